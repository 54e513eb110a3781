//! Pictures of meshes and point clouds, in memory, without a GPU: the same bytes on every machine.
//!
//! The data is an [`Image`], rows from the top; a [`Drawing`], a mesh or points with what is shown on them; and the
//! [`Options`] that say how. The verb is [`render`]; [`render_mesh`] and [`render_points`] are for what is no more:
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
//! 4. Edges, borders, strokes and dots are drawn over it where nothing hides them.
//! 5. What a pixel's samples show is shaded, darkened in creases, and averaged in linear light.
//! 6. Values have a bar beside the views.
//!
//! Only `+ − × ÷ √` on `f64` and integers are used: these are exactly rounded everywhere.
#![forbid(unsafe_code)]

mod bar;
mod camera;
mod cloud;
mod colormap;
mod drawing;
mod font;
mod frame;
mod marks;
mod mesh;
mod options;
mod paint;
mod samples;
mod shade;
mod sheet;
mod strip;

pub use colormap::ColorMap;
pub use drawing::{Bar, Coloring, Dot, Drawing, Stroke, Subject, Values, Visibility};
pub use options::{Background, Borders, Options, Palette, Projection, Shading, Style, Up, View};
pub use strip::strip;

use pellicle_geometry::{Aabb, DVec3, VertexId};
use pellicle_mesh::{MeshView, TriangleId};

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
    /// There are not as many values as vertices or points.
    #[error("{values} values for {expected} vertices or points")]
    ValueCount {
        /// How many values.
        values: usize,
        /// How many vertices of the mesh, or points.
        expected: usize,
    },
    /// There are not as many colours as triangles or points.
    #[error("{colors} colours for {expected} triangles or points")]
    ColorCount {
        /// How many colours.
        colors: usize,
        /// How many triangles, or points.
        expected: usize,
    },
    /// The values of the colours' ends are not finite, or in the wrong order.
    #[error("colours cannot run from {low} to {high}")]
    NoRange {
        /// The first.
        low: f64,
        /// The second.
        high: f64,
    },
    /// A triangle that is to be marked does not exist.
    #[error("triangle {} is to be marked, but there are {triangles}", .triangle.0)]
    NoSuchTriangle {
        /// The triangle.
        triangle: TriangleId,
        /// How many there are.
        triangles: usize,
    },
    /// An end of a stroke is NaN or infinite.
    #[error("stroke {stroke} has an end that is not finite")]
    StrokeNotFinite {
        /// The first such stroke's index.
        stroke: usize,
    },
    /// A dot is at NaN or infinity.
    #[error("dot {dot} has a coordinate that is not finite")]
    DotNotFinite {
        /// The first such dot's index.
        dot: usize,
    },
    /// A bar of colours would leave no place for the views.
    #[error("{width} × {height} pixels have no room for a bar of colours")]
    NoRoomForBar {
        /// Pixels in a row.
        width: u32,
        /// Rows.
        height: u32,
    },
    /// More triangles, points and marks than `u32` ids can name.
    #[error("{count} triangles or points and marks: at most 2^32 - 8 can be drawn")]
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

/// Draws a mesh or points with all that is shown on them.
///
/// Time is linear in things plus samples covered, times views, but for one sort of the edges; memory is 36 bytes a
/// vertex, 64 a point, 8 a sample of each view, and 12 to 96 an edge where edges or borders are drawn.
pub fn render(drawing: &Drawing<'_>, options: &Options) -> Result<Image, Error> {
    check_bounds(options)?;
    let (things, vertices) = match drawing.subject {
        Subject::Mesh(mesh) => (mesh.triangles.len(), mesh.positions.len()),
        Subject::Points { positions, .. } => (positions.len(), positions.len()),
    };
    let count = things + drawing.strokes.len() + drawing.dots.len();
    if count > (u32::MAX - 8) as usize {
        return Err(Error::TooMany { count });
    }
    paint::check(&drawing.coloring, things, vertices)?;
    marks::check(drawing.strokes, drawing.dots)?;
    let bar = bar::ColorBar::new(&drawing.coloring, options)?;
    let right = bar.as_ref().map_or(0, |bar| bar.columns);
    let mut image = match drawing.subject {
        Subject::Mesh(mesh) => {
            mesh::check(mesh, drawing.marked)?;
            let scene = mesh::MeshScene::new(mesh, drawing, options);
            sheet::draw(&scene, options, right)
        }
        Subject::Points { positions, normals } => {
            cloud::check(positions, normals)?;
            let scene = cloud::CloudScene::new(positions, normals, drawing, options);
            sheet::draw(&scene, options, right)
        }
    }?;
    if let Some(bar) = bar {
        bar.draw(&mut image, options);
    }
    Ok(image)
}

/// Draws a mesh or a soup in the colours of the palette. Counter-clockwise triangles face the viewer; others show the
/// back's colour.
pub fn render_mesh(mesh: MeshView<'_>, options: &Options) -> Result<Image, Error> {
    render(&Drawing::mesh(mesh), options)
}

/// Draws a cloud: a disc a point, turned by its normal where there is one, else a small ball.
///
/// A normal that is zero or not finite counts as none.
pub fn render_points(
    points: &[DVec3],
    normals: Option<&[DVec3]>,
    options: &Options,
) -> Result<Image, Error> {
    render(&Drawing::points(points, normals), options)
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
