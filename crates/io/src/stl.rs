//! STL: triangles without shared vertices, as text or as 50 bytes each in single precision.
//!
//! Corners with equal coordinates become one vertex, so that a mesh hangs together again.

use crate::contents::{Contents, Keep, push};
use crate::sink::Sink;
use crate::source::Source;
use crate::text::{number, shown, words};
use crate::write::Rounded;
use crate::{Error, Format, Location, Note};
use pellicle_geometry::{DVec3, triangle};
use pellicle_mesh::MeshView;
use std::hash::{BuildHasher, RandomState};
use std::path::Path;

const HEADER: u64 = 84;
const RECORD: usize = 50;

pub(crate) fn read(source: &mut Source, keep: Keep) -> Result<Contents, Error> {
    let mut builder = Builder::new(keep);
    // "solid" opens many binary files too: only the size tells them apart.
    let (solid, declared) = {
        let start = source.peek()?;
        let count = start
            .get(80..84)
            .map(|raw| u64::from(u32::from_le_bytes([raw[0], raw[1], raw[2], raw[3]])));
        (start.trim_ascii_start().starts_with(b"solid"), count)
    };
    let length = source.length();
    let expected = declared.map(|count| HEADER + count * RECORD as u64);
    match (solid, expected, declared) {
        (_, Some(expected), Some(count)) if expected == length || (!solid && expected < length) => {
            read_binary(source, count, &mut builder)?;
            builder
                .contents
                .ignored("bytes after the last triangle", length - expected);
        }
        (true, ..) => read_text(source, &mut builder)?,
        (false, Some(expected), Some(count)) => {
            return Err(source.malformed(
                Location::Byte(80),
                format!(
                    "{count} triangles are declared, which take {expected} bytes, but the file has {length}; it is \
                     truncated, or no STL file"
                ),
            ));
        }
        _ => {
            return Err(source.malformed(
                Location::File,
                format!("has {length} bytes: a binary STL file has 84 at least, and one of text starts with \"solid\""),
            ));
        }
    }
    Ok(builder.finish())
}

fn read_binary(source: &mut Source, count: u64, builder: &mut Builder) -> Result<(), Error> {
    source.skip(HEADER, "its header")?;
    if builder.contents.keeps_triangles() {
        source.reserve(
            &mut builder.contents.triangles,
            count,
            RECORD as u64,
            "triangles",
        )?;
    }
    // A closed mesh has half as many vertices as triangles.
    source.reserve(
        &mut builder.contents.positions,
        count / 2 + 2,
        RECORD as u64,
        "vertices",
    )?;
    let mut record = [0; RECORD];
    for _ in 0..count {
        let place = source.byte();
        source.read_exact(&mut record, "its last triangle")?;
        let mut corners = [0; 3];
        for (k, corner) in corners.iter_mut().enumerate() {
            // The first twelve bytes are the normal, which the corners tell better.
            let coordinate = |axis: usize| {
                let at = 12 + 12 * k + 4 * axis;
                f64::from(f32::from_le_bytes([
                    record[at],
                    record[at + 1],
                    record[at + 2],
                    record[at + 3],
                ]))
            };
            let position = DVec3::new(coordinate(0), coordinate(1), coordinate(2));
            *corner = builder.vertex(source, position, place)?;
        }
        builder.contents.triangle(corners);
    }
    Ok(())
}

fn read_text(source: &mut Source, builder: &mut Builder) -> Result<(), Error> {
    let mut line = Vec::new();
    let mut corners = [0; 3];
    let mut filled = 0;
    let mut facets = 0u64;
    let mut inside = false;
    while source.next_line(&mut line)? {
        let mut words = words(&line);
        let Some(keyword) = words.next() else {
            continue;
        };
        match keyword.to_ascii_lowercase().as_slice() {
            b"solid" => inside = true,
            b"endsolid" => inside = false,
            b"facet" | b"outer" if inside => {}
            b"vertex" if inside => {
                if filled == 3 {
                    return Err(
                        source.at_line(format!("facet {facets} has more than three vertices"))
                    );
                }
                let mut v = [0.0; 3];
                for coordinate in &mut v {
                    let word = words.next().unwrap_or_default();
                    *coordinate = number(word).ok_or_else(|| {
                        source.at_line(format!("{} is not a coordinate", shown(word)))
                    })?;
                }
                corners[filled] = builder.vertex(source, DVec3::from_array(v), source.line())?;
                filled += 1;
            }
            b"endloop" if inside => {
                if filled != 3 {
                    return Err(
                        source.at_line(format!("facet {facets} has {filled} vertices, not three"))
                    );
                }
                builder.contents.triangle(corners);
                filled = 0;
                facets += 1;
            }
            b"endfacet" if inside => {}
            _ => {
                return Err(source.at_line(format!(
                    "{} is no keyword of STL here; a binary file would have another size",
                    shown(keyword)
                )));
            }
        }
    }
    if filled > 0 || inside {
        return Err(source.truncated("\"endsolid\""));
    }
    Ok(())
}

