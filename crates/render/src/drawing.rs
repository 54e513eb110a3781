//! What is drawn, and what is shown on it.

use crate::ColorMap;
use pellicle_geometry::DVec3;
use pellicle_mesh::{MeshView, TriangleId};

/// A mesh or points, their colours, and marks on them.
///
/// ```
/// use pellicle_geometry::{DVec3, VertexId};
/// use pellicle_mesh::MeshView;
/// use pellicle_render::{Coloring, Drawing, Options, Style, Values, render};
///
/// let positions = [DVec3::ZERO, DVec3::X, DVec3::Y];
/// let triangles = [[0, 1, 2].map(VertexId)];
/// let heights = [0.0, 1.0, 2.0];
/// let drawing = Drawing {
///     coloring: Coloring::Values(Values::new(&heights)),
///     ..Drawing::mesh(MeshView { positions: &positions, triangles: &triangles })
/// };
/// let options = Options { width: 320, height: 240, style: Style::SurfaceAndEdges, ..Options::default() };
/// let image = render(&drawing, &options)?;
/// assert_eq!(image.width, 320);
/// # Ok::<(), pellicle_render::Error>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Drawing<'a> {
    /// The mesh or the points.
    pub subject: Subject<'a>,
    /// Their colours; those of the palette by default.
    pub coloring: Coloring<'a>,
    /// Triangles in the colour of crossing ones, such as those that intersect; none by default, and none of points.
    pub marked: &'a [TriangleId],
    /// Segments drawn over it; none by default.
    pub strokes: &'a [Stroke],
    /// Points drawn over it; none by default.
    pub dots: &'a [Dot],
}

impl<'a> Drawing<'a> {
    /// A mesh or a soup in the colours of the palette.
    pub fn mesh(mesh: impl Into<MeshView<'a>>) -> Self {
        Self::of(Subject::Mesh(mesh.into()))
    }

    /// Points in the colours of the palette, with one normal each or none.
    pub fn points(positions: &'a [DVec3], normals: Option<&'a [DVec3]>) -> Self {
        Self::of(Subject::Points { positions, normals })
    }

    fn of(subject: Subject<'a>) -> Self {
        Self {
            subject,
            coloring: Coloring::default(),
            marked: &[],
            strokes: &[],
            dots: &[],
        }
    }
}

/// What is drawn.
#[derive(Clone, Copy, Debug)]
pub enum Subject<'a> {
    /// Counter-clockwise triangles face the viewer; others show the back's colour.
    Mesh(MeshView<'a>),
    /// A disc a point, turned by its normal where there is one, else a small ball.
    Points {
        /// The points.
        positions: &'a [DVec3],
        /// One a point; one that is zero or not finite counts as none.
        normals: Option<&'a [DVec3]>,
    },
}

/// Where colours come from.
#[derive(Clone, Copy, Debug, Default)]
pub enum Coloring<'a> {
    /// From the palette: front and back of triangles, points.
    #[default]
    Sides,
    /// Red, green and blue in sRGB, for each triangle or each point.
    Each(&'a [[u8; 3]]),
    /// From a value of each vertex or each point; a bar beside the views tells which colour is which.
    Values(Values<'a>),
}

/// Numbers as colours.
#[derive(Clone, Copy, Debug)]
pub struct Values<'a> {
    /// One a vertex or a point, blended over triangles. One that is not finite shows the palette's colour for none.
    pub values: &'a [f64],
    /// The values of the map's ends, the first not greater than the second; by default the least and the greatest.
    /// What lies outside has the colour of the nearer end.
    pub range: Option<[f64; 2]>,
    /// The colours; viridis by default.
    pub map: ColorMap,
    /// What stands above the bar: letters of English, digits and common signs; nothing by default.
    pub title: &'a str,
    /// Whether there is a bar; there is by default.
    pub bar: Bar,
}

impl<'a> Values<'a> {
    /// Values from the least to the greatest, with a bar.
    pub fn new(values: &'a [f64]) -> Self {
        Self {
            values,
            range: None,
            map: ColorMap::default(),
            title: "",
            bar: Bar::default(),
        }
    }

    /// The values of the map's ends; none if no value is finite.
    pub(crate) fn ends(&self) -> Option<[f64; 2]> {
        let finite = || self.values.iter().copied().filter(|v| v.is_finite());
        match self.range {
            Some(range) => Some(range),
            None => Some([finite().reduce(f64::min)?, finite().reduce(f64::max)?]),
        }
    }
}

/// Whether a bar tells which colour is which value.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Bar {
    /// At the right, with ticks and numbers.
    #[default]
    Right,
    /// None, as where several pictures share one.
    Absent,
}

/// A segment drawn over a mesh or points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stroke {
    /// From, to; a disc where they are equal.
    pub ends: [DVec3; 2],
    /// Red, green and blue in sRGB.
    pub color: [u8; 3],
    /// In pixels.
    pub width: f64,
    /// Whether what is nearer hides it.
    pub visibility: Visibility,
}

/// A disc drawn over a mesh or points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dot {
    /// Its middle.
    pub position: DVec3,
    /// Red, green and blue in sRGB.
    pub color: [u8; 3],
    /// In pixels.
    pub radius: f64,
    /// Whether what is nearer hides it.
    pub visibility: Visibility,
}

/// Whether what is nearer hides a mark.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Visibility {
    /// It shows where nothing is nearer.
    #[default]
    Hidden,
    /// It shows through everything.
    Through,
}
