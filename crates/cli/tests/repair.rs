//! `repair`, and what `info` says of self-intersections, on files whose outcome is known.

mod common;

use common::{fixture, json, names, pellicle, stderr, stdout};
use pellicle::geometry::{DVec3, VertexId};
use pellicle::io::{ReadOptions, WriteOptions, read_mesh, write_mesh};
use pellicle::mesh::{TriMesh, TriangleSoup, icosphere};
use serde_json::Value;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};
use tempfile::tempdir;

fn soup(path: &Path) -> TriangleSoup {
    read_mesh(path, &ReadOptions::default()).unwrap().soup
}

fn parsed(path: &Path) -> Value {
    serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
}

#[test]
fn known_outcomes_are_reached_and_written() {
    let folder = tempdir().unwrap();
    for (name, rule, components, volume) in [
        ("cubes_generic", "union", 1, 107.0 / 64.0),
        ("cubes_coplanar_shift", "union", 1, 1.5),
        ("cubes_coincident", "union", 1, 1.0),
        ("cubes_edge_touch", "union", 2, 2.0),
        ("cubes_face_touch_partial", "union", 1, 1.25),
        ("edge_edge_cross", "union", 2, 16.0),
        ("vertex_on_face", "nonzero", 2, 52.0 / 3.0),
        ("nested_cavity", "union", 2, 3.271_387_075_99),
        ("nested_cavity", "outside", 1, 4.172_687_596_93),
        ("sphere_all_inverted", "nonzero", 1, 4.172_687_596_93),
        ("sphere_plus_inverted_overlap", "union", 1, 3.310_642_437_43),
    ] {
        let input = fixture(&format!("repair/{name}.off"));
        let arguments = ["repair", &input, "-o", "out.ply", "--force", "--rule", rule];
        let done = json(folder.path(), &arguments);
        let info = json(folder.path(), &["info", "out.ply"]);
        assert_eq!(done["rule"], rule);
        assert_eq!(done["remaining"], 0, "{name}");
        for key in ["closed", "edge_manifold", "vertex_manifold", "oriented"] {
            assert_eq!(info[key], true, "{name} {rule}: {key}");
        }
        assert_eq!(info["self_intersections"], 0, "{name} {rule}");
        for said in [&done, &info] {
            assert_eq!(said["components"], components, "{name} {rule}");
            assert_eq!(said["genus"], 0, "{name} {rule}");
            let found = said["volume"].as_f64().unwrap();
            assert!((found - volume).abs() < 1e-10, "{name} {rule}: {found}");
        }
    }
}

#[test]
fn the_report_holds_everything() {
    let folder = tempdir().unwrap();
    let input = fixture("repair/cubes_generic.off");
    let arguments = ["repair", &input, "-o", "out.off", "--report", "r.json"];
    let done = json(folder.path(), &arguments);
    let mut report = parsed(&folder.path().join("r.json"));
    let sources = report.as_object_mut().unwrap().remove("sources").unwrap();
    assert_eq!(report, done, "but for the sources it is what is printed");
    for (key, value) in [
        ("pairs", 12),
        ("cut", 12),
        ("degenerate", 0),
        ("reoriented", 0),
        ("seeds", 1),
        ("singular_vertices", 0),
        ("singular_edges", 0),
        ("new_vertices", 12),
        ("rounded", 0),
        ("repeats", 0),
        ("remaining", 0),
        ("components_before", 2),
        ("components", 1),
        ("genus_before", 0),
        ("genus", 0),
    ] {
        assert_eq!(report[key], value, "{key}");
    }
    assert_eq!(report["input"], input.as_str());
    assert_eq!(report["output"], "out.off");
    assert_eq!(report["rule"], "union");
    assert_eq!(report["unchanged"], false);
    assert_eq!(report["volume_before"], 2.0);
    assert_eq!(report["volume_after"], 1.671_875);

    // Each triangle lies in the plane of its source, and faces as it does.
    let (before, after) = (
        soup(Path::new(&input)),
        soup(&folder.path().join("out.off")),
    );
    let sources = sources.as_array().unwrap();
    assert_eq!(sources.len(), after.triangles.len());
    let normal = |soup: &TriangleSoup, t: usize| {
        let [a, b, c] = soup.triangles[t].map(|v| soup.positions[v.index()]);
        ((b - a).cross(c - a).normalize(), a)
    };
    for (t, source) in sources.iter().enumerate() {
        let source = source.as_u64().unwrap() as usize;
        let ((n, p), (m, q)) = (normal(&after, t), normal(&before, source));
        assert!(n.dot(m) > 1.0 - 1e-12 && (p - q).dot(m).abs() < 1e-12);
    }
}

