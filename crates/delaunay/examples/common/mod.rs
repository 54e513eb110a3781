//! What the examples share: inputs, arguments, clocks.
#![allow(dead_code)] // each example uses a part

pub mod inputs;
pub mod random;

use pellicle_geometry::DVec3;
use std::{
    error::Error,
    fs,
    io::{self, Read},
    path::Path,
    time::{Duration, Instant},
};

/// What `main` returns.
pub type Outcome<T = ()> = Result<T, Box<dyn Error>>;

/// KIND COUNT, or `file` PATH, then options that each have a value.
pub struct Arguments(Vec<String>);

impl Arguments {
    /// Those of the process.
    pub fn of_process() -> Self {
        Self(std::env::args().skip(1).collect())
    }

    /// The argument at this place, from 0.
    pub fn word(&self, place: usize) -> Option<&str> {
        self.0.get(place).map(String::as_str)
    }

    /// The value behind an option's name.
    pub fn option(&self, name: &str) -> Option<&str> {
        let place = self.0.iter().position(|argument| argument == name)?;
        self.0.get(place + 1).map(String::as_str)
    }

    /// The numbers behind an option's name, with commas between.
    pub fn numbers(&self, name: &str) -> Outcome<Vec<usize>> {
        let Some(text) = self.option(name) else {
            return Ok(Vec::new());
        };
        Ok(text.split(',').map(str::parse).collect::<Result<_, _>>()?)
    }

    /// The points that the first two arguments name: a kind and a count, or `file` and a path of doubles.
    pub fn points(&self) -> Outcome<Vec<DVec3>> {
        match &self.0[..] {
            [kind, path, ..] if kind == "file" => Ok(read(Path::new(path))?),
            [kind, count, ..] => inputs::input(kind, count.parse()?)
                .ok_or_else(|| format!("kinds are {} and file", inputs::KINDS.join(", ")).into()),
            _ => Err("KIND COUNT, or file PATH, is wanted".into()),
        }
    }

    /// The weights of these points, if they have some: a file's are in the file of the option `--weights`, which those of a kind are
    /// written to.
    pub fn weights(&self, points: &[DVec3]) -> Outcome<Option<Vec<f64>>> {
        let path = self.option("--weights").map(Path::new);
        if self.word(0) == Some("file") {
            return Ok(path.map(read_weights).transpose()?);
        }
        let weights = self
            .word(0)
            .and_then(|kind| inputs::weights(kind, points.len()));
        if let Some((path, weights)) = path.zip(weights.as_deref()) {
            write_weights(path, weights)?;
        }
        Ok(weights)
    }
}

/// Points as little-endian doubles, three each.
pub fn read(path: &Path) -> io::Result<Vec<DVec3>> {
    read_doubles(path, DVec3::from_array)
}

/// Weights as little-endian doubles.
pub fn read_weights(path: &Path) -> io::Result<Vec<f64>> {
    read_doubles(path, |[weight]| weight)
}

fn read_doubles<const N: usize, T>(path: &Path, of: impl Fn([f64; N]) -> T) -> io::Result<Vec<T>> {
    // Little by little: a large block, once freed, would let the allocator keep what it frees later, and the peak of what is
    // measured would be another.
    let mut file = io::BufReader::new(fs::File::open(path)?);
    let count = file.get_ref().metadata()?.len() / (8 * N as u64);
    let mut all = Vec::with_capacity(count as usize);
    let mut row = [[0; 8]; N];
    for _ in 0..count {
        for eight in &mut row {
            file.read_exact(eight)?;
        }
        all.push(of(row.map(f64::from_le_bytes)));
    }
    Ok(all)
}

/// Writes points so that [`read`] reads them.
pub fn write(path: &Path, points: &[DVec3]) -> io::Result<()> {
    write_doubles(path, points.iter().flat_map(|p| p.to_array()))
}

/// Writes weights so that [`read_weights`] reads them.
pub fn write_weights(path: &Path, weights: &[f64]) -> io::Result<()> {
    write_doubles(path, weights.iter().copied())
}

fn write_doubles(path: &Path, doubles: impl Iterator<Item = f64>) -> io::Result<()> {
    let bytes: Vec<u8> = doubles.flat_map(f64::to_le_bytes).collect();
    fs::write(path, bytes)
}

/// What a task makes, and the seconds of the processor and of the clock that it takes; the clock's twice where the system does
/// not tell the processor's.
pub fn timed<T>(task: impl FnOnce() -> T) -> (T, [f64; 2]) {
    let (clock, before) = (Instant::now(), spent());
    let made = task();
    let wall = clock.elapsed();
    let cpu = spent().zip(before).map(|(after, before)| after - before);
    (
        made,
        [cpu.unwrap_or(wall), wall].map(|time| time.as_secs_f64()),
    )
}

/// Runs a task with so many threads at its disposal, or with all there are.
pub fn with_threads<T: Send>(
    threads: Option<usize>,
    task: impl FnOnce() -> T + Send,
) -> Outcome<T> {
    let Some(threads) = threads else {
        return Ok(task());
    };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
    Ok(pool.build()?.install(task))
}

/// The time that all threads of the process have spent; `None` where the system does not tell.
pub fn spent() -> Option<Duration> {
    #[cfg(unix)]
    {
        let spent = rustix::time::clock_gettime(rustix::time::ClockId::ProcessCPUTime);
        Some(Duration::new(
            spent.tv_sec.try_into().ok()?,
            spent.tv_nsec.try_into().ok()?,
        ))
    }
    #[cfg(not(unix))]
    None
}

/// A line of Linux's account of the process, in bytes: `VmRSS` is what it holds, `VmHWM` the most it held.
pub fn memory(line: &str) -> Option<u64> {
    let status = fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|text| text.strip_prefix(line))?;
    let kibibytes: u64 = line
        .trim_start_matches(':')
        .split_whitespace()
        .next()?
        .parse()
        .ok()?;
    Some(kibibytes * 1024)
}
