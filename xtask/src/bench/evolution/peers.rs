//! Other programs on the same clouds: each is run where it is installed, and its mesh measured as ours is.

use super::{ALONE, Programs, Row};
use crate::bench::{cgal_program, measured};
use std::path::{Path, PathBuf};

/// The octree's depth of screened Poisson.
pub const DEPTH: &str = "8";
/// α of the wrapping, as parts of the diagonal: a coarse one that stays outside of sparse clouds, and a finer one.
pub const ALPHAS: [&str; 2] = ["20", "50"];
/// The offset of the wrapping, as parts of the diagonal.
pub const OFFSET: &str = "600";

/// What a program made of each cloud: in the order of the clouds; none where it failed.
pub struct Peer {
    pub name: String,
    pub rows: Vec<Option<(Row, f64)>>,
}

/// All programs that are installed, on the clouds with truth on which the adaptive schedule ran.
pub fn run(root: &Path, programs: &Programs, ours: &[Row]) -> Result<Vec<Peer>, String> {
    let clouds: Vec<&Row> = ours.iter().filter(|row| is_compared(row)).collect();
    let mut runs = Vec::new();
    if let Some(python) = python() {
        let script = root
            .join("xtask/peers/poisson.py")
            .to_string_lossy()
            .into_owned();
        runs.push(Program {
            name: "screened Poisson".into(),
            program: python,
            before: vec![script, DEPTH.into()],
            after: Vec::new(),
            mesh: programs.scratch.join("peer.ply"),
        });
    } else {
        eprintln!("no python with open3d: PELLICLE_PYTHON may name one");
    }
    match cgal_program(root, &programs.scratch, "cgal_alpha_wrap") {
        Ok(program) => runs.extend(ALPHAS.map(|alpha| Program {
            name: format!("alpha wrapping, 1/{alpha}"),
            program: program.clone(),
            before: Vec::new(),
            after: vec![alpha.into(), OFFSET.into()],
            mesh: programs.scratch.join("peer.off"),
        })),
        Err(error) => eprintln!("no alpha wrapping: {error}"),
    }
    let mut peers: Vec<Peer> = runs
        .iter()
        .map(|run| Peer {
            name: run.name.clone(),
            rows: Vec::new(),
        })
        .collect();
    let points = programs.scratch.join("peer.xyz");
    for cloud in clouds {
        let name = cloud.name();
        measured::run(
            &programs.table,
            &["cloud", &name, &points.to_string_lossy()],
        )?;
        for (run, peer) in runs.iter().zip(&mut peers) {
            let made = run.on(programs, &name, &points);
            if let Err(error) = &made {
                eprintln!("{name}, {}: {error}", run.name);
            }
            peer.rows.push(made.ok());
        }
        eprintln!("{name}: compared");
    }
    Ok(peers)
}

/// Whether other programs run on the cloud of this row.
pub fn is_compared(row: &Row) -> bool {
    row.schedule == "adaptive" && !["fine", "scan"].contains(&row.cloud.as_str())
}

/// PROGRAM BEFORE… POINTS MESH AFTER…
struct Program {
    name: String,
    program: PathBuf,
    before: Vec<String>,
    after: Vec<String>,
    mesh: PathBuf,
}

impl Program {
    /// The measures of what it makes of the points, and its own seconds.
    fn on(&self, programs: &Programs, name: &str, points: &Path) -> Result<(Row, f64), String> {
        // A mesh of another cloud shall not be taken for this one's.
        if self.mesh.exists() {
            std::fs::remove_file(&self.mesh).map_err(|error| error.to_string())?;
        }
        let (points, mesh) = (points.to_string_lossy(), self.mesh.to_string_lossy());
        let mut words: Vec<&str> = self.before.iter().map(String::as_str).collect();
        words.extend([&*points, &*mesh]);
        words.extend(self.after.iter().map(String::as_str));
        let run = measured::run_in(&ALONE, &self.program, &words)?;
        let last = run.output.lines().last().unwrap_or_default().trim();
        let seconds = last.parse().map_err(|_| format!("not seconds: {last}"))?;
        let measures = measured::run(&programs.table, &["measure", name, &mesh])?;
        Ok((Row::read(name, measures.output.trim())?, seconds))
    }
}

/// A python that has open3d: that of PELLICLE_PYTHON, else `python3`.
fn python() -> Option<PathBuf> {
    let python = crate::bench::python();
    let tried = measured::run(&python, &["-c", "import open3d, numpy"]);
    tried.is_ok().then_some(python)
}
