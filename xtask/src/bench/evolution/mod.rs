//! `cargo xtask bench --evolution`: surfaces evolved onto clouds with known truth and onto scans, beside screened Poisson
//! (Open3D) and CGAL's alpha wrapping where they are installed, and how long the parts take.

mod goals;
mod page;
mod peers;
mod times;

use super::measured;
use crate::{Outcome, execute};
use serde_json::Value;
use std::path::{Path, PathBuf};

/// One thread: how everything but the comparison of threads runs.
const ALONE: [(&str, &str); 2] = [("RAYON_NUM_THREADS", "1"), ("OMP_NUM_THREADS", "1")];

/// What is run, and a folder for what it writes.
struct Programs {
    table: PathBuf,
    step: PathBuf,
    distance: PathBuf,
    scratch: PathBuf,
}

/// One line of `evolution_table`.
struct Row {
    shape: String,
    cloud: String,
    schedule: String,
    values: Value,
}

/// Runs all and writes the page; fails if a surface is no closed manifold.
pub fn run(root: &Path) -> Outcome {
    let programs = Programs::build(root)?;
    let load_before = super::load();
    let times = times::run(&programs)?;
    let load_after = super::load();
    let rows = programs.rows()?;
    let peers = peers::run(root, &programs, &rows)?;
    let goals = goals::of(&rows, &times);
    for goal in goals.iter().filter(|goal| !goal.met) {
        eprintln!(
            "missed: {}: {}, wanted {}",
            goal.what, goal.here, goal.wanted
        );
    }
    let loads = (load_before, load_after);
    let text = page::page(&super::machine(), &loads, &goals, &rows, &peers, &times);
    super::write_page(root, "evolution.md", &text)?;
    match rows.iter().find(|row| !row.holds("closed_manifold")) {
        Some(row) => Err(format!("{}: no closed manifold", row.name())),
        None => Ok(()),
    }
}

impl Programs {
    fn build(root: &Path) -> Result<Self, String> {
        for (package, examples) in [
            ("pellicle-figures", &["evolution_table"][..]),
            ("pellicle-evolution", &["time_step", "time_distance"]),
        ] {
            let mut words = vec!["cargo", "build", "--release", "--package", package];
            for example in examples {
                words.extend(["--example", example]);
            }
            execute(root, &[], &words)?;
        }
        let target = super::target_folder(root)?;
        let scratch = target.join("bench");
        std::fs::create_dir_all(&scratch)
            .map_err(|error| format!("{}: {error}", scratch.display()))?;
        let example = |name: &str| {
            let file = format!("{name}{}", std::env::consts::EXE_SUFFIX);
            target.join("release/examples").join(file)
        };
        Ok(Self {
            table: example("evolution_table"),
            step: example("time_step"),
            distance: example("time_distance"),
            scratch,
        })
    }

    /// Every experiment.
    fn rows(&self) -> Result<Vec<Row>, String> {
        let names = measured::run(&self.table, &["list"])?.output;
        names
            .lines()
            .map(|name| {
                let run = measured::run_in(&ALONE, &self.table, &["evolve", name])?;
                let row = Row::read(name, run.output.trim())?;
                eprintln!("{name}: {:.1} s", row.number("seconds"));
                Ok(row)
            })
            .collect()
    }
}

impl Row {
    fn read(name: &str, line: &str) -> Result<Self, String> {
        let values = serde_json::from_str(line).map_err(|error| format!("{name}: {error}"))?;
        let parts: Vec<&str> = name.split('/').collect();
        let [shape, cloud, schedule] = parts[..] else {
            return Err(format!("{name}: not three parts"));
        };
        Ok(Self {
            shape: shape.to_owned(),
            cloud: cloud.to_owned(),
            schedule: schedule.to_owned(),
            values,
        })
    }

    fn name(&self) -> String {
        format!("{}/{}/{}", self.shape, self.cloud, self.schedule)
    }

    /// A number; NaN where there is none, which meets no goal.
    fn number(&self, key: &str) -> f64 {
        self.values[key].as_f64().unwrap_or(f64::NAN)
    }

    fn holds(&self, key: &str) -> bool {
        self.values[key] == true
    }

    /// Whether the mesh is a sphere, as every shape is.
    fn is_sphere(&self) -> bool {
        self.holds("closed_manifold") && self.values["components"] == 1 && self.values["genus"] == 0
    }

    /// The mean of the mean distances either way, in percent of the truth's diagonal.
    fn distance_percent(&self) -> f64 {
        50.0 * (self.number("truth_to_mesh") + self.number("mesh_to_truth"))
            / self.number("diagonal")
    }

    /// A length in voxels.
    fn voxels(&self, key: &str) -> f64 {
        self.number(key) / self.number("voxel")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_read() {
        let row = Row::read(
            "vase/noise/adaptive",
            r#"{"closed_manifold": true, "components": 1, "genus": 0, "voxel": 0.5,
                "truth_to_mesh": 1.0, "mesh_to_truth": 3.0, "diagonal": 200.0}"#,
        )
        .unwrap();
        assert_eq!(row.name(), "vase/noise/adaptive");
        assert!(row.is_sphere());
        assert_eq!(row.distance_percent(), 1.0);
        assert_eq!(row.voxels("mesh_to_truth"), 6.0);
        assert!(row.number("seconds").is_nan());
        let torus = r#"{"closed_manifold": true, "components": 1, "genus": 1}"#;
        assert!(!Row::read("a/b/c", torus).unwrap().is_sphere());
        assert!(Row::read("a/b", "{}").is_err());
        assert!(Row::read("a/b/c", "no").is_err());
    }
}
