//! The figures of the slides "Robustness": what rounding and degeneracy do to geometric programs, and what exact signs
//! and symbolic perturbation do about it.

use crate::Figure;

mod orientation;

/// All of them, in the slides' order.
pub const FIGURES: &[Figure] = &[orientation::FIGURE];
