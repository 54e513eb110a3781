//! The figures of the slides "Robustness": what rounding and degeneracy do to geometric programs, and what exact signs
//! and symbolic perturbation do about it.

use crate::Figure;
use crate::sheet::{Color, Style};
use pellicle::predicates::Sign;

mod choices;
mod conflict;
mod orientation;
mod perturbations;
mod planar;
mod stages;
mod static_filter;
mod theorem;
mod toy;
mod turn;
mod walk;

/// All of them, in the slides' order.
pub const FIGURES: &[Figure] = &[
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

/// The three colours of signs.
fn color(sign: Sign) -> Color {
    match sign {
        Sign::Positive => Color::BLUE,
        Sign::Zero => Color::YELLOW,
        Sign::Negative => Color::VERMILION,
    }
}

/// What they mean.
fn sign_legend() -> [(Style, &'static str); 3] {
    let entry = |sign, words| (Style::fill(color(sign)).outlined(Color::WHITE, 1.0), words);
    [
        entry(Sign::Positive, "> 0"),
        entry(Sign::Zero, "= 0"),
        entry(Sign::Negative, "< 0"),
    ]
}
