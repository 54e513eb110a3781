//! The power test: every stage, the perturbation, and what it shares with the in-sphere test.

use super::{
    config,
    inputs::{Points, points, weighted_points},
    oracle,
    permutation::permutations,
};
use crate::{
    Sign, StaticFilter, exact, filter, fixed, insphere, lattice, lifted, orient3d, power_test,
    unfiltered,
};
use dashu::integer::IBig;
use glam::DVec3;
use proptest::{prelude::*, sample::subsequence};
use std::{array::from_fn, cmp::Ordering};

const TETRAHEDRON: [DVec3; 4] = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];

fn call(points: Points, weights: [f64; 5]) -> Sign {
    let [a, b, c, d, e] = points;
    power_test(a, b, c, d, e, weights)
}

fn perturbed(points: Points, weights: [f64; 5]) -> Sign {
    let [a, b, c, d, e] = points;
    lifted::power_test(a, b, c, d, e, weights)
}

/// The static filter of the points' box and the weights' interval.
fn filter_of(points: &Points, weights: &[f64; 5]) -> StaticFilter {
    let min = points.iter().copied().fold(points[0], DVec3::min);
    let max = points.iter().copied().fold(points[0], DVec3::max);
    let least = weights.iter().copied().fold(f64::INFINITY, f64::min);
    let greatest = weights.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    StaticFilter::from_bounds(min, max).with_weights(least, greatest)
}

