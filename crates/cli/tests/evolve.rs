//! `evolve`, with its snapshots and tables, and what its failures leave.

mod common;

use common::{fixture, json, manifold, names, pellicle, stderr, stdout};
use pellicle::evolution::Measures;
use pellicle::geometry::{DVec3, PointCloud};
use pellicle::io::{WriteOptions, write_mesh, write_points};
use pellicle::mesh::icosphere;
use std::f64::consts::PI;
use std::path::Path;
use tempfile::tempdir;

/// 3,000 points on a sphere, along a spiral.
fn sphere(path: &Path, center: DVec3, radius: f64) {
    let points = (0..3000).map(|i| {
        let z = 1.0 - (2.0 * f64::from(i) + 1.0) / 3000.0;
        let (sin, cos) = (2.399_963 * f64::from(i)).sin_cos();
        let (x, y) = (cos * (1.0 - z * z).sqrt(), sin * (1.0 - z * z).sqrt());
        center + radius * DVec3::new(x, y, z)
    });
    let cloud = PointCloud::new(points.collect()).unwrap();
    write_points(path, &cloud, &WriteOptions::default()).unwrap();
}

/// A hemisphere, which holds no volume: the surface falls through it.
fn bowl() -> String {
    fixture("analytic/hemisphere_open.off")
}

#[test]
fn a_surface_parts_around_several_objects() {
    let folder = tempdir().unwrap();
    let spheres: Vec<DVec3> = [-2.0 * DVec3::X, 2.0 * DVec3::X]
        .into_iter()
        .flat_map(|center| {
            (icosphere(3).unwrap().positions().to_vec().into_iter()).map(move |p| p + center)
        })
        .collect();
    let cloud = PointCloud::new(spheres).unwrap();
    write_points(
        folder.path().join("two.ply"),
        &cloud,
        &WriteOptions::default(),
    )
    .unwrap();
    let arguments = ["evolve", "two.ply", "--grid", "60", "-o"];
    let fixed = json(folder.path(), &[&arguments[..], &["one.ply"]].concat());
    assert_eq!(fixed["components"], 1);
    let adaptive = ["two.off", "--topology", "adaptive", "--snapshots", "frames"];
    let parted = json(folder.path(), &[&arguments[..], &adaptive].concat());
    assert_eq!(parted["components"], 2, "{parted}");
    assert_eq!(parted["self_intersections"], 0, "{parted}");
    let refused = ["no.off", "--topology", "adaptive", "--preset", "paper"];
    let refused = pellicle(folder.path())
        .args(arguments)
        .args(refused)
        .assert()
        .failure();
    assert!(stderr(&refused).contains("--preset"));
}

#[test]
fn a_sphere_has_its_volume_in_the_units_of_the_cloud() {
    let folder = tempdir().unwrap();
    let radius = 30.0;
    sphere(
        &folder.path().join("s.ply"),
        DVec3::new(5e3, -2e3, 1e3),
        radius,
    );
    let done = json(
        folder.path(),
        &["evolve", "s.ply", "-o", "out.ply", "--grid", "100"],
    );
    let number = |key: &str| done[key].as_f64().unwrap();
    assert_eq!(done["points"], 3000);
    assert_eq!(done["points_left_out"], 0);
    assert_eq!(done["at_rest"], true);
    assert_eq!(done["self_intersections"], 0);
    assert_eq!(
        (number("sigma"), number("noise") < 0.01 * radius),
        (1.0, true)
    );
    // The box holds an ellipsoid a little larger than the sphere.
    let voxel = number("voxel");
    assert!((2.0 * radius..2.4 * radius).contains(&(100.0 * voxel)));
    // Within a quarter of a voxel of the points, and within one in a hundred of the volume.
    let (volume, area) = (4.0 / 3.0 * PI * radius.powi(3), 4.0 * PI * radius.powi(2));
    assert!((number("volume") / volume - 1.0).abs() < 0.01, "{done}");
    assert!((number("area") / area - 1.0).abs() < 0.01, "{done}");
    assert!(number("mean_distance_voxels") < 0.25, "{done}");
    assert!((number("mean_distance_voxels") * voxel / number("mean_distance") - 1.0).abs() < 1e-9);
    assert!(number("mean_distance") <= number("greatest_distance"));
    // What `info` reads is what was told.
    let info = json(folder.path(), &["info", "out.ply"]);
    manifold(&info, 0);
    for key in ["vertices", "triangles"] {
        assert_eq!(info[key], done[key], "{key}");
    }
    for key in ["volume", "area"] {
        let told = info[key].as_f64().unwrap();
        assert!((told / number(key) - 1.0).abs() < 1e-9, "{key}");
    }
}

