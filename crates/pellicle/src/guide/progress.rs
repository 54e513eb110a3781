//! Watching long work, and stopping it.
//!
//! The `…_with` functions, and those with an argument of that type, take a [`Progress`](crate::geometry::Progress) observer;
//! `&()` observes nothing. Its `Break` ends the work with an error, never with half a result. It is asked from any thread,
//! often enough that a stop takes effect within a fraction of a second.
//!
//! ```
//! use pellicle::delaunay::{Error, Options, tetrahedralize_with};
//! use pellicle::prelude::*;
//! use std::ops::ControlFlow;
//!
//! struct Stop;
//! impl Progress for Stop {
//!     fn step(&self, _stage: &'static str, _done: u64, _total: u64) -> ControlFlow<()> {
//!         ControlFlow::Break(())
//!     }
//! }
//! let points: Vec<DVec3> = (0..5000_u32)
//!     .map(|i| DVec3::new(f64::from(i % 17), f64::from(i % 19), f64::from(i % 23)))
//!     .collect();
//! let stopped = tetrahedralize_with(&points, &Options::default(), &Stop);
//! assert!(matches!(stopped, Err(Error::Cancelled(_))));
//! ```
//!
//! The libraries print nothing: what they have to say besides are `tracing` events. Threads are those of the `rayon` pool
//! that the call is made in; their number changes no result.
