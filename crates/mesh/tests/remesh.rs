//! Remeshing: what comes out, what stays, and what it does with the degenerate.

mod common;

use common::*;
use pellicle_geometry::{DVec3, Progress, triangle};
use pellicle_mesh::*;
use proptest::prelude::*;
use std::ops::ControlFlow;

fn ellipsoid(levels: u32, axes: DVec3) -> TriMesh {
    let mut mesh = icosphere(levels).unwrap();
    let stretched = mesh.positions().iter().map(|&p| p * axes).collect();
    mesh.set_positions(stretched).unwrap();
    mesh
}

fn lengths(mesh: &TriMesh) -> Vec<f64> {
    let length = |h| {
        mesh.position(mesh.origin(h))
            .distance(mesh.position(mesh.destination(h)))
    };
    mesh.edges().map(length).collect()
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

fn relative(factor: f64) -> RemeshOptions {
    RemeshOptions {
        target: TargetLength::Relative(factor),
        ..RemeshOptions::default()
    }
}

/// Remeshes and checks what holds for any mesh and options.
fn remeshed(mesh: &TriMesh, options: &RemeshOptions) -> (TriMesh, RemeshReport) {
    let (result, report) = remesh(mesh, options, &()).unwrap();
    check_kept(mesh, &result);
    assert_eq!(
        report.after,
        quality((&result).into(), &AngleBounds::default())
    );
    (result, report)
}

fn check_kept(before: &TriMesh, after: &TriMesh) {
    let defects = after.validate();
    assert!(
        defects.iter().all(|d| !d.prevents_manifold()),
        "{defects:?}"
    );
    assert_eq!(
        after,
        &TriMesh::try_from(after.clone().into_soup()).unwrap()
    );
    assert_eq!(topology(after), topology(before));
}

/// All angles within 30° and 120°, no intersection that was not there, every vertex on the surface.
fn check_good(name: &str, mesh: &TriMesh, options: &RemeshOptions) -> TriMesh {
    let (result, report) = remeshed(mesh, options);
    let after = report.after.unwrap();
    let bounds = (after.small_angles, after.large_angles);
    let angles = [after.min_angle, after.max_angle].map(f64::to_degrees);
    assert_eq!(bounds, (0, 0), "{name}: {angles:?}");
    let meets = |m: &TriMesh| count_self_intersections(m.into(), &()).unwrap();
    assert!(meets(&result) <= meets(mesh), "{name}");
    result
}

#[test]
fn angles_are_good_on_smooth_closed_surfaces() {
    for axes in [
        [1.0, 1.0, 1.0],
        [1.0, 1.0, 5.0],
        [1.0, 4.0, 6.0],
        [5.0, 5.0, 1.0],
    ] {
        for levels in 2..5 {
            let mesh = ellipsoid(levels, DVec3::from(axes));
            check_good(
                &format!("{axes:?} {levels}"),
                &mesh,
                &RemeshOptions::default(),
            );
        }
    }
    for (major, minor) in [(1.0, 0.4), (1.0, 0.1)] {
        let mesh = mesh(torus(major, minor, 60, 16));
        let result = check_good("torus", &mesh, &RemeshOptions::default());
        assert_eq!(summarize((&result).into()).unwrap().genus(), Some(1));
    }
}

#[test]
fn angles_are_good_on_scans_and_parts() {
    for name in [
        "elephant",
        "hand",
        "knot1",
        "knot2",
        "bull",
        "anchor_dense",
        "turbine",
    ] {
        let mesh = TriMesh::try_from(off(name)).unwrap();
        check_good(name, &mesh, &RemeshOptions::default());
    }
    for name in ["holes", "blobby_3cc"] {
        let mesh = TriMesh::try_from(off(name)).unwrap();
        check_good(name, &mesh, &RemeshOptions::default());
    }
}

#[test]
fn lengths_are_as_wanted_and_vertices_on_the_surface() {
    let mesh = TriMesh::try_from(off("elephant")).unwrap();
    let before = mean(&lengths(&mesh));
    for factor in [0.5, 1.0, 2.0] {
        let (result, _) = remeshed(&mesh, &relative(factor));
        let after = lengths(&result);
        let wanted = factor * before;
        assert!(
            (mean(&after) / wanted - 1.0).abs() < 0.12,
            "{factor}: {}",
            mean(&after) / wanted
        );
        let off_limits = after
            .iter()
            .filter(|&&l| l < 0.6 * wanted || l > 1.5 * wanted)
            .count();
        assert!(
            off_limits * 100 < after.len(),
            "{factor}: {off_limits} of {}",
            after.len()
        );
        // The vertices themselves lie on the surface.
        let points = TriangleSoup {
            positions: result.positions().to_vec(),
            triangles: vec![],
        };
        let options = DistanceOptions {
            samples: 0,
            seed: 0,
        };
        let far = distances((&points).into(), (&mesh).into(), &options, &()).unwrap();
        assert!(far.max < 1e-12, "{factor}: {:e}", far.max);
    }
}

#[test]
fn absolute_and_relative_lengths_mean_the_same() {
    let mesh = ellipsoid(3, DVec3::new(1.0, 2.0, 3.0));
    let absolute = RemeshOptions {
        target: TargetLength::Absolute(mean(&lengths(&mesh))),
        ..RemeshOptions::default()
    };
    let [a, b] = [absolute, relative(1.0)].map(|o| remeshed(&mesh, &o).0);
    assert_eq!(a.positions().len(), b.positions().len());
}

#[test]
fn scale_and_threads_do_not_matter() {
    let mesh = ellipsoid(4, DVec3::new(1.0, 2.0, 3.0));
    let (expected, report) = remeshed(&mesh, &relative(0.8));
    for threads in [1, 2, 5] {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        let result = pool.install(|| remesh(&mesh, &relative(0.8), &()).unwrap());
        assert_eq!(result, (expected.clone(), report.clone()));
    }
    for scale in [2.0_f64.powi(-400), 2.0_f64.powi(400)] {
        let mut scaled = mesh.clone();
        let positions = |m: &TriMesh| m.positions().iter().map(|&p| p * scale).collect::<Vec<_>>();
        scaled.set_positions(positions(&mesh)).unwrap();
        let (result, _) = remeshed(&scaled, &relative(0.8));
        assert_eq!(result.triangles(), expected.triangles());
        assert_eq!(result.positions(), positions(&expected));
    }
}

#[test]
fn without_projection_little_volume_is_lost() {
    let mesh = ellipsoid(4, DVec3::new(1.0, 1.0, 3.0));
    let before = signed_volume((&mesh).into());
    for iterations in 1..4 {
        let options = RemeshOptions {
            iterations,
            projection: Projection::None,
            ..RemeshOptions::default()
        };
        let (result, report) = remeshed(&mesh, &options);
        let change = signed_volume((&result).into()) / before - 1.0;
        assert!(change.abs() < 0.01, "{iterations}: {change}");
        let after = report.after.unwrap();
        assert_eq!(
            (after.small_angles, after.large_angles),
            (0, 0),
            "{iterations}"
        );
    }
}

/// The greatest distance of a border vertex from the borders of another mesh.
fn off_the_border(result: &TriMesh, original: &TriMesh) -> f64 {
    let segments: Vec<[DVec3; 2]> = original
        .border_loops()
        .concat()
        .iter()
        .map(|&h| [original.origin(h), original.destination(h)].map(|v| original.position(v)))
        .collect();
    let distance = |p: DVec3| {
        let feet = segments
            .iter()
            .map(|&[a, b]| triangle::closest_point_on_segment(p, a, b));
        feet.map(|foot| foot.distance(p))
            .fold(f64::INFINITY, f64::min)
    };
    let border = result.vertex_ids().filter(|&v| result.is_border_vertex(v));
    border
        .map(|v| distance(result.position(v)))
        .fold(0.0, f64::max)
}

#[test]
fn borders_stay_where_they_are() {
    // A flat square keeps its outline exactly, so its area too, whatever the triangles.
    let square = mesh(sheet(12, 12));
    for factor in [0.4, 1.0, 3.0] {
        let (result, _) = remeshed(&square, &relative(factor));
        assert!((area((&result).into()) - 144.0).abs() < 1e-10, "{factor}");
        assert_eq!(off_the_border(&result, &square), 0.0);
        for corner in [[0.0, 0.0], [12.0, 0.0], [0.0, 12.0], [12.0, 12.0]] {
            let corner = DVec3::new(corner[0], corner[1], 0.0);
            assert!(result.positions().contains(&corner));
        }
    }
    for name in ["analytic/hemisphere_open", "holes", "mech-holes-shark"] {
        let open = TriMesh::try_from(off(name)).unwrap();
        let size = summarize((&open).into()).unwrap().bounds.diagonal();
        for projection in [Projection::Surface, Projection::None] {
            let options = RemeshOptions {
                projection,
                ..relative(1.5)
            };
            let (result, _) = remeshed(&open, &options);
            let off = off_the_border(&result, &open);
            assert!(off <= 1e-12 * size, "{name} {projection:?}: {off:e}");
        }
    }
}

#[test]
fn creases_stay_where_they_are() {
    let mut fine = mesh(cube());
    for _ in 0..3 {
        fine = subdivide(&fine).unwrap();
    }
    for factor in [0.5, 1.0, 2.0] {
        let options = RemeshOptions {
            crease_angle: Some(1.0),
            ..relative(factor)
        };
        let (result, report) = remeshed(&fine, &options);
        // Only with every edge of the cube in place are volume and area exact.
        assert!(
            (signed_volume((&result).into()) - 1.0).abs() < 1e-12,
            "{factor}"
        );
        assert!((area((&result).into()) - 6.0).abs() < 1e-12, "{factor}");
        for corner in cube().positions {
            assert!(result.positions().contains(&corner));
        }
        let after = report.after.unwrap();
        assert_eq!((after.small_angles, after.large_angles), (0, 0), "{factor}");
    }
    // Without creases the edges are cut.
    let (result, _) = remeshed(&fine, &relative(2.0));
    assert!(signed_volume((&result).into()) < 0.999);
}

#[test]
fn creases_are_found_behind_caps() {
    // On every third sharp edge of a cube a triangle without area, whose normal tells nothing of the crease.
    let mut fine = mesh(cube());
    for _ in 0..2 {
        fine = subdivide(&fine).unwrap();
    }
    let normal = |h: HalfEdgeId| {
        let [a, b, c] = fine.corners(h.triangle());
        triangle::unit_normal(a, b, c).unwrap()
    };
    let is_sharp = |h: &HalfEdgeId| normal(*h).dot(normal(fine.twin(*h).unwrap())) < 0.5;
    let mut editor = MeshEditor::new(fine.clone());
    let sharp: Vec<_> = fine.edges().filter(is_sharp).collect();
    let ends = |h: HalfEdgeId| [fine.origin(h), fine.destination(h)];
    for pair in sharp.iter().step_by(3).map(|&h| ends(h)) {
        let h = editor
            .half_edges()
            .find(|&h| editor.ends(h) == Some(pair))
            .unwrap();
        let [a, b] = pair.map(|v| fine.position(v));
        let m = editor.split(h, 0.5 * (a + b)).unwrap();
        // The edge across, at one side of the new vertex: flipped, it is a–b again, with m in a cap beside it.
        let across = h.next();
        assert_eq!(editor.ends(across).unwrap()[0], m);
        editor.flip(across).unwrap();
    }
    let capped = editor.finish().0;
    assert_eq!(capped.validate().len(), sharp.len().div_ceil(3));
    let options = RemeshOptions {
        crease_angle: Some(1.0),
        ..relative(1.0)
    };
    let (result, _) = remeshed(&capped, &options);
    assert!((signed_volume((&result).into()) - 1.0).abs() < 1e-12);
}

#[test]
fn lengths_follow_the_curvature() {
    // A sphere: one curvature, one length.
    let (radius, tolerance) = (2.0, 0.01);
    let sphere = ellipsoid(4, DVec3::splat(radius));
    let adapted = |mesh: &TriMesh, tolerance: f64, min: f64, max: f64| {
        let target = TargetLength::Curvature(CurvatureLength::new(tolerance, min, max));
        remeshed(
            mesh,
            &RemeshOptions {
                target,
                ..RemeshOptions::default()
            },
        )
    };
    let (result, _) = adapted(&sphere, tolerance, 1e-3, 10.0);
    let wanted = (6.0 * tolerance * radius - 3.0 * tolerance * tolerance).sqrt();
    assert!((mean(&lengths(&result)) / wanted - 1.0).abs() < 0.08);
    // The middles of triangles lie that far inside, but for what triangles differ in size.
    let depths: Vec<f64> = result
        .triangle_ids()
        .map(|t| {
            let [a, b, c] = result.corners(t);
            radius - triangle::centroid(a, b, c).length()
        })
        .collect();
    assert!(depths.iter().all(|&d| d < 2.0 * tolerance));
    assert!(
        (mean(&depths) / tolerance - 1.0).abs() < 0.25,
        "{}",
        mean(&depths)
    );

    // An ellipsoid: its tips have curvature 3 / 0.5², its waist at most 1 / 0.5.
    let pill = ellipsoid(5, DVec3::new(0.5, 0.5, 3.0));
    let (result, report) = adapted(&pill, 0.003, 0.01, 0.5);
    let near = |low: f64, high: f64| {
        let sides = result.edges().filter_map(|h| {
            let [a, b] = [result.origin(h), result.destination(h)].map(|v| result.position(v));
            (low..high).contains(&a.z.abs()).then(|| a.distance(b))
        });
        mean(&sides.collect::<Vec<_>>())
    };
    let length = |curvature: f64| (6.0 * 0.003 / curvature - 3.0 * 0.003_f64.powi(2)).sqrt();
    assert!(
        (near(0.0, 0.5) / length(2.0) - 1.0).abs() < 0.15,
        "{}",
        near(0.0, 0.5)
    );
    assert!(
        near(2.95, 3.0) < 0.55 * near(0.0, 0.5),
        "{}",
        near(2.95, 3.0)
    );
    let after = report.after.unwrap();
    assert_eq!((after.small_angles, after.large_angles), (0, 0));
    // Bounds hold: a sphere that wants longer or shorter edges gets those of the bounds.
    for (tolerance, min, max, wanted) in [(1.0, 0.1, 0.3, 0.3), (1e-9, 0.3, 0.5, 0.3)] {
        let (result, _) = adapted(&sphere, tolerance, min, max);
        assert!((mean(&lengths(&result)) / wanted - 1.0).abs() < 0.1);
    }
}

/// A sphere with needles, caps and triangles without area: vertices pushed onto or next to neighbours.
fn damaged(push: f64) -> TriMesh {
    let mut mesh = icosphere(3).unwrap();
    let mut positions = mesh.positions().to_vec();
    for v in mesh.vertex_ids().step_by(17) {
        let to = mesh.neighbors(v).next().unwrap();
        positions[v.index()] = positions[v.index()].lerp(positions[to.index()], push);
    }
    mesh.set_positions(positions).unwrap();
    mesh
}

#[test]
fn needles_and_caps_go() {
    for push in [0.9, 0.999, 1.0 - 1e-9, 1.0] {
        for factor in [0.3, 1.0, 2.0] {
            check_good(
                &format!("{push} {factor}"),
                &damaged(push),
                &relative(factor),
            );
        }
    }
    // Caps: the middle of an edge, and a little beside it.
    for aside in [0.0, 1e-12, 1e-3] {
        let mut mesh = icosphere(3).unwrap();
        let mut editor = MeshEditor::new(mesh.clone());
        for h in mesh.edges().step_by(13) {
            let [a, b] = [mesh.origin(h), mesh.destination(h)].map(|v| mesh.position(v));
            let across = (b - a).cross(a).normalize();
            // An earlier split may have given the id to another edge: any will do.
            let _ = editor.split(h, 0.5 * (a + b) + across * aside);
        }
        mesh = editor.finish().0;
        check_good(&format!("caps {aside:e}"), &mesh, &relative(1.0));
    }
}

#[test]
fn the_smallest_meshes_survive() {
    let lone = || soup(vec![DVec3::ZERO, DVec3::X, DVec3::Y], &[[0, 1, 2]]);
    let flat = || soup(vec![DVec3::ZERO, DVec3::X, 2.0 * DVec3::X], &[[0, 1, 2]]);
    let point = || {
        soup(
            vec![DVec3::ONE; 4],
            &[[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]],
        )
    };
    let line = || {
        let on = |x: f64| DVec3::new(x, 2.0 * x, -x);
        soup(
            [0.0, 1.0, 1.0, 5.0].map(on).to_vec(),
            &[[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]],
        )
    };
    let far = || {
        let end = f64::MAX;
        let corners = [
            DVec3::splat(end),
            DVec3::new(-end, end, end),
            DVec3::new(end, -end, end),
        ];
        soup(corners.to_vec(), &[[0, 1, 2]])
    };
    let tiny = || {
        let least = f64::from_bits(1);
        soup(
            vec![DVec3::ZERO, DVec3::X * least, DVec3::Y * least],
            &[[0, 1, 2]],
        )
    };
    let all = [
        TriangleSoup::default(),
        lone(),
        flat(),
        point(),
        line(),
        far(),
        tiny(),
        tetrahedron(),
        sheet(1, 1),
        sheet(5, 1),
    ];
    for soup in all {
        let mesh = TriMesh::try_from(soup).unwrap();
        for factor in [0.3, 1.0, 1e6] {
            for crease_angle in [None, Some(0.5)] {
                let options = RemeshOptions {
                    crease_angle,
                    ..relative(factor)
                };
                remeshed(&mesh, &options);
            }
        }
        let (better, _) = improve(&mesh, &ImproveOptions::default(), &()).unwrap();
        check_kept(&mesh, &better);
        assert_eq!(better.positions().len(), mesh.positions().len());
    }
    // As long as edges may be, nothing is left but a tetrahedron; and the lone triangle stays itself.
    let (result, _) = remeshed(&icosphere(2).unwrap(), &relative(1e6));
    assert!(result.triangles().len() < 20);
    assert_eq!(
        remeshed(&TriMesh::try_from(lone()).unwrap(), &relative(1e6))
            .0
            .into_soup(),
        lone()
    );
}

#[test]
fn options_that_mean_nothing_are_refused() {
    let mesh = mesh(tetrahedron());
    let target = |target| RemeshOptions {
        target,
        ..RemeshOptions::default()
    };
    let curvature = |tolerance, min, max| {
        target(TargetLength::Curvature(CurvatureLength::new(
            tolerance, min, max,
        )))
    };
    let mut bad = vec![
        curvature(0.0, 1.0, 2.0),
        curvature(0.1, 3.0, 2.0),
        curvature(0.1, -1.0, 2.0),
        curvature(0.1, 1.0, f64::INFINITY),
    ];
    for value in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        bad.push(target(TargetLength::Absolute(value)));
        bad.push(target(TargetLength::Relative(value)));
    }
    for value in [-0.1, 4.0, f64::NAN] {
        bad.push(RemeshOptions {
            crease_angle: Some(value),
            ..RemeshOptions::default()
        });
        bad.push(RemeshOptions {
            corner_angle: value,
            ..RemeshOptions::default()
        });
    }
    for options in bad {
        let error = remesh(&mesh, &options, &()).unwrap_err();
        assert!(
            matches!(error, MeshError::InvalidOption { .. }),
            "{options:?}: {error}"
        );
    }
    let error = remesh(&mesh, &target(TargetLength::Absolute(1e-9)), &()).unwrap_err();
    assert!(matches!(error, MeshError::TooLarge { .. }), "{error}");
}