/// Corners made to vertices.
struct Builder {
    contents: Contents,
    /// Open addressing: the id of a vertex, or `FREE`. Four bytes a slot, where a map of positions takes forty.
    slots: Vec<u32>,
    hasher: RandomState,
    corners: u64,
}

const FREE: u32 = u32::MAX;

impl Builder {
    fn new(keep: Keep) -> Self {
        Self {
            contents: Contents::new(keep),
            slots: vec![FREE; 1 << 10],
            hasher: RandomState::new(),
            corners: 0,
        }
    }

    /// The vertex at this position: an earlier one with equal coordinates, or a new one.
    fn vertex(&mut self, source: &Source, position: DVec3, place: Location) -> Result<u32, Error> {
        source.check_finite(position, self.contents.positions.len(), place)?;
        self.corners += 1;
        if (self.contents.positions.len() + 1) * 4 > self.slots.len() * 3 {
            self.grow();
        }
        let mut slot = self.slot(position);
        loop {
            match self.slots[slot] {
                FREE => break,
                id if self.contents.positions[id as usize] == position => return Ok(id),
                _ => slot = (slot + 1) & (self.slots.len() - 1),
            }
        }
        let id = self.contents.positions.len();
        if id + 1 >= u32::MAX as usize {
            return Err(source.too_many(id as u64 + 1, "vertices"));
        }
        self.slots[slot] = id as u32;
        push(&mut self.contents.positions, position);
        Ok(id as u32)
    }

    /// Where the search for a position starts. Equal positions start alike: zero has one sign.
    fn slot(&self, position: DVec3) -> usize {
        let bits = (position + DVec3::ZERO).to_array().map(f64::to_bits);
        self.hasher.hash_one(bits) as usize & (self.slots.len() - 1)
    }

    fn grow(&mut self) {
        let size = self.slots.len() * 2;
        self.slots = Vec::new();
        self.slots = vec![FREE; size];
        for (id, &position) in self.contents.positions.iter().enumerate() {
            let mut slot = self.slot(position);
            while self.slots[slot] != FREE {
                slot = (slot + 1) & (size - 1);
            }
            self.slots[slot] = id as u32;
        }
    }

    fn finish(mut self) -> Contents {
        let vertices = self.contents.positions.len() as u64;
        if self.corners > vertices {
            self.contents.notes.push(Note::Merged {
                corners: self.corners,
                vertices,
            });
        }
        self.contents
    }
}

pub(crate) fn write(
    sink: &mut Sink,
    path: &Path,
    mesh: MeshView,
    normals: Option<&[DVec3]>,
    notes: &mut Vec<Note>,
) -> Result<(), Error> {
    let rounded = Rounded::new(mesh.positions, false, notes).ok_or_else(|| Error::Range {
        path: path.to_owned(),
        format: Format::Stl,
    })?;
    if normals.is_some() {
        notes.push(Note::NormalsDropped {
            why: "STL has them of triangles only",
        });
    }
    // The header must not start with "solid".
    let mut header = [0; HEADER as usize];
    header[..15].copy_from_slice(b"binary triangle");
    header[80..].copy_from_slice(&(mesh.triangles.len() as u32).to_le_bytes());
    sink.put(&header)?;
    for corners in mesh.triangles {
        let exact = corners.map(|v| mesh.positions[v.index()]);
        let [a, b, c] = exact.map(|p| p - rounded.shift);
        let normal = triangle::double_area_normal(a, b, c)
            .normalize_or_zero()
            .as_vec3();
        let mut record = Vec::with_capacity(RECORD);
        for v in std::iter::once(normal).chain(exact.map(|p| rounded.local(p))) {
            for coordinate in v.to_array() {
                record.extend(coordinate.to_le_bytes());
            }
        }
        record.extend([0, 0]);
        sink.put(&record)?;
        sink.item()?;
    }
    Ok(())
}
