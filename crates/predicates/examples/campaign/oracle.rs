//! The determinants by expansion into minors, over dashu's integers. No formula and no number type is shared
//! with the crate.
//!
//! All numbers of a case are multiples of one power of two: coordinates of its unit, weights of the unit's
//! square. Expanded along the column of the heights h, with O_i the orientation of all points but the i-th:
//!
//! ```text
//! in the plane   Σ (−1)^i h_i O_i        in space   −Σ (−1)^i h_i O_i
//! ```
//!
//! So O_i is, up to that sign, what raising the i-th point adds.

use dashu::{base::Sign as Signum, integer::IBig};
use glam::{DVec2, DVec3};
use pellicle_predicates::{Sign, lifted};
use std::{array::from_fn, cmp::Ordering, collections::BTreeMap};

pub fn sign(value: &IBig) -> Sign {
    match value.sign() {
        _ if *value == IBig::ZERO => Sign::Zero,
        Signum::Positive => Sign::Positive,
        Signum::Negative => Sign::Negative,
    }
}

/// value = mantissa · 2^exponent, with zero bits of the mantissa left where they are.
fn parts(value: f64) -> (i64, i32) {
    let bits = value.to_bits();
    let fraction = (bits & 0x000f_ffff_ffff_ffff) as i64;
    let biased = (bits >> 52 & 0x7ff) as i32;
    let magnitude = if biased == 0 {
        fraction
    } else {
        fraction + (1 << 52)
    };
    let signed = if value < 0.0 { -magnitude } else { magnitude };
    (signed, biased.max(1) - 1075)
}

/// The exponent of the last bit that is set, if any is.
fn last_bit(value: f64) -> Option<i32> {
    let (mantissa, exponent) = parts(value);
    (mantissa != 0).then(|| exponent + mantissa.trailing_zeros() as i32)
}

/// value / 2^unit, which is an integer.
fn in_units(value: f64, unit: i32) -> IBig {
    let (mantissa, exponent) = parts(value);
    let integer = IBig::from(mantissa);
    match usize::try_from(exponent - unit) {
        Ok(shift) => integer << shift,
        Err(_) => {
            let shift = (unit - exponent) as usize;
            debug_assert!(mantissa == 0 || integer.trailing_zeros() >= Some(shift));
            integer >> shift
        }
    }
}

/// The greatest unit of these coordinates and weights.
fn unit(coordinates: impl Iterator<Item = f64>, weights: &[f64]) -> i32 {
    let of_weights = weights
        .iter()
        .filter_map(|&w| last_bit(w))
        .map(|e| e.div_euclid(2));
    let of_points = coordinates.filter_map(last_bit);
    of_points.chain(of_weights).min().unwrap_or(0)
}

/// The sign of a determinant with a column of heights, and of its perturbations.
pub struct Lifted<const N: usize> {
    pub plain: Sign,
    /// With each lift raised by a power of one small number, less for smaller points.
    pub raised: Sign,
    /// With weights.
    pub power: Sign,
    pub power_raised: Sign,
    /// The orientation of all points but the last.
    pub orientation: Sign,
}

/// The sign of Σ h_i factor_i, and with the heights raised.
fn lifted<const N: usize>(
    heights: &[IBig; N],
    factors: &[IBig; N],
    compare: impl Fn(usize, usize) -> Ordering,
) -> (Sign, Sign) {
    let value: IBig = (0..N).map(|i| &heights[i] * &factors[i]).sum();
    let plain = sign(&value);
    if plain != Sign::Zero {
        return (plain, plain);
    }
    let mut order: [usize; N] = from_fn(|i| i);
    order.sort_by(|&i, &j| compare(j, i));
    // Points at one place are raised alike.
    let raised = order.chunk_by(|&i, &j| compare(i, j) == Ordering::Equal);
    let coefficients = raised.map(|alike| sign(&alike.iter().map(|&i| &factors[i]).sum()));
    let first = coefficients.into_iter().find(|&sign| sign != Sign::Zero);
    (plain, first.unwrap_or(Sign::Zero))
}

