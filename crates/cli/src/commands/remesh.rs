//! `pellicle remesh`.

use crate::arguments::{Global, Target, number, positive};
use crate::failure::Failure;
use crate::output;
use crate::progress::Watch;
use crate::surface::Surface;
use clap::Args;
use pellicle::geometry::Aabb;
use pellicle::io::Content;
use pellicle::mesh::{
    CurvatureLength, Projection, Quality, RemeshOptions, RemeshReport, TargetLength, TriMesh,
    remesh,
};
use serde::Serialize;
use std::path::PathBuf;

const EXAMPLE: &str = "\
Examples:
  pellicle remesh scan.ply -o even.ply --edge-length 0.5
  pellicle remesh scan.ply -o coarse.ply --relative 2
  pellicle remesh part.stl -o part.ply --curvature 0.01 --creases 60

Lengths are in the units of the mesh. Topology stays: components, genus, borders.";

/// Give a mesh new triangles, even and well shaped
///
/// Edges are split, collapsed and flipped, and vertices relaxed on the surface, until edges have about the length wanted
/// and angles are good.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLE)]
pub struct Remesh {
    /// The mesh: an oriented manifold, open or closed
    #[arg(value_name = "MESH")]
    input: PathBuf,
    #[command(flatten)]
    target: Target,
    /// The length of edges
    #[arg(long, value_name = "LENGTH", value_parser = positive, conflicts_with_all = ["relative", "curvature"])]
    edge_length: Option<f64>,
    /// The length of edges, in mean edges of the mesh; 1 by default
    #[arg(long, value_name = "RATIO", value_parser = positive, conflicts_with = "curvature")]
    relative: Option<f64>,
    /// Edges short where the surface bends much: triangles lie within this distance of it
    #[arg(long, value_name = "TOLERANCE", value_parser = positive)]
    curvature: Option<f64>,
    /// With --curvature, the least length of edges; the tolerance by default
    #[arg(long, value_name = "LENGTH", value_parser = positive, requires = "curvature")]
    min: Option<f64>,
    /// With --curvature, the greatest length of edges; a tenth of the diagonal by default
    #[arg(long, value_name = "LENGTH", value_parser = positive, requires = "curvature")]
    max: Option<f64>,
    /// How often to split, collapse, flip and relax
    #[arg(long, value_name = "N", default_value_t = RemeshOptions::default().iterations)]
    iterations: u32,
    /// Keep edges across which normals turn by more than this; 60 finds the edges of machine parts
    #[arg(long, value_name = "DEGREES", value_parser = degrees)]
    creases: Option<f64>,
    /// Do not put vertices back onto the surface after they moved: faster, and less exact
    #[arg(long)]
    no_projection: bool,
}

#[derive(Serialize)]
struct Done {
    input: PathBuf,
    output: PathBuf,
    vertices_before: usize,
    triangles_before: usize,
    least_angle_before: Option<f64>,
    greatest_angle_before: Option<f64>,
    #[serde(flatten)]
    surface: Surface,
    splits: usize,
    collapses: usize,
    flips: usize,
    bytes: u64,
}

impl Remesh {
    /// Reads a mesh, remeshes it, writes it.
    pub fn run(self, global: &Global, watch: &Watch) -> Result<(), Failure> {
        self.target.check(Content::Mesh)?;
        let before = super::read_manifold(&self.input, watch)?;
        let (mesh, report) = remesh(&before, &self.options(&before), watch)
            .map_err(super::mesh_failure(&self.input))?;
        let written = self.target.write_mesh(&mesh, watch)?;
        let surface =
            Surface::of(&mesh, watch).map_err(super::mesh_failure(&self.target.output))?;
        let done = self.done(&before, &report, surface, written.bytes);
        done.log();
        output::report(global, &done)
    }

    fn options(&self, mesh: &TriMesh) -> RemeshOptions {
        let target = match (self.edge_length, self.curvature) {
            (Some(length), _) => TargetLength::Absolute(length),
            (None, Some(tolerance)) => {
                let diagonal = Aabb::of_points(mesh.positions()).diagonal();
                let max = self
                    .max
                    .unwrap_or_else(|| (0.1 * diagonal).max(self.min.unwrap_or(tolerance)));
                let min = self.min.unwrap_or(tolerance.min(max));
                TargetLength::Curvature(CurvatureLength::new(tolerance, min, max))
            }
            (None, None) => TargetLength::Relative(self.relative.unwrap_or(1.0)),
        };
        RemeshOptions {
            target,
            iterations: self.iterations,
            projection: if self.no_projection {
                Projection::None
            } else {
                Projection::Surface
            },
            crease_angle: self.creases.map(f64::to_radians),
            ..RemeshOptions::default()
        }
    }

    fn done(self, before: &TriMesh, report: &RemeshReport, surface: Surface, bytes: u64) -> Done {
        let angle = |of: fn(&Quality) -> f64| report.before.as_ref().map(|q| of(q).to_degrees());
        Done {
            vertices_before: before.positions().len(),
            triangles_before: before.triangles().len(),
            least_angle_before: angle(|q| q.min_angle),
            greatest_angle_before: angle(|q| q.max_angle),
            surface,
            splits: report.splits,
            collapses: report.collapses,
            flips: report.flips,
            input: self.input,
            output: self.target.output,
            bytes,
        }
    }
}

impl Done {
    fn log(&self) {
        let (least, greatest) = (self.least_angle_before, self.greatest_angle_before);
        if let Some((least, greatest)) = least.zip(greatest) {
            tracing::info!(
                "before: {} vertices, {} triangles; angles from {least:.1} to {greatest:.1} degrees",
                self.vertices_before,
                self.triangles_before
            );
        }
        self.surface.log();
    }
}

fn degrees(text: &str) -> Result<f64, String> {
    number(
        text,
        |value| (0.0..=180.0).contains(&value),
        "must be an angle from 0 to 180 degrees",
    )
}
