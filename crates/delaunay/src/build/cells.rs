//! The arrays of a growing tetrahedralisation, shared by all threads that insert into it.
//!
//! Every word is an atomic that is read and written without ordering, which costs what a plain word costs;
//! the order between threads comes from the [`blocks`](super::blocks) that they hold.

use crate::{FacetId, TetId};
use pellicle_geometry::VertexId;
use prefetch_index::prefetch_index;
use rayon::prelude::*;
use std::sync::atomic::{AtomicU32, Ordering::Relaxed};

/// The first corner's word holds the vertex in these bits and the mark in the others, so that a look at a
/// tetrahedron fetches both.
const MARK_SHIFT: u32 = 28;
const VERTEX_BITS: u32 = (1 << MARK_SHIFT) - 1;

/// How many vertices there may be.
pub(crate) const MOST_VERTICES: usize = 1 << MARK_SHIFT;

/// The mark of a tetrahedron that is in no conflict region.
pub(super) const AT_REST: u8 = 0;
/// The mark of a tetrahedron that is in the conflict region of a point being inserted.
pub(super) const IN_CONFLICT: u8 = 1;
/// The mark of a slot that holds no tetrahedron.
pub(super) const VACANT: u8 = 15;
/// The mark of a slot that holds no tetrahedron and that a worker keeps for a new one.
pub(super) const KEPT: u8 = 14;

/// Fewer slots than these are one thread's work.
const LEAST_SHARED: usize = 1 << 14;

#[derive(Default)]
pub(super) struct Cells {
    /// Four corners each, the first with the mark; positively oriented; an infinite one as if its vertex at infinity, corner 3, were
    /// any point beyond its hull facet.
    corners: Vec<[AtomicU32; 4]>,
    /// By tetrahedron and corner: the facet opposite the corner, seen from the other side.
    twins: Vec<[AtomicU32; 4]>,
}

impl Cells {
    /// No slot yet, and memory reserved (but not touched) for `expected`.
    pub(super) fn with_capacity(expected: usize) -> Self {
        Self {
            corners: Vec::with_capacity(expected),
            twins: Vec::with_capacity(expected),
        }
    }

    pub(super) fn len(&self) -> usize {
        self.corners.len()
    }

    /// Leaves no slots; the memory is kept.
    pub(super) fn clear(&mut self) {
        self.corners.clear();
        self.twins.clear();
    }

    /// Adds vacant slots until there are `len`. Whoever writes first to new memory waits until it is there, so
    /// threads do it together.
    pub(super) fn grow(&mut self, len: usize) {
        let new = self.len()..len.max(self.len());
        let row = |first: u32| {
            let mut row = [const { AtomicU32::new(0) }; 4];
            *row[0].get_mut() = first;
            row
        };
        let vacant = u32::from(VACANT) << MARK_SHIFT;
        if new.len() < LEAST_SHARED {
            self.corners.resize_with(new.end, || row(vacant));
            self.twins.resize_with(new.end, || row(0));
        } else {
            let corners = new.clone().into_par_iter().map(|_| row(vacant));
            self.corners.par_extend(corners);
            self.twins.par_extend(new.into_par_iter().map(|_| row(0)));
        }
    }

    /// Moves the tetrahedra apart, in their order, so that they are spread evenly over `len` slots: each
    /// then has room beside it for those that its neighbourhood will hold.
    pub(super) fn spread(&mut self, len: usize) {
        /// Bits behind the point of the distance between two that were neighbours.
        const FRACTION: u32 = 24;
        let old = self.len();
        if len <= old {
            return;
        }
        self.grow(len);
        let cells = &*self;
        let step = ((len as u64) << FRACTION) / old as u64;
        let place = |slot: u32| ((u64::from(slot) * step) >> FRACTION) as u32;
        let spread = |slot: u32| {
            let from = TetId(slot);
            let mark = cells.mark(from);
            let corners = cells.corners(from);
            cells.set_mark(from, VACANT);
            if mark == AT_REST {
                let to = TetId(place(slot));
                let twins = cells.twins(from);
                let renamed =
                    |twin: FacetId| FacetId::of(TetId(place(twin.tet().0)), twin.corner());
                cells.set(to, corners, twins.map(renamed), AT_REST);
            }
        };
        // Those that leave the slots in use do not meet each other there; then those that leave what they left.
        let mut end = old as u32;
        loop {
            let start = (u64::from(end) << FRACTION).div_ceil(step) as u32;
            if ((end - start) as usize) < LEAST_SHARED {
                break;
            }
            (start..end).into_par_iter().for_each(spread);
            end = start;
        }
        // From the last one down: none is overwritten before it has moved.
        (0..end).rev().for_each(spread);
    }

