//! The figures of Zaharescu et al. 2007: TransforMesh.

use crate::Figure;

/// All of them, in the paper's order.
pub const FIGURES: &[Figure] = &[];
