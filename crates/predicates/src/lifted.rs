//! Symbolic perturbation in the lifted dimension (Devillers and Teillaud 2011).
//!
//! A point lies inside a sphere when its lift (p, |p|²) lies below the hyperplane through the lifts of the
//! sphere's points. The perturbation raises the lift of the point of lexicographic rank i among n by
//! ε^(n−i) and lets ε > 0 tend to zero. So the lexicographically largest of a cospherical set is raised
//! most and lies *outside* the sphere of the others, the Delaunay triangulation depends on the point set
//! alone, and since no point moves in space, no simplex of it is flat.
//!
//! Along the raised coordinate the determinant is linear. With five cospherical points its sign is that of
//! the first of these coefficients, from the largest point down, that is not zero:
//!
//! ```text
//! raised   a                b                c                d                e
//! factor   o(e, b, c, d)    o(a, e, c, d)    o(a, b, e, d)    o(a, b, c, e)    −o(a, b, c, d)
//! ```
//!
//! # Weights
//!
//! The lift of a point with weight w is (p, |p|² − w), and [`power_test`] perturbs it in the same way, by the
//! same ranks of the *positions*. Two points at one position need no rank of their own. Let a and b be two
//! such points among the five, with different weights: their lifts lie on one vertical line, so the determinant
//! is (w_a − w_b) · o(a, c, d, e) up to sign. Either this decides: of the two the larger weight lies below, and
//! the smaller is hidden. Or a, c, d and e are coplanar, and then every factor of the table vanishes: zero, whatever
//! the ranks. Two points that agree in weight too are one point given twice: zero, the caller's duplicate.
//!
//! # In a plane
//!
//! The test in a plane needs no function of its own: when `a, b, c, e` are coplanar, `insphere(a, b, c, d,
//! e)` with `a, b, c, d` positive says whether `e` lies inside the circle through `a, b, c`, perturbed by
//! these four points alone, for every `d` off their plane, because the factor of `d` vanishes. So does
//! [`power_test`], whatever the weight of `d`: raising or lowering d turns the hyperplane about the plane of
//! a, b and c.

use crate::{
    Sign, incircle as plain_incircle, insphere as plain_insphere, orient2d, orient3d,
    power_test as plain_power_test,
    statistics::{Predicate, Stage, decided},
};
use glam::{DVec2, DVec3};
use std::cmp::Ordering;

/// Compares by x, then y, then z; −0 and 0 are equal.
#[inline]
pub fn lexicographic(a: DVec3, b: DVec3) -> Ordering {
    compare(a.to_array(), b.to_array())
}

/// Compares by x, then y; −0 and 0 are equal.
#[inline]
pub fn lexicographic2d(a: DVec2, b: DVec2) -> Ordering {
    compare(a.to_array(), b.to_array())
}

#[inline]
fn compare<const D: usize>(a: [f64; D], b: [f64; D]) -> Ordering {
    for (x, y) in a.into_iter().zip(b) {
        if x < y {
            return Ordering::Less;
        }
        if x > y {
            return Ordering::Greater;
        }
    }
    Ordering::Equal
}

/// The perturbed in-circle test: positive when `d` lies inside the circle through the counter-clockwise
/// `a, b, c`. Never zero for distinct points with `a, b, c` not collinear; zero when a point of a
/// degenerate set is there twice.
#[inline]
pub fn incircle(a: DVec2, b: DVec2, c: DVec2, d: DVec2) -> Sign {
    match plain_incircle(a, b, c, d) {
        Sign::Zero => incircle_of_cocircular(a, b, c, d),
        sign => sign,
    }
}

/// The perturbed in-sphere test: positive when `e` lies inside the sphere through the positively oriented
/// `a, b, c, d`. Never zero for distinct points with `a, b, c, d` not coplanar; zero when a point of a
/// degenerate set is there twice.
///
/// ```
/// use glam::DVec3;
/// use pellicle_predicates::{Sign, lifted};
///
/// let [a, b, c, d] = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
/// // (1, 1, 1) completes the cube and is its largest corner: outside.
/// assert_eq!(lifted::insphere(a, b, c, d, DVec3::ONE), Sign::Negative);
/// ```
#[inline]
pub fn insphere(a: DVec3, b: DVec3, c: DVec3, d: DVec3, e: DVec3) -> Sign {
    match plain_insphere(a, b, c, d, e) {
        Sign::Zero => insphere_of_cospherical(a, b, c, d, e),
        sign => sign,
    }
}

