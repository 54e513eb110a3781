//! Each stage decides the input that it is made for; otherwise the tests of the stages would be empty.

use crate::{
    Sign, StaticFilter, StaticFilter2, exact, filter, fixed, insphere, lattice, orient3d,
    unfiltered,
};
use glam::{DVec2, DVec3};

const TETRAHEDRON: [DVec3; 4] = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];

#[test]
fn filters_decide_easy_input() {
    let [a, b, c, d] = TETRAHEDRON;
    let inside = DVec3::splat(0.3);
    let fixed = StaticFilter::from_bounds(DVec3::ZERO, DVec3::ONE);
    assert_eq!(
        fixed.insphere_filtered(a, b, c, d, inside),
        Some(Sign::Positive)
    );
    assert_eq!(
        fixed.insphere_filtered(b, a, c, d, inside),
        Some(Sign::Negative)
    );
    assert_eq!(fixed.orient3d_filtered(a, b, c, d), Some(Sign::Positive));
    assert_eq!(filter::insphere(a, b, c, d, inside), Some(Sign::Positive));
    assert_eq!(filter::orient3d(a, b, c, d), Some(Sign::Positive));
    let fixed = StaticFilter2::from_bounds(DVec2::ZERO, DVec2::ONE);
    let [a, b, c, inside] = [a, b, c, inside].map(|p| p.truncate());
    assert_eq!(fixed.orient2d_filtered(a, b, c), Some(Sign::Positive));
    assert_eq!(
        fixed.incircle_filtered(a, b, c, inside),
        Some(Sign::Positive)
    );
    assert_eq!(filter::orient2d(a, b, c), Some(Sign::Positive));
    assert_eq!(filter::incircle(a, b, c, inside), Some(Sign::Positive));
}

/// Points of one plane z = const have zero determinants: no arithmetic is needed to see it.
#[test]
fn flat_input_is_seen_at_once() {
    let [a, b, c] = [
        DVec3::new(0.1, 0.2, 0.7),
        DVec3::new(0.9, 0.3, 0.7),
        DVec3::new(0.4, 0.8, 0.7),
    ];
    let d = DVec3::new(0.3, 0.3, 0.7);
    assert_eq!(filter::orient3d(a, b, c, d), Some(Sign::Zero));
    assert_eq!(filter::insphere(a, b, c, d, a), Some(Sign::Zero));
}

#[test]
fn the_slides_bound_is_ours() {
    // |x|, |y| ≤ M = 1 in the box of side 2: the last sign below 2⁻⁴⁸ M² is left undecided, and one above
    // the bound (with its slack of a four-hundredth) is not.
    let fixed = StaticFilter2::from_bounds(DVec2::splat(-1.0), DVec2::splat(1.0));
    let value =
        |height: f64| fixed.orient2d_filtered(DVec2::ZERO, DVec2::X, DVec2::new(0.5, height));
    let bound = f64::powi(2.0, -48);
    assert_eq!(value(bound), None);
    assert_eq!(value(bound * 1.01), Some(Sign::Positive));
}

#[test]
fn a_box_out_of_range_decides_nothing() {
    let [a, b, c, d] = TETRAHEDRON;
    let e = DVec3::splat(0.3);
    for max in [
        DVec3::new(1.0, 1.0, 0.0),
        DVec3::new(1.0, 1.0, 1e-60),
        DVec3::splat(1e60),
    ] {
        let fixed = StaticFilter::from_bounds(DVec3::ZERO, max);
        let scaled = [a, b, c, d, e].map(|p| p * max);
        let [a, b, c, d, e] = scaled;
        assert_eq!(fixed.insphere_filtered(a, b, c, d, e), None);
        assert_eq!(fixed.insphere(a, b, c, d, e), insphere(a, b, c, d, e));
    }
    // Corners given in the wrong order or not at all.
    for (min, max) in [
        (DVec3::ONE, DVec3::ZERO),
        (DVec3::INFINITY, DVec3::NEG_INFINITY),
    ] {
        let fixed = StaticFilter::from_bounds(min, max);
        assert!(format!("{fixed:?}").contains("insphere: inf"));
    }
}

