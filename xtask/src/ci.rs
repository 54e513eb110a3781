//! Everything that must hold before a change lands.

use crate::{Outcome, execute, guide, read, readme, target_folder, tidy};
use std::path::Path;

/// Format, clippy, rustdoc, tidy, the program outside of the workspace, then the test command that README.md gives its reader.
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
    guide::check_documentation(root)?;
    eprintln!("+ cargo xtask tidy");
    tidy::run(root)?;
    downstream(root)?;
    let command = readme::test_command(&read(&root.join("README.md"))?)?;
    let words: Vec<&str> = command.split_whitespace().collect();
    execute(root, &[], &words)
}

/// Formats, builds and runs `examples/downstream`, with the versions of its own lock file.
fn downstream(root: &Path) -> Outcome {
    const MANIFEST: &str = "examples/downstream/Cargo.toml";
    execute(
        root,
        &[],
        &["cargo", "fmt", "--manifest-path", MANIFEST, "--check"],
    )?;
    // One target folder for both, so that what they share is built once.
    let target = target_folder(root)?;
    let picture = target.join("downstream.png");
    // Usually there is nothing to remove.
    let _ = std::fs::remove_file(&picture);
    let [target, picture] = [target, picture].map(|path| path.to_string_lossy().into_owned());
    execute(
        root,
        &[],
        &[
            "cargo",
            "run",
            "--locked",
            "--manifest-path",
            MANIFEST,
            "--target-dir",
            &target,
            "--",
            "fixtures/analytic/cube.off",
            "fixtures/repair/cubes_generic.off",
            &picture,
        ],
    )
}