#[test]
fn a_real_scan_becomes_a_closed_manifold_by_one_command() {
    let folder = tempdir().unwrap();
    for (input, points) in [("oni.pwn", 1435), ("kitten.xyz", 5210)] {
        let assert = pellicle(folder.path())
            .args(["evolve", &fixture(input), "-o", "out.off", "--force"])
            .args(["--grid", "100", "--smooth", "2"])
            .assert()
            .success();
        assert_eq!(stdout(&assert), "");
        let said = stderr(&assert);
        let points = format!("{points} points");
        for words in [&points, "volume", "at rest", "voxels", "angles"] {
            assert!(said.contains(words), "{words}: {said}");
        }
        // The kitten's tail is a handle; a sphere closes around it without running into itself.
        manifold(&json(folder.path(), &["info", "out.off"]), 0);
        assert!(
            input != "kitten.xyz" || said.contains("were held"),
            "{said}"
        );
    }
}

#[test]
fn the_vertices_of_a_mesh_are_a_cloud_too_and_threads_do_not_matter() {
    let folder = tempdir().unwrap();
    let ball = fixture("analytic/sphere.off");
    for (out, threads) in [("1.ply", "1"), ("3.ply", "3")] {
        pellicle(folder.path())
            .args(["evolve", &ball, "-o", out, "--threads", threads])
            .args(["--grid", "40", "--quiet"])
            .assert()
            .success();
    }
    let bytes = |name| std::fs::read(folder.path().join(name)).unwrap();
    assert!(bytes("1.ply") == bytes("3.ply"));
}

#[test]
fn reconstruct_by_evolution_is_evolve_with_its_defaults() {
    let folder = tempdir().unwrap();
    sphere(&folder.path().join("s.ply"), DVec3::ZERO, 1.0);
    let evolved = json(folder.path(), &["evolve", "s.ply", "-o", "a.ply"]);
    let arguments = [
        "reconstruct",
        "s.ply",
        "-o",
        "b.ply",
        "--method",
        "evolution",
    ];
    let reconstructed = json(folder.path(), &arguments);
    let bytes = |name| std::fs::read(folder.path().join(name)).unwrap();
    assert!(bytes("a.ply") == bytes("b.ply"));
    assert_eq!(evolved["steps"], reconstructed["steps"]);
}

#[test]
fn the_preset_takes_the_steps_of_the_paper() {
    let folder = tempdir().unwrap();
    sphere(&folder.path().join("s.ply"), DVec3::ZERO, 1.0);
    let run = |further: &[&str]| {
        let arguments = [
            "evolve", "s.ply", "-o", "out.ply", "--force", "--grid", "60",
        ];
        json(
            folder.path(),
            &[&arguments[..], &["--preset", "paper"], further].concat(),
        )
    };
    let done = run(&[]);
    for (key, value) in [("vertices", 2562), ("triangles", 5120), ("steps", 120)] {
        assert_eq!(done[key], value, "{key}");
    }
    assert_eq!(done["sigma"], 1.0);
    assert!(done["at_rest"].is_null());
    assert_eq!(run(&["--smooth", "3"])["steps"], 98);
    // More diffusion moves a surface on faster.
    let strong = run(&["--diffusion", "0.8", "--smooth", "0"]);
    let weak = run(&["--diffusion", "0.1", "--smooth", "0"]);
    let volume = |done: &serde_json::Value| done["volume"].as_f64().unwrap();
    assert!(volume(&strong) < volume(&weak));
}

#[test]
fn outliers_are_left_out_unless_kept() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("s.xyz");
    sphere(&path, DVec3::ZERO, 1.0);
    let mut text = std::fs::read_to_string(&path).unwrap();
    text.push_str("1.6 0 0\n0 1.7 0.2\n-1 -1 -1\n");
    std::fs::write(&path, text).unwrap();
    let run = |further: &[&str]| {
        let arguments = [
            "evolve", "s.xyz", "-o", "out.ply", "--force", "--grid", "40",
        ];
        json(folder.path(), &[&arguments, further].concat())
    };
    assert_eq!(run(&[])["points_left_out"], 3);
    assert_eq!(run(&["--keep-outliers"])["points_left_out"], 0);
}

