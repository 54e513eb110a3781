//! What other programs read from our files, and we from theirs: `tobj`, `gltf` and `las`.

use pellicle_geometry::{DVec3, VertexId};
use pellicle_io::{
    Data, Error, Format, Note, Overwrite, ReadOptions, WriteOptions, read, read_from, read_mesh,
    read_points, write_mesh,
};
use pellicle_mesh::TriangleSoup;
use std::io::Cursor;
use std::path::PathBuf;

fn fixture(name: &str) -> PathBuf {
    [env!("CARGO_MANIFEST_DIR"), "../../fixtures", name]
        .iter()
        .collect()
}

#[test]
fn tobj_reads_what_we_write() {
    let mesh = read_mesh(fixture("elephant.off"), &ReadOptions::default()).unwrap();
    let place = tempfile::tempdir().unwrap();
    let path = place.path().join("a.obj");
    write_mesh(&path, &mesh.soup, None, &WriteOptions::default()).unwrap();
    let (models, _) = tobj::load_obj(&path, &tobj::LoadOptions::default()).unwrap();
    let theirs = &models[0].mesh;
    assert_eq!(theirs.indices.len(), 3 * mesh.soup.triangles.len());
    // It numbers the vertices anew, in the order of their use.
    for (theirs_id, ours) in theirs
        .indices
        .iter()
        .zip(mesh.soup.triangles.as_flattened())
    {
        let at = 3 * *theirs_id as usize;
        let position = mesh.soup.positions[ours.index()];
        assert_eq!(theirs.positions[at..at + 3], position.to_array());
    }
}

#[test]
fn gltf_reads_what_we_write() {
    let mesh = read_mesh(fixture("elephant.off"), &ReadOptions::default()).unwrap();
    let normals: Vec<DVec3> = mesh.soup.positions.iter().map(|p| p.normalize()).collect();
    let place = tempfile::tempdir().unwrap();
    let path = place.path().join("a.glb");
    let moved = TriangleSoup {
        positions: mesh
            .soup
            .positions
            .iter()
            .map(|p| p + DVec3::splat(5e6))
            .collect(),
        ..mesh.soup.clone()
    };
    for soup in [&mesh.soup, &moved] {
        let options = WriteOptions {
            overwrite: Overwrite::Replace,
            ..Default::default()
        };
        let report = write_mesh(&path, soup, Some(&normals), &options).unwrap();
        let shift = report.shift().unwrap_or(DVec3::ZERO);
        let gltf = gltf::Gltf::open(&path).unwrap();
        let blob = gltf.blob.clone().unwrap();
        let node = gltf.default_scene().unwrap().nodes().next().unwrap();
        let translation = node.transform().decomposed().0.map(f64::from);
        assert_eq!(DVec3::from_array(translation), shift);
        let primitive = node.mesh().unwrap().primitives().next().unwrap();
        let reader = primitive.reader(|_| Some(&blob));
        let positions: Vec<[f32; 3]> = reader.read_positions().unwrap().collect();
        let local: Vec<[f32; 3]> = soup
            .positions
            .iter()
            .map(|&p| (p - shift).as_vec3().to_array())
            .collect();
        assert_eq!(positions, local);
        let theirs: Vec<[f32; 3]> = reader.read_normals().unwrap().collect();
        assert_eq!(theirs.len(), normals.len());
        let bounds = primitive.bounding_box();
        let extreme = |pick: fn(f32, f32) -> f32| {
            local
                .iter()
                .copied()
                .reduce(|a, b| [0, 1, 2].map(|i| pick(a[i], b[i])))
                .unwrap()
        };
        assert_eq!(
            (bounds.min, bounds.max),
            (extreme(f32::min), extreme(f32::max))
        );
        let indices: Vec<u32> = reader.read_indices().unwrap().into_u32().collect();
        let ours: Vec<u32> = soup.triangles.as_flattened().iter().map(|v| v.0).collect();
        assert_eq!(indices, ours);
    }
}

