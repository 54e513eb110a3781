//! Exact evaluation in doubles or 128-bit integers for points on a coarse lattice.
//!
//! Degenerate input is mostly quantised input: grids, scans with a fixed step, rounded coordinates. When
//! the coordinates of a call are integer multiples of a power of two, and their differences are less than
//! 2^B of these units, the determinant divided by the units is an integer that fits 128 bits:
//!
//! | determinant | monomials | largest value | B |
//! |---|---|---|---|
//! | orient2d | 2 | 2 · 2^2B | 48 |
//! | orient3d | 6 | 6 · 2^3B | 41 |
//! | incircle | 12 | 12 · 2^4B | 30 |
//! | insphere | 72 | 72 · 2^5B | 24 |
//! | power test | 72 + 24 | 72 · 2^5B + 24 · 2^3B W | 24 |
//!
//! Weights are multiples of the unit's square, and their differences W less than 2^2B of these.
//!
//! No intermediate result is larger than the sum of the absolute monomials, which is the value given. The
//! coordinates themselves, far from the origin perhaps, must fit 62 bits; for orient2d B is less than could
//! be, to leave them room.

use crate::{Sign, determinant, determinant::Ring};
use glam::{DVec2, DVec3};

impl Ring for i128 {
    #[inline(always)]
    fn add(&self, other: &Self) -> Self {
        self + other
    }
    #[inline(always)]
    fn sub(&self, other: &Self) -> Self {
        self - other
    }
    #[inline(always)]
    fn mul(&self, other: &Self) -> Self {
        self * other
    }
}

/// A power of two and its inverse.
#[derive(Clone, Copy)]
struct Unit {
    size: f64,
    inverse: f64,
}

impl Unit {
    /// The unit in which a number like `largest` has `bits` bits.
    #[inline(always)]
    fn of(largest: f64, bits: u32) -> Option<Self> {
        let exponent = (largest.to_bits() >> 52) as i64 + 1 - i64::from(bits);
        // Both powers must be normal numbers, so that multiplying by them rounds only by underflow, which
        // `count` notices, or overflow.
        (1..2046).contains(&exponent).then(|| Self {
            size: f64::from_bits((exponent as u64) << 52),
            inverse: f64::from_bits(((2046 - exponent) as u64) << 52),
        })
    }

    /// How many units `coordinate` is, and whether that is exact.
    #[inline(always)]
    fn count(self, coordinate: f64) -> (i64, bool) {
        const LIMIT: f64 = (1_i64 << 62) as f64;
        let units = coordinate * self.inverse;
        let count = units as i64;
        let exact = count as f64 * self.size == coordinate;
        (count, exact & (units.abs() < LIMIT))
    }

    /// Its square, the unit of weights.
    fn squared(self) -> Option<Self> {
        let square = Self {
            size: self.size * self.size,
            inverse: self.inverse * self.inverse,
        };
        (square.size.is_normal() && square.inverse.is_normal()).then_some(square)
    }

    /// The same for all coordinates of a point.
    #[inline(always)]
    fn counts<const D: usize>(self, point: [f64; D]) -> ([i64; D], bool) {
        let mut exact = true;
        let counts = point.map(|coordinate| {
            let (count, is_exact) = self.count(coordinate);
            exact &= is_exact;
            count
        });
        (counts, exact)
    }
}

/// The points minus the last one and their unit, if these differences are exact multiples of a power of two
/// with at most `BITS` bits, so small and so large that products of five of them neither underflow nor
/// overflow.
#[inline(always)]
fn exact_doubles<const BITS: u32, const D: usize, const N: usize>(
    points: &[[f64; D]; N],
    last: &[f64; D],
) -> Option<([[f64; D]; N], f64)> {
    let mut differences = *points;
    let mut largest = 0.0;
    for difference in &mut differences {
        for (d, l) in difference.iter_mut().zip(last) {
            *d -= l;
            largest = f64::max(largest, d.abs());
        }
    }
    let range = f64::powi(2.0, -180)..f64::powi(2.0, 180);
    if !range.contains(&largest) {
        return None;
    }
    let unit = Unit::of(largest, BITS)?.size;
    // Adding 1.5 · 2⁵² units and taking them away again rounds to whole units what is less than 2⁵¹ units.
    let rounder = unit * (1.5 * f64::powi(2.0, 52));
    let limit = unit * f64::powi(2.0, 50);
    let mut exact = true;
    for l in last {
        exact &= ((l + rounder) - rounder == *l) & (l.abs() <= limit);
    }
    if !exact {
        return None;
    }
    for c in points.iter().flatten() {
        exact &= (c + rounder) - rounder == *c;
    }
    exact.then_some((differences, unit))
}

