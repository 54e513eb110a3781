//! `cargo xtask bench --repair`: meshes that cross themselves, repaired, beside other programs where they are installed;
//! how time grows; two threads against one.

mod goals;
mod page;
mod peers;

use super::measured::{self, median};
use crate::{Outcome, execute};
use peers::{Peer, Run};
use serde_json::Value;
use std::path::{Path, PathBuf};

/// One thread: how everything but the comparison of threads runs.
const ALONE: [(&str, &str); 2] = [("RAYON_NUM_THREADS", "1"), ("OMP_NUM_THREADS", "1")];

/// Runs of everything, taken in turns.
const ROUNDS: usize = 3;

/// What everybody repairs: the name in the page, and where it comes from.
const COMPARED: [(&str, Source); 6] = [
    ("valley50k", Source::Folder("a_valley50k.off")),
    ("bunny25k_offset5", Source::Folder("b_bunny25k_offset5.off")),
    ("two spheres", Source::Made("two_spheres", 70)),
    ("torus_closed", Source::Fixture("torus_closed.off")),
    ("dumbbell_pinch", Source::Fixture("dumbbell_pinch.off")),
    ("bumpy", Source::Made("bumpy", 36)),
];

/// What only Pellicle repairs, up to two million triangles: kinds and frequencies.
const GROWTH: [(&str, &[u32]); 2] = [
    ("two_spheres", &[28, 56, 112, 224]),
    ("valley", &[40, 79, 158, 316]),
];

