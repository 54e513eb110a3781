//! `pellicle render`.

use crate::arguments::{Global, Target, not_negative};
use crate::failure::Failure;
use crate::progress::Watch;
use crate::scalar::{Scalar, Scalars};
use crate::{interrupt, output};
use clap::{Args, ValueEnum};
use pellicle::geometry::DVec3;
use pellicle::io::{Data, Pixels, write_png};
use pellicle::mesh::{MeshView, TriangleId, TriangleSoup, self_intersections};
use pellicle::render::{
    self, Background, Bar, Borders, ColorMap, Coloring, Drawing, Options, Stroke, Values,
    Visibility,
};
use pellicle::transformesh::intersection_segments;
use serde::Serialize;
use std::path::PathBuf;

const EXAMPLE: &str = "\
Examples:
  pellicle render mesh.ply -o mesh.png
  pellicle render mesh.ply -o edges.png --style surface-edges --views three-quarter
  pellicle render mesh.ply -o curvature.png --scalar mean-curvature --range=-2,2
  pellicle render mesh.ply -o difference.png --scalar distance-to:scan.ply
  pellicle render crossing.off -o crossing.png --crossing

Triangles seen from behind are purple, borders are orange, edges of three or more triangles are red. The picture is the
same on every machine.";

/// Width in pixels of a segment in which triangles meet.
const CROSSING_WIDTH: f64 = 2.5;
const CROSSING_COLOR: [u8; 3] = [196, 16, 48];