/// The perturbed power test: positive when the lift of `e` lies below the hyperplane through those of the
/// positively oriented `a, b, c, d`; `weights` are theirs in this order, in squares of the unit of length.
/// Never zero for distinct points with `a, b, c, d` not coplanar; of two equal points the one with the larger
/// weight lies below. Zero when a point of a degenerate set is there twice, with the same weight.
///
/// ```
/// use glam::DVec3;
/// use pellicle_predicates::{Sign, lifted};
///
/// let [a, b, c, d] = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
/// let inside = |e, weights| lifted::power_test(a, b, c, d, e, weights);
/// assert_eq!(inside(DVec3::ONE, [0.0; 5]), Sign::Negative);
/// // At one position the larger weight wins, by however little.
/// assert_eq!(inside(DVec3::X, [0.0, 0.0, 0.0, 0.0, f64::MIN_POSITIVE]), Sign::Positive);
/// assert_eq!(inside(DVec3::X, [0.0, f64::MIN_POSITIVE, 0.0, 0.0, 0.0]), Sign::Negative);
/// assert_eq!(inside(DVec3::X, [0.0; 5]), Sign::Zero);
/// ```
#[inline]
pub fn power_test(a: DVec3, b: DVec3, c: DVec3, d: DVec3, e: DVec3, weights: [f64; 5]) -> Sign {
    match plain_power_test(a, b, c, d, e, weights) {
        Sign::Zero => power_test_of_cospherical(a, b, c, d, e),
        sign => sign,
    }
}

/// The sign of the perturbation for four points already known to be cocircular (or collinear).
#[cold]
#[inline(never)]
pub fn incircle_of_cocircular(a: DVec2, b: DVec2, c: DVec2, d: DVec2) -> Sign {
    decided(Predicate::InCircle, Stage::Perturbation);
    from_the_largest([a, b, c, d], lexicographic2d, |raised| match raised {
        0 => orient2d(d, b, c),
        1 => orient2d(a, d, c),
        2 => orient2d(a, b, d),
        _ => -orient2d(a, b, c),
    })
}

/// The sign of the perturbation for five points already known to be cospherical (or coplanar).
#[cold]
#[inline(never)]
pub fn insphere_of_cospherical(a: DVec3, b: DVec3, c: DVec3, d: DVec3, e: DVec3) -> Sign {
    insphere_of_cospherical_by([a, b, c, d, e], orient3d)
}

/// The same, with signs of orientation from elsewhere.
#[inline]
pub(crate) fn insphere_of_cospherical_by(
    points: [DVec3; 5],
    orient3d: impl Fn(DVec3, DVec3, DVec3, DVec3) -> Sign,
) -> Sign {
    decided(Predicate::InSphere, Stage::Perturbation);
    by_factors(points, orient3d)
}

/// The sign of the perturbation for five points whose lifts are already known to lie on one hyperplane: the
/// weights have no more say.
#[cold]
#[inline(never)]
pub fn power_test_of_cospherical(a: DVec3, b: DVec3, c: DVec3, d: DVec3, e: DVec3) -> Sign {
    decided(Predicate::PowerTest, Stage::Perturbation);
    by_factors([a, b, c, d, e], orient3d)
}

#[inline(always)]
fn by_factors(
    [a, b, c, d, e]: [DVec3; 5],
    orient3d: impl Fn(DVec3, DVec3, DVec3, DVec3) -> Sign,
) -> Sign {
    from_the_largest([a, b, c, d, e], lexicographic, |raised| match raised {
        0 => orient3d(e, b, c, d),
        1 => orient3d(a, e, c, d),
        2 => orient3d(a, b, e, d),
        3 => orient3d(a, b, c, e),
        _ => -orient3d(a, b, c, d),
    })
}

/// The first factor that is not zero, from the largest point down. The first one mostly decides, so the
/// points are not sorted but the largest is searched again among those left.
#[inline(always)]
fn from_the_largest<P: Copy, const N: usize>(
    points: [P; N],
    order: impl Fn(P, P) -> Ordering,
    factor: impl Fn(usize) -> Sign,
) -> Sign {
    let mut left: [usize; N] = std::array::from_fn(|i| i);
    for count in (1..=N).rev() {
        let mut largest = 0;
        for i in 1..count {
            match order(points[left[i]], points[left[largest]]) {
                Ordering::Greater => largest = i,
                Ordering::Less => {}
                // Two equal points are raised alike: the determinant stays zero.
                Ordering::Equal => return Sign::Zero,
            }
        }
        let sign = factor(left[largest]);
        if sign != Sign::Zero {
            return sign;
        }
        left[largest] = left[count - 1];
    }
    Sign::Zero
}
