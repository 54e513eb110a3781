//! The same tests for each symbolic perturbation: agreement with the plain sign, never zero,
//! antisymmetry, and agreement with a determinant for one very small ε.
//!
//! Points are small integers over four, so that coefficients are bounded and ε = 2^−k with a large k is
//! surely small enough.

use super::{config, oracle, permutation::permutations};
use crate::{Sign, incircle, insphere, lifted, orient2d, orient3d, sos, world};
use dashu::integer::IBig;
use glam::{DVec2, DVec3};
use proptest::{prelude::*, sample::subsequence};
use std::array::from_fn;

/// A point in quarters, and its index.
type Item<const D: usize> = ([i32; D], u32);
/// A perturbed predicate and the exact matrix of its determinant at ε = 2^−k, up to a positive factor.
struct Scheme<const D: usize, const N: usize> {
    sign: fn([Item<D>; N]) -> Sign,
    matrix: fn([Item<D>; N]) -> Vec<Vec<IBig>>,
    /// Whether the sign of the matrix's determinant is the opposite one.
    opposite: bool,
}

fn point2(item: Item<2>) -> DVec2 {
    DVec2::from_array(item.0.map(|c| f64::from(c) / 4.0))
}

fn point3(item: Item<3>) -> DVec3 {
    DVec3::from_array(item.0.map(|c| f64::from(c) / 4.0))
}

fn with_one(mut row: Vec<IBig>) -> Vec<IBig> {
    row.push(IBig::ONE);
    row
}

/// (x, …, |p|², 1)
fn with_lift(row: Vec<IBig>) -> Vec<IBig> {
    let lift = row.iter().map(|c| c * c).sum();
    let mut row = row;
    row.push(lift);
    with_one(row)
}

/// The quarter-integers p + ε^(2^i) (i, i², …) for ε = 2^−256, in units of 2^−(256·64).
fn displaced<const D: usize>((p, index): Item<D>) -> Vec<IBig> {
    assert!(index <= 6);
    let unit = 256 * 64;
    let epsilon = IBig::ONE << (unit - (256 << index));
    let coordinate = |k: usize| {
        let direction = IBig::from(4 * i64::from(index).pow(k as u32 + 1));
        (IBig::from(p[k]) << unit) + direction * &epsilon
    };
    (0..D).map(coordinate).collect()
}

/// (x + εy, y + ε²x + ε³(x² + y²)) for ε = 2^−256, times 16 · 2⁷⁶⁸.
fn moved(([x, y], _): Item<2>) -> Vec<IBig> {
    let [x, y] = [x, y].map(|c| IBig::from(4 * c));
    let lift = (&x * &x + &y * &y) / 16;
    vec![(&x << 768) + (&y << 512), (&y << 768) + (&x << 256) + lift]
}

/// The lifted points, the lift of the point of lexicographic rank i of N raised by ε^(N + 1 − i),
/// ε = 2^−256.
fn raised<const D: usize, const N: usize>(items: [Item<D>; N]) -> Vec<Vec<IBig>> {
    let row = |(p, _): &Item<D>| {
        let rank = items.iter().filter(|(q, _)| q <= p).count();
        let mut row: Vec<IBig> = p.iter().map(|&c| IBig::from(c)).collect();
        let lift: IBig = row.iter().map(|c| c * c).sum();
        row.push((lift << (256 * N)) + (IBig::ONE << (256 * (rank - 1))));
        with_one(row)
    };
    items.iter().map(row).collect()
}

const SOS_ORIENT2D: Scheme<2, 3> = Scheme {
    sign: |i| sos::orient2d(i.map(point2), i.map(|i| i.1)),
    matrix: |i| i.map(|i| with_one(displaced(i))).to_vec(),
    opposite: false,
};
const SOS_ORIENT3D: Scheme<3, 4> = Scheme {
    sign: |i| sos::orient3d(i.map(point3), i.map(|i| i.1)),
    matrix: |i| i.map(|i| with_one(displaced(i))).to_vec(),
    opposite: true,
};
const SOS_INCIRCLE: Scheme<2, 4> = Scheme {
    sign: |i| sos::incircle(i.map(point2), i.map(|i| i.1)),
    matrix: |i| i.map(|i| with_lift(displaced(i))).to_vec(),
    opposite: false,
};
const SOS_INSPHERE: Scheme<3, 5> = Scheme {
    sign: |i| sos::insphere(i.map(point3), i.map(|i| i.1)),
    matrix: |i| i.map(|i| with_lift(displaced(i))).to_vec(),
    opposite: true,
};
const WORLD_ORIENT2D: Scheme<2, 3> = Scheme {
    sign: |i| {
        let [a, b, c] = i.map(point2);
        world::orient2d(a, b, c)
    },
    matrix: |i| i.map(|i| with_one(moved(i))).to_vec(),
    opposite: false,
};
const WORLD_INCIRCLE: Scheme<2, 4> = Scheme {
    sign: |i| {
        let [a, b, c, d] = i.map(point2);
        world::incircle(a, b, c, d)
    },
    matrix: |i| i.map(|i| with_lift(moved(i))).to_vec(),
    opposite: false,
};
const LIFTED_INCIRCLE: Scheme<2, 4> = Scheme {
    sign: |i| {
        let [a, b, c, d] = i.map(point2);
        lifted::incircle(a, b, c, d)
    },
    matrix: raised,
    opposite: false,
};
const LIFTED_INSPHERE: Scheme<3, 5> = Scheme {
    sign: |i| {
        let [a, b, c, d, e] = i.map(point3);
        lifted::insphere(a, b, c, d, e)
    },
    matrix: raised,
    opposite: true,
};

