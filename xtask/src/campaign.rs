//! The predicates against exact arithmetic, at length.

use crate::{Outcome, execute};
use std::path::Path;

/// As many cases as take about ten minutes of one core: five times as many calls.
const CASES: &str = "10000000";

/// Runs the campaign of `pellicle-predicates`, which fails if any sign is wrong. `cargo test` runs 10⁴ cases of it.
pub fn run(root: &Path, arguments: &[&str]) -> Outcome {
    let (cases, seed) = match arguments {
        [] => (CASES, "1"),
        [cases] => (*cases, "1"),
        [cases, seed] => (*cases, *seed),
        _ => return Err("usage: cargo xtask campaign [CASES [SEED]]".to_owned()),
    };
    execute(
        root,
        &[],
        &[
            "cargo",
            "run",
            "--release",
            "-p",
            "pellicle-predicates",
            "--features",
            "statistics",
            "--example",
            "campaign",
            "--",
            cases,
            seed,
        ],
    )
}