#[test]
fn the_resolution_is_the_length_of_edges() {
    let folder = tempdir().unwrap();
    sphere(&folder.path().join("s.ply"), DVec3::ZERO, 10.0);
    for length in ["1.5", "0.8"] {
        let arguments = ["evolve", "s.ply", "-o", "out.ply", "--force", "--grid"];
        let done = json(
            folder.path(),
            &[&arguments[..], &["60", "--resolution", length]].concat(),
        );
        let ratio = done["mean_edge"].as_f64().unwrap() / length.parse::<f64>().unwrap();
        assert!((ratio - 1.0).abs() < 0.15, "{length}: {ratio}");
    }
}

#[test]
fn clouds_without_a_volume_are_explained() {
    let folder = tempdir().unwrap();
    let grid: String = (0..36)
        .map(|i| format!("{} {} 0\n", i % 6, i / 6))
        .collect();
    let line: String = (0..30).map(|i| format!("{i} {i} {i}\n")).collect();
    for (name, content, reason) in [
        ("one.xyz", "1 2 3\n", "one place"),
        ("same.xyz", &"1 2 3\n".repeat(20), "one place"),
        ("line.xyz", &line, "line"),
        ("plane.xyz", &grid, "plane"),
    ] {
        std::fs::write(folder.path().join(name), content).unwrap();
        for verb in [&["evolve"][..], &["reconstruct", "--method", "evolution"]] {
            let assert = pellicle(folder.path())
                .args(verb)
                .args([name, "-o", "out.ply"])
                .assert()
                .code(1);
            let said = stderr(&assert);
            assert!(
                said.contains(name) && said.contains(reason),
                "{verb:?} {name}: {said}"
            );
        }
    }
}

#[test]
fn an_initial_mesh_gives_its_genus() {
    let folder = tempdir().unwrap();
    // A sphere around, not around the origin.
    let mut mesh = icosphere(3).unwrap();
    let center = DVec3::new(1.0, 2.0, 3.0);
    let around = mesh.positions().iter().map(|p| center + 1.5 * p).collect();
    mesh.set_positions(around).unwrap();
    write_mesh(
        folder.path().join("around.ply"),
        &mesh,
        None,
        &WriteOptions::default(),
    )
    .unwrap();
    sphere(&folder.path().join("s.ply"), center, 1.0);
    let arguments = ["evolve", "s.ply", "-o", "out.ply", "--grid", "40"];
    let done = json(
        folder.path(),
        &[&arguments[..], &["--initial", "around.ply"]].concat(),
    );
    assert_eq!(done["at_rest"], true);
    manifold(&json(folder.path(), &["info", "out.ply"]), 0);
    // What is wrong with another one is said of it, not of the cloud.
    let tetrahedron = "20 0 0\n29 0 0\n20 9 0\n20 0 9\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n";
    let crossing = format!(
        "OFF\n8 8 0\n{}{}3 4 6 5\n3 4 5 7\n3 5 6 7\n3 6 4 7\n",
        "0 0 0\n9 0 0\n0 9 0\n0 0 9\n1 1 1\n10 1 1\n1 10 1\n1 1 10\n",
        "3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n",
    );
    std::fs::write(folder.path().join("crossing.off"), crossing).unwrap();
    std::fs::write(
        folder.path().join("beside.off"),
        format!("OFF\n4 4 0\n{tetrahedron}"),
    )
    .unwrap();
    for (initial, reason) in [
        (bowl().as_str(), "closed"),
        ("crossing.off", "intersects itself"),
        ("beside.off", "not inside"),
        (&fixture("analytic/moebius.off"), "manifold"),
    ] {
        let assert = pellicle(folder.path())
            .args(arguments)
            .args(["--force", "--initial", initial])
            .assert()
            .code(1);
        let said = stderr(&assert).replace("\n  │", "");
        let name = initial.rsplit('/').next().unwrap();
        assert!(
            said.contains(name) && said.contains(reason),
            "{initial}: {said}"
        );
    }
}

