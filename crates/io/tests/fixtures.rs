//! Every scan and mesh of the fixtures is read, with the counts that their manifest states.

use pellicle_geometry::DVec3;
use pellicle_io::{Data, Format, Note, ReadOptions, read, read_points};
use std::path::PathBuf;

fn fixture(name: &str) -> PathBuf {
    [env!("CARGO_MANIFEST_DIR"), "../../fixtures", name]
        .iter()
        .collect()
}

/// Name, vertices, triangles, whether there are normals.
const FIXTURES: &[(&str, usize, usize, bool)] = &[
    ("kitten.xyz", 5210, 0, true),
    ("oni.pwn", 1435, 0, true),
    ("half.xyz", 325, 0, false),
    ("hippo1.ply", 6104, 0, true),
    ("hippo2.ply", 4387, 0, true),
    ("b9.ply", 22300, 0, false),
    ("blobby.xyz", 3288, 0, true),
    ("fin90_with_PCA_normals.xyz", 757, 0, true),
    ("building.xyz", 8075, 0, true),
    ("sphere_20k.xyz", 21000, 0, false),
    ("sphere926.pwn", 926, 0, true),
    ("cylinders.ply", 1813, 0, true),
    ("spheres.ply", 5969, 0, true),
    ("fandisk.off", 6475, 12946, false),
    ("anchor_dense.off", 3793, 7598, false),
    ("bones.off", 2154, 4204, false),
    ("blobby_3cc.off", 1820, 3417, false),
    ("elephant.off", 2775, 5558, false),
    // The manifest counts the 2733 vertices that triangles use; the file has 65 more.
    ("elephant-with-holes.off", 2798, 4463, false),
    ("knot1.off", 3200, 6400, false),
    ("knot2.off", 5760, 11520, false),
    ("couplingdown.off", 1841, 3714, false),
    ("mannequin-devil.off", 12977, 25888, false),
    ("holes.off", 4291, 8288, false),
    ("mech-holes-shark.off", 5246, 10192, false),
    ("hand.off", 1197, 2390, false),
    ("pinion.off", 650, 1300, false),
    ("spool.off", 649, 1294, false),
    ("cheese.off", 8629, 17786, false),
    ("turbine.off", 9210, 18460, false),
    ("bull.off", 6200, 12396, false),
    ("tm_featuretype.stl", 2010, 3476, false),
    ("tm_fixed_top.ply", 2374, 4772, false),
    ("pcl_ism_train_cat.pcd", 3400, 0, false),
    ("pcl_rops_points.pcd", 32087, 0, false),
    ("pdal_autzen_trim.laz", 110000, 0, false),
    ("analytic/cube.off", 8, 12, false),
    ("analytic/hemisphere_open.off", 5185, 10176, false),
    ("analytic/moebius.off", 1800, 3200, false),
    ("analytic/nested_spheres.off", 5124, 10240, false),
    ("analytic/sphere.off", 10242, 20480, false),
    ("analytic/thin_plate.off", 8, 12, false),
    ("analytic/torus.off", 6144, 12288, false),
    ("analytic/two_spheres_gap.off", 5124, 10240, false),
];

#[test]
fn counts_are_those_of_the_manifest() {
    for &(name, vertices, triangles, has_normals) in FIXTURES {
        let path = fixture(name);
        let read = read(&path, &ReadOptions::default()).unwrap_or_else(|e| panic!("{e}"));
        let found = match &read.data {
            Data::Points(cloud) => (cloud.len(), 0, cloud.normals().is_some()),
            Data::Mesh { soup, normals } => (
                soup.positions.len(),
                soup.triangles.len(),
                normals.is_some(),
            ),
        };
        assert_eq!(found, (vertices, triangles, has_normals), "{name}");
        let points = read_points(&path, &ReadOptions::default()).unwrap();
        assert_eq!(points.cloud.len(), vertices, "{name}");
        let positions = match &read.data {
            Data::Points(cloud) => cloud.positions(),
            Data::Mesh { soup, .. } => &soup.positions,
        };
        assert_eq!(points.cloud.positions(), positions, "{name}");
    }
}

/// First and last coordinates, taken from the files by other programs.
#[test]
fn coordinates_are_those_of_the_file() {
    let first_and_last = |name: &str| {
        let points = read_points(fixture(name), &ReadOptions::default()).unwrap();
        let positions = points.cloud.positions();
        (positions[0], positions[positions.len() - 1])
    };
    assert_eq!(
        first_and_last("kitten.xyz").0,
        DVec3::new(-0.0721898, -0.159749, -0.108444)
    );
    assert_eq!(
        first_and_last("b9.ply").0,
        DVec3::new(45.375, 52.1094, -10.6268)
    );
}

#[test]
fn stl_corners_are_merged_and_reported() {
    let read = read(fixture("tm_featuretype.stl"), &ReadOptions::default()).unwrap();
    assert_eq!(read.report.format, Format::Stl);
    assert_eq!(
        read.report.notes,
        [Note::Merged {
            corners: 3 * 3476,
            vertices: 2010
        }]
    );
}
