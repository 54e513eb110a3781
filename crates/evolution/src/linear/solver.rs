//! One name for every way to solve a system, with what is worth keeping from one time step to the next.

use super::{
    Cholesky, Columns, Convergence, CsrMatrix, Ilu0, IterativeOptions, Jacobi, LinearError,
    NoPreconditioner, Preconditioner, Workspace, bicgstab, conjugate_gradient,
};

/// How to solve a system.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Solver {
    /// [`bicgstab()`](super::bicgstab()): any matrix.
    BiCgStab(Preconditioning),
    /// [`conjugate_gradient()`](super::conjugate_gradient()): symmetric positive definite.
    ConjugateGradient(Preconditioning),
    /// A [`Cholesky`] factor at each step: symmetric positive definite. The result does not depend on earlier steps.
    Cholesky,
    /// Conjugate gradients with the [`Cholesky`] factor of an earlier step, renewed when the iterations that it cost in
    /// excess outweigh a new one: symmetric positive definite. The last bits depend on the steps before.
    LaggedCholesky,
}

impl Solver {
    /// What measured best, from 2562 to 40 962 vertices, for the pinned stiffness and its like: symmetric positive
    /// definite, ill-conditioned. [`LaggedCholesky`](Self::LaggedCholesky) takes about two thirds of its time, at the
    /// price of a result that depends on the steps before.
    pub const SYMMETRIC: Self = Self::Cholesky;

    /// What measured best, from 2562 to 40 962 vertices, for the implicit step in time: not symmetric, dominated by its
    /// diagonal. ILU(0) halves the iterations and takes as long, and only on one thread.
    pub const GENERAL: Self = Self::BiCgStab(Preconditioning::Jacobi);
}

/// How an iteration is preconditioned.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Preconditioning {
    /// Not at all.
    None,
    /// By the diagonal: [`Jacobi`].
    Jacobi,
    /// By incomplete factors: [`Ilu0`].
    Ilu0,
}

/// Iterations that cost as much as a factor: six to nine were measured, from 2562 to 40 962 rows. A factor is renewed
/// when it has cost as much again as a new one, so never more than twice what foresight would spend.
const FACTOR_WORTH: usize = 7;

/// Solves systems whose matrix changes from step to step while its pattern mostly stands.
///
/// Keeps the vectors, the preconditioner and the analysis of the pattern; nothing is allocated while the pattern stands,
/// but for vectors inside a solution by [`Cholesky`].
///
/// ```
/// use pellicle_evolution::linear::{
///     CsrMatrix, CsrPattern, IterativeOptions, LinearSolver, Solver,
/// };
/// use pellicle_mesh::icosphere;
/// use std::sync::Arc;
///
/// // The graph Laplacian of a sphere, pinned in one vertex.
/// let pattern = CsrPattern::of_mesh(&icosphere(2)?)?;
/// let mut matrix = CsrMatrix::zeros(Arc::new(pattern));
/// for row in 0..matrix.rows() {
///     let entries = matrix.pattern().row(row);
///     let degree = entries.len() as f64 - 1.0;
///     matrix.values_mut()[entries].fill(-1.0);
///     matrix.add(row, row, degree + 1.0)?;
/// }
/// matrix.pin(0)?;
/// let mut right = vec![0.0; matrix.rows()];
/// (right[10], right[20]) = (1.0, -1.0);
///
/// let mut solver = LinearSolver::new(Solver::SYMMETRIC, IterativeOptions::default());
/// let mut solution = vec![0.0; matrix.rows()];
/// let convergence = solver.solve(&matrix, &right, &mut solution)?;
/// assert!(convergence.residual < 1e-10);
/// assert_eq!(solution[0], 0.0);
/// assert!(solution[10] > 0.0 && solution[20] < 0.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct LinearSolver<V> {
    method: Solver,
    options: IterativeOptions,
    workspace: Workspace<V>,
    kept: Kept,
    /// Iterations beyond the first of each solution since the factor was made.
    excess: usize,
}

impl<V: Columns> LinearSolver<V> {
    /// A solver that has seen no matrix yet.
    #[must_use]
    pub fn new(method: Solver, options: IterativeOptions) -> Self {
        Self {
            method,
            options,
            workspace: Workspace::default(),
            kept: Kept::Nothing(NoPreconditioner),
            excess: 0,
        }
    }