impl<const D: usize, const N: usize> Scheme<D, N> {
    /// The tests that hold for every scheme; `plain` is the sign without perturbation, `nonzero` whether
    /// the perturbed sign must not be zero.
    fn check(&self, items: [Item<D>; N], plain: Sign, nonzero: bool) -> Result<(), TestCaseError> {
        let sign = (self.sign)(items);
        if plain != Sign::Zero {
            prop_assert_eq!(sign, plain);
        }
        if nonzero {
            prop_assert_ne!(sign, Sign::Zero);
        }
        let exact = oracle::sign(&oracle::determinant(&(self.matrix)(items)));
        prop_assert_eq!(sign, if self.opposite { -exact } else { exact });
        for (arranged, parity) in permutations(items) {
            prop_assert_eq!((self.sign)(arranged), parity * sign);
        }
        Ok(())
    }
}

/// Distinct points: on one line, on a circle or sphere about the origin, or of a grid so small that all of
/// that happens often; with distinct indices.
fn items<const D: usize, const N: usize>() -> BoxedStrategy<[Item<D>; N]> {
    let grid: Vec<[i32; D]> = all_points(-1..=1);
    let line: Vec<[i32; D]> = (-4..=4)
        .map(|s| from_fn(|k| s * [1, 2, -1][k] + 3))
        .collect();
    let axis: Vec<[i32; D]> = (-4..=4)
        .map(|s| from_fn(|k| if k == 0 { s } else { 0 }))
        .collect();
    let round: Vec<[i32; D]> = all_points(-5..=5)
        .into_iter()
        .filter(|p| p.iter().map(|c| c * c).sum::<i32>() == 25)
        .collect();
    let any: Vec<[i32; D]> = all_points(-3..=4);
    let points = prop_oneof![
        4 => subsequence(grid, N),
        1 => subsequence(line, N),
        1 => subsequence(axis, N),
        4 => subsequence(round, N),
        2 => subsequence(any, N),
    ];
    let indices = subsequence((0..=6_u32).collect::<Vec<_>>(), N).prop_shuffle();
    (points.prop_shuffle(), indices)
        .prop_map(|(points, indices)| from_fn(|i| (points[i], indices[i])))
        .boxed()
}

fn all_points<const D: usize>(range: std::ops::RangeInclusive<i32>) -> Vec<[i32; D]> {
    let mut points = vec![[0; D]];
    for k in 0..D {
        let extend = |p: &[i32; D]| {
            let p = *p;
            range.clone().map(move |c| {
                let mut p = p;
                p[k] = c;
                p
            })
        };
        points = points.iter().flat_map(extend).collect();
    }
    points
}

fn some_triple_turns(p: [DVec2; 4]) -> bool {
    permutations(p)
        .iter()
        .any(|(p, _)| orient2d(p[0], p[1], p[2]) != Sign::Zero)
}

fn some_four_span(p: [DVec3; 5]) -> bool {
    permutations(p)
        .iter()
        .any(|(p, _)| orient3d(p[0], p[1], p[2], p[3]) != Sign::Zero)
}

fn fewer() -> ProptestConfig {
    let config = config();
    ProptestConfig {
        cases: config.cases / 8,
        ..config
    }
}

