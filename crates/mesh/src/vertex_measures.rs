//! What each vertex of a surface has: its share of the area, and its mean curvature.

use crate::MeshView;
use crate::edge_table::{EdgeTable, origin};
use crate::frame::Frame;
use crate::measure::measurable;
use pellicle_geometry::{DVec3, triangle};

/// A third of the area of the triangles at each vertex: together the area of the surface.
///
/// In squares of the units of the positions; 0 at a vertex of no triangle. Unusable triangles and those with corners that
/// are not finite count as absent. Linear time.
///
/// ```
/// let sphere = pellicle_mesh::icosphere(4)?;
/// let areas = pellicle_mesh::vertex_areas((&sphere).into());
/// let whole: f64 = areas.iter().sum();
/// assert!((whole / (4.0 * std::f64::consts::PI) - 1.0).abs() < 0.01);
/// # Ok::<(), pellicle_mesh::MeshError>(())
/// ```
pub fn vertex_areas(mesh: MeshView) -> Vec<f64> {
    let mut areas = vec![0.0; mesh.positions.len()];
    let frame = Frame::of(mesh.positions);
    let unit = frame.scale * frame.scale / 3.0;
    for (t, corners) in measurable(mesh) {
        let [a, b, c] = corners.map(|p| frame.apply(p));
        for vertex in mesh.triangles[t] {
            areas[vertex.index()] += triangle::area(a, b, c) * unit;
        }
    }
    areas
}

/// The mean of the two principal curvatures at each vertex, per unit of the positions: positive where the surface bulges
/// outwards, 1/R on a sphere of radius R that faces outwards.
///
/// By cotangents over the mixed areas of Meyer et al. 2003, with the sign of the outward normal. NaN where it is not
/// defined: at vertices of no triangle, of a triangle without area, and of an edge that has not two triangles which run
/// along it in opposite directions. O(n log n).
///
/// ```
/// let sphere = pellicle_mesh::icosphere(4)?;
/// let curvatures = pellicle_mesh::mean_curvatures((&sphere).into());
/// assert!(curvatures.iter().all(|curvature| (curvature - 1.0).abs() < 0.01));
/// # Ok::<(), pellicle_mesh::MeshError>(())
/// ```
pub fn mean_curvatures(mesh: MeshView) -> Vec<f64> {
    let frame = Frame::of(mesh.positions);
    let mut rings = vec![Ring::default(); mesh.positions.len()];
    for (t, corners) in measurable(mesh) {
        let corners = corners.map(|p| frame.apply(p));
        for (i, vertex) in mesh.triangles[t].into_iter().enumerate() {
            let [at, next, last] = [corners[i], corners[(i + 1) % 3], corners[(i + 2) % 3]];
            rings[vertex.index()].add(at, next, last);
        }
    }
    for (ends, group) in EdgeTable::new(mesh).edges() {
        let forward = |e: &&crate::EdgeEntry| origin(mesh.triangles, e.half_edge) == ends[0];
        if group.len() != 2 || group.iter().filter(forward).count() != 1 {
            for vertex in ends {
                rings[vertex.index()].normal = DVec3::NAN;
            }
        }
    }
    rings
        .iter()
        .map(|ring| ring.mean_curvature() / frame.scale)
        .collect()
}

/// Sums over the triangles around a vertex.
///
/// ```text
///      last          cotangents of the angles at next and last weigh the edges to last and next
///       | \
///       |  \         area: what is nearer to `at` than to next and last; where an angle is obtuse, half or a
///       |   \        quarter of the triangle
///      at----next
/// ```
#[derive(Clone, Copy, Default)]
struct Ring {
    /// The integral of the Laplacian of the position.
    laplacian: DVec3,
    /// The sum of the normals, each as long as twice its area.
    normal: DVec3,
    area: f64,
}

impl Ring {
    fn add(&mut self, at: DVec3, next: DVec3, last: DVec3) {
        let normal = (next - at).cross(last - at);
        let double_area = normal.length();
        // Infinite or NaN without an area; no curvature comes of it then.
        let cotangent = |u: DVec3, v: DVec3| u.dot(v) / double_area;
        let (to_next, to_last) = (next - at, last - at);
        let at_next = cotangent(at - next, last - next);
        let at_last = cotangent(at - last, next - last);
        self.laplacian += 0.5 * (at_last * to_next + at_next * to_last);
        self.normal += normal;
        self.area += match () {
            () if to_next.dot(to_last) < 0.0 => 0.25 * double_area,
            () if at_next < 0.0 || at_last < 0.0 => 0.125 * double_area,
            () => 0.125 * (to_next.length_squared() * at_last + to_last.length_squared() * at_next),
        };
    }

    /// −½ Δx · N; NaN if the vertex has no such thing.
    fn mean_curvature(&self) -> f64 {
        let curvature = -0.5 * self.laplacian.dot(self.normal / self.normal.length()) / self.area;
        match curvature.is_finite() {
            true => curvature,
            false => f64::NAN,
        }
    }
}
