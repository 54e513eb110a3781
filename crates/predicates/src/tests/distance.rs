//! The comparison of distances against exact integers.

use super::{config, inputs::points, oracle::units};
use crate::{Sign, compare_distance, distance::filtered, exact, fixed};
use dashu::integer::IBig;
use glam::DVec3;
use proptest::prelude::*;
use std::cmp::Ordering;

fn truth(p: DVec3, a: DVec3, b: DVec3) -> Ordering {
    let square = |q: DVec3| -> IBig {
        let difference = |axis: usize| units(q[axis]) - units(p[axis]);
        (0..3).map(|axis| difference(axis) * difference(axis)).sum()
    };
    square(a).cmp(&square(b))
}

fn sign(ordering: Ordering) -> Sign {
    Sign::of(f64::from(ordering as i8))
}

/// Two points at equal distance from the first, or nearly so: images of one vector of integers, scaled, and
/// then moved by a few units in the last place.
fn near_ties() -> impl Strategy<Value = [DVec3; 3]> {
    let size = prop_oneof![Just(9_i32), Just(2_000), Just(1 << 28)];
    let vector = size.prop_flat_map(|n| [-n..=n, -n..=n, -n..=n]);
    let center = [-9..=9_i32, -9..=9, -9..=9];
    let exponent = prop_oneof![
        Just(0),
        -20..=20,
        -1074..=-1000,
        -560..=-440,
        Just(900),
        Just(990)
    ];
    let nudge = [-2..=2_i32, -2..=2, -2..=2];
    let nudged = prop::bool::weighted(0.7);
    (
        vector,
        center,
        0..6_usize,
        0..8_u32,
        exponent,
        nudge,
        nudged,
    )
        .prop_map(|(v, center, order, signs, exponent, nudge, nudged)| {
            let order = [
                [0, 1, 2],
                [0, 2, 1],
                [1, 0, 2],
                [1, 2, 0],
                [2, 0, 1],
                [2, 1, 0],
            ][order];
            let image = [0, 1, 2].map(|k| v[order[k]] * if signs >> k & 1 == 1 { -1 } else { 1 });
            let at = |offset: [i32; 3]| {
                let half = exponent / 2;
                let p = DVec3::from([0, 1, 2].map(|k| f64::from(center[k] + offset[k])));
                p * f64::powi(2.0, half) * f64::powi(2.0, exponent - half)
            };
            let mut b = at(image);
            for axis in 0..3 {
                for _ in 0..if nudged { nudge[axis].abs() } else { 0 } {
                    b[axis] = if nudge[axis] > 0 {
                        b[axis].next_up()
                    } else {
                        b[axis].next_down()
                    };
                }
            }
            [at([0; 3]), at(v), b]
        })
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn compare_distance_is_exact([p, a, b, c, d] in points()) {
        for [p, a, b] in [[p, a, b], [a, c, d], [d, p, b], [c, c, d]] {
            prop_assert_eq!(compare_distance(p, a, b), truth(p, a, b));
        }
    }

    #[test]
    fn compare_distance_is_exact_at_near_ties([p, a, b] in near_ties()) {
        let truth = truth(p, a, b);
        prop_assert_eq!(compare_distance(p, a, b), truth);
        prop_assert_eq!(compare_distance(p, b, a), truth.reverse());
    }

    #[test]
    fn each_stage_of_compare_distance_is_right([p, a, b] in near_ties()) {
        let truth = truth(p, a, b);
        prop_assert!(filtered(p, a, b).is_none_or(|ordering| ordering == truth));
        prop_assert!(fixed::compare_distance(p, a, b).is_none_or(|s| s == sign(truth)));
        prop_assert_eq!(exact::compare_distance(p, a, b), sign(truth));
    }
}

#[test]
fn distances_whose_squares_overflow_or_underflow() {
    let largest = DVec3::splat(f64::MAX);
    assert_eq!(
        compare_distance(-largest, largest, largest.with_x(0.0)),
        Ordering::Greater
    );
    assert_eq!(
        compare_distance(-largest, largest, largest),
        Ordering::Equal
    );
    let tiny = f64::from_bits(1);
    let [x, y] = [DVec3::X * tiny, DVec3::Y * tiny];
    assert_eq!(compare_distance(DVec3::ZERO, x, y), Ordering::Equal);
    assert_eq!(compare_distance(x, y, DVec3::ZERO), Ordering::Greater);
    // A difference that only bits 2000 places apart decide.
    assert_eq!(
        compare_distance(
            x,
            largest.with_y(0.0),
            largest.with_y(0.0).with_x(-f64::MAX)
        ),
        Ordering::Less
    );
}

/// The whole range between what the filter decides and what is a tie is walked through.
#[test]
fn the_filter_hands_over_what_is_close() {
    let p = DVec3::new(0.1, 0.2, 0.3);
    let a = DVec3::new(1.3, 0.7, -0.4);
    let mut decided = [0; 2];
    for steps in 0..200_u64 {
        let b = DVec3::new(f64::from_bits(a.x.to_bits() + steps), a.y, a.z);
        assert_eq!(compare_distance(p, a, b), truth(p, a, b), "{steps}");
        decided[usize::from(filtered(p, a, b).is_some())] += 1;
    }
    assert!(decided.iter().all(|&count| count > 4), "{decided:?}");
}
