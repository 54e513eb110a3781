//! The figures of chapter 4 of Dey 2006: Cocone; and its lemmas, measured.

pub mod edges;
mod lemmas;
pub mod measured;
mod neighbor;
mod pole;
mod sharp;
pub mod surface;
mod theorem;

use crate::{Figure, Paper};

/// All of them, in the paper's order.
pub const FIGURES: &[Figure] = &[
    Figure {
        name: "cocone-pole",
        paper: Paper::Cocone,
        number: "figure 4.1",
        title: "A pole and a cocone",
        shows: "The positive pole p⁺ helps estimating the normal n_p, and the cocone helps estimating the restricted Voronoi \
                cell V_p|Σ.",
        make: pole::make,
    },
    Figure {
        name: "cocone-lemmas",
        paper: Paper::Cocone,
        number: "lemmas 4.1 to 4.3",
        title: "The lemmas, measured",
        shows: "Bounds, proved and not drawn: how far a pole vector is from the normal, how large a cocone triangle is, and how \
                it is tilted, for an ε-sample.",
        make: lemmas::make,
    },
    Figure {
        name: "cocone-sharp",
        paper: Paper::Cocone,
        number: "figure 4.2",
        title: "A sharp edge",
        shows: "The edge e is not sharp in the left picture. It is sharp in the right picture.",
        make: sharp::make,
    },
    Figure {
        name: "cocone-theorem",
        paper: Paper::Cocone,
        number: "figure 4.3",
        title: "Two restricted Delaunay triangles at an edge",
        shows: "Two neighbouring triangles, their balls with centres on the surface, and the plane H between them.",
        make: theorem::make,
    },
    Figure {
        name: "cocone-neighbor",
        paper: Paper::Cocone,
        number: "figure 4.4",
        title: "The surface neighbour, by turning and by numbers",
        shows: "A stable computation of SURFACENEIGHBOR; a zoom on a reconstruction after an unstable computation with numerical \
                errors; and a stable computation without any.",
        make: neighbor::make,
    },
];
