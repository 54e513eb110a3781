//! The header: which elements follow, with which properties, in which encoding.

use crate::Error;
use crate::source::Source;
use crate::text::{count, shown, words};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Encoding {
    Ascii,
    LittleEndian,
    BigEndian,
}

/// The type of a number, by its width in bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Scalar {
    fn from_name(name: &[u8]) -> Option<Self> {
        Some(match name {
            b"char" | b"int8" => Self::I8,
            b"uchar" | b"uint8" => Self::U8,
            b"short" | b"int16" => Self::I16,
            b"ushort" | b"uint16" => Self::U16,
            b"int" | b"int32" => Self::I32,
            b"uint" | b"uint32" => Self::U32,
            b"float" | b"float32" => Self::F32,
            b"double" | b"float64" => Self::F64,
            _ => return None,
        })
    }

    pub fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }

    /// Every type is exact in `f64`. `bytes` are `size()` many, in this order.
    #[inline]
    pub fn decode(self, bytes: &[u8], encoding: Encoding) -> f64 {
        macro_rules! number {
            ($type:ty) => {{
                let mut raw = [0; size_of::<$type>()];
                raw.copy_from_slice(&bytes[..size_of::<$type>()]);
                match encoding {
                    Encoding::BigEndian => <$type>::from_be_bytes(raw),
                    _ => <$type>::from_le_bytes(raw),
                }
                .into()
            }};
        }
        match self {
            Self::I8 => number!(i8),
            Self::U8 => number!(u8),
            Self::I16 => number!(i16),
            Self::U16 => number!(u16),
            Self::I32 => number!(i32),
            Self::U32 => number!(u32),
            Self::F32 => number!(f32),
            Self::F64 => number!(f64),
        }
    }
}

/// One value, or a counted list of values.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Shape {
    One(Scalar),
    List { count: Scalar, item: Scalar },
}

#[derive(Clone, Debug)]
pub(super) struct Property {
    pub name: String,
    pub shape: Shape,
}

#[derive(Clone, Debug)]
pub(super) struct Element {
    pub name: String,
    pub count: u64,
    pub properties: Vec<Property>,
}

impl Element {
    /// The bytes of one such element, if it has no list.
    pub fn stride(&self) -> Option<u64> {
        self.properties
            .iter()
            .map(|property| match property.shape {
                Shape::One(scalar) => Some(scalar.size() as u64),
                Shape::List { .. } => None,
            })
            .sum()
    }

    /// The fewest bytes that one such element can take in a file.
    pub fn least_bytes(&self, encoding: Encoding) -> u64 {
        self.properties
            .iter()
            .map(|property| match (encoding, property.shape) {
                (Encoding::Ascii, _) => 2,
                (_, Shape::One(scalar) | Shape::List { count: scalar, .. }) => scalar.size() as u64,
            })
            .sum::<u64>()
            .max(1)
    }

    pub fn position(&self, name: &str) -> Option<usize> {
        self.properties.iter().position(|p| p.name == name)
    }
}

#[derive(Debug)]
pub(super) struct Header {
    pub encoding: Encoding,
    pub elements: Vec<Element>,
}

impl Header {
    pub fn read(source: &mut Source) -> Result<Self, Error> {
        let mut line = Vec::new();
        if !source.next_line(&mut line)? || line.trim_ascii() != b"ply" {
            return Err(source.at_line(format!(
                "starts with {}, not with \"ply\": this is no PLY file",
                shown(&line)
            )));
        }
        let mut encoding = None;
        let mut elements: Vec<Element> = Vec::new();
        loop {
            if !source.next_line(&mut line)? {
                return Err(source.truncated("\"end_header\""));
            }
            let mut words = words(&line);
            match words.next() {
                None | Some(b"comment" | b"obj_info") => {}
                Some(b"format") => {
                    encoding = Some(match words.next() {
                        Some(b"ascii") => Encoding::Ascii,
                        Some(b"binary_little_endian") => Encoding::LittleEndian,
                        Some(b"binary_big_endian") => Encoding::BigEndian,
                        other => {
                            return Err(source.at_line(format!(
                                "format {} is none of ascii, binary_little_endian and binary_big_endian",
                                shown(other.unwrap_or_default())
                            )));
                        }
                    });
                }
                Some(b"element") => {
                    let (Some(name), Some(number)) = (words.next(), words.next().and_then(count))
                    else {
                        return Err(
                            source.at_line("an element needs a name and a count of 0 or more")
                        );
                    };
                    elements.push(Element {
                        name: String::from_utf8_lossy(name).into_owned(),
                        count: number,
                        properties: Vec::new(),
                    });
                }
                Some(b"property") => {
                    let words: Vec<&[u8]> = words.collect();
                    let property = property(&words).ok_or_else(|| {
                        source.at_line(
                            "a property is \"property TYPE NAME\" or \"property list TYPE TYPE NAME\" with \
                             the types char, uchar, short, ushort, int, uint, float and double",
                        )
                    })?;
                    let Some(element) = elements.last_mut() else {
                        return Err(source.at_line("a property stands before any element"));
                    };
                    element.properties.push(property);
                }
                Some(b"end_header") => break,
                Some(word) => {
                    return Err(
                        source.at_line(format!("{} is no keyword of a PLY header", shown(word)))
                    );
                }
            }
        }
        let encoding =
            encoding.ok_or_else(|| source.at_line("the header ends without a format line"))?;
        for name in ["vertex", "face"] {
            if elements.iter().filter(|e| e.name == name).count() > 1 {
                return Err(source.at_line(format!("the header declares {name} twice")));
            }
        }
        Ok(Self { encoding, elements })
    }
}

fn property(words: &[&[u8]]) -> Option<Property> {
    let (shape, name) = match words {
        [b"list", count, item, name] => {
            let count = Scalar::from_name(count)?;
            if matches!(count, Scalar::F32 | Scalar::F64) {
                return None;
            }
            let item = Scalar::from_name(item)?;
            (Shape::List { count, item }, name)
        }
        [scalar, name] => (Shape::One(Scalar::from_name(scalar)?), name),
        _ => return None,
    };
    Some(Property {
        name: String::from_utf8_lossy(name).into_owned(),
        shape,
    })
}
