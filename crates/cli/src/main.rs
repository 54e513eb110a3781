//! The command line of Pellicle.
fn main() {}