#[test]
fn snapshots_play_and_the_table_tells_of_every_step() {
    let folder = tempdir().unwrap();
    let run = || {
        let mut command = pellicle(folder.path());
        command.args([
            "evolve",
            &fixture("kitten.xyz"),
            "-o",
            "k.ply",
            "--grid",
            "40",
        ]);
        command.args([
            "--snapshots",
            "frames",
            "--every",
            "7",
            "--csv",
            "k.csv",
            "--json",
        ]);
        command
    };
    let assert = run().assert().success();
    let done: serde_json::Value = serde_json::from_str(&stdout(&assert)).unwrap();
    let steps = done["steps"].as_u64().unwrap();

    // 1. The table: a line a step, all of them numbers.
    let table = std::fs::read_to_string(folder.path().join("k.csv")).unwrap();
    let mut lines = table.lines();
    let header: Vec<&str> = lines.next().unwrap().split(',').collect();
    assert_eq!(header.join(","), Measures::CSV_HEADER);
    let rows: Vec<Vec<f64>> = lines
        .map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect())
        .collect();
    assert_eq!(rows.len() as u64, steps);
    let column = |name: &str| header.iter().position(|column| *column == name).unwrap();
    for (index, row) in rows.iter().enumerate() {
        assert_eq!(row.len(), header.len());
        assert_eq!(row[column("step")], (index + 1) as f64);
        assert!(row[column("volume")] > 0.0);
    }
    let voxel = done["voxel"].as_f64().unwrap();
    assert!((rows[0][column("spacing")] / voxel - 1.0).abs() < 1e-12);

    // 2. The meshes: the first step, every seventh, the result.
    let mut expected: Vec<u64> = (1..=steps).filter(|step| step % 7 == 0).collect();
    expected.insert(0, 1);
    if !steps.is_multiple_of(7) {
        expected.push(steps);
    }
    let mut files: Vec<String> = expected
        .iter()
        .map(|s| format!("step-{s:06}.ply"))
        .collect();
    let meshes = files.len();
    files.splice(
        0..0,
        ["evolution.glb".to_owned(), "evolution.png".to_owned()],
    );
    assert_eq!(names(&folder.path().join("frames")), files);
    assert_eq!(done["snapshots"]["meshes"], meshes);
    let bytes = |name: &str| std::fs::read(folder.path().join(name)).unwrap();
    assert!(bytes(&format!("frames/{}", files.last().unwrap())) == bytes("k.ply"));

    // 3. The animation, as the crate `gltf` validates and reads it.
    let glb = folder.path().join("frames/evolution.glb");
    let gltf::Gltf { document, blob } = gltf::Gltf::open(&glb).unwrap();
    let blob = blob.unwrap();
    let animation = document.animations().next().unwrap();
    assert_eq!(animation.channels().count(), meshes);
    let counts: Vec<usize> = document
        .meshes()
        .map(|mesh| {
            let primitive = mesh.primitives().next().unwrap();
            let reader = primitive.reader(|_| Some(&blob));
            reader.read_positions().unwrap().count()
        })
        .collect();
    assert_eq!(counts.len(), meshes);
    let vertices = |step: u64| rows[step as usize - 1][column("vertices")];
    assert_eq!(counts[0] as f64, vertices(1));
    assert_eq!(
        *counts.last().unwrap() as u64,
        done["vertices"].as_u64().unwrap()
    );

    // 4. The strip: eight pictures by one camera, so that the surface shrinks from the first to the last.
    let strip = image::open(folder.path().join("frames/evolution.png"))
        .unwrap()
        .into_rgba8();
    assert_eq!(strip.dimensions(), (1600, 800));
    let background = *strip.get_pixel(0, 0);
    // Rows of a picture in which something is drawn.
    let height = |left: u32, top: u32| {
        let drawn = |y: u32| (left..left + 400).any(|x| *strip.get_pixel(x, y) != background);
        (top..top + 400).filter(|&y| drawn(y)).count()
    };
    let (first, last) = (height(0, 0), height(1200, 400));
    assert!(last > 80 && 5 * last < 4 * first, "{first} {last}");

    // 5. Nothing of it is replaced without --force.
    std::fs::remove_file(folder.path().join("k.ply")).unwrap();
    let said = stderr(&run().assert().code(1));
    assert!(said.contains("k.csv") && said.contains("--force"), "{said}");
    std::fs::remove_file(folder.path().join("k.csv")).unwrap();
    let said = stderr(&run().assert().code(1));
    assert!(
        said.contains("frames") && said.contains("--force"),
        "{said}"
    );
    run().arg("--force").assert().success();
    assert_eq!(names(&folder.path().join("frames")), files);
}

