//! From the kernel's arrays to the caller's vertices.

use super::{
    cells::MOST_VERTICES,
    kernel::{INFINITE, Kernel},
};
use crate::{
    FacetId, TetId, Tetrahedralization, id::facet_vertices, tetrahedralization::last_incident,
};
use glam::DVec3;
use pellicle_geometry::VertexId;
use pellicle_predicates::lanes::{Registers, Vectorized, vectorized};
use prefetch_index::prefetch_index;
use rayon::prelude::*;
use std::{
    ops::Range,
    sync::atomic::{AtomicU32, Ordering::Relaxed},
};

impl Kernel {
    /// Puts the tetrahedra into an order that does not depend on how they came to be, and names the
    /// caller's vertices.
    ///
    /// The order: by the vertex that comes last in the order of insertion, then by the other corners;
    /// infinite ones after all others.
    pub(super) fn finish<'a>(
        self,
        points: &'a [DVec3],
        order: &[u32],
        duplicates: Vec<(VertexId, VertexId)>,
    ) -> Tetrahedralization<'a> {
        let vertices = self.points.len();
        let cells = self.cells;
        drop(self.points);
        let (mut tets, mut twins) = cells.into_plain();
        latest_first(&mut tets, &mut twins);
        let Places {
            mut of,
            finite,
            used,
        } = places(&tets, vertices);
        twins.par_iter_mut().for_each(|twins| {
            *twins = twins.map(|twin| FacetId::of(TetId(of[twin.tet().index()]), twin.corner()));
        });
        Rows::new(&mut of, &mut tets, &mut twins).arrange();
        drop(of);
        tets.truncate(used);
        twins.truncate(used);
        tets.shrink_to_fit();
        twins.shrink_to_fit();
        // The kernel's vertices lie about as the tetrahedra do, the caller's anywhere.
        let last = last_incident(vertices, &tets[..finite]);
        let mut incident = vec![TetId::NONE; points.len()];
        for (&vertex, &tet) in order.iter().zip(&last[1..]) {
            incident[vertex as usize] = tet;
        }
        tets.par_iter_mut().for_each(|tet| {
            *tet = tet.map(|vertex| match vertex {
                INFINITE => Tetrahedralization::INFINITE,
                VertexId(vertex) => VertexId(order[vertex as usize - 1]),
            });
        });
        Tetrahedralization::from_arrays(points, tets, twins, finite, incident, duplicates)
    }
}

/// Turns the tetrahedra such that the corner inserted last comes first and the least one last. Those that
/// one thread made are so already.
fn latest_first(tets: &mut [[VertexId; 4]], twins: &mut [[FacetId; 4]]) {
    for t in 0..tets.len() {
        let [a, b, c, d] = tets[t];
        if a == UNUSED || (a > b && a > c && d < b && d < c) {
            continue;
        }
        let latest = (0..4).max_by_key(|&i| tets[t][i]).unwrap_or(0);
        let mut turned = [0; 4];
        turned[0] = latest;
        // (corner, facet opposite it) is odd, so the facet is turned around.
        let [x, y, z] = facet_vertices([0, 1, 2, 3].map(VertexId), latest);
        let [x, y, z] = [y.index(), x.index(), z.index()];
        let least = [x, y, z].into_iter().min_by_key(|&i| tets[t][i]);
        let facet = if least == Some(x) {
            [y, z, x]
        } else if least == Some(y) {
            [z, x, y]
        } else {
            [x, y, z]
        };
        turned[1..].copy_from_slice(&facet);
        let (tet, mut around) = (tets[t], twins[t]);
        // Twins within the tetrahedron itself do not occur, so one after the other may be told.
        around = turned.map(|i| around[i]);
        tets[t] = turned.map(|i| tet[i]);
        twins[t] = around;
        for (corner, twin) in around.into_iter().enumerate() {
            twins[twin.tet().index()][twin.corner()] = FacetId::of(TetId::new(t), corner);
        }
    }
}

/// No slot.
const NONE: u32 = u32::MAX;

/// The first corner of a slot without a tetrahedron.
const UNUSED: VertexId = VertexId::NONE;

/// Up to this many tetrahedra of one latest vertex, all are compared with all.
const MOST_COMPARED: usize = 64;

/// The least [key](Lists::key) of a finite tetrahedron.
const FIRST_FINITE: f64 = f64::from_bits(1 << 62 | 1 << 32);

/// Where the tetrahedra go.
struct Places {
    /// By slot the place in the result; those of slots without a tetrahedron come last.
    of: Vec<u32>,
    /// How many places are finite tetrahedra'.
    finite: usize,
    /// How many are tetrahedra's.
    used: usize,
}

fn places(tets: &[[VertexId; 4]], vertices: usize) -> Places {
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
    Places {
        of: of.into_iter().map(AtomicU32::into_inner).collect(),
        finite: finite as usize,
        used: used as usize,
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

/// Some of the tetrahedra, side by side, and where in the result each goes.
struct Rows<'a> {
    /// The place of the first.
    start: u32,
    of: &'a mut [u32],
    tets: &'a mut [[VertexId; 4]],
    twins: &'a mut [[FacetId; 4]],
}

impl<'a> Rows<'a> {
    fn new(
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
    fn arrange(mut self) {
        const SHARE: u32 = 20;
        // A copy needs little memory beside all the others, and stays in the cache.
        let block = (self.of.len().max(1).ilog2().saturating_sub(6)).clamp(12, 17);
        if rayon::current_num_threads() == 1 {
            self.move_into_places(block);
        } else {
            self.move_into_blocks(SHARE);
            (self.chunks(SHARE).into_par_iter()).for_each(|share| share.move_into_places(block));
        }
    }

    /// By way of blocks of two to this power.
    fn move_into_places(mut self, block: u32) {
        self.move_into_blocks(block);
        for rows in self.chunks(block) {
            let place = |slot: usize| (rows.of[slot] - rows.start) as usize;
            permute(rows.tets, place);
            permute(rows.twins, place);
        }
    }

    fn chunks(&mut self, size: u32) -> Vec<Rows<'_>> {
        let size = 1 << size;
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

    /// Each into its block of so many places.
    fn move_into_blocks(&mut self, shift: u32) {
        let size = 1 << shift;
        let count = self.of.len();
        if count <= size {
            return;
        }
        let start = self.start;
        let home = |place: u32| ((place - start) >> shift) as usize;
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
