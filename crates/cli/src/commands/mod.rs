//! One module a verb: its arguments, and the calls of the library that it stands for.

pub mod compare;
pub mod convert;
pub mod delaunay;
pub mod evolve;
pub mod info;
pub mod morph;
pub mod normals;
pub mod reconstruct;
pub mod remesh;
pub mod render;
pub mod repair;
pub mod smooth;
pub mod view;

use crate::arguments::{Global, Verb};
use crate::failure::Failure;
use crate::output::log_notes;
use crate::progress::Watch;
use pellicle::delaunay::{Options, Tetrahedralization, tetrahedralize_with};
use pellicle::geometry::{DVec3, PointCloud};
use pellicle::io::{self, Content, Format, ReadOptions};
use pellicle::mesh::{MeshError, TriMesh};
use pellicle::transformesh;
use std::path::Path;

/// Does what the verb says.
pub fn run(verb: Verb, global: &Global) -> Result<(), Failure> {
    let watch = Watch::new(global);
    match verb {
        Verb::Reconstruct(verb) => verb.run(global, &watch),
        Verb::Evolve(verb) => verb.run(global, &watch),
        Verb::Morph(verb) => verb.run(global, &watch),
        Verb::Delaunay(verb) => verb.run(global, &watch),
        Verb::Info(verb) => verb.run(global, &watch),
        Verb::Convert(verb) => verb.run(global, &watch),
        Verb::Normals(verb) => verb.run(global, &watch),
        Verb::Smooth(verb) => verb.run(global, &watch),
        Verb::Remesh(verb) => verb.run(global, &watch),
        Verb::Repair(verb) => verb.run(global, &watch),
        Verb::Compare(verb) => verb.run(global, &watch),
        Verb::Render(verb) => verb.run(global, &watch),
        Verb::View(verb) => verb.run(global, &watch),
    }
}

/// How files are read.
pub fn read_options(watch: &Watch) -> ReadOptions<'_> {
    ReadOptions {
        progress: watch,
        ..ReadOptions::default()
    }
}

/// Reads points, and logs what the reader left out.
fn read_points(path: &Path, watch: &Watch) -> Result<PointCloud, Failure> {
    let read = io::read_points(path, &read_options(watch))?;
    log_notes(path, &read.report.notes);
    Ok(read.cloud)
}

/// Reads a mesh that is an oriented manifold, and logs what the reader left out.
fn read_manifold(path: &Path, watch: &Watch) -> Result<TriMesh, Failure> {
    let read = io::read_mesh(path, &read_options(watch))?;
    log_notes(path, &read.report.notes);
    TriMesh::try_from(read.soup).map_err(mesh_failure(path))
}

/// The failure of something done with the mesh of a file.
pub fn mesh_failure(path: &Path) -> impl Fn(MeshError) -> Failure + use<> {
    let path = path.to_owned();
    move |reason| Failure::Mesh {
        path: path.clone(),
        reason,
    }
}

/// The failure of a repair of the mesh of a file, or of a search for its intersections.
fn repair_failure(path: &Path) -> impl Fn(transformesh::Error) -> Failure + use<> {
    let path = path.to_owned();
    move |reason| {
        let path = path.clone();
        match reason {
            transformesh::Error::Open { edges, from, to } => Failure::Open {
                path,
                edges,
                from,
                to,
            },
            reason => Failure::Repair { path, reason },
        }
    }
}

/// Reads points or a mesh, and logs what the reader left out.
pub fn read(path: &Path, watch: &Watch) -> Result<io::Read, Failure> {
    let read = io::read(path, &read_options(watch))?;
    log_notes(path, &read.report.notes);
    Ok(read)
}

/// The tetrahedra of points, with their file in the error.
fn tetrahedralize<'a>(
    path: &Path,
    points: &'a [DVec3],
    watch: &Watch,
) -> Result<Tetrahedralization<'a>, Failure> {
    tetrahedralize_with(points, &Options::default(), watch).map_err(|reason| Failure::Delaunay {
        path: path.to_owned(),
        reason,
    })
}

/// The extensions of the formats that hold `content`, and further ones, for messages.
fn extensions(content: Content, further: &[&str]) -> String {
    let names: Vec<&str> = Format::ALL
        .into_iter()
        .filter(|format| format.can_write(content))
        .flat_map(|format| format.extensions())
        .chain(further)
        .copied()
        .collect();
    names.join(", ")
}
