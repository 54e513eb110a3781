//! How the program behaves: usage, errors, exit codes, files left alone, Ctrl-C.

mod common;

use common::{fixture, names, pellicle, stderr, stdout};
use pellicle::geometry::{DVec3, PointCloud};
use pellicle::io::{WriteOptions, write_points};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};
use tempfile::tempdir;

const VERBS: [&str; 13] = [
    "reconstruct",
    "evolve",
    "morph",
    "delaunay",
    "info",
    "convert",
    "normals",
    "smooth",
    "remesh",
    "repair",
    "compare",
    "render",
    "view",
];

#[test]
fn wrong_usage_exits_with_2() {
    let folder = tempdir().unwrap();
    let kitten = fixture("kitten.xyz");
    for arguments in [
        &[][..],
        &["destroy"],
        &["reconstruct"],
        &["reconstruct", &kitten],
        &["reconstruct", &kitten, "-o"],
        &["reconstruct", &kitten, "-o", "a.ply", "--method", "guess"],
        &["reconstruct", &kitten, "-o", "a.ply", "--threads", "0"],
        &["info"],
        &["info", &kitten, "--progress", "maybe"],
        &["compare", &kitten],
        &["render", &kitten, "-o", "a.png", "--width", "-5"],
        &["render", &kitten, "-o", "a.png", "--scalar", "beauty"],
        &["render", &kitten, "-o", "a.png", "--scalar", "property:"],
        &["render", &kitten, "-o", "a.png", "--range", "0,1"],
        &[
            "render", &kitten, "-o", "a.png", "--scalar", "x", "--range", "1,0",
        ],
        &[
            "render", &kitten, "-o", "a.png", "--scalar", "x", "--range", "1",
        ],
        &[
            "render", &kitten, "-o", "a.png", "--scalar", "x", "--range", "0,nan",
        ],
        &["render", &kitten, "-o", "a.png", "--edge-width", "-1"],
        &["view", &kitten],
        &["view", "-o", "a.html"],
        &["view", &kitten, "-o", "a.html", "--as", "heap"],
        &["view", &kitten, "-o", "a.html", "--seconds", "0"],
        &["evolve", &kitten, "-o", "a.ply", "--every", "5"],
        &["evolve", &kitten, "-o", "a.ply", "--grid", "3"],
        &["evolve", &kitten, "-o", "a.ply", "--sigma", "17"],
        &["evolve", &kitten, "-o", "a.ply", "--diffusion", "-1"],
        &["evolve", &kitten, "-o", "a.ply", "--preset", "free"],
        &["evolve", &kitten, "-o", "a.ply", "--resolution", "0"],
        &["morph", &kitten, "-o", "a.ply"],
        &["morph", &kitten, &kitten, "-o", "a.ply", "--smoothing", "2"],
        &[
            "morph",
            &kitten,
            &kitten,
            "-o",
            "a.ply",
            "--edge-length",
            "0",
        ],
        &["morph", &kitten, &kitten, "-o", "a.ply", "--every", "5"],
        &["smooth", &kitten, "-o", "a.ply", "--strength", "nan"],
        &["remesh", &kitten, "-o", "a.ply", "--min", "1"],
        &["remesh", &kitten, "-o", "a.ply", "--creases", "200"],
        &["repair", &kitten],
        &["repair", &kitten, "-o", "a.ply", "--rule", "inside"],
        &["repair", &kitten, "-o", "a.ply", "--report"],
    ] {
        let assert = pellicle(folder.path()).args(arguments).assert().code(2);
        assert_eq!(stdout(&assert), "", "{arguments:?}");
        assert!(
            stderr(&assert).contains("--help"),
            "{arguments:?}: {}",
            stderr(&assert)
        );
    }
    assert!(names(folder.path()).is_empty());
}

