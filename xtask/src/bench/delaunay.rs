//! `cargo xtask bench --delaunay`: our tetrahedralisation against CGAL's, where Debian's `libcgal-dev` is installed.

use super::cgal_program;
use super::measured::{self, Measured, median, minimum};
use crate::{Outcome, execute};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// Runs of each program on each input, taken in turns.
const ROUNDS: usize = 5;

/// What `time_delaunay` can make: uniform in a cube, a bumpy sphere, an integer grid, a sphere rounded to integers.
const INPUTS: [&str; 4] = [
    "uniform:1000000",
    "sphere:1000000",
    "grid:1000000",
    "rounded:200000",
];

/// One program on one input.
#[derive(Default)]
struct Runs {
    seconds: Vec<f64>,
    peak_bytes: u64,
    points: u64,
    tetrahedra: u64,
}

/// Both programs on one input.
struct Compared {
    input: String,
    ours: Runs,
    cgal: Runs,
    same_set: bool,
}

/// Times the inputs, `KIND:COUNT` each, or those that [`INPUTS`] names; writes the page.
pub fn run(root: &Path, inputs: &[&str]) -> Outcome {
    let inputs = if inputs.is_empty() {
        &INPUTS[..]
    } else {
        inputs
    };
    let (ours, scratch) = our_program(root)?;
    let cgal = cgal_program(root, &scratch, "cgal_delaunay")?;
    let compared = inputs
        .iter()
        .map(|input| compare(&ours, &cgal, &scratch, input))
        .collect::<Result<Vec<_>, _>>()?;
    super::write_page(root, "delaunay.md", &page(&compared))?;
    match compared.iter().find(|compared| !compared.same_set) {
        Some(compared) => Err(format!("{}: the sets of tetrahedra differ", compared.input)),
        None => Ok(()),
    }
}

fn our_program(root: &Path) -> Result<(PathBuf, PathBuf), String> {
    execute(
        root,
        &[],
        &[
            "cargo",
            "build",
            "--release",
            "--package",
            "pellicle-delaunay",
            "--example",
            "time_delaunay",
        ],
    )?;
    let target = super::target_folder(root)?;
    let scratch = target.join("bench");
    std::fs::create_dir_all(&scratch).map_err(|error| format!("{}: {error}", scratch.display()))?;
    Ok((target.join("release/examples/time_delaunay"), scratch))
}

fn compare(ours: &Path, cgal: &Path, scratch: &Path, input: &str) -> Result<Compared, String> {
    let (kind, count) = input
        .split_once(':')
        .ok_or_else(|| format!("{input}: KIND:COUNT is wanted"))?;
    let path = |name: &str| scratch.join(name).to_string_lossy().into_owned();
    let (points, our_set, cgal_set) = (path("points"), path("ours"), path("cgal"));
    measured::run(
        ours,
        &[kind, count, "--points", &points, "--dump", &our_set],
    )?;
    measured::run(cgal, &[&points, &cgal_set])?;
    let bytes = |file: &str| std::fs::read(file).map_err(|error| format!("{file}: {error}"));
    let representatives = representatives(&bytes(&points)?);
    let set = |file: &str| Ok::<_, String>(canonical_set(&bytes(file)?, &representatives));
    let same_set = set(&our_set)? == set(&cgal_set)?;

    let mut compared = Compared {
        input: input.to_owned(),
        ours: Runs::default(),
        cgal: Runs::default(),
        same_set,
    };
    for _ in 0..ROUNDS {
        compared.ours.add(measured::run(ours, &[kind, count])?)?;
        compared.cgal.add(measured::run(cgal, &[&points])?)?;
    }
    let [least, middle] = compared.ratios();
    eprintln!("{input}: {least:.2} times CGAL's least time, {middle:.2} times its median");
    Ok(compared)
}

/// For each point, given as three little-endian doubles, the lowest id of an equal point: the programs name equal points
/// by different ids.
fn representatives(points: &[u8]) -> Vec<u32> {
    let coordinate = |bytes: &[u8]| {
        let mut eight = [0; 8];
        eight.copy_from_slice(bytes);
        // Adding zero makes −0 and 0 one.
        (f64::from_le_bytes(eight) + 0.0).to_bits()
    };
    let points: Vec<[u64; 3]> = points
        .chunks_exact(24)
        .map(|p| {
            [
                coordinate(&p[..8]),
                coordinate(&p[8..16]),
                coordinate(&p[16..]),
            ]
        })
        .collect();
    let mut order: Vec<u32> = (0..points.len() as u32).collect();
    order.sort_unstable_by_key(|&i| (points[i as usize], i));
    let mut representatives = vec![0; points.len()];
    for equal in order.chunk_by(|&a, &b| points[a as usize] == points[b as usize]) {
        for &point in equal {
            representatives[point as usize] = equal[0];
        }
    }
    representatives
}

/// The tetrahedra of a dump, four little-endian ids each, by representatives and sorted; ids out of range stay.
fn canonical_set(dump: &[u8], representatives: &[u32]) -> Vec<[u32; 4]> {
    let mut set: Vec<[u32; 4]> = dump
        .chunks_exact(16)
        .map(|tet| {
            let mut corners = [0, 4, 8, 12].map(|at| {
                let id = u32::from_le_bytes([tet[at], tet[at + 1], tet[at + 2], tet[at + 3]]);
                representatives.get(id as usize).copied().unwrap_or(id)
            });
            corners.sort_unstable();
            corners
        })
        .collect();
    set.sort_unstable();
    set
}

