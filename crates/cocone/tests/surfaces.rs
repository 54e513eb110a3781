//! Sampled surfaces come back: closed ones whole, open ones with their borders.

mod common;

use common::{
    METHODS, Random, delaunay, double_torus, implicit, off, options, run, sphere, summary, torus,
    xyz,
};
use pellicle_cocone::{Error, Method, Reconstruction, reconstruct, reconstruct_with};
use pellicle_geometry::{Cancelled, DVec3, Progress, VertexId, triangle};
use std::collections::BTreeSet;
use std::ops::ControlFlow;
use std::sync::Mutex;

/// Triangles of the caller's points, each from its lowest id on.
fn triangles(found: &Reconstruction) -> BTreeSet<[VertexId; 3]> {
    let point = |v: VertexId| found.vertices[v.index()];
    let mesh = found.mesh.triangles().iter();
    mesh.map(|t| {
        let mut t = t.map(point);
        let lowest = (0..3).min_by_key(|&i| t[i]).unwrap_or(0);
        t.rotate_left(lowest);
        t
    })
    .collect()
}

fn reversed(triangles: &BTreeSet<[VertexId; 3]>) -> BTreeSet<[VertexId; 3]> {
    triangles.iter().map(|&[a, b, c]| [a, c, b]).collect()
}

/// Both methods find the closed surface, with these genera of its components, and every point on it.
fn check_closed(name: &str, points: &[DVec3], genera: &[usize]) {
    let found = METHODS.map(|method| run(points, method));
    for (found, method) in found.iter().zip(METHODS) {
        let name = format!("{name}, {method:?}");
        let summary = summary(&found.mesh);
        assert!(summary.is_closed(), "{name}");
        let found_genera: Vec<_> = summary.components.iter().map(|c| c.genus()).collect();
        let expected: Vec<_> = genera.iter().map(|&g| Some(g)).collect();
        assert_eq!(found_genera, expected, "{name}");
        assert_eq!(found.report.used, points.len(), "{name}");
        assert_eq!(found.report.dropped, [], "{name}");
        assert_eq!(found.report.split, [], "{name}");
        assert!(summary.volume.unwrap() > 0.0, "{name}");
    }
    let [cocone, tight] = found.each_ref().map(triangles);
    assert!(cocone == tight, "{name}: Tight Cocone differs");
}

#[test]
fn well_sampled_closed_surfaces_come_back_whole() {
    check_closed("sphere.off", &off("analytic/sphere.off"), &[0]);
    check_closed("torus.off", &off("analytic/torus.off"), &[1]);
    check_closed("kitten.xyz", &xyz("kitten.xyz").0, &[1]);
    check_closed("knot1.off", &off("knot1.off"), &[1]);
    check_closed("knot2.off", &off("knot2.off"), &[1, 1]);
}

#[test]
fn random_samples_of_known_genus_come_back_whole() {
    for seed in 0..4 {
        let ball = |p: DVec3| p.length() - 1.0;
        let points = implicit(ball, DVec3::splat(1.2), 0.1, seed);
        check_closed(&format!("sphere {seed}"), &points, &[0]);
        let points = implicit(torus, DVec3::new(1.5, 1.5, 0.5), 0.06, seed);
        check_closed(&format!("torus {seed}"), &points, &[1]);
        let points = implicit(double_torus, DVec3::new(1.2, 0.8, 0.3), 0.022, seed);
        check_closed(&format!("genus two {seed}"), &points, &[2]);
    }
}

/// The gap is as wide as the points are apart: there, and nowhere else, Cocone may leave a hole.
#[test]
fn spheres_that_nearly_touch_stay_apart() {
    let points = off("analytic/two_spheres_gap.off");
    for method in METHODS {
        let found = run(&points, method);
        let genera: Vec<_> = summary(&found.mesh)
            .components
            .iter()
            .map(|c| c.genus())
            .collect();
        assert_eq!(genera, [Some(0), Some(0)]);
        let gap = DVec3::new(0.51, 0.0, 0.0);
        for border in found.mesh.border_loops() {
            for h in border {
                let p = found.mesh.position(found.mesh.origin(h));
                assert!(
                    method == Method::Cocone && p.distance(gap) < 0.1,
                    "{method:?}: {p}"
                );
            }
        }
        for v in found
            .report
            .dropped
            .iter()
            .chain(&found.report.undersampled)
        {
            assert!(points[v.index()].distance(gap) < 0.1);
        }
    }
}

