//! What the sheet shows, and how.

use pellicle_geometry::{Aabb, DVec3};

/// Size, views and looks of a sheet.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// Pixels in a row; 1600.
    pub width: u32,
    /// Rows; 1200.
    pub height: u32,
    /// The views, row by row from the top left; front, right, top and three-quarter.
    pub views: Vec<View>,
    /// A box that each view fits, and what lies outside of it as well; none, so that what is drawn fits closely.
    /// With the box of all frames of an animation they have one camera, and nothing jumps.
    pub bounds: Option<Aabb>,
    /// Which axis of the data points up; y, as in most scans of objects.
    pub up: Up,
    /// Mild perspective by default.
    pub projection: Projection,
    /// Flat by default: what is drawn is what the mesh is.
    pub shading: Shading,
    /// Samples along a pixel's side; 3, so nine a pixel. At least 1.
    pub samples: u32,
    /// Radius of a point's disc in units of the data; by default a share of the estimated spacing.
    pub point_radius: Option<f64>,
    /// What of a mesh is drawn; its surface.
    pub style: Style,
    /// Width of an edge in pixels; 1.
    pub edge_width: f64,
    /// Whether edges of one triangle, and of three or more, are marked; they are.
    pub borders: Borders,
    /// How much creases are darkened; 0 is not at all, 1 the default.
    pub occlusion: f64,
    /// What is where there is nothing; the palette's colour.
    pub background: Background,
    /// The colours.
    pub palette: Palette,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            width: 1600,
            height: 1200,
            views: vec![View::Front, View::Right, View::Top, View::ThreeQuarter],
            bounds: None,
            up: Up::default(),
            projection: Projection::default(),
            shading: Shading::default(),
            samples: 3,
            point_radius: None,
            style: Style::default(),
            edge_width: 1.0,
            borders: Borders::default(),
            occlusion: 1.0,
            background: Background::default(),
            palette: Palette::default(),
        }
    }
}

/// Where the viewer stands. Front looks along +y when z is up, and along −z when y is up; right is +x in both.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum View {
    /// From before it.
    Front,
    /// From behind it.
    Back,
    /// From its left.
    Left,
    /// From its right.
    Right,
    /// From above, the front at the lower edge.
    Top,
    /// From below, the front at the upper edge.
    Bottom,
    /// From before, to the right and above.
    ThreeQuarter,
    /// From this direction: towards the viewer, in the axes of the data, of any length.
    From(DVec3),
}

/// The axis that points up in the picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Up {
    /// The y axis: most scans of objects.
    #[default]
    Y,
    /// The z axis: surveys and most technical drawing.
    Z,
}

/// How depth shows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Projection {
    /// Parallel lines stay parallel.
    Orthographic,
    /// Seen from six times the radius of the data away.
    #[default]
    Perspective,
}

/// How a triangle takes light.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Shading {
    /// One normal a triangle.
    #[default]
    Flat,
    /// Normals blended over a triangle, but not across edges sharper than 60 degrees.
    Smooth,
    /// No light: each colour as it is.
    Unlit,
}

/// What of a mesh is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Style {
    /// Its triangles.
    #[default]
    Surface,
    /// Its triangles, and their edges over them.
    SurfaceAndEdges,
    /// Its edges, but for those that the surface hides.
    VisibleEdges,
    /// All its edges.
    AllEdges,
}

/// Whether the edges are marked at which a mesh is no closed manifold.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Borders {
    /// Edges of one triangle, and of three or more, in colours of their own.
    #[default]
    Marked,
    /// As all other edges.
    Plain,
}

/// What is where there is nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Background {
    /// The palette's colour.
    #[default]
    Opaque,
    /// Nothing: opacity is the share of a pixel that is covered.
    Transparent,
}

/// Colours in sRGB: red, green, blue.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Palette {
    /// A triangle seen counter-clockwise, a point whose normal faces the viewer.
    pub front: [u8; 3],
    /// A triangle seen from behind, a point whose normal faces away.
    pub back: [u8; 3],
    /// A point without a normal.
    pub point: [u8; 3],
    /// An edge of one triangle.
    pub border: [u8; 3],
    /// An edge of three or more triangles.
    pub non_manifold: [u8; 3],
    /// An edge of two triangles, where edges are drawn.
    pub edge: [u8; 3],
    /// A triangle that is marked.
    pub marked: [u8; 3],
    /// Where a value is not finite.
    pub no_value: [u8; 3],
    /// Numbers and title of a colour bar.
    pub text: [u8; 3],
    /// Where there is nothing.
    pub background: [u8; 3],
}

impl Default for Palette {
    fn default() -> Self {
        Self {
            front: [214, 208, 196],
            back: [178, 96, 148],
            point: [126, 160, 190],
            border: [226, 88, 34],
            non_manifold: [206, 0, 24],
            edge: [44, 48, 56],
            marked: [228, 160, 32],
            no_value: [150, 150, 150],
            text: [52, 56, 64],
            background: [244, 245, 247],
        }
    }
}
