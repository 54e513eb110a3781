//! Each verb on real files: what it writes, and what it says.

mod common;

use common::{fixture, json, manifold, pellicle, stderr, stdout};
use pellicle::io::{Data, ReadOptions, read};
use pellicle::mesh::TriMesh;
use serde_json::Value;
use std::path::Path;
use tempfile::tempdir;

fn data(path: &Path) -> Data {
    read(path, &ReadOptions::default()).unwrap().data
}

#[test]
fn reconstruct_makes_closed_manifolds_of_a_torus_and_of_a_real_scan() {
    let folder = tempdir().unwrap();
    for (input, points) in [("analytic/torus.off", 6144), ("kitten.xyz", 5210)] {
        for method in ["cocone", "tight-cocone"] {
            let arguments = [
                "reconstruct",
                &fixture(input),
                "-o",
                "out.ply",
                "--force",
                "--method",
                method,
            ];
            let done = json(folder.path(), &arguments);
            assert_eq!(done["points"], points);
            assert_eq!(done["closed"], true);
            let Data::Mesh { soup, .. } = data(&folder.path().join("out.ply")) else {
                panic!("no mesh of {input}");
            };
            assert_eq!(done["triangles"], soup.triangles.len());
            assert!(TriMesh::try_from(soup).unwrap().is_closed());
            manifold(&json(folder.path(), &["info", "out.ply"]), 1);
        }
    }
}

#[test]
fn the_number_of_threads_does_not_matter() {
    let folder = tempdir().unwrap();
    let input = fixture("oni.pwn");
    for threads in ["1", "2", "4"] {
        let out = format!("{threads}.ply");
        pellicle(folder.path())
            .args(["reconstruct", &input, "-o", &out, "--threads", threads])
            .assert()
            .success();
    }
    let bytes =
        |threads: &str| std::fs::read(folder.path().join(format!("{threads}.ply"))).unwrap();
    assert!(bytes("1") == bytes("2") && bytes("2") == bytes("4"));
}

#[test]
fn info_describes_points_and_meshes() {
    let folder = tempdir().unwrap();
    let points = json(folder.path(), &["info", &fixture("kitten.xyz")]);
    assert_eq!(points["kind"], "points");
    assert_eq!(points["points"], 5210);
    assert_eq!(points["normals"], true);
    assert!(points["spacing"].as_f64().unwrap() > 0.0);

    let cube = json(folder.path(), &["info", &fixture("analytic/cube.off")]);
    assert_eq!(cube["kind"], "mesh");
    for (key, value) in [
        ("vertices", 8),
        ("edges", 18),
        ("triangles", 12),
        ("genus", 0),
        ("borders", 0),
    ] {
        assert_eq!(cube[key], value, "{key}");
    }
    let torus = json(folder.path(), &["info", &fixture("analytic/torus.off")]);
    assert_eq!(torus["genus"], 1);
    let open = json(
        folder.path(),
        &["info", &fixture("analytic/hemisphere_open.off")],
    );
    assert_eq!(
        (&open["closed"], &open["borders"]),
        (&Value::Bool(false), &Value::from(1))
    );
    assert_eq!(open["volume"], Value::Null);
    let moebius = json(folder.path(), &["info", &fixture("analytic/moebius.off")]);
    assert_eq!(moebius["genus"], Value::Null);
    let spheres = json(
        folder.path(),
        &["info", &fixture("analytic/two_spheres_gap.off")],
    );
    assert_eq!(spheres["components"], 2);

    let text = stdout(
        &pellicle(folder.path())
            .args(["info", &fixture("analytic/cube.off")])
            .assert()
            .success(),
    );
    assert!(
        text.contains("self-intersections  0\n") && text.contains("closed              yes\n"),
        "{text}"
    );
}

#[test]
fn info_counts_self_intersections() {
    let folder = tempdir().unwrap();
    let crossing =
        "OFF\n6 2 0\n0 0 0\n2 0 0\n0 2 0\n0.5 0.5 -1\n0.5 0.5 1\n3 3 1\n3 0 1 2\n3 3 4 5\n";
    std::fs::write(folder.path().join("crossing.off"), crossing).unwrap();
    let info = json(folder.path(), &["info", "crossing.off"]);
    assert_eq!(
        (&info["self_intersections"], &info["components"]),
        (&Value::from(1), &Value::from(2))
    );
}