/// The sign of the determinant with the lifts raised, by its definition: with η a positive number that is
/// smaller than any ratio of the coefficients, the point of rank i of n is raised by η^(n − i).
fn raised(points: Points, weights: [f64; 5]) -> Sign {
    let value = oracle::power_test(points, weights);
    let mut order = [0, 1, 2, 3, 4];
    order.sort_by(|&i, &j| lifted::lexicographic(points[j], points[i]));
    let mut sign = oracle::sign(&value);
    for pair in 0..5 {
        if sign != Sign::Zero {
            return sign;
        }
        let equals =
            |j: usize| lifted::lexicographic(points[order[pair]], points[j]) == Ordering::Equal;
        // Equal points are raised alike: the sum of their factors.
        let factors = (0..5).filter(|&j| equals(j)).map(|j| {
            let rows: Vec<Vec<IBig>> = (0..5)
                .filter(|&i| i != j)
                .map(|i| {
                    let row = points[i].to_array().map(oracle::units);
                    row.into_iter().chain([IBig::ONE]).collect()
                })
                .collect();
            // The cofactor of the lift, in column 3 of row j; the test has the opposite sign.
            let minor = oracle::determinant(&rows);
            if (j + 3) % 2 == 0 { -minor } else { minor }
        });
        sign = oracle::sign(&factors.sum());
    }
    sign
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn power_test_is_exact((points, weights) in weighted_points()) {
        let truth = oracle::sign(&oracle::power_test(points, weights));
        prop_assert_eq!(call(points, weights), truth);
    }

    #[test]
    fn power_test_stages((points, weights) in weighted_points()) {
        let [a, b, c, d, e] = points;
        let value = oracle::power_test(points, weights);
        let truth = oracle::sign(&value);
        let right = |decision: Option<Sign>| decision.is_none_or(|sign| sign == truth);
        let fixed = filter_of(&points, &weights);
        prop_assert!(right(fixed.power_test_filtered(a, b, c, d, e, weights)));
        prop_assert!(right(filter::power_test(a, b, c, d, e, weights)));
        prop_assert!(right(lattice::power_test(points, weights)));
        prop_assert!(right(fixed::power_test(points, weights)));
        prop_assert!(right(unfiltered::interval_power_test(points, weights).sign()));
        prop_assert_eq!(exact::power_test(points, weights), truth);
        prop_assert_eq!(fixed.power_test(a, b, c, d, e, weights), truth);
    }

    #[test]
    fn equal_weights_make_it_the_insphere_test(points in points(), bits in any::<u64>()) {
        let weight = f64::from_bits(bits);
        prop_assume!(weight.is_finite());
        let [a, b, c, d, e] = points;
        prop_assert_eq!(call(points, [weight; 5]), insphere(a, b, c, d, e));
        prop_assert_eq!(perturbed(points, [weight; 5]), lifted::insphere(a, b, c, d, e));
    }

    #[test]
    fn every_permutation_turns_the_sign((points, weights) in weighted_points()) {
        let (sign, sign_perturbed) = (call(points, weights), perturbed(points, weights));
        for (order, parity) in permutations([0, 1, 2, 3, 4]) {
            let (points, weights) = (order.map(|i| points[i]), order.map(|i| weights[i]));
            prop_assert_eq!(call(points, weights), parity * sign);
            prop_assert_eq!(perturbed(points, weights), parity * sign_perturbed);
        }
    }

    /// Points of all kinds, some of them at the position of another.
    #[test]
    fn the_perturbation_is_its_definition(
        (points, weights) in weighted_points(),
        copies in prop_oneof![3 => Just([0, 1, 2, 3, 4]), 1 => proptest::array::uniform5(0..5_usize)],
        same_weight: bool,
    ) {
        let weights = if same_weight { copies.map(|i| weights[i]) } else { weights };
        let points = copies.map(|i| points[i]);
        let sign = perturbed(points, weights);
        prop_assert_eq!(sign, raised(points, weights));
        let fixed = filter_of(&points, &weights);
        let [a, b, c, d, e] = points;
        prop_assert_eq!(fixed.power_test_perturbed(a, b, c, d, e, weights), sign);
    }

    /// Lattice points with integer weights, on one lifted hyperplane often: never zero where four of them span
    /// space and none is there twice.
    #[test]
    fn never_zero_for_distinct_points(
        points in subsequence(grid(), 5).prop_shuffle(),
        weights in proptest::array::uniform5(-1..=1_i32),
        normal in [-2..=2_i32, -2..=2_i32, -2..=2_i32],
        exponent in -500..500_i32,
    ) {
        // |p|² plus a linear function flattens the lifts; the rest of the weight bends them again.
        let weights: [f64; 5] = from_fn(|i| {
            let p = points[i];
            let normal = DVec3::from_array(normal.map(f64::from));
            let bend = if weights[4] == 0 { 0.0 } else { f64::from(weights[i]) };
            (p.length_squared() + normal.dot(p) + bend) * f64::powi(2.0, 2 * exponent)
        });
        let points: Points = from_fn(|i| points[i] * f64::powi(2.0, exponent));
        let span = permutations(points)
            .iter()
            .any(|(p, _)| orient3d(p[0], p[1], p[2], p[3]) != Sign::Zero);
        prop_assert_eq!(perturbed(points, weights) != Sign::Zero, span);
    }

    /// In a plane the point off it does not matter, nor does its weight.
    #[test]
    fn in_a_plane_the_fourth_point_has_no_say(
        points in subsequence(grid(), 4).prop_shuffle(),
        weights in proptest::array::uniform4(-2..=2_i32),
        apexes in proptest::array::uniform2([-9..9_i32, -9..9_i32, 1..9_i32, -99..99_i32]),
    ) {
        let [a, b, c, e] = from_fn(|i| DVec3::new(points[i].x, points[i].y, 0.0));
        let [wa, wb, wc, we] = weights.map(f64::from);
        let signs = apexes.map(|[x, y, z, w]| {
            let d = DVec3::new(x.into(), y.into(), z.into());
            lifted::power_test(a, b, c, d, e, [wa, wb, wc, w.into(), we]) * orient3d(a, b, c, d)
        });
        prop_assert_eq!(signs[0], signs[1]);
    }

    /// At one position the larger weight lies below the sphere of any tetrahedron with the other.
    #[test]
    fn at_one_position_the_larger_weight_wins((points, weights) in weighted_points(), corner in 0..4_usize) {
        let [a, b, c, d, _] = points;
        let mut points = points;
        points[4] = points[corner];
        let order = weights[4].partial_cmp(&weights[corner]).expect("finite weights");
        let expected = orient3d(a, b, c, d) * Sign::of(f64::from(order as i8));
        prop_assert_eq!(call(points, weights), expected);
        prop_assert_eq!(perturbed(points, weights), expected);
    }
}

