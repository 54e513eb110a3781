//! Order and search in space: Hilbert and BRIO order, bounding-volume hierarchy, k-d tree.
//!
//! The data are the caller's slices: nothing here moves or changes them, and every result is a permutation
//! or a list of indices.
#![forbid(unsafe_code)]

pub mod brio;
pub mod bvh;
pub mod hilbert;
pub mod kd_tree;

pub use bvh::Bvh;
pub use kd_tree::{KdTree, Neighbor, median_spacing};
