//! Which formats there are, and what each can hold.

use crate::{Content, Error};
use std::fmt;
use std::path::Path;

/// A file format, known by the extension of the file's name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Format {
    /// Polygon File Format of Stanford: ascii, binary little-endian and big-endian.
    Ply,
    /// Columns of numbers: x y z, perhaps nx ny nz.
    Xyz,
    /// As [`Format::Xyz`] with a line that counts the points ahead.
    Pts,
    /// Points with normals, in six columns or in two blocks.
    Pwn,
    /// Columns of numbers with a separator and perhaps a line of names.
    Csv,
    /// Point Cloud Data of the Point Cloud Library: ascii, binary, compressed.
    Pcd,
    /// Points of airborne lasers, of the American Society for Photogrammetry.
    Las,
    /// [`Format::Las`] compressed.
    Laz,
    /// Object File Format of Geomview.
    Off,
    /// Wavefront's object file.
    Obj,
    /// Stereolithography, ascii or binary.
    Stl,
    /// glTF 2.0: JSON with its buffers beside it or inside.
    Gltf,
    /// glTF 2.0 in one binary file.
    Glb,
}

impl Format {
    /// Every format.
    pub const ALL: [Self; 13] = [
        Self::Ply,
        Self::Xyz,
        Self::Pts,
        Self::Pwn,
        Self::Csv,
        Self::Pcd,
        Self::Las,
        Self::Laz,
        Self::Off,
        Self::Obj,
        Self::Stl,
        Self::Gltf,
        Self::Glb,
    ];

    /// The format that the extension of `path` names, in either case.
    ///
    /// ```
    /// use pellicle_io::Format;
    /// assert_eq!(Format::from_path("scan.PLY")?, Format::Ply);
    /// assert!(Format::from_path("scan.doc").is_err());
    /// # Ok::<(), pellicle_io::Error>(())
    /// ```
    pub fn from_path(path: impl AsRef<Path>) -> Result<Self, Error> {
        let path = path.as_ref();
        let extension = path
            .extension()
            .map(|e| e.to_string_lossy().to_ascii_lowercase())
            .unwrap_or_default();
        Self::ALL
            .into_iter()
            .find(|format| format.extensions().contains(&extension.as_str()))
            .ok_or_else(|| Error::UnknownFormat {
                path: path.to_owned(),
                extension,
            })
    }

    /// The extensions that name this format, the usual one first.
    pub fn extensions(self) -> &'static [&'static str] {
        match self {
            Self::Ply => &["ply"],
            Self::Xyz => &["xyz", "xyzn", "txt", "asc"],
            Self::Pts => &["pts"],
            Self::Pwn => &["pwn"],
            Self::Csv => &["csv", "tsv"],
            Self::Pcd => &["pcd"],
            Self::Las => &["las"],
            Self::Laz => &["laz"],
            Self::Off => &["off"],
            Self::Obj => &["obj"],
            Self::Stl => &["stl"],
            Self::Gltf => &["gltf"],
            Self::Glb => &["glb"],
        }
    }

    /// Whether [`crate::write_points`] or [`crate::write_mesh`] writes this content in this format.
    pub fn can_write(self, content: Content) -> bool {
        match content {
            Content::Points => matches!(
                self,
                Self::Ply | Self::Xyz | Self::Pts | Self::Csv | Self::Pcd | Self::Off | Self::Obj
            ),
            Content::Normals => self == Self::Pwn || self.can_write(Content::Points),
            Content::Mesh => {
                matches!(
                    self,
                    Self::Ply | Self::Off | Self::Obj | Self::Stl | Self::Glb
                )
            }
        }
    }
}

impl fmt::Display for Format {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.extensions()[0].to_ascii_uppercase())
    }
}

/// The extensions of all formats, for messages.
pub(crate) fn known() -> String {
    list(|_| true)
}

/// The extensions of the formats that can be written with this content, for messages.
pub(crate) fn able(content: Content) -> String {
    list(|format| format.can_write(content))
}

fn list(keep: impl Fn(Format) -> bool) -> String {
    let names: Vec<&str> = Format::ALL
        .into_iter()
        .filter(|&format| keep(format))
        .flat_map(|format| format.extensions())
        .copied()
        .collect();
    names.join(", ")
}
