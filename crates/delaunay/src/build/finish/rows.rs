//! Moving the tetrahedra to their places, with little memory beside theirs.

use crate::FacetId;
use pellicle_geometry::VertexId;
use rayon::prelude::*;

/// Some of the tetrahedra, side by side, and where in the result each goes.
pub(super) struct Rows<'a> {
    /// The place of the first.
    start: u32,
    of: &'a mut [u32],
    tets: &'a mut [[VertexId; 4]],
    twins: &'a mut [[FacetId; 4]],
}

impl<'a> Rows<'a> {
    pub(super) fn new(
        of: &'a mut [u32],
        tets: &'a mut [[VertexId; 4]],
        twins: &'a mut [[FacetId; 4]],
    ) -> Self {
        Self {
            start: 0,
            of,
            tets,
            twins,
        }
    }

    /// Moves the tetrahedra to these places.
    ///
    /// Slots and places run about alike, but following the cycles of the permutation would jump through all of
    /// memory all the same. So each goes into the right block first, to where the blocks' next free places are,
    /// which are few enough to stay in the cache; then to its place in the block (McIlroy et al. 1993), by way of a copy
    /// of the block's corners or twins.
    ///
    /// Since they run about alike, few need to go from one thread's share to another's.
    pub(super) fn arrange(mut self) {
        // A copy needs little memory beside all the others, and stays in the cache.
        let block = (self.of.len().max(1).ilog2().saturating_sub(6)).clamp(12, 17);
        let share = self.of.len().div_ceil(rayon::current_num_threads()).max(1);
        self.move_into_blocks(share, |place| place / share);
        let shares = self.chunks(share).into_par_iter();
        shares.for_each(|share| share.move_into_places(block));
    }

    /// By way of blocks of two to this power.
    fn move_into_places(mut self, block: u32) {
        self.move_into_blocks(1 << block, |place| place >> block);
        for rows in self.chunks(1 << block) {
            let place = |slot: usize| (rows.of[slot] - rows.start) as usize;
            permute(rows.tets, place);
            permute(rows.twins, place);
        }
    }

    fn chunks(&mut self, size: usize) -> Vec<Rows<'_>> {
        let starts = (self.start..).step_by(size);
        let of = self.of.chunks_mut(size);
        let tets = self.tets.chunks_mut(size);
        let twins = self.twins.chunks_mut(size);
        let rows = starts.zip(of).zip(tets.zip(twins));
        rows.map(|((start, of), (tets, twins))| Rows {
            start,
            of,
            tets,
            twins,
        })
        .collect()
    }

    #[inline(always)]
    fn swap(&mut self, one: usize, other: usize) {
        self.of.swap(one, other);
        self.tets.swap(one, other);
        self.twins.swap(one, other);
    }

    /// Each into its block of so many places: `block_of` a place, counted from the first.
    #[inline(always)]
    fn move_into_blocks(&mut self, size: usize, block_of: impl Fn(usize) -> usize) {
        let count = self.of.len();
        if count <= size {
            return;
        }
        let start = self.start;
        let home = |place: u32| block_of((place - start) as usize);
        let mut next: Vec<usize> = (0..count).step_by(size).collect();
        for block in 0..next.len() {
            let end = ((block + 1) * size).min(count);
            let mut slot = next[block];
            while slot < end {
                let to = home(self.of[slot]);
                if to == block {
                    slot += 1;
                    continue;
                }
                // Those before `next` are home; so may be the next ones.
                let mut free = next[to];
                while home(self.of[free]) == to {
                    free += 1;
                }
                next[to] = free + 1;
                self.swap(slot, free);
            }
        }
    }
}

/// Each row to its place.
fn permute<T: Copy>(rows: &mut [T], place: impl Fn(usize) -> usize) {
    let before = rows.to_vec();
    for (slot, &row) in before.iter().enumerate() {
        rows[place(slot)] = row;
    }
}
