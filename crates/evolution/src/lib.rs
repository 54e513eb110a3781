//! Surfaces that evolve onto a point cloud (Daniel 2015).
#![forbid(unsafe_code)]

mod cloud;
mod contact;
pub mod distance;
mod error;
mod evolve;
mod field;
mod finite_volumes;
mod initial;
pub mod linear;
mod measures;
mod options;
mod parallel;
mod redistribution;
mod rings;
mod run;
mod stage;
mod step;
mod systems;
mod velocity;

#[cfg(test)]
mod tests;

pub use distance::{DistanceGrid, DistanceOptions, Storage};
pub use error::Error;
pub use evolve::{evolve, evolve_with};
pub use field::{Field, One, Sample, ShortOf};
pub use initial::ellipsoid_around;
pub use measures::Measures;
pub use options::{EdgeLength, Evolved, Initial, Options, Outliers, Report, Schedule};
pub use redistribution::{CurvatureDensity, CurvatureFunction, Redistribution};
pub use stage::{Flow, Refinement, Stage, Upkeep};
pub use step::{Evolution, StepOptions, StepReport, step};
pub use systems::SystemSolver;
