//! The union of closed meshes: `cargo run --release --example union -- union.ply a.off b.off`
//!
//! Put into one soup, the meshes overlap; a place belongs to the union where the winding number is at least 1.

use pellicle::prelude::*;
use std::error::Error;
use std::path::PathBuf;

fn main() -> Result<(), Box<dyn Error>> {
    let files: Vec<PathBuf> = std::env::args_os().skip(1).map(PathBuf::from).collect();
    let Some((output, inputs)) = files.split_first() else {
        return Err("usage: union OUTPUT MESH…".into());
    };
    let mut meshes = Vec::new();
    for input in inputs {
        meshes.push(read_mesh(input, &ReadOptions::default())?.soup);
    }
    let (union, report) = union(&meshes)?;
    write_mesh(output, &union, None, &WriteOptions::default())?;
    println!(
        "{} triangles were cut; volume {:.6}, of {:.6} with overlaps counted twice",
        report.cut, report.volume[1], report.volume[0]
    );
    Ok(())
}

/// The border of what lies in at least one of the meshes: closed, and free of self-intersections, exactly.
pub fn union(
    meshes: &[TriangleSoup],
) -> Result<(TriMesh, transformesh::Report), transformesh::Error> {
    let mut all = TriangleSoup {
        positions: Vec::new(),
        triangles: Vec::new(),
    };
    for mesh in meshes {
        let first = all.positions.len() as u32;
        all.positions.extend(&mesh.positions);
        let moved = |corner: &VertexId| VertexId(corner.0 + first);
        all.triangles.extend(
            mesh.triangles
                .iter()
                .map(|triangle| triangle.each_ref().map(moved)),
        );
    }
    // A mesh whose triangles are reversed counts -1, and is taken away from the others.
    repair(&all, &transformesh::Options::default())
}
