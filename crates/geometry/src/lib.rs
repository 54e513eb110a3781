//! Points, boxes, triangles, point clouds, progress and cancellation: what every other crate shares.
//!
//! Coordinates are [`glam::DVec3`] in the caller's units; ids are `u32` newtypes made by [`define_id!`].
#![forbid(unsafe_code)]

pub use glam;
pub use glam::{DVec2, DVec3};

mod aabb;
mod cloud;
mod id;
mod progress;
pub mod triangle;
mod union_find;

pub use aabb::Aabb;
pub use cloud::{CloudError, PointCloud, first_not_finite};
pub use id::VertexId;
pub use progress::{Cancelled, Progress};
pub use union_find::UnionFind;
