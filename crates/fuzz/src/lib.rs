//! Bytes, read as a file of some format or as points: what the fuzz targets share.
#![forbid(unsafe_code)]

mod points;

pub use pellicle_io::Format;
use pellicle_io::{Data, ReadOptions, read_from};
pub use points::{check_dynamic, check_regular, check_tetrahedralize};
use std::io::Cursor;

/// Reads the bytes; an error is fine, a panic is not, and what is read must be sound.
pub fn read(format: Format, bytes: &[u8]) {
    let Ok(read) = read_from(Cursor::new(bytes), format, "fuzz", &ReadOptions::default()) else {
        return;
    };
    match read.data {
        Data::Points(cloud) => assert!(cloud.normals().is_none_or(|n| n.len() == cloud.len())),
        Data::Mesh { soup, normals } => {
            let vertices = soup.positions.len();
            assert!(soup.positions.iter().all(|p| p.is_finite()));
            assert!(normals.is_none_or(|n| n.len() == vertices));
            assert!(
                soup.triangles
                    .as_flattened()
                    .iter()
                    .all(|v| v.index() < vertices)
            );
        }
    }
}