impl Runs {
    /// Takes in a run that printed seconds, points and tetrahedra.
    fn add(&mut self, run: Measured) -> Outcome {
        let numbers: Vec<f64> = run
            .output
            .split_whitespace()
            .filter_map(|word| word.parse().ok())
            .collect();
        let [seconds, points, tetrahedra] = numbers[..] else {
            return Err(format!("not three numbers: {}", run.output));
        };
        self.seconds.push(seconds);
        self.points = points as u64;
        self.tetrahedra = tetrahedra as u64;
        self.peak_bytes = self.peak_bytes.max(run.peak_bytes.unwrap_or(0));
        Ok(())
    }

    /// The least and the median seconds.
    fn shown(&self) -> String {
        format!(
            "{:.2} / {:.2}",
            minimum(&self.seconds),
            median(&self.seconds)
        )
    }

    /// The program's whole memory at its peak, by tetrahedron.
    fn peak_per_tetrahedron(&self) -> f64 {
        self.peak_bytes as f64 / self.tetrahedra as f64
    }
}

impl Compared {
    /// Our least seconds over CGAL's, and the same of the medians. Other work on the machine lengthens the medians.
    fn ratios(&self) -> [f64; 2] {
        [minimum, median].map(|of| of(&self.ours.seconds) / of(&self.cgal.seconds))
    }
}

fn page(compared: &[Compared]) -> String {
    let mut text = format!(
        "\
# Delaunay tetrahedralisation, against CGAL

Made by `cargo xtask bench --delaunay` on {}.
Wall seconds of one thread, sorting and insertion alone; the least and the median of {ROUNDS} runs taken in turns. Peak: the most resident
memory of the whole program by finite tetrahedron, the points included. *Same set*: both programs return the same set of
tetrahedra, compared vertex by vertex (equal points are one vertex). CGAL is `Delaunay_triangulation_3` with its exact predicates and inexact
constructions, from Debian's `libcgal-dev`, compiled with -O3.

| input | finite tetrahedra | Pellicle s | CGAL s | ratio of least | ratio of medians | Pellicle peak, bytes | CGAL peak, bytes | same set |
|---|---:|---:|---:|---:|---:|---:|---:|---|
",
        super::machine()
    );
    for c in compared {
        let [least, middle] = c.ratios();
        let _ = writeln!(
            text,
            "| {} | {} | {} | {} | {least:.2} | {middle:.2} | {:.0} | {:.0} | {} |",
            c.input.replace(':', " "),
            c.ours.tetrahedra,
            c.ours.shown(),
            c.cgal.shown(),
            c.ours.peak_per_tetrahedron(),
            c.cgal.peak_per_tetrahedron(),
            if c.same_set { "yes" } else { "**no**" }
        );
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    fn measured(output: &str) -> Measured {
        Measured {
            seconds: 9.0,
            peak_bytes: Some(7000),
            output: output.to_owned(),
        }
    }

    #[test]
    fn runs_are_read_from_what_programs_print() {
        let mut runs = Runs::default();
        runs.add(measured("0.250 100 70\n")).unwrap();
        assert_eq!(
            (runs.seconds[0], runs.points, runs.tetrahedra),
            (0.25, 100, 70)
        );
        assert_eq!(runs.peak_per_tetrahedron(), 100.0);
        assert!(runs.add(measured("done\n")).is_err());
    }

    #[test]
    fn sets_are_compared_by_place_not_by_id() {
        // Points 1 and 3 are equal, zeros of either sign included.
        let coordinates = [
            [1.0, 0.0, 0.0],
            [0.0, 2.0, 0.0],
            [0.0, 0.0, 3.0],
            [-0.0, 2.0, 0.0],
        ];
        let points: Vec<u8> = coordinates
            .iter()
            .flatten()
            .flat_map(|c: &f64| c.to_le_bytes())
            .collect();
        let representatives = representatives(&points);
        assert_eq!(representatives, [0, 1, 2, 1]);
        let set = |tets: &[[u32; 4]]| {
            let bytes: Vec<u8> = tets
                .iter()
                .flatten()
                .flat_map(|id| id.to_le_bytes())
                .collect();
            canonical_set(&bytes, &representatives)
        };
        assert_eq!(
            set(&[[0, 1, 2, 7], [0, 3, 2, 9]]),
            set(&[[9, 2, 0, 1], [7, 3, 2, 0]])
        );
        assert_ne!(set(&[[0, 1, 2, 7]]), set(&[[0, 2, 2, 7]]));
    }

    #[test]
    fn the_page_shows_the_ratios() {
        let mut compared = Compared {
            input: "uniform:100".into(),
            ours: Runs::default(),
            cgal: Runs::default(),
            same_set: false,
        };
        for seconds in ["1.0", "3.0", "4.0"] {
            compared
                .ours
                .add(measured(&format!("{seconds} 100 70")))
                .unwrap();
        }
        compared.cgal.add(measured("2.0 100 70")).unwrap();
        let page = page(&[compared]);
        assert!(
            page.contains("| uniform 100 | 70 | 1.00 / 3.00 | 2.00 / 2.00 | 0.50 | 1.50 | 100 | 100 | **no** |"),
            "{page}"
        );
    }
}
