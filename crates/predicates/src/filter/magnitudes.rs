//! The sharpest bound on the rounding errors of a determinant, at the price of a second evaluation: by the
//! magnitudes of its own monomials in place of the largest that they could be.

use super::{UNIT_ROUNDOFF, certain};
use crate::{
    Sign,
    determinant::{self, Ring},
};

/// 16 roundings (see [the table](super)), and the slack that the other bounds have too.
const INSPHERE: f64 = 16.05 * UNIT_ROUNDOFF;

/// Bounds below it do not count. With spreads up to 2¹⁹⁰ underflow may cost 2⁻⁴⁹⁵ in all: an error of 2⁻¹⁰⁷⁵ of one product
/// meets factors of at most 2⁵⁷² and fewer than 2⁸ times.
const LEAST: f64 = f64::from_bits((1023 - 400) << 52);

pub(crate) fn insphere_bound(monomials: f64) -> f64 {
    INSPHERE * monomials
}

/// A sum of absolute values of monomials. Being computed, it is too small by as many roundings at most, which the slack
/// covers.
#[derive(Clone)]
struct Magnitude(f64);

impl Ring for Magnitude {
    #[inline(always)]
    fn add(&self, other: &Self) -> Self {
        Self(self.0 + other.0)
    }
    #[inline(always)]
    fn sub(&self, other: &Self) -> Self {
        self.add(other)
    }
    #[inline(always)]
    fn mul(&self, other: &Self) -> Self {
        Self(self.0 * other.0)
    }
}

/// The sign of the in-sphere determinant of these differences, the spreads of which are in the range of the filters.
#[cold]
pub(super) fn insphere(vectors: &[[f64; 3]; 4], value: f64) -> Option<Sign> {
    let [a, b, c, d] = vectors.map(|vector| vector.map(|x| Magnitude(x.abs())));
    let Magnitude(monomials) = determinant::insphere(&a, &b, &c, &d);
    let bound = insphere_bound(monomials);
    if bound < LEAST {
        return None;
    }
    certain(value, bound)
}
