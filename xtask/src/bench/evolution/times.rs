//! How long the paper's 130 steps, one step of a fine surface, and distance grids take, on one thread and on two.

use super::Programs;
use crate::bench::measured::{self, Measured, median};
use serde_json::Value;
use std::path::Path;

/// Runs of everything, taken in turns.
const ROUNDS: usize = 3;

/// The threads compared.
pub const THREADS: [&str; 2] = ["1", "2"];

/// What is timed: the word of it in the page, the program, its arguments.
const GRIDS: [(&str, [&str; 4]); 3] = [
    (
        "distance, 200³, dense, 20,000 points",
        ["20000", "200", "dense", "1"],
    ),
    (
        "distance, 300³, dense, 20,000 points",
        ["20000", "300", "dense", "1"],
    ),
    (
        "distance, effective 1000³, sparse, 100,000 points",
        ["100000", "1000", "sparse", "1"],
    ),
];

/// Medians for each number of threads.
pub struct Times {
    /// Seconds of the 130 steps, all told.
    pub all: [f64; 2],
    /// Of that, what comes before the first step.
    pub before: [f64; 2],
    /// Seconds of a step at 40,962 vertices.
    pub step: [f64; 2],
    /// Seconds of the first step.
    pub first_step: [f64; 2],
    /// The parts of a step, and their seconds.
    pub parts: Vec<(String, [f64; 2])>,
    /// The grids: seconds, and bytes at the peak of the whole program.
    pub grids: Vec<(&'static str, [f64; 2], Option<u64>)>,
}

/// A name, and its seconds in each round, for each number of threads.
type Series = Vec<(String, [Vec<f64>; 2])>;

pub fn run(programs: &Programs) -> Result<Times, String> {
    let mut series = Series::new();
    let mut peaks = [None; GRIDS.len()];
    for round in 1..=ROUNDS {
        for (place, threads) in THREADS.into_iter().enumerate() {
            let run = |program: &Path, words: &[&str]| {
                measured::run_in(&[("RAYON_NUM_THREADS", threads)], program, words)
            };
            let all = run(&programs.table, &["time", "body/noise/paper"])?;
            for (key, seconds) in numbers_of_evolution(&all)? {
                add(&mut series, place, key, seconds);
            }
            let step = run(&programs.step, &["6", "20", "200"])?;
            for (name, seconds) in numbers_of_step(&step)? {
                add(&mut series, place, &name, seconds);
            }
            for (grid, (name, words)) in GRIDS.iter().enumerate() {
                let build = run(&programs.distance, words)?;
                add(&mut series, place, name, seconds_of_grid(&build)?);
                peaks[grid] = peaks[grid].max(build.peak_bytes);
            }
        }
        eprintln!("times: round {round} of {ROUNDS}");
    }
    let of = |name: &str| {
        let found = series.iter().find(|(known, _)| known == name);
        found.map_or([f64::NAN; 2], |(_, seconds)| {
            [median(&seconds[0]), median(&seconds[1])]
        })
    };
    let parts = series.iter().filter_map(|(name, _)| {
        let part = name.strip_prefix(PART)?;
        Some((part.to_owned(), of(name)))
    });
    Ok(Times {
        all: of("all"),
        before: of("before"),
        step: of("step"),
        first_step: of("first step"),
        parts: parts.collect(),
        grids: GRIDS
            .iter()
            .zip(peaks)
            .map(|((name, _), peak)| (*name, of(name), peak))
            .collect(),
    })
}

const PART: &str = "part: ";

fn add(series: &mut Series, place: usize, name: &str, seconds: f64) {
    match series.iter_mut().find(|(known, _)| known == name) {
        Some((_, all)) => all[place].push(seconds),
        None => {
            let mut all = [Vec::new(), Vec::new()];
            all[place].push(seconds);
            series.push((name.to_owned(), all));
        }
    }
}

/// What `evolution_table time` prints.
fn numbers_of_evolution(run: &Measured) -> Result<[(&'static str, f64); 2], String> {
    let values: Value = serde_json::from_str(run.output.trim())
        .map_err(|error| format!("{}: {error}", run.output))?;
    let number = |key: &str| values[key].as_f64().ok_or_else(|| format!("no {key}"));
    if values["steps"] != 130 || values["vertices"] != 2562 {
        return Err(format!("not 130 steps of 2562 vertices: {}", run.output));
    }
    Ok([("all", number("seconds")?), ("before", number("before")?)])
}

/// What `time_step` prints.
fn numbers_of_step(run: &Measured) -> Result<Vec<(String, f64)>, String> {
    let strange = || format!("not the times of a step: {}", run.output);
    let mut lines = run.output.lines();
    let head: Vec<f64> = lines
        .next()
        .ok_or_else(strange)?
        .split_whitespace()
        .filter_map(|word| word.parse().ok())
        .collect();
    let [40_962.0, first, mean] = head[..] else {
        return Err(strange());
    };
    let mut numbers = vec![("first step".to_owned(), first), ("step".to_owned(), mean)];
    for line in lines {
        let (seconds, part) = line.split_once(' ').ok_or_else(strange)?;
        let seconds = seconds.parse().map_err(|_| strange())?;
        numbers.push((format!("{PART}{part}"), seconds));
    }
    Ok(numbers)
}

/// What `time_distance` prints of a single run.
fn seconds_of_grid(run: &Measured) -> Result<f64, String> {
    let line = run.output.lines().find(|line| line.starts_with("build"));
    let word = line.and_then(|line| line.split_whitespace().nth(1));
    word.and_then(|word| word.parse().ok())
        .ok_or_else(|| format!("no time of a grid: {}", run.output))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn printed(output: &str) -> Measured {
        Measured {
            seconds: 9.0,
            peak_bytes: None,
            output: output.to_owned(),
        }
    }

    #[test]
    fn what_the_programs_print_is_read() {
        let all = printed(r#"{"steps": 130, "vertices": 2562, "seconds": 1.5, "before": 0.5}"#);
        assert_eq!(
            numbers_of_evolution(&all).unwrap(),
            [("all", 1.5), ("before", 0.5)]
        );
        let fewer = printed(r#"{"steps": 129, "vertices": 2562, "seconds": 1.5, "before": 0.5}"#);
        assert!(numbers_of_evolution(&fewer).is_err());

        let step = printed("40962 0.2 0.1\n0.04 measure\n0.06 solve for ψ\n");
        let numbers = numbers_of_step(&step).unwrap();
        assert_eq!(numbers[1], ("step".to_owned(), 0.1));
        assert_eq!(numbers[3], ("part: solve for ψ".to_owned(), 0.06));
        assert!(numbers_of_step(&printed("2562 0.2 0.1\n")).is_err());

        assert_eq!(seconds_of_grid(&printed("build    1.250 s\n")), Ok(1.25));
        assert!(seconds_of_grid(&printed("")).is_err());
    }
}
