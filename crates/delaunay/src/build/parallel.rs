//! Insertion by several threads at once into one tetrahedralisation.
//!
//! The result is unique, so the order of insertion is free. Each round of the order is cut into as many
//! stretches of the Hilbert curve as there are workers, which so work far from each other. Where two meet
//! all the same, marks decide:
//!
//! 1. A worker *claims* each tetrahedron that it finds in conflict: it changes the mark from "at rest" to
//!    its own, or fails. It never waits.
//! 2. From a claimed tetrahedron it looks at the four neighbours. One that carries another's mark ends the
//!    insertion: all claims are released, and the point is tried again later.
//! 3. When the whole conflict region is claimed, and no neighbour of it is, its boundary cannot change:
//!    whoever wants to remove a tetrahedron behind the boundary claims it and looks at *its* neighbours,
//!    ours among them. Claims and looks are sequentially consistent, so of two such workers at least one
//!    sees the other.
//! 4. New tetrahedra carry the mark until all twins are set.
//!
//! A twin may have been read just before a neighbour's replacement was complete, and the neighbour's slot
//! be at rest again, in another place. The replacement sets our twin before its marks go, so reading the
//! twin once more after the mark shows it ([`Worker::dig`]).
//!
//! Walks read without any claim and may see anything; what they find is claimed and then tested.

use super::{
    cells::KEPT,
    kernel::Kernel,
    worker::{Outcome, Worker},
};
use crate::Error;
use pellicle_geometry::{Cancelled, Progress, VertexId};
use pellicle_predicates::lanes::{Registers, Vectorized, vectorized};
use std::{
    ops::Range,
    sync::atomic::{AtomicBool, AtomicUsize, Ordering::Relaxed},
};

/// Points that a worker takes at once, and that are inserted between two calls of the observer: a
/// millisecond's work.
const CHUNK: usize = 512;

/// Rounds with fewer points are one thread's work.
const LEAST_SHARED_ROUND: usize = 8192;

/// How often a worker tries again what others were in the way of, before it leaves it to the end.
const ATTEMPTS: usize = 4;

/// As many as there are marks for.
const MOST_WORKERS: usize = KEPT as usize - 1;

/// Inserts the points after the first four, round by round.
pub(super) fn insert_all(kernel: &mut Kernel, progress: &dyn Progress) -> Result<(), Error> {
    let end = kernel.points.len();
    let threads = rayon::current_num_threads().clamp(1, MOST_WORKERS);
    let mut workers: Vec<Crew> = (0..threads).map(|index| Crew::new(index, end)).collect();
    let mut start = 5.min(end);
    for round_end in round_ends(end) {
        let count = if round_end - start < LEAST_SHARED_ROUND {
            1
        } else {
            threads
        };
        kernel.spread(round_end as f64 / start as f64, count);
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

/// A worker and what it still has to insert.
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

/// Consecutive points that workers take chunks of.
struct Stretch {
    next: AtomicUsize,
    end: usize,
}

impl Stretch {
    fn take(&self) -> Option<Range<usize>> {
        let start = self.next.fetch_add(CHUNK, Relaxed);
        (start < self.end).then(|| start..(start + CHUNK).min(self.end))
    }

    fn left(&self) -> usize {
        self.end.saturating_sub(self.next.load(Relaxed))
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
}

impl<'a> Round<'a> {
    fn new(points: Range<usize>, workers: usize, progress: &'a dyn Progress, total: u64) -> Self {
        let cut = |k: usize| points.start + points.len() * k / workers;
        Self {
            stretches: (0..workers)
                .map(|k| Stretch {
                    next: AtomicUsize::new(cut(k)),
                    end: cut(k + 1),
                })
                .collect(),
            full: AtomicBool::new(false),
            cancelled: AtomicBool::new(false),
            done: AtomicUsize::new(points.start),
            progress,
            total,
        }
    }

    /// Until all points of the round are inserted, together and at last alone.
    fn run(mut self, kernel: &mut Kernel, crews: &mut [Crew]) -> Result<(), Error> {
        while !self.is_over(crews) {
            if *self.full.get_mut() {
                kernel.grow()?;
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

    fn is_over(&self, crews: &[Crew]) -> bool {
        self.stretches.iter().all(|stretch| stretch.left() == 0)
            && crews.iter().all(|crew| crew.postponed.is_empty())
    }

    fn turn<const SHARED: bool>(&self, kernel: &Kernel, index: usize, crew: &mut Crew) {
        vectorized(Turn::<SHARED> {
            round: self,
            kernel,
            index,
            crew,
        });
    }

    /// A chunk of the worker's own stretch, or of the one with most left.
    fn take(&self, index: usize) -> Option<Range<usize>> {
        self.stretches[index].take().or_else(|| {
            let fullest = self.stretches.iter().max_by_key(|stretch| stretch.left())?;
            fullest.take()
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
struct Turn<'a, const SHARED: bool> {
    round: &'a Round<'a>,
    kernel: &'a Kernel,
    index: usize,
    crew: &'a mut Crew,
}

impl<const SHARED: bool> Vectorized for Turn<'_, SHARED> {
    type Output = ();

    #[inline(always)]
    fn run<R: Registers>(self, registers: R) {
        let Self {
            round,
            kernel,
            index,
            crew,
        } = self;
        let mut pending = std::mem::take(&mut crew.postponed);
        let mut attempts = 0;
        loop {
            for (k, &vertex) in pending.iter().enumerate() {
                let worker = &mut crew.worker;
                let outcome = match kernel.weights.is_empty() {
                    true => {
                        let point = kernel.point(vertex);
                        worker.insert::<SHARED, R>(registers, kernel, vertex, point)
                    }
                    false => worker.insert_weighted::<SHARED, R>(registers, kernel, vertex),
                };
                match outcome {
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
                pending.extend(chunk.map(VertexId::new));
            } else if !crew.postponed.is_empty() && attempts < ATTEMPTS {
                attempts += 1;
                std::mem::swap(&mut pending, &mut crew.postponed);
            } else {
                return;
            }
        }
    }
}
