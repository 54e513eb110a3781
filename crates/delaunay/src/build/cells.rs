//! The arrays of a growing tetrahedralisation, shared by all threads that insert into it.
//!
//! Every word is an atomic that is read and written without ordering, which costs what a plain word costs;
//! the order between threads comes from the [`blocks`](super::blocks) that they hold.

use super::spreading::Spreading;
use crate::{FacetId, TetId};
use pellicle_geometry::VertexId;
use prefetch_index::prefetch_index;
use rayon::prelude::*;
use std::sync::atomic::{AtomicU8, AtomicU32, Ordering::Relaxed};

/// How many vertices there may be.
pub(crate) const MOST_VERTICES: usize = 1 << 28;

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

/// So many marks, or more, are kept in memory of their own: allocators commonly give a vector of this capacity back to the
/// system as soon as it is dropped, and so the end of the work does not need more memory than its middle.
const MANY: usize = 1 << 18;
const OWN_MEMORY: usize = (1 << 25) + 1;

#[derive(Default)]
pub(super) struct Cells {
    /// By slot. A mark is not part of the corners, so that whoever reads these need not wait for a mark just written.
    marks: Vec<AtomicU8>,
    /// Four corners each, positively oriented; an infinite one as if its vertex at infinity, corner 3, were any point beyond its hull facet.
    corners: Vec<[AtomicU32; 4]>,
    /// By tetrahedron and corner: the facet opposite the corner, seen from the other side.
    twins: Vec<[AtomicU32; 4]>,
}

impl Cells {
    /// No slot yet, and memory reserved (but not touched) for `expected`.
    pub(super) fn with_capacity(expected: usize) -> Self {
        Self {
            marks: Vec::with_capacity(match expected {
                0..MANY => expected,
                _ => expected.max(OWN_MEMORY),
            }),
            corners: Vec::with_capacity(expected),
            twins: Vec::with_capacity(expected),
        }
    }

    pub(super) fn len(&self) -> usize {
        self.corners.len()
    }

    /// Leaves no slots; the memory is kept.
    pub(super) fn clear(&mut self) {
        self.marks.clear();
        self.corners.clear();
        self.twins.clear();
    }

    /// Adds vacant slots until there are `len`. Whoever writes first to new memory waits until it is there, so
    /// threads do it together.
    pub(super) fn grow(&mut self, len: usize) {
        let new = self.len()..len.max(self.len());
        let vacant = || AtomicU8::new(VACANT);
        let row = || [const { AtomicU32::new(0) }; 4];
        if new.len() < LEAST_SHARED {
            self.marks.resize_with(new.end, vacant);
            self.corners.resize_with(new.end, row);
            self.twins.resize_with(new.end, row);
        } else {
            let marks = new.clone().into_par_iter().map(|_| vacant());
            self.marks.par_extend(marks);
            let corners = new.clone().into_par_iter().map(|_| row());
            self.corners.par_extend(corners);
            self.twins.par_extend(new.into_par_iter().map(|_| row()));
        }
    }

    /// Moves the tetrahedra apart, in their order, such that each has room beside it for those that its neighbourhood will
    /// hold: over `len` slots, where `growth` times as many are to be expected. See [`Spreading`].
    pub(super) fn spread(&mut self, len: usize, growth: f64, parts: usize) {
        let old = self.len();
        if len <= old {
            return;
        }
        self.grow(len);
        let cells = &*self;
        let places = Spreading::new(old, len, growth, parts);
        let spread = |slot: usize| {
            let from = TetId::new(slot);
            let mark = cells.mark(from);
            let corners = cells.corners(from);
            cells.set_mark(from, VACANT);
            if mark == AT_REST {
                let to = TetId::new(places.of(slot));
                let twins = cells.twins(from);
                let renamed = |twin: FacetId| {
                    let tet = TetId::new(places.of(twin.tet().index()));
                    FacetId::of(tet, twin.corner())
                };
                cells.set(to, corners, twins.map(renamed), AT_REST);
            }
        };
        // Those that leave the slots in use do not meet each other there; then those that leave what they left.
        let mut end = old;
        loop {
            let start = places.first_beyond(end);
            if end - start < LEAST_SHARED {
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
        four(|i| VertexId(vertex(i)))
    }

    /// The vertex opposite a facet.
    #[inline(always)]
    pub(super) fn opposite(&self, facet: FacetId) -> VertexId {
        VertexId(self.corners[facet.tet().index()][facet.corner()].load(Relaxed))
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
        four(|i| slots[i].store(corners[i].0, Relaxed));
        let slots = &self.twins[tet.index()];
        four(|i| slots[i].store(twins[i].0, Relaxed));
        self.set_mark(tet, mark);
    }

    /// Says that the corners of a tetrahedron will be wanted soon.
    #[inline(always)]
    pub(super) fn prefetch_corners(&self, tet: TetId) {
        prefetch_index(&self.corners, tet.index());
    }

    /// Says that the mark of a tetrahedron will be wanted soon.
    #[inline(always)]
    pub(super) fn prefetch_mark(&self, tet: TetId) {
        prefetch_index(&self.marks, tet.index());
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
        self.marks[tet.index()].load(Relaxed)
    }

    #[inline(always)]
    pub(super) fn set_mark(&self, tet: TetId, mark: u8) {
        self.marks[tet.index()].store(mark, Relaxed);
    }

    /// The arrays as plain numbers, in place: corners and twins. Slots without a tetrahedron have
    /// [`VertexId::NONE`] as their first corner.
    pub(super) fn into_plain(self) -> (Vec<[VertexId; 4]>, Vec<[FacetId; 4]>) {
        let Self {
            marks,
            mut corners,
            twins,
        } = self;
        let vacant = marks.par_iter().zip(&mut corners);
        vacant.for_each(|(mark, corners)| {
            if mark.load(Relaxed) != AT_REST {
                *corners[0].get_mut() = VertexId::NONE.0;
            }
        });
        drop(marks);
        let vertices = |corners: [AtomicU32; 4]| corners.map(|v| VertexId(v.into_inner()));
        let facets = |twins: [AtomicU32; 4]| twins.map(|twin| FacetId(twin.into_inner()));
        (
            corners.into_iter().map(vertices).collect(),
            twins.into_iter().map(facets).collect(),
        )
    }
}

/// What `of` gives for 0 to 3. (`array::from_fn` and `map` are not surely inlined into functions that are
/// compiled for more than the least machine.)
#[inline(always)]
pub(super) fn four<T>(mut of: impl FnMut(usize) -> T) -> [T; 4] {
    [of(0), of(1), of(2), of(3)]
}
