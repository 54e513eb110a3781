//! The points.

use super::header::{Encoding, Header};
use super::lzf;
use crate::contents::{Contents, Keep, push};
use crate::source::Source;
use crate::text::{number, shown, words};
use crate::{Error, Location, Note};
use pellicle_geometry::DVec3;

pub(crate) fn read(source: &mut Source) -> Result<Contents, Error> {
    let header = Header::read(source)?;
    let find = |names: [&str; 3]| -> Option<[usize; 3]> {
        let [a, b, c] = names.map(|name| header.find(name));
        Some([a?, b?, c?])
    };
    let Some(position) = find(["x", "y", "z"]) else {
        return Err(source.at_line("the fields x, y and z are not all there"));
    };
    let normal = find(["normal_x", "normal_y", "normal_z"]);
    let mut slots = vec![None; header.fields.len()];
    for (slot, field) in position
        .into_iter()
        .chain(normal.into_iter().flatten())
        .enumerate()
    {
        slots[field] = Some(slot);
    }
    let mut points = Points {
        contents: Contents::new(Keep::Points),
        normals: normal.is_some(),
        missing: 0,
        read: 0,
    };
    match header.encoding {
        Encoding::Ascii => read_text(source, &header, &slots, &mut points)?,
        Encoding::Binary => read_records(source, &header, &slots, &mut points)?,
        Encoding::Compressed => read_compressed(source, &header, &slots, &mut points)?,
    }
    let mut contents = points.contents;
    if points.missing > 0 {
        contents.notes.push(Note::Missing {
            points: points.missing,
        });
    }
    let ignored = slots.iter().filter(|slot| slot.is_none()).count();
    contents.ignored("fields other than position and normal", ignored as u64);
    Ok(contents)
}

struct Points {
    contents: Contents,
    normals: bool,
    missing: u64,
    read: u64,
}

impl Points {
    fn reserve(&mut self, source: &Source, count: u64, least_bytes: u64) -> Result<(), Error> {
        source.reserve(&mut self.contents.positions, count, least_bytes, "points")?;
        if self.normals {
            source.reserve(&mut self.contents.normals, count, least_bytes, "points")?;
        }
        Ok(())
    }

    /// A point with NaN in all coordinates is one that the sensor did not see.
    fn add(&mut self, source: &Source, kept: [f64; 6], place: Location) -> Result<(), Error> {
        let [x, y, z, nx, ny, nz] = kept;
        let position = DVec3::new(x, y, z);
        let which = self.read;
        self.read += 1;
        if position.is_nan_mask().all() {
            self.missing += 1;
            return Ok(());
        }
        source.check_finite(position, which as usize, place)?;
        push(&mut self.contents.positions, position);
        if self.normals {
            push(&mut self.contents.normals, DVec3::new(nx, ny, nz));
        }
        Ok(())
    }
}

fn read_text(
    source: &mut Source,
    header: &Header,
    slots: &[Option<usize>],
    points: &mut Points,
) -> Result<(), Error> {
    points.reserve(source, header.points, 6)?;
    let mut line = Vec::new();
    for point in 0..header.points {
        loop {
            if !source.next_line(&mut line)? {
                return Err(source.truncated(&format!("point {point} of {}", header.points)));
            }
            if !line.trim_ascii().is_empty() {
                break;
            }
        }
        let mut kept = [0.0; 6];
        let mut words = words(&line);
        for (field, slot) in header.fields.iter().zip(slots) {
            for value in 0..field.count {
                let Some(word) = words.next() else {
                    return Err(source.at_line(format!(
                        "point {point} ends before its field {}",
                        shown(field.name.as_bytes())
                    )));
                };
                if let (Some(slot), 0) = (slot, value) {
                    kept[*slot] = number(word).ok_or_else(|| {
                        source.at_line(format!("{} is not a number", shown(word)))
                    })?;
                }
            }
        }
        points.add(source, kept, source.line())?;
    }
    Ok(())
}

fn read_records(
    source: &mut Source,
    header: &Header,
    slots: &[Option<usize>],
    points: &mut Points,
) -> Result<(), Error> {
    let stride = header.stride();
    points.reserve(source, header.points, stride as u64)?;
    let mut record = vec![0; stride];
    let what = format!("the last of {} points", header.points);
    for _ in 0..header.points {
        let place = source.byte();
        if (stride as u64) > source.remaining() {
            return Err(source.truncated(&what));
        }
        source.read_exact(&mut record, &what)?;
        let mut kept = [0.0; 6];
        let mut offset = 0;
        for (field, slot) in header.fields.iter().zip(slots) {
            if let Some(slot) = slot {
                kept[*slot] = field.decode(&record[offset..]);
            }
            offset += field.bytes();
        }
        points.add(source, kept, place)?;
    }
    Ok(())
}

/// Compressed data hold all values of the first field, then all of the next.
fn read_compressed(
    source: &mut Source,
    header: &Header,
    slots: &[Option<usize>],
    points: &mut Points,
) -> Result<(), Error> {
    let start = source.byte();
    let mut sizes = [0; 8];
    source.read_exact(&mut sizes, "the sizes of the compressed data")?;
    let size = |at: usize| {
        u64::from(u32::from_le_bytes([
            sizes[at],
            sizes[at + 1],
            sizes[at + 2],
            sizes[at + 3],
        ]))
    };
    let (compressed, uncompressed) = (size(0), size(4));
    let needed = header.points.saturating_mul(header.stride() as u64);
    if uncompressed != needed {
        return Err(source.malformed(
            start,
            format!("{uncompressed} bytes of points are stated, and the header needs {needed}"),
        ));
    }
    if compressed > source.remaining() {
        return Err(source.truncated("the end of the compressed data"));
    }
    if uncompressed > compressed.saturating_mul(lzf::LARGEST_RATIO) {
        return Err(source.malformed(
            start,
            format!("{compressed} bytes cannot decompress to {uncompressed}; the file is damaged"),
        ));
    }
    let count = header.points as usize;
    let mut decoder = lzf::Decoder::new(compressed);
    let too_many = source.too_many(header.points, "points");
    let contents = &mut points.contents;
    for vectors in [
        Some(&mut contents.positions),
        points.normals.then_some(&mut contents.normals),
    ]
    .into_iter()
    .flatten()
    {
        if vectors.try_reserve_exact(count).is_err() {
            return Err(too_many);
        }
        vectors.resize(count, DVec3::ZERO);
    }
    for (field, slot) in header.fields.iter().zip(slots) {
        let Some(slot) = *slot else {
            decoder.skip(source, field.bytes() as u64 * header.points)?;
            continue;
        };
        let mut value = vec![0; field.bytes()];
        let target = match slot {
            0..3 => &mut contents.positions,
            _ => &mut contents.normals,
        };
        for vector in target {
            decoder.read_exact(source, &mut value)?;
            vector[slot % 3] = field.decode(&value);
        }
    }
    keep_seen(source, points)
}

/// Checks the positions in place, and moves those together that were measured.
fn keep_seen(source: &Source, points: &mut Points) -> Result<(), Error> {
    let Contents {
        positions, normals, ..
    } = &mut points.contents;
    let mut kept = 0;
    for i in 0..positions.len() {
        if positions[i].is_nan_mask().all() {
            points.missing += 1;
            continue;
        }
        source.check_finite(positions[i], i, Location::File)?;
        positions[kept] = positions[i];
        if points.normals {
            normals[kept] = normals[i];
        }
        kept += 1;
    }
    positions.truncate(kept);
    normals.truncate(kept);
    Ok(())
}