fn grid() -> Vec<DVec3> {
    (0..64)
        .map(|i| DVec3::new((i & 3) as f64, (i >> 2 & 3) as f64, (i >> 4) as f64))
        .collect()
}

#[test]
fn conventions_of_the_power_test() {
    let [a, b, c, d] = TETRAHEDRON;
    let far = DVec3::splat(3.0);
    // |far|² = 27 is 18 above the sphere's hyperplane x + y + z = 9.
    let inside = |weight| power_test(a, b, c, d, far, [0.0, 0.0, 0.0, 0.0, weight]);
    assert_eq!(inside(17.5), Sign::Negative);
    assert_eq!(inside(18.0), Sign::Zero);
    assert_eq!(inside(18.5), Sign::Positive);
    assert_eq!(
        power_test(b, a, c, d, far, [0.0, 0.0, 0.0, 0.0, 18.5]),
        Sign::Negative
    );
    // A heavier corner lowers the hyperplane.
    assert_eq!(
        power_test(a, b, c, d, DVec3::splat(0.25), [9.0, 0.0, 0.0, 0.0, 0.0]),
        Sign::Negative
    );
}

#[test]
fn non_finite_weights_do_not_panic() {
    let [a, b, c, d] = TETRAHEDRON;
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        power_test(a, b, c, d, DVec3::ONE, [0.0, 0.0, 0.0, 0.0, bad]);
        lifted::power_test(a, b, c, d, DVec3::ONE, [bad; 5]);
        let p = DVec3::splat(bad);
        power_test(a, b, c, d, p, [bad; 5]);
    }
}

#[test]
fn each_stage_decides_what_it_is_made_for() {
    let points = |e| [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z, e];
    let [a, b, c, d] = TETRAHEDRON;
    let weights = [0.0, 0.1, 0.0, -0.2, 0.3];
    let easy = DVec3::splat(0.3);
    assert_eq!(
        filter::power_test(a, b, c, d, easy, weights),
        Some(Sign::Positive)
    );
    assert_eq!(
        filter::power_test(
            a,
            b,
            c,
            DVec3::ONE - DVec3::Z,
            easy * DVec3::new(1.0, 1.0, 0.0),
            weights
        ),
        Some(Sign::Zero)
    );
    let fixed = StaticFilter::from_bounds(DVec3::ZERO, DVec3::ONE);
    let with_weights = fixed.with_weights(-0.2, 0.3);
    assert_eq!(
        with_weights.power_test_filtered(a, b, c, d, easy, weights),
        Some(Sign::Positive)
    );
    // No interval of weights, none that can be, or one that is too wide.
    assert_eq!(fixed.power_test_filtered(a, b, c, d, easy, weights), None);
    for (least, greatest) in [(1.0, 0.0), (-1e200, 1e200), (f64::MIN, f64::MAX)] {
        let fixed = fixed.with_weights(least, greatest);
        assert!(format!("{fixed:?}").contains("power_test: inf"));
    }

    // Lattices: zero exactly, at every scale at which the squared unit is a double.
    for exponent in (-480..=480).step_by(60) {
        let unit = f64::powi(2.0, exponent);
        let weights = [0.0, 0.0, 0.0, 0.0, 2.0].map(|w| w * unit * unit);
        // (1, 1, 2) has |e|² − 2 = 4 = x + y + z.
        let e = DVec3::new(1.0, 1.0, 2.0);
        let points = points(e).map(|p| p * unit);
        assert_eq!(
            lattice::power_test(points, weights),
            Some(Sign::Zero),
            "2^{exponent}"
        );
        assert_eq!(
            fixed::power_test(points, weights),
            Some(Sign::Zero),
            "2^{exponent}"
        );
    }
    // Beyond its bits a lattice stands aside.
    let heavy = [0.0, 0.0, 0.0, 0.0, f64::powi(2.0, 60) + 256.0];
    assert_eq!(lattice::power_test(points(DVec3::splat(3.0)), heavy), None);
    assert_eq!(
        fixed::power_test(points(DVec3::splat(3.0)), heavy),
        Some(Sign::Positive)
    );

    // Rounded coordinates and weights: fixed width.
    let e = DVec3::new(0.1, 0.7, 0.3);
    let weights = [0.1, 0.3, 0.0, 0.7, 0.2];
    assert_eq!(lattice::power_test(points(e), weights), None);
    assert_eq!(
        fixed::power_test(points(e), weights),
        Some(exact::power_test(points(e), weights))
    );

    // Mixed magnitudes: intervals; a tie of them: any width.
    let weights = [0.0, 0.0, 0.0, 0.0, 1e300];
    assert_eq!(filter::power_test(a, b, c, d, e, weights), None);
    assert_eq!(lattice::power_test(points(e), weights), None);
    assert_eq!(fixed::power_test(points(e), weights), None);
    assert_eq!(
        unfiltered::interval_power_test(points(e), weights).sign(),
        Some(Sign::Positive)
    );
    let weights = [1e300, 1e300, 1e300, 1e-300, 1e300];
    let flat = DVec3::new(0.3, 0.3, 0.0);
    let undecided = unfiltered::interval_power_test(points(flat), weights);
    assert_eq!(undecided.sign(), Some(Sign::Positive));
    let weights = [5e-324, 5e-324, 5e-324, 1e300, 5e-324];
    let cocircular = DVec3::new(1.0, 1.0, 0.0);
    assert_eq!(exact::power_test(points(cocircular), weights), Sign::Zero);
}

