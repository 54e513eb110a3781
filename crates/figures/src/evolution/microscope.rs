//! A stand-in for the images of the paper's section 6: membranes around vesicles, as a laser microscope sees them.
//!
//! The light of a point: the wall of a vesicle, and outside of the vesicles the membranes between cells, which are the
//! Voronoi cells of jittered points of a lattice; both as wide as the microscope is blurred. Then the noise of counted light.

use super::plane::Raster;
use crate::{Error, Random, Shape};
use pellicle::glam::DVec2;
use pellicle::mesh::SignedDistance;
use pellicle::prelude::*;

/// Between cells.
const CELL: f64 = 15.0;
/// Half the width of a membrane in the image.
const BLUR: f64 = 1.5;

pub(crate) struct Embryo {
    walls: Vec<SignedDistance>,
    seed: u64,
}

impl Embryo {
    pub(crate) fn new(vesicles: &[Shape], seed: u64) -> Result<Self, Error> {
        let walls = vesicles.iter().map(|v| SignedDistance::new(&v.truth));
        Ok(Self {
            walls: walls.collect::<Result<_, _>>()?,
            seed,
        })
    }

    /// The image of a slice at a height, with so many pixels along x; 0 is dark and 1 as bright as a wall.
    pub(crate) fn slice(&self, min: DVec2, max: DVec2, height: f64, pixels: usize) -> Raster {
        let mut raster = Raster::of(min, max, pixels, |p| self.light(p.extend(height)));
        let mut random = Random::new(self.seed, height.to_bits());
        for value in &mut raster.values {
            // Of four hundred photons at full brightness.
            let noise = 0.05 * value.max(0.02).sqrt() * random.normal();
            // In 32 shades.
            *value = ((*value + noise).clamp(0.0, 1.0) * 32.0).round() / 32.0;
        }
        raster
    }

    /// What leaves a point, without noise.
    pub(crate) fn light(&self, p: DVec3) -> f64 {
        let distances = self.walls.iter().map(|wall| wall.sample(p).distance);
        let distance = distances.fold(f64::INFINITY, f64::min);
        let bell = |x: f64, width: f64| libm::exp(-x * x / (2.0 * width * width));
        let wall = bell(distance, BLUR);
        if distance < 0.0 {
            return 0.06 + 0.94 * wall;
        }
        let [first, second] = self.two_nearest_cells(p);
        // Half the difference is about the distance to the face between both cells.
        let membrane = 0.62 * bell(0.5 * (second - first), BLUR);
        // Cells farther from the vesicles are out of the stained tissue.
        let tissue = 0.35 + 0.65 * bell((distance - 12.0).max(0.0), 22.0);
        (0.10 + 0.9 * wall.max(membrane * tissue)).min(1.0)
    }

    /// The distances of the two nearest cells' middles.
    fn two_nearest_cells(&self, p: DVec3) -> [f64; 2] {
        let here = (p / CELL).floor();
        let mut nearest = [f64::INFINITY; 2];
        for i in 0..125_u32 {
            let step = DVec3::from([i % 5, i / 5 % 5, i / 25].map(|k| f64::from(k) - 2.0));
            let node = here + step;
            // Each node's jitter has a stream of its own.
            let key = node.to_array().map(|x| (x as i64 as u64) & 0xFFFF);
            let mut random = Random::new(self.seed, key[0] | key[1] << 16 | key[2] << 32);
            let middle = CELL * (node + random.vector(Random::unit));
            let distance = middle.distance(p);
            if distance < nearest[0] {
                nearest = [distance, nearest[0]];
            } else if distance < nearest[1] {
                nearest[1] = distance;
            }
        }
        nearest
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shapes;

    #[test]
    fn walls_are_bright_and_vesicles_dark() {
        let vesicles = shapes::vesicles();
        let embryo = Embryo::new(&vesicles, 1).unwrap();
        for vesicle in &vesicles {
            for &p in vesicle.truth.positions().iter().step_by(97) {
                assert!(embryo.light(p) > 0.99);
            }
            let middle = pellicle::geometry::Aabb::of_points(vesicle.truth.positions()).center();
            assert!(embryo.light(middle) < 0.07);
        }
    }

    #[test]
    fn a_slice_is_the_same_twice_and_noisy() {
        let embryo = Embryo::new(&shapes::vesicles(), 1).unwrap();
        let slice = |height| embryo.slice(DVec2::splat(-20.0), DVec2::splat(20.0), height, 20);
        let (one, other) = (slice(0.0), slice(0.0));
        assert_eq!(one.values, other.values);
        let light = |i: usize| embryo.light(one.node(i).extend(0.0));
        assert!((0..400).any(|i| (one.values[i] - light(i)).abs() > 0.01));
        assert_ne!(one.values, slice(1.0).values);
    }
}
