//! Sparse systems against dense ones, and what breaks an iteration.

mod bicgstab;
mod csr;
mod support;