#[test]
fn what_cannot_be_written_is_said_before_the_work() {
    let folder = tempdir().unwrap();
    std::fs::write(folder.path().join("file"), "").unwrap();
    let kitten = fixture("kitten.xyz");
    for (further, expected) in [
        (["--snapshots", "no/such"], "no directory"),
        (["--snapshots", "file"], "snapshots"),
        (["--csv", "no/such.csv"], "no directory"),
        (["--csv", "."], "directory"),
        (["--csv", "out.ply"], "two results"),
        (["--initial", "missing.ply"], "missing.ply"),
    ] {
        let assert = pellicle(folder.path())
            .args(["evolve", &kitten, "-o", "out.ply"])
            .args(further)
            .assert()
            .code(1);
        let said = stderr(&assert);
        assert!(said.contains(expected), "{further:?}: {said}");
    }
    assert_eq!(names(folder.path()), ["file"]);
}

#[test]
fn a_failure_keeps_its_records_with_the_last_good_surface() {
    let folder = tempdir().unwrap();
    let assert = pellicle(folder.path())
        .args(["evolve", &bowl(), "-o", "out.ply", "--grid", "40"])
        .args([
            "--snapshots",
            "frames",
            "--every",
            "1000",
            "--csv",
            "out.csv",
        ])
        .assert()
        .code(1);
    // Lines are broken anywhere.
    let said = stderr(&assert).replace('│', " ");
    let said = said.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(
        said.contains("no volume") && said.contains("hemisphere_open.off"),
        "{said}"
    );
    assert_eq!(names(folder.path()), ["frames", "out.csv"]);
    let table = std::fs::read_to_string(folder.path().join("out.csv")).unwrap();
    let steps = table.lines().count() - 1;
    let last = format!("step-{steps:06}.ply");
    assert_eq!(
        names(&folder.path().join("frames")),
        ["evolution.glb", "evolution.png", "step-000001.ply", &last]
    );
    let info = json(&folder.path().join("frames"), &["info", &last]);
    assert_eq!(info["closed"], true);
}

#[test]
fn a_failure_before_the_first_step_leaves_nothing() {
    let folder = tempdir().unwrap();
    std::fs::write(folder.path().join("one.xyz"), "1 2 3\n").unwrap();
    pellicle(folder.path())
        .args(["evolve", "one.xyz", "-o", "out.ply"])
        .args(["--snapshots", "frames", "--csv", "out.csv"])
        .assert()
        .code(1);
    assert_eq!(names(folder.path()), ["one.xyz"]);
}

#[test]
#[cfg(target_os = "linux")]
fn a_full_disk_ends_the_evolution_at_the_snapshot() {
    let folder = tempdir().unwrap();
    // Files of at most 160 blocks, of 512 or 1024 bytes: the first mesh fits, the fine ones do not.
    let script = "trap '' XFSZ; ulimit -f 160; exec \"$0\" \"$@\"";
    let output = std::process::Command::new("sh")
        .args(["-c", script, env!("CARGO_BIN_EXE_pellicle")])
        .args(["evolve", &fixture("kitten.xyz"), "-o", "out.ply"])
        .args(["--grid", "150", "--snapshots", "frames", "--every", "1"])
        .args(["--csv", "out.csv"])
        .current_dir(folder.path())
        .output()
        .unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(
        said.contains("step-") && said.contains("cannot be written"),
        "{said}"
    );
    assert_eq!(names(folder.path()), ["frames"]);
    let kept = names(&folder.path().join("frames"));
    assert!(!kept.is_empty());
    for name in kept {
        json(&folder.path().join("frames"), &["info", &name]);
    }
}

#[test]
fn progress_tells_of_step_move_and_volume() {
    let folder = tempdir().unwrap();
    let run = |when: &str| {
        let assert = pellicle(folder.path())
            .args(["evolve", &fixture("kitten.xyz"), "-o", "out.ply", "--force"])
            .args(["--grid", "60", "--quiet", "--progress", when])
            .assert()
            .success();
        assert_eq!(stdout(&assert), "");
        stderr(&assert)
    };
    let said = run("bar");
    for words in ["stage", "step", "move", "voxels", "volume"] {
        assert!(said.contains(words), "{words}: {said}");
    }
    assert_eq!(run("auto"), "");
}
