//! Writes every shape as PLY, with its picture, into a folder, and a table of their measures.
//!
//! `cargo run --release -p pellicle-figures --example shapes -- FOLDER`

use pellicle::io::{Overwrite, Pixels, write_png};
use pellicle::mesh::summarize;
use pellicle::prelude::*;
use pellicle_figures::shapes;
use std::path::PathBuf;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = std::env::args().nth(1).map(PathBuf::from);
    let folder = folder.ok_or("which folder?")?;
    let write = WriteOptions {
        overwrite: Overwrite::Replace,
        ..WriteOptions::default()
    };
    let draw = render::Options {
        width: 1000,
        height: 800,
        shading: render::Shading::Smooth,
        ..render::Options::default()
    };
    println!(
        "| shape | vertices | diagonal | area | volume | volume of the mesh |\n|---|---:|---:|---:|---:|---:|"
    );
    for shape in shapes::all() {
        let mesh = MeshView::from(&shape.truth);
        let name = shape.name.replace(' ', "-");
        write_mesh(folder.join(format!("{name}.ply")), mesh, None, &write)?;
        let image = render_mesh(mesh, &draw)?;
        write_png(
            folder.join(format!("{name}.png")),
            image.width,
            image.height,
            Pixels::Rgba(image.pixels.as_flattened()),
            &write,
        )?;
        println!(
            "| {} | {} | {:.3} | {:.3} | {:.5} | {:.5} |",
            shape.name,
            mesh.positions.len(),
            shape.diagonal(),
            summarize(mesh)?.area,
            shape.volume,
            mesh::signed_volume(mesh),
        );
    }
    Ok(())
}
