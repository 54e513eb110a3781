//! LAS and LAZ: records of airborne lasers with integer coordinates, a scale and an offset.
//!
//! The header and the uncompressed records are read here. Compressed ones are left to `laz`, the decoder
//! beneath the crate `las`: `las` itself trusts the lengths in the headers of its records, and a file of
//! some hundred bytes can make it ask for any amount of memory. The tests compare with it.

mod compressed;
mod header;

use crate::Error;
use crate::contents::{Contents, Keep, push};
use crate::source::Source;
use header::Header;
use pellicle_geometry::DVec3;

pub(crate) fn read(source: &mut Source) -> Result<Contents, Error> {
    let header = Header::read(source)?;
    let mut contents = Contents::new(Keep::Points);
    match &header.compression {
        None => read_records(source, &header, &mut contents)?,
        Some(_) => compressed::read(source, &header, &mut contents)?,
    }
    Ok(contents)
}

fn read_records(
    source: &mut Source,
    header: &Header,
    contents: &mut Contents,
) -> Result<(), Error> {
    let length = u64::from(header.record_length);
    let gap = header.points_start - source.offset();
    source.skip(gap, "its first point")?;
    source.reserve(&mut contents.positions, header.points, length, "points")?;
    let what = format!("the last of {} points", header.points);
    let mut record = vec![0; usize::from(header.record_length)];
    for point in 0..header.points {
        if length > source.remaining() {
            return Err(source.truncated(&what));
        }
        let place = source.byte();
        source.read_exact(&mut record, &what)?;
        let position = header.position(&record);
        source.check_finite(position, point as usize, place)?;
        push(&mut contents.positions, position);
    }
    Ok(())
}

impl Header {
    /// Every point format starts with x, y and z as integers.
    fn position(&self, record: &[u8]) -> DVec3 {
        let integer = |at: usize| {
            f64::from(i32::from_le_bytes([
                record[at],
                record[at + 1],
                record[at + 2],
                record[at + 3],
            ]))
        };
        DVec3::new(integer(0), integer(4), integer(8)) * self.scale + self.offset
    }
}
