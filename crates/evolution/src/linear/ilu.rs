//! Incomplete factors without fill.

use super::preconditioner::inverse_or_one;
use super::{Columns, CsrMatrix, CsrPattern, LinearError, Preconditioner};
use std::sync::Arc;

/// A pivot that keeps less than this part of its diagonal entry is rounding, or worse.
const SMALLEST_PIVOT: f64 = 1e-6;

/// Incomplete LU factors on the pattern of the matrix, ILU(0) (Saad 2003, algorithm 10.4): A ≈ L U, with L unit lower
/// triangular, exact on the pattern.
///
/// A pivot that loses the sign of its diagonal entry, or all but a millionth of it, is replaced by that entry; so the
/// factors of a symmetric positive definite matrix make a symmetric positive definite preconditioner (up to rounding),
/// also where obtuse angles make positive entries. Sequential; time O(Σ over rows of entries²) to factorise, O(entries)
/// to apply.
#[derive(Clone, Debug)]
pub struct Ilu0 {
    pattern: Arc<CsrPattern>,
    /// L below the diagonal, U above it, the inverses of U's diagonal on it.
    values: Vec<f64>,
    /// The entry of the present row in each column.
    entry_in: Vec<u32>,
}

const NONE: u32 = u32::MAX;

impl Ilu0 {
    /// Factorises a matrix.
    #[must_use]
    pub fn new(matrix: &CsrMatrix) -> Self {
        let mut ilu = Self {
            pattern: Arc::clone(matrix.pattern()),
            values: matrix.values().to_vec(),
            entry_in: vec![NONE; matrix.rows()],
        };
        ilu.factorise();
        ilu
    }

    /// Whether a matrix has the pattern that was analysed.
    #[must_use]
    pub fn fits(&self, matrix: &CsrMatrix) -> bool {
        matrix.has_pattern(&self.pattern)
    }

    /// Factorises another matrix of the same pattern, without allocating.
    ///
    /// # Errors
    ///
    /// [`LinearError::WrongPattern`].
    pub fn refresh(&mut self, matrix: &CsrMatrix) -> Result<(), LinearError> {
        if !self.fits(matrix) {
            return Err(LinearError::WrongPattern);
        }
        self.values.copy_from_slice(matrix.values());
        self.factorise();
        Ok(())
    }

    /// 1. For each entry left of the diagonal, in order: its multiplier l.
    /// 2. Subtract l times the row of U that it names, where this row has entries.
    /// 3. Invert the pivot.
    fn factorise(&mut self) {
        let pattern = &*self.pattern;
        let (columns, diagonal) = (pattern.columns(), pattern.diagonal());
        for row in 0..pattern.rows() {
            let entries = pattern.row(row);
            let own = diagonal[row] as usize;
            let before = self.values[own];
            for entry in entries.clone() {
                self.entry_in[columns[entry] as usize] = entry as u32;
            }
            for left in entries.start..own {
                let pivot = columns[left] as usize;
                let right = diagonal[pivot] as usize;
                let multiplier = self.values[left] * self.values[right];
                self.values[left] = multiplier;
                let upper = right + 1..pattern.row(pivot).end;
                for (&column, upper) in columns[upper.clone()].iter().zip(upper) {
                    let target = self.entry_in[column as usize];
                    if target != NONE {
                        self.values[target as usize] -= multiplier * self.values[upper];
                    }
                }
            }
            for entry in entries {
                self.entry_in[columns[entry] as usize] = NONE;
            }
            let pivot = &mut self.values[own];
            let keeps = *pivot / before > SMALLEST_PIVOT;
            *pivot = inverse_or_one(if keeps { *pivot } else { before });
        }
    }
}

impl Preconditioner for Ilu0 {
    fn apply<V: Columns>(&mut self, vector: &[V], solution: &mut [V]) {
        let pattern = &*self.pattern;
        let sum = |entries: std::ops::Range<usize>, solution: &[V]| {
            let columns = pattern.columns()[entries.clone()].iter();
            let mut sum = V::ZERO;
            for (&column, &value) in columns.zip(&self.values[entries]) {
                sum += solution[column as usize] * value;
            }
            sum
        };
        for row in 0..pattern.rows() {
            let left = pattern.row(row).start..pattern.diagonal()[row] as usize;
            solution[row] = vector[row] - sum(left, solution);
        }
        for row in (0..pattern.rows()).rev() {
            let own = pattern.diagonal()[row] as usize;
            let right = own + 1..pattern.row(row).end;
            solution[row] = (solution[row] - sum(right, solution)) * self.values[own];
        }
    }
}
