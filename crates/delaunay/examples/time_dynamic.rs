//! Times single steps on a large structure: `time_dynamic uniform 1000000 [steps]`.
//!
//! Tetrahedralises a seeded input, or a file, then prints microseconds of the processor's
//! time a step: insertion with and without a hint, removal, location, nearest vertex. Each kind of step is done at
//! random places, `steps` times (100 000 unless told); what is inserted is removed again.

mod common;

use common::{Arguments, Outcome, random::SplitMix, timed};
use pellicle_delaunay::DynamicTetrahedralization;
use pellicle_geometry::{DVec3, VertexId};
use std::hint::black_box;

fn main() -> Outcome {
    let arguments = Arguments::of_process();
    let points = arguments.points()?;
    let count = points.len();
    let steps = arguments.word(2).map_or(Ok(100_000), str::parse)?;
    let mut random = SplitMix(12345 + count as u64);

    let (made, [taken, _]) = timed(|| DynamicTetrahedralization::of_points(&points));
    let mut dynamic = made?;
    println!("{count} points: {taken:.2} s at once");

    // New points beside vertices at random, at about a third of the distance to the next one.
    let anchors: Vec<VertexId> = (0..steps)
        .map(|_| VertexId::new(random.below(count.max(1))))
        .filter(|&vertex| dynamic.point(vertex).is_some())
        .collect();
    let beside: Vec<DVec3> = anchors
        .iter()
        .filter_map(|&vertex| {
            let point = dynamic.point(vertex)?;
            let neighbors = dynamic.neighbors(vertex).into_iter();
            let distances = neighbors.filter_map(|next| Some(dynamic.point(next)?.distance(point)));
            Some(point + random.direction() * (0.3 * distances.reduce(f64::min)?))
        })
        .collect();

    report("locate with a hint", beside.len(), || {
        for (&point, &anchor) in beside.iter().zip(&anchors) {
            black_box(dynamic.locate(point, Some(anchor)));
        }
    });
    report("locate without", beside.len(), || {
        for &point in &beside {
            black_box(dynamic.locate(point, None));
        }
    });
    report("nearest with a hint", beside.len(), || {
        for (&point, &anchor) in beside.iter().zip(&anchors) {
            black_box(dynamic.nearest_vertex(point, Some(anchor)));
        }
    });
    let mut inserted = Vec::with_capacity(beside.len());
    report("insert with a hint", beside.len(), || {
        for (&point, &anchor) in beside.iter().zip(&anchors) {
            inserted.push(dynamic.insert_near(point, anchor));
        }
    });
    let remove_all = |inserted: &mut Vec<_>, dynamic: &mut DynamicTetrahedralization| {
        report("remove", inserted.len(), || {
            for vertex in inserted.drain(..).flatten() {
                black_box(dynamic.remove(vertex).ok());
            }
        });
    };
    remove_all(&mut inserted, &mut dynamic);
    report("insert without", beside.len(), || {
        for &point in &beside {
            inserted.push(dynamic.insert(point));
        }
    });
    remove_all(&mut inserted, &mut dynamic);
    println!("{dynamic:?}");
    Ok(())
}

/// Prints what the steps took.
fn report(name: &str, steps: usize, work: impl FnOnce()) {
    let ((), [taken, _]) = timed(work);
    let each = taken / steps.max(1) as f64;
    println!("{name:>20}: {:6.2} µs", each * 1e6);
}
