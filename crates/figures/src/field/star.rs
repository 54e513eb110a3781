//! Bodies whose radius is a function of the direction: |q| = R·h(q/|q|).

use super::{Field, enlarged};
use pellicle::geometry::Aabb;
use pellicle::prelude::DVec3;
use std::f64::consts::PI;

/// h(n), a function of a unit vector.
pub(crate) trait Radius: Send + Sync {
    /// h, and a gradient whose part along n does not matter.
    fn at(&self, n: DVec3) -> (f64, DVec3);
    /// The largest h, or a bound of it.
    fn largest(&self) -> f64;
    /// ∫ h³ over the unit sphere, in closed form.
    fn integral_of_cube(&self) -> f64;
}

/// The body q = (p − centre)/semi-axes, |q| = h(q/|q|).
pub(crate) struct Star<R> {
    /// The middle.
    pub(crate) center: DVec3,
    /// What q is scaled by along x, y and z.
    pub(crate) semi_axes: DVec3,
    /// h.
    pub(crate) radius: R,
}

impl<R: Radius> Star<R> {
    /// ∫ h³/3 over the unit sphere, times the product of the semi-axes.
    pub(crate) fn volume(&self) -> f64 {
        self.semi_axes.element_product() * self.radius.integral_of_cube() / 3.0
    }
}

impl<R: Radius> Field for Star<R> {
    fn bounds(&self) -> Aabb {
        let reach = self.radius.largest() * self.semi_axes;
        let bounds = Aabb {
            min: self.center - reach,
            max: self.center + reach,
        };
        enlarged(bounds, 0.03)
    }

    fn at(&self, p: DVec3) -> (f64, DVec3) {
        let q = (p - self.center) / self.semi_axes;
        let length = q.length();
        if length == 0.0 {
            return (-1.0, DVec3::ZERO);
        }
        let n = q / length;
        let (h, slope) = self.radius.at(n);
        // h(q/|q|) changes with the part of its gradient across n alone.
        let across = (slope - slope.dot(n) * n) / length;
        (length - h, (n - across) / self.semi_axes)
    }
}

/// h = 1 + ε·3√3·n_x n_y n_z: four lobes towards the corners of a tetrahedron, and hollows between them from ε = 0.2.
pub(crate) struct Lobes {
    /// ε, the height of a lobe.
    pub(crate) height: f64,
}

impl Lobes {
    fn factor(&self) -> f64 {
        self.height * 27.0_f64.sqrt()
    }
}

impl Radius for Lobes {
    fn at(&self, n: DVec3) -> (f64, DVec3) {
        let factor = self.factor();
        let gradient = factor * DVec3::new(n.y * n.z, n.z * n.x, n.x * n.y);
        (1.0 + factor * n.element_product(), gradient)
    }

    fn largest(&self) -> f64 {
        1.0 + self.height.abs()
    }

    /// The odd powers of n_x n_y n_z cancel, and the mean of its square is 1/105.
    fn integral_of_cube(&self) -> f64 {
        4.0 * PI * (1.0 + 3.0 * self.factor() * self.factor() / 105.0)
    }
}

/// h = 1 + Σ A s³ with s = (n·c − t)/(1 − t) where that is positive: a smooth bump about each direction c, none
/// reaching another.
pub(crate) struct Bumps {
    /// The directions c, of unit length.
    pub(crate) directions: Vec<DVec3>,
    /// A.
    pub(crate) height: f64,
    /// t, the cosine of the angle at which a bump ends.
    pub(crate) edge: f64,
}

impl Radius for Bumps {
    fn at(&self, n: DVec3) -> (f64, DVec3) {
        let (mut h, mut gradient) = (1.0, DVec3::ZERO);
        for &c in &self.directions {
            let s = (n.dot(c) - self.edge) / (1.0 - self.edge);
            if s > 0.0 {
                h += self.height * s * s * s;
                gradient += 3.0 * self.height * s * s / (1.0 - self.edge) * c;
            }
        }
        (h, gradient)
    }

    fn largest(&self) -> f64 {
        1.0 + self.height
    }

    /// ∫ (A s³)ᵏ over a cap is 2π(1 − t) Aᵏ/(3k + 1), and h³ = 1 + 3b + 3b² + b³.
    fn integral_of_cube(&self) -> f64 {
        let a = self.height;
        let cap = 3.0 * a / 4.0 + 3.0 * a * a / 7.0 + a * a * a / 10.0;
        4.0 * PI + self.directions.len() as f64 * 2.0 * PI * (1.0 - self.edge) * cap
    }
}