#[test]
fn lattices_decide_grids_at_every_scale() {
    for exponent in (-875..=1000).step_by(125) {
        let scale = f64::powi(2.0, exponent);
        let corner = DVec3::new(90.0, -17.0, 33.0);
        let [a, b, c, d] = TETRAHEDRON.map(|p| (p + corner) * scale);
        let e = (DVec3::ONE + corner) * scale;
        assert_eq!(
            lattice::insphere(a, b, c, d, e),
            Some(Sign::Zero),
            "2^{exponent}"
        );
        assert_eq!(
            lattice::orient3d(a, b, c, d),
            Some(Sign::Positive),
            "2^{exponent}"
        );
        let [a, b, c, e] = [a, b, c, e].map(|p| p.truncate());
        assert_eq!(
            lattice::incircle(a, b, c, e),
            Some(Sign::Zero),
            "2^{exponent}"
        );
        assert_eq!(
            lattice::orient2d(a, b, c),
            Some(Sign::Positive),
            "2^{exponent}"
        );
    }
}

/// The largest differences that a lattice takes, in the corners of a cube, where determinants are largest.
#[test]
fn lattices_hold_their_largest_values() {
    let side = f64::powi(2.0, 24) - 1.0;
    let corner = |i: u32| DVec3::new((i & 1) as f64, (i >> 1 & 1) as f64, (i >> 2) as f64) * side;
    let mut decided = 0;
    for i in 0..8_u32.pow(5) {
        let [a, b, c, d, e] = std::array::from_fn(|k| corner(i >> (3 * k) & 7));
        if [a, b, c, d] == [e; 4] {
            continue;
        }
        assert_eq!(lattice::insphere(a, b, c, d, e), Some(Sign::Zero));
        // Inside by one unit of the lattice.
        let nearer = DVec3::new((e.x - 1.0).abs(), e.y, e.z);
        let sign = lattice::insphere(a, b, c, d, nearer);
        assert_eq!(sign, fixed::insphere(a, b, c, d, nearer));
        assert_eq!(sign, Some(orient3d(a, b, c, d)));
        decided += u32::from(sign != Some(Sign::Zero));
    }
    // The tetrahedra of a cube's corners: 58 of its 70 quadruples, in 24 orders, with 8 queries.
    assert_eq!(decided, 58 * 24 * 8);
}

/// Signed permutations of one vector are cospherical, whatever its size: where doubles begin to round,
/// integers must have taken over.
#[test]
fn cospherical_integers_of_every_size() {
    let orders = [
        [0, 1, 2],
        [0, 2, 1],
        [1, 0, 2],
        [1, 2, 0],
        [2, 0, 1],
        [2, 1, 0],
    ];
    for bits in 4..=23 {
        let size = f64::powi(2.0, bits);
        let v = [0.97, 0.61, 0.34].map(|c| (c * size / 2.0).round());
        let image = |k: usize| {
            let mut p = orders[k % 6].map(|i| v[i]);
            for (axis, coordinate) in p.iter_mut().enumerate() {
                *coordinate *= [1.0, -1.0][((k / 6) >> axis) & 1];
            }
            DVec3::from_array(p)
        };
        for k in 0..2000 {
            let [a, b, c, d, e] =
                [k, 7 * k + 1, 11 * k + 5, 17 * k + 9, 29 * k + 40].map(|k| image(k % 48));
            if a != e {
                assert_eq!(
                    lattice::insphere(a, b, c, d, e),
                    Some(Sign::Zero),
                    "2^{bits}"
                );
            }
            // On one circle: the images that permute and turn x and y alone.
            let [a, b, c, d] =
                [a, b, c, d].map(|p| DVec2::new(p.x.signum() * v[0], p.y.signum() * v[1]));
            let d = DVec2::new(d.y, d.x);
            if a != d {
                assert_eq!(lattice::incircle(a, b, c, d), Some(Sign::Zero), "2^{bits}");
            }
        }
    }
}

