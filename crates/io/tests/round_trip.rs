//! What is written reads back: to the last bit where the format holds double precision, and otherwise within
//! the rounding that the report states.

use pellicle_geometry::{DVec3, PointCloud, VertexId};
use pellicle_io::{
    Data, Encoding, Error, Format, Note, Overwrite, ReadOptions, WriteOptions, read, read_mesh,
    read_points, write_mesh, write_points,
};
use pellicle_mesh::TriangleSoup;
use proptest::prelude::*;
use std::path::PathBuf;
use tempfile::TempDir;

const POINT_FORMATS: [Format; 7] = [
    Format::Ply,
    Format::Xyz,
    Format::Pts,
    Format::Csv,
    Format::Pcd,
    Format::Off,
    Format::Obj,
];
const DOUBLE_MESH_FORMATS: [Format; 3] = [Format::Ply, Format::Off, Format::Obj];
const ENCODINGS: [Encoding; 2] = [Encoding::Binary, Encoding::Text];

struct Place(TempDir);

impl Place {
    fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    fn file(&self, format: Format) -> PathBuf {
        self.0
            .path()
            .join(format!("data.{}", format.extensions()[0]))
    }
}

fn replacing(encoding: Encoding) -> WriteOptions<'static> {
    WriteOptions {
        overwrite: Overwrite::Replace,
        encoding,
        ..Default::default()
    }
}

fn bits(vectors: &[DVec3]) -> Vec<[u64; 3]> {
    vectors
        .iter()
        .map(|v| v.to_array().map(f64::to_bits))
        .collect()
}

/// Every finite number: any exponent, denormals, both zeros; and numbers as they occur.
fn coordinate() -> impl Strategy<Value = f64> {
    prop_oneof![
        any::<u64>()
            .prop_map(f64::from_bits)
            .prop_filter("finite", |v| v.is_finite()),
        4_000_000.0..5_000_000.0,
        -1.0..1.0,
        (-1000i32..1000).prop_map(f64::from),
        Just(-0.0),
        Just(f64::MIN_POSITIVE),
        Just(5e-324),
        Just(f64::MAX),
    ]
}

fn vector() -> impl Strategy<Value = DVec3> {
    [coordinate(), coordinate(), coordinate()].prop_map(DVec3::from_array)
}

fn unit() -> impl Strategy<Value = DVec3> {
    [-1.0..1.0, -1.0..1.0, 0.1..1.0].prop_map(|v| DVec3::from_array(v).normalize())
}

fn cloud(least: usize) -> impl Strategy<Value = (Vec<DVec3>, Option<Vec<DVec3>>)> {
    prop::collection::vec((vector(), unit()), least..40).prop_flat_map(|pairs| {
        let (positions, normals): (Vec<_>, Vec<_>) = pairs.into_iter().unzip();
        any::<bool>().prop_map(move |with| (positions.clone(), with.then(|| normals.clone())))
    })
}

