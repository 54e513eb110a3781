//! Five points with weights, by family.

use crate::random::Random;
use glam::DVec3;
use std::array::from_fn;

/// Points of space, of which the plane's predicates take x and y, and their weights.
#[derive(Clone, Copy, Debug)]
pub struct Case {
    pub points: [DVec3; 5],
    pub weights: [f64; 5],
}

/// What a case is like.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Family {
    Uniform,
    SmallGrid,
    Tenths,
    NearlyFlat,
    NearlySpherical,
    FlatIntegers,
    SphericalIntegers,
    FarFromTheOrigin,
    Repeated,
    MixedMagnitudes,
    AnyBits,
    Extreme,
}

pub const FAMILIES: [Family; 12] = [
    Family::Uniform,
    Family::SmallGrid,
    Family::Tenths,
    Family::NearlyFlat,
    Family::NearlySpherical,
    Family::FlatIntegers,
    Family::SphericalIntegers,
    Family::FarFromTheOrigin,
    Family::Repeated,
    Family::MixedMagnitudes,
    Family::AnyBits,
    Family::Extreme,
];

/// A case of some family, at some scale, perhaps moved by units in the last place.
pub fn case(random: &mut Random) -> (Family, Case) {
    // The wide families are slow to decide exactly, and less rich.
    let family = match random.below(32) {
        draw @ 0..27 => FAMILIES[(draw / 3) as usize],
        27 | 28 => Family::MixedMagnitudes,
        29 | 30 => Family::AnyBits,
        _ => Family::Extreme,
    };
    let mut points = shape(random, family);
    let narrow = !matches!(
        family,
        Family::MixedMagnitudes | Family::AnyBits | Family::Extreme
    );
    if narrow {
        points = scaled(points, scale(random));
    }
    let mut weights = weights(random, &points);
    if random.one_in(3) {
        for coordinate in points.iter_mut().flat_map(|p| p.as_mut()) {
            *coordinate = nudged(random, *coordinate);
        }
    }
    if random.one_in(3) {
        weights = weights.map(|w| nudged(random, w));
    }
    (family, Case { points, weights })
}

fn shape(random: &mut Random, family: Family) -> [DVec3; 5] {
    match family {
        Family::Uniform => [(); 5].map(|()| in_cube(random)),
        Family::SmallGrid => {
            let side = [1, 3, 100][random.below(3) as usize];
            [(); 5].map(|()| integer_point(random, side))
        }
        Family::Tenths => [(); 5].map(|()| integer_point(random, 20) * 0.1),
        Family::NearlyFlat => nearly_flat(random),
        Family::NearlySpherical => nearly_spherical(random),
        Family::FlatIntegers => flat_integers(random),
        Family::SphericalIntegers => spherical_integers(random),
        Family::FarFromTheOrigin => {
            let origin = DVec3::new(500_000.0, 5_400_000.0, 300.0);
            [(); 5].map(|()| integer_point(random, 40) * 0.001 + origin)
        }
        Family::Repeated => {
            let points = [(); 5].map(|()| integer_point(random, 9) * 0.3);
            from_fn(|_| points[random.below(4) as usize])
        }
        Family::MixedMagnitudes => {
            let range = [60, 1000][random.below(2) as usize];
            let coordinate = |random: &mut Random| {
                random.signed() * f64::powi(2.0, random.between(-range, range))
            };
            [(); 5].map(|()| DVec3::from_array([(); 3].map(|()| coordinate(random))))
        }
        Family::AnyBits => [(); 5].map(|()| DVec3::from_array([(); 3].map(|()| any_bits(random)))),
        Family::Extreme => [(); 5].map(|()| DVec3::from_array([(); 3].map(|()| extreme(random)))),
    }
}

fn in_cube(random: &mut Random) -> DVec3 {
    DVec3::from_array([(); 3].map(|()| random.signed()))
}

fn integer_point(random: &mut Random, most: i32) -> DVec3 {
    DVec3::from_array([(); 3].map(|()| f64::from(random.between(-most, most))))
}

fn any_bits(random: &mut Random) -> f64 {
    loop {
        let value = f64::from_bits(random.bits());
        if value.is_finite() {
            return value;
        }
    }
}

fn extreme(random: &mut Random) -> f64 {
    let tiny = f64::from_bits(1);
    let values = [
        0.0,
        tiny,
        3.0 * tiny,
        f64::MIN_POSITIVE,
        f64::MIN_POSITIVE.next_down(),
        1.0,
        1.0 + f64::EPSILON,
        1e-300,
        1e300,
        f64::MAX,
        f64::MAX.next_down(),
    ];
    let value = values[random.below(values.len() as u64) as usize];
    if random.one_in(2) { value } else { -value }
}

/// The last two points on the line or in the plane of the first ones, up to rounding.
fn nearly_flat(random: &mut Random) -> [DVec3; 5] {
    let [a, b, c] = [(); 3].map(|()| in_cube(random));
    let c = if random.one_in(3) {
        a + 2.0 * random.signed() * (b - a)
    } else {
        c
    };
    let mut combined = || a + 2.0 * random.signed() * (b - a) + 2.0 * random.signed() * (c - a);
    [a, b, c, combined(), combined()]
}

