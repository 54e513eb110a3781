//! The values, element by element.

use super::header::{Element, Encoding, Header, Scalar, Shape};
use crate::contents::{Contents, Keep, push};
use crate::source::Source;
use crate::text::{number, shown};
use crate::{Error, Location, Note};
use pellicle_geometry::DVec3;

pub(crate) fn read(source: &mut Source, keep: Keep) -> Result<Contents, Error> {
    let Header { encoding, elements } = Header::read(source)?;
    let mut contents = Contents::new(keep);
    let vertices = elements
        .iter()
        .find(|e| e.name == "vertex")
        .map_or(0, |e| e.count);
    let mut values = Values {
        source,
        encoding,
        line: Vec::new(),
        at: 0,
    };
    for element in &elements {
        match element.name.as_str() {
            "vertex" => read_vertices(&mut values, element, &mut contents)?,
            "face" => read_faces(&mut values, element, vertices, &mut contents)?,
            "tristrips" => read_strips(&mut values, element, vertices, &mut contents)?,
            name => {
                values.skip(element)?;
                contents.ignored(
                    format!("elements {}", shown(name.as_bytes())),
                    element.count,
                );
            }
        }
    }
    if encoding != Encoding::Ascii {
        let rest = values.source.remaining();
        contents.ignored("bytes after the last element", rest);
    }
    Ok(contents)
}

/// One scalar property of every vertex.
pub(crate) fn read_property(source: &mut Source, name: &str) -> Result<Vec<f64>, Error> {
    let Header { encoding, elements } = Header::read(source)?;
    let mut values = Values {
        source,
        encoding,
        line: Vec::new(),
        at: 0,
    };
    let scalar = |element: &Element| {
        let is_scalar = |at: &usize| matches!(element.properties[*at].shape, Shape::One(_));
        element.position(name).filter(is_scalar)
    };
    for element in &elements {
        if element.name != "vertex" {
            values.skip(element)?;
            continue;
        }
        let Some(wanted) = scalar(element) else {
            let scalars = element.properties.iter();
            let scalars = scalars.filter(|p| matches!(p.shape, Shape::One(_)));
            let known: Vec<String> = scalars.map(|p| shown(p.name.as_bytes())).collect();
            return Err(Error::NoSuchProperty {
                path: values.source.path().to_owned(),
                name: name.to_owned(),
                known: known.join(", "),
            });
        };
        let mut found = Vec::new();
        let least = element.least_bytes(encoding);
        values
            .source
            .reserve(&mut found, element.count, least, "vertices")?;
        for _ in 0..element.count {
            for (at, property) in element.properties.iter().enumerate() {
                match property.shape {
                    Shape::One(scalar) if at == wanted => {
                        found.push(values.next(scalar, element)?);
                    }
                    shape => values.skip_property(shape, element)?,
                }
            }
            values.end(element)?;
        }
        return Ok(found);
    }
    Err(source.at_byte("the file declares no vertices"))
}

/// The values of the file one after the other, as `f64`, which holds each type exactly.
struct Values<'s, 'a> {
    source: &'s mut Source<'a>,
    encoding: Encoding,
    line: Vec<u8>,
    /// Where in `line` the next word may start.
    at: usize,
}

impl Values<'_, '_> {
    fn next(&mut self, scalar: Scalar, element: &Element) -> Result<f64, Error> {
        if self.encoding == Encoding::Ascii {
            return self.next_word(element);
        }
        let mut bytes = [0; 8];
        let bytes = &mut bytes[..scalar.size()];
        self.source.read_exact(bytes, &last_of(element))?;
        Ok(scalar.decode(bytes, self.encoding))
    }

    fn next_word(&mut self, element: &Element) -> Result<f64, Error> {
        loop {
            let rest = self.line[self.at..].trim_ascii_start();
            if !rest.is_empty() {
                let length = rest
                    .iter()
                    .position(u8::is_ascii_whitespace)
                    .unwrap_or(rest.len());
                let word = &rest[..length];
                let value = number(word);
                if value.is_none() {
                    let message = format!("{} is not a number", shown(word));
                    return Err(self.source.at_line(message));
                }
                self.at = self.line.len() - rest.len() + length;
                return Ok(value.unwrap_or_default());
            }
            self.at = 0;
            if !self.source.next_line(&mut self.line)? {
                self.line.clear();
                return Err(self.source.truncated(&last_of(element)));
            }
        }
    }

    /// After one element of an ascii file: the line must be used up, or the columns are not those declared.
    fn end(&mut self, element: &Element) -> Result<(), Error> {
        if self.encoding == Encoding::Ascii && !self.line[self.at..].trim_ascii().is_empty() {
            return Err(self.source.at_line(format!(
                "this line has more values than the header declares for {}",
                shown(element.name.as_bytes())
            )));
        }
        Ok(())
    }

