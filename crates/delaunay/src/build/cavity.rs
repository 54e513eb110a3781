//! The conflict region: dig it out, and fill it with tetrahedra around the new vertex.

use super::{
    cells::{AT_REST, Cells, IN_CONFLICT, KEPT, four},
    conflict::Query,
    kernel::Kernel,
    worker::Worker,
};
use crate::{FacetId, TetId, id::FACET_CORNERS};
use pellicle_geometry::VertexId;
use pellicle_predicates::lanes::Registers;

/// Up to this many vertices on a cavity's boundary, edges are paired through a table with a row and a
/// column a vertex.
const MOST_TABLED_VERTICES: usize = 256;

/// Entries between the rows of the table: a little more than a row, so that rows do not share the same
/// places of the cache.
const ROW: usize = MOST_TABLED_VERTICES + 16;

/// A facet between the conflict region and the rest.
#[derive(Clone, Copy)]
struct BoundaryFacet {
    /// Clockwise seen from the cavity, so that (new vertex, corners) is positive.
    corners: [VertexId; 3],
    /// The facet seen from outside the cavity.
    outer: FacetId,
}

impl BoundaryFacet {
    const NONE: Self = Self {
        corners: [VertexId::NONE; 3],
        outer: FacetId::NONE,
    };
}

/// Storage of the current conflict region, kept between insertions.
pub(super) struct Cavity {
    /// The tetrahedra in conflict, and room for more.
    conflict: Vec<TetId>,
    conflict_count: usize,
    /// The facets around them, and room for more.
    boundary: Vec<BoundaryFacet>,
    boundary_count: usize,
    ranking: Ranking,
    /// By boundary facet, its corners' ranks.
    ranks: Vec<[u8; 4]>,
    /// The facet of the filling at the edge from one vertex (row) to another (column).
    edges: Box<[FacetId; MOST_TABLED_VERTICES * ROW]>,
}

impl Cavity {
    pub(super) fn for_vertices(vertices: usize) -> Self {
        Self {
            conflict: Vec::new(),
            conflict_count: 0,
            boundary: Vec::new(),
            boundary_count: 0,
            ranking: Ranking::for_vertices(vertices),
            ranks: Vec::new(),
            edges: vec![FacetId::NONE; MOST_TABLED_VERTICES * ROW]
                .try_into()
                .expect("the vector has the length of the array"),
        }
    }

    /// Makes room for vertices up to this number.
    pub(super) fn make_room_for_vertices(&mut self, vertices: usize) {
        let rank = &mut self.ranking.rank;
        rank.resize(vertices.max(rank.len()), 0);
    }

    /// Forgets the last conflict region.
    fn clear(&mut self) {
        self.conflict_count = 0;
        self.boundary_count = 0;
    }

    /// The tetrahedra in conflict; after they were replaced, those in their place.
    pub(super) fn conflict(&self) -> &[TetId] {
        &self.conflict[..self.conflict_count]
    }

    fn push_conflict(&mut self, tet: TetId) {
        self.make_room();
        self.conflict[self.conflict_count] = tet;
        self.conflict_count += 1;
    }

    /// The neighbour opposite corner `I` of a tetrahedron in conflict: to the conflict region, or the facet there to the
    /// boundary, as bit `I` of `inside` and `outside` say. (A closure in its place would not surely be inlined.)
    #[inline(always)]
    fn sort_in<const I: usize>(
        &mut self,
        cells: &Cells,
        corners: [VertexId; 4],
        twins: [FacetId; 4],
        marks: [u8; 4],
        inside: u8,
        outside: u8,
    ) {
        let [a, b, c] = FACET_CORNERS[I];
        self.boundary[self.boundary_count] = BoundaryFacet {
            corners: [corners[b], corners[a], corners[c]],
            outer: twins[I],
        };
        self.boundary_count += usize::from(outside >> I & 1);
        let neighbor = twins[I].tet();
        let is_inside = inside >> I & 1 == 1;
        cells.set_mark(neighbor, if is_inside { IN_CONFLICT } else { marks[I] });
        cells.prefetch_twins(neighbor);
        self.conflict[self.conflict_count] = neighbor;
        self.conflict_count += usize::from(is_inside);
    }

    /// How many tetrahedra the filling has more than the conflict region.
    #[inline(always)]
    pub(super) fn growth(&self) -> usize {
        self.boundary_count.saturating_sub(self.conflict_count)
    }

    /// Room for four more of each kind.
    #[inline(always)]
    fn make_room(&mut self) {
        if self.conflict_count + 4 > self.conflict.len()
            || self.boundary_count + 4 > self.boundary.len()
        {
            self.make_more_room();
        }
    }

