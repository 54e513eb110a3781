//! Compressed points.
//!
//! `laz` is written for sound files: it panics on some damaged ones and reserves what chunk tables and layers
//! claim. So the claims are checked here first, against the size of the file; what may still panic, inside
//! the arithmetic decoder, is caught. (The panic hook of the process runs before that, and may print.)

use super::header::{Header, u32_at};
use crate::contents::{Contents, push};
use crate::source::{Input, Source};
use crate::{Error, Location};
use laz::laszip::ChunkTable;
use laz::{DecompressionSelection, LasZipDecompressor, LazItemType, LazVlr};
use pellicle_geometry::{Cancelled, DVec3, Progress};
use std::io::{self, SeekFrom};
use std::panic::{AssertUnwindSafe, catch_unwind};

/// Points decoded at once, between two looks at the progress.
const BATCH: u64 = 4096;

/// A compressed byte can stand for a good many points that are alike, but for no more than so many.
const MOST_POINTS_PER_BYTE: u64 = 4096;

pub(super) fn read(
    source: &mut Source,
    header: &Header,
    contents: &mut Contents,
) -> Result<(), Error> {
    let Some(raw) = &header.compression else {
        return Ok(());
    };
    let start = Location::Byte(header.points_start);
    let room = source.length() - header.points_start;
    if header.points >= u64::from(u32::MAX) {
        return Err(source.too_many(header.points, "points"));
    }
    if header.points > room.saturating_mul(MOST_POINTS_PER_BYTE) {
        return Err(source.malformed(
            start,
            format!(
                "{} points cannot be in {room} bytes; the file is truncated or damaged",
                header.points
            ),
        ));
    }
    if header.points == 0 {
        return Ok(());
    }
    source.reserve(
        &mut contents.positions,
        header.points.min(room),
        0,
        "points",
    )?;
    let length = source.length();
    let progress = source.progress();
    let decoded = decode_all(source.input(), raw, header, length, progress, contents);
    decoded.map_err(|failure| match failure {
        Failure::Cancelled(cancelled) => cancelled.into(),
        Failure::Damaged(reason) => {
            source.malformed(start, format!("{reason}; copy or export the file again"))
        }
        Failure::NotFinite(vertex) => Error::NotFinite {
            path: source.path().to_owned(),
            location: start,
            vertex,
        },
    })
}

fn decode_all(
    input: &mut dyn Input,
    raw: &[u8],
    header: &Header,
    length: u64,
    progress: &dyn Progress,
    contents: &mut Contents,
) -> Result<(), Failure> {
    let mut decoder = guarded(|| prepare(input, raw, header, length))?;
    let mut record = vec![0; usize::from(header.record_length)];
    let mut done = 0;
    while done < header.points {
        let batch = BATCH.min(header.points - done);
        guarded(|| decode(&mut decoder, &mut record, header, batch, contents))
            .map_err(|failure| failure.at(contents.positions.len()))?;
        done += batch;
        let flow = progress.step("read", done, header.points);
        Cancelled::check(flow).map_err(Failure::Cancelled)?;
    }
    Ok(())
}

/// A panic of the decoder becomes a failure. What it leaves half done is not looked at again.
fn guarded<T>(work: impl FnOnce() -> Result<T, Failure>) -> Result<T, Failure> {
    catch_unwind(AssertUnwindSafe(work))
        .unwrap_or_else(|_| Err("its compressed points are damaged".to_owned().into()))
}

enum Failure {
    Damaged(String),
    NotFinite(u64),
    Cancelled(Cancelled),
}

impl Failure {
    fn at(self, point: usize) -> Self {
        match self {
            Self::Damaged(reason) => Self::Damaged(format!("at point {point}: {reason}")),
            other => other,
        }
    }
}

impl From<String> for Failure {
    fn from(reason: String) -> Self {
        Self::Damaged(reason)
    }
}

impl From<io::Error> for Failure {
    fn from(error: io::Error) -> Self {
        Self::Damaged(match error.kind() {
            io::ErrorKind::UnexpectedEof => "the file ends before its last point".into(),
            _ => error.to_string(),
        })
    }
}

impl From<laz::LasZipError> for Failure {
    fn from(error: laz::LasZipError) -> Self {
        Self::Damaged(format!("its compression is not understood: {error}"))
    }
}

/// How the compressed points are laid out.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    /// All in one.
    PointWise,
    /// In chunks, with a table of these at the end.
    Chunked,
    /// In chunks, and there each field of the points in a layer of its own.
    Layered,
}

type Decoder<'s> = LasZipDecompressor<'s, &'s mut dyn Input>;

/// The decoder at the first point, once everything that it trusts is checked.
fn prepare<'s>(
    input: &'s mut dyn Input,
    raw: &[u8],
    header: &Header,
    length: u64,
) -> Result<Decoder<'s>, Failure> {
    let (kind, vlr) = layout(raw, header)?;
    if kind != Kind::PointWise {
        check_chunks(input, &vlr, kind, header, length)?;
    }
    input.seek(SeekFrom::Start(header.points_start))?;
    let selection = DecompressionSelection::xy_returns_channel().decompress_z();
    Ok(LasZipDecompressor::selective(input, vlr, selection)?)
}

