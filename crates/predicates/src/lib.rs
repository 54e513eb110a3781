//! Signs of geometric determinants, right for every finite `f64`, with ties broken by symbolic
//! perturbation.
//!
//! The data are points, [`DVec2`] and [`DVec3`]; the verbs are [`orient2d`], [`orient3d`], [`incircle`],
//! [`insphere`] and, for points with weights, [`power_test`], each of which returns a [`Sign`];
//! [`compare_distance`] says which of two points is nearer.
//!
//! ```
//! use glam::DVec3;
//! use pellicle_predicates::{Sign, insphere, lifted, orient3d};
//!
//! let [a, b, c, d] = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
//! assert_eq!(orient3d(a, b, c, d), Sign::Positive);
//! assert_eq!(insphere(a, b, c, d, DVec3::splat(0.5)), Sign::Positive);
//! // On the sphere: zero, unless a perturbation decides.
//! assert_eq!(insphere(a, b, c, d, DVec3::ONE), Sign::Zero);
//! assert_eq!(lifted::insphere(a, b, c, d, DVec3::ONE), Sign::Negative);
//! ```
//!
//! # Orientation
//!
//! `orient3d(a, b, c, d)` is the sign of det[b − a, c − a, d − a]: positive when `d` sees `a, b, c` turn
//! counter-clockwise, so that (origin, x, y, z) is positive:
//!
//! ```text
//!          d = z
//!          |
//!          |
//!          a = 0 ------ c = y
//!         /
//!        b = x
//! ```
//!
//! (The functions of Shewchuk 1997 have the other sign in space.)
//!
//! # Stages
//!
//! A call is decided by the first stage that can: a static filter when the points' box is known
//! ([`StaticFilter`], [`StaticFilter2`]), a semi-static filter from the coordinate differences, exact 128-bit
//! integers when the points lie on a coarse lattice, exact 384-bit integers when their magnitudes are
//! alike, interval arithmetic, exact integers of any width. All but the last answer only what they are sure
//! of, so the sign never depends on the stage. The feature `statistics` counts them ([`statistics`]); [`stages`] calls one
//! alone.
//!
//! Coordinates must be finite: for NaN and infinity the sign means nothing (there is no panic).
#![forbid(unsafe_code)]

use glam::{DVec2, DVec3};
use statistics::{Predicate, Stage, decided};

mod determinant;
mod distance;
mod exact;
mod filter;
mod fixed;
mod integer;
mod interval;
mod lattice;
mod polynomial;
mod sign;

pub mod implicit;
pub mod lanes;
pub mod lifted;
pub mod sos;
pub mod stages;
pub mod statistics;
pub mod world;

pub use distance::compare_distance;
pub use filter::{StaticFilter, StaticFilter2};
pub use sign::Sign;

#[cfg(test)]
mod tests;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

/// The sign of det[b − a, c − a]: positive when `a, b, c` turn counter-clockwise.
///
/// ```
/// use glam::DVec2;
/// use pellicle_predicates::{Sign, orient2d};
///
/// // Three points of a line with rounded coordinates: exactly where they are, not where they should be.
/// let [a, b, c] = [0.1, 0.2, 0.3].map(DVec2::splat);
/// assert_eq!(orient2d(a, b, c), Sign::Zero);
/// assert_eq!(orient2d(a, b, DVec2::new(0.3, 0.1 + 0.2)), Sign::Positive);
/// ```
#[inline]
pub fn orient2d(a: DVec2, b: DVec2, c: DVec2) -> Sign {
    match filter::orient2d(a, b, c) {
        Some(sign) => {
            decided(Predicate::Orient2d, Stage::SemiStatic);
            sign
        }
        None => unfiltered::orient2d(a, b, c),
    }
}

