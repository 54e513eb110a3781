//! Evolution with changes of topology, on clouds whose topology is known.

use pellicle::prelude::*;
use pellicle::{ADAPTING_GAP, evolve_adapting};
use std::f64::consts::{PI, TAU};

fn sphere(center: DVec3, radius: f64, count: u32) -> Vec<DVec3> {
    let point = |i: u32| {
        let z = 1.0 - (2.0 * f64::from(i) + 1.0) / f64::from(count);
        let (sin, cos) = (2.399_963 * f64::from(i)).sin_cos();
        center + radius * (DVec3::new(cos, sin, 0.0) * (1.0 - z * z).sqrt() + DVec3::Z * z)
    };
    (0..count).map(point).collect()
}

fn torus(center: DVec3, large: f64, small: f64) -> Vec<DVec3> {
    let point = |i: u32, j: u32| {
        let (u, v) = (TAU * f64::from(i) / 120.0, TAU * f64::from(j) / 45.0);
        let around = DVec3::new(u.cos(), u.sin(), 0.0);
        center + (large + small * v.cos()) * around + small * v.sin() * DVec3::Z
    };
    (0..120)
        .flat_map(|i| (0..45).map(move |j| point(i, j)))
        .collect()
}

/// Evolves, and checks all that does not depend on the shape. Returns each component's genus, sorted, and the volume.
fn evolved(points: &[DVec3]) -> (Vec<usize>, f64) {
    let options = evolution::Options {
        resolution: 100,
        ..evolution::Options::default()
    };
    let evolved = evolve_adapting(points, &options, ADAPTING_GAP, &(), &mut |_, mesh| {
        assert!(mesh.is_closed());
    });
    let evolved = evolved.unwrap();
    assert!(evolved.report.at_rest);
    assert_eq!(evolved.report.held, 0);
    let view = mesh::MeshView::from(&evolved.mesh);
    assert_eq!(mesh::count_self_intersections(view, &()).unwrap(), 0);
    let summary = mesh::summarize(view).unwrap();
    let mut genus: Vec<usize> = summary
        .components
        .iter()
        .map(|c| c.genus().unwrap())
        .collect();
    genus.sort_unstable();
    (genus, mesh::signed_volume(view))
}

#[test]
fn one_surface_becomes_several() {
    let radii = [1.0, 0.7, 0.9];
    let centers = [-2.0 * DVec3::X, 2.0 * DVec3::X, DVec3::new(0.3, 2.5, 0.5)];
    let points: Vec<DVec3> = (centers.into_iter().zip(radii))
        .flat_map(|(center, radius)| sphere(center, radius, 2500))
        .collect();
    let (genus, volume) = evolved(&points);
    assert_eq!(genus, [0, 0, 0]);
    let exact: f64 = radii.map(|r: f64| 4.0 / 3.0 * PI * r.powi(3)).iter().sum();
    assert!((volume / exact - 1.0).abs() < 0.05, "{volume} {exact}");
}

#[test]
fn a_handle_opens() {
    let (genus, volume) = evolved(&torus(DVec3::ZERO, 1.0, 0.4));
    assert_eq!(genus, [1]);
    let exact = 2.0 * PI * PI * 0.16;
    assert!((volume / exact - 1.0).abs() < 0.05, "{volume} {exact}");
}

#[test]
fn handles_open_in_parts() {
    let tori = [-1.8, 1.8].map(|x| torus(x * DVec3::X, 1.0, 0.35));
    assert_eq!(evolved(&tori.concat()).0, [1, 1]);
}

#[test]
fn what_is_whole_stays_whole() {
    assert_eq!(evolved(&sphere(DVec3::ONE, 3.0, 3000)).0, [0]);
}

#[test]
fn a_gap_must_be_positive() {
    let points = sphere(DVec3::ZERO, 1.0, 500);
    for gap in [0.0, -1.0, f64::NAN] {
        let result = evolve_adapting(&points, &Default::default(), gap, &(), &mut |_, _| {});
        assert!(matches!(result, Err(evolution::Error::Option { .. })));
    }
}
