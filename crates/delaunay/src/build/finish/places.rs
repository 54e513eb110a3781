//! The order of the tetrahedra, which does not depend on how they came to be.

use super::super::{cells::MOST_VERTICES, kernel::INFINITE};
use pellicle_geometry::VertexId;
use pellicle_predicates::lanes::{Registers, Vectorized, vectorized};
use prefetch_index::prefetch_index;
use rayon::prelude::*;
use std::{
    ops::Range,
    sync::atomic::{AtomicU32, Ordering::Relaxed},
};

/// No slot.
const NONE: u32 = u32::MAX;

/// The first corner of a slot without a tetrahedron.
pub(super) const UNUSED: VertexId = VertexId::NONE;

/// Up to this many tetrahedra of one latest vertex, all are compared with all.
const MOST_COMPARED: usize = 64;

/// The least [key](Lists::key) of a finite tetrahedron.
const FIRST_FINITE: f64 = f64::from_bits(1 << 62 | 1 << 32);

/// Where the tetrahedra go.
pub(super) struct Places {
    /// By slot the place in the result; those of slots without a tetrahedron come last.
    pub(super) of: Vec<u32>,
    /// How many places are finite tetrahedra'.
    pub(super) finite: usize,
    /// How many are tetrahedra's.
    pub(super) used: usize,
}

impl Places {
    /// Of tetrahedra whose latest corner comes first and whose least one comes last.
    pub(super) fn of_tetrahedra(tets: &[[VertexId; 4]], vertices: usize) -> Self {
        /// So many slots are looked at in one go.
        const SLOTS: usize = 1 << 16;
        let unnumbered = |count: usize| -> Vec<AtomicU32> {
            let all = (0..count).into_par_iter();
            all.map(|_| AtomicU32::new(NONE)).collect()
        };
        let of = unnumbered(tets.len());
        let last = unnumbered(vertices);
        let threads = rayon::current_num_threads();
        let share = (vertices / (4 * threads)).next_power_of_two();
        let lists = Lists {
            tets,
            of: &of,
            last: &last,
            share_shift: share.ilog2(),
            shared: threads > 1,
        };
        let found: Vec<Found> = tets
            .par_chunks(SLOTS)
            .enumerate()
            .map(|(k, chunk)| lists.gather(k * SLOTS..k * SLOTS + chunk.len()))
            .collect();

        let mut starts = vec![Counts::default(); vertices.div_ceil(share)];
        let mut unused = Vec::new();
        for mut more in found {
            for (start, count) in starts.iter_mut().zip(more.by_share) {
                start.finite += count.finite;
                start.infinite += count.infinite;
            }
            unused.append(&mut more.unused);
        }
        // From how many there are to how many come before.
        let finite: u32 = starts.iter().map(|count| count.finite).sum();
        let mut next = Counts {
            finite: 0,
            infinite: finite,
        };
        for start in &mut starts {
            let count = std::mem::replace(start, next);
            next.finite += count.finite;
            next.infinite += count.infinite;
        }
        last.par_chunks(share).zip(starts).for_each(|(last, next)| {
            vectorized(Numbering {
                lists: &lists,
                last,
                next,
            });
        });

        let used = next.infinite;
        for (t, place) in unused.into_iter().zip(used..) {
            of[t as usize].store(place, Relaxed);
        }
        Self {
            of: of.into_iter().map(AtomicU32::into_inner).collect(),
            finite: finite as usize,
            used: used as usize,
        }
    }
}

/// By latest vertex the list of its tetrahedra, in any order: the last one in `last`, the one before each in `of`.
struct Lists<'a> {
    tets: &'a [[VertexId; 4]],
    of: &'a [AtomicU32],
    last: &'a [AtomicU32],
    /// Two to this power are the vertices in a share.
    share_shift: u32,
    /// Whether several threads make the lists.
    shared: bool,
}

/// What is in some of the slots.
struct Found {
    /// How many tetrahedra the vertices of each share have.
    by_share: Vec<Counts>,
    unused: Vec<u32>,
}

/// Of tetrahedra, or of places taken.
#[derive(Clone, Copy, Default)]
struct Counts {
    finite: u32,
    infinite: u32,
}

