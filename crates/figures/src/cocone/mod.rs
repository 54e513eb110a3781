//! The figures of Chapter 4 of Dey 2006: Cocone.

use crate::Figure;

/// All of them, in the paper's order.
pub const FIGURES: &[Figure] = &[];