#[test]
fn it_says_what_was_done_and_is_silent_when_asked() {
    let folder = tempdir().unwrap();
    let input = fixture("repair/sphere_plus_inverted_overlap.off");
    let run = |further: &[&str]| {
        let assert = pellicle(folder.path())
            .args(["repair", &input, "-o", "out.ply", "--force"])
            .args(further)
            .assert()
            .success();
        assert_eq!(stdout(&assert), "");
        stderr(&assert)
    };
    let said = run(&[]);
    for part in [
        "220 pairs",
        "components 2 -> 1",
        "genus 0 -> 0",
        "volume 8.79649e-17 -> 3.31064",
        "220 new vertices, 220 of them rounded",
        "no self-intersections",
    ] {
        assert!(said.contains(part), "{part}: {said}");
    }
    assert!(!said.contains('%') && !said.contains("WARN"), "{said}");
    assert_eq!(run(&["--quiet"]), "");
    let bar = run(&["--quiet", "--progress", "bar"]);
    assert!(bar.contains('%'), "{bar}");
}

#[test]
fn a_valid_mesh_stays_and_repairing_twice_changes_nothing() {
    let folder = tempdir().unwrap();
    let run = |input: &str, out: &str| json(folder.path(), &["repair", input, "-o", out]);
    let torus = fixture("repair/torus_before.off");
    let done = run(&torus, "same.ply");
    assert_eq!(done["unchanged"], true);
    assert_eq!(
        soup(&folder.path().join("same.ply")),
        soup(Path::new(&torus))
    );

    let crossing = fixture("repair/cubes_coplanar_shift.off");
    assert_eq!(run(&crossing, "once.ply")["unchanged"], false);
    assert_eq!(run("once.ply", "twice.ply")["unchanged"], true);
    let bytes = |name: &str| std::fs::read(folder.path().join(name)).unwrap();
    assert!(bytes("once.ply") == bytes("twice.ply"));
}

#[test]
fn the_number_of_threads_does_not_matter() {
    let folder = tempdir().unwrap();
    let input = fixture("repair/sphere_plus_inverted_overlap.off");
    for threads in ["1", "3"] {
        let out = format!("{threads}.ply");
        let arguments = ["repair", &input, "-o", &out, "--threads", threads];
        json(folder.path(), &arguments);
    }
    let bytes = |name: &str| std::fs::read(folder.path().join(name)).unwrap();
    assert!(bytes("1.ply") == bytes("3.ply"));
}

#[test]
fn nothing_left_is_an_empty_mesh_and_a_warning() {
    let folder = tempdir().unwrap();
    let input = fixture("repair/sphere_all_inverted.off");
    for rule in ["union", "outside"] {
        for extension in ["ply", "off", "obj", "stl", "glb"] {
            let out = format!("{rule}.{extension}");
            let assert = pellicle(folder.path())
                .args(["repair", &input, "-o", &out, "--rule", rule])
                .assert()
                .success();
            let said = stderr(&assert);
            assert!(
                said.contains("WARN") && said.contains("nothing is left"),
                "{said}"
            );
            assert!(said.contains("--rule nonzero"), "{said}");
            assert!(folder.path().join(out).exists());
        }
    }
    assert!(soup_is_empty(&folder.path().join("union.off")));
    // Nonzero cannot help where it is the rule.
    let input = fixture("repair/cube_coincident_opposite.off");
    let assert = pellicle(folder.path())
        .args(["repair", &input, "-o", "none.off", "--rule", "nonzero"])
        .assert()
        .success();
    let said = stderr(&assert);
    assert!(
        said.contains("cancel") && !said.contains("--rule"),
        "{said}"
    );
}

fn soup_is_empty(path: &Path) -> bool {
    std::fs::read_to_string(path).unwrap().trim_end() == "OFF\n0 0 0"
}

