//! Floating-point filters: the determinant in doubles, trusted when it exceeds a bound on its error.
//!
//! # The error bounds
//!
//! Let u = 2⁻⁵³, and let X, Y, Z bound the computed coordinate differences |dx|, |dy|, |dz|. Without
//! underflow and overflow every operation returns its exact result times a factor 1 + δ, |δ| ≤ u. Multiply
//! a determinant out: each monomial of the computed value is the exact monomial times a product of k such
//! factors or their inverses, and that product is 1 + θ with |θ| ≤ γ = ku / (1 − ku) (Higham 2002, lemma
//! 3.1). Here k counts the roundings on the way from the coordinates to the result, the differences
//! themselves included. So
//!
//! ```text
//! |computed − exact| ≤ γ · Σ |monomials of the computed differences|
//! ```
//!
//! | determinant | differences | minor | 3×3 | lift | product and sum | k | Σ of the monomials | bound |
//! |---|---|---|---|---|---|---|---|---|
//! | orient2d | 2 | 1 · and 1 − | | | | 4 | 2 XY | 8u XY |
//! | orient3d | 3 | 1 · and 1 − | 1 · and 2 + | | | 8 | 6 XYZ | 48u XYZ |
//! | incircle | 4 | 1 · and 1 − | | 1 · and 1 + | 1 · and 2 + | 11 | 3·2 XY (X² + Y²) | 66u XY (X² + Y²) |
//! | insphere | 5 | 1 · and 1 − | 1 · and 2 + | 1 · and 2 + | 1 · and 2 + | 16 | 4·6 XYZ (X² + Y² + Z²) | 384u XYZ (X² + Y² + Z²) |
//! | power test | 5 | 1 · and 1 − | 1 · and 2 + | 1 · and 2 + and 1 − | 1 · and 2 + | 17 | 4·6 XYZ (X² + Y² + Z² + W) | 408u XYZ (X² + Y² + Z² + W) |
//!
//! With |x|, |y| ≤ M, X = Y = 2M and the first line reads 2⁻⁴⁸ M², the static bound of Teillaud's lecture
//! on robustness.
//!
//! *Weights* are squares of lengths. W bounds the computed differences of weights, which round like those of
//! coordinates. A monomial with a weight has 13 roundings only: one for its difference, three for those of
//! coordinates, then minor, 3×3, subtraction from the lift, product and sum. The bound takes 17 for all.
//!
//! *Slack.* The factors below are larger by 1/400 or more. That covers the difference between γ and ku (a
//! relative 2⁻⁴⁸), the rounding of the bound itself (eight operations) and underflow, as follows.
//!
//! *Underflow and overflow.* The filters stand aside unless 2⁻¹⁹⁰ ≤ X, Y, Z ≤ 2¹⁹⁰. Then no intermediate
//! result exceeds 72 · 2⁹⁵⁰, and the bound is at least 2⁻⁴⁵ · 2⁻⁹⁵⁰ = 2⁻⁹⁹⁵. A product that underflows is
//! wrong by at most 2⁻¹⁰⁷⁵ more. Such an error in a minor (12 products of two factors) reaches the result
//! multiplied by at most Z (X² + Y² + Z²) times a small count; relative to the bound, which has the same
//! factors, that is 2⁻¹⁰⁷⁵⁺⁶ / (2⁻⁴⁵ XY) ≤ 2⁻⁶⁴⁴. The same holds for the lifts and the 3×3 determinants, and
//! the last four products add 2⁻¹⁰⁷³, a relative 2⁻⁷⁸. Sums and differences never underflow wrongly.
//!
//! For weights the filter stands aside unless W ≤ 2³⁸⁰ (a difference that overflows is infinite): then nothing
//! exceeds 96 · 2⁹⁵⁰. From below W needs no limit, because a weight enters by sums alone and the bound, which
//! has the coordinates' part, is not smaller than before.
//!
//! # Static and semi-static
//!
//! The bounds grow with X, Y, Z, W, so any upper bounds of the computed differences will do: the largest of
//! the call (semi-static; Meyer and Pion 2008), or the extents of a box that holds all points, and of
//! an interval that holds all weights (static):
//! rounding is monotone, so no computed difference exceeds the computed extent.

mod across;
pub(crate) mod magnitudes;
mod out_of_line;
mod plane;

pub use plane::StaticFilter2;

