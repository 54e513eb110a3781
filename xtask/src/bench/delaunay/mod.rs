//! `cargo xtask bench --delaunay`: our tetrahedralisation beside those of other programs, where they are installed.
//!
//! For each input: a seeded set of points is written to a file; the set of tetrahedra is compared with CGAL's, all of it;
//! the result is compared between numbers of threads and looked at by an exact checker that shares no code with the
//! library; then all programs are timed in turns. What was measured is kept in `docs/benchmarks/delaunay.json`, and the
//! page and its pictures are made from that.
//!
//! To add a program: a [`programs::Program`] that prints `cpu=… wall=… points=… tetrahedra=…`. To add an input: a kind in
//! `crates/delaunay/examples/common/inputs.rs`, or a file of little-endian doubles, as `file:PATH`.

mod arguments;
mod goals;
mod page;
mod plot;
mod programs;
mod record;
mod runs;
mod sets;

use crate::Outcome;
use arguments::Arguments;
use programs::{Program, Programs};
use record::{Compared, Record};
use runs::{Run, Runs};
use std::path::Path;
use std::time::Duration;

/// The inputs without arguments.
const INPUTS: [&str; 9] = [
    "uniform:100000",
    "uniform:1000000",
    "uniform:4000000",
    "uniform:10000000",
    "sphere:1000000",
    "torus:1000000",
    "grid:1000000",
    "rounded:200000",
    "weighted:1000000",
];

/// The inputs of `--quick`: a look that takes a minute or two.
const QUICK: [&str; 6] = [
    "uniform:100000",
    "sphere:100000",
    "torus:20000",
    "grid:27000",
    "rounded:50000",
    "weighted:50000",
];

/// The kind of points that have weights: of them a regular tetrahedralisation is made, and the exact checker of Delaunay's, which
/// does not know of weights, has no say.
const WEIGHTED: &str = "weighted";

/// Other programs run on so many points at most; beyond, memory and patience end.
const MOST_FOR_PEERS: u64 = 5_000_000;

/// The exact checker runs on so many points at most.
const MOST_FOR_CHECKER: u64 = 1_000_000;

/// A program that takes longer is given up.
const LIMIT: Duration = Duration::from_secs(1800);

/// Measures what the arguments name; writes the record, the page and the pictures.
pub fn run(root: &Path, words: &[&str]) -> Outcome {
    let arguments = Arguments::parse(words)?;
    // A quick look is no figure to publish.
    let folder = match arguments.quick {
        true => crate::bench::target_folder(root)?.join("bench"),
        false => root.join("docs/benchmarks"),
    };
    let mut record = match arguments.keep {
        true => Record::read(&folder)?,
        false => Record::default(),
    };
    if !arguments.inputs.is_empty() {
        let programs = Programs::build(root, &arguments)?;
        record.about_programs(programs.about());
        for input in &arguments.inputs {
            let compared = compare(&programs, input, &arguments)?;
            eprintln!("{input}: {}", page::summary(&compared));
            record.put(compared);
            // After each input, so that what is interrupted has not run for nothing.
            record.write(&folder)?;
        }
    }
    page::write(&folder, &record)?;
    match record.inputs.iter().find_map(Compared::defect) {
        Some(defect) => Err(defect),
        None => Ok(()),
    }
}

/// All programs on one input.
fn compare(programs: &Programs, input: &str, arguments: &Arguments) -> Result<Compared, String> {
    let (kind, count) = input
        .split_once(':')
        .ok_or_else(|| format!("{input}: KIND:COUNT or file:PATH is wanted"))?;
    let path = |name: &str| programs.scratch.join(name);
    let points = path("points");
    let weights = (kind == WEIGHTED).then(|| path("weights"));
    let weights = weights.as_deref();
    // A file's folders are nobody else's business.
    let name = count.rsplit(['/', '\\']).next().unwrap_or(count);
    let mut compared = Compared::of(&format!("{kind}:{name}"));

    // 1. The points, and what comes of them with one thread and with several.
    let others: Vec<String> = [1, 2, 3, 4].map(|n: usize| n.to_string()).into();
    let ours = path("ours");
    let mut files = vec![("--points", &*points), ("--dump", &*ours)];
    files.extend(weights.map(|weights| ("--weights", weights)));
    let made = programs.ours(
        &[kind, count, "--threads", "1"],
        &files,
        &[("--identical", &others[1..].join(","))],
    )?;
    let first = Run::read(&made)?;
    compared.identical = Some(made.matches("identical with").count() == others.len() - 1);

    // 2. The same tetrahedra as CGAL's.
    let peers = first.points <= MOST_FOR_PEERS;
    if let Some(cgal) = programs.cgal().filter(|_| peers) {
        let theirs = path("cgal");
        cgal.run(&points, weights, &[&theirs.to_string_lossy()], LIMIT)?;
        let difference = sets::compare(&points, &ours, &theirs)?;
        if !difference.is_empty() {
            eprintln!("{input}: {difference:?}");
        }
        compared.same_set = Some(difference.is_empty());
        remove(&theirs);
    }
    remove(&ours);

    // 3. The exact checker.
    if first.points <= MOST_FOR_CHECKER && arguments.check && weights.is_none() {
        compared.checked = Some(match programs.check(&points) {
            Ok(text) => {
                eprint!("{text}");
                true
            }
            Err(reason) => {
                eprintln!("{input}: {reason}");
                false
            }
        });
    }

    // 4. All programs in turns.
    let runnable: Vec<&Program> = programs
        .timed
        .iter()
        .filter(|program| peers || program.is_ours)
        .filter(|program| weights.is_none() || program.weighs())
        .collect();
    compared.runs = in_turns(&runnable, &points, weights, arguments.rounds);
    remove(&points);
    if let Some(weights) = weights {
        remove(weights);
    }
    Ok(compared)
}

/// A B C A B C …; a program that fails once is left out from then on.
fn in_turns(
    programs: &[&Program],
    points: &Path,
    weights: Option<&Path>,
    rounds: usize,
) -> Vec<Runs> {
    let mut all: Vec<Runs> = programs.iter().map(|program| program.no_runs()).collect();
    for _ in 0..rounds {
        for (program, runs) in programs.iter().zip(&mut all) {
            if runs.failed.is_some() {
                continue;
            }
            let run = program
                .run(points, weights, &[], LIMIT)
                .and_then(|made| Ok((Run::read(&made.output)?, made.peak_bytes)));
            match run {
                Ok((run, peak)) => runs.add(&run, peak),
                Err(reason) => {
                    eprintln!("{}: {reason}", program.name);
                    runs.failed = Some(reason.lines().next().unwrap_or_default().to_owned());
                }
            }
        }
    }
    all
}

/// Removes a file that may be large; if that fails, the next input overwrites it.
fn remove(file: &Path) {
    let _ = std::fs::remove_file(file);
}
