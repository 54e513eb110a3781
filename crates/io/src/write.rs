//! Writing, whatever the format.

use crate::sink::Sink;
use crate::{Content, Error, Format, Note, WriteReport, gltf, obj, off, pcd, ply, stl, table};
use pellicle_geometry::{Aabb, DVec3, PointCloud, Progress, first_not_finite};
use pellicle_mesh::MeshView;
use std::path::Path;

/// What to do when the file to be written exists.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Overwrite {
    /// Leave it and return [`Error::Exists`].
    #[default]
    Refuse,
    /// Replace it, at once and as a whole, when everything is written.
    Replace,
}

/// How numbers are written where the format leaves a choice (PLY and PCD).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Encoding {
    /// Little-endian bytes.
    #[default]
    Binary,
    /// Text, with the fewest digits that read back to the same bits.
    Text,
}

/// How to write a file.
#[derive(Clone, Copy)]
pub struct WriteOptions<'a> {
    /// The format; default `None`: by the extension of the file's name.
    pub format: Option<Format>,
    /// What to do when the file exists; default [`Overwrite::Refuse`].
    pub overwrite: Overwrite,
    /// Binary or text where the format has both; default [`Encoding::Binary`].
    pub encoding: Encoding,
    /// Told about the items written, and asked whether to go on; default `()`.
    pub progress: &'a dyn Progress,
}

impl Default for WriteOptions<'_> {
    fn default() -> Self {
        Self {
            format: None,
            overwrite: Overwrite::default(),
            encoding: Encoding::default(),
            progress: &(),
        }
    }
}

/// The pixels of a picture, row by row from the top, eight bits a channel.
#[derive(Clone, Copy, Debug)]
pub enum Pixels<'a> {
    /// Red, green, blue.
    Rgb(&'a [u8]),
    /// Red, green, blue, opacity.
    Rgba(&'a [u8]),
}

/// Writes points. Linear time.
///
/// The file appears under its name at once and complete, or not at all.
pub fn write_points(
    path: impl AsRef<Path>,
    cloud: &PointCloud,
    options: &WriteOptions,
) -> Result<WriteReport, Error> {
    let path = path.as_ref();
    let content = match cloud.normals() {
        Some(_) => Content::Normals,
        None => Content::Points,
    };
    let mesh = MeshView {
        positions: cloud.positions(),
        triangles: &[],
    };
    write(path, mesh, cloud.normals(), content, options)
}

/// Writes a mesh, with one normal a vertex if there are any. Linear time.
///
/// The file appears under its name at once and complete, or not at all.
pub fn write_mesh<'a>(
    path: impl AsRef<Path>,
    mesh: impl Into<MeshView<'a>>,
    normals: Option<&[DVec3]>,
    options: &WriteOptions,
) -> Result<WriteReport, Error> {
    write(path.as_ref(), mesh.into(), normals, Content::Mesh, options)
}

fn write(
    path: &Path,
    mesh: MeshView,
    normals: Option<&[DVec3]>,
    content: Content,
    options: &WriteOptions,
) -> Result<WriteReport, Error> {
    let format = match options.format {
        Some(format) => format,
        None => Format::from_path(path)?,
    };
    if !format.can_write(content) {
        return Err(Error::CannotHold {
            path: path.to_owned(),
            format,
            what: content,
        });
    }
    check(path, mesh, normals)?;
    let total = mesh.positions.len() as u64 + mesh.triangles.len() as u64;
    let mut sink = Sink::create(path, options.overwrite, options.progress, total)?;
    let mut notes = Vec::new();
    match format {
        Format::Ply => ply::write(&mut sink, mesh, normals, content, options.encoding)?,
        Format::Xyz | Format::Pts | Format::Pwn | Format::Csv => {
            table::write(&mut sink, mesh.positions, normals, format, &mut notes)?;
        }
        Format::Pcd => pcd::write(&mut sink, mesh.positions, normals, options.encoding)?,
        Format::Off => off::write(&mut sink, mesh, normals)?,
        Format::Obj => obj::write(&mut sink, mesh, normals)?,
        Format::Stl => stl::write(&mut sink, path, mesh, normals, &mut notes)?,
        Format::Glb => gltf::write(&mut sink, path, mesh, normals, &mut notes)?,
        Format::Las | Format::Laz | Format::Gltf => {
            unreachable!("{format} is not among the formats that can be written")
        }
    }
    let bytes = sink.finish()?;
    tracing::debug!(path = %path.display(), %format, bytes, "written");
    Ok(WriteReport {
        format,
        bytes,
        notes,
    })
}

