//! What can go wrong, with the file and the place in it.

use crate::Format;
use pellicle_geometry::{Cancelled, VertexId};
use std::fmt;
use std::path::PathBuf;

/// Where in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Location {
    /// A line of text; the first is 1.
    Line(u64),
    /// An offset in bytes; the first is 0.
    Byte(u64),
    /// The file as a whole.
    File,
}

impl fmt::Display for Location {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Line(line) => write!(f, "line {line}"),
            Self::Byte(byte) => write!(f, "byte {byte}"),
            Self::File => f.write_str("the file"),
        }
    }
}

/// Why a file was not read or not written. Every variant that concerns a file names it.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The extension is not one of a known format.
    #[error("{}: no format has the extension {extension:?}; known are {}", .path.display(), crate::format::known())]
    UnknownFormat {
        /// The file.
        path: PathBuf,
        /// Its extension; empty if there is none.
        extension: String,
    },
    /// The format cannot hold what is to be written, or cannot be written at all.
    #[error("{}: {format} files cannot hold {what} here; write one of {}", .path.display(), crate::format::able(*what))]
    CannotHold {
        /// The file.
        path: PathBuf,
        /// Its format.
        format: Format,
        /// What was to be written.
        what: Content,
    },
    /// The path names a directory.
    #[error("{}: is a directory; name a file in it", .path.display())]
    Directory {
        /// The path.
        path: PathBuf,
    },
    /// The file to be written exists, and may not be replaced.
    #[error("{}: exists already and is left as it is; allow replacing it, or choose another name", .path.display())]
    Exists {
        /// The file.
        path: PathBuf,
    },
    /// The operating system refused.
    #[error("{}: cannot be {action}: {reason}", .path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// What was tried: "opened", "read", "created", "written".
        action: &'static str,
        /// Why. Part of the message, and so not its `source`.
        reason: std::io::Error,
    },
    /// The file breaks its format, or uses a part of it that is not supported.
    #[error("{}: {location}: {reason}", .path.display())]
    Malformed {
        /// The file.
        path: PathBuf,
        /// Where in it.
        location: Location,
        /// What is wrong there, and what helps.
        reason: String,
    },
    /// A coordinate in the file is NaN, infinite, or past the range of `f64`.
    #[error("{}: {location}: vertex {vertex} has a coordinate that is not finite; remove the vertex or export the file again", .path.display())]
    NotFinite {
        /// The file.
        path: PathBuf,
        /// Where in it.
        location: Location,
        /// Which vertex of the file; the first is 0.
        vertex: u64,
    },
    /// More vertices or triangles than `u32` ids or the memory of this machine can hold.
    #[error("{}: {count} {what} are more than can be held", .path.display())]
    TooMany {
        /// The file.
        path: PathBuf,
        /// How many.
        count: u64,
        /// Of what: "vertices", "triangles".
        what: &'static str,
    },
    /// A mesh was asked for, and the file has points only.
    #[error("{}: holds {vertices} points and no triangle; reconstruct a surface from it first", .path.display())]
    NoTriangles {
        /// The file.
        path: PathBuf,
        /// How many points it holds.
        vertices: usize,
    },
    /// A coordinate to be written is NaN or infinite.
    #[error("{}: not written: vertex {} has a coordinate that is not finite", .path.display(), .vertex.0)]
    VertexNotFinite {
        /// The file.
        path: PathBuf,
        /// The first such vertex.
        vertex: VertexId,
    },
    /// A triangle to be written has a corner that is not a vertex.
    #[error("{}: not written: triangle {triangle} has a corner {} that is none of the {vertices} vertices", .path.display(), .vertex.0)]
    VertexOutOfRange {
        /// The file.
        path: PathBuf,
        /// The triangle.
        triangle: usize,
        /// Its corner.
        vertex: VertexId,
        /// How many vertices there are.
        vertices: usize,
    },
    /// A tetrahedron to be written has a corner that is not a vertex.
    #[error("{}: not written: tetrahedron {tetrahedron} has a corner {} that is none of the {vertices} vertices", .path.display(), .vertex.0)]
    CornerOutOfRange {
        /// The file.
        path: PathBuf,
        /// The tetrahedron.
        tetrahedron: usize,
        /// Its corner.
        vertex: VertexId,
        /// How many vertices there are.
        vertices: usize,
    },
    /// There are not as many normals as vertices.
    #[error("{}: not written: {normals} normals for {vertices} vertices", .path.display())]
    NormalCount {
        /// The file.
        path: PathBuf,
        /// How many vertices.
        vertices: usize,
        /// How many normals.
        normals: usize,
    },
    /// The coordinates do not fit the single precision of the format, even after a shift.
    #[error("{}: not written: the coordinates exceed the single precision of {format}; write one of {}", .path.display(), crate::format::able(Content::Mesh))]
    Range {
        /// The file.
        path: PathBuf,
        /// Its format.
        format: Format,
    },
    /// The bytes of a picture do not match its size.
    #[error("{}: not written: {bytes} bytes for a picture of {width} by {height} pixels, {expected} expected", .path.display())]
    PictureSize {
        /// The file.
        path: PathBuf,
        /// Pixels in a row.
        width: u32,
        /// Rows.
        height: u32,
        /// How many bytes there are.
        bytes: usize,
        /// How many there must be.
        expected: u64,
    },
    /// A frame's time is not a positive number, or so short or long that single precision cannot tell the frames apart.
    #[error("{}: not written: {seconds} seconds a frame; take a time such as 0.1", .path.display())]
    FrameSeconds {
        /// The file.
        path: PathBuf,
        /// The time that was asked for.
        seconds: f64,
    },
    /// A format whose vertices have no named properties was asked for one.
    #[error("{}: {format} files have no named properties that are read here; PLY files have", .path.display())]
    NoProperties {
        /// The file.
        path: PathBuf,
        /// Its format.
        format: Format,
    },
    /// The vertices of a file lack a property.
    #[error("{}: the vertices have no number {name:?}; they have {known}", .path.display())]
    NoSuchProperty {
        /// The file.
        path: PathBuf,
        /// What was asked for.
        name: String,
        /// What there is, separated by commas.
        known: String,
    },
    /// The observer asked to stop; nothing was written.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// What a file can hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Content {
    /// Points, perhaps with normals.
    Points,
    /// Points with a normal each, and none without.
    Normals,
    /// Triangles over vertices.
    Mesh,
}

impl fmt::Display for Content {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Points => "points without normals",
            Self::Normals => "points with normals",
            Self::Mesh => "triangles",
        })
    }
}
