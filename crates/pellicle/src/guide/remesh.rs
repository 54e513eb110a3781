//! A mesh to even, well shaped triangles.
//!
//! ![A part of a machine][before.png] ![The same with edges twice as long, its creases kept][remesh.png]
//!
//! ```sh
//! pellicle remesh fixtures/fandisk.off -o remesh.ply --relative 2 --creases 60
//! pellicle render fixtures/fandisk.off -o before.png --style surface-edges --edge-width 0.5 --views three-quarter --width 320 --height 260
//! pellicle render remesh.ply -o remesh.png --style surface-edges --edge-width 0.5 --views three-quarter --width 320 --height 260
//! ```
//!
//! Edges are split, collapsed and flipped, and vertices relaxed on the surface (Botsch and Kobbelt 2004), until edges have
//! about the length wanted. Topology stays: components, genus, borders. Borders and creases stay as curves.
//!
//! ```
//! use pellicle::prelude::*;
//!
//! let sphere = mesh::icosphere(3)?;
//! let options = mesh::RemeshOptions {
//!     target: mesh::TargetLength::Absolute(0.3),
//!     ..mesh::RemeshOptions::default()
//! };
//! let (coarser, report) = mesh::remesh(&sphere, &options, &())?;
//! assert!(coarser.triangles().len() < sphere.triangles().len());
//! assert!(report.after.unwrap().min_angle.to_degrees() > 30.0);
//! # Ok::<(), mesh::MeshError>(())
//! ```
//!
//! [`TargetLength`](crate::mesh::TargetLength) also asks for edges short where the surface bends.
//! [`subdivide`](crate::mesh::subdivide) parts each triangle into four; single edges are edited with
//! [`MeshEditor`](crate::mesh::MeshEditor).
//!
#![doc = include_str!("pictures/remesh.md")]
