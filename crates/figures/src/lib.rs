//! Shapes and clouds with known truth, for the experiments of the papers. Not published.
//!
//! A [`Shape`] is a closed mesh as fine as the truth needs, its volume, and points of the surface itself; [`shapes`]
//! makes those of Daniel 2015. [`clouds`] gives a cloud the defects of measured ones. [`crossing`] makes surfaces that
//! cross themselves. Everything is seeded and the same on every machine.
//!
//! ```
//! use pellicle_figures::{clouds, shapes};
//!
//! let shape = shapes::ellipsoid();
//! let points = shape.sample(500, 1);
//! let cloud = clouds::with_outliers(&clouds::with_noise(&points, 0.01, 2), 0.01, 3);
//! assert_eq!(cloud.len(), 505);
//! assert!(shape.truth.is_closed());
//! ```
#![forbid(unsafe_code)]

pub mod clouds;
pub mod crossing;
mod field;
mod polygonize;
mod random;
mod sampler;
mod shape;
pub mod shapes;

pub use random::Random;
pub use sampler::AreaSampler;
pub use shape::Shape;

#[cfg(test)]
mod tests;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
