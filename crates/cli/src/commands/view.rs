//! `pellicle view`.

use crate::arguments::{Global, positive};
use crate::failure::Failure;
use crate::interrupt;
use crate::output;
use crate::page::{self, Page, Shown, Up};
use crate::progress::Watch;
use clap::{Args, ValueEnum};
use pellicle::io::{self, Data, Overwrite, WriteOptions, write_text};
use serde::Serialize;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};

const EXAMPLE: &str = "\
Examples:
  pellicle view mesh.ply -o mesh.html
  pellicle view scan.xyz mesh.ply -o both.html
  pellicle evolve scan.xyz -o surface.ply --snapshots frames && pellicle view frames -o frames.html

The page needs no network and no other file. Drag turns, the wheel or two fingers come nearer, the right button moves; \
keys: arrows turn, + and - come nearer and go away, S surface, W wireframe, P points, R resets, space plays. What follows \
a # in its address is shown at first: #view=front&wireframe=on&step=3&play=on, and panel=off hides the panel.";

/// More triangles and points than this may be slow to turn on a small machine.
const MANY: usize = 4_000_000;

/// No browser takes much more than this in one text.
const MOST_BYTES: usize = 400 << 20;

/// Write a page that shows meshes and points in a browser, to be turned around
///
/// A folder of snapshots, or files whose names differ by a number at their end, are steps that the page plays; other
/// files are layers.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLE)]
pub struct View {
    /// Meshes or points; or folders, of which the numbered meshes are taken
    #[arg(value_name = "IN", required = true)]
    inputs: Vec<PathBuf>,
    /// The page to write
    #[arg(long, short, value_name = "OUT")]
    output: PathBuf,
    /// Replace the file if it exists
    #[arg(long)]
    force: bool,
    /// How several inputs are shown
    #[arg(long = "as", value_name = "HOW", default_value = "auto")]
    shown: As,
    /// The axis of the data that points up
    #[arg(long, value_name = "AXIS", default_value = "y")]
    up: Axis,
    /// How long a step is shown
    #[arg(long, value_name = "SECONDS", default_value = "0.1", value_parser = positive)]
    seconds: f64,
    /// What the page is called; by default the names of the inputs
    #[arg(long, value_name = "TEXT")]
    title: Option<String>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum As {
    /// Steps if they come of folders or are numbered, and else layers
    Auto,
    /// All at once, each in a colour of its own
    Layers,
    /// One after the other
    Steps,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Axis {
    Y,
    Z,
}

#[derive(Serialize)]
struct Done {
    output: PathBuf,
    /// `layers` or `steps`.
    shown: Shown,
    items: Vec<DoneItem>,
    bytes: u64,
}

#[derive(Serialize)]
struct DoneItem {
    file: PathBuf,
    vertices: usize,
    triangles: usize,
}

impl View {
    /// Reads everything, writes one page.
    pub fn run(self, global: &Global, watch: &Watch) -> Result<(), Failure> {
        let extension = self.output.extension().map(OsStr::to_ascii_lowercase);
        if !extension.is_some_and(|extension| extension == "html" || extension == "htm") {
            return Err(Failure::OutputFormat {
                path: self.output,
                verb: "view",
                known: "html, htm".to_owned(),
            });
        }
        output::check_place(&self.output, self.force)?;
        let files = files(&self.inputs)?;
        let shown = self.shown(&files);
        let items = read(&files, watch)?;
        let page = Page {
            title: self.title.clone().unwrap_or_else(|| self.name()),
            shown,
            up: match self.up {
                Axis::Y => Up::Y,
                Axis::Z => Up::Z,
            },
            seconds: self.seconds,
            items: &items,
        };
        let text = page.to_html()?;
        if text.len() > MOST_BYTES {
            return Err(Failure::PageTooLarge {
                path: self.output,
                bytes: text.len(),
                most: MOST_BYTES,
            });
        }
        let options = WriteOptions {
            overwrite: match self.force {
                true => Overwrite::Replace,
                false => Overwrite::Refuse,
            },
            progress: watch,
            ..WriteOptions::default()
        };
        let bytes = interrupt::while_writing(|| write_text(&self.output, &text, &options))?;
        let done = Done {
            output: self.output,
            shown,
            items: files.into_iter().zip(&items).map(DoneItem::of).collect(),
            bytes,
        };
        done.log();
        output::report(global, &done)
    }

    fn shown(&self, files: &[PathBuf]) -> Shown {
        match self.shown {
            As::Layers => Shown::Layers,
            As::Steps => Shown::Steps,
            As::Auto if files.len() > 1 && is_numbered(files) => Shown::Steps,
            As::Auto => Shown::Layers,
        }
    }

    /// The names of the inputs, of many only the first and the last.
    fn name(&self) -> String {
        let names: Vec<String> = self.inputs.iter().map(|input| page::name(input)).collect();
        match names.as_slice() {
            [first, _, .., last] if names.len() > 3 => format!("{first} … {last}"),
            names => names.join(", "),
        }
    }
}

impl DoneItem {
    fn of((file, item): (PathBuf, &page::Item)) -> Self {
        Self {
            file,
            vertices: item.positions().len(),
            triangles: item.triangles().len(),
        }
    }
}

impl Done {
    fn log(&self) {
        let count: usize = self.items.iter().map(|i| i.vertices.max(i.triangles)).sum();
        let kind = match self.shown {
            _ if self.items.len() == 1 => "",
            Shown::Layers => " as layers",
            Shown::Steps => " as steps",
        };
        tracing::info!(
            "{} files{kind}, {:.1} MB: open {} in a browser",
            self.items.len(),
            self.bytes as f64 / 1e6,
            self.output.display()
        );
        if self.shown == Shown::Layers && count > MANY {
            tracing::warn!(
                "{count} triangles and points may be slow to turn; remesh with --relative 2 takes a quarter of the triangles"
            );
        }
    }
}

/// The inputs, folders replaced by the numbered files in them, in the order of the numbers.
fn files(inputs: &[PathBuf]) -> Result<Vec<PathBuf>, Failure> {
    let mut files = Vec::new();
    for input in inputs {
        if !input.is_dir() {
            files.push(input.clone());
            continue;
        }
        let failed = |reason| {
            Failure::File(io::Error::Io {
                path: input.clone(),
                action: "read",
                reason,
            })
        };
        let mut found = Vec::new();
        for entry in std::fs::read_dir(input).map_err(failed)? {
            let path = entry.map_err(failed)?.path();
            let is_readable = io::Format::from_path(&path).is_ok();
            if let (true, Some((stem, number))) = (is_readable, number(&path)) {
                found.push((stem, number, path));
            }
        }
        if found.is_empty() {
            return Err(Failure::NoSteps {
                path: input.clone(),
            });
        }
        found.sort();
        files.extend(found.into_iter().map(|(.., path)| path));
    }
    Ok(files)
}

/// What stands before the number at the end of a file's stem, and the number.
fn number(path: &Path) -> Option<(String, u64)> {
    let stem = path.file_stem()?.to_string_lossy().into_owned();
    let before = stem.trim_end_matches(|letter: char| letter.is_ascii_digit());
    let number = stem[before.len()..].parse().ok()?;
    Some((before.to_owned(), number))
}

/// Whether the names differ by their numbers alone.
fn is_numbered(files: &[PathBuf]) -> bool {
    let parts: Option<Vec<(String, u64)>> = files.iter().map(|file| number(file)).collect();
    parts.is_some_and(|parts| {
        let same = parts.windows(2).all(|pair| pair[0].0 == pair[1].0);
        same && parts.windows(2).all(|pair| pair[0].1 != pair[1].1)
    })
}

/// Reads every file; one without a point is an error.
fn read(files: &[PathBuf], watch: &Watch) -> Result<Vec<page::Item>, Failure> {
    let item = |file: &PathBuf| {
        let item = match super::read(file, watch)?.data {
            Data::Mesh { soup, .. } => page::Item::mesh(file, soup),
            Data::Points(cloud) => page::Item::points(file, cloud),
        };
        match item.positions().is_empty() {
            true => Err(Failure::NothingToShow { path: file.clone() }),
            false => Ok(item),
        }
    };
    files.iter().map(item).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn numbered(names: &[&str]) -> bool {
        let files: Vec<PathBuf> = names.iter().map(PathBuf::from).collect();
        is_numbered(&files)
    }

    #[test]
    fn steps_are_known_by_their_names() {
        assert!(numbered(&[
            "step-000000.ply",
            "step-000010.ply",
            "step-000020.ply"
        ]));
        assert!(numbered(&["a/7.off", "b/12.off"]));
        assert!(!numbered(&["scan.xyz", "mesh.ply"]));
        assert!(!numbered(&["a1.ply", "b2.ply"]));
        assert!(!numbered(&["a1.ply", "a1.off"]));
        assert!(!numbered(&["a1.ply", "a.ply"]));
        assert!(!numbered(&["a99999999999999999999999.ply", "a2.ply"]));
    }
}
