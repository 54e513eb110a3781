//! The distance between two meshes or clouds, each way.
//!
//! ![A smoothed elephant; the colours are its distance from the one before][compare.png]
//!
//! ```sh
//! pellicle smooth fixtures/elephant.off -o smooth.ply
//! pellicle compare smooth.ply fixtures/elephant.off
//! pellicle render smooth.ply -o compare.png --scalar distance-to:fixtures/elephant.off --shading smooth --views three-quarter --width 360 --height 280
//! ```
//!
//! Points are spread evenly over the triangles of each, and the nearest point of the other is found for each of them and
//! for each vertex; the choice is the same each time.
//!
//! ```
//! use pellicle::prelude::*;
//!
//! let cloud = [DVec3::ZERO, DVec3::X];
//! let lifted = cloud.map(|p| p + 0.5 * DVec3::Z);
//! let view = |positions| MeshView { positions, triangles: &[] };
//! let comparison =
//!     mesh::compare(view(&cloud), view(&lifted), &mesh::DistanceOptions::default(), &())?;
//! assert_eq!(comparison.hausdorff(), 0.5);
//! assert_eq!(comparison.forward.mean, 0.5);
//! # Ok::<(), mesh::MeshError>(())
//! ```
//!
//! For given points rather than chosen ones: [`point_distances`](crate::mesh::point_distances).
//!
#![doc = include_str!("pictures/compare.md")]
