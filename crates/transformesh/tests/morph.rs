//! Surfaces that morph: topology, distance, no self-intersections; and what cannot be reached.

use pellicle_geometry::{Cancelled, DVec3, Progress, VertexId};
use pellicle_mesh::{
    SignedDistance, TriMesh, TriangleSoup, count_self_intersections, icosphere, signed_volume,
};
use pellicle_transformesh::{
    Error, MorphEnd, MorphOptions, MorphReport, Options, Placement, morph, morph_with, repair,
};
use std::f64::consts::{PI, TAU};
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicU32, Ordering};

fn moved(soup: &TriangleSoup, scale: f64, by: DVec3) -> TriangleSoup {
    TriangleSoup {
        positions: soup.positions.iter().map(|p| *p * scale + by).collect(),
        triangles: soup.triangles.clone(),
    }
}

fn together(parts: &[TriangleSoup]) -> TriangleSoup {
    let mut all = TriangleSoup::default();
    for part in parts {
        let count = all.positions.len() as u32;
        all.positions.extend(&part.positions);
        let triangles = part.triangles.iter();
        all.triangles
            .extend(triangles.map(|t| t.map(|v| VertexId(v.0 + count))));
    }
    all
}

fn sphere(radius: f64, center: DVec3) -> TriangleSoup {
    moved(&icosphere(3).unwrap().into_soup(), radius, center)
}

