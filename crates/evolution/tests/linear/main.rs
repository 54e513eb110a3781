//! Sparse systems against dense ones, and what breaks an iteration.

mod bicgstab;
mod cholesky;
mod conjugate_gradient;
mod csr;
mod ilu;
mod solver;
mod support;
