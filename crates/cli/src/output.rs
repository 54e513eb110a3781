//! Standard output, and the checks of a file that is to be written.

use crate::arguments::{Encoding, Global, Target};
use crate::failure::Failure;
use crate::interrupt;
use crate::progress::Watch;
use pellicle::io::{self, Content, Format, Note, Overwrite, WriteOptions, WriteReport};
use pellicle::mesh::TriMesh;
use serde::Serialize;
use std::io::{ErrorKind, Write};
use std::path::Path;

/// Writes text to standard output. A reader that has gone is no failure.
pub fn print(text: &str) -> Result<(), Failure> {
    let mut output = std::io::stdout().lock();
    match output
        .write_all(text.as_bytes())
        .and_then(|()| output.flush())
    {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(Failure::StandardOutput(error)),
        _ => Ok(()),
    }
}

/// Writes a value to standard output as JSON.
pub fn print_json(value: &impl Serialize) -> Result<(), Failure> {
    print(&json(value)?)
}

/// A value as JSON, for people too.
pub fn json(value: &impl Serialize) -> Result<String, Failure> {
    let text = serde_json::to_string_pretty(value)
        .map_err(|error| Failure::StandardOutput(error.into()))?;
    Ok(text + "\n")
}

/// Says as JSON what was done, if asked to.
pub fn report(global: &Global, value: &impl Serialize) -> Result<(), Failure> {
    if global.json {
        print_json(value)
    } else {
        Ok(())
    }
}

/// A number with six digits that tell.
pub fn digits(value: f64) -> String {
    let magnitude = value.abs().log10();
    match value {
        0.0 => "0".to_owned(),
        _ if !(-4.0..9.0).contains(&magnitude) => format!("{value:.5e}"),
        _ => format!("{value:.*}", (5 - magnitude.floor() as i32).max(0) as usize),
    }
}

/// Logs what a reader or writer left out or changed.
pub fn log_notes(path: &Path, notes: &[Note]) {
    for note in notes {
        tracing::warn!("{}: {note}", path.display());
    }
}

/// Fails early where a file exists, is a directory, or has no directory to stand in.
pub fn check_place(path: &Path, force: bool) -> Result<(), Failure> {
    if let Ok(metadata) = std::fs::metadata(path) {
        let path = path.to_owned();
        if metadata.is_dir() {
            return Err(io::Error::Directory { path }.into());
        }
        if !force {
            return Err(io::Error::Exists { path }.into());
        }
    }
    check_parent(path)
}

/// Fails where a file or directory has no directory to stand in.
pub fn check_parent(path: &Path) -> Result<(), Failure> {
    match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() && !parent.is_dir() => {
            let reason = format!(
                "there is no directory {}; create it first",
                parent.display()
            );
            Err(Failure::File(io::Error::Io {
                path: path.to_owned(),
                action: "created",
                reason: std::io::Error::new(ErrorKind::NotFound, reason),
            }))
        }
        _ => Ok(()),
    }
}

impl Target {
    /// How the library is to write it.
    pub fn options<'a>(&self, watch: &'a Watch) -> WriteOptions<'a> {
        WriteOptions {
            overwrite: if self.force {
                Overwrite::Replace
            } else {
                Overwrite::Refuse
            },
            encoding: match self.encoding {
                Encoding::Binary => io::Encoding::Binary,
                Encoding::Text => io::Encoding::Text,
            },
            progress: watch,
            ..WriteOptions::default()
        }
    }

    /// Fails early where writing `content` would fail late.
    pub fn check(&self, content: Content) -> Result<(), Failure> {
        let format = Format::from_path(&self.output)?;
        if !format.can_write(content) {
            return Err(Failure::File(io::Error::CannotHold {
                path: self.output.clone(),
                format,
                what: content,
            }));
        }
        self.check_place()
    }

    /// Fails early where the file exists, is a directory, or has no directory to stand in.
    pub fn check_place(&self) -> Result<(), Failure> {
        check_place(&self.output, self.force)
    }

    /// Fails early where a further result cannot stand at `path`, or would stand where this one does.
    pub fn check_further(&self, path: Option<&Path>) -> Result<(), Failure> {
        match path {
            Some(path) if path == self.output => Err(Failure::SameOutput {
                path: path.to_owned(),
            }),
            Some(path) => check_place(path, self.force),
            None => Ok(()),
        }
    }

    /// Writes a mesh, and logs what the format could not keep.
    pub fn write_mesh(&self, mesh: &TriMesh, watch: &Watch) -> Result<WriteReport, Failure> {
        self.write(|| io::write_mesh(&self.output, mesh, None, &self.options(watch)))
    }

    /// Runs a writer, and logs what it could not keep.
    pub fn write(
        &self,
        write: impl FnOnce() -> Result<WriteReport, io::Error>,
    ) -> Result<WriteReport, Failure> {
        let report = interrupt::while_writing(write)?;
        log_notes(&self.output, &report.notes);
        Ok(report)
    }
}

#[cfg(test)]
mod tests {
    use super::digits;

    #[test]
    fn six_digits_tell() {
        for (value, expected) in [
            (0.0, "0"),
            (1.0, "1.00000"),
            (-12.345_678_9, "-12.3457"),
            (0.000_123_456_789, "0.000123457"),
            (1_234_567.8, "1234568"),
            (1.234_567_8e12, "1.23457e12"),
            (1.234_567_8e-12, "1.23457e-12"),
            (f64::NAN, "NaN"),
        ] {
            assert_eq!(digits(value), expected);
        }
    }
}
