//! Tetrahedra out: VTK's legacy format, and Medit's.
//!
//! Both are written only. Sources: "The VTK File Formats" (simple legacy formats), and the description of
//! `.mesh` files in the documentation of Medit.

use crate::sink::Sink;
use crate::{Encoding, Error, WriteOptions};
use pellicle_geometry::{DVec3, VertexId, first_not_finite};
use std::fmt;
use std::path::Path;

/// A file format for tetrahedra, known by the extension of the file's name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum VolumeFormat {
    /// The Visualization Toolkit's legacy format, as an unstructured grid: text or big-endian binary.
    Vtk,
    /// Medit's text format, with ids from 1.
    Medit,
}

impl VolumeFormat {
    /// Every format.
    pub const ALL: [Self; 2] = [Self::Vtk, Self::Medit];

    /// The format that the extension of `path` names, in either case; `None` if it names none.
    ///
    /// ```
    /// use pellicle_io::VolumeFormat;
    /// assert_eq!(VolumeFormat::from_path("tets.VTK"), Some(VolumeFormat::Vtk));
    /// assert_eq!(VolumeFormat::from_path("mesh.ply"), None);
    /// ```
    pub fn from_path(path: impl AsRef<Path>) -> Option<Self> {
        let extension = path.as_ref().extension()?.to_str()?.to_ascii_lowercase();
        Self::ALL
            .into_iter()
            .find(|format| format.extension() == extension)
    }

    /// The extension that names this format.
    pub fn extension(self) -> &'static str {
        match self {
            Self::Vtk => "vtk",
            Self::Medit => "mesh",
        }
    }
}

impl fmt::Display for VolumeFormat {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Vtk => "VTK",
            Self::Medit => "Medit",
        })
    }
}

/// Writes tetrahedra over `positions`, all of which are written in their order; returns the size in bytes.
///
/// Positive corners, det[b − a, c − a, d − a] > 0, are what both formats call positive. Coordinates are
/// kept to the last bit. The file appears under its name at once and complete, or not at all. Linear time.
///
/// ```
/// use pellicle_geometry::{DVec3, VertexId};
/// use pellicle_io::{VolumeFormat, WriteOptions, write_tetrahedra};
///
/// let directory = tempfile::tempdir()?;
/// let positions = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
/// let path = directory.path().join("one.vtk");
/// let tetrahedron = [0, 1, 2, 3].map(VertexId);
/// write_tetrahedra(&path, VolumeFormat::Vtk, &positions, &[tetrahedron], &WriteOptions::default())?;
/// assert!(std::fs::read(&path)?.starts_with(b"# vtk DataFile Version 3.0\n"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn write_tetrahedra(
    path: impl AsRef<Path>,
    format: VolumeFormat,
    positions: &[DVec3],
    tetrahedra: &[[VertexId; 4]],
    options: &WriteOptions,
) -> Result<u64, Error> {
    let path = path.as_ref();
    check(path, positions, tetrahedra)?;
    let total = (positions.len() + tetrahedra.len()) as u64;
    let mut sink = Sink::create(path, options.overwrite, options.progress, total)?;
    match (format, options.encoding) {
        (VolumeFormat::Vtk, Encoding::Binary) => vtk_binary(&mut sink, positions, tetrahedra)?,
        (VolumeFormat::Vtk, Encoding::Text) => vtk_text(&mut sink, positions, tetrahedra)?,
        (VolumeFormat::Medit, _) => medit(&mut sink, positions, tetrahedra)?,
    }
    sink.finish()
}

/// The type of a tetrahedral cell in VTK.
const VTK_TETRA: i32 = 10;

fn vtk_header(encoding: &str, vertices: usize) -> String {
    format!(
        "# vtk DataFile Version 3.0\nTetrahedra\n{encoding}\nDATASET UNSTRUCTURED_GRID\nPOINTS {vertices} double\n"
    )
}

fn vtk_text(sink: &mut Sink, positions: &[DVec3], tets: &[[VertexId; 4]]) -> Result<(), Error> {
    sink.put(vtk_header("ASCII", positions.len()).as_bytes())?;
    for p in positions {
        sink.put(format!("{:?} {:?} {:?}\n", p.x, p.y, p.z).as_bytes())?;
        sink.item()?;
    }
    sink.put(format!("CELLS {} {}\n", tets.len(), 5 * tets.len()).as_bytes())?;
    for [a, b, c, d] in tets {
        sink.put(format!("4 {} {} {} {}\n", a.0, b.0, c.0, d.0).as_bytes())?;
        sink.item()?;
    }
    sink.put(format!("CELL_TYPES {}\n", tets.len()).as_bytes())?;
    for _ in tets {
        sink.put(format!("{VTK_TETRA}\n").as_bytes())?;
    }
    Ok(())
}

/// As text, but the numbers are big-endian: doubles, and 32-bit integers.
fn vtk_binary(sink: &mut Sink, positions: &[DVec3], tets: &[[VertexId; 4]]) -> Result<(), Error> {
    sink.put(vtk_header("BINARY", positions.len()).as_bytes())?;
    for p in positions {
        sink.put(p.to_array().map(f64::to_be_bytes).as_flattened())?;
        sink.item()?;
    }
    sink.put(format!("\nCELLS {} {}\n", tets.len(), 5 * tets.len()).as_bytes())?;
    for [a, b, c, d] in tets {
        sink.put([4, a.0, b.0, c.0, d.0].map(u32::to_be_bytes).as_flattened())?;
        sink.item()?;
    }
    sink.put(format!("\nCELL_TYPES {}\n", tets.len()).as_bytes())?;
    for _ in tets {
        sink.put(&VTK_TETRA.to_be_bytes())?;
    }
    sink.put(b"\n")
}

/// Ids count from 1; the last column is a reference number, here 0.
fn medit(sink: &mut Sink, positions: &[DVec3], tets: &[[VertexId; 4]]) -> Result<(), Error> {
    let header = format!(
        "MeshVersionFormatted 2\n\nDimension 3\n\nVertices\n{}\n",
        positions.len()
    );
    sink.put(header.as_bytes())?;
    for p in positions {
        sink.put(format!("{:?} {:?} {:?} 0\n", p.x, p.y, p.z).as_bytes())?;
        sink.item()?;
    }
    sink.put(format!("\nTetrahedra\n{}\n", tets.len()).as_bytes())?;
    for tet in tets {
        let [a, b, c, d] = tet.map(|corner| corner.0 + 1);
        sink.put(format!("{a} {b} {c} {d} 0\n").as_bytes())?;
        sink.item()?;
    }
    sink.put(b"\nEnd\n")
}

/// Everything that the writers rely on; ids must fit VTK's signed integers.
fn check(path: &Path, positions: &[DVec3], tets: &[[VertexId; 4]]) -> Result<(), Error> {
    let vertices = positions.len();
    for (count, what) in [(vertices, "vertices"), (tets.len(), "tetrahedra")] {
        if count > i32::MAX as usize {
            return Err(Error::TooMany {
                path: path.to_owned(),
                count: count as u64,
                what,
            });
        }
    }
    if let Some(vertex) = first_not_finite(positions) {
        return Err(Error::VertexNotFinite {
            path: path.to_owned(),
            vertex,
        });
    }
    for (tetrahedron, corners) in tets.iter().enumerate() {
        if let Some(&vertex) = corners.iter().find(|v| v.index() >= vertices) {
            return Err(Error::CornerOutOfRange {
                path: path.to_owned(),
                tetrahedron,
                vertex,
                vertices,
            });
        }
    }
    Ok(())
}
