//! Insertion by several threads at once into one tetrahedralisation.
//!
//! The result is unique, so the order of insertion is free. Each round of the order is cut into as many
//! stretches of the Hilbert curve as there are workers, which so work far from each other. Where two meet
//! all the same, [`blocks`](super::blocks) of slots decide:
//!
//! 1. A worker reads and writes only tetrahedra in blocks that it *holds*; the new ones too. A block that nobody
//!    holds it takes, and holds from then on. So what one insertion sees is whole, and what it leaves is.
//! 2. When another holds the block, the insertion ends before it has changed anything, and the point is tried again
//!    later. The other is told, and lets *all* its blocks go before its next insertion. Nobody waits.
//! 3. Whoever lets a block go publishes what it wrote; whoever takes it sees that.
//!
//! On samples of volumes two workers hardly ever meet, and a block is taken once for hundreds of insertions. On
//! surfaces they meet often, since long tetrahedra cross the inside, and hold few blocks at a time.
//!
//! Walks read what they do not hold, and may see anything; where they end is held and then tested.

use super::{
    blocks::Blocks,
    conflict::Query,
    kernel::Kernel,
    weighted::Weighted,
    worker::{Outcome, Worker},
};
use crate::Error;
use glam::DVec3;
use pellicle_geometry::{Cancelled, Progress, VertexId};
use pellicle_predicates::lanes::{Registers, Vectorized, vectorized};
use std::{
    marker::PhantomData,
    ops::Range,
    sync::atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering::Relaxed},
};

/// Points that a worker takes at once, and that are inserted between two calls of the observer: a
/// millisecond's work.
const CHUNK: usize = 512;

/// Rounds with fewer points are one thread's work.
const LEAST_SHARED_ROUND: usize = 8192;

/// The part of the tetrahedra to expect from the last round that are sure to come: grids end with fewer a point than their
/// subsets. For the others room is made when they come.
const LEAST_SHARE: f64 = 0.875;

/// Before the last round there is room for more than those to expect: what is added behind all others lies far from its
/// neighbours in the next round.
const AMPLE_SHARE: f64 = 1.03;

/// How often a worker tries again what others were in the way of, before it leaves it to the end.
const ATTEMPTS: usize = 4;

/// Inserts the points after the first four, round by round.
pub(super) fn insert_all(kernel: &mut Kernel, progress: &dyn Progress) -> Result<(), Error> {
    let end = kernel.points.len();
    let threads = rayon::current_num_threads().clamp(1, Blocks::MOST_WORKERS);
    let mut workers: Vec<Crew> = (0..threads).map(|index| Crew::new(index, end)).collect();
    let mut start = 5.min(end);
    let mut trend = Trend::default();
    for round_end in round_ends(end) {
        let count = if round_end - start < LEAST_SHARED_ROUND {
            1
        } else {
            threads
        };
        let tets = kernel.count();
        let growth = trend.growth(start, tets, round_end);
        let room = match round_end == end {
            true => LEAST_SHARE * round_end as f64 / start as f64,
            false => AMPLE_SHARE * growth,
        };
        kernel.spread(growth, (tets as f64 * room) as usize, count);
        for (index, crew) in workers[..count].iter_mut().enumerate() {
            crew.worker.start_round(kernel.first_of_region(index));
        }
        let round = Round::new(start..round_end, count, progress, end as u64);
        round.run(kernel, &mut workers[..count])?;
        start = round_end;
    }
    Ok(())
}

/// Each round holds seven eighths of the points that are left before it, counted from the last.
fn round_ends(points: usize) -> impl Iterator<Item = usize> {
    (0..=20)
        .rev()
        .map(move |round| points >> (3 * round))
        .filter(|&end| end > 5)
}

/// How many tetrahedra a point has, which may become more from round to round (on some surfaces by a tenth) or fewer.
#[derive(Default)]
struct Trend {
    /// Before the last round.
    by_point: Option<f64>,
}

impl Trend {
    /// By how much the tetrahedra of `points` points will have been multiplied when there are `more` points.
    fn growth(&mut self, points: usize, tets: usize, more: usize) -> f64 {
        let by_point = tets as f64 / points as f64;
        let before = self.by_point.replace(by_point).unwrap_or(by_point);
        // By as much more as in the last round, within reason.
        let trend = (2.0 - before / by_point).clamp(0.8, 1.25);
        trend * more as f64 / points as f64
    }
}

/// A worker and what it still has to insert; away from what other threads write to.
#[repr(align(128))]
struct Crew {
    worker: Worker,
    postponed: Vec<VertexId>,
}

