//! A surface in motion, kept as it goes: numbered meshes, and at the end all of them as one animation and one picture.

use crate::failure::Failure;
use crate::interrupt;
use crate::output::{check_parent, check_place};
use crate::progress::Watch;
use pellicle::geometry::Aabb;
use pellicle::io::{
    self, AnimationOptions, AnimationWriter, Frame, Overwrite, Pixels, ReadOptions, WriteOptions,
    read_mesh, write_mesh, write_png,
};
use pellicle::mesh::{MeshView, TriMesh, TriangleSoup};
use pellicle::render::{Options, View, render_mesh, strip};
use serde::Serialize;
use std::path::{Path, PathBuf};

/// Pictures of the strip, and how many stand in a row.
const PICTURES: usize = 8;
const COLUMNS: usize = 4;
/// Pixels of a side of each.
const PICTURE_SIZE: u32 = 400;

/// A folder of snapshots.
pub struct Snapshots<'a> {
    folder: PathBuf,
    /// What animation and pictures are called.
    name: &'static str,
    every: u64,
    force: bool,
    watch: &'a Watch,
    /// The steps that there are meshes of.
    steps: Vec<u64>,
}

/// What the folder holds.
#[derive(Serialize)]
pub struct Kept {
    folder: PathBuf,
    meshes: usize,
    animation: PathBuf,
    strip: PathBuf,
}

impl<'a> Snapshots<'a> {
    /// A folder for a mesh every so many steps, and at last `name.glb` and `name.png`. Nothing is written yet, but whether
    /// it can be is asked.
    pub fn new(
        folder: &Path,
        name: &'static str,
        every: u64,
        force: bool,
        watch: &'a Watch,
    ) -> Result<Self, Failure> {
        check_parent(folder)?;
        match std::fs::read_dir(folder) {
            Ok(entries) => {
                for entry in entries.filter_map(Result::ok) {
                    if is_ours(&entry.file_name().to_string_lossy(), name) {
                        check_place(&entry.path(), force)?;
                    }
                }
            }
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => {}
            Err(error) => return Err(created(folder, error)),
        }
        Ok(Self {
            folder: folder.to_owned(),
            name,
            every,
            force,
            watch,
            steps: Vec::new(),
        })
    }

    /// Keeps the surface after a step, if it is its turn: the first, and every so many.
    pub fn step(&mut self, step: u64, mesh: &TriMesh) -> Result<(), Failure> {
        let is_new = self.steps.last() != Some(&step);
        match is_new && (self.steps.is_empty() || step.is_multiple_of(self.every)) {
            true => self.keep(step, mesh),
            false => Ok(()),
        }
    }

    fn keep(&mut self, step: u64, mesh: &TriMesh) -> Result<(), Failure> {
        if self.steps.is_empty() {
            std::fs::create_dir_all(&self.folder).map_err(|error| created(&self.folder, error))?;
        }
        let is_new = self.steps.last() != Some(&step);
        let options = self.options(!is_new);
        interrupt::while_writing(|| write_mesh(self.path(step), mesh, None, &options))?;
        if is_new {
            self.steps.push(step);
        }
        Ok(())
    }

    /// Keeps the result, whatever its turn, and puts all snapshots together.
    pub fn finish(mut self, step: u64, mesh: &TriMesh) -> Result<Kept, Failure> {
        self.keep(step, mesh)?;
        let bounds = self.animate()?;
        self.draw(bounds)?;
        Ok(Kept {
            meshes: self.steps.len(),
            animation: self.animation(),
            strip: self.strip(),
            folder: self.folder,
        })
    }

    /// Writes the animation; returns the box around all its frames.
    fn animate(&self) -> Result<Aabb, Failure> {
        let path = self.animation();
        let options = self.options(false);
        let mut bounds = Aabb::EMPTY;
        // That it holds single precision is no loss for the eye: no notes of it.
        interrupt::while_writing(|| {
            let animation = AnimationOptions::default();
            let mut writer = AnimationWriter::create(&path, &animation, &options)?;
            for &step in &self.steps {
                let soup = self.read(step)?;
                bounds = bounds.union(Aabb::of_points(&soup.positions));
                writer.push(Frame {
                    mesh: (&soup).into(),
                    normals: None,
                })?;
            }
            writer.finish()
        })?;
        Ok(bounds)
    }

