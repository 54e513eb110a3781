//! What `render` shows beside the surface: values, edges, crossings, nothing.

mod common;

use common::{fixture, json, names, pellicle, stderr};
use image::RgbaImage;
use pellicle::geometry::DVec3;
use pellicle::io::{WriteOptions, write_mesh};
use pellicle::mesh::{TriMesh, icosphere};
use std::path::Path;
use tempfile::tempdir;

const BACKGROUND: [u8; 4] = [244, 245, 247, 255];
const EDGE: [u8; 4] = [44, 48, 56, 255];
const CROSSING: [u8; 4] = [196, 16, 48, 255];
const BORDER: [u8; 4] = [226, 88, 34, 255];

/// Draws one view of 300 × 200 pixels.
fn picture(folder: &Path, input: &str, further: &[&str]) -> RgbaImage {
    pellicle(folder)
        .args(["render", input, "-o", "out.png", "--force"])
        .args(["--width", "300", "--height", "200", "--views", "front"])
        .args(further)
        .assert()
        .success();
    image::open(folder.join("out.png")).unwrap().into_rgba8()
}

fn shows(picture: &RgbaImage, color: [u8; 4]) -> usize {
    picture.pixels().filter(|pixel| pixel.0 == color).count()
}

fn write_sphere(path: &Path, radius: f64, shift: DVec3) {
    let mut mesh: TriMesh = icosphere(3).unwrap();
    let moved = mesh
        .positions()
        .iter()
        .map(|p| *p * radius + shift)
        .collect();
    mesh.set_positions(moved).unwrap();
    write_mesh(path, &mesh, None, &WriteOptions::default()).unwrap();
}

#[test]
fn styles_differ_as_they_say() {
    let folder = tempdir().unwrap();
    let draw = |style: &str| {
        let further = ["--style", style];
        picture(folder.path(), &fixture("elephant.off"), &further)
    };
    let [surface, both, visible, all, points] = [
        "surface",
        "surface-edges",
        "visible-edges",
        "edges",
        "points",
    ]
    .map(draw);
    assert_eq!(shows(&surface, EDGE), 0);
    let covered = |picture: &RgbaImage| 300 * 200 - shows(picture, BACKGROUND);
    assert!(shows(&both, EDGE) > 50);
    assert!(covered(&both) >= covered(&surface));
    assert!(covered(&visible) < covered(&both) && covered(&visible) < covered(&all));
    assert!(covered(&points) > 1000 && points != surface);
    // Wider edges cover more.
    let wide = ["--style", "visible-edges", "--edge-width", "3"];
    let wide = picture(folder.path(), &fixture("elephant.off"), &wide);
    assert!(shows(&wide, EDGE) > 2 * shows(&visible, EDGE));
}

#[test]
fn transparency_is_where_nothing_is() {
    let folder = tempdir().unwrap();
    let cube = fixture("analytic/cube.off");
    let opaque = picture(folder.path(), &cube, &[]);
    let clear = picture(folder.path(), &cube, &["--transparent"]);
    assert_eq!(shows(&clear, [0; 4]), shows(&opaque, BACKGROUND));
    for (a, b) in opaque.pixels().zip(clear.pixels()) {
        assert!(b[3] < 255 || a == b);
    }
}

#[test]
fn crossings_and_borders_are_marked_when_asked_for() {
    let folder = tempdir().unwrap();
    let crossing = fixture("repair/sphere_plus_inverted_overlap.off");
    let plain = picture(folder.path(), &crossing, &["--views", "three-quarter"]);
    assert_eq!(shows(&plain, CROSSING), 0);
    let further = [
        "--views",
        "three-quarter",
        "--crossing",
        "--shading",
        "unlit",
    ];
    let marked = picture(folder.path(), &crossing, &further);
    assert!(
        shows(&marked, CROSSING) > 30,
        "{}",
        shows(&marked, CROSSING)
    );
    let is_like_marked = |pixel: [u8; 4]| {
        let [red, green, blue] = [pixel[0], pixel[1], pixel[2]].map(u16::from);
        red > 2 * blue && green > 2 * blue
    };
    let hue = marked.pixels().filter(|pixel| is_like_marked(pixel.0));
    assert!(hue.count() > 30, "nothing is marked");
    let arguments = ["render", &crossing, "-o", "c.png", "--crossing"];
    let info = json(folder.path(), &["info", &crossing]);
    let done = json(folder.path(), &arguments);
    assert_eq!(
        done["intersecting_triangles"],
        info["intersecting_triangles"]
    );

    let open = fixture("analytic/hemisphere_open.off");
    let below = ["--views", "bottom", "--up", "z"];
    let bordered = picture(folder.path(), &open, &below);
    let plain = picture(
        folder.path(),
        &open,
        &[&below[..], &["--no-borders"]].concat(),
    );
    assert!(
        shows(&bordered, BORDER) > 100,
        "{}",
        shows(&bordered, BORDER)
    );
    assert_eq!(shows(&plain, BORDER), 0);
}

