//! Perturbing the world, in the plane: all points are moved by one map that depends on ε
//! (Alliez et al. 2000).
//!
//! ```text
//! (x, y) ↦ (x + εy, y + ε²x + ε³(x² + y²))
//! ```
//!
//! The sign is the limit for ε → 0⁺. No index is needed: the result depends on the points alone, and it is
//! never zero for distinct points. With t = x² + y² the orientation becomes
//!
//! ```text
//! (1 − ε³) |1 x y| + ε³ |1 x t| + ε⁴ |1 y t|
//! ```
//!
//! and vanishes only if the lifted points are collinear in every projection, which no three points of a
//! paraboloid are. The in-circle polynomial starts with
//!
//! ```text
//! |1 x y t| + 2ε |1 x y xy| + ε² (|1 x y y²| + 2 |1 x y xy|) + …
//! ```
//!
//! and goes on to degree 10. For four collinear points all terms shown vanish, and the later ones are
//! needed: on the line y = 0 the first that does not is 2ε⁸ |1 x x² x³|.
//!
//! Orientations are perturbed too, so triangles may come out flat: for Delaunay triangulations take
//! [`lifted`](crate::lifted).

use crate::{
    Sign,
    determinant::{self, Ring},
    integer::Integer,
    polynomial::{Polynomial, integers},
    statistics::{Predicate, Stage, decided},
};
use glam::DVec2;

/// The images of the points. Coordinates are integers in units of 2^−shift; times 2^shift, they share the
/// unit of x² + y².
fn moved<const N: usize>(points: [DVec2; N]) -> [[Polynomial<u32>; 2]; N] {
    let (points, shift) = integers(points.map(|p| p.to_array()));
    let scale = Integer::shifted(1, shift);
    points.map(|[x, y]| {
        let lift = x.square().add(&y.square());
        let [x, y] = [x, y].map(|c| c.mul(&scale));
        let term = |value: &Integer, exponent| Polynomial::term(value.clone(), exponent);
        [
            term(&x, 0).add(&term(&y, 1)),
            term(&y, 0).add(&term(&x, 2)).add(&term(&lift, 3)),
        ]
    })
}

/// [`orient2d`](crate::orient2d) of the moved points; never zero for distinct points.
///
/// ```
/// use glam::DVec2;
/// use pellicle_predicates::{Sign, world};
///
/// // The x-axis becomes a parabola that opens upwards.
/// let [a, b, c] = [0.0, 1.0, 2.0].map(|x| DVec2::new(x, 0.0));
/// assert_eq!(world::orient2d(a, b, c), Sign::Positive);
/// ```
pub fn orient2d(a: DVec2, b: DVec2, c: DVec2) -> Sign {
    match crate::orient2d(a, b, c) {
        Sign::Zero => {}
        sign => return sign,
    }
    decided(Predicate::Orient2d, Stage::Perturbation);
    let [a, b, c] = moved([a, b, c]);
    let [a, b] = [a, b].map(|p| determinant::translated(&p, &c));
    determinant::orient2d(&a, &b).sign()
}

/// [`incircle`](crate::incircle) of the moved points; never zero for distinct points. The sign turns with
/// the *perturbed* orientation of the first three.
pub fn incircle(a: DVec2, b: DVec2, c: DVec2, d: DVec2) -> Sign {
    match crate::incircle(a, b, c, d) {
        Sign::Zero => {}
        sign => return sign,
    }
    decided(Predicate::InCircle, Stage::Perturbation);
    let [a, b, c, d] = moved([a, b, c, d]);
    let [a, b, c] = [a, b, c].map(|p| determinant::translated(&p, &d));
    determinant::incircle(&a, &b, &c).sign()
}