/// A scene with all that moves and indexes: checked against what the numbers say.
#[test]
fn gltf_scenes() {
    // Three points; bytes as indices 0 1 2 at 36; base64 of both.
    let points: [[f32; 3]; 3] = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let mut bytes: Vec<u8> = points
        .as_flattened()
        .iter()
        .flat_map(|v| v.to_le_bytes())
        .collect();
    bytes.extend([0u8, 1, 2, 0]);
    let place = tempfile::tempdir().unwrap();
    std::fs::write(place.path().join("a b.bin"), &bytes).unwrap();
    let json = |uri: &str, mode: u32, node: &str| {
        format!(
            r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],
            "nodes":[{{"children":[1],"translation":[4649776.224681,0,1e-3]}},{{"mesh":0{node}}}],
            "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0,"TEXCOORD_0":9}},"indices":1,"mode":{mode}}},
              {{"attributes":{{"POSITION":0}},"mode":1}}]}}],
            "accessors":[{{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}},
              {{"bufferView":1,"componentType":5121,"count":3,"type":"SCALAR"}}],
            "bufferViews":[{{"buffer":0,"byteLength":36}},{{"buffer":0,"byteOffset":36,"byteLength":3}}],
            "buffers":[{{"uri":"{uri}","byteLength":40}}]}}"#
        )
    };
    let data = format!(
        "data:application/octet-stream;base64,{}AAECAA==",
        // 36 bytes are 48 letters without a rest.
        "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"
    );
    let path = place.path().join("a.gltf");
    let x = 4_649_776.224_681;
    for uri in ["a%20b.bin", &data] {
        for (mode, node, expected, corners) in [
            (
                4,
                "",
                [[x, 0.0, 1e-3], [x + 1.0, 0.0, 1e-3], [x, 1.0, 1e-3]],
                vec![[0, 1, 2]],
            ),
            (
                5,
                "",
                [[x, 0.0, 1e-3], [x + 1.0, 0.0, 1e-3], [x, 1.0, 1e-3]],
                vec![[0, 1, 2]],
            ),
            (
                6,
                r#","scale":[1,2,-3]"#,
                [[x, 0.0, 1e-3], [x + 1.0, 0.0, 1e-3], [x, 2.0, 1e-3]],
                vec![[0, 2, 1]],
            ),
            (
                4,
                r#","matrix":[0,1,0,0,-1,0,0,0,0,0,1,0,0,0,7,1]"#,
                [[x, 0.0, 7.001], [x, 1.0, 7.001], [x - 1.0, 0.0, 7.001]],
                vec![[0, 1, 2]],
            ),
            (
                0,
                "",
                [[x, 0.0, 1e-3], [x + 1.0, 0.0, 1e-3], [x, 1.0, 1e-3]],
                vec![],
            ),
        ] {
            std::fs::write(&path, json(uri, mode, node)).unwrap();
            let read = read(&path, &ReadOptions::default()).unwrap_or_else(|e| panic!("{e}"));
            let (positions, triangles) = match read.data {
                Data::Points(cloud) => (cloud.into_parts().0, vec![]),
                Data::Mesh { soup, .. } => (soup.positions, soup.triangles),
            };
            assert_eq!(positions, expected.map(DVec3::from_array));
            let triangles: Vec<_> = triangles.iter().map(|t| t.map(|v| v.0)).collect();
            assert_eq!(triangles, corners);
            assert!(read.report.notes.contains(&Note::Transformed { nodes: 1 }));
        }
    }
    // A turn by a quaternion: x becomes y, within the rounding of the square root.
    std::fs::write(
        &path,
        json(
            &data,
            4,
            r#","rotation":[0,0,0.7071067811865476,0.7071067811865476]"#,
        ),
    )
    .unwrap();
    let turned = read_mesh(&path, &ReadOptions::default())
        .unwrap()
        .soup
        .positions;
    assert!((turned[1] - DVec3::new(x, 1.0, 1e-3)).length() < 1e-8);
}