#[test]
fn values_are_those_of_closed_forms() {
    let folder = tempdir().unwrap();
    write_sphere(&folder.path().join("s.ply"), 2.0, DVec3::ZERO);
    write_sphere(&folder.path().join("far.ply"), 1.0, 10.0 * DVec3::X);
    let values = |scalar: &str| {
        let arguments = [
            "render", "s.ply", "-o", "v.png", "--force", "--scalar", scalar,
        ];
        let done = json(folder.path(), &arguments)["scalar"].clone();
        assert_eq!(done["missing"], 0, "{scalar}");
        let number = |key: &str| done[key].as_f64().unwrap();
        (number("least"), number("greatest"))
    };
    let near = |found: (f64, f64), least: f64, greatest: f64, within: f64| {
        let close = (found.0 - least).abs() < within && (found.1 - greatest).abs() < within;
        assert!(close, "{found:?}: {least} {greatest}");
    };
    // 1/R, and the nearest and farthest point of the other sphere.
    near(values("mean-curvature"), 0.5, 0.5, 0.01);
    near(values("distance-to:far.ply"), 7.0, 11.0, 0.1);
    near(values("z"), -2.0, 2.0, 0.02);
    let (least, greatest) = values("area");
    // 642 vertices.
    let mean = 16.0 * std::f64::consts::PI / 642.0;
    assert!(least < mean && mean < greatest && greatest < 2.0 * least);
    // A property of the file itself.
    near(values("property:x"), -2.0, 2.0, 0.02);
}

#[test]
fn the_bar_can_be_left_out_and_its_range_chosen() {
    let folder = tempdir().unwrap();
    let cube = fixture("analytic/cube.off");
    let with = picture(folder.path(), &cube, &["--scalar", "x"]);
    let without = picture(folder.path(), &cube, &["--scalar", "x", "--no-bar"]);
    // The last columns but a margin hold numbers, or nothing.
    let right = |picture: &RgbaImage| {
        let at = picture.enumerate_pixels().filter(|(x, _, _)| *x >= 262);
        at.filter(|(.., pixel)| pixel.0 != BACKGROUND).count()
    };
    assert!(right(&with) > 100 && right(&without) == 0);
    // Beyond the range everything has the last colour, but for creases.
    let range = [
        "--scalar",
        "x",
        "--no-bar",
        "--range",
        "-9,-8",
        "--shading",
        "unlit",
    ];
    let beyond = picture(folder.path(), &cube, &range);
    let is_yellow = |pixel: [u8; 4]| {
        let [red, green, blue] = [pixel[0], pixel[1], pixel[2]].map(u16::from);
        red > 2 * blue && green > 2 * blue
    };
    let last = beyond.pixels().filter(|pixel| is_yellow(pixel.0)).count();
    assert!(last > 1000, "{last}");
}

#[test]
fn values_that_there_are_not_are_explained() {
    let folder = tempdir().unwrap();
    write_sphere(&folder.path().join("s.ply"), 1.0, DVec3::ZERO);
    let kitten = fixture("kitten.xyz");
    let cube = fixture("analytic/cube.off");
    for (input, scalar, expected) in [
        (kitten.as_str(), "mean-curvature", "5210"),
        (&kitten, "area", "5210"),
        (&cube, "property:quality", "PLY"),
        ("s.ply", "property:quality", "\"x\", \"y\", \"z\""),
        (&cube, "distance-to:missing.ply", "missing.ply"),
    ] {
        let assert = pellicle(folder.path())
            .args(["render", input, "-o", "out.png", "--scalar", scalar])
            .assert()
            .code(1);
        assert!(
            stderr(&assert).contains(expected),
            "{scalar}: {}",
            stderr(&assert)
        );
    }
    assert_eq!(names(folder.path()), ["s.ply"]);
}
