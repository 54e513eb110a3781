//! Cheap approximate inverses.

use super::{Columns, CsrMatrix, columns};

/// A fixed linear operator that approximates the inverse of a matrix.
pub trait Preconditioner {
    /// `solution` ≈ A⁻¹ `vector`, for each column of the vector.
    ///
    /// Both have as many values as the matrix has rows; may panic otherwise. The operator is linear and stays the same
    /// until it is refreshed.
    fn apply<V: Columns>(&mut self, vector: &[V], solution: &mut [V]);
}

/// The identity: no preconditioning.
#[derive(Clone, Copy, Debug, Default)]
pub struct NoPreconditioner;

impl Preconditioner for NoPreconditioner {
    fn apply<V: Columns>(&mut self, vector: &[V], solution: &mut [V]) {
        solution.copy_from_slice(vector);
    }
}

/// The inverse of the diagonal.
///
/// A zero on the diagonal, or any value without a finite inverse, counts as one.
#[derive(Clone, Debug, Default)]
pub struct Jacobi {
    inverse: Vec<f64>,
}

impl Jacobi {
    /// The preconditioner of a matrix. Time O(rows).
    #[must_use]
    pub fn new(matrix: &CsrMatrix) -> Self {
        let mut jacobi = Self::default();
        jacobi.refresh(matrix);
        jacobi
    }

    /// Takes the diagonal of another matrix. Allocates only where that has more rows.
    pub fn refresh(&mut self, matrix: &CsrMatrix) {
        let diagonal = matrix.pattern().diagonal().iter();
        let inverse = diagonal.map(|&entry| inverse_or_one(matrix.values()[entry as usize]));
        self.inverse.clear();
        self.inverse.extend(inverse);
    }
}

impl Preconditioner for Jacobi {
    fn apply<V: Columns>(&mut self, vector: &[V], solution: &mut [V]) {
        columns::update(solution, |first, rows| {
            let inverse = &self.inverse[first..];
            let vector = &vector[first..];
            for ((out, &value), &inverse) in rows.iter_mut().zip(vector).zip(inverse) {
                *out = value * inverse;
            }
            []
        });
    }
}

/// 1 / `value`, or one where that is not finite.
pub(super) fn inverse_or_one(value: f64) -> f64 {
    let inverse = value.recip();
    if inverse.is_finite() { inverse } else { 1.0 }
}
