//! The public header, and the one variable-length record that matters: that of the compression.
//!
//! ```text
//!   0 "LASF"             94 bytes of the header, u16     131 scale of x, y, z, 3 f64
//!  24 version, 2 u8      96 where the points start, u32  155 offset of x, y, z, 3 f64
//!                       100 records between, u32         247 points from version 1.4 on, u64
//!                       104 point format, u8; 128 set when compressed
//!                       105 bytes of a point, u16
//!                       107 points up to version 1.3, u32
//! ```

use crate::Error;
use crate::source::Source;
use pellicle_geometry::DVec3;

pub(super) struct Header {
    pub points_start: u64,
    pub point_format: u8,
    pub record_length: u16,
    pub points: u64,
    pub scale: DVec3,
    pub offset: DVec3,
    /// The record that describes the compression, if the points are compressed.
    pub compression: Option<Vec<u8>>,
}

/// The bytes of a point of each format, without further bytes of the producer's.
const RECORD_LENGTHS: [u16; 11] = [20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67];

/// The header of version 1.0 to 1.2.
const SHORTEST: usize = 227;

impl Header {
    pub fn read(source: &mut Source) -> Result<Self, Error> {
        let mut raw = [0; 375];
        source.read_exact(&mut raw[..SHORTEST], "the end of its header")?;
        if &raw[..4] != b"LASF" {
            return Err(source.malformed(
                crate::Location::Byte(0),
                "does not start with \"LASF\": this is no LAS or LAZ file",
            ));
        }
        let header_size = usize::from(u16_at(&raw, 94));
        if header_size < SHORTEST {
            return Err(source.malformed(
                crate::Location::Byte(94),
                format!("a header of {header_size} bytes; the shortest has {SHORTEST}"),
            ));
        }
        let known = header_size.min(raw.len());
        source.read_exact(&mut raw[SHORTEST..known], "the end of its header")?;
        source.skip((header_size - known) as u64, "the end of its header")?;
        let point_format = raw[104] & 0x3f;
        let record_length = u16_at(&raw, 105);
        let Some(&least) = RECORD_LENGTHS.get(usize::from(point_format)) else {
            return Err(source.malformed(
                crate::Location::Byte(104),
                format!("point format {point_format} is not known; 0 to 10 are"),
            ));
        };
        if record_length < least {
            return Err(source.malformed(
                crate::Location::Byte(105),
                format!("points of {record_length} bytes; format {point_format} has {least}"),
            ));
        }
        let legacy = u64::from(u32_at(&raw, 107));
        let points = match (raw[24], raw[25]) {
            (1, 4..) if known >= 255 => u64_at(&raw, 247),
            _ => legacy,
        };
        let points_start = u64::from(u32_at(&raw, 96));
        if points_start < header_size as u64 || points_start > source.length() {
            return Err(source.malformed(
                crate::Location::Byte(96),
                format!(
                    "the points cannot start at byte {points_start} of {}",
                    source.length()
                ),
            ));
        }
        let triple = |at| {
            DVec3::new(
                f64_at(&raw, at),
                f64_at(&raw, at + 8),
                f64_at(&raw, at + 16),
            )
        };
        let mut header = Self {
            points_start,
            point_format,
            record_length,
            points,
            scale: triple(131),
            offset: triple(155),
            compression: None,
        };
        if raw[104] & 0x80 != 0 {
            header.compression = Some(compression(source, u32_at(&raw, 100), points_start)?);
        }
        Ok(header)
    }
}

/// Looks through the variable-length records.
///
/// ```text
/// 0 reserved, u16   2 user, 16 bytes   18 record, u16   20 length, u16   22 description, 32 bytes
/// ```
fn compression(source: &mut Source, records: u32, points_start: u64) -> Result<Vec<u8>, Error> {
    for _ in 0..records {
        let mut head = [0; 54];
        if source.offset() + 54 > points_start {
            break;
        }
        source.read_exact(&mut head, "the end of a variable-length record")?;
        let length = u64::from(u16_at(&head, 20));
        if source.offset() + length > points_start {
            return Err(source.at_byte("a variable-length record reaches into the points"));
        }
        if head[2..].starts_with(b"laszip encoded") && u16_at(&head, 18) == 22204 {
            return source.read_to_vec(length, "the end of the record of its compression");
        }
        source.skip(length, "the end of a variable-length record")?;
    }
    Err(source.at_byte("the points are compressed, but no record says how; the file is damaged"))
}

pub(super) fn u16_at(raw: &[u8], at: usize) -> u16 {
    u16::from_le_bytes([raw[at], raw[at + 1]])
}

pub(super) fn u32_at(raw: &[u8], at: usize) -> u32 {
    u32::from_le_bytes([raw[at], raw[at + 1], raw[at + 2], raw[at + 3]])
}

fn u64_at(raw: &[u8], at: usize) -> u64 {
    u64::from(u32_at(raw, at)) | u64::from(u32_at(raw, at + 4)) << 32
}

fn f64_at(raw: &[u8], at: usize) -> f64 {
    f64::from_bits(u64_at(raw, at))
}
