//! What drives a surface: a distance and its gradient at every point of space.

use glam::DVec3;

/// The value of a field at a point, and its gradient.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// d, in the units of the coordinates.
    pub value: f64,
    /// ∇d, without unit.
    pub gradient: DVec3,
}

/// A function of space, with its gradient: the d of (3.2).
///
/// ```
/// use pellicle_evolution::{Field, Sample};
/// use pellicle_geometry::DVec3;
///
/// /// The distance to the unit sphere.
/// struct Sphere;
/// impl Field for Sphere {
///     fn sample(&self, at: DVec3) -> Sample {
///         let outside = at.length() - 1.0;
///         Sample { value: outside.abs(), gradient: outside.signum() * at.normalize_or_zero() }
///     }
/// }
/// assert_eq!(Sphere.sample(DVec3::X * 3.0).value, 2.0);
/// ```
pub trait Field: Sync {
    /// The value and gradient at a point.
    fn sample(&self, at: DVec3) -> Sample;
}

/// d = 1 everywhere: diffusion becomes mean curvature flow, and advection vanishes.
#[derive(Clone, Copy, Debug, Default)]
pub struct One;

impl Field for One {
    #[inline]
    fn sample(&self, _at: DVec3) -> Sample {
        Sample {
            value: 1.0,
            gradient: DVec3::ZERO,
        }
    }
}