/// A tube around a closed curve, given by its center, and two directions across it, at an angle.
fn tube(
    rings: u32,
    sides: u32,
    radius: f64,
    at: impl Fn(f64) -> (DVec3, DVec3, DVec3),
) -> TriangleSoup {
    let mut soup = TriangleSoup::default();
    for i in 0..rings {
        let (center, right, up) = at(TAU * f64::from(i) / f64::from(rings));
        for j in 0..sides {
            let (sin, cos) = (TAU * f64::from(j) / f64::from(sides)).sin_cos();
            soup.positions
                .push(center + radius * (right * cos + up * sin));
            let at = |i: u32, j: u32| VertexId((i % rings) * sides + j % sides);
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            soup.triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    soup
}

/// About the z axis.
fn torus(major: f64, minor: f64) -> TriangleSoup {
    tube(48, 20, minor, |angle| {
        let (sin, cos) = angle.sin_cos();
        let right = DVec3::new(cos, sin, 0.0);
        (major * right, right, DVec3::Z)
    })
}

fn trefoil() -> TriangleSoup {
    let point = |t: f64| {
        let r = 2.0 + (3.0 * t).cos();
        DVec3::new(r * (2.0 * t).cos(), r * (2.0 * t).sin(), (3.0 * t).sin())
    };
    tube(180, 12, 0.35, |t| {
        let tangent = (point(t + 1e-4) - point(t - 1e-4)).normalize();
        // The knot lies on a torus, whose normal turns with it.
        let (sin, cos) = (2.0 * t).sin_cos();
        let right = point(t) - 2.0 * DVec3::new(cos, sin, 0.0);
        let right = (right - tangent * right.dot(tangent)).normalize();
        (point(t), right, right.cross(tangent))
    })
}

/// Morphs, and holds what every morph must hold.
fn check(
    source: &TriangleSoup,
    target: &TriangleSoup,
    options: &MorphOptions,
) -> (TriMesh, MorphReport) {
    let mut next = 0;
    let (mesh, report) = morph_with(
        source.into(),
        target.into(),
        options,
        &(),
        &mut |step, mesh| {
            assert_eq!(step.step, next);
            next += 1;
            assert!(mesh.is_closed());
            assert!(step.largest_move <= options.step * step.edge_length * (1.0 + 1e-9));
            let is_repaired = step.step % options.repair_every == 0 && step.step > 0;
            assert_eq!(step.repaired_pairs.is_some(), is_repaired);
            if is_repaired {
                assert_eq!(count_self_intersections(mesh.into(), &()).unwrap(), 0);
            }
        },
    )
    .unwrap();
    assert_eq!((report.steps, report.remaining_pairs), (next - 1, 0));
    assert_eq!(mesh.validate(), []);
    assert_eq!(count_self_intersections((&mesh).into(), &()).unwrap(), 0);
    (mesh, report)
}

/// That the surface got there, with the topology given.
fn arrives(source: &TriangleSoup, target: &TriangleSoup, edge: f64, genera: &[usize]) -> TriMesh {
    let options = MorphOptions {
        edge_length: Some(edge),
        ..MorphOptions::default()
    };
    let (mesh, report) = check(source, target, &options);
    assert_eq!(report.end, MorphEnd::Arrived, "{report:?}");
    assert_eq!(report.topology.genera, genera);
    assert_eq!(report.target_topology.genera, genera);
    assert_eq!(report.missed, 0);
    assert!(
        report.mean_distance < 0.25 * report.edge_length,
        "{report:?}"
    );
    assert!(report.greatest_distance <= report.edge_length, "{report:?}");
    let (outside, _) = repair(target, &Options::default()).unwrap();
    let volumes = [&mesh, &outside].map(|mesh| signed_volume(mesh.into()));
    assert!((volumes[0] / volumes[1] - 1.0).abs() < 0.08, "{volumes:?}");
    mesh
}

#[test]
fn a_sphere_becomes_an_ellipsoid() {
    let sphere = sphere(1.0, DVec3::ZERO);
    let mut ellipsoid = sphere.clone();
    let stretch = DVec3::new(2.0, 1.0, 0.5);
    ellipsoid.positions.iter_mut().for_each(|p| *p *= stretch);
    let mesh = arrives(&sphere, &ellipsoid, 0.15, &[0]);
    let exact = 4.0 / 3.0 * PI;
    assert!((signed_volume((&mesh).into()) / exact - 1.0).abs() < 0.04);
}

#[test]
fn a_sphere_becomes_a_bumpy_one() {
    let bumpy = |p: DVec3| p * (1.0 + 0.3 * (5.0 * p.x).sin() * (4.0 * p.y).cos());
    let mut target = sphere(1.0, DVec3::ZERO);
    target.positions.iter_mut().for_each(|p| *p = bumpy(*p));
    arrives(&sphere(0.4, 0.2 * DVec3::Z), &target, 0.12, &[0]);
}

#[test]
fn a_sphere_around_a_torus_opens_a_hole() {
    arrives(&sphere(2.0, DVec3::ZERO), &torus(1.0, 0.4), 0.15, &[1]);
}

#[test]
fn a_sphere_in_a_torus_grows_around_and_closes() {
    arrives(&sphere(0.3, DVec3::X), &torus(1.0, 0.4), 0.15, &[1]);
}

#[test]
fn a_torus_becomes_two_spheres() {
    let two = together(&[sphere(0.5, DVec3::X), sphere(0.5, -DVec3::X)]);
    arrives(&torus(1.0, 0.25), &two, 0.12, &[0, 0]);
}

#[test]
fn two_spheres_become_one() {
    let two = together(&[sphere(0.4, 0.8 * DVec3::X), sphere(0.4, -0.8 * DVec3::X)]);
    arrives(&two, &sphere(1.0, DVec3::ZERO), 0.2, &[0]);
}

#[test]
fn a_sphere_becomes_three_rings_that_cross() {
    // The target crosses itself: its outside counts, of genus 3 where the rings overlap in a row.
    let rings = [-1.0, 0.0, 1.0].map(|x| moved(&torus(1.0, 0.3), 1.0, 2.0 * x * DVec3::X));
    arrives(&sphere(4.0, DVec3::ZERO), &together(&rings), 0.2, &[3]);
}

#[test]
fn a_knot_and_back() {
    let big = sphere(4.5, DVec3::ZERO);
    arrives(&big, &trefoil(), 0.22, &[1]);
    arrives(&trefoil(), &moved(&big, 0.6, DVec3::ZERO), 0.5, &[0]);
}

#[test]
fn a_sphere_becomes_itself() {
    let sphere = sphere(1.0, DVec3::ZERO);
    let (_, report) = check(&sphere, &sphere, &MorphOptions::default());
    assert_eq!(
        (report.end, report.topology_changes),
        (MorphEnd::Arrived, 0)
    );
    assert!(report.mean_distance < 0.05 * report.edge_length);
}

#[test]
fn placements() {
    let target = moved(&torus(1.0, 0.4), 3.0, DVec3::new(100.0, -50.0, 7.0));
    let source = sphere(0.1, DVec3::ZERO);
    let vanished = morph(&source, &target, &MorphOptions::default());
    assert!(matches!(vanished, Err(Error::Vanished { step }) if step > 0));
    for placement in [Placement::Enclose, Placement::Fit] {
        let options = MorphOptions {
            edge_length: Some(0.5),
            placement,
            ..MorphOptions::default()
        };
        let mut first = None;
        let (_, report) = morph_with(
            (&source).into(),
            (&target).into(),
            &options,
            &(),
            &mut |_, mesh| {
                first.get_or_insert_with(|| mesh.clone());
            },
        )
        .unwrap();
        assert_eq!(
            (report.end, report.topology.genus()),
            (MorphEnd::Arrived, 1)
        );
        let start = SignedDistance::new(&first.unwrap()).unwrap();
        let is_inside = |p: &DVec3| start.sample(*p).distance < 0.0;
        let all = target.positions.iter().all(is_inside);
        assert_eq!(all, placement == Placement::Enclose);
    }
}

#[test]
fn what_it_cannot_reach_is_counted() {
    // A second sphere that the surface never touches.
    let two = together(&[sphere(1.0, DVec3::ZERO), sphere(0.5, 3.0 * DVec3::X)]);
    let options = MorphOptions {
        edge_length: Some(0.25),
        ..MorphOptions::default()
    };
    let (_, report) = check(&sphere(0.8, DVec3::ZERO), &two, &options);
    assert_eq!((report.end, report.missed), (MorphEnd::Resting, 1));
    assert_eq!(report.topology.genera, [0]);
    assert_eq!(report.target_topology.genera, [0, 0]);
    // A cavity, where no surface begins.
    let mut cavity = sphere(0.5, DVec3::ZERO);
    cavity.triangles.iter_mut().for_each(|t| t.swap(0, 1));
    let shell = together(&[sphere(1.0, DVec3::ZERO), cavity]);
    let (mesh, report) = check(&sphere(1.5, DVec3::ZERO), &shell, &options);
    assert_eq!((report.end, report.missed), (MorphEnd::Resting, 1));
    assert!((signed_volume((&mesh).into()) / (4.0 / 3.0 * PI) - 1.0).abs() < 0.05);
    // From a shell it is found.
    let (_, report) = check(&moved(&shell, 1.2, DVec3::ZERO), &shell, &options);
    assert_eq!((report.end, report.missed), (MorphEnd::Arrived, 0));
}

#[test]
fn steps_run_out() {
    let options = MorphOptions {
        edge_length: Some(0.2),
        max_steps: 4,
        ..MorphOptions::default()
    };
    let (_, report) = check(
        &sphere(3.0, DVec3::ZERO),
        &sphere(1.0, DVec3::ZERO),
        &options,
    );
    assert_eq!((report.end, report.steps), (MorphEnd::StepLimit, 4));
    assert!(report.greatest_distance > 1.0);
}

#[test]
fn what_is_refused_and_what_is_filled() {
    let plain = sphere(1.0, DVec3::ZERO);
    let options = MorphOptions::default();
    let mut holed = plain.clone();
    holed.triangles.remove(7);
    let (_, report) = check(&holed, &holed, &options);
    assert_eq!(report.filled, 2);
    holed.triangles.drain(3..5);
    for (source, target, name) in [(&holed, &plain, "source"), (&plain, &holed, "target")] {
        let error = morph(source, target, &options).unwrap_err();
        let Error::Side { side, reason } = error else {
            panic!("{error}");
        };
        assert_eq!(side, name);
        assert!(matches!(*reason, Error::Open { .. }));
    }
    let mut inverted = plain.clone();
    inverted.triangles.iter_mut().for_each(|t| t.swap(0, 1));
    let nothing = TriangleSoup::default();
    for (source, target, side) in [
        (&inverted, &plain, "source"),
        (&plain, &inverted, "target"),
        (&plain, &nothing, "target"),
    ] {
        assert_eq!(morph(source, target, &options), Err(Error::Empty { side }));
    }
    let mut broken = plain.clone();
    broken.positions[3].x = f64::NAN;
    let Err(Error::Side { side, reason }) = morph(&plain, &broken, &options) else {
        panic!("a position that is not finite");
    };
    assert_eq!(side, "target");
    assert!(matches!(*reason, Error::NotFinite { vertex, .. } if vertex == VertexId(3)));
    for bad in [
        MorphOptions {
            edge_length: Some(0.0),
            ..options.clone()
        },
        MorphOptions {
            edge_length: Some(f64::NAN),
            ..options.clone()
        },
        MorphOptions {
            step: -1.0,
            ..options.clone()
        },
        MorphOptions {
            smoothing: 1.5,
            ..options.clone()
        },
        MorphOptions {
            repair_every: 0,
            ..options.clone()
        },
        MorphOptions {
            mean_distance: f64::INFINITY,
            ..options.clone()
        },
        MorphOptions {
            greatest_distance: 0.0,
            ..options.clone()
        },
    ] {
        assert!(matches!(
            morph(&plain, &plain, &bad),
            Err(Error::Option { .. })
        ));
    }
}

#[test]
fn it_can_be_stopped() {
    struct Limit(AtomicU32);
    impl Progress for Limit {
        fn step(&self, stage: &'static str, _: u64, _: u64) -> ControlFlow<()> {
            let calls = self
                .0
                .fetch_add(u32::from(stage == "morph"), Ordering::Relaxed);
            if calls >= 3 {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        }
    }
    let (source, target) = (sphere(2.0, DVec3::ZERO), torus(1.0, 0.4));
    let mut steps = 0;
    let stopped = morph_with(
        (&source).into(),
        (&target).into(),
        &MorphOptions::default(),
        &Limit(AtomicU32::new(0)),
        &mut |step, _| steps = step.step,
    );
    assert_eq!(stopped, Err(Error::Cancelled(Cancelled)));
    assert_eq!(steps, 4);
}

#[test]
fn neither_threads_nor_units_show() {
    let (source, target) = (sphere(2.0, DVec3::ZERO), torus(1.0, 0.4));
    let options = MorphOptions {
        edge_length: Some(0.25),
        ..MorphOptions::default()
    };
    let with = |threads| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| morph(&source, &target, &options).unwrap())
    };
    let (mesh, report) = with(1);
    assert_eq!((mesh.clone(), report.clone()), with(3));
    for exponent in [-500, 8, 500] {
        let unit = 2_f64.powi(exponent);
        let scaled = MorphOptions {
            edge_length: Some(0.25 * unit),
            ..MorphOptions::default()
        };
        let [source, target] = [&source, &target].map(|soup| moved(soup, unit, DVec3::ZERO));
        let (other, other_report) = morph(&source, &target, &scaled).unwrap();
        assert_eq!(other_report.steps, report.steps);
        assert_eq!(other_report.mean_distance, report.mean_distance * unit);
        assert_eq!(other.triangles(), mesh.triangles());
        let same = other.positions().iter().zip(mesh.positions());
        assert!(same.into_iter().all(|(p, q)| *p == *q * unit));
    }
}

#[test]
fn a_hole_narrower_than_an_edge_is_found_by_shorter_ones() {
    let (source, target) = (sphere(2.5, DVec3::ZERO), torus(1.0, 0.85));
    let with = |refinements| {
        let options = MorphOptions {
            edge_length: Some(0.5),
            refinements,
            ..MorphOptions::default()
        };
        check(&source, &target, &options).1
    };
    let coarse = with(0);
    assert_eq!(coarse.end, MorphEnd::Resting, "{coarse:?}");
    assert_eq!(coarse.topology.genera, [0]);
    assert!(coarse.mean_distance < 0.2 * coarse.edge_length);
    let fine = with(2);
    assert_eq!(fine.end, MorphEnd::Arrived, "{fine:?}");
    assert_eq!(fine.topology.genera, [1]);
    assert!(fine.edge_length < 0.5);
}
