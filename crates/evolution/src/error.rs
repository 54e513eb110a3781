//! What can go wrong.

use glam::DVec3;
use pellicle_geometry::{Cancelled, VertexId};
use pellicle_mesh::{MeshError, TriMesh};

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
    /// The points lie in a plane, on a line, or in one place.
    #[error(
        "the {points} points {}: an evolution needs points all around a volume; give more, or, for a flat cloud, use the \
         cocone method",
        match dimension {
            0 => "are all in one place",
            1 => "lie on a line",
            _ => "lie in a plane",
        }
    )]
    Flat {
        /// How many points there are, outliers left out.
        points: usize,
        /// 0, 1 or 2.
        dimension: u32,
    },
    /// The surface could not be repaired while its topology changed.
    #[error("after step {step} the surface could not be repaired: {reason}")]
    Repair {
        /// The step, from one.
        step: u64,
        /// What the repair said.
        reason: String,
    },
    /// The initial surface intersects itself.
    #[error(
        "the initial surface intersects itself: {pairs} pairs of triangles do; repair it, or start from an ellipsoid"
    )]
    InitialIntersectsItself {
        /// Pairs of triangles.
        pairs: u64,
    },
    /// The initial surface does not enclose the points.
    #[error(
        "{outside} of {points} points, the first at {position}, are not inside of the initial surface: give one that \
         encloses them with its triangles counter-clockwise seen from outside, or start from an ellipsoid"
    )]
    NotEnclosed {
        /// The first point outside.
        position: DVec3,
        /// How many are outside.
        outside: usize,
        /// How many points there are, outliers left out.
        points: usize,
    },
    /// The surface has shrunk to nothing.
    #[error(
        "after {step} steps the surface has shrunk to nothing: the points enclose no volume that the grid resolves. \
         Raise the resolution, or give points all around the object; open sheets are for the cocone method"
    )]
    Collapsed {
        /// The step, from one.
        step: u64,
    },
    /// A linear system could not be solved; the surface stands where it stood before the step.
    #[error(transparent)]
    Linear(#[from] crate::linear::LinearError),
    /// A mesh could not be made.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// The distance to no points is undefined.
    #[error("the cloud has no points")]
    EmptyCloud,
    /// A point has a coordinate that is infinite or not a number.
    #[error("point {index} has a coordinate that is not finite")]
    PointNotFinite {
        /// The point's index in the caller's slice.
        index: usize,
    },
    /// More points than 32 bits can name.
    #[error("{count} points are more than 2^32 - 2")]
    TooManyPoints {
        /// How many.
        count: usize,
    },
    /// The box of the distance grid has no size, so no voxel size follows from it.
    #[error(
        "the box of the distance grid has no size: all points coincide, or its bounds are empty; give bounds"
    )]
    ZeroExtent,
    /// The box of the distance grid is not finite, or its longest side overflows.
    #[error("the box of the distance grid is not finite: scale the points")]
    BoundsNotFinite,
    /// The given bounds lie so far from every point that the field would be rounding alone.
    #[error(
        "the nearest point lies {voxels:.3e} voxels outside of the bounds; at most {limit:.0e} make sense"
    )]
    BoundsFarFromPoints {
        /// The distance of the nearest point from the box, in voxels.
        voxels: f64,
        /// The largest distance that is accepted.
        limit: f64,
    },
    /// The distance grid would take more memory than its options allow.
    #[error(
        "the distance grid needs {needed} bytes of memory, and the limit is {limit}: lower the resolution, store it \
         sparsely, or raise the limit"
    )]
    GridTooLarge {
        /// Bytes at the peak; saturates.
        needed: u64,
        /// Bytes that the options allow.
        limit: u64,
    },
    /// An option is outside of its range.
    #[error("option {option} is {value}, and has to be {expected}")]
    Option {
        /// The field of the options.
        option: &'static str,
        /// Its value.
        value: f64,
        /// What it has to be.
        expected: &'static str,
    },
    /// The observer asked for a stop.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

impl Error {
    /// [`Error::NotClosed`], with the first edge that says so.
    pub(crate) fn not_closed(mesh: &TriMesh) -> Self {
        let border = mesh.half_edge_ids().find(|&h| mesh.twin(h).is_none());
        Self::NotClosed {
            edge: border.map(|h| [mesh.origin(h), mesh.destination(h)]),
        }
    }
}
