//! Meshes and points to a page that turns them.
//!
//! ![The page in a browser: a surface that evolves, and its controls][view.png]
//!
//! ```sh
//! pellicle evolve fixtures/oni.pwn -o oni.ply --grid 60 --snapshots evolve --every 10
//! pellicle view evolve -o view.html
//! ```
//!
//! One file that needs no network: drag turns, the wheel comes nearer, and numbered meshes are played as steps. What follows
//! a `#` in the address is shown at first: `view.html#view=front&wireframe=on&step=3`.
//!
//! The page belongs to the program. A library shows meshes in other people's viewers, as an animated GLB for example:
//!
//! ```
//! use pellicle::io::{AnimationOptions, Frame, write_animation};
//! use pellicle::prelude::*;
//!
//! # let folder = tempfile::tempdir()?;
//! # let path = folder.path().join("growing.glb");
//! let sphere = mesh::icosphere(2)?;
//! let mut larger = sphere.clone();
//! larger.set_positions(sphere.positions().iter().map(|p| 2.0 * *p).collect())?;
//! let frames = [&sphere, &larger].map(|mesh| Frame { mesh: mesh.into(), normals: None });
//! write_animation(&path, frames, &AnimationOptions::default(), &WriteOptions::default())?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
#![doc = include_str!("pictures/view.md")]
