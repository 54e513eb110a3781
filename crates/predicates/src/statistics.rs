//! Which stage decided how many calls, counted per thread.
//!
//! The counters exist only with the feature `statistics`; without it nothing is counted and nothing is
//! paid. A call of a perturbed predicate counts as the plain predicates that it asks, and once more under
//! [`Stage::Perturbation`] when these leave a tie.
//!
#![cfg_attr(
    feature = "statistics",
    doc = "```
use pellicle_predicates::{insphere, statistics::{self, Predicate, Stage}};
use glam::DVec3;
statistics::reset();
insphere(DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z, DVec3::splat(0.3));
let counts = statistics::snapshot();
assert_eq!(counts.of(Predicate::InSphere, Stage::SemiStatic), 1);
```"
)]

/// A predicate that decides in stages.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Predicate {
    /// [`orient2d`](crate::orient2d).
    Orient2d,
    /// [`orient3d`](crate::orient3d).
    Orient3d,
    /// [`incircle`](crate::incircle).
    InCircle,
    /// [`insphere`](crate::insphere).
    InSphere,
    /// [`power_test`](crate::power_test).
    PowerTest,
}

/// What can decide a call, in the order in which it is tried.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Stage {
    /// One comparison with a bound known from the box of the points.
    Static,
    /// A bound computed from the coordinate differences of the call.
    SemiStatic,
    /// Exact 128-bit integers, for coordinates on a coarse lattice.
    Lattice,
    /// Exact integers of fixed width, for coordinates of like magnitude.
    FixedWidth,
    /// Interval arithmetic.
    Interval,
    /// Exact integers of any width.
    AnyWidth,
    /// A tie, decided by symbolic perturbation.
    Perturbation,
}

impl Predicate {
    /// Every predicate.
    pub const ALL: [Self; 5] = [
        Self::Orient2d,
        Self::Orient3d,
        Self::InCircle,
        Self::InSphere,
        Self::PowerTest,
    ];
}

impl Stage {
    /// Every stage, in the order in which they are tried.
    pub const ALL: [Self; 7] = [
        Self::Static,
        Self::SemiStatic,
        Self::Lattice,
        Self::FixedWidth,
        Self::Interval,
        Self::AnyWidth,
        Self::Perturbation,
    ];
}

const PREDICATES: usize = Predicate::ALL.len();
const STAGES: usize = Stage::ALL.len();

/// The number of calls by predicate and stage.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    calls: [[u64; STAGES]; PREDICATES],
}

impl Counts {
    /// How many calls of `predicate` the `stage` decided.
    pub fn of(&self, predicate: Predicate, stage: Stage) -> u64 {
        self.calls[predicate as usize][stage as usize]
    }
}

#[cfg(feature = "statistics")]
thread_local! {
    static COUNTS: std::cell::Cell<Counts> = const {
        std::cell::Cell::new(Counts { calls: [[0; STAGES]; PREDICATES] })
    };
}

/// What this thread has counted since its start or the last [`reset`].
#[cfg(feature = "statistics")]
pub fn snapshot() -> Counts {
    COUNTS.get()
}

/// Starts this thread's counting anew.
#[cfg(feature = "statistics")]
pub fn reset() {
    COUNTS.set(Counts::default());
}

/// Counts one decision.
#[inline(always)]
pub(crate) fn decided(predicate: Predicate, stage: Stage) {
    #[cfg(feature = "statistics")]
    {
        let mut counts = COUNTS.get();
        counts.calls[predicate as usize][stage as usize] += 1;
        COUNTS.set(counts);
    }
    #[cfg(not(feature = "statistics"))]
    let _ = (predicate, stage);
}