use crate::{
    Sign, determinant, lifted,
    statistics::{Predicate, Stage, decided},
};
use glam::{DVec2, DVec3};

/// u · 2⁰: the largest relative error of one operation.
const UNIT_ROUNDOFF: f64 = f64::EPSILON / 2.0;
const ORIENT2D: f64 = 8.02 * UNIT_ROUNDOFF;
const ORIENT3D: f64 = 48.12 * UNIT_ROUNDOFF;
const INCIRCLE: f64 = 66.17 * UNIT_ROUNDOFF;
const INSPHERE: f64 = 385.0 * UNIT_ROUNDOFF;
const POWER_TEST: f64 = 409.1 * UNIT_ROUNDOFF;

/// 2⁻¹⁹⁰ and 2¹⁹⁰, between which the bounds above hold.
const TINY: f64 = f64::from_bits((1023 - 190) << 52);
const HUGE: f64 = f64::from_bits((1023 + 190) << 52);
/// 2³⁸⁰, for weights.
const HUGE_WEIGHT: f64 = HUGE * HUGE;

#[inline(always)]
fn in_range<const D: usize>(extents: [f64; D]) -> bool {
    extents.iter().all(|&e| (TINY..=HUGE).contains(&e))
}

#[inline(always)]
pub(crate) fn orient2d_bound([x, y]: [f64; 2]) -> f64 {
    ORIENT2D * x * y
}

#[inline(always)]
pub(crate) fn orient3d_bound([x, y, z]: [f64; 3]) -> f64 {
    ORIENT3D * x * y * z
}

#[inline(always)]
pub(crate) fn incircle_bound([x, y]: [f64; 2]) -> f64 {
    INCIRCLE * x * y * (x * x + y * y)
}

#[inline(always)]
pub(crate) fn insphere_bound([x, y, z]: [f64; 3]) -> f64 {
    INSPHERE * x * y * z * (x * x + y * y + z * z)
}

#[inline(always)]
pub(crate) fn power_test_bound([x, y, z]: [f64; 3], weight: f64) -> f64 {
    POWER_TEST * x * y * z * (x * x + y * y + z * z + weight)
}

/// The sign of `value` if it is surely that of the exact determinant.
#[inline(always)]
fn certain(value: f64, bound: f64) -> Option<Sign> {
    if value.abs() > bound {
        Some(if value > 0.0 {
            Sign::Positive
        } else {
            Sign::Negative
        })
    } else {
        None
    }
}

/// Why the semi-static filter gave no bound.
enum Unfit {
    /// All points agree in one coordinate: every determinant is zero.
    Flat,
    /// Too small or too large for the error analysis.
    OutOfRange,
}

/// The largest |difference| along each axis.
#[inline(always)]
fn spreads<const D: usize, const N: usize>(vectors: &[[f64; D]; N]) -> Result<[f64; D], Unfit> {
    let mut spreads = [0.0; D];
    for vector in vectors {
        for (spread, coordinate) in spreads.iter_mut().zip(vector) {
            *spread = f64::max(*spread, coordinate.abs());
        }
    }
    if in_range(spreads) {
        Ok(spreads)
    } else if spreads.contains(&0.0) {
        // Two doubles have the difference zero only when they are equal.
        Err(Unfit::Flat)
    } else {
        Err(Unfit::OutOfRange)
    }
}

/// The semi-static filter: a value, and the bound that belongs to the spreads of its vectors.
#[inline(always)]
fn semi_static<const D: usize, const N: usize>(
    vectors: &[[f64; D]; N],
    bound: impl Fn([f64; D]) -> f64,
    value: impl Fn() -> f64,
) -> Option<Sign> {
    semi_static_or(vectors, bound, value, |_| None)
}

/// The same, and a sharper bound for a value that is not certain by that of the spreads.
#[inline(always)]
fn semi_static_or<const D: usize, const N: usize>(
    vectors: &[[f64; D]; N],
    bound: impl Fn([f64; D]) -> f64,
    value: impl Fn() -> f64,
    sharper: impl Fn(f64) -> Option<Sign>,
) -> Option<Sign> {
    match spreads(vectors) {
        Ok(spreads) => {
            let value = value();
            certain(value, bound(spreads)).or_else(|| sharper(value))
        }
        Err(Unfit::Flat) => Some(Sign::Zero),
        Err(Unfit::OutOfRange) => None,
    }
}

