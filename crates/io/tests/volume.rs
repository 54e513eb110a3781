//! Tetrahedra in files, read back by a reader of their own.

use pellicle_geometry::{DVec3, VertexId};
use pellicle_io::{Encoding, Error, Overwrite, VolumeFormat, WriteOptions, write_tetrahedra};
use std::path::Path;

type Volume = (Vec<[f64; 3]>, Vec<[u32; 4]>);

fn sample() -> (Vec<DVec3>, Vec<[VertexId; 4]>) {
    let positions = vec![
        DVec3::ZERO,
        DVec3::new(4_649_776.25, 1e-300, -0.1),
        DVec3::new(0.1 + 0.2, f64::MAX, f64::MIN_POSITIVE),
        DVec3::new(1e300, -1.0 / 3.0, 5e-324),
        DVec3::new(-0.0, 2.0, 3.0),
    ];
    let tets = vec![[0, 1, 2, 3], [4, 1, 3, 2]]
        .into_iter()
        .map(|t: [u32; 4]| t.map(VertexId));
    (positions, tets.collect())
}

fn write(path: &Path, encoding: Encoding) {
    let (positions, tets) = sample();
    let options = WriteOptions {
        encoding,
        ..WriteOptions::default()
    };
    let format = VolumeFormat::from_path(path).unwrap();
    let bytes = write_tetrahedra(path, format, &positions, &tets, &options).unwrap();
    assert_eq!(bytes, std::fs::metadata(path).unwrap().len());
}

fn read_medit(text: &str) -> Volume {
    let mut words = text.split_whitespace();
    let mut volume = Volume::default();
    let number =
        |words: &mut std::str::SplitWhitespace| words.next().unwrap().parse::<f64>().unwrap();
    while let Some(word) = words.next() {
        match word {
            "MeshVersionFormatted" | "Dimension" => drop(words.next()),
            "Vertices" => {
                for _ in 0..number(&mut words) as usize {
                    volume.0.push([0; 3].map(|_| number(&mut words)));
                    assert_eq!(words.next(), Some("0"));
                }
            }
            "Tetrahedra" => {
                for _ in 0..number(&mut words) as usize {
                    volume.1.push([0; 4].map(|_| number(&mut words) as u32 - 1));
                    assert_eq!(words.next(), Some("0"));
                }
            }
            "End" => assert_eq!(words.next(), None),
            other => panic!("{other}"),
        }
    }
    volume
}

fn read_vtk(bytes: &[u8]) -> Volume {
    let mut at = 0;
    let line = |at: &mut usize| loop {
        let end = bytes[*at..].iter().position(|&b| b == b'\n').unwrap() + *at;
        let line = std::str::from_utf8(&bytes[*at..end]).unwrap();
        *at = end + 1;
        if !line.is_empty() {
            return line;
        }
    };
    assert_eq!(line(&mut at), "# vtk DataFile Version 3.0");
    line(&mut at);
    let binary = line(&mut at) == "BINARY";
    assert_eq!(line(&mut at), "DATASET UNSTRUCTURED_GRID");
    let count =
        |line: &str, word: usize| -> usize { line.split(' ').nth(word).unwrap().parse().unwrap() };
    let mut volume = Volume::default();
    let points = count(line(&mut at), 1);
    for _ in 0..points {
        volume.0.push(if binary {
            let p = [0, 8, 16]
                .map(|i| f64::from_be_bytes(bytes[at + i..at + i + 8].try_into().unwrap()));
            at += 24;
            p
        } else {
            let mut words = line(&mut at).split(' ').map(|w| w.parse().unwrap());
            [0; 3].map(|_| words.next().unwrap())
        });
    }
    let header = line(&mut at);
    let cells = count(header, 1);
    assert_eq!(count(header, 2), 5 * cells);
    for _ in 0..cells {
        let cell: [u32; 5] = if binary {
            let cell = [0, 4, 8, 12, 16]
                .map(|i| u32::from_be_bytes(bytes[at + i..at + i + 4].try_into().unwrap()));
            at += 20;
            cell
        } else {
            let mut words = line(&mut at).split(' ').map(|w| w.parse().unwrap());
            [0; 5].map(|_| words.next().unwrap())
        };
        assert_eq!(cell[0], 4);
        volume.1.push([cell[1], cell[2], cell[3], cell[4]]);
    }
    assert_eq!(count(line(&mut at), 1), cells);
    for _ in 0..cells {
        let kind = if binary {
            at += 4;
            u32::from_be_bytes(bytes[at - 4..at].try_into().unwrap())
        } else {
            line(&mut at).parse().unwrap()
        };
        assert_eq!(kind, 10);
    }
    assert!(bytes[at..].iter().all(|&b| b == b'\n'));
    volume
}

#[test]
fn everything_survives_to_the_last_bit() {
    let directory = tempfile::tempdir().unwrap();
    let (positions, tets) = sample();
    let bits = |points: &[[f64; 3]]| {
        points
            .iter()
            .map(|p| p.map(f64::to_bits))
            .collect::<Vec<_>>()
    };
    let expected: Vec<[f64; 3]> = positions.iter().map(|p| p.to_array()).collect();
    for (name, encoding) in [
        ("a.vtk", Encoding::Binary),
        ("b.vtk", Encoding::Text),
        ("c.mesh", Encoding::Text),
    ] {
        let path = directory.path().join(name);
        write(&path, encoding);
        let bytes = std::fs::read(&path).unwrap();
        let (points, cells) = match VolumeFormat::from_path(&path).unwrap() {
            VolumeFormat::Vtk => read_vtk(&bytes),
            _ => read_medit(std::str::from_utf8(&bytes).unwrap()),
        };
        assert_eq!(bits(&points), bits(&expected), "{name}");
        let found: Vec<[VertexId; 4]> = cells.iter().map(|c| c.map(VertexId)).collect();
        assert_eq!(found, tets, "{name}");
    }
}

#[test]
fn nonsense_and_existing_files_are_refused() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("a.vtk");
    let (mut positions, tets) = sample();
    let options = WriteOptions::default();
    let write = |positions: &[DVec3], tets: &[[VertexId; 4]], options: &WriteOptions| {
        write_tetrahedra(&path, VolumeFormat::Vtk, positions, tets, options)
    };
    let refused = write(&positions, &[[0, 1, 2, 5].map(VertexId)], &options);
    assert!(matches!(
        refused,
        Err(Error::CornerOutOfRange {
            tetrahedron: 0,
            vertices: 5,
            ..
        })
    ));
    assert!(!path.exists());
    write(&positions, &tets, &options).unwrap();
    assert!(matches!(
        write(&positions, &tets, &options),
        Err(Error::Exists { .. })
    ));
    let replace = WriteOptions {
        overwrite: Overwrite::Replace,
        ..options
    };
    write(&positions, &tets, &replace).unwrap();
    positions[2].y = f64::NAN;
    let refused = write(&positions, &tets, &replace);
    assert!(matches!(
        refused,
        Err(Error::VertexNotFinite {
            vertex: VertexId(2),
            ..
        })
    ));
}
