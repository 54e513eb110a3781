//! `pellicle render`.

use crate::arguments::{Global, Target};
use crate::failure::Failure;
use crate::progress::Watch;
use crate::{interrupt, output};
use clap::{Args, ValueEnum};
use pellicle::io::{Data, Pixels, write_png};
use pellicle::render::{self, Options, render_mesh, render_points};
use serde::Serialize;
use std::path::PathBuf;

const EXAMPLE: &str = "\
Example:
  pellicle render mesh.ply -o mesh.png

Triangles seen from behind are purple, borders are orange, edges of three or more triangles are red. The picture is the
same on every machine.";

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
    /// One normal a triangle, or blended ones
    #[arg(long, value_name = "HOW", default_value = "flat")]
    shading: Shading,
    /// How depth shows
    #[arg(long, value_name = "HOW", default_value = "perspective")]
    projection: Projection,
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
enum Shading {
    Flat,
    Smooth,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Projection {
    Orthographic,
    Perspective,
}

#[derive(Serialize)]
struct Done {
    input: PathBuf,
    output: PathBuf,
    width: u32,
    height: u32,
    bytes: u64,
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
        let options = self.options();
        let image = match super::read(&self.input, watch)?.data {
            Data::Mesh { soup, .. } => render_mesh((&soup).into(), &options),
            Data::Points(cloud) => render_points(cloud.positions(), cloud.normals(), &options),
        }
        .map_err(|reason| Failure::Render {
            path: self.input.clone(),
            reason,
        })?;
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
            input: self.input,
            output: self.target.output,
            width: image.width,
            height: image.height,
            bytes,
        };
        output::report(global, &done)
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
            },
            ..Options::default()
        }
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
