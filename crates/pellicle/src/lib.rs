//! pellicle
