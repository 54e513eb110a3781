//! The conflict region: dig it out, and fill it with tetrahedra around the new vertex.

use super::{
    conflict::Query,
    kernel::{INFINITE, Kernel, Mark},
};
use crate::{Error, FacetId, TetId, id::facet_vertices};
use pellicle_geometry::VertexId;

/// Up to this many vertices on a cavity's boundary, edges are paired through a table with a row and a
/// column a vertex.
const MOST_TABLED_VERTICES: usize = 256;

/// A facet between the conflict region and the rest.
#[derive(Clone, Copy)]
pub(super) struct BoundaryFacet {
    /// Clockwise seen from the cavity, so that (new vertex, corners) is positive; infinity comes last.
    corners: [VertexId; 3],
    /// The facet seen from outside the cavity.
    pub(super) outer: FacetId,
}

/// Storage of the current conflict region, kept between insertions.
#[derive(Default)]
pub(super) struct Cavity {
    pub(super) conflict: Vec<TetId>,
    pub(super) boundary: Vec<BoundaryFacet>,
    /// The tetrahedra that fill the cavity: one a boundary facet.
    pub(super) filling: Vec<TetId>,
    /// The vertices of the boundary.
    vertices: Vec<VertexId>,
    /// By vertex: where it stands in `vertices`, if `vertices` agrees.
    rank: Vec<u32>,
    /// The facet of the filling at the edge from one vertex (row) to another (column).
    edges: Vec<FacetId>,
}

impl Cavity {
    pub(super) fn for_vertices(vertices: usize) -> Self {
        Self {
            rank: vec![0; vertices],
            edges: vec![FacetId::NONE; MOST_TABLED_VERTICES * MOST_TABLED_VERTICES],
            ..Self::default()
        }
    }

    /// Makes room for vertices up to this number.
    pub(super) fn make_room(&mut self, vertices: usize) {
        if self.rank.len() < vertices {
            self.rank.resize(vertices, 0);
        }
    }

    /// The rank of a boundary vertex, the next free one if it is new.
    #[inline]
    fn rank_of(&mut self, vertex: VertexId) -> usize {
        let rank = self.rank[vertex.index()] as usize;
        if self.vertices.get(rank) == Some(&vertex) {
            return rank;
        }
        self.rank[vertex.index()] = self.vertices.len() as u32;
        self.vertices.push(vertex);
        self.vertices.len() - 1
    }
}

impl Kernel {
    /// Finds all tetrahedra in conflict with `p`, breadth first from `start`, and the facets around them.
    /// The conflict region is connected and star-shaped around `p`: the signs are exact.
    #[inline(never)]
    pub(super) fn dig(&mut self, start: TetId, p: impl Query) {
        // Out of `self`, so that the conflict test may borrow it.
        let mut conflict = std::mem::take(&mut self.cavity.conflict);
        let mut boundary = std::mem::take(&mut self.cavity.boundary);
        conflict.clear();
        boundary.clear();

        debug_assert!(self.is_in_conflict(start, p));
        self.marks[start.index()] = Mark::InConflict;
        conflict.push(start);
        let mut next = 0;
        while let Some(&tet) = conflict.get(next) {
            next += 1;
            let corners = self.tets[tet.index()];
            let twins = self.twins[tet.index()];
            for (i, outer) in twins.into_iter().enumerate() {
                let neighbor = outer.tet();
                let mark = self.marks[neighbor.index()];
                if mark == Mark::InConflict {
                    continue;
                }
                if mark == Mark::Untested {
                    if self.is_in_conflict(neighbor, p) {
                        self.marks[neighbor.index()] = Mark::InConflict;
                        conflict.push(neighbor);
                        continue;
                    }
                    self.marks[neighbor.index()] = Mark::Free;
                }
                boundary.push(BoundaryFacet {
                    corners: clockwise_infinity_last(facet_vertices(corners, i)),
                    outer,
                });
            }
        }
        self.cavity.conflict = conflict;
        self.cavity.boundary = boundary;
    }

