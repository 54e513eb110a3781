//! The programs that are compared, each behind a driver that prints what its own work took.

use super::{ALONE, Programs};
use crate::bench::{cgal_program, measured};
use crate::execute;
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// How long a program may take for a mesh, reading and writing included.
pub const LIMIT: Duration = Duration::from_secs(20);

/// A program: BEFORE… MESH RESULT.
pub struct Peer {
    pub name: &'static str,
    program: PathBuf,
    before: Vec<String>,
    /// Whether it makes a mesh, or only finds pairs.
    pub makes_mesh: bool,
}

/// One run.
#[derive(Clone, Debug, PartialEq)]
pub struct Run {
    /// Seconds of all processors for the work alone.
    pub cpu: f64,
    /// The whole process at its peak, in bytes.
    pub peak: u64,
    /// What it held before the work, the mesh included.
    pub held: u64,
}

/// Ours first, and then those that are installed.
pub fn installed(root: &Path, programs: &Programs) -> Vec<Peer> {
    let ours = Peer {
        name: "Pellicle",
        program: programs.table.clone(),
        before: vec!["repair".into()],
        makes_mesh: true,
    };
    let mut peers = vec![ours];
    let mut add =
        |name, program: Result<PathBuf, String>, before: &[&str], makes_mesh| match program {
            Ok(program) => peers.push(Peer {
                name,
                program,
                before: before.iter().map(|&word| word.to_owned()).collect(),
                makes_mesh,
            }),
            Err(error) => eprintln!("{name}: {error}"),
        };
    add(
        "manifold-rust 0.19",
        manifold_rust(root, programs),
        &[],
        true,
    );
    let igl = python("igl.copyleft.cgal");
    add("libigl", igl, &["xtask/peers/igl_union.py"], true);
    let manifold = python("manifold3d");
    let driver = &["xtask/peers/manifold_union.py"];
    add("Manifold", manifold, driver, true);
    let cgal = cgal_program(root, &programs.scratch, "cgal_repair");
    add("CGAL autorefinement", cgal.clone(), &["autorefine"], true);
    add("CGAL detection", cgal, &["detect"], false);
    for peer in &mut peers {
        for word in &mut peer.before {
            if word.ends_with(".py") {
                *word = root.join(&*word).to_string_lossy().into_owned();
            }
        }
    }
    peers
}

impl Peer {
    pub fn on(&self, mesh: &Path, result: &Path) -> Result<Run, String> {
        // A result of another mesh shall not be taken for this one's.
        if result.exists() {
            std::fs::remove_file(result).map_err(|error| error.to_string())?;
        }
        let mut words: Vec<&str> = self.before.iter().map(String::as_str).collect();
        let (mesh, result) = (mesh.to_string_lossy(), result.to_string_lossy());
        words.push(&mesh);
        if self.makes_mesh {
            words.push(&result);
        }
        let run = measured::run_within(LIMIT, &ALONE, &self.program, &words)
            .map_err(|error| error.lines().last().unwrap_or_default().to_owned())?;
        Run::read(&run.output, run.peak_bytes.unwrap_or(0))
    }
}

impl Run {
    /// From what a driver prints: JSON, or seconds of CPU and of wall time and KiB.
    fn read(output: &str, peak: u64) -> Result<Self, String> {
        let line = output.lines().last().unwrap_or_default().trim();
        let strange = || format!("not a time: {line}");
        let (cpu, held) = if line.starts_with('{') {
            let values: Value = serde_json::from_str(line).map_err(|_| strange())?;
            (values["cpu"].as_f64(), values["held"].as_f64())
        } else {
            let mut numbers = line.split_whitespace().map(|word| word.parse::<f64>().ok());
            (numbers.next().flatten(), numbers.nth(1).flatten())
        };
        let (Some(cpu), Some(held)) = (cpu, held) else {
            return Err(strange());
        };
        Ok(Self {
            cpu,
            peak,
            held: held as u64 * 1024,
        })
    }
}

/// A python that has this module: that of PELLICLE_PYTHON, else `python3`.
fn python(module: &str) -> Result<PathBuf, String> {
    let python = crate::bench::python();
    measured::run(&python, &["-c", &format!("import numpy, {module}")])
        .map_err(|_| format!("no python with {module}"))?;
    Ok(python)
}

fn manifold_rust(root: &Path, programs: &Programs) -> Result<PathBuf, String> {
    let target = programs.scratch.join("manifold_rust");
    let words = [
        "cargo",
        "build",
        "--release",
        "--manifest-path",
        "xtask/peers/manifold_rust/Cargo.toml",
        "--target-dir",
        &target.to_string_lossy(),
    ];
    execute(root, &[], &words)?;
    let name = format!("manifold_rust_union{}", std::env::consts::EXE_SUFFIX);
    Ok(target.join("release").join(name))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_drivers_print_is_read() {
        let run = |cpu, held: u64| Run {
            cpu,
            peak: 9,
            held: 1024 * held,
        };
        let ours = r#"{"cpu": 0.25, "wall": 0.3, "held": 7, "pairs": 5}"#;
        assert_eq!(Run::read(ours, 9), Ok(run(0.25, 7)));
        assert_eq!(Run::read("warning\n0.5000 0.6000 8\n", 9), Ok(run(0.5, 8)));
        assert_eq!(Run::read("0.5000 0.6000 8 4039\n", 9), Ok(run(0.5, 8)));
        assert!(Run::read("0.5\n", 9).is_err());
        assert!(Run::read("{}", 9).is_err());
        assert!(Run::read("", 9).is_err());
    }
}