#[inline(always)]
pub(crate) fn orient2d(a: DVec2, b: DVec2, c: DVec2) -> Option<Sign> {
    let v = [(a - c).to_array(), (b - c).to_array()];
    semi_static(&v, orient2d_bound, || determinant::orient2d(&v[0], &v[1]))
}

#[inline(always)]
pub(crate) fn orient3d(a: DVec3, b: DVec3, c: DVec3, d: DVec3) -> Option<Sign> {
    let v = [(a - d).to_array(), (b - d).to_array(), (c - d).to_array()];
    semi_static(&v, orient3d_bound, || {
        determinant::orient3d(&v[0], &v[1], &v[2])
    })
}

#[inline(always)]
pub(crate) fn incircle(a: DVec2, b: DVec2, c: DVec2, d: DVec2) -> Option<Sign> {
    let v = [(a - d).to_array(), (b - d).to_array(), (c - d).to_array()];
    semi_static(&v, incircle_bound, || {
        determinant::incircle(&v[0], &v[1], &v[2])
    })
}

#[inline(always)]
pub(crate) fn insphere(a: DVec3, b: DVec3, c: DVec3, d: DVec3, e: DVec3) -> Option<Sign> {
    // One by one: `map` over an array of points goes through memory, at half the speed.
    let v = [
        (a - e).to_array(),
        (b - e).to_array(),
        (c - e).to_array(),
        (d - e).to_array(),
    ];
    semi_static_or(
        &v,
        insphere_bound,
        || determinant::insphere(&v[0], &v[1], &v[2], &v[3]),
        |value| magnitudes::insphere(&v, value),
    )
}

/// The weights minus the last one.
#[inline(always)]
fn weight_differences([a, b, c, d, e]: [f64; 5]) -> [f64; 4] {
    [a - e, b - e, c - e, d - e]
}

#[inline(always)]
pub(crate) fn power_test(
    a: DVec3,
    b: DVec3,
    c: DVec3,
    d: DVec3,
    e: DVec3,
    weights: [f64; 5],
) -> Option<Sign> {
    let v = [
        (a - e).to_array(),
        (b - e).to_array(),
        (c - e).to_array(),
        (d - e).to_array(),
    ];
    let weights = weight_differences(weights);
    let spread = weights
        .iter()
        .fold(0.0, |spread, w| f64::max(spread, w.abs()));
    match spreads(&v) {
        Ok(spreads) if spread <= HUGE_WEIGHT => certain(
            determinant::power_test([&v[0], &v[1], &v[2], &v[3]], &weights),
            power_test_bound(spreads, spread),
        ),
        Err(Unfit::Flat) => Some(Sign::Zero),
        _ => None,
    }
}

/// Static filters for points of space inside a known box: each test costs one comparison beside the
/// determinant itself (77 operations for the in-sphere test, 23 for the orientation).
///
/// Every point given to a test must lie inside the box: debug builds assert it, release builds trust it,
/// and for a point outside a wrong sign may pass the filter. A box with a side of length zero, or shorter
/// than 2⁻¹⁹⁰ or longer than 2¹⁹⁰, leaves every decision to the later stages.
///
/// ```
/// use glam::DVec3;
/// use pellicle_predicates::{Sign, StaticFilter};
///
/// let filter = StaticFilter::from_bounds(DVec3::ZERO, DVec3::ONE);
/// let corners = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
/// let [a, b, c, d] = corners;
/// assert_eq!(filter.insphere(a, b, c, d, DVec3::splat(0.4)), Sign::Positive);
/// // The opposite corner of the cube is on the sphere: no filter can tell, exact arithmetic does.
/// assert_eq!(filter.insphere_filtered(a, b, c, d, DVec3::ONE), None);
/// assert_eq!(filter.insphere(a, b, c, d, DVec3::ONE), Sign::Zero);
/// assert_eq!(filter.insphere_perturbed(a, b, c, d, DVec3::ONE), Sign::Negative);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct StaticFilter {
    min: DVec3,
    max: DVec3,
    orient3d: f64,
    insphere: f64,
    /// Half the least determinants that are not zero, or 0: see [`with_unit`](Self::with_unit).
    half_unit_of_orient3d: f64,
    half_unit_of_insphere: f64,
    weights: [f64; 2],
    power_test: f64,
}