#[test]
fn components_come_back_each() {
    let mut points = sphere(800);
    let ring = implicit(torus, DVec3::new(1.5, 1.5, 0.5), 0.08, 9);
    points.extend(ring.iter().map(|p| *p + DVec3::X * 3.0));
    points.extend(sphere(300).iter().map(|p| *p * 0.3 + DVec3::Y * 4.0));
    let found = run(&points, Method::Cocone);
    let summary = summary(&found.mesh);
    let mut genera: Vec<_> = summary.components.iter().map(|c| c.genus()).collect();
    genera.sort();
    assert_eq!(genera, [Some(0), Some(0), Some(1)]);
    assert!(summary.is_closed());
    assert_eq!(found.report.dropped, []);
    assert_eq!(found.report.undersampled, []);
}

/// Cocone sees both spheres from outside. To Tight Cocone they bound a shell: what is inside the inner
/// one is outside again.
#[test]
fn nested_spheres_are_two_surfaces_or_the_boundary_of_a_shell() {
    let points = off("analytic/nested_spheres.off");
    let [cocone, tight] = METHODS.map(|method| run(&points, method));
    for found in [&cocone, &tight] {
        let summary = summary(&found.mesh);
        assert!(summary.is_closed());
        let genera: Vec<_> = summary.components.iter().map(|c| c.genus()).collect();
        assert_eq!(genera, [Some(0), Some(0)]);
        assert_eq!(found.report.dropped, []);
    }
    let is_inner = |t: &[VertexId; 3]| points[t[0].index()].length() < 0.9;
    let (inner, outer): (BTreeSet<_>, BTreeSet<_>) =
        triangles(&cocone).into_iter().partition(is_inner);
    let expected: BTreeSet<_> = reversed(&inner).union(&outer).copied().collect();
    assert!(triangles(&tight) == expected);
    let outward = |found: &Reconstruction, outer: bool| {
        let mesh = &found.mesh;
        mesh.triangle_ids()
            .map(|t| mesh.corners(t))
            .filter(|[a, _, _]| (a.length() > 0.9) == outer)
            .all(|[a, b, c]| triangle::double_area_normal(a, b, c).dot(a + b + c) > 0.0)
    };
    assert!(outward(&cocone, true) && outward(&cocone, false));
    assert!(outward(&tight, true));
}

#[test]
fn an_open_hemisphere_keeps_one_clean_border() {
    let points = off("analytic/hemisphere_open.off");
    let found = run(&points, Method::Cocone);
    let mesh = &found.mesh;
    let summary = summary(mesh);
    assert_eq!(summary.components.len(), 1);
    assert_eq!(summary.genus(), Some(0));
    assert_eq!(found.report.dropped, []);
    assert_eq!(found.report.split, []);

    // The border is the rim, all of it, and the rim is what the report calls undersampled.
    let loops = mesh.border_loops();
    assert_eq!(loops.len(), 1);
    let border: BTreeSet<VertexId> = loops[0]
        .iter()
        .map(|&h| found.vertices[mesh.origin(h).index()])
        .collect();
    let lowest = points.iter().map(|p| p.z).fold(f64::INFINITY, f64::min);
    let rim: BTreeSet<VertexId> = (0..points.len())
        .filter(|&i| points[i].z < lowest + 1e-9)
        .map(VertexId::new)
        .collect();
    assert_eq!(border.len(), loops[0].len());
    assert!(border == rim, "{} of {}", border.len(), rim.len());
    let undersampled: BTreeSet<VertexId> = found.report.undersampled.iter().copied().collect();
    assert!(
        rim.is_subset(&undersampled),
        "{} of {}",
        undersampled.intersection(&rim).count(),
        rim.len()
    );

    // Oriented one way, outward.
    for t in mesh.triangle_ids() {
        let [a, b, c] = mesh.corners(t);
        assert!(triangle::double_area_normal(a, b, c).dot(a + b + c) > 0.0);
    }
    let tight = run(&points, Method::TightCocone);
    assert!(tight.mesh.is_closed());
    assert_eq!(tight.report.dropped, []);
}

