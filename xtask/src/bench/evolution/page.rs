//! `docs/benchmarks/evolution.md`.

use super::Row;
use super::goals::{Goal, percent};
use super::peers::{self, Peer};
use super::times::{THREADS, Times};
use std::fmt::Write as _;

/// The page. `loads`: how busy the machine was before and after the times were taken.
pub fn page(
    machine: &str,
    loads: &(Option<f64>, Option<f64>),
    goals: &[Goal],
    rows: &[Row],
    peers: &[Peer],
    times: &Times,
) -> String {
    let load = |load: Option<f64>| load.map_or("unknown".into(), |load| format!("{load:.1}"));
    let mut text = format!(
        "\
# Evolution onto points

Made by `cargo xtask bench --evolution` on {machine}.
Load of the machine (processes that want to run, mean over a minute) before and after the times were taken: {} and {}.
{BUSY}
Shapes and clouds are those of `pellicle-figures`, seed 1: 20,000 points; noise 1 % of the diagonal on every coordinate;
1 % gross outliers; a patch of radius 0.12 diagonals missing; density 30:1; vesicles of 600 points with 1 % outliers.

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
    ours(&mut text, rows);
    compared(&mut text, rows, peers);
    fine(&mut text, rows);
    scans(&mut text, rows);
    timed(&mut text, times);
    text
}

const BUSY: &str = "\
Above about 1, other work lengthened the seconds, and two threads had no two processors to themselves.
";

fn ours(text: &mut String, rows: &[Row]) {
    *text += "
## Default options

Grid of 200 voxels along the longest side, from coarse to fine with remeshing. One run, one thread. Distances in voxels:
mean from the truth to the mesh / mean back / Hausdorff. All are closed manifolds of one component and genus 0 without
self-intersections and folded triangles (a turn of more than 120° between neighbours), unless the last column says what
else.

";
    let usual = |row: &&Row| peers::is_compared(row);
    evolved(text, rows.iter().filter(usual));
    *text += "
## The paper's stages

Daniel 2015, figures 6 to 10: 2,562 vertices all the time, 100 steps onto the points (w_a = 300, w_d = 100, or 120
against outliers and a missing patch), 30 of mean curvature flow; σ of one voxel, and outliers are not left out. The
initial ellipsoid is ours; advection moves a surface by at most 30 voxels in 100 steps, and less near outliers: where the
volume is too large, it had farther to go.

";
    let paper = |row: &&Row| row.schedule == "paper" && row.cloud != "fine";
    evolved(text, rows.iter().filter(paper));
}

fn evolved<'a>(text: &mut String, rows: impl Iterator<Item = &'a Row>) {
    *text += "\
| cloud | vertices | steps | at rest | s | volume | distances, voxels | angles | |
|---|---:|---:|---|---:|---:|---|---|---|
";
    for row in rows {
        if let Some(error) = row.values["error"].as_str() {
            let _ = writeln!(
                text,
                "| {} {} | **{error}** | | | | | | | |",
                row.shape, row.cloud
            );
            continue;
        }
        let _ = writeln!(
            text,
            "| {} {} | {} | {} | {} | {:.1} | {} | {:.3} / {:.3} / {:.2} | {} | {} |",
            row.shape,
            row.cloud,
            row.values["vertices"],
            row.values["steps"],
            rests(row),
            row.number("seconds"),
            percent(row.number("volume_ratio")),
            row.voxels("truth_to_mesh"),
            row.voxels("mesh_to_truth"),
            row.voxels("hausdorff"),
            angles(row),
            defects(row),
        );
    }
}

/// What is not as it should be; nothing if all is well.
fn defects(row: &Row) -> String {
    let mut defects = Vec::new();
    if !row.is_sphere() {
        defects.push(format!("**{}**", topology(row)));
    }
    for (key, what) in [
        ("self_intersections", "self-intersections"),
        ("folded", "folded"),
    ] {
        if row.values[key] != 0 {
            defects.push(format!("**{} {what}**", row.values[key]));
        }
    }
    defects.join(", ")
}

