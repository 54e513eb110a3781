//! The conflict region: dig it out, and fill it with tetrahedra around the new vertex.

use super::{
    cells::{AT_REST, Cells, IN_CONFLICT, KEPT, four},
    conflict::Query,
    kernel::Kernel,
    worker::Worker,
};
use crate::{FacetId, TetId};
use pellicle_geometry::VertexId;
use pellicle_predicates::lanes::Registers;
use std::hint::select_unpredictable;

/// Up to this many vertices on a cavity's boundary, edges are paired through a table with a row and a
/// column a vertex.
const MOST_TABLED_VERTICES: usize = UNRANKED as usize;

/// Entries between the rows of the table: a little more than a row, so that rows do not share the same
/// places of the cache.
const ROW: usize = 272;

/// The same for up to as many vertices: rows that are close to each other.
const SHORT_ROW: usize = 64;

/// Entries of the table, for any two bytes as row and column.
const ENTRIES: usize = (u8::MAX as usize + 1) * ROW;

/// A facet between the conflict region and the rest.
#[derive(Clone, Copy)]
struct BoundaryFacet {
    /// Clockwise seen from the cavity, so that (new vertex, corners) is positive. The vertex at infinity comes last.
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
    ranks: Vec<[u8; 3]>,
    /// The facet of the filling at the edge from one vertex (row) to another (column).
    edges: Box<[FacetId; ENTRIES]>,
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
            edges: vec![FacetId::NONE; ENTRIES]
                .try_into()
                .expect("the vector has the length of the array"),
        }
    }

    /// Makes room for vertices up to this number.
    pub(super) fn make_room_for_vertices(&mut self, vertices: usize) {
        let rank = &mut self.ranking.rank;
        rank.resize(vertices.max(rank.len()), UNRANKED);
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
        self.room().conflict[0] = tet;
        self.conflict_count += 1;
    }

    /// How many tetrahedra the filling has more than the conflict region.
    #[inline(always)]
    pub(super) fn growth(&self) -> usize {
        self.boundary_count.saturating_sub(self.conflict_count)
    }

    /// Room for four more of each kind.
    #[inline(always)]
    fn room(&mut self) -> Found<'_> {
        if self.conflict_count + 4 > self.conflict.len()
            || self.boundary_count + 4 > self.boundary.len()
        {
            self.make_more_room();
        }
        let conflict = self.conflict[self.conflict_count..].first_chunk_mut();
        let boundary = self.boundary[self.boundary_count..].first_chunk_mut();
        Found {
            conflict: conflict.expect("room was made"),
            conflict_count: 0,
            boundary: boundary.expect("room was made"),
            boundary_count: 0,
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

/// Places for what is found on the four sides of a tetrahedron in conflict.
struct Found<'a> {
    conflict: &'a mut [TetId; 4],
    conflict_count: usize,
    boundary: &'a mut [BoundaryFacet; 4],
    boundary_count: usize,
}

impl Found<'_> {
    /// The neighbour opposite corner `I` of a tetrahedron in conflict: to the conflict region if bit `I` of `inside` says so and
    /// it is not there yet, or the facet there to the boundary. (A closure in its place would not surely be inlined.)
    #[inline(always)]
    fn sort_in<const I: usize>(
        &mut self,
        cells: &Cells,
        corners: [VertexId; 4],
        twins: [FacetId; 4],
        inside: u8,
    ) {
        let is_inside = inside >> I & 1;
        self.boundary[self.boundary_count & 3] = BoundaryFacet {
            corners: facet_least_last::<I>(corners),
            outer: twins[I],
        };
        self.boundary_count += usize::from(is_inside ^ 1);
        let neighbor = twins[I].tet();
        // One of 0 and 1, at rest and in conflict: those that are joined to others have no other mark.
        let mark = cells.mark(neighbor);
        cells.set_mark(neighbor, mark | (IN_CONFLICT * is_inside));
        cells.prefetch_twins(neighbor);
        self.conflict[self.conflict_count & 3] = neighbor;
        self.conflict_count += usize::from(is_inside & !mark);
    }
}

