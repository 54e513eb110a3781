//! The examples do what they say, on small inputs.

use pellicle::prelude::*;
use std::path::{Path, PathBuf};

#[allow(dead_code)]
#[path = "../examples/evolve.rs"]
mod evolve_example;
#[allow(dead_code)]
#[path = "../examples/neighbors.rs"]
mod neighbors;
#[allow(dead_code)]
#[path = "../examples/reconstruct.rs"]
mod reconstruct_example;
#[allow(dead_code)]
#[path = "../examples/union.rs"]
mod union_example;

fn fixture(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../fixtures")
        .join(name)
}

fn soup(name: &str) -> TriangleSoup {
    let read = read_mesh(fixture(name), &ReadOptions::default());
    read.unwrap().soup
}

#[test]
fn a_scan_becomes_watertight() {
    let folder = tempfile::tempdir().unwrap();
    let output = folder.path().join("half.ply");
    let said = reconstruct_example::run(&fixture("half.xyz"), &output).unwrap();
    assert!(
        said.starts_with("325 of 325 points, 646 triangles in 1 components"),
        "{said}"
    );
    let read = read_mesh(&output, &ReadOptions::default()).unwrap().soup;
    assert!(TriMesh::try_from(read).unwrap().is_closed());

    // Not overwritten, and said so.
    let again = reconstruct_example::run(&fixture("half.xyz"), &output);
    assert!(matches!(
        again,
        Err(reconstruct_example::Failure::File(io::Error::Exists { .. }))
    ));
    // Three points are no body.
    let flat = folder.path().join("flat.xyz");
    std::fs::write(&flat, "0 0 0\n1 0 0\n0 1 0\n").unwrap();
    assert!(matches!(
        reconstruct_example::run(&flat, &folder.path().join("flat.ply")),
        Err(reconstruct_example::Failure::Span(
            delaunay::Error::TooFewPoints { distinct: 3 }
        ))
    ));
}

#[test]
fn a_surface_evolves_and_can_be_stopped() {
    let scan = fixture("sphere926.pwn");
    let mut said = Vec::new();
    let evolved = evolve_example::run(&scan, 40, || false, &mut |line| said.push(line)).unwrap();
    assert!(said[0].starts_with("step    1: volume "), "{said:?}");
    let points = read_points(&scan, &ReadOptions::default()).unwrap().cloud;
    let points = MeshView {
        positions: points.positions(),
        triangles: &[],
    };
    let radius = 0.5 * points.bounds().extent().max_element();
    let ball = 4.0 / 3.0 * std::f64::consts::PI * radius.powi(3);
    let volume = mesh::signed_volume((&evolved.mesh).into());
    assert!(
        (volume / ball - 1.0).abs() < 0.05,
        "{volume} instead of {ball}"
    );

    let stopped = evolve_example::run(&scan, 40, || true, &mut |_| {}).unwrap_err();
    assert_eq!(stopped.to_string(), Cancelled.to_string());
}

#[test]
fn two_cubes_become_one_body() {
    // The second half an edge further along each axis.
    let cube = soup("analytic/cube.off");
    let least = cube.positions.iter().copied().reduce(DVec3::min).unwrap();
    let edge = cube.positions.iter().copied().reduce(DVec3::max).unwrap() - least;
    let mut moved = cube.clone();
    for position in &mut moved.positions {
        *position += 0.5 * edge;
    }
    let (union, report) = union_example::union(&[cube.clone(), moved.clone()]).unwrap();
    assert!(union.is_closed() && report.remaining == 0);
    let one = edge.x * edge.y * edge.z;
    let volume = mesh::signed_volume((&union).into());
    assert!((volume - 15.0 / 8.0 * one).abs() < 1e-12 * one, "{volume}");

    // Inside out, the second is taken away.
    for triangle in &mut moved.triangles {
        triangle.reverse();
    }
    let (difference, _) = union_example::union(&[cube, moved]).unwrap();
    let volume = mesh::signed_volume((&difference).into());
    assert!((volume - 7.0 / 8.0 * one).abs() < 1e-12 * one, "{volume}");
}

#[test]
fn points_answer() {
    // 5 × 5 × 5: every bounded cell is a unit cube, and the middle is a point.
    let grid: Vec<DVec3> = (0..125)
        .map(|i| DVec3::new(f64::from(i % 5), f64::from(i / 5 % 5), f64::from(i / 25)))
        .collect();
    let said = neighbors::ask(&grid).unwrap();
    assert!(said[0].ends_with("point 62, 0.000000 away"), "{said:?}");
    assert_eq!(said[1], "it lies in Vertex(VertexId(62))");
    assert!(said[2].ends_with(": 1.000000"), "{said:?}");

    // Points at a distance of at least 1.5: every one that is left out has one of them nearer.
    let share = 1.5 / DVec3::splat(4.0).length();
    let kept = neighbors::thin(&grid, share).unwrap();
    let nearest = |from: DVec3| {
        let others = kept.iter().filter(|&&other| other != from);
        others
            .map(|other| other.distance(from))
            .fold(f64::INFINITY, f64::min)
    };
    for &point in &grid {
        assert_eq!(kept.contains(&point), nearest(point) >= 1.5, "{point}");
    }
}
