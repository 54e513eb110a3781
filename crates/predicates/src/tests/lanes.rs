//! Four tests at once, and filters that know of a lattice.

use super::{
    config,
    inputs::{points, space, weighted_points},
};
use crate::{
    Sign, StaticFilter, insphere,
    lanes::{AtInfinity, FourSides, FourVerdicts, Plain, Registers, Vectorized, vectorized},
    lifted, orient3d, power_test,
};
use glam::DVec3;
use proptest::prelude::*;

/// The corners of the neighbours, as the table in `lanes` has them.
const NEIGHBORS: [[usize; 3]; 4] = [[3, 1, 2], [2, 0, 3], [3, 0, 1], [1, 0, 2]];

/// Four tests, of points or of points with weights.
struct Across<P> {
    filter: StaticFilter,
    corners: [P; 4],
    opposite: [P; 4],
    p: P,
    at_infinity: AtInfinity,
}

impl Vectorized for Across<DVec3> {
    type Output = FourVerdicts;

    #[inline(always)]
    fn run<R: Registers>(self, registers: R) -> FourVerdicts {
        let (corners, opposite) = (self.corners, self.opposite);
        let filter = self.filter;
        filter.insphere_across(registers, corners, opposite, self.p, self.at_infinity)
    }
}

impl Vectorized for Across<(DVec3, f64)> {
    type Output = FourVerdicts;

    #[inline(always)]
    fn run<R: Registers>(self, registers: R) -> FourVerdicts {
        let (corners, opposite) = (self.corners, self.opposite);
        let filter = self.filter;
        filter.power_test_across(registers, corners, opposite, self.p, self.at_infinity)
    }
}

fn at_infinity() -> impl Strategy<Value = AtInfinity> {
    prop_oneof![
        (0..16_u8).prop_map(|opposite| AtInfinity {
            opposite,
            corner: false,
        }),
        Just(AtInfinity {
            opposite: 0,
            corner: true,
        }),
    ]
}

struct Sides {
    filter: StaticFilter,
    corners: [DVec3; 4],
    p: DVec3,
}

impl Vectorized for Sides {
    type Output = FourSides;

    #[inline(always)]
    fn run<R: Registers>(self, registers: R) -> FourSides {
        let Self { filter, corners, p } = self;
        filter.sides_of_facets(registers, corners, p)
    }
}

/// The largest power of two of which all coordinates are multiples, found by trying; 1 for none but zeros.
fn unit(points: &[DVec3]) -> f64 {
    let coordinates = || points.iter().flat_map(|p| p.to_array());
    if coordinates().all(|c| c == 0.0) {
        return 1.0;
    }
    let powers = (-1074..=1023)
        .rev()
        .map(|e| 2_f64.powi(e / 2) * 2_f64.powi(e - e / 2));
    powers
        .into_iter()
        .find(|unit| coordinates().all(|c| c % unit == 0.0))
        .expect("all doubles are multiples of the least one")
}

fn filter(points: &[DVec3]) -> StaticFilter {
    let min = points.iter().copied().reduce(DVec3::min);
    let max = points.iter().copied().reduce(DVec3::max);
    StaticFilter::from_bounds(min.expect("points"), max.expect("points")).with_unit(unit(points))
}

