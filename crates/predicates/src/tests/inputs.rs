//! Points that are random, degenerate, or degenerate but for a few units in the last place.

use glam::{DVec2, DVec3};
use proptest::prelude::*;
use std::array::from_fn;

/// Five points of space; the plane's predicates take x and y.
pub(super) type Points = [DVec3; 5];

fn points_of(coordinate: impl Strategy<Value = f64> + Clone + 'static) -> BoxedStrategy<Points> {
    let point = [coordinate.clone(), coordinate.clone(), coordinate].prop_map(DVec3::from_array);
    proptest::array::uniform5(point).boxed()
}

/// Multiplies by 2^exponent in two steps, each a normal factor.
fn scaled(points: Points, exponent: i32) -> Points {
    let half = exponent / 2;
    points.map(|p| p * f64::powi(2.0, half) * f64::powi(2.0, exponent - half))
}

/// Often where some products of coordinates underflow and others do not.
fn exponent() -> BoxedStrategy<i32> {
    prop_oneof![3 => Just(0), 1 => -20..=20, 2 => -1000..=1000, 1 => -1074..=-1000, 1 => Just(1000), 2 => -380..=-180, 1 => 180..=350]
        .boxed()
}

fn extreme() -> BoxedStrategy<f64> {
    let tiny = f64::from_bits(1);
    let values = vec![
        0.0,
        -0.0,
        tiny,
        -tiny,
        f64::MIN_POSITIVE,
        -f64::MIN_POSITIVE.next_down(),
        1.0,
        -1.0,
        1.0 + f64::EPSILON,
        1e300,
        -1e300,
        f64::MAX,
        f64::MIN,
        f64::MAX.next_down(),
    ];
    proptest::sample::select(values).boxed()
}

/// Moves each coordinate by up to two units in the last place.
fn nudged(points: BoxedStrategy<Points>) -> BoxedStrategy<Points> {
    let moves = proptest::array::uniform15(prop_oneof![6 => Just(0), 1 => -2..=2]);
    (points, moves)
        .prop_map(|(points, moves)| {
            from_fn(|i| DVec3::from_array(from_fn(|k| stepped(points[i][k], moves[3 * i + k]))))
        })
        .boxed()
}

/// The last two points on the line or in the plane of the first ones, up to rounding.
fn near_flat() -> BoxedStrategy<Points> {
    let weights = proptest::array::uniform4(-2.0..2.0);
    (points_of(-1.0..1.0), weights, any::<bool>())
        .prop_map(|([a, b, c, ..], w, line)| {
            let c = if line { a + w[2] * (b - a) } else { c };
            let d = a + w[0] * (b - a) + w[1] * (c - a);
            [a, b, c, d, a + w[3] * (b - a)]
        })
        .boxed()
}

/// On a sphere whose equator is a circle of the xy-plane, up to rounding.
fn near_sphere() -> BoxedStrategy<Points> {
    let center = [-4.0..4.0, -4.0..4.0, -4.0..4.0].prop_map(DVec3::from_array);
    (points_of(-1.0..1.0), center, any::<bool>(), 0.1..8.0)
        .prop_map(|(points, center, equator, radius)| {
            points.map(|p| {
                let p = if equator {
                    p * DVec3::new(1.0, 1.0, 0.0)
                } else {
                    p
                };
                center + radius * p.normalize_or(DVec3::X)
            })
        })
        .boxed()
}

/// Exactly on a sphere: signed permutations of one integer vector about a centre. In the plane the first
/// two coordinates lie on a circle when the third does not take part.
fn sphere_of_integers() -> BoxedStrategy<Points> {
    // From what doubles evaluate exactly to what needs more than 128 bits.
    let size = prop_oneof![Just(40_i32), Just(2_000), Just(1 << 20), Just(1 << 28)];
    let vector = size.prop_flat_map(|n| [0..n, 0..n, 0..n]);
    let images = proptest::array::uniform5((0..6_usize, 0..8_u32));
    (vector, images, any::<bool>(), -9..9_i32)
        .prop_map(|(v, images, flat, center)| {
            images.map(|(order, signs)| {
                let mut image = match order {
                    _ if flat && order % 2 == 0 => [v[0], v[1], v[2]],
                    _ if flat => [v[1], v[0], v[2]],
                    0 => [v[0], v[1], v[2]],
                    1 => [v[0], v[2], v[1]],
                    2 => [v[1], v[0], v[2]],
                    3 => [v[1], v[2], v[0]],
                    4 => [v[2], v[0], v[1]],
                    _ => [v[2], v[1], v[0]],
                };
                for (k, coordinate) in image.iter_mut().enumerate() {
                    if signs >> k & 1 == 1 {
                        *coordinate = -*coordinate;
                    }
                }
                DVec3::from_array(image.map(|c| f64::from(c + center)))
            })
        })
        .boxed()
}

/// Exactly on a line or in a plane, in integers.
fn flat_integers() -> BoxedStrategy<Points> {
    let size = prop_oneof![Just(20_i32), Just(2_000), Just(1 << 20)];
    let vectors = size.prop_flat_map(|n| [[-n..n, -n..n, -n..n], [-n..n, -n..n, -n..n]]);
    let weights = proptest::array::uniform5([-9..=9_i32, -9..=9_i32]);
    (vectors, weights, any::<bool>())
        .prop_map(|(vectors, weights, line)| {
            let [p, q] = vectors.map(|v| DVec3::from_array(v.map(f64::from)));
            let q = if line { DVec3::ZERO } else { q };
            weights.map(|[s, t]| f64::from(s) * p + f64::from(t) * q)
        })
        .boxed()
}

