//! Defects of measured clouds. Each function leaves its input as it is, so that they combine in any order.

use crate::{Random, Shape};
use pellicle::geometry::Aabb;
use pellicle::prelude::DVec3;

/// One stream a defect: the same seed for two of them does not correlate them.
const NOISE: u64 = 1;
const OUTLIERS: u64 = 2;
const UNEVEN: u64 = 3;

/// How much of its extent the box of the outliers is larger on each side.
const MARGIN: f64 = 0.1;

/// Every coordinate moved by a normal error, whose deviation is this share of the cloud's diagonal.
pub fn with_noise(points: &[DVec3], share: f64, seed: u64) -> Vec<DVec3> {
    let mut points = points.to_vec();
    let deviation = share * Aabb::of_points(&points).diagonal();
    displace(&mut points, deviation, &mut Random::new(seed, NOISE));
    points
}

/// More points behind the others, this share of them and rounded to a number, uniform in the cloud's box with 10 % of
/// its extent added on each side.
pub fn with_outliers(points: &[DVec3], share: f64, seed: u64) -> Vec<DVec3> {
    let count = (share * points.len() as f64).round() as usize;
    let region = Aabb::of_points(points);
    let mut random = Random::new(seed, OUTLIERS);
    let outliers = std::iter::repeat_with(|| around(region, &mut random)).take(count);
    points.iter().copied().chain(outliers).collect()
}

/// The points farther than `radius` from `center`.
pub fn without_patch(points: &[DVec3], center: DVec3, radius: f64) -> Vec<DVec3> {
    let kept = points.iter().filter(|p| p.distance(center) > radius);
    kept.copied().collect()
}

/// Points whose density falls along the longest side of the shape's box, from its upper end to `1/ratio` of that at
/// its lower end: as 1/(1 + (ratio − 1)t).
pub fn unevenly(shape: &Shape, count: usize, ratio: f64, seed: u64) -> Vec<DVec3> {
    let bounds = Aabb::of_points(shape.truth.positions());
    let extent = bounds.extent();
    let axis = extent.max_position();
    let mut random = Random::new(seed, UNEVEN);
    let sampler = shape.sampler();
    let mut points = Vec::with_capacity(count);
    while points.len() < count {
        let p = shape.project(sampler.point(&mut random));
        let below = (bounds.max[axis] - p[axis]) / extent[axis];
        if random.unit() * (1.0 + (ratio - 1.0) * below) < 1.0 {
            points.push(p);
        }
    }
    points
}

/// Moves every coordinate by a normal error of this deviation, in the units of the points.
pub fn displace(points: &mut [DVec3], deviation: f64, random: &mut Random) {
    for p in points {
        *p += deviation * random.vector(Random::normal);
    }
}

/// A point, uniform in a box with 10 % of its extent added on each side.
pub fn around(region: Aabb, random: &mut Random) -> DVec3 {
    let along = (1.0 + 2.0 * MARGIN) * random.vector(Random::unit) - MARGIN;
    region.min + (region.max - region.min) * along
}
