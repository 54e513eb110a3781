//! The figures of the slides "Robustness": what rounding and degeneracy do to geometric programs, and what exact signs
//! and symbolic perturbation do about it.

use crate::Figure;

mod choices;
mod conflict;
mod doubles;
mod in_disk;
mod orientation;
mod perturbations;
mod planar;
mod sign_map;
mod stages;
mod static_filter;
mod theorem;
mod toy;
mod turn;
mod walk;

/// All of them, in the slides' order.
pub const FIGURES: &[Figure] = &[
    in_disk::FIGURE,
    choices::FIGURE,
    toy::FIGURE,
    orientation::FIGURE,
    theorem::FIGURE,
    turn::FIGURE,
    walk::FIGURE,
    conflict::FIGURE,
    static_filter::FIGURE,
    stages::FIGURE,
    perturbations::FIGURE,
];
