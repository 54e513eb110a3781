//! Triangle meshes: a soup of triangles, and the oriented manifold that it may become.
#![forbid(unsafe_code)]

mod soup;
mod trimesh;

pub use soup::{MeshView, TriangleSoup};
pub use trimesh::TriMesh;
