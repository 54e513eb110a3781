//! Triangle meshes: a soup of triangles, and the oriented manifold that it may become.
//!
//! # Data
//!
//! - [`TriangleSoup`]: positions and triangles, nothing promised. What a file holds.
//! - [`TriMesh`]: the same with half-edge connectivity. Its fields are private: a value of the type is an
//!   oriented manifold, with or without borders.
//! - [`MeshView`]: either of them, borrowed. What everything that only reads takes.
//!
//! # Verbs
//!
//! - [`TriMesh::try_from`] refuses what is no manifold and names every [`Defect`];
//!   [`TriMesh::from_soup_splitting`] cuts it until it is one, and reports the cuts.
//! - [`icosphere`] makes the unit sphere; [`subdivide`] cuts every triangle in four.
//! - [`remesh()`] makes new triangles of even size and good angles for the same surface; [`improve`] makes those there
//!   are better. [`MeshEditor`] splits, collapses and flips single edges.
//! - [`validate()`] lists all defects; [`summarize`] measures, and [`quality`] the shapes of
//!   triangles alone; [`self_intersections`] finds triangles that meet
//!   where they should not, exactly; [`compare`] measures distances, [`point_distances`] those of single points,
//!   [`SignedDistance`] those from a closed surface, exactly inside or outside.
//!
//! ```
//! use pellicle_geometry::{DVec3, VertexId};
//! use pellicle_mesh::{TriMesh, TriangleSoup, self_intersections, summarize};
//!
//! let soup = TriangleSoup {
//!     positions: vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z],
//!     triangles: [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]].map(|t| t.map(VertexId)).to_vec(),
//! };
//! let mesh = TriMesh::try_from(soup)?;
//! let summary = summarize((&mesh).into())?;
//! assert!(mesh.is_closed() && summary.genus() == Some(0));
//! assert!(self_intersections((&mesh).into(), &())?.is_empty());
//! # Ok::<(), pellicle_mesh::MeshError>(())
//! ```
//!
//! Triangles are counter-clockwise seen from outside.
#![forbid(unsafe_code)]

mod distance;
mod edge_table;
mod edit;
mod error;
mod frame;
mod id;
mod measure;
mod quality;
mod remesh;
mod self_intersection;
mod shapes;
mod signed_distance;
mod soup;
mod split;
mod trimesh;
mod validate;
mod vertex_measures;
mod winding;

pub use distance::{Comparison, DistanceOptions, Distances, compare, distances, point_distances};
pub use edge_table::{EdgeEntry, EdgeTable};
pub use edit::{MeshEditor, Refusal};
pub use error::MeshError;
pub use id::{HalfEdgeId, TriangleId};
pub use measure::{Component, Shape, Summary, area, components, signed_volume, summarize};
pub use quality::{AngleBounds, Quality, quality};
pub use remesh::{
    CurvatureLength, ImproveOptions, Projection, RemeshOptions, RemeshReport, TargetLength,
    improve, remesh,
};
pub use self_intersection::{count_self_intersections, self_intersections, triangles_intersect};
pub use shapes::{cuboid, icosphere, subdivide};
pub use signed_distance::{SignedDistance, SignedDistanceSample};
pub use soup::{MeshView, TriangleSoup, VertexRemap};
pub use split::{DropReason, OrientationPolicy, SplitOptions, SplitReport};
pub use trimesh::TriMesh;
pub use validate::{Defect, validate};
pub use vertex_measures::{mean_curvatures, vertex_areas};
pub use winding::winding_numbers;
