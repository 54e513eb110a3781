//! Coordinates brought near the origin and to size one, so that products neither cancel, overflow nor
//! vanish.

use pellicle_geometry::triangle::power_of_two_near;
use pellicle_geometry::{Aabb, DVec3};

/// The map p ↦ (p − center) / scale, with a power of two for a scale: only the subtraction rounds.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Frame {
    center: DVec3,
    pub(crate) scale: f64,
}

impl Frame {
    /// The frame of some points; those that are not finite are left out.
    pub(crate) fn of<'a>(points: impl IntoIterator<Item = &'a DVec3>) -> Self {
        let finite = points.into_iter().filter(|p| p.is_finite());
        let bounds = finite.fold(Aabb::EMPTY, |bounds, &p| bounds.with(p));
        if bounds.is_empty() {
            return Self {
                center: DVec3::ZERO,
                scale: 1.0,
            };
        }
        let half = 0.5 * bounds.max - 0.5 * bounds.min;
        Self {
            center: bounds.center(),
            scale: power_of_two_near(half.max_element()),
        }
    }

    #[inline]
    pub(crate) fn apply(self, p: DVec3) -> DVec3 {
        // Each half is finite, and halving is exact, where the difference might overflow.
        let half = p * 0.5 - self.center * 0.5;
        half / self.scale * 2.0
    }

    pub(crate) fn restore(self, p: DVec3) -> DVec3 {
        p * self.scale + self.center
    }
}

/// A sum with its rounding error carried along (Neumaier 1974).
#[derive(Clone, Copy, Default)]
pub(crate) struct Sum {
    sum: f64,
    error: f64,
}

impl Sum {
    #[inline]
    pub(crate) fn add(&mut self, x: f64) {
        let sum = self.sum + x;
        self.error += if self.sum.abs() >= x.abs() {
            (self.sum - sum) + x
        } else {
            (x - sum) + self.sum
        };
        self.sum = sum;
    }

    pub(crate) fn value(self) -> f64 {
        self.sum + self.error
    }
}
