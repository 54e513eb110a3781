//! `docs/benchmarks/delaunay.md` and its pictures.

use super::goals::{self, ratio_to, shown, speed_up};
use super::plot::{Bars, COLORS};
use super::programs::OURS;
use super::record::{Compared, Record};
use super::runs::Runs;
use crate::Outcome;
use std::fmt::Write as _;
use std::path::Path;

/// Other programs, in the order of their columns.
const PEERS: [&str; 3] = ["CGAL", "HXT", "TetGen"];

/// Writes the page and the pictures.
pub fn write(folder: &Path, record: &Record) -> Outcome {
    for (name, bars) in pictures(record) {
        crate::bench::write_file(folder, name, &bars.to_svg())?;
    }
    crate::bench::write_file(folder, "delaunay.md", &page(record))
}

/// An input in a line, for whoever waits.
pub fn summary(compared: &Compared) -> String {
    let mut parts = Vec::new();
    for peer in PEERS {
        if let Some([_, median]) = ratio_to(compared, peer) {
            parts.push(format!("{median:.2} of {peer}'s processor time"));
        }
    }
    if let Some([_, median]) = speed_up(compared, OURS, 2) {
        parts.push(format!("two threads {median:.2}"));
    }
    if let Some(bytes) = compared.runs_of(OURS, 1).and_then(Runs::own) {
        parts.push(format!("{bytes:.1} bytes a tetrahedron"));
    }
    parts.join(", ")
}

fn page(record: &Record) -> String {
    let mut text = "\
# Delaunay tetrahedralisation

Made by `cargo xtask bench --delaunay`, which says in its usage how to measure other inputs; the figures are in
`delaunay.json`. Inputs are made from seeds (`crates/delaunay/examples/common/inputs.rs`): *uniform* in a cube, *sphere* a
bumpy one, *torus* with R = 1 and r = 0.4, *grid* a shuffled cube of integers, *rounded* a sphere of radius
1000 rounded to integers, *weighted* uniform points with weights, of which regular tetrahedra are made.
Programs run in turns, one after the other, on the same file of points; reading it is not counted.

"
    .to_owned();
    for line in &record.about {
        let _ = writeln!(text, "- {line}");
    }
    goals_met(&mut text, record);
    times(&mut text, record);
    threads(&mut text, record);
    memory(&mut text, record);
    proofs(&mut text, record);
    text
}

fn goals_met(text: &mut String, record: &Record) {
    *text += "\n## Goals\n\n| what | wanted | here | met |\n|---|---|---:|---|\n";
    for goal in goals::of(record) {
        let (here, met) = match goal.here {
            Some(here) => (here, if goal.met { "yes" } else { "**no**" }),
            None => ("–".into(), "not measured"),
        };
        let _ = writeln!(text, "| {} | {} | {here} | {met} |", goal.what, goal.wanted);
    }
}

