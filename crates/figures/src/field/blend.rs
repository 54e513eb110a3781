//! Ellipsoids joined and cut with rounded creases.

use super::Field;
use pellicle::geometry::Aabb;
use pellicle::prelude::DVec3;

/// One ellipsoid of a [`Blend`].
pub(crate) struct Part {
    /// Its middle.
    pub(crate) center: DVec3,
    /// Its semi-axes along x, y and z.
    pub(crate) semi_axes: DVec3,
    /// How far the crease between it and the parts before it is rounded.
    pub(crate) rounding: f64,
    /// Added, or taken away.
    pub(crate) role: Role,
}

/// What a part does to those before it.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Role {
    /// Joined to them.
    Joined,
    /// Cut from them.
    Cut,
}

impl Part {
    /// A part that is joined.
    pub(crate) fn joined(center: [f64; 3], semi_axes: [f64; 3], rounding: f64) -> Self {
        Self {
            center: center.into(),
            semi_axes: semi_axes.into(),
            rounding,
            role: Role::Joined,
        }
    }

    /// A part that is cut away.
    pub(crate) fn cut(center: [f64; 3], semi_axes: [f64; 3], rounding: f64) -> Self {
        Self {
            role: Role::Cut,
            ..Self::joined(center, semi_axes, rounding)
        }
    }

    /// About the distance, to first order at the surface: (k² − k)/m with k = |q/a| and m = |q/a²|.
    fn at(&self, p: DVec3) -> (f64, DVec3) {
        let q = (p - self.center) / self.semi_axes;
        let steep = q / self.semi_axes;
        let (k, m) = (q.length(), steep.length());
        if m == 0.0 {
            return (-self.semi_axes.min_element(), DVec3::ZERO);
        }
        let slope_of_k = steep / k;
        let slope_of_m = steep / (self.semi_axes * self.semi_axes * m);
        let value = (k * k - k) / m;
        (
            value,
            ((2.0 * k - 1.0) * slope_of_k - value * slope_of_m) / m,
        )
    }
}

/// Parts joined and cut one after the other, above a floor.
pub(crate) struct Blend {
    /// In this order.
    pub(crate) parts: Vec<Part>,
    /// What lies below this y is cut away at last.
    pub(crate) floor: f64,
    /// How far the rim of the floor is rounded.
    pub(crate) rim: f64,
}

impl Field for Blend {
    fn bounds(&self) -> Aabb {
        let mut bounds = Aabb::EMPTY;
        for part in self.parts.iter().filter(|part| part.role == Role::Joined) {
            // A rounded union bulges by a sixth of its rounding at most.
            let reach = part.semi_axes + DVec3::splat(1.0 + part.rounding / 6.0);
            bounds = bounds.with(part.center - reach).with(part.center + reach);
        }
        bounds.min.y = bounds.min.y.max(self.floor - 1.0);
        bounds
    }

    fn at(&self, p: DVec3) -> (f64, DVec3) {
        let mut solid = (f64::INFINITY, DVec3::ZERO);
        for part in &self.parts {
            let next = part.at(p);
            solid = match part.role {
                Role::Joined if solid.0 == f64::INFINITY => next,
                Role::Joined => union(solid, next, part.rounding),
                Role::Cut => complement(union(complement(solid), next, part.rounding)),
            };
        }
        let below = (p.y - self.floor, DVec3::Y);
        complement(union(complement(solid), below, self.rim))
    }
}

fn complement((value, gradient): (f64, DVec3)) -> (f64, DVec3) {
    (-value, -gradient)
}

/// The smaller of two functions, less a cubic in their difference where that is below `rounding`: twice continuously
/// differentiable. The gradients enter with weights that add to one.
fn union(a: (f64, DVec3), b: (f64, DVec3), rounding: f64) -> (f64, DVec3) {
    let (small, large) = if a.0 < b.0 { (a, b) } else { (b, a) };
    let h = ((rounding - (large.0 - small.0)) / rounding).max(0.0);
    let weight = h * h / 2.0;
    (
        small.0 - rounding * h * h * h / 6.0,
        (1.0 - weight) * small.1 + weight * large.1,
    )
}
