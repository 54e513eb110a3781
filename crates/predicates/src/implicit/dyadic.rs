//! Integers times powers of two, as short as their digits: sums of products of them are all that implicit
//! points need.

use crate::{Sign, integer::Parts};
use std::{array::from_fn, ops::Neg};

/// Limbs of a number that needs no heap: 512 bits. With more, moving the numbers about takes longer than
/// multiplying them.
const INLINE: usize = 8;

/// A number m · 2^(64 low): the limbs of |m| have no zeros at either end; zero has none.
///
/// Zeros below the last digit cost nothing. So where a mesh holds one very small coordinate, the numbers of
/// all other triangles stay short.
#[derive(Clone, Debug)]
pub(crate) struct Dyadic {
    negative: bool,
    low: i32,
    length: usize,
    inline: [u64; INLINE],
    /// All limbs, when they are more than fit inline.
    spilled: Box<[u64]>,
}

/// A [`Dyadic`] that lies elsewhere.
#[derive(Clone, Copy, Debug)]
pub(crate) struct View<'a> {
    negative: bool,
    low: i32,
    limbs: &'a [u64],
}

impl Dyadic {
    pub(crate) fn new(negative: bool, magnitude: u128, exponent: i32) -> Self {
        let bits = exponent.rem_euclid(64) as u32;
        let first = magnitude << bits;
        // In two steps: a shift by 128 is none.
        let above = (magnitude >> 64) >> (64 - bits).min(63) >> u32::from(bits == 0);
        let limbs = [first as u64, (first >> 64) as u64, above as u64];
        Self::trimmed(negative, exponent.div_euclid(64), &limbs)
    }

    /// value / 2^unit.
    pub(crate) fn of(value: f64, unit: i32) -> Self {
        let Parts { mantissa, exponent } = Parts::of(value);
        Self::new(
            mantissa < 0,
            u128::from(mantissa.unsigned_abs()),
            exponent - unit,
        )
    }

    /// (x − y) / 2^unit.
    pub(crate) fn difference(x: f64, y: f64, unit: i32) -> Self {
        /// So that mantissas of 53 bits, shifted, and their difference fit 128 bits.
        const SHIFT: i32 = 70;
        let (p, q) = (Parts::of(x), Parts::of(y));
        let last = match (p.mantissa, q.mantissa) {
            (0, _) => q.exponent,
            (_, 0) => p.exponent,
            _ => p.exponent.min(q.exponent),
        };
        let shift = |part: Parts| {
            if part.mantissa == 0 {
                0
            } else {
                part.exponent - last
            }
        };
        if shift(p) > SHIFT || shift(q) > SHIFT {
            let (x, y) = (Self::of(x, unit), Self::of(y, unit));
            return sum([(x.view(), View::ONE), (-y.view(), View::ONE)]);
        }
        let [p, q] = [p, q].map(|part| i128::from(part.mantissa) << shift(part));
        let difference = p - q;
        Self::new(difference < 0, difference.unsigned_abs(), last - unit)
    }

    fn trimmed(negative: bool, low: i32, limbs: &[u64]) -> Self {
        let mut number = Self {
            negative: false,
            low: 0,
            length: 0,
            inline: [0; INLINE],
            spilled: Box::default(),
        };
        let Some(last) = limbs.iter().rposition(|&limb| limb != 0) else {
            return number;
        };
        let first = limbs.iter().position(|&limb| limb != 0).unwrap_or(0);
        let limbs = &limbs[first..=last];
        number.negative = negative;
        number.low = low + first as i32;
        number.length = limbs.len();
        match number.inline.get_mut(..limbs.len()) {
            Some(inline) => inline.copy_from_slice(limbs),
            None => number.spilled = limbs.into(),
        }
        number
    }

    #[inline]
    pub(crate) fn view(&self) -> View<'_> {
        View {
            negative: self.negative,
            low: self.low,
            limbs: (self.inline.get(..self.length)).unwrap_or(&self.spilled),
        }
    }

    pub(crate) fn sign(&self) -> Sign {
        self.view().sign()
    }
}

/// All of them as views.
#[inline]
pub(crate) fn views<const N: usize>(numbers: &[Dyadic; N]) -> [View<'_>; N] {
    numbers.each_ref().map(Dyadic::view)
}

impl<'a> View<'a> {
    pub(crate) const ONE: View<'static> = View {
        negative: false,
        low: 0,
        limbs: &[1],
    };

    #[inline]
    pub(crate) fn sign(self) -> Sign {
        match (self.limbs, self.negative) {
            ([], _) => Sign::Zero,
            (_, false) => Sign::Positive,
            (_, true) => Sign::Negative,
        }
    }

    #[cfg(test)]
    pub(crate) fn parts(self) -> (bool, &'a [u64], i32) {
        (self.negative, self.limbs, self.low)
    }

    pub(crate) fn is_zero(self) -> bool {
        self.limbs.is_empty()
    }

    pub(crate) fn magnitude(self) -> Self {
        Self {
            negative: false,
            ..self
        }
    }

    /// The least k with |self| < 2^k; of no meaning for zero.
    pub(crate) fn order(self) -> i64 {
        let zeros = self.limbs.last().map_or(0, |limb| limb.leading_zeros());
        64 * (i64::from(self.low) + self.limbs.len() as i64) - i64::from(zeros)
    }

    /// The first 64 binary digits, cut off behind: |self| / 2^(order − 64), rounded down.
    pub(crate) fn leading(self) -> u64 {
        match *self.limbs {
            [] => 0,
            [top] => top << top.leading_zeros(),
            [.., below, top] => {
                let both = u128::from(top) << 64 | u128::from(below);
                ((both << top.leading_zeros()) >> 64) as u64
            }
        }
    }
}

