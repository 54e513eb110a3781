//! The co-volume mesh and what is measured on it (Daniel 2015, section 4.3).
//!
//! Notation, in the paper's letters: V_i the barycentric co-volume of vertex i and μ_i its area; A = Σ μ_i; N_i the
//! outward unit normal; θ the angles of triangles; h_i the mean curvature vector and H_i = h_i · N_i its signed length,
//! negative where the surface is convex: −2/R on a sphere of radius R.
//!
//! ```text
//!            k
//!           /|\           V_i is bounded by σ₁ = C_j B and σ₂ = B C_k in each triangle (i, j, k), with
//!      C_k .  \           B its barycentre and C_j, C_k the midpoints of its edges at i:
//!         /\ B \          a third of the triangle's area.
//!        /  '.  \
//!       i----.---j
//!           C_j
//! ```

use crate::parallel::fill;
use crate::rings::{RingEdge, Rings};
use glam::DVec3;

/// Cotangents are cut off here: the angle of 0.006° of a triangle that has all but collapsed.
const COTANGENT_LIMIT: f64 = 1e4;

/// Areas, normals, cotangents and curvatures of one position of the surface. Storage is reused from step to step.
#[derive(Clone, Debug, Default)]
pub(crate) struct FiniteVolumes {
    /// Three cotangents a triangle, of the angles at its corners.
    cotangents: Vec<[f64; 3]>,
    pub(crate) faces: Vec<Face>,
    /// ½ (cot + cot) of the two angles opposite to each edge, in the order of the rings.
    pub(crate) weights: Vec<f64>,
    /// μ_i.
    pub(crate) areas: Vec<f64>,
    /// A, of each connected component.
    pub(crate) total_areas: Vec<f64>,
    /// N_i, the mean of the unit normals of the triangles at i, normalised.
    pub(crate) normals: Vec<DVec3>,
    /// h_i, (4.15) with the sign of the errata: it points inwards on a sphere.
    pub(crate) curvature_vectors: Vec<DVec3>,
    /// H_i.
    pub(crate) curvatures: Vec<f64>,
}

/// A triangle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Face {
    /// Outward; zero if the triangle has no area.
    pub(crate) unit_normal: DVec3,
    pub(crate) area: f64,
}

impl FiniteVolumes {
    /// Measures the surface.
    pub(crate) fn measure(&mut self, rings: &Rings, positions: &[DVec3]) {
        let triangles = &rings.triangles;
        let corners = |t: usize| triangles[t].map(|v| positions[v as usize]);
        fill(&mut self.faces, triangles.len(), |t| {
            let [a, b, c] = corners(t);
            let double_area = (b - a).cross(c - a);
            let length = double_area.length();
            Face {
                unit_normal: if length > 0.0 {
                    double_area / length
                } else {
                    DVec3::ZERO
                },
                area: 0.5 * length,
            }
        });
        let faces = &self.faces;
        fill(&mut self.cotangents, triangles.len(), |t| {
            cotangents(corners(t), 2.0 * faces[t].area)
        });

        let vertices = rings.vertices();
        let around = |i: usize| rings.around(i).iter().map(|e| faces[e.triangle as usize]);
        fill(&mut self.areas, vertices, |i| {
            around(i).map(|face| face.area).sum::<f64>() / 3.0
        });
        self.total_areas = rings.sum_by_component(|i| self.areas[i]);
        fill(&mut self.normals, vertices, |i| {
            let sum: DVec3 = around(i).map(|face| face.unit_normal).sum();
            sum.normalize_or_zero()
        });

        let cotangents = self.cotangents.as_flattened();
        fill(&mut self.weights, rings.len(), |e| {
            let [left, right] = rings.edge(e).opposite;
            0.5 * (cotangents[left as usize] + cotangents[right as usize])
        });
        let (weights, areas) = (&self.weights, &self.areas);
        fill(&mut self.curvature_vectors, vertices, |i| {
            let sum = laplacian(rings, weights, i, |e| {
                positions[e.neighbor as usize] - positions[i]
            });
            if areas[i] > 0.0 {
                sum / areas[i]
            } else {
                DVec3::ZERO
            }
        });
        let (vectors, normals) = (&self.curvature_vectors, &self.normals);
        fill(&mut self.curvatures, vertices, |i| {
            vectors[i].dot(normals[i])
        });
    }
}

/// Σ_p ½ (cot + cot) (u_p − u_i), the integral of the Laplace–Beltrami operator over V_i: (4.6) and (4.13), with the
/// sign of the errata. `difference` gives u_p − u_i along an edge.
#[inline]
pub(crate) fn laplacian<T>(
    rings: &Rings,
    weights: &[f64],
    vertex: usize,
    difference: impl Fn(&RingEdge) -> T,
) -> T
where
    T: std::iter::Sum + std::ops::Mul<f64, Output = T>,
{
    let weights = &weights[rings.offset(vertex)..];
    let edges = rings.around(vertex).iter().zip(weights);
    edges.map(|(edge, &weight)| difference(edge) * weight).sum()
}

/// The cotangents of the angles of a triangle, given twice its area.
fn cotangents([a, b, c]: [DVec3; 3], double_area: f64) -> [f64; 3] {
    let of = |u: DVec3, v: DVec3| {
        let dot = u.dot(v);
        // NaN, from 0 / 0, becomes a right angle.
        let cotangent = (dot / double_area).clamp(-COTANGENT_LIMIT, COTANGENT_LIMIT);
        if cotangent.is_nan() && dot == 0.0 {
            0.0
        } else {
            cotangent
        }
    };
    [of(b - a, c - a), of(c - b, a - b), of(a - c, b - c)]
}