/// The largest weights that the lattice takes, on the corners of a cube with the largest sides.
#[test]
fn lattices_hold_their_largest_weights() {
    let side = f64::powi(2.0, 24) - 1.0;
    let corner = |i: u32| DVec3::new((i & 1) as f64, (i >> 1 & 1) as f64, (i >> 2) as f64) * side;
    let most = f64::powi(2.0, 48) - 1.0;
    let (mut decided, mut refused) = (0, 0);
    for i in (0..8_u32.pow(5)).step_by(3) {
        let points: Points = from_fn(|k| corner(i >> (3 * k) & 7));
        for signs in 0..32_u32 {
            let half = |k: u32| if signs >> k & 1 == 1 { -0.5 } else { 0.5 };
            let whole = from_fn(|k| ((half(k as u32) + 0.5) * most).round());
            let sign = lattice::power_test(points, whole);
            if points != [points[4]; 5] {
                assert_eq!(
                    sign,
                    fixed::power_test(points, whole),
                    "{points:?} {whole:?}"
                );
                decided += u32::from(sign.is_some());
            }
            let beyond = whole.map(|w| if w == 0.0 { 0.0 } else { w + 1.0 });
            let sign = lattice::power_test(points, beyond);
            assert!(sign.is_none_or(|sign| Some(sign) == fixed::power_test(points, beyond)));
            refused += u32::from(sign.is_none());
        }
    }
    assert!(decided > 300_000, "{decided}");
    assert!(refused > 200_000, "{refused}");
}

/// Lifts on one hyperplane but for one unit, at heights where doubles begin to round: wider integers must have taken
/// over.
#[test]
fn flat_lifts_of_every_height() {
    let mut signs = 0;
    for bits in 4..=40 {
        let slope = f64::powi(2.0, bits) + 1.0;
        for k in 0..2000_u32 {
            let coordinate = |i: u32| f64::from(k.wrapping_mul(2 * i + 7919).rotate_left(i) % 511);
            let points: Points = from_fn(|i| {
                DVec3::from_array([0, 1, 2].map(|axis| coordinate(5 * axis + i as u32)))
            });
            let flat = points.map(|p| p.length_squared() - slope * (p.x - p.y + p.z));
            for bend in [-1.0, 0.0, 1.0] {
                let mut weights = flat;
                weights[4] += bend;
                // The query sinks below the hyperplane as its weight grows.
                let [a, b, c, d, _] = points;
                let expected = orient3d(a, b, c, d) * Sign::of(bend);
                let sign = lattice::power_test(points, weights);
                assert!(
                    sign.is_none_or(|sign| sign == expected),
                    "2^{bits} {points:?}"
                );
                assert_eq!(fixed::power_test(points, weights), Some(expected));
                signs += u32::from(sign.is_some());
            }
        }
    }
    assert!(signs > 10_000, "{signs}");
}

