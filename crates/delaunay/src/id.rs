//! Tetrahedra, facets, and the order of their corners.

use pellicle_geometry::{VertexId, define_id};

define_id! {
    /// A tetrahedron, finite or infinite.
    pub struct TetId;
}

define_id! {
    /// A facet as seen from one of its two tetrahedra: `4 t + i` is the facet of tetrahedron `t` opposite
    /// its corner `i`.
    pub struct FacetId;
}

impl FacetId {
    /// The facet of `tet` opposite `corner`, which is below 4.
    #[inline]
    pub fn of(tet: TetId, corner: usize) -> Self {
        debug_assert!(corner < 4);
        Self(tet.0 << 2 | corner as u32)
    }

    /// The tetrahedron from which the facet is seen.
    #[inline]
    pub fn tet(self) -> TetId {
        TetId(self.0 >> 2)
    }

    /// The corner opposite the facet.
    #[inline]
    pub fn corner(self) -> usize {
        (self.0 & 3) as usize
    }
}

/// The corners of the facet opposite corner `i`, counter-clockwise seen from corner `i`:
/// `orient3d(facet, corner i)` is positive when the tetrahedron is.
///
/// ```text
///            3
///           /|\
///          / | \         facet 3 = (0, 1, 2) from 3
///         /  |  \        facet 2 = (0, 3, 1) from 2
///        0 - | - 2       facet 1 = (0, 2, 3) from 1
///         \  |  /        facet 0 = (1, 3, 2) from 0
///          \ | /
///            1
/// ```
pub const FACET_CORNERS: [[usize; 3]; 4] = [[1, 3, 2], [0, 2, 3], [0, 3, 1], [0, 1, 2]];

/// The corners of the facet opposite `corner`, counter-clockwise seen from that corner.
#[inline]
pub(crate) fn facet_vertices(tet: [VertexId; 4], corner: usize) -> [VertexId; 3] {
    FACET_CORNERS[corner].map(|i| tet[i])
}
