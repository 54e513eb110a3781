//! What each reader understands, and what it says when it does not.

use pellicle_geometry::DVec3;
use pellicle_io::{Data, Error, Format, Location, Note, Read, ReadOptions, read_from};
use std::io::Cursor;

fn try_read(format: Format, bytes: impl Into<Vec<u8>>) -> Result<Read, Error> {
    let input = Cursor::new(bytes.into());
    read_from(input, format, "the.file", &ReadOptions::default())
}

/// Positions, normals if any, triangles.
type Parts = (Vec<[f64; 3]>, Option<Vec<[f64; 3]>>, Vec<[u32; 3]>);

fn parts(read: &Read) -> Parts {
    let arrays = |v: &[DVec3]| v.iter().map(|v| v.to_array()).collect::<Vec<_>>();
    match &read.data {
        Data::Points(cloud) => (
            arrays(cloud.positions()),
            cloud.normals().map(arrays),
            vec![],
        ),
        Data::Mesh { soup, normals } => (
            arrays(&soup.positions),
            normals.as_deref().map(arrays),
            soup.triangles.iter().map(|t| t.map(|v| v.0)).collect(),
        ),
    }
}

#[track_caller]
fn check(format: Format, bytes: impl Into<Vec<u8>>, expected: Parts, notes: &[Note]) {
    let read = try_read(format, bytes).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(parts(&read), expected);
    assert_eq!(read.report.notes, notes);
}

/// The message must hold all of `words`; the place must be `location`.
#[track_caller]
fn check_error(format: Format, bytes: impl Into<Vec<u8>>, location: Location, words: &[&str]) {
    let error = try_read(format, bytes).expect_err("this must not read");
    let message = error.to_string();
    let found = match error {
        Error::Malformed { location, .. } | Error::NotFinite { location, .. } => location,
        other => panic!("{other}"),
    };
    assert_eq!(found, location, "{message}");
    assert!(message.starts_with("the.file: "), "{message}");
    for word in words {
        assert!(message.contains(word), "{word:?} in {message:?}");
    }
}

const A: [f64; 3] = [1.0, 2.0, 3.0];
const B: [f64; 3] = [4.0, 5.0, 6.5];
const UP: [f64; 3] = [0.0, 0.0, 1.0];
const DOWN: [f64; 3] = [0.0, 0.0, -1.0];

fn ignored(what: &str, count: u64) -> Note {
    Note::Ignored {
        what: what.into(),
        count,
    }
}

#[test]
fn tables_in_their_many_shapes() {
    let two = (vec![A, B], None, vec![]);
    let with_normals = (vec![A, B], Some(vec![UP, DOWN]), vec![]);
    for (format, text) in [
        (Format::Xyz, "1 2 3\n4 5 6.5\n"),
        (Format::Xyz, "1 2 3\r\n4 5 6.5\r\n"),
        (Format::Xyz, "1 2 3\r4 5 6.5\r"),
        (Format::Xyz, "\u{feff}1 2 3\n4 5 6.5"),
        (Format::Xyz, "# a\n// b\n\n  1\t2  3 # c\n4 5 +6.5e0\n\n"),
        (Format::Xyz, "2\n1 2 3\n4 5 6.5\n"),
        (Format::Xyz, "1,2,3\n4, 5, 6.5\n"),
        (Format::Pts, "2\n1 2 3\n4 5 6.5\n"),
        (Format::Pts, "1\n1 2 3\n1\n4 5 6.5\n"),
        (Format::Pwn, "2\n1 2 3\n4 5 6.5\n"),
        (Format::Csv, "x,y,z\n1,2,3\n4,5,6.5\n"),
        (Format::Csv, "\"X\";\"Y\";\"Z\"\n1,0;2,0;3,0\n4;5;6,5\n"),
        (Format::Csv, "z,y,x\n3,2,1\n6.5,5,4\n"),
        (
            Format::Csv,
            "Easting [m]\tNorthing [m]\tHeight [m]\n1\t2\t3\n4\t5\t6.5\n",
        ),
        (Format::Csv, "//X Y Z\n2\n1 2 3\n4 5 6.5\n"),
    ] {
        let read = try_read(format, text).unwrap_or_else(|e| panic!("{text:?}: {e}"));
        assert_eq!(parts(&read), two, "{text:?}");
    }
    for (format, text) in [
        (Format::Xyz, "1 2 3 0 0 1\n4 5 6.5 0 0 -1\n"),
        (Format::Pwn, "2\n1 2 3 0 0 1\n4 5 6.5 0 0 -1\n"),
        (Format::Pwn, "2\n1 2 3\n4 5 6.5\n0 0 1\n0 0 -1\n"),
        (Format::Csv, "nx,ny,nz,x,y,z\n0,0,1,1,2,3\n0,0,-1,4,5,6.5\n"),
        (
            Format::Csv,
            "x,y,z,name,nx,ny,nz\n1,2,3,,0,0,1\n4,5,6.5,b,0,0,-1\n",
        ),
    ] {
        let read = try_read(format, text).unwrap_or_else(|e| panic!("{text:?}: {e}"));
        assert_eq!(parts(&read), with_normals, "{text:?}");
    }
    check(
        Format::Pts,
        "2\n1 2 3 9 255 0 7\n4 5 6.5 9 255 0 7\n",
        two.clone(),
        &[ignored("columns other than position and normal", 4)],
    );
    check(
        Format::Xyz,
        "1 2 3 255 0 7\n4 5 6.5 128 0 0\n",
        two,
        &[Note::NormalsDropped {
            why: "columns 4 to 6 hold whole numbers up to 255, as colours do",
        }],
    );
}

