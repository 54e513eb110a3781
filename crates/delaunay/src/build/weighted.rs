//! The same construction for points with weights.
//!
//! A conflict is then a lift (p, |p|² − w) below the hyperplane of a tetrahedron's lifted corners. Two things are
//! new (Edelsbrunner and Shah 1996). A point whose lift lies above the tetrahedron that contains it is *hidden*:
//! it is skipped. And the conflict region of a point may hold whole stars: their vertices become hidden, since
//! none of the new tetrahedra has them. The lower hull of the lifts only sinks, so what is hidden remains so.
//!
//! The region's boundary is a sphere around the new point all the same. Where a point is coplanar with a facet,
//! the hyperplanes on both sides of it have the same height there: both are in conflict or neither is. So no flat
//! tetrahedron comes up, and the point may be the position of a vertex that it hides.

use super::{check, conflict::Query, duplicates_aside, first, kernel::Kernel};
use crate::{Error, InsertionOrder, Options, Tetrahedralization};
use pellicle_geometry::{Cancelled, DVec3, Progress, VertexId};
use pellicle_predicates::Sign;
use pellicle_spatial::brio;

/// A point with a weight, among vertices with weights.
#[derive(Clone, Copy)]
struct Weighted<'a> {
    position: DVec3,
    weight: f64,
    /// By vertex of the kernel.
    weights: &'a [f64],
}

impl Query for Weighted<'_> {
    #[inline(always)]
    fn position(self) -> DVec3 {
        self.position
    }

    #[inline(always)]
    fn is_inside(self, kernel: &Kernel, corners: [VertexId; 4]) -> bool {
        let [a, b, c, d] = corners.map(|v| kernel.point(v));
        let [wa, wb, wc, wd] = corners.map(|v| self.weights[v.index()]);
        let weights = [wa, wb, wc, wd, self.weight];
        let sign = kernel
            .filter
            .power_test_perturbed(a, b, c, d, self.position, weights);
        sign == Sign::Positive
    }
}

/// See [`crate::tetrahedralize_weighted_with`]. The points that are neither vertices nor duplicates have no
/// incident tetrahedron.
pub(crate) fn tetrahedralize_weighted<'a>(
    points: &'a [DVec3],
    weights: &[f64],
    options: &Options,
    progress: &dyn Progress,
) -> Result<Tetrahedralization<'a>, Error> {
    check(points)?;
    check_weights(points, weights)?;

    // 1. The order of insertion, with the heaviest of each set of equal points.
    let order = match options.order {
        InsertionOrder::Brio => brio::order(points),
        InsertionOrder::AsGiven => duplicates_aside(points),
    };
    let (mut order, duplicates) = heaviest(points, weights, &order);

    // 2. Four points that span a tetrahedron come first.
    first::four_that_span(points, &mut order)?;
    let mut kernel = Kernel::of_first_tetrahedron(points, &order);
    let weights = of_vertices(weights, &order);
    let least = weights.iter().copied().fold(f64::INFINITY, f64::min);
    let greatest = weights.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    kernel.filter = kernel.filter.with_weights(least, greatest);

    // 3. The others, one by one.
    let total = order.len() as u64;
    for vertex in 4..order.len() {
        if vertex % super::POINTS_PER_STEP == 0 {
            Cancelled::check(progress.step("tetrahedralize", vertex as u64, total))?;
        }
        kernel.insert_weighted(VertexId::new(vertex + 1), &weights)?;
    }
    Cancelled::check(progress.step("tetrahedralize", total, total))?;

    // 4. Back to the caller's vertices.
    Ok(kernel.finish(points, &order, duplicates))
}

impl Kernel {
    /// Inserts a vertex, or leaves it out if it is hidden.
    fn insert_weighted(&mut self, vertex: VertexId, weights: &[f64]) -> Result<(), Error> {
        let query = Weighted {
            position: self.point(vertex),
            weight: weights[vertex.index()],
            weights,
        };
        let start = self.locate(query.position);
        if self.is_in_conflict(start, query) {
            self.dig(start, query);
            self.retriangulate(vertex)?;
        }
        Ok(())
    }
}

fn check_weights(points: &[DVec3], weights: &[f64]) -> Result<(), Error> {
    if weights.len() != points.len() {
        return Err(Error::WeightCount {
            points: points.len(),
            weights: weights.len(),
        });
    }
    match weights.iter().position(|weight| !weight.is_finite()) {
        Some(vertex) => Err(Error::WeightNotFinite {
            vertex: VertexId::new(vertex),
        }),
        None => Ok(()),
    }
}

/// The weights by vertex of the kernel, which has the one at infinity first.
fn of_vertices(weights: &[f64], order: &[u32]) -> Vec<f64> {
    let of_points = order.iter().map(|&i| weights[i as usize]);
    std::iter::once(weights[order[0] as usize])
        .chain(of_points)
        .collect()
}

/// Of an order in which equal points are neighbours: the heaviest of each, the one with the lowest id where
/// several are; and (duplicate, representative) pairs for these others, sorted. What is lighter is in neither.
fn heaviest(
    points: &[DVec3],
    weights: &[f64],
    order: &[u32],
) -> (Vec<u32>, Vec<(VertexId, VertexId)>) {
    let mut kept = Vec::with_capacity(order.len());
    let mut duplicates = Vec::new();
    let weight = |i: u32| weights[i as usize];
    for equal in order.chunk_by(|&i, &j| points[i as usize] == points[j as usize]) {
        let heavier = |best: u32, i: u32| {
            let better = weight(i) > weight(best) || (weight(i) == weight(best) && i < best);
            if better { i } else { best }
        };
        let best = equal[1..].iter().copied().fold(equal[0], heavier);
        kept.push(best);
        let as_heavy = equal.iter().copied().filter(|&i| weight(i) == weight(best));
        duplicates.extend(
            as_heavy
                .filter(|&i| i != best)
                .map(|i| (VertexId(i), VertexId(best))),
        );
    }
    duplicates.sort_unstable();
    (kept, duplicates)
}
