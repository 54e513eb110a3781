//! Normals: consistent, outward, near the true ones; independent of the order of the points.

mod common;

use common::{
    Random, delaunay, double_torus, gradient, implicit, off, options, ply, sphere, torus, xyz,
};
use pellicle_cocone::{Method, normals, normals_with, reconstruct};
use pellicle_geometry::{Cancelled, DVec3, Progress};
use std::f64::consts::PI;
use std::ops::ControlFlow;

fn normals_of(points: &[DVec3]) -> Vec<DVec3> {
    let normals = normals(&delaunay(points));
    assert_eq!(normals.len(), points.len());
    for normal in &normals {
        assert!((normal.length() - 1.0).abs() < 1e-12 || *normal == DVec3::ZERO);
    }
    normals
}

/// Cocones hold the surface only while pole vectors are within π/8 of the normals.
fn check_truth(name: &str, points: &[DVec3], truth: impl Fn(DVec3) -> DVec3) {
    for (p, normal) in points.iter().zip(normals_of(points)) {
        let cosine = normal.dot(truth(*p).normalize());
        assert!(cosine > (PI / 8.0).cos(), "{name}: {cosine} at {p}");
    }
}

#[test]
fn samples_of_known_surfaces_have_their_outward_normals() {
    check_truth("spiral", &sphere(500), |p| p);
    check_truth("sphere.off", &off("analytic/sphere.off"), |p| p);
    check_truth("torus.off", &off("analytic/torus.off"), |p| {
        gradient(
            &|q: DVec3| (q.truncate().length() - 1.0).hypot(q.z) - 0.3,
            p,
        )
    });
    let points = implicit(torus, DVec3::new(1.5, 1.5, 0.5), 0.06, 1);
    check_truth("torus", &points, |p| gradient(&torus, p));
    let points = implicit(double_torus, DVec3::new(1.2, 0.8, 0.3), 0.03, 2);
    check_truth("genus two", &points, |p| gradient(&double_torus, p));
}

#[test]
fn each_of_several_spheres_has_normals_away_from_its_own_centre() {
    check_truth(
        "nested_spheres.off",
        &off("analytic/nested_spheres.off"),
        |p| p,
    );
    // (centre, radius, points): side by side; inside, off centre; inside of that.
    let balls = [
        (DVec3::ZERO, 1.0, 4000),
        (DVec3::new(2.1, 0.0, 0.0), 1.0, 3900),
        (DVec3::new(-0.35, 0.2, 0.1), 0.5, 2000),
        (DVec3::new(-0.25, 0.25, 0.0), 0.2, 700),
    ];
    let mut points = Vec::new();
    let mut truth = Vec::new();
    for (center, radius, count) in balls {
        let directions = sphere(count);
        points.extend(directions.iter().map(|&d| center + d * radius));
        truth.extend(directions);
    }
    for (i, (normal, truth)) in normals_of(&points).iter().zip(&truth).enumerate() {
        assert!(normal.dot(*truth) > (PI / 8.0).cos(), "point {i}");
    }
}

#[test]
fn the_kitten_has_the_signs_of_its_file() {
    let (points, truth) = xyz("kitten.xyz");
    let normals = normals_of(&points);
    let wrong = normals
        .iter()
        .zip(&truth)
        .filter(|(n, t)| n.dot(**t) <= 0.0);
    assert_eq!(wrong.count(), 0);
}

/// Open scans: where the surface is sampled, signs are those that the scanner saw.
///
/// The second has a patch of 55 points apart from the rest, which is turned as its own hull says.
#[test]
fn scans_have_the_signs_of_the_scanner() {
    for (name, apart) in [("hippo1.ply", 0), ("hippo2.ply", 55)] {
        let (points, truth) = ply(name);
        let normals = normals_of(&points);
        let found = reconstruct(&delaunay(&points), &options(Method::Cocone)).unwrap();
        let mut is_sampled = vec![true; points.len()];
        for vertex in &found.report.undersampled {
            is_sampled[vertex.index()] = false;
        }
        let wrong = (0..points.len()).filter(|&i| is_sampled[i] && normals[i].dot(truth[i]) < 0.0);
        let wrong = wrong.count();
        assert!(wrong <= apart, "{name}: {wrong}");
    }
}