#[test]
fn tables_that_are_broken() {
    let line = Location::Line;
    for (format, text, place, words) in [
        (
            Format::Xyz,
            "1 2 3\n4 5 x\n",
            line(2),
            &["\"x\"", "column 3"][..],
        ),
        (Format::Xyz, "1 2 3\n4 5\n", line(2), &["2 columns"]),
        (Format::Xyz, "1 2\n", line(1), &["2 columns", "three"]),
        (
            Format::Xyz,
            "1 2 3\n\n1 nan 3\n",
            line(3),
            &["not finite", "vertex 1"],
        ),
        (Format::Xyz, "1 2 3\n1 2 -inf\n", line(2), &["not finite"]),
        (
            Format::Xyz,
            "1e999 2 3\n",
            line(1),
            &["not finite", "vertex 0"],
        ),
        (Format::Xyz, "# only\n", Location::File, &["no point"]),
        (Format::Xyz, "", Location::File, &["empty"]),
        (Format::Csv, "a,b,c\n1,2,3\n", line(1), &["x, y and z"]),
        (Format::Xyz, "\u{7f}ELF\n", line(1), &["neither"]),
        (Format::Xyz, "1\n1 2 3\n4 5 6\n", line(3), &["one more"]),
        (
            Format::Pts,
            "3\n1 2 3\n",
            Location::Byte(8),
            &["point 1 of the 3"],
        ),
        (
            Format::Pwn,
            "2\n1 2 3\n4 5 6\n0 0 1\n",
            Location::Byte(20),
            &["truncated"],
        ),
    ] {
        check_error(format, text, place, words);
    }
}