/// Draw a mesh or points, from several sides, on one sheet
#[derive(Debug, Args)]
#[command(after_help = EXAMPLE)]
pub struct Render {
    /// The mesh or the points
    #[arg(value_name = "IN")]
    input: PathBuf,
    #[command(flatten)]
    target: Target,
    /// Pixels in a row
    #[arg(long, value_name = "PIXELS", default_value_t = Options::default().width)]
    width: u32,
    /// Rows of pixels
    #[arg(long, value_name = "PIXELS", default_value_t = Options::default().height)]
    height: u32,
    /// The views, separated by commas
    #[arg(
        long,
        value_name = "VIEWS",
        value_delimiter = ',',
        default_value = "front,right,top,three-quarter"
    )]
    views: Vec<View>,
    /// The axis of the data that points up
    #[arg(long, value_name = "AXIS", default_value = "y")]
    up: Up,
    /// What of a mesh is drawn
    #[arg(long, value_name = "WHAT", default_value = "surface")]
    style: Style,
    /// One normal a triangle, blended ones, or no light at all
    #[arg(long, value_name = "HOW", default_value = "flat")]
    shading: Shading,
    /// How depth shows
    #[arg(long, value_name = "HOW", default_value = "perspective")]
    projection: Projection,
    /// Width of edges in pixels
    #[arg(long, value_name = "PIXELS", default_value_t = Options::default().edge_width, value_parser = not_negative)]
    edge_width: f64,
    /// Colours by a value of each vertex or point, with a bar of colours: mean-curvature, area (a third of the triangles
    /// around), x, y, z, distance-to:FILE (a mesh or points), property:NAME (a number in a PLY file)
    #[arg(long, value_name = "VALUE")]
    scalar: Option<Scalar>,
    /// The values of the first and the last colour; by default the least and the greatest
    #[arg(long, value_name = "LOW,HIGH", requires = "scalar", value_parser = range, allow_hyphen_values = true)]
    range: Option<[f64; 2]>,
    /// The colours; by default diverging around zero for mean-curvature, and else viridis
    #[arg(long, value_name = "MAP", requires = "scalar")]
    map: Option<Map>,
    /// Draw no bar of colours
    #[arg(long, requires = "scalar")]
    no_bar: bool,
    /// Mark triangles that intersect others, and the segments in which they meet
    #[arg(long)]
    crossing: bool,
    /// Do not mark borders and edges of three or more triangles
    #[arg(long)]
    no_borders: bool,
    /// Leave free what nothing is drawn on
    #[arg(long)]
    transparent: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum View {
    Front,
    Back,
    Left,
    Right,
    Top,
    Bottom,
    ThreeQuarter,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Up {
    Y,
    Z,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Style {
    /// Triangles
    Surface,
    /// Triangles, and their edges
    SurfaceEdges,
    /// Edges that nothing hides
    VisibleEdges,
    /// All edges
    Edges,
    /// Vertices
    Points,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Shading {
    Flat,
    Smooth,
    Unlit,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Projection {
    Orthographic,
    Perspective,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Map {
    /// Dark violet to yellow
    Viridis,
    /// Blue over white to orange
    Diverging,
}

#[derive(Serialize)]
struct Done {
    input: PathBuf,
    output: PathBuf,
    width: u32,
    height: u32,
    /// Triangles that intersect others; none unless asked for.
    intersecting_triangles: Option<usize>,
    scalar: Option<ScalarDone>,
    bytes: u64,
}

/// The values shown.
#[derive(Serialize)]
struct ScalarDone {
    name: String,
    /// Of the finite ones; none if there is none.
    least: Option<f64>,
    greatest: Option<f64>,
    /// Vertices or points without a finite one.
    missing: usize,
}

/// Where triangles intersect.
#[derive(Default)]
struct Crossing {
    triangles: Vec<TriangleId>,
    strokes: Vec<Stroke>,
}

impl Render {
    /// Reads, draws, writes.
    pub fn run(self, global: &Global, watch: &Watch) -> Result<(), Failure> {
        let extension = self.target.output.extension();
        if !extension.is_some_and(|extension| extension.eq_ignore_ascii_case("png")) {
            return Err(Failure::OutputFormat {
                path: self.target.output,
                verb: "render",
                known: "png".to_owned(),
            });
        }
        self.target.check_place()?;
        let data = super::read(&self.input, watch)?.data;
        let (soup, normals) = match &data {
            Data::Mesh { soup, normals } => (Some(soup), normals.as_deref()),
            Data::Points(cloud) => (None, cloud.normals()),
        };
        let view = match &data {
            Data::Mesh { soup, .. } => soup.into(),
            Data::Points(cloud) => MeshView {
                positions: cloud.positions(),
                triangles: &[],
            },
        };
        let scalars = self.scalar.as_ref();
        let scalars = scalars.map(|scalar| scalar.of(&self.input, view, watch));
        let scalars = scalars.transpose()?;
        let crossing = match soup {
            Some(soup) if self.crossing => self.find_crossing(soup, watch)?,
            _ => Crossing::default(),
        };
        let image = self.draw(soup, (view.positions, normals), scalars.as_ref(), &crossing)?;
        let bytes = interrupt::while_writing(|| {
            write_png(
                &self.target.output,
                image.width,
                image.height,
                Pixels::Rgba(image.pixels.as_flattened()),
                &self.target.options(watch),
            )
        })?;
        let done = Done {
            intersecting_triangles: self.crossing.then_some(crossing.triangles.len()),
            scalar: scalars.map(ScalarDone::of),
            input: self.input,
            output: self.target.output,
            width: image.width,
            height: image.height,
            bytes,
        };
        output::report(global, &done)
    }

    fn draw(
        &self,
        soup: Option<&TriangleSoup>,
        (positions, normals): (&[DVec3], Option<&[DVec3]>),
        scalars: Option<&Scalars>,
        crossing: &Crossing,
    ) -> Result<render::Image, Failure> {
        let mut drawing = match soup {
            Some(soup) if self.style != Style::Points => Drawing {
                marked: &crossing.triangles,
                ..Drawing::mesh(soup)
            },
            _ => Drawing::points(positions, normals),
        };
        drawing.strokes = &crossing.strokes;
        if let Some(scalars) = scalars {
            drawing.coloring = Coloring::Values(self.values(scalars));
        }
        render::render(&drawing, &self.options()).map_err(|reason| Failure::Render {
            path: self.input.clone(),
            reason,
        })
    }

    fn values<'a>(&self, scalars: &'a Scalars) -> Values<'a> {
        let signed = self.scalar == Some(Scalar::MeanCurvature);
        let map = match self.map {
            Some(Map::Viridis) => ColorMap::Viridis,
            Some(Map::Diverging) => ColorMap::Diverging,
            None if signed => ColorMap::Diverging,
            None => ColorMap::Viridis,
        };
        // Around zero, so that the middle of the colours is where the sign changes.
        let around_zero = || match (map, scalars.ends()) {
            (ColorMap::Diverging, Some([low, high])) if low < 0.0 && high > 0.0 => {
                let end = high.max(-low);
                Some([-end, end])
            }
            _ => None,
        };
        Values {
            range: self.range.or_else(around_zero),
            map,
            title: &scalars.name,
            bar: if self.no_bar { Bar::Absent } else { Bar::Right },
            ..Values::new(&scalars.values)
        }
    }

    fn find_crossing(&self, soup: &TriangleSoup, watch: &Watch) -> Result<Crossing, Failure> {
        let pairs =
            self_intersections(soup.into(), watch).map_err(super::mesh_failure(&self.input))?;
        let mut triangles: Vec<TriangleId> = pairs.iter().flat_map(|&(a, b)| [a, b]).collect();
        triangles.sort_unstable();
        triangles.dedup();
        let segments = intersection_segments(soup.into(), watch)
            .map_err(super::repair_failure(&self.input))?;
        tracing::info!(
            "{} triangles intersect others, in {} segments",
            triangles.len(),
            segments.len()
        );
        let strokes = segments.iter().map(|segment| Stroke {
            ends: segment.ends,
            color: CROSSING_COLOR,
            width: CROSSING_WIDTH,
            visibility: Visibility::Hidden,
        });
        Ok(Crossing {
            strokes: strokes.collect(),
            triangles,
        })
    }

    fn options(&self) -> Options {
        Options {
            width: self.width,
            height: self.height,
            views: self.views.iter().copied().map(View::into).collect(),
            up: match self.up {
                Up::Y => render::Up::Y,
                Up::Z => render::Up::Z,
            },
            projection: match self.projection {
                Projection::Orthographic => render::Projection::Orthographic,
                Projection::Perspective => render::Projection::Perspective,
            },
            shading: match self.shading {
                Shading::Flat => render::Shading::Flat,
                Shading::Smooth => render::Shading::Smooth,
                Shading::Unlit => render::Shading::Unlit,
            },
            style: match self.style {
                Style::Surface | Style::Points => render::Style::Surface,
                Style::SurfaceEdges => render::Style::SurfaceAndEdges,
                Style::VisibleEdges => render::Style::VisibleEdges,
                Style::Edges => render::Style::AllEdges,
            },
            edge_width: self.edge_width,
            borders: match self.no_borders {
                true => Borders::Plain,
                false => Borders::Marked,
            },
            background: match self.transparent {
                true => Background::Transparent,
                false => Background::Opaque,
            },
            ..Options::default()
        }
    }
}

impl ScalarDone {
    fn of(scalars: Scalars) -> Self {
        let ends = scalars.ends();
        Self {
            least: ends.map(|[least, _]| least),
            greatest: ends.map(|[_, greatest]| greatest),
            missing: scalars.values.iter().filter(|v| !v.is_finite()).count(),
            name: scalars.name,
        }
    }
}

/// Two numbers, the first not above the second.
fn range(text: &str) -> Result<[f64; 2], String> {
    let (low, high) = text
        .split_once(',')
        .ok_or("two numbers with a comma between them")?;
    let number = |text: &str| crate::arguments::number(text.trim(), |_| true, "must be finite");
    let range = [number(low)?, number(high)?];
    match range[0] <= range[1] {
        true => Ok(range),
        false => Err("the first must not be above the second".to_owned()),
    }
}

impl From<View> for render::View {
    fn from(view: View) -> Self {
        match view {
            View::Front => Self::Front,
            View::Back => Self::Back,
            View::Left => Self::Left,
            View::Right => Self::Right,
            View::Top => Self::Top,
            View::Bottom => Self::Bottom,
            View::ThreeQuarter => Self::ThreeQuarter,
        }
    }
}
