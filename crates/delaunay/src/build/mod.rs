//! Incremental construction: order, first tetrahedron, then for each point locate, dig, retriangulate.

mod blocks;
mod cavity;
mod cells;
mod conflict;
mod finish;
mod first;
mod kernel;
mod lattice;
mod locate;
mod parallel;
mod spreading;
mod steps;
mod weighted;
mod worker;

#[cfg(test)]
pub(crate) mod tests;

use crate::{Error, InsertionOrder, Options, Tetrahedralization};
pub(crate) use cells::MOST_VERTICES;
pub(crate) use first::collinear;
pub(crate) use kernel::INFINITE;
use kernel::Kernel;
pub(crate) use steps::Stepwise;

use pellicle_geometry::{Cancelled, DVec3, Progress, VertexId, first_not_finite};
use pellicle_spatial::brio;

/// See [`crate::tetrahedralize_with`], and with weights [`crate::tetrahedralize_weighted_with`]: the points that
/// are then neither vertices nor duplicates have no incident tetrahedron.
pub(crate) fn tetrahedralize<'a>(
    points: &'a [DVec3],
    weights: Option<&[f64]>,
    options: &Options,
    progress: &dyn Progress,
) -> Result<Tetrahedralization<'a>, Error> {
    check(points)?;
    if let Some(weights) = weights {
        weighted::check_weights(points, weights)?;
    }

    // 1. The order of insertion, with one representative of each set of equal points.
    let order = match options.order {
        InsertionOrder::Brio => brio::order(points),
        InsertionOrder::AsGiven => duplicates_aside(points),
    };
    let (mut order, duplicates) = match weights {
        None => representatives(points, order),
        Some(weights) => weighted::heaviest(points, weights, order),
    };

    // 2. Four points that span a tetrahedron come first.
    first::four_that_span(points, &mut order)?;
    let mut kernel = Kernel::of_first_tetrahedron(points, &order);
    if let Some(weights) = weights {
        kernel.set_weights(weights, &order);
    }

    // 3. The others, each into the conflict region that it digs.
    parallel::insert_all(&mut kernel, progress)?;
    let total = order.len() as u64;
    Cancelled::check(progress.step("tetrahedralize", total, total))?;

    // 4. Back to the caller's vertices.
    Ok(kernel.finish(points, &order, duplicates))
}

fn check(points: &[DVec3]) -> Result<(), Error> {
    if points.len() >= MOST_VERTICES {
        return Err(Error::TooMany {
            of: "points",
            limit: MOST_VERTICES - 1,
        });
    }
    match first_not_finite(points) {
        Some(vertex) => Err(Error::NotFinite { vertex }),
        None => Ok(()),
    }
}

/// The caller's order, but for equal points, which follow the first of them.
fn duplicates_aside(points: &[DVec3]) -> Vec<u32> {
    let mut first_of_equals: Vec<u32> = (0..points.len() as u32).collect();
    let mut sorted = first_of_equals.clone();
    let coordinates = |i: u32| {
        (points[i as usize] + DVec3::ZERO)
            .to_array()
            .map(f64::to_bits)
    };
    sorted.sort_unstable_by_key(|&i| (coordinates(i), i));
    for equal in sorted.chunk_by(|&i, &j| points[i as usize] == points[j as usize]) {
        for &i in equal {
            first_of_equals[i as usize] = equal[0];
        }
    }
    sorted.sort_unstable_by_key(|&i| (first_of_equals[i as usize], i));
    sorted
}

/// Splits an order in which equal points are neighbours into the first of each and
/// (duplicate, representative) pairs; the representative has the lowest id.
fn representatives(points: &[DVec3], mut order: Vec<u32>) -> (Vec<u32>, Vec<(VertexId, VertexId)>) {
    let mut duplicates = Vec::new();
    order.dedup_by(|&mut later, &mut kept| {
        let equal = points[later as usize] == points[kept as usize];
        if equal {
            duplicates.push((VertexId(later), VertexId(kept)));
        }
        equal
    });
    duplicates.sort_unstable();
    (order, duplicates)
}
