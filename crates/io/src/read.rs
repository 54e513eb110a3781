//! Reading, whatever the format.

use crate::contents::{Contents, Keep};
use crate::source::{Source, read_error};
use crate::{Error, Format, ReadReport, gltf, las, obj, off, pcd, ply, stl, table};
use pellicle_geometry::{CloudError, DVec3, PointCloud, Progress};
use pellicle_mesh::TriangleSoup;
use std::fs::File;
use std::io::{BufRead, BufReader, Cursor, Read as _, Seek, SeekFrom};
use std::path::Path;

/// How to read a file.
#[derive(Clone, Copy)]
pub struct ReadOptions<'a> {
    /// The format; default `None`: by the extension of the file's name.
    pub format: Option<Format>,
    /// Told about the bytes read, and asked whether to go on; default `()`.
    pub progress: &'a dyn Progress,
}

impl Default for ReadOptions<'_> {
    fn default() -> Self {
        Self {
            format: None,
            progress: &(),
        }
    }
}

/// What a file held.
#[derive(Clone, Debug, PartialEq)]
pub struct Read {
    /// Points or a mesh.
    pub data: Data,
    /// What was ignored or changed on the way.
    pub report: ReadReport,
}

/// Points, or a mesh if the file holds at least one polygon.
#[derive(Clone, Debug, PartialEq)]
pub enum Data {
    /// Points, perhaps with normals.
    Points(PointCloud),
    /// Triangles; larger polygons are cut.
    Mesh {
        /// The triangles.
        soup: TriangleSoup,
        /// One a vertex, if the file has them.
        normals: Option<Vec<DVec3>>,
    },
}

/// The points of a file.
#[derive(Clone, Debug, PartialEq)]
pub struct ReadPoints {
    /// The points, perhaps with normals, in the order of the file.
    pub cloud: PointCloud,
    /// What was ignored or changed on the way.
    pub report: ReadReport,
}

/// The mesh of a file.
#[derive(Clone, Debug, PartialEq)]
pub struct ReadMesh {
    /// Vertices and triangles, in the order of the file.
    pub soup: TriangleSoup,
    /// One a vertex, if the file has them.
    pub normals: Option<Vec<DVec3>>,
    /// What was ignored or changed on the way.
    pub report: ReadReport,
}

/// Reads points or a mesh, by what the file holds. Linear time.
pub fn read(path: impl AsRef<Path>, options: &ReadOptions) -> Result<Read, Error> {
    let (contents, report) = read_path(path.as_ref(), options, Keep::Everything)?;
    into_read(contents, report, path.as_ref())
}

/// As [`read`], from bytes in memory or an open file at its start. `name` stands for the file in errors;
/// files that the input refers to (the buffers of glTF) are not opened.
///
/// ```
/// use pellicle_io::{Data, Format, ReadOptions, read_from};
/// let text = std::io::Cursor::new("1 2 3\n4 5 6\n");
/// let read = read_from(text, Format::Xyz, "two points", &ReadOptions::default())?;
/// let Data::Points(cloud) = read.data else { panic!() };
/// assert_eq!(cloud.len(), 2);
/// # Ok::<(), pellicle_io::Error>(())
/// ```
pub fn read_from(
    mut input: impl BufRead + Seek + Send + Sync,
    format: Format,
    name: impl AsRef<Path>,
    options: &ReadOptions,
) -> Result<Read, Error> {
    let name = name.as_ref();
    let length = input
        .seek(SeekFrom::End(0))
        .and_then(|length| input.rewind().map(|()| length))
        .map_err(|e| read_error(name, e))?;
    let mut source = Source::new(&mut input, name, length, options.progress);
    let (contents, report) = parse(&mut source, format, None, Keep::Everything)?;
    into_read(contents, report, name)
}

/// Reads points; the vertices of a mesh count as points, its polygons are not kept. Linear time.
pub fn read_points(path: impl AsRef<Path>, options: &ReadOptions) -> Result<ReadPoints, Error> {
    let path = path.as_ref();
    let (contents, report) = read_path(path, options, Keep::Points)?;
    let cloud = cloud(contents, path)?;
    Ok(ReadPoints { cloud, report })
}

/// Reads a mesh; [`Error::NoTriangles`] if the file has points only. Linear time.
pub fn read_mesh(path: impl AsRef<Path>, options: &ReadOptions) -> Result<ReadMesh, Error> {
    let path = path.as_ref();
    let Read { data, report } = read(path, options)?;
    match data {
        Data::Mesh { soup, normals } => Ok(ReadMesh {
            soup,
            normals,
            report,
        }),
        Data::Points(cloud) => Err(Error::NoTriangles {
            path: path.to_owned(),
            vertices: cloud.len(),
        }),
    }
}

