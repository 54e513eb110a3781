//! Everything that must hold before a change lands.

use crate::{Outcome, execute, read, readme, tidy};
use std::path::Path;

/// Format, clippy, rustdoc, tidy, then the test command that README.md gives its reader.
pub fn run(root: &Path) -> Outcome {
    execute(root, &[], &["cargo", "fmt", "--all", "--check"])?;
    execute(
        root,
        &[],
        &[
            "cargo",
            "clippy",
            "--workspace",
            "--all-targets",
            "--",
            "-D",
            "warnings",
        ],
    )?;
    execute(
        root,
        &[("RUSTDOCFLAGS", "-D warnings")],
        &["cargo", "doc", "--workspace", "--no-deps"],
    )?;
    eprintln!("+ cargo xtask tidy");
    tidy::run(root)?;
    let command = readme::test_command(&read(&root.join("README.md"))?)?;
    let words: Vec<&str> = command.split_whitespace().collect();
    execute(root, &[], &words)
}