pub fn space(points: &[DVec3; 5], weights: &[f64; 5]) -> Lifted<5> {
    let unit = unit(points.iter().flat_map(|p| p.to_array()), weights);
    let p = points.map(|p| p.to_array().map(|c| in_units(c, unit)));
    let pair = |i: usize, j: usize| &p[i][0] * &p[j][1] - &p[i][1] * &p[j][0];
    let pairs: [[IBig; 5]; 5] =
        from_fn(|i| from_fn(|j| if i < j { pair(i, j) } else { IBig::ZERO }));
    let triple = |i: usize, j: usize, k: usize| {
        &p[i][2] * &pairs[j][k] - &p[j][2] * &pairs[i][k] + &p[k][2] * &pairs[i][j]
    };
    let factors = from_fn(|left_out| {
        let rest: Vec<usize> = (0..5).filter(|&i| i != left_out).collect();
        let [i, j, k, l] = [rest[0], rest[1], rest[2], rest[3]];
        let orientation = triple(j, k, l) - triple(i, k, l) + triple(i, j, l) - triple(i, j, k);
        if left_out % 2 == 0 {
            -orientation
        } else {
            orientation
        }
    });
    let heights = p.each_ref().map(|p| p.iter().map(|c| c * c).sum::<IBig>());
    let powers = from_fn(|i| &heights[i] - in_units(weights[i], 2 * unit));
    let compare = |i: usize, j: usize| lifted::lexicographic(points[i], points[j]);
    let (plain, raised) = self::lifted(&heights, &factors, compare);
    let (power, power_raised) = self::lifted(&powers, &factors, compare);
    Lifted {
        plain,
        raised,
        power,
        power_raised,
        orientation: -sign(&factors[4]),
    }
}

pub fn plane(points: &[DVec2; 4]) -> Lifted<4> {
    let unit = unit(points.iter().flat_map(|p| p.to_array()), &[]);
    let p = points.map(|p| p.to_array().map(|c| in_units(c, unit)));
    let pair = |i: usize, j: usize| &p[i][0] * &p[j][1] - &p[i][1] * &p[j][0];
    let factors = from_fn(|left_out| {
        let rest: Vec<usize> = (0..4).filter(|&i| i != left_out).collect();
        let [i, j, k] = [rest[0], rest[1], rest[2]];
        let orientation = pair(j, k) - pair(i, k) + pair(i, j);
        if left_out % 2 == 0 {
            orientation
        } else {
            -orientation
        }
    });
    let heights = p.each_ref().map(|p| p.iter().map(|c| c * c).sum::<IBig>());
    let compare = |i: usize, j: usize| lifted::lexicographic2d(points[i], points[j]);
    let (plain, raised) = self::lifted(&heights, &factors, compare);
    Lifted {
        plain,
        raised,
        power: plain,
        power_raised: raised,
        orientation: -sign(&factors[3]),
    }
}

/// The sign of |a − p|² − |b − p|².
pub fn compare_distance(p: DVec3, a: DVec3, b: DVec3) -> Sign {
    let unit = unit([p, a, b].iter().flat_map(|p| p.to_array()), &[]);
    let [p, a, b] = [p, a, b].map(|p| p.to_array().map(|c| in_units(c, unit)));
    // |a|² − |b|² − 2 p · (a − b)
    let terms = (0..3).map(|k| (&a[k] - &b[k]) * (&a[k] + &b[k] - &p[k] * IBig::from(2)));
    sign(&terms.sum())
}

/// A polynomial in ε: coefficients by exponent.
#[derive(Clone, Default)]
struct Polynomial(BTreeMap<u64, IBig>);

impl Polynomial {
    fn of(terms: impl IntoIterator<Item = (u64, IBig)>) -> Self {
        let mut polynomial = Self::default();
        terms
            .into_iter()
            .for_each(|(exponent, coefficient)| polynomial.add(exponent, coefficient));
        polynomial
    }

    fn add(&mut self, exponent: u64, coefficient: IBig) {
        *self.0.entry(exponent).or_default() += coefficient;
    }

    fn times(&self, other: &Self) -> Self {
        let mut product = Self::default();
        for (i, x) in &self.0 {
            for (j, y) in &other.0 {
                product.add(i + j, x * y);
            }
        }
        product
    }

