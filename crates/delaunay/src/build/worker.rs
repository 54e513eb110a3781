//! One thread's part in the insertion: locate, dig, retriangulate.

use super::{
    blocks::Held,
    cavity::Cavity,
    cells::{AT_REST, IN_CONFLICT, KEPT, VACANT},
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
    index: usize,
    /// The blocks that no other worker touches.
    pub(super) held: Held,
    pub(super) cavity: Cavity,
    /// Slots kept for new tetrahedra.
    pub(super) kept: Vec<TetId>,
    /// Slots of which the vacant ones are this worker's.
    slots: Range<usize>,
    /// A tetrahedron of the last insertion: where the next walk starts.
    pub(super) recent: TetId,
}

impl Worker {
    /// The `index`-th worker, below [`Blocks::MOST_WORKERS`], for a kernel with so many vertices.
    pub(super) fn new(index: usize, vertices: usize) -> Self {
        Self {
            index,
            held: Held::by_worker(index),
            cavity: Cavity::for_vertices(vertices),
            kept: Vec::new(),
            slots: 0..0,
            recent: TetId(0),
        }
    }

    /// Inserts a point. `SHARED` says whether others may be inserting at the same time.
    #[inline(always)]
    pub(super) fn insert<const SHARED: bool, R: Registers, Q: Query>(
        &mut self,
        registers: R,
        kernel: &Kernel,
        vertex: VertexId,
        query: Q,
    ) -> Outcome {
        // 1. A tetrahedron in conflict.
        let Some(start) = self.locate::<SHARED, R>(registers, kernel, query.position()) else {
            return Outcome::Contended;
        };
        if SHARED && !(self.held.hold(&kernel.blocks, start) && kernel.cells.mark(start) == AT_REST)
        {
            return Outcome::Contended;
        }
        debug_assert!(SHARED || Q::MAY_BE_HIDDEN || kernel.is_in_conflict(start, query));
        if (SHARED || Q::MAY_BE_HIDDEN) && !kernel.is_in_conflict(start, query) {
            // A weight may hide the point. Or others changed the tetrahedron on the way.
            let is_hidden = !SHARED || kernel.contains(start, query.position());
            return match is_hidden {
                true => Outcome::Hidden,
                false => Outcome::Contended,
            };
        }
        kernel.cells.set_mark(start, IN_CONFLICT);
        // 2. All of them.
        if !self.dig::<SHARED, R>(registers, kernel, start, query) {
            self.release(kernel);
            return Outcome::Contended;
        }
        // 3. Room for those that take their place.
        match self.reserve::<SHARED>(kernel, self.cavity.growth()) {
            Room::Enough => {}
            Room::Contended => {
                self.release(kernel);
                return Outcome::Contended;
            }
            Room::None => {
                self.release(kernel);
                return Outcome::Full;
            }
        }
        // 4. The new ones.
        debug_assert!(!SHARED || self.holds_cavity(kernel));
        self.retriangulate(kernel, vertex);
        Outcome::Inserted
    }

    /// Forgets slots, which move between rounds, and starts the next walk from `recent`.
    pub(super) fn start_round(&mut self, recent: TetId) {
        self.kept.clear();
        self.slots = 0..0;
        self.recent = recent;
    }

    /// Looks for slots for so many new tetrahedra beside those of the conflict region.
    #[inline(always)]
    pub(super) fn reserve<const SHARED: bool>(&mut self, kernel: &Kernel, slots: usize) -> Room {
        while self.kept.len() < slots {
            let Some(slot) = self.slots.clone().next().map(TetId::new) else {
                self.slots = kernel.take_slots(self.index);
                if self.slots.is_empty() {
                    return Room::None;
                }
                continue;
            };
            if SHARED && !self.held.hold(&kernel.blocks, slot) {
                return Room::Contended;
            }
            self.slots.start += 1;
            if kernel.cells.mark(slot) == VACANT {
                kernel.cells.set_mark(slot, KEPT);
                self.kept.push(slot);
            }
        }
        if SHARED {
            // Those kept for long may lie in a block that another holds by now.
            let first = self.kept.len() - slots;
            let mut others = self.kept[first..].iter();
            if let Some(k) = others.position(|&slot| !self.held.hold(&kernel.blocks, slot)) {
                self.kept.swap(0, first + k);
                return Room::Contended;
            }
        }
        Room::Enough
    }
}

/// Whether there are slots for new tetrahedra.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Room {
    Enough,
    /// Another worker holds what would have to be looked at.
    Contended,
    None,
}
