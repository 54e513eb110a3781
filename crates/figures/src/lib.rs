//! The figures of the papers, and shapes and clouds with known truth for their experiments. Not published.
//!
//! A [`Figure`] says where it stands in which [`Paper`], and makes ours: a [`Sheet`], an SVG document, and the
//! [`Number`]s beside it. [`figures`] lists all of them. The program `figures` (`cargo xtask figures`) makes, stores and
//! compares them; [`store`] is where they are kept, [`page`] sets them beside the papers'.
//!
//! ```
//! use pellicle_figures::{Effort, Run, figures};
//!
//! let figure = figures().find(|figure| figure.name == "robustness-orientation").unwrap();
//! let made = (figure.make)(&Run { effort: Effort::Quick, progress: &() })?;
//! let wrong = made.numbers.iter().find(|number| number.name == "wrong signs, doubles").unwrap();
//! assert!(wrong.value > 0.0);
//! # Ok::<(), pellicle_figures::Error>(())
//! ```
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
pub mod cocone;
pub mod crossing;
mod error;
pub mod evolution;
mod field;
mod figure;
mod number;
pub mod page;
mod polygonize;
mod random;
pub mod raster;
pub mod robustness;
mod sampler;
pub mod scene;
mod shape;
pub mod shapes;
pub mod sheet;
pub mod store;
pub mod transformesh;

pub use error::Error;
pub use figure::{Effort, Figure, Made, Paper, Run, Verdict};
pub use number::{Compare, Number};
pub use random::Random;
pub use sampler::AreaSampler;
pub use shape::Shape;
pub use sheet::Sheet;

/// Every figure, in the order of the page.
pub fn figures() -> impl Iterator<Item = &'static Figure> {
    [
        robustness::FIGURES,
        cocone::FIGURES,
        transformesh::FIGURES,
        evolution::FIGURES,
    ]
    .into_iter()
    .flatten()
}

#[cfg(test)]
mod tests;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