#[test]
fn convert_keeps_every_bit_where_the_format_can() {
    let folder = tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let steps = [
        (fixture("kitten.xyz"), "a.ply"),
        ("a.ply".into(), "b.csv"),
        ("b.csv".into(), "c.ply"),
    ];
    for (from, to) in &steps {
        pellicle(folder.path())
            .args(["convert", from, "-o", to])
            .assert()
            .success();
    }
    assert_eq!(data(&at("a.ply")), data(Path::new(&steps[0].0)));
    assert_eq!(data(&at("c.ply")), data(&at("a.ply")));

    let elephant = fixture("elephant.off");
    for (from, to) in [
        (elephant.as_str(), "e.obj"),
        ("e.obj", "e.ply"),
        ("e.ply", "e.off"),
    ] {
        pellicle(folder.path())
            .args(["convert", from, "-o", to])
            .assert()
            .success();
    }
    assert_eq!(data(&at("e.off")), data(Path::new(&elephant)));
    pellicle(folder.path())
        .args(["convert", "e.ply", "-o", "text.ply", "--encoding", "text"])
        .assert()
        .success();
    assert!(
        std::fs::read(at("text.ply"))
            .unwrap()
            .starts_with(b"ply\nformat ascii")
    );
    assert_eq!(data(&at("text.ply")), data(&at("e.ply")));
}

#[test]
fn what_a_reader_changes_is_said() {
    let folder = tempdir().unwrap();
    let square = "OFF\n4 1 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n";
    std::fs::write(folder.path().join("square.off"), square).unwrap();
    let assert = pellicle(folder.path())
        .args(["info", "square.off"])
        .assert()
        .success();
    assert!(
        stderr(&assert).contains("1 polygons cut"),
        "{}",
        stderr(&assert)
    );
}

#[test]
fn convert_to_single_precision_says_so() {
    let folder = tempdir().unwrap();
    let assert = pellicle(folder.path())
        .args(["convert", &fixture("elephant.off"), "-o", "e.stl"])
        .assert()
        .success();
    assert!(
        stderr(&assert).contains("single precision"),
        "{}",
        stderr(&assert)
    );
    let quiet = pellicle(folder.path())
        .args([
            "convert",
            &fixture("elephant.off"),
            "-o",
            "q.stl",
            "--quiet",
        ])
        .assert()
        .success();
    assert_eq!(stderr(&quiet), "");
}

#[test]
fn normals_are_of_length_one_and_point_outwards() {
    let folder = tempdir().unwrap();
    let sphere = fixture("analytic/sphere.off");
    pellicle(folder.path())
        .args(["normals", &sphere, "-o", "n.ply"])
        .assert()
        .success();
    let Data::Points(cloud) = data(&folder.path().join("n.ply")) else {
        panic!("no points");
    };
    let center = cloud.bounds().center();
    for (p, n) in cloud.positions().iter().zip(cloud.normals().unwrap()) {
        assert!((n.length() - 1.0).abs() < 1e-9);
        assert!(n.dot((*p - center).normalize()) > 0.9, "{p} {n}");
    }
}

#[test]
fn delaunay_writes_tetrahedra_hull_and_facets() {
    let folder = tempdir().unwrap();
    let cube = fixture("analytic/cube.off");
    let done = json(
        folder.path(),
        &["delaunay", &cube, "-o", "cube.vtk", "--encoding", "text"],
    );
    let text = std::fs::read_to_string(folder.path().join("cube.vtk")).unwrap();
    let count = done["tetrahedra"].as_u64().unwrap();
    assert!((5..=6).contains(&count));
    assert!(
        text.contains("POINTS 8 double\n")
            && text.contains(&format!("CELLS {count} {}\n", 5 * count))
    );

    pellicle(folder.path())
        .args(["delaunay", &cube, "-o", "cube.mesh"])
        .assert()
        .success();
    let medit = std::fs::read_to_string(folder.path().join("cube.mesh")).unwrap();
    assert!(medit.contains(&format!("Tetrahedra\n{count}\n")));

    pellicle(folder.path())
        .args(["delaunay", &cube, "-o", "hull.ply"])
        .assert()
        .success();
    let hull = json(folder.path(), &["info", "hull.ply"]);
    let volume = |info: &Value| info["volume"].as_f64().unwrap();
    let truth = json(folder.path(), &["info", &cube]);
    assert_eq!(
        (&hull["closed"], &hull["triangles"]),
        (&Value::Bool(true), &Value::from(12))
    );
    assert!(volume(&hull) > 0.0 && (volume(&hull) - volume(&truth)).abs() < 1e-12);

    pellicle(folder.path())
        .args(["delaunay", &cube, "-o", "all.ply", "--facets", "all"])
        .assert()
        .success();
    let all = json(folder.path(), &["info", "all.ply"]);
    // Each tetrahedron has four facets; inner ones are counted twice so.
    assert_eq!(all["triangles"].as_u64().unwrap() * 2, 4 * count + 12);
}

