//! Reading takes at most 1.2 times the data held, at its peak, as the system counts it: address space, so that what
//! is reserved and not used counts too.
#![cfg(target_os = "linux")]

use pellicle_geometry::{DVec3, PointCloud, VertexId};
use pellicle_io::{
    AnimationOptions, AnimationWriter, Data, Encoding, Format, Frame, ReadOptions, WriteOptions,
    read, write_mesh, write_points,
};
use pellicle_mesh::TriangleSoup;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Names the file to read, in the process that is measured.
const FILE: &str = "PELLICLE_TEST_MEMORY_FILE";

/// A line of the status of this process, in bytes.
fn status(name: &str) -> usize {
    let status = std::fs::read_to_string("/proc/self/status").unwrap();
    let line = status.lines().find(|line| line.starts_with(name)).unwrap();
    line.split_whitespace()
        .nth(1)
        .unwrap()
        .parse::<usize>()
        .unwrap()
        * 1024
}

/// Not a test of its own: what the measured process does.
#[test]
fn measured_process() {
    let Some(path) = std::env::var_os(FILE) else {
        return;
    };
    let before = status("VmSize");
    let read = read(Path::new(&path), &ReadOptions::default()).unwrap();
    let peak = status("VmPeak") - before;
    let vector = size_of::<DVec3>();
    let held = match &read.data {
        Data::Points(cloud) => vector * cloud.len() * (1 + usize::from(cloud.normals().is_some())),
        Data::Mesh { soup, normals } => {
            vector * (soup.positions.len() + normals.as_ref().map_or(0, Vec::len))
                + size_of::<[VertexId; 3]>() * soup.triangles.len()
        }
    };
    println!("ratio {:.3}", peak as f64 / held as f64);
}

/// Names the animation to write, in the process that is measured.
const ANIMATION: &str = "PELLICLE_TEST_MEMORY_ANIMATION";

/// Not a test of its own: what the measured process does.
#[test]
fn measured_animation() {
    let Some(path) = std::env::var_os(ANIMATION).map(PathBuf::from) else {
        return;
    };
    let soup = torus(400, 250);
    let frame = Frame {
        mesh: (&soup).into(),
        normals: None,
    };
    let before = status("VmSize");
    let (animation, options) = (AnimationOptions::default(), WriteOptions::default());
    let mut writer = AnimationWriter::create(&path, &animation, &options).unwrap();
    for _ in 0..FRAMES {
        writer.push(frame).unwrap();
    }
    let written = writer.finish().unwrap().bytes;
    let peak = status("VmPeak") - before;
    println!("ratio {:.4}", peak as f64 / written as f64);
}

const FRAMES: usize = 40;

/// An animation takes the memory of its buffers, whatever the number of its frames.
#[test]
fn peak_of_animations() {
    let place = tempfile::tempdir().unwrap();
    let path = place.path().join("a.glb");
    let ratio = measure("measured_animation", ANIMATION, &path);
    let written = std::fs::metadata(&path).unwrap().len();
    assert!(written > FRAMES as u64 * 3_000_000, "{written}");
    // Two buffers of 256 KiB and a block of 1 MiB, where a frame is 3.6 MB.
    let peak = ratio * written as f64;
    assert!(peak > 1e6 && peak < 3e6, "{peak}");
}

fn ratio(path: &Path) -> f64 {
    measure("measured_process", FILE, path)
}

fn measure(test: &str, variable: &str, path: &Path) -> f64 {
    let output = Command::new(std::env::current_exe().unwrap())
        .args(["--exact", test, "--nocapture"])
        .env(variable, path)
        // One heap: that of a further thread takes 64 MiB of address space at once.
        .env("MALLOC_ARENA_MAX", "1")
        .output()
        .unwrap();
    let text = String::from_utf8(output.stdout).unwrap();
    let at = text.find("ratio ").unwrap_or_else(|| panic!("{text}"));
    text[at + 6..]
        .split_whitespace()
        .next()
        .unwrap()
        .parse()
        .unwrap()
}

/// Lines get longer towards the end, so that an estimate from the start of the file would be wrong.
fn position(i: usize) -> DVec3 {
    let x = if i.is_multiple_of(3) {
        i as f64
    } else {
        (i as f64).sqrt()
    };
    DVec3::new(x, (i % 1000) as f64, 0.5)
}

#[test]
fn peak_of_points() {
    let place = tempfile::tempdir().unwrap();
    let positions: Vec<DVec3> = (0..600_000).map(position).collect();
    let normals = positions.iter().map(|p| p.normalize_or(DVec3::Z)).collect();
    let plain = PointCloud::new(positions).unwrap();
    let oriented = plain.clone().with_normals(normals).unwrap();
    for (format, encoding) in [
        (Format::Xyz, Encoding::Text),
        (Format::Csv, Encoding::Text),
        (Format::Obj, Encoding::Text),
        (Format::Off, Encoding::Text),
        (Format::Ply, Encoding::Text),
        (Format::Ply, Encoding::Binary),
        (Format::Pcd, Encoding::Binary),
    ] {
        for cloud in [&plain, &oriented] {
            let path = place.path().join(format!("a.{}", format.extensions()[0]));
            let options = WriteOptions {
                encoding,
                overwrite: pellicle_io::Overwrite::Replace,
                ..Default::default()
            };
            write_points(&path, cloud, &options).unwrap();
            let ratio = ratio(&path);
            assert!(
                ratio > 0.9,
                "{format} {encoding:?}: measured nothing: {ratio}"
            );
            assert!(ratio <= 1.2, "{format} {encoding:?}: {ratio}");
        }
    }
}

/// A torus: twice as many triangles as vertices.
fn torus(m: u32, n: u32) -> TriangleSoup {
    let id = |i: u32, j: u32| VertexId((i % m) * n + j % n);
    let angle = |k: u32, of: u32| std::f64::consts::TAU * f64::from(k) / f64::from(of);
    let mut soup = TriangleSoup::default();
    for i in 0..m {
        for j in 0..n {
            let ((sa, ca), (sb, cb)) = (angle(i, m).sin_cos(), angle(j, n).sin_cos());
            soup.positions
                .push(DVec3::new((3.0 + cb) * ca, (3.0 + cb) * sa, sb));
            soup.triangles
                .push([id(i, j), id(i + 1, j), id(i + 1, j + 1)]);
            soup.triangles
                .push([id(i, j), id(i + 1, j + 1), id(i, j + 1)]);
        }
    }
    soup
}

#[test]
fn peak_of_meshes() {
    let place = tempfile::tempdir().unwrap();
    let soup = torus(800, 500);
    // STL keeps a table to find equal corners; GLB is held while it is read.
    for (format, most) in [
        (Format::Ply, 1.2),
        (Format::Off, 1.2),
        (Format::Obj, 1.2),
        (Format::Stl, 1.3),
        (Format::Glb, 2.0),
    ] {
        let path = place.path().join(format!("a.{}", format.extensions()[0]));
        write_mesh(&path, &soup, None, &WriteOptions::default()).unwrap();
        let ratio = ratio(&path);
        println!("{format}: {ratio}");
        assert!(ratio > 0.9 && ratio <= most, "{format}: {ratio}");
    }
}
