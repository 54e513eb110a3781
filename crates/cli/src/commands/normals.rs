//! `pellicle normals`.

use crate::arguments::{Global, Target};
use crate::failure::Failure;
use crate::output;
use crate::progress::Watch;
use clap::Args;
use pellicle::cocone;
use pellicle::geometry::PointCloud;
use pellicle::io::{Content, write_points};
use serde::Serialize;
use std::path::PathBuf;

const EXAMPLE: &str = "\
Example:
  pellicle normals scan.xyz -o oriented.ply";

/// Estimate an oriented normal at every point
///
/// Normals have length one and point out of the surface. Those that the input has are not used.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLE)]
pub struct Normals {
    /// The points: any point or mesh format
    #[arg(value_name = "IN")]
    input: PathBuf,
    #[command(flatten)]
    target: Target,
}

#[derive(Serialize)]
struct Done {
    input: PathBuf,
    output: PathBuf,
    points: usize,
    bytes: u64,
}

impl Normals {
    /// Reads points, tetrahedralises, writes the points with their normals.
    pub fn run(self, global: &Global, watch: &Watch) -> Result<(), Failure> {
        self.target.check(Content::Normals)?;
        let cloud = super::read_points(&self.input, watch)?;
        let tetrahedralization = super::tetrahedralize(&self.input, cloud.positions(), watch)?;
        let normals = cocone::normals_with(&tetrahedralization, watch)?;
        drop(tetrahedralization);
        let (positions, _) = cloud.into_parts();
        let cloud = PointCloud::new(positions).and_then(|cloud| cloud.with_normals(normals))?;
        let written = self
            .target
            .write(|| write_points(&self.target.output, &cloud, &self.target.options(watch)))?;
        tracing::info!("{} points with normals", cloud.len());
        let done = Done {
            points: cloud.len(),
            input: self.input,
            output: self.target.output,
            bytes: written.bytes,
        };
        output::report(global, &done)
    }
}
