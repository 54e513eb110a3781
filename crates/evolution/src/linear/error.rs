//! What can go wrong with a linear system.

use thiserror::Error;

/// An iteration that ended before its tolerance was met.
///
/// The vector of unknowns then holds the last iterate.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[error("no convergence: relative residual {residual:.3e} after {iterations} iterations")]
pub struct NotConverged {
    /// ‖b − Ax‖ / ‖b‖ of the last iterate, the largest of all right-hand sides; not finite where a value was not.
    pub residual: f64,
    /// Iterations done.
    pub iterations: usize,
}

/// What can go wrong with a linear system.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum LinearError {
    /// The iteration did not reach its tolerance: the matrix is singular or ill-conditioned, a value is not finite, or
    /// the tolerance or the limit is too small.
    #[error(transparent)]
    NotConverged(#[from] NotConverged),
    /// A vector, or the values of a matrix, have another length than the pattern.
    #[error("{found} values where the matrix takes {expected}")]
    WrongLength {
        /// What the matrix takes.
        expected: usize,
        /// What was given.
        found: usize,
    },
    /// A preconditioner or factor was made for a matrix of another pattern.
    #[error("the matrix has another pattern than the one analysed")]
    WrongPattern,
    /// A row or column lies outside the matrix, or outside its pattern.
    #[error("row {row} has no entry in column {column}")]
    NoEntry {
        /// The row.
        row: usize,
        /// The column.
        column: usize,
    },
    /// More rows or entries than a `u32` counts.
    #[error("a matrix of {0} rows or entries is too large")]
    TooLarge(usize),
    /// A symmetric matrix is not positive definite: nothing is pinned, the mesh has several components, or a triangle has
    /// no area.
    #[error("the matrix is not positive definite: no positive pivot in row {row}")]
    NotPositiveDefinite {
        /// The row.
        row: usize,
    },
}
