//! `smooth` and `remesh`, against closed forms.

mod common;

use common::{fixture, json, manifold, names, pellicle, stderr};
use pellicle::geometry::DVec3;
use pellicle::io::{WriteOptions, read_mesh, write_mesh};
use pellicle::mesh::{TriMesh, icosphere};
use std::path::Path;
use tempfile::tempdir;

fn write(path: &Path, mesh: &TriMesh) {
    write_mesh(path, mesh, None, &WriteOptions::default()).unwrap();
}

/// A sphere of radius 10 whose vertices alternate by a part of that.
fn rough_sphere(roughness: f64) -> TriMesh {
    let mut mesh = icosphere(4).unwrap();
    let moved = mesh.positions().iter().enumerate();
    let moved = moved.map(|(i, p)| 10.0 * p * (1.0 + roughness * ((i % 5) as f64 - 2.0)));
    let moved: Vec<DVec3> = moved.collect();
    mesh.set_positions(moved).unwrap();
    mesh
}

#[test]
fn free_smoothing_shrinks_a_sphere_as_the_closed_form_says() {
    let folder = tempdir().unwrap();
    write(&folder.path().join("s.ply"), &rough_sphere(0.0));
    let before = json(folder.path(), &["info", "s.ply"]);
    let edge = before["mean_edge"].as_f64().unwrap();
    let (steps, strength) = (40, 0.5);
    let arguments = ["smooth", "s.ply", "-o", "out.ply", "--free"];
    let options = ["--steps", "40", "--strength", "0.5"];
    json(folder.path(), &[&arguments[..], &options].concat());
    // R² = R₀² − 4t, and a step takes `strength` mean edges squared of t.
    let time = f64::from(steps) * strength * edge * edge;
    let expected = (100.0 - 4.0 * time).sqrt();
    let options = pellicle::io::ReadOptions::default();
    let soup = read_mesh(folder.path().join("out.ply"), &options)
        .unwrap()
        .soup;
    let count = soup.positions.len() as f64;
    let radius = soup.positions.iter().map(|p| p.length()).sum::<f64>() / count;
    // The way is 10 − expected; steps of this length follow it to a few hundredths.
    let way = 10.0 - expected;
    assert!(
        way > 1.0 && (radius - expected).abs() < 0.04 * way,
        "{radius} {expected}"
    );
}

#[test]
fn smoothing_keeps_the_volume_and_takes_roughness_away() {
    let folder = tempdir().unwrap();
    write(&folder.path().join("rough.ply"), &rough_sphere(0.004));
    let done = json(folder.path(), &["smooth", "rough.ply", "-o", "out.ply"]);
    let info = |name: &str| json(folder.path(), &["info", name]);
    let number = |value: &serde_json::Value, key: &str| value[key].as_f64().unwrap();
    let (before, after) = (info("rough.ply"), info("out.ply"));
    manifold(&after, 0);
    assert_eq!(done["steps"], 10);
    assert_eq!(before["vertices"], after["vertices"]);
    let volume = |value: &serde_json::Value| number(value, "volume");
    assert!((volume(&after) / volume(&before) - 1.0).abs() < 1e-6);
    assert!((number(&done, "volume_before") / volume(&before) - 1.0).abs() < 1e-12);
    // What area there is beyond that of the sphere of the same volume.
    let excess = |value: &serde_json::Value| {
        let radius = (volume(value) * 0.75 / std::f64::consts::PI).cbrt();
        number(value, "area") / (4.0 * std::f64::consts::PI * radius * radius) - 1.0
    };
    assert!(
        excess(&after) < 0.5 * excess(&before),
        "{} {}",
        excess(&after),
        excess(&before)
    );
}

#[test]
fn smoothing_wants_a_closed_mesh() {
    let folder = tempdir().unwrap();
    let assert = pellicle(folder.path())
        .args([
            "smooth",
            &fixture("analytic/hemisphere_open.off"),
            "-o",
            "out.ply",
        ])
        .assert()
        .code(1);
    let said = stderr(&assert);
    assert!(
        said.contains("hemisphere_open.off") && said.contains("closed"),
        "{said}"
    );
    let assert = pellicle(folder.path())
        .args(["smooth", &fixture("kitten.xyz"), "-o", "out.ply"])
        .assert()
        .code(1);
    let said = stderr(&assert);
    assert!(
        said.contains("no triangle") && said.contains("reconstruct"),
        "{said}"
    );
    let assert = pellicle(folder.path())
        .args(["remesh", &fixture("analytic/moebius.off"), "-o", "out.ply"])
        .assert()
        .code(1);
    assert!(stderr(&assert).contains("manifold"), "{}", stderr(&assert));
    assert!(names(folder.path()).is_empty());
}