/// Everything that a writer relies on.
pub(crate) fn check(path: &Path, mesh: MeshView, normals: Option<&[DVec3]>) -> Result<(), Error> {
    let vertices = mesh.positions.len();
    let too_many = |count: usize, what| Error::TooMany {
        path: path.to_owned(),
        count: count as u64,
        what,
    };
    if vertices >= u32::MAX as usize {
        return Err(too_many(vertices, "vertices"));
    }
    if mesh.triangles.len() >= u32::MAX as usize {
        return Err(too_many(mesh.triangles.len(), "triangles"));
    }
    if let Some(normals) = normals
        && normals.len() != vertices
    {
        return Err(Error::NormalCount {
            path: path.to_owned(),
            vertices,
            normals: normals.len(),
        });
    }
    if let Some(vertex) = first_not_finite(mesh.positions) {
        return Err(Error::VertexNotFinite {
            path: path.to_owned(),
            vertex,
        });
    }
    for (triangle, corners) in mesh.triangles.iter().enumerate() {
        if let Some(&vertex) = corners.iter().find(|v| v.0 as usize >= vertices) {
            return Err(Error::VertexOutOfRange {
                path: path.to_owned(),
                triangle,
                vertex,
                vertices,
            });
        }
    }
    Ok(())
}

/// Writes a picture as PNG, whatever the extension of `path`.
///
/// The file appears under its name at once and complete, or not at all.
pub fn write_png(
    path: impl AsRef<Path>,
    width: u32,
    height: u32,
    pixels: Pixels,
    options: &WriteOptions,
) -> Result<u64, Error> {
    use image::{ExtendedColorType, ImageEncoder, codecs::png::PngEncoder};
    let path = path.as_ref();
    let (bytes, channels, color) = match pixels {
        Pixels::Rgb(bytes) => (bytes, 3, ExtendedColorType::Rgb8),
        Pixels::Rgba(bytes) => (bytes, 4, ExtendedColorType::Rgba8),
    };
    let expected = u64::from(width)
        .saturating_mul(u64::from(height))
        .saturating_mul(channels);
    if bytes.len() as u64 != expected || expected == 0 {
        return Err(Error::PictureSize {
            path: path.to_owned(),
            width,
            height,
            bytes: bytes.len(),
            expected,
        });
    }
    let mut encoded = Vec::new();
    PngEncoder::new(&mut encoded)
        .write_image(bytes, width, height, color)
        .map_err(|e| Error::Io {
            path: path.to_owned(),
            action: "encoded",
            reason: std::io::Error::other(e),
        })?;
    let mut sink = Sink::create(path, options.overwrite, options.progress, 1)?;
    sink.put(&encoded)?;
    sink.finish()
}

/// Writes text, such as a table, whatever the extension of `path`. Returns its size in bytes.
///
/// The file appears under its name at once and complete, or not at all.
pub fn write_text(
    path: impl AsRef<Path>,
    text: &str,
    options: &WriteOptions,
) -> Result<u64, Error> {
    let mut sink = Sink::create(path.as_ref(), options.overwrite, options.progress, 1)?;
    sink.put(text.as_bytes())?;
    sink.finish()
}

/// Positions farther from the origin than so many times their extent are shifted before rounding: nearer
/// ones lose two bits at most by staying where they are.
const FAR: f64 = 4.0;

/// Positions as single precision holds them.
pub(crate) struct Rounded {
    /// What is subtracted before rounding; itself exact in single precision. Zero if the
    /// positions are exact without, or near the origin for their extent.
    pub shift: DVec3,
}

impl Rounded {
    /// Finds the shift, and notes it and the error that remains; `None` if single precision cannot hold
    /// the positions at all.
    pub fn new(positions: &[DVec3], restored_by_file: bool, notes: &mut Vec<Note>) -> Option<Self> {
        let exact = |p: &DVec3| p.as_vec3().as_dvec3() == *p;
        if positions.iter().all(exact) {
            return Some(Self { shift: DVec3::ZERO });
        }
        let far = Self::far_shift(Aabb::of_points(positions));
        let rounded = Self {
            shift: far.unwrap_or_default(),
        };
        let error = rounded.error(positions)?;
        if let Some(shift) = far {
            notes.push(Note::Shifted {
                shift,
                restored_by_file,
            });
        }
        if error > 0.0 {
            notes.push(Note::Rounded { error });
        }
        Some(rounded)
    }

    /// What to subtract from positions in this box, if they are far from the origin for their extent.
    pub fn far_shift(bounds: Aabb) -> Option<DVec3> {
        let farthest = bounds.min.abs().max(bounds.max.abs()).max_element();
        let far = farthest > FAR * bounds.extent().max_element();
        far.then(|| bounds.center().as_vec3().as_dvec3())
    }

    /// The largest distance along an axis between a position and what is read back; `None` if single precision
    /// cannot hold the positions at all.
    pub fn error(&self, positions: &[DVec3]) -> Option<f64> {
        let mut error: f64 = 0.0;
        for &p in positions {
            let local = self.local(p);
            if !local.is_finite() || !self.shift.is_finite() {
                return None;
            }
            let restored = local.as_dvec3() + self.shift;
            error = error.max((restored - p).abs().max_element());
        }
        Some(error)
    }

    /// One position, shifted and rounded.
    pub fn local(&self, position: DVec3) -> glam::Vec3 {
        (position - self.shift).as_vec3()
    }
}