/// The points minus the last one in lattice units, if these are exact and have at most `BITS` bits; and the
/// unit.
#[inline(always)]
fn differences<const BITS: u32, const D: usize, const N: usize>(
    points: [[f64; D]; N],
    last: [f64; D],
) -> Option<([[i64; D]; N], Unit)> {
    let mut largest = 0.0;
    for p in &points {
        for (x, y) in p.iter().zip(&last) {
            largest = f64::max(largest, (x - y).abs());
        }
    }
    let unit = Unit::of(largest, BITS)?;
    // Off the lattice, the first point mostly shows it.
    let (last, on_lattice) = unit.counts(last);
    if !on_lattice {
        return None;
    }
    let mut exact = true;
    let mut differences = points.map(|p| {
        let (counts, on_lattice) = unit.counts(p);
        exact &= on_lattice;
        counts
    });
    // The extent above is rounded; whether the differences fit is seen from them alone.
    let mut bits = 0;
    for difference in &mut differences {
        for (d, l) in difference.iter_mut().zip(last) {
            // Counts that are not exact may be anything; no exact pair overflows.
            *d = d.wrapping_sub(l);
            bits |= d.unsigned_abs();
        }
    }
    (exact & (bits >> BITS == 0)).then_some((differences, unit))
}

fn sign(value: i128) -> Sign {
    match value.signum() {
        1 => Sign::Positive,
        0 => Sign::Zero,
        _ => Sign::Negative,
    }
}

#[inline(always)]
fn wide<const D: usize, const N: usize>(vectors: [[i64; D]; N]) -> [[i128; D]; N] {
    vectors.map(|v| v.map(i128::from))
}

pub(crate) fn orient2d(a: DVec2, b: DVec2, c: DVec2) -> Option<Sign> {
    let (points, last) = ([a.to_array(), b.to_array()], c.to_array());
    if let Some(([a, b], _)) = exact_doubles::<26, 2, 2>(&points, &last) {
        return Some(Sign::of(determinant::orient2d(&a, &b)));
    }
    let (v, _) = differences::<48, 2, 2>(points, last)?;
    let [a, b] = wide(v);
    Some(sign(determinant::orient2d(&a, &b)))
}

pub(crate) fn orient3d(a: DVec3, b: DVec3, c: DVec3, d: DVec3) -> Option<Sign> {
    let (points, last) = ([a.to_array(), b.to_array(), c.to_array()], d.to_array());
    if let Some(([a, b, c], _)) = exact_doubles::<16, 3, 3>(&points, &last) {
        return Some(Sign::of(determinant::orient3d(&a, &b, &c)));
    }
    let (v, _) = differences::<41, 3, 3>(points, last)?;
    let [a, b, c] = wide(v);
    Some(sign(determinant::orient3d(&a, &b, &c)))
}

pub(crate) fn incircle(a: DVec2, b: DVec2, c: DVec2, d: DVec2) -> Option<Sign> {
    let (points, last) = ([a.to_array(), b.to_array(), c.to_array()], d.to_array());
    if let Some(([a, b, c], _)) = exact_doubles::<12, 2, 3>(&points, &last) {
        return Some(Sign::of(determinant::incircle(&a, &b, &c)));
    }
    let (v, _) = differences::<30, 2, 3>(points, last)?;
    let [a, b, c] = wide(v);
    Some(sign(determinant::incircle(&a, &b, &c)))
}

