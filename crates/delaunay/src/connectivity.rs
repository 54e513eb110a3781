//! What circulators, point location and the Voronoi dual need of a tetrahedralisation, borrowed or owned.

use crate::{FacetId, TetId, Tetrahedralization, id::facet_vertices};
use pellicle_geometry::{DVec3, VertexId};

/// Corners, twins, points and one tetrahedron a vertex. An infinite tetrahedron has `VertexId::NONE` as its
/// corner 3.
pub trait Connectivity {
    /// The four corners of a tetrahedron.
    fn corners(&self, tet: TetId) -> [VertexId; 4];

    /// The same facet seen from the other side.
    fn other_side(&self, facet: FacetId) -> FacetId;

    /// The point at an id below [`vertex_limit`](Self::vertex_limit); not a number if that names no vertex now.
    fn position(&self, vertex: VertexId) -> DVec3;

    /// A finite tetrahedron at the vertex. `None` for the vertex at infinity, for ids out of range, and for
    /// ids that name no vertex now.
    fn tet_at(&self, vertex: VertexId) -> Option<TetId>;

    /// Vertex ids, that at infinity excepted, are below this number.
    fn vertex_limit(&self) -> usize;

    /// Some tetrahedron; `None` where there is none.
    fn any_tet(&self) -> Option<TetId>;

    /// Whether none of the tetrahedron's corners is at infinity.
    #[inline]
    fn has_four_points(&self, tet: TetId) -> bool {
        self.corners(tet)[3] != VertexId::NONE
    }

    /// Where `vertex` stands among the corners of `tet`.
    #[inline]
    fn place_of(&self, tet: TetId, vertex: VertexId) -> Option<usize> {
        self.corners(tet)
            .iter()
            .position(|&corner| corner == vertex)
    }

    /// The points of a facet without the vertex at infinity, counter-clockwise seen from `tet`.
    #[inline]
    fn facet_points(&self, tet: TetId, corner: usize) -> [DVec3; 3] {
        facet_vertices(self.corners(tet), corner).map(|vertex| self.position(vertex))
    }
}

impl Connectivity for Tetrahedralization<'_> {
    #[inline]
    fn corners(&self, tet: TetId) -> [VertexId; 4] {
        self.tet(tet)
    }

    #[inline]
    fn other_side(&self, facet: FacetId) -> FacetId {
        self.twin(facet)
    }

    #[inline]
    fn position(&self, vertex: VertexId) -> DVec3 {
        self.points()[vertex.index()]
    }

    #[inline]
    fn tet_at(&self, vertex: VertexId) -> Option<TetId> {
        self.incident(vertex)
    }

    #[inline]
    fn vertex_limit(&self) -> usize {
        self.points().len()
    }

    #[inline]
    fn any_tet(&self) -> Option<TetId> {
        Some(TetId(0))
    }
}
