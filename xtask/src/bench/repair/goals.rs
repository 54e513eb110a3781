//! What was to be reached, and what was.

use super::peers::Peer;
use super::{Grown, Row, Search};

/// A goal, and the figure beside it.
pub struct Goal {
    pub what: String,
    pub wanted: String,
    pub here: String,
    pub met: bool,
}

const MB: f64 = 1e6;

/// Mesh, the most seconds, the most bytes at the peak of the program.
const LIMITS: [(&str, f64, Option<f64>); 5] = [
    ("valley50k", 0.10, Some(30.0 * MB)),
    ("bunny25k_offset5", 0.30, None),
    ("two spheres", 0.50, None),
    ("torus_closed", 5.0, Some(500.0 * MB)),
    ("dumbbell_pinch", 5.0, Some(500.0 * MB)),
];

/// Every goal.
pub fn of(rows: &[Row], peers: &[Peer], grown: &[Grown], searches: &[Search]) -> Vec<Goal> {
    let mut goals = Vec::new();
    for row in rows {
        goals.extend(limits(row));
    }
    goals.push(sound(rows));
    goals.extend(rows.iter().filter_map(|row| ahead(row, peers)));
    goals.extend(growth(grown));
    goals.extend(searches.iter().map(threads));
    goals
}

fn limits(row: &Row) -> Vec<Goal> {
    let ours = &row.made[0];
    let Some((name, seconds, bytes)) = LIMITS.iter().find(|limit| limit.0 == row.name) else {
        return Vec::new();
    };
    let mut goals = vec![Goal {
        what: format!("{name}: time, one thread"),
        wanted: format!("at most {seconds:.2} s"),
        here: ours.shown(),
        met: ours.seconds() <= *seconds,
    }];
    if let Some(bytes) = bytes {
        let peak = ours.peak().map_or(f64::NAN, |run| run.peak as f64);
        goals.push(Goal {
            what: format!("{name}: memory of the program at its peak"),
            wanted: format!("at most {:.0} MB", bytes / MB),
            here: format!("{:.0} MB", peak / MB),
            met: peak <= *bytes,
        });
    }
    goals
}

fn sound(rows: &[Row]) -> Goal {
    let sound = rows.iter().filter(|row| row.made[0].is_sound()).count();
    Goal {
        what: "closed manifolds without intersecting pairs".into(),
        wanted: "all".into(),
        here: format!("{sound} of {}", rows.len()),
        met: sound == rows.len(),
    }
}

/// Ours against the fastest program whose mesh has the same volume.
fn ahead(row: &Row, peers: &[Peer]) -> Option<Goal> {
    let ours = row.made[0].seconds();
    let others = (1..peers.len()).filter(|&program| row.agrees(program));
    let best = others.min_by(|&a, &b| row.made[a].seconds().total_cmp(&row.made[b].seconds()))?;
    let times = row.made[best].seconds() / ours;
    Some(Goal {
        what: format!(
            "{}: ahead of every program that gets the right volume",
            row.name
        ),
        wanted: "more than 1 times".into(),
        here: format!("{times:.1} times ({})", peers[best].name),
        met: times > 1.0,
    })
}

/// How much the time grows between the last two sizes of a kind, which are about four times apart: n log n, and the
/// pairs, which are twice as many.
fn growth(grown: &[Grown]) -> Vec<Goal> {
    let kinds = grown.chunk_by(|a, b| a.kind == b.kind);
    kinds
        .filter_map(|sizes| {
            let [.., small, large] = sizes else {
                return None;
            };
            let size = large.triangles as f64 / small.triangles as f64;
            let log = (large.triangles as f64).ln() / (small.triangles as f64).ln();
            let times = large.run.cpu / small.run.cpu;
            let bound = 1.15 * size * log;
            Some(Goal {
                what: format!(
                    "{}: time from {} to {} triangles",
                    large.kind.replace('_', " "),
                    small.triangles,
                    large.triangles
                ),
                wanted: format!("at most {bound:.1} times: n log n and 15 %"),
                here: format!("{times:.1} times"),
                met: times <= bound && large.remaining == 0,
            })
        })
        .collect()
}

fn threads(search: &Search) -> Goal {
    let times = search.seconds[0] / search.seconds[1];
    Goal {
        what: format!(
            "search for pairs, {}, {} triangles: two threads against one",
            search.kind.replace('_', " "),
            search.triangles
        ),
        wanted: "at least 1.6 times".into(),
        here: format!("{times:.2}"),
        met: times >= 1.6,
    }
}

#[cfg(test)]
mod tests {
    use super::super::peers::Run;
    use super::super::{Made, Value};
    use super::*;

    fn made(cpu: f64, peak: u64, outcome: &str) -> Made {
        let outcome: Value = serde_json::from_str(outcome).unwrap();
        Made {
            runs: Ok(vec![Run { cpu, peak, held: 0 }]),
            outcome: Some(outcome),
        }
    }

    const SOUND: &str = r#"{"closed": true, "manifold": true, "intersecting": 0, "volume": 2.0}"#;

    fn row(name: &'static str, ours: Made) -> Row {
        Row {
            name,
            triangles: 1,
            pairs: 1,
            made: vec![ours],
        }
    }

    fn grown(triangles: u64, cpu: f64) -> Grown {
        Grown {
            kind: "valley",
            triangles,
            pairs: 1,
            run: Run {
                cpu,
                peak: 1,
                held: 0,
            },
            remaining: 0,
        }
    }

    fn search(two: f64) -> Search {
        Search {
            kind: "valley",
            triangles: 9,
            seconds: [1.6, two],
        }
    }

    fn missed(goals: &[Goal]) -> Vec<&str> {
        let missed = goals.iter().filter(|goal| !goal.met);
        missed.map(|goal| goal.what.as_str()).collect()
    }

    #[test]
    fn goals_at_their_limits_are_met() {
        let rows: Vec<Row> = LIMITS
            .iter()
            .map(|&(name, seconds, bytes)| {
                row(name, made(seconds, bytes.unwrap_or(9e9) as u64, SOUND))
            })
            .collect();
        let sizes = [grown(10_000, 1.0), grown(40_000, 4.6)];
        let goals = of(&rows, &[], &sizes, &[search(1.0)]);
        assert_eq!(missed(&goals), [""; 0]);
        assert_eq!(goals.len(), 5 + 3 + 1 + 1 + 1);
    }

    #[test]
    fn every_goal_can_be_missed() {
        let crossing = SOUND.replace("\"intersecting\": 0", "\"intersecting\": 1");
        let rows: Vec<Row> = LIMITS
            .iter()
            .map(|&(name, seconds, bytes)| {
                row(
                    name,
                    made(
                        1.01 * seconds,
                        2 * bytes.unwrap_or(0.0) as u64 + 1,
                        &crossing,
                    ),
                )
            })
            .collect();
        let sizes = [grown(10_000, 1.0), grown(40_000, 6.0)];
        let goals = of(&rows, &[], &sizes, &[search(1.01)]);
        assert_eq!(missed(&goals).len(), goals.len());
    }

    #[test]
    fn what_did_not_finish_meets_nothing() {
        let late = Made {
            runs: Err("not done".into()),
            outcome: None,
        };
        let goals = limits(&row("torus_closed", late));
        assert_eq!(missed(&goals).len(), 2);
    }
}
