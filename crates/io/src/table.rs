//! Tables of numbers, a point a line: XYZ, PTS, PWN, CSV.
//!
//! ```text
//! # comment                        // comment
//! 5210                             a count, perhaps
//! x,y,z,nx,ny,nz                   names, perhaps; without them the order is this one
//! 0.1 0.2 0.3  0 0 1               white space, commas, semicolons or tabs between
//! ```

use crate::contents::{Contents, Keep, push};
use crate::sink::Sink;
use crate::source::Source;
use crate::text::{before, count, number, put_triple, shown};
use crate::{Error, Format, Note};
use pellicle_geometry::DVec3;

/// What stands between two columns.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Separator {
    /// Any run of white space.
    Space,
    /// This byte, each time; an empty column is possible.
    Byte(u8),
}

impl Separator {
    /// A semicolon anywhere leaves the comma to the decimals.
    fn detect(line: &[u8], format: Format) -> Self {
        let tab = (format == Format::Csv).then_some(b'\t');
        [Some(b';'), tab, Some(b',')]
            .into_iter()
            .flatten()
            .find(|mark| line.contains(mark))
            .map_or(Self::Space, Self::Byte)
    }

    fn fields<'l>(self, line: &'l [u8]) -> impl Iterator<Item = &'l [u8]> + use<'l> {
        line.split(move |&b| match self {
            Self::Space => b.is_ascii_whitespace(),
            Self::Byte(mark) => b == mark,
        })
        .filter(move |field| self != Self::Space || !field.is_empty())
        .map(|field| {
            let field = field.trim_ascii();
            field
                .strip_prefix(b"\"")
                .and_then(|inner| inner.strip_suffix(b"\""))
                .unwrap_or(field)
        })
    }

    fn number(self, field: &[u8]) -> Option<f64> {
        match self {
            Self::Byte(b';') if field.contains(&b',') => {
                let dotted: Vec<u8> = field
                    .iter()
                    .map(|&b| if b == b',' { b'.' } else { b })
                    .collect();
                number(&dotted)
            }
            _ => number(field),
        }
    }
}

/// Which column goes where.
#[derive(Clone, Default)]
struct Layout {
    /// For each column, where of x y z nx ny nz it goes.
    slots: Vec<Option<usize>>,
    /// Every column from this one on is ignored.
    needed: usize,
    normals: bool,
    names_line: bool,
}

impl Layout {
    fn of_columns(position: [usize; 3], normal: Option<[usize; 3]>) -> Self {
        let columns = position.into_iter().chain(normal.into_iter().flatten());
        let needed = columns.clone().max().unwrap_or(0) + 1;
        let mut slots = vec![None; needed];
        for (slot, column) in columns.enumerate() {
            slots[column] = Some(slot);
        }
        Self {
            slots,
            needed,
            normals: normal.is_some(),
            names_line: false,
        }
    }

    /// By the names of the columns, if x, y and z are among them.
    fn of_names(line: &[u8], format: Format) -> Option<Self> {
        let names: Vec<String> = Separator::detect(line, format)
            .fields(line)
            .map(|name| {
                let name = String::from_utf8_lossy(name).to_ascii_lowercase();
                // "x [m]" and "x(m)" are x.
                let end = name.find(['[', '(']).unwrap_or(name.len());
                name[..end].trim().to_owned()
            })
            .collect();
        let find = |aliases: [&[&str]; 3]| -> Option<[usize; 3]> {
            let [a, b, c] = aliases.map(|aliases| {
                names
                    .iter()
                    .position(|name| aliases.contains(&name.as_str()))
            });
            Some([a?, b?, c?])
        };
        let position = find([
            &["x", "px", "easting"],
            &["y", "py", "northing"],
            &["z", "pz", "elevation", "height"],
        ])?;
        let normal = find([
            &["nx", "normal_x", "normalx"],
            &["ny", "normal_y", "normaly"],
            &["nz", "normal_z", "normalz"],
        ]);
        Some(Self {
            names_line: true,
            ..Self::of_columns(position, normal)
        })
    }

    /// By the number of columns, where nothing names them.
    fn of_width(width: usize, format: Format) -> Self {
        let normals = match format {
            Format::Pwn => width >= 6,
            // Intensity and colours follow the position there.
            Format::Pts => false,
            _ => width == 6,
        };
        Self::of_columns([0, 1, 2], normals.then_some([3, 4, 5]))
    }
}

