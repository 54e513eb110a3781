//! `docs/benchmarks/repair.md`.

use super::goals::Goal;
use super::peers::{LIMIT, Peer, Run};
use super::{Grown, Made, ROUNDS, Row, Search};
use std::fmt::Write as _;

/// The page. `loads`: how busy the machine was before and after.
pub fn page(
    machine: &str,
    loads: &(Option<f64>, Option<f64>),
    goals: &[Goal],
    rows: &[Row],
    peers: &[Peer],
    grown: &[Grown],
    searches: &[Search],
) -> String {
    let load = |load: Option<f64>| load.map_or("unknown".into(), |load| format!("{load:.1}"));
    let mut text = format!(
        "\
# Repair of meshes that cross themselves

Made by `cargo xtask bench --repair FOLDER` on {machine}.
Load of the machine (processes that want to run, mean over a minute) before and after: {} and {}; above about 1, other
work lengthened the seconds, and two threads had no two processors to themselves.

## Goals

| what | wanted | here | met |
|---|---|---|---|
",
        load(loads.0),
        load(loads.1)
    );
    for goal in goals {
        let met = if goal.met { "yes" } else { "**no**" };
        let _ = writeln!(
            text,
            "| {} | {} | {} | {met} |",
            goal.what, goal.wanted, goal.here
        );
    }
    compared(&mut text, rows, peers);
    sizes(&mut text, grown);
    threads(&mut text, searches);
    text
}

fn compared(text: &mut String, rows: &[Row], peers: &[Peer]) {
    let _ = write!(
        text,
        "
## Beside others

Seconds of CPU of one thread for the work alone, files not counted: medians of {ROUNDS} runs taken in turns, and in brackets
times ours. Memory: the whole program at its peak, and what of it came with the work
and with writing the result, in MB. Of the result: volume,
components/genus, pairs that intersect in the doubles that were written; *border* or *not manifold* where it is that. In
bold where it is not as ours. A program that took more than {} s was stopped, and not tried again.

`valley50k`: a sphere whose valley has closed, the case of Zaharescu et al. 2007. `bunny25k_offset5`: the Stanford bunny
moved outwards by 5 %. Two spheres: 98,000 triangles each. `torus_closed` and `dumbbell_pinch`: many sheets through each
other. Bumpy: a bumpy sphere moved outwards. libigl: `mesh_boolean` with nothing. Manifold (C++): the union of the
components; it does not take one apart that crosses itself. CGAL 5.5: `self_intersections`, which finds pairs and no more,
and `autorefine_and_remove_self_intersections`. manifold-rust: `rebuild_solid` with winding numbers of at least 1.
",
        LIMIT.as_secs()
    );
    for row in rows {
        let _ = write!(
            text,
            "
### {}: {} triangles, {} pairs

| program | s | memory, MB | volume | components/genus | pairs left |
|---|---:|---:|---:|---|---:|
",
            row.name, row.triangles, row.pairs
        );
        for (program, (peer, made)) in peers.iter().zip(&row.made).enumerate() {
            let _ = writeln!(text, "| {} | {} |", peer.name, cells(row, program, made));
        }
    }
}

fn cells(row: &Row, program: usize, made: &Made) -> String {
    let Ok(_) = &made.runs else {
        return format!("{} | | | | ", made.shown());
    };
    let ours = row.made[0].seconds();
    let mut seconds = format!("{:.3}", made.seconds());
    if program > 0 {
        let _ = write!(seconds, " ({:.1})", made.seconds() / ours);
    }
    let memory = made.peak().map(memory).unwrap_or_default();
    let Some(outcome) = &made.outcome else {
        return format!("{seconds} | {memory} | | | ");
    };
    let like = |shown: String, is_like: bool| {
        if is_like {
            shown
        } else {
            format!("**{shown}**")
        }
    };
    let mut volume = like(
        format!("{:.9}", made.volume()),
        row.agrees(program) || program == 0,
    );
    if outcome["volume"].is_null() && outcome["components"] != 0 {
        volume = "–".into();
    }
    let ours = row.made[0].outcome.as_ref();
    let topology = if outcome["manifold"] != true {
        "**not manifold**".into()
    } else if outcome["closed"] != true {
        "**border**".into()
    } else {
        let shown = format!("{}/{}", outcome["components"], outcome["genus"]);
        let same = |key: &str| ours.is_some_and(|ours| ours[key] == outcome[key]);
        like(shown, same("components") && same("genus"))
    };
    let left = like(
        outcome["intersecting"].to_string(),
        outcome["intersecting"] == 0,
    );
    format!("{seconds} | {memory} | {volume} | {topology} | {left}")
}

fn memory(run: &Run) -> String {
    let mb = |bytes: u64| bytes as f64 / 1e6;
    format!(
        "{:.0}, {:.0}",
        mb(run.peak),
        mb(run.peak.saturating_sub(run.held))
    )
}

fn sizes(text: &mut String, grown: &[Grown]) {
    *text += "
## Growth

One run each, one thread: seconds of CPU of the repair alone. With n log n the last column would stand still.

| mesh | triangles | pairs | pairs left | s | memory, MB | ns / (n log₂ n) |
|---|---:|---:|---:|---:|---:|---:|
";
    for g in grown {
        let n = g.triangles as f64;
        let _ = writeln!(
            text,
            "| {} | {} | {} | {} | {:.3} | {} | {:.1} |",
            g.kind.replace('_', " "),
            g.triangles,
            g.pairs,
            g.remaining,
            g.run.cpu,
            memory(&g.run),
            1e9 * g.run.cpu / (n * n.log2())
        );
    }
}

fn threads(text: &mut String, searches: &[Search]) {
    *text += "
## Search for intersecting pairs

Wall seconds, the least of two times three runs taken in turns.

| mesh | triangles | 1 thread | 2 threads | times faster |
|---|---:|---:|---:|---:|
";
    for s in searches {
        let [one, two] = s.seconds;
        let _ = writeln!(
            text,
            "| {} | {} | {one:.3} | {two:.3} | {:.2} |",
            s.kind.replace('_', " "),
            s.triangles,
            one / two
        );
    }
}
