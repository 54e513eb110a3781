//! The Voronoi dual: vertices, edges, facets and cells, unbounded ones included.
//!
//! | Delaunay | Voronoi |
//! |---|---|
//! | finite tetrahedron | vertex: its circumcentre |
//! | infinite tetrahedron | vertex at infinity: the outward normal of its hull facet |
//! | facet | edge between the vertices of its two tetrahedra |
//! | edge | facet: the polygon of the vertices around the edge |
//! | vertex | cell |

use crate::{
    AroundEdge, AroundVertex, FacetId, TetId, Tetrahedralization, circumcenter::circumcenter,
    connectivity::Connectivity,
};
use pellicle_geometry::{DVec3, VertexId, triangle};

/// A Voronoi vertex.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum VoronoiVertex {
    /// The circumcentre of a finite tetrahedron.
    Finite(DVec3),
    /// A unit direction: outward from the hull facet of an infinite tetrahedron, or of a tetrahedron so
    /// flat that its circumcentre exceeds the range of doubles.
    Infinite(DVec3),
}

/// A Voronoi edge: a segment, or a ray where one end is infinite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VoronoiEdge {
    /// The Delaunay facet it is dual to.
    pub facet: FacetId,
    /// The vertex of the facet's own tetrahedron, then that of its twin's.
    pub ends: [VoronoiVertex; 2],
}

/// A Voronoi facet: the polygon around a Delaunay edge.
#[derive(Clone, Debug, PartialEq)]
pub struct VoronoiFacet {
    /// The Delaunay edge that it bisects at a right angle.
    pub edge: [VertexId; 2],
    /// Its vertices, counter-clockwise seen from the second vertex of the edge looking at the first.
    pub vertices: Vec<VoronoiVertex>,
}

impl VoronoiFacet {
    /// Whether none of its vertices is infinite.
    pub fn is_bounded(&self) -> bool {
        self.vertices
            .iter()
            .all(|vertex| matches!(vertex, VoronoiVertex::Finite(_)))
    }
}

/// The Voronoi cell of a vertex: the part of space that is nearer to it than to any other.
#[derive(Clone, Debug, PartialEq)]
pub struct VoronoiCell {
    /// The vertex at whose point the cell lies.
    pub vertex: VertexId,
    /// Its facets, one a Delaunay neighbour, in the order of the neighbours' ids.
    pub facets: Vec<VoronoiFacet>,
}

impl VoronoiCell {
    /// Whether the cell is bounded: its vertex is not on the convex hull.
    pub fn is_bounded(&self) -> bool {
        self.facets.iter().all(VoronoiFacet::is_bounded)
    }
}

impl Tetrahedralization<'_> {
    /// The Voronoi vertex dual to a tetrahedron.
    ///
    /// Accurate for slivers too, as far as doubles can be: decisions must not hang on it all the same, since
    /// the circumcentre of a sliver moves far when a point moves a little.
    pub fn voronoi_vertex(&self, tet: TetId) -> VoronoiVertex {
        voronoi_vertex(self, tet)
    }

    /// The finite Voronoi vertices with the tetrahedra they are dual to.
    pub fn voronoi_vertices(&self) -> impl Iterator<Item = (TetId, VoronoiVertex)> + '_ {
        (0..self.finite_count()).map(|t| (TetId::new(t), self.voronoi_vertex(TetId::new(t))))
    }

    /// The Voronoi edge dual to a facet.
    pub fn voronoi_edge(&self, facet: FacetId) -> VoronoiEdge {
        voronoi_edge(self, facet)
    }

    /// All Voronoi edges, each once: bounded ones and rays.
    pub fn voronoi_edges(&self) -> impl Iterator<Item = VoronoiEdge> + '_ {
        self.facets().map(|facet| self.voronoi_edge(facet))
    }

    /// The Voronoi edges that are rays: one a facet of the convex hull, its finite end first.
    pub fn unbounded_voronoi_edges(&self) -> impl Iterator<Item = VoronoiEdge> + '_ {
        (self.finite_count()..self.tets().len())
            .map(|t| self.voronoi_edge(self.twin(FacetId::of(TetId::new(t), 3))))
    }

    /// The Voronoi facet dual to the edge between two vertices of `tet`; `None` where `tet` does not hold
    /// both.
    pub fn voronoi_facet(&self, tet: TetId, from: VertexId, to: VertexId) -> Option<VoronoiFacet> {
        voronoi_facet(self, tet, from, to)
    }

    /// The Voronoi cell of a vertex; that of its representative for a duplicate. Linear in the number of
    /// tetrahedra at the vertex, up to a logarithm. `None` for the vertex at infinity and ids out of range.
    pub fn voronoi_cell(&self, vertex: VertexId) -> Option<VoronoiCell> {
        voronoi_cell(self, self.representative(vertex))
    }

    /// The Voronoi cells of all vertices, duplicates excepted.
    pub fn voronoi_cells(&self) -> impl Iterator<Item = VoronoiCell> + '_ {
        (0..self.points().len())
            .map(VertexId::new)
            .filter(|&vertex| self.representative(vertex) == vertex)
            .filter_map(|vertex| self.voronoi_cell(vertex))
    }
}

/// See [`Tetrahedralization::voronoi_vertex`].
pub(crate) fn voronoi_vertex<T: Connectivity>(among: &T, tet: TetId) -> VoronoiVertex {
    if among.has_four_points(tet) {
        let [a, b, c, d] = among.corners(tet).map(|vertex| among.position(vertex));
        if let Some(center) = circumcenter(a, b, c, d) {
            return VoronoiVertex::Finite(center);
        }
    }
    // Facet 3 seen from its infinite tetrahedron: counter-clockwise from outside; zero without area.
    let [a, b, c] = among.facet_points(tet, 3);
    VoronoiVertex::Infinite(triangle::unit_normal(a, b, c).unwrap_or(DVec3::ZERO))
}

/// See [`Tetrahedralization::voronoi_edge`].
pub(crate) fn voronoi_edge<T: Connectivity>(among: &T, facet: FacetId) -> VoronoiEdge {
    VoronoiEdge {
        facet,
        ends: [facet, among.other_side(facet)].map(|side| voronoi_vertex(among, side.tet())),
    }
}

/// See [`Tetrahedralization::voronoi_facet`].
pub(crate) fn voronoi_facet<T: Connectivity>(
    among: &T,
    tet: TetId,
    from: VertexId,
    to: VertexId,
) -> Option<VoronoiFacet> {
    let around = AroundEdge::new(among, tet, from, to)?;
    Some(VoronoiFacet {
        edge: [from, to],
        vertices: around.map(|(tet, _)| voronoi_vertex(among, tet)).collect(),
    })
}

/// See [`Tetrahedralization::voronoi_cell`].
pub(crate) fn voronoi_cell<T: Connectivity>(among: &T, vertex: VertexId) -> Option<VoronoiCell> {
    among.tet_at(vertex)?;
    let mut neighbors: Vec<(VertexId, TetId)> = AroundVertex::new(among, vertex)
        .flat_map(|tet| among.corners(tet).map(|corner| (corner, tet)))
        .filter(|&(corner, _)| corner != vertex && corner != VertexId::NONE)
        .collect();
    neighbors.sort_unstable();
    neighbors.dedup_by_key(|&mut (corner, _)| corner);
    let facets = neighbors
        .into_iter()
        .filter_map(|(neighbor, tet)| voronoi_facet(among, tet, vertex, neighbor))
        .collect();
    Some(VoronoiCell { vertex, facets })
}