#[test]
fn open_meshes_are_refused_with_advice_or_keep_their_borders() {
    let folder = tempdir().unwrap();
    for (input, border) in [
        (fixture("repair/open_sphere_overlap.off"), 7),
        (fixture("holes.off"), 304),
    ] {
        for rule in ["union", "nonzero"] {
            let assert = pellicle(folder.path())
                .args(["repair", &input, "-o", "out.ply", "--rule", rule])
                .assert()
                .code(1);
            let said = stderr(&assert).replace("\n  │ ", " ");
            for part in [
                ".off: the surface is open",
                &format!("{border} edges"),
                "--rule outside",
            ] {
                assert!(said.contains(part), "{part}: {said}");
            }
            assert!(names(folder.path()).is_empty());
        }
        let assert = pellicle(folder.path())
            .args(["repair", &input, "-o", "out.ply", "--rule", "outside"])
            .assert()
            .success();
        let said = stderr(&assert);
        assert!(
            said.contains("rule outside") && said.contains("borders"),
            "{said}"
        );
        let info = json(folder.path(), &["info", "out.ply"]);
        assert_eq!(info["self_intersections"], 0);
        assert_eq!(info["border_edges"], border);
        assert_eq!(info["oriented"], true);
        std::fs::remove_file(folder.path().join("out.ply")).unwrap();
    }
}

fn write(path: &Path, soup: TriangleSoup) {
    let mesh = TriMesh::try_from(soup).unwrap();
    write_mesh(path, &mesh, None, &WriteOptions::default()).unwrap();
}

/// Two spheres that overlap, moved by `shift`.
fn two_spheres(level: u32, shift: DVec3) -> TriangleSoup {
    let mut soup = icosphere(level).unwrap().into_soup();
    let count = soup.positions.len() as u32;
    let other = soup.clone();
    let moved = other
        .positions
        .iter()
        .map(|&p| p + DVec3::new(0.7, 0.5, 0.3));
    soup.positions.extend(moved);
    let moved = other.triangles.iter();
    soup.triangles
        .extend(moved.map(|t| t.map(|v| VertexId(v.0 + count))));
    for p in &mut soup.positions {
        *p += shift;
    }
    soup
}

#[test]
fn triangles_that_disagree_are_turned_and_it_is_said() {
    let folder = tempdir().unwrap();
    let text = std::fs::read_to_string(fixture("repair/cubes_generic.off")).unwrap();
    let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
    let last = lines
        .iter()
        .rposition(|line| line.starts_with("3 "))
        .unwrap();
    let corners: Vec<&str> = text.lines().nth(last).unwrap().split(' ').collect();
    lines[last] = format!("3 {} {} {}", corners[1], corners[3], corners[2]);
    std::fs::write(folder.path().join("turned.off"), lines.join("\n")).unwrap();
    let arguments = ["repair", "turned.off", "-o", "out.ply"];
    let assert = pellicle(folder.path()).args(arguments).assert().success();
    let said = stderr(&assert);
    assert!(said.contains("1 triangles turned"), "{said}");
    let info = json(folder.path(), &["info", "out.ply"]);
    assert!((info["volume"].as_f64().unwrap() - 107.0 / 64.0).abs() < 1e-12);
}

#[test]
fn single_precision_is_warned_of() {
    let folder = tempdir().unwrap();
    write(
        &folder.path().join("two.ply"),
        two_spheres(1, DVec3::splat(0.1)),
    );
    for (out, warned) in [("a.stl", true), ("a.glb", true), ("a.ply", false)] {
        let assert = pellicle(folder.path())
            .args(["repair", "two.ply", "-o", out])
            .assert()
            .success();
        let said = stderr(&assert);
        assert_eq!(
            said.contains("single precision the surface"),
            warned,
            "{said}"
        );
    }
}

#[test]
fn damaged_files_are_refused_and_nothing_is_left() {
    let folder = tempdir().unwrap();
    for (name, content, reason) in [
        ("empty.off", "", "empty"),
        (
            "nan.off",
            "OFF\n3 1 0\n0 0 0\nnan 0 0\n0 1 0\n3 0 1 2\n",
            "vertex 1 has a coordinate that is not finite",
        ),
        (
            "index.off",
            "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 9\n",
            "corner 9",
        ),
        ("points.off", "OFF\n2 0 0\n0 0 0\n1 0 0\n", "no triangle"),
    ] {
        std::fs::write(folder.path().join(name), content).unwrap();
        let assert = pellicle(folder.path())
            .args(["repair", name, "-o", "out.ply", "--report", "r.json"])
            .assert()
            .code(1);
        let said = stderr(&assert);
        assert!(said.contains(reason) && said.contains(name), "{said}");
        std::fs::remove_file(folder.path().join(name)).unwrap();
        assert!(names(folder.path()).is_empty(), "{name}");
    }
}