/// Weight differences of just 150 bits and more, in squares of the coordinates' unit.
#[test]
fn fixed_width_holds_its_largest_weights() {
    let corner = |i: u32| DVec3::new((i & 1) as f64, (i >> 1 & 1) as f64, (i >> 2) as f64);
    let mut decided = [0; 2];
    for i in (0..8_u32.pow(4)).step_by(5) {
        for bits in [60, 74, 75] {
            let side = f64::powi(2.0, bits) * (1.0 - f64::EPSILON);
            let mut points: Points = from_fn(|k| corner(i >> (3 * k) & 7) * side);
            points[4] = DVec3::new(0.0, side, 1.0);
            // About the query the determinants are larger still.
            if i % 2 == 1 {
                let around = |k: usize| (corner(i >> (3 * k) & 7) * 2.0 - 1.0) * side;
                points = [around(0), around(1), around(2), around(3), DVec3::Z];
            }
            for weight_bits in [140, 149, 150, 151, 156, 190, 220] {
                for turned in 0..32_u32 {
                    let weight = f64::powi(2.0, weight_bits) * (1.0 - f64::EPSILON);
                    let weights = from_fn(|k| if turned >> k & 1 == 1 { weight } else { 0.0 });
                    let sign = fixed::power_test(points, weights);
                    decided[usize::from(sign.is_some())] += 1;
                    if let Some(sign) = sign
                        && (i + turned) % 7 == 0
                    {
                        assert_eq!(
                            sign,
                            exact::power_test(points, weights),
                            "{points:?} {weights:?}"
                        );
                    }
                    let fits = weight_bits <= 150 || turned == 0;
                    assert!(
                        !fits || bits == 75 || sign.is_some(),
                        "2^{bits} 2^{weight_bits}"
                    );
                }
            }
        }
    }
    // Weights that three limbs would take for small ones.
    let points = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z, DVec3::splat(3.0)];
    for bits in [189, 190, 191, 192] {
        let weights =
            [0.0, 0.0, 0.0, 0.0, 1.0].map(|w| w * (f64::powi(2.0, bits) + f64::powi(2.0, 140)));
        assert_eq!(fixed::power_test(points, weights), None, "2^{bits}");
    }
    assert!(decided.iter().all(|&count| count > 50_000), "{decided:?}");
}

#[cfg(feature = "statistics")]
#[test]
fn statistics_count_power_tests() {
    use crate::statistics::{Predicate, Stage, reset, snapshot};
    let [a, b, c, d] = TETRAHEDRON;
    let fixed = StaticFilter::from_bounds(DVec3::ZERO, DVec3::ONE).with_weights(0.0, 0.7);
    reset();
    fixed.power_test_perturbed(a, b, c, d, DVec3::splat(0.3), [0.5; 5]);
    fixed.power_test_perturbed(a, b, c, d, DVec3::ONE, [0.5; 5]);
    power_test(a, b, c, d, DVec3::splat(0.3), [0.1; 5]);
    power_test(a, b, c, d, DVec3::ONE, [0.1; 5]);
    power_test(
        a,
        b,
        c,
        d,
        DVec3::new(0.1, 0.2, 0.3),
        [0.0, 0.0, 0.0, 0.0, 1e300],
    );
    power_test(
        a,
        b,
        c,
        DVec3::new(0.3, 0.1, 0.7),
        DVec3::new(1.0, 1.0, 0.0),
        [5e-324, 5e-324, 5e-324, 1e300, 5e-324],
    );
    let counts = snapshot();
    let of = |stage| counts.of(Predicate::PowerTest, stage);
    assert_eq!((of(Stage::Static), of(Stage::SemiStatic)), (1, 1));
    assert_eq!((of(Stage::Lattice), of(Stage::FixedWidth)), (1, 1));
    assert_eq!((of(Stage::Interval), of(Stage::AnyWidth)), (1, 1));
    assert_eq!(of(Stage::Perturbation), 1);
    assert_eq!(counts.of(Predicate::InSphere, Stage::Perturbation), 0);
}