impl Lists<'_> {
    /// Puts the tetrahedra in these slots into the lists.
    fn gather(&self, slots: Range<usize>) -> Found {
        let shares = self.last.len().div_ceil(1 << self.share_shift);
        let mut found = Found {
            by_share: vec![Counts::default(); shares],
            unused: Vec::new(),
        };
        for (t, tet) in (slots.start as u32..).zip(&self.tets[slots.clone()]) {
            if tet[0] == UNUSED {
                found.unused.push(t);
            } else {
                let last = &self.last[tet[0].index()];
                let before = if self.shared {
                    last.swap(t, Relaxed)
                } else {
                    let before = last.load(Relaxed);
                    last.store(t, Relaxed);
                    before
                };
                self.of[t as usize].store(before, Relaxed);
                let counts = &mut found.by_share[tet[0].index() >> self.share_shift];
                match tet[3] {
                    INFINITE => counts.infinite += 1,
                    _ => counts.finite += 1,
                }
            }
        }
        found
    }

    /// The list of these slots in order. Comparing all with all takes no branch that could be foreseen wrongly.
    #[inline(always)]
    fn number_few<R: Registers>(
        &self,
        registers: R,
        slots: &[u32],
        keys: &mut [f64; MOST_COMPARED],
        next: &mut Counts,
    ) {
        let mut infinite = 0;
        for (key, &t) in keys.iter_mut().zip(slots) {
            *key = self.key(t);
            infinite += u32::from(*key < FIRST_FINITE);
        }
        let fours = slots.len().div_ceil(4);
        keys[slots.len()..4 * fours].fill(f64::INFINITY);
        for (&t, &key) in slots.iter().zip(&*keys) {
            let key = registers.set([key; 4]);
            let mut rank = 0;
            for others in &keys.as_chunks::<4>().0[..fours] {
                rank += registers.greater(key, registers.set(*others)).count_ones();
            }
            let place = match rank < infinite {
                true => next.infinite + rank,
                false => next.finite + rank - infinite,
            };
            self.of[t as usize].store(place, Relaxed);
        }
        next.infinite += infinite;
        next.finite += slots.len() as u32 - infinite;
    }

    #[cold]
    fn number_many(&self, slots: &[u32], next: &mut Counts) {
        let mut keyed: Vec<(f64, u32)> = slots.iter().map(|&t| (self.key(t), t)).collect();
        keyed.sort_unstable_by(|one, other| one.0.total_cmp(&other.0));
        for (key, t) in keyed {
            let next = match key < FIRST_FINITE {
                true => &mut next.infinite,
                false => &mut next.finite,
            };
            self.of[t as usize].store(*next, Relaxed);
            *next += 1;
        }
    }

    /// What tetrahedra of one latest vertex are ordered by: the least corner, that at infinity before all others, then the
    /// second one. As the bits of a number between 2 and infinity, which are in the order of these numbers.
    #[inline(always)]
    fn key(&self, slot: u32) -> f64 {
        let [_, second, _, least] = self.tets[slot as usize];
        const { assert!(MOST_VERTICES <= 1 << 28) };
        f64::from_bits(1 << 62 | u64::from(least.0) << 32 | u64::from(second.0))
    }
}

/// Some of the lists, and the first places of what is in them.
struct Numbering<'a> {
    lists: &'a Lists<'a>,
    last: &'a [AtomicU32],
    next: Counts,
}

impl Vectorized for Numbering<'_> {
    type Output = ();

    /// Each list in order, and in place of the list the places.
    ///
    /// Of two tetrahedra with the same latest and least corners no two have the same second one: they would share a facet
    /// and lie on the same side of it.
    #[inline(always)]
    fn run<R: Registers>(self, registers: R) {
        let Self {
            lists,
            last: all,
            mut next,
        } = self;
        let Lists { tets, of, .. } = *lists;
        /// So many lists are followed before their tetrahedra are looked at, which are asked for meanwhile; as the ends of
        /// the lists after these are.
        const FOLLOWED: usize = 16;
        let mut slots = Vec::new();
        let mut ends = Vec::with_capacity(FOLLOWED);
        let mut keys = [f64::INFINITY; MOST_COMPARED];
        let mut following = all.chunks(FOLLOWED).skip(1);
        for last in all.chunks(FOLLOWED) {
            for next in following.next().unwrap_or_default() {
                prefetch_index(of, next.load(Relaxed) as usize);
            }
            slots.clear();
            ends.clear();
            for last in last {
                let mut t = last.load(Relaxed);
                while t != NONE {
                    prefetch_index(tets, t as usize);
                    slots.push(t);
                    t = of[t as usize].load(Relaxed);
                }
                ends.push(slots.len());
            }
            let mut start = 0;
            for &end in &ends {
                let slots = &slots[start..end];
                if slots.len() <= MOST_COMPARED {
                    lists.number_few(registers, slots, &mut keys, &mut next);
                } else {
                    lists.number_many(slots, &mut next);
                }
                start = end;
            }
        }
    }
}
