//! What a mesh is, and everything that is wrong with it.
//!
//! ![An elephant with holes: borders are orange, the inside is purple][measure.png]
//!
//! ```sh
//! pellicle info fixtures/elephant-with-holes.off
//! pellicle render fixtures/elephant-with-holes.off -o measure.png --views three-quarter --width 320 --height 260
//! ```
//!
//! Triangles without a guarantee are a [`TriangleSoup`](crate::mesh::TriangleSoup). A [`TriMesh`](crate::mesh::TriMesh) is an
//! oriented manifold, perhaps with borders: the type is the promise, and what cannot be one stays a soup.
//!
//! ```
//! use pellicle::prelude::*;
//!
//! let tetrahedron = TriangleSoup {
//!     positions: vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z],
//!     triangles: [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]].map(|t| t.map(VertexId)).to_vec(),
//! };
//! let summary = mesh::summarize((&tetrahedron).into())?;
//! assert_eq!((summary.is_closed(), summary.genus()), (true, Some(0)));
//! assert_eq!(mesh::count_self_intersections((&tetrahedron).into(), &())?, 0);
//! assert!(TriMesh::try_from(tetrahedron.clone())?.is_closed());
//!
//! // All defects at once, each by its ids.
//! let mut broken = tetrahedron;
//! broken.triangles[0].reverse();
//! assert!(!mesh::validate((&broken).into()).is_empty());
//! assert!(matches!(TriMesh::try_from(broken), Err(mesh::MeshError::NotManifold { .. })));
//! # Ok::<(), mesh::MeshError>(())
//! ```
//!
//! Inside or outside, exactly: [`winding_numbers`](crate::mesh::winding_numbers),
//! [`SignedDistance`](crate::mesh::SignedDistance). Shapes of triangles: [`quality`](crate::mesh::quality).
//!
#![doc = include_str!("pictures/measure.md")]
