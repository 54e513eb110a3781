//! Points of a mesh, uniform over its area.

use crate::Random;
use pellicle::geometry::{Aabb, triangle};
use pellicle::prelude::{DVec3, MeshView};
use std::collections::HashMap;

/// Takes points from the triangles of a mesh.
///
/// ```
/// use pellicle::prelude::*;
/// use pellicle_figures::{AreaSampler, Random};
///
/// let positions = [DVec3::ZERO, DVec3::X, DVec3::Y];
/// let triangles = [[0, 1, 2].map(VertexId)];
/// let mesh = MeshView { positions: &positions, triangles: &triangles };
/// let p = AreaSampler::new(mesh).point(&mut Random::new(1, 0));
/// assert!(p.x + p.y <= 1.0 && p.z == 0.0);
/// ```
pub struct AreaSampler<'a> {
    mesh: MeshView<'a>,
    /// For each triangle, twice the area of the triangles up to it.
    cumulative: Vec<f64>,
}

impl<'a> AreaSampler<'a> {
    /// A sampler of a mesh that has an area. Linear time.
    pub fn new(mesh: MeshView<'a>) -> Self {
        let mut sum = 0.0;
        let mut cumulative = Vec::with_capacity(mesh.triangles.len());
        for corners in mesh.triangles {
            let [a, b, c] = corners.map(|v| mesh.positions[v.index()]);
            sum += triangle::double_area_normal(a, b, c).length();
            cumulative.push(sum);
        }
        Self { mesh, cumulative }
    }

    /// The area of the mesh.
    pub fn area(&self) -> f64 {
        self.cumulative.last().map_or(0.0, |double| double / 2.0)
    }

    /// A point, uniform over the area. Logarithmic time.
    pub fn point(&self, random: &mut Random) -> DVec3 {
        let last = self.cumulative.len() - 1;
        let at = random.unit() * self.cumulative[last];
        let triangle = self.cumulative.partition_point(|&sum| sum < at).min(last);
        let [a, b, c] = self.mesh.triangles[triangle].map(|v| self.mesh.positions[v.index()]);
        let (mut u, mut v) = (random.unit(), random.unit());
        if u + v > 1.0 {
            (u, v) = (1.0 - u, 1.0 - v);
        }
        a + (b - a) * u + (c - a) * v
    }

    /// Random points, of which those stay that are a distance from all that stayed before: `near` times d beside
    /// the first vertex, growing to d at half the diagonal from it. Discs of diameter d so placed at last fill 54.7 %
    /// of a plane, so that `count` of them have `count`·π d²/4 = 0.547·area. The tries end before: `near` = 1 leaves
    /// about 0.82 `count`.
    pub fn scatter(&self, count: usize, random: &mut Random, near: f64) -> Vec<DVec3> {
        let diagonal = Aabb::of_points(self.mesh.positions).diagonal();
        let distance = (0.70 * self.area() / count as f64).sqrt();
        let mut cells: HashMap<[i64; 3], Vec<DVec3>> = HashMap::new();
        let mut points = Vec::new();
        for _ in 0..12 * count {
            let p = self.point(random);
            let [x, y, z] = (p / distance).floor().to_array().map(|x| x as i64);
            let away = (2.0 * p.distance(self.mesh.positions[0]) / diagonal).min(1.0);
            let least = (near + (1.0 - near) * away) * distance;
            let clear = (0..27)
                .filter_map(|i| cells.get(&[x + i % 3 - 1, y + i / 3 % 3 - 1, z + i / 9 - 1]))
                .flatten()
                .all(|q| q.distance(p) >= least);
            if clear {
                cells.entry([x, y, z]).or_default().push(p);
                points.push(p);
            }
        }
        points
    }
}