#[test]
fn remeshing_gives_the_lengths_that_were_asked_for() {
    let folder = tempdir().unwrap();
    let elephant = fixture("elephant.off");
    let run = |further: &[&str]| {
        let arguments = ["remesh", &elephant, "-o", "out.ply", "--force"];
        let done = json(folder.path(), &[&arguments, further].concat());
        manifold(&json(folder.path(), &["info", "out.ply"]), 3);
        done
    };
    let number = |value: &serde_json::Value, key: &str| value[key].as_f64().unwrap();
    let same = run(&[]);
    assert!(number(&same, "least_angle") > 25.0, "{same}");
    assert_eq!(same["vertices_before"], 2775);
    let length = number(&same, "mean_edge");
    let volume = number(&json(folder.path(), &["info", &elephant]), "volume");
    let coarse = run(&["--relative", "2"]);
    let ratio = number(&coarse, "mean_edge") / length;
    assert!((1.8..2.2).contains(&ratio), "{ratio}");
    let fine = run(&["--edge-length", "0.01", "--iterations", "4"]);
    assert!(
        (number(&fine, "mean_edge") / 0.01 - 1.0).abs() < 0.1,
        "{fine}"
    );
    assert!((number(&fine, "volume") / volume - 1.0).abs() < 0.01);
    // A looser tolerance takes fewer triangles, a greater least length as well.
    let triangles = |further: &[&str]| run(further)["triangles"].as_u64().unwrap();
    let fine = triangles(&["--curvature", "0.0005"]);
    let loose = triangles(&["--curvature", "0.002"]);
    let bounded = triangles(&["--curvature", "0.0005", "--min", "0.03", "--max", "0.1"]);
    assert!(loose < fine && bounded < fine, "{loose} {bounded} {fine}");
}

#[test]
fn creases_are_kept_when_asked_for() {
    let folder = tempdir().unwrap();
    let cube = fixture("analytic/cube.off");
    let volume = |further: &[&str]| {
        let arguments = [
            "remesh",
            &cube,
            "-o",
            "out.ply",
            "--force",
            "--relative",
            "0.3",
        ];
        let done = json(folder.path(), &[&arguments, further].concat());
        done["volume"].as_f64().unwrap()
    };
    let whole = volume(&["--creases", "60"]);
    assert!((whole - 1.0).abs() < 1e-12, "{whole}");
    assert!(volume(&[]) < 0.999);
    assert!(volume(&["--no-projection"]) < 0.999);
}

#[test]
fn vertices_lie_on_the_surface_unless_they_need_not() {
    let folder = tempdir().unwrap();
    let elephant = fixture("elephant.off");
    let farthest = |further: &[&str]| {
        let arguments = ["remesh", &elephant, "-o", "out.ply", "--force"];
        json(folder.path(), &[&arguments, further].concat());
        let arguments = ["compare", "out.ply", &elephant, "--samples", "0"];
        let compared = json(folder.path(), &arguments);
        compared["forward"]["max"]["relative"].as_f64().unwrap()
    };
    assert!(farthest(&[]) < 1e-9);
    assert!(farthest(&["--no-projection"]) > 1e-4);
}

#[test]
fn flat_parts_have_edges_of_a_tenth_of_the_diagonal_at_most() {
    let folder = tempdir().unwrap();
    let done = json(
        folder.path(),
        &[
            &["remesh", &fixture("analytic/cube.off"), "-o", "out.ply"][..],
            &["--curvature", "0.01", "--creases", "60"],
        ]
        .concat(),
    );
    let edge = done["mean_edge"].as_f64().unwrap() / 3.0_f64.sqrt();
    assert!((0.07..0.13).contains(&edge), "{done}");
}
