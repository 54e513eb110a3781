//! What README.md tells its reader to run works, and its picture is what comes of it.

mod common;

use common::{pellicle, root};
use tempfile::tempdir;

const RUN: &str = "cargo run --release -- ";

#[test]
#[cfg(unix)]
fn the_commands_work_and_make_the_picture() {
    let readme = std::fs::read_to_string(root().join("README.md")).unwrap();
    let commands: Vec<&str> = readme
        .lines()
        .filter_map(|line| line.strip_prefix(RUN))
        .collect();
    assert_eq!(
        commands.len(),
        3,
        "the commands are found by their first words"
    );

    let folder = tempdir().unwrap();
    let fixtures = root().join("fixtures").canonicalize().unwrap();
    std::os::unix::fs::symlink(fixtures, folder.path().join("fixtures")).unwrap();
    for command in commands {
        pellicle(folder.path())
            .args(command.split_whitespace())
            .assert()
            .success();
    }

    let shown = image::open(root().join("docs/images/kitten.png"))
        .unwrap()
        .into_rgba8();
    let made = image::open(folder.path().join("kitten.png"))
        .unwrap()
        .into_rgba8();
    assert!(
        shown == made,
        "docs/images/kitten.png is not what the README's commands make: cargo xtask picture makes it anew"
    );
}
