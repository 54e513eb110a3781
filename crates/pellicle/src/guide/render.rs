//! A mesh or points to a picture.
//!
//! ![An elephant; the colours are its mean curvature][render.png]
//!
//! ```sh
//! pellicle render fixtures/elephant.off -o render.png --scalar mean-curvature --range=-60,60 --views three-quarter --width 360 --height 280
//! ```
//!
//! A rasteriser in software: the same bytes on every machine and for any number of threads. Nothing is hidden that is wrong
//! with a mesh: triangles seen from behind are purple, borders are orange, edges of three or more triangles are red.
//!
//! ```
//! use pellicle::prelude::*;
//! use pellicle::render::{Coloring, Drawing, Options, Values, View};
//!
//! # let folder = tempfile::tempdir()?;
//! # let path = folder.path().join("heights.png");
//! let sphere = mesh::icosphere(3)?;
//! let heights: Vec<f64> = sphere.positions().iter().map(|p| p.y).collect();
//! let mut drawing = Drawing::mesh(&sphere);
//! drawing.coloring = Coloring::Values(Values { title: "height", ..Values::new(&heights) });
//! let options = Options {
//!     width: 320,
//!     height: 240,
//!     views: vec![View::ThreeQuarter],
//!     ..Options::default()
//! };
//! let image = render::render(&drawing, &options)?;
//!
//! let pixels = io::Pixels::Rgba(image.pixels.as_flattened());
//! io::write_png(&path, image.width, image.height, pixels, &WriteOptions::default())?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Frames of an animation want one camera: [`Options::bounds`](crate::render::Options::bounds); several pictures side by
//! side: [`strip`](crate::render::strip).
//!
#![doc = include_str!("pictures/render.md")]
