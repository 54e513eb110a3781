//! Why points have no tetrahedralisation.

use pellicle_geometry::{Cancelled, VertexId};

/// Why [`tetrahedralize`](crate::tetrahedralize) or
/// [`tetrahedralize_weighted`](crate::tetrahedralize_weighted) has no result, or a
/// [`DynamicTetrahedralization`](crate::DynamicTetrahedralization) stays as it is.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A coordinate is NaN or infinite.
    #[error("point {} has a coordinate that is not finite; remove the point or mend its file", .vertex.0)]
    NotFinite {
        /// The first such point.
        vertex: VertexId,
    },
    /// Fewer than four points differ from each other.
    #[error("{distinct} distinct points: a tetrahedralisation needs at least four")]
    TooFewPoints {
        /// How many points are distinct.
        distinct: usize,
    },
    /// All points lie on one line, exactly.
    #[error("all {distinct} distinct points lie on one line: they span no tetrahedron")]
    Collinear {
        /// How many points are distinct.
        distinct: usize,
    },
    /// All points lie in one plane, exactly.
    #[error("all {distinct} distinct points lie in one plane: they span no tetrahedron")]
    Coplanar {
        /// How many points are distinct.
        distinct: usize,
    },
    /// More than 2³⁰ tetrahedra, which is what facet ids can name, or more points than `u32` ids.
    #[error("more than {limit} {of}: the ids are 32 bits wide; split the points into blocks")]
    TooMany {
        /// What there are too many of.
        of: &'static str,
        /// How many there may be.
        limit: usize,
    },
    /// The id names no vertex: none had it yet, or it was removed.
    #[error("{} is not the id of a vertex: it was removed, or never inserted", .vertex.0)]
    NotAVertex {
        /// The id.
        vertex: VertexId,
    },
    /// There is not one weight for each point.
    #[error("{weights} weights for {points} points: each point needs one")]
    WeightCount {
        /// How many points there are.
        points: usize,
        /// How many weights.
        weights: usize,
    },
    /// A weight is NaN or infinite.
    #[error("the weight of point {} is not finite", .vertex.0)]
    WeightNotFinite {
        /// The first such point.
        vertex: VertexId,
    },
    /// The observer asked to stop.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}
