//! What the iterations have in common: when they stop, what they work in, and the residual that they report.

use super::csr::check_length;
use super::{Columns, CsrMatrix, LinearError, NotConverged, columns};

/// When an iteration stops.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IterativeOptions {
    /// Largest ‖b − Ax‖ / ‖b‖ of a solution, in each column. Default 1e-10: below what the scheme in time makes of it,
    /// above what rounding leaves of it.
    pub tolerance: f64,
    /// Largest number of iterations. Default: 2000, several times what a cotangent stiffness of 40 962 vertices takes
    /// with the weakest preconditioner.
    pub max_iterations: usize,
}

impl Default for IterativeOptions {
    fn default() -> Self {
        Self {
            tolerance: 1e-10,
            max_iterations: 2000,
        }
    }
}

/// What a solution took.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Convergence {
    /// Iterations done: those of the column that took most.
    pub iterations: usize,
    /// ‖b − Ax‖ / ‖b‖ of the solution, computed from it at the end; the largest of all columns.
    pub residual: f64,
}

/// The vectors of an iteration, kept from one solution to the next. Six values for each row.
#[derive(Clone, Debug, Default)]
pub struct Workspace<V> {
    vectors: Vec<Vec<V>>,
}

impl<V: Columns> Workspace<V> {
    /// `COUNT` vectors of that length; what they hold is left from before.
    pub(super) fn vectors<const COUNT: usize>(&mut self, rows: usize) -> [&mut [V]; COUNT] {
        self.vectors
            .resize_with(COUNT.max(self.vectors.len()), Vec::new);
        let mut vectors = self.vectors.iter_mut();
        std::array::from_fn(|_| {
            let vector = vectors.next().expect("as many as asked for");
            vector.resize(rows, V::ZERO);
            &mut vector[..]
        })
    }
}

/// A x = b, with each column of b scaled by a power of two to a size whose square neither overflows nor vanishes.
pub(super) struct System<'a, V> {
    pub matrix: &'a CsrMatrix,
    right: &'a [V],
    /// What a residual is multiplied by, exactly, to be that of the unscaled system.
    pub scale: V,
    inverse_scale: V,
    /// ‖b‖ after scaling.
    norm: V,
    pub options: &'a IterativeOptions,
}

impl<'a, V: Columns> System<'a, V> {
    /// Columns of `right` that are zero set theirs of `solution` to zero.
    pub fn new(
        matrix: &'a CsrMatrix,
        right: &'a [V],
        solution: &mut [V],
        options: &'a IterativeOptions,
    ) -> Result<Self, LinearError> {
        check_length(matrix.rows(), right.len())?;
        check_length(matrix.rows(), solution.len())?;
        let largest = V::from_columns(|column| {
            right.iter().fold(0.0, |largest, value| {
                value.column(column).abs().max(largest)
            })
        });
        let scale = V::from_columns(|column| power_of_two(largest.column(column)));
        let inverse_scale = V::from_columns(|column| scale.column(column).recip());
        let [squares] = columns::sums(right.len(), |rows| {
            let mut sum = V::ZERO;
            for &value in &right[rows] {
                let scaled = value * inverse_scale;
                sum += scaled * scaled;
            }
            [sum]
        });
        for column in 0..V::COUNT {
            if squares.column(column) == 0.0 {
                for value in &mut *solution {
                    value.set_column(column, 0.0);
                }
            }
        }
        Ok(Self {
            matrix,
            right,
            scale,
            inverse_scale,
            norm: square_root(squares),
            options,
        })
    }

    /// `residual` = (b − A x) / scale; returns its relative norm in each column.
    pub fn residual(&self, solution: &[V], residual: &mut [V]) -> V {
        self.matrix.multiply_and_sum(solution, residual, |_, _| []);
        let [squares] = columns::update(residual, |first, rows| {
            let mut sum = V::ZERO;
            for (out, &right) in rows.iter_mut().zip(&self.right[first..]) {
                *out = (right - *out) * self.inverse_scale;
                sum += *out * *out;
            }
            [sum]
        });
        self.relative(squares)
    }

    /// The relative norm, in each column, of a scaled residual with these squares of norms.
    pub fn relative(&self, squares: V) -> V {
        V::from_columns(|column| {
            let (square, norm) = (squares.column(column), self.norm.column(column));
            if square == 0.0 {
                0.0
            } else {
                square.sqrt() / norm
            }
        })
    }

    pub fn is_met(&self, relative: f64) -> bool {
        relative <= self.options.tolerance
    }

    /// Whether a residual by recursion calls for the true one, which does not fall below rounding whatever is asked.
    pub fn may_be_met(&self, relative: f64) -> bool {
        relative <= self.options.tolerance.max(f64::EPSILON)
    }

    fn not_converged(&self, residual: V, iterations: usize) -> LinearError {
        let residual = worst(residual);
        NotConverged {
            residual,
            iterations,
        }
        .into()
    }
}

/// A recursion that carries its own residual along.
pub(super) trait Process<V> {
    /// r, to be set before a start.
    fn residual(&mut self) -> &mut [V];
    /// Iterations done since the first start.
    fn iterations(&self) -> usize;
    /// Starts at the residual, whose relative norms these are.
    fn start(&mut self, relative: V);
    /// Iterates until the recursion has every column converged, can do no more, or is at the limit of iterations;
    /// `false` where a value is not finite.
    fn run(&mut self, solution: &mut [V]) -> bool;
}

/// Runs a process, and again from the true residual for as long as that falls, until it is small in each column.
pub(super) fn drive<V: Columns>(
    system: &System<V>,
    solution: &mut [V],
    process: &mut impl Process<V>,
) -> Result<Convergence, LinearError> {
    let mut before = V::from_columns(|_| f64::INFINITY);
    loop {
        let relative = system.residual(solution, process.residual());
        if (0..V::COUNT).all(|column| system.is_met(relative.column(column))) {
            return Ok(Convergence {
                iterations: process.iterations(),
                residual: worst(relative),
            });
        }
        // A recursion that claims success without halving the truth will claim it for ever.
        let falls = |column| {
            let (now, before) = (relative.column(column), before.column(column));
            system.is_met(now) || now <= 0.5 * before
        };
        let may_go_on = is_finite(relative)
            && (0..V::COUNT).all(falls)
            && process.iterations() < system.options.max_iterations;
        if !may_go_on {
            return Err(system.not_converged(relative, process.iterations()));
        }
        process.start(relative);
        if !process.run(solution) {
            let not_finite = V::from_columns(|_| f64::NAN);
            return Err(system.not_converged(not_finite, process.iterations()));
        }
        before = relative;
    }
}

/// The square root in each column.
pub(super) fn square_root<V: Columns>(squares: V) -> V {
    V::from_columns(|column| squares.column(column).sqrt())
}

/// Whether every column is finite.
pub(super) fn is_finite<V: Columns>(values: V) -> bool {
    (0..V::COUNT).all(|column| values.column(column).is_finite())
}

/// The largest column; NaN where any is.
fn worst<V: Columns>(values: V) -> f64 {
    let columns = (0..V::COUNT).map(|column| values.column(column));
    columns.fold(0.0, |worst, value| {
        if value > worst || value.is_nan() {
            value
        } else {
            worst
        }
    })
}

/// The largest power of two that is at most `value` and has a finite inverse; one for zero.
fn power_of_two(value: f64) -> f64 {
    const EXPONENT: u64 = 0x7ff0_0000_0000_0000;
    if value == 0.0 || !value.is_finite() {
        return 1.0;
    }
    f64::from_bits(value.to_bits() & EXPONENT).max(f64::MIN_POSITIVE)
}
