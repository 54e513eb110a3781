//! The tetrahedralisation under ids of our own: local in memory, and the same for every order of the
//! caller's points.

use glam::DVec3;
use pellicle_delaunay::{FACET_CORNERS, FacetId, TetId, Tetrahedralization};
use pellicle_geometry::{Aabb, VertexId};

/// A tetrahedralisation whose vertices are numbered as its tetrahedra first name them.
pub(crate) struct Canonical<'a> {
    tetrahedralization: &'a Tetrahedralization<'a>,
    /// By canonical id, the caller's.
    vertices: Vec<VertexId>,
    /// By canonical id, the point: as the caller has it, times a power of two where coordinates are so large
    /// or small that squares of lengths would leave the range of doubles.
    points: Vec<DVec3>,
    /// Four canonical ids each.
    tets: Vec<[VertexId; 4]>,
}

impl<'a> Canonical<'a> {
    /// The vertex at infinity.
    pub(crate) const INFINITE: VertexId = Tetrahedralization::INFINITE;

    pub(crate) fn of(tetrahedralization: &'a Tetrahedralization<'a>) -> Self {
        let mut canonical = vec![VertexId::NONE; tetrahedralization.points().len()];
        let mut vertices = Vec::with_capacity(tetrahedralization.vertex_count());
        let mut number = |vertex: VertexId| {
            if vertex == Self::INFINITE {
                return vertex;
            }
            let id = &mut canonical[vertex.index()];
            if *id == VertexId::NONE {
                *id = VertexId::new(vertices.len());
                vertices.push(vertex);
            }
            *id
        };
        let tets = tetrahedralization.tets();
        let tets = tets
            .iter()
            .map(|&[a, b, c, d]| [number(a), number(b), number(c), number(d)])
            .collect();
        let scale = power_of_two_scale(tetrahedralization.points());
        let points = vertices
            .iter()
            .map(|v| tetrahedralization.points()[v.index()] * scale)
            .collect();
        Self {
            tetrahedralization,
            vertices,
            points,
            tets,
        }
    }

    /// The caller's points, by the caller's ids.
    pub(crate) fn original_points(&self) -> &'a [DVec3] {
        self.tetrahedralization.points()
    }

    pub(crate) fn points(&self) -> &[DVec3] {
        &self.points
    }

    #[inline]
    pub(crate) fn point(&self, vertex: VertexId) -> DVec3 {
        self.points[vertex.index()]
    }

    /// The caller's id.
    pub(crate) fn original(&self, vertex: VertexId) -> VertexId {
        self.vertices[vertex.index()]
    }

    pub(crate) fn vertex_count(&self) -> usize {
        self.vertices.len()
    }

    pub(crate) fn vertex_ids(&self) -> impl Iterator<Item = VertexId> + use<> {
        (0..self.vertices.len()).map(VertexId::new)
    }

    pub(crate) fn tets(&self) -> &[[VertexId; 4]] {
        &self.tets
    }

    #[inline]
    pub(crate) fn is_finite(&self, tet: TetId) -> bool {
        self.tetrahedralization.is_finite(tet)
    }

    pub(crate) fn finite_count(&self) -> usize {
        self.tetrahedralization.finite_count()
    }

    #[inline]
    pub(crate) fn twin(&self, facet: FacetId) -> FacetId {
        self.tetrahedralization.twin(facet)
    }

    #[inline]
    pub(crate) fn twins(&self, tet: TetId) -> [FacetId; 4] {
        self.tetrahedralization.twins()[tet.index()]
    }

    /// The vertices of a facet, counter-clockwise seen from its tetrahedron.
    #[inline]
    pub(crate) fn facet(&self, facet: FacetId) -> [VertexId; 3] {
        let tet = self.tets[facet.tet().index()];
        let [a, b, c] = FACET_CORNERS[facet.corner()];
        [tet[a], tet[b], tet[c]]
    }

    /// Where a vertex stands in a tetrahedron that has it.
    #[inline]
    pub(crate) fn corner_of(&self, tet: TetId, vertex: VertexId) -> usize {
        let tet = self.tets[tet.index()];
        // Without a branch for the fourth: the vertex is one of the four.
        (0..3).find(|&i| tet[i] == vertex).unwrap_or(3)
    }

    /// Every facet with three finite vertices, once, seen from the tetrahedron with the lower id.
    pub(crate) fn facets(&self) -> impl Iterator<Item = FacetId> + '_ {
        self.tetrahedralization.facets()
    }

    /// Those of [`Canonical::facets`] that are seen from a finite tetrahedron.
    #[inline]
    pub(crate) fn for_facets_of(&self, tet: TetId, mut see: impl FnMut(FacetId)) {
        let twins = self.twins(tet);
        for (corner, twin) in twins.iter().enumerate() {
            if tet < twin.tet() {
                see(FacetId::of(tet, corner));
            }
        }
    }

    /// A finite tetrahedron at the vertex.
    pub(crate) fn incident(&self, vertex: VertexId) -> Option<TetId> {
        self.tetrahedralization.incident(self.original(vertex))
    }

    /// All tetrahedra at a vertex, infinite ones included.
    pub(crate) fn around_vertex(&self, vertex: VertexId) -> impl Iterator<Item = TetId> + '_ {
        self.tetrahedralization.around_vertex(self.original(vertex))
    }

    /// The facet sides met when turning around an edge of `facet` from its tetrahedron on, away from the
    /// facet itself, which comes last, seen from behind:
    ///
    /// ```text
    ///            w                 the edge (u, v) upright at o, the facet (u, v, w);
    ///            |  σ              first the other facet of σ at the edge, seen from σ,
    ///            o———·  1st        then that of the neighbour beyond it, and so on around
    ///          / ·
    ///       3rd   2nd
    /// ```
    pub(crate) fn around_edge(&self, facet: FacetId, opposite: VertexId) -> AroundEdge<'_, 'a> {
        AroundEdge {
            canonical: self,
            next: Some((facet.tet(), opposite, facet.corner())),
            last: self.twin(facet),
        }
    }
}

/// See [`Canonical::around_edge`].
pub(crate) struct AroundEdge<'c, 'a> {
    canonical: &'c Canonical<'a>,
    /// The tetrahedron, its vertex opposite the facet to come, and its corner opposite the facet behind.
    next: Option<(TetId, VertexId, usize)>,
    last: FacetId,
}

impl Iterator for AroundEdge<'_, '_> {
    type Item = FacetId;

    #[inline]
    fn next(&mut self) -> Option<FacetId> {
        let (tet, opposite, behind) = self.next?;
        let out = FacetId::of(tet, self.canonical.corner_of(tet, opposite));
        self.next = (out != self.last).then(|| {
            // The third vertex of `out` is the one that was opposite the facet behind.
            let third = self.canonical.tets[tet.index()][behind];
            let twin = self.canonical.twin(out);
            (twin.tet(), third, twin.corner())
        });
        Some(out)
    }
}

/// 1, or a power of two that brings coordinates near 1 where squares and cubes of them would overflow or
/// underflow.
fn power_of_two_scale(points: &[DVec3]) -> f64 {
    let bounds = Aabb::of_points(points);
    let largest = bounds.min.abs().max(bounds.max.abs()).max_element();
    let side = (bounds.max * 0.5 - bounds.min * 0.5).max_element();
    if largest < 1e60 && side > 1e-60 {
        1.0
    } else {
        // Clamped: denormals are scaled as far as a double's exponent allows.
        (-side.log2().floor()).clamp(-1020.0, 1020.0).exp2()
    }
}