fn into_read(contents: Contents, report: ReadReport, path: &Path) -> Result<Read, Error> {
    let data = if contents.triangles.is_empty() {
        Data::Points(cloud(contents, path)?)
    } else {
        Data::Mesh {
            normals: (!contents.normals.is_empty()).then_some(contents.normals),
            soup: TriangleSoup {
                positions: contents.positions,
                triangles: contents.triangles,
            },
        }
    };
    Ok(Read { data, report })
}

fn cloud(contents: Contents, path: &Path) -> Result<PointCloud, Error> {
    let Contents {
        positions, normals, ..
    } = contents;
    let points = positions.len();
    let result = PointCloud::new(positions).and_then(|cloud| match normals.is_empty() {
        true => Ok(cloud),
        false => cloud.with_normals(normals),
    });
    // The readers have checked all of this already; a cloud checks again.
    result.map_err(|e| match e {
        CloudError::NotFinite { vertex, .. } => Error::NotFinite {
            path: path.to_owned(),
            location: crate::Location::File,
            vertex: u64::from(vertex.0),
        },
        _ => Error::TooMany {
            path: path.to_owned(),
            count: points as u64,
            what: "vertices",
        },
    })
}

/// One number of each vertex of a PLY file, by its name in the header: a scalar property of any type but for lists.
///
/// In the order of the vertices that [`read`] gives. Numbers that are not finite come as they are. Linear time.
///
/// ```
/// use pellicle_io::{ReadOptions, read_vertex_property};
/// let folder = tempfile::tempdir()?;
/// let path = folder.path().join("two.ply");
/// std::fs::write(&path, "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n\
///     property uchar quality\nend_header\n0 0 0 7\n1 0 0 8\n")?;
/// let quality = read_vertex_property(&path, "quality", &ReadOptions::default())?;
/// assert_eq!(quality, [7.0, 8.0]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn read_vertex_property(
    path: impl AsRef<Path>,
    name: &str,
    options: &ReadOptions,
) -> Result<Vec<f64>, Error> {
    let path = path.as_ref();
    open(path, options, |source, format, _| match format {
        Format::Ply => ply::read_property(source, name),
        format => Err(Error::NoProperties {
            path: path.to_owned(),
            format,
        }),
    })
}

fn read_path(
    path: &Path,
    options: &ReadOptions,
    keep: Keep,
) -> Result<(Contents, ReadReport), Error> {
    open(path, options, |source, format, base| {
        parse(source, format, base, keep)
    })
}

/// Opens a file, and has it read.
fn open<T>(
    path: &Path,
    options: &ReadOptions,
    parse: impl FnOnce(&mut Source, Format, Option<&Path>) -> Result<T, Error>,
) -> Result<T, Error> {
    let open_error = |reason| Error::Io {
        path: path.to_owned(),
        action: "opened",
        reason,
    };
    let metadata = std::fs::metadata(path).map_err(open_error)?;
    if metadata.is_dir() {
        return Err(Error::Directory {
            path: path.to_owned(),
        });
    }
    let format = match options.format {
        Some(format) => format,
        None => Format::from_path(path)?,
    };
    let mut file = File::open(path).map_err(open_error)?;
    let base = path.parent();
    if metadata.is_file() {
        let mut input = BufReader::with_capacity(1 << 18, file);
        let mut source = Source::new(&mut input, path, metadata.len(), options.progress);
        parse(&mut source, format, base)
    } else {
        // A pipe or device: its size is known at its end only, and some formats seek.
        let mut bytes = Vec::new();
        file.read_to_end(&mut bytes)
            .map_err(|e| read_error(path, e))?;
        let length = bytes.len() as u64;
        let mut input = Cursor::new(bytes);
        let mut source = Source::new(&mut input, path, length, options.progress);
        parse(&mut source, format, base)
    }
}

fn parse(
    source: &mut Source,
    format: Format,
    base: Option<&Path>,
    keep: Keep,
) -> Result<(Contents, ReadReport), Error> {
    if source.length() == 0 {
        return Err(source.malformed(crate::Location::File, "is empty; there is nothing to read"));
    }
    let contents = match format {
        Format::Ply => ply::read(source, keep),
        Format::Xyz | Format::Pts | Format::Pwn | Format::Csv => table::read(source, format),
        Format::Pcd => pcd::read(source),
        Format::Las | Format::Laz => las::read(source),
        Format::Off => off::read(source, keep),
        Format::Obj => obj::read(source, keep),
        Format::Stl => stl::read(source, keep),
        Format::Gltf | Format::Glb => gltf::read(source, base, keep),
    }?
    .finish();
    tracing::debug!(
        path = %source.path().display(),
        %format,
        vertices = contents.positions.len(),
        triangles = contents.triangles.len(),
        "read"
    );
    let notes = contents.notes.clone();
    Ok((contents, ReadReport { format, notes }))
}
