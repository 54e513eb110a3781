//! A closed surface shrinks onto noisy points: `cargo run --release --example evolve -- scan.xyz surface.ply [VOXELS]`
//!
//! Prints volume and vertices on the way. A file `stop` in the folder it runs in ends it.

use pellicle::evolution::{Options, evolve_with};
use pellicle::prelude::*;
use std::error::Error;
use std::ops::ControlFlow;
use std::path::Path;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let (scan, output, voxels) = match arguments.as_slice() {
        [scan, output] => (scan, output, 200),
        [scan, output, voxels] => (scan, output, voxels.parse()?),
        _ => return Err("usage: evolve SCAN OUTPUT [VOXELS]".into()),
    };
    let stop = || Path::new("stop").exists();
    let evolved = run(Path::new(scan), voxels, stop, &mut |line| {
        eprintln!("{line}")
    })?;
    write_mesh(output, &evolved.mesh, None, &WriteOptions::default())?;
    println!("volume {:.6}", mesh::signed_volume((&evolved.mesh).into()));
    Ok(())
}

/// Asked between steps whether to go on; `Break` ends the work with an error, never with half a surface.
struct Until<F>(F);

impl<F: Fn() -> bool + Sync> Progress for Until<F> {
    fn step(&self, _stage: &'static str, _done: u64, _total: u64) -> ControlFlow<()> {
        match (self.0)() {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        }
    }
}

/// Evolves a surface onto the points of a file, and tells of every tenth step.
pub fn run(
    scan: &Path,
    voxels: u32,
    stop: impl Fn() -> bool + Sync,
    say: &mut dyn FnMut(String),
) -> Result<Evolved, Box<dyn Error>> {
    let cloud = read_points(scan, &ReadOptions::default())?.cloud;
    let options = Options {
        resolution: voxels,
        smoothing: 5,
        ..Options::default()
    };
    let evolved = evolve_with(cloud.positions(), &options, &Until(stop), &mut |now, _| {
        if now.step % 10 == 1 {
            say(format!(
                "step {:4}: volume {:.6}, {} vertices, moved {:.2} voxels",
                now.step,
                now.volume,
                now.vertices,
                now.largest_move / now.spacing
            ));
        }
    })?;
    if !evolved.report.at_rest {
        say("the surface still moved when its steps ran out".to_owned());
    }
    Ok(evolved)
}
