//! `cargo xtask picture`: the README's commands, run, and the picture that the README shows.

use crate::{Outcome, execute, read, readme};
use std::path::Path;

/// What the commands make, and where the README shows it.
const MADE: [&str; 2] = ["kitten.ply", "kitten.png"];
const SHOWN: &str = "docs/images/kitten.png";

/// Runs the commands anew and puts their picture in its place.
pub fn run(root: &Path) -> Outcome {
    for name in MADE {
        // Usually there is nothing to remove.
        let _ = std::fs::remove_file(root.join(name));
    }
    for command in readme::run_commands(&read(&root.join("README.md"))?) {
        let words: Vec<&str> = command.split_whitespace().collect();
        execute(root, &[], &words)?;
    }
    std::fs::copy(root.join(MADE[1]), root.join(SHOWN))
        .map_err(|error| format!("{SHOWN}: {error}"))?;
    eprintln!("wrote {SHOWN}: look at it");
    Ok(())
}
