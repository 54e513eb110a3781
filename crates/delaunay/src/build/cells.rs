//! The arrays of a growing tetrahedralisation, shared by all threads that insert into it.
//!
//! Every word is an atomic that is read and written without ordering, which costs what a plain word costs;
//! the order between threads comes from the marks alone (see [`parallel`](super::parallel)).

use crate::{FacetId, TetId};
use pellicle_geometry::VertexId;
use std::sync::atomic::{AtomicU8, AtomicU32, Ordering::*};

/// The mark of a tetrahedron that no insertion has claimed.
pub(super) const AT_REST: u8 = 0;
/// The mark of a slot that holds no tetrahedron.
pub(super) const VACANT: u8 = u8::MAX;
/// The mark of a slot that holds no tetrahedron and that a worker keeps for a new one.
pub(super) const KEPT: u8 = u8::MAX - 1;

#[derive(Default)]
pub(super) struct Cells {
    /// Four corners each, positively oriented; an infinite one as if its vertex at infinity, corner 3, were
    /// any point beyond its hull facet.
    corners: Vec<[AtomicU32; 4]>,
    /// By tetrahedron and corner: the facet opposite the corner, seen from the other side.
    twins: Vec<[AtomicU32; 4]>,
    /// [`AT_REST`], [`VACANT`], [`KEPT`], or the worker whose conflict region the tetrahedron is in.
    marks: Vec<AtomicU8>,
}

impl Cells {
    /// No slot yet, and memory reserved (but not touched) for `expected`.
    pub(super) fn with_capacity(expected: usize) -> Self {
        Self {
            corners: Vec::with_capacity(expected),
            twins: Vec::with_capacity(expected),
            marks: Vec::with_capacity(expected),
        }
    }

    pub(super) fn len(&self) -> usize {
        self.corners.len()
    }

    /// Leaves no slots; the memory is kept.
    pub(super) fn clear(&mut self) {
        self.corners.clear();
        self.twins.clear();
        self.marks.clear();
    }

    /// Adds vacant slots until there are `len`.
    pub(super) fn grow(&mut self, len: usize) {
        let nothing = || [const { AtomicU32::new(0) }; 4];
        self.corners.resize_with(len, nothing);
        self.twins.resize_with(len, nothing);
        self.marks.resize_with(len, || AtomicU8::new(VACANT));
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
        let step = ((len as u64) << FRACTION) / old as u64;
        let place = |slot: u32| ((u64::from(slot) * step) >> FRACTION) as u32;
        // From the last one down: none is overwritten before it has moved.
        for slot in (0..old as u32).rev() {
            let from = TetId(slot);
            let mark = *self.marks[from.index()].get_mut();
            *self.marks[from.index()].get_mut() = VACANT;
            if mark == AT_REST {
                let to = TetId(place(slot));
                let twins = self.twins(from);
                let renamed =
                    |twin: FacetId| FacetId::of(TetId(place(twin.tet().0)), twin.corner());
                self.set(to, self.corners(from), twins.map(renamed));
                *self.marks[to.index()].get_mut() = AT_REST;
            }
        }
    }

    /// How many slots hold a tetrahedron.
    pub(super) fn count(&self) -> usize {
        let marks = self.marks.iter();
        marks.filter(|mark| mark.load(Relaxed) == AT_REST).count()
    }

    #[inline(always)]
    pub(super) fn corners(&self, tet: TetId) -> [VertexId; 4] {
        let corners = &self.corners[tet.index()];
        four(|i| VertexId(corners[i].load(Relaxed)))
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
    pub(super) fn set(&self, tet: TetId, corners: [VertexId; 4], twins: [FacetId; 4]) {
        let slots = &self.corners[tet.index()];
        four(|i| slots[i].store(corners[i].0, Relaxed));
        let slots = &self.twins[tet.index()];
        four(|i| slots[i].store(twins[i].0, Relaxed));
    }

    #[inline(always)]
    pub(super) fn set_twin(&self, facet: FacetId, twin: FacetId) {
        self.twins[facet.tet().index()][facet.corner()].store(twin.0, Relaxed);
    }

    /// What was written to the tetrahedron before its mark was set is seen after this.
    #[inline(always)]
    pub(super) fn mark(&self, tet: TetId) -> u8 {
        self.marks[tet.index()].load(SeqCst)
    }

    #[inline(always)]
    pub(super) fn is_vacant(&self, tet: TetId) -> bool {
        self.marks[tet.index()].load(Relaxed) == VACANT
    }

    /// Sets a mark that only its owner may set; what was written before is seen by whoever reads it.
    #[inline(always)]
    pub(super) fn set_mark(&self, tet: TetId, mark: u8) {
        self.marks[tet.index()].store(mark, Release);
    }

    /// Claims a tetrahedron at rest; false when it is another's, or vacant.
    #[inline(always)]
    pub(super) fn claim(&self, tet: TetId, mark: u8) -> bool {
        self.marks[tet.index()]
            .compare_exchange(AT_REST, mark, SeqCst, Relaxed)
            .is_ok()
    }

    /// The arrays as plain numbers, in place: corners, twins, and whether each slot is in use.
    pub(super) fn into_plain(self) -> (Vec<[VertexId; 4]>, Vec<[FacetId; 4]>, Vec<bool>) {
        let corners = self.corners.into_iter();
        let twins = self.twins.into_iter();
        let marks = self.marks.into_iter();
        (
            corners
                .map(|four| four.map(|corner| VertexId(corner.into_inner())))
                .collect(),
            twins
                .map(|four| four.map(|twin| FacetId(twin.into_inner())))
                .collect(),
            marks.map(|mark| mark.into_inner() == AT_REST).collect(),
        )
    }
}

/// What `of` gives for 0 to 3. (`array::from_fn` and `map` are not surely inlined into functions that are
/// compiled for more than the least machine.)
#[inline(always)]
pub(super) fn four<T>(mut of: impl FnMut(usize) -> T) -> [T; 4] {
    [of(0), of(1), of(2), of(3)]
}