impl Worker {
    /// Finds all tetrahedra in conflict with a point, breadth first from `start`, and the facets around them;
    /// marks them. The conflict region is connected and star-shaped around it: the signs are exact.
    ///
    /// False when another worker holds one of the tetrahedra to be looked at; then what is marked must be released.
    ///
    /// Whether a neighbour is in conflict is as good as random, so the inner loop has no branch on it: it
    /// writes what may be needed, and counts what is. It does not ask which ones were tested before either: all four at once
    /// take no longer.
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
                four(|i| cells.prefetch_mark(twins[i].tet()));
                if SHARED {
                    four(|i| kernel.blocks.prefetch(twins[i].tet()));
                }
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
            let inside = kernel.are_in_conflict(registers, corners, twins, query);
            let mut found = cavity.room();
            found.sort_in::<0>(cells, corners, twins, inside);
            found.sort_in::<1>(cells, corners, twins, inside);
            found.sort_in::<2>(cells, corners, twins, inside);
            found.sort_in::<3>(cells, corners, twins, inside);
            let (conflict, boundary) = (found.conflict_count, found.boundary_count);
            cavity.conflict_count += conflict;
            cavity.boundary_count += boundary;
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
            cavity.push_conflict(tet);
        }
        // The boundary is a sphere with F facets and F / 2 + 2 vertices.
        let vertices = cavity.boundary_count / 2 + 2;
        if vertices <= SHORT_ROW {
            cavity.join_through_table::<SHORT_ROW>(kernel, vertex);
        } else if vertices <= MOST_TABLED_VERTICES {
            cavity.join_through_table::<ROW>(kernel, vertex);
        } else {
            cavity.join_through_sorting(kernel, vertex);
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
    fn join_through_table<const STRIDE: usize>(&mut self, kernel: &Kernel, vertex: VertexId) {
        let count = self.boundary_count;
        if self.ranks.len() < count {
            self.ranks.resize(self.boundary.len(), [0; 3]);
        }
        let edges = &mut *self.edges;
        let edge = |from: u8, to: u8| usize::from(from) * STRIDE + usize::from(to);
        let boundary = &self.boundary[..count];
        let filling = &self.conflict[..count];
        let ranks = &mut self.ranks[..count];
        let mut ranking = self.ranking.start();
        for ((facet, &tet), ranks) in boundary.iter().zip(filling).zip(&mut *ranks) {
            let [a, b, c] = facet.corners;
            let a = ranking.rank_of(a);
            let b = ranking.rank_of(b);
            let c = ranking.rank_of(c);
            *ranks = [a, b, c];
            edges[edge(b, c)] = FacetId::of(tet, 1);
            edges[edge(c, a)] = FacetId::of(tet, 2);
            edges[edge(a, b)] = FacetId::of(tet, 3);
        }
        debug_assert_eq!(usize::from(ranking.count), count / 2 + 2);
        ranking.forget();
        for ((facet, &tet), &[a, b, c]) in boundary.iter().zip(filling).zip(&*ranks) {
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
                AT_REST,
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
            let [a, b, c] = facet.corners;
            kernel
                .cells
                .set(tet, [vertex, a, b, c], [facet.outer; 4], AT_REST);
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

/// In place of a rank.
const UNRANKED: u8 = u8::MAX;

/// Numbers the vertices of a cavity's boundary from 0.
struct Ranking {
    /// By vertex: its rank.
    rank: Vec<u8>,
    /// By rank.
    vertices: Box<[VertexId; UNRANKED as usize + 1]>,
}

impl Ranking {
    fn for_vertices(vertices: usize) -> Self {
        Self {
            rank: vec![UNRANKED; vertices],
            vertices: Box::new([VertexId::NONE; UNRANKED as usize + 1]),
        }
    }

    #[inline(always)]
    fn start(&mut self) -> Numbering<'_> {
        Numbering {
            rank: &mut self.rank,
            vertices: &mut self.vertices,
            count: 0,
        }
    }
}

/// A cavity's vertices being numbered.
struct Numbering<'a> {
    rank: &'a mut [u8],
    vertices: &'a mut [VertexId; UNRANKED as usize + 1],
    count: u8,
}

impl Numbering<'_> {
    /// Without a branch: which vertices are new is as good as random.
    #[inline(always)]
    fn rank_of(&mut self, vertex: VertexId) -> u8 {
        let slot = &mut self.rank[vertex.index()];
        let is_new = *slot == UNRANKED;
        let rank = select_unpredictable(is_new, self.count, *slot);
        *slot = rank;
        self.vertices[usize::from(self.count)] = vertex;
        self.count += u8::from(is_new);
        rank
    }

    /// Leaves no vertex with a rank.
    #[inline(always)]
    fn forget(self) {
        for vertex in &self.vertices[..usize::from(self.count)] {
            self.rank[vertex.index()] = UNRANKED;
        }
    }
}

/// The facet opposite corner `I`, clockwise seen from there.
///
/// Of a tetrahedron with the vertex inserted last as its first corner and the least one, perhaps that at infinity, as its last
/// one, the facet has its least vertex last too.
#[inline(always)]
fn facet_least_last<const I: usize>([a, b, c, d]: [VertexId; 4]) -> [VertexId; 3] {
    match I {
        0 => [b, c, d],
        1 => [c, a, d],
        2 => [a, b, d],
        _ => {
            let is_b = b < c;
            let pick = |if_b, otherwise| select_unpredictable(is_b, if_b, otherwise);
            [pick(a, b), pick(c, a), pick(b, c)]
        }
    }
}