impl Crew {
    fn new(index: usize, vertices: usize) -> Self {
        Self {
            worker: Worker::new(index, vertices),
            postponed: Vec::new(),
        }
    }
}

/// Consecutive points that a worker takes chunks of from the front, and others half from the back: the next one in the
/// upper, the end in the lower half of the word.
#[repr(align(128))]
struct Stretch(AtomicU64);

impl Stretch {
    fn new(points: Range<usize>) -> Self {
        Self(AtomicU64::new(Self::word(points)))
    }

    fn word(points: Range<usize>) -> u64 {
        (points.start as u64) << 32 | points.end as u64
    }

    fn points(word: u64) -> Range<usize> {
        (word >> 32) as usize..word as u32 as usize
    }

    fn left(&self) -> usize {
        Self::points(self.0.load(Relaxed)).len()
    }

    /// Divides what is left: the points to keep, and those to take.
    fn take(
        &self,
        divide: impl Fn(Range<usize>) -> Option<(Range<usize>, Range<usize>)>,
    ) -> Option<Range<usize>> {
        let keep = |word| divide(Self::points(word)).map(|(kept, _)| Self::word(kept));
        let word = self.0.fetch_update(Relaxed, Relaxed, keep).ok()?;
        divide(Self::points(word)).map(|(_, taken)| taken)
    }

    fn chunk(&self) -> Option<Range<usize>> {
        self.take(|Range { start, end }| {
            let cut = (start + CHUNK).min(end);
            (start < end).then_some((cut..end, start..cut))
        })
    }

    /// Of what the owner is at, only what lies far from there.
    fn back_half(&self) -> Option<Range<usize>> {
        self.take(|Range { start, end }| {
            let cut = start.midpoint(end);
            (end - start >= 4 * CHUNK).then_some((start..cut, cut..end))
        })
    }
}

struct Round<'a> {
    stretches: Vec<Stretch>,
    /// The arrays are full: all workers come back.
    full: AtomicBool,
    cancelled: AtomicBool,
    done: AtomicUsize,
    progress: &'a dyn Progress,
    total: u64,
    /// One after the last point of the round.
    end: usize,
}

impl<'a> Round<'a> {
    fn new(points: Range<usize>, workers: usize, progress: &'a dyn Progress, total: u64) -> Self {
        let cut = |k: usize| points.start + points.len() * k / workers;
        Self {
            stretches: (0..workers)
                .map(|k| Stretch::new(cut(k)..cut(k + 1)))
                .collect(),
            full: AtomicBool::new(false),
            cancelled: AtomicBool::new(false),
            done: AtomicUsize::new(points.start),
            progress,
            total,
            end: points.end,
        }
    }

    /// Until all points of the round are inserted, together and at last alone.
    fn run(mut self, kernel: &mut Kernel, crews: &mut [Crew]) -> Result<(), Error> {
        while !self.is_over(crews) {
            if *self.full.get_mut() {
                let inserted = self.inserted(crews);
                kernel.grow(self.wanted(kernel, inserted), crews.len())?;
                *self.full.get_mut() = false;
            }
            let shared: &Kernel = kernel;
            match &mut *crews {
                [crew] => self.turn::<false>(shared, 0, crew),
                crews => rayon::scope(|scope| {
                    for (index, crew) in crews.iter_mut().enumerate() {
                        let round = &self;
                        scope.spawn(move |_| round.turn::<true>(shared, index, crew));
                    }
                }),
            }
            if *self.cancelled.get_mut() {
                return Err(Cancelled.into());
            }
            if !*self.full.get_mut() {
                // What is left of a shared round, one after the other.
                let left: Vec<VertexId> = crews
                    .iter_mut()
                    .flat_map(|crew| crew.postponed.drain(..))
                    .collect();
                crews[0].postponed = left;
                self.turn::<false>(shared, 0, &mut crews[0]);
            }
        }
        Ok(())
    }

    /// How many points are in the tetrahedralisation.
    fn inserted(&mut self, crews: &[Crew]) -> usize {
        let postponed: usize = crews.iter().map(|crew| crew.postponed.len()).sum();
        *self.done.get_mut() - postponed
    }

    /// How many tetrahedra are to be expected beyond those that fill all slots, when the points to come make as many
    /// as those before: seven eighths of them, so as not to ask for too much.
    fn wanted(&self, kernel: &Kernel, inserted: usize) -> usize {
        let by_point = kernel.slots() as f64 / inserted as f64;
        (0.875 * by_point * (self.end - inserted) as f64) as usize
    }