/// Half of a random sample: a border that no grid helps to find.
#[test]
fn a_random_bowl_has_one_border() {
    for seed in 0..4 {
        let ball = |p: DVec3| p.length() - 1.0;
        let mut points = implicit(ball, DVec3::splat(1.2), 0.08, seed);
        points.retain(|p| p.z > -0.3);
        let found = run(&points, Method::Cocone);
        let summary = summary(&found.mesh);
        assert_eq!(summary.components.len(), 1, "{seed}");
        assert_eq!(summary.genus(), Some(0), "{seed}");
        assert_eq!(summary.border_loops(), 1, "{seed}");
        let inner = found
            .report
            .dropped
            .iter()
            .filter(|v| points[v.index()].z > 0.0);
        assert_eq!(inner.count(), 0, "{seed}");
        for border in found.mesh.border_loops() {
            for h in border {
                let z = found.mesh.position(found.mesh.origin(h)).z;
                assert!(z < 0.0, "{seed}: the border climbs to {z}");
            }
        }
    }
}

#[test]
fn duplicates_and_distant_points_are_reported_as_dropped() {
    let clean = sphere(600);
    let mut points = clean.clone();
    points.extend_from_slice(&clean[..50]);
    // Far enough from the surface, and from each other, to be no part of it.
    points.push(DVec3::new(40.0, 3.0, 1.0));
    points.push(DVec3::new(-35.0, 30.0, -60.0));
    let found = run(&points, Method::Cocone);
    let dropped: Vec<VertexId> = (600..652).map(VertexId::new).collect();
    assert_eq!(found.report.dropped, dropped);
    assert_eq!(found.report.used, 600);
    assert!(found.mesh.is_closed());
    assert_eq!(triangles(&found), triangles(&run(&clean, Method::Cocone)));
    for outlier in [650, 651].map(VertexId::new) {
        assert!(found.report.undersampled.contains(&outlier));
    }
}

#[test]
fn scans_give_the_same_bytes_in_any_order_and_for_any_number_of_threads() {
    let mut random = Random(17);
    for points in [xyz("kitten.xyz").0, off("analytic/hemisphere_open.off")] {
        let mut shuffled = points.clone();
        random.shuffle(&mut shuffled);
        for method in METHODS {
            let one = rayon::ThreadPoolBuilder::new()
                .num_threads(1)
                .build()
                .unwrap();
            let three = rayon::ThreadPoolBuilder::new()
                .num_threads(3)
                .build()
                .unwrap();
            let before = one.install(|| run(&points, method));
            let after = three.install(|| run(&shuffled, method));
            assert!(before.mesh == after.mesh, "{method:?}");
        }
    }
}

/// Records steps, and stops at one.
struct Watch {
    stop: Option<usize>,
    steps: Mutex<Vec<(u64, u64)>>,
}

impl Progress for Watch {
    fn step(&self, stage: &'static str, done: u64, total: u64) -> ControlFlow<()> {
        assert_eq!(stage, "reconstruct");
        let mut steps = self.steps.lock().unwrap();
        steps.push((done, total));
        match self.stop == Some(steps.len() - 1) {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        }
    }
}

#[test]
fn work_stops_when_asked_at_every_step() {
    let points = sphere(60);
    let tetrahedralization = delaunay(&points);
    for method in METHODS {
        let watched = |stop| {
            let watch = Watch {
                stop,
                steps: Mutex::default(),
            };
            let result = reconstruct_with(&tetrahedralization, &options(method), &watch);
            (result, watch.steps.into_inner().unwrap())
        };
        let (result, steps) = watched(None);
        let unwatched = reconstruct(&tetrahedralization, &options(method)).unwrap();
        assert_eq!(result.unwrap().mesh, unwatched.mesh);
        assert!(steps.is_sorted() && steps.iter().all(|&(done, total)| done <= total));
        assert_eq!(steps.first().map(|s| s.0), Some(0));
        assert!(steps.last().is_some_and(|&(done, total)| done == total));
        for stop in 0..steps.len() {
            let (result, seen) = watched(Some(stop));
            assert_eq!(
                result.map(|_| ()),
                Err(Error::Cancelled(Cancelled)),
                "step {stop}"
            );
            assert_eq!(seen.len(), stop + 1, "nothing after the stop");
        }
    }
}

#[test]
fn a_surface_ruled_along_its_rows_of_points_is_not_pruned_away() {
    let points = off("analytic/moebius.off");
    let reconstruction = run(&points, Method::Cocone);
    assert_eq!(reconstruction.report.used, points.len());
}