    /// The length of a list, which the rest of the file must be able to hold.
    fn list_length(
        &mut self,
        count: Scalar,
        item: Scalar,
        element: &Element,
    ) -> Result<u64, Error> {
        let length = self.next(count, element)?;
        if length < 0.0 || length.fract() != 0.0 {
            let message = format!("a list cannot have {length} items");
            return Err(self.source.malformed(self.place(), message));
        }
        let length = length as u64;
        let room = match self.encoding {
            Encoding::Ascii => self.source.remaining() + (self.line.len() - self.at) as u64,
            _ => self.source.remaining() / item.size() as u64,
        };
        if length > room {
            let message = format!(
                "a list of {length} items does not fit into the rest of the file; the file is truncated or damaged"
            );
            return Err(self.source.malformed(self.place(), message));
        }
        Ok(length)
    }

    fn place(&self) -> Location {
        match self.encoding {
            Encoding::Ascii => self.source.line(),
            _ => self.source.byte(),
        }
    }

    /// Passes over all elements of this kind.
    fn skip(&mut self, element: &Element) -> Result<(), Error> {
        if element.properties.is_empty() {
            return Ok(());
        }
        if let (Some(stride), false) = (element.stride(), self.encoding == Encoding::Ascii) {
            let bytes = stride.saturating_mul(element.count);
            return self.source.skip(bytes, &last_of(element));
        }
        for _ in 0..element.count {
            for property in &element.properties {
                self.skip_property(property.shape, element)?;
            }
            self.end(element)?;
        }
        Ok(())
    }

    fn skip_property(&mut self, shape: Shape, element: &Element) -> Result<(), Error> {
        match shape {
            Shape::One(scalar) => self.next(scalar, element).map(|_| ()),
            Shape::List { count, item } => {
                let length = self.list_length(count, item, element)?;
                if self.encoding == Encoding::Ascii {
                    for _ in 0..length {
                        self.next_word(element)?;
                    }
                    return Ok(());
                }
                let bytes = length * item.size() as u64;
                self.source.skip(bytes, &last_of(element))
            }
        }
    }
}

fn last_of(element: &Element) -> String {
    format!(
        "the last of {} elements {}",
        element.count,
        shown(element.name.as_bytes())
    )
}

fn read_vertices(
    values: &mut Values,
    element: &Element,
    contents: &mut Contents,
) -> Result<(), Error> {
    let find = |names: [&str; 3]| -> Option<[usize; 3]> {
        let [a, b, c] = names.map(|name| element.position(name));
        Some([a?, b?, c?])
    };
    let missing = || {
        values
            .source
            .at_byte("the vertices declared in the header lack a property x, y or z")
    };
    let columns = find(["x", "y", "z"]).ok_or_else(missing)?;
    let normal_columns = find(["nx", "ny", "nz"]);
    // Six slots are kept of each element; `slots[p]` is where property `p` goes.
    let mut slots = vec![None; element.properties.len()];
    for (slot, &column) in columns
        .iter()
        .chain(normal_columns.iter().flatten())
        .enumerate()
    {
        slots[column] = Some(slot);
        if matches!(element.properties[column].shape, Shape::List { .. }) {
            return Err(missing());
        }
    }
    let least = element.least_bytes(values.encoding);
    let source = &*values.source;
    source.reserve(&mut contents.positions, element.count, least, "vertices")?;
    if normal_columns.is_some() {
        source.reserve(&mut contents.normals, element.count, least, "vertices")?;
    }
    let record = Record::new(element, &slots, values.encoding);
    for _ in 0..element.count {
        let place = values.place();
        let mut kept = [0.0; 6];
        match &record {
            Some(record) => record.read(values, element, &mut kept)?,
            None => {
                for (property, slot) in element.properties.iter().zip(&slots) {
                    match (property.shape, slot) {
                        (Shape::One(scalar), Some(slot)) => {
                            kept[*slot] = values.next(scalar, element)?;
                        }
                        (shape, _) => values.skip_property(shape, element)?,
                    }
                }
                values.end(element)?;
            }
        }
        let place = match values.encoding {
            Encoding::Ascii => values.place(),
            _ => place,
        };
        let [x, y, z, nx, ny, nz] = kept;
        let position = DVec3::new(x, y, z);
        let vertex = contents.positions.len();
        values.source.check_finite(position, vertex, place)?;
        push(&mut contents.positions, position);
        if normal_columns.is_some() {
            push(&mut contents.normals, DVec3::new(nx, ny, nz));
        }
    }
    Ok(())
}