/// Whether `p` is beyond the hull facet of the neighbour in lane `i`, if that has the vertex at infinity.
fn beyond_hull(
    at_infinity: AtInfinity,
    i: usize,
    [x, y, z, opposite]: [DVec3; 4],
    p: DVec3,
) -> Option<Sign> {
    // Corner 3 is the first vertex in lanes 0 and 2 and the third in lane 1; opposite vertices are the fourth.
    match (at_infinity.corner, i) {
        (true, 3) => None,
        (true, 1) => Some(-orient3d(x, y, opposite, p)),
        (true, _) => Some(-orient3d(y, z, opposite, p)),
        (false, _) => (at_infinity.opposite >> i & 1 == 1).then(|| orient3d(x, y, z, p)),
    }
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn four_verdicts_are_right_and_the_same_on_all_registers(
        five in points(),
        others in points(),
        lane in 0..4_usize,
        at_infinity in at_infinity(),
    ) {
        let [a, b, c, d, e] = space(&five);
        let [q, ..]: [DVec3; 5] = space(&others);
        // In one lane the five points that are degenerate together.
        let mut corners = [a, b, c, a];
        corners[3] = corners[lane];
        corners[lane] = q;
        let opposite = [d; 4];
        let filter = filter(&[a, b, c, d, e, q]);
        let across = || Across { filter, corners, opposite, p: e, at_infinity };
        let verdicts = vectorized(across());
        prop_assert_eq!(verdicts, across().run(Plain));
        for (i, neighbor) in NEIGHBORS.into_iter().enumerate() {
            let [x, y, z] = neighbor.map(|corner| corners[corner]);
            let bit = |set: u8| set >> i & 1 == 1;
            if let Some(truth) = beyond_hull(at_infinity, i, [x, y, z, opposite[i]], e) {
                prop_assert!(!bit(verdicts.inside) || truth == Sign::Positive);
                prop_assert!(!bit(verdicts.outside) || truth == Sign::Negative);
                continue;
            }
            let truth = insphere(x, y, z, opposite[i], e);
            if truth == Sign::Zero {
                let vertices = [x, y, z, opposite[i]];
                if orient3d(x, y, z, opposite[i]) != Sign::Positive || vertices.contains(&e) {
                    continue;
                }
            }
            let truth = match truth {
                Sign::Zero => lifted::insphere(x, y, z, opposite[i], e),
                sign => sign,
            };
            prop_assert!(!bit(verdicts.inside) || truth == Sign::Positive);
            prop_assert!(!bit(verdicts.outside) || truth == Sign::Negative);
        }
    }

    #[test]
    fn four_verdicts_on_weighted_points_are_right_and_the_same_on_all_registers(
        (five, weights) in weighted_points(),
        others in points(),
        other_weight in prop_oneof![-1.0..1.0, any::<f64>().prop_filter("finite", |w| w.is_finite())],
        lane in 0..4_usize,
        at_infinity in at_infinity(),
    ) {
        let [a, b, c, d, e] = five;
        let [wa, wb, wc, wd, we] = weights;
        let q = others[0];
        let mut corners = [(a, wa), (b, wb), (c, wc), (a, wa)];
        corners[3] = corners[lane];
        corners[lane] = (q, other_weight);
        let opposite = [(d, wd); 4];
        let all = [wa, wb, wc, wd, we, other_weight];
        let least = all.iter().copied().fold(f64::INFINITY, f64::min);
        let greatest = all.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let filter = filter(&[a, b, c, d, e, q]).with_weights(least, greatest);
        let p = (e, we);
        let across = || Across { filter, corners, opposite, p, at_infinity };
        let verdicts = vectorized(across());
        prop_assert_eq!(verdicts, across().run(Plain));
        for (i, neighbor) in NEIGHBORS.into_iter().enumerate() {
            let [x, y, z] = neighbor.map(|corner| corners[corner]);
            let vertices = [x, y, z, opposite[i]];
            let truth = beyond_hull(at_infinity, i, vertices.map(|(point, _)| point), e)
                .unwrap_or_else(|| {
                    let weights = [x.1, y.1, z.1, opposite[i].1, we];
                    power_test(x.0, y.0, z.0, opposite[i].0, e, weights)
                });
            let bit = |set: u8| set >> i & 1 == 1;
            prop_assert!(!bit(verdicts.inside) || truth == Sign::Positive);
            prop_assert!(!bit(verdicts.outside) || truth == Sign::Negative);
        }
    }

    /// The heavy vertex is weighted by the volume of the others, which is nothing but a rounding.
    #[test]
    fn one_heavy_vertex_has_its_part_in_the_bound(
        points in proptest::array::uniform5(proptest::array::uniform3(-1.0..1.0)),
        share in [0.0..1.0, 0.0..1.0],
        heavy in 0..8_usize,
        exponent in -10..100_i32,
    ) {
        let [a, b, c, q, d] = points.map(DVec3::from_array);
        let p = a + share[0] * (b - a) + share[1] * (c - a);
        // The neighbour opposite corner 3 has a, b, c, which p is coplanar with, and the fourth vertex.
        let mut corners = [a, b, c, q].map(|p| (p, 0.0));
        let mut opposite = [d; 4].map(|p| (p, 0.0));
        let weight = 2_f64.powi(exponent);
        match heavy {
            0..4 => corners[heavy].1 = weight,
            _ => opposite[heavy - 4].1 = weight,
        }
        let filter = filter(&[a, b, c, q, d, p]).with_weights(0.0, weight);
        let across = || Across {
            filter,
            corners,
            opposite,
            p: (p, 0.0),
            at_infinity: AtInfinity::default(),
        };
        let verdicts = vectorized(across());
        prop_assert_eq!(verdicts, across().run(Plain));
        for (i, neighbor) in NEIGHBORS.into_iter().enumerate() {
            let [x, y, z] = neighbor.map(|corner| corners[corner]);
            let o = opposite[i];
            let truth = power_test(x.0, y.0, z.0, o.0, p, [x.1, y.1, z.1, o.1, 0.0]);
            let bit = |set: u8| set >> i & 1 == 1;
            prop_assert!(!bit(verdicts.inside) || truth == Sign::Positive);
            prop_assert!(!bit(verdicts.outside) || truth == Sign::Negative);
        }
    }

    #[test]
    fn four_sides_are_right_and_the_same_on_all_registers(five in points(), on_lattice in any::<bool>()) {
        let [a, b, c, d, e] = space(&five);
        let corners = [a, b, c, d];
        let filter = match on_lattice {
            true => filter(&[a, b, c, d, e]),
            false => filter(&[a, b, c, d, e]).with_unit(0.0),
        };
        let across = || Sides { filter, corners, p: e };
        let sides = vectorized(across());
        prop_assert_eq!(sides, across().run(Plain));
        for (i, neighbor) in NEIGHBORS.into_iter().enumerate() {
            let [x, y, z] = neighbor.map(|corner| corners[corner]);
            let is_beyond = orient3d(x, y, z, e) == Sign::Positive;
            let bit = |set: u8| set >> i & 1 == 1;
            prop_assert!(!bit(sides.beyond) || is_beyond);
            prop_assert!(!bit(sides.within) || !is_beyond);
        }
    }

    #[test]
    fn a_filter_that_knows_the_lattice_is_exact(five in points()) {
        let [a, b, c, d, e] = space(&five);
        let filter = filter(&[a, b, c, d, e]);
        prop_assert_eq!(filter.orient3d(a, b, c, d), orient3d(a, b, c, d));
        prop_assert_eq!(filter.insphere(a, b, c, d, e), insphere(a, b, c, d, e));
        if orient3d(a, b, c, d) == Sign::Positive {
            prop_assert_eq!(
                filter.insphere_perturbed(a, b, c, d, e),
                lifted::insphere(a, b, c, d, e)
            );
        }
    }
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn on_a_lattice_ties_are_decided_in_all_lanes(
        corners in proptest::array::uniform4(0..8_u8),
        opposite in proptest::array::uniform4(0..8_u8),
        p in 0..8_u8,
        axes in Just([0, 1, 2]).prop_shuffle(),
        wide in any::<bool>(),
    ) {
        // Corners of a cube, all on one sphere; in a wide box only the second filter knows it.
        let corner = |i: u8| DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2));
        let corner = |i: u8| DVec3::from_array(axes.map(|axis| corner(i)[axis]));
        let (corners, opposite, p) = (corners.map(corner), opposite.map(corner), corner(p));
        let size = if wide { 1000.0 } else { 1.0 };
        let filter = StaticFilter::from_bounds(DVec3::ZERO, DVec3::splat(size)).with_unit(1.0);
        let across = || Across { filter, corners, opposite, p, at_infinity: AtInfinity::default() };
        let verdicts = vectorized(across());
        prop_assert_eq!(verdicts, across().run(Plain));
        for (i, neighbor) in NEIGHBORS.into_iter().enumerate() {
            let [x, y, z] = neighbor.map(|corner| corners[corner]);
            let is_vertex = [x, y, z, opposite[i]].contains(&p);
            if orient3d(x, y, z, opposite[i]) == Sign::Positive && !is_vertex {
                let sign = match (verdicts.inside >> i & 1, verdicts.outside >> i & 1) {
                    (1, 0) => Sign::Positive,
                    (0, 1) => Sign::Negative,
                    _ => Sign::Zero,
                };
                prop_assert_eq!(sign, lifted::insphere(x, y, z, opposite[i], p));
            }
        }
    }
}

