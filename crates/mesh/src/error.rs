//! What can go wrong.

use crate::{Defect, Refusal, TriangleSoup};
use pellicle_geometry::{Cancelled, DVec3, VertexId};

/// Why a mesh operation refused its input.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MeshError {
    /// The soup is not an oriented manifold.
    #[error("not an oriented manifold: {}{}", first(.defects), others(.defects))]
    NotManifold {
        /// The soup, unchanged.
        soup: TriangleSoup,
        /// Every defect; at least one of them keeps the soup from being a manifold.
        defects: Vec<Defect>,
    },
    /// There are not as many new positions as vertices.
    #[error("{positions} positions for {vertices} vertices")]
    PositionCount {
        /// How many positions were given.
        positions: usize,
        /// How many vertices the mesh has.
        vertices: usize,
    },
    /// A position has a coordinate that is NaN or infinite.
    #[error("vertex {} has a coordinate that is not finite: {position}", .vertex.0)]
    NotFinite {
        /// The first such vertex.
        vertex: VertexId,
        /// Its position.
        position: DVec3,
    },
    /// The mesh bounds nothing: an edge has more triangles on one side than on the other.
    #[error(
        "not closed: {forward} triangles run from vertex {} to {} and {backward} back",
        .edge[0].0, .edge[1].0
    )]
    NotClosed {
        /// The first such edge, its lower vertex first.
        edge: [VertexId; 2],
        /// How many triangles run along the edge.
        forward: usize,
        /// How many run back.
        backward: usize,
    },
    /// More vertices or triangles than `u32` ids can name.
    #[error(
        "{vertices} vertices and {triangles} triangles: at most 2^32 - 2 and (2^32 - 1)/3 - 1 are supported"
    )]
    TooLarge {
        /// How many vertices.
        vertices: usize,
        /// How many triangles.
        triangles: usize,
    },
    /// There is nothing to measure the distance to, or from.
    #[error("no distance: {side} holds neither a triangle nor a point")]
    NothingToMeasure {
        /// Which of the two arguments.
        side: &'static str,
    },
    /// An option has a value that means nothing.
    #[error("{option} is {value}: {expected}")]
    InvalidOption {
        /// The name of the field.
        option: &'static str,
        /// Its value.
        value: f64,
        /// What it must be.
        expected: &'static str,
    },
    /// An edit of connectivity was refused.
    #[error(transparent)]
    Refused(#[from] Refusal),
    /// The work was stopped by its observer.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

fn first(defects: &[Defect]) -> String {
    let refused = defects.iter().find(|d| d.prevents_manifold());
    refused.map_or_else(String::new, Defect::to_string)
}

fn others(defects: &[Defect]) -> String {
    match defects.len() {
        0 | 1 => String::new(),
        n => format!(" (and {} more)", n - 1),
    }
}