/// A paraboloid over a square; its back is open. At the rim itself, cells are not long along the normal.
#[test]
fn an_open_bowl_is_consistent_and_faces_its_hull() {
    let points: Vec<DVec3> = (0..900)
        .map(|i| DVec3::new(f64::from(i % 30) - 14.5, f64::from(i / 30) - 14.5, 0.0) / 15.0)
        .map(|p| p - DVec3::Z * 0.7 * p.length_squared())
        .collect();
    let flipped: Vec<DVec3> = points.iter().map(|p| -*p).collect();
    for (points, up) in [(points, DVec3::Z), (flipped, -DVec3::Z)] {
        for (p, normal) in points.iter().zip(normals_of(&points)) {
            let is_rim = p.x.abs().max(p.y.abs()) > 14.0 / 15.0;
            assert!(is_rim || normal.dot(up) > 0.0, "{normal} at {p}");
        }
    }
}

#[test]
fn noise_and_outliers_leave_finite_unit_normals() {
    let mut random = Random(5);
    let mut points = sphere(1500);
    for p in &mut points {
        *p += random.point() * 0.02;
    }
    points.extend((0..100).map(|_| random.point() * 2.0));
    let normals = normals_of(&points);
    let outward = (0..1500)
        .filter(|&i| normals[i].dot(points[i]) > 0.0)
        .count();
    // Noise at half the spacing leaves few cells that point the wrong way.
    assert!(outward > 1450, "{outward}");
}

#[test]
fn normals_do_not_depend_on_the_order_of_the_points() {
    let mut random = Random(11);
    let clouds = [
        (0..300).map(|_| random.point()).collect(),
        (0..125)
            .map(|i| DVec3::new((i % 5).into(), (i / 5 % 5).into(), (i / 25).into()))
            .collect(),
        xyz("kitten.xyz").0,
    ];
    for points in clouds {
        let points: Vec<DVec3> = points;
        let before = normals_of(&points);
        let mut order: Vec<usize> = (0..points.len()).collect();
        random.shuffle(&mut order);
        let shuffled: Vec<DVec3> = order.iter().map(|&i| points[i]).collect();
        for (&i, after) in order.iter().zip(normals_of(&shuffled)) {
            assert_eq!(
                before[i].to_array().map(f64::to_bits),
                after.to_array().map(f64::to_bits)
            );
        }
    }
}

#[test]
fn duplicates_have_the_normals_of_their_representatives() {
    let points = sphere(200);
    let plain = normals_of(&points);
    let twice: Vec<DVec3> = points.iter().chain(points.iter().rev()).copied().collect();
    let normals = normals_of(&twice);
    assert_eq!(normals[..200], plain);
    assert!(normals[200..].iter().eq(plain.iter().rev()));
}

#[test]
fn normals_do_not_depend_on_the_unit_of_length() {
    let mut random = Random(3);
    // 30 bits a coordinate: what is left of them at the least scale.
    let points: Vec<DVec3> = sphere(300)
        .iter()
        .map(|p| (*p * 2_f64.powi(20) + random.point()).round())
        .collect();
    let expected = normals_of(&points);
    for exponent in [-1074, -1000, -300, 300, 1000] {
        let half = 2_f64.powi(exponent / 2);
        let rest = 2_f64.powi(exponent - exponent / 2);
        let scaled: Vec<DVec3> = points.iter().map(|p| *p * half * rest).collect();
        for (n, e) in normals_of(&scaled).iter().zip(&expected) {
            assert!(n.distance(*e) < 1e-9, "2^{exponent}: {n} for {e}");
        }
    }
}

/// Stops at a step.
struct StopAt(u64);

impl Progress for StopAt {
    fn step(&self, stage: &'static str, done: u64, total: u64) -> ControlFlow<()> {
        assert!(stage == "normals" && done <= total);
        match done == self.0 {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        }
    }
}

#[test]
fn work_stops_when_asked() {
    let points = sphere(50);
    let tetrahedralization = delaunay(&points);
    for step in 0..=4 {
        let stopped = normals_with(&tetrahedralization, &StopAt(step));
        assert_eq!(stopped, Err(Cancelled), "step {step}");
    }
    assert_eq!(
        normals_with(&tetrahedralization, &StopAt(9)).map(|n| n.len()),
        Ok(50)
    );
}
