//! The figures of Daniel 2015: direct surface evolution.

use crate::Figure;

/// All of them, in the paper's order.
pub const FIGURES: &[Figure] = &[];
