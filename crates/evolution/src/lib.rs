//! Surfaces that evolve onto a point cloud (Daniel 2015).
#![forbid(unsafe_code)]

mod distance;
pub mod linear;
