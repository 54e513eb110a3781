//! A file being written: beside its name first, then in its place at once.

use crate::{Error, Overwrite};
use pellicle_geometry::{Cancelled, Progress};
use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use tempfile::NamedTempFile;

/// How often progress is told: once in so many items.
const TICK: u64 = 1 << 14;

/// A file under a temporary name in its future directory, or a device that is written directly.
pub(crate) struct Sink<'a> {
    out: BufWriter<Target>,
    path: &'a Path,
    overwrite: Overwrite,
    progress: &'a dyn Progress,
    bytes: u64,
    done: u64,
    total: u64,
}

enum Target {
    Temporary(NamedTempFile, PathBuf),
    Device(File),
}

impl Write for Target {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match self {
            Self::Temporary(file, _) => file.as_file_mut().write(bytes),
            Self::Device(file) => file.write(bytes),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match self {
            Self::Temporary(file, _) => file.as_file_mut().flush(),
            Self::Device(file) => file.flush(),
        }
    }
}

impl<'a> Sink<'a> {
    /// Starts a file of `total` items, for the progress.
    pub fn create(
        path: &'a Path,
        overwrite: Overwrite,
        progress: &'a dyn Progress,
        total: u64,
    ) -> Result<Self, Error> {
        let target = open(path, overwrite)?;
        Ok(Self {
            out: BufWriter::with_capacity(1 << 18, target),
            path,
            overwrite,
            progress,
            bytes: 0,
            done: 0,
            total,
        })
    }

    /// Counts one item as written, and asks now and then whether to go on.
    pub fn item(&mut self) -> Result<(), Error> {
        self.done += 1;
        if self.done.is_multiple_of(TICK) {
            Cancelled::check(self.progress.step("write", self.done, self.total))?;
        }
        Ok(())
    }

    /// How many items there will be, where that is not known at the start.
    pub fn expect(&mut self, total: u64) {
        self.total = total;
    }

    /// A nameless file beside this one, for what cannot be put in its order; where a device is written, among the
    /// temporary files of the machine.
    pub fn scratch(&self) -> Result<File, Error> {
        let file = match self.out.get_ref() {
            Target::Temporary(_, place) => tempfile::tempfile_in(directory(place)),
            Target::Device(_) => tempfile::tempfile(),
        };
        file.map_err(|e| create_error(self.path, e.kind().into()))
    }

    /// Writes, with the file named in the error.
    pub fn put(&mut self, bytes: &[u8]) -> Result<(), Error> {
        self.out
            .write_all(bytes)
            .map_err(|e| write_error(self.path, e))?;
        self.bytes += bytes.len() as u64;
        Ok(())
    }

    /// Brings everything to the disk and the file to its name; returns its size.
    pub fn finish(self) -> Result<u64, Error> {
        let Self {
            out,
            path,
            overwrite,
            progress,
            bytes,
            total,
            ..
        } = self;
        let target = out
            .into_inner()
            .map_err(|e| write_error(path, e.into_error()))?;
        // The last moment to stop: what follows is one rename.
        Cancelled::check(progress.step("write", total, total))?;
        match target {
            Target::Device(mut file) => file.flush().map_err(|e| write_error(path, e))?,
            Target::Temporary(file, place) => {
                file.as_file()
                    .sync_all()
                    .map_err(|e| write_error(path, e))?;
                match overwrite {
                    Overwrite::Replace => file.persist(&place),
                    Overwrite::Refuse => file.persist_noclobber(&place),
                }
                .map_err(|e| match e.error.kind() {
                    io::ErrorKind::AlreadyExists => Error::Exists {
                        path: path.to_owned(),
                    },
                    _ => write_error(path, e.error),
                })?;
            }
        }
        Ok(bytes)
    }
}

fn open(path: &Path, overwrite: Overwrite) -> Result<Target, Error> {
    let existing = match fs::metadata(path) {
        Ok(metadata) if metadata.is_dir() => {
            return Err(Error::Directory {
                path: path.to_owned(),
            });
        }
        Ok(metadata) => Some(metadata),
        Err(e) if e.kind() == io::ErrorKind::NotFound => None,
        Err(e) => return Err(create_error(path, e)),
    };
    if let Some(metadata) = &existing {
        if overwrite == Overwrite::Refuse {
            return Err(Error::Exists {
                path: path.to_owned(),
            });
        }
        // A device or a pipe, also where it leads to a redirected file: nothing to rename over.
        if !metadata.is_file() || path.starts_with("/dev") || path.starts_with("/proc") {
            return OpenOptions::new()
                .write(true)
                .open(path)
                .map(Target::Device)
                .map_err(|e| create_error(path, e));
        }
        if metadata.permissions().readonly() {
            return Err(create_error(path, io::ErrorKind::PermissionDenied.into()));
        }
    }
    // Through a symbolic link to the file behind it.
    let place = match &existing {
        Some(_) => fs::canonicalize(path).map_err(|e| create_error(path, e))?,
        None => path.to_owned(),
    };
    let directory = directory(&place);
    let mut builder = tempfile::Builder::new();
    builder.prefix(".pellicle-").suffix(".part");
    let permissions = existing.map(|metadata| metadata.permissions());
    #[cfg(unix)]
    let permissions = permissions.or_else(|| {
        // As any new file has: the mask of the process applies.
        use std::os::unix::fs::PermissionsExt;
        Some(fs::Permissions::from_mode(0o666))
    });
    if let Some(permissions) = permissions {
        builder.permissions(permissions);
    }
    builder
        .tempfile_in(directory)
        .map(|file| Target::Temporary(file, place.clone()))
        .map_err(|e| {
            let e = match e.kind() {
                io::ErrorKind::NotFound => io::Error::new(
                    e.kind(),
                    format!(
                        "there is no directory {}; create it first",
                        directory.display()
                    ),
                ),
                // The temporary name means nothing to the caller.
                _ => e.kind().into(),
            };
            create_error(path, e)
        })
}

fn directory(place: &Path) -> &Path {
    match place.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    }
}

fn create_error(path: &Path, source: io::Error) -> Error {
    Error::Io {
        path: path.to_owned(),
        action: "created",
        reason: source,
    }
}

fn write_error(path: &Path, source: io::Error) -> Error {
    Error::Io {
        path: path.to_owned(),
        action: "written",
        reason: source,
    }
}