#[test]
fn outputs_are_checked_before_the_work() {
    let folder = tempdir().unwrap();
    let cube = fixture("analytic/cube.off");
    for name in ["out.ply", "r.json"] {
        std::fs::write(folder.path().join(name), "precious").unwrap();
        let run = |further: &[&str]| {
            let mut command = pellicle(folder.path());
            command.args(["repair", &cube, "-o", "out.ply", "--report", "r.json"]);
            command.args(further);
            command
        };
        let said = stderr(&run(&[]).assert().code(1));
        assert!(said.contains(name) && said.contains("--force"), "{said}");
        assert_eq!(names(folder.path()), [name]);
        run(&["--force"]).assert().success();
        assert_eq!(names(folder.path()), ["out.ply", "r.json"]);
        for made in names(folder.path()) {
            std::fs::remove_file(folder.path().join(made)).unwrap();
        }
    }
    let assert = pellicle(folder.path())
        .args(["repair", &cube, "-o", "a.ply", "--report", "a.ply"])
        .assert()
        .code(1);
    assert!(stderr(&assert).contains("two results"));
    assert!(names(folder.path()).is_empty());
}

#[test]
#[cfg(target_os = "linux")]
fn a_full_disk_is_an_error_for_the_report_too() {
    let folder = tempdir().unwrap();
    let link = folder.path().join("r.json");
    std::os::unix::fs::symlink("/dev/full", &link).unwrap();
    let cube = fixture("analytic/cube.off");
    let assert = pellicle(folder.path())
        .args([
            "repair", &cube, "-o", "o.ply", "--report", "r.json", "--force",
        ])
        .assert()
        .code(1);
    assert!(stderr(&assert).contains("space"), "{}", stderr(&assert));
    assert!(link.is_symlink());
}

#[test]
#[cfg(unix)]
fn ctrl_c_stops_within_a_second_and_leaves_nothing() {
    let folder = tempdir().unwrap();
    write(
        &folder.path().join("large.ply"),
        two_spheres(8, DVec3::ZERO),
    );
    for delay in [300, 1200] {
        let mut child = Command::new(env!("CARGO_BIN_EXE_pellicle"))
            .args(["repair", "large.ply", "-o", "out.ply", "--report", "r.json"])
            .current_dir(folder.path())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        std::thread::sleep(Duration::from_millis(delay));
        let status = Command::new("kill")
            .args(["-INT", &child.id().to_string()])
            .status();
        assert!(status.unwrap().success());
        let pressed = Instant::now();
        let status = child.wait().unwrap();
        let took = pressed.elapsed();
        assert_eq!(status.code(), Some(130), "{delay}");
        assert!(took < Duration::from_secs(1), "{delay}: {took:?}");
        assert_eq!(names(folder.path()), ["large.ply"]);
    }
}

#[test]
fn info_says_how_and_where_triangles_meet() {
    let folder = tempdir().unwrap();
    let info = |name: &str| json(folder.path(), &["info", &fixture(name)]);
    for (name, pairs, triangles, segments, points) in [
        ("repair/cubes_generic.off", 12, 12, 12, 0),
        ("repair/vertex_on_face.off", 3, 4, 0, 3),
        // Two triangles of each of six sides, each with its twin, three edges a pair; and where the diagonals' ends
        // touch: nothing, as common edges and corners fit.
        ("repair/cubes_coincident.off", 12, 24, 36, 0),
        ("analytic/cube.off", 0, 0, 0, 0),
    ] {
        let found = info(name);
        assert_eq!(found["self_intersections"], pairs, "{name}");
        assert_eq!(found["intersecting_triangles"], triangles, "{name}");
        assert_eq!(found["intersections"]["segments"], segments, "{name}");
        assert_eq!(found["intersections"]["points"], points, "{name}");
    }
    // The cubes [0, 1]³ and the one moved by (1/2, 1/4, 1/8): around their hexagon.
    let bounds = &info("repair/cubes_generic.off")["intersections"]["bounds"];
    assert_eq!(bounds["min"], serde_json::json!([0.5, 0.25, 0.125]));
    assert_eq!(bounds["max"], serde_json::json!([1.0, 1.0, 1.0]));
    assert!(info("analytic/cube.off")["intersections"]["bounds"].is_null());

    for (name, expected) in [
        (
            "repair/cubes_generic.off",
            "self-intersections  12 pairs of 12 triangles, in 12 segments\n",
        ),
        (
            "repair/vertex_on_face.off",
            "self-intersections  3 pairs of 4 triangles, in 3 points\n",
        ),
        ("analytic/cube.off", "self-intersections  0\n"),
    ] {
        let assert = pellicle(folder.path())
            .args(["info", &fixture(name)])
            .assert();
        assert!(stdout(&assert).contains(expected), "{}", stdout(&assert));
    }
}