/// Checks that the compressed items are those of the point format.
fn layout(raw: &[u8], header: &Header) -> Result<(Kind, LazVlr), Failure> {
    let kind = match raw.first_chunk() {
        Some([1, 0]) => Kind::PointWise,
        Some([2, 0]) => Kind::Chunked,
        Some([3, 0]) => Kind::Layered,
        _ => return Err("a compressor that is not known".to_owned().into()),
    };
    let vlr = LazVlr::from_buffer(raw)?;
    let layered = kind == Kind::Layered;
    let first = match header.point_format {
        0..=5 => LazItemType::Point10,
        _ => LazItemType::Point14,
    };
    let mut bytes = 0;
    for (i, item) in vlr.items().iter().enumerate() {
        let size = match item.item_type() {
            LazItemType::Point10 => 20,
            LazItemType::Point14 => 30,
            LazItemType::GpsTime | LazItemType::RGBNIR14 => 8,
            LazItemType::RGB12 | LazItemType::RGB14 => 6,
            LazItemType::WavePacket13 | LazItemType::WavePacket14 => 29,
            LazItemType::Byte(size) | LazItemType::Byte14(size) => size,
        };
        let family = if layered { 3..=4 } else { 1..=2 };
        if item.size() != size
            || size == 0
            || !family.contains(&item.version())
            || (i == 0) != (item.item_type() == first)
        {
            return Err(format!(
                "compressed items that are not those of point format {}",
                header.point_format
            )
            .into());
        }
        bytes += u64::from(size);
    }
    if bytes != u64::from(header.record_length) {
        return Err(format!(
            "compressed points of {bytes} bytes, where the header has {}",
            header.record_length
        )
        .into());
    }
    Ok((kind, vlr))
}

/// Checks the chunk table, and in each chunk of layers the sizes of these, against the file.
fn check_chunks(
    input: &mut dyn Input,
    vlr: &LazVlr,
    kind: Kind,
    header: &Header,
    length: u64,
) -> Result<(), Failure> {
    let first_chunk = header.points_start + 8;
    let missing = || Failure::Damaged("the chunk table is missing: the file is truncated".into());
    input.seek(SeekFrom::Start(header.points_start))?;
    let mut raw = [0; 8];
    input.read_exact(&mut raw)?;
    let mut table = u64::from_le_bytes(raw);
    if table == u64::MAX {
        // A writer that could not go back leaves the place at the end.
        input.seek(SeekFrom::End(-8))?;
        input.read_exact(&mut raw)?;
        table = u64::from_le_bytes(raw);
    }
    if table < first_chunk || table.saturating_add(8) > length {
        return Err(missing());
    }
    input.seek(SeekFrom::Start(table))?;
    input.read_exact(&mut raw)?;
    let chunks = u64::from(u32_at(&raw, 4));
    let point = u64::from(header.record_length);
    // The first point of each chunk is not compressed.
    if chunks == 0 || chunks > (table - first_chunk) / point {
        return Err(missing());
    }
    input.seek(SeekFrom::Start(header.points_start))?;
    let entries = ChunkTable::read_from(&mut *input, vlr)?;
    let (mut place, mut points) = (first_chunk, 0u64);
    for entry in entries.as_ref() {
        if entry.byte_count < point || entry.byte_count > table - place {
            return Err("the chunk table does not fit the file".to_owned().into());
        }
        if kind == Kind::Layered {
            check_layers(input, vlr, place, entry.byte_count, point)?;
        }
        place += entry.byte_count;
        points = points.saturating_add(entry.point_count);
        if entry.point_count == 0 || entry.point_count > u64::from(u32::MAX) {
            return Err("a chunk without points".to_owned().into());
        }
    }
    if points < header.points {
        return Err(format!("its chunks hold {points} points of {}", header.points).into());
    }
    Ok(())
}

/// A chunk of layers: its first point, the number of points, the size of each layer, the layers.
fn check_layers(
    input: &mut dyn Input,
    vlr: &LazVlr,
    place: u64,
    bytes: u64,
    point: u64,
) -> Result<(), Failure> {
    let layers: usize = vlr
        .items()
        .iter()
        .map(|item| match item.item_type() {
            LazItemType::Point14 => 9,
            LazItemType::RGBNIR14 => 2,
            LazItemType::Byte14(size) => usize::from(size),
            _ => 1,
        })
        .sum();
    let head = point + 4 + 4 * layers as u64;
    input.seek(SeekFrom::Start(place + point + 4))?;
    let mut sizes = vec![0; 4 * layers];
    input.read_exact(&mut sizes)?;
    let sum: u64 = sizes.chunks(4).map(|raw| u64::from(u32_at(raw, 0))).sum();
    if head + sum != bytes {
        return Err(format!("a chunk of {bytes} bytes has layers of {sum}").into());
    }
    Ok(())
}

fn decode(
    decoder: &mut Decoder,
    record: &mut [u8],
    header: &Header,
    batch: u64,
    contents: &mut Contents,
) -> Result<(), Failure> {
    for _ in 0..batch {
        decoder.decompress_one(record)?;
        let position: DVec3 = header.position(record);
        if !position.is_finite() {
            return Err(Failure::NotFinite(contents.positions.len() as u64));
        }
        push(&mut contents.positions, position);
    }
    Ok(())
}
