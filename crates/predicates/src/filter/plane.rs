//! The static filter of the plane.

use super::{certain, in_range, incircle_bound, orient2d_bound, out_of_line};
use crate::{
    Sign, determinant, lifted,
    statistics::{Predicate, Stage, decided},
};
use glam::DVec2;

/// Static filters for points of the plane inside a known rectangle; as
/// [`StaticFilter`](crate::StaticFilter).
///
/// ```
/// use glam::DVec2;
/// use pellicle_predicates::{Sign, StaticFilter2};
///
/// let filter = StaticFilter2::from_bounds(DVec2::ZERO, DVec2::ONE);
/// assert_eq!(filter.orient2d(DVec2::ZERO, DVec2::X, DVec2::Y), Sign::Positive);
/// assert_eq!(filter.incircle(DVec2::ZERO, DVec2::X, DVec2::Y, DVec2::ONE), Sign::Zero);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct StaticFilter2 {
    min: DVec2,
    max: DVec2,
    orient2d: f64,
    incircle: f64,
}

impl StaticFilter2 {
    /// The filter for points inside the rectangle from `min` to `max`.
    pub fn from_bounds(min: DVec2, max: DVec2) -> Self {
        let extents = (max - min).to_array();
        let usable = |bound: f64| {
            if in_range(extents) {
                bound
            } else {
                f64::INFINITY
            }
        };
        Self {
            min,
            max,
            orient2d: usable(orient2d_bound(extents)),
            incircle: usable(incircle_bound(extents)),
        }
    }

    #[inline(always)]
    fn check(&self, points: &[DVec2]) {
        debug_assert!(
            points
                .iter()
                .all(|p| p.cmpge(self.min).all() && p.cmple(self.max).all()),
            "a point outside the filter's rectangle: {points:?}"
        );
    }

    /// [`orient2d`](crate::orient2d) by the static filter alone: `None` when undecided.
    #[inline(always)]
    pub fn orient2d_filtered(&self, a: DVec2, b: DVec2, c: DVec2) -> Option<Sign> {
        self.check(&[a, b, c]);
        let [a, b] = [(a - c).to_array(), (b - c).to_array()];
        certain(determinant::orient2d(&a, &b), self.orient2d)
    }

    /// [`incircle`](crate::incircle) by the static filter alone: `None` when undecided.
    #[inline(always)]
    pub fn incircle_filtered(&self, a: DVec2, b: DVec2, c: DVec2, d: DVec2) -> Option<Sign> {
        self.check(&[a, b, c, d]);
        let [a, b, c] = [(a - d).to_array(), (b - d).to_array(), (c - d).to_array()];
        certain(determinant::incircle(&a, &b, &c), self.incircle)
    }

    /// [`orient2d`](crate::orient2d) for points inside the rectangle.
    #[inline(always)]
    pub fn orient2d(&self, a: DVec2, b: DVec2, c: DVec2) -> Sign {
        match self.orient2d_filtered(a, b, c) {
            Some(sign) => {
                decided(Predicate::Orient2d, Stage::Static);
                sign
            }
            None => out_of_line::orient2d(a, b, c),
        }
    }

    /// [`incircle`](crate::incircle) for points inside the rectangle.
    #[inline(always)]
    pub fn incircle(&self, a: DVec2, b: DVec2, c: DVec2, d: DVec2) -> Sign {
        match self.incircle_filtered(a, b, c, d) {
            Some(sign) => {
                decided(Predicate::InCircle, Stage::Static);
                sign
            }
            None => out_of_line::incircle(a, b, c, d),
        }
    }

    /// [`lifted::incircle`] for points inside the rectangle.
    #[inline(always)]
    pub fn incircle_perturbed(&self, a: DVec2, b: DVec2, c: DVec2, d: DVec2) -> Sign {
        match self.incircle(a, b, c, d) {
            Sign::Zero => lifted::incircle_of_cocircular(a, b, c, d),
            sign => sign,
        }
    }
}