    /// Solves A x = b, starting at what `solution` holds.
    ///
    /// A solution by a factor is corrected by conjugate gradients with that factor until it meets the tolerance; the
    /// first iteration is the solution itself.
    ///
    /// # Errors
    ///
    /// [`LinearError::NotConverged`]; by a factor also [`LinearError::NotPositiveDefinite`], and
    /// [`LinearError::NoEntry`] where the pattern is not symmetric; [`LinearError::WrongLength`].
    pub fn solve(
        &mut self,
        matrix: &CsrMatrix,
        right: &[V],
        solution: &mut [V],
    ) -> Result<Convergence, LinearError> {
        match self.method {
            Solver::BiCgStab(kind) => {
                self.kept.refresh(kind, matrix)?;
                let (options, workspace) = (&self.options, &mut self.workspace);
                bicgstab(matrix, right, solution, &mut self.kept, options, workspace)
            }
            Solver::ConjugateGradient(kind) => {
                self.kept.refresh(kind, matrix)?;
                self.conjugate_gradient(matrix, right, solution, self.options)
            }
            Solver::Cholesky => {
                self.kept.factorise(matrix)?;
                self.conjugate_gradient(matrix, right, solution, self.options)
            }
            Solver::LaggedCholesky => self.solve_lagged(matrix, right, solution),
        }
    }

    fn solve_lagged(
        &mut self,
        matrix: &CsrMatrix,
        right: &[V],
        solution: &mut [V],
    ) -> Result<Convergence, LinearError> {
        let mut before = 0;
        if self.kept.is_factor_for(matrix) && self.excess < FACTOR_WORTH {
            let options = IterativeOptions {
                max_iterations: self.options.max_iterations.min(2 * FACTOR_WORTH),
                ..self.options
            };
            match self.conjugate_gradient(matrix, right, solution, options) {
                Ok(convergence) => {
                    self.excess += convergence.iterations.saturating_sub(1);
                    return Ok(convergence);
                }
                // The factor is too old; go on from here with a new one.
                Err(LinearError::NotConverged(e)) if e.residual.is_finite() => {
                    before = e.iterations;
                }
                Err(other) => return Err(other),
            }
        }
        self.kept.factorise(matrix)?;
        self.excess = 0;
        let mut convergence = self.conjugate_gradient(matrix, right, solution, self.options)?;
        convergence.iterations += before;
        Ok(convergence)
    }

    fn conjugate_gradient(
        &mut self,
        matrix: &CsrMatrix,
        right: &[V],
        solution: &mut [V],
        options: IterativeOptions,
    ) -> Result<Convergence, LinearError> {
        let workspace = &mut self.workspace;
        conjugate_gradient(matrix, right, solution, &mut self.kept, &options, workspace)
    }
}

/// The preconditioner of the step before.
#[derive(Debug)]
enum Kept {
    Nothing(NoPreconditioner),
    Jacobi(Jacobi),
    Ilu0(Ilu0),
    Cholesky(Box<Cholesky>),
}

impl Kept {
    fn refresh(&mut self, kind: Preconditioning, matrix: &CsrMatrix) -> Result<(), LinearError> {
        match (kind, &mut *self) {
            (Preconditioning::Jacobi, Self::Jacobi(jacobi)) => jacobi.refresh(matrix),
            (Preconditioning::Ilu0, Self::Ilu0(ilu)) if ilu.fits(matrix) => ilu.refresh(matrix)?,
            (Preconditioning::None, _) => *self = Self::Nothing(NoPreconditioner),
            (Preconditioning::Jacobi, _) => *self = Self::Jacobi(Jacobi::new(matrix)),
            (Preconditioning::Ilu0, _) => *self = Self::Ilu0(Ilu0::new(matrix)),
        }
        Ok(())
    }

    fn is_factor_for(&self, matrix: &CsrMatrix) -> bool {
        matches!(self, Self::Cholesky(cholesky) if cholesky.fits(matrix))
    }

    /// Leaves no half factor behind on an error.
    fn factorise(&mut self, matrix: &CsrMatrix) -> Result<(), LinearError> {
        match std::mem::replace(self, Self::Nothing(NoPreconditioner)) {
            Self::Cholesky(mut cholesky) if cholesky.fits(matrix) => {
                cholesky.refresh(matrix)?;
                *self = Self::Cholesky(cholesky);
            }
            _ => *self = Self::Cholesky(Box::new(Cholesky::new(matrix)?)),
        }
        Ok(())
    }
}

impl Preconditioner for Kept {
    fn apply<V: Columns>(&mut self, vector: &[V], solution: &mut [V]) {
        match self {
            Self::Nothing(nothing) => nothing.apply(vector, solution),
            Self::Jacobi(jacobi) => jacobi.apply(vector, solution),
            Self::Ilu0(ilu) => ilu.apply(vector, solution),
            Self::Cholesky(cholesky) => cholesky.apply(vector, solution),
        }
    }
}
