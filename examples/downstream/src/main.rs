//! One body becomes another, and a picture shows both beside the result:
//! `cargo run --release -- SOURCE TARGET PICTURE.png`

use pellicle::prelude::*;
use pellicle::render::{Image, Options, View, strip};
use pellicle::transformesh::{MorphEnd, MorphOptions, Placement};
use std::error::Error;
use std::path::PathBuf;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<PathBuf> = std::env::args_os().skip(1).map(PathBuf::from).collect();
    let [source, target, picture] = arguments.as_slice() else {
        return Err("usage: pellicle-downstream SOURCE TARGET PICTURE.png".into());
    };
    let source = read_mesh(source, &ReadOptions::default())?.soup;
    let target = read_mesh(target, &ReadOptions::default())?.soup;

    // The picture is written in the end; better to know now that its place is taken.
    if picture.exists() {
        return Err(format!("{} exists already", picture.display()).into());
    }
    let options = MorphOptions {
        placement: Placement::Enclose,
        ..MorphOptions::default()
    };
    let (result, report) = morph(&source, &target, &options)?;
    println!(
        "{} steps, {} changes of topology; {:.2e} from the target in the mean",
        report.steps, report.topology_changes, report.mean_distance
    );
    if report.end != MorphEnd::Arrived {
        return Err("the source did not become the target".into());
    }

    let images = [
        draw((&source).into())?,
        draw((&result).into())?,
        draw((&target).into())?,
    ];
    let image = strip(&images, images.len())?;
    let pixels = io::Pixels::Rgba(image.pixels.as_flattened());
    io::write_png(
        picture,
        image.width,
        image.height,
        pixels,
        &WriteOptions::default(),
    )?;
    Ok(())
}

fn draw(mesh: MeshView) -> Result<Image, render::Error> {
    let options = Options {
        width: 400,
        height: 400,
        views: vec![View::ThreeQuarter],
        ..Options::default()
    };
    render_mesh(mesh, &options)
}
