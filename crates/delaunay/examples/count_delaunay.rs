//! Work for a profiler that counts: `valgrind --tool=callgrind --toggle-collect='*counted*' count_delaunay KIND COUNT WORK`.
//!
//! WORK is `tetrahedralize`, with their weights if the points have some, or in a tetrahedralisation of nine tenths of the points: `locate` the last tenth, `insert` it
//! point by point, or `remove` it again. It happens inside of functions whose names begin with `counted`, on one thread. No
//! clock is read, since counting tools stumble over how that is done. Prints how much there was to do.

mod common;

use common::{Arguments, Outcome, with_threads};
use pellicle_delaunay::{
    DynamicTetrahedralization, Error, Options, tetrahedralize, tetrahedralize_weighted,
};
use pellicle_geometry::{DVec3, VertexId};

fn main() -> Outcome {
    let arguments = Arguments::of_process();
    let points = arguments.points()?;
    let weights = arguments.weights(&points)?;
    let work = arguments.word(2).unwrap_or("tetrahedralize");
    let done = with_threads(Some(1), || run(work, &points, weights.as_deref()))??;
    println!(
        "{}",
        done.ok_or("WORK is tetrahedralize, locate, insert or remove")?
    );
    Ok(())
}

fn run(work: &str, points: &[DVec3], weights: Option<&[f64]>) -> Result<Option<usize>, Error> {
    if work == "tetrahedralize" {
        return counted_tetrahedralize(points, weights).map(Some);
    }
    let (most, last) = points.split_at(points.len() / 10 * 9);
    let mut there = DynamicTetrahedralization::of_points(most)?;
    match work {
        "locate" => Ok(Some(counted_locate(&there, last))),
        "insert" => counted_insert(&mut there, last).map(|vertices| Some(vertices.len())),
        "remove" => {
            let mut vertices = insert(&mut there, last)?;
            vertices.sort_unstable();
            vertices.dedup();
            counted_remove(&mut there, &vertices).map(Some)
        }
        _ => Ok(None),
    }
}

#[inline(never)]
fn counted_tetrahedralize(points: &[DVec3], weights: Option<&[f64]>) -> Result<usize, Error> {
    let options = Options::default();
    Ok(match weights {
        None => tetrahedralize(points, &options)?.finite_count(),
        Some(weights) => tetrahedralize_weighted(points, weights, &options)?.finite_count(),
    })
}

#[inline(never)]
fn counted_locate(there: &DynamicTetrahedralization, points: &[DVec3]) -> usize {
    let located = points.iter().filter_map(|&p| there.locate(p, None));
    located.count()
}

#[inline(never)]
fn counted_insert(
    there: &mut DynamicTetrahedralization,
    points: &[DVec3],
) -> Result<Vec<VertexId>, Error> {
    insert(there, points)
}

#[inline(never)]
fn counted_remove(
    there: &mut DynamicTetrahedralization,
    vertices: &[VertexId],
) -> Result<usize, Error> {
    for &vertex in vertices {
        there.remove(vertex)?;
    }
    Ok(vertices.len())
}

fn insert(there: &mut DynamicTetrahedralization, points: &[DVec3]) -> Result<Vec<VertexId>, Error> {
    points.iter().map(|&point| there.insert(point)).collect()
}