fn compared(text: &mut String, rows: &[Row], peers: &[Peer]) {
    if peers.is_empty() {
        *text += "\n## Beside others\n\nNo other program was installed.\n";
        return;
    }
    let _ = write!(
        text,
        "
## Beside others

The same points, and the meshes measured by the same code: mean distance in percent of the diagonal (the mean of both
ways), volume, components/genus (in bold unless 1/0; *open* if no closed manifold), s. Pellicle and alpha wrapping on one
thread. Screened Poisson: Open3D, depth {}, one thread, normals estimated from 30 neighbours and oriented along a
minimum spanning tree, whose seconds count, nothing cropped. Alpha wrapping: CGAL's `alpha_wrap_3` of the points with α
of 1/{} and of 1/{} of the diagonal and an offset of 1/{}; where α finds a way between the points, it wraps them from
inside too, and the volume is that of a shell. Most volumes of a wrap are larger by the offset.

| cloud | Pellicle |",
        peers::DEPTH,
        peers::ALPHAS[0],
        peers::ALPHAS[1],
        peers::OFFSET
    );
    for peer in peers {
        let _ = write!(text, " {} |", peer.name);
    }
    *text += "\n|---|---|";
    *text += &"---|".repeat(peers.len());
    *text += "\n";
    for (place, row) in rows
        .iter()
        .filter(|row| peers::is_compared(row))
        .enumerate()
    {
        let ours = cell(row, row.number("seconds"));
        let _ = write!(text, "| {} {} | {ours} |", row.shape, row.cloud);
        for peer in peers {
            let made = peer.rows.get(place).and_then(Option::as_ref);
            let shown = made.map_or("failed".into(), |(row, seconds)| cell(row, *seconds));
            let _ = write!(text, " {shown} |");
        }
        *text += "\n";
    }
}

fn cell(row: &Row, seconds: f64) -> String {
    if !row.values["error"].is_null() {
        return "**none**".into();
    }
    let topology = if row.is_sphere() {
        topology(row)
    } else {
        format!("**{}**", topology(row))
    };
    let volume = match row.values["volume_ratio"].as_f64() {
        Some(ratio) => percent(ratio),
        None => "–".into(),
    };
    format!(
        "{:.3}, {volume}, {topology}, {seconds:.1}",
        row.distance_percent()
    )
}

/// Components and genus of a closed manifold.
fn topology(row: &Row) -> String {
    if row.holds("closed_manifold") {
        format!("{}/{}", row.values["components"], row.values["genus"])
    } else {
        "open".into()
    }
}

fn fine(text: &mut String, rows: &[Row]) {
    *text += "
## The bust on a grid of 300³

60,000 points. *paper*: figure 11 of Daniel 2015, from 162 to 40,962 vertices by four subdivisions in 245 steps, and
three of mean curvature flow. *adaptive*: from coarse to fine with remeshing, to edges that give about as many. Small and
large angles: less than 20°, more than 140°.

| stages | vertices | steps | s | volume | distances, voxels | angles | small, large | folded | greatest turn | self-intersections |
|---|---:|---:|---:|---:|---|---|---:|---:|---:|---:|
";
    for row in rows.iter().filter(|row| row.cloud == "fine") {
        let _ = writeln!(
            text,
            "| {} | {} | {} | {:.1} | {} | {:.3} / {:.3} / {:.2} | {} | {}, {} | {} | {:.0}° | {} |",
            row.schedule,
            row.values["vertices"],
            row.values["steps"],
            row.number("seconds"),
            percent(row.number("volume_ratio")),
            row.voxels("truth_to_mesh"),
            row.voxels("mesh_to_truth"),
            row.voxels("hausdorff"),
            angles(row),
            row.values["small_angles"],
            row.values["large_angles"],
            row.values["folded"],
            row.number("greatest_turn"),
            row.values["self_intersections"],
        );
    }
}

fn scans(text: &mut String, rows: &[Row]) {
    *text += "
## Scans

Default options. Distances from all points of the file, outliers included, to the surface.

| scan | points | left out | vertices | steps | at rest | s | closed manifold, components/genus | mean, greatest distance, voxels | angles | self-intersections |
|---|---:|---:|---:|---:|---|---:|---|---|---|---:|
";
    for row in rows.iter().filter(|row| row.cloud == "scan") {
        if let Some(error) = row.values["error"].as_str() {
            let _ = writeln!(text, "| {} | **{error}** | | | | | | | | | |", row.shape);
            continue;
        }
        let _ = writeln!(
            text,
            "| {} | {} | {} | {} | {} | {} | {:.1} | {} | {:.3}, {:.2} | {} | {} |",
            row.shape,
            row.values["points"],
            row.values["outliers"],
            row.values["vertices"],
            row.values["steps"],
            yes(row.holds("at_rest")),
            row.number("seconds"),
            topology(row),
            row.voxels("points_to_mesh"),
            row.voxels("farthest_point"),
            angles(row),
            row.values["self_intersections"],
        );
    }
}