    #[cold]
    fn make_more_room(&mut self) {
        let conflict = 2 * self.conflict.len() + 64;
        self.conflict.resize(conflict, TetId::NONE);
        let boundary = 2 * self.boundary.len() + 64;
        self.boundary.resize(boundary, BoundaryFacet::NONE);
    }
}

impl Worker {
    /// Finds all tetrahedra in conflict with a point, breadth first from `start`, and the facets around them;
    /// marks them. The conflict region is connected and star-shaped around it: the signs are exact.
    ///
    /// False when another worker holds one of the tetrahedra to be looked at; then what is marked must be released.
    ///
    /// Whether a neighbour is in conflict is as good as random, so the inner loop has no branch on it: it
    /// writes what may be needed, and counts what is.
    #[inline(always)]
    pub(super) fn dig<const SHARED: bool, R: Registers>(
        &mut self,
        registers: R,
        kernel: &Kernel,
        start: TetId,
        query: impl Query,
    ) -> bool {
        let cells = &kernel.cells;
        let held = &mut self.held;
        let cavity = &mut self.cavity;
        cavity.clear();
        cavity.push_conflict(start);
        let mut next = 0;
        while next < cavity.conflict_count {
            let tet = cavity.conflict[next];
            next += 1;
            if next + 1 < cavity.conflict_count {
                let twins = cells.twins(cavity.conflict[next + 1]);
                four(|i| cells.prefetch_corners(twins[i].tet()));
            }
            let corners = cells.corners(tet);
            let twins = cells.twins(tet);
            if SHARED {
                let is_held = held.hold(&kernel.blocks, twins[0].tet())
                    && held.hold(&kernel.blocks, twins[1].tet())
                    && held.hold(&kernel.blocks, twins[2].tet())
                    && held.hold(&kernel.blocks, twins[3].tet());
                if !is_held {
                    return false;
                }
            }
            let marks = four(|i| cells.mark(twins[i].tet()));
            let [a, b, c, d] = four(|i| u8::from(marks[i] != IN_CONFLICT) << i);
            let untested = a | b | c | d;
            if untested == 0 {
                continue;
            }
            let inside = kernel.are_in_conflict(registers, corners, twins, untested, query);
            let outside = untested & !inside;
            cavity.make_room();
            cavity.sort_in::<0>(cells, corners, twins, marks, inside, outside);
            cavity.sort_in::<1>(cells, corners, twins, marks, inside, outside);
            cavity.sort_in::<2>(cells, corners, twins, marks, inside, outside);
            cavity.sort_in::<3>(cells, corners, twins, marks, inside, outside);
        }
        true
    }

    /// Whether the worker holds all that is written to: the conflict region, what is around it, and slots reserved.
    pub(super) fn holds_cavity(&self, kernel: &Kernel) -> bool {
        let outer = self.cavity.boundary[..self.cavity.boundary_count].iter();
        let reserved = self.kept.len().saturating_sub(self.cavity.growth());
        let mut slots = outer
            .map(|facet| facet.outer.tet())
            .chain(self.cavity.conflict().iter().copied())
            .chain(self.kept[reserved..].iter().copied());
        slots.all(|slot| self.held.holds(&kernel.blocks, slot))
    }

    /// Gives the conflict region back as it was.
    #[cold]
    pub(super) fn release(&mut self, kernel: &Kernel) {
        for &tet in self.cavity.conflict() {
            kernel.cells.set_mark(tet, AT_REST);
        }
    }

    /// Fills the cavity with a tetrahedron from `vertex` to each boundary facet. The slots of the conflict
    /// region are taken first, then those that were reserved.
    #[inline(always)]
    pub(super) fn retriangulate(&mut self, kernel: &Kernel, vertex: VertexId) {
        let cavity = &mut self.cavity;
        while cavity.conflict_count > cavity.boundary_count {
            cavity.conflict_count -= 1;
            let tet = cavity.conflict[cavity.conflict_count];
            kernel.cells.set_mark(tet, KEPT);
            self.kept.push(tet);
        }
        while cavity.conflict_count < cavity.boundary_count {
            let tet = self.kept.pop().expect("slots were reserved");
            kernel.cells.set_mark(tet, IN_CONFLICT);
            cavity.push_conflict(tet);
        }
        // The boundary is a sphere with F facets and F / 2 + 2 vertices.
        if cavity.boundary_count / 2 + 2 <= MOST_TABLED_VERTICES {
            cavity.join_through_table(kernel, vertex);
        } else {
            cavity.join_through_sorting(kernel, vertex);
        }
        for &tet in cavity.conflict() {
            kernel.cells.set_mark(tet, AT_REST);
        }
        self.recent = cavity.conflict[0];
    }
}

