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

use super::{cells::four, conflict::Query, kernel::Kernel};
use crate::Error;
use pellicle_geometry::{DVec3, VertexId};
use pellicle_predicates::{
    Sign,
    lanes::{AtInfinity, FourVerdicts, Registers},
};

/// A point with a weight, in a kernel whose vertices have weights.
#[derive(Clone, Copy)]
pub(super) struct Weighted {
    position: DVec3,
    weight: f64,
}

impl Query for Weighted {
    const MAY_BE_HIDDEN: bool = true;

    #[inline(always)]
    fn of_vertex(kernel: &Kernel, vertex: VertexId) -> Self {
        Self {
            position: kernel.point(vertex),
            weight: kernel.weights[vertex.index()],
        }
    }

    #[inline(always)]
    fn position(self) -> DVec3 {
        self.position
    }

    #[inline(always)]
    fn is_inside(self, kernel: &Kernel, corners: [VertexId; 4]) -> bool {
        let [a, b, c, d] = corners.map(|v| kernel.point(v));
        let [wa, wb, wc, wd] = corners.map(|v| kernel.weights[v.index()]);
        let weights = [wa, wb, wc, wd, self.weight];
        let sign = kernel
            .filter
            .power_test_perturbed(a, b, c, d, self.position, weights);
        sign == Sign::Positive
    }

    #[inline(always)]
    fn is_inside_across<R: Registers>(
        self,
        registers: R,
        kernel: &Kernel,
        corners: [VertexId; 4],
        opposite: [VertexId; 4],
        at_infinity: AtInfinity,
    ) -> FourVerdicts {
        let weighted = |v: VertexId| (kernel.point(v), kernel.weights[v.index()]);
        let corners = four(|i| weighted(corners[i]));
        let opposite = four(|i| weighted(opposite[i]));
        let point = (self.position, self.weight);
        let filter = &kernel.filter;
        filter.power_test_across(registers, corners, opposite, point, at_infinity)
    }
}

impl Kernel {
    /// Gives the points, which came in this order, their weights.
    pub(super) fn set_weights(&mut self, weights: &[f64], order: &[u32]) {
        let of_points = order.iter().map(|&i| weights[i as usize]);
        let least = of_points.clone().fold(f64::INFINITY, f64::min);
        let greatest = of_points.clone().fold(f64::NEG_INFINITY, f64::max);
        self.filter = self.filter.with_weights(least, greatest);
        // The vertex at infinity has the first place.
        self.weights = std::iter::once(least).chain(of_points).collect();
    }
}

pub(super) fn check_weights(points: &[DVec3], weights: &[f64]) -> Result<(), Error> {
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

/// Of an order in which equal points are neighbours: the heaviest of each, the one with the lowest id where
/// several are; and (duplicate, representative) pairs for these others, sorted. What is lighter is in neither.
pub(super) fn heaviest(
    points: &[DVec3],
    weights: &[f64],
    order: Vec<u32>,
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