#[derive(Clone, Copy)]
enum Source {
    /// A file of the folder that the caller names.
    Folder(&'static str),
    /// A file of `fixtures/repair/`.
    Fixture(&'static str),
    /// A kind of `pellicle_figures::crossing`, and its frequency.
    Made(&'static str, u32),
}

/// What is run, and a folder for what it writes.
struct Programs {
    table: PathBuf,
    scratch: PathBuf,
}

/// One mesh, and what the programs made of it.
struct Row {
    name: &'static str,
    triangles: u64,
    pairs: u64,
    /// For each program.
    made: Vec<Made>,
}

/// Every run, or why there is none; what came out, if it was a mesh.
#[derive(Clone)]
struct Made {
    runs: Result<Vec<Run>, String>,
    outcome: Option<Value>,
}

/// One size of one kind.
struct Grown {
    kind: &'static str,
    triangles: u64,
    pairs: u64,
    run: Run,
    remaining: u64,
}

/// Seconds of wall time of the search for pairs, on one thread and on two.
struct Search {
    kind: &'static str,
    triangles: u64,
    seconds: [f64; 2],
}

/// Runs all and writes the page; fails if ours is no closed manifold, or crosses itself.
pub fn run(root: &Path, folder: Option<&Path>) -> Outcome {
    let programs = Programs::build(root)?;
    let peers = peers::installed(root, &programs);
    let load_before = super::load();
    let rows = programs.compare(root, folder, &peers)?;
    let grown = programs.grow()?;
    let searches = programs.search()?;
    let loads = (load_before, super::load());
    let goals = goals::of(&rows, &peers, &grown, &searches);
    for goal in goals.iter().filter(|goal| !goal.met) {
        let (what, here, wanted) = (&goal.what, &goal.here, &goal.wanted);
        eprintln!("missed: {what}: {here}, wanted {wanted}");
    }
    let text = page::page(
        &super::machine(),
        &loads,
        &goals,
        &rows,
        &peers,
        &grown,
        &searches,
    );
    super::write_page(root, "repair.md", &text)?;
    match rows.iter().find(|row| !row.made[0].is_sound()) {
        Some(row) => Err(format!("{}: not repaired", row.name)),
        None => Ok(()),
    }
}

impl Programs {
    fn build(root: &Path) -> Result<Self, String> {
        let words = [
            "cargo",
            "build",
            "--release",
            "--package",
            "pellicle-figures",
            "--example",
            "repair_table",
        ];
        execute(root, &[], &words)?;
        let target = super::target_folder(root)?;
        let scratch = target.join("bench");
        std::fs::create_dir_all(&scratch)
            .map_err(|error| format!("{}: {error}", scratch.display()))?;
        let file = format!("repair_table{}", std::env::consts::EXE_SUFFIX);
        Ok(Self {
            table: target.join("release/examples").join(file),
            scratch,
        })
    }

    /// The file of a mesh; none if it is in a folder that was not named.
    fn file(
        &self,
        root: &Path,
        folder: Option<&Path>,
        source: Source,
    ) -> Result<Option<PathBuf>, String> {
        Ok(match source {
            Source::Folder(name) => folder
                .map(|folder| folder.join(name))
                .filter(|file| file.exists()),
            Source::Fixture(name) => Some(root.join("fixtures/repair").join(name)),
            Source::Made(kind, frequency) => Some(self.make(kind, frequency)?),
        })
    }

    fn make(&self, kind: &str, frequency: u32) -> Result<PathBuf, String> {
        let file = self.scratch.join(format!("{kind}_{frequency}.off"));
        let words = [
            "write",
            kind,
            &frequency.to_string(),
            &file.to_string_lossy(),
        ];
        measured::run(&self.table, &words)?;
        Ok(file)
    }

    /// The last line of JSON that a command of the table prints.
    fn json(&self, threads: &str, words: &[&str]) -> Result<(Value, u64), String> {
        let run = measured::run_in(&[("RAYON_NUM_THREADS", threads)], &self.table, words)?;
        let line = run.output.lines().last().unwrap_or_default();
        let values = serde_json::from_str(line).map_err(|error| format!("{line}: {error}"))?;
        Ok((values, run.peak_bytes.unwrap_or(0)))
    }

    fn compare(
        &self,
        root: &Path,
        folder: Option<&Path>,
        peers: &[Peer],
    ) -> Result<Vec<Row>, String> {
        let mut rows = Vec::new();
        for (name, source) in COMPARED {
            let Some(file) = self.file(root, folder, source)? else {
                eprintln!("{name}: not there");
                continue;
            };
            let (found, _) = self.json("1", &["pairs", &file.to_string_lossy()])?;
            let mut made: Vec<Made> = peers
                .iter()
                .map(|_| Made {
                    runs: Ok(Vec::new()),
                    outcome: None,
                })
                .collect();
            for round in 0..ROUNDS {
                for (peer, made) in peers.iter().zip(&mut made) {
                    // What failed once fails again.
                    let Ok(runs) = &mut made.runs else { continue };
                    let result = self.scratch.join("repaired.off");
                    match peer.on(&file, &result) {
                        Ok(run) => runs.push(run),
                        Err(error) => made.runs = Err(error),
                    }
                    if round == 0 && peer.makes_mesh && made.runs.is_ok() {
                        let measured = self.json("1", &["measure", &result.to_string_lossy()]);
                        made.outcome = measured.ok().map(|(values, _)| values);
                    }
                }
            }
            eprintln!("{name}: {}", made[0].shown());
            rows.push(Row {
                name,
                triangles: found["triangles"].as_u64().unwrap_or(0),
                pairs: found["pairs"].as_u64().unwrap_or(0),
                made,
            });
        }
        Ok(rows)
    }

    fn grow(&self) -> Result<Vec<Grown>, String> {
        let mut grown = Vec::new();
        for (kind, frequencies) in GROWTH {
            for &frequency in frequencies {
                let file = self.make(kind, frequency)?;
                let (values, peak) = self.json("1", &["repair", &file.to_string_lossy()])?;
                let number = |key: &str| values[key].as_u64().unwrap_or(u64::MAX);
                grown.push(Grown {
                    kind,
                    triangles: number("triangles"),
                    pairs: number("pairs"),
                    run: Run {
                        cpu: values["cpu"].as_f64().unwrap_or(f64::NAN),
                        peak,
                        held: 1024 * number("held"),
                    },
                    remaining: number("remaining"),
                });
            }
        }
        Ok(grown)
    }

    fn search(&self) -> Result<Vec<Search>, String> {
        let mut searches = Vec::new();
        for (kind, frequencies) in GROWTH {
            // The last was made just now.
            let frequency = frequencies.last().copied().unwrap_or(1);
            let file = self.scratch.join(format!("{kind}_{frequency}.off"));
            let mut seconds = [Vec::new(), Vec::new()];
            let mut triangles = 0;
            for _ in 0..2 {
                for (threads, seconds) in ["1", "2"].into_iter().zip(&mut seconds) {
                    let (values, _) = self.json(threads, &["pairs", &file.to_string_lossy()])?;
                    seconds.push(values["wall"].as_f64().unwrap_or(f64::NAN));
                    triangles = values["triangles"].as_u64().unwrap_or(0);
                }
            }
            searches.push(Search {
                kind,
                triangles,
                seconds: seconds.map(|seconds| measured::minimum(&seconds)),
            });
        }
        Ok(searches)
    }
}

impl Made {
    /// The median seconds; NaN if there are none, which meets no goal.
    fn seconds(&self) -> f64 {
        let runs = self.runs.as_deref().unwrap_or_default();
        median(&runs.iter().map(|run| run.cpu).collect::<Vec<_>>())
    }

    fn peak(&self) -> Option<&Run> {
        let runs = self.runs.as_deref().unwrap_or_default();
        runs.iter().max_by_key(|run| run.peak)
    }

    /// Whether a closed manifold came out that does not cross itself.
    fn is_sound(&self) -> bool {
        self.outcome.as_ref().is_some_and(|outcome| {
            outcome["closed"] == true && outcome["manifold"] == true && outcome["intersecting"] == 0
        })
    }

    fn volume(&self) -> f64 {
        let volume = self
            .outcome
            .as_ref()
            .and_then(|outcome| outcome["volume"].as_f64());
        volume.unwrap_or(0.0)
    }

    fn shown(&self) -> String {
        match &self.runs {
            Ok(_) => format!("{:.3} s", self.seconds()),
            Err(error) => error.clone(),
        }
    }
}

impl Row {
    /// Whether a program made a mesh of the same volume as ours, which is sound.
    fn agrees(&self, program: usize) -> bool {
        let (ours, theirs) = (&self.made[0], &self.made[program]);
        let mesh = theirs.outcome.is_some();
        mesh && (theirs.volume() / ours.volume() - 1.0).abs() < 1e-9
    }
}
