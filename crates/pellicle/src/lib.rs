//! Points to clean surfaces.
//!
//! **The data.** Points are a [`PointCloud`](geometry::PointCloud) or a plain `&[DVec3]`; triangles without a
//! guarantee are a [`TriangleSoup`](mesh::TriangleSoup), and an oriented manifold is a [`TriMesh`](mesh::TriMesh);
//! the tetrahedra between them are a [`Tetrahedralization`](delaunay::Tetrahedralization). Coordinates are
//! [`glam::DVec3`], in the caller's units.
//!
//! **The verbs.** Each is a function of a module that takes an options struct with defaults. A surface through points
//! takes two of them:
//!
//! ```
//! use pellicle::prelude::*;
//!
//! // 400 points on the unit sphere, along a spiral.
//! let points: Vec<DVec3> = (0..400)
//!     .map(|i| {
//!         let z = 1.0 - (2.0 * f64::from(i) + 1.0) / 400.0;
//!         let (sin, cos) = (2.399963 * f64::from(i)).sin_cos();
//!         DVec3::new(cos, sin, 0.0) * (1.0 - z * z).sqrt() + DVec3::Z * z
//!     })
//!     .collect();
//! let tetrahedra = tetrahedralize(&points, &delaunay::Options::default())?;
//! let surface = reconstruct(&tetrahedra, &cocone::Options::default())?;
//! assert!(surface.mesh.is_closed());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! The same points give the same result in any order and for any number of threads; everything combinatorial is
//! decided by exact signs, so degenerate input (grids, cospherical or coplanar points, duplicates) is ordinary input.
//!
//! # Guide
//!
//! ## Read and write
//!
//! The extension names the format. A file appears under its name at once and complete, or not at all.
//!
//! ```
//! use pellicle::prelude::*;
//!
//! # let folder = tempfile::tempdir()?;
//! # let path = folder.path().join("two.ply");
//! let cloud = PointCloud::new(vec![DVec3::ZERO, DVec3::X])?;
//! write_points(&path, &cloud, &WriteOptions::default())?;
//! assert_eq!(read_points(&path, &ReadOptions::default())?.cloud, cloud);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! ## Tetrahedralise
//!
//! The Delaunay tetrahedra depend on the set of points alone, cospherical points included.
//!
//! ```
//! use pellicle::prelude::*;
//!
//! let cube: Vec<DVec3> = (0..8)
//!     .map(|i| DVec3::new((i & 1) as f64, (i >> 1 & 1) as f64, (i >> 2) as f64))
//!     .collect();
//! let tetrahedra = tetrahedralize(&cube, &delaunay::Options::default())?;
//! assert!(tetrahedra.validate().is_empty());
//! # Ok::<(), pellicle::delaunay::Error>(())
//! ```
//!
//! Points may also come and go one by one: [`delaunay::DynamicTetrahedralization`]. Point location, nearest vertices,
//! circulators and Voronoi cells are in [`delaunay::guide`].
//!
//! ```
//! use pellicle::prelude::*;
//!
//! let mut tetrahedra = delaunay::DynamicTetrahedralization::of_points(&[DVec3::X, DVec3::Y, DVec3::Z])?;
//! let origin = tetrahedra.insert(DVec3::ZERO)?;
//! assert_eq!(tetrahedra.nearest_vertex(DVec3::splat(0.1), None), Some(origin));
//! tetrahedra.remove(origin)?;
//! assert_eq!(tetrahedra.finite_tets().count(), 0);
//! # Ok::<(), pellicle::delaunay::Error>(())
//! ```
//!
//! ## Reconstruct a closed surface, or normals
//!
//! Cocone leaves open what the points do not support; Tight Cocone always returns the boundary of a solid.
//!
//! ```
//! use pellicle::prelude::*;
//! # let points: Vec<DVec3> = (0..60)
//! #     .map(|i| DVec3::new(f64::from(i % 5), f64::from(i / 5 % 4), f64::from(i / 20)))
//! #     .collect();
//! let tetrahedra = tetrahedralize(&points, &delaunay::Options::default())?;
//! let mut options = cocone::Options::default();
//! options.method = cocone::Method::TightCocone;
//! let surface = reconstruct(&tetrahedra, &options)?;
//! assert!(surface.mesh.is_closed());
//! // The point that each vertex of the mesh is:
//! assert_eq!(points[surface.vertices[0].index()], surface.mesh.positions()[0]);
//!
//! let normals = cocone::normals(&tetrahedra);
//! assert_eq!(normals.len(), points.len());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! ## Evolve a surface onto points
//!
//! For clouds that are noisy, uneven, full of outliers or missing a part: a closed surface shrinks onto them and keeps a
//! good mesh. It starts as an ellipsoid and keeps that topology. Options are in voxels, so they suit any unit.
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
//! let options = evolution::Options { resolution: 40, ..evolution::Options::default() };
//! let evolved = evolve(&points, &options)?;
//! assert!(evolved.mesh.is_closed());
//! assert_eq!(mesh::count_self_intersections((&evolved.mesh).into(), &())?, 0);
//!
//! // A step at a time: mean curvature flow of the result.
//! let smooth = evolution::StepOptions { diffusion: 0.001, time_step: 1.0, ..Default::default() };
//! let mut surface = evolution::Evolution::new(evolved.mesh)?;
//! surface.step(&evolution::One, &smooth)?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! ## Morph a surface into another
//!
//! The source moves onto the target; holes open, pieces split off and merge on the way. It must overlap what it is to
//! find: start from around everything.
//!
//! ```
//! use pellicle::prelude::*;
//!
//! let sphere = mesh::icosphere(2)?;
//! let mut target = sphere.clone();
//! target.set_positions(sphere.positions().iter().map(|p| *p * DVec3::new(2.0, 1.0, 0.5)).collect())?;
//! let options = transformesh::MorphOptions {
//!     placement: transformesh::Placement::Enclose,
//!     ..Default::default()
//! };
//! let (mesh, report) = morph(&sphere, &target, &options)?;
//! assert_eq!(report.end, transformesh::MorphEnd::Arrived);
//! assert_eq!(report.topology, report.target_topology);
//! assert!(mesh.is_closed() && report.mean_distance < 0.25 * report.edge_length);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! ## Edit, subdivide and remesh
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
//! ## Repair a mesh that crosses itself
//!
//! What comes back is closed, an oriented manifold, and free of self-intersections; vertices that stay do not move. A
//! [`Rule`](transformesh::Rule) says what becomes of voids, of what is inside out, and of borders.
//!
//! ```
//! use pellicle::prelude::*;
//!
//! // A sphere, one vertex of which was pulled through the other side.
//! let mut folded = mesh::icosphere(2)?.into_soup();
//! folded.positions[0] *= -1.5;
//! let segments = transformesh::intersection_segments((&folded).into(), &())?;
//! assert!(!segments.is_empty());
//!
//! let (clean, report) = repair(&folded, &transformesh::Options::default())?;
//! assert_eq!(report.remaining, 0);
//! assert_eq!(mesh::count_self_intersections((&clean).into(), &())?, 0);
//! // The triangle of the input that each one is a piece of:
//! assert_eq!(report.sources.len(), clean.triangles().len());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! ## Measure a mesh
//!
//! ```
//! use pellicle::prelude::*;
//!
//! let tetrahedron = TriangleSoup {
//!     positions: vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z],
//!     triangles: [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]].map(|t| t.map(VertexId)).to_vec(),
//! };
//! let summary = mesh::summarize((&tetrahedron).into())?;
//! assert_eq!((summary.is_closed(), summary.genus()), (true, Some(0)));
//! assert_eq!(mesh::count_self_intersections((&tetrahedron).into(), &())?, 0);
//!
//! // From an oriented manifold soup to the type that guarantees it.
//! let tetrahedron = TriMesh::try_from(tetrahedron)?;
//! assert!(tetrahedron.is_closed());
//! # Ok::<(), pellicle::mesh::MeshError>(())
//! ```
//!
//! ## Compare two surfaces
//!
//! ```
//! use pellicle::prelude::*;
//!
//! let cloud = [DVec3::ZERO, DVec3::X];
//! let lifted = cloud.map(|p| p + 0.5 * DVec3::Z);
//! let view = |positions| MeshView { positions, triangles: &[] };
//! let comparison =
//!     mesh::compare(view(&cloud), view(&lifted), &mesh::DistanceOptions::default(), &())?;
//! assert_eq!(comparison.hausdorff(), 0.5);
//! # Ok::<(), pellicle::mesh::MeshError>(())
//! ```
//!
//! ## Draw
//!
//! ```
//! use pellicle::prelude::*;
//!
//! # let folder = tempfile::tempdir()?;
//! # let path = folder.path().join("points.png");
//! let options = render::Options { width: 320, height: 240, ..render::Options::default() };
//! let image = render_points(&[DVec3::ZERO, DVec3::X, DVec3::Y], None, &options)?;
//! let pixels = io::Pixels::Rgba(image.pixels.as_flattened());
//! io::write_png(&path, image.width, image.height, pixels, &WriteOptions::default())?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! ## Watch long work, and stop it
//!
//! The `…_with` functions take a [`Progress`](geometry::Progress) observer; its `Break` ends the work with an error,
//! never with half a result.
//!
//! ```
//! use pellicle::delaunay::{Error, Options, tetrahedralize_with};
//! use pellicle::prelude::*;
//! use std::ops::ControlFlow;
//!
//! struct Stop;
//! impl Progress for Stop {
//!     fn step(&self, _stage: &'static str, _done: u64, _total: u64) -> ControlFlow<()> {
//!         ControlFlow::Break(())
//!     }
//! }
//! let points: Vec<DVec3> = (0..5000_u32)
//!     .map(|i| DVec3::new(f64::from(i % 17), f64::from(i % 19), f64::from(i % 23)))
//!     .collect();
//! let stopped = tetrahedralize_with(&points, &Options::default(), &Stop);
//! assert!(matches!(stopped, Err(Error::Cancelled(_))));
//! ```
#![forbid(unsafe_code)]