    /// Fills the cavity with a tetrahedron from `vertex` to each boundary facet.
    #[inline(never)]
    pub(super) fn retriangulate(&mut self, vertex: VertexId) -> Result<(), Error> {
        let mut cavity = std::mem::take(&mut self.cavity);
        self.vacant.append(&mut cavity.conflict);

        // 1. One tetrahedron a boundary facet, joined to the outside.
        cavity.filling.clear();
        for facet in &cavity.boundary {
            let tet = self.allocate()?;
            let [a, b, c] = facet.corners;
            self.tets[tet.index()] = [vertex, a, b, c];
            self.marks[tet.index()] = Mark::Untested;
            self.twins[tet.index()][0] = facet.outer;
            self.twins[facet.outer.tet().index()][facet.outer.corner()] = FacetId::of(tet, 0);
            self.marks[facet.outer.tet().index()] = Mark::Untested;
            cavity.filling.push(tet);
        }

        // 2. Joined to each other along the edges of the boundary, a sphere with F / 2 + 2 vertices.
        let vertices = cavity.boundary.len() / 2 + 2;
        if vertices <= MOST_TABLED_VERTICES {
            self.join_through_table(&mut cavity, vertices);
        } else {
            self.join_through_sorting(&cavity);
        }
        self.recent = cavity.filling[0];
        self.cavity = cavity;
        Ok(())
    }

    /// Facet 1 of a filling tetrahedron (v, a, b, c) holds the edge from b to c, and the neighbour there
    /// holds the edge from c to b:
    ///
    /// ```text
    ///         a
    ///        / \        facet 1 (opposite a): b → c
    ///       /   \       facet 2 (opposite b): c → a
    ///      b ——→ c      facet 3 (opposite c): a → b
    /// ```
    #[inline(never)]
    fn join_through_table(&mut self, cavity: &mut Cavity, vertices: usize) {
        cavity.vertices.clear();
        for k in 0..cavity.boundary.len() {
            let [a, b, c] = cavity.boundary[k].corners.map(|v| cavity.rank_of(v));
            let tet = cavity.filling[k];
            cavity.edges[b * vertices + c] = FacetId::of(tet, 1);
            cavity.edges[c * vertices + a] = FacetId::of(tet, 2);
            cavity.edges[a * vertices + b] = FacetId::of(tet, 3);
        }
        debug_assert_eq!(cavity.vertices.len(), vertices);
        for (facet, tet) in cavity.boundary.iter().zip(&cavity.filling) {
            let [a, b, c] = facet.corners.map(|v| cavity.rank[v.index()] as usize);
            let twins = &mut self.twins[tet.index()];
            twins[1] = cavity.edges[c * vertices + b];
            twins[2] = cavity.edges[a * vertices + c];
            twins[3] = cavity.edges[b * vertices + a];
        }
    }

    /// The same for cavities with many vertices: equal edges meet in a sorted list.
    #[cold]
    fn join_through_sorting(&mut self, cavity: &Cavity) {
        let mut edges = Vec::with_capacity(3 * cavity.boundary.len());
        for (facet, &tet) in cavity.boundary.iter().zip(&cavity.filling) {
            let [a, b, c] = facet.corners;
            for (from, to, corner) in [(b, c, 1), (c, a, 2), (a, b, 3)] {
                edges.push((from.min(to), from.max(to), FacetId::of(tet, corner)));
            }
        }
        edges.sort_unstable();
        for pair in edges.chunks_exact(2) {
            let (one, other) = (pair[0].2, pair[1].2);
            debug_assert_eq!((pair[0].0, pair[0].1), (pair[1].0, pair[1].1));
            self.twins[one.tet().index()][one.corner()] = other;
            self.twins[other.tet().index()][other.corner()] = one;
        }
    }
}

/// Turns a facet that is counter-clockwise seen from inside around, with the vertex at infinity, if it is
/// one of them, last.
#[inline]
fn clockwise_infinity_last([a, b, c]: [VertexId; 3]) -> [VertexId; 3] {
    if a == INFINITE {
        [c, b, a]
    } else if b == INFINITE {
        [a, c, b]
    } else {
        [b, a, c]
    }
}
