//! Simulation of Simplicity (Edelsbrunner and Mücke 1990): every point moves, by its index.
//!
//! The point of index i is displaced by ε^(2^i) (i, i²), in space by ε^(2^i) (i, i², i³): a point of the
//! moment curve, on which no three directions of space (two of the plane) depend on each other. The sign is
//! the limit for ε → 0⁺ and is never zero when the indices differ, even where points coincide.
//!
//! *Why never zero.* Let the indices be i < j < k < l. In the in-circle determinant take the squared
//! displacement from the lift of l, the displacements of k and j, and none of i: the coefficient is
//! ±(l² + l⁴) det[(j, j²), (k, k²)] ≠ 0, and no other choice has the exponent 2·2^l + 2^k + 2^j. Likewise
//! for the others.
//!
//! The general method, and the heavy one: the whole polynomial is expanded. It depends on the numbering of
//! the points, and it moves points out of a common plane, which makes flat tetrahedra: for Delaunay
//! triangulations take [`lifted`](crate::lifted).

use crate::{
    Sign,
    determinant::{self, Ring},
    integer::Integer,
    polynomial::{Binary, Polynomial, integers},
    statistics::{Predicate, Stage, decided},
};
use glam::{DVec2, DVec3};
use std::array::from_fn;

type Coordinate = Polynomial<Binary>;

/// p + ε^(2^i) (i, i², i³), in units of 2^−shift.
fn displaced<const D: usize, const N: usize>(
    points: [[f64; D]; N],
    indices: [u32; N],
) -> [[Coordinate; D]; N] {
    let (points, shift) = integers(points);
    from_fn(|n| {
        let index = Integer::shifted(i64::from(indices[n]), 0);
        let mut power = Integer::shifted(1, shift);
        from_fn(|k| {
            power = power.mul(&index);
            let displacement = Polynomial::term(power.clone(), Binary::power(indices[n]));
            Polynomial::constant(points[n][k].clone()).add(&displacement)
        })
    })
}

/// [`orient2d`](crate::orient2d) of the displaced points; never zero when the indices differ.
pub fn orient2d(points: [DVec2; 3], indices: [u32; 3]) -> Sign {
    let [a, b, c] = points;
    match crate::orient2d(a, b, c) {
        Sign::Zero => {}
        sign => return sign,
    }
    decided(Predicate::Orient2d, Stage::Perturbation);
    let [a, b, c] = displaced(points.map(|p| p.to_array()), indices);
    let [a, b] = [a, b].map(|p| determinant::translated(&p, &c));
    determinant::orient2d(&a, &b).sign()
}

/// [`orient3d`](crate::orient3d) of the displaced points; never zero when the indices differ.
///
/// ```
/// use glam::DVec3;
/// use pellicle_predicates::{Sign, sos};
///
/// // Four times the same point, and still a tetrahedron.
/// assert_eq!(sos::orient3d([DVec3::ONE; 4], [1, 2, 3, 4]), Sign::Negative);
/// assert_eq!(sos::orient3d([DVec3::ONE; 4], [2, 1, 3, 4]), Sign::Positive);
/// ```
pub fn orient3d(points: [DVec3; 4], indices: [u32; 4]) -> Sign {
    let [a, b, c, d] = points;
    match crate::orient3d(a, b, c, d) {
        Sign::Zero => {}
        sign => return sign,
    }
    decided(Predicate::Orient3d, Stage::Perturbation);
    let [a, b, c, d] = displaced(points.map(|p| p.to_array()), indices);
    let [a, b, c] = [a, b, c].map(|p| determinant::translated(&p, &d));
    determinant::orient3d(&a, &b, &c).sign()
}

/// [`incircle`](crate::incircle) of the displaced points; never zero when the indices differ. The sign
/// turns with the *perturbed* orientation of the first three.
pub fn incircle(points: [DVec2; 4], indices: [u32; 4]) -> Sign {
    let [a, b, c, d] = points;
    match crate::incircle(a, b, c, d) {
        Sign::Zero => {}
        sign => return sign,
    }
    decided(Predicate::InCircle, Stage::Perturbation);
    let [a, b, c, d] = displaced(points.map(|p| p.to_array()), indices);
    let [a, b, c] = [a, b, c].map(|p| determinant::translated(&p, &d));
    determinant::incircle(&a, &b, &c).sign()
}

/// [`insphere`](crate::insphere) of the displaced points; never zero when the indices differ. The sign
/// turns with the *perturbed* orientation of the first four.
pub fn insphere(points: [DVec3; 5], indices: [u32; 5]) -> Sign {
    let [a, b, c, d, e] = points;
    match crate::insphere(a, b, c, d, e) {
        Sign::Zero => {}
        sign => return sign,
    }
    decided(Predicate::InSphere, Stage::Perturbation);
    let [a, b, c, d, e] = displaced(points.map(|p| p.to_array()), indices);
    let [a, b, c, d] = [a, b, c, d].map(|p| determinant::translated(&p, &e));
    determinant::insphere(&a, &b, &c, &d).sign()
}