/// Runs every verb on an input that none can use; each must fail with 1, name the file, and leave nothing behind.
fn all_refuse(input: &str, content: Option<&[u8]>, reason: &str) {
    for verb in VERBS {
        let folder = tempdir().unwrap();
        if let Some(content) = content {
            std::fs::write(folder.path().join(input), content).unwrap();
        }
        let before = names(folder.path());
        let mut command = pellicle(folder.path());
        command.args([verb, input]);
        match verb {
            "info" => {}
            "compare" => drop(command.arg(input)),
            "morph" => drop(command.args([input, "-o", "out.ply"])),
            "render" => drop(command.args(["-o", "out.png"])),
            "view" => drop(command.args(["-o", "out.html"])),
            _ => drop(command.args(["-o", "out.ply"])),
        }
        let assert = command.assert().code(1);
        let message = stderr(&assert);
        assert!(message.contains(reason), "{verb} {input}: {message}");
        assert!(!message.contains("panicked"), "{message}");
        assert_eq!(stdout(&assert), "", "{verb} {input}");
        assert_eq!(names(folder.path()), before, "{verb} {input}");
    }
}

#[test]
fn unusable_inputs_are_refused_by_every_verb() {
    all_refuse("missing.ply", None, "missing.ply");
    all_refuse("empty.ply", Some(b""), "empty");
    all_refuse("empty.xyz", Some(b""), "empty");
    all_refuse("nan.xyz", Some(b"0 0 0\n1 0 0\n0 nan 0\n0 0 1\n"), "line 3");
    all_refuse(
        "huge.xyz",
        Some(b"0 0 0\n1 0 0\n0 1e999 0\n0 0 1\n"),
        "line 3",
    );
    all_refuse("words.xyz", Some(b"0 0 0\n1 0 zero\n"), "line 2");
    all_refuse("short.ply", Some(b"ply\nformat binary_little_endian 1.0\nelement vertex 9\nproperty double x\nproperty double y\nproperty double z\nend_header\n123"), "short.ply");
    all_refuse("picture.gif", Some(b"GIF89a"), "extension");
    all_refuse(".", None, "");
}

#[test]
fn a_directory_is_neither_input_nor_output() {
    let folder = tempdir().unwrap();
    std::fs::create_dir(folder.path().join("dir.ply")).unwrap();
    for arguments in [
        ["convert", "dir.ply", "-o", "out.ply"],
        ["convert", &fixture("half.xyz"), "-o", "dir.ply"],
    ] {
        let assert = pellicle(folder.path()).args(arguments).assert().code(1);
        assert!(stderr(&assert).contains("directory"), "{}", stderr(&assert));
    }
    let assert = pellicle(folder.path())
        .args(["convert", &fixture("half.xyz"), "-o", "no/such/out.ply"])
        .assert()
        .code(1);
    assert!(
        stderr(&assert).contains("no directory"),
        "{}",
        stderr(&assert)
    );
    assert_eq!(names(folder.path()), ["dir.ply"]);
}

#[test]
fn nothing_is_overwritten_without_force() {
    for (verb, out) in [
        ("reconstruct", "out.ply"),
        ("delaunay", "out.vtk"),
        ("delaunay", "out.off"),
        ("convert", "out.csv"),
        ("normals", "out.ply"),
        ("evolve", "out.ply"),
        ("render", "out.png"),
        ("view", "out.html"),
    ] {
        let folder = tempdir().unwrap();
        let path = folder.path().join(out);
        std::fs::write(&path, "precious").unwrap();
        let run = || {
            let mut command = pellicle(folder.path());
            command.args([verb, &fixture("half.xyz"), "-o", out]);
            command
        };
        let assert = run().assert().code(1);
        assert!(
            stderr(&assert).contains("--force"),
            "{verb}: {}",
            stderr(&assert)
        );
        assert_eq!(std::fs::read_to_string(&path).unwrap(), "precious");
        run().arg("--force").assert().success();
        assert_ne!(std::fs::read(&path).unwrap(), b"precious");
        assert_eq!(names(folder.path()), [out]);
    }
}

#[test]
fn what_a_format_cannot_hold_is_said_before_the_work() {
    let folder = tempdir().unwrap();
    let half = fixture("half.xyz");
    for (arguments, expected) in [
        (["reconstruct", &half, "-o", "out.xyz"], "ply"),
        (["reconstruct", &half, "-o", "out"], "extension"),
        (["evolve", &half, "-o", "out.xyz"], "ply"),
        (["smooth", &half, "-o", "out.xyz"], "ply"),
        (["remesh", &half, "-o", "out.pcd"], "ply"),
        (["repair", &half, "-o", "out.csv"], "ply"),
        (["delaunay", &half, "-o", "out.xyz"], "vtk"),
        (["normals", &half, "-o", "out.stl"], "ply"),
        (["render", &half, "-o", "out.jpg"], "png"),
        (["view", &half, "-o", "out.png"], "html"),
        (
            ["convert", &fixture("analytic/cube.off"), "-o", "out.pcd"],
            "ply",
        ),
    ] {
        let assert = pellicle(folder.path()).args(arguments).assert().code(1);
        assert!(
            stderr(&assert).contains(expected),
            "{arguments:?}: {}",
            stderr(&assert)
        );
    }
    assert!(names(folder.path()).is_empty());
}