#[test]
fn sides_of_the_facets_of_a_corner() {
    let corners = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    let (min, max) = (DVec3::splat(-2.0), DVec3::splat(2.0));
    let sides = |p: [f64; 3], unit: f64| {
        let filter = StaticFilter::from_bounds(min, max).with_unit(unit);
        let p = DVec3::from_array(p);
        let sides = vectorized(Sides { filter, corners, p });
        (sides.beyond, sides.within)
    };
    for unit in [0.0, 0.0625] {
        assert_eq!(sides([0.125; 3], unit), (0, 0b1111));
        assert_eq!(sides([1.0; 3], unit), (0b0001, 0b1110));
        assert_eq!(sides([-1.0, 0.5, 0.25], unit), (0b0010, 0b1101));
        assert_eq!(sides([0.5, -1.0, -0.5], unit), (0b1100, 0b0011));
    }
    // In the plane of a facet the point is not beyond it, which is certain on a lattice only.
    assert_eq!(sides([0.25, 0.25, 0.0], 0.0), (0, 0b0111));
    assert_eq!(sides([0.25, 0.25, 0.0], 0.0625), (0, 0b1111));
}

#[test]
fn small_determinants_on_a_lattice_are_no_ties() {
    // (0, x, y, d) has volume 1/6, so the determinant is minus the power of the point with respect to the sphere:
    // x² − x + y² − y + z² − K z with K = p² − p + q² − q + 1 for d = (p, q, 1).
    let (p, q) = (20, 20);
    let k = p * p - p + q * q - q + 1;
    let corners = [
        DVec3::ZERO,
        DVec3::X,
        DVec3::Y,
        DVec3::new(f64::from(p), f64::from(q), 1.0),
    ];
    let [a, b, c, d] = corners;
    // In this box the bound on the error is about ten.
    let filter = StaticFilter::from_bounds(DVec3::ZERO, DVec3::splat(600.0)).with_unit(1.0);
    let mut found = 0;
    for z in 300..310 {
        for (x, y) in (0..600).flat_map(|x| (0..x).map(move |y| (x, y))) {
            let power: i32 = x * x - x + y * y - y + z * z - k * z;
            if power != 0 && power.abs() <= 8 {
                let e = DVec3::new(f64::from(x), f64::from(y), f64::from(z));
                let truth = if power < 0 {
                    Sign::Positive
                } else {
                    Sign::Negative
                };
                assert_eq!(insphere(a, b, c, d, e), truth);
                assert_eq!(filter.insphere_perturbed(a, b, c, d, e), truth, "{e}");
                found += 1;
            }
        }
    }
    assert!(found > 20, "{found}");
}
