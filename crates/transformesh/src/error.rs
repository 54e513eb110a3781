//! What can go wrong.

use pellicle_geometry::{Cancelled, DVec3, VertexId};
use pellicle_mesh::{MeshError, TriangleId};

/// Why a mesh was not repaired.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A vertex has a coordinate that is NaN or infinite.
    #[error("vertex {} has a coordinate that is not finite: {position}", .vertex.0)]
    NotFinite {
        /// The first such vertex.
        vertex: VertexId,
        /// Its position.
        position: DVec3,
    },
    /// A triangle names a vertex that does not exist.
    #[error("triangle {} names vertex {}, but there are only {vertices} vertices", .triangle.0, .vertex.0)]
    NoSuchVertex {
        /// The first such triangle.
        triangle: TriangleId,
        /// The vertex that it names.
        vertex: VertexId,
        /// How many vertices there are.
        vertices: usize,
    },
    /// The surface has a border, or triangles that face against their neighbours, so that it has no inside.
    #[error(
        "the surface is open: along {edges} edges its sheets do not add up, the first from {from} to {to}; \
         close it first, or ask for what is seen from outside (Rule::Outside), which keeps borders"
    )]
    Open {
        /// At how many edges of the cut surface.
        edges: usize,
        /// One end of the first of them.
        from: DVec3,
        /// The other end.
        to: DVec3,
    },
    /// The surface that morphs shrank to nothing: it did not overlap the target.
    #[error("the surface vanished in step {step}: where it began, it did not overlap the target")]
    Vanished {
        /// After how many steps.
        step: u32,
    },
    /// The source or the target of a morph encloses nothing.
    #[error("the {side} encloses nothing: it is empty, flat or inside out")]
    Empty {
        /// Which of the two.
        side: &'static str,
    },
    /// The source or the target of a morph cannot be repaired.
    #[error("the {side}: {reason}")]
    Side {
        /// Which of the two.
        side: &'static str,
        /// What is wrong with it.
        reason: Box<Error>,
    },
    /// An option has a value that means nothing.
    #[error("{option} is {value}: {expected}")]
    Option {
        /// The name of the field.
        option: &'static str,
        /// Its value.
        value: f64,
        /// What it must be.
        expected: &'static str,
    },
    /// More vertices or triangles than ids can name.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// The work was stopped by its observer.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}
