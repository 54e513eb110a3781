//! Everything that can end a run, and what helps.

use miette::Diagnostic;
use pellicle::geometry::{Cancelled, CloudError, DVec3};
use pellicle::{cocone, delaunay, evolution, io, mesh, render, transformesh};
use std::fmt;
use std::path::PathBuf;

/// Why the program failed.
#[derive(Debug, thiserror::Error)]
pub enum Failure {
    /// A file was not read or not written.
    #[error(transparent)]
    File(#[from] io::Error),
    /// Points have no tetrahedra.
    #[error("{}: {reason}", .path.display())]
    Delaunay {
        /// The file.
        path: PathBuf,
        /// The reason.
        reason: delaunay::Error,
    },
    /// Tetrahedra have no surface.
    #[error("{}: {reason}", .path.display())]
    Cocone {
        /// The file.
        path: PathBuf,
        /// The reason.
        reason: cocone::Error,
    },
    /// A surface did not evolve onto points, or was not smoothed.
    #[error("{}: {reason}", .path.display())]
    Evolution {
        /// The file: the cloud, or the surface that is the reason.
        path: PathBuf,
        /// The reason.
        reason: evolution::Error,
    },
    /// A surface did not morph into another.
    #[error("{}: {reason}", .path.display())]
    Morph {
        /// The file: source or target, whichever is the reason.
        path: PathBuf,
        /// The reason.
        reason: transformesh::Error,
    },
    /// A mesh was not measured, or not remeshed.
    #[error("{}: {reason}", .path.display())]
    Mesh {
        /// The file.
        path: PathBuf,
        /// The reason.
        reason: mesh::MeshError,
    },
    /// A mesh was not repaired, or not searched for where it meets itself.
    #[error("{}: {reason}", .path.display())]
    Repair {
        /// The file.
        path: PathBuf,
        /// The reason.
        reason: transformesh::Error,
    },
    /// A mesh that was to be repaired has no inside.
    #[error(
        "{}: the surface is open, so it has no inside: at {edges} edges a triangle has no partner, or one that faces the \
         other way; the first runs from {from} to {to}",
        .path.display()
    )]
    Open {
        /// The file.
        path: PathBuf,
        /// At how many edges.
        edges: usize,
        /// One end of the first.
        from: DVec3,
        /// Its other end.
        to: DVec3,
    },
    /// Two files were not compared.
    #[error("{}, {}: {reason}", .first.display(), .second.display())]
    Compare {
        /// One file.
        first: PathBuf,
        /// The other.
        second: PathBuf,
        /// The reason.
        reason: mesh::MeshError,
    },
    /// Normals do not fit their points.
    #[error(transparent)]
    Cloud(#[from] CloudError),
    /// A picture was not drawn.
    #[error("{}: {reason}", .path.display())]
    Render {
        /// The file.
        path: PathBuf,
        /// The reason.
        reason: render::Error,
    },
    /// A file holds no point.
    #[error("{}: holds no point, so there is nothing to show", .path.display())]
    NothingToShow {
        /// The file.
        path: PathBuf,
    },
    /// A folder holds no numbered mesh.
    #[error("{}: is a directory without numbered meshes or points such as step-000010.ply", .path.display())]
    NoSteps {
        /// The folder.
        path: PathBuf,
    },
    /// A page would be larger than a browser takes.
    #[error("{}: the page would have {bytes} bytes; browsers take about {most}", .path.display())]
    PageTooLarge {
        /// The page.
        path: PathBuf,
        /// Its size.
        bytes: usize,
        /// What can be read.
        most: usize,
    },
    /// The output's extension does not name a format that can hold the result.
    #[error("{}: {verb} cannot write this format; it writes {known}", .path.display())]
    OutputFormat {
        /// The file.
        path: PathBuf,
        /// The verb.
        verb: &'static str,
        /// The extensions that it can write.
        known: String,
    },
    /// Two results were to be written to one file.
    #[error("{}: is named for two results", .path.display())]
    SameOutput {
        /// The file.
        path: PathBuf,
    },
    /// Standard output was not written.
    #[error("standard output cannot be written: {0}")]
    StandardOutput(std::io::Error),
    /// Threads were not started.
    #[error("cannot start threads: {0}")]
    Threads(String),
    /// Ctrl-C could not be listened for.
    #[error("cannot listen for signals: {0}")]
    Signals(String),
    /// Ctrl-C.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

impl Failure {
    /// Whether Ctrl-C is the reason.
    pub fn is_interruption(&self) -> bool {
        matches!(
            self,
            Self::Cancelled(_)
                | Self::File(io::Error::Cancelled(_))
                | Self::Delaunay {
                    reason: delaunay::Error::Cancelled(_),
                    ..
                }
                | Self::Cocone {
                    reason: cocone::Error::Cancelled(_),
                    ..
                }
                | Self::Evolution {
                    reason: evolution::Error::Cancelled(_)
                        | evolution::Error::Mesh(mesh::MeshError::Cancelled(_)),
                    ..
                }
                | Self::Morph {
                    reason: transformesh::Error::Cancelled(_),
                    ..
                }
                | Self::Mesh {
                    reason: mesh::MeshError::Cancelled(_),
                    ..
                }
                | Self::Repair {
                    reason: transformesh::Error::Cancelled(_)
                        | transformesh::Error::Mesh(mesh::MeshError::Cancelled(_)),
                    ..
                }
                | Self::Compare {
                    reason: mesh::MeshError::Cancelled(_),
                    ..
                }
        )
    }

    fn advice(&self) -> Option<&'static str> {
        Some(match self {
            Self::File(io::Error::Exists { .. }) => "pass --force to replace it",
            Self::File(io::Error::NoTriangles { .. }) => {
                "make a mesh of the points first: pellicle reconstruct IN -o OUT"
            }
            Self::Delaunay { reason, .. } => match reason {
                delaunay::Error::TooFewPoints { .. } => "a surface needs at least four points",
                delaunay::Error::Collinear { .. } | delaunay::Error::Coplanar { .. } => {
                    "flat data has no inside; a surface in space needs points off the plane"
                }
                _ => return None,
            },
            Self::Evolution {
                reason:
                    evolution::Error::NotFinite { .. }
                    | evolution::Error::Linear(_)
                    | evolution::Error::Collapsed { .. },
                ..
            } => "with --snapshots DIR the surfaces up to that step are kept",
            Self::Morph {
                reason: transformesh::Error::Vanished { .. },
                ..
            } => "with --place enclose or --place fit the source starts on the target",
            Self::Open { .. } => {
                "close it first; or --rule outside keeps what is seen from outside, and the borders"
            }
            Self::PageTooLarge { .. } => "show fewer steps, or remesh with longer edges first",
            Self::SameOutput { .. } => "name different files",
            _ => return None,
        })
    }
}

impl Diagnostic for Failure {
    fn help<'a>(&'a self) -> Option<Box<dyn fmt::Display + 'a>> {
        self.advice()
            .map(|advice| Box::new(advice) as Box<dyn fmt::Display>)
    }
}