#[test]
fn flat_and_tiny_inputs_are_explained() {
    let folder = tempdir().unwrap();
    for (name, content, expected) in [
        ("three.xyz", "0 0 0\n1 0 0\n0 1 0\n", "at least four"),
        (
            "same.xyz",
            "0 0 0\n0 0 0\n0 0 0\n0 0 0\n0 0 0\n",
            "at least four",
        ),
        ("line.xyz", "0 0 0\n1 1 1\n2 2 2\n3 3 3\n", "line"),
        ("plane.xyz", "0 0 0\n1 0 0\n0 1 0\n1 1 0\n2 5 0\n", "plane"),
    ] {
        std::fs::write(folder.path().join(name), content).unwrap();
        for verb in ["reconstruct", "delaunay", "normals"] {
            let assert = pellicle(folder.path())
                .args([verb, name, "-o", "out.ply"])
                .assert()
                .code(1);
            assert!(
                stderr(&assert).contains(expected),
                "{verb} {name}: {}",
                stderr(&assert)
            );
        }
    }
    assert!(!folder.path().join("out.ply").exists());
}

#[test]
#[cfg(target_os = "linux")]
fn a_full_disk_is_an_error() {
    let folder = tempdir().unwrap();
    let half = fixture("half.xyz");
    let cube = fixture("analytic/cube.off");
    for arguments in [
        &["convert", &half, "-o", "full.ply", "--force"][..],
        &["render", &half, "-o", "full.png", "--force"],
        &["view", &half, "-o", "full.html", "--force"],
        &["delaunay", &half, "-o", "full.vtk", "--force"],
        &["evolve", &half, "-o", "full.off", "--force"],
        &["repair", &cube, "-o", "full.stl", "--force"],
    ] {
        // A link with an extension, since the device has none.
        let link = folder.path().join(arguments[3]);
        std::os::unix::fs::symlink("/dev/full", &link).unwrap();
        let assert = pellicle(folder.path()).args(arguments).assert().code(1);
        assert!(
            stderr(&assert).contains("space"),
            "{arguments:?}: {}",
            stderr(&assert)
        );
        assert!(link.is_symlink());
    }
    // Standard output too.
    let full = std::fs::OpenOptions::new()
        .write(true)
        .open("/dev/full")
        .unwrap();
    let output = Command::new(env!("CARGO_BIN_EXE_pellicle"))
        .args(["info", &half])
        .stdout(full)
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&output.stderr).contains("standard output"));
}

#[test]
#[cfg(unix)]
fn a_closed_pipe_is_quiet() {
    let (reader, writer) = std::io::pipe().unwrap();
    drop(reader);
    let output = Command::new(env!("CARGO_BIN_EXE_pellicle"))
        .args(["info", &fixture("half.xyz")])
        .stdout(writer)
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(0));
    assert_eq!(String::from_utf8_lossy(&output.stderr), "");
}

#[test]
fn progress_goes_to_standard_error_when_asked() {
    let folder = tempdir().unwrap();
    let run = |out: &str, when: &str| {
        let assert = pellicle(folder.path())
            .args([
                "delaunay",
                &fixture("sphere_20k.xyz"),
                "-o",
                out,
                "--quiet",
                "--progress",
                when,
            ])
            .assert()
            .success();
        assert_eq!(stdout(&assert), "");
        stderr(&assert)
    };
    assert_eq!(run("a.vtk", "none"), "");
    assert_eq!(run("b.vtk", "auto"), "");
    assert!(run("c.vtk", "bar").contains('%'));
}

