//! What was done to the data on the way.

use crate::Format;
use pellicle_geometry::DVec3;
use std::fmt;

/// What a reader found and how it dealt with it.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct ReadReport {
    /// The format of the file.
    pub format: Format,
    /// Tolerated defects, and contents that were left out.
    pub notes: Vec<Note>,
}

/// What a writer did.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct WriteReport {
    /// The format of the file.
    pub format: Format,
    /// Its size in bytes.
    pub bytes: u64,
    /// What could not be kept as it was.
    pub notes: Vec<Note>,
}

impl WriteReport {
    /// What was subtracted from every position, if the format holds single precision only and the
    /// positions do not fit it. To be added back to what is read from the file; a GLB file does so itself.
    pub fn shift(&self) -> Option<DVec3> {
        self.notes.iter().find_map(|note| match note {
            Note::Shifted { shift, .. } => Some(*shift),
            _ => None,
        })
    }
}

/// One thing worth knowing about a file that was read or written.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Note {
    /// Polygons with more than three corners were cut into triangles, as fans from their first corner.
    Triangulated {
        /// How many polygons.
        polygons: u64,
    },
    /// Triangle strips were cut into their triangles.
    Strips {
        /// How many strips.
        strips: u64,
    },
    /// Something that is neither point, normal nor polygon was left out.
    Ignored {
        /// What.
        what: String,
        /// How many times.
        count: u64,
    },
    /// Points that the file marks as missing (all coordinates NaN, in PCD) were left out.
    Missing {
        /// How many.
        points: u64,
    },
    /// Corners with equal coordinates became one vertex.
    Merged {
        /// How many corners.
        corners: u64,
        /// How many vertices.
        vertices: u64,
    },
    /// The vertices were placed by the nodes of a scene.
    Transformed {
        /// How many nodes with a transform.
        nodes: u64,
    },
    /// The format holds single precision: positions are rounded.
    Rounded {
        /// The largest distance along an axis between a position and its rounding, in the units of
        /// the coordinates.
        error: f64,
    },
    /// `shift` was subtracted from every position before rounding to single precision.
    Shifted {
        /// The shift, itself exact in single precision.
        shift: DVec3,
        /// Whether the file tells its readers to add the shift back (GLB) or cannot (STL).
        restored_by_file: bool,
    },
    /// The format or the file has no place for the normals.
    NormalsDropped {
        /// Why.
        why: &'static str,
    },
}

impl fmt::Display for Note {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Triangulated { polygons } => {
                write!(f, "{polygons} polygons cut into triangles")
            }
            Self::Strips { strips } => write!(f, "{strips} strips cut into triangles"),
            Self::Ignored { what, count } => write!(f, "{count} {what} ignored"),
            Self::Missing { points } => write!(f, "{points} points without a measurement left out"),
            Self::Merged { corners, vertices } => {
                write!(f, "{corners} corners merged to {vertices} vertices")
            }
            Self::Transformed { nodes } => write!(f, "the transforms of {nodes} nodes applied"),
            Self::Rounded { error } => {
                write!(f, "rounded to single precision, by at most {error:e}")
            }
            Self::Shifted {
                shift: DVec3 { x, y, z },
                restored_by_file,
            } => {
                write!(f, "shifted by ({x:?}, {y:?}, {z:?}), ")?;
                f.write_str(if *restored_by_file {
                    "which the file adds back"
                } else {
                    "which is to be added to what is read from the file"
                })
            }
            Self::NormalsDropped { why } => write!(f, "normals dropped: {why}"),
        }
    }
}