#[test]
fn off_in_its_many_shapes() {
    let triangle = (
        vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
        None,
        vec![[0, 1, 2]],
    );
    for text in [
        "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
        "OFF 3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2",
        "3 1\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
        "OFF # c\n# c\n\n3 1 0\n\n0 0 0 # c\n1 0\n0\n0 1 0\n3 0\n1 2 255 0 0\n",
    ] {
        check(Format::Off, text, triangle.clone(), &[]);
    }
    check(
        Format::Off,
        "COFF\n3 1 0\n0 0 0 255 0 0 255\n1 0 0 0.5 0 0 1\n0 1 0 0 0 0 1\n3 0 1 2\n",
        triangle.clone(),
        &[ignored("kinds of further columns of the vertices", 1)],
    );
    check(
        Format::Off,
        "STCNOFF\n3 1 0\n0 0 0 0 0 1 9 9\n1 0 0 0 0 1 9 9\n0 1 0 0 0 -1 9 9\n3 2 1 0\n",
        (
            triangle.0.clone(),
            Some(vec![UP, UP, DOWN]),
            vec![[2, 1, 0]],
        ),
        &[ignored("kinds of further columns of the vertices", 1)],
    );
    check(
        Format::Off,
        "OFF\n5 3 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n-1 0 0\n5 0 1 2 3 4\n2 0 1\n3 0 1 2\n",
        (
            vec![
                [0.0; 3],
                [1.0, 0.0, 0.0],
                [1.0, 1.0, 0.0],
                [0.0, 1.0, 0.0],
                [-1.0, 0.0, 0.0],
            ],
            None,
            vec![[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 1, 2]],
        ),
        &[
            Note::Triangulated { polygons: 1 },
            ignored("polygons with fewer than three corners", 1),
        ],
    );
    let line = Location::Line;
    for (text, place, words) in [
        ("OFF BINARY\n", line(1), &["binary OFF", "convert"][..]),
        ("4OFF\n1 0 0\n", line(1), &["dimensions"]),
        ("solid\n", line(1), &["no OFF file"]),
        ("OFF\n3\n", line(2), &["counts"]),
        (
            "OFF\n1 1 0\n0 0 0\n3 0 0 1\n",
            line(4),
            &["corner 1 of face 0", "1 vertices"],
        ),
        ("OFF\n1 1 0\n0 0 0\n3 0 0 -1\n", line(4), &["\"-1\""]),
        (
            "OFF\n2 0 0\n0 0 0\n0 NaN 0\n",
            line(4),
            &["vertex 1", "not finite"],
        ),
        (
            "OFF\n9 0 0\n0 0 0\n",
            Location::Byte(16),
            &["vertex 1 of 9", "truncated"],
        ),
        ("OFF\n1 2 0\n0 0 0\n", Location::Byte(16), &["face 0 of 2"]),
    ] {
        check_error(Format::Off, text, place, words);
    }
}

