//! Repairs meshes that cross themselves, and measures what comes out: one line of JSON a command. `cargo xtask bench
//! --repair` runs it beside other programs and writes `docs/benchmarks/repair.md`.
//!
//! `cargo run --release -p pellicle-figures --example repair_table -- COMMAND`, where a command is one of
//!
//! - `write KIND FREQUENCY FILE`: a surface of `pellicle_figures::crossing`: `two_spheres`, `valley` or `bumpy`;
//! - `repair FILE [RESULT]`: the seconds of repair alone, and its report;
//! - `pairs FILE`: the seconds of the search for intersecting pairs alone, the least of three;
//! - `measure FILE…`: of each mesh components, genus, volume, and the pairs that intersect.
//!
//! Threads: set `RAYON_NUM_THREADS`.

use pellicle::io::Overwrite;
use pellicle::mesh::{count_self_intersections, self_intersections, summarize};
use pellicle::prelude::*;
use pellicle::transformesh::{self, repair};
use pellicle_figures::crossing;
use std::time::Instant;

type Result<T> = std::result::Result<T, Box<dyn std::error::Error>>;

fn main() -> Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match words[..] {
        ["write", kind, frequency, file] => {
            let frequency = frequency.parse()?;
            let soup = match kind {
                "two_spheres" => crossing::two_spheres(frequency),
                "valley" => crossing::valley(frequency),
                "bumpy" => crossing::bumpy_offset(frequency, 0.05, 1),
                _ => return Err(format!("no surface is called {kind}").into()),
            };
            write(file, &soup)
        }
        ["repair", file] => repaired(file, None),
        ["repair", file, result] => repaired(file, Some(result)),
        ["pairs", file] => pairs(file),
        ["measure", ref files @ ..] => files.iter().try_for_each(|file| measure(file)),
        _ => {
            Err("write KIND FREQUENCY FILE, repair FILE [RESULT], pairs FILE, measure FILE…".into())
        }
    }
}

fn read(file: &str) -> Result<TriangleSoup> {
    Ok(read_mesh(file, &ReadOptions::default())?.soup)
}

fn write<'a>(file: &str, mesh: impl Into<MeshView<'a>>) -> Result<()> {
    let options = WriteOptions {
        overwrite: Overwrite::Replace,
        ..WriteOptions::default()
    };
    write_mesh(file, mesh.into(), None, &options)?;
    Ok(())
}

fn repaired(file: &str, result: Option<&str>) -> Result<()> {
    let soup = read(file)?;
    let held = resident();
    let (wall, cpu) = (Instant::now(), processor_seconds());
    let (mesh, report) = repair(&soup, &transformesh::Options::default())?;
    let cpu = processor_seconds() - cpu;
    let wall = wall.elapsed().as_secs_f64();
    println!(
        r#"{{"cpu": {cpu:.4}, "wall": {wall:.4}, "held": {held}, "triangles": {}, "pairs": {}, "repeats": {}, "remaining": {}}}"#,
        soup.triangles.len(),
        report.pairs,
        report.repeats,
        report.remaining,
    );
    match result {
        Some(result) => write(result, &mesh),
        None => Ok(()),
    }
}

fn pairs(file: &str) -> Result<()> {
    let soup = read(file)?;
    let (mut least, mut count) = (f64::INFINITY, 0);
    for _ in 0..3 {
        let start = Instant::now();
        count = self_intersections((&soup).into(), &())?.len();
        least = least.min(start.elapsed().as_secs_f64());
    }
    println!(
        r#"{{"wall": {least:.4}, "triangles": {}, "pairs": {count}}}"#,
        soup.triangles.len()
    );
    Ok(())
}

fn measure(file: &str) -> Result<()> {
    let soup = read(file)?;
    let view = MeshView::from(&soup);
    let summary = summarize(view)?;
    let manifold = summary.is_edge_manifold()
        && summary.is_vertex_manifold()
        && summary.is_oriented()
        && summary.duplicate_triangles == 0
        && summary.unusable_triangles == 0;
    println!(
        r#"{{"closed": {}, "manifold": {manifold}, "components": {}, "genus": {}, "volume": {}, "intersecting": {}}}"#,
        summary.is_closed() || summary.triangles == 0,
        summary.components.len(),
        json(summary.genus()),
        json(summary.volume),
        count_self_intersections(view, &())?,
    );
    Ok(())
}

fn json(value: Option<impl ToString>) -> String {
    value.map_or("null".into(), |value| value.to_string())
}

/// Seconds of all processors for this program so far; those of the clock where the system does not tell.
fn processor_seconds() -> f64 {
    #[cfg(unix)]
    {
        let spent = rustix::time::clock_gettime(rustix::time::ClockId::ProcessCPUTime);
        spent.tv_sec as f64 + 1e-9 * spent.tv_nsec as f64
    }
    #[cfg(not(unix))]
    {
        static START: std::sync::LazyLock<Instant> = std::sync::LazyLock::new(Instant::now);
        START.elapsed().as_secs_f64()
    }
}

/// The most KiB that the process has held; 0 where the system does not tell.
fn resident() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    let word = line.and_then(|line| line.split_whitespace().next());
    word.and_then(|word| word.parse().ok()).unwrap_or(0)
}
