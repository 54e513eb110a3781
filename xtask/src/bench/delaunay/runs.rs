//! What a program prints about a run, and the runs of one program on one input.

use crate::bench::measured::{median, minimum};
use serde_json::{Value, json};

/// What a program prints about one run: `cpu=2.61 wall=2.62 points=1000000 tetrahedra=6748359`, and the bytes `held=` before
/// and at the `peak=`, if it knows them.
#[derive(Clone, Debug, PartialEq)]
pub struct Run {
    /// Seconds that all threads of the process spent.
    pub cpu: f64,
    /// Seconds that went by.
    pub wall: f64,
    /// Points of the input, equal ones counted as they come.
    pub points: u64,
    /// Finite tetrahedra of the result.
    pub tetrahedra: u64,
    /// What the process held before the call, the input among it.
    pub held: Option<u64>,
    /// The most that the process held.
    pub peak: Option<u64>,
}

impl Run {
    /// Reads the first line with all the fields that must be there.
    pub fn read(output: &str) -> Result<Self, String> {
        let read = |line: &str| {
            let field = |name: &str| {
                line.split_whitespace().find_map(|word| {
                    let value = word.strip_prefix(name)?.strip_prefix('=')?;
                    value
                        .parse::<f64>()
                        .ok()
                        .filter(|v| v.is_finite() && *v >= 0.0)
                })
            };
            let bytes = |name: &str| field(name).filter(|&b| b > 0.0).map(|b| b as u64);
            Some(Self {
                cpu: field("cpu")?,
                wall: field("wall")?,
                points: field("points")? as u64,
                tetrahedra: field("tetrahedra")? as u64,
                held: bytes("held"),
                peak: bytes("peak"),
            })
        };
        output
            .lines()
            .find_map(read)
            .ok_or_else(|| format!("no line of cpu=, wall=, points=, tetrahedra=: {output}"))
    }
}

/// One program on one input.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Runs {
    /// The program's name, without the threads.
    pub program: String,
    pub threads: usize,
    pub cpu: Vec<f64>,
    pub wall: Vec<f64>,
    pub points: u64,
    pub tetrahedra: u64,
    /// The least that was held before.
    pub held: Option<u64>,
    /// The greatest peak.
    pub peak: Option<u64>,
    /// Why it was given up.
    pub failed: Option<String>,
}

impl Runs {
    /// Takes in a run; `watched` is the peak as seen from outside, for a program that does not tell.
    pub fn add(&mut self, run: &Run, watched: Option<u64>) {
        self.cpu.push(run.cpu);
        self.wall.push(run.wall);
        self.points = run.points;
        self.tetrahedra = run.tetrahedra;
        self.held = match (self.held, run.held) {
            (Some(one), Some(other)) => Some(one.min(other)),
            (one, other) => one.or(other),
        };
        self.peak = self.peak.max(run.peak.or(watched));
    }

    /// Whether there is anything to show.
    pub fn is_measured(&self) -> bool {
        self.failed.is_none() && !self.cpu.is_empty()
    }

    /// The least and the median of the processor's seconds.
    pub fn cpu(&self) -> [f64; 2] {
        [minimum(&self.cpu), median(&self.cpu)]
    }

    /// The least and the median of the wall's seconds.
    pub fn wall(&self) -> [f64; 2] {
        [minimum(&self.wall), median(&self.wall)]
    }

    /// The whole process at its peak, in bytes a tetrahedron.
    pub fn whole(&self) -> Option<f64> {
        Some(self.peak? as f64 / self.tetrahedra as f64)
    }

    /// The peak without what was held before the call: working storage and result.
    pub fn own(&self) -> Option<f64> {
        Some(self.peak?.checked_sub(self.held?)? as f64 / self.tetrahedra as f64)
    }

    pub fn to_json(&self) -> Value {
        json!({
            "program": self.program, "threads": self.threads,
            "cpu": self.cpu, "wall": self.wall,
            "points": self.points, "tetrahedra": self.tetrahedra,
            "held": self.held, "peak": self.peak, "failed": self.failed,
        })
    }

    pub fn of_json(value: &Value) -> Option<Self> {
        let seconds = |name: &str| -> Option<Vec<f64>> {
            value[name].as_array()?.iter().map(Value::as_f64).collect()
        };
        Some(Self {
            program: value["program"].as_str()?.to_owned(),
            threads: value["threads"].as_u64()? as usize,
            cpu: seconds("cpu")?,
            wall: seconds("wall")?,
            points: value["points"].as_u64()?,
            tetrahedra: value["tetrahedra"].as_u64()?,
            held: value["held"].as_u64(),
            peak: value["peak"].as_u64(),
            failed: value["failed"].as_str().map(str::to_owned),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LINE: &str = "cpu=0.25 wall=0.5 points=100 tetrahedra=70 held=1400 peak=7000";

    #[test]
    fn runs_are_read_from_what_programs_print() {
        let run = Run::read(&format!("warning\n{LINE}\nidentical with 2 threads\n")).unwrap();
        assert_eq!((run.cpu, run.wall), (0.25, 0.5));
        assert_eq!((run.points, run.tetrahedra), (100, 70));
        assert_eq!((run.held, run.peak), (Some(1400), Some(7000)));
        let bare = Run::read("cpu=1 wall=2 points=3 tetrahedra=4 held=0").unwrap();
        assert_eq!((bare.held, bare.peak), (None, None));
        for bad in [
            "done",
            "cpu=1 wall=2 points=3",
            "cpu=NaN wall=2 points=3 tetrahedra=4",
            "",
        ] {
            assert!(Run::read(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn memory_is_shown_whole_and_without_the_input() {
        let mut runs = Runs::default();
        assert!(!runs.is_measured());
        runs.add(&Run::read(LINE).unwrap(), Some(9000));
        assert_eq!((runs.whole(), runs.own()), (Some(100.0), Some(80.0)));
        // What the program says of itself counts; what is seen from outside only where it says nothing.
        runs.add(
            &Run::read("cpu=0.75 wall=1 points=100 tetrahedra=70").unwrap(),
            Some(8000),
        );
        assert_eq!(runs.peak, Some(8000));
        assert_eq!((runs.cpu(), runs.wall()), ([0.25, 0.5], [0.5, 0.75]));
        assert!(runs.is_measured());
    }

    #[test]
    fn what_is_kept_comes_back() {
        let mut runs = Runs {
            program: "CGAL".into(),
            threads: 1,
            ..Runs::default()
        };
        runs.add(&Run::read(LINE).unwrap(), None);
        assert_eq!(Runs::of_json(&runs.to_json()), Some(runs.clone()));
        runs.failed = Some("not done".into());
        assert_eq!(Runs::of_json(&runs.to_json()), Some(runs));
        assert_eq!(Runs::of_json(&json!({"program": "CGAL"})), None);
    }
}
