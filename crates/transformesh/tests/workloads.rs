//! Meshes whose right outcome is known: volume, components, genus.

mod common;

use common::*;
use pellicle_geometry::DVec3;
use pellicle_mesh::{TriMesh, TriangleSoup, signed_volume, winding_numbers};
use pellicle_transformesh::{Rule, repair};
use std::f64::consts::PI;

/// Name, volume, components, and their genera summed.
type Known = (&'static str, f64, usize, usize);

/// Closed forms; those marked * agree with the exact self-union of libigl 2.6.
const KNOWN: [Known; 15] = [
    ("cube_coincident_opposite", 0.0, 0, 0),
    ("cubes_coincident", 1.0, 1, 0),
    ("cubes_coplanar_shift", 1.5, 1, 0),
    ("cubes_edge_touch", 2.0, 2, 0),
    ("cubes_face_touch", 2.0, 1, 0),
    ("cubes_face_touch_partial", 1.25, 1, 0),
    ("cubes_generic", 107.0 / 64.0, 1, 0),
    ("cubes_vertex_touch", 2.0, 2, 0),
    ("edge_edge_cross", 16.0, 2, 0),
    ("vertex_on_face", 52.0 / 3.0, 2, 0),
    ("nested_cavity", 3.27138707599, 2, 0),  // *
    ("nested_out_out", 4.17268759693, 1, 0), // *
    ("sphere_all_inverted", 0.0, 0, 0),
    ("sphere_plus_inverted_overlap", 3.31064243743, 1, 0), // *
    ("torus_before", 7.040396447101142, 1, 1),             // of the input
];

#[test]
fn volume_and_topology_are_right() {
    for (name, volume, components, genus) in KNOWN {
        let input = workload(name);
        let (mesh, _) = repaired(&input, Rule::Union);
        let here = signed_volume((&mesh).into());
        assert!((here - volume).abs() <= 1e-9 * volume, "{name}: {here}");
        survivors(&input, &mesh).unwrap_or_else(|reason| panic!("{name}: {reason}"));
        assert_eq!(topology(&mesh), (components, genus), "{name}");
    }
}

/// Many sheets through each other. There is no second program that finishes them: winding numbers on a grid decide.
///
/// In the closed torus the tube passes through itself about the axis, once outwards and once inwards: there it winds 0
/// times, which [`Rule::Union`] keeps as a sealed void and [`Rule::Outside`] fills. In the middle of the dumbbell's neck,
/// which is inside out, the surface is turned once more: there a small body of its own winds once.
#[test]
fn pile_ups() {
    for (name, rule, components) in [
        ("torus_closed", Rule::Union, 2),
        ("torus_closed", Rule::Outside, 1),
        ("dumbbell_pinch", Rule::Union, 3),
    ] {
        let input = workload(name);
        let (mesh, _) = repaired(&input, rule);
        assert_eq!(topology(&mesh), (components, 0), "{name}");
        if rule == Rule::Outside {
            continue;
        }
        let bounds = pellicle_geometry::Aabb::of_points(&input.positions);
        let side = 48;
        let mut points = Vec::new();
        for (x, y, z) in grid(side) {
            // Off the planes of symmetry.
            let part = (DVec3::new(x, y, z) + DVec3::new(0.437, 0.519, 0.561)) / side as f64;
            points.push(bounds.min + part * bounds.extent());
        }
        let inside =
            |windings: Vec<i32>| -> Vec<bool> { windings.into_iter().map(|w| w >= 1).collect() };
        let before = inside(winding_numbers((&input).into(), &points));
        let after = inside(winding_numbers((&mesh).into(), &points));
        assert!(before == after, "{name}");
        let share = before.iter().filter(|&&b| b).count() as f64 / points.len() as f64;
        let sampled = share * bounds.extent().element_product();
        let volume = signed_volume((&mesh).into());
        assert!(
            (sampled / volume - 1.0).abs() < 0.02,
            "{name}: {sampled} {volume}"
        );
    }
}

/// The torus that moved outwards by 0.7 until its hole closed, by discs across its axis: with its void, and without.
#[test]
fn the_closed_torus_has_the_volume_of_a_spindle_torus() {
    let (axis, tube) = (1.0_f64, 1.2_f64);
    let steps = 100_000;
    let height = 2.0 * tube / f64::from(steps);
    let (mut outer, mut void) = (0.0, 0.0);
    for i in 0..steps {
        let z = (f64::from(i) + 0.5) * height - tube;
        let s = (tube * tube - z * z).sqrt();
        let hole = (axis - s).max(0.0);
        outer += PI * ((axis + s).powi(2) - hole * hole) * height;
        void += PI * (s - axis).max(0.0).powi(2) * height;
    }
    let input = workload("torus_closed");
    let [filled, hollow] = [Rule::Outside, Rule::Union].map(|rule| {
        let (mesh, _) = repaired(&input, rule);
        signed_volume((&mesh).into())
    });
    // 48 by 32 flat quadrilaterals.
    assert!((filled / outer - 1.0).abs() < 0.02, "{filled} {outer}");
    assert!(
        ((filled - hollow) / void - 1.0).abs() < 0.1,
        "{filled} {hollow} {void}"
    );
}

fn grid(side: usize) -> impl Iterator<Item = (f64, f64, f64)> {
    let line = move || (0..side).map(|i| i as f64);
    line().flat_map(move |x| line().flat_map(move |y| line().map(move |z| (x, y, z))))
}

#[test]
fn valid_meshes_come_back_bit_by_bit() {
    for name in ["dumbbell_before", "torus_before", "nested_cavity"] {
        let input = workload(name);
        for rule in [Rule::Union, Rule::Nonzero] {
            let (mesh, report) = repaired(&input, rule);
            assert!(same_bits(&mesh, &input), "{name}");
            let sources = report.sources.iter().enumerate();
            assert!(sources.into_iter().all(|(i, s)| s.index() == i), "{name}");
        }
        let mesh = TriMesh::try_from(input).unwrap();
        let (again, _) = repair(&mesh, &options(Rule::Union)).unwrap();
        assert!(same_bits(&mesh, &again), "{name}");
    }
}

#[test]
fn sealed_voids_go_under_the_papers_rule() {
    for (name, components, like) in [
        ("nested_cavity", 1, "nested_out_out"),
        ("nested_out_out", 1, "nested_out_out"),
        ("torus_before", 1, "torus_before"),
    ] {
        let (mesh, _) = repaired(&workload(name), Rule::Outside);
        let volume = KNOWN.iter().find(|known| known.0 == like).unwrap().1;
        let here = signed_volume((&mesh).into());
        assert!((here / volume - 1.0).abs() <= 1e-9, "{name}: {here}");
        assert_eq!(topology(&mesh).0, components, "{name}");
    }
}

#[test]
fn what_is_inside_out_counts_under_nonzero() {
    let input = workload("sphere_all_inverted");
    let (mesh, _) = repaired(&input, Rule::Nonzero);
    let volume = -signed_volume((&input).into());
    assert!((signed_volume((&mesh).into()) / volume - 1.0).abs() < 1e-12);
    assert_eq!(topology(&mesh), (1, 0));
    let (empty, _) = repaired(&workload("cube_coincident_opposite"), Rule::Nonzero);
    assert!(empty.triangles().is_empty());
    // Where they overlap the two cancel, and meet along a circle: a ring of touching edges.
    repaired(&workload("sphere_plus_inverted_overlap"), Rule::Nonzero);
}

/// Every mesh here: the order of its triangles, corners and vertices does not show, nor the threads.
#[test]
fn order_and_threads_do_not_show() {
    let more = [
        ("torus_closed", 0.0, 0, 0),
        ("dumbbell_pinch", 0.0, 0, 0),
        ("dumbbell_before", 0.0, 0, 0),
    ];
    let pool = |threads| {
        let builder = rayon::ThreadPoolBuilder::new().num_threads(threads);
        builder.build().unwrap()
    };
    let (one, three) = (pool(1), pool(3));
    for (name, ..) in KNOWN.iter().chain(&more) {
        let input = workload(name);
        let run = |input: &TriangleSoup| repair(input, &options(Rule::Union)).unwrap();
        let (alone, alone_report) = one.install(|| run(&input));
        let (together, together_report) = three.install(|| run(&input));
        assert!(same_bits(&alone, &together), "{name}");
        assert_eq!(alone_report.sources, together_report.sources, "{name}");
        for seed in [1, 2] {
            let (other, _) = run(&shuffled(&input, seed));
            assert!(as_set(&alone) == as_set(&other), "{name}");
        }
    }
}

/// Rounded to integers: triangles degenerate, duplicate, fold over and pile up.
#[test]
fn snapped_to_a_lattice() {
    for (name, cells) in [
        ("dumbbell_before", 12.0),
        ("dumbbell_pinch", 6.0),
        ("torus_before", 9.0),
        ("torus_closed", 5.0),
        ("torus_closed", 7.5),
        ("nested_cavity", 7.0),
        ("sphere_plus_inverted_overlap", 8.0),
    ] {
        let input = mapped(&workload(name), |p| (cells * p).round());
        repaired(&input, Rule::Union);
    }
}
