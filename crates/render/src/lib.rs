//! Pictures of meshes and point clouds, in memory, without a GPU: the same bytes on every machine.
//!
//! The data is an [`Image`], rows from the top, and the [`Options`] that say what the sheet shows. The verbs are
//! [`render_mesh`] and [`render_points`]:
//!
//! ```
//! use pellicle_geometry::DVec3;
//! use pellicle_render::{Options, View, render_points};
//!
//! let points = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
//! let options = Options { width: 64, height: 48, views: vec![View::Front], ..Options::default() };
//! let image = render_points(&points, None, &options)?;
//! assert_eq!((image.width, image.height), (64, 48));
//! assert!(image.pixels.iter().any(|&pixel| pixel != image.pixels[0]));
//! # Ok::<(), pellicle_render::Error>(())
//! ```
//!
//! # How a sheet is made
//!
//! 1. The input is moved and scaled into the unit ball, so that any finite coordinates do.
//! 2. Each view gets a cell of the sheet, all of one size, and one scale fits all of them.
//! 3. In each cell every sample (several a pixel) keeps the nearest triangle or disc: *what*, not *which colour*.
//! 4. Borders are drawn over it where nothing hides them.
//! 5. Samples are shaded, darkened in creases, and averaged to pixels in linear light.
//!
//! Only `+ − × ÷ √` on `f64` and integers are used: these are exactly rounded everywhere.
#![forbid(unsafe_code)]

mod camera;
mod cloud;
mod frame;
mod mesh;
mod options;
mod samples;
mod shade;
mod sheet;
mod strip;

pub use options::{Options, Palette, Projection, Shading, Up, View};
pub use strip::strip;

use pellicle_geometry::{Aabb, DVec3, VertexId};
use pellicle_mesh::MeshView;

/// A picture: red, green, blue and opacity of each pixel, in sRGB, rows from the top.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Image {
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// `width` × `height` pixels.
    pub pixels: Vec<[u8; 4]>,
}

/// Why there is no picture.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A coordinate is NaN or infinite.
    #[error("vertex {} has a coordinate that is not finite: {position}", .vertex.0)]
    NotFinite {
        /// The first such vertex.
        vertex: VertexId,
        /// Its coordinates.
        position: DVec3,
    },
    /// A triangle names a vertex that does not exist.
    #[error("triangle {triangle} names vertex {}, but there are {vertices}", .vertex.0)]
    NoSuchVertex {
        /// The triangle's index.
        triangle: usize,
        /// What it names.
        vertex: VertexId,
        /// How many vertices there are.
        vertices: usize,
    },
    /// There are not as many normals as points.
    #[error("{normals} normals for {points} points")]
    NormalCount {
        /// How many points.
        points: usize,
        /// How many normals.
        normals: usize,
    },
    /// More triangles or points than `u32` ids can name.
    #[error("{count} triangles or points: at most 2^32 - 8 can be drawn")]
    TooMany {
        /// How many.
        count: usize,
    },
    /// The box of the options has a coordinate that is not finite.
    #[error("the box to be fitted is not finite: from {min} to {max}")]
    BoundsNotFinite {
        /// Its least corner.
        min: DVec3,
        /// Its greatest corner.
        max: DVec3,
    },
    /// A strip of no image, or of empty ones.
    #[error("there is no image to put into a strip")]
    NoImage,
    /// An image of a strip has another size than the first, or not as many pixels as its size says.
    #[error("image {image} of the strip is {width} × {height} with {pixels} pixels; the first is {} × {}", .first.0, .first.1)]
    UnequalImages {
        /// Which image; the first is 0.
        image: usize,
        /// Its pixels in a row.
        width: u32,
        /// Its rows.
        height: u32,
        /// Its pixels.
        pixels: usize,
        /// Width and height of the first image.
        first: (u32, u32),
    },
    /// A strip has more pixels in a row, or more rows, than a `u32` counts.
    #[error("{columns} columns and {rows} rows of images of {} × {} are too large a picture", .size.0, .size.1)]
    StripSize {
        /// Images in a row.
        columns: usize,
        /// Rows of images.
        rows: usize,
        /// Width and height of an image.
        size: (u32, u32),
    },
    /// The options ask for no view at all.
    #[error("the sheet has no view")]
    NoView,
    /// A view's direction is zero or not finite.
    #[error("a view's direction is zero or not finite: {direction}")]
    NoDirection {
        /// The direction asked for.
        direction: DVec3,
    },
    /// The image, or a view's part of it, is empty or larger than 65,536 samples a side.
    #[error("cannot draw {views} views on {width} × {height} pixels with {samples} samples a side")]
    Size {
        /// Pixels in a row.
        width: u32,
        /// Rows.
        height: u32,
        /// Views on the sheet.
        views: usize,
        /// Samples along a pixel's side.
        samples: u32,
    },
}

/// Draws a mesh or a soup. Counter-clockwise triangles face the viewer; others show the back's colour.
///
/// Time is linear in triangles plus samples covered, times views, but for one sort of the edges; memory is 12 bytes a
/// vertex and 8 a sample of one view, 24 an edge while borders are sought.
pub fn render_mesh(mesh: MeshView<'_>, options: &Options) -> Result<Image, Error> {
    check_bounds(options)?;
    mesh::check(mesh)?;
    sheet::draw(&mesh::MeshScene::new(mesh, options), options)
}

/// Draws a cloud: a disc a point, turned by its normal where there is one, else a small ball.
///
/// A normal that is zero or not finite counts as none. Time is linear in points plus samples covered, times views.
pub fn render_points(
    points: &[DVec3],
    normals: Option<&[DVec3]>,
    options: &Options,
) -> Result<Image, Error> {
    check_bounds(options)?;
    cloud::check(points, normals)?;
    sheet::draw(&cloud::CloudScene::new(points, normals, options), options)
}

/// An empty box asks for nothing.
fn check_bounds(options: &Options) -> Result<(), Error> {
    match options.bounds {
        Some(Aabb { min, max })
            if !(min.is_finite() && max.is_finite()) && options.bounds != Some(Aabb::EMPTY) =>
        {
            Err(Error::BoundsNotFinite { min, max })
        }
        _ => Ok(()),
    }
}

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
