//! Each stage alone: a filter never lies, an interval contains the value, the exact routes agree.

use super::{
    config,
    inputs::{Points, plane, points, space},
    oracle,
};
use crate::{
    Sign, StaticFilter, StaticFilter2, determinant::Ring, exact, filter, fixed, integer::Integer,
    interval::Interval, lattice, stages, statistics::Stage, unfiltered,
};
use dashu::integer::IBig;
use glam::DVec3;
use proptest::prelude::*;

/// An undecided stage says nothing; a decided one must be right.
fn right(decision: Option<Sign>, truth: Sign) -> bool {
    decision.is_none_or(|sign| sign == truth)
}

/// Infinite ends contain everything on their side.
fn contains(interval: Interval, value: &IBig, degree: usize) -> bool {
    let above = interval.low == f64::NEG_INFINITY
        || oracle::units_of_degree(interval.low, degree) <= *value;
    let below =
        interval.high == f64::INFINITY || *value <= oracle::units_of_degree(interval.high, degree);
    above && below
}

fn bounds(points: &Points) -> (DVec3, DVec3) {
    let min = points
        .iter()
        .copied()
        .reduce(DVec3::min)
        .expect("five points");
    let max = points
        .iter()
        .copied()
        .reduce(DVec3::max)
        .expect("five points");
    (min, max)
}

fn any_double() -> BoxedStrategy<f64> {
    let exponent = -1074..1024_i32;
    prop_oneof![
        any::<u64>()
            .prop_map(f64::from_bits)
            .prop_filter("finite", |v| v.is_finite()),
        (-4..=4_i32).prop_map(f64::from),
        (-1.0..1.0, exponent).prop_map(|(m, e): (f64, i32)| {
            m * f64::powi(2.0, e / 2) * f64::powi(2.0, e - e / 2)
        }),
        Just(f64::MAX),
        Just(-f64::MAX),
        Just(f64::from_bits(1)),
    ]
    .boxed()
}

