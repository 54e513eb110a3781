//! Qualities against closed forms and against the measures that use connectivity.

mod common;

use common::*;
use pellicle_geometry::DVec3;
use pellicle_mesh::{AngleBounds, TriangleSoup, icosphere, quality, summarize};
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

fn measured(soup: &TriangleSoup) -> pellicle_mesh::Quality {
    quality(soup.into(), &AngleBounds::default()).expect("a triangle")
}

#[test]
fn nothing_to_measure() {
    assert_eq!(
        quality((&TriangleSoup::default()).into(), &AngleBounds::default()),
        None
    );
    let unusable = soup(
        vec![DVec3::ZERO, DVec3::X, DVec3::NAN],
        &[[0, 1, 2], [0, 0, 1], [0, 1, 9]],
    );
    assert_eq!(quality((&unusable).into(), &AngleBounds::default()), None);
}

#[test]
fn a_right_triangle_and_its_double() {
    // Areas 1/2 and 2; the vertices have 5/6, 5/6, 1/6 and 2/3 of them.
    let pair = soup(
        vec![DVec3::ZERO, DVec3::X, DVec3::Y, 4.0 * DVec3::Z],
        &[[0, 1, 2], [0, 3, 1]],
    );
    let q = measured(&pair);
    assert_eq!(q.triangles, 2);
    assert!((q.min_angle - 0.25_f64.atan()).abs() < 1e-15);
    assert!((q.max_angle - FRAC_PI_2).abs() < 1e-15);
    assert_eq!((q.small_angles, q.large_angles), (1, 0));
    assert_eq!((q.min_area, q.max_area, q.mean_area), (0.5, 2.0, 1.25));
    assert!((q.area_variation - 0.75 / 1.25).abs() < 1e-15);
    let of_vertices = [5.0 / 6.0, 5.0 / 6.0, 1.0 / 6.0, 2.0 / 3.0];
    let mean: f64 = of_vertices.iter().sum::<f64>() / 4.0;
    let square: f64 = of_vertices.iter().map(|a| (a - mean) * (a - mean)).sum();
    assert!((q.vertex_area_variation - (square / 4.0).sqrt() / mean).abs() < 1e-15);
    let sides = 2.0 + 2.0_f64.sqrt() + 5.0 + 17.0_f64.sqrt();
    assert!((q.mean_edge - sides / 6.0).abs() < 1e-15);
}

#[test]
fn bounds_count_on_either_side() {
    let right = soup(vec![DVec3::ZERO, DVec3::X, DVec3::Y], &[[0, 1, 2]]);
    let count = |small, large| {
        let q = quality((&right).into(), &AngleBounds { small, large }).unwrap();
        (q.small_angles, q.large_angles)
    };
    assert_eq!(count(FRAC_PI_4 - 1e-9, FRAC_PI_2 + 1e-9), (0, 0));
    assert_eq!(count(FRAC_PI_4 + 1e-9, FRAC_PI_2 - 1e-9), (2, 1));
    assert_eq!(count(3.0, FRAC_PI_4 - 1e-9), (3, 3));
}

#[test]
fn degenerate_triangles_are_measured() {
    let flat = soup(vec![DVec3::ZERO, DVec3::X, 2.0 * DVec3::X], &[[0, 1, 2]]);
    let q = measured(&flat);
    assert_eq!((q.min_angle, q.max_area, q.area_variation), (0.0, 0.0, 0.0));
    assert!((q.max_angle.to_degrees() - 180.0).abs() < 1e-12);
}

#[test]
fn agrees_with_the_summary_and_with_scaling() {
    let sphere = icosphere(3).unwrap();
    let q = quality((&sphere).into(), &AngleBounds::default()).unwrap();
    let summary = summarize((&sphere).into()).unwrap();
    let shape = summary.shape.unwrap();
    assert_eq!(
        (q.min_angle, q.max_angle),
        (shape.min_angle, shape.max_angle)
    );
    // Closed: each edge is a side twice.
    assert!((q.mean_edge - shape.mean_edge).abs() < 1e-14);
    assert!((q.mean_area * q.triangles as f64 - summary.area).abs() < 1e-12);

    for scale in [2.0_f64.powi(-300), 2.0_f64.powi(300)] {
        let mut scaled = sphere.clone();
        scaled
            .set_positions(sphere.positions().iter().map(|&p| p * scale).collect())
            .unwrap();
        let s = quality((&scaled).into(), &AngleBounds::default()).unwrap();
        assert_eq!(s.area_variation, q.area_variation);
        assert_eq!(s.vertex_area_variation, q.vertex_area_variation);
        assert_eq!(s.mean_edge, q.mean_edge * scale);
        assert_eq!((s.min_angle, s.max_angle), (q.min_angle, q.max_angle));
    }
    // Equal areas: no variation but rounding.
    assert!(
        quality((&icosphere(0).unwrap()).into(), &AngleBounds::default())
            .unwrap()
            .area_variation
            < 1e-14
    );
}
