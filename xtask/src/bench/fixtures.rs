//! `cargo xtask bench --table`: every fixture reconstructed by every method, and what came of it.

use super::measured;
use crate::{Outcome, read, tidy};
use serde_json::Value;
use std::fmt::Write as _;
use std::path::Path;

/// Smooth closed surfaces whose samples are denser than the surface comes close to itself: here theory promises a mesh
/// of the right topology.
///
/// Of those that are meshes, 96 to 100 % of the triangles are facets of the points' Delaunay tetrahedra. Of bull.off and
/// cheese.off only 87 % and 56 % are, so no subset of the tetrahedra's facets is that surface; the spheres of
/// two_spheres_gap.off come closer than their points are to each other.
const WELL_SAMPLED: [&str; 7] = [
    "kitten.xyz",
    "sphere926.pwn",
    "knot1.off",
    "knot2.off",
    "analytic/sphere.off",
    "analytic/torus.off",
    "analytic/nested_spheres.off",
];

/// The true topology of clouds that come without triangles.
const KNOWN: [(&str, Topology); 2] = [
    (
        "kitten.xyz",
        Topology {
            components: 1,
            genus: 1,
        },
    ),
    (
        "sphere926.pwn",
        Topology {
            components: 1,
            genus: 0,
        },
    ),
];

const METHODS: [&str; 2] = ["cocone", "tight-cocone"];

/// Components, and their genera summed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Topology {
    components: u64,
    genus: u64,
}

/// One reconstruction.
struct Row {
    file: String,
    method: &'static str,
    truth: Option<Topology>,
    result: Result<Made, String>,
    verdict: Verdict,
}

struct Made {
    seconds: f64,
    done: Value,
    info: Value,
}

/// What was promised, and whether it was kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Verdict {
    /// Nothing but a result was promised, and there is one.
    Done,
    /// Everything promised was kept.
    Pass,
    /// Something was not.
    Fail,
}

/// Runs all, writes the page, and fails if a promise was broken.
pub fn run(root: &Path) -> Outcome {
    let (program, scratch) = super::command_line(root)?;
    let mut rows = Vec::new();
    let listed = tidy::fixtures::listed(&read(&root.join("fixtures/README.md"))?);
    // Those of `repair/` are surfaces that cross themselves: their vertices sample no surface.
    for file in listed
        .into_iter()
        .filter(|file| !file.starts_with("repair/"))
    {
        let input = root.join("fixtures").join(&file);
        let truth = truth(&program, &input, &file)?;
        for method in METHODS {
            let output = scratch.join("reconstructed.ply");
            let result = make(&program, &input, &output, method);
            let verdict = judge(&file, method, truth, result.as_ref().ok());
            eprintln!("{file} {method}: {verdict:?}");
            rows.push(Row {
                file: file.clone(),
                method,
                truth,
                result,
                verdict,
            });
        }
    }
    super::write_page(root, "fixtures.md", &page(&rows))?;
    let broken = rows
        .iter()
        .filter(|row| row.verdict == Verdict::Fail)
        .count();
    if broken == 0 {
        Ok(())
    } else {
        Err(format!(
            "{broken} of {} reconstructions break a promise",
            rows.len()
        ))
    }
}

/// The topology of a fixture that is a closed manifold mesh itself, or that is known.
fn truth(program: &Path, input: &Path, file: &str) -> Result<Option<Topology>, String> {
    if let Some((_, topology)) = KNOWN.iter().find(|(known, _)| *known == file) {
        return Ok(Some(*topology));
    }
    let run = measured::run(
        program,
        &["info", &input.to_string_lossy(), "--json", "--quiet"],
    )?;
    let info = parse(&run.output)?;
    Ok(Topology::of_closed(&info))
}

impl Topology {
    fn of_closed(info: &Value) -> Option<Self> {
        (info["closed"] == true).then_some(())?;
        Some(Self {
            components: info["components"].as_u64()?,
            genus: info["genus"].as_u64()?,
        })
    }
}

fn parse(text: &str) -> Result<Value, String> {
    serde_json::from_str(text).map_err(|error| format!("not JSON: {error}"))
}

fn make(program: &Path, input: &Path, output: &Path, method: &str) -> Result<Made, String> {
    let (input, output) = (input.to_string_lossy(), output.to_string_lossy());
    let arguments = [
        "reconstruct",
        &input,
        "-o",
        &output,
        "--method",
        method,
        "--force",
        "--json",
        "--quiet",
        "--threads",
        "1",
    ];
    let made = measured::run(program, &arguments)?;
    let info = measured::run(program, &["info", &output, "--json"])?;
    Ok(Made {
        seconds: made.seconds,
        done: parse(&made.output)?,
        info: parse(&info.output)?,
    })
}

/// Holds a result against its promises.
///
/// Every result is an oriented edge- and vertex-manifold without self-intersections; one of Tight Cocone is closed and
/// not empty; one of a well-sampled surface has the right topology with either method.
fn judge(file: &str, method: &str, truth: Option<Topology>, made: Option<&Made>) -> Verdict {
    let Some(made) = made else {
        return Verdict::Fail;
    };
    let (info, tight) = (&made.info, method == "tight-cocone");
    let promised = WELL_SAMPLED.contains(&file);
    if made.done["triangles"] == 0 {
        // Cocone may find no surface at all; a file without triangles is a cloud to `info`.
        return if tight || promised {
            Verdict::Fail
        } else {
            Verdict::Done
        };
    }
    let yes = |key: &str| info[key] == true;
    let manifold = yes("edge_manifold") && yes("vertex_manifold") && yes("oriented");
    let sound = manifold && info["self_intersections"] == 0;
    let closed = yes("closed") || !tight;
    let right = !promised || (truth.is_some() && Topology::of_closed(info) == truth);
    match (sound && closed && right, tight || promised) {
        (false, _) => Verdict::Fail,
        (true, true) => Verdict::Pass,
        (true, false) => Verdict::Done,
    }
}

