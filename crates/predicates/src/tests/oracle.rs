//! The determinants in homogeneous coordinates over dashu's exact numbers, untranslated: nothing is shared
//! with the code under test.
//!
//! Every finite double is a multiple of 2⁻¹⁰⁷⁴, so rationals with that denominator are integers.

use crate::Sign;
use dashu::{base::BitTest, integer::IBig, rational::RBig};
use glam::{DVec2, DVec3};

/// value · 2¹⁰⁷⁴.
pub(super) fn units(value: f64) -> IBig {
    let rational = RBig::try_from(value).expect("a finite double");
    let power = rational.denominator().bit_len() - 1;
    rational.numerator().clone() << (1074 - power)
}

/// value · 2^(1074 · degree): comparable with the value of a determinant of that degree.
pub(super) fn units_of_degree(value: f64, degree: usize) -> IBig {
    units(value) << (1074 * (degree - 1))
}

pub(super) fn sign(value: &IBig) -> Sign {
    match value.cmp(&IBig::ZERO) {
        std::cmp::Ordering::Less => Sign::Negative,
        std::cmp::Ordering::Equal => Sign::Zero,
        std::cmp::Ordering::Greater => Sign::Positive,
    }
}

/// Laplace expansion along the first row.
pub(super) fn determinant(rows: &[Vec<IBig>]) -> IBig {
    if rows.is_empty() {
        return IBig::ONE;
    }
    let mut sum = IBig::ZERO;
    for column in 0..rows.len() {
        if rows[0][column] == IBig::ZERO {
            continue;
        }
        let minor: Vec<Vec<IBig>> = rows[1..]
            .iter()
            .map(|row| {
                let mut row = row.clone();
                row.remove(column);
                row
            })
            .collect();
        let term = &rows[0][column] * determinant(&minor);
        sum = if column % 2 == 0 {
            sum + term
        } else {
            sum - term
        };
    }
    sum
}

/// (1, x, …), the row of an orientation.
fn affine(p: &[f64]) -> Vec<IBig> {
    std::iter::once(IBig::ONE)
        .chain(p.iter().map(|&c| units(c)))
        .collect()
}

/// (x, …, |p|², 1), the row of an in-sphere test.
fn lifted(p: &[f64]) -> Vec<IBig> {
    let mut row: Vec<IBig> = p.iter().map(|&c| units(c)).collect();
    let lift = row.iter().map(|c| c * c).sum();
    row.push(lift);
    row.push(IBig::ONE);
    row
}

pub(super) fn orient2d(p: [DVec2; 3]) -> IBig {
    determinant(&p.map(|p| affine(&p.to_array())))
}

pub(super) fn orient3d(p: [DVec3; 4]) -> IBig {
    determinant(&p.map(|p| affine(&p.to_array())))
}

pub(super) fn incircle(p: [DVec2; 4]) -> IBig {
    determinant(&p.map(|p| lifted(&p.to_array())))
}

/// The weights count in the square of the coordinates' unit.
pub(super) fn power_test(p: [DVec3; 5], weights: [f64; 5]) -> IBig {
    -determinant(&std::array::from_fn::<_, 5, _>(|i| {
        let mut row = lifted(&p[i].to_array());
        row[3] -= units_of_degree(weights[i], 2);
        row
    }))
}

/// The lifted determinant is negative for points inside a positive tetrahedron's sphere.
pub(super) fn insphere(p: [DVec3; 5]) -> IBig {
    -determinant(&p.map(|p| lifted(&p.to_array())))
}
