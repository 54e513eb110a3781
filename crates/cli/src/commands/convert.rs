//! `pellicle convert`.

use crate::arguments::{Global, Target};
use crate::failure::Failure;
use crate::output;
use crate::progress::Watch;
use clap::Args;
use pellicle::io::{Content, Data, write_mesh, write_points};
use serde::Serialize;
use std::path::PathBuf;

const EXAMPLE: &str = "\
Example:
  pellicle convert scan.laz -o scan.ply

Reads ply, xyz, pts, pwn, csv, pcd, las, laz, off, obj, stl, gltf and glb.";

/// Convert between formats: points stay points, a mesh stays a mesh
#[derive(Debug, Args)]
#[command(after_help = EXAMPLE)]
pub struct Convert {
    /// The file to read
    #[arg(value_name = "IN")]
    input: PathBuf,
    #[command(flatten)]
    target: Target,
}

#[derive(Serialize)]
struct Done {
    input: PathBuf,
    output: PathBuf,
    vertices: usize,
    triangles: usize,
    bytes: u64,
    /// What the format could not hold as it was.
    notes: Vec<String>,
}

impl Convert {
    /// Reads, and writes what was read.
    pub fn run(self, global: &Global, watch: &Watch) -> Result<(), Failure> {
        self.target.check_place()?;
        let data = super::read(&self.input, watch)?.data;
        self.target.check(match &data {
            Data::Points(cloud) if cloud.normals().is_some() => Content::Normals,
            Data::Points(_) => Content::Points,
            Data::Mesh { .. } => Content::Mesh,
        })?;
        let options = self.target.options(watch);
        let (vertices, triangles) = match &data {
            Data::Points(cloud) => (cloud.len(), 0),
            Data::Mesh { soup, .. } => (soup.positions.len(), soup.triangles.len()),
        };
        let written = self.target.write(|| match &data {
            Data::Points(cloud) => write_points(&self.target.output, cloud, &options),
            Data::Mesh { soup, normals } => {
                write_mesh(&self.target.output, soup, normals.as_deref(), &options)
            }
        })?;
        tracing::info!(
            "{}: {vertices} vertices, {triangles} triangles",
            self.target.output.display()
        );
        let done = Done {
            input: self.input,
            output: self.target.output,
            vertices,
            triangles,
            bytes: written.bytes,
            notes: written.notes.iter().map(ToString::to_string).collect(),
        };
        output::report(global, &done)
    }
}
