//! Which of two points is nearer to a third.
//!
//! With A = |a − p|² and B = |b − p|², the sign of A − B. The filter computes both in doubles, each with a
//! relative error of at most γ₅ = 5u / (1 − 5u): one rounding of a difference counts twice in its square,
//! then the square, then two sums (Higham 2002). So the computed difference is wrong by at most
//! 10.02 u max(A, B), and by 7 · 2⁻¹⁰⁷⁵ where squares underflow; for max(A, B) ≥ 2⁻⁹⁰⁰ the bound
//! 11 u max(A, B) covers both. Where something overflows the bound is infinite or the difference NaN, and
//! neither decides.
//!
//! What the filter leaves open is decided in integers: of fixed width where the magnitudes are alike, of any
//! width otherwise.

use crate::{Sign, exact, fixed};
use glam::DVec3;
use std::cmp::Ordering;

/// 11 u with u = 2⁻⁵³.
const BOUND: f64 = 5.5 * f64::EPSILON;

/// 2⁻⁹⁰⁰.
const TINY: f64 = f64::from_bits((1023 - 900) << 52);

/// Compares the distances from `p` to `a` and to `b`: `Less` when `a` is nearer. Exact for all finite
/// doubles.
///
/// ```
/// use glam::DVec3;
/// use pellicle_predicates::compare_distance;
/// use std::cmp::Ordering;
///
/// let p = DVec3::new(3.0, 0.0, 0.0);
/// assert_eq!(compare_distance(p, DVec3::X, DVec3::ZERO), Ordering::Less);
/// assert_eq!(compare_distance(p, DVec3::ZERO, p + p), Ordering::Equal);
/// // Squares of these distances underflow to zero.
/// let tiny = f64::from_bits(1);
/// let [near, far] = [DVec3::splat(tiny), DVec3::splat(2.0 * tiny)];
/// assert_eq!(compare_distance(DVec3::ZERO, near, far), Ordering::Less);
/// ```
#[inline]
pub fn compare_distance(p: DVec3, a: DVec3, b: DVec3) -> Ordering {
    match filtered(p, a, b) {
        Some(ordering) => ordering,
        None => unfiltered(p, a, b),
    }
}

#[inline(always)]
pub(crate) fn filtered(p: DVec3, a: DVec3, b: DVec3) -> Option<Ordering> {
    let (a, b) = ((a - p).length_squared(), (b - p).length_squared());
    let (difference, largest) = (a - b, f64::max(a, b));
    if difference.abs() > BOUND * largest && largest >= TINY {
        a.partial_cmp(&b)
    } else {
        None
    }
}

#[cold]
#[inline(never)]
fn unfiltered(p: DVec3, a: DVec3, b: DVec3) -> Ordering {
    let sign = fixed::compare_distance(p, a, b).unwrap_or_else(|| exact::compare_distance(p, a, b));
    match sign {
        Sign::Negative => Ordering::Less,
        Sign::Zero => Ordering::Equal,
        Sign::Positive => Ordering::Greater,
    }
}
