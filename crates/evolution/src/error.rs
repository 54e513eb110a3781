//! What can go wrong.

use glam::DVec3;
use pellicle_geometry::{Cancelled, VertexId};
use pellicle_mesh::MeshError;

/// What can go wrong with an evolution.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The surface has a border, or no triangles at all.
    #[error(
        "the surface must be closed, and {}",
        match edge {
            Some([a, b]) => format!("the edge between its vertices {} and {} has one triangle; close it first", a.0, b.0),
            None => "has no triangles".to_owned(),
        }
    )]
    NotClosed {
        /// The vertices of an edge with one triangle; `None` without triangles.
        edge: Option<[VertexId; 2]>,
    },
    /// A vertex would have left all bounds; the surface stands where it stood before the step.
    #[error(
        "step {step} would move vertex {} from {position} to infinity or NaN: take a smaller time step, \
         or remesh a surface that has collapsed",
        vertex.0
    )]
    NotFinite {
        /// The step, from one.
        step: u64,
        /// The vertex.
        vertex: VertexId,
        /// Where it stands.
        position: DVec3,
    },
    /// A mesh could not be made.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// The observer asked for a stop.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}
