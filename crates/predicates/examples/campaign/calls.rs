//! The calls of a case: a group of predicates, each with the points in an order of its own.

use crate::{inputs::Case, oracle, random::Random, tally::Tally};
use glam::{DVec2, DVec3};
use pellicle_predicates::{
    Sign, StaticFilter, StaticFilter2, compare_distance, incircle, insphere, lifted, orient2d,
    orient3d, power_test, sos, world,
};
use std::cmp::Ordering;

pub fn check(case: &Case, random: &mut Random, tally: &mut Tally) {
    match random.below(16) {
        0..2 => orientations_in_space(case, random, tally),
        2..6 => spheres(case, random, tally),
        6..11 => powers(case, random, tally),
        11..15 => plane(case, random, tally),
        _ => distances(case, random, tally),
    }
}

/// Positive for even orders.
fn parity<const N: usize>(order: [usize; N]) -> Sign {
    let inversions = (0..N).flat_map(|i| (0..i).map(move |j| (j, i)));
    let odd = inversions.filter(|&(j, i)| order[j] > order[i]).count() % 2;
    if odd == 1 {
        Sign::Negative
    } else {
        Sign::Positive
    }
}

/// Perturbations by polynomials take milliseconds where magnitudes are mixed: not every tie is put to them.
const OF_TIES: u64 = 16;

fn filter(case: &Case) -> StaticFilter {
    let [first, ..] = case.points;
    let min = case.points.iter().copied().fold(first, DVec3::min);
    let max = case.points.iter().copied().fold(first, DVec3::max);
    let least = case.weights.iter().copied().fold(f64::INFINITY, f64::min);
    let greatest = case
        .weights
        .iter()
        .copied()
        .fold(f64::NEG_INFINITY, f64::max);
    StaticFilter::from_bounds(min, max).with_weights(least, greatest)
}

/// Distinct indices for the perturbation by indices.
fn indices<const N: usize>(random: &mut Random) -> [u32; N] {
    let order = random.order::<8>();
    std::array::from_fn(|i| order[i] as u32)
}

fn orientations_in_space(case: &Case, random: &mut Random, tally: &mut Tally) {
    let truth = oracle::space(&case.points, &case.weights).orientation;
    let order = random.order::<4>();
    let [a, b, c, d] = order.map(|i| case.points[i]);
    let here = parity(order) * truth;
    tally.call("orient3d", orient3d(a, b, c, d), here, truth);
    let answer = filter(case).orient3d(a, b, c, d);
    tally.call("StaticFilter::orient3d", answer, here, truth);
    if truth != Sign::Zero || random.one_in(OF_TIES) {
        let indices = indices(random);
        let truth_displaced = match truth {
            Sign::Zero => oracle::displaced(&[a, b, c, d].map(|p| p.to_array()), &indices, false),
            _ => here,
        };
        let answer = sos::orient3d([a, b, c, d], indices);
        tally.call("sos::orient3d", answer, truth_displaced, truth);
    }
}

fn spheres(case: &Case, random: &mut Random, tally: &mut Tally) {
    let truth = oracle::space(&case.points, &case.weights);
    let order = random.order::<5>();
    let [a, b, c, d, e] = order.map(|i| case.points[i]);
    let parity = parity(order);
    let (plain, raised) = (parity * truth.plain, parity * truth.raised);
    let filter = filter(case);
    let mut call = |name, answer, truth| tally.call(name, answer, truth, plain);
    call("insphere", insphere(a, b, c, d, e), plain);
    call(
        "StaticFilter::insphere",
        filter.insphere(a, b, c, d, e),
        plain,
    );
    call("lifted::insphere", lifted::insphere(a, b, c, d, e), raised);
    let answer = filter.insphere_perturbed(a, b, c, d, e);
    call("StaticFilter::insphere_perturbed", answer, raised);
    if plain != Sign::Zero || random.one_in(OF_TIES) {
        let indices = indices(random);
        let points = [a, b, c, d, e];
        let truth = match plain {
            Sign::Zero => oracle::displaced(&points.map(|p| p.to_array()), &indices, true),
            _ => plain,
        };
        call("sos::insphere", sos::insphere(points, indices), truth);
    }
}