/// On a sphere, or on its equator in the xy-plane, up to rounding.
fn nearly_spherical(random: &mut Random) -> [DVec3; 5] {
    let centre = 4.0 * in_cube(random);
    let radius = f64::powi(2.0, random.between(-3, 3)) * (1.5 + random.signed());
    let flatten = DVec3::new(1.0, 1.0, f64::from(random.between(0, 1)));
    [(); 5].map(|()| centre + radius * (in_cube(random) * flatten).normalize_or(DVec3::X))
}

/// Exactly on a line or in a plane.
fn flat_integers(random: &mut Random) -> [DVec3; 5] {
    let most = [20, 2_000, 1 << 20][random.below(3) as usize];
    let (p, mut q) = (integer_point(random, most), integer_point(random, most));
    if random.one_in(3) {
        q = DVec3::ZERO;
    }
    let mut factor = || f64::from(random.between(-9, 9));
    [(); 5].map(|()| factor() * p + factor() * q)
}

/// Exactly on a sphere, often on a circle too: signed permutations of one vector about a centre.
fn spherical_integers(random: &mut Random) -> [DVec3; 5] {
    // From what doubles evaluate exactly to what needs more than 128 bits.
    let most = [40, 2_000, 1 << 20, 1 << 28][random.below(4) as usize];
    let v = integer_point(random, most).to_array();
    let centre = integer_point(random, 9);
    let flat = random.one_in(2);
    [(); 5].map(|()| {
        let mut order = random.order::<3>();
        if flat {
            order = [[0, 1, 2], [1, 0, 2]][random.below(2) as usize];
        }
        let signs = random.bits();
        let turned = |k: usize| {
            if signs >> k & 1 == 1 {
                -v[order[k]]
            } else {
                v[order[k]]
            }
        };
        centre + DVec3::from_array(from_fn(turned))
    })
}

/// An exponent: mostly none or at the ends, also where some products underflow and others do not.
fn scale(random: &mut Random) -> i32 {
    match random.below(8) {
        0..3 => 0,
        3 => random.between(-1000, 1000),
        4 => 1000,
        5 => -1000,
        6 => random.between(-380, -180),
        _ => random.between(180, 350),
    }
}

/// Times 2^exponent, or as much of it as leaves the points finite.
fn scaled(points: [DVec3; 5], exponent: i32) -> [DVec3; 5] {
    let largest = points.iter().map(|p| p.abs().max_element());
    let bits = largest.fold(1.0, f64::max).log2().ceil() as i32;
    let exponent = exponent.min(1020 - bits);
    points.map(|p| p * f64::powi(2.0, exponent / 2) * f64::powi(2.0, exponent - exponent / 2))
}

/// Moved by up to two units in the last place, one time in four.
fn nudged(random: &mut Random, value: f64) -> f64 {
    let moved = match random.below(16) {
        0 => value.next_up(),
        1 => value.next_down(),
        2 => value.next_up().next_up(),
        3 => value.next_down().next_down(),
        _ => value,
    };
    if moved.is_finite() { moved } else { value }
}

fn weights(random: &mut Random, points: &[DVec3; 5]) -> [f64; 5] {
    let unit = extent(points);
    let finite = |value: f64| match value {
        value if value.is_nan() => 0.0,
        value => value.clamp(f64::MIN, f64::MAX),
    };
    match random.below(8) {
        // The same for all.
        0 => [any_bits(random); 5],
        // Few units, as wide as the points.
        1 => [(); 5].map(|()| finite(f64::from(random.between(-3, 3)) * unit * unit)),
        // A share of the squared extent.
        2 | 3 => {
            let share = f64::powi(2.0, random.between(-70, 70));
            [(); 5].map(|()| finite(random.signed() * share * unit * unit))
        }
        // The lifts on one hyperplane, exactly or up to rounding: all points orthogonal to one sphere.
        4..7 => {
            let centre = match random.below(3) {
                0 => DVec3::ZERO,
                1 => points[0],
                _ => points[0] + integer_point(random, 3) * unit,
            };
            let squared_radius = f64::from(random.between(-9, 9)) * unit * unit;
            points.map(|p| finite(p.distance_squared(centre) - squared_radius))
        }
        _ => match random.below(2) {
            0 => [(); 5].map(|()| any_bits(random)),
            _ => [(); 5].map(|()| extreme(random)),
        },
    }
}

/// The power of two just below the largest coordinate difference.
fn extent(points: &[DVec3; 5]) -> f64 {
    let largest = points.iter().map(|p| (*p - points[0]).abs().max_element());
    match largest.fold(0.0, f64::max).log2().floor() as i32 {
        exponent if exponent < -1022 => 1.0,
        exponent => f64::powi(2.0, exponent.min(1023)),
    }
}
