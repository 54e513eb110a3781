//! `cargo xtask figures`: what the papers show, made anew or compared.

use crate::{Outcome, execute};
use std::path::Path;

/// Runs the program of `pellicle-figures`. The quick comparison is built as the tests are, which is there sooner.
pub fn run(root: &Path, arguments: &[&str]) -> Outcome {
    let mut words = vec!["cargo", "run", "--quiet"];
    if !arguments.contains(&"--quick") {
        words.push("--release");
    }
    words.extend(["--package", "pellicle-figures", "--bin", "figures", "--"]);
    words.extend(arguments);
    execute(root, &[], &words)
}
