//! What was to be reached, and what was.

use super::programs::OURS;
use super::record::{Compared, Record};

/// The processor's time that ours may take, as parts of CGAL's.
const OF_CGAL: [(&str, f64); 7] = [
    ("uniform:100000", 0.5),
    ("uniform:1000000", 0.5),
    ("uniform:4000000", 0.5),
    ("sphere:1000000", 0.6),
    ("torus:1000000", 0.6),
    ("grid:1000000", 0.4),
    ("rounded:200000", 0.55),
];

/// How much faster two threads shall be than one.
const TWO_THREADS: f64 = 1.7;

/// Where that is asked for.
const THREADED: [&str; 4] = [
    "uniform:1000000",
    "sphere:1000000",
    "torus:1000000",
    "grid:1000000",
];

/// Bytes a tetrahedron at the peak: working storage and result.
const BYTES: f64 = 40.0;

/// What several threads may take beyond that, as a part of what one takes.
const MORE_WITH_THREADS: f64 = 1.1;

/// Ten million points against one: time by point, and bytes in all.
const LARGE: (&str, &str, f64, f64) = (
    "uniform:10000000",
    "uniform:1000000",
    1.25,
    4.0 * (1_u64 << 30) as f64,
);

/// A goal, and the figure beside it; none where it was not measured.
#[derive(Debug, PartialEq)]
pub struct Goal {
    pub what: String,
    pub wanted: String,
    pub here: Option<String>,
    pub met: bool,
}

impl Goal {
    fn at_most(what: String, limit: f64, digits: usize, here: Option<f64>) -> Self {
        Self {
            what,
            wanted: format!("at most {limit:.digits$}"),
            here: here.map(|here| format!("{here:.digits$}")),
            met: here.is_some_and(|here| here <= limit),
        }
    }
}

/// Every goal.
pub fn of(record: &Record) -> Vec<Goal> {
    let input = |name: &str| record.inputs.iter().find(|compared| compared.input == name);
    let mut goals = Vec::new();
    for (name, limit) in OF_CGAL {
        let ratio = input(name).and_then(|compared| ratio_to(compared, "CGAL"));
        let what = format!("{}: processor's time, as a part of CGAL's", shown(name));
        goals.push(Goal::at_most(
            what,
            limit,
            2,
            ratio.map(|[_, median]| median),
        ));
    }
    for name in THREADED {
        let here = input(name).and_then(|compared| speed_up(compared, OURS, 2));
        goals.push(Goal {
            what: format!("{}: two threads against one", shown(name)),
            wanted: format!("at least {TWO_THREADS:.2}"),
            here: here.map(|[_, median]| format!("{median:.2}")),
            met: here.is_some_and(|[_, median]| median >= TWO_THREADS),
        });
    }
    for compared in &record.inputs {
        let bytes = |threads| compared.runs_of(OURS, threads).and_then(|runs| runs.own());
        let name = shown(&compared.input);
        goals.push(Goal::at_most(
            format!("{name}: bytes a tetrahedron, the input not counted"),
            BYTES,
            1,
            bytes(1),
        ));
        if let (Some(one), Some(two)) = (bytes(1), bytes(2)) {
            goals.push(Goal::at_most(
                format!("{name}: memory of two threads, as a multiple of one's"),
                MORE_WITH_THREADS,
                2,
                Some(two / one),
            ));
        }
    }
    let (large, small, slower, bytes) = LARGE;
    let by_point = |name: &str| {
        let runs = input(name)?.runs_of(OURS, 1)?;
        Some(runs.cpu()[1] / runs.points as f64)
    };
    let slow_down = by_point(large).zip(by_point(small)).map(|(a, b)| a / b);
    let what = format!(
        "{}: time by point, as a multiple of that at a million",
        shown(large)
    );
    goals.push(Goal::at_most(what, slower, 2, slow_down));
    let peak = input(large).and_then(|compared| compared.runs_of(OURS, 1)?.peak);
    goals.push(Goal {
        what: format!("{}: peak, the whole process", shown(large)),
        wanted: format!("under {:.0} GiB", bytes / GIB),
        here: peak.map(|peak| format!("{:.2} GiB", peak as f64 / GIB)),
        met: peak.is_some_and(|peak| (peak as f64) < bytes),
    });
    goals
}

const GIB: f64 = (1_u64 << 30) as f64;

