//! Points to a mesh through them.
//!
//! ![5,210 points of a kitten][points.png] ![The mesh through them][reconstruct.png]
//!
//! ```sh
//! pellicle reconstruct fixtures/kitten.xyz -o kitten.ply
//! pellicle render fixtures/kitten.xyz -o points.png --style points --views three-quarter --width 320 --height 320
//! pellicle render kitten.ply -o reconstruct.png --style surface-edges --edge-width 0.7 --views three-quarter --width 320 --height 320
//! ```
//!
//! Two steps: the Delaunay tetrahedra of the points ([`tetrahedralize`](crate::delaunay::tetrahedralize)), and the choice of
//! triangles among their facets ([`reconstruct`](crate::cocone::reconstruct), Dey 2006). Vertices are points of the input,
//! unmoved; normals are neither needed nor used.
//!
//! [`Method::Cocone`](crate::cocone::Method::Cocone) leaves open what the points do not support: a border of the surface, a
//! place with too few points. [`Method::TightCocone`](crate::cocone::Method::TightCocone) always returns the boundary of a
//! solid (Dey and Goswami 2003).
//!
//! ```
//! use pellicle::prelude::*;
//!
//! // 60 points on and in a box, as they come from a grid: degenerate input is ordinary input.
//! let points: Vec<DVec3> = (0..60)
//!     .map(|i| DVec3::new(f64::from(i % 5), f64::from(i / 5 % 4), f64::from(i / 20)))
//!     .collect();
//! let tetrahedra = tetrahedralize(&points, &delaunay::Options::default())?;
//! let mut options = cocone::Options::default();
//! options.method = cocone::Method::TightCocone;
//! let surface = reconstruct(&tetrahedra, &options)?;
//! assert!(surface.mesh.is_closed());
//!
//! // The point that each vertex of the mesh is, and the points that are no vertex:
//! assert_eq!(points[surface.vertices[0].index()], surface.mesh.positions()[0]);
//! assert_eq!(surface.report.used + surface.report.dropped.len(), points.len());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Too few points somewhere, or noise of the size of their distances: [`evolve`](super::evolve).
//!
#![doc = include_str!("pictures/reconstruct.md")]
