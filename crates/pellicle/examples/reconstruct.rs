//! A scan becomes a watertight mesh: `cargo run --release --example reconstruct -- scan.xyz mesh.ply`

use pellicle::prelude::*;
use std::path::Path;
use std::process::ExitCode;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [scan, output] = arguments.as_slice() else {
        eprintln!("usage: reconstruct SCAN OUTPUT");
        return ExitCode::from(2);
    };
    match run(Path::new(scan), Path::new(output)) {
        Ok(said) => {
            println!("{said}");
            ExitCode::SUCCESS
        }
        Err(Failure::Span(reason)) => {
            eprintln!("{scan}: {reason}; a surface needs points all around a body");
            ExitCode::FAILURE
        }
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}

/// What can go wrong, each with the words of the library.
#[derive(Debug)]
pub enum Failure {
    /// A file cannot be read or written.
    File(io::Error),
    /// The points span no tetrahedron, or are not finite.
    Span(delaunay::Error),
    /// Anything later on.
    Other(Box<dyn std::error::Error>),
}

/// Reads the scan, reconstructs, writes the mesh, and says what came of it.
pub fn run(scan: &Path, output: &Path) -> Result<String, Failure> {
    let cloud = read_points(scan, &ReadOptions::default())
        .map_err(Failure::File)?
        .cloud;
    let tetrahedra =
        tetrahedralize(cloud.positions(), &delaunay::Options::default()).map_err(Failure::Span)?;

    let mut options = cocone::Options::default();
    options.method = cocone::Method::TightCocone;
    let surface =
        reconstruct(&tetrahedra, &options).map_err(|error| Failure::Other(error.into()))?;

    // A file that exists is left as it is, and that is an error.
    write_mesh(output, &surface.mesh, None, &WriteOptions::default()).map_err(Failure::File)?;

    let summary =
        mesh::summarize((&surface.mesh).into()).map_err(|error| Failure::Other(error.into()))?;
    Ok(format!(
        "{} of {} points, {} triangles in {} components, volume {:.6}",
        surface.report.used,
        cloud.len(),
        summary.triangles,
        summary.components.len(),
        summary.volume.unwrap_or(f64::NAN),
    ))
}

impl std::fmt::Display for Failure {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::File(error) => error.fmt(f),
            Self::Span(error) => error.fmt(f),
            Self::Other(error) => error.fmt(f),
        }
    }
}
