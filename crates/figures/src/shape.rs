//! A body whose surface and volume are known.

use crate::field::{self, Field};
use crate::polygonize::polygonize;
use crate::{AreaSampler, Random};
use pellicle::geometry::Aabb;
use pellicle::mesh::TriMesh;
use pellicle::prelude::DVec3;

/// A body, its surface as a fine mesh, and its volume.
pub struct Shape {
    /// What it is called in tables.
    pub name: &'static str,
    /// A closed mesh without self-intersections, whose vertices lie on the surface.
    pub truth: TriMesh,
    /// The volume inside the surface; the mesh, which cuts corners, has a little less.
    pub volume: f64,
    field: Box<dyn Field>,
}

impl Shape {
    /// A body with `cells` cubes along the longest side of its box, and a volume that is known.
    pub(crate) fn new(
        name: &'static str,
        field: impl Field + 'static,
        cells: usize,
        volume: f64,
    ) -> Self {
        let truth = polygonize(&field, cells);
        Self {
            name,
            truth,
            volume,
            field: Box::new(field),
        }
    }

    /// A body whose volume has no closed form.
    pub(crate) fn measured(name: &'static str, field: impl Field + 'static, cells: usize) -> Self {
        let mut shape = Self::new(name, field, cells, 0.0);
        shape.volume = volume(&*shape.field, &shape.truth);
        shape
    }

    /// Points of the surface, independent of each other and uniform over its area. Logarithmic time a point.
    pub fn sample(&self, count: usize, seed: u64) -> Vec<DVec3> {
        let sampler = self.sampler();
        let mut random = Random::new(seed, 0);
        let points = std::iter::repeat_with(|| self.project(sampler.point(&mut random)));
        points.take(count).collect()
    }

    /// Points of the surface that keep a distance from each other, about 0.82 `count` of them: as a scanner leaves
    /// them.
    pub fn sample_evenly(&self, count: usize, seed: u64) -> Vec<DVec3> {
        let points = self
            .sampler()
            .scatter(count, &mut Random::new(seed, 0), 1.0);
        points.into_iter().map(|p| self.project(p)).collect()
    }

    /// The point of the surface to which Newton's steps lead from a point near it.
    pub fn project(&self, near: DVec3) -> DVec3 {
        field::project(&*self.field, near)
    }

    /// The diagonal of the surface's box.
    pub fn diagonal(&self) -> f64 {
        Aabb::of_points(self.truth.positions()).diagonal()
    }

    pub(crate) fn sampler(&self) -> AreaSampler<'_> {
        AreaSampler::new((&self.truth).into())
    }

    #[cfg(test)]
    pub(crate) fn field(&self) -> &dyn Field {
        &*self.field
    }
}

/// The volume inside a surface that a mesh approximates: that of the mesh, V(h), and that with every triangle cut into
/// four whose new corners are moved to the surface, V(h/2); the error is of order h², so (4V(h/2) − V(h))/3 is of
/// order h⁴.
pub(crate) fn volume(field: &dyn Field, mesh: &TriMesh) -> f64 {
    let middle = Aabb::of_points(mesh.positions()).center();
    let spanned = |a: DVec3, b: DVec3, c: DVec3| a.dot(b.cross(c)) / 6.0;
    let (mut coarse, mut fine) = (0.0, 0.0);
    for triangle in mesh.triangle_ids() {
        let corners = mesh.corners(triangle);
        let [d, e, f] = [[1, 2], [2, 0], [0, 1]]
            .map(|[i, j]| field::project(field, 0.5 * (corners[i] + corners[j])) - middle);
        let [a, b, c] = corners.map(|p| p - middle);
        coarse += spanned(a, b, c);
        fine += spanned(a, f, e) + spanned(f, b, d) + spanned(e, d, c) + spanned(d, e, f);
    }
    (4.0 * fine - coarse) / 3.0
}
