//! What a round of the repair leaves, in doubles, and how it is kept apart from what rounding does to it.

use crate::Error;
use crate::hash::FastMap;
use crate::points::Points;
use crate::rounding::{Broken, broken, gather};
use crate::slivers::without_slivers;
use crate::stitch::Stitched;
use crate::weld::{Weld, key};
use pellicle_geometry::triangle::power_of_two_near;
use pellicle_geometry::{Aabb, VertexId};
use pellicle_mesh::{MeshError, TriMesh, TriangleId, TriangleSoup, components};

/// The surface after one round.
#[derive(Clone)]
pub(crate) struct Surface {
    pub soup: TriangleSoup,
    pub sources: Vec<TriangleId>,
    /// Of each vertex, whether it is where no vertex of the input is.
    pub is_new: Vec<bool>,
    /// Of each vertex, whether it is not where it is exactly.
    pub is_rounded: Vec<bool>,
}

impl Surface {
    pub(crate) fn new(stitched: Stitched, weld: &Weld, points: &Points) -> Self {
        let is_exact = |v: VertexId| points.get(v).is_exact();
        let of_points = stitched.points.iter();
        Self {
            sources: stitched.sources_in(weld),
            is_new: (of_points.clone())
                .map(|v| v.index() >= weld.positions.len())
                .collect(),
            // The middle of a halved edge has no point.
            is_rounded: of_points
                .map(|v| v.some().is_none_or(|v| !is_exact(v)))
                .collect(),
            soup: stitched.soup,
        }
    }

    /// As a surface of the input, of which `before` was one.
    pub(crate) fn after(mut self, before: &Self) -> Self {
        for source in &mut self.sources {
            *source = before.sources[source.index()];
        }
        let flags = before.is_new.iter().zip(&before.is_rounded);
        let flags: FastMap<[u64; 3], (bool, bool)> = (before.soup.positions.iter().zip(flags))
            .map(|(&position, (&new, &rounded))| (key(position), (new, rounded)))
            .collect();
        for (v, &position) in self.soup.positions.iter().enumerate() {
            if let Some(&(new, rounded)) = flags.get(&key(position)) {
                self.is_new[v] |= new;
                self.is_rounded[v] |= rounded;
            }
        }
        self
    }

    /// Makes rounded vertices that are closer to each other than rounding can keep apart one place, or that of a vertex of the
    /// input.
    pub(crate) fn gather(&mut self, repeat: u32) {
        let distance = 4.0 * self.thickness(repeat);
        gather(&mut self.soup.positions, &self.is_rounded, distance);
    }

    /// A few units in the last place of the largest coordinate, more with every repeat.
    fn thickness(&self, repeat: u32) -> f64 {
        let bounds = Aabb::of_points(&self.soup.positions);
        let largest = bounds.min.abs().max(bounds.max.abs()).max_element();
        largest * f64::EPSILON * 16.0_f64.powi(repeat as i32)
    }

    /// Whether a component with a rounded vertex is no thicker, on the average, than rounding can tell.
    pub(crate) fn has_thin_components(&self) -> bool {
        const UNITS: f64 = 256.0;
        let bounds = Aabb::of_points(&self.soup.positions);
        let largest = bounds.min.abs().max(bounds.max.abs()).max_element();
        let (center, scale) = (bounds.center(), power_of_two_near(largest));
        // Volume, area, and whether it has a rounded vertex.
        let mut measures = vec![(0.0, 0.0, false); self.soup.positions.len()];
        for (t, component) in (self.soup.triangles.iter()).zip(components((&self.soup).into())) {
            let [a, b, c] = t.map(|v| (self.soup.positions[v.index()] - center) / scale);
            let measure = &mut measures[component.index()];
            measure.0 += a.dot(b.cross(c)) / 6.0;
            measure.1 += 0.5 * (b - a).cross(c - a).length();
            measure.2 |= t.iter().any(|v| self.is_rounded[v.index()]);
        }
        measures
            .iter()
            .any(|&(volume, area, rounded)| rounded && volume.abs() <= area * UNITS * f64::EPSILON)
    }

    /// What rounding broke.
    pub(crate) fn broken(&self) -> Broken {
        broken(&self.soup, |v| self.is_rounded[v.index()])
    }

    /// Without triangles that rounding cannot keep apart.
    pub(crate) fn without_slivers(self, repeat: u32) -> Result<Self, Error> {
        let thickness = self.thickness(repeat);
        let scale = power_of_two_near(thickness / f64::EPSILON);
        let mesh = match TriMesh::try_from(self.soup) {
            Ok(mesh) => mesh,
            Err(MeshError::NotManifold { soup, .. }) => return Ok(Self { soup, ..self }),
            Err(error) => return Err(error.into()),
        };
        let cleaned = without_slivers(mesh, &self.is_rounded, thickness, scale);
        let triangles = cleaned.triangles.iter();
        let vertices = cleaned.vertices.iter();
        Ok(Self {
            soup: cleaned.mesh.into_soup(),
            sources: triangles.map(|t| self.sources[t.index()]).collect(),
            is_new: vertices.clone().map(|v| self.is_new[v.index()]).collect(),
            is_rounded: vertices.map(|v| self.is_rounded[v.index()]).collect(),
        })
    }
}
