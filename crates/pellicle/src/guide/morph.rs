//! A closed mesh deformed into another, topology included.
//!
//! ![A sphere shrinks onto a torus, and its middle opens][morph/morph.png]
//!
//! ```sh
//! pellicle morph fixtures/analytic/sphere.off fixtures/repair/torus_before.off -o torus.ply --place enclose --edge-length 0.2 --snapshots morph --every 12
//! ```
//!
//! The source moves along its normals onto the target: outside of it the surface shrinks, inside it grows (Zaharescu et
//! al. 2007). Where sheets pass through each other, [`repair`](super::repair) opens a hole, or parts or merges pieces.
//!
//! ```
//! use pellicle::prelude::*;
//!
//! let sphere = mesh::icosphere(2)?;
//! let mut target = sphere.clone();
//! target.set_positions(sphere.positions().iter().map(|p| *p * DVec3::new(2.0, 1.0, 0.5)).collect())?;
//! let options = transformesh::MorphOptions {
//!     placement: transformesh::Placement::Enclose,
//!     ..Default::default()
//! };
//! let (mesh, report) = morph(&sphere, &target, &options)?;
//! assert_eq!(report.end, transformesh::MorphEnd::Arrived);
//! assert_eq!(report.topology, report.target_topology);
//! assert!(mesh.is_closed() && report.mean_distance < 0.25 * report.edge_length);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! A component of the target is found if the source overlaps it at the start: start from around everything, with
//! [`Placement::Enclose`](crate::transformesh::Placement::Enclose). Else the report says what was
//! [missed](crate::transformesh::MorphReport::missed).
//!
#![doc = include_str!("pictures/morph.md")]
