//! Surfaces that evolve onto a point cloud (Daniel 2015).
//!
//! # Data
//!
//! - A cloud is a `&[DVec3]`; the surface is a closed [`TriMesh`](pellicle_mesh::TriMesh), counter-clockwise seen from
//!   outside.
//! - [`DistanceGrid`]: the regularised distance d to the cloud on a grid of voxels. Anything else that drives a surface
//!   implements [`Field`].
//! - [`Evolution`]: a surface in motion. [`Stage`]: a run of steps with the same parameters, lengths in voxels.
//!
//! # Verbs
//!
//! - [`evolve()`] takes a cloud to a surface: distance, initial ellipsoid, stages from coarse to fine.
//! - [`Evolution::step`] is one step of (3.2): ∂F/∂t = w_a (−∇d · N) N + w_d d ΔF + v_T. The advection brings the surface
//!   to the points, the diffusion keeps it smooth and carries it past gaps, and v_T spreads the vertices over it
//!   ([`Redistribution`]).
//!
//! ```
//! use pellicle_evolution::{Options, evolve};
//! use pellicle_geometry::DVec3;
//! use pellicle_mesh::signed_volume;
//!
//! // 2,000 points of the unit sphere, along a spiral.
//! let points: Vec<DVec3> = (0..2000)
//!     .map(|i| {
//!         let z = 1.0 - (2.0 * f64::from(i) + 1.0) / 2000.0;
//!         let (sin, cos) = (2.399963 * f64::from(i)).sin_cos();
//!         DVec3::new(cos, sin, 0.0) * (1.0 - z * z).sqrt() + DVec3::Z * z
//!     })
//!     .collect();
//! let evolved = evolve(&points, &Options { resolution: 60, ..Options::default() })?;
//! assert!(evolved.mesh.is_closed() && evolved.report.at_rest);
//! let volume = signed_volume((&evolved.mesh).into());
//! assert!((volume / 4.18879 - 1.0).abs() < 0.02);
//! # Ok::<(), pellicle_evolution::Error>(())
//! ```
#![forbid(unsafe_code)]

mod cloud;
mod contact;
mod covolumes;
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
mod placement;
mod redistribution;
mod rings;
mod run;
mod stage;
mod step;
mod systems;
mod velocity;

#[cfg(test)]
mod tests;

pub use covolumes::Covolumes;
pub use distance::{DistanceGrid, DistanceOptions, Storage};
pub use error::Error;
pub use evolve::{Topology, evolve, evolve_adapting, evolve_with};
pub use field::{Field, One, Sample, ShortOf};
pub use initial::ellipsoid_around;
pub use measures::Measures;
pub use options::{EdgeLength, Evolved, Initial, Options, Outliers, Report, Schedule};
pub use redistribution::{CurvatureDensity, CurvatureFunction, Redistribution};
pub use stage::{Flow, Refinement, Stage, Upkeep};
pub use step::{Deflation, Evolution, StepOptions, StepReport, step};
pub use systems::SystemSolver;
