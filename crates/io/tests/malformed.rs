//! No bytes make a reader panic, take memory out of proportion, or hang.
//!
//! Sound files of every format are damaged in ways that are chosen at random but the same at each run; what
//! fuzzing found stands in `tests/malformed/` and is read too.

use pellicle_geometry::{DVec3, PointCloud, VertexId};
use pellicle_io::{
    Data, Encoding, Format, Overwrite, ReadOptions, WriteOptions, read_from, write_mesh,
    write_points,
};
use pellicle_mesh::TriangleSoup;
use proptest::prelude::*;
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};
use std::io::Cursor;
use std::path::Path;

/// Reads; an error must name the file, and what is read must be sound.
fn survive(format: Format, bytes: &[u8]) {
    let input = Cursor::new(bytes);
    match read_from(input, format, "damaged.file", &ReadOptions::default()) {
        Err(error) => {
            let message = error.to_string();
            assert!(message.starts_with("damaged.file: "), "{message}");
            assert!(message.len() < 2000, "{message}");
        }
        Ok(read) => match read.data {
            Data::Points(cloud) => {
                assert!(cloud.normals().is_none_or(|n| n.len() == cloud.len()));
            }
            Data::Mesh { soup, normals } => {
                let vertices = soup.positions.len();
                assert!(soup.positions.iter().all(|p| p.is_finite()));
                assert!(normals.is_none_or(|n| n.len() == vertices));
                let mut corners = soup.triangles.as_flattened().iter();
                assert!(corners.all(|v| (v.0 as usize) < vertices));
            }
        },
    }
}

/// Sound files of every format and encoding.
fn seeds() -> Vec<(Format, Vec<u8>)> {
    let place = tempfile::tempdir().unwrap();
    let positions: Vec<DVec3> = (0..12)
        .map(|i| DVec3::new(f64::from(i), 0.5 * f64::from(i * i), -1.25e-3))
        .collect();
    let normals = vec![DVec3::Z; positions.len()];
    let soup = TriangleSoup {
        triangles: (0..10).map(|i| [i, i + 1, i + 2].map(VertexId)).collect(),
        positions: positions.clone(),
    };
    let plain = PointCloud::new(positions).unwrap();
    let oriented = plain.clone().with_normals(normals.clone()).unwrap();
    let mut seeds = Vec::new();
    for format in Format::ALL {
        let path = place.path().join(format!("a.{}", format.extensions()[0]));
        for encoding in [Encoding::Binary, Encoding::Text] {
            let options = WriteOptions {
                overwrite: Overwrite::Replace,
                encoding,
                ..Default::default()
            };
            let written = [
                write_points(&path, &plain, &options).map(|_| std::fs::read(&path)),
                write_points(&path, &oriented, &options).map(|_| std::fs::read(&path)),
                write_mesh(&path, &soup, Some(&normals), &options).map(|_| std::fs::read(&path)),
            ];
            let kept = written
                .into_iter()
                .flatten()
                .map(|bytes| (format, bytes.unwrap()));
            seeds.extend(kept);
        }
    }
    seeds.extend(handmade());
    for compressed in [false, true] {
        for format in [0, 1, 3, 7] {
            let of = if compressed { Format::Laz } else { Format::Las };
            seeds.push((of, las(format, compressed)));
        }
    }
    seeds
}

/// What the writers do not write.
fn handmade() -> Vec<(Format, Vec<u8>)> {
    let mut big_endian = b"ply\nformat binary_big_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\n\
        property float z\nproperty list uchar short l\nelement tristrips 1\nproperty list int int vertex_indices\n\
        end_header\n"
        .to_vec();
    for _ in 0..3 {
        big_endian.extend([0x3f, 0x80, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 7]);
    }
    for v in [4i32, 0, 1, 2, -1] {
        big_endian.extend(v.to_be_bytes());
    }
    let mut compressed =
        b"FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 40\nHEIGHT 1\nPOINTS 40\n\
        DATA binary_compressed\n"
            .to_vec();
    // One zero, then copies of it: 480 bytes in all.
    let packed = [0, 0, 0xe0, 255, 0, 0xe0, 206, 0];
    compressed.extend((packed.len() as u32).to_le_bytes());
    compressed.extend(480u32.to_le_bytes());
    compressed.extend(packed);
    let gltf = r#"{"asset":{"version":"2.0"},"scenes":[{"nodes":[0]}],"nodes":[{"children":[1],"scale":[1,1,2]},
        {"mesh":0,"rotation":[0,0,0,1]}],"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1,"mode":5}]}],
        "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},
        {"bufferView":0,"byteOffset":0,"componentType":5121,"count":3,"type":"SCALAR"}],
        "bufferViews":[{"buffer":0,"byteLength":36,"byteStride":12}],
        "buffers":[{"uri":"data:;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA","byteLength":36}]}"#;
    vec![
        (Format::Ply, big_endian),
        (Format::Pcd, compressed),
        (Format::Gltf, gltf.as_bytes().to_vec()),
        (Format::Off, b"STCNOFF 3 1 0\n0 0 0 0 0 1 9 9\n1 0 0 0 0 1\n0 1 0 0 0 1\n3 0 1 2 # c\n".to_vec()),
        (Format::Obj, b"v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nf -3//1 \\\n-2//1 3//1\nl 1 2\n".to_vec()),
        (
            Format::Stl,
            b"solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n\
              endsolid a\n"
                .to_vec(),
        ),
        (Format::Pwn, b"2\n1 2 3\n4 5 6\n0 0 1\n0 0 1\n".to_vec()),
        (Format::Csv, b"name;X [m];Y;Z;nx;ny;nz\na;1,5;2;3;0;0;1\n;4;5;6,5;0;0;1\n".to_vec()),
    ]
}

