//! What was to be reached, and what was.

use super::times::Times;
use super::{Row, peers};

/// A goal, and the figure beside it.
pub struct Goal {
    pub what: String,
    pub wanted: &'static str,
    pub here: String,
    pub met: bool,
}

/// Every goal.
pub fn of(rows: &[Row], times: &Times) -> Vec<Goal> {
    let mut goals = clean(rows);
    goals.extend(defects(rows));
    goals.extend(fine(rows));
    goals.extend(scans(rows));
    goals.extend(seconds(times));
    goals
}

fn goal(what: impl Into<String>, wanted: &'static str, here: String, met: bool) -> Goal {
    Goal {
        what: what.into(),
        wanted,
        here,
        met,
    }
}

/// The ellipsoid and the vase from clean points, evolved by default.
fn clean(rows: &[Row]) -> Vec<Goal> {
    let mut goals = Vec::new();
    for row in rows.iter().filter(|row| {
        let shape = row.shape.as_str();
        row.cloud == "clean" && row.schedule == "adaptive" && ["ellipsoid", "vase"].contains(&shape)
    }) {
        let far = row.voxels("truth_to_mesh").max(row.voxels("mesh_to_truth"));
        let volume = row.number("volume_ratio");
        goals.push(goal(
            format!("{}, clean: mean distance", row.shape),
            "at most 0.25 voxel",
            format!("{far:.3}"),
            far <= 0.25,
        ));
        goals.push(goal(
            format!("{}, clean: volume", row.shape),
            "within 1 %",
            percent(volume),
            (volume - 1.0).abs() <= 0.01,
        ));
    }
    goals
}

/// Everything else with a truth on the usual grid.
fn defects(rows: &[Row]) -> [Goal; 2] {
    let harder: Vec<&Row> = rows
        .iter()
        .filter(|row| peers::is_compared(row) && row.cloud != "clean")
        .collect();
    let n = harder.len();
    let spheres = harder.iter().filter(|row| row.is_sphere()).count();
    let off = |row: &Row| (row.number("volume_ratio") - 1.0).abs();
    let missed: Vec<String> = harder
        .iter()
        // No volume is none within bounds.
        .filter(|row| !matches!(off(row).partial_cmp(&0.03), Some(order) if order.is_le()))
        .map(|row| {
            let volume = percent(row.number("volume_ratio"));
            format!("{} {}: {volume}", row.shape, row.cloud)
        })
        .collect();
    let mut within = format!("{} of {n}", n - missed.len());
    if !missed.is_empty() {
        within += &format!(" ({})", missed.join("; "));
    }
    [
        goal(
            "noise, outliers, missing patch, uneven, sparse: closed manifold, genus 0",
            "all",
            format!("{spheres} of {n}"),
            spheres == n,
        ),
        goal("the same: volume", "within 3 %", within, missed.is_empty()),
    ]
}

/// The bust on a grid of 300³.
fn fine(rows: &[Row]) -> Vec<Goal> {
    let fine = rows.iter().filter(|row| row.cloud == "fine");
    fine.flat_map(|row| {
        let what = format!(
            "bust, 300³, {}, {} vertices",
            row.schedule, row.values["vertices"]
        );
        let (folded, crossing) = (&row.values["folded"], &row.values["self_intersections"]);
        let (least, greatest) = (row.number("least_angle"), row.number("greatest_angle"));
        [
            goal(
                format!("{what}: folded triangles"),
                "0",
                folded.to_string(),
                *folded == 0,
            ),
            goal(
                format!("{what}: angles"),
                "20° to 140°",
                format!("{least:.1}° to {greatest:.1}°"),
                least >= 20.0 && greatest <= 140.0,
            ),
            goal(
                format!("{what}: self-intersections"),
                "0",
                crossing.to_string(),
                *crossing == 0,
            ),
        ]
    })
    .collect()
}

fn scans(rows: &[Row]) -> Option<Goal> {
    let scans: Vec<&Row> = rows.iter().filter(|row| row.cloud == "scan").collect();
    let closed = scans.iter().filter(|row| row.holds("closed_manifold"));
    let (closed, n) = (closed.count(), scans.len());
    let here = format!("{closed} of {n}");
    (n > 0).then(|| goal("scans: closed manifold", "all", here, closed == n))
}

