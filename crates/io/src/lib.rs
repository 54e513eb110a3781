//! Readers and writers of point clouds and triangle meshes.
//!
//! A file is points (a [`PointCloud`](pellicle_geometry::PointCloud)) or triangles over vertices (a
//! [`TriangleSoup`](pellicle_mesh::TriangleSoup)); [`read`] returns what it is, [`read_points`] takes the
//! vertices of a mesh for points too, [`write_points`] and [`write_mesh`] put them into a file. The extension
//! names the [`Format`].
//!
//! ```
//! use pellicle_geometry::{DVec3, PointCloud};
//! use pellicle_io::{ReadOptions, WriteOptions, read_points, write_points};
//!
//! let directory = tempfile::tempdir()?;
//! let path = directory.path().join("two.ply");
//! let cloud = PointCloud::new(vec![DVec3::ZERO, DVec3::new(4_649_776.25, 0.1, 1.0)])?;
//! write_points(&path, &cloud, &WriteOptions::default())?;
//! let read = read_points(&path, &ReadOptions::default())?;
//! assert_eq!(read.cloud, cloud);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Nothing that a file holds makes a reader panic, nor take memory out of proportion to the file; what is
//! wrong comes back as an [`Error`] with the file, the line or byte, and the reason. What is merely left out
//! or changed comes back as [`Note`]s. A writer puts a complete file under its name, or leaves what is there.
#![forbid(unsafe_code)]

mod contents;
mod error;
mod format;
mod gltf;
mod las;
mod obj;
mod off;
mod pcd;
mod ply;
mod read;
mod report;
mod sink;
mod source;
mod stl;
mod table;
mod text;
mod volume;
mod write;

pub use error::{Content, Error, Location};
pub use format::Format;
pub use gltf::{AnimationOptions, AnimationWriter, Frame, write_animation};
pub use read::{
    Data, Read, ReadMesh, ReadOptions, ReadPoints, read, read_from, read_mesh, read_points,
    read_vertex_property,
};
pub use report::{Note, ReadReport, WriteReport};
pub use volume::{VolumeFormat, write_tetrahedra};
pub use write::{
    Encoding, Overwrite, Pixels, WriteOptions, write_mesh, write_png, write_points, write_text,
};
