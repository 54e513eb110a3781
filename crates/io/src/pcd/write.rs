//! Double precision, as text or records.

use crate::sink::Sink;
use crate::text::put_triple;
use crate::{Encoding, Error};
use pellicle_geometry::DVec3;

pub(crate) fn write(
    sink: &mut Sink,
    positions: &[DVec3],
    normals: Option<&[DVec3]>,
    encoding: Encoding,
) -> Result<(), Error> {
    let (names, columns) = match normals {
        Some(_) => ("x y z normal_x normal_y normal_z", 6),
        None => ("x y z", 3),
    };
    let each = |value: &str| vec![value; columns].join(" ");
    let data = match encoding {
        Encoding::Binary => "binary",
        Encoding::Text => "ascii",
    };
    let count = positions.len();
    let header = format!(
        "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS {names}\nSIZE {}\nTYPE {}\nCOUNT {}\n\
         WIDTH {count}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {count}\nDATA {data}\n",
        each("8"),
        each("F"),
        each("1"),
    );
    sink.put(header.as_bytes())?;
    let mut buffer = Vec::new();
    for (i, &position) in positions.iter().enumerate() {
        buffer.clear();
        let normal = normals.map(|normals| normals[i]);
        for (part, v) in std::iter::once(position).chain(normal).enumerate() {
            match encoding {
                Encoding::Binary => {
                    for coordinate in v.to_array() {
                        buffer.extend(coordinate.to_le_bytes());
                    }
                }
                Encoding::Text => {
                    if part > 0 {
                        buffer.push(b' ');
                    }
                    put_triple(&mut buffer, v, b' ');
                }
            }
        }
        if encoding == Encoding::Text {
            buffer.push(b'\n');
        }
        sink.put(&buffer)?;
        sink.item()?;
    }
    Ok(())
}