fn powers(case: &Case, random: &mut Random, tally: &mut Tally) {
    let truth = oracle::space(&case.points, &case.weights);
    let order = random.order::<5>();
    let [a, b, c, d, e] = order.map(|i| case.points[i]);
    let w = order.map(|i| case.weights[i]);
    let parity = parity(order);
    let (plain, raised) = (parity * truth.power, parity * truth.power_raised);
    let filter = filter(case);
    let mut call = |name, answer, truth| tally.call(name, answer, truth, plain);
    call("power_test", power_test(a, b, c, d, e, w), plain);
    call(
        "StaticFilter::power_test",
        filter.power_test(a, b, c, d, e, w),
        plain,
    );
    call(
        "lifted::power_test",
        lifted::power_test(a, b, c, d, e, w),
        raised,
    );
    let answer = filter.power_test_perturbed(a, b, c, d, e, w);
    call("StaticFilter::power_test_perturbed", answer, raised);
}

fn plane(case: &Case, random: &mut Random, tally: &mut Tally) {
    let [p, q, r, s, _] = case.points.map(|p| p.truncate());
    let points = [p, q, r, s];
    let truth = oracle::plane(&points);
    let min = points.iter().copied().fold(p, DVec2::min);
    let max = points.iter().copied().fold(p, DVec2::max);
    let filter = StaticFilter2::from_bounds(min, max);

    let order = random.order::<3>();
    let [a, b, c] = order.map(|i| points[i]);
    let here = parity(order) * truth.orientation;
    tally.call("orient2d", orient2d(a, b, c), here, here);
    tally.call(
        "StaticFilter2::orient2d",
        filter.orient2d(a, b, c),
        here,
        here,
    );
    let perturbed = here != Sign::Zero || random.one_in(OF_TIES);
    if perturbed {
        let indices = indices(random);
        let (mut displaced, mut moved) = (here, here);
        if here == Sign::Zero {
            displaced = oracle::displaced(&[a, b, c].map(|p| p.to_array()), &indices, false);
            moved = oracle::moved(&[a, b, c], false);
        }
        let answer = sos::orient2d([a, b, c], indices);
        tally.call("sos::orient2d", answer, displaced, here);
        tally.call("world::orient2d", world::orient2d(a, b, c), moved, here);
    }

    let order = random.order::<4>();
    let [a, b, c, d] = order.map(|i| points[i]);
    let parity = parity(order);
    let (plain, raised) = (parity * truth.plain, parity * truth.raised);
    let mut call = |name, answer, truth| tally.call(name, answer, truth, plain);
    call("incircle", incircle(a, b, c, d), plain);
    call(
        "StaticFilter2::incircle",
        filter.incircle(a, b, c, d),
        plain,
    );
    call("lifted::incircle", lifted::incircle(a, b, c, d), raised);
    let answer = filter.incircle_perturbed(a, b, c, d);
    call("StaticFilter2::incircle_perturbed", answer, raised);
    if plain != Sign::Zero || random.one_in(OF_TIES) {
        let indices = indices(random);
        let (mut displaced, mut moved) = (plain, plain);
        if plain == Sign::Zero {
            displaced = oracle::displaced(&[a, b, c, d].map(|p| p.to_array()), &indices, true);
            moved = oracle::moved(&[a, b, c, d], true);
        }
        call(
            "sos::incircle",
            sos::incircle([a, b, c, d], indices),
            displaced,
        );
        call("world::incircle", world::incircle(a, b, c, d), moved);
    }
}

fn distances(case: &Case, random: &mut Random, tally: &mut Tally) {
    let [p, a, b, ..] = random.order::<5>().map(|i| case.points[i]);
    let truth = oracle::compare_distance(p, a, b);
    let answer = match compare_distance(p, a, b) {
        Ordering::Less => Sign::Negative,
        Ordering::Equal => Sign::Zero,
        Ordering::Greater => Sign::Positive,
    };
    tally.call("compare_distance", answer, truth, truth);
}
