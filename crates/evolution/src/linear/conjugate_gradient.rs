//! The conjugate gradients of Hestenes and Stiefel 1952, preconditioned.
//!
//! Notation: r the residual, z = M⁻¹ r, p the search direction, q = A p, ρ = r·z, α = ρ / (p·q), β = ρ / ρ_old.

use super::columns::{update, update_two};
use super::iterative::{Process, System, drive, is_finite};
use super::{
    Columns, Convergence, CsrMatrix, IterativeOptions, LinearError, Preconditioner, Workspace,
};

/// Solves A x = b for a symmetric positive definite A by conjugate gradients (Hestenes and Stiefel 1952; Saad 2003,
/// algorithm 9.1), starting at what `solution` holds. The preconditioner must be symmetric and positive definite too.
///
/// Columns, scaling, determinism and the check of the true residual are as in [`bicgstab`](super::bicgstab()); each
/// iteration takes one product with the matrix and one with the preconditioner. A positive semi-definite A serves if b
/// lies in its image: the solution then keeps the part of the guess in the kernel.
///
/// # Errors
///
/// [`LinearError::NotConverged`] as in [`bicgstab`](super::bicgstab()), and where p·q or r·z is not positive: the matrix
/// or the preconditioner is not positive definite. [`LinearError::WrongLength`].
pub fn conjugate_gradient<V: Columns, P: Preconditioner>(
    matrix: &CsrMatrix,
    right: &[V],
    solution: &mut [V],
    preconditioner: &mut P,
    options: &IterativeOptions,
    workspace: &mut Workspace<V>,
) -> Result<Convergence, LinearError> {
    let system = System::new(matrix, right, solution, options)?;
    let [residual, direction, image, search] = workspace.vectors(matrix.rows());
    let mut process = ConjugateGradient {
        system: &system,
        preconditioner,
        residual,
        direction,
        image,
        search,
        rho: V::ZERO,
        done: [false; 3],
        iterations: 0,
    };
    drive(&system, solution, &mut process)
}

struct ConjugateGradient<'a, V, P> {
    system: &'a System<'a, V>,
    preconditioner: &'a mut P,
    /// r.
    residual: &'a mut [V],
    /// p.
    direction: &'a mut [V],
    /// q.
    image: &'a mut [V],
    /// z.
    search: &'a mut [V],
    rho: V,
    /// Converged, or not positive definite: nothing moves any more.
    done: [bool; 3],
    iterations: usize,
}

impl<V: Columns, P: Preconditioner> Process<V> for ConjugateGradient<'_, V, P> {
    fn residual(&mut self) -> &mut [V] {
        self.residual
    }

    fn iterations(&self) -> usize {
        self.iterations
    }

    /// p = z.
    fn start(&mut self, relative: V) {
        for column in 0..V::COUNT {
            self.done[column] = self.system.is_met(relative.column(column));
        }
        self.preconditioner.apply(self.residual, self.search);
        self.rho = self.product();
        self.direction.copy_from_slice(self.search);
    }

    fn run(&mut self, solution: &mut [V]) -> bool {
        while self.iterations < self.system.options.max_iterations
            && !self.done[..V::COUNT].iter().all(|&done| done)
        {
            self.iterations += 1;
            if !self.step(solution) {
                return false;
            }
            self.turn();
        }
        true
    }
}

impl<V: Columns, P: Preconditioner> ConjugateGradient<'_, V, P> {
    /// x += α p, r -= α q; `false` where a value is not finite.
    fn step(&mut self, solution: &mut [V]) -> bool {
        let direction = &*self.direction;
        let matrix = self.system.matrix;
        let [curvature] =
            matrix.multiply_and_sum(direction, self.image, |row, q| [direction[row] * q]);
        if !is_finite(curvature) || !is_finite(self.rho) {
            return false;
        }
        let alpha = V::from_columns(|column| {
            let (rho, curvature) = (self.rho.column(column), curvature.column(column));
            self.done[column] |= rho <= 0.0 || curvature <= 0.0;
            if self.done[column] {
                0.0
            } else {
                rho / curvature
            }
        });
        let step = alpha * self.system.scale;
        let image = &*self.image;
        let [squares] = update_two(solution, self.residual, |first, x, r| {
            let (direction, image) = (&direction[first..], &image[first..]);
            let mut sum = V::ZERO;
            for (((x, r), &p), &q) in x.iter_mut().zip(r).zip(direction).zip(image) {
                *x += p * step;
                *r -= q * alpha;
                sum += *r * *r;
            }
            [sum]
        });
        let relative = self.system.relative(squares);
        for column in 0..V::COUNT {
            self.done[column] |= self.system.may_be_met(relative.column(column));
        }
        is_finite(squares)
    }

    /// p = z + β p.
    fn turn(&mut self) {
        if self.done[..V::COUNT].iter().all(|&done| done) {
            return;
        }
        self.preconditioner.apply(self.residual, self.search);
        let rho = self.product();
        let beta = V::from_columns(|column| {
            let ratio = rho.column(column) / self.rho.column(column);
            if self.done[column] { 0.0 } else { ratio }
        });
        self.rho = rho;
        let search = &*self.search;
        update(self.direction, |first, rows| {
            for (p, &z) in rows.iter_mut().zip(&search[first..]) {
                *p = z + *p * beta;
            }
            []
        });
    }

    /// r·z.
    fn product(&self) -> V {
        let [product] = super::columns::sums(self.residual.len(), |rows| {
            let mut sum = V::ZERO;
            for (&r, &z) in self.residual[rows.clone()].iter().zip(&self.search[rows]) {
                sum += r * z;
            }
            [sum]
        });
        product
    }
}