    /// Writes some of the snapshots side by side, as one camera sees them.
    fn draw(&self, bounds: Aabb) -> Result<(), Failure> {
        let path = self.strip();
        let failed = |reason| Failure::Render {
            path: path.clone(),
            reason,
        };
        let options = Options {
            width: PICTURE_SIZE,
            height: PICTURE_SIZE,
            views: vec![View::ThreeQuarter],
            bounds: Some(bounds),
            ..Options::default()
        };
        let mut images = Vec::new();
        for index in evenly(self.steps.len(), PICTURES) {
            let soup = self.read(self.steps[index])?;
            images.push(render_mesh(MeshView::from(&soup), &options).map_err(failed)?);
        }
        let image = strip(&images, COLUMNS).map_err(failed)?;
        let pixels = Pixels::Rgba(image.pixels.as_flattened());
        interrupt::while_writing(|| {
            write_png(
                &path,
                image.width,
                image.height,
                pixels,
                &self.options(false),
            )
        })?;
        Ok(())
    }

    fn read(&self, step: u64) -> Result<TriangleSoup, io::Error> {
        let options = ReadOptions {
            progress: self.watch,
            ..ReadOptions::default()
        };
        Ok(read_mesh(self.path(step), &options)?.soup)
    }

    fn animation(&self) -> PathBuf {
        self.folder.join(format!("{}.glb", self.name))
    }

    fn strip(&self) -> PathBuf {
        self.folder.join(format!("{}.png", self.name))
    }

    fn path(&self, step: u64) -> PathBuf {
        self.folder.join(format!("step-{step:06}.ply"))
    }

    fn options(&self, replace: bool) -> WriteOptions<'a> {
        WriteOptions {
            overwrite: if self.force || replace {
                Overwrite::Replace
            } else {
                Overwrite::Refuse
            },
            progress: self.watch,
            ..WriteOptions::default()
        }
    }
}

/// Whether a file of this name may come of a run.
fn is_ours(name: &str, whole: &str) -> bool {
    let step = name
        .strip_prefix("step-")
        .and_then(|rest| rest.strip_suffix(".ply"));
    let is_step =
        step.is_some_and(|step| !step.is_empty() && step.bytes().all(|b| b.is_ascii_digit()));
    let extension = name.strip_prefix(whole);
    is_step || extension.is_some_and(|extension| [".glb", ".png"].contains(&extension))
}

/// At most `wanted` of `count` indices, evenly spread, the first and the last among them.
fn evenly(count: usize, wanted: usize) -> impl Iterator<Item = usize> {
    let chosen = wanted.min(count);
    (0..chosen).map(move |i| match chosen {
        1 => 0,
        _ => i * (count - 1) / (chosen - 1),
    })
}

fn created(folder: &Path, reason: std::io::Error) -> Failure {
    Failure::File(io::Error::Io {
        path: folder.to_owned(),
        action: "used as a folder for snapshots",
        reason,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_are_spread_from_the_first_to_the_last() {
        let chosen = |count| evenly(count, 8).collect::<Vec<_>>();
        assert!(chosen(0).is_empty());
        assert_eq!(chosen(1), [0]);
        assert_eq!(chosen(3), [0, 1, 2]);
        assert_eq!(chosen(15), [0, 2, 4, 6, 8, 10, 12, 14]);
        for count in 2..100 {
            let chosen = chosen(count);
            assert!(chosen.is_sorted_by(|a, b| a < b), "{count}");
            assert_eq!((chosen[0], chosen[chosen.len() - 1]), (0, count - 1));
        }
    }

    #[test]
    fn only_our_names_are_ours() {
        for name in ["step-000010.ply", "evolution.glb", "evolution.png"] {
            assert!(is_ours(name, "evolution"), "{name}");
        }
        for name in [
            "step-.ply",
            "step-1a.ply",
            "scan.ply",
            "evolution.csv",
            "morph.glb",
        ] {
            assert!(!is_ours(name, "evolution"), "{name}");
        }
    }
}