fn las(format: u8, compressed: bool) -> Vec<u8> {
    let mut builder = las::Builder::from((1, 4));
    builder.point_format = las::point::Format::new(format).unwrap();
    builder.point_format.is_compressed = compressed;
    let header = builder.into_header().unwrap();
    let mut writer = las::Writer::new(Cursor::new(Vec::new()), header).unwrap();
    for i in 0..40 {
        let f = las::point::Format::new(format).unwrap();
        writer
            .write_point(las::Point {
                x: f64::from(i) * 0.5,
                gps_time: f.has_gps_time.then_some(1.5),
                color: f.has_color.then(|| las::Color::new(1, 7, 9)),
                ..Default::default()
            })
            .unwrap();
    }
    writer.close().unwrap();
    writer.into_inner().unwrap().into_inner()
}

/// One way to damage a file.
#[derive(Clone, Debug)]
enum Damage {
    Flip(usize, u8),
    Set(usize, Vec<u8>),
    Insert(usize, Vec<u8>),
    Remove(usize, usize),
    Repeat(usize, usize),
    Truncate(usize),
}

fn damage() -> impl Strategy<Value = Damage> {
    let at = || any::<usize>();
    let bytes = || {
        prop_oneof![
            prop::collection::vec(any::<u8>(), 1..9),
            prop::sample::select(vec![
                b"-1".to_vec(),
                b" 999999999999999999 ".to_vec(),
                b"18446744073709551615".to_vec(),
                b"nan".to_vec(),
                b"1e999".to_vec(),
                b"\n".to_vec(),
                b"\r".to_vec(),
                b" ".to_vec(),
                b"\0".to_vec(),
                b"#".to_vec(),
                vec![255; 4],
                vec![255; 8],
                vec![0; 8],
                vec![255, 255, 255, 127],
                0xffff_fff0u32.to_le_bytes().to_vec(),
            ]),
        ]
    };
    prop_oneof![
        (at(), any::<u8>()).prop_map(|(at, bit)| Damage::Flip(at, bit % 8)),
        (at(), bytes()).prop_map(|(at, bytes)| Damage::Set(at, bytes)),
        (at(), bytes()).prop_map(|(at, bytes)| Damage::Insert(at, bytes)),
        (at(), 1usize..40).prop_map(|(at, n)| Damage::Remove(at, n)),
        (at(), 1usize..40).prop_map(|(at, n)| Damage::Repeat(at, n)),
        at().prop_map(Damage::Truncate),
    ]
}

fn apply(bytes: &mut Vec<u8>, damage: &Damage) {
    let length = bytes.len();
    let place = |at: usize| at % (length + 1);
    match damage {
        Damage::Flip(at, bit) => {
            if let Some(byte) = bytes.get_mut(place(*at)) {
                *byte ^= 1 << bit;
            }
        }
        Damage::Set(at, with) => {
            let at = place(*at);
            let end = (at + with.len()).min(length);
            bytes[at..end].copy_from_slice(&with[..end - at]);
        }
        Damage::Insert(at, with) => {
            let at = place(*at);
            bytes.splice(at..at, with.iter().copied());
        }
        Damage::Remove(at, n) => {
            let at = place(*at);
            bytes.drain(at..(at + n).min(length));
        }
        Damage::Repeat(at, n) => {
            let at = place(*at);
            let again = bytes[at..(at + n).min(length)].to_vec();
            bytes.splice(at..at, again);
        }
        Damage::Truncate(at) => bytes.truncate(place(*at)),
    }
}

/// The most address space that this process had, all tests together: the files have some kilobytes, and what is
/// reserved for them counts even if it is not used.
#[cfg(target_os = "linux")]
fn check_peak() {
    let status = std::fs::read_to_string("/proc/self/status").unwrap();
    let line = status
        .lines()
        .find(|line| line.starts_with("VmPeak"))
        .unwrap();
    let peak = line
        .split_whitespace()
        .nth(1)
        .unwrap()
        .parse::<usize>()
        .unwrap()
        * 1024;
    assert!(peak < 3 << 30, "{peak} bytes at the peak");
}

