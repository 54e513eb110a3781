//! Surfaces that evolve onto a point cloud (Daniel 2015).
#![forbid(unsafe_code)]

pub mod distance;
mod error;
mod field;
pub mod linear;

pub use distance::{DistanceGrid, DistanceOptions, Storage};
pub use error::Error;
pub use field::{Field, One, Sample};
