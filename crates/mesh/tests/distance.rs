//! Distances against closed forms and brute force.

mod common;

use common::*;
use pellicle_geometry::{Cancelled, DVec3, Progress, triangle};
use pellicle_mesh::{
    DistanceOptions, Distances, MeshError, MeshView, TriangleSoup, compare, distances,
};
use proptest::prelude::*;
use std::ops::ControlFlow;

fn measure(from: &TriangleSoup, to: &TriangleSoup, samples: usize) -> Distances {
    let options = DistanceOptions { samples, seed: 7 };
    distances(from.into(), to.into(), &options, &()).unwrap()
}

fn cloud(points: &[DVec3]) -> TriangleSoup {
    soup(points.to_vec(), &[])
}

#[test]
fn a_raised_sheet_is_its_height_away() {
    let (floor, raised) = (sheet(8, 8), moved(sheet(8, 8), 3.0 * DVec3::Z));
    let d = measure(&raised, &floor, 5000);
    assert_eq!((d.max, d.mean, d.rms), (3.0, 3.0, 3.0));
    assert_eq!(d.points, 81 + 5000);
    // Beside each other: points of [8, 9] × [0, 1] to [0, 1] × [0, 1] are at x - 1, from 7 to 8.
    let d = measure(&moved(sheet(1, 1), 8.0 * DVec3::X), &sheet(1, 1), 20_000);
    assert_eq!((d.max, d.farthest.x), (8.0, 9.0));
    // Mean 7.5, mean square 7.5² + 1/12; the samples are stratified only along the triangles.
    let standard_error = (1.0 / 12.0_f64 / 20_000.0).sqrt();
    assert!((d.mean - 7.5).abs() < 4.0 * standard_error, "{}", d.mean);
    let mean_square = 7.5 * 7.5 + 1.0 / 12.0;
    assert!(
        (d.rms * d.rms - mean_square).abs() < 4.0 * 15.0 * standard_error,
        "{}",
        d.rms
    );
}

#[test]
fn concentric_spheres_are_the_difference_of_radii_away() {
    let mut outer = sphere(3);
    outer.positions.iter_mut().for_each(|p| *p *= 2.0);
    let result = compare(
        (&sphere(3)).into(),
        (&outer).into(),
        &DistanceOptions::default(),
        &(),
    )
    .unwrap();
    // A vertex of the inner one is at most 1 from the outer sphere, and its facets are nearer.
    assert!(result.forward.max <= 1.0 + 1e-12 && result.forward.mean > 0.95);
    assert!((result.backward.max - 1.0).abs() < 1e-12, "{result:?}");
    assert_eq!(
        result.hausdorff(),
        result.backward.max.max(result.forward.max)
    );
    assert!((result.diagonal - 4.0 * 3_f64.sqrt()).abs() < 1e-12);
}

