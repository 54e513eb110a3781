//! Points, noisy or with gaps, to a closed smooth mesh.
//!
//! ![An ellipsoid shrinks onto the points of a head, in four steps][evolve/evolution.png]
//!
//! ```sh
//! pellicle evolve fixtures/oni.pwn -o oni.ply --grid 60 --snapshots evolve --every 40
//! ```
//!
//! A closed surface around the points shrinks onto them, driven by their distance on a grid (Daniel 2015), and is remeshed
//! while it moves. Unlike [`reconstruct`](super::reconstruct) it does not go through the points: noise is averaged, outliers
//! are left out, gaps are spanned.
//!
//! Lengths in the [`Options`](crate::evolution::Options) are voxels, so they suit any unit: `resolution` voxels along the
//! longest side. More of them resolve finer shapes, and take more time and memory.
//!
//! ```
//! use pellicle::prelude::*;
//!
//! # let points: Vec<DVec3> = (0..900)
//! #     .map(|i| {
//! #         let z = 1.0 - (2.0 * f64::from(i) + 1.0) / 900.0;
//! #         let (sin, cos) = (2.399963 * f64::from(i)).sin_cos();
//! #         DVec3::new(cos, sin, 0.0) * (1.0 - z * z).sqrt() + DVec3::Z * z
//! #     })
//! #     .collect();
//! // `points`: 900 on the unit sphere.
//! let options = evolution::Options { resolution: 40, ..evolution::Options::default() };
//! let evolved = evolve(&points, &options)?;
//! assert!(evolved.mesh.is_closed() && evolved.report.at_rest);
//! let volume = mesh::signed_volume((&evolved.mesh).into());
//! assert!((volume / (4.0 / 3.0 * std::f64::consts::PI) - 1.0).abs() < 0.02);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Topology stays that of the surface at the start, a sphere's unless `initial` gives another.
//! [`evolve_adapting`](crate::evolve_adapting) lets one surface around several objects become several, and opens holes;
//! between its steps it calls [`repair`](super::repair). [`evolve_with`](crate::evolution::evolve_with) tells of each step.
//!
#![doc = include_str!("pictures/evolve.md")]
