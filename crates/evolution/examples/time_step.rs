//! Times steps of the evolution, and the parts of a step: `cargo run --release -p pellicle-evolution --example time_step
//! -- [6 [20 [200]]]` for an icosahedron subdivided 6 times (40,962 vertices; 4: 2562, 5: 10,242), 20 steps, and a grid
//! of 200³. Threads: set `RAYON_NUM_THREADS`.
//!
//! Prints vertices, the seconds of the first step, the mean seconds of the later ones, and then a line for each part:
//! its mean seconds in the later steps. ψ is solved for within the redistribution; the rest of a step is its own line.

use glam::DVec3;
use pellicle_evolution::{
    DistanceGrid, DistanceOptions, Evolution, Redistribution, StepOptions, ellipsoid_around,
};
use std::cell::RefCell;
use std::f64::consts::PI;
use std::sync::Mutex;
use std::time::{Duration, Instant};
use tracing::span::{Attributes, Id, Record};
use tracing::{Event, Metadata, Subscriber};

/// Points on the ellipsoid that the surface evolves onto.
const POINTS: u32 = 20_000;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let number = |i: usize, default: u32| {
        arguments
            .get(i)
            .map_or(Ok(default), |text| text.parse::<u32>())
    };
    let (levels, steps, resolution) = (number(0, 6)?, number(1, 20)?, number(2, 200)?);

    // 1. A surface that starts at a distance from the points, and evolves as in figure 6 of Daniel 2015.
    let points = ellipsoid(POINTS);
    let mesh = ellipsoid_around(&points, 7.0, levels)?;
    let field = DistanceGrid::new(
        &points,
        &DistanceOptions {
            resolution,
            ..DistanceOptions::default()
        },
        &(),
    )?;
    // A step of length τ w_a moves the surface by less than an edge.
    let options = StepOptions {
        advection: 300.0 * field.spacing(),
        diffusion: 100.0 * field.spacing(),
        time_step: 0.001 / f64::from(1 << (2 * levels.saturating_sub(4))),
        redistribution: Redistribution::AreaUniform { omega: 100.0 },
        ..StepOptions::default()
    };

    // 2. The first step analyses the pattern of the systems; the others are timed together, and part by part.
    tracing::subscriber::set_global_default(Parts)?;
    let vertices = mesh.positions().len();
    let mut evolution = Evolution::new(mesh)?;
    let start = Instant::now();
    evolution.step(&field, &options)?;
    let first = start.elapsed().as_secs_f64();
    SUMS.lock().map_err(|error| error.to_string())?.clear();
    let start = Instant::now();
    for _ in 0..steps {
        evolution.step(&field, &options)?;
    }
    let mean = start.elapsed().as_secs_f64() / f64::from(steps);

    println!("{vertices} {first:.6} {mean:.6}");
    let sums = SUMS.lock().map_err(|error| error.to_string())?;
    let mut parts: Vec<(&str, f64)> = sums
        .iter()
        .map(|(name, sum)| (*name, sum.as_secs_f64() / f64::from(steps)))
        .collect();
    let solved = parts.iter().find(|part| part.0 == "solve for ψ");
    let solved = solved.map_or(0.0, |part| part.1);
    for part in &mut parts {
        if part.0 == "redistribute" {
            *part = ("v_T without ψ", part.1 - solved);
        }
    }
    let rest = mean - parts.iter().map(|part| part.1).sum::<f64>();
    parts.push(("the rest", rest));
    for (name, seconds) in parts {
        println!("{seconds:.6} {name}");
    }
    Ok(())
}

/// Points along a spiral over an ellipsoid with half axes 70, 50 and 40.
fn ellipsoid(n: u32) -> Vec<DVec3> {
    (0..n)
        .map(|i| {
            let z = 1.0 - (2.0 * f64::from(i) + 1.0) / f64::from(n);
            let angle = f64::from(i) * PI * (3.0 - 5.0_f64.sqrt());
            let r = (1.0 - z * z).sqrt();
            DVec3::new(70.0 * r * angle.cos(), 50.0 * r * angle.sin(), 40.0 * z)
        })
        .collect()
}

/// Adds up how long each span lasts, by its name.
struct Parts;

/// The names in the order of their first end, and their sums.
static SUMS: Mutex<Vec<(&'static str, Duration)>> = Mutex::new(Vec::new());

thread_local! {
    /// The spans that this thread is in.
    static OPEN: RefCell<Vec<Instant>> = const { RefCell::new(Vec::new()) };
}

/// The names of the spans, whose ids are their places here, from one.
static NAMES: Mutex<Vec<&'static str>> = Mutex::new(Vec::new());

impl Subscriber for Parts {
    fn enabled(&self, metadata: &Metadata<'_>) -> bool {
        metadata.is_span()
    }

    fn new_span(&self, span: &Attributes<'_>) -> Id {
        let name = span.metadata().name();
        let place = NAMES.lock().map_or(0, |mut names| {
            let place = names.iter().position(|known| *known == name);
            place.unwrap_or_else(|| {
                names.push(name);
                names.len() - 1
            })
        });
        Id::from_u64(place as u64 + 1)
    }

    fn record(&self, _span: &Id, _values: &Record<'_>) {}

    fn record_follows_from(&self, _span: &Id, _follows: &Id) {}

    fn event(&self, _event: &Event<'_>) {}

    fn enter(&self, _span: &Id) {
        OPEN.with_borrow_mut(|open| open.push(Instant::now()));
    }

    fn exit(&self, span: &Id) {
        let Some(start) = OPEN.with_borrow_mut(Vec::pop) else {
            return;
        };
        let (Ok(names), Ok(mut sums)) = (NAMES.lock(), SUMS.lock()) else {
            return;
        };
        let Some(&name) = names.get(span.into_u64() as usize - 1) else {
            return;
        };
        match sums.iter_mut().find(|(known, _)| *known == name) {
            Some((_, sum)) => *sum += start.elapsed(),
            None => sums.push((name, start.elapsed())),
        }
    }
}