#[test]
fn samples_are_uniform_over_the_area() {
    // Nine tenths of the area lie in the first triangle; count by the distance to a far point.
    let two = soup(
        vec![
            DVec3::ZERO,
            9.0 * DVec3::X,
            2.0 * DVec3::Y,
            -DVec3::X,
            -2.0 * DVec3::Y,
        ],
        &[[0, 1, 2], [0, 3, 4]],
    );
    let n = 10_000;
    // The mean over both of the distance to the plane x = -100 is that of the centroid: Σ area · x / Σ area.
    let wall = soup(
        vec![
            DVec3::new(-100.0, -1e3, -1e3),
            DVec3::new(-100.0, 1e3, -1e3),
            DVec3::new(-100.0, 0.0, 1e3),
        ],
        &[[0, 1, 2]],
    );
    let expected = 100.0 + (9.0 * 3.0 + 1.0 * (-1.0 / 3.0)) / 10.0;
    let d = measure(&two, &wall, n);
    let spread = 9.0 / 18_f64.sqrt();
    assert!(
        (d.mean - expected).abs() < 4.0 * spread / (n as f64).sqrt(),
        "{} {expected}",
        d.mean
    );
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn vertex_distances_are_those_of_brute_force(
        from in prop::collection::vec([-3.0..3.0, -3.0..3.0, -3.0..3.0], 1..20),
        to in prop::collection::vec([-3.0..3.0, -3.0..3.0, -3.0..3.0], 3..20),
        triangles in prop::collection::vec([0..20_u32, 0..20_u32, 0..20_u32], 0..12),
        exponent in prop_oneof![Just(0), Just(-600), Just(700)],
    ) {
        let points = |list: &[[f64; 3]]| -> Vec<DVec3> { list.iter().map(|&p| DVec3::from_array(p)).collect() };
        let (from, to) = (points(&from), points(&to));
        let usable: Vec<[u32; 3]> = triangles
            .into_iter()
            .filter(|[a, b, c]| a != b && b != c && c != a && [a, b, c].iter().all(|v| (**v as usize) < to.len()))
            .collect();
        let exact = |p: DVec3| -> f64 {
            let to_triangles = usable.iter().map(|t| {
                let [a, b, c] = t.map(|v| to[v as usize]);
                p.distance(triangle::closest_point(p, a, b, c))
            });
            let to_points = to.iter().map(|&q| p.distance(q));
            if usable.is_empty() { to_points.fold(f64::MAX, f64::min) } else { to_triangles.fold(f64::MAX, f64::min) }
        };
        let expected: Vec<f64> = from.iter().map(|&p| exact(p)).collect();
        let n = expected.len() as f64;
        let scale = 2_f64.powi(exponent);
        let scaled = |list: &[DVec3]| -> Vec<DVec3> { list.iter().map(|&p| p * scale).collect() };
        let d = measure(&cloud(&scaled(&from)), &soup(scaled(&to), &usable), 100);
        let close = |found: f64, expected: f64| (found - expected).abs() < 1e-11;
        prop_assert!(close(d.max / scale, expected.iter().copied().fold(0.0, f64::max)));
        prop_assert!(close(d.mean / scale, expected.iter().sum::<f64>() / n));
        prop_assert!(close(d.rms / scale, (expected.iter().map(|x| x * x).sum::<f64>() / n).sqrt()));
        prop_assert_eq!(d.points, from.len());
        prop_assert!(close(exact(d.farthest / scale), d.max / scale));
    }
}

#[test]
fn any_number_of_threads_measures_the_same_bits() {
    let (a, b) = (torus(2.0, 0.5, 40, 20), sphere(4));
    let expected = measure(&a, &b, 30_000);
    for threads in [1, 3] {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        assert_eq!(pool.install(|| measure(&a, &b, 30_000)), expected);
    }
    assert_ne!(measure(&a, &b, 29_999).mean, expected.mean);
}

#[test]
fn nothing_to_measure_is_an_error() {
    let nothing = cloud(&[DVec3::NAN]);
    let options = DistanceOptions::default();
    let run = |a: &TriangleSoup, b: &TriangleSoup| distances(a.into(), b.into(), &options, &());
    assert_eq!(
        run(&nothing, &cube()),
        Err(MeshError::NothingToMeasure { side: "the source" })
    );
    assert_eq!(
        run(&cube(), &nothing),
        Err(MeshError::NothingToMeasure { side: "the target" })
    );
    // A surface without area has vertices only; unused vertices of a mesh do not count.
    let mut line = soup(
        vec![DVec3::ZERO, DVec3::X, 2.0 * DVec3::X, 9.0 * DVec3::X],
        &[[0, 1, 2]],
    );
    let d = run(&line, &cloud(&[DVec3::ZERO])).unwrap();
    assert_eq!((d.max, d.mean, d.points), (2.0, 1.0, 3));
    line.triangles.clear();
    assert_eq!(run(&line, &cloud(&[DVec3::ZERO])).unwrap().max, 9.0);
    struct Stop;
    impl Progress for Stop {
        fn step(&self, _: &'static str, _: u64, _: u64) -> ControlFlow<()> {
            ControlFlow::Break(())
        }
    }
    let view: MeshView = (&line).into();
    assert_eq!(
        distances(view, view, &options, &Stop),
        Err(MeshError::Cancelled(Cancelled))
    );
}