#[test]
fn compare_measures_both_ways() {
    let folder = tempdir().unwrap();
    let sphere = fixture("analytic/sphere.off");
    let same = json(folder.path(), &["compare", &sphere, &sphere]);
    assert!(same["hausdorff"]["relative"].as_f64().unwrap() < 1e-12);

    // Two parallel squares, one twice as long: 0.5 apart, and the longer reaches past the other by 1.
    let square = |x: f64, z: f64| {
        format!("OFF\n4 2 0\n0 0 {z}\n{x} 0 {z}\n{x} 1 {z}\n0 1 {z}\n3 0 1 2\n3 0 2 3\n")
    };
    std::fs::write(folder.path().join("a.off"), square(1.0, 0.0)).unwrap();
    std::fs::write(folder.path().join("b.off"), square(2.0, 0.5)).unwrap();
    let found = json(folder.path(), &["compare", "a.off", "b.off"]);
    let number = |way: &str, what: &str| found[way][what]["absolute"].as_f64().unwrap();
    assert!((number("forward", "max") - 0.5).abs() < 1e-12);
    assert!((number("forward", "mean") - 0.5).abs() < 1e-12);
    assert!((number("backward", "max") - 1.25_f64.sqrt()).abs() < 1e-12);
    assert!(number("backward", "rms") > number("backward", "mean"));
    let hausdorff = found["hausdorff"]["absolute"].as_f64().unwrap();
    assert_eq!(hausdorff, number("backward", "max"));
    let text = stdout(
        &pellicle(folder.path())
            .args(["compare", "a.off", "b.off"])
            .assert()
            .success(),
    );
    assert!(text.contains("Hausdorff"), "{text}");
}

#[test]
fn render_draws_meshes_and_points() {
    let folder = tempdir().unwrap();
    for (name, out) in [
        ("elephant.off", "a.png"),
        ("kitten.xyz", "b.PNG"),
        ("half.xyz", "c.png"),
    ] {
        pellicle(folder.path())
            .args([
                "render",
                &fixture(name),
                "-o",
                out,
                "--width",
                "200",
                "--height",
                "100",
            ])
            .args(["--views", "front,three-quarter", "--up", "z"])
            .assert()
            .success();
        let bytes = std::fs::read(folder.path().join(out)).unwrap();
        let picture = image::load_from_memory(&bytes).unwrap().into_rgba8();
        assert_eq!(picture.dimensions(), (200, 100));
        let background = *picture.get_pixel(0, 0);
        let covered = picture
            .pixels()
            .filter(|&&pixel| pixel != background)
            .count();
        assert!(covered > 1000, "{name}: {covered}");
    }
}

#[test]
fn every_verb_reports_as_json() {
    let folder = tempdir().unwrap();
    let kitten = fixture("oni.pwn");
    for (verb, out) in [
        ("reconstruct", "r.ply"),
        ("delaunay", "d.vtk"),
        ("convert", "c.ply"),
        ("normals", "n.ply"),
        ("render", "p.png"),
        ("view", "p.html"),
        ("evolve", "e.ply"),
    ] {
        let done = json(folder.path(), &[verb, &kitten, "-o", out]);
        assert_eq!(done["output"], out, "{verb}");
        let size = std::fs::metadata(folder.path().join(out)).unwrap().len();
        assert_eq!(done["bytes"], size, "{verb}");
    }
}