impl Cavity {
    /// Facet 1 of a filling tetrahedron (v, a, b, c) holds the edge from b to c, and the neighbour there
    /// holds the edge from c to b:
    ///
    /// ```text
    ///         a
    ///        / \        facet 1 (opposite a): b → c
    ///       /   \       facet 2 (opposite b): c → a
    ///      b ——→ c      facet 3 (opposite c): a → b
    /// ```
    #[inline(always)]
    fn join_through_table(&mut self, kernel: &Kernel, vertex: VertexId) {
        self.ranking.clear();
        let count = self.boundary_count;
        if self.ranks.len() < count {
            self.ranks.resize(self.boundary.len(), [0; 4]);
        }
        let edges = &mut *self.edges;
        let edge = |from: u8, to: u8| usize::from(from) * ROW + usize::from(to);
        let boundary = &mut self.boundary[..count];
        let filling = &self.conflict[..count];
        let ranks = &mut self.ranks[..count];
        for ((facet, &tet), ranks) in boundary.iter_mut().zip(filling).zip(&mut *ranks) {
            facet.corners = least_last(facet.corners);
            let [a, b, c] = facet.corners;
            let a = self.ranking.rank_of(a);
            let b = self.ranking.rank_of(b);
            let c = self.ranking.rank_of(c);
            *ranks = [a, b, c, 0];
            edges[edge(b, c)] = FacetId::of(tet, 1);
            edges[edge(c, a)] = FacetId::of(tet, 2);
            edges[edge(a, b)] = FacetId::of(tet, 3);
        }
        debug_assert_eq!(self.ranking.count, count / 2 + 2);
        for ((facet, &tet), &[a, b, c, _]) in boundary.iter().zip(filling).zip(&*ranks) {
            let [x, y, z] = facet.corners;
            kernel.cells.set(
                tet,
                [vertex, x, y, z],
                [
                    facet.outer,
                    edges[edge(c, b)],
                    edges[edge(a, c)],
                    edges[edge(b, a)],
                ],
                IN_CONFLICT,
            );
            kernel.cells.set_twin(facet.outer, FacetId::of(tet, 0));
        }
    }

    /// The same for cavities with many vertices: equal edges meet in a sorted list.
    #[cold]
    fn join_through_sorting(&mut self, kernel: &Kernel, vertex: VertexId) {
        let boundary = &self.boundary[..self.boundary_count];
        let mut edges = Vec::with_capacity(3 * boundary.len());
        for (facet, &tet) in boundary.iter().zip(&self.conflict) {
            let [a, b, c] = least_last(facet.corners);
            kernel
                .cells
                .set(tet, [vertex, a, b, c], [facet.outer; 4], IN_CONFLICT);
            kernel.cells.set_twin(facet.outer, FacetId::of(tet, 0));
            for (from, to, corner) in [(b, c, 1), (c, a, 2), (a, b, 3)] {
                edges.push((from.min(to), from.max(to), FacetId::of(tet, corner)));
            }
        }
        edges.sort_unstable();
        for pair in edges.chunks_exact(2) {
            let (one, other) = (pair[0].2, pair[1].2);
            debug_assert_eq!((pair[0].0, pair[0].1), (pair[1].0, pair[1].1));
            kernel.cells.set_twin(one, other);
            kernel.cells.set_twin(other, one);
        }
    }
}

/// Numbers the vertices of a cavity's boundary from 0.
struct Ranking {
    /// By vertex: its rank, if `vertices` agrees.
    rank: Vec<u8>,
    /// By rank.
    vertices: Box<[VertexId; MOST_TABLED_VERTICES]>,
    count: usize,
}

impl Ranking {
    fn for_vertices(vertices: usize) -> Self {
        Self {
            rank: vec![0; vertices],
            vertices: Box::new([VertexId::NONE; MOST_TABLED_VERTICES]),
            count: 0,
        }
    }

    #[inline(always)]
    fn clear(&mut self) {
        self.count = 0;
    }

    /// Without a branch: which vertices are new is as good as random.
    #[inline(always)]
    fn rank_of(&mut self, vertex: VertexId) -> u8 {
        let slot = &mut self.rank[vertex.index()];
        let rank = *slot;
        let is_known =
            (self.vertices[usize::from(rank)] == vertex) & (usize::from(rank) < self.count);
        let rank = if is_known { rank } else { self.count as u8 };
        *slot = rank;
        self.vertices[usize::from(rank)] = vertex;
        self.count += usize::from(!is_known);
        rank
    }
}

/// Turns a triangle so that its least vertex, that at infinity if it is there, comes last.
#[inline(always)]
fn least_last([a, b, c]: [VertexId; 3]) -> [VertexId; 3] {
    let is_a = (a < b) & (a < c);
    let is_b = (b < a) & (b < c);
    let pick = |if_a, if_b, otherwise| {
        if is_a {
            if_a
        } else if is_b {
            if_b
        } else {
            otherwise
        }
    };
    [pick(b, c, a), pick(c, a, b), pick(a, b, c)]
}