fn any_interval() -> BoxedStrategy<Interval> {
    prop_oneof![
        any_double().prop_map(Interval::exactly),
        (any_double(), any_double()).prop_map(|(x, y)| Interval {
            low: x.min(y),
            high: x.max(y)
        }),
    ]
    .boxed()
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn orient2d_stages(points in points()) {
        let p @ [a, b, c] = plane(&points);
        let value = oracle::orient2d(p);
        let truth = oracle::sign(&value);
        let (min, max) = bounds(&points);
        let fixed = StaticFilter2::from_bounds(min.truncate(), max.truncate());
        prop_assert!(right(fixed.orient2d_filtered(a, b, c), truth));
        prop_assert!(right(filter::orient2d(a, b, c), truth));
        prop_assert!(contains(unfiltered::interval_orient2d(a, b, c), &value, 2));
        prop_assert!(right(lattice::orient2d(a, b, c), truth));
        prop_assert!(right(fixed::orient2d(a, b, c), truth));
        prop_assert_eq!(exact::orient2d(a, b, c), truth);
        prop_assert_eq!(fixed.orient2d(a, b, c), truth);
    }

    #[test]
    fn orient3d_stages(points in points()) {
        let p @ [a, b, c, d] = space(&points);
        let value = oracle::orient3d(p);
        let truth = oracle::sign(&value);
        let (min, max) = bounds(&points);
        let fixed = StaticFilter::from_bounds(min, max);
        prop_assert!(right(fixed.orient3d_filtered(a, b, c, d), truth));
        prop_assert!(right(filter::orient3d(a, b, c, d), truth));
        prop_assert!(contains(unfiltered::interval_orient3d(a, b, c, d), &value, 3));
        prop_assert!(right(lattice::orient3d(a, b, c, d), truth));
        prop_assert!(right(fixed::orient3d(a, b, c, d), truth));
        prop_assert_eq!(exact::orient3d(a, b, c, d), truth);
        prop_assert_eq!(fixed.orient3d(a, b, c, d), truth);
    }

    #[test]
    fn incircle_stages(points in points()) {
        let p @ [a, b, c, d] = plane(&points);
        let value = oracle::incircle(p);
        let truth = oracle::sign(&value);
        let (min, max) = bounds(&points);
        let fixed = StaticFilter2::from_bounds(min.truncate(), max.truncate());
        prop_assert!(right(fixed.incircle_filtered(a, b, c, d), truth));
        prop_assert!(right(filter::incircle(a, b, c, d), truth));
        prop_assert!(contains(unfiltered::interval_incircle(a, b, c, d), &value, 4));
        prop_assert!(right(lattice::incircle(a, b, c, d), truth));
        prop_assert!(right(fixed::incircle(a, b, c, d), truth));
        prop_assert_eq!(exact::incircle(a, b, c, d), truth);
        prop_assert_eq!(fixed.incircle(a, b, c, d), truth);
    }

    #[test]
    fn insphere_stages(points in points()) {
        let p @ [a, b, c, d, e] = space(&points);
        let value = oracle::insphere(p);
        let truth = oracle::sign(&value);
        let (min, max) = bounds(&points);
        let fixed = StaticFilter::from_bounds(min, max);
        prop_assert!(right(fixed.insphere_filtered(a, b, c, d, e), truth));
        prop_assert!(right(filter::insphere(a, b, c, d, e), truth));
        prop_assert!(contains(unfiltered::interval_insphere(a, b, c, d, e), &value, 5));
        prop_assert!(right(lattice::insphere(a, b, c, d, e), truth));
        prop_assert!(right(fixed::insphere(a, b, c, d, e), truth));
        prop_assert_eq!(exact::insphere(a, b, c, d, e), truth);
        prop_assert_eq!(fixed.insphere(a, b, c, d, e), truth);
    }

    /// One point far away, so that the spreads say nothing, and three so near, in a plane with the last one, that products of
    /// their coordinates underflow.
    #[test]
    fn monomials_that_underflow_are_not_trusted(
        near in prop::array::uniform3((-64..64_i32, -64..64_i32, Just(0)).prop_map(|(x, y, z)| [x, y, z])),
        far in prop::array::uniform3(1..64_i32),
        exponent in 255..285_i32,
    ) {
        let scaled = |p: [i32; 3], scale: f64| DVec3::from_array(p.map(|c| f64::from(c) * scale));
        let [a, b, c] = near.map(|p| scaled(p, 2.0_f64.powi(-exponent)));
        let d = scaled(far, 1.0);
        let truth = exact::insphere(a, b, c, d, DVec3::ZERO);
        prop_assert!(right(filter::insphere(a, b, c, d, DVec3::ZERO), truth));
    }

    /// The ends of the operands are numbers they contain, so all results of ends must be contained.
    #[test]
    fn interval_operations_contain_their_results(x in any_interval(), y in any_interval()) {
        for p in [x.low, x.high].map(oracle::units) {
            for q in [y.low, y.high].map(oracle::units) {
                prop_assert!(contains(x.add(&y), &(&p + &q), 1));
                prop_assert!(contains(x.sub(&y), &(&p - &q), 1));
                prop_assert!(contains(x.mul(&y), &(&p * &q), 2));
            }
            prop_assert!(contains(x.square(), &(&p * &p), 2));
        }
        if x.low <= 0.0 && x.high >= 0.0 {
            prop_assert!(contains(x.square(), &IBig::ZERO, 2));
        }
    }

    /// Sums and products of shifted integers, by way of the sign of their difference to the oracle's.
    #[test]
    fn integers_are_a_ring(
        x in any::<i64>(), y in any::<i64>(), z in any::<i64>(),
        shifts in proptest::array::uniform3(0..300_u32),
    ) {
        let ours = |v: i64, k: usize| Integer::shifted(v, shifts[k]);
        let theirs = |v: i64, k: usize| IBig::from(v) << shifts[k] as usize;
        let value = ours(x, 0).mul(&ours(y, 1)).add(&ours(z, 2));
        let expected = theirs(x, 0) * theirs(y, 1) + theirs(z, 2);
        prop_assert_eq!(value.sign(), oracle::sign(&expected));
        // The same number from 62-bit digits.
        let mut rest = expected.clone();
        let mut sum = Integer::ZERO;
        let digit = IBig::ONE << 62;
        for position in 0..20 {
            let low: i64 = (&rest % &digit).try_into().expect("62 bits");
            sum = sum.add(&Integer::shifted(low, 62 * position));
            rest /= &digit;
        }
        prop_assert_eq!(value.sub(&sum), Integer::ZERO);
        prop_assert_eq!(value, sum);
    }
}

proptest! {
    #![proptest_config(config())]

    /// What a stage alone says is the predicate's sign, or nothing; the last always says it.
    #[test]
    fn public_stages_are_right(points in points()) {
        let p @ [a, b, c, d, e] = space(&points);
        let truth = oracle::sign(&oracle::insphere(p));
        let orientation = oracle::sign(&oracle::orient3d([a, b, c, d]));
        for stage in Stage::ALL {
            prop_assert!(right(stages::insphere(stage, a, b, c, d, e), truth), "{stage:?}");
            prop_assert!(right(stages::orient3d(stage, a, b, c, d), orientation), "{stage:?}");
        }
        prop_assert_eq!(stages::insphere(Stage::AnyWidth, a, b, c, d, e), Some(truth));
        prop_assert_eq!(stages::orient3d(Stage::AnyWidth, a, b, c, d), Some(orientation));
    }
}
