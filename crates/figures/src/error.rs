//! Why there is no figure.

use pellicle::{cocone, delaunay, evolution, geometry, io, mesh, render, transformesh};
use std::path::PathBuf;

/// Why a figure could not be made, drawn, stored or compared.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The observer asked for a stop.
    #[error(transparent)]
    Cancelled(#[from] geometry::Cancelled),
    /// A cloud was refused.
    #[error(transparent)]
    Cloud(#[from] geometry::CloudError),
    /// A mesh was refused.
    #[error(transparent)]
    Mesh(#[from] mesh::MeshError),
    /// The tetrahedralisation failed.
    #[error(transparent)]
    Delaunay(#[from] delaunay::Error),
    /// The reconstruction failed.
    #[error(transparent)]
    Cocone(#[from] cocone::Error),
    /// The evolution failed.
    #[error(transparent)]
    Evolution(#[from] evolution::Error),
    /// The repair or the morphing failed.
    #[error(transparent)]
    TransforMesh(#[from] transformesh::Error),
    /// A scene could not be drawn.
    #[error(transparent)]
    Render(#[from] render::Error),
    /// A fixture could not be read, or a result not be written.
    #[error(transparent)]
    Io(#[from] io::Error),
    /// What the figure is to show did not happen.
    #[error("the figure does not show what it should: {0}")]
    NotShown(String),
    /// A number is NaN or infinite.
    #[error("the number \"{name}\" is {value}")]
    NotFinite {
        /// The number's name.
        name: String,
        /// What it is.
        value: f64,
    },
    /// Two numbers of a figure have one name.
    #[error("two numbers are called \"{name}\"")]
    SameName {
        /// The name.
        name: String,
    },
    /// No figure is called so.
    #[error("there is no figure \"{name}\"")]
    NoSuchFigure {
        /// What was asked for.
        name: String,
    },
    /// A picture could not be encoded.
    #[error("a picture of {width} × {height} pixels could not be encoded: {reason}")]
    Png {
        /// Pixels in a row.
        width: u32,
        /// Rows.
        height: u32,
        /// What the encoder says.
        reason: String,
    },
    /// The sheet is no SVG that could be drawn.
    #[error("the sheet could not be drawn: {0}")]
    Svg(String),
    /// A file could not be read or written.
    #[error("{}: {reason}", .path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// What the system says.
        reason: std::io::Error,
    },
    /// Stored numbers could not be understood.
    #[error("{}: {reason}", .path.display())]
    Stored {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        reason: serde_json::Error,
    },
}