fn seconds(times: &Times) -> Vec<Goal> {
    const GIB: f64 = (1_u64 << 30) as f64;
    let speedup = |[one, two]: [f64; 2]| one / two;
    let mut goals = vec![
        goal(
            "the paper's 130 steps, 2,562 vertices, 200³, all told, one thread",
            "at most 1.5 s",
            format!("{:.2} s", times.all[0]),
            times.all[0] <= 1.5,
        ),
        goal(
            "the same: two threads against one",
            "at least 1.5 times",
            format!("{:.2}", speedup(times.all)),
            speedup(times.all) >= 1.5,
        ),
        goal(
            "one step, 40,962 vertices, with redistribution, one thread",
            "at most 0.25 s",
            format!("{:.3} s", times.step[0]),
            times.step[0] <= 0.25,
        ),
        goal(
            "the same: two threads against one",
            "at least 1.5 times",
            format!("{:.2}", speedup(times.step)),
            speedup(times.step) >= 1.5,
        ),
    ];
    if let Some((name, _, Some(peak))) = times.grids.last() {
        let peak = *peak as f64 / GIB;
        goals.push(goal(
            format!("{name}: memory of the program at its peak"),
            "at most 2 GiB",
            format!("{peak:.2} GiB"),
            peak <= 2.0,
        ));
    }
    goals
}

/// A ratio as its difference from one.
pub fn percent(ratio: f64) -> String {
    format!("{:+.1} %", 100.0 * (ratio - 1.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(name: &str, volume: f64) -> Row {
        let line = format!(
            r#"{{"closed_manifold": true, "components": 1, "genus": 0, "voxel": 1.0, "folded": 0,
                 "truth_to_mesh": 0.2, "mesh_to_truth": 0.2, "self_intersections": 0, "vertices": 9,
                 "least_angle": 21.0, "greatest_angle": 139.0, "volume_ratio": {volume}}}"#
        );
        Row::read(name, &line).unwrap()
    }

    fn missed(goals: &[Goal]) -> Vec<&str> {
        let missed = goals.iter().filter(|goal| !goal.met);
        missed.map(|goal| goal.what.as_str()).collect()
    }

    fn times() -> Times {
        Times {
            all: [1.5, 1.0],
            before: [0.5, 0.3],
            step: [0.25, 0.125],
            first_step: [0.5, 0.4],
            parts: Vec::new(),
            grids: vec![("grid", [1.0, 0.6], Some(2 << 30))],
        }
    }

    #[test]
    fn goals_at_their_limits_are_met() {
        let rows = [
            row("vase/clean/adaptive", 0.9901),
            row("vase/noise/adaptive", 1.0299),
            row("bust/fine/paper", 1.5),
            row("kitten.xyz/scan/adaptive", 1.0),
        ];
        let goals = of(&rows, &times());
        assert_eq!(missed(&goals), [""; 0]);
        assert_eq!(goals.len(), 13);
    }

    #[test]
    fn every_goal_can_be_missed() {
        let mut far = row("vase/clean/adaptive", 0.98);
        far.values["mesh_to_truth"] = 0.26.into();
        let mut open = row("vase/noise/adaptive", 0.96);
        open.values["closed_manifold"] = false.into();
        let mut folded = row("bust/fine/paper", 1.0);
        for (key, value) in [
            ("folded", 1.0),
            ("least_angle", 19.0),
            ("self_intersections", 2.0),
        ] {
            folded.values[key] = value.into();
        }
        let mut scan = row("kitten.xyz/scan/adaptive", 1.0);
        scan.values["closed_manifold"] = false.into();
        let slow = Times {
            all: [1.6, 1.1],
            before: [0.5, 0.3],
            step: [0.26, 0.2],
            first_step: [0.5, 0.4],
            parts: Vec::new(),
            grids: vec![("grid", [1.0, 0.6], Some((2 << 30) + (1 << 20)))],
        };
        let goals = of(&[far, open, folded, scan], &slow);
        assert_eq!(missed(&goals).len(), goals.len());
    }

    #[test]
    fn a_missing_volume_misses() {
        let mut open = row("vase/noise/adaptive", 1.0);
        open.values["volume_ratio"] = serde_json::Value::Null;
        let goals = defects(&[open]);
        assert!(goals[0].met && !goals[1].met);
    }
}