pub(crate) fn insphere(a: DVec3, b: DVec3, c: DVec3, d: DVec3, e: DVec3) -> Option<Sign> {
    let points = [a.to_array(), b.to_array(), c.to_array(), d.to_array()];
    let last = e.to_array();
    if let Some(([a, b, c, d], _)) = exact_doubles::<9, 3, 4>(&points, &last) {
        return Some(Sign::of(determinant::insphere(&a, &b, &c, &d)));
    }
    let (v, _) = differences::<24, 3, 4>(points, last)?;
    Some(lifted(v, [0; 4]))
}

pub(crate) fn power_test(points: [DVec3; 5], weights: [f64; 5]) -> Option<Sign> {
    let [a, b, c, d, last] = points.map(|p| p.to_array());
    let points = [a, b, c, d];
    if let Some(([a, b, c, d], unit)) = exact_doubles::<9, 3, 4>(&points, &last)
        && let Some(weights) = exact_double_weights::<18>(&weights, unit * unit)
    {
        let value = determinant::power_test([&a, &b, &c, &d], &weights);
        return Some(Sign::of(value));
    }
    let (v, unit) = differences::<24, 3, 4>(points, last)?;
    Some(lifted(v, weight_differences::<48>(weights, unit)?))
}

/// The weights minus the last one, if these differences are exact multiples of `unit` with at most `BITS`
/// bits.
#[inline(always)]
fn exact_double_weights<const BITS: u32>(weights: &[f64; 5], unit: f64) -> Option<[f64; 4]> {
    let rounder = unit * (1.5 * f64::powi(2.0, 52));
    let limit = unit * f64::powi(2.0, 50);
    let mut exact = true;
    for w in weights {
        exact &= ((w + rounder) - rounder == *w) & (w.abs() <= limit);
    }
    let differences = std::array::from_fn(|i| weights[i] - weights[4]);
    let largest = unit * f64::powi(2.0, BITS as i32);
    exact &= differences.iter().all(|d: &f64| d.abs() <= largest);
    exact.then_some(differences)
}

/// The weights minus the last one in squares of the unit, if these are exact and have at most `BITS` bits.
fn weight_differences<const BITS: u32>(weights: [f64; 5], unit: Unit) -> Option<[i64; 4]> {
    let (counts, on_lattice) = unit.squared()?.counts(weights);
    if !on_lattice {
        return None;
    }
    let differences = std::array::from_fn(|i| counts[i] - counts[4]);
    let bits = differences
        .iter()
        .fold(0, |bits, d: &i64| bits | d.unsigned_abs());
    (bits >> BITS == 0).then_some(differences)
}

/// The formula of [`determinant::power_test`], each part in the narrowest type that holds it: minors are below
/// 2 · 2⁴⁸, heights below 4 · 2⁴⁸.
#[inline(always)]
fn lifted([a, b, c, d]: [[i64; 3]; 4], weights: [i64; 4]) -> Sign {
    let minor = |x: &[i64; 3], y: &[i64; 3]| x[0] * y[1] - y[0] * x[1];
    let height =
        |p: &[i64; 3], i: usize| i128::from(p[0] * p[0] + p[1] * p[1] + p[2] * p[2] - weights[i]);
    let z = |p: &[i64; 3], minor: i64| i128::from(p[2]) * i128::from(minor);
    let (ab, bc, cd) = (minor(&a, &b), minor(&b, &c), minor(&c, &d));
    let (da, ac, bd) = (minor(&d, &a), minor(&a, &c), minor(&b, &d));
    let abc = z(&a, bc) - z(&b, ac) + z(&c, ab);
    let bcd = z(&b, cd) - z(&c, bd) + z(&d, bc);
    let cda = z(&c, da) + z(&d, ac) + z(&a, cd);
    let dab = z(&d, ab) + z(&a, bd) + z(&b, da);
    sign(height(&c, 2) * dab - height(&d, 3) * abc + (height(&a, 0) * bcd - height(&b, 1) * cda))
}
