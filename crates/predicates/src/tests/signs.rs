//! The public predicates: conventions, exactness, symmetry.

use super::{
    config,
    inputs::{plane, points, space},
    oracle,
    permutation::permutations,
};
use crate::{Sign, incircle, insphere, orient2d, orient3d};
use glam::{DVec2, DVec3};
use proptest::prelude::*;

#[test]
fn conventions_on_one_tetrahedron() {
    let [o, x, y, z] = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    assert_eq!(orient3d(o, x, y, z), Sign::Positive);
    assert_eq!(orient3d(o, y, x, z), Sign::Negative);
    assert_eq!(insphere(o, x, y, z, DVec3::splat(0.3)), Sign::Positive);
    assert_eq!(insphere(o, x, y, z, DVec3::splat(3.0)), Sign::Negative);
    assert_eq!(insphere(o, x, y, z, DVec3::ONE), Sign::Zero);
    let [o, x, y] = [DVec2::ZERO, DVec2::X, DVec2::Y];
    assert_eq!(orient2d(o, x, y), Sign::Positive);
    assert_eq!(incircle(o, x, y, DVec2::splat(0.3)), Sign::Positive);
    assert_eq!(incircle(o, x, y, DVec2::splat(3.0)), Sign::Negative);
    assert_eq!(incircle(o, x, y, DVec2::ONE), Sign::Zero);
}

/// NaN and infinity have no sign, but do no harm.
#[test]
fn non_finite_coordinates_do_not_panic() {
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let p = DVec3::new(bad, 1.0, bad);
        orient3d(p, DVec3::X, DVec3::Y, DVec3::Z);
        orient3d(DVec3::ZERO, DVec3::X, DVec3::Y, p);
        insphere(p, DVec3::X, DVec3::Y, DVec3::Z, DVec3::ONE);
        insphere(DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z, p);
        orient2d(p.truncate(), DVec2::X, DVec2::Y);
        incircle(p.truncate(), DVec2::X, DVec2::Y, DVec2::ONE);
    }
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn orient2d_is_exact(points in points()) {
        let p @ [a, b, c] = plane(&points);
        prop_assert_eq!(orient2d(a, b, c), oracle::sign(&oracle::orient2d(p)));
    }

    #[test]
    fn orient3d_is_exact(points in points()) {
        let p @ [a, b, c, d] = space(&points);
        prop_assert_eq!(orient3d(a, b, c, d), oracle::sign(&oracle::orient3d(p)));
    }

    #[test]
    fn incircle_is_exact(points in points()) {
        let p @ [a, b, c, d] = plane(&points);
        prop_assert_eq!(incircle(a, b, c, d), oracle::sign(&oracle::incircle(p)));
    }

    #[test]
    fn insphere_is_exact(points in points()) {
        let p @ [a, b, c, d, e] = space(&points);
        prop_assert_eq!(insphere(a, b, c, d, e), oracle::sign(&oracle::insphere(p)));
    }

    #[test]
    fn every_permutation_turns_the_sign(points in points()) {
        let [a, b, c, d] = plane(&points);
        let (sign2, sign_circle) = (orient2d(a, b, c), incircle(a, b, c, d));
        for (p, parity) in permutations([a, b, c]) {
            prop_assert_eq!(orient2d(p[0], p[1], p[2]), parity * sign2);
        }
        for (p, parity) in permutations([a, b, c, d]) {
            prop_assert_eq!(incircle(p[0], p[1], p[2], p[3]), parity * sign_circle);
        }
        let [a, b, c, d, e] = points;
        let (sign3, sign_sphere) = (orient3d(a, b, c, d), insphere(a, b, c, d, e));
        for (p, parity) in permutations([a, b, c, d]) {
            prop_assert_eq!(orient3d(p[0], p[1], p[2], p[3]), parity * sign3);
        }
        for (p, parity) in permutations([a, b, c, d, e]) {
            prop_assert_eq!(insphere(p[0], p[1], p[2], p[3], p[4]), parity * sign_sphere);
        }
    }
}
