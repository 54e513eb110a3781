//! Signs of the determinants over integers of any width: the last stage, right for every finite double.
//!
//! All coordinates of a call are multiples of one power of two, the smallest last bit among them. Divided
//! by it they are integers, and the sign of a homogeneous determinant does not change. Weights, squares of
//! lengths, count in squares of that unit, which is taken so fine that they are integers too.
//!
//! *Why integers, and our own.* Expansions of doubles (Shewchuk 1997) are exact only while no product
//! overflows or underflows, so each call would need a range check and a second route beside it. Integers
//! have no such range: the code is the same at all scales. Nearly all calls that pass the filters fit a
//! [fixed width](crate::fixed), which is also several times faster than expansions. What is left are
//! coordinates of very mixed magnitude, for which sums and schoolbook products (a hundred lines) are enough
//! and a library would be heavy.

use crate::{
    Sign,
    determinant::{self, Ring},
    integer::{Integer, Parts},
};
use glam::{DVec2, DVec3};

/// The coordinates as integers, in units of their smallest last bit.
fn integers<const D: usize, const N: usize>(points: [[f64; D]; N]) -> [[Integer; D]; N] {
    let parts = points.map(|p| p.map(Parts::of));
    let unit = smallest_exponent(parts.iter().flatten()).unwrap_or(0);
    parts.map(|p| p.map(|c| in_units(c, unit)))
}

fn smallest_exponent<'a>(parts: impl Iterator<Item = &'a Parts>) -> Option<i32> {
    let nonzero = parts.filter(|p| p.mantissa != 0);
    nonzero.map(|p| p.exponent).min()
}

/// The number divided by 2^unit, where that is an integer.
fn in_units(part: Parts, unit: i32) -> Integer {
    match part.mantissa {
        0 => Integer::ZERO,
        mantissa => Integer::shifted(mantissa, (part.exponent - unit) as u32),
    }
}

#[cold]
#[inline(never)]
pub(crate) fn orient2d(a: DVec2, b: DVec2, c: DVec2) -> Sign {
    let [a, b, c] = integers([a, b, c].map(|p| p.to_array()));
    let [a, b] = [a, b].map(|p| determinant::translated(&p, &c));
    determinant::orient2d(&a, &b).sign()
}

#[cold]
#[inline(never)]
pub(crate) fn orient3d(a: DVec3, b: DVec3, c: DVec3, d: DVec3) -> Sign {
    let [a, b, c, d] = integers([a, b, c, d].map(|p| p.to_array()));
    let [a, b, c] = [a, b, c].map(|p| determinant::translated(&p, &d));
    determinant::orient3d(&a, &b, &c).sign()
}

#[cold]
#[inline(never)]
pub(crate) fn incircle(a: DVec2, b: DVec2, c: DVec2, d: DVec2) -> Sign {
    let [a, b, c, d] = integers([a, b, c, d].map(|p| p.to_array()));
    let [a, b, c] = [a, b, c].map(|p| determinant::translated(&p, &d));
    determinant::incircle(&a, &b, &c).sign()
}

#[cold]
#[inline(never)]
pub(crate) fn insphere(a: DVec3, b: DVec3, c: DVec3, d: DVec3, e: DVec3) -> Sign {
    let [a, b, c, d, e] = integers([a, b, c, d, e].map(|p| p.to_array()));
    let [a, b, c, d] = [a, b, c, d].map(|p| determinant::translated(&p, &e));
    determinant::insphere(&a, &b, &c, &d).sign()
}

/// The sign of |a − p|² − |b − p|².
#[cold]
#[inline(never)]
pub(crate) fn compare_distance(p: DVec3, a: DVec3, b: DVec3) -> Sign {
    let [a, b, p] = integers([a, b, p].map(|p| p.to_array()));
    let [a, b] = [a, b].map(|q| {
        let [x, y, z] = determinant::translated(&q, &p);
        x.square().add(&y.square()).add(&z.square())
    });
    a.sub(&b).sign()
}

#[cold]
#[inline(never)]
pub(crate) fn power_test(points: [DVec3; 5], weights: [f64; 5]) -> Sign {
    let parts = points.map(|p| p.to_array().map(Parts::of));
    let weights = weights.map(Parts::of);
    let of_points = smallest_exponent(parts.iter().flatten()).unwrap_or(0);
    let of_weights = smallest_exponent(weights.iter()).unwrap_or(0);
    let unit = of_points.min(of_weights.div_euclid(2));
    let [a, b, c, d, e] = parts.map(|p| p.map(|c| in_units(c, unit)));
    let weights = weights.map(|w| in_units(w, 2 * unit));
    let [a, b, c, d] = [a, b, c, d].map(|p| determinant::translated(&p, &e));
    let weights = std::array::from_fn(|i| weights[i].sub(&weights[4]));
    determinant::power_test([&a, &b, &c, &d], &weights).sign()
}
