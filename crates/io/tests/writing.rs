//! A file appears whole or not at all.

use pellicle_geometry::{DVec3, PointCloud, Progress, VertexId};
use pellicle_io::{
    Encoding, Error, Format, Overwrite, Pixels, ReadOptions, WriteOptions, read_points, write_mesh,
    write_png, write_points,
};
use pellicle_mesh::{MeshView, TriangleSoup};
use std::fs;
use std::ops::ControlFlow;
use std::path::Path;

const REPLACE: WriteOptions = WriteOptions {
    format: None,
    overwrite: Overwrite::Replace,
    encoding: Encoding::Binary,
    progress: &(),
};

fn cloud(count: usize) -> PointCloud {
    PointCloud::new((0..count).map(|i| DVec3::splat(i as f64)).collect()).unwrap()
}

fn names(directory: &Path) -> Vec<String> {
    fs::read_dir(directory)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect()
}

#[test]
fn an_existing_file_is_kept_unless_it_may_be_replaced() {
    let place = tempfile::tempdir().unwrap();
    let path = place.path().join("a.xyz");
    fs::write(&path, "before").unwrap();
    let error = write_points(&path, &cloud(2), &WriteOptions::default()).unwrap_err();
    assert!(matches!(error, Error::Exists { .. }), "{error}");
    assert_eq!(fs::read_to_string(&path).unwrap(), "before");
    let report = write_points(&path, &cloud(2), &REPLACE).unwrap();
    assert_eq!(fs::read_to_string(&path).unwrap(), "0 0 0\n1 1 1\n");
    assert_eq!(report.bytes, 12);
    assert_eq!(names(place.path()), ["a.xyz"]);
}

/// A file that appears while another is being written under its name is not lost.
#[test]
fn a_file_that_appears_meanwhile_is_kept() {
    struct Appears<'a>(&'a Path);
    impl Progress for Appears<'_> {
        fn step(&self, _: &'static str, _: u64, _: u64) -> ControlFlow<()> {
            fs::write(self.0, "meanwhile").unwrap();
            ControlFlow::Continue(())
        }
    }
    let place = tempfile::tempdir().unwrap();
    let path = place.path().join("a.ply");
    let options = WriteOptions {
        progress: &Appears(&path),
        ..Default::default()
    };
    let error = write_points(&path, &cloud(9), &options).unwrap_err();
    assert!(matches!(error, Error::Exists { .. }), "{error}");
    assert_eq!(fs::read_to_string(&path).unwrap(), "meanwhile");
    assert_eq!(names(place.path()), ["a.ply"]);
}

struct StopAfter(u64);
impl Progress for StopAfter {
    fn step(&self, _: &'static str, done: u64, _: u64) -> ControlFlow<()> {
        if done >= self.0 {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        }
    }
}

#[test]
fn a_stop_leaves_nothing_behind() {
    let place = tempfile::tempdir().unwrap();
    let path = place.path().join("a.ply");
    fs::write(&path, "before").unwrap();
    for stop in [0, 20_000, 100_000] {
        let options = WriteOptions {
            progress: &StopAfter(stop),
            ..REPLACE
        };
        let error = write_points(&path, &cloud(100_000), &options).unwrap_err();
        assert!(matches!(error, Error::Cancelled(_)), "{error}");
        assert_eq!(fs::read_to_string(&path).unwrap(), "before");
        assert_eq!(names(place.path()), ["a.ply"]);
    }
}

#[test]
fn reading_stops_when_asked() {
    let place = tempfile::tempdir().unwrap();
    for format in [Format::Xyz, Format::Ply, Format::Pcd, Format::Obj] {
        let path = place.path().join(format!("a.{}", format.extensions()[0]));
        write_points(&path, &cloud(200_000), &REPLACE).unwrap();
        let options = ReadOptions {
            progress: &StopAfter(1 << 20),
            ..Default::default()
        };
        let error = read_points(&path, &options).unwrap_err();
        assert!(matches!(error, Error::Cancelled(_)), "{format}: {error}");
    }
}

#[test]
fn places_that_cannot_be_written() {
    let place = tempfile::tempdir().unwrap();
    let folder = place.path().join("folder.ply");
    fs::create_dir(&folder).unwrap();
    let error = write_points(&folder, &cloud(1), &REPLACE).unwrap_err();
    assert!(matches!(error, Error::Directory { .. }), "{error}");
    let nowhere = place.path().join("missing").join("a.ply");
    let error = write_points(&nowhere, &cloud(1), &REPLACE).unwrap_err();
    assert!(error.to_string().contains("no directory"), "{error}");
    let below_file = place.path().join("f.ply");
    write_points(&below_file, &cloud(1), &REPLACE).unwrap();
    let error = write_points(below_file.join("a.ply"), &cloud(1), &REPLACE).unwrap_err();
    assert!(matches!(error, Error::Io { .. }), "{error}");
    assert_eq!(names(place.path()).len(), 2);
}

