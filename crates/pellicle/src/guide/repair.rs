//! A mesh that crosses itself to the closed manifold that bounds its outside.
//!
//! ![Two spheres that cross, one of them inside out][before.png] ![A ball with a bite][repair.png]
//!
//! ```sh
//! pellicle repair fixtures/repair/sphere_plus_inverted_overlap.off -o clean.ply
//! pellicle render fixtures/repair/sphere_plus_inverted_overlap.off -o before.png --crossing --views three-quarter --width 320 --height 260
//! pellicle render clean.ply -o repair.png --views three-quarter --width 320 --height 260
//! ```
//!
//! The mesh is cut where its triangles meet, by exact signs; of the pieces those are kept that bound what a
//! [`Rule`](crate::transformesh::Rule) says of the winding number. What comes back is closed, an oriented manifold, and free
//! of self-intersections; vertices that stay do not move.
//!
//! ```
//! use pellicle::prelude::*;
//!
//! // A sphere, one vertex of which was pulled through the other side.
//! let mut folded = mesh::icosphere(2)?.into_soup();
//! folded.positions[0] *= -1.5;
//! assert!(mesh::count_self_intersections((&folded).into(), &())? > 0);
//!
//! let (clean, report) = repair(&folded, &transformesh::Options::default())?;
//! assert_eq!(report.remaining, 0);
//! assert_eq!(mesh::count_self_intersections((&clean).into(), &())?, 0);
//! // The triangle of the input that each one is a piece of:
//! assert_eq!(report.sources.len(), clean.triangles().len());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Several meshes in one soup become their union; one that is inside out is taken away from the others. The segments in
//! which triangles meet, without a repair: [`intersection_segments`](crate::transformesh::intersection_segments).
//!
#![doc = include_str!("pictures/repair.md")]
