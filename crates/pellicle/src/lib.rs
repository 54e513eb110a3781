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
//! [`guide`] has a chapter for each verb, with a picture, the commands that make it, and the same as a program.
//!
#![forbid(unsafe_code)]

mod adapting;
pub mod guide;

pub use adapting::{ADAPTING_GAP, evolve_adapting};
pub use glam;
pub use pellicle_cocone as cocone;
pub use pellicle_delaunay as delaunay;
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