#[cfg(not(target_os = "linux"))]
fn check_peak() {}

#[test]
fn damaged_files_are_survived() {
    let seeds = seeds();
    for format in Format::ALL {
        assert!(
            seeds.iter().any(|(of, _)| *of == format),
            "no seed of {format}"
        );
    }
    for (format, bytes) in &seeds {
        let read = read_from(Cursor::new(bytes), *format, "seed", &ReadOptions::default());
        read.unwrap_or_else(|e| panic!("a seed must be sound: {format}: {e}"));
    }
    let config = Config {
        cases: 60_000,
        failure_persistence: None,
        ..Config::default()
    };
    let mut runner =
        TestRunner::new_with_rng(config, TestRng::deterministic_rng(RngAlgorithm::ChaCha));
    let strategy = (0..seeds.len(), prop::collection::vec(damage(), 1..5));
    runner
        .run(&strategy, |(seed, damages)| {
            let (format, mut bytes) = seeds[seed].clone();
            for damage in &damages {
                apply(&mut bytes, damage);
            }
            survive(format, &bytes);
            Ok(())
        })
        .unwrap();
    check_peak();
}

/// Every file cut at every byte, read as every format.
#[test]
fn cut_files_are_survived() {
    for (format, bytes) in seeds() {
        let step = (bytes.len() / 400).max(1);
        for end in (0..bytes.len()).step_by(step) {
            survive(format, &bytes[..end]);
        }
        for other in Format::ALL {
            survive(other, &bytes);
        }
    }
}

/// A header that lies costs nothing: 10^18 of everything.
#[test]
fn counts_that_lie_are_survived() {
    let n = 1_000_000_000_000_000_000u64;
    let big = "element vertex N\nproperty double x\nproperty double y\nproperty double z\n";
    for (format, text) in [
        (
            Format::Ply,
            format!("ply\nformat ascii 1.0\n{big}end_header\n0 0 0\n"),
        ),
        (
            Format::Ply,
            format!("ply\nformat binary_little_endian 1.0\n{big}end_header\n0 0 0\n"),
        ),
        (
            Format::Ply,
            "ply\nformat binary_little_endian 1.0\nelement a N\nend_header\n".into(),
        ),
        (
            Format::Ply,
            "ply\nformat ascii 1.0\nelement a N\nend_header\n".into(),
        ),
        (
            Format::Ply,
            "ply\nformat binary_big_endian 1.0\nelement a N\nproperty int b\nend_header\n".into(),
        ),
        (Format::Off, "OFF\nN 1 0\n0 0 0\n".into()),
        (Format::Off, "OFF\n1 N 0\n0 0 0\n".into()),
        (Format::Off, "OFF\n1 1 0\n0 0 0\nN 0 0 0\n".into()),
        (Format::Xyz, "N\n0 0 0\n".into()),
        (Format::Pwn, "N\n0 0 0 0 0 1\n".into()),
        (
            Format::Pcd,
            "FIELDS x y z\nPOINTS N\nDATA ascii\n0 0 0\n".into(),
        ),
        (
            Format::Pcd,
            "FIELDS x y z\nPOINTS N\nDATA binary\n0 0 0\n".into(),
        ),
        (
            Format::Pcd,
            "FIELDS x y z\nWIDTH N\nHEIGHT N\nDATA binary\n0 0 0\n".into(),
        ),
        (
            Format::Pcd,
            "FIELDS x y z\nPOINTS N\nDATA binary_compressed\n0 0 00000000\n".into(),
        ),
        (Format::Obj, "v 0 0 0\nf N 1 1\n".into()),
    ] {
        // The last could be reserved, and would show.
        for count in [n, u64::from(u32::MAX) - 1, u64::MAX, 400_000_000] {
            survive(format, text.replace('N', &count.to_string()).as_bytes());
        }
    }
    check_peak();
}

/// What fuzzing found; the extension names the format.
#[test]
fn found_files_are_survived() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/malformed");
    let mut count = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if let Ok(format) = Format::from_path(&path) {
            survive(format, &std::fs::read(&path).unwrap());
            count += 1;
        }
    }
    assert!(count > 0);
}

/// Puts the seeds where `cargo fuzz` looks for them.
#[test]
#[ignore = "writes the corpus of the fuzz targets"]
fn write_corpus() {
    let corpus = Path::new(env!("CARGO_MANIFEST_DIR")).join("../fuzz/corpus");
    for (i, (format, bytes)) in seeds().iter().enumerate() {
        let target = match format {
            Format::Xyz | Format::Pts | Format::Pwn | Format::Csv => "table".into(),
            Format::Glb => "gltf".into(),
            other => other.to_string().to_lowercase(),
        };
        let folder = corpus.join(target);
        std::fs::create_dir_all(&folder).unwrap();
        std::fs::write(folder.join(format!("seed_{i}")), bytes).unwrap();
    }
}
