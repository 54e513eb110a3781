//! Watching long work, and stopping it.

use std::ops::ControlFlow;

/// An observer of long work; `()` observes nothing and never stops.
///
/// ```
/// use pellicle_geometry::Progress;
/// use std::ops::ControlFlow;
///
/// struct Limit(u64);
/// impl Progress for Limit {
///     fn step(&self, _stage: &'static str, done: u64, _total: u64) -> ControlFlow<()> {
///         if done > self.0 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
///     }
/// }
/// assert!(Limit(5).step("insert", 6, 10).is_break());
/// ```
pub trait Progress: Sync {
    /// `done` of `total` units of `stage` are finished; `Break` asks for the work to stop.
    ///
    /// Called often enough that a stop takes effect within a fraction of a second, and from any thread.
    fn step(&self, stage: &'static str, done: u64, total: u64) -> ControlFlow<()>;
}

impl Progress for () {
    #[inline]
    fn step(&self, _stage: &'static str, _done: u64, _total: u64) -> ControlFlow<()> {
        ControlFlow::Continue(())
    }
}

/// The work was stopped by its [`Progress`] observer; there is no result.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("cancelled")]
pub struct Cancelled;

impl Cancelled {
    /// `Err(Cancelled)` on `Break`, for use with `?`.
    #[inline]
    pub fn check(flow: ControlFlow<()>) -> Result<(), Self> {
        match flow {
            ControlFlow::Continue(()) => Ok(()),
            ControlFlow::Break(()) => Err(Self),
        }
    }
}
