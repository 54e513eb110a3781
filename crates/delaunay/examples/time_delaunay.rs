//! Times the tetrahedralisation of a seeded input, or of a file: `time_delaunay uniform 1000000 --threads 2`.
//!
//! Prints processor seconds of all threads and wall seconds of the call alone, points, finite tetrahedra, and in bytes what
//! the process held before the call, the points among it, and the most that it ever held:
//! `cpu=2.610 wall=2.612 points=1000000 tetrahedra=6748359 held=25460736 peak=280510464`.
//!
//! * `--threads N`: in a pool of N threads; otherwise in the pool of all cores.
//! * `--weights FILE`: the weights, as little-endian doubles: reads those of `file`, writes those of `weighted`.
//! * `--points FILE`: writes the coordinates as little-endian doubles, for other programs, or as `file FILE`, to read.
//! * `--dump FILE`: writes the set of tetrahedra, four sorted `u32` ids each, sorted.
//! * `--identical N,…`: tetrahedralises with N threads too, and fails where anything is not the same, bit for bit.

mod common;

use common::{Arguments, Outcome, memory, timed, with_threads};
use pellicle_delaunay::{
    Error, FacetId, Options, RegularTetrahedralization, Tetrahedralization, tetrahedralize,
    tetrahedralize_weighted,
};
use pellicle_geometry::{DVec3, VertexId};
use std::{fs, path::Path};

fn main() -> Outcome {
    let arguments = Arguments::of_process();
    let points = arguments.points()?;
    if let Some(file) = arguments.option("--points") {
        common::write(Path::new(file), &points)?;
    }
    let weights = arguments.weights(&points)?;
    let weights = weights.as_deref();
    let threads = arguments.option("--threads").map(str::parse).transpose()?;
    let (result, line) = with_threads(threads, || measured(&points, weights))?;
    let made = result?;
    println!("{line}");
    if let Some(file) = arguments.option("--dump") {
        fs::write(file, sorted_set(made.arrays()))?;
    }
    for threads in arguments.numbers("--identical")? {
        let other = with_threads(Some(threads), || measured_call(&points, weights))??;
        if made.arrays() != other.arrays() {
            return Err(format!("another result with {threads} threads").into());
        }
        println!("identical with {threads} threads");
    }
    Ok(())
}

/// The result, and the line about it.
fn measured<'a>(
    points: &'a [DVec3],
    weights: Option<&'a [f64]>,
) -> (Result<Made<'a>, Error>, String) {
    let held = memory("VmRSS").unwrap_or(0);
    let (result, [cpu, wall]) = timed(|| measured_call(points, weights));
    let line = format!(
        "cpu={:.4} wall={:.4} points={} tetrahedra={} held={held} peak={}",
        cpu,
        wall,
        points.len(),
        result.as_ref().map_or(0, |made| made.arrays().finite),
        memory("VmHWM").unwrap_or(0),
    );
    (result, line)
}

/// A function of its own, so that a profiler may count what happens inside of it alone.
#[inline(never)]
fn measured_call<'a>(points: &'a [DVec3], weights: Option<&'a [f64]>) -> Result<Made<'a>, Error> {
    let options = Options::default();
    match weights {
        None => tetrahedralize(points, &options).map(Made::Delaunay),
        Some(weights) => tetrahedralize_weighted(points, weights, &options).map(Made::Regular),
    }
}

/// What is made of points, and of points with weights.
enum Made<'a> {
    Delaunay(Tetrahedralization<'a>),
    Regular(RegularTetrahedralization<'a>),
}

impl Made<'_> {
    fn arrays(&self) -> Arrays<'_> {
        match self {
            Self::Delaunay(made) => Arrays {
                tets: made.tets(),
                twins: made.twins(),
                finite: made.finite_count(),
                duplicates: made.duplicates(),
                hidden: &[],
            },
            Self::Regular(made) => Arrays {
                tets: made.tets(),
                twins: made.twins(),
                finite: made.finite_count(),
                duplicates: made.duplicates(),
                hidden: made.hidden(),
            },
        }
    }
}

/// All that must be the same for two results to be identical.
#[derive(PartialEq)]
struct Arrays<'a> {
    tets: &'a [[VertexId; 4]],
    twins: &'a [[FacetId; 4]],
    finite: usize,
    duplicates: &'a [(VertexId, VertexId)],
    hidden: &'a [VertexId],
}

fn sorted_set(arrays: Arrays) -> Vec<u8> {
    let mut tets: Vec<[u32; 4]> = arrays.tets[..arrays.finite]
        .iter()
        .map(|tet| {
            let mut corners = tet.map(|v| v.0);
            corners.sort_unstable();
            corners
        })
        .collect();
    tets.sort_unstable();
    tets.iter()
        .flatten()
        .flat_map(|corner| corner.to_le_bytes())
        .collect()
}
