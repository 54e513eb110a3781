//! Triangles without a guarantee.

use crate::TriMesh;
use pellicle_geometry::{DVec3, VertexId};

/// Triangles over positions, with nothing promised: what a file holds.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TriangleSoup {
    /// The vertices.
    pub positions: Vec<DVec3>,
    /// Three vertices a triangle, counter-clockwise seen from outside.
    pub triangles: Vec<[VertexId; 3]>,
}

/// A borrowed mesh or soup: what measures, writers and pictures take.
#[derive(Clone, Copy, Debug)]
pub struct MeshView<'a> {
    /// The vertices.
    pub positions: &'a [DVec3],
    /// Three vertices a triangle, counter-clockwise seen from outside.
    pub triangles: &'a [[VertexId; 3]],
}

impl<'a> From<&'a TriangleSoup> for MeshView<'a> {
    fn from(soup: &'a TriangleSoup) -> Self {
        Self {
            positions: &soup.positions,
            triangles: &soup.triangles,
        }
    }
}

impl<'a> From<&'a TriMesh> for MeshView<'a> {
    fn from(mesh: &'a TriMesh) -> Self {
        Self {
            positions: mesh.positions(),
            triangles: mesh.triangles(),
        }
    }
}
