//! Quotients of long numbers, rounded correctly to doubles without a long division.
//!
//! Of dividend and divisor the first 64 digits x and w are taken, 2⁶³ ≤ x, w < 2⁶⁴, and of 2¹²⁷ / w the
//! whole part r, at most 2⁶⁴ − 1. With what was cut off, θ and φ in [0, 1), the quotient is
//!
//! ```text
//! T = 2¹²⁷ (x + θ) / (w + φ)     times a power of two, and     P = x r     stands for it.
//! T − P < 2¹²⁷ (x + 1) / w − x (2¹²⁷ / w − 1) = 2¹²⁷ / w + x ≤ 2⁶⁵
//! P − T < 2¹²⁷ x / w − 2¹²⁷ x / (w + 1) < 2¹²⁷ x / w² ≤ 2 x ≤ 2⁶⁵
//! ```
//!
//! P has 127 or 128 digits, so half a unit in the last place of a double is at least 2⁷³. Unless P is within
//! 2⁶⁵ of a multiple of that (one case in a hundred, and the ties and the exact doubles), both are rounded
//! alike. Else the quotient is compared with this multiple, exactly.

use super::dyadic::{Dyadic, View, sum};
use crate::Sign;

/// A positive divisor, prepared.
pub(super) struct Divisor<'a> {
    divisor: View<'a>,
    reciprocal: u64,
}

/// A double, and whether it is the very quotient.
pub(super) struct Rounded {
    pub(super) value: f64,
    pub(super) is_exact: bool,
}

const ERROR: u128 = 1 << 65;
/// Of the least subnormal double.
const LEAST_EXPONENT: i64 = -1074;

impl<'a> Divisor<'a> {
    pub(super) fn new(divisor: View<'a>) -> Self {
        let reciprocal = (1_u128 << 127) / u128::from(divisor.leading().max(1));
        Self {
            divisor,
            reciprocal: u64::try_from(reciprocal).unwrap_or(u64::MAX),
        }
    }

    /// x / divisor · 2^unit to nearest, ties to even; never −0, infinite when too large.
    pub(super) fn quotient(&self, x: View, unit: i32) -> Rounded {
        if x.is_zero() {
            return Rounded {
                value: 0.0,
                is_exact: true,
            };
        }
        let p = u128::from(x.leading()) * u128::from(self.reciprocal);
        // |quotient| = p · 2^scale, nearly.
        let scale = x.order() - self.divisor.order() - 127 + i64::from(unit);
        let exponent = (i64::from(p.ilog2()) + scale - 52).max(LEAST_EXPONENT);
        let (mantissa, is_exact) = match exponent - 1 - scale {
            // Less than half the least subnormal.
            129.. => (0, false),
            half => {
                let (count, rest, missing) = match 1_u128.checked_shl(half as u32) {
                    Some(half_unit) => {
                        let rest = p & (half_unit - 1);
                        ((p >> half) as u64, rest, half_unit - rest)
                    }
                    None => (0, p, p.wrapping_neg()),
                };
                if rest <= ERROR {
                    self.decided(x, unit, count, exponent)
                } else if missing <= ERROR {
                    self.decided(x, unit, count + 1, exponent)
                } else {
                    (count.div_ceil(2), false)
                }
            }
        };
        let value = scaled(mantissa, exponent);
        Rounded {
            value: if x.sign() == Sign::Negative && value != 0.0 {
                -value
            } else {
                value
            },
            is_exact,
        }
    }

    /// The mantissa, and whether it is exact, of a quotient near `halves` halves of 2^exponent.
    #[cold]
    fn decided(&self, x: View, unit: i32, halves: u64, exponent: i64) -> (u64, bool) {
        let power = Dyadic::new(false, 1, (i64::from(unit) - exponent + 1) as i32);
        let count = Dyadic::new(false, u128::from(halves), 0);
        let difference = sum([(x.magnitude(), power.view()), (-count.view(), self.divisor)]);
        match difference.sign() {
            Sign::Negative => (halves / 2, false),
            Sign::Positive => (halves.div_ceil(2), false),
            Sign::Zero if halves.is_multiple_of(2) => (halves / 2, true),
            // A tie: to the even one of the two neighbours.
            Sign::Zero => {
                let below = halves / 2;
                (below + below % 2, false)
            }
        }
    }
}

/// mantissa · 2^exponent, which is a double or too large for one.
fn scaled(mantissa: u64, exponent: i64) -> f64 {
    let power = match exponent {
        1024.. => f64::INFINITY,
        -1022.. => f64::from_bits(((exponent + 1023) as u64) << 52),
        _ => f64::from_bits(1 << (exponent - LEAST_EXPONENT)),
    };
    if mantissa == 0 {
        0.0
    } else {
        mantissa as f64 * power
    }
}
