//! One thread's part in the insertion: locate, dig, retriangulate.

use super::{
    cavity::Cavity,
    cells::{AT_REST, KEPT, VACANT},
    conflict::Query,
    kernel::Kernel,
};
use crate::TetId;
use pellicle_geometry::VertexId;
use pellicle_predicates::lanes::Registers;
use std::ops::Range;

/// What became of an insertion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Outcome {
    Inserted,
    /// The point's weight hides it; nothing has changed.
    Hidden,
    /// Another worker is at work there; nothing has changed.
    Contended,
    /// No slot is left; nothing has changed.
    Full,
}

pub(super) struct Worker {
    /// The mark of what this worker has claimed.
    pub(super) mark: u8,
    pub(super) cavity: Cavity,
    /// Slots kept for new tetrahedra.
    pub(super) kept: Vec<TetId>,
    /// Slots of which the vacant ones are this worker's.
    slots: Range<usize>,
    /// A tetrahedron of the last insertion: where the next walk starts.
    pub(super) recent: TetId,
}

impl Worker {
    /// The `index`-th worker, below 253, for a kernel with so many vertices.
    pub(super) fn new(index: usize, vertices: usize) -> Self {
        Self {
            mark: index as u8 + 1,
            cavity: Cavity::for_vertices(vertices),
            kept: Vec::new(),
            slots: 0..0,
            recent: TetId(0),
        }
    }

    /// Inserts a point. `SHARED` says whether others may be inserting at the same time.
    #[inline(always)]
    pub(super) fn insert<const SHARED: bool, R: Registers>(
        &mut self,
        registers: R,
        kernel: &Kernel,
        vertex: VertexId,
        query: impl Query,
    ) -> Outcome {
        // 1. A tetrahedron in conflict, claimed.
        let Some(start) = self.locate::<SHARED>(kernel, query.position()) else {
            return Outcome::Contended;
        };
        if SHARED && !kernel.cells.claim(start, self.mark) {
            return Outcome::Contended;
        }
        if !SHARED {
            kernel.cells.set_mark(start, self.mark);
        }
        if !kernel.is_in_conflict(start, query) {
            // A weight may hide the point. Or others changed the tetrahedron between the walk and the claim.
            let is_hidden = !SHARED || kernel.contains(start, query.position());
            kernel.cells.set_mark(start, AT_REST);
            return match is_hidden {
                true => Outcome::Hidden,
                false => Outcome::Contended,
            };
        }
        // 2. All of them, claimed.
        if !self.dig::<SHARED, R>(registers, kernel, start, query) {
            self.release(kernel);
            return Outcome::Contended;
        }
        // 3. Room for those that take their place.
        if !self.reserve(kernel, self.cavity.growth()) {
            self.release(kernel);
            return Outcome::Full;
        }
        // 4. The new ones.
        self.retriangulate(kernel, vertex);
        Outcome::Inserted
    }

    /// Forgets slots, which move between rounds, and starts the next walk from `recent`.
    pub(super) fn start_round(&mut self, recent: TetId) {
        self.kept.clear();
        self.slots = 0..0;
        self.recent = recent;
    }

    /// Whether there are slots for so many new tetrahedra beside those of the conflict region.
    #[inline(always)]
    pub(super) fn reserve(&mut self, kernel: &Kernel, slots: usize) -> bool {
        while self.kept.len() < slots {
            if self.slots.is_empty() {
                self.slots = kernel.take_slots(usize::from(self.mark - 1));
                if self.slots.is_empty() {
                    return false;
                }
            }
            for slot in self.slots.by_ref().map(TetId::new) {
                if kernel.cells.mark(slot) == VACANT {
                    kernel.cells.set_mark(slot, KEPT);
                    self.kept.push(slot);
                    if self.kept.len() == slots {
                        break;
                    }
                }
            }
        }
        true
    }
}