impl StaticFilter {
    /// The filter for points inside the box from `min` to `max`.
    pub fn from_bounds(min: DVec3, max: DVec3) -> Self {
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
            orient3d: usable(orient3d_bound(extents)),
            insphere: usable(insphere_bound(extents)),
            half_unit_of_orient3d: 0.0,
            half_unit_of_insphere: 0.0,
            weights: [f64::NEG_INFINITY, f64::INFINITY],
            power_test: f64::INFINITY,
        }
    }

    /// The same filter for points whose coordinates are all multiples of `unit`, a power of two, and so small
    /// multiples of it that their differences are exact: scans with a fixed step, grids, rounded coordinates.
    /// Determinants are then multiples of a power of the unit, and where the bound on the error is less than
    /// half of that, one that may be zero is zero: the filter decides ties too.
    ///
    /// A unit outside 2^±180, or so small that differences may be rounded, changes nothing.
    ///
    /// ```
    /// use glam::DVec3;
    /// use pellicle_predicates::{Sign, StaticFilter};
    ///
    /// let filter = StaticFilter::from_bounds(DVec3::ZERO, DVec3::splat(9.0)).with_unit(1.0);
    /// let [a, b, c] = [DVec3::ZERO, DVec3::X, DVec3::Y];
    /// assert_eq!(filter.orient3d(a, b, c, DVec3::new(7.0, 9.0, 0.0)), Sign::Zero);
    /// ```
    #[must_use]
    pub fn with_unit(mut self, unit: f64) -> Self {
        const RANGE: std::ops::RangeInclusive<f64> =
            f64::from_bits((1023 - 180) << 52)..=f64::from_bits((1023 + 180) << 52);
        let largest = self.min.abs().max(self.max.abs()).max_element();
        let is_exact = RANGE.contains(&unit) && largest <= unit * f64::from_bits((1023 + 52) << 52);
        if is_exact {
            self.half_unit_of_orient3d = 0.5 * unit.powi(3);
            self.half_unit_of_insphere = 0.5 * unit.powi(5);
        }
        self
    }

    /// The same filter for points whose weights lie between `least` and `greatest`, in squares of the unit of
    /// length. Without it, or with weights that differ by more than 2³⁸⁰, the power test is left to the later
    /// stages.
    ///
    /// ```
    /// use glam::DVec3;
    /// use pellicle_predicates::{Sign, StaticFilter};
    ///
    /// let filter = StaticFilter::from_bounds(DVec3::ZERO, DVec3::ONE).with_weights(0.0, 2.0);
    /// let [a, b, c, d] = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    /// let inside = |weight| filter.power_test(a, b, c, d, DVec3::ONE, [0.0, 0.0, 0.0, 0.0, weight]);
    /// assert_eq!(inside(0.0), Sign::Zero);
    /// assert_eq!(inside(2.0), Sign::Positive);
    /// ```
    #[must_use]
    pub fn with_weights(mut self, least: f64, greatest: f64) -> Self {
        let extents = (self.max - self.min).to_array();
        let spread = greatest - least;
        self.weights = [least, greatest];
        self.power_test = if in_range(extents) && (0.0..=HUGE_WEIGHT).contains(&spread) {
            power_test_bound(extents, spread)
        } else {
            f64::INFINITY
        };
        self
    }

    #[inline(always)]
    fn check(&self, points: &[DVec3]) {
        debug_assert!(
            points
                .iter()
                .all(|p| p.cmpge(self.min).all() && p.cmple(self.max).all()),
            "a point outside the filter's box: {points:?}"
        );
    }

    #[inline(always)]
    fn check_weights(&self, weights: &[f64]) {
        let [least, greatest] = self.weights;
        debug_assert!(
            weights.iter().all(|w| (least..=greatest).contains(w)),
            "a weight outside the filter's interval: {weights:?}"
        );
    }

    /// [`orient3d`](crate::orient3d) by the static filter alone: `None` when undecided.
    #[inline(always)]
    pub fn orient3d_filtered(&self, a: DVec3, b: DVec3, c: DVec3, d: DVec3) -> Option<Sign> {
        self.check(&[a, b, c, d]);
        let [a, b, c] = [(a - d).to_array(), (b - d).to_array(), (c - d).to_array()];
        certain(determinant::orient3d(&a, &b, &c), self.orient3d)
    }

    /// [`insphere`](crate::insphere) by the static filter alone: `None` when undecided.
    #[inline(always)]
    pub fn insphere_filtered(
        &self,
        a: DVec3,
        b: DVec3,
        c: DVec3,
        d: DVec3,
        e: DVec3,
    ) -> Option<Sign> {
        self.check(&[a, b, c, d, e]);
        // One by one: `map` over an array of points goes through memory, at half the speed.
        let [a, b, c, d] = [
            (a - e).to_array(),
            (b - e).to_array(),
            (c - e).to_array(),
            (d - e).to_array(),
        ];
        certain(determinant::insphere(&a, &b, &c, &d), self.insphere)
    }

    /// [`orient3d`](crate::orient3d) for points inside the box.
    #[inline(always)]
    pub fn orient3d(&self, a: DVec3, b: DVec3, c: DVec3, d: DVec3) -> Sign {
        match self.orient3d_filtered(a, b, c, d) {
            Some(sign) => {
                decided(Predicate::Orient3d, Stage::Static);
                sign
            }
            None if self.orient3d < self.half_unit_of_orient3d => {
                decided(Predicate::Orient3d, Stage::Static);
                Sign::Zero
            }
            None => out_of_line::orient3d(a, b, c, d),
        }
    }

    /// [`insphere`](crate::insphere) for points inside the box.
    #[inline(always)]
    pub fn insphere(&self, a: DVec3, b: DVec3, c: DVec3, d: DVec3, e: DVec3) -> Sign {
        match self.insphere_filtered(a, b, c, d, e) {
            Some(sign) => {
                decided(Predicate::InSphere, Stage::Static);
                sign
            }
            None => out_of_line::insphere(a, b, c, d, e),
        }
    }

    /// [`power_test`](crate::power_test) by the static filter alone: `None` when undecided.
    #[inline(always)]
    pub fn power_test_filtered(
        &self,
        a: DVec3,
        b: DVec3,
        c: DVec3,
        d: DVec3,
        e: DVec3,
        weights: [f64; 5],
    ) -> Option<Sign> {
        self.check(&[a, b, c, d, e]);
        self.check_weights(&weights);
        let [a, b, c, d] = [
            (a - e).to_array(),
            (b - e).to_array(),
            (c - e).to_array(),
            (d - e).to_array(),
        ];
        let weights = weight_differences(weights);
        certain(
            determinant::power_test([&a, &b, &c, &d], &weights),
            self.power_test,
        )
    }

    /// [`power_test`](crate::power_test) for points inside the box, with weights in the interval.
    #[inline(always)]
    pub fn power_test(
        &self,
        a: DVec3,
        b: DVec3,
        c: DVec3,
        d: DVec3,
        e: DVec3,
        weights: [f64; 5],
    ) -> Sign {
        match self.power_test_filtered(a, b, c, d, e, weights) {
            Some(sign) => {
                decided(Predicate::PowerTest, Stage::Static);
                sign
            }
            None => out_of_line::power_test(a, b, c, d, e, weights),
        }
    }

    /// [`lifted::power_test`] for points inside the box, with weights in the interval.
    #[inline(always)]
    pub fn power_test_perturbed(
        &self,
        a: DVec3,
        b: DVec3,
        c: DVec3,
        d: DVec3,
        e: DVec3,
        weights: [f64; 5],
    ) -> Sign {
        match self.power_test_filtered(a, b, c, d, e, weights) {
            Some(sign) => {
                decided(Predicate::PowerTest, Stage::Static);
                sign
            }
            None => out_of_line::power_test_perturbed(a, b, c, d, e, weights),
        }
    }

    /// [`lifted::insphere`] for points inside the box.
    #[inline(always)]
    pub fn insphere_perturbed(&self, a: DVec3, b: DVec3, c: DVec3, d: DVec3, e: DVec3) -> Sign {
        match self.insphere_filtered(a, b, c, d, e) {
            Some(sign) => {
                decided(Predicate::InSphere, Stage::Static);
                sign
            }
            None if self.insphere < self.half_unit_of_insphere => {
                let orient3d = |a, b, c, d| self.orient3d(a, b, c, d);
                lifted::insphere_of_cospherical_by([a, b, c, d, e], orient3d)
            }
            None => out_of_line::insphere_perturbed(a, b, c, d, e),
        }
    }
}