    fn is_over(&self, crews: &[Crew]) -> bool {
        self.stretches.iter().all(|stretch| stretch.left() == 0)
            && crews.iter().all(|crew| crew.postponed.is_empty())
    }

    fn turn<const SHARED: bool>(&self, kernel: &Kernel, index: usize, crew: &mut Crew) {
        match kernel.weights.is_empty() {
            true => self.turn_with::<SHARED, DVec3>(kernel, index, crew),
            false => self.turn_with::<SHARED, Weighted>(kernel, index, crew),
        }
        crew.worker.held.release(&kernel.blocks);
    }

    fn turn_with<const SHARED: bool, Q: Query>(
        &self,
        kernel: &Kernel,
        index: usize,
        crew: &mut Crew,
    ) {
        vectorized(Turn::<SHARED, Q> {
            round: self,
            kernel,
            index,
            crew,
            query: PhantomData,
        });
    }

    /// A chunk of the worker's own stretch; when that is done, it is given half of what another has left.
    fn take(&self, index: usize) -> Option<Range<usize>> {
        let own = &self.stretches[index];
        own.chunk().or_else(|| {
            let fullest = self.stretches.iter().max_by_key(|stretch| stretch.left())?;
            own.0.store(Stretch::word(fullest.back_half()?), Relaxed);
            own.chunk()
        })
    }

    fn tell(&self, inserted: usize) {
        let done = self.done.fetch_add(inserted, Relaxed) + inserted;
        let step = self
            .progress
            .step("tetrahedralize", done as u64, self.total);
        if step.is_break() {
            self.cancelled.store(true, Relaxed);
        }
    }
}

/// What one thread does in a round.
struct Turn<'a, const SHARED: bool, Q> {
    round: &'a Round<'a>,
    kernel: &'a Kernel,
    index: usize,
    crew: &'a mut Crew,
    /// What the points ask.
    query: PhantomData<Q>,
}

impl<const SHARED: bool, Q: Query> Vectorized for Turn<'_, SHARED, Q> {
    type Output = ();

    #[inline(always)]
    fn run<R: Registers>(self, registers: R) {
        let Self {
            round,
            kernel,
            index,
            crew,
            query: _,
        } = self;
        let mut pending = std::mem::take(&mut crew.postponed);
        let mut attempts = 0;
        let mut patience = Patience::default();
        loop {
            for (k, &vertex) in pending.iter().enumerate() {
                let worker = &mut crew.worker;
                if SHARED {
                    worker.held.yield_if_wanted(&kernel.blocks);
                }
                let query = Q::of_vertex(kernel, vertex);
                match worker.insert::<SHARED, R, Q>(registers, kernel, vertex, query) {
                    Outcome::Inserted | Outcome::Hidden => {}
                    Outcome::Contended => crew.postponed.push(vertex),
                    Outcome::Full => {
                        round.full.store(true, Relaxed);
                        crew.postponed.extend_from_slice(&pending[k..]);
                        return;
                    }
                }
                if SHARED && round.full.load(Relaxed) {
                    crew.postponed.extend_from_slice(&pending[k + 1..]);
                    return;
                }
            }
            pending.clear();
            if round.cancelled.load(Relaxed) {
                return;
            }
            if let Some(chunk) = round.take(index) {
                round.tell(chunk.len());
                if patience.ends(crew.postponed.len()) {
                    pending.append(&mut crew.postponed);
                }
                pending.extend(chunk.map(VertexId::new));
            } else if !crew.postponed.is_empty() && attempts < ATTEMPTS {
                attempts += 1;
                // Perhaps it is the one who runs on this core that is in the way.
                std::thread::yield_now();
                std::mem::swap(&mut pending, &mut crew.postponed);
            } else {
                return;
            }
        }
    }
}

/// When to try again what others were in the way of: the longer a thread in the way stays, as one does that waits for a
/// core, the more seldom.
#[derive(Default)]
struct Patience {
    /// Chunks to the next try.
    left: usize,
    /// Chunks between the last try and the next one.
    interval: usize,
    /// Points that were tried last.
    tried: usize,
}

impl Patience {
    /// With so many points postponed, after another chunk.
    fn ends(&mut self, postponed: usize) -> bool {
        if self.left > 0 {
            self.left -= 1;
            return false;
        }
        self.interval = match postponed >= self.tried && postponed > 0 {
            true => (2 * self.interval + 1).min(64),
            false => 0,
        };
        (self.left, self.tried) = (self.interval, postponed);
        true
    }
}
