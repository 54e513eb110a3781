//! An oriented normal at every point.
//!
//! ![5,760 points of two linked rings, without normals][without.png] ![The same, lit by its normals][normals.png]
//!
//! ```sh
//! pellicle normals fixtures/knot2.off -o normals.ply
//! pellicle render fixtures/knot2.off -o without.png --style points --views three-quarter --width 320 --height 260
//! pellicle render normals.ply -o normals.png --views three-quarter --width 320 --height 260
//! ```
//!
//! A point's Voronoi cell is long across the surface, so its farthest corner, the pole, tells the normal (Dey 2006); all of
//! them are then turned to the same side, outwards.
//!
//! ```
//! use pellicle::prelude::*;
//!
//! let points = mesh::icosphere(3)?.into_soup().positions;
//! let tetrahedra = tetrahedralize(&points, &delaunay::Options::default())?;
//! let normals = cocone::normals(&tetrahedra);
//! for (point, normal) in points.iter().zip(&normals) {
//!     assert!(point.dot(*normal) > 0.99);
//! }
//! let cloud = PointCloud::new(points)?.with_normals(normals)?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
#![doc = include_str!("pictures/normals.md")]