/// How far a file with a count has come.
#[derive(Clone, Copy, PartialEq, Eq)]
struct Count {
    declared: u64,
    /// Rows before this block.
    base: u64,
}

pub(crate) fn read(source: &mut Source, format: Format) -> Result<Contents, Error> {
    let mut table = Table {
        contents: Contents::new(Keep::Points),
        format,
        separator: Separator::Space,
        layout: None,
        count: None,
        started: false,
        rows: 0,
    };
    let mut line = Vec::new();
    while source.next_line(&mut line)? {
        let text = line.trim_ascii();
        let comment = match text {
            [b'#', rest @ ..] | [b'/', b'/', rest @ ..] => Some(rest),
            _ => None,
        };
        if let Some(comment) = comment {
            if !table.started && table.layout.is_none() {
                table.layout = Layout::of_names(comment, format);
            }
            continue;
        }
        let text = before(text, b'#');
        if !text.trim_ascii().is_empty() {
            table.line(source, text)?;
        }
    }
    table.finish(source)
}

struct Table {
    contents: Contents,
    format: Format,
    separator: Separator,
    layout: Option<Layout>,
    count: Option<Count>,
    /// Whether a row of numbers was met.
    started: bool,
    rows: u64,
}

impl Table {
    fn line(&mut self, source: &mut Source, text: &[u8]) -> Result<(), Error> {
        if self.block_is_full() || !self.started {
            let separator = Separator::detect(text, self.format);
            let mut fields = separator.fields(text);
            if let (Some(first), None) = (fields.next(), fields.next())
                && let Some(declared) = count(first)
                && (self.count.is_none() || self.format == Format::Pts)
            {
                let base = self.rows;
                self.count = Some(Count { declared, base });
                return self.reserve_counted(source, declared);
            }
        }
        if !self.started {
            self.separator = Separator::detect(text, self.format);
            // With names known, the first column may be a text of no interest.
            let named = self.layout.as_ref().is_some_and(|l| l.names_line);
            let first = self.separator.fields(text).next().unwrap_or_default();
            if !named && self.separator.number(first).is_none() {
                return self.names(source, text);
            }
            self.start(source, text)?;
        }
        if self.block_is_full() {
            let count = self.count.map_or(0, |count| count.declared);
            if !(self.format == Format::Pwn && self.second_block()) {
                return Err(source.at_line(format!(
                    "{count} points were announced, and here is one more; the count or the file is wrong"
                )));
            }
        }
        self.row(source, text)
    }

    /// Whether as many rows were read as the count says.
    fn block_is_full(&self) -> bool {
        self.count
            .is_some_and(|count| self.rows - count.base >= count.declared)
    }

    /// In PWN, as many normals may follow the positions.
    fn second_block(&self) -> bool {
        let has_columns = self.layout.as_ref().is_some_and(|layout| layout.normals);
        !has_columns
            && self
                .count
                .is_some_and(|count| self.rows < 2 * count.declared)
    }

    fn reserve_counted(&mut self, source: &Source, declared: u64) -> Result<(), Error> {
        // "0 0 0" and the end of the line.
        source.reserve(&mut self.contents.positions, declared, 6, "points")
    }

    fn names(&mut self, source: &Source, text: &[u8]) -> Result<(), Error> {
        let named = Layout::of_names(text, self.format);
        if named.is_none() {
            return Err(source.at_line(format!(
                "{} is neither a row of numbers nor names of columns with x, y and z among them",
                shown(text)
            )));
        }
        self.layout = named;
        Ok(())
    }

    /// At the first row: the layout, if no names told it, and the memory.
    fn start(&mut self, source: &mut Source, text: &[u8]) -> Result<(), Error> {
        self.started = true;
        let width = self.separator.fields(text).count();
        if width < 3 {
            return Err(source.at_line(format!("{width} columns; a point has three: x, y and z")));
        }
        let format = self.format;
        let layout = self
            .layout
            .get_or_insert_with(|| Layout::of_width(width, format));
        let normals = layout.normals;
        let left_out = width.saturating_sub(if normals { 6 } else { 3 });
        self.contents
            .ignored("columns other than position and normal", left_out as u64);
        let rows = match self.count {
            Some(count) => count.declared,
            None => {
                let estimate = source.estimate_lines()? + 1;
                source.reserve(&mut self.contents.positions, estimate, 1, "points")?;
                estimate
            }
        };
        if normals {
            source.reserve(&mut self.contents.normals, rows, 6, "points")?;
        }
        Ok(())
    }