/// The sign of det[b − a, c − a, d − a]: positive for (origin, x, y, z).
///
/// ```
/// use glam::DVec3;
/// use pellicle_predicates::{Sign, orient3d};
///
/// let largest = f64::MAX;
/// let [a, b] = [DVec3::splat(-largest), DVec3::new(largest, -largest, -largest)];
/// let [c, d] = [DVec3::new(-largest, largest, -largest), DVec3::new(-largest, -largest, largest)];
/// assert_eq!(orient3d(a, b, c, d), Sign::Positive);
/// ```
#[inline]
pub fn orient3d(a: DVec3, b: DVec3, c: DVec3, d: DVec3) -> Sign {
    match filter::orient3d(a, b, c, d) {
        Some(sign) => {
            decided(Predicate::Orient3d, Stage::SemiStatic);
            sign
        }
        None => unfiltered::orient3d(a, b, c, d),
    }
}

/// Positive when `d` lies inside the circle through `a, b, c`, which turn counter-clockwise; the sign turns
/// with their orientation.
#[inline]
pub fn incircle(a: DVec2, b: DVec2, c: DVec2, d: DVec2) -> Sign {
    match filter::incircle(a, b, c, d) {
        Some(sign) => {
            decided(Predicate::InCircle, Stage::SemiStatic);
            sign
        }
        None => unfiltered::incircle(a, b, c, d),
    }
}

/// Positive when `e` lies inside the sphere through `a, b, c, d`, which are positively oriented; the sign
/// turns with their orientation.
#[inline]
pub fn insphere(a: DVec3, b: DVec3, c: DVec3, d: DVec3, e: DVec3) -> Sign {
    match filter::insphere(a, b, c, d, e) {
        Some(sign) => {
            decided(Predicate::InSphere, Stage::SemiStatic);
            sign
        }
        None => unfiltered::insphere(a, b, c, d, e),
    }
}

/// Positive when the lift (e, |e|² − w) of `e` lies below the hyperplane through the lifts of the positively
/// oriented `a, b, c, d`; the sign turns with their orientation.
///
/// The `weights` are those of the points in this order, in squares of the unit of length: of any sign, and
/// independent of the coordinates' magnitude. A point p with weight w has the power |x − p|² − w at x, and the
/// five lifts lie on one hyperplane when some x has the same power with respect to all (Aurenhammer 1987).
/// With equal weights this is [`insphere`], whatever they are.
///
/// ```
/// use glam::DVec3;
/// use pellicle_predicates::{Sign, power_test};
///
/// let [a, b, c, d] = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
/// let inside = |e, weights| power_test(a, b, c, d, e, weights);
/// assert_eq!(inside(DVec3::ONE, [7.0; 5]), Sign::Zero);
/// assert_eq!(inside(DVec3::ONE, [0.0, 0.0, 0.0, 0.0, 1e-300]), Sign::Positive);
/// assert_eq!(inside(DVec3::splat(0.5), [0.0, 0.0, 0.0, 0.0, -0.75]), Sign::Zero);
/// ```
#[inline]
pub fn power_test(a: DVec3, b: DVec3, c: DVec3, d: DVec3, e: DVec3, weights: [f64; 5]) -> Sign {
    match filter::power_test(a, b, c, d, e, weights) {
        Some(sign) => {
            decided(Predicate::PowerTest, Stage::SemiStatic);
            sign
        }
        None => unfiltered::power_test([a, b, c, d, e], weights),
    }
}

/// The stages after the filters.
mod unfiltered {
    use super::{
        DVec2, DVec3, Predicate, Sign, Stage, decided, determinant, exact, fixed, lattice,
    };
    use crate::{determinant::Ring, interval::Interval};

    fn intervals<const D: usize, const N: usize>(
        points: [[f64; D]; N],
        to: [f64; D],
    ) -> [[Interval; D]; N] {
        let to = to.map(Interval::exactly);
        points.map(|p| determinant::translated(&p.map(Interval::exactly), &to))
    }

