//! From clouds to surfaces, and what is refused.

use pellicle_evolution::{
    EdgeLength, Error, Evolution, Evolved, Field, Flow, Initial, One, Options, Outliers,
    Redistribution, Sample, Schedule, Stage, StepOptions, evolve, evolve_with,
};
use pellicle_geometry::{DVec3, Progress, VertexId};
use pellicle_mesh::{
    AngleBounds, TriMesh, TriangleSoup, count_self_intersections, icosphere, quality,
    signed_volume, summarize,
};
use std::f64::consts::{PI, TAU};
use std::ops::ControlFlow;

/// Numbers in [0, 1), the same on every machine.
struct Random(u64);

impl Random {
    fn unit(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn direction(&mut self) -> DVec3 {
        let z = 2.0 * self.unit() - 1.0;
        let (sin, cos) = (TAU * self.unit()).sin_cos();
        DVec3::new(cos, sin, 0.0) * (1.0 - z * z).sqrt() + DVec3::Z * z
    }

    /// Normal, by the sum of twelve.
    fn normal(&mut self) -> f64 {
        (0..12).map(|_| self.unit()).sum::<f64>() - 6.0
    }
}

const SEMI_AXES: DVec3 = DVec3::new(1.0, 0.8, 0.6);

fn ellipsoid(count: usize) -> Vec<DVec3> {
    let mut random = Random(1);
    (0..count).map(|_| SEMI_AXES * random.direction()).collect()
}

fn torus(count: usize) -> Vec<DVec3> {
    let mut random = Random(2);
    let point = |_| {
        let (u, v) = (TAU * random.unit(), TAU * random.unit());
        let ring = 1.0 + 0.4 * v.cos();
        DVec3::new(ring * u.cos(), ring * u.sin(), 0.4 * v.sin())
    };
    (0..count).map(point).collect()
}

/// Small, for tests.
fn options() -> Options {
    Options {
        resolution: 64,
        ..Options::default()
    }
}

fn assert_sound(evolved: &Evolved) {
    let mesh = &evolved.mesh;
    assert!(mesh.is_closed());
    assert_eq!(count_self_intersections(mesh.into(), &()).unwrap(), 0);
    let summary = summarize(mesh.into()).unwrap();
    assert_eq!((summary.components.len(), summary.genus()), (1, Some(0)));
}

#[test]
fn an_ellipsoid_is_found() {
    let options = Options {
        resolution: 128,
        ..Options::default()
    };
    let evolved = evolve(&ellipsoid(12_000), &options).unwrap();
    assert_sound(&evolved);
    assert!(evolved.report.at_rest);
    let volume = signed_volume((&evolved.mesh).into());
    let exact = 4.0 / 3.0 * PI * SEMI_AXES.element_product();
    assert!((volume / exact - 1.0).abs() < 0.01, "{}", volume / exact);
    // The distance to first order: (|q| − 1) over the length of its gradient.
    let distance = |p: &DVec3| {
        let q = *p / SEMI_AXES;
        let gradient = q / SEMI_AXES / q.length();
        ((q.length() - 1.0) / gradient.length()).abs()
    };
    let positions = evolved.mesh.positions();
    let mean = positions.iter().map(distance).sum::<f64>() / positions.len() as f64;
    assert!(
        mean < 0.25 * evolved.report.spacing,
        "{}",
        mean / evolved.report.spacing
    );
    let angles = quality((&evolved.mesh).into(), &AngleBounds::default()).unwrap();
    assert!(angles.min_angle > 20_f64.to_radians() && angles.max_angle < 140_f64.to_radians());
}

#[test]
fn a_hole_is_spanned_by_two_sheets_that_do_not_meet() {
    let evolved = evolve(&torus(6000), &options()).unwrap();
    assert_sound(&evolved);
    assert!(evolved.report.held > 0);
}

#[test]
fn outliers_are_left_out_and_noise_is_measured() {
    let mut random = Random(3);
    let deviation = 0.02;
    let clean = ellipsoid(6000);
    let mut noise = || deviation * DVec3::new(random.normal(), random.normal(), random.normal());
    let mut points: Vec<DVec3> = clean.iter().map(|&p| p + noise()).collect();
    let near = |p: &DVec3| (*p / SEMI_AXES).length() < 1.5;
    points.extend(
        (0..60)
            .map(|_| 2.5 * random.direction())
            .filter(|p| !near(p)),
    );
    // A clump: none of its points is far from the next.
    points.extend((0..40).map(|_| DVec3::new(0.0, 3.0, 0.0) + 0.1 * random.direction()));
    let far = points.len() - 6000;
    let evolved = evolve(&points, &options()).unwrap();
    assert_sound(&evolved);
    let report = &evolved.report;
    assert!(
        report.outliers >= far && report.outliers < far + 60,
        "{report:?}"
    );
    assert!((report.noise / deviation - 1.0).abs() < 0.25, "{report:?}");
    let volume = signed_volume((&evolved.mesh).into());
    let exact = 4.0 / 3.0 * PI * SEMI_AXES.element_product();
    assert!((volume / exact - 1.0).abs() < 0.03, "{}", volume / exact);
}

#[test]
fn sparse_parts_are_not_outliers() {
    // Thirty times as dense at one end as at the other.
    let mut random = Random(4);
    let points: Vec<DVec3> = ellipsoid(40_000)
        .into_iter()
        .filter(|p| random.unit() * (1.0 + 29.0 * (0.5 - 0.5 * p.x)) < 1.0)
        .collect();
    let evolved = evolve(&points, &options()).unwrap();
    assert!(
        evolved.report.outliers * 200 < points.len(),
        "{:?}",
        evolved.report
    );
    assert_sound(&evolved);
}

#[test]
fn neither_threads_nor_the_order_of_the_points_matter() {
    let points = ellipsoid(1500);
    let options = Options {
        resolution: 40,
        ..Options::default()
    };
    let expected = evolve(&points, &options).unwrap().mesh;
    for threads in [1, 3] {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        let reversed: Vec<DVec3> = points.iter().rev().copied().collect();
        let mesh = pool.install(|| evolve(&reversed, &options)).unwrap().mesh;
        assert_eq!(mesh, expected);
    }
}

#[test]
fn the_unit_of_length_does_not_matter() {
    let points = ellipsoid(1500);
    let options = Options {
        resolution: 40,
        ..Options::default()
    };
    let expected = evolve(&points, &options).unwrap().mesh;
    for exponent in [-40, 40] {
        let scale = 2.0_f64.powi(exponent);
        let scaled: Vec<DVec3> = points.iter().map(|&p| scale * p).collect();
        let mesh = evolve(&scaled, &options).unwrap().mesh;
        assert_eq!(mesh.triangles(), expected.triangles());
        for (a, b) in mesh.positions().iter().zip(expected.positions()) {
            assert!((*a / scale - *b).length() < 1e-9);
        }
    }
}

#[test]
fn nor_does_the_place() {
    let points = ellipsoid(1500);
    let options = Options {
        resolution: 40,
        ..Options::default()
    };
    let near = signed_volume((&evolve(&points, &options).unwrap().mesh).into());
    for (scale, shift) in [
        (1.0, DVec3::new(1e9, 0.0, -3e8)),
        (1e200, DVec3::ZERO),
        (1e-200, DVec3::ZERO),
        (1e-200, DVec3::splat(1e-196)),
        (1e300, DVec3::splat(1e305)),
    ] {
        let placed: Vec<DVec3> = points.iter().map(|&p| scale * p + shift).collect();
        let mut shown = 0;
        let watch = &mut |measures: &pellicle_evolution::Measures, mesh: &TriMesh| {
            assert!(measures.largest_move <= scale);
            assert!((mesh.positions()[0] - shift).abs().max_element() <= 3.0 * scale);
            shown += 1;
        };
        let evolved = evolve_with(&placed, &options, &(), watch).unwrap();
        assert_eq!(shown, evolved.report.steps);
        let mut back = evolved.mesh;
        let positions = back.positions().iter().map(|&p| (p - shift) / scale);
        let positions = positions.collect();
        back.set_positions(positions).unwrap();
        let volume = signed_volume((&back).into());
        assert!(
            (volume / near - 1.0).abs() < 1e-3,
            "{scale:e} {shift}: {volume} {near}"
        );
    }
}

#[test]
fn edges_longer_than_the_object_are_refused() {
    for edge_length in [
        EdgeLength::Voxels(9.0),
        EdgeLength::Absolute(10.0),
        EdgeLength::Voxels(f64::NAN),
    ] {
        let schedule = Schedule::Adaptive {
            edge_length,
            diffusion: 0.1,
        };
        let error = evolve(
            &ellipsoid(500),
            &Options {
                schedule,
                ..options()
            },
        )
        .unwrap_err();
        assert!(matches!(error, Error::Option { .. }), "{error}");
    }
}

#[test]
fn clouds_without_a_volume_are_refused() {
    let flat =
        |map: fn(DVec3) -> DVec3| -> Vec<DVec3> { ellipsoid(200).into_iter().map(map).collect() };
    let refused = |points: &[DVec3]| evolve(points, &options()).map(|_| ()).unwrap_err();
    assert!(matches!(refused(&[]), Error::EmptyCloud));
    assert!(matches!(
        refused(&[DVec3::ONE]),
        Error::Flat {
            points: 1,
            dimension: 0
        }
    ));
    assert!(matches!(
        refused(&[DVec3::ONE; 30]),
        Error::Flat { dimension: 0, .. }
    ));
    let line = flat(|p| DVec3::new(p.x, 2.0 * p.x, -p.x));
    assert!(matches!(refused(&line), Error::Flat { dimension: 1, .. }));
    let plane = flat(|p| DVec3::new(p.x, p.y, p.x + 0.3 * p.y + 1.0));
    let error = refused(&plane);
    assert!(matches!(error, Error::Flat { dimension: 2, .. }));
    assert!(error.to_string().contains("lie in a plane"), "{error}");
    let mut broken = ellipsoid(100);
    broken[17].y = f64::NAN;
    assert!(matches!(
        refused(&broken),
        Error::PointNotFinite { index: 17 }
    ));
}

#[test]
fn initial_surfaces_are_checked() {
    let points = ellipsoid(500);
    let from = |mesh: TriMesh| {
        let options = Options {
            initial: Initial::Mesh(mesh),
            ..options()
        };
        evolve(&points, &options)
    };
    let sphere = |radius: f64, shift: DVec3| {
        let mut mesh = icosphere(2).unwrap();
        let moved = mesh
            .positions()
            .iter()
            .map(|&p| radius * p + shift)
            .collect();
        mesh.set_positions(moved).unwrap();
        mesh
    };
    let mut open = sphere(2.0, DVec3::ZERO).into_soup();
    open.triangles.pop();
    let error = from(TriMesh::try_from(open).unwrap()).unwrap_err();
    assert!(
        matches!(error, Error::NotClosed { edge: Some(_) }),
        "{error}"
    );

    let mut twice = sphere(2.0, DVec3::ZERO).into_soup();
    let offset = twice.positions.len() as u32;
    let second = sphere(2.0, DVec3::X);
    twice.positions.extend(second.positions());
    let moved = second
        .triangles()
        .iter()
        .map(|t| t.map(|v| VertexId(v.0 + offset)));
    twice.triangles.extend(moved);
    let error = from(TriMesh::try_from(twice).unwrap()).unwrap_err();
    assert!(
        matches!(error, Error::InitialIntersectsItself { pairs } if pairs > 0),
        "{error}"
    );

    let error = from(sphere(0.9, DVec3::ZERO)).unwrap_err();
    assert!(
        matches!(error, Error::NotEnclosed { outside, .. } if outside > 0),
        "{error}"
    );
    let mut inverted = sphere(2.0, DVec3::ZERO);
    inverted.reverse_orientation();
    let error = from(inverted).unwrap_err();
    assert!(
        matches!(error, Error::NotEnclosed { outside: 500, .. }),
        "{error}"
    );

    assert_sound(&from(sphere(1.5, DVec3::ZERO)).unwrap());
}

#[test]
fn a_step_never_changes_connectivity() {
    let mesh = icosphere(3).unwrap();
    let mut evolution = Evolution::new(mesh.clone()).unwrap();
    let options = StepOptions {
        diffusion: 1.0,
        ..StepOptions::default()
    };
    for _ in 0..5 {
        evolution.step(&One, &options).unwrap();
    }
    assert_eq!(evolution.mesh().triangles(), mesh.triangles());
    assert_ne!(evolution.mesh().positions(), mesh.positions());
    assert_eq!(evolution.steps(), 5);
}

#[test]
fn a_step_that_fails_leaves_the_surface_where_it_was() {
    struct Broken;
    impl Field for Broken {
        fn sample(&self, at: DVec3) -> Sample {
            let value = if at.z > 0.99 { f64::NAN } else { 1.0 };
            Sample {
                value,
                gradient: DVec3::ZERO,
            }
        }
    }
    let mesh = icosphere(2).unwrap();
    let top = mesh.positions().iter().position(|p| p.z > 0.99).unwrap();
    let mut evolution = Evolution::new(mesh.clone()).unwrap();
    evolution.step(&One, &StepOptions::default()).unwrap();
    let before = evolution.mesh().clone();
    // One step of mean curvature flow moved the top below; hold the field against where it is.
    struct Higher(f64);
    impl Field for Higher {
        fn sample(&self, at: DVec3) -> Sample {
            Broken.sample(at + DVec3::Z * self.0)
        }
    }
    let lift = 1.0 - before.positions()[top].z;
    let error = evolution
        .step(&Higher(lift), &StepOptions::default())
        .unwrap_err();
    assert!(matches!(error, Error::NotFinite { step: 2, .. }), "{error}");
    assert_eq!(evolution.mesh(), &before);
}

#[test]
fn meshes_with_a_border_are_refused() {
    let triangle = TriangleSoup {
        positions: vec![DVec3::ZERO, DVec3::X, DVec3::Y],
        triangles: vec![[0, 1, 2].map(VertexId)],
    };
    let error = Evolution::new(TriMesh::try_from(triangle).unwrap()).unwrap_err();
    assert!(matches!(error, Error::NotClosed { edge: Some(_) }));
    let error = Evolution::new(TriMesh::default()).unwrap_err();
    assert!(matches!(error, Error::NotClosed { edge: None }));
}

#[test]
fn no_vertex_goes_farther_than_it_may() {
    struct Pull;
    impl Field for Pull {
        fn sample(&self, at: DVec3) -> Sample {
            Sample {
                value: at.length(),
                gradient: at.normalize() * (3.0 + at.x),
            }
        }
    }
    let mesh = icosphere(2).unwrap();
    let shortest = mesh.edges().map(|h| {
        mesh.position(mesh.origin(h))
            .distance(mesh.position(mesh.destination(h)))
    });
    let longest_edge = shortest.fold(0.0, f64::max);
    let options = StepOptions {
        time_step: 0.1,
        move_limit: 0.25,
        redistribution: Redistribution::AngleAware {
            omega: 5.0,
            omega_angles: 5.0,
        },
        ..StepOptions::default()
    };
    let mut evolution = Evolution::new(mesh).unwrap();
    let report = evolution.step(&Pull, &options).unwrap();
    assert_eq!(report.time_step, 0.0125, "cut to an eighth");
    assert!(report.capped > 0 && report.largest_move <= 0.25 * longest_edge);
}

#[test]
fn smoothing_keeps_the_volume_and_lessens_the_area() {
    let points = ellipsoid(2000);
    let plain = evolve(
        &points,
        &Options {
            resolution: 40,
            ..Options::default()
        },
    )
    .unwrap();
    let smooth = Options {
        resolution: 40,
        smoothing: 10,
        ..Options::default()
    };
    let smooth = evolve(&points, &smooth).unwrap();
    let of = |evolved: &Evolved| {
        let mesh = &evolved.mesh;
        (signed_volume(mesh.into()), pellicle_mesh::area(mesh.into()))
    };
    let ((volume, area), (smooth_volume, smooth_area)) = (of(&plain), of(&smooth));
    assert!(
        (smooth_volume / volume - 1.0).abs() < 1e-6,
        "{}",
        smooth_volume / volume
    );
    assert!(smooth_area < area);
}

#[test]
fn the_stages_of_the_paper() {
    let stages = Stage::paper(95, 100.0, 25, 450.0);
    assert_eq!(
        stages.iter().map(|s| (s.flow, s.steps)).collect::<Vec<_>>(),
        [(Flow::OntoPoints, 95), (Flow::MeanCurvature, 25),]
    );
    let run = |levels, stages| {
        let options = Options {
            resolution: 40,
            sigma: Some(1.0),
            outliers: Outliers::Keep,
            schedule: Schedule::Stages { levels, stages },
            ..Options::default()
        };
        let mut vertices = Vec::new();
        let watch = &mut |measures: &pellicle_evolution::Measures, _: &TriMesh| {
            vertices.push(measures.vertices);
        };
        let evolved = evolve_with(&ellipsoid(2000), &options, &(), watch).unwrap();
        (evolved, vertices)
    };
    let (evolved, vertices) = run(3, stages);
    assert_eq!(vertices, [642; 120]);
    assert_sound(&evolved);
    let short: Vec<Stage> = Stage::paper_coarse_to_fine()
        .into_iter()
        .map(|stage| Stage {
            steps: stage.steps.min(2),
            ..stage
        })
        .collect();
    let taus: Vec<f64> = short.iter().map(|s| s.step.time_step).collect();
    assert_eq!(
        taus[..5],
        [0.01, 0.0025, 0.01 / 16.0, 0.01 / 64.0, 0.01 / 256.0]
    );
    let (_, vertices) = run(0, short);
    assert_eq!(
        vertices,
        [12, 12, 42, 42, 162, 162, 642, 642, 2562, 2562, 2562, 2562]
    );
}

#[test]
fn the_length_of_edges_is_as_asked() {
    let schedule = Schedule::Adaptive {
        edge_length: EdgeLength::Absolute(0.1),
        diffusion: 0.1,
    };
    let evolved = evolve(
        &ellipsoid(3000),
        &Options {
            schedule,
            ..options()
        },
    )
    .unwrap();
    let mean = quality((&evolved.mesh).into(), &AngleBounds::default())
        .unwrap()
        .mean_edge;
    assert!((mean / 0.1 - 1.0).abs() < 0.3, "{mean}");
}

#[test]
fn the_observer_may_stop_it() {
    struct Stop;
    impl Progress for Stop {
        fn step(&self, stage: &'static str, done: u64, _total: u64) -> ControlFlow<()> {
            match stage == "evolve" && done > 3 {
                true => ControlFlow::Break(()),
                false => ControlFlow::Continue(()),
            }
        }
    }
    let error = evolve_with(&ellipsoid(500), &options(), &Stop, &mut |_, _| {}).unwrap_err();
    assert!(matches!(error, Error::Cancelled(_)));
}

#[test]
fn collapsing_is_an_error() {
    // A needle: no volume that the grid resolves, and nothing in the paper's stages that keeps the sheets apart.
    let stick = |width: f64| -> Vec<DVec3> {
        let mut random = Random(5);
        let size = DVec3::new(100.0, width, width);
        let mut point = || size * DVec3::new(random.unit(), random.unit(), random.unit());
        (0..400).map(|_| point()).collect()
    };
    let schedule = Schedule::Stages {
        levels: 3,
        stages: Stage::paper(500, 100.0, 0, 0.0),
    };
    let paper = Options {
        schedule,
        ..options()
    };
    let error = evolve(&stick(1e-4), &paper).map(|e| e.report);
    assert!(matches!(error, Err(Error::Collapsed { .. })), "{error:?}");
    assert_sound(&evolve(&stick(8.0), &Options::default()).unwrap());
}
