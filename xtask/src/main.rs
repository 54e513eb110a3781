//! Orchestration: `cargo xtask ci`, `tidy`, `campaign`, `bench`, `figures`. Uses no crate of the workspace.
#![forbid(unsafe_code)]

mod bench;
mod campaign;
mod ci;
mod figures;
mod guide;
mod picture;
mod readme;
mod tidy;

use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

/// What a task returns: nothing, or why it failed.
type Outcome = Result<(), String>;

const USAGE: &str = "\
usage: cargo xtask <task>

  ci      format, clippy, rustdoc, tidy, and the test command of README.md
  tidy    the checks of the house: floors, printing, lengths, citations, paths, fixtures
  campaign [CASES [SEED]]           the predicates against exact arithmetic: 10⁷ cases, ten minutes of one core
  figures [--quick] [--only NAME,…]  what the papers show: docs/figures/ and docs/REPRODUCTION.md. --quick writes nothing, and
                                    compares the numbers with the stored ones, as the tests do; --list tells the names;
                                    --page makes only the page anew, after a merge
  picture [--guide]                 the README's commands, and the picture that they make; --guide: those of the guide's
                                    chapters
  bench --table                     every fixture reconstructed: docs/benchmarks/fixtures.md
  bench --delaunay [OPTION …] [INPUT …]
                                    tetrahedralisation, beside CGAL, HXT and TetGen where they are installed:
                                    docs/benchmarks/delaunay.md. INPUT is KIND:COUNT (uniform, sphere, torus, grid,
                                    rounded) or file:PATH, little-endian doubles; without one, all that the page shows.
                                    --quick: small ones, and the page goes to the target folder; --rounds N; --threads N,…; --only NAME,… of the others;
                                    --keep: adds to what was measured before; --page: only makes the page anew;
                                    --no-check: without the exact checker.
                                    PELLICLE_PYTHON names a python with gmsh, for HXT, and perhaps tetgen
  bench --instructions [--accept]   instructions of small tetrahedralisations, counted by valgrind, against those stored
                                    in docs/benchmarks/instructions.json; --accept stores what is counted
  bench --evolution                 shapes and scans, beside others that are installed, and times:
                                    docs/benchmarks/evolution.md; PELLICLE_PYTHON names a python with open3d
  bench --repair [FOLDER]           meshes that cross themselves, beside others that are installed:
                                    docs/benchmarks/repair.md; FOLDER has more of them, as OFF;
                                    PELLICLE_PYTHON names a python with libigl and manifold3d
";

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let outcome = match words.as_slice() {
        ["ci"] => ci::run(&root()),
        ["tidy"] => tidy::run(&root()),
        ["picture"] => picture::run(&root()),
        ["picture", "--guide"] => guide::run(&root()),
        ["figures", arguments @ ..] => figures::run(&root(), arguments),
        ["campaign", arguments @ ..] => campaign::run(&root(), arguments),
        ["bench", arguments @ ..] => bench::run(&root(), arguments),
        _ => {
            eprint!("{USAGE}");
            return ExitCode::from(2);
        }
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(reason) => {
            eprintln!("error: {reason}");
            ExitCode::FAILURE
        }
    }
}

/// The workspace's folder: the parent of this crate's.
fn root() -> PathBuf {
    let manifest = std::env::var_os("CARGO_MANIFEST_DIR").map(PathBuf::from);
    match manifest.as_deref().and_then(Path::parent) {
        Some(root) => root.to_path_buf(),
        None => PathBuf::from("."),
    }
}

/// Prints a command, runs it in `root`, and fails if it does.
fn execute(root: &Path, environment: &[(&str, &str)], words: &[&str]) -> Outcome {
    let shown: Vec<String> = environment
        .iter()
        .map(|(name, value)| format!("{name}=\"{value}\""))
        .chain(words.iter().map(|word| (*word).to_owned()))
        .collect();
    eprintln!("+ {}", shown.join(" "));
    let (program, arguments) = words.split_first().ok_or("an empty command")?;
    let status = Command::new(program)
        .args(arguments)
        .envs(environment.iter().copied())
        .current_dir(root)
        .status()
        .map_err(|error| format!("{program}: {error}"))?;
    if status.success() {
        Ok(())
    } else {
        Err(format!("`{}` failed: {status}", words.join(" ")))
    }
}

/// The text of a file, with its name in the error.
fn read(path: &Path) -> Result<String, String> {
    std::fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()))
}

/// What cargo knows about the workspace's own packages, as JSON.
fn cargo_metadata(root: &Path) -> Result<String, String> {
    let output = Command::new("cargo")
        .args(["metadata", "--no-deps", "--format-version", "1"])
        .current_dir(root)
        .output()
        .map_err(|error| format!("cargo metadata: {error}"))?;
    if !output.status.success() {
        return Err(String::from_utf8_lossy(&output.stderr).into_owned());
    }
    String::from_utf8(output.stdout).map_err(|error| format!("cargo metadata: {error}"))
}

/// Where cargo puts what it builds.
fn target_folder(root: &Path) -> Result<PathBuf, String> {
    let metadata: Value = serde_json::from_str(&cargo_metadata(root)?)
        .map_err(|error| format!("cargo metadata: {error}"))?;
    let folder = metadata["target_directory"]
        .as_str()
        .ok_or("cargo metadata: no target directory")?;
    Ok(PathBuf::from(folder))
}