    fn row(&mut self, source: &Source, text: &[u8]) -> Result<(), Error> {
        let Some(layout) = &self.layout else {
            return Ok(());
        };
        let mut kept = [0.0; 6];
        let mut width = 0;
        for (field, slot) in self.separator.fields(text).zip(&layout.slots) {
            if let Some(slot) = slot {
                kept[*slot] = self.separator.number(field).ok_or_else(|| {
                    source.at_line(format!(
                        "{} in column {} is not a number",
                        shown(field),
                        width + 1
                    ))
                })?;
            }
            width += 1;
        }
        if width < layout.needed {
            return Err(source.at_line(format!(
                "{width} columns, and {} are needed as in the rows before; the file is truncated or damaged here",
                layout.needed
            )));
        }
        let [x, y, z, nx, ny, nz] = kept;
        let first = DVec3::new(x, y, z);
        if self.block_is_full() {
            push(&mut self.contents.normals, first);
        } else {
            let vertex = self.contents.positions.len();
            source.check_finite(first, vertex, source.line())?;
            if vertex + 1 >= u32::MAX as usize {
                return Err(source.too_many(vertex as u64 + 1, "points"));
            }
            push(&mut self.contents.positions, first);
            if layout.normals {
                push(&mut self.contents.normals, DVec3::new(nx, ny, nz));
            }
        }
        self.rows += 1;
        Ok(())
    }

    fn finish(mut self, source: &Source) -> Result<Contents, Error> {
        if let Some(count) = self.count {
            let rows = self.rows - count.base;
            if rows < count.declared || (rows > count.declared && rows < 2 * count.declared) {
                return Err(source.truncated(&format!(
                    "point {} of the {} that its count announces",
                    rows, count.declared
                )));
            }
        } else if !self.started {
            return Err(source.malformed(crate::Location::File, "holds no point, only comments"));
        }
        if looks_like_colours(&self.contents.normals) {
            self.contents.normals = Vec::new();
            self.contents.notes.push(Note::NormalsDropped {
                why: "columns 4 to 6 hold whole numbers up to 255, as colours do",
            });
        }
        Ok(self.contents)
    }
}

/// Three columns may be a normal or a colour: whole numbers from 0 to 255 throughout, and beyond 1 somewhere,
/// are no unit normals.
fn looks_like_colours(normals: &[DVec3]) -> bool {
    let whole = |v: f64| v.fract() == 0.0 && (0.0..=255.0).contains(&v);
    normals.iter().any(|n| n.max_element() > 1.0)
        && normals.iter().all(|n| n.to_array().into_iter().all(whole))
}

pub(crate) fn write(
    sink: &mut Sink,
    positions: &[DVec3],
    normals: Option<&[DVec3]>,
    format: Format,
    notes: &mut Vec<Note>,
) -> Result<(), Error> {
    let separator = if format == Format::Csv { b',' } else { b' ' };
    let normals = match format {
        Format::Pts if normals.is_some() => {
            notes.push(Note::NormalsDropped {
                why: "PTS has intensities and colours in their columns",
            });
            None
        }
        _ => normals,
    };
    match (format, normals) {
        (Format::Csv, Some(_)) => sink.put(b"x,y,z,nx,ny,nz\n")?,
        (Format::Csv, None) => sink.put(b"x,y,z\n")?,
        (Format::Pts, _) => sink.put(format!("{}\n", positions.len()).as_bytes())?,
        _ => {}
    }
    let mut text = Vec::new();
    for (i, &position) in positions.iter().enumerate() {
        text.clear();
        put_triple(&mut text, position, separator);
        if let Some(normals) = normals {
            text.push(separator);
            put_triple(&mut text, normals[i], separator);
        }
        text.push(b'\n');
        sink.put(&text)?;
        sink.item()?;
    }
    Ok(())
}