#[test]
fn work_can_be_stopped() {
    struct Stop(u64);
    impl Progress for Stop {
        fn step(&self, _stage: &'static str, done: u64, total: u64) -> ControlFlow<()> {
            assert!(done <= total);
            match done >= self.0 {
                true => ControlFlow::Break(()),
                false => ControlFlow::Continue(()),
            }
        }
    }
    let mesh = icosphere(2).unwrap();
    for at in [0, 1, 3] {
        let cancelled = |e| matches!(e, MeshError::Cancelled(_));
        assert!(cancelled(
            remesh(&mesh, &RemeshOptions::default(), &Stop(at)).unwrap_err()
        ));
        assert!(cancelled(
            improve(&mesh, &ImproveOptions::default(), &Stop(at)).unwrap_err()
        ));
    }
}

#[test]
fn improving_keeps_vertices_and_opens_angles() {
    for projection in [Projection::Surface, Projection::None] {
        for axes in [DVec3::new(1.0, 1.0, 4.0), DVec3::new(3.0, 3.0, 1.0)] {
            let mesh = ellipsoid(4, axes);
            let options = ImproveOptions {
                projection,
                ..ImproveOptions::default()
            };
            let (better, report) = improve(&mesh, &options, &()).unwrap();
            check_kept(&mesh, &better);
            assert_eq!(better.positions().len(), mesh.positions().len());
            let (before, after) = (report.before.unwrap(), report.after.unwrap());
            assert!(before.small_angles > 500);
            assert_eq!(
                (after.small_angles, after.large_angles),
                (0, 0),
                "{projection:?} {axes}"
            );
            let volume = |m: &TriMesh| signed_volume(m.into());
            assert!((volume(&better) / volume(&mesh) - 1.0).abs() < 0.01);
            // The same vertices, moved a little: not others.
            let step = mean(&lengths(&mesh));
            let moves: Vec<f64> = mesh
                .vertex_ids()
                .map(|v| mesh.position(v).distance(better.position(v)))
                .collect();
            assert!(mean(&moves) < step, "{}", mean(&moves) / step);
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(150))]
    #[test]
    fn any_manifold_keeps_its_topology(
        triangles in prop::collection::vec([0_u32..14, 0_u32..14, 0_u32..14], 1..50),
        coordinates in prop::collection::vec([-3_i8..4, -3_i8..4, -3_i8..4], 14),
        factor in 0.3_f64..4.0,
        crease in prop::option::of(0.0_f64..3.0),
        project in any::<bool>(),
    ) {
        let positions = coordinates.iter().map(|c| DVec3::from(c.map(f64::from))).collect();
        let (mesh, _) = TriMesh::from_soup_splitting(soup(positions, &triangles), &SplitOptions::default()).unwrap();
        let options = RemeshOptions {
            projection: if project { Projection::Surface } else { Projection::None },
            crease_angle: crease,
            iterations: 3,
            ..relative(factor)
        };
        remeshed(&mesh, &options);
        let (better, _) = improve(&mesh, &ImproveOptions { crease_angle: crease, ..Default::default() }, &()).unwrap();
        check_kept(&mesh, &better);
        prop_assert_eq!(better.positions().len(), mesh.positions().len());
    }

    #[test]
    fn moved_spheres_keep_their_topology_and_face(
        moves in prop::collection::vec([-0.15_f64..0.15, -0.15_f64..0.15, -0.15_f64..0.15], 162),
        factor in 0.4_f64..2.0,
    ) {
        let mut mesh = icosphere(2).unwrap();
        let moved = mesh.positions().iter().zip(moves).map(|(&p, m)| p + DVec3::from(m)).collect();
        mesh.set_positions(moved).unwrap();
        let (result, _) = remeshed(&mesh, &relative(factor));
        prop_assert!(signed_volume((&result).into()) > 0.5 * signed_volume((&mesh).into()));
    }
}
