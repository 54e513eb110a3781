//! The oriented manifold.

use pellicle_geometry::{DVec3, VertexId};

/// An oriented manifold triangle mesh, possibly with borders.
#[derive(Clone, Debug, Default)]
pub struct TriMesh {
    positions: Vec<DVec3>,
    triangles: Vec<[VertexId; 3]>,
}

impl TriMesh {
    /// The vertices.
    pub fn positions(&self) -> &[DVec3] {
        &self.positions
    }

    /// Three vertices a triangle, counter-clockwise seen from outside.
    pub fn triangles(&self) -> &[[VertexId; 3]] {
        &self.triangles
    }
}
