//! Measures of a triangle against closed forms and brute force.

use pellicle_geometry::{Aabb, DVec3, triangle};
use proptest::prelude::*;
use std::f64::consts::PI;

fn point() -> impl Strategy<Value = DVec3> {
    prop_oneof![
        [-1.0..1.0, -1.0..1.0, -1.0..1.0].prop_map(DVec3::from_array),
        // Few values: coinciding and collinear corners are common.
        [-1_i8..2, -1_i8..2, -1_i8..2].prop_map(|p| DVec3::from_array(p.map(f64::from))),
    ]
}

/// The least distance to a fine net of points of the triangle: never below the true one, and above it by
/// at most the mesh size.
fn sampled_distance(p: DVec3, [a, b, c]: [DVec3; 3], n: u32) -> f64 {
    let mut least = f64::INFINITY;
    for i in 0..=n {
        for j in 0..=n - i {
            let (u, v) = (f64::from(i) / f64::from(n), f64::from(j) / f64::from(n));
            least = least.min(p.distance(a + (b - a) * u + (c - a) * v));
        }
    }
    least
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(3000))]

    #[test]
    fn closest_point_is_closest(p in point(), a in point(), b in point(), c in point()) {
        let found = triangle::closest_point(p, a, b, c);
        let distance = p.distance(found);
        // In the triangle: no farther from it than rounding, by the same net around `found`.
        let size = a.distance(b).max(a.distance(c));
        let n = 40;
        let grain = 2.0 * size / f64::from(n) + 1e-12;
        prop_assert!(sampled_distance(found, [a, b, c], n) <= grain);
        let sampled = sampled_distance(p, [a, b, c], n);
        prop_assert!(distance <= sampled + 1e-12, "{distance} {sampled}");
        prop_assert!(distance >= sampled - grain);
        let bounds = Aabb::of_points(&[a, b, c]);
        prop_assert_eq!(bounds.distance_squared(found), 0.0);
        prop_assert!(bounds.distance_squared(p) <= p.distance_squared(found));
    }

    #[test]
    fn the_closest_point_satisfies_the_variational_inequality(
        p in point(), a in point(), b in point(), c in point()
    ) {
        // x is the projection of p onto a convex set exactly when (p - x)·(y - x) <= 0 for all y in it.
        let x = triangle::closest_point(p, a, b, c);
        for y in [a, b, c] {
            prop_assert!((p - x).dot(y - x) <= 1e-13, "{}", (p - x).dot(y - x));
        }
    }

    #[test]
    fn angles_area_and_circumradius_agree(a in point(), b in point(), c in point()) {
        let area = triangle::area(a, b, c);
        let angles = triangle::angles(a, b, c);
        let lengths = triangle::edge_lengths(a, b, c);
        prop_assert!(angles.iter().all(|x| (0.0..=PI).contains(x)));
        if area > 1e-6 {
            prop_assert!((angles.iter().sum::<f64>() - PI).abs() < 1e-12);
            // Law of sines: each edge over the sine of the angle across is twice the radius.
            let r = triangle::circumradius(a, b, c);
            for i in 0..3 {
                let opposite = lengths[(i + 1) % 3];
                prop_assert!((opposite / angles[i].sin() / (2.0 * r) - 1.0).abs() < 1e-8);
            }
            prop_assert!((triangle::unit_normal(a, b, c).unwrap().dot(b - a)).abs() < 1e-9);
        }
    }

    #[test]
    fn measures_scale(a in point(), b in point(), c in point(), exponent in -480..480) {
        let s = 2_f64.powi(exponent);
        let (sa, sb, sc) = (a * s, b * s, c * s);
        let close = |x: f64, y: f64| x == y || (x / y - 1.0).abs() < 1e-12;
        prop_assert!(close(triangle::circumradius(sa, sb, sc), triangle::circumradius(a, b, c) * s));
        prop_assert!(close(triangle::area(sa, sb, sc), triangle::area(a, b, c) * s * s));
        prop_assert_eq!(triangle::angles(sa, sb, sc), triangle::angles(a, b, c));
        let lengths = triangle::edge_lengths(a, b, c).map(|l| l * s);
        prop_assert_eq!(triangle::edge_lengths(sa, sb, sc), lengths);
        prop_assert_eq!(triangle::unit_normal(sa, sb, sc), triangle::unit_normal(a, b, c));
    }
}

#[test]
fn slivers_are_measured() {
    // Ten metres long, 1e-17 high: every case distinction by rounded products fails here.
    let (a, b, c) = (DVec3::ZERO, 10.0 * DVec3::X, DVec3::new(5.0, 1e-17, 0.0));
    for (p, expected) in [
        (DVec3::new(2.0, 3.0, 0.0), DVec3::new(2.0, 0.0, 0.0)),
        (DVec3::new(7.0, -3.0, 1.0), DVec3::new(7.0, 0.0, 0.0)),
        (DVec3::new(-7.0, 3.0, 1.0), a),
    ] {
        let found = triangle::closest_point(p, a, b, c);
        assert!(found.distance(expected) < 1e-15, "{found}");
    }
    let [at_a, _, at_c] = triangle::angles(a, b, c);
    assert!((at_a / 2e-18 - 1.0).abs() < 1e-12);
    assert_eq!(at_c, PI);
    let normal = triangle::unit_normal(a, b, c).unwrap();
    assert!(normal.distance(DVec3::Z) <= f64::EPSILON, "{normal}");
}

#[test]
fn degenerate_triangles_have_defined_measures() {
    let (o, x) = (DVec3::ZERO, DVec3::X);
    assert_eq!(triangle::circumradius(o, o, o), 0.0);
    assert_eq!(triangle::circumradius(o, x, 2.0 * x), f64::INFINITY);
    assert_eq!(triangle::angles(o, o, o), [0.0; 3]);
    assert_eq!(triangle::angles(o, x, 2.0 * x), [0.0, PI, 0.0]);
    assert_eq!(triangle::closest_point(x, o, o, o), o);
    assert_eq!(triangle::closest_point(x, o, o, 2.0 * x), x);
    assert_eq!(
        triangle::area(o, 1e300 * x, 1e300 * DVec3::Y),
        f64::INFINITY
    );
    assert_eq!(triangle::power_of_two_near(5.0), 4.0);
    assert_eq!(triangle::power_of_two_near(0.75), 0.5);
}