    /// For all small enough ε > 0.
    fn sign(&self) -> Sign {
        self.0
            .values()
            .map(sign)
            .find(|&sign| sign != Sign::Zero)
            .unwrap_or(Sign::Zero)
    }
}

/// By Laplace's expansion along the first column.
fn determinant(rows: &[Vec<Polynomial>], column: usize) -> Polynomial {
    if rows.is_empty() {
        return Polynomial::of([(0, IBig::ONE)]);
    }
    let mut sum = Polynomial::default();
    for (i, row) in rows.iter().enumerate() {
        let mut rest = rows.to_vec();
        rest.remove(i);
        for (exponent, term) in row[column].times(&determinant(&rest, column + 1)).0 {
            sum.add(exponent, if i % 2 == 0 { term } else { -term });
        }
    }
    sum
}

/// Rows (x, …, |p|², 1) or without the lift, for coordinates that are polynomials.
fn determinant_of(points: Vec<Vec<Polynomial>>, lift: bool) -> Sign {
    let rows: Vec<Vec<Polynomial>> = points
        .into_iter()
        .map(|mut row| {
            if lift {
                let squares = row.iter().map(|c| c.times(c)).flat_map(|square| square.0);
                row.push(Polynomial::of(squares.collect::<Vec<_>>()));
            }
            row.push(Polynomial::of([(0, IBig::ONE)]));
            row
        })
        .collect();
    determinant(&rows, 0).sign()
}

/// The coordinates in a unit of which 1 is a multiple, and 1 in this unit.
fn with_one<const D: usize>(points: &[[f64; D]]) -> (Vec<[IBig; D]>, IBig) {
    let unit = unit(points.iter().flatten().copied().chain([1.0]), &[]);
    let points = points.iter().map(|p| p.map(|c| in_units(c, unit)));
    (points.collect(), in_units(1.0, unit))
}

/// Edelsbrunner and Mücke's perturbation: p + ε^(2^i) (i, i², i³).
pub fn displaced<const D: usize>(points: &[[f64; D]], indices: &[u32], lift: bool) -> Sign {
    let (points, one) = with_one(points);
    let moved = |(p, &index): (&[IBig; D], &u32)| {
        let coordinate = |k: usize| {
            let displacement = IBig::from(u64::from(index).pow(k as u32 + 1)) * &one;
            Polynomial::of([(0, p[k].clone()), (1 << index, displacement)])
        };
        (0..D).map(coordinate).collect()
    };
    let sign = determinant_of(points.iter().zip(indices).map(moved).collect(), lift);
    // In space the column of ones in the last place turns the sign of both determinants.
    if D == 3 { -sign } else { sign }
}

/// Alliez, Devillers and Snoeyink's: (x + εy, y + ε²x + ε³(x² + y²)).
pub fn moved(points: &[DVec2], lift: bool) -> Sign {
    let points: Vec<[f64; 2]> = points.iter().map(|p| p.to_array()).collect();
    let (points, one) = with_one(&points);
    let moved = |[x, y]: [IBig; 2]| {
        let square = &x * &x + &y * &y;
        let (x, y) = (x * &one, y * &one);
        vec![
            Polynomial::of([(0, x.clone()), (1, y.clone())]),
            Polynomial::of([(0, y), (2, x), (3, square)]),
        ]
    };
    determinant_of(points.into_iter().map(moved).collect(), lift)
}

#[cfg(test)]
mod tests {
    use super::*;
    use dashu::rational::RBig;

    /// Numbers in units are the rationals that dashu reads from the doubles itself.
    #[test]
    fn units_are_exact() {
        let mut random = crate::random::Random::new(5);
        for _ in 0..5000 {
            let (_, case) = crate::inputs::case(&mut random);
            for value in case
                .points
                .iter()
                .flat_map(|p| p.to_array())
                .chain(case.weights)
            {
                let Some(last) = last_bit(value) else {
                    continue;
                };
                for unit in [last, last - 3, -1074] {
                    let power = RBig::from(IBig::ONE << unit.unsigned_abs() as usize);
                    let scaled = RBig::from(in_units(value, unit));
                    let back = if unit < 0 {
                        scaled / power
                    } else {
                        scaled * power
                    };
                    assert_eq!(back, RBig::try_from(value).expect("a finite double"));
                }
            }
        }
    }
}