#[test]
fn obj_in_its_many_shapes() {
    let square = vec![[0.0; 3], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    let v = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
    for faces in [
        "f 1 2 3 4",
        "f 1/1 2/2 3/3 4/4",
        "f -4 -3 \\\n -2 -1",
        "o a\ng b\ns 1\nusemtl c\nf 1//1 2//1 3//1 4//1 # c",
    ] {
        check(
            Format::Obj,
            format!("mtllib a\n{v}{faces}\n"),
            (square.clone(), None, vec![[0, 1, 2], [0, 2, 3]]),
            &[Note::Triangulated { polygons: 1 }],
        );
    }
    check(
        Format::Obj,
        format!("{v}vt 0 0\nl 1 2\np 1\nv 9 9 9 0.5 0.5 0.5\n"),
        ([square.clone(), vec![[9.0; 3]]].concat(), None, vec![]),
        &[
            ignored("colours or weights of vertices", 1),
            ignored("texture coordinates", 1),
            ignored("polylines and point elements", 2),
        ],
    );
    check(
        Format::Obj,
        "f 1//1 2//2 3//3\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nvn 0 0 1\nvn 0 0 -1\n",
        (
            vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
            Some(vec![UP, UP, DOWN]),
            vec![[0, 1, 2]],
        ),
        &[],
    );
    check(
        Format::Obj,
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nf 1//1 2//1 3//1\n",
        (
            vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
            None,
            vec![[0, 1, 2]],
        ),
        &[Note::NormalsDropped {
            why: "they are not one a vertex",
        }],
    );
    let line = Location::Line;
    for (text, place, words) in [
        (
            "v 0 0 0\nf 1 2 1\nv 0 0\n",
            line(3),
            &["fewer than three"][..],
        ),
        ("v 0 0 0\nf 1 2 1\n", line(2), &["corner 2", "1 vertices"]),
        ("v 0 0 0\nf 0 1 1\n", line(2), &["\"0\""]),
        ("v 0 0 0\nf -2 1 1\n", line(2), &["\"-2\""]),
        ("v 0 0 x\n", line(1), &["\"x\"", "vertex 0"]),
        ("v 0 0 inf\n", line(1), &["not finite"]),
        ("hello\n", Location::File, &["no line"]),
        ("v 0 0 0\n\u{1}\u{2}\n", line(2), &["no OBJ"]),
    ] {
        check_error(Format::Obj, text, place, words);
    }
}

fn binary_stl(triangles: &[[[f32; 3]; 3]], header: &[u8]) -> Vec<u8> {
    let mut bytes = header.to_vec();
    bytes.resize(80, b' ');
    bytes.extend((triangles.len() as u32).to_le_bytes());
    for corners in triangles {
        bytes.extend([0; 12]);
        for coordinate in corners.as_flattened() {
            bytes.extend(coordinate.to_le_bytes());
        }
        bytes.extend([0, 0]);
    }
    bytes
}

#[test]
fn stl_of_both_kinds() {
    let [o, x, y, z]: [[f32; 3]; 4] =
        [[0.0; 3], [1.0, 0.0, -0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 0.1]];
    let tent = [[o, x, y], [o, y, z]];
    let expected = (
        vec![
            [0.0; 3],
            [1.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [0.0, 0.0, f64::from(0.1f32)],
        ],
        None,
        vec![[0, 1, 2], [0, 2, 3]],
    );
    let merged = Note::Merged {
        corners: 6,
        vertices: 4,
    };
    // Many programs begin the header of a binary file with the word that marks text.
    for header in [&b"binary"[..], b"solid trap", b"solid"] {
        check(
            Format::Stl,
            binary_stl(&tent, header),
            expected.clone(),
            std::slice::from_ref(&merged),
        );
    }
    let mut longer = binary_stl(&tent, b"more");
    longer.extend([7; 9]);
    check(
        Format::Stl,
        longer,
        expected.clone(),
        &[ignored("bytes after the last triangle", 9), merged.clone()],
    );
    let facet = |t: &[[f32; 3]; 3]| {
        let vertex = |v: &[f32; 3]| format!("   VERTEX {:e} {} {}\n", v[0], v[1], v[2]);
        let vertices: String = t.iter().map(vertex).collect();
        format!("facet normal 0 0 1\n outer loop\n{vertices} endloop\nendfacet\n")
    };
    let text: String = tent.iter().map(facet).collect();
    let mut from_text = expected;
    from_text.0[3] = [0.0, 0.0, 0.1];
    check(
        Format::Stl,
        format!("solid a b\n{text}endsolid a b\n"),
        from_text,
        &[merged],
    );
    let cut = binary_stl(&tent, b"cut");
    check_error(
        Format::Stl,
        &cut[..cut.len() - 1],
        Location::Byte(80),
        &["2 triangles", "184", "183", "truncated"],
    );
    check_error(Format::Stl, "x", Location::File, &["1 bytes"]);
    check_error(
        Format::Stl,
        binary_stl(&[[o, x, [0.0, f32::NAN, 0.0]]], b"nan"),
        Location::Byte(84),
        &["not finite"],
    );
    for (text, place, words) in [
        (
            "solid\nvertex 0 0 0\nvertex 0 0 0\nendloop\n",
            Location::Line(4),
            &["2 vertices"][..],
        ),
        ("solid\nvertex 0 0\n", Location::Line(2), &["coordinate"]),
        (
            "solid\nfacet normal 0 0 1\n",
            Location::Byte(25),
            &["truncated"],
        ),
        ("solid\nfase\n", Location::Line(2), &["\"fase\""]),
        (
            "solid\nvertex 0 0 0\nvertex 0 0 0\nvertex 0 0 0\nvertex 0 0 0\n",
            Location::Line(5),
            &["more than three"],
        ),
    ] {
        check_error(Format::Stl, text, place, words);
    }
}

/// A header, and the values of one vertex with all types and a list before a face: in both byte orders.
#[test]
fn ply_with_everything_in_between() {
    let header = |format: &str| {
        format!(
            "ply\nformat {format} 1.0\ncomment c\nobj_info o\nelement junk 2\nproperty list uchar short l\n\
             property int i\nelement empty 7\nelement vertex 3\nproperty uchar red\nproperty double y\n\
             property float x\nproperty short z\nproperty list ushort char w\nelement face 1\n\
             property uint id\nproperty list int ushort vertex_index\nproperty double area\nend_header\n"
        )
    };
    let expected = (
        vec![[0.5, 0.1, -2.0], [1.5, 0.1, -2.0], [0.5, 1.1, 3.0]],
        None,
        vec![[0, 1, 2]],
    );
    let notes = [
        ignored("elements \"junk\"", 2),
        ignored("elements \"empty\"", 7),
    ];
    let text =
        "2 7 8 9\n0 -5\n1 0.1 0.5 -2 0\n2 0.1 1.5 -2 2 1 1\n3 1.1 0.5 3 0\n99 3 0 1 2 0.25\n";
    let ascii = header("ascii") + text;
    check(
        Format::Ply,
        ascii.replace('\n', "\r\n"),
        expected.clone(),
        &notes,
    );
    check(Format::Ply, ascii, expected.clone(), &notes);

    for (name, big) in [("binary_little_endian", false), ("binary_big_endian", true)] {
        let mut bytes = header(name).into_bytes();
        let mut put = |raw: &[u8]| {
            let mut raw = raw.to_vec();
            if big {
                raw.reverse();
            }
            bytes.extend(raw);
        };
        put(&[2]);
        put(&7i16.to_le_bytes());
        put(&8i16.to_le_bytes());
        put(&9i32.to_le_bytes());
        put(&[0]);
        put(&(-5i32).to_le_bytes());
        for (y, x, z, list) in [
            (0.1f64, 0.5f32, -2i16, 0u16),
            (0.1, 1.5, -2, 2),
            (1.1, 0.5, 3, 0),
        ] {
            put(&[200]);
            put(&y.to_le_bytes());
            put(&x.to_le_bytes());
            put(&z.to_le_bytes());
            put(&list.to_le_bytes());
            for _ in 0..list {
                put(&[1]);
            }
        }
        put(&99u32.to_le_bytes());
        put(&3i32.to_le_bytes());
        for corner in 0u16..3 {
            put(&corner.to_le_bytes());
        }
        put(&0.25f64.to_le_bytes());
        check(Format::Ply, bytes.clone(), expected.clone(), &notes);
        let length = bytes.len() as u64;
        bytes.pop();
        check_error(
            Format::Ply,
            bytes,
            Location::Byte(length - 8),
            &["the last of 1 elements \"face\"", "truncated"],
        );
    }
}

#[test]
fn ply_strips() {
    let text = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
                element tristrips 1\nproperty list int int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n\
                8 0 1 2 3 -1 3 2 1\n";
    let read = try_read(Format::Ply, text).unwrap();
    assert_eq!(parts(&read).2, [[0, 1, 2], [2, 1, 3], [3, 2, 1]]);
    assert_eq!(read.report.notes, [Note::Strips { strips: 2 }]);
}

#[test]
fn ply_that_is_broken() {
    let vertex = "element vertex 1\nproperty float x\nproperty float y\nproperty float z\n";
    let ascii = "ply\nformat ascii 1.0\n";
    let line = Location::Line;
    for (text, place, words) in [
        ("plx\n".to_owned(), line(1), &["\"plx\"", "no PLY"][..]),
        (
            "ply\nformat ascii\n".into(),
            Location::Byte(17),
            &["end_header", "truncated"],
        ),
        ("ply\nformat text 1.0\n".into(), line(2), &["\"text\""]),
        ("ply\nelement vertex -1\n".into(), line(2), &["count"]),
        (
            "ply\nproperty float x\n".into(),
            line(2),
            &["before any element"],
        ),
        (
            format!("{ascii}{vertex}property list float int w\n"),
            line(7),
            &["property list"],
        ),
        (
            format!("{ascii}{vertex}property quad w\n"),
            line(7),
            &["property"],
        ),
        (format!("{ascii}elemnt\n"), line(3), &["keyword"]),
        (
            format!("ply\n{vertex}end_header\n0 0 0\n"),
            line(6),
            &["format line"],
        ),
        (
            format!("{ascii}{vertex}{vertex}end_header\n"),
            line(11),
            &["vertex twice"],
        ),
        (
            format!("{ascii}{vertex}end_header\n0 0\n"),
            Location::Byte(104),
            &["truncated"],
        ),
        (
            format!("{ascii}{vertex}end_header\n0 0 0 0\n"),
            line(8),
            &["more values"],
        ),
        (
            format!("{ascii}{vertex}end_header\n0 o 0\n"),
            line(8),
            &["\"o\""],
        ),
        (
            format!("{ascii}{vertex}end_header\n0 nan 0\n"),
            line(8),
            &["vertex 0", "not finite"],
        ),
        (
            format!(
                "{ascii}element vertex 1\nproperty float x\nproperty float y\nend_header\n0 0\n"
            ),
            Location::Byte(83),
            &["lack", "x, y or z"],
        ),
        (
            format!(
                "{ascii}{vertex}element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n3 0 0 1\n"
            ),
            line(11),
            &["corner 1", "1 vertices"],
        ),
        (
            format!(
                "{ascii}{vertex}element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n999 0 0\n"
            ),
            line(11),
            &["999 items"],
        ),
        (
            format!("{ascii}{vertex}element face 1\nproperty int n\nend_header\n0 0 0\n1\n"),
            Location::Byte(136),
            &["vertex_indices"],
        ),
    ] {
        check_error(Format::Ply, text, place, words);
    }
}

fn pcd(fields: &str, size: &str, kind: &str, count: &str, points: u64, data: &str) -> Vec<u8> {
    format!(
        "# .PCD v0.7\nVERSION 0.7\nFIELDS {fields}\nSIZE {size}\nTYPE {kind}\nCOUNT {count}\nWIDTH {points}\n\
         HEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {points}\nDATA {data}\n"
    )
    .into_bytes()
}

/// Compresses with literal runs, and with a long copy where bytes repeat.
fn lzf(bytes: &[u8]) -> Vec<u8> {
    let mut out = Vec::new();
    let mut at = 0;
    while at < bytes.len() {
        let run = bytes[at..].iter().take_while(|&&b| b == bytes[at]).count();
        if at > 0 && bytes[at - 1] == bytes[at] && run >= 3 {
            let length = run.min(264);
            if length < 9 {
                out.extend([((length - 2) as u8) << 5, 0]);
            } else {
                out.extend([7 << 5, (length - 9) as u8, 0]);
            }
            at += length;
        } else {
            out.extend([0, bytes[at]]);
            at += 1;
        }
    }
    out
}

#[test]
fn pcd_in_all_encodings() {
    // z is an integer, y comes first, a field of three values and one of bytes lie between.
    let nan = f64::NAN;
    let points: Vec<(f64, i16, f32)> = vec![
        (0.1, -3, 0.5),
        (nan, 0, 0.25),
        (4_649_776.224_681, 32_000, 0.125),
    ];
    let fields = ("y h z rgb x", "8 4 2 1 4", "F F I U F", "1 3 1 2 1");
    let expected = (
        vec![
            [0.5, 0.1, -3.0],
            [f64::from(0.125f32), 4_649_776.224_681, 32_000.0],
        ],
        None,
        vec![],
    );
    let (f, s, t, c) = fields;
    let n = points.len() as u64;
    // NaN in one coordinate only is an error; here the middle point goes.
    let error = |bytes: Vec<u8>| {
        let error = try_read(Format::Pcd, bytes).unwrap_err();
        assert!(
            matches!(error, Error::NotFinite { vertex: 1, .. }),
            "{error}"
        );
    };
    let sound: Vec<_> = points.iter().filter(|p| p.0.is_finite()).copied().collect();
    let text = |points: &[(f64, i16, f32)]| {
        let mut bytes = pcd(f, s, t, c, points.len() as u64, "ascii");
        for (y, z, x) in points {
            bytes.extend(format!("{y} 7 8 9 {z} 1 2 {x}\n").bytes());
        }
        bytes
    };
    let binary = |points: &[(f64, i16, f32)]| {
        let mut bytes = pcd(f, s, t, c, points.len() as u64, "binary");
        for (y, z, x) in points {
            bytes.extend(y.to_le_bytes());
            bytes.extend([9; 12]);
            bytes.extend(z.to_le_bytes());
            bytes.extend([1; 2]);
            bytes.extend(x.to_le_bytes());
        }
        bytes
    };
    let compressed = |points: &[(f64, i16, f32)]| {
        let mut raw = Vec::new();
        raw.extend(points.iter().flat_map(|p| p.0.to_le_bytes()));
        raw.extend(vec![9; 12 * points.len()]);
        raw.extend(points.iter().flat_map(|p| p.1.to_le_bytes()));
        raw.extend(vec![1; 2 * points.len()]);
        raw.extend(points.iter().flat_map(|p| p.2.to_le_bytes()));
        let packed = lzf(&raw);
        let mut bytes = pcd(f, s, t, c, points.len() as u64, "binary_compressed");
        bytes.extend((packed.len() as u32).to_le_bytes());
        bytes.extend((raw.len() as u32).to_le_bytes());
        bytes.extend(packed);
        bytes
    };
    let notes = [ignored("fields other than position and normal", 2)];
    check(Format::Pcd, text(&sound), expected.clone(), &notes);
    check(Format::Pcd, binary(&sound), expected.clone(), &notes);
    check(Format::Pcd, compressed(&sound), expected, &notes);
    assert_eq!(n, 3);
    error(text(&points));
    error(binary(&points));
    error(compressed(&points));
}

#[test]
fn pcd_leaves_out_what_the_sensor_did_not_see() {
    let mut ascii = pcd("x y z", "4 4 4", "F F F", "1 1 1", 3, "ascii");
    ascii.extend(b"nan nan nan\n1 2 3\nnan nan nan\n");
    check(
        Format::Pcd,
        ascii,
        (vec![A], None, vec![]),
        &[Note::Missing { points: 2 }],
    );
    // The same in records of a field each.
    let columns = [
        f32::NAN,
        1.0,
        f32::NAN,
        2.0,
        f32::NAN,
        3.0,
        0.0,
        0.0,
        0.0,
        0.0,
        0.0,
        1.0,
    ];
    let raw: Vec<u8> = columns.iter().flat_map(|v| v.to_le_bytes()).collect();
    let packed = lzf(&raw);
    let names = "x y z normal_x normal_y normal_z";
    let mut bytes = pcd(
        names,
        "4 4 4 4 4 4",
        "F F F F F F",
        "1 1 1 1 1 1",
        2,
        "binary_compressed",
    );
    bytes.extend((packed.len() as u32).to_le_bytes());
    bytes.extend((raw.len() as u32).to_le_bytes());
    bytes.extend(packed);
    check(
        Format::Pcd,
        bytes,
        (vec![A], Some(vec![UP]), vec![]),
        &[Note::Missing { points: 1 }],
    );
}

#[test]
fn pcd_that_is_broken() {
    let xyz = |points, data| pcd("x y z", "4 4 4", "F F F", "1 1 1", points, data);
    let with = |mut bytes: Vec<u8>, more: &[u8]| {
        bytes.extend(more);
        bytes
    };
    let end = |bytes: &[u8]| Location::Byte(bytes.len() as u64);
    for (bytes, place, words) in [
        (
            b"VERSION .7\n".to_vec(),
            Location::Byte(11),
            &["DATA", "truncated"][..],
        ),
        (b"hello\n".to_vec(), Location::Line(1), &["\"hello\""]),
        (
            b"FIELDS x y z\nSIZE 4 4\n".to_vec(),
            Location::Line(2),
            &["2 values", "3 names"],
        ),
        (
            b"FIELDS x\nSIZE 3\n".to_vec(),
            Location::Line(2),
            &["\"3\""],
        ),
        (
            b"FIELDS x\nSIZE 1\nPOINTS 1\nDATA ascii\n".to_vec(),
            Location::Line(4),
            &["\"x\"", "float of 1 bytes"],
        ),
        (
            pcd("x y", "4 4", "F F", "1 1", 1, "ascii"),
            Location::Line(11),
            &["x, y and z"],
        ),
        (
            b"FIELDS x y z\nWIDTH 3\nHEIGHT 2\nPOINTS 5\nDATA ascii\n".to_vec(),
            Location::Line(5),
            &["5 points", "6"],
        ),
        (
            with(xyz(2, "ascii"), b"1 2 3\n"),
            end(&with(xyz(2, "ascii"), b"1 2 3\n")),
            &["point 1 of 2"],
        ),
        (
            with(xyz(1, "ascii"), b"1 2\n"),
            Location::Line(12),
            &["\"z\""],
        ),
        (
            with(xyz(1, "binary"), &[0; 11]),
            end(&xyz(1, "binary")),
            &["1 points", "truncated"],
        ),
        (
            with(xyz(1, "binary_compressed"), &[3, 0, 0, 0, 11, 0, 0, 0]),
            end(&xyz(1, "binary_compressed")),
            &["11 bytes", "12"],
        ),
        (
            // A copy from before the start.
            with(
                xyz(1, "binary_compressed"),
                &[2, 0, 0, 0, 12, 0, 0, 0, 0x20, 5],
            ),
            end(&with(xyz(1, "binary_compressed"), &[0; 10])),
            &["before their start"],
        ),
    ] {
        check_error(Format::Pcd, bytes, place, words);
    }
}

#[test]
fn unknown_extensions_list_the_known() {
    let message = Format::from_path("scan.e57").unwrap_err().to_string();
    for word in ["scan.e57", "\"e57\"", "ply", "laz", "glb", "xyzn"] {
        assert!(message.contains(word), "{message}");
    }
}