fn times(text: &mut String, record: &Record) {
    *text += "
## One thread

Seconds of the processor: the least and the median of the runs; behind it what ours takes as a part of theirs, of the
medians. *Load*: processes that wanted to run on the machine before, mean over a minute; above about 1 the seconds are
those of a busy machine.

![processor's time by point](delaunay-time.svg)

| input | finite tetrahedra | runs | Pellicle |";
    columns(text, PEERS.iter().map(|peer| format!(" {peer} |")));
    *text += " load |\n|---|---:|---:|---:|";
    columns(text, PEERS.iter().map(|_| "---:|".into()));
    *text += "---:|\n";
    for compared in &record.inputs {
        let Some(ours) = compared.runs_of(OURS, 1) else {
            continue;
        };
        let _ = write!(
            text,
            "| {} | {} | {} | {} |",
            shown(&compared.input),
            ours.tetrahedra,
            ours.cpu.len(),
            pair(ours.cpu())
        );
        columns(text, PEERS.iter().map(|peer| peer_cell(compared, peer)));
        let load = compared
            .load
            .map_or("–".into(), |load| format!("{load:.1}"));
        let _ = writeln!(text, " {load} |");
    }
}

fn peer_cell(compared: &Compared, peer: &str) -> String {
    let measured = compared.runs_of(peer, 1).zip(ratio_to(compared, peer));
    if let Some((runs, [_, ratio])) = measured {
        return format!(" {} · **{ratio:.2}** |", pair(runs.cpu()));
    }
    let failed = compared.runs.iter().find(|runs| runs.program == peer);
    match failed.and_then(|runs| runs.failed.as_ref()) {
        Some(_) => " fails |".into(),
        None => " – |".into(),
    }
}

fn threads(text: &mut String, record: &Record) {
    let others = more_threads(record);
    if others.is_empty() {
        return;
    }
    *text += "
## Threads

Wall seconds, the least and the median of the runs; behind several threads how many times faster they are than one, of the
medians. *Identical*: the arrays that come out with 1, 2, 3 and 4 threads are the same, bit for bit.

![threads](delaunay-threads.svg)

| input | Pellicle, 1 thread |";
    columns(text, others.iter().map(|n| format!(" {n} threads |")));
    *text += " HXT, 1 thread |";
    columns(text, others.iter().map(|n| format!(" {n} threads |")));
    *text += " identical |\n|---|---:|";
    columns(text, others.iter().map(|_| "---:|".into()));
    *text += "---:|";
    columns(text, others.iter().map(|_| "---:|".into()));
    *text += "---|\n";
    for compared in &record.inputs {
        let _ = write!(text, "| {} |", shown(&compared.input));
        for program in [OURS, "HXT"] {
            let one = compared.runs_of(program, 1);
            *text += &one.map_or(" – |".into(), |runs| format!(" {} |", pair(runs.wall())));
            for &n in &others {
                let several = compared
                    .runs_of(program, n)
                    .zip(speed_up(compared, program, n));
                *text += &several.map_or(" – |".into(), |(runs, [_, ratio])| {
                    format!(" {} · **{ratio:.2}** |", pair(runs.wall()))
                });
            }
        }
        let _ = writeln!(text, " {} |", answer(compared.identical));
    }
}

/// The numbers of threads above one with which ours was run.
fn more_threads(record: &Record) -> Vec<usize> {
    let runs = record.inputs.iter().flat_map(|compared| &compared.runs);
    let mut numbers: Vec<usize> = runs
        .filter(|runs| runs.program == OURS && runs.threads > 1)
        .map(|runs| runs.threads)
        .collect();
    numbers.sort_unstable();
    numbers.dedup();
    numbers
}

fn memory(text: &mut String, record: &Record) {
    *text += "
## Memory

Bytes a finite tetrahedron at the peak: the whole process / without what it held before the call, the caller's points among it.

![memory](delaunay-memory.svg)

| input | Pellicle, 1 thread | 2 threads | CGAL | TetGen, whole | Pellicle's peak, MiB |
|---|---:|---:|---:|---:|---:|
";
    for compared in &record.inputs {
        let Some(ours) = compared.runs_of(OURS, 1) else {
            continue;
        };
        let both = |runs: Option<&Runs>| {
            let bytes = runs.and_then(|runs| Some((runs.whole()?, runs.own()?)));
            bytes.map_or("–".into(), |(whole, own)| {
                format!("{whole:.1} / {own:.1}")
            })
        };
        let whole = compared.runs_of("TetGen", 1).and_then(Runs::whole);
        let _ = writeln!(
            text,
            "| {} | {} | {} | {} | {} | {} |",
            shown(&compared.input),
            both(Some(ours)),
            both(compared.runs_of(OURS, 2)),
            both(compared.runs_of("CGAL", 1)),
            whole.map_or("–".into(), |whole| format!("{whole:.0}")),
            ours.peak
                .map_or("–".into(), |peak| (peak >> 20).to_string()),
        );
    }
}

fn proofs(text: &mut String, record: &Record) {
    *text += "
## The result

*Same as CGAL's*: both sets of tetrahedra, compared whole (equal points are one vertex); CGAL's perturbation is ours, so
they must be equal on degenerate input too. *Checked*: a checker in exact arithmetic that shares no code with the library
finds that the tetrahedra are positive and tile the convex hull, that each facet is locally Delaunay, ties included, and
that each distinct point is a vertex (`crates/delaunay/tests/checker/`). The other programs' numbers of finite tetrahedra
may differ from ours where points are cospherical.

| input | Pellicle | same as CGAL's | checked |";
    columns(text, PEERS[1..].iter().map(|peer| format!(" {peer} |")));
    *text += "\n|---|---:|---|---|---:|---:|\n";
    for compared in &record.inputs {
        let count = |program: &str| {
            let runs = compared.runs_of(program, 1);
            runs.map_or("–".into(), |runs| runs.tetrahedra.to_string())
        };
        let _ = writeln!(
            text,
            "| {} | {} | {} | {} | {} | {} |",
            shown(&compared.input),
            count(OURS),
            answer(compared.same_set),
            answer(compared.checked),
            count("HXT"),
            count("TetGen"),
        );
    }
}

fn answer(answer: Option<bool>) -> &'static str {
    match answer {
        Some(true) => "yes",
        Some(false) => "**no**",
        None => "–",
    }
}

fn columns(text: &mut String, cells: impl Iterator<Item = String>) {
    text.extend(cells);
}

