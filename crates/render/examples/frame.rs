//! How long one frame of an animation takes: 1920 × 1080 pixels of a mesh of 100,352 triangles, in each style.
//!
//! `cargo run --release -p pellicle-render --example frame [FRAMES]`

use pellicle_geometry::{DVec3, VertexId};
use pellicle_mesh::TriangleSoup;
use pellicle_render::{Coloring, Drawing, Options, Shading, Style, Values, View, render};
use std::time::Instant;

/// Vertices around each way of the torus.
const SIDE: usize = 224;

/// A torus with waves on it, closed and counter-clockwise from outside, and the waves' height at each vertex.
fn torus() -> (TriangleSoup, Vec<f64>) {
    let turn = |i: usize| std::f64::consts::TAU * i as f64 / SIDE as f64;
    let heights: Vec<f64> = (0..SIDE * SIDE)
        .map(|v| 0.04 * (9.0 * turn(v / SIDE)).sin() * (7.0 * turn(v % SIDE)).cos())
        .collect();
    let position = |(v, height): (usize, &f64)| {
        let (across, around) = (turn(v / SIDE).sin_cos(), turn(v % SIDE).sin_cos());
        let radius = 0.4 + height;
        let ring = 1.0 + radius * around.1;
        DVec3::new(ring * across.1, radius * around.0, -ring * across.0)
    };
    let id = |i: usize, j: usize| VertexId::new(i % SIDE * SIDE + j % SIDE);
    let cells = (0..SIDE * SIDE).map(|cell| (cell / SIDE, cell % SIDE));
    let triangles = cells.flat_map(|(i, j)| {
        let [a, b, c, d] = [id(i, j), id(i + 1, j), id(i + 1, j + 1), id(i, j + 1)];
        [[a, b, c], [a, c, d]]
    });
    let soup = TriangleSoup {
        positions: heights.iter().enumerate().map(position).collect(),
        triangles: triangles.collect(),
    };
    (soup, heights)
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let frames: u32 = std::env::args().nth(1).map_or(Ok(5), |n| n.parse())?;
    let (soup, heights) = torus();
    let whole = Options {
        width: 1920,
        height: 1080,
        views: vec![View::ThreeQuarter],
        ..Options::default()
    };
    let plain = Drawing::mesh(&soup);
    let colored = Drawing {
        coloring: Coloring::Values(Values::new(&heights)),
        ..plain
    };
    let styled = |style| Options {
        style,
        ..whole.clone()
    };
    let smooth = Options {
        shading: Shading::Smooth,
        ..whole.clone()
    };
    let coarse = Options {
        samples: 2,
        ..whole.clone()
    };
    println!(
        "{} triangles, {} threads",
        soup.triangles.len(),
        rayon::current_num_threads()
    );
    for (name, drawing, options) in [
        ("surface", plain, &whole),
        ("surface, four samples a pixel", plain, &coarse),
        ("surface, smooth", plain, &smooth),
        ("values", colored, &whole),
        ("surface and edges", plain, &styled(Style::SurfaceAndEdges)),
        ("visible edges", plain, &styled(Style::VisibleEdges)),
        ("all edges", plain, &styled(Style::AllEdges)),
    ] {
        let start = Instant::now();
        for _ in 0..frames.max(1) {
            std::hint::black_box(render(&drawing, options)?);
        }
        let milliseconds = start.elapsed().as_secs_f64() * 1e3 / f64::from(frames.max(1));
        println!("{name:<32}{milliseconds:8.1} ms a frame");
    }
    Ok(())
}