pub use glam;
pub use pellicle_cocone as cocone;
pub use pellicle_delaunay as delaunay;
mod adapting;

pub use adapting::{ADAPTING_GAP, evolve_adapting};
pub use pellicle_evolution as evolution;
pub use pellicle_geometry as geometry;
pub use pellicle_io as io;
pub use pellicle_mesh as mesh;
pub use pellicle_predicates as predicates;
pub use pellicle_render as render;
pub use pellicle_spatial as spatial;
pub use pellicle_transformesh as transformesh;

/// What most programs need: the modules, the central types, and the verbs whose names stand for themselves.
///
/// ```
/// use pellicle::prelude::*;
/// let cloud = PointCloud::new(vec![DVec3::ZERO])?;
/// assert_eq!(cloud.len(), 1);
/// # Ok::<(), pellicle::geometry::CloudError>(())
/// ```
pub mod prelude {
    pub use crate::cocone::{Reconstruction, reconstruct};
    pub use crate::delaunay::{Tetrahedralization, tetrahedralize};
    pub use crate::evolution::{Evolved, evolve};
    pub use crate::geometry::{Cancelled, DVec2, DVec3, PointCloud, Progress, VertexId};
    pub use crate::io::{
        ReadOptions, WriteOptions, read_mesh, read_points, write_mesh, write_points,
    };
    pub use crate::mesh::{MeshView, TriMesh, TriangleSoup};
    pub use crate::render::{render_mesh, render_points};
    pub use crate::transformesh::{morph, repair};
    pub use crate::{cocone, delaunay, evolution, geometry, io, mesh, render, transformesh};
}

/// The examples of the READMEs, which compile and hold.
#[cfg(doctest)]
mod readmes {
    #[doc = include_str!("../../../README.md")]
    struct Workspace;
    #[doc = include_str!("../README.md")]
    struct Crate;
}
