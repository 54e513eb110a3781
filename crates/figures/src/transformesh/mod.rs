//! The figures of Zaharescu et al. 2007: TransforMesh.

mod crossing_cases;
mod growing;
mod singular;
mod timing;
mod topology;
mod toy;
mod traversal;
pub mod watch;

use crate::{Figure, Paper};

/// All of them, in the paper's order.
pub const FIGURES: &[Figure] = &[
    Figure {
        name: "transformesh-1",
        paper: Paper::TransforMesh,
        number: "figure 1",
        title: "A toy example",
        shows: "A toy example of TransforMesh at work: a mesh that crosses itself, and its outside.",
        make: toy::make,
    },
    Figure {
        name: "transformesh-2",
        paper: Paper::TransforMesh,
        number: "figure 2",
        title: "Valid region growing",
        shows: "Valid region growing, a simplified view in the plane, in five states; the selected elements are in bold.",
        make: growing::make,
    },
    Figure {
        name: "transformesh-3",
        paper: Paper::TransforMesh,
        number: "figure 3",
        title: "Traversal of a partially valid triangle",
        shows: "A triangle cut along its intersection segments, and a traversal from the entrance half-edge that stops at them.",
        make: traversal::make,
    },
    Figure {
        name: "transformesh-4",
        paper: Paper::TransforMesh,
        number: "figure 4",
        title: "The two ways of crossing",
        shows: "Partial triangle crossing cases, from the side: where the region goes on, by the normals.",
        make: crossing_cases::make,
    },
    Figure {
        name: "transformesh-5",
        paper: Paper::TransforMesh,
        number: "figure 5",
        title: "Singular vertex, edge and face",
        shows: "The special cases encountered while stitching a triangle soup.",
        make: singular::special_cases,
    },
    Figure {
        name: "transformesh-6",
        paper: Paper::TransforMesh,
        number: "figure 6",
        title: "How a singular vertex comes about",
        shows: "A singular vertex occurs in a typical removal of self-intersections, due to an inverted triangle (red).",
        make: singular::inverted_triangle,
    },
    Figure {
        name: "transformesh-7",
        paper: Paper::TransforMesh,
        number: "figure 7",
        title: "Changes of topology",
        shows: "Different topological changes in a simplified view in the plane; the final surface is in bold blue.",
        make: topology::make,
    },
    Figure {
        name: "transformesh-timing",
        paper: Paper::TransforMesh,
        number: "section 4",
        title: "50,000 facets",
        shows: "The self-intersection test takes under a second for 50,000 facets, with exact arithmetic and self-intersections \
                in the range of 100.",
        make: timing::make,
    },
];
