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

/// The distance to the surface at some distance from what a field is the distance to, from outside: zero nearer than
/// that, so that a surface stops short of the points.
///
/// What it is for: on a coarse mesh a thin limb of the object fits between the vertices, and a surface that goes as far as
/// the points loses it. Stopped half an edge short of them, it holds every limb like a glove.
///
/// ```
/// use pellicle_evolution::{Field, Sample, ShortOf};
/// use pellicle_geometry::DVec3;
///
/// struct Origin;
/// impl Field for Origin {
///     fn sample(&self, at: DVec3) -> Sample {
///         Sample { value: at.length(), gradient: at.normalize_or_zero() }
///     }
/// }
/// let short = ShortOf { field: &Origin, distance: 1.0 };
/// assert_eq!(short.sample(3.0 * DVec3::X), Sample { value: 2.0, gradient: DVec3::X });
/// assert_eq!(short.sample(0.9 * DVec3::X), Sample { value: 0.0, gradient: DVec3::ZERO });
/// ```
#[derive(Clone, Copy, Debug)]
pub struct ShortOf<F> {
    /// The field.
    pub field: F,
    /// How far short. The gradient fades to zero over the last half of it, so that the surface comes to rest.
    pub distance: f64,
}

impl<F: Field> Field for ShortOf<F> {
    fn sample(&self, at: DVec3) -> Sample {
        let sample = self.field.sample(at);
        let left = (sample.value - self.distance).max(0.0);
        let fading = (left / (0.5 * self.distance)).min(1.0);
        Sample {
            value: left,
            gradient: if left > 0.0 {
                fading * sample.gradient
            } else {
                DVec3::ZERO
            },
        }
    }
}

impl<F: Field + ?Sized> Field for &F {
    #[inline]
    fn sample(&self, at: DVec3) -> Sample {
        (**self).sample(at)
    }
}
