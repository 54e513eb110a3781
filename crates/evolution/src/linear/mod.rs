//! The sparse linear algebra of surfaces in motion.
//!
//! # Data
//!
//! - [`CsrPattern`]: which entries of a matrix may differ from zero, row by row. It follows from the connectivity of a
//!   mesh and is shared (`Arc`) by every matrix that is assembled while that connectivity stands.
//! - [`CsrMatrix`]: a pattern and its values.
//! - [`Columns`]: what a vector holds for each row; `f64` for one right-hand side, `DVec3` for three at once.
//!
//! # Verbs
//!
//! - [`bicgstab()`] solves any system, [`conjugate_gradient()`] a symmetric positive definite one; both take a
//!   [`Preconditioner`]: [`NoPreconditioner`], [`Jacobi`], [`Ilu0`], or a [`Cholesky`] factor of a matrix that is near.
//! - [`Cholesky`] solves a symmetric positive definite system at once.
//! - [`LinearSolver`] does any of these for a [`Solver`] by name, and keeps what serves again at the next time step.
//!
//! Every result has the same bits for any number of threads: sums run over chunks of a fixed size in a fixed order.
//! No multiplication is fused with an addition, so the bits are those of any machine with IEEE 754 arithmetic.
//!
//! ```
//! use pellicle_evolution::linear::{
//!     CsrMatrix, CsrPattern, IterativeOptions, Jacobi, Workspace, bicgstab,
//! };
//! use std::sync::Arc;
//!
//! // A ring of five: each row has its two neighbours and the diagonal.
//! let pattern = CsrPattern::from_neighbors(5, |row| [(row + 1) % 5, (row + 4) % 5])?;
//! let mut matrix = CsrMatrix::zeros(Arc::new(pattern));
//! for row in 0..5 {
//!     matrix.add(row, row, 3.0)?;
//!     matrix.add(row, (row + 1) % 5, -1.0)?;
//!     matrix.add(row, (row + 4) % 5, -1.0)?;
//! }
//! let mut solution = [0.0; 5];
//! let jacobi = &mut Jacobi::new(&matrix);
//! let options = IterativeOptions::default();
//! bicgstab(&matrix, &[1.0; 5], &mut solution, jacobi, &options, &mut Workspace::default())?;
//! assert!(solution.iter().all(|x| (x - 1.0).abs() < 1e-9));
//! # Ok::<(), pellicle_evolution::linear::LinearError>(())
//! ```

mod bicgstab;
mod cholesky;
mod columns;
mod conjugate_gradient;
mod csr;
mod error;
mod ilu;
mod iterative;
mod preconditioner;
mod solver;

pub use bicgstab::bicgstab;
pub use cholesky::Cholesky;
pub use columns::Columns;
pub use conjugate_gradient::conjugate_gradient;
pub use csr::{CsrMatrix, CsrPattern};
pub use error::{LinearError, NotConverged};
pub use ilu::Ilu0;
pub use iterative::{Convergence, IterativeOptions, Workspace};
pub use preconditioner::{Jacobi, NoPreconditioner, Preconditioner};
pub use solver::{LinearSolver, Preconditioning, Solver};
