//! What one can ask between two changes.

use super::DynamicTetrahedralization;
use crate::{
    AroundEdge, AroundVertex, FacetId, Location, TetId, VoronoiCell, VoronoiEdge, VoronoiFacet,
    VoronoiVertex, circulate, connectivity::Connectivity, id::facet_vertices, locate, voronoi,
};
use pellicle_geometry::{DVec3, VertexId};
use pellicle_predicates::{compare_distance, lifted::lexicographic};

/// Ids of tetrahedra are those of now: an insertion or removal may take a tetrahedron away and give its id to
/// another.
impl DynamicTetrahedralization {
    /// All tetrahedra, finite and infinite.
    pub fn tets(&self) -> impl Iterator<Item = TetId> + '_ {
        (0..self.kernel.tet_slots())
            .map(TetId::new)
            .filter(|&tet| self.kernel.is_in_use(tet))
    }

    /// The finite tetrahedra.
    pub fn finite_tets(&self) -> impl Iterator<Item = TetId> + '_ {
        self.tets().filter(|&tet| self.is_finite(tet))
    }

    /// The infinite tetrahedra: one a facet of the convex hull.
    pub fn infinite_tets(&self) -> impl Iterator<Item = TetId> + '_ {
        self.tets().filter(|&tet| !self.is_finite(tet))
    }

    /// The four corners of a tetrahedron, positively oriented.
    #[inline]
    pub fn tet(&self, tet: TetId) -> [VertexId; 4] {
        self.corners(tet)
    }

    /// Whether none of the tetrahedron's corners is at infinity.
    #[inline]
    pub fn is_finite(&self, tet: TetId) -> bool {
        self.has_four_points(tet)
    }

    /// The same facet seen from the other side.
    #[inline]
    pub fn twin(&self, facet: FacetId) -> FacetId {
        self.kernel.twin(facet)
    }

    /// The three vertices of a facet, counter-clockwise seen from its tetrahedron.
    #[inline]
    pub fn facet(&self, facet: FacetId) -> [VertexId; 3] {
        facet_vertices(self.tet(facet.tet()), facet.corner())
    }

    /// A finite tetrahedron at the vertex. `None` if the id names no vertex, and while the points are flat.
    #[inline]
    pub fn incident(&self, vertex: VertexId) -> Option<TetId> {
        self.tet_at(vertex)
    }

    /// As [`Tetrahedralization::locate`](crate::Tetrahedralization::locate); `None` also while the points
    /// are flat. Without a hint the walk starts at the nearest of 8 n^(1/4) vertices drawn at random and
    /// one of the last step.
    pub fn locate(&self, point: DVec3, hint: Option<VertexId>) -> Option<Location> {
        locate::locate(self, point, hint)
    }

    /// As [`Tetrahedralization::nearest_vertex`](crate::Tetrahedralization::nearest_vertex); `None` only
    /// without vertices and for a point that is not finite. Linear in the number of vertices while these are
    /// flat.
    ///
    /// ```
    /// # use pellicle_delaunay::DynamicTetrahedralization;
    /// # use pellicle_geometry::DVec3;
    /// let mut tetrahedralization = DynamicTetrahedralization::new();
    /// assert_eq!(tetrahedralization.nearest_vertex(DVec3::ZERO, None), None);
    /// tetrahedralization.insert(DVec3::X)?;
    /// let near = tetrahedralization.insert(DVec3::Y * 0.5)?;
    /// assert_eq!(tetrahedralization.nearest_vertex(DVec3::ZERO, None), Some(near));
    /// # Ok::<(), pellicle_delaunay::Error>(())
    /// ```
    pub fn nearest_vertex(&self, point: DVec3, hint: Option<VertexId>) -> Option<VertexId> {
        if self.flat.is_none() {
            return locate::nearest_vertex(self, point, hint);
        }
        let by_distance = |one: &(VertexId, DVec3), other: &(VertexId, DVec3)| {
            compare_distance(point, one.1, other.1).then_with(|| lexicographic(one.1, other.1))
        };
        let nearest = self
            .present()
            .filter(|_| point.is_finite())
            .min_by(by_distance);
        nearest.map(|(vertex, _)| vertex)
    }

    /// As [`Tetrahedralization::around_edge`](crate::Tetrahedralization::around_edge).
    pub fn around_edge(
        &self,
        tet: TetId,
        from: VertexId,
        to: VertexId,
    ) -> Option<AroundEdge<'_, Self>> {
        let tet = self.kernel.is_in_use(tet).then_some(tet)?;
        AroundEdge::new(self, tet, from, to)
    }

    /// As [`Tetrahedralization::around_vertex`](crate::Tetrahedralization::around_vertex).
    pub fn around_vertex(&self, vertex: VertexId) -> AroundVertex<'_, Self> {
        AroundVertex::new(self, vertex)
    }

    /// As [`Tetrahedralization::neighbors`](crate::Tetrahedralization::neighbors); none while the points are
    /// flat.
    pub fn neighbors(&self, vertex: VertexId) -> Vec<VertexId> {
        circulate::neighbors(self, vertex)
    }

    /// As [`Tetrahedralization::tet_at_edge`](crate::Tetrahedralization::tet_at_edge).
    pub fn tet_at_edge(&self, from: VertexId, to: VertexId) -> Option<TetId> {
        circulate::tet_at_edge(self, from, to)
    }

    /// As [`Tetrahedralization::voronoi_vertex`](crate::Tetrahedralization::voronoi_vertex).
    pub fn voronoi_vertex(&self, tet: TetId) -> VoronoiVertex {
        voronoi::voronoi_vertex(self, tet)
    }

    /// As [`Tetrahedralization::voronoi_edge`](crate::Tetrahedralization::voronoi_edge).
    pub fn voronoi_edge(&self, facet: FacetId) -> VoronoiEdge {
        voronoi::voronoi_edge(self, facet)
    }

    /// As [`Tetrahedralization::voronoi_facet`](crate::Tetrahedralization::voronoi_facet).
    pub fn voronoi_facet(&self, tet: TetId, from: VertexId, to: VertexId) -> Option<VoronoiFacet> {
        let tet = self.kernel.is_in_use(tet).then_some(tet)?;
        voronoi::voronoi_facet(self, tet, from, to)
    }

    /// As [`Tetrahedralization::voronoi_cell`](crate::Tetrahedralization::voronoi_cell); `None` also while
    /// the points are flat.
    pub fn voronoi_cell(&self, vertex: VertexId) -> Option<VoronoiCell> {
        voronoi::voronoi_cell(self, vertex)
    }

    /// The Voronoi cells of all vertices, by id; none while the points are flat.
    pub fn voronoi_cells(&self) -> impl Iterator<Item = VoronoiCell> + '_ {
        self.vertices()
            .filter_map(|vertex| self.voronoi_cell(vertex))
    }
}
