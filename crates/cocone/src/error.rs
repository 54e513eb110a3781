//! Why there is no reconstruction.

use pellicle_geometry::Cancelled;
use pellicle_mesh::MeshError;

/// Why [`reconstruct`](crate::reconstruct) has no result.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The mesh has more triangles than ids can name.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// The observer asked to stop.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}