#[test]
fn help_is_as_recorded() {
    let folder = tempdir().unwrap();
    let help =
        |arguments: &[&str]| stdout(&pellicle(folder.path()).args(arguments).assert().success());
    insta::assert_snapshot!("help", help(&["--help"]));
    for verb in VERBS {
        let text = help(&[verb, "--help"]);
        assert!(
            text.contains(&format!("  pellicle {verb} ")),
            "{verb} shows no example"
        );
        insta::assert_snapshot!(verb, text);
    }
}

/// A cloud that takes a debug build many seconds to tetrahedralise.
fn large_cloud(path: &Path) {
    let mut state = 1_u64;
    let mut random = || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    let points = (0..1_500_000)
        .map(|_| DVec3::new(random(), random(), random()))
        .collect();
    write_points(
        path,
        &PointCloud::new(points).unwrap(),
        &WriteOptions::default(),
    )
    .unwrap();
}

#[cfg(unix)]
fn interrupt(child: &Child) {
    let status = Command::new("kill")
        .args(["-INT", &child.id().to_string()])
        .status()
        .unwrap();
    assert!(status.success());
}

#[test]
#[cfg(unix)]
fn ctrl_c_stops_within_a_second_and_leaves_no_half_file() {
    let folder = tempdir().unwrap();
    large_cloud(&folder.path().join("large.ply"));
    // While reading, while computing; the last but one verb writes for seconds.
    for (arguments, delay) in [
        (&["delaunay", "large.ply", "-o", "out.vtk"][..], 20),
        (&["delaunay", "large.ply", "-o", "out.vtk"], 1200),
        (&["reconstruct", "large.ply", "-o", "out.ply"], 1200),
        (&["convert", "large.ply", "-o", "out.csv"], 400),
        (&["normals", "large.ply", "-o", "out.ply"], 1200),
        (&["info", "large.ply"], 200),
        (&["compare", "large.ply", "large.ply"], 1000),
    ] {
        let mut child = Command::new(env!("CARGO_BIN_EXE_pellicle"))
            .args(arguments)
            .current_dir(folder.path())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        std::thread::sleep(Duration::from_millis(delay));
        interrupt(&child);
        let pressed = Instant::now();
        let status = child.wait().unwrap();
        let took = pressed.elapsed();
        // A verb that was done before the key was pressed has its whole result.
        if status.code() == Some(0) {
            assert!(
                !arguments[0].contains("delaunay"),
                "{arguments:?} was too quick to interrupt"
            );
        } else {
            assert_eq!(status.code(), Some(130), "{arguments:?}");
            assert!(took < Duration::from_secs(1), "{arguments:?}: {took:?}");
            assert_eq!(names(folder.path()), ["large.ply"], "{arguments:?}");
        }
        for out in ["out.vtk", "out.ply", "out.csv"] {
            let _ = std::fs::remove_file(folder.path().join(out));
        }
    }
}

#[test]
#[cfg(unix)]
fn ctrl_c_leaves_the_snapshots_so_far_and_nothing_else() {
    let folder = tempdir().unwrap();
    // At first while the grid is made, then while the surface moves.
    for (delay, moving) in [(300, false), (6000, true)] {
        let mut child = Command::new(env!("CARGO_BIN_EXE_pellicle"))
            .args(["evolve", &fixture("kitten.xyz"), "-o", "out.ply"])
            .args(["--grid", if moving { "150" } else { "300" }])
            .args(["--smooth", "100000", "--csv", "out.csv"])
            .args(["--snapshots", "frames", "--every", "3", "--force"])
            .current_dir(folder.path())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        std::thread::sleep(Duration::from_millis(delay));
        interrupt(&child);
        let pressed = Instant::now();
        let status = child.wait().unwrap();
        let took = pressed.elapsed();
        assert_eq!(status.code(), Some(130), "{moving}");
        assert!(took < Duration::from_secs(1), "{moving}: {took:?}");
        if !moving {
            assert!(names(folder.path()).is_empty());
            continue;
        }
        assert_eq!(names(folder.path()), ["frames"]);
        let frames = folder.path().join("frames");
        let kept = names(&frames);
        assert!(kept.len() > 2, "{kept:?}");
        for name in kept {
            assert!(
                name.starts_with("step-") && name.ends_with(".ply"),
                "{name}"
            );
            let info = stdout(&pellicle(&frames).args(["info", &name]).assert().success());
            assert!(info.contains("closed              yes"), "{name}: {info}");
        }
    }
}
