//! Running a program and taking its time and memory.

use std::io::Read;
use std::path::Path;
use std::process::{Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};

/// What a run took.
pub struct Measured {
    /// Wall time from start to end, file to file.
    pub seconds: f64,
    /// The greatest resident size in bytes, where the system tells it; looked at every few milliseconds.
    pub peak_bytes: Option<u64>,
    /// What it wrote to standard output.
    pub output: String,
}

/// Runs a program to its end; its standard error is the reason if it fails.
pub fn run(program: &Path, arguments: &[&str]) -> Result<Measured, String> {
    run_in(&[], program, arguments)
}

/// [`run`] with these variables in the program's environment.
pub fn run_in(
    environment: &[(&str, &str)],
    program: &Path,
    arguments: &[&str],
) -> Result<Measured, String> {
    run_within(Duration::MAX, environment, program, arguments)
}

/// [`run_in`] for so long at most; then the program is ended, and that is the reason.
pub fn run_within(
    limit: Duration,
    environment: &[(&str, &str)],
    program: &Path,
    arguments: &[&str],
) -> Result<Measured, String> {
    let failed = |error: std::io::Error| format!("{}: {error}", program.display());
    let start = Instant::now();
    let mut child = Command::new(program)
        .args(arguments)
        .envs(environment.iter().copied())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .map_err(failed)?;
    let output = drain(child.stdout.take());
    let errors = drain(child.stderr.take());
    let mut peak_bytes = None;
    let status = loop {
        peak_bytes = resident_peak(child.id()).or(peak_bytes);
        match child.try_wait().map_err(failed)? {
            Some(status) => break status,
            None if start.elapsed() > limit => {
                // One that has just ended by itself cannot be ended, and need not.
                let _ = child.kill();
                child.wait().map_err(failed)?;
                return Err(format!("not done within {} s", limit.as_secs()));
            }
            None => thread::sleep(Duration::from_millis(2)),
        }
    };
    let seconds = start.elapsed().as_secs_f64();
    let output = output.join().unwrap_or_default();
    let errors = errors.join().unwrap_or_default();
    if status.success() {
        Ok(Measured {
            seconds,
            peak_bytes,
            output,
        })
    } else {
        Err(format!("{status}: {}", errors.trim()))
    }
}

fn drain(stream: Option<impl Read + Send + 'static>) -> thread::JoinHandle<String> {
    thread::spawn(move || {
        let mut bytes = Vec::new();
        if let Some(mut stream) = stream {
            // What was read before an error is all there is to show.
            let _ = stream.read_to_end(&mut bytes);
        }
        String::from_utf8_lossy(&bytes).into_owned()
    })
}

/// Linux's high-water mark of a process.
fn resident_peak(process: u32) -> Option<u64> {
    let status = std::fs::read_to_string(format!("/proc/{process}/status")).ok()?;
    peak_in(&status)
}

fn peak_in(status: &str) -> Option<u64> {
    let line = status.lines().find(|line| line.starts_with("VmHWM:"))?;
    let kibibytes: u64 = line.split_whitespace().nth(1)?.parse().ok()?;
    Some(kibibytes * 1024)
}

/// The least of some numbers; infinity for none.
pub fn minimum(values: &[f64]) -> f64 {
    values.iter().copied().fold(f64::INFINITY, f64::min)
}

/// The middle of some numbers; the mean of the two middle ones of an even count.
pub fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    match sorted.len() {
        0 => f64::NAN,
        n => (sorted[(n - 1) / 2] + sorted[n / 2]) / 2.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn medians() {
        assert_eq!(median(&[3.0, 1.0, 2.0]), 2.0);
        assert_eq!(minimum(&[3.0, 1.0, 2.0]), 1.0);
        assert_eq!(median(&[4.0, 1.0, 2.0, 3.0]), 2.5);
        assert!(median(&[]).is_nan());
    }

    #[test]
    fn the_high_water_mark_is_read() {
        assert_eq!(
            peak_in("Name:\tx\nVmHWM:\t    1234 kB\n"),
            Some(1234 * 1024)
        );
        assert_eq!(peak_in("Name:\tx\n"), None);
    }

    #[test]
    fn a_program_that_takes_too_long_is_ended() {
        let limit = Duration::from_millis(1);
        let run = run_within(limit, &[], Path::new("cargo"), &["metadata", "--no-deps"]);
        assert!(run.is_err_and(|reason| reason.starts_with("not done")));
    }

    #[test]
    fn a_failing_program_is_an_error() {
        assert!(run(Path::new("cargo"), &["no-such-command"]).is_err());
        assert!(
            run(Path::new("cargo"), &["--version"])
                .unwrap()
                .output
                .starts_with("cargo")
        );
    }
}