proptest! {
    #![proptest_config(fewer())]

    #[test]
    fn orientations_in_the_plane(items in items::<2, 3>()) {
        let [a, b, c] = items.map(point2);
        let plain = orient2d(a, b, c);
        SOS_ORIENT2D.check(items, plain, true)?;
        WORLD_ORIENT2D.check(items, plain, true)?;
    }

    #[test]
    fn orientations_in_space(items in items::<3, 4>()) {
        let [a, b, c, d] = items.map(point3);
        SOS_ORIENT3D.check(items, orient3d(a, b, c, d), true)?;
    }

    #[test]
    fn circles(items in items::<2, 4>()) {
        let p @ [a, b, c, d] = items.map(point2);
        let plain = incircle(a, b, c, d);
        SOS_INCIRCLE.check(items, plain, true)?;
        WORLD_INCIRCLE.check(items, plain, true)?;
        // The lift moves no point, so four collinear points stay so.
        LIFTED_INCIRCLE.check(items, plain, some_triple_turns(p))?;
    }

    #[test]
    fn spheres(items in items::<3, 5>()) {
        let p @ [a, b, c, d, e] = items.map(point3);
        let plain = insphere(a, b, c, d, e);
        SOS_INSPHERE.check(items, plain, true)?;
        LIFTED_INSPHERE.check(items, plain, some_four_span(p))?;
    }

    /// Points that coincide are told apart by their indices.
    #[test]
    fn simplicity_of_coinciding_points(items in items::<3, 5>(), copies in proptest::array::uniform5(0..3_usize)) {
        let merged: [Item<3>; 5] = from_fn(|i| (items[copies[i]].0, items[i].1));
        let [a, b, c, d, e] = merged.map(point3);
        SOS_INSPHERE.check(merged, insphere(a, b, c, d, e), true)?;
        let four = [merged[0], merged[1], merged[2], merged[3]];
        SOS_ORIENT3D.check(four, orient3d(a, b, c, d), true)?;
    }

    /// Scaling by a power of two keeps the order of the points and every sign of the lifted scheme.
    #[test]
    fn lifted_at_all_scales(items in items::<3, 5>(), exponent in -1060..1015_i32) {
        let [a, b, c, d, e] = items.map(point3);
        let scale = |p: DVec3| p * f64::powi(2.0, exponent / 2) * f64::powi(2.0, exponent - exponent / 2);
        prop_assert_eq!(
            lifted::insphere(scale(a), scale(b), scale(c), scale(d), scale(e)),
            lifted::insphere(a, b, c, d, e)
        );
    }

    /// In a plane, the point off it does not matter.
    #[test]
    fn lifted_in_a_plane_of_space(items in items::<2, 4>(), apex in proptest::array::uniform2([-9..9_i32, -9..9_i32, 1..9_i32])) {
        let [a, b, c, e] = items.map(point2);
        let flat = lifted::incircle(a, b, c, e) * orient2d(a, b, c);
        if orient2d(a, b, c) != Sign::Zero {
            for apex in apex {
                let d = DVec3::from_array(apex.map(f64::from));
                let [a, b, c, e] = [a, b, c, e].map(|p| p.extend(0.0));
                let sign = lifted::insphere(a, b, c, d, e) * orient3d(a, b, c, d);
                prop_assert_eq!(sign, flat);
            }
        }
    }
}

#[test]
fn the_largest_of_a_cospherical_set_is_outside() {
    let corners: [DVec3; 8] =
        from_fn(|i| DVec3::new((i & 1) as f64, (i >> 1 & 1) as f64, (i >> 2) as f64));
    let mut tested = 0;
    for (p, _) in permutations([0, 1, 2, 4, 7]) {
        let [a, b, c, d, e] = p.map(|i| corners[i]);
        if orient3d(a, b, c, d) != Sign::Zero && e == DVec3::ONE {
            let outside = -orient3d(a, b, c, d);
            assert_eq!(lifted::insphere(a, b, c, d, e), outside);
            tested += 1;
        }
    }
    assert_eq!(tested, 24);
}

#[test]
fn zeros_of_either_sign_are_the_same_place() {
    use std::cmp::Ordering;
    let (p, q) = (DVec3::new(0.0, -0.0, 1.0), DVec3::new(-0.0, 0.0, 1.0));
    assert_eq!(lifted::lexicographic(p, q), Ordering::Equal);
    assert_eq!(
        lifted::lexicographic2d(p.truncate(), q.truncate()),
        Ordering::Equal
    );
    assert_eq!(
        lifted::lexicographic(DVec3::new(-0.0, 1.0, 0.0), DVec3::X),
        Ordering::Less
    );
    let square = [DVec2::ZERO, DVec2::X, DVec2::ONE, DVec2::Y];
    let minus =
        square.map(|p| DVec2::from_array(p.to_array().map(|c| if c == 0.0 { -0.0 } else { c })));
    let sign = |[a, b, c, d]: [DVec2; 4]| lifted::incircle(a, b, c, d);
    assert_eq!(sign(square), sign(minus));
    assert_eq!(
        sign([square[0], minus[1], square[2], minus[3]]),
        sign(square)
    );
}

/// One point twice: no perturbation that knows only places can tell, and none may pretend to.
#[test]
fn a_repeated_point_is_a_tie() {
    let [a, b, c, d] = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    assert_eq!(lifted::insphere(a, b, c, d, d), Sign::Zero);
    let [a, b, c] = [DVec2::ZERO, DVec2::X, DVec2::Y];
    assert_eq!(lifted::incircle(a, b, c, a), Sign::Zero);
    assert_eq!(world::incircle(a, b, c, a), Sign::Zero);
    assert_eq!(world::orient2d(a, b, b), Sign::Zero);
}

/// Sets of digits add and compare as the numbers that they stand for.
#[test]
fn exponents_are_numbers() {
    use crate::polynomial::{Binary, Exponent};
    let of = |n: u32| {
        let digits = (0..32).filter(|i| n >> i & 1 == 1).map(Binary::power);
        digits.fold(Binary::zero(), |sum, digit| sum.plus(&digit))
    };
    for x in 0..64 {
        for y in 0..64 {
            assert_eq!(of(x).plus(&of(y)), of(x + y));
            assert_eq!(of(x).cmp(&of(y)), x.cmp(&y));
        }
    }
}