#[test]
fn gltf_that_is_broken() {
    let part = |json: &str| format!(r#"{{"asset":{{"version":"2.0"}},{json}}}"#);
    let one = r#""meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}]"#;
    for (text, words) in [
        ("{".to_owned(), &["JSON", "line 1"][..]),
        (r#"{"asset":{"version":"1.0"}}"#.into(), &["version", "1.0"]),
        (
            part(r#""extensionsRequired":["KHR_draco_mesh_compression"]"#),
            &["KHR_draco", "without"],
        ),
        (
            part(r#""nodes":[{"children":[1]},{"children":[0]}],"scenes":[{"nodes":[0]}]"#),
            &["two parents"],
        ),
        (part(r#""nodes":[{"mesh":3}]"#), &["mesh 3"]),
        (part(one), &["accessor 0", "does not exist"]),
        (
            part(&format!(
                r#"{one},"accessors":[{{"componentType":5126,"count":3,"type":"VEC3","sparse":{{}}}}]"#
            )),
            &["sparse"],
        ),
        (
            part(&format!(
                r#"{one},"accessors":[{{"componentType":5126,"count":3,"type":"VEC2"}}]"#
            )),
            &["wrong type"],
        ),
        (
            part(&format!(
                r#"{one},"accessors":[{{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}}],
                "bufferViews":[{{"buffer":0,"byteLength":36}}],"buffers":[{{"uri":"data:;base64,AAAA","byteLength":3}}]"#
            )),
            &["beyond its buffer"],
        ),
        (
            part(&format!(
                r#"{one},"accessors":[{{"bufferView":0,"componentType":5126,"count":18446744073709551615,"type":"VEC3"}}],
                "bufferViews":[{{"buffer":0,"byteLength":18446744073709551615,"byteOffset":9}}],
                "buffers":[{{"uri":"data:;base64,AAAA","byteLength":3}}]"#
            )),
            &["beyond its buffer"],
        ),
        (
            part(r#""buffers":[{"uri":"data:;base64,AAAA","byteLength":4}]"#),
            &["3 bytes", "truncated"],
        ),
        (
            part(r#""buffers":[{"uri":"data:;base64,?","byteLength":1}]"#),
            &["base64"],
        ),
        (part(r#""buffers":[{"byteLength":1}]"#), &["neither"]),
        (
            part(r#""buffers":[{"uri":"../a","byteLength":1}]"#),
            &["directory"],
        ),
        (
            part(r#""buffers":[{"uri":"/etc/passwd","byteLength":1}]"#),
            &["directory"],
        ),
        (
            part(r#""buffers":[{"uri":"https://a/b","byteLength":1}]"#),
            &["directory"],
        ),
        (
            part(r#""buffers":[{"uri":"a.bin","byteLength":1}]"#),
            &["not opened here"],
        ),
    ] {
        let input = Cursor::new(text.clone());
        let error =
            read_from(input, Format::Gltf, "the.gltf", &ReadOptions::default()).expect_err(&text);
        assert!(matches!(error, Error::Malformed { .. }), "{error}");
        for word in words {
            assert!(error.to_string().contains(word), "{word:?} in {error}");
        }
    }
}

fn las_bytes(format: u8, compressed: bool, extra: u16, count: i32) -> Vec<u8> {
    let mut builder = las::Builder::from((1, 4));
    builder.point_format = las::point::Format::new(format).unwrap();
    builder.point_format.is_compressed = compressed;
    builder.point_format.extra_bytes = extra;
    let scaled = |offset| las::Transform {
        scale: 0.001,
        offset,
    };
    builder.transforms = las::Vector {
        x: scaled(689_000.0),
        y: scaled(4_649_776.0),
        z: scaled(-7.5),
    };
    let header = builder.into_header().unwrap();
    let mut writer = las::Writer::new(Cursor::new(Vec::new()), header).unwrap();
    for i in 0..count {
        let at = f64::from(i);
        let f = las::point::Format::new(format).unwrap();
        writer
            .write_point(las::Point {
                x: 689_000.0 + (at * 0.37) % 900.0,
                y: 4_649_776.0 + (at * at * 0.11) % 900.0,
                z: (at * 0.7) % 35.0 - 20.0,
                gps_time: f.has_gps_time.then_some(at),
                color: f.has_color.then(|| las::Color::new(i as u16, 7, 9)),
                nir: f.has_nir.then_some(3),
                waveform: f.has_waveform.then(Default::default),
                extra_bytes: vec![(i % 250) as u8; usize::from(extra)],
                ..Default::default()
            })
            .unwrap();
    }
    writer.close().unwrap();
    writer.into_inner().unwrap().into_inner()
}

/// Every point format, with and without compression, against the crate `las`.
#[test]
fn las_agrees_with_las() {
    for format in 0..=10 {
        for compressed in [false, true] {
            // The crate `las` does not compress wave packets of these formats.
            if compressed && [4, 5, 9, 10].contains(&format) {
                continue;
            }
            for extra in [0, 3] {
                let bytes = las_bytes(
                    format,
                    compressed,
                    extra,
                    60_000 * i32::from(format % 3 == 0) + 500,
                );
                let mut reader = las::Reader::new(Cursor::new(bytes.clone())).unwrap();
                let theirs: Vec<DVec3> = reader
                    .read_all()
                    .unwrap()
                    .points()
                    .map(|p| p.map(|p| DVec3::new(p.x, p.y, p.z)).unwrap())
                    .collect();
                let file_format = if compressed { Format::Laz } else { Format::Las };
                let ours = read_from(
                    Cursor::new(bytes),
                    file_format,
                    "a",
                    &ReadOptions::default(),
                )
                .unwrap_or_else(|e| panic!("{format} {compressed} {extra}: {e}"));
                let Data::Points(cloud) = ours.data else {
                    panic!()
                };
                assert!(cloud.positions() == theirs, "{format} {compressed} {extra}");
            }
        }
    }
}

#[test]
fn the_laz_fixture_agrees_with_las() {
    let path = fixture("pdal_autzen_trim.laz");
    let ours = read_points(&path, &ReadOptions::default()).unwrap().cloud;
    let mut reader = las::Reader::from_path(&path).unwrap();
    let theirs: Vec<DVec3> = reader
        .read_all()
        .unwrap()
        .points()
        .map(|p| p.map(|p| DVec3::new(p.x, p.y, p.z)).unwrap())
        .collect();
    assert!(ours.positions() == theirs);
}

#[test]
fn las_that_is_broken() {
    let sound = las_bytes(0, false, 0, 10);
    let laz = las_bytes(0, true, 0, 10);
    let with = |bytes: &[u8], at: usize, value: &[u8]| {
        let mut bytes = bytes.to_vec();
        bytes[at..at + value.len()].copy_from_slice(value);
        bytes
    };
    for (bytes, words) in [
        (sound[..100].to_vec(), &["header", "truncated"][..]),
        (with(&sound, 0, b"LASX"), &["LASF"]),
        (with(&sound, 94, &[5, 0]), &["header of 5 bytes"]),
        (with(&sound, 104, &[11]), &["point format 11"]),
        (with(&sound, 105, &[19, 0]), &["19 bytes", "20"]),
        (with(&sound, 96, &[255; 4]), &["cannot start"]),
        (
            with(&sound, 131, &f64::NAN.to_le_bytes()),
            &["vertex 0", "not finite"],
        ),
        (
            sound[..sound.len() - 1].to_vec(),
            &["10 points", "truncated"],
        ),
        (
            with(&laz, 247, &1_000_000_000u64.to_le_bytes()),
            &["cannot be in"],
        ),
        (with(&laz, 100, &[0; 4]), &["no record says how"]),
        (laz[..laz.len() - 9].to_vec(), &["chunk table"]),
    ] {
        let error = read_from(
            Cursor::new(bytes),
            Format::Las,
            "the.las",
            &ReadOptions::default(),
        )
        .expect_err(words[0]);
        for word in words {
            assert!(error.to_string().contains(word), "{word:?} in {error}");
        }
    }
    // As many points as no header can mean.
    let many = with(&sound, 247, &(1u64 << 60).to_le_bytes());
    let error =
        read_from(Cursor::new(many), Format::Las, "a", &ReadOptions::default()).unwrap_err();
    assert!(matches!(error, Error::TooMany { .. }), "{error}");
}

/// A triangle keeps its side through every format.
#[test]
fn orientation_survives() {
    let place = tempfile::tempdir().unwrap();
    let soup = TriangleSoup {
        positions: vec![DVec3::ZERO, DVec3::X, DVec3::Y],
        triangles: vec![[0, 1, 2].map(VertexId)],
    };
    for format in ["ply", "off", "obj", "stl", "glb"] {
        let path = place.path().join(format!("a.{format}"));
        write_mesh(&path, &soup, None, &WriteOptions::default()).unwrap();
        let back = read_mesh(&path, &ReadOptions::default()).unwrap().soup;
        let [a, b, c] = back.triangles[0].map(|v| back.positions[v.index()]);
        assert_eq!((b - a).cross(c - a), DVec3::Z, "{format}");
    }
    let stl = std::fs::read(place.path().join("a.stl")).unwrap();
    assert_eq!(stl[84..96], [0f32, 0.0, 1.0].map(f32::to_le_bytes).concat());
}