/// `uniform:1000000` as `uniform 1 M`.
pub fn shown(input: &str) -> String {
    let (kind, count) = input.split_once(':').unwrap_or((input, ""));
    let count = match count.parse::<u64>() {
        Ok(n) if n >= 1_000_000 && n % 100_000 == 0 => format!("{} M", n as f64 / 1e6),
        Ok(n) if n >= 1_000 && n % 1_000 == 0 => format!("{} k", n / 1_000),
        _ => count.to_owned(),
    };
    format!("{kind} {count}")
}

/// Our seconds of the processor over another's, one thread each: of the least, and of the medians.
pub fn ratio_to(compared: &Compared, other: &str) -> Option<[f64; 2]> {
    let (ours, theirs) = (compared.runs_of(OURS, 1)?, compared.runs_of(other, 1)?);
    let (ours, theirs) = (ours.cpu(), theirs.cpu());
    Some([ours[0] / theirs[0], ours[1] / theirs[1]])
}

/// A program's wall seconds with one thread over those with several: of the least, and of the medians.
pub fn speed_up(compared: &Compared, program: &str, threads: usize) -> Option<[f64; 2]> {
    let one = compared.runs_of(program, 1)?.wall();
    let several = compared.runs_of(program, threads)?.wall();
    Some([one[0] / several[0], one[1] / several[1]])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::delaunay::runs::Runs;

    /// Runs of a million points that took these seconds, of the processor and the wall, and these bytes.
    pub fn runs(program: &str, threads: usize, seconds: &[f64], own: u64) -> Runs {
        Runs {
            program: program.into(),
            threads,
            cpu: seconds.into(),
            wall: seconds.into(),
            points: 1_000_000,
            tetrahedra: 10,
            held: Some(500),
            peak: Some(500 + own),
            failed: None,
        }
    }

    fn goal(record: &Record, what: &str) -> (Option<String>, bool) {
        let goals = of(record);
        let goal = goals.iter().find(|goal| goal.what.starts_with(what));
        let goal = goal.unwrap_or_else(|| panic!("no goal {what}"));
        (goal.here.clone(), goal.met)
    }

    #[test]
    fn goals_are_met_or_not() {
        let mut record = Record::default();
        assert_eq!(goal(&record, "torus 1 M: processor"), (None, false));
        let mut compared = Compared::of("torus:1000000");
        compared.runs = vec![
            runs(OURS, 1, &[1.0, 1.2, 1.4], 400),
            runs(OURS, 2, &[0.5, 0.8, 0.9], 450),
            runs("CGAL", 1, &[2.0], 9000),
        ];
        record.put(compared);
        let told = |what: &str| goal(&record, what);
        assert_eq!(told("torus 1 M: processor"), (Some("0.60".into()), true));
        assert_eq!(told("torus 1 M: two"), (Some("1.50".into()), false));
        assert_eq!(told("torus 1 M: bytes"), (Some("40.0".into()), true));
        assert_eq!(told("torus 1 M: memory"), (Some("1.12".into()), false));
        let compared = &record.inputs[0];
        assert_eq!(ratio_to(compared, "CGAL"), Some([0.5, 0.6]));
        assert_eq!(speed_up(compared, OURS, 2), Some([2.0, 1.2 / 0.8]));
        assert_eq!(ratio_to(compared, "HXT"), None);
    }

    #[test]
    fn large_inputs_are_compared_by_point() {
        let mut record = Record::default();
        let mut small = Compared::of("uniform:1000000");
        small.runs = vec![runs(OURS, 1, &[1.0], 400)];
        let mut large = Compared::of("uniform:10000000");
        large.runs = vec![Runs {
            points: 10_000_000,
            ..runs(OURS, 1, &[13.0], 5 << 30)
        }];
        record.put(small);
        record.put(large);
        assert_eq!(
            goal(&record, "uniform 10 M: time"),
            (Some("1.30".into()), false)
        );
        assert_eq!(
            goal(&record, "uniform 10 M: peak"),
            (Some("5.00 GiB".into()), false)
        );
    }

    #[test]
    fn inputs_are_shown_short() {
        assert_eq!(shown("uniform:4000000"), "uniform 4 M");
        assert_eq!(shown("grid:27000"), "grid 27 k");
        assert_eq!(shown("grid:27"), "grid 27");
        assert_eq!(shown("file:scan.bin"), "file scan.bin");
    }
}
