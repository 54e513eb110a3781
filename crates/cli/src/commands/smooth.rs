//! `pellicle smooth`.

use crate::arguments::{Global, Target, positive};
use crate::failure::Failure;
use crate::output;
use crate::progress::Watch;
use crate::surface::Surface;
use clap::Args;
use pellicle::evolution::{Error, Evolution, One, Redistribution, StepOptions};
use pellicle::geometry::{Cancelled, Progress};
use pellicle::io::Content;
use pellicle::mesh::{AngleBounds, TriMesh, quality, signed_volume};
use serde::Serialize;
use std::path::PathBuf;

const EXAMPLE: &str = "\
Example:
  pellicle smooth surface.ply -o smooth.ply --steps 5

A step of strength S is S square mean edges of time in the mean curvature flow: N steps take waves down to a third that \
are 2 pi sqrt(N S) mean edges long, which is three edges with the defaults, and shorter ones further. Tubes thinner than \
sqrt(2 N S) mean edges in radius pinch off. Where triangles are very uneven, remesh first.";

/// Smooth a closed mesh by mean curvature flow
///
/// Vertices move along their normals, faster where the surface bends more, and a little along the surface, for better
/// angles; connectivity stays. After each step the surface is pushed out evenly until it holds the volume that it had.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLE)]
pub struct Smooth {
    /// The mesh: closed, an oriented manifold
    #[arg(value_name = "MESH")]
    input: PathBuf,
    #[command(flatten)]
    target: Target,
    /// How many steps
    #[arg(long, value_name = "N", default_value_t = 10)]
    steps: u32,
    /// How much a step smooths, in squares of the mean edge length
    #[arg(long, value_name = "S", default_value_t = 0.02, value_parser = positive)]
    strength: f64,
    /// Let the volume shrink, as it does in the mean curvature flow, instead of keeping it
    #[arg(long)]
    free: bool,
}

#[derive(Serialize)]
struct Done {
    input: PathBuf,
    output: PathBuf,
    steps: u32,
    volume_before: f64,
    #[serde(flatten)]
    surface: Surface,
    bytes: u64,
}

impl Smooth {
    /// Reads a mesh, smooths it, writes it.
    pub fn run(self, global: &Global, watch: &Watch) -> Result<(), Failure> {
        self.target.check(Content::Mesh)?;
        let mesh = super::read_manifold(&self.input, watch)?;
        let volume = signed_volume((&mesh).into());
        let mesh = self
            .smooth(mesh, volume, watch)
            .map_err(|reason| Failure::Evolution {
                path: self.input.clone(),
                reason,
            })?;
        let written = self.target.write_mesh(&mesh, watch)?;
        let done = Done {
            surface: Surface::of(&mesh, watch).map_err(super::mesh_failure(&self.target.output))?,
            steps: self.steps,
            volume_before: volume,
            input: self.input,
            output: self.target.output,
            bytes: written.bytes,
        };
        done.surface.log();
        output::report(global, &done)
    }

    fn smooth(&self, mesh: TriMesh, volume: f64, watch: &Watch) -> Result<TriMesh, Error> {
        let quality = quality((&mesh).into(), &AngleBounds::default());
        let mean_edge = quality.map_or(0.0, |quality| quality.mean_edge);
        let options = StepOptions {
            advection: 0.0,
            diffusion: self.strength * mean_edge * mean_edge,
            time_step: 1.0,
            // Areas keep their ratios, so that small triangles may stay small.
            redistribution: Redistribution::AngleAware {
                omega: 0.0,
                omega_angles: 0.2,
            },
            ..StepOptions::default()
        };
        let mut evolution = Evolution::new(mesh)?;
        for step in 0..self.steps {
            Cancelled::check(watch.step("smooth", step.into(), self.steps.into()))?;
            evolution.step(&One, &options)?;
            if !self.free {
                evolution.restore_volume(volume)?;
            }
        }
        Ok(evolution.into_mesh())
    }
}
