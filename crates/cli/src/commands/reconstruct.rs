//! `pellicle reconstruct`.

use super::evolve::Evolve;
use crate::arguments::{Global, Target};
use crate::failure::Failure;
use crate::output;
use crate::progress::Watch;
use clap::{Args, ValueEnum};
use pellicle::cocone::{self, reconstruct_with};
use pellicle::io::Content;
use serde::Serialize;
use std::path::PathBuf;

const EXAMPLE: &str = "\
Examples:
  pellicle reconstruct scan.xyz -o mesh.ply
  pellicle reconstruct sparse.ply -o closed.obj --method tight-cocone
  pellicle reconstruct noisy.ply -o smooth.ply --method evolution";

/// Reconstruct a surface from points
///
/// The mesh's vertices are points of the input, unmoved, but for the method evolution, which is the verb evolve with its
/// defaults. Normals are not needed and not used.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLE)]
pub struct Reconstruct {
    /// The points: any point or mesh format
    #[arg(value_name = "IN")]
    input: PathBuf,
    #[command(flatten)]
    target: Target,
    /// How the surface is found: the first two choose among the Delaunay triangles
    #[arg(long, value_name = "METHOD", default_value = "cocone")]
    method: Method,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Method {
    /// The surface as far as the points support it; open where they do not
    Cocone,
    /// Always closed: the boundary of a solid
    TightCocone,
    /// A closed surface that shrinks onto the points: for noise, outliers and gaps
    Evolution,
}

#[derive(Serialize)]
struct Done {
    input: PathBuf,
    output: PathBuf,
    points: usize,
    points_used: usize,
    points_dropped: usize,
    vertices: usize,
    triangles: usize,
    candidate_triangles: usize,
    pruned_triangles: usize,
    undersampled_points: usize,
    components: Vec<Component>,
    closed: bool,
    bytes: u64,
}

#[derive(Serialize)]
struct Component {
    triangles: usize,
    vertices: usize,
    genus: usize,
    borders: usize,
}

impl From<&cocone::Component> for Component {
    fn from(component: &cocone::Component) -> Self {
        Self {
            triangles: component.triangles,
            vertices: component.vertices,
            genus: component.genus,
            borders: component.borders,
        }
    }
}

impl Reconstruct {
    /// Reads points, tetrahedralises, reconstructs, writes.
    pub fn run(self, global: &Global, watch: &Watch) -> Result<(), Failure> {
        let method = match self.method {
            Method::Cocone => cocone::Method::Cocone,
            Method::TightCocone => cocone::Method::TightCocone,
            Method::Evolution => {
                return Evolve::with_defaults(self.input, self.target).run(global, watch);
            }
        };
        self.target.check(Content::Mesh)?;
        let cloud = super::read_points(&self.input, watch)?;
        let tetrahedralization = super::tetrahedralize(&self.input, cloud.positions(), watch)?;
        let mut options = cocone::Options::default();
        options.method = method;
        let reconstruction =
            reconstruct_with(&tetrahedralization, &options, watch).map_err(|reason| {
                Failure::Cocone {
                    path: self.input.clone(),
                    reason,
                }
            })?;
        drop(tetrahedralization);
        let (mesh, report) = (&reconstruction.mesh, &reconstruction.report);
        let written = self.target.write_mesh(mesh, watch)?;
        tracing::info!(
            "{} points, {} used; {} triangles, {}",
            cloud.len(),
            report.used,
            mesh.triangles().len(),
            if mesh.is_closed() { "closed" } else { "open" }
        );
        if report.used < cloud.len() / 2 {
            tracing::warn!(
                "{} of {} points found no place in the surface: the sample is sparse or noisy there{}",
                cloud.len() - report.used,
                cloud.len(),
                match method {
                    cocone::Method::Cocone =>
                        "; `--method tight-cocone` closes what is left open, `--method evolution` smooths noise",
                    cocone::Method::TightCocone => "; `--method evolution` smooths noise",
                }
            );
        }
        let done = Done {
            points: cloud.len(),
            points_used: report.used,
            points_dropped: report.dropped.len(),
            vertices: mesh.positions().len(),
            triangles: mesh.triangles().len(),
            candidate_triangles: report.candidate_triangles,
            pruned_triangles: report.pruned_triangles,
            undersampled_points: report.undersampled.len(),
            components: report.components.iter().map(Component::from).collect(),
            closed: mesh.is_closed(),
            input: self.input,
            output: self.target.output,
            bytes: written.bytes,
        };
        output::report(global, &done)
    }
}