    /// How many slots hold a tetrahedron.
    pub(super) fn count(&self) -> usize {
        let slots = (0..self.len()).map(TetId::new);
        slots.filter(|&slot| self.mark(slot) == AT_REST).count()
    }

    #[inline(always)]
    pub(super) fn corners(&self, tet: TetId) -> [VertexId; 4] {
        let corners = &self.corners[tet.index()];
        let vertex = |i: usize| corners[i].load(Relaxed);
        [vertex(0) & VERTEX_BITS, vertex(1), vertex(2), vertex(3)].map(VertexId)
    }

    /// The vertex opposite a facet.
    #[inline(always)]
    pub(super) fn opposite(&self, facet: FacetId) -> VertexId {
        let word = self.corners[facet.tet().index()][facet.corner()].load(Relaxed);
        VertexId(word & VERTEX_BITS)
    }

    #[inline(always)]
    pub(super) fn twins(&self, tet: TetId) -> [FacetId; 4] {
        let twins = &self.twins[tet.index()];
        four(|i| FacetId(twins[i].load(Relaxed)))
    }

    #[inline(always)]
    pub(super) fn twin(&self, facet: FacetId) -> FacetId {
        FacetId(self.twins[facet.tet().index()][facet.corner()].load(Relaxed))
    }

    #[inline(always)]
    pub(super) fn set(&self, tet: TetId, corners: [VertexId; 4], twins: [FacetId; 4], mark: u8) {
        let slots = &self.corners[tet.index()];
        slots[0].store(word(corners[0], mark), Relaxed);
        slots[1].store(corners[1].0, Relaxed);
        slots[2].store(corners[2].0, Relaxed);
        slots[3].store(corners[3].0, Relaxed);
        let slots = &self.twins[tet.index()];
        four(|i| slots[i].store(twins[i].0, Relaxed));
    }

    /// Says that the corners of a tetrahedron, and its mark, will be wanted soon.
    #[inline(always)]
    pub(super) fn prefetch_corners(&self, tet: TetId) {
        prefetch_index(&self.corners, tet.index());
    }

    /// Says that the twins of a tetrahedron will be wanted soon.
    #[inline(always)]
    pub(super) fn prefetch_twins(&self, tet: TetId) {
        prefetch_index(&self.twins, tet.index());
    }

    #[inline(always)]
    pub(super) fn set_twin(&self, facet: FacetId, twin: FacetId) {
        self.twins[facet.tet().index()][facet.corner()].store(twin.0, Relaxed);
    }

    #[inline(always)]
    pub(super) fn mark(&self, tet: TetId) -> u8 {
        (self.corners[tet.index()][0].load(Relaxed) >> MARK_SHIFT) as u8
    }

    #[inline(always)]
    pub(super) fn set_mark(&self, tet: TetId, mark: u8) {
        let first = &self.corners[tet.index()][0];
        let vertex = VertexId(first.load(Relaxed) & VERTEX_BITS);
        first.store(word(vertex, mark), Relaxed);
    }

    /// The arrays as plain numbers, in place: corners and twins. Slots without a tetrahedron have
    /// [`VertexId::NONE`] as their first corner.
    pub(super) fn into_plain(self) -> (Vec<[VertexId; 4]>, Vec<[FacetId; 4]>) {
        let vertices = |corners: [AtomicU32; 4]| {
            let [mut first, second, third, fourth] = corners.map(AtomicU32::into_inner);
            if first >> MARK_SHIFT != u32::from(AT_REST) {
                first = VertexId::NONE.0;
            }
            [first, second, third, fourth].map(VertexId)
        };
        let facets = |twins: [AtomicU32; 4]| twins.map(|twin| FacetId(twin.into_inner()));
        (
            self.corners.into_iter().map(vertices).collect(),
            self.twins.into_iter().map(facets).collect(),
        )
    }
}

#[inline(always)]
fn word(vertex: VertexId, mark: u8) -> u32 {
    vertex.0 | u32::from(mark) << MARK_SHIFT
}

/// What `of` gives for 0 to 3. (`array::from_fn` and `map` are not surely inlined into functions that are
/// compiled for more than the least machine.)
#[inline(always)]
pub(super) fn four<T>(mut of: impl FnMut(usize) -> T) -> [T; 4] {
    [of(0), of(1), of(2), of(3)]
}
