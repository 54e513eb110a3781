//! Sparse linear systems: rows in compressed form, preconditioners, BiCGStab.
