//! Triangle meshes: a soup of triangles, and the oriented manifold that it may become.
#![forbid(unsafe_code)]

mod edge_table;
mod error;
mod frame;
mod id;
mod measure;
mod self_intersection;
mod soup;
mod split;
mod trimesh;
mod union_find;
mod validate;

pub use error::MeshError;
pub use id::{HalfEdgeId, TriangleId};
pub use measure::{Component, Shape, Summary, area, signed_volume, summarize};
pub use self_intersection::{count_self_intersections, self_intersections, triangles_intersect};
pub use soup::{MeshView, TriangleSoup, VertexRemap};
pub use split::{DropReason, OrientationPolicy, SplitOptions, SplitReport};
pub use trimesh::TriMesh;
pub use validate::{Defect, validate};
