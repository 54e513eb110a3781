//! Interval arithmetic with outward rounding.
//!
//! The rounding mode cannot be switched, so each end is computed to nearest and then moved outward:
//! sums by the sign of their error, which TwoSum (Knuth 1997) gives exactly, products to the neighbouring
//! double. Differences of close points therefore stay exact.

use crate::{Sign, determinant::Ring};

/// All reals between two ends, which may be infinite. Never contains NaN ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Interval {
    pub(crate) low: f64,
    pub(crate) high: f64,
}

impl Interval {
    const ENTIRE: Self = Self {
        low: f64::NEG_INFINITY,
        high: f64::INFINITY,
    };
    const ZERO: Self = Self {
        low: 0.0,
        high: 0.0,
    };

    /// The interval that holds one number.
    #[inline]
    pub(crate) fn exactly(value: f64) -> Self {
        Self {
            low: value,
            high: value,
        }
    }

    /// The common sign of all its numbers, if they have one.
    #[inline]
    pub(crate) fn sign(&self) -> Option<Sign> {
        if self.low > 0.0 {
            Some(Sign::Positive)
        } else if self.high < 0.0 {
            Some(Sign::Negative)
        } else if *self == Self::ZERO {
            Some(Sign::Zero)
        } else {
            None
        }
    }
}

/// The rounded sum and its error: x + y = sum + error, unless something overflows.
#[inline]
fn two_sum(x: f64, y: f64) -> (f64, f64) {
    let sum = x + y;
    let y_part = sum - x;
    let error = (x - (sum - y_part)) + (y - y_part);
    (sum, error)
}

/// x + y rounded down.
#[inline]
fn sum_down(x: f64, y: f64) -> f64 {
    let (sum, error) = two_sum(x, y);
    if error >= 0.0 && error.is_finite() {
        sum
    } else {
        sum.next_down()
    }
}

/// x + y rounded up.
#[inline]
fn sum_up(x: f64, y: f64) -> f64 {
    -sum_down(-x, -y)
}

/// From candidates for the ends, as computed to nearest; NaN (0·∞, ∞ − ∞) tells nothing.
#[inline]
fn outward(low: f64, high: f64) -> Interval {
    if low.is_nan() || high.is_nan() {
        return Interval::ENTIRE;
    }
    Interval {
        low: low.next_down(),
        high: high.next_up(),
    }
}

impl Ring for Interval {
    #[inline]
    fn add(&self, other: &Self) -> Self {
        let low = sum_down(self.low, other.low);
        let high = sum_up(self.high, other.high);
        if low.is_nan() || high.is_nan() {
            return Self::ENTIRE;
        }
        Self { low, high }
    }

    #[inline]
    fn sub(&self, other: &Self) -> Self {
        self.add(&Self {
            low: -other.high,
            high: -other.low,
        })
    }

    #[inline]
    fn mul(&self, other: &Self) -> Self {
        if *self == Self::ZERO || *other == Self::ZERO {
            return Self::ZERO;
        }
        let products = [
            self.low * other.low,
            self.low * other.high,
            self.high * other.low,
            self.high * other.high,
        ];
        if products.iter().any(|p| p.is_nan()) {
            return Self::ENTIRE;
        }
        let low = (products[0].min(products[1])).min(products[2].min(products[3]));
        let high = (products[0].max(products[1])).max(products[2].max(products[3]));
        outward(low, high)
    }

    #[inline]
    fn square(&self) -> Self {
        if *self == Self::ZERO {
            return Self::ZERO;
        }
        let (x, y) = (self.low.abs(), self.high.abs());
        let (near, far) = if x < y { (x, y) } else { (y, x) };
        let high = (far * far).next_up();
        if self.low <= 0.0 && self.high >= 0.0 {
            return Self { low: 0.0, high };
        }
        Self {
            low: (near * near).next_down(),
            high,
        }
    }
}