fn timed(text: &mut String, times: &Times) {
    let [one, two] = THREADS;
    let _ = write!(
        text,
        "
## Times

Wall seconds, medians of runs taken in turns. The paper's 130 steps: noisy points of the body, 2,562 vertices, grid of
200³, from points to mesh, of which *before the first step* is the noise's estimate, the initial surface and the distance;
the paper has 7.38 s on a laptop of 2013 with 2.2 GHz. A step at 40,962 vertices: the mean of 20 with
area-uniform redistribution after a first one, which also analyses the systems' pattern.

| what | {one} thread | {two} threads | times faster | peak memory, MiB |
|---|---:|---:|---:|---:|
"
    );
    let mut line = |what: &str, seconds: [f64; 2], peak: Option<u64>| {
        let [one, two] = seconds;
        let peak = peak.map_or(String::new(), |bytes| (bytes >> 20).to_string());
        let _ = writeln!(
            text,
            "| {what} | {one:.3} | {two:.3} | {:.2} | {peak} |",
            one / two
        );
    };
    line("130 steps, all told", times.all, None);
    line("of them, before the first step", times.before, None);
    line("step at 40,962 vertices", times.step, None);
    for (part, seconds) in &times.parts {
        line(&format!("of it, {part}"), *seconds, None);
    }
    line("first step at 40,962 vertices", times.first_step, None);
    for (name, seconds, peak) in &times.grids {
        line(name, *seconds, *peak);
    }
}

fn angles(row: &Row) -> String {
    let (least, greatest) = (row.number("least_angle"), row.number("greatest_angle"));
    format!("{least:.0}° to {greatest:.0}°")
}

/// Whether a surface came to rest; the paper's stages have a number of steps instead.
fn rests(row: &Row) -> &'static str {
    if row.schedule == "paper" {
        "–"
    } else {
        yes(row.holds("at_rest"))
    }
}

fn yes(holds: bool) -> &'static str {
    if holds { "yes" } else { "**no**" }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(name: &str, more: &str) -> Row {
        let line = format!(
            r#"{{"vertices": 100, "steps": 20, "at_rest": false, "seconds": 1.26, "voxel": 0.5, "diagonal": 200.0,
                 "components": 1, "genus": 0, "volume_ratio": 0.98, "truth_to_mesh": 0.1, "mesh_to_truth": 0.3,
                 "hausdorff": 1.0, "least_angle": 30.2, "greatest_angle": 99.6, "folded": 0{more}}}"#
        );
        Row::read(name, &line).unwrap()
    }

    #[test]
    fn the_page_shows_defects_and_peers() {
        let rows = [
            row(
                "vase/noise/adaptive",
                r#", "closed_manifold": true, "self_intersections": 0"#,
            ),
            row(
                "vase/patch/adaptive",
                r#", "closed_manifold": true, "self_intersections": 3"#,
            ),
            Row::read("oni.pwn/scan/adaptive", r#"{"error": "collapsed"}"#).unwrap(),
        ];
        let open = row("vase/patch/adaptive", r#", "closed_manifold": false"#);
        let peers = [Peer {
            name: "other".into(),
            rows: vec![None, Some((open, 2.0))],
        }];
        let times = Times {
            all: [1.5, 1.0],
            before: [0.5, 0.3],
            step: [0.2, 0.1],
            first_step: [0.5, 0.4],
            parts: vec![("measure".into(), [0.02, 0.01])],
            grids: vec![("grid", [1.0, 0.5], Some(3 << 20))],
        };
        let goal = Goal {
            what: "volume".into(),
            wanted: "within 3 %",
            here: "5 %".into(),
            met: false,
        };
        let page = page(
            "a machine",
            &(Some(0.25), None),
            &[goal],
            &rows,
            &peers,
            &times,
        );
        for line in [
            "taken: 0.2 and unknown.",
            "| volume | within 3 % | 5 % | **no** |",
            "| vase noise | 100 | 20 | **no** | 1.3 | -2.0 % | 0.200 / 0.600 / 2.00 | 30° to 100° |  |",
            "| **3 self-intersections** |",
            "| vase noise | 0.100, -2.0 %, 1/0, 1.3 | failed |",
            "| vase patch | 0.100, -2.0 %, 1/0, 1.3 | 0.100, -2.0 %, **open**, 2.0 |",
            "| oni.pwn | **collapsed** |",
            "| of it, measure | 0.020 | 0.010 | 2.00 |  |",
            "| grid | 1.000 | 0.500 | 2.00 | 3 |",
        ] {
            assert!(page.contains(line), "{line}\n{page}");
        }
    }
}
