//! Exact evaluation in integers of a fixed width, for coordinates whose differences have at most 75 bits.
//!
//! That is the common case of points that are nearly cospherical: doubles of like size. Widths grow along
//! the formulas, and none is larger than what the largest value needs (in limbs of 64 bits, differences
//! below 2⁷⁵):
//!
//! | | value | bits with sign | limbs |
//! |---|---|---|---|
//! | difference | 2⁷⁵ | 76 | 2 |
//! | minor | 2 · 2¹⁵⁰ | 152 | 3 |
//! | lift | 3 · 2¹⁵⁰ | 153 | 3 |
//! | 3×3 determinant | 6 · 2²²⁵ | 229 | 4 |
//! | incircle | 12 · 2³⁰⁰ | 305 | 5 |
//! | insphere | 72 · 2³⁷⁵ | 383 | 6 |
//! | difference of weights | 2¹⁵⁰ | 151 | 3 |
//! | power test | 96 · 2³⁷⁵ | 383 | 6 |

use crate::{Sign, integer::Parts};
use glam::{DVec2, DVec3};

/// Two's complement in N limbs, least first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Fixed<const N: usize>([u64; N]);

impl Fixed<2> {
    pub(crate) fn of(value: i128) -> Self {
        Self([value as u64, (value >> 64) as u64])
    }
}

impl Fixed<3> {
    /// mantissa · 2^shift, where that is less than 2¹⁹¹.
    fn shifted(mantissa: i64, shift: u32) -> Self {
        let wide = i128::from(mantissa) << (shift % 64);
        let words = (shift / 64) as usize;
        Self(std::array::from_fn(|i| match i.checked_sub(words) {
            None => 0,
            Some(0) => wide as u64,
            Some(1) => (wide >> 64) as u64,
            Some(_) => (wide >> 127) as u64,
        }))
    }

    /// Whether −2^bits ≤ self < 2^bits, for 128 ≤ bits < 192.
    fn fits(self, bits: u32) -> bool {
        matches!((self.0[2] as i64) >> (bits - 128), 0 | -1)
    }
}

impl<const N: usize> Fixed<N> {
    #[inline(always)]
    fn is_negative(self) -> bool {
        self.0[N - 1] >> 63 == 1
    }

    pub(crate) fn sign(self) -> Sign {
        if self.is_negative() {
            Sign::Negative
        } else if self.0 == [0; N] {
            Sign::Zero
        } else {
            Sign::Positive
        }
    }

    #[inline(always)]
    pub(crate) fn plus(mut self, other: Self) -> Self {
        let mut carry = false;
        for (x, y) in self.0.iter_mut().zip(other.0) {
            let (sum, first) = x.overflowing_add(y);
            let (sum, second) = sum.overflowing_add(u64::from(carry));
            *x = sum;
            carry = first | second;
        }
        self
    }

    #[inline(always)]
    pub(crate) fn minus(mut self, other: Self) -> Self {
        subtract(&mut self.0, &other.0);
        self
    }

    /// The product modulo 2^64R: exact when it fits R limbs.
    #[inline(always)]
    pub(crate) fn times<const M: usize, const R: usize>(self, other: Fixed<M>) -> Fixed<R> {
        let mut product = [0_u64; R];
        for (i, &x) in self.0.iter().enumerate() {
            let mut carry = 0;
            for (j, &y) in other.0.iter().enumerate() {
                if i + j < R {
                    let total = u128::from(x) * u128::from(y) + u128::from(product[i + j]) + carry;
                    product[i + j] = total as u64;
                    carry = total >> 64;
                }
            }
            if i + M < R {
                product[i + M] = carry as u64;
            }
        }
        // As unsigned numbers the negative factors were too large by 2^64N and 2^64M.
        if self.is_negative() {
            subtract(&mut product[N..], &other.0);
        }
        if other.is_negative() {
            subtract(&mut product[M..], &self.0);
        }
        Fixed(product)
    }
}