impl Neg for View<'_> {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        Self {
            negative: !self.negative,
            ..self
        }
    }
}

/// Σ xᵢ yᵢ, exactly.
pub(crate) fn sum<const N: usize>(terms: [(View, View); N]) -> Dyadic {
    let (mut low, mut top) = (i32::MAX, i32::MIN);
    for (x, y) in &terms {
        if !x.is_zero() && !y.is_zero() {
            low = low.min(x.low + y.low);
            top = top.max(x.low + y.low + (x.limbs.len() + y.limbs.len()) as i32);
        }
    }
    if low > top {
        return Dyadic::trimmed(false, 0, &[]);
    }
    // The sum of N products and its sign take less than a limb more than the longest of them.
    let length = (top - low) as usize + 1;
    match length {
        0..=8 => sum_in(low, &mut [0; 8][..length], &terms),
        9..=16 => sum_in(low, &mut [0; 16][..length], &terms),
        17..=32 => sum_in(low, &mut [0; 32][..length], &terms),
        _ => sum_in(low, &mut vec![0; length], &terms),
    }
}

/// The same, in two's complement in limbs that are zero and enough.
fn sum_in(low: i32, limbs: &mut [u64], terms: &[(View, View)]) -> Dyadic {
    for (x, y) in terms {
        if x.is_zero() || y.is_zero() {
            continue;
        }
        let place = (x.low + y.low - low) as usize;
        let (rows, columns) = match x.limbs.len() < y.limbs.len() {
            true => (x.limbs, y.limbs),
            false => (y.limbs, x.limbs),
        };
        if x.negative == y.negative {
            add_product(&mut limbs[place..], rows, columns);
        } else {
            subtract_product(&mut limbs[place..], rows, columns);
        }
    }
    let negative = limbs.last().is_some_and(|top| top >> 63 == 1);
    if negative {
        let mut carry = true;
        for limb in limbs.iter_mut() {
            (*limb, carry) = (!*limb).overflowing_add(u64::from(carry));
        }
    }
    Dyadic::trimmed(negative, low, limbs)
}

/// Schoolbook, row by row straight into the sum.
#[inline]
fn add_product(sum: &mut [u64], rows: &[u64], columns: &[u64]) {
    for (i, &x) in rows.iter().enumerate() {
        let (row, above) = sum[i..].split_at_mut(columns.len());
        let mut carry = 0;
        for (digit, &y) in row.iter_mut().zip(columns) {
            let total = u128::from(x) * u128::from(y) + u128::from(*digit) + u128::from(carry);
            *digit = total as u64;
            carry = (total >> 64) as u64;
        }
        for digit in above {
            let (total, overflow) = digit.overflowing_add(carry);
            *digit = total;
            if !overflow {
                break;
            }
            carry = 1;
        }
    }
}

/// The same, taken away.
#[inline]
fn subtract_product(sum: &mut [u64], rows: &[u64], columns: &[u64]) {
    for (i, &x) in rows.iter().enumerate() {
        let (row, above) = sum[i..].split_at_mut(columns.len());
        let mut borrow = 0;
        for (digit, &y) in row.iter_mut().zip(columns) {
            let product = u128::from(x) * u128::from(y) + u128::from(borrow);
            let (rest, below) = digit.overflowing_sub(product as u64);
            *digit = rest;
            // No overflow: where the upper half is 2⁶⁴ − 1, the lower one is zero.
            borrow = (product >> 64) as u64 + u64::from(below);
        }
        for digit in above {
            let (rest, below) = digit.overflowing_sub(borrow);
            *digit = rest;
            if !below {
                break;
            }
            borrow = 1;
        }
    }
}

/// x × y.
pub(crate) fn cross(x: [View; 3], y: [View; 3]) -> [Dyadic; 3] {
    from_fn(|k| {
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        sum([(x[i], y[j]), (-x[j], y[i])])
    })
}

/// x · y.
pub(crate) fn dot(x: [View; 3], y: [View; 3]) -> Dyadic {
    sum([(x[0], y[0]), (x[1], y[1]), (x[2], y[2])])
}

/// det[x, y, z].
pub(crate) fn determinant(x: [View; 3], y: [View; 3], z: [View; 3]) -> Dyadic {
    dot(x, views(&cross(y, z)))
}

/// Four numbers in one piece of memory: a word for the place, length and sign of each, then all limbs.
#[derive(Clone, Debug)]
pub(crate) struct Packed(Box<[u64]>);

impl Packed {
    /// Bit 0 of a header: the sign. Bits 1 to 31: how many limbs. The upper half: their place.
    pub(crate) fn new(numbers: [View; 4]) -> Self {
        let limbs = numbers.iter().map(|number| number.limbs.len());
        let mut words = Vec::with_capacity(4 + limbs.sum::<usize>());
        words.extend(numbers.iter().map(|number| {
            let place = u64::from(number.low as u32) << 32;
            place | (number.limbs.len() as u64) << 1 | u64::from(number.negative)
        }));
        for number in numbers {
            words.extend_from_slice(number.limbs);
        }
        Self(words.into_boxed_slice())
    }

    #[inline]
    pub(crate) fn views(&self) -> [View<'_>; 4] {
        let (headers, mut limbs) = self.0.split_at(4);
        from_fn(|i| {
            let header = headers[i];
            let (own, rest) = limbs.split_at((header as u32 >> 1) as usize);
            limbs = rest;
            View {
                negative: header & 1 == 1,
                low: (header >> 32) as i32,
                limbs: own,
            }
        })
    }
}