fn small_grid() -> BoxedStrategy<Points> {
    points_of((-3..=3_i32).prop_map(f64::from))
}

/// Far from the origin, as measured coordinates are.
fn shifted() -> BoxedStrategy<Points> {
    let digits = (-40..=40_i32).prop_map(|i| f64::from(i) * 0.001);
    points_of(digits)
        .prop_map(|points| points.map(|p| p + DVec3::new(500_000.0, 5_400_000.0, 300.0)))
        .boxed()
}

fn mixed_magnitudes() -> BoxedStrategy<Points> {
    let value = (-1.0..1.0, prop_oneof![-1000..=1000_i32, -60..=60_i32])
        .prop_map(|(m, e): (f64, i32)| m * f64::powi(2.0, e));
    points_of(value)
}

fn any_finite() -> BoxedStrategy<Points> {
    points_of(any::<u64>().prop_map(|bits| {
        let value = f64::from_bits(bits);
        if value.is_finite() {
            value
        } else {
            f64::from_bits(bits >> 2)
        }
    }))
}

/// All of it.
pub(super) fn points() -> BoxedStrategy<Points> {
    let tenths = points_of((-20..=20_i32).prop_map(|i| f64::from(i) * 0.1));
    let shapes = prop_oneof![
        points_of(-1.0..1.0),
        small_grid(),
        nudged(small_grid()),
        tenths,
        near_flat(),
        nudged(near_flat()),
        near_sphere(),
        flat_integers(),
        nudged(flat_integers()),
        sphere_of_integers(),
        nudged(sphere_of_integers()),
        shifted(),
    ];
    let shapes = (shapes, exponent()).prop_map(|(points, exponent)| {
        // Scaling up may overflow only where coordinates are beyond 2^24.
        let largest = points
            .iter()
            .map(|p| p.abs().max_element())
            .fold(1.0, f64::max);
        scaled(points, exponent.min(1020 - largest.log2().ceil() as i32))
    });
    prop_oneof![
        10 => shapes,
        1 => mixed_magnitudes(),
        1 => any_finite(),
        1 => points_of(extreme()),
        1 => nudged(points_of(extreme())),
    ]
    .boxed()
}

/// Points, and weights that are all the same, few units, a share of the squared extent, such that the lifts lie
/// on one hyperplane (exactly on lattices, elsewhere up to rounding), or anything.
pub(super) fn weighted_points() -> BoxedStrategy<(Points, [f64; 5])> {
    let few = proptest::array::uniform5((-9..=9_i32).prop_map(f64::from));
    let share = (proptest::array::uniform5(-1.0..1.0), -70..=70_i32)
        .prop_map(|(w, e)| w.map(|w| w * f64::powi(2.0, e)));
    let weight = prop_oneof![
        2 => any::<u64>().prop_map(f64::from_bits).prop_filter("finite", |w| w.is_finite()),
        1 => extreme(),
        1 => (-1.0..1.0, -1070..1020_i32).prop_map(|(m, e): (f64, i32)| {
            m * f64::powi(2.0, e / 2) * f64::powi(2.0, e - e / 2)
        }),
    ];
    let absolute = prop_oneof![
        weight.clone().prop_map(|w| [w; 5]),
        proptest::array::uniform5(weight),
    ];
    let moves = proptest::array::uniform5(prop_oneof![6 => Just(0), 1 => -2..=2_i32]);
    let power = [-3..=3_i32, -3..=3_i32, -3..=3_i32, -9..=9_i32];
    let scaled = (points(), prop_oneof![few, share]).prop_map(|(points, weights)| {
        let unit = extent(&points);
        (points, weights.map(|w| finite(w * unit * unit)))
    });
    // Orthogonal to a sphere about a lattice point near the first one.
    let flat = (points(), power, moves).prop_map(|(points, [x, y, z, r], moves)| {
        let unit = extent(&points);
        let centre = points[0] + DVec3::new(x.into(), y.into(), z.into()) * unit;
        let weights = from_fn(|i| {
            let power = points[i].distance_squared(centre) - f64::from(r) * unit * unit;
            stepped(finite(power), moves[i])
        });
        (points, weights)
    });
    prop_oneof![
        3 => scaled,
        3 => flat,
        2 => (points(), absolute),
    ]
    .boxed()
}

/// The power of two just below the largest coordinate difference.
fn extent(points: &Points) -> f64 {
    let mut largest = 0.0;
    for p in points {
        largest = f64::max(largest, (*p - points[0]).abs().max_element());
    }
    match largest.log2().floor() as i32 {
        exponent if exponent < -1022 => 1.0,
        exponent => f64::powi(2.0, exponent.min(1023)),
    }
}

/// What overflowed becomes the largest double, NaN zero.
fn finite(value: f64) -> f64 {
    if value.is_nan() {
        0.0
    } else {
        value.clamp(f64::MIN, f64::MAX)
    }
}

fn stepped(value: f64, steps: i32) -> f64 {
    let next = |value: f64| {
        if steps > 0 {
            value.next_up()
        } else {
            value.next_down()
        }
    };
    let moved = (0..steps.abs()).fold(value, |value, _| next(value));
    if moved.is_finite() { moved } else { value }
}

/// The first points without z.
pub(super) fn plane<const N: usize>(points: &Points) -> [DVec2; N] {
    from_fn(|i| points[i].truncate())
}

/// The first points.
pub(super) fn space<const N: usize>(points: &Points) -> [DVec3; N] {
    from_fn(|i| points[i])
}