/// Binary elements without lists: read whole, then picked from.
struct Record {
    stride: usize,
    /// Offset, type and slot of each property that is kept.
    fields: Vec<(usize, Scalar, usize)>,
    encoding: Encoding,
}

/// Longer records are read value by value.
const LONGEST_RECORD: usize = 1024;

impl Record {
    fn new(element: &Element, slots: &[Option<usize>], encoding: Encoding) -> Option<Self> {
        let stride = usize::try_from(element.stride()?).ok()?;
        if encoding == Encoding::Ascii || stride > LONGEST_RECORD {
            return None;
        }
        let mut fields = Vec::new();
        let mut offset = 0;
        for (property, slot) in element.properties.iter().zip(slots) {
            if let Shape::One(scalar) = property.shape {
                fields.extend(slot.map(|slot| (offset, scalar, slot)));
                offset += scalar.size();
            }
        }
        Some(Self {
            stride,
            fields,
            encoding,
        })
    }

    fn read(
        &self,
        values: &mut Values,
        element: &Element,
        kept: &mut [f64; 6],
    ) -> Result<(), Error> {
        let mut bytes = [0; LONGEST_RECORD];
        let bytes = &mut bytes[..self.stride];
        if self.stride as u64 > values.source.remaining() {
            return Err(values.source.truncated(&last_of(element)));
        }
        values.source.read_exact(bytes, "a vertex")?;
        for &(offset, scalar, slot) in &self.fields {
            kept[slot] = scalar.decode(&bytes[offset..], self.encoding);
        }
        Ok(())
    }
}

/// The property of an element that lists its vertices.
fn index_list(values: &Values, element: &Element) -> Result<usize, Error> {
    ["vertex_indices", "vertex_index"]
        .iter()
        .find_map(|name| element.position(name))
        .filter(|&at| matches!(element.properties[at].shape, Shape::List { .. }))
        .ok_or_else(|| {
            values.source.at_byte(format!(
                "the elements {} lack a list \"vertex_indices\"",
                shown(element.name.as_bytes())
            ))
        })
}

/// Calls `each` with the index list of every element.
fn for_each_list(
    values: &mut Values,
    element: &Element,
    mut each: impl FnMut(&mut Values, &[f64]) -> Result<(), Error>,
) -> Result<(), Error> {
    let indices_at = index_list(values, element)?;
    let mut indices = Vec::new();
    for _ in 0..element.count {
        for (at, property) in element.properties.iter().enumerate() {
            match property.shape {
                Shape::List { count, item } if at == indices_at => {
                    indices.clear();
                    for _ in 0..values.list_length(count, item, element)? {
                        indices.push(values.next(item, element)?);
                    }
                }
                shape => values.skip_property(shape, element)?,
            }
        }
        values.end(element)?;
        each(values, &indices)?;
    }
    Ok(())
}

fn vertex(values: &Values, index: f64, vertices: u64) -> Result<u32, Error> {
    if index >= 0.0 && index < vertices as f64 && index.fract() == 0.0 {
        return Ok(index as u32);
    }
    let message = format!("corner {index} is none of the {vertices} vertices");
    Err(values.source.malformed(values.place(), message))
}

fn read_faces(
    values: &mut Values,
    element: &Element,
    vertices: u64,
    contents: &mut Contents,
) -> Result<(), Error> {
    if element.count == 0 {
        return Ok(());
    }
    if contents.keeps_triangles() {
        let least = element.least_bytes(values.encoding);
        let source = &*values.source;
        source.reserve(&mut contents.triangles, element.count, least, "faces")?;
    }
    let mut corners = Vec::new();
    for_each_list(values, element, |values, indices| {
        corners.clear();
        for &index in indices {
            corners.push(vertex(values, index, vertices)?);
        }
        contents.polygon(&corners);
        Ok(())
    })
}

/// Strips: each corner makes a triangle with the two before it, in turns of either hand; -1 starts anew.
fn read_strips(
    values: &mut Values,
    element: &Element,
    vertices: u64,
    contents: &mut Contents,
) -> Result<(), Error> {
    if element.count == 0 {
        return Ok(());
    }
    let mut restarts = 0;
    for_each_list(values, element, |values, indices| {
        for strip in indices.split(|&index| index == -1.0) {
            restarts += 1;
            let mut window = [0; 2];
            for (i, &index) in strip.iter().enumerate() {
                let c = vertex(values, index, vertices)?;
                let [a, b] = window;
                if i >= 2 {
                    contents.triangle(if i % 2 == 0 { [a, b, c] } else { [b, a, c] });
                }
                window = [b, c];
            }
        }
        Ok(())
    })?;
    contents.notes.push(Note::Strips { strips: restarts });
    Ok(())
}
