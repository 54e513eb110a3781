//! Running the binary, and where the fixtures are.
#![allow(dead_code, reason = "each test file uses its share")]

use assert_cmd::Command;
use assert_cmd::assert::Assert;
use serde_json::Value;
use std::path::{Path, PathBuf};

/// The binary, to be run in `folder`.
pub fn pellicle(folder: &Path) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_pellicle"));
    command.current_dir(folder).env("NO_COLOR", "1");
    command
}

/// The workspace's folder.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// A file of `fixtures/`, as an argument.
pub fn fixture(name: &str) -> String {
    root()
        .join("fixtures")
        .join(name)
        .to_string_lossy()
        .into_owned()
}

/// What was written to standard output.
pub fn stdout(assert: &Assert) -> String {
    String::from_utf8(assert.get_output().stdout.clone()).unwrap()
}

/// What was written to standard error.
pub fn stderr(assert: &Assert) -> String {
    String::from_utf8(assert.get_output().stderr.clone()).unwrap()
}

/// What a run says as JSON.
pub fn json(folder: &Path, arguments: &[&str]) -> Value {
    let assert = pellicle(folder)
        .args(arguments)
        .arg("--json")
        .assert()
        .success();
    serde_json::from_str(&stdout(&assert)).unwrap()
}

/// What `info` says is one closed, oriented manifold of this genus, without self-intersections, facing outwards.
pub fn manifold(info: &Value, genus: u64) {
    for key in ["closed", "edge_manifold", "vertex_manifold", "oriented"] {
        assert_eq!(info[key], true, "{key}");
    }
    assert_eq!(info["genus"], genus);
    for (key, value) in [("components", 1), ("borders", 0), ("self_intersections", 0)] {
        assert_eq!(info[key], value, "{key}");
    }
    assert!(info["volume"].as_f64().unwrap() > 0.0);
}

/// The names in a folder, sorted.
pub fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned())
        .collect();
    names.sort();
    names
}
