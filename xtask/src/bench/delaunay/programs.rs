//! The programs: ours, and others where they are installed.

use super::arguments::Arguments;
use super::runs::Runs;
use crate::bench::measured::{self, Measured};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;

/// The name under which ours is shown.
pub const OURS: &str = "Pellicle";

/// The word in a program's arguments that stands for the file of points.
const POINTS: &str = "POINTS";

/// The word that stands for the option of a file of weights, or for nothing.
const WEIGHTS: &str = "WEIGHTS";

/// A program that is timed: it reads a file of points and prints a line for [`super::runs::Run::read`].
pub struct Program {
    /// Without the threads.
    pub name: &'static str,
    pub threads: usize,
    pub is_ours: bool,
    program: PathBuf,
    words: Vec<String>,
}

impl Program {
    /// Whether it knows points with weights.
    pub fn weighs(&self) -> bool {
        self.words.iter().any(|word| word == WEIGHTS)
    }

    /// Runs it on the points of this file, with the weights of the other, and with more words behind.
    pub fn run(
        &self,
        points: &Path,
        weights: Option<&Path>,
        more: &[&str],
        limit: Duration,
    ) -> Result<Measured, String> {
        let points = points.to_string_lossy();
        let weights = weights.map(Path::to_string_lossy);
        let weights = weights.as_deref().map(|weights| ["--weights", weights]);
        let words: Vec<&str> = self
            .words
            .iter()
            .flat_map(|word| match (word.as_str(), weights) {
                (POINTS, _) => vec![&*points],
                (WEIGHTS, Some(words)) => words.into(),
                (WEIGHTS, None) => Vec::new(),
                (word, _) => vec![word],
            })
            .chain(more.iter().copied())
            .collect();
        measured::run_within(limit, &[], &self.program, &words)
    }

    /// Where its runs are put.
    pub fn no_runs(&self) -> Runs {
        Runs {
            program: self.name.into(),
            threads: self.threads,
            ..Runs::default()
        }
    }
}

/// Everything that is run.
pub struct Programs {
    /// A folder for files of points and tetrahedra.
    pub scratch: PathBuf,
    /// In the order in which they take turns.
    pub timed: Vec<Program>,
    ours: PathBuf,
    checker: PathBuf,
    about: Vec<String>,
}

impl Programs {
    /// Builds ours, and finds or builds the others; tells which are missing.
    pub fn build(root: &Path, arguments: &Arguments) -> Result<Self, String> {
        let [ours, checker] = ["time_delaunay", "check_delaunay"];
        let examples = crate::bench::delaunay_examples(root, &[ours, checker])?;
        let target = crate::bench::target_folder(root)?;
        let scratch = target.join("bench");
        std::fs::create_dir_all(&scratch)
            .map_err(|error| format!("{}: {error}", scratch.display()))?;
        let example = |name: &str| examples.join(name);
        let mut programs = Self {
            timed: arguments
                .threads
                .iter()
                .map(|&threads| our_program(example(ours), threads))
                .collect(),
            ours: example(ours),
            checker: example(checker),
            about: vec![crate::bench::machine()],
            scratch,
        };
        programs.find_cgal(root, arguments);
        programs.find_by_python(root, arguments);
        Ok(programs)
    }

    /// CGAL's, which dumps its tetrahedra into a file that is named behind the points.
    pub fn cgal(&self) -> Option<&Program> {
        self.timed.iter().find(|program| program.name == "CGAL")
    }

    /// The machine, and each program's version, or that it is missing.
    pub fn about(&self) -> Vec<String> {
        self.about.clone()
    }

    /// Runs ours: first words, then options with paths, then others.
    pub fn ours(
        &self,
        words: &[&str],
        files: &[(&str, &Path)],
        others: &[(&str, &str)],
    ) -> Result<String, String> {
        let mut all: Vec<String> = words.iter().map(|word| (*word).to_owned()).collect();
        for (name, file) in files {
            all.extend([(*name).to_owned(), file.to_string_lossy().into_owned()]);
        }
        for (name, value) in others {
            all.extend([(*name).to_owned(), (*value).to_owned()]);
        }
        let words: Vec<&str> = all.iter().map(String::as_str).collect();
        Ok(measured::run(&self.ours, &words)?.output)
    }

    /// What the exact checker says; an error if it finds a defect.
    pub fn check(&self, points: &Path) -> Result<String, String> {
        let points = points.to_string_lossy();
        Ok(measured::run(&self.checker, &["file", &points])?.output)
    }

    fn missing(&mut self, name: &str, reason: &str) {
        let reason = reason.lines().last().unwrap_or_default();
        eprintln!("no {name}: {reason}");
        self.about.push(format!("{name}: missing"));
    }

    fn find_cgal(&mut self, root: &Path, arguments: &Arguments) {
        if !arguments.wants("CGAL") {
            return;
        }
        match cgal_program(root, &self.scratch) {
            Ok((program, version)) => {
                self.about.push(format!(
                    "CGAL {version}: Delaunay_triangulation_3 and Regular_triangulation_3, exact predicates and inexact constructions, -O3, one thread"
                ));
                self.timed.push(Program {
                    name: "CGAL",
                    threads: 1,
                    is_ours: false,
                    program,
                    words: [WEIGHTS, POINTS].map(str::to_owned).into(),
                });
            }
            Err(reason) => self.missing("CGAL", &reason),
        }
    }

    fn find_by_python(&mut self, root: &Path, arguments: &Arguments) {
        let threads = &arguments.threads[..];
        for (name, script, threads, about) in [
            (
                "HXT",
                "hxt_delaunay.py",
                threads,
                "HXT in gmsh, the making of gmsh's own tetrahedra included",
            ),
            ("TetGen", "tetgen_delaunay.py", &[1], "TetGen"),
        ] {
            if !arguments.wants(name) {
                continue;
            }
            let script = root.join("xtask/peers").join(script);
            let script = script.to_string_lossy().into_owned();
            let python = crate::bench::python();
            match measured::run(&python, &[&script, "--version"]) {
                Ok(run) => self.about.push(format!("{about}: {}", run.output.trim())),
                Err(reason) => {
                    self.missing(name, &reason);
                    continue;
                }
            }
            for &threads in threads {
                self.timed.push(Program {
                    name,
                    threads,
                    is_ours: false,
                    program: python.clone(),
                    words: vec![script.clone(), POINTS.into(), threads.to_string()],
                });
            }
        }
    }
}

fn our_program(program: PathBuf, threads: usize) -> Program {
    let words = ["file", POINTS, WEIGHTS, "--threads", &threads.to_string()];
    Program {
        name: OURS,
        threads,
        is_ours: true,
        program,
        words: words.map(str::to_owned).into(),
    }
}

/// Builds CGAL's program, and asks for its version and the compiler's.
fn cgal_program(root: &Path, scratch: &Path) -> Result<(PathBuf, String), String> {
    let program = crate::bench::cgal_program(root, scratch, "cgal_delaunay")?;
    let version = measured::run(&program, &["--version"])?.output;
    let compiler = Command::new("g++").arg("-dumpfullversion").output();
    let compiler = compiler.map_or(String::new(), |output| {
        format!(", g++ {}", String::from_utf8_lossy(&output.stdout).trim())
    });
    Ok((program, format!("{}{compiler}", version.trim())))
}