fn pair([least, median]: [f64; 2]) -> String {
    format!("{least:.2} / {median:.2}")
}

/// The same colour for the same program in all pictures.
fn color(program: &str, threads: usize) -> &'static str {
    let place = match (program, threads) {
        (OURS, 1) => 0,
        (OURS, _) => 1,
        ("CGAL", _) => 2,
        ("HXT", _) => 3,
        ("TetGen", _) => 4,
        _ => 5,
    };
    COLORS[place]
}

/// The pictures, with their names.
fn pictures(record: &Record) -> [(&'static str, Bars<'static>); 3] {
    let bars = |title,
                unit,
                series: &[(&str, usize)],
                line,
                value: &dyn Fn(&Compared, &Runs) -> Option<f64>| Bars {
        title,
        unit,
        series: series
            .iter()
            .map(|(program, threads)| {
                let name = match threads {
                    1 => (*program).to_owned(),
                    n => format!("{program}, {n} threads"),
                };
                (name, color(program, *threads))
            })
            .collect(),
        groups: record
            .inputs
            .iter()
            .map(|compared| {
                let heights = series.iter().map(|(program, threads)| {
                    value(compared, compared.runs_of(program, *threads)?)
                });
                (shown(&compared.input), heights.collect())
            })
            .collect(),
        line,
    };
    let alone = [(OURS, 1), ("CGAL", 1), ("HXT", 1), ("TetGen", 1)];
    [
        (
            "delaunay-time.svg",
            bars(
                "Delaunay tetrahedralisation, one thread",
                "microseconds of the processor by point, median",
                &alone,
                None,
                &|_, runs| Some(runs.cpu()[1] / runs.points as f64 * 1e6),
            ),
        ),
        (
            "delaunay-threads.svg",
            bars(
                "How many times faster two threads are than one",
                "wall time of one thread over that of two, of the medians",
                &[(OURS, 2), ("HXT", 2)],
                Some((1.0, "as one thread")),
                &|compared, runs| Some(speed_up(compared, &runs.program, runs.threads)?[1]),
            ),
        ),
        (
            "delaunay-memory.svg",
            bars(
                "Memory at the peak",
                "bytes a finite tetrahedron, the input not counted",
                &[(OURS, 1), (OURS, 2), ("CGAL", 1)],
                None,
                &|_, runs| runs.own(),
            ),
        ),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn record() -> Record {
        let runs = |program: &str, threads, seconds: &[f64]| Runs {
            program: program.into(),
            threads,
            cpu: seconds.into(),
            wall: seconds.into(),
            points: 100_000,
            tetrahedra: 70,
            held: Some(1400),
            peak: Some(7000),
            failed: None,
        };
        let mut compared = Compared {
            same_set: Some(false),
            checked: Some(true),
            load: Some(0.25),
            ..Compared::of("uniform:100000")
        };
        compared.load = Some(0.25);
        compared.runs = vec![
            runs(OURS, 1, &[1.0, 3.0, 4.0]),
            runs(OURS, 2, &[1.0, 2.0, 2.0]),
            runs("CGAL", 1, &[2.0]),
            Runs {
                failed: Some("not done".into()),
                ..runs("TetGen", 1, &[])
            },
        ];
        Record {
            about: vec!["some machine".into()],
            inputs: vec![compared],
        }
    }

    #[test]
    fn the_page_shows_what_was_measured_and_what_was_not() {
        let page = page(&record());
        for row in [
            "- some machine",
            "| uniform 100 k | 70 | 3 | 1.00 / 3.00 | 2.00 / 2.00 · **1.50** | – | fails | 0.2 |",
            "| uniform 100 k | 1.00 / 3.00 | 1.00 / 2.00 · **1.50** | – | – | – |",
            "| uniform 100 k | 100.0 / 80.0 | 100.0 / 80.0 | 100.0 / 80.0 | – | 0 |",
            "| uniform 100 k | 70 | **no** | yes | – | – |",
            "| torus 1 M: processor's time, as a part of CGAL's | at most 0.60 | – | not measured |",
        ] {
            assert!(page.contains(row), "{row}\n{page}");
        }
    }

    #[test]
    fn the_pictures_show_it_too() {
        let pictures = pictures(&record());
        let count = |i: usize| pictures[i].1.to_svg().matches("<title>").count();
        assert_eq!([count(0), count(1), count(2)], [2, 1, 3]);
    }

    #[test]
    fn a_summary_names_the_ratios() {
        let record = record();
        let summary = summary(&record.inputs[0]);
        assert_eq!(
            summary,
            "1.50 of CGAL's processor time, two threads 1.50, 80.0 bytes a tetrahedron"
        );
    }
}