#[cfg(unix)]
#[test]
fn devices_links_and_permissions() {
    use std::os::unix::fs::{PermissionsExt, symlink};
    let full = WriteOptions {
        format: Some(Format::Ply),
        ..REPLACE
    };
    if Path::new("/dev/full").exists() {
        let error = write_points("/dev/full", &cloud(100_000), &full).unwrap_err();
        assert!(
            matches!(
                error,
                Error::Io {
                    action: "written",
                    ..
                }
            ),
            "{error}"
        );
        assert!(Path::new("/dev/full").exists());
        write_points("/dev/null", &cloud(3), &full).unwrap();
        assert!(!fs::metadata("/dev/null").unwrap().is_file());
    }
    let place = tempfile::tempdir().unwrap();
    let (target, link) = (place.path().join("t.ply"), place.path().join("l.ply"));
    write_points(&target, &cloud(1), &REPLACE).unwrap();
    let mode = |path: &Path| fs::metadata(path).unwrap().permissions().mode() & 0o777;
    let usual = place.path().join("usual");
    fs::write(&usual, "").unwrap();
    assert_eq!(mode(&target), mode(&usual), "as any new file");
    fs::set_permissions(&target, fs::Permissions::from_mode(0o640)).unwrap();
    symlink(&target, &link).unwrap();
    write_points(&link, &cloud(2), &REPLACE).unwrap();
    assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
    assert_eq!(
        read_points(&target, &ReadOptions::default()).unwrap().cloud,
        cloud(2)
    );
    assert_eq!(mode(&target), 0o640, "as the file before");
    fs::set_permissions(&target, fs::Permissions::from_mode(0o440)).unwrap();
    let error = write_points(&target, &cloud(3), &REPLACE).unwrap_err();
    assert!(
        matches!(
            error,
            Error::Io {
                action: "created",
                ..
            }
        ),
        "{error}"
    );
}

#[test]
fn places_that_cannot_be_read() {
    let place = tempfile::tempdir().unwrap();
    let error = read_points(place.path().join("none.ply"), &ReadOptions::default()).unwrap_err();
    assert!(
        error.to_string().contains("none.ply: cannot be opened"),
        "{error}"
    );
    let folder = place.path().join("folder.ply");
    fs::create_dir(&folder).unwrap();
    let error = read_points(&folder, &ReadOptions::default()).unwrap_err();
    assert!(matches!(error, Error::Directory { .. }), "{error}");
}

#[test]
fn what_a_format_cannot_hold_is_refused() {
    let place = tempfile::tempdir().unwrap();
    let soup = TriangleSoup {
        positions: vec![DVec3::ZERO, DVec3::X, DVec3::Y],
        triangles: vec![[0, 1, 2].map(VertexId)],
    };
    for format in Format::ALL {
        let path = place.path().join(format!("a.{}", format.extensions()[0]));
        let points = write_points(&path, &cloud(3), &REPLACE);
        assert_eq!(
            points.is_ok(),
            format.can_write(pellicle_io::Content::Points),
            "{format}"
        );
        let mesh = write_mesh(&path, &soup, None, &REPLACE);
        assert_eq!(
            mesh.is_ok(),
            format.can_write(pellicle_io::Content::Mesh),
            "{format}"
        );
        for error in [points.err(), mesh.err()].into_iter().flatten() {
            assert!(error.to_string().contains("ply"), "{error}");
        }
    }
    let path = place.path().join("b.ply");
    let view = MeshView {
        positions: &soup.positions,
        triangles: &[[0, 3, 1].map(VertexId)],
    };
    let error = write_mesh(&path, view, None, &REPLACE).unwrap_err();
    assert!(
        matches!(
            error,
            Error::VertexOutOfRange {
                triangle: 0,
                vertices: 3,
                ..
            }
        ),
        "{error}"
    );
    let error = write_mesh(&path, &soup, Some(&[DVec3::Z]), &REPLACE).unwrap_err();
    assert!(
        matches!(
            error,
            Error::NormalCount {
                vertices: 3,
                normals: 1,
                ..
            }
        ),
        "{error}"
    );
    let broken = TriangleSoup {
        positions: vec![DVec3::ZERO, DVec3::NAN],
        triangles: vec![],
    };
    let error = write_mesh(&path, &broken, None, &REPLACE).unwrap_err();
    assert!(
        matches!(
            error,
            Error::VertexNotFinite {
                vertex: VertexId(1),
                ..
            }
        ),
        "{error}"
    );
    let huge = TriangleSoup {
        positions: vec![DVec3::ZERO, DVec3::splat(1e300), DVec3::X],
        ..soup
    };
    let error = write_mesh(place.path().join("c.stl"), &huge, None, &REPLACE).unwrap_err();
    assert!(matches!(error, Error::Range { .. }), "{error}");
    assert!(!path.exists());
}

#[test]
fn pictures() {
    let place = tempfile::tempdir().unwrap();
    let path = place.path().join("a.png");
    let bytes = [255, 0, 0, 0, 255, 0, 0, 0, 255, 1, 2, 3, 4, 5, 6, 7, 8, 9];
    write_png(&path, 3, 2, Pixels::Rgb(&bytes), &WriteOptions::default()).unwrap();
    let encoded = fs::read(&path).unwrap();
    let decoded = image::load_from_memory(&encoded).unwrap().into_rgb8();
    assert_eq!((decoded.width(), decoded.height()), (3, 2));
    assert_eq!(decoded.into_raw(), bytes);
    let error = write_png(&path, 3, 2, Pixels::Rgb(&bytes), &WriteOptions::default()).unwrap_err();
    assert!(matches!(error, Error::Exists { .. }), "{error}");
    let error = write_png(&path, 3, 2, Pixels::Rgba(&bytes), &REPLACE).unwrap_err();
    assert!(
        matches!(error, Error::PictureSize { expected: 24, .. }),
        "{error}"
    );
}