/// x − y modulo the width of x.
#[inline(always)]
fn subtract(x: &mut [u64], y: &[u64]) {
    let mut borrow = false;
    for (x, &y) in x.iter_mut().zip(y) {
        let (rest, first) = x.overflowing_sub(y);
        let (rest, second) = rest.overflowing_sub(u64::from(borrow));
        *x = rest;
        borrow = first | second;
    }
}

/// The points minus the last one, in units of the smallest last bit among all coordinates.
fn differences<const D: usize, const N: usize>(
    points: [[f64; D]; N],
    last: [f64; D],
) -> Option<[[Fixed<2>; D]; N]> {
    Some(differences_in_units(points, last, i32::MAX)?.0)
}

/// The points minus the last one, in units of the smallest last bit among all coordinates, or of 2^finest if
/// that is less; and the unit's exponent.
#[inline(always)]
fn differences_in_units<const D: usize, const N: usize>(
    points: [[f64; D]; N],
    last: [f64; D],
    finest: i32,
) -> Option<([[Fixed<2>; D]; N], i32)> {
    /// Bits of a coordinate above the smallest last bit, so that differences fit an `i128`.
    const COORDINATE_BITS: i32 = 126;
    const DIFFERENCE_BITS: u32 = 75;
    let last = last.map(Parts::of);
    let parts = points.map(|p| p.map(Parts::of));
    let (mut low, mut top) = (finest, i32::MIN);
    for part in parts.iter().flatten().chain(&last) {
        if part.mantissa != 0 {
            low = low.min(part.exponent);
            top = top.max(part.exponent + part.mantissa.unsigned_abs().ilog2() as i32 + 1);
        }
    }
    if i64::from(top) - i64::from(low) > i64::from(COORDINATE_BITS) {
        return None;
    }
    let integer = |part: Parts| match part.mantissa {
        0 => 0,
        mantissa => i128::from(mantissa) << (part.exponent - low),
    };
    let last = last.map(integer);
    let mut bits = 0;
    let differences = parts.map(|p| {
        std::array::from_fn(|k| {
            let difference = integer(p[k]) - last[k];
            bits |= difference.unsigned_abs();
            Fixed::of(difference)
        })
    });
    (bits >> DIFFERENCE_BITS == 0).then_some((differences, low))
}

#[inline(always)]
fn minor<const D: usize>(x: &[Fixed<2>; D], y: &[Fixed<2>; D]) -> Fixed<3> {
    x[0].times(y[1]).minus(y[0].times(x[1]))
}

/// Σ |p|² in three limbs.
#[inline(always)]
fn lift<const D: usize>(p: &[Fixed<2>; D]) -> Fixed<3> {
    p.iter().fold(Fixed([0; 3]), |sum, &c| sum.plus(c.times(c)))
}

pub(crate) fn orient2d(a: DVec2, b: DVec2, c: DVec2) -> Option<Sign> {
    let [a, b] = differences([a, b].map(|p| p.to_array()), c.to_array())?;
    Some(minor(&a, &b).sign())
}

/// The formula of [`crate::determinant::orient3d`].
pub(crate) fn orient3d(a: DVec3, b: DVec3, c: DVec3, d: DVec3) -> Option<Sign> {
    let [a, b, c] = differences([a, b, c].map(|p| p.to_array()), d.to_array())?;
    let value: Fixed<4> = b[2].times(minor(&a, &c));
    let value = value.plus(a[2].times(minor(&c, &b)));
    Some(value.plus(c[2].times(minor(&b, &a))).sign())
}

/// The formula of [`crate::determinant::incircle`].
pub(crate) fn incircle(a: DVec2, b: DVec2, c: DVec2, d: DVec2) -> Option<Sign> {
    let [a, b, c] = differences([a, b, c].map(|p| p.to_array()), d.to_array())?;
    let value: Fixed<5> = lift(&a).times(minor(&b, &c));
    let value = value.plus(lift(&b).times(minor(&c, &a)));
    Some(value.plus(lift(&c).times(minor(&a, &b))).sign())
}

