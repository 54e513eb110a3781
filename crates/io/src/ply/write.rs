//! Double precision, as text or little-endian bytes.

use crate::sink::Sink;
use crate::text::put_triple;
use crate::{Content, Encoding, Error};
use pellicle_geometry::DVec3;
use pellicle_mesh::MeshView;

pub(crate) fn write(
    sink: &mut Sink,
    mesh: MeshView,
    normals: Option<&[DVec3]>,
    content: Content,
    encoding: Encoding,
) -> Result<(), Error> {
    // Signed indices are what most readers know; they end at 2^31.
    let wide = mesh.positions.len() > i32::MAX as usize;
    sink.put(header(mesh, normals.is_some(), content, encoding, wide).as_bytes())?;
    let mut buffer = Vec::new();
    for (i, &position) in mesh.positions.iter().enumerate() {
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
    for triangle in mesh.triangles {
        buffer.clear();
        let [a, b, c] = triangle.map(|v| v.0);
        match encoding {
            Encoding::Binary => {
                buffer.push(3);
                for corner in [a, b, c] {
                    buffer.extend(corner.to_le_bytes());
                }
            }
            Encoding::Text => buffer.extend(format!("3 {a} {b} {c}\n").bytes()),
        }
        sink.put(&buffer)?;
        sink.item()?;
    }
    Ok(())
}

fn header(
    mesh: MeshView,
    normals: bool,
    content: Content,
    encoding: Encoding,
    wide: bool,
) -> String {
    let encoding = match encoding {
        Encoding::Binary => "binary_little_endian",
        Encoding::Text => "ascii",
    };
    let mut header = format!(
        "ply\nformat {encoding} 1.0\nelement vertex {}\n",
        mesh.positions.len()
    );
    let names: &[&str] = match normals {
        true => &["x", "y", "z", "nx", "ny", "nz"],
        false => &["x", "y", "z"],
    };
    for name in names {
        header.push_str(&format!("property double {name}\n"));
    }
    if content == Content::Mesh {
        let index = if wide { "uint" } else { "int" };
        header.push_str(&format!(
            "element face {}\nproperty list uchar {index} vertex_indices\n",
            mesh.triangles.len()
        ));
    }
    header.push_str("end_header\n");
    header
}
