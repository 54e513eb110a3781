//! Times the distance grid of points on an ellipsoid:
//! `cargo run --release -p pellicle-evolution --example time_distance -- 20000 200 [dense|sparse] [repeats]`.
//!
//! Prints wall seconds of each run, the time of a sample, and the process's peak memory where the system tells it.

use pellicle_evolution::{DistanceGrid, DistanceOptions, Error, Storage};
use pellicle_geometry::DVec3;
use std::f64::consts::PI;
use std::hint::black_box;
use std::time::Instant;

/// Points along a spiral over an ellipsoid with half axes 7, 5 and 4.
fn ellipsoid(n: u32) -> Vec<DVec3> {
    (0..n)
        .map(|i| {
            let z = 1.0 - (2.0 * f64::from(i) + 1.0) / f64::from(n);
            let angle = f64::from(i) * PI * (3.0 - 5.0_f64.sqrt());
            let r = (1.0 - z * z).sqrt();
            DVec3::new(7.0 * r * angle.cos(), 5.0 * r * angle.sin(), 4.0 * z)
        })
        .collect()
}

fn main() -> Result<(), Error> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let number = |i: usize, default: u32| {
        arguments
            .get(i)
            .and_then(|text| text.parse().ok())
            .unwrap_or(default)
    };
    let points = ellipsoid(number(0, 20_000));
    let options = DistanceOptions {
        resolution: number(1, 200),
        storage: match arguments.get(2).map(String::as_str) {
            Some("dense") => Storage::Dense,
            Some("sparse") => Storage::Sparse,
            _ => Storage::Auto,
        },
        ..Default::default()
    };
    let mut last = None;
    for _ in 0..number(3, 3) {
        let start = Instant::now();
        let grid = DistanceGrid::new(&points, &options, &())?;
        println!("build {:8.3} s", start.elapsed().as_secs_f64());
        last = Some(grid);
    }
    let Some(grid) = last else { return Ok(()) };
    println!(
        "{} points, {} voxels of {:.4}, {} MiB of values",
        points.len(),
        grid.dims(),
        grid.spacing(),
        grid.memory() >> 20
    );
    let start = Instant::now();
    let mut sum = 0.0;
    for &point in points.iter().cycle().take(1_000_000) {
        sum += black_box(grid.sample(1.01 * point)).value;
    }
    println!(
        "sample {:.0} ns, mean value {:.4}",
        start.elapsed().as_secs_f64() * 1e3,
        sum * 1e-6
    );
    if let Ok(status) = std::fs::read_to_string("/proc/self/status") {
        for line in status.lines().filter(|line| line.starts_with("VmHWM")) {
            println!("{line}");
        }
    }
    Ok(())
}
