//! `morph`, with its snapshots and tables, and what its failures leave.

mod common;

use common::{fixture, json, manifold, names, pellicle, stderr, stdout};
use pellicle::geometry::DVec3;
use pellicle::io::{WriteOptions, write_mesh};
use pellicle::mesh::icosphere;
use std::path::Path;
use tempfile::tempdir;

fn sphere(path: &Path, center: DVec3, radius: f64) {
    let mut mesh = icosphere(3).unwrap();
    let positions = mesh.positions().iter().map(|p| center + radius * *p);
    mesh.set_positions(positions.collect()).unwrap();
    write_mesh(path, &mesh, None, &WriteOptions::default()).unwrap();
}

#[test]
fn a_sphere_becomes_a_torus_with_snapshots_and_a_table() {
    let folder = tempdir().unwrap();
    sphere(&folder.path().join("s.ply"), DVec3::splat(7.0), 0.1);
    let torus = fixture("repair/torus_before.off");
    let arguments = ["morph", "s.ply", &torus, "-o", "out.ply"];
    let more = [
        "--place",
        "enclose",
        "--snapshots",
        "frames",
        "--csv",
        "t.csv",
    ];
    let done = json(folder.path(), &[&arguments[..], &more].concat());
    assert_eq!(
        (&done["arrived"], &done["genus"]),
        (&true.into(), &1.into())
    );
    for (key, value) in [
        ("components", 1),
        ("target_genus", 1),
        ("missed", 0),
        ("self_intersections", 0),
    ] {
        assert_eq!(done[key], value, "{key}");
    }
    let number = |key: &str| done[key].as_f64().unwrap();
    assert!(number("mean_distance_edges") < 0.25, "{done}");
    let edges = number("mean_distance") / number("edge_length");
    assert!((edges / number("mean_distance_edges") - 1.0).abs() < 1e-9);
    manifold(&json(folder.path(), &["info", "out.ply"]), 1);

    let steps = done["steps"].as_u64().unwrap();
    let table = std::fs::read_to_string(folder.path().join("t.csv")).unwrap();
    let rows: Vec<Vec<&str>> = table.lines().map(|l| l.split(',').collect()).collect();
    assert_eq!(rows.len() as u64, steps + 2);
    assert!(rows.iter().all(|row| row.len() == rows[0].len()));
    assert_eq!(
        (rows[1][0], rows[1][8], rows[rows.len() - 1][8]),
        ("0", "0", "1")
    );

    let frames = folder.path().join("frames");
    let kept = names(&frames);
    let last = format!("step-{steps:06}.ply");
    for name in [
        "morph.glb",
        "morph.png",
        "step-000000.ply",
        "step-000004.ply",
        &last,
    ] {
        assert!(kept.iter().any(|k| k == name), "{name}: {kept:?}");
    }
    assert_eq!(done["snapshots"]["meshes"], kept.len() - 2);
    let bytes = |name: &str| std::fs::read(folder.path().join(name)).unwrap();
    assert!(bytes("out.ply") == bytes(&format!("frames/{last}")));
    // Again on one thread, the same; but not over what is there.
    let assert = pellicle(folder.path())
        .args(arguments)
        .args(more)
        .assert()
        .code(1);
    assert!(stderr(&assert).contains("--force"));
    let before = bytes("out.ply");
    pellicle(folder.path())
        .args(arguments)
        .args(["--place", "enclose", "--force", "--threads", "1"])
        .assert()
        .success();
    assert!(before == bytes("out.ply"));
}

#[test]
fn a_source_beside_the_target_vanishes_and_leaves_its_records() {
    let folder = tempdir().unwrap();
    sphere(&folder.path().join("a.ply"), DVec3::ZERO, 1.0);
    sphere(&folder.path().join("b.ply"), 5.0 * DVec3::X, 1.0);
    let assert = pellicle(folder.path())
        .args(["morph", "a.ply", "b.ply", "-o", "out.ply"])
        .args(["--csv", "t.csv", "--snapshots", "frames"])
        .assert()
        .code(1);
    let said = stderr(&assert);
    assert!(
        said.contains("vanished") && said.contains("--place"),
        "{said}"
    );
    assert_eq!(stdout(&assert), "");
    assert_eq!(names(folder.path()), ["a.ply", "b.ply", "frames", "t.csv"]);
    assert!(names(&folder.path().join("frames")).contains(&"morph.glb".to_owned()));
}

#[test]
fn what_was_not_found_is_said() {
    let folder = tempdir().unwrap();
    sphere(&folder.path().join("a.ply"), DVec3::ZERO, 1.0);
    // Two spheres, one inside the other, both facing outwards: the inner one is no surface.
    let two = fixture("repair/nested_cavity.off");
    let assert = pellicle(folder.path())
        .args([
            "morph", "a.ply", &two, "-o", "out.ply", "--place", "enclose",
        ])
        .assert()
        .success();
    let said = stderr(&assert);
    assert!(said.contains("1 components of the target"), "{said}");
}

#[test]
fn open_meshes_are_named() {
    let folder = tempdir().unwrap();
    sphere(&folder.path().join("a.ply"), DVec3::ZERO, 1.0);
    let open = fixture("analytic/hemisphere_open.off");
    for (source, target, side) in [
        ("a.ply", open.as_str(), "target"),
        (&open, "a.ply", "source"),
    ] {
        let assert = pellicle(folder.path())
            .args(["morph", source, target, "-o", "out.ply"])
            .assert()
            .code(1);
        let said: String = stderr(&assert)
            .split_whitespace()
            .collect::<Vec<_>>()
            .join(" ");
        assert!(
            said.contains("hemisphere_open") && said.contains(side),
            "{said}"
        );
    }
    assert_eq!(names(folder.path()), ["a.ply"]);
}