fn page(rows: &[Row]) -> String {
    let mut text = format!(
        "\
# Every fixture, reconstructed

Made by `cargo xtask bench --table` on {}; one run each, one thread, wall time from file to file.

Promised: every result is an oriented edge- and vertex-manifold without self-intersections (counted exactly); Tight
Cocone's is closed and never empty; of the smooth, densely sampled closed surfaces (their truth is in bold) either
method's result has the true components and genus. *truth* is the topology of the file's own triangles where they are a
closed manifold; *done* means that there is a sound result, and nothing further was promised.

| file | method | points | dropped | triangles | components | genus | truth | borders | closed | edge-manifold | vertex-manifold | self-intersections | seconds | verdict |
|---|---|---:|---:|---:|---:|---:|---:|---:|---|---|---|---:|---:|---|
",
        super::machine()
    );
    for row in rows {
        let truth = row.truth.map_or("–".to_owned(), |truth| {
            let text = format!("{} in {}", truth.genus, truth.components);
            match WELL_SAMPLED.contains(&row.file.as_str()) {
                true => format!("**{text}**"),
                false => text,
            }
        });
        let verdict = match row.verdict {
            Verdict::Done => "done",
            Verdict::Pass => "pass",
            Verdict::Fail => "**fail**",
        };
        let cells = match &row.result {
            Err(reason) => format!("{} | | | | | {truth} | | | | | | |", one_line(reason)),
            Ok(made) => {
                let info = |key: &str| cell(&made.info[key]);
                [
                    cell(&made.done["points"]),
                    cell(&made.done["points_dropped"]),
                    cell(&made.done["triangles"]),
                    info("components"),
                    info("genus"),
                    truth,
                    info("borders"),
                    info("closed"),
                    info("edge_manifold"),
                    info("vertex_manifold"),
                    info("self_intersections"),
                    format!("{:.3}", made.seconds),
                ]
                .join(" | ")
            }
        };
        let _ = writeln!(
            text,
            "| {} | {} | {cells} | {verdict} |",
            row.file, row.method
        );
    }
    let count = |verdict: Verdict| rows.iter().filter(|row| row.verdict == verdict).count();
    let _ = writeln!(
        text,
        "\n{} reconstructions: {} pass, {} done, {} fail.",
        rows.len(),
        count(Verdict::Pass),
        count(Verdict::Done),
        count(Verdict::Fail)
    );
    text
}

fn cell(value: &Value) -> String {
    match value {
        Value::Bool(true) => "yes".into(),
        Value::Bool(false) => "no".into(),
        Value::Null => "–".into(),
        other => other.to_string(),
    }
}

fn one_line(text: &str) -> String {
    text.replace('|', "/")
        .split_whitespace()
        .collect::<Vec<_>>()
        .join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn made(closed: bool, genus: u64) -> Made {
        Made {
            seconds: 1.0,
            done: json!({"triangles": 12}),
            info: json!({
                "closed": closed, "edge_manifold": true, "vertex_manifold": true, "oriented": true,
                "self_intersections": 0, "components": 1, "genus": genus,
            }),
        }
    }

    #[test]
    fn promises_are_held_against_results() {
        let truth = Some(Topology {
            components: 1,
            genus: 1,
        });
        let judged = |file, method, made: &Made| judge(file, method, truth, Some(made));
        assert_eq!(
            judged("kitten.xyz", "cocone", &made(true, 1)),
            Verdict::Pass
        );
        assert_eq!(
            judged("kitten.xyz", "cocone", &made(true, 0)),
            Verdict::Fail
        );
        assert_eq!(
            judged("kitten.xyz", "cocone", &made(false, 1)),
            Verdict::Fail
        );
        assert_eq!(judged("b9.ply", "cocone", &made(false, 7)), Verdict::Done);
        assert_eq!(
            judged("b9.ply", "tight-cocone", &made(true, 7)),
            Verdict::Pass
        );
        assert_eq!(
            judged("b9.ply", "tight-cocone", &made(false, 7)),
            Verdict::Fail
        );
        assert_eq!(judge("b9.ply", "cocone", None, None), Verdict::Fail);
        assert_eq!(
            judge("kitten.xyz", "cocone", None, Some(&made(true, 1))),
            Verdict::Fail
        );
        for key in ["edge_manifold", "vertex_manifold", "oriented"] {
            let mut broken = made(true, 1);
            broken.info[key] = Value::Bool(false);
            assert_eq!(judged("b9.ply", "cocone", &broken), Verdict::Fail, "{key}");
        }
        let mut crossing = made(true, 1);
        crossing.info["self_intersections"] = Value::from(1);
        assert_eq!(judged("b9.ply", "cocone", &crossing), Verdict::Fail);
        let mut empty = made(true, 1);
        empty.done["triangles"] = Value::from(0);
        assert_eq!(judged("b9.ply", "tight-cocone", &empty), Verdict::Fail);
        assert_eq!(judged("b9.ply", "cocone", &empty), Verdict::Done);
    }
}
