//! Solids as functions of space: negative inside, positive outside, with the gradient.
//!
//! Only `+ − × ÷ √`, so that a solid is the same on every machine.

mod blend;
mod star;

pub(crate) use blend::{Blend, Part};
pub(crate) use star::{Bumps, Lobes, Star};

use pellicle::geometry::Aabb;
use pellicle::prelude::DVec3;

/// A solid whose surface is where the function vanishes.
pub(crate) trait Field: Send + Sync {
    /// A box that holds the solid with some room around it.
    fn bounds(&self) -> Aabb;

    /// The function and its gradient, which points outwards at the surface.
    fn at(&self, p: DVec3) -> (f64, DVec3);
}

/// How many Newton steps a projection may take; five do from within a cell of the surface.
const NEWTON_STEPS: usize = 40;

/// A point of the surface near `p`: Newton steps along the gradient, until they are rounding errors.
pub(crate) fn project(field: &dyn Field, p: DVec3) -> DVec3 {
    let rounding = 1e-14 * field.bounds().extent().max_element();
    let mut on = p;
    for _ in 0..NEWTON_STEPS {
        let (value, gradient) = field.at(on);
        let step = value / gradient.length_squared() * gradient;
        if !step.is_finite() {
            break;
        }
        on -= step;
        if step.length_squared() <= rounding * rounding {
            break;
        }
    }
    on
}

/// The box with `share` of its extent added on either side.
pub(crate) fn enlarged(bounds: Aabb, share: f64) -> Aabb {
    let margin = share * bounds.extent();
    Aabb {
        min: bounds.min - margin,
        max: bounds.max + margin,
    }
}

/// Σ (x/a)² = 1.
pub(crate) struct Ellipsoid {
    /// The semi-axes along x, y and z.
    pub(crate) semi_axes: DVec3,
}

impl Field for Ellipsoid {
    fn bounds(&self) -> Aabb {
        let bounds = Aabb {
            min: -self.semi_axes,
            max: self.semi_axes,
        };
        enlarged(bounds, 0.05)
    }

    fn at(&self, p: DVec3) -> (f64, DVec3) {
        let scaled = p / self.semi_axes;
        (scaled.length_squared() - 1.0, 2.0 * scaled / self.semi_axes)
    }
}

/// A body of revolution about y: x² + z² = (1 − u¹⁶) r(u)² with u = y/H, so that its ends are flat but for a rounded
/// rim, and smooth.
pub(crate) struct Revolution {
    /// H, half the height.
    pub(crate) half_height: f64,
    /// r(u) = c₀ + c₁u + c₂u² + c₃u³, positive on [−1.1, 1.1].
    pub(crate) profile: [f64; 4],
}

impl Revolution {
    /// r(u) and r′(u).
    fn radius(&self, u: f64) -> (f64, f64) {
        let [a, b, c, d] = self.profile;
        (
            a + u * (b + u * (c + u * d)),
            b + u * (2.0 * c + u * 3.0 * d),
        )
    }

    /// π H ∫ (1 − u¹⁶) r² du over [−1, 1], in closed form: with r² = Σ sₙ uⁿ, even powers alone remain, each
    /// 2/(n + 1) − 2/(n + 17).
    pub(crate) fn volume(&self) -> f64 {
        let mut square = [0.0; 7];
        for (i, a) in self.profile.iter().enumerate() {
            for (j, b) in self.profile.iter().enumerate() {
                square[i + j] += a * b;
            }
        }
        let integral: f64 = (0..7)
            .step_by(2)
            .map(|n| square[n] * (2.0 / (n + 1) as f64 - 2.0 / (n + 17) as f64))
            .sum();
        std::f64::consts::PI * self.half_height * integral
    }
}

impl Field for Revolution {
    fn bounds(&self) -> Aabb {
        let widest = (0..=200)
            .map(|i| self.radius(f64::from(i) / 100.0 - 1.0).0)
            .fold(0.0, f64::max);
        let corner = DVec3::new(widest, self.half_height, widest);
        let bounds = Aabb {
            min: -corner,
            max: corner,
        };
        enlarged(bounds, 0.03)
    }

    fn at(&self, p: DVec3) -> (f64, DVec3) {
        let u = p.y / self.half_height;
        let (r, slope) = self.radius(u);
        let squared = u * u;
        let fourth = squared * squared;
        let eighth = fourth * fourth;
        let end = 1.0 - eighth * eighth;
        let value = p.x * p.x + p.z * p.z - end * r * r;
        let along = 16.0 * eighth * fourth * squared * u * r * r - end * 2.0 * r * slope;
        let gradient = DVec3::new(2.0 * p.x, along / self.half_height, 2.0 * p.z);
        (value, gradient)
    }
}
