//! The figures of Daniel 2015: direct surface evolution.

mod bumps;
mod bust;
mod covolumes;
mod defects;
mod distance;
mod flow;
mod microscope;
mod pictures;
mod plane;
mod quality;
mod runs;
mod spheres;
mod vesicles;

use crate::Figure;

/// All of them, in the paper's order.
pub const FIGURES: &[Figure] = &[
    spheres::FIGURES[0],
    distance::FIGURE,
    defects::FIGURES[0],
    spheres::FIGURES[1],
    covolumes::FIGURE,
    defects::FIGURES[1],
    defects::FIGURES[2],
    defects::FIGURES[3],
    defects::FIGURES[4],
    defects::FIGURES[5],
    bust::FIGURE,
    bumps::FIGURE,
    vesicles::FIGURES[0],
    vesicles::FIGURES[1],
    vesicles::FIGURES[2],
    flow::FIGURES[0],
    flow::FIGURES[1],
    quality::FIGURE,
    flow::FIGURES[2],
];