    /// The answer of the first stage that has one.
    ///
    /// Integers of fixed width take a quarter of the time of intervals, so these come in only where the
    /// magnitudes are too mixed for the former.
    #[inline(always)]
    fn staged(
        predicate: Predicate,
        lattice: Option<Sign>,
        fixed: impl Fn() -> Option<Sign>,
        interval: impl Fn() -> Interval,
        exact: impl Fn() -> Sign,
    ) -> Sign {
        let (sign, stage) = if let Some(sign) = lattice {
            (sign, Stage::Lattice)
        } else if let Some(sign) = fixed() {
            (sign, Stage::FixedWidth)
        } else if let Some(sign) = interval().sign() {
            (sign, Stage::Interval)
        } else {
            (exact(), Stage::AnyWidth)
        };
        decided(predicate, stage);
        sign
    }

    #[cold]
    #[inline(never)]
    pub(super) fn orient2d(a: DVec2, b: DVec2, c: DVec2) -> Sign {
        staged(
            Predicate::Orient2d,
            lattice::orient2d(a, b, c),
            || fixed::orient2d(a, b, c),
            || interval_orient2d(a, b, c),
            || exact::orient2d(a, b, c),
        )
    }

    #[cold]
    #[inline(never)]
    pub(super) fn orient3d(a: DVec3, b: DVec3, c: DVec3, d: DVec3) -> Sign {
        staged(
            Predicate::Orient3d,
            lattice::orient3d(a, b, c, d),
            || fixed::orient3d(a, b, c, d),
            || interval_orient3d(a, b, c, d),
            || exact::orient3d(a, b, c, d),
        )
    }

    #[cold]
    #[inline(never)]
    pub(super) fn incircle(a: DVec2, b: DVec2, c: DVec2, d: DVec2) -> Sign {
        staged(
            Predicate::InCircle,
            lattice::incircle(a, b, c, d),
            || fixed::incircle(a, b, c, d),
            || interval_incircle(a, b, c, d),
            || exact::incircle(a, b, c, d),
        )
    }

    #[cold]
    #[inline(never)]
    pub(super) fn insphere(a: DVec3, b: DVec3, c: DVec3, d: DVec3, e: DVec3) -> Sign {
        staged(
            Predicate::InSphere,
            lattice::insphere(a, b, c, d, e),
            || fixed::insphere(a, b, c, d, e),
            || interval_insphere(a, b, c, d, e),
            || exact::insphere(a, b, c, d, e),
        )
    }

    #[cold]
    #[inline(never)]
    pub(super) fn power_test(points: [DVec3; 5], weights: [f64; 5]) -> Sign {
        staged(
            Predicate::PowerTest,
            lattice::power_test(points, weights),
            || fixed::power_test(points, weights),
            || interval_power_test(points, weights),
            || exact::power_test(points, weights),
        )
    }

    pub(crate) fn interval_orient2d(a: DVec2, b: DVec2, c: DVec2) -> Interval {
        let [a, b] = intervals([a, b].map(|p| p.to_array()), c.to_array());
        determinant::orient2d(&a, &b)
    }

    pub(crate) fn interval_orient3d(a: DVec3, b: DVec3, c: DVec3, d: DVec3) -> Interval {
        let [a, b, c] = intervals([a, b, c].map(|p| p.to_array()), d.to_array());
        determinant::orient3d(&a, &b, &c)
    }

    pub(crate) fn interval_incircle(a: DVec2, b: DVec2, c: DVec2, d: DVec2) -> Interval {
        let [a, b, c] = intervals([a, b, c].map(|p| p.to_array()), d.to_array());
        determinant::incircle(&a, &b, &c)
    }

    pub(crate) fn interval_insphere(a: DVec3, b: DVec3, c: DVec3, d: DVec3, e: DVec3) -> Interval {
        let [a, b, c, d] = intervals([a, b, c, d].map(|p| p.to_array()), e.to_array());
        determinant::insphere(&a, &b, &c, &d)
    }

    pub(crate) fn interval_power_test(points: [DVec3; 5], weights: [f64; 5]) -> Interval {
        let [a, b, c, d, e] = points.map(|p| p.to_array());
        let [a, b, c, d] = intervals([a, b, c, d], e);
        let weights = weights.map(Interval::exactly);
        let weights = std::array::from_fn(|i| weights[i].sub(&weights[4]));
        determinant::power_test([&a, &b, &c, &d], &weights)
    }
}