/// A soup in which every vertex is used, as STL needs it.
fn soup(vector: impl Strategy<Value = DVec3>) -> impl Strategy<Value = (TriangleSoup, Vec<DVec3>)> {
    prop::collection::vec((vector, unit()), 3..30).prop_flat_map(|pairs| {
        let count = pairs.len() as u32;
        let corner = 0..count;
        prop::collection::vec([corner.clone(), corner.clone(), corner], 1..40).prop_map(
            move |triangles| {
                let (positions, normals): (Vec<_>, Vec<_>) = pairs.clone().into_iter().unzip();
                let triangles = triangles.into_iter().map(|t| t.map(VertexId)).collect();
                (
                    TriangleSoup {
                        positions,
                        triangles,
                    },
                    normals,
                )
            },
        )
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn points_come_back_to_the_last_bit((positions, normals) in cloud(1)) {
        let place = Place::new();
        let mut cloud = PointCloud::new(positions.clone()).unwrap();
        if let Some(normals) = &normals {
            cloud = cloud.with_normals(normals.clone()).unwrap();
        }
        for format in POINT_FORMATS {
            for encoding in ENCODINGS {
                let path = place.file(format);
                write_points(&path, &cloud, &replacing(encoding)).unwrap();
                let read = read_points(&path, &ReadOptions::default()).unwrap();
                prop_assert_eq!(bits(read.cloud.positions()), bits(&positions), "{}", format);
                let expected = normals.as_deref().filter(|_| format != Format::Pts).map(bits);
                prop_assert_eq!(read.cloud.normals().map(bits), expected, "{}", format);
            }
        }
        let path = place.file(Format::Pwn);
        let written = write_points(&path, &cloud, &replacing(Encoding::Text));
        if normals.is_some() {
            written.unwrap();
            prop_assert_eq!(read_points(&path, &ReadOptions::default()).unwrap().cloud, cloud);
        } else {
            let refused = matches!(written, Err(Error::CannotHold { .. }));
            prop_assert!(refused);
        }
    }

    #[test]
    fn meshes_come_back_to_the_last_bit((soup, normals) in soup(vector())) {
        let place = Place::new();
        for format in DOUBLE_MESH_FORMATS {
            for encoding in ENCODINGS {
                for normals in [None, Some(&normals[..])] {
                    let path = place.file(format);
                    write_mesh(&path, &soup, normals, &replacing(encoding)).unwrap();
                    let read = read_mesh(&path, &ReadOptions::default()).unwrap();
                    prop_assert_eq!(bits(&read.soup.positions), bits(&soup.positions));
                    prop_assert_eq!(&read.soup.triangles, &soup.triangles);
                    prop_assert_eq!(read.normals.as_deref().map(bits), normals.map(bits));
                }
            }
        }
    }

    /// A mesh of some metres, millions of metres away.
    #[test]
    fn single_precision_comes_back_within_the_stated_rounding(
        (soup, normals) in soup([0.0..50.0, 0.0..50.0, 0.0..50.0].prop_map(|v: [f64; 3]| {
            DVec3::from_array(v) + DVec3::new(689_000.25, 4_649_776.5, 120.0)
        }))
    ) {
        let place = Place::new();
        for format in [Format::Stl, Format::Glb] {
            let path = place.file(format);
            let report = write_mesh(&path, &soup, Some(&normals), &replacing(Encoding::Binary)).unwrap();
            let shift = report.shift().expect("far from the origin");
            let add = if format == Format::Stl { shift } else { DVec3::ZERO };
            let rounding = report.notes.iter().find_map(|note| match note {
                Note::Rounded { error } => Some(*error),
                _ => None,
            }).unwrap_or(0.0);
            // 25 metres in single precision, and half an ulp of double precision at the place.
            prop_assert!(rounding <= 25.0 * 2f64.powi(-24) + 1e-9, "{}", rounding);
            let read = read_mesh(&path, &ReadOptions::default()).unwrap();
            prop_assert_eq!(read.soup.triangles.len(), soup.triangles.len());
            for (ours, theirs) in soup.triangles.iter().zip(&read.soup.triangles) {
                for (a, b) in ours.iter().zip(theirs) {
                    let there = read.soup.positions[b.index()] + add;
                    let apart = (soup.positions[a.index()] - there).abs().max_element();
                    prop_assert!(apart <= rounding + 1e-9, "{} {}", apart, rounding);
                }
            }
        }
    }

    #[test]
    fn single_precision_positions_come_back_exactly(
        (soup, normals) in soup([-1e6f32..1e6, -1e3f32..1e3, -1.0f32..1.0].prop_map(|v| {
            DVec3::from_array(v.map(f64::from))
        }))
    ) {
        let place = Place::new();
        let path = place.file(Format::Glb);
        let report = write_mesh(&path, &soup, Some(&normals), &replacing(Encoding::Binary)).unwrap();
        prop_assert_eq!(report.notes, []);
        let read_back = read_mesh(&path, &ReadOptions::default()).unwrap();
        prop_assert_eq!(&read_back.soup, &soup);
        let single: Vec<DVec3> = normals.iter().map(|n| n.as_vec3().as_dvec3()).collect();
        prop_assert_eq!(read_back.normals, Some(single));

        let path = place.file(Format::Stl);
        write_mesh(&path, &soup, None, &replacing(Encoding::Binary)).unwrap();
        let read_back = read_mesh(&path, &ReadOptions::default()).unwrap();
        for (ours, theirs) in soup.triangles.iter().zip(&read_back.soup.triangles) {
            prop_assert_eq!(
                ours.map(|v| soup.positions[v.index()]),
                theirs.map(|v| read_back.soup.positions[v.index()])
            );
        }
    }
}

#[test]
fn a_cloud_of_no_points_round_trips_where_a_file_can_say_so() {
    let place = Place::new();
    let empty = PointCloud::default();
    for format in [Format::Ply, Format::Pcd, Format::Off] {
        let path = place.file(format);
        write_points(&path, &empty, &WriteOptions::default()).unwrap();
        assert_eq!(
            read_points(&path, &ReadOptions::default()).unwrap().cloud,
            empty
        );
    }
}

#[test]
fn a_mesh_without_triangles_reads_as_points() {
    let place = Place::new();
    let soup = TriangleSoup {
        positions: vec![DVec3::X, DVec3::Y],
        triangles: vec![],
    };
    for format in DOUBLE_MESH_FORMATS {
        let path = place.file(format);
        write_mesh(&path, &soup, None, &WriteOptions::default()).unwrap();
        let data = read(&path, &ReadOptions::default()).unwrap().data;
        assert!(matches!(data, Data::Points(cloud) if cloud.positions() == soup.positions));
        let error = read_mesh(&path, &ReadOptions::default()).unwrap_err();
        assert!(matches!(error, Error::NoTriangles { vertices: 2, .. }));
    }
}

/// UTM coordinates in metres with a nanometre at the end: one bit more or less would show.
#[test]
fn large_coordinates_keep_their_last_bit() {
    let place = Place::new();
    let utm = DVec3::new(
        689_012.345_678_901_2,
        4_649_776.224_681_012,
        1_234.567_890_123_4,
    );
    let cloud = PointCloud::new(vec![
        utm,
        DVec3::from_array(utm.to_array().map(f64::next_up)),
    ])
    .unwrap();
    for format in POINT_FORMATS {
        let path = place.file(format);
        write_points(&path, &cloud, &replacing(Encoding::Text)).unwrap();
        assert_eq!(
            read_points(&path, &ReadOptions::default()).unwrap().cloud,
            cloud,
            "{format}"
        );
    }
}
