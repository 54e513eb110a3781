//! A closed mesh to a smoother one.
//!
//! ![An elephant, faceted][before.png] ![The same after ten steps][smooth.png]
//!
//! ```sh
//! pellicle smooth fixtures/elephant.off -o smooth.ply
//! pellicle render fixtures/elephant.off -o before.png --views three-quarter --width 320 --height 260
//! pellicle render smooth.ply -o smooth.png --views three-quarter --width 320 --height 260
//! ```
//!
//! Mean curvature flow: vertices move along their normals, faster where the surface bends more, by one implicit step after
//! the other; connectivity stays. A step's strength is s = `diffusion` × `time_step`: N steps flatten waves up to about
//! 2π√(N s) long, in the units of the mesh. The flow shrinks the body;
//! [`restore_volume`](crate::evolution::Evolution::restore_volume) pushes it out again. Triangles are kept even by a velocity
//! along the surface, whose rate times `time_step` must stay well below 1: 100 × 0.001 by default.
//!
//! ```
//! use pellicle::prelude::*;
//!
//! // A sphere of radius 1 with dents.
//! let sphere = mesh::icosphere(3)?;
//! let dented = |p: &DVec3| *p * (1.0 + 0.05 * (9.0 * p.x).sin() * (9.0 * p.y).sin());
//! let mut rough = sphere.clone();
//! rough.set_positions(sphere.positions().iter().map(dented).collect())?;
//! let volume = mesh::signed_volume((&rough).into());
//! let area = mesh::area((&rough).into());
//!
//! let options = evolution::StepOptions { diffusion: 2.0, time_step: 0.001, ..Default::default() };
//! let mut surface = evolution::Evolution::new(rough)?;
//! for _ in 0..10 {
//!     surface.step(&evolution::One, &options)?;
//!     surface.restore_volume(volume)?;
//! }
//! let smooth = surface.into_mesh();
//! assert!((mesh::signed_volume((&smooth).into()) / volume - 1.0).abs() < 1e-6);
//! // A ball has the least area around its volume; three percent above it have become less than half a percent.
//! let ball = (36.0 * std::f64::consts::PI * volume * volume).cbrt();
//! assert!(area > 1.02 * ball && mesh::area((&smooth).into()) < 1.005 * ball);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Where triangles are very uneven, [`remesh`](super::remesh) first.
//!
#![doc = include_str!("pictures/smooth.md")]
