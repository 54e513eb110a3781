//! What vertices are projected onto: the surface and the curves as they were.

use crate::TriMesh;
use crate::edit::MeshEditor;
use pellicle_geometry::{Aabb, DVec3, VertexId, triangle};
use pellicle_spatial::Bvh;

/// The surface before remeshing, and the length that edges should have there.
pub(super) struct Surface {
    positions: Vec<DVec3>,
    triangles: Vec<[VertexId; 3]>,
    /// Unit normals; zero for a triangle without area.
    normals: Vec<DVec3>,
    lengths: Vec<f64>,
    bvh: Bvh,
}

impl Surface {
    /// `lengths` has one entry for each vertex.
    pub(super) fn new(mesh: &TriMesh, lengths: Vec<f64>) -> Self {
        let corners = || mesh.triangle_ids().map(|t| mesh.corners(t));
        Self {
            positions: mesh.positions().to_vec(),
            triangles: mesh.triangles().to_vec(),
            normals: corners()
                .map(|[a, b, c]| triangle::unit_normal(a, b, c).unwrap_or(DVec3::ZERO))
                .collect(),
            lengths,
            bvh: Bvh::new(corners().map(|c| Aabb::of_points(&c))),
        }
    }

    /// The nearest point, with the edge length wanted there.
    ///
    /// A triangle that does not face as `normal` does counts as twice `length` away at right angles, so that a vertex
    /// on one side of a thin wall does not jump to the other.
    pub(super) fn closest(&self, point: DVec3, normal: DVec3, length: f64) -> Option<(DVec3, f64)> {
        let corners = |t: u32| self.triangles[t as usize].map(|v| self.positions[v.index()]);
        let penalty = 4.0 * length * length;
        let (t, _) = self.bvh.nearest(point, |t| {
            let [a, b, c] = corners(t);
            let square = point.distance_squared(triangle::closest_point(point, a, b, c));
            match self.normals[t as usize].dot(normal) > 0.0 {
                true => square,
                false => square + penalty,
            }
        })?;
        let [a, b, c] = corners(t);
        let foot = triangle::closest_point(point, a, b, c);
        Some((foot, self.length_at(t, foot)))
    }

    /// Linear between the corners.
    fn length_at(&self, t: u32, point: DVec3) -> f64 {
        let [u, v, w] = self.triangles[t as usize];
        let [a, b, c] = [u, v, w].map(|v| self.positions[v.index()]);
        let [la, lb, lc] = [u, v, w].map(|v| self.lengths[v.index()]);
        let normal = triangle::double_area_normal(a, b, c);
        let square = normal.length_squared();
        if la == lb && lb == lc || square <= 0.0 {
            return la.min(lb).min(lc);
        }
        let at_b = (point - a).cross(c - a).dot(normal) / square;
        let at_c = (b - a).cross(point - a).dot(normal) / square;
        let length = la + at_b * (lb - la) + at_c * (lc - la);
        length.clamp(la.min(lb).min(lc), la.max(lb).max(lc))
    }
}

/// Borders and creases before remeshing.
#[derive(Default)]
pub(super) struct Curves {
    segments: Vec<[DVec3; 2]>,
    is_border: Vec<bool>,
    bvh: Bvh,
}

impl Curves {
    /// The edges that are marked as creases; borders among them.
    pub(super) fn of(editor: &MeshEditor) -> Self {
        let mut segments = Vec::new();
        let mut is_border = Vec::new();
        for h in editor.edges().filter(|h| editor.creases[h.index()]) {
            segments.push([editor.origin(h), editor.destination(h)].map(|v| editor.at(v)));
            is_border.push(editor.twin_of(h).is_none());
        }
        let bvh = Bvh::new(segments.iter().map(|s| Aabb::of_points(s)));
        Self {
            segments,
            is_border,
            bvh,
        }
    }

    /// The nearest point of a border, or of a crease inside the surface.
    pub(super) fn closest(&self, point: DVec3, border: bool) -> Option<DVec3> {
        let foot = |i: u32| {
            let [a, b] = self.segments[i as usize];
            triangle::closest_point_on_segment(point, a, b)
        };
        let distance = |i: u32| match self.is_border[i as usize] == border {
            true => point.distance_squared(foot(i)),
            false => f64::INFINITY,
        };
        let (i, d) = self.bvh.nearest(point, distance)?;
        (d < f64::INFINITY).then(|| foot(i))
    }
}
