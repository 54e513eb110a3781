//! Integers of any size, sign and magnitude, for the last exact route.

use crate::{Sign, determinant::Ring};
use std::cmp::Ordering;

/// An integer: `magnitude` holds 64-bit limbs, least first, without leading zeros; zero has none.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Integer {
    negative: bool,
    magnitude: Vec<u64>,
}

impl Integer {
    pub(crate) const ZERO: Self = Self {
        negative: false,
        magnitude: Vec::new(),
    };

    /// value · 2^shift.
    pub(crate) fn shifted(value: i64, shift: u32) -> Self {
        let words = (shift / 64) as usize;
        let bits = shift % 64;
        let wide = u128::from(value.unsigned_abs()) << bits;
        let mut magnitude = vec![0; words];
        magnitude.push(wide as u64);
        magnitude.push((wide >> 64) as u64);
        Self::normalized(value < 0, magnitude)
    }

    pub(crate) fn sign(&self) -> Sign {
        match (self.magnitude.is_empty(), self.negative) {
            (true, _) => Sign::Zero,
            (false, false) => Sign::Positive,
            (false, true) => Sign::Negative,
        }
    }

    fn normalized(negative: bool, mut magnitude: Vec<u64>) -> Self {
        while magnitude.last() == Some(&0) {
            magnitude.pop();
        }
        Self {
            negative: negative && !magnitude.is_empty(),
            magnitude,
        }
    }

    /// self + other, with the sign of `other` turned when `turned`.
    fn sum(&self, other: &Self, turned: bool) -> Self {
        let other_negative = other.negative != turned;
        if self.negative == other_negative {
            let magnitude = sum_of(&self.magnitude, &other.magnitude);
            return Self::normalized(self.negative, magnitude);
        }
        match compare(&self.magnitude, &other.magnitude) {
            Ordering::Equal => Self::ZERO,
            Ordering::Greater => Self::normalized(
                self.negative,
                difference_of(&self.magnitude, &other.magnitude),
            ),
            Ordering::Less => Self::normalized(
                other_negative,
                difference_of(&other.magnitude, &self.magnitude),
            ),
        }
    }
}

fn compare(x: &[u64], y: &[u64]) -> Ordering {
    (x.len().cmp(&y.len())).then_with(|| x.iter().rev().cmp(y.iter().rev()))
}

fn sum_of(x: &[u64], y: &[u64]) -> Vec<u64> {
    let (long, short) = if x.len() >= y.len() { (x, y) } else { (y, x) };
    let mut sum = Vec::with_capacity(long.len() + 1);
    let mut carry = 0;
    for (i, &limb) in long.iter().enumerate() {
        let total = u128::from(limb) + u128::from(short.get(i).copied().unwrap_or(0)) + carry;
        sum.push(total as u64);
        carry = total >> 64;
    }
    sum.push(carry as u64);
    sum
}

/// large − small, where large is not the smaller one.
fn difference_of(large: &[u64], small: &[u64]) -> Vec<u64> {
    let mut borrow = false;
    let limbs = large.iter().enumerate().map(|(i, &limb)| {
        let (part, first) = limb.overflowing_sub(small.get(i).copied().unwrap_or(0));
        let (part, second) = part.overflowing_sub(u64::from(borrow));
        borrow = first || second;
        part
    });
    limbs.collect()
}

impl Ring for Integer {
    fn add(&self, other: &Self) -> Self {
        self.sum(other, false)
    }

    fn sub(&self, other: &Self) -> Self {
        self.sum(other, true)
    }

    /// Schoolbook: a product of two 2100-bit numbers takes about a thousand limb products.
    fn mul(&self, other: &Self) -> Self {
        let mut product = vec![0_u64; self.magnitude.len() + other.magnitude.len()];
        for (i, &x) in self.magnitude.iter().enumerate() {
            let mut carry = 0;
            for (j, &y) in other.magnitude.iter().enumerate() {
                let total = u128::from(x) * u128::from(y) + u128::from(product[i + j]) + carry;
                product[i + j] = total as u64;
                carry = total >> 64;
            }
            product[i + other.magnitude.len()] = carry as u64;
        }
        Self::normalized(self.negative != other.negative, product)
    }
}

/// A double taken apart: value = mantissa · 2^exponent with an odd mantissa (or zero, exponent 0).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Parts {
    pub(crate) mantissa: i64,
    pub(crate) exponent: i32,
}

impl Parts {
    pub(crate) fn of(value: f64) -> Self {
        let bits = value.to_bits();
        let fraction = (bits & ((1 << 52) - 1)) as i64;
        let (magnitude, exponent) = match ((bits >> 52) & 0x7ff) as i32 {
            0 => (fraction, -1074),
            biased => (fraction | (1 << 52), biased - 1075),
        };
        if magnitude == 0 {
            return Self {
                mantissa: 0,
                exponent: 0,
            };
        }
        let zeros = magnitude.trailing_zeros() as i32;
        let odd = magnitude >> zeros;
        Self {
            mantissa: if value.is_sign_negative() { -odd } else { odd },
            exponent: exponent + zeros,
        }
    }
}