/// Differences of just 75 bits and more, in units that the last bits of the query set.
#[test]
fn fixed_width_holds_its_largest_values() {
    let corner = |i: u32| DVec3::new((i & 1) as f64, (i >> 1 & 1) as f64, (i >> 2) as f64);
    let mut decided = 0;
    for bits in 70..=100 {
        let side = f64::powi(2.0, bits);
        for i in 0..8_u32.pow(4) {
            let [a, b, c, d] = std::array::from_fn(|k| corner(i >> (3 * k) & 7) * side);
            let orientation = orient3d(a, b, c, d);
            if orientation == Sign::Zero {
                continue;
            }
            // Near one corner, outside by one unit and inside by one; then far inside.
            let inside = DVec3::new(1.0, side / 2.0, side / 2.0);
            for (e, sign) in [
                (-DVec3::X, -orientation),
                (DVec3::X, orientation),
                (inside, orientation),
            ] {
                let fixed = fixed::insphere(a, b, c, d, e);
                assert!(fixed.is_none_or(|fixed| fixed == sign), "2^{bits} {i} {e}");
                // At 75 it depends on whether a difference reaches the full side.
                assert!(bits == 75 || fixed.is_some() == (bits < 75), "2^{bits}");
                decided += u32::from(fixed.is_some());
                if i % 97 == 0 {
                    assert_eq!(exact::insphere(a, b, c, d, e), sign);
                }
            }
            let e = DVec3::new(1.0, 1.0, side);
            assert!(
                fixed::orient3d(a, b, c, e).is_none_or(|sign| sign == exact::orient3d(a, b, c, e))
            );
        }
    }
    assert!(decided >= 5 * 3 * 58 * 24, "{decided}");
}

#[test]
fn fixed_width_decides_rounded_spheres() {
    let sphere = [
        [0.1, 0.7, 0.3],
        [-0.4, 0.2, 0.9],
        [0.6, -0.5, 0.2],
        [0.3, 0.3, -0.8],
        [-0.7, -0.1, -0.1],
    ];
    let [a, b, c, d, e] = sphere.map(|p| DVec3::from_array(p).normalize());
    let sign = exact::insphere(a, b, c, d, e);
    assert_eq!(lattice::insphere(a, b, c, d, e), None);
    assert_eq!(fixed::insphere(a, b, c, d, e), Some(sign));
}

#[test]
fn intervals_decide_mixed_magnitudes() {
    let [a, b] = [DVec3::new(1e60, 1.0, 1.0), DVec3::new(1.0, 1e-60, 1.0)];
    let [c, d] = [DVec3::new(1.0, 1.0, 1e40), DVec3::ZERO];
    assert_eq!(filter::orient3d(a, b, c, d), None);
    assert_eq!(lattice::orient3d(a, b, c, d), None);
    assert_eq!(fixed::orient3d(a, b, c, d), None);
    // −det[a, b, c] = 10⁶⁰ (1 − 10⁻²⁰ …)
    assert_eq!(
        unfiltered::interval_orient3d(a, b, c, d).sign(),
        Some(Sign::Positive)
    );
    assert_eq!(exact::orient3d(a, b, c, d), Sign::Positive);
}

#[cfg(feature = "statistics")]
#[test]
fn statistics_count_the_deciding_stage() {
    use crate::statistics::{Counts, Predicate, Stage, reset, snapshot};
    let [a, b, c, d] = TETRAHEDRON;
    let fixed = StaticFilter::from_bounds(DVec3::ZERO, DVec3::ONE);
    reset();
    assert_eq!(snapshot(), Counts::default());
    fixed.insphere_perturbed(a, b, c, d, DVec3::splat(0.3));
    fixed.insphere_perturbed(a, b, c, d, DVec3::ONE);
    insphere(a, b, c, d, DVec3::splat(0.3));
    let counts = snapshot();
    let of = |stage| counts.of(Predicate::InSphere, stage);
    assert_eq!((of(Stage::Static), of(Stage::SemiStatic)), (1, 1));
    assert_eq!((of(Stage::Lattice), of(Stage::Perturbation)), (1, 1));
    // The largest point is the query: one orientation decides.
    assert_eq!(counts.of(Predicate::Orient3d, Stage::SemiStatic), 1);
}