pub(crate) fn insphere(a: DVec3, b: DVec3, c: DVec3, d: DVec3, e: DVec3) -> Option<Sign> {
    let v = differences([a, b, c, d].map(|p| p.to_array()), e.to_array())?;
    let lifts = [lift(&v[0]), lift(&v[1]), lift(&v[2]), lift(&v[3])];
    Some(lifted(v, lifts))
}

/// The weights minus the last one, in units of 2^unit.
fn weight_differences(weights: [Parts; 5], unit: i32) -> Option<[Fixed<3>; 4]> {
    const WEIGHT_BITS: i32 = 190;
    const DIFFERENCE_BITS: u32 = 150;
    let mut integers = [Fixed([0; 3]); 5];
    for (integer, part) in integers.iter_mut().zip(weights) {
        if part.mantissa != 0 {
            let shift = part.exponent - unit;
            if shift + 1 + part.mantissa.unsigned_abs().ilog2() as i32 > WEIGHT_BITS {
                return None;
            }
            *integer = Fixed::shifted(part.mantissa, shift as u32);
        }
    }
    let differences = std::array::from_fn(|i| integers[i].minus(integers[4]));
    let fit = |d: &Fixed<3>| d.fits(DIFFERENCE_BITS);
    differences.iter().all(fit).then_some(differences)
}

pub(crate) fn power_test(points: [DVec3; 5], weights: [f64; 5]) -> Option<Sign> {
    let [a, b, c, d, e] = points.map(|p| p.to_array());
    let weights = weights.map(Parts::of);
    // Weights count in squares of the unit.
    let nonzero = weights.iter().filter(|w| w.mantissa != 0);
    let finest = nonzero.map(|w| w.exponent.div_euclid(2)).min();
    let finest = finest.unwrap_or(i32::MAX);
    let (v, unit) = differences_in_units([a, b, c, d], e, finest)?;
    let unit = unit.saturating_mul(2);
    let w = weight_differences(weights, unit)?;
    let heights = std::array::from_fn(|i| lift(&v[i]).minus(w[i]));
    Some(lifted(v, heights))
}

/// The formula of [`crate::determinant::power_test`], from the heights of the lifted points.
#[inline(always)]
fn lifted([a, b, c, d]: [[Fixed<2>; 3]; 4], [ha, hb, hc, hd]: [Fixed<3>; 4]) -> Sign {
    let (ab, bc, cd) = (minor(&a, &b), minor(&b, &c), minor(&c, &d));
    let (da, ac, bd) = (minor(&d, &a), minor(&a, &c), minor(&b, &d));
    let z = |p: &[Fixed<2>; 3], minor: Fixed<3>| -> Fixed<4> { p[2].times(minor) };
    let abc = z(&a, bc).minus(z(&b, ac)).plus(z(&c, ab));
    let bcd = z(&b, cd).minus(z(&c, bd)).plus(z(&d, bc));
    let cda = z(&c, da).plus(z(&d, ac)).plus(z(&a, cd));
    let dab = z(&d, ab).plus(z(&a, bd)).plus(z(&b, da));
    let weighted = |height: Fixed<3>, det: Fixed<4>| -> Fixed<6> { height.times(det) };
    let first = weighted(hc, dab).minus(weighted(hd, abc));
    let second = weighted(ha, bcd).minus(weighted(hb, cda));
    first.plus(second).sign()
}

/// The sign of |a − p|² − |b − p|².
pub(crate) fn compare_distance(p: DVec3, a: DVec3, b: DVec3) -> Option<Sign> {
    let [a, b] = differences([a, b].map(|p| p.to_array()), p.to_array())?;
    Some(lift(&a).minus(lift(&b)).sign())
}
