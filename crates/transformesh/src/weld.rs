//! Corners with equal coordinates made one, and triangles without area left out.
//!
//! A triangle without area bounds nothing. Where it held a long edge together with two short ones, the triangle on the
//! long edge touches the vertex between them, and is cut there like any other.

use crate::hash::FastMap;
use pellicle_geometry::{DVec2, DVec3, VertexId};
use pellicle_mesh::{MeshView, TriangleId};
use pellicle_predicates::{Sign, orient2d};

/// The triangles that bound something, over places: vertices with different coordinates.
pub(crate) struct Weld {
    /// The places, each with the id of the first vertex there; vertices that are not first keep an unused entry, so that
    /// ids stay those of the input.
    pub positions: Vec<DVec3>,
    /// The triangles, over places.
    pub triangles: Vec<[VertexId; 3]>,
    /// For each the triangle of the input that it is.
    pub sources: Vec<TriangleId>,
    /// Triangles of the input without area.
    pub degenerate: usize,
    /// The place at given coordinates.
    pub places: FastMap<[u64; 3], VertexId>,
}

impl Weld {
    /// Of a mesh whose vertices exist and are finite.
    pub(crate) fn new(mesh: MeshView) -> Self {
        let mut places =
            FastMap::with_capacity_and_hasher(mesh.positions.len(), Default::default());
        let place_of: Vec<VertexId> = mesh
            .positions
            .iter()
            .enumerate()
            .map(|(v, &position)| *places.entry(key(position)).or_insert(VertexId::new(v)))
            .collect();
        let mut triangles = Vec::with_capacity(mesh.triangles.len());
        let mut sources = Vec::with_capacity(mesh.triangles.len());
        for (t, triangle) in mesh.triangles.iter().enumerate() {
            let triangle = triangle.map(|v| place_of[v.index()]);
            if !is_flat(triangle.map(|v| mesh.positions[v.index()])) {
                triangles.push(triangle);
                sources.push(TriangleId::new(t));
            }
        }
        Self {
            positions: mesh.positions.to_vec(),
            degenerate: mesh.triangles.len() - triangles.len(),
            triangles,
            sources,
            places,
        }
    }

    pub(crate) fn view(&self) -> MeshView<'_> {
        MeshView {
            positions: &self.positions,
            triangles: &self.triangles,
        }
    }

    /// The corners of a triangle.
    pub(crate) fn corners(&self, triangle: usize) -> [DVec3; 3] {
        self.triangles[triangle].map(|v| self.positions[v.index()])
    }
}

/// The coordinates as a key: equal for equal numbers, so that −0 is 0.
pub(crate) fn key(position: DVec3) -> [u64; 3] {
    (position + 0.0).to_array().map(f64::to_bits)
}

/// Whether three points lie on one line.
pub(crate) fn is_flat([a, b, c]: [DVec3; 3]) -> bool {
    (0..3).all(|axis| {
        let [a, b, c] = [a, b, c].map(|p| projected(p, axis));
        orient2d(a, b, c) == Sign::Zero
    })
}

/// The projection along an axis that turns as the plane's normal points along it: (y, z), (z, x), (x, y).
pub(crate) fn projected(p: DVec3, axis: usize) -> DVec2 {
    match axis {
        0 => DVec2::new(p.y, p.z),
        1 => DVec2::new(p.z, p.x),
        _ => DVec2::new(p.x, p.y),
    }
}
