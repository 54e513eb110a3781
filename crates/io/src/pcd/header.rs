//! The header.
//!
//! ```text
//! VERSION .7
//! FIELDS x y z intensity          the names
//! SIZE 4 4 4 2                    bytes of a value
//! TYPE F F F U                    float, unsigned, signed
//! COUNT 1 1 1 1                   values in the field
//! WIDTH 213
//! HEIGHT 1
//! VIEWPOINT 0 0 0 1 0 0 0
//! POINTS 213
//! DATA ascii                      or binary, or binary_compressed
//! ```

use crate::Error;
use crate::source::Source;
use crate::text::{count, shown, words};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Encoding {
    Ascii,
    Binary,
    Compressed,
}

/// One field of a point.
#[derive(Clone, Debug)]
pub(super) struct Field {
    pub name: String,
    /// Bytes of one value: 1, 2, 4 or 8.
    pub size: usize,
    /// F, U or I.
    pub kind: u8,
    /// Values in the field.
    pub count: usize,
}

impl Field {
    pub fn bytes(&self) -> usize {
        self.size * self.count
    }

    /// The first value; integers past 2^53 are rounded.
    pub fn decode(&self, raw: &[u8]) -> f64 {
        macro_rules! number {
            ($type:ty) => {{
                let mut bytes = [0; size_of::<$type>()];
                bytes.copy_from_slice(&raw[..size_of::<$type>()]);
                <$type>::from_le_bytes(bytes) as f64
            }};
        }
        match (self.kind, self.size) {
            (b'F', 8) => number!(f64),
            (b'F', _) => number!(f32),
            (b'U', 1) => number!(u8),
            (b'U', 2) => number!(u16),
            (b'U', 4) => number!(u32),
            (b'U', _) => number!(u64),
            (_, 1) => number!(i8),
            (_, 2) => number!(i16),
            (_, 4) => number!(i32),
            (_, _) => number!(i64),
        }
    }
}

#[derive(Debug)]
pub(super) struct Header {
    pub fields: Vec<Field>,
    pub points: u64,
    pub encoding: Encoding,
}

/// The bytes of one point; far beyond any sensor.
const LARGEST_POINT: usize = 1 << 20;

impl Header {
    pub fn read(source: &mut Source) -> Result<Self, Error> {
        let mut line = Vec::new();
        let mut fields: Vec<Field> = Vec::new();
        let (mut width, mut height, mut points) = (None, None, None);
        let encoding = loop {
            if !source.next_line(&mut line)? {
                return Err(source.truncated("its line DATA"));
            }
            let all: Vec<&[u8]> = words(&line).collect();
            let Some((&keyword, values)) = all.split_first() else {
                continue;
            };
            match keyword {
                _ if keyword.starts_with(b"#") => {}
                b"VERSION" | b"VIEWPOINT" => {}
                b"FIELDS" | b"COLUMNS" => {
                    fields = values.iter().map(|name| named(name)).collect();
                }
                b"SIZE" | b"TYPE" | b"COUNT" => {
                    if values.len() != fields.len() {
                        return Err(source.at_line(format!(
                            "{} values for the {} names of the line FIELDS",
                            values.len(),
                            fields.len()
                        )));
                    }
                    for (field, value) in fields.iter_mut().zip(values) {
                        set(field, keyword, value).ok_or_else(|| {
                            source.at_line(format!("{} cannot stand here", shown(value)))
                        })?;
                    }
                }
                b"WIDTH" | b"HEIGHT" | b"POINTS" => {
                    let Some(value) = values.first().and_then(|word| count(word)) else {
                        return Err(source.at_line("a count of 0 or more is expected here"));
                    };
                    *match keyword {
                        b"WIDTH" => &mut width,
                        b"HEIGHT" => &mut height,
                        _ => &mut points,
                    } = Some(value);
                }
                b"DATA" => {
                    break match values.first() {
                        Some(&b"ascii") => Encoding::Ascii,
                        Some(&b"binary") => Encoding::Binary,
                        Some(&b"binary_compressed") => Encoding::Compressed,
                        other => {
                            return Err(source.at_line(format!(
                                "DATA {} is none of ascii, binary and binary_compressed",
                                shown(other.copied().unwrap_or_default())
                            )));
                        }
                    };
                }
                _ => {
                    return Err(
                        source.at_line(format!("{} is no keyword of a PCD header", shown(keyword)))
                    );
                }
            }
        };
        let area = match (width, height) {
            (Some(width), height) => width.checked_mul(height.unwrap_or(1)),
            _ => None,
        };
        let points = match (points, area) {
            (Some(points), Some(area)) if points != area => {
                return Err(source.at_line(format!(
                    "the header states {points} points, and WIDTH times HEIGHT is {area}"
                )));
            }
            (points, area) => points
                .or(area)
                .ok_or_else(|| source.at_line("the header states no POINTS"))?,
        };
        if let Some(field) = fields
            .iter()
            .find(|field| field.kind == b'F' && field.size < 4)
        {
            return Err(source.at_line(format!(
                "field {} is a float of {} bytes; 4 or 8 are known",
                shown(field.name.as_bytes()),
                field.size
            )));
        }
        let size = fields.iter().map(Field::bytes).sum::<usize>();
        if size > LARGEST_POINT {
            return Err(source.at_line(format!("a point of {size} bytes is not supported")));
        }
        Ok(Self {
            fields,
            points,
            encoding,
        })
    }

    /// Where the first value of this field is, and the field.
    pub fn find(&self, name: &str) -> Option<usize> {
        self.fields
            .iter()
            .position(|field| field.name == name && field.count > 0)
    }

    /// The bytes of one point.
    pub fn stride(&self) -> usize {
        self.fields.iter().map(Field::bytes).sum()
    }
}

fn named(name: &[u8]) -> Field {
    Field {
        name: String::from_utf8_lossy(name).into_owned(),
        size: 4,
        kind: b'F',
        count: 1,
    }
}

fn set(field: &mut Field, keyword: &[u8], value: &[u8]) -> Option<()> {
    match keyword {
        b"TYPE" => {
            field.kind = match value {
                [kind @ (b'F' | b'U' | b'I')] => *kind,
                _ => return None,
            };
        }
        b"SIZE" => field.size = count(value).filter(|size| [1, 2, 4, 8].contains(size))? as usize,
        _ => field.count = count(value).filter(|&count| count <= LARGEST_POINT as u64)? as usize,
    }
    Some(())
}
