//! Measurements, and the pages under `docs/benchmarks/` that show them.

mod delaunay;
mod evolution;
mod fixtures;
mod instructions;
mod measured;
mod repair;

use crate::{Outcome, execute, target_folder};
use std::path::{Path, PathBuf};
use std::process::Command;

/// `--table`, `--delaunay …`, `--instructions …`, `--evolution` or `--repair …`.
pub fn run(root: &Path, arguments: &[&str]) -> Outcome {
    match arguments {
        ["--table"] => fixtures::run(root),
        ["--delaunay", words @ ..] => delaunay::run(root, words),
        ["--instructions", words @ ..] => instructions::run(root, words),
        ["--evolution"] => evolution::run(root),
        ["--repair"] => repair::run(root, None),
        ["--repair", folder] => repair::run(root, Some(Path::new(folder))),
        _ => Err(
            "bench wants --table, --delaunay …, --instructions, --evolution, or --repair [FOLDER]"
                .into(),
        ),
    }
}

/// The python that runs other programs' drivers: that of PELLICLE_PYTHON, else `python3`.
fn python() -> PathBuf {
    let python = std::env::var_os("PELLICLE_PYTHON").unwrap_or_else(|| "python3".into());
    PathBuf::from(python)
}

/// Builds the command line in release, and returns where it is and a folder for what it writes.
fn command_line(root: &Path) -> Result<(PathBuf, PathBuf), String> {
    execute(
        root,
        &[],
        &["cargo", "build", "--release", "--package", "pellicle-cli"],
    )?;
    let target = target_folder(root)?;
    let scratch = target.join("bench");
    std::fs::create_dir_all(&scratch).map_err(|error| format!("{}: {error}", scratch.display()))?;
    let name = format!("pellicle{}", std::env::consts::EXE_SUFFIX);
    Ok((target.join("release").join(name), scratch))
}

/// Builds examples of `pellicle-delaunay` in release, and returns the folder where they are.
fn delaunay_examples(root: &Path, names: &[&str]) -> Result<PathBuf, String> {
    let mut command = vec![
        "cargo",
        "build",
        "--release",
        "--package",
        "pellicle-delaunay",
    ];
    command.extend(names.iter().flat_map(|name| ["--example", *name]));
    execute(root, &[], &command)?;
    Ok(target_folder(root)?.join("release/examples"))
}

/// Compiles a peer that stands on CGAL, `xtask/peers/NAME.cpp`, into a folder, and returns where it is.
fn cgal_program(root: &Path, scratch: &Path, name: &str) -> Result<PathBuf, String> {
    let program = scratch.join(name);
    let source = format!("xtask/peers/{name}.cpp");
    let output = program.to_string_lossy().into_owned();
    // CGAL's interval arithmetic wants -frounding-math of gcc. No -march=native, which ours does not get either.
    let words = [
        "g++",
        "-std=c++17",
        "-O3",
        "-DNDEBUG",
        "-frounding-math",
        &source,
        "-o",
        &output,
        "-lgmp",
        "-lmpfr",
    ];
    execute(root, &[], &words).map_err(|error| format!("{error}; is libcgal-dev installed?"))?;
    Ok(program)
}

/// The machine in a line: processor, cores, and the compiler.
fn machine() -> String {
    let processor = std::fs::read_to_string("/proc/cpuinfo")
        .ok()
        .and_then(|text| {
            let line = text.lines().find(|line| line.starts_with("model name"))?;
            Some(line.split_once(':')?.1.trim().to_owned())
        })
        .unwrap_or_else(|| std::env::consts::ARCH.to_owned());
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let compiler = Command::new("rustc")
        .arg("--version")
        .output()
        .map(|output| String::from_utf8_lossy(&output.stdout).trim().to_owned())
        .unwrap_or_default();
    format!("{processor}, {cores} cores, {compiler}")
}

/// How busy the machine is: the mean number of processes that want to run, over the last minute.
fn load() -> Option<f64> {
    let text = std::fs::read_to_string("/proc/loadavg").ok()?;
    text.split_whitespace().next()?.parse().ok()
}

/// Writes a page under `docs/benchmarks/`.
fn write_page(root: &Path, name: &str, text: &str) -> Outcome {
    write_file(&root.join("docs/benchmarks"), name, text)
}

/// Writes a file into a folder, which is made if it is not there, and says so.
fn write_file(folder: &Path, name: &str, text: &str) -> Outcome {
    let path = folder.join(name);
    std::fs::create_dir_all(folder)
        .and_then(|()| std::fs::write(&path, text))
        .map_err(|error| format!("{}: {error}", path.display()))?;
    eprintln!("wrote {}", path.display());
    Ok(())
}
