//! Which worker may touch which tetrahedra: slots belong together in blocks, and a block to one worker at a time.

use crate::TetId;
use prefetch_index::prefetch_index;
use std::sync::atomic::{AtomicBool, AtomicU8, Ordering::*};

/// Two to this power are the slots in a block: neighbours in space, mostly.
const BLOCK_SHIFT: u32 = 3;

/// The owner of a block that nobody holds.
const FREE: u8 = 0;

/// By block, the worker that holds it.
#[derive(Default)]
pub(super) struct Blocks {
    owners: Vec<AtomicU8>,
    /// By worker, whether another is in want of a block that it holds.
    wanted: Vec<AtomicBool>,
}

impl Blocks {
    /// How many workers there can be.
    pub(super) const MOST_WORKERS: usize = u8::MAX as usize - 1;

    /// As many blocks as hold `slots` slots, for so many workers; all are free.
    pub(super) fn prepare(&mut self, slots: usize, workers: usize) {
        let blocks = (slots >> BLOCK_SHIFT) + 1;
        self.owners.resize_with(blocks, || AtomicU8::new(FREE));
        self.wanted
            .resize_with(workers.max(self.wanted.len()), AtomicBool::default);
    }

    /// Says that who holds the tetrahedron's block will be asked for soon.
    #[inline(always)]
    pub(super) fn prefetch(&self, tet: TetId) {
        prefetch_index(&self.owners, tet.index() >> BLOCK_SHIFT);
    }
}

/// The blocks that a worker holds.
pub(super) struct Held {
    /// Who it is, among the owners.
    owner: u8,
    blocks: Vec<u32>,
}

impl Held {
    pub(super) fn by_worker(index: usize) -> Self {
        Self {
            owner: index as u8 + 1,
            blocks: Vec::new(),
        }
    }

    /// Whether the worker holds the tetrahedron's block, if need be from now on. If not, its holder is told.
    #[inline(always)]
    pub(super) fn hold(&mut self, blocks: &Blocks, tet: TetId) -> bool {
        let block = tet.index() >> BLOCK_SHIFT;
        blocks.owners[block].load(Relaxed) == self.owner || self.take(blocks, block)
    }

    /// Whether the worker holds the tetrahedron's block.
    pub(super) fn holds(&self, blocks: &Blocks, tet: TetId) -> bool {
        blocks.owners[tet.index() >> BLOCK_SHIFT].load(Relaxed) == self.owner
    }

    /// What others have written to a block before they let it go is seen from here on.
    #[cold]
    #[inline(never)]
    fn take(&mut self, blocks: &Blocks, block: usize) -> bool {
        match blocks.owners[block].compare_exchange(FREE, self.owner, Acquire, Relaxed) {
            Ok(_) => {
                self.blocks.push(block as u32);
                true
            }
            Err(owner) => {
                blocks.wanted[usize::from(owner) - 1].store(true, Relaxed);
                false
            }
        }
    }

    /// Lets all blocks go if somebody is in want of one. No insertion is under way.
    #[inline(always)]
    pub(super) fn yield_if_wanted(&mut self, blocks: &Blocks) {
        if blocks.wanted[usize::from(self.owner) - 1].load(Relaxed) {
            self.release(blocks);
        }
    }

    /// Lets all blocks go. No insertion is under way.
    #[cold]
    pub(super) fn release(&mut self, blocks: &Blocks) {
        for block in self.blocks.drain(..) {
            blocks.owners[block as usize].store(FREE, Release);
        }
        if let Some(wanted) = blocks.wanted.get(usize::from(self.owner) - 1) {
            wanted.store(false, Relaxed);
        }
    }
}
