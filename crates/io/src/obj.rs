//! OBJ of Wavefront: lines of vertices, normals and polygons.
//!
//! Read here and not by `tobj`, which holds the whole file, reorders the vertices, and drops those that no
//! polygon uses: a cloud would come back empty. The tests compare with it.

use crate::contents::{Contents, Keep, push};
use crate::sink::Sink;
use crate::source::Source;
use crate::text::{before, number, put_triple, shown, words};
use crate::{Error, Note};
use pellicle_geometry::DVec3;
use pellicle_mesh::MeshView;

#[derive(Default)]
struct State {
    normals: Vec<DVec3>,
    /// Whether every corner so far names the normal of the same number as its vertex.
    normals_match: Option<bool>,
    /// The greatest corner, and the line that names it: a polygon may precede its vertices.
    greatest: u32,
    greatest_line: u64,
    polygons: u64,
    colours: u64,
    lines_and_points: u64,
    curves: u64,
    texture: u64,
}

pub(crate) fn read(source: &mut Source, keep: Keep) -> Result<Contents, Error> {
    let mut contents = Contents::new(keep);
    let mut state = State::default();
    let mut line = Vec::new();
    let mut more = Vec::new();
    while source.next_line(&mut line)? {
        // A backslash at the end continues the line.
        while line.ends_with(b"\\") {
            line.pop();
            line.push(b' ');
            if !source.next_line(&mut more)? {
                break;
            }
            line.extend_from_slice(&more);
            if line.len() > 16 << 20 {
                return Err(source.at_line("more than 16 MiB continued by backslashes"));
            }
        }
        let mut words = words(before(&line, b'#'));
        let Some(keyword) = words.next() else {
            continue;
        };
        match keyword {
            b"v" => {
                let vertex = contents.positions.len();
                let position = triple(source, &mut words, "vertex", vertex)?;
                state.colours += u64::from(words.next().is_some());
                source.check_finite(position, vertex, source.line())?;
                if vertex + 1 >= u32::MAX as usize {
                    return Err(source.too_many(vertex as u64 + 1, "vertices"));
                }
                push(&mut contents.positions, position);
            }
            b"vn" => {
                let normal = triple(source, &mut words, "normal", state.normals.len())?;
                push(&mut state.normals, normal);
            }
            b"f" | b"fo" => polygon(source, &mut words, &mut contents, &mut state)?,
            b"l" | b"p" => state.lines_and_points += 1,
            b"vt" => state.texture += 1,
            b"curv" | b"curv2" | b"surf" | b"vp" => state.curves += 1,
            _ if keyword.iter().all(|b| b.is_ascii_graphic()) => {}
            _ => {
                return Err(source.at_line(format!(
                    "{} is no keyword: this is no OBJ file",
                    shown(keyword)
                )));
            }
        }
    }
    conclude(source, contents, state)
}

/// The checks and notes that need the whole file.
fn conclude(source: &Source, mut contents: Contents, state: State) -> Result<Contents, Error> {
    let vertices = contents.positions.len();
    if vertices == 0 {
        return Err(source.malformed(
            crate::Location::File,
            "has no line \"v x y z\": it holds no vertex, or is no OBJ file",
        ));
    }
    if state.polygons > 0 && state.greatest as usize >= vertices {
        return Err(source.malformed(
            crate::Location::Line(state.greatest_line),
            format!(
                "corner {} is none of the {vertices} vertices",
                u64::from(state.greatest) + 1
            ),
        ));
    }
    if !state.normals.is_empty() {
        // Without polygons nothing can tell otherwise.
        let matching = state.normals_match.unwrap_or(state.polygons == 0);
        if matching && state.normals.len() == vertices {
            contents.normals = state.normals;
        } else {
            contents.notes.push(Note::NormalsDropped {
                why: "they are not one a vertex",
            });
        }
    }
    contents.ignored("colours or weights of vertices", state.colours);
    contents.ignored("texture coordinates", state.texture);
    contents.ignored("polylines and point elements", state.lines_and_points);
    contents.ignored("curves and free-form surfaces", state.curves);
    Ok(contents)
}

fn triple<'l>(
    source: &Source,
    words: &mut impl Iterator<Item = &'l [u8]>,
    what: &str,
    which: usize,
) -> Result<DVec3, Error> {
    let mut v = [0.0; 3];
    for coordinate in &mut v {
        let word = words.next().ok_or_else(|| {
            source.at_line(format!("{what} {which} has fewer than three coordinates"))
        })?;
        *coordinate = number(word).ok_or_else(|| {
            source.at_line(format!("{} in {what} {which} is not a number", shown(word)))
        })?;
    }
    Ok(DVec3::from_array(v))
}

fn polygon<'l>(
    source: &Source,
    words: &mut impl Iterator<Item = &'l [u8]>,
    contents: &mut Contents,
    state: &mut State,
) -> Result<(), Error> {
    let mut corners = Vec::new();
    for word in words {
        // v, v/vt, v//vn or v/vt/vn; from 1, or negative from the last.
        let mut parts = word.split(|&b| b == b'/');
        let v = parts
            .next()
            .and_then(|part| index(part, contents.positions.len()));
        let Some(v) = v else {
            return Err(source.at_line(format!("{} is no corner of a polygon", shown(word))));
        };
        let n = parts
            .nth(1)
            .and_then(|part| index(part, state.normals.len()));
        let matching = state.normals_match.get_or_insert(true);
        *matching &= n == Some(v);
        if v >= state.greatest {
            state.greatest = v;
            state.greatest_line = match source.line() {
                crate::Location::Line(line) => line,
                _ => 0,
            };
        }
        corners.push(v);
    }
    state.polygons += 1;
    contents.polygon(&corners);
    Ok(())
}

/// An index from 0, of one from 1 or one that counts back from the last of `len`.
fn index(word: &[u8], len: usize) -> Option<u32> {
    let value: i64 = std::str::from_utf8(word).ok()?.parse().ok()?;
    let index = match value {
        1.. => value - 1,
        0 => return None,
        _ => len as i64 + value,
    };
    u32::try_from(index).ok().filter(|&index| index != u32::MAX)
}

pub(crate) fn write(
    sink: &mut Sink,
    mesh: MeshView,
    normals: Option<&[DVec3]>,
) -> Result<(), Error> {
    let mut text = Vec::new();
    for (keyword, vectors) in [(&b"v "[..], Some(mesh.positions)), (b"vn ", normals)] {
        for &v in vectors.unwrap_or_default() {
            text.clear();
            text.extend(keyword);
            put_triple(&mut text, v, b' ');
            text.push(b'\n');
            sink.put(&text)?;
            sink.item()?;
        }
    }
    for triangle in mesh.triangles {
        let [a, b, c] = triangle.map(|v| v.0 + 1);
        let face = match normals {
            Some(_) => format!("f {a}//{a} {b}//{b} {c}//{c}\n"),
            None => format!("f {a} {b} {c}\n"),
        };
        sink.put(face.as_bytes())?;
        sink.item()?;
    }
    Ok(())
}
