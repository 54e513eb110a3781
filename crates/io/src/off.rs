//! OFF, the Object File Format of Geomview: counts, then vertices, then polygons, as text.
//!
//! The keyword `[ST][C][N]OFF` says which columns a vertex has: position, normal (N), colour (C), texture
//! (ST), in this order.

use crate::Error;
use crate::contents::{Contents, Keep, push};
use crate::sink::Sink;
use crate::source::Source;
use crate::text::{before, count, number, put_triple, shown, words};
use pellicle_geometry::DVec3;
use pellicle_mesh::MeshView;

struct Header {
    normals: bool,
    /// Colour or texture was announced.
    extras: bool,
    vertices: u64,
    faces: u64,
}

pub(crate) fn read(source: &mut Source, keep: Keep) -> Result<Contents, Error> {
    let mut contents = Contents::new(keep);
    let mut line = Vec::new();
    let header = read_header(source, &mut line)?;
    source.reserve(&mut contents.positions, header.vertices, 6, "vertices")?;
    if header.normals {
        source.reserve(&mut contents.normals, header.vertices, 12, "vertices")?;
    }
    let mut extras = u64::from(header.extras);
    let columns = if header.normals { 6 } else { 3 };
    for vertex in 0..header.vertices {
        let mut kept = [0.0; 6];
        let mut filled = 0;
        while filled < columns {
            let what = || format!("vertex {vertex} of {}", header.vertices);
            content_line(source, &mut line, what)?;
            for word in words(before(&line, b'#')) {
                if filled < columns {
                    kept[filled] = number(word).ok_or_else(|| {
                        source.at_line(format!(
                            "{} in vertex {vertex} is not a number",
                            shown(word)
                        ))
                    })?;
                    filled += 1;
                } else {
                    extras = 1;
                }
            }
        }
        let [x, y, z, nx, ny, nz] = kept;
        let position = DVec3::new(x, y, z);
        source.check_finite(position, vertex as usize, source.line())?;
        push(&mut contents.positions, position);
        if header.normals {
            push(&mut contents.normals, DVec3::new(nx, ny, nz));
        }
    }
    if contents.keeps_triangles() {
        source.reserve(&mut contents.triangles, header.faces, 4, "faces")?;
    }
    read_faces(source, &mut line, &header, &mut contents)?;
    if extras > 0 {
        contents.ignored("kinds of further columns of the vertices", extras);
    }
    Ok(contents)
}

/// The next line with something before its comment.
fn content_line(
    source: &mut Source,
    line: &mut Vec<u8>,
    what: impl Fn() -> String,
) -> Result<(), Error> {
    loop {
        if !source.next_line(line)? {
            return Err(source.truncated(&what()));
        }
        if !before(line, b'#').trim_ascii().is_empty() {
            return Ok(());
        }
    }
}

fn read_header(source: &mut Source, line: &mut Vec<u8>) -> Result<Header, Error> {
    content_line(source, line, || "its header".into())?;
    let mut first: Vec<Vec<u8>> = words(before(line, b'#')).map(<[u8]>::to_vec).collect();
    let mut header = Header {
        normals: false,
        extras: false,
        vertices: 0,
        faces: 0,
    };
    if count(&first[0]).is_none() {
        let keyword = first.remove(0);
        let wrong = |reason: &str| Err(source.at_line(format!("{} {reason}", shown(&keyword))));
        let Some(mut prefix) = keyword.strip_suffix(b"OFF") else {
            return wrong(
                "is neither the keyword OFF nor a count of vertices: this is no OFF file",
            );
        };
        for (mark, is_normal) in [(&b"ST"[..], false), (b"C", false), (b"N", true)] {
            if let Some(rest) = prefix.strip_prefix(mark) {
                prefix = rest;
                header.normals |= is_normal;
                header.extras |= !is_normal;
            }
        }
        if !prefix.is_empty() {
            return wrong("has vertices of other than three dimensions, which are not supported");
        }
        if first.first().is_some_and(|word| word == b"BINARY") {
            return wrong("BINARY: binary OFF is not supported; convert the file to text or PLY");
        }
    }
    if first.is_empty() {
        content_line(source, line, || "the counts of vertices and faces".into())?;
        first = words(before(line, b'#')).map(<[u8]>::to_vec).collect();
    }
    let mut counts = first.iter().map(|word| count(word));
    match (counts.next().flatten(), counts.next().flatten()) {
        (Some(vertices), Some(faces)) => Ok(Header {
            vertices,
            faces,
            ..header
        }),
        _ => Err(source.at_line("here the counts of vertices, faces and edges are expected")),
    }
}

fn read_faces(
    source: &mut Source,
    line: &mut Vec<u8>,
    header: &Header,
    contents: &mut Contents,
) -> Result<(), Error> {
    let mut corners = Vec::new();
    for face in 0..header.faces {
        let what = || format!("face {face} of {}", header.faces);
        corners.clear();
        let mut left = None;
        while left != Some(0) {
            content_line(source, line, what)?;
            for word in words(before(line, b'#')) {
                if left == Some(0) {
                    // What follows the corners is a colour.
                    break;
                }
                let Some(value) = count(word) else {
                    return Err(source.at_line(format!(
                        "{} in face {face} is no count or corner",
                        shown(word)
                    )));
                };
                match &mut left {
                    None => left = Some(value),
                    Some(left) => {
                        if value >= header.vertices {
                            return Err(source.at_line(format!(
                                "corner {value} of face {face} is none of the {} vertices",
                                header.vertices
                            )));
                        }
                        corners.push(value as u32);
                        *left -= 1;
                    }
                }
            }
        }
        contents.polygon(&corners);
    }
    Ok(())
}

pub(crate) fn write(
    sink: &mut Sink,
    mesh: MeshView,
    normals: Option<&[DVec3]>,
) -> Result<(), Error> {
    let keyword = if normals.is_some() { "NOFF" } else { "OFF" };
    let (vertices, faces) = (mesh.positions.len(), mesh.triangles.len());
    sink.put(format!("{keyword}\n{vertices} {faces} 0\n").as_bytes())?;
    let mut text = Vec::new();
    for (i, &position) in mesh.positions.iter().enumerate() {
        text.clear();
        put_triple(&mut text, position, b' ');
        if let Some(normals) = normals {
            text.push(b' ');
            put_triple(&mut text, normals[i], b' ');
        }
        text.push(b'\n');
        sink.put(&text)?;
        sink.item()?;
    }
    for triangle in mesh.triangles {
        let [a, b, c] = triangle.map(|v| v.0);
        sink.put(format!("3 {a} {b} {c}\n").as_bytes())?;
        sink.item()?;
    }
    Ok(())
}
