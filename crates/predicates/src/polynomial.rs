//! Polynomials in ε with integer coefficients, for signs in the limit ε → 0⁺.
//!
//! A perturbation that moves points is evaluated by the same determinants as the points themselves, with
//! polynomials for coordinates. The sign of the result for all small enough ε > 0 is that of its first
//! coefficient that is not zero.

use crate::{
    Sign,
    determinant::Ring,
    integer::{Integer, Parts},
};
use std::{
    cmp::Ordering,
    collections::{BTreeMap, BTreeSet},
};

/// An exponent of ε.
pub(crate) trait Exponent: Ord + Clone {
    fn zero() -> Self;
    fn plus(&self, other: &Self) -> Self;
}

impl Exponent for u32 {
    fn zero() -> Self {
        0
    }
    fn plus(&self, other: &Self) -> Self {
        self + other
    }
}

/// A sum of powers 2^i, for exponents beyond any machine word: the set of its binary digits.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Binary(BTreeSet<u64>);

impl Binary {
    /// 2^digit.
    pub(crate) fn power(digit: u32) -> Self {
        Self(BTreeSet::from([u64::from(digit)]))
    }
}

impl Ord for Binary {
    /// As numbers: the highest digit in which they differ decides.
    fn cmp(&self, other: &Self) -> Ordering {
        self.0.iter().rev().cmp(other.0.iter().rev())
    }
}

impl PartialOrd for Binary {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Exponent for Binary {
    fn zero() -> Self {
        Self(BTreeSet::new())
    }

    fn plus(&self, other: &Self) -> Self {
        let mut sum = self.0.clone();
        for &digit in &other.0 {
            let mut carry = digit;
            while !sum.insert(carry) {
                sum.remove(&carry);
                carry += 1;
            }
        }
        Self(sum)
    }
}

/// Coefficients by exponent; those that are zero may be absent.
#[derive(Clone, Debug)]
pub(crate) struct Polynomial<E>(BTreeMap<E, Integer>);

impl<E: Exponent> Polynomial<E> {
    pub(crate) fn constant(value: Integer) -> Self {
        Self::term(value, E::zero())
    }

    /// coefficient · ε^exponent.
    pub(crate) fn term(coefficient: Integer, exponent: E) -> Self {
        Self(BTreeMap::from([(exponent, coefficient)]))
    }

    /// The sign for all small enough ε > 0.
    pub(crate) fn sign(&self) -> Sign {
        let signs = self.0.values().map(Integer::sign);
        signs
            .into_iter()
            .find(|&s| s != Sign::Zero)
            .unwrap_or(Sign::Zero)
    }
}

impl<E: Exponent> Ring for Polynomial<E> {
    fn add(&self, other: &Self) -> Self {
        let mut sum = self.0.clone();
        for (exponent, coefficient) in &other.0 {
            let entry = sum.entry(exponent.clone()).or_insert(Integer::ZERO);
            *entry = entry.add(coefficient);
        }
        Self(sum)
    }

    fn sub(&self, other: &Self) -> Self {
        let mut difference = self.0.clone();
        for (exponent, coefficient) in &other.0 {
            let entry = difference.entry(exponent.clone()).or_insert(Integer::ZERO);
            *entry = entry.sub(coefficient);
        }
        Self(difference)
    }

    fn mul(&self, other: &Self) -> Self {
        let mut product = BTreeMap::new();
        for (i, x) in &self.0 {
            for (j, y) in &other.0 {
                let entry = product.entry(i.plus(j)).or_insert(Integer::ZERO);
                *entry = entry.add(&x.mul(y));
            }
        }
        Self(product)
    }
}

/// Coordinates as integers in units of 2^−shift, where 1 is a multiple of the unit too.
pub(crate) fn integers<const D: usize, const N: usize>(
    points: [[f64; D]; N],
) -> ([[Integer; D]; N], u32) {
    let parts = points.map(|p| p.map(Parts::of));
    let unit = parts.iter().flatten().map(|p| p.exponent).fold(0, i32::min);
    let integers =
        parts.map(|p| p.map(|c| Integer::shifted(c.mantissa, (c.exponent - unit) as u32)));
    (integers, unit.unsigned_abs())
}
