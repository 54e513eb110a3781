//! The tangential velocity v_T, which moves vertices along the surface and leaves its shape alone: (2.18)–(2.20),
//! (4.7)–(4.9), (4.13)–(4.19).

use crate::finite_volumes::FiniteVolumes;
use crate::parallel::fill;
use crate::rings::Rings;
use glam::DVec3;

/// How vertices are spread over the surface while it moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Redistribution {
    /// v_T = 0: vertices move along the normal alone.
    None,
    /// Towards equal co-volume areas, (2.19).
    AreaUniform {
        /// ω, per unit of time: areas approach their targets like exp(−ωt). ωτ < 2, best at most 1.
        omega: f64,
    },
    /// Denser where the surface is more curved, (2.20).
    CurvatureDriven {
        /// ω, as above.
        omega: f64,
        /// f(H).
        density: CurvatureDensity,
    },
    /// Towards equal areas and, beyond the paper, equilateral triangles.
    AngleAware {
        /// ω, as above.
        omega: f64,
        /// The share of the way to where its triangles would be equilateral that a vertex goes in a unit of time. Times
        /// τ less than 1.
        omega_angles: f64,
    },
}

/// The f of (2.16): areas become proportional to 1/f(H̃). H̃ is the mean curvature after three steps of mean curvature
/// flow (section 5), its size alone, and made dimensionless by a length: see [`CurvatureDensity::unit`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurvatureDensity {
    /// Which f.
    pub function: CurvatureFunction,
    /// What H̃ is multiplied by; `None` for the radius of the sphere of the same area, so that the result does not
    /// depend on the unit of length. The paper's figure 12 has 1.
    pub unit: Option<f64>,
}

/// The three choices of section 2.3.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CurvatureFunction {
    /// (|H̃| + ε)^(1/3). Without ε flat places would want no vertices at all.
    CubeRoot {
        /// ε.
        epsilon: f64,
    },
    /// (|H̃| + ε)^(2/3).
    CubeRootSquared {
        /// ε.
        epsilon: f64,
    },
    /// exp(α |H̃|).
    Exponential {
        /// α.
        alpha: f64,
    },
}

impl CurvatureFunction {
    /// f at a curvature.
    pub fn value(self, curvature: f64) -> f64 {
        let size = curvature.abs();
        match self {
            Self::CubeRoot { epsilon } => (size + epsilon).cbrt(),
            Self::CubeRootSquared { epsilon } => (size + epsilon).cbrt().powi(2),
            // Beyond that, shares of the area would underflow.
            Self::Exponential { alpha } => (alpha * size).min(30.0).exp(),
        }
    }
}

/// t_i, the share of the area of its component that vertex i is to have: 1/n, or (1/f_i) / Σ (1/f_j).
pub(crate) fn target_shares(rings: &Rings, density: impl Fn(usize) -> f64) -> Vec<f64> {
    let sums = rings.sum_by_component(|i| density(i).recip());
    (0..rings.vertices())
        .map(|i| density(i).recip() / sums[rings.component(i)])
        .collect()
}

/// The integral of the right side of (2.19) or (2.20) over each co-volume:
/// μ_i (q_i − Σ μq / A) + ω (A t_i − μ_i), with q = v_N · h. It sums to zero over each component.
pub(crate) fn right_side(
    rings: &Rings,
    volumes: &FiniteVolumes,
    q: &[f64],
    shares: &[f64],
    omega: f64,
) -> Vec<f64> {
    let (areas, total_areas) = (&volumes.areas, &volumes.total_areas);
    let sums = rings.sum_by_component(|i| areas[i] * q[i]);
    (0..areas.len())
        .map(|i| {
            let component = rings.component(i);
            let total_area = total_areas[component];
            let mean = sums[component] / total_area;
            areas[i] * (q[i] - mean) + omega * (total_area * shares[i] - areas[i])
        })
        .collect()
}

/// v_T = ∇ψ at each vertex by Stokes' theorem on its co-volume, (4.8) with (4.9). A constant added to ψ changes nothing.
///
/// What (4.8) leaves along the normal, which vanishes with the length of the edges, is taken off, unlike in the paper: on
/// coarse meshes it moves the surface, and on bad ones it can blow it up.
pub(crate) fn gradient_velocity(
    velocity: &mut Vec<DVec3>,
    rings: &Rings,
    volumes: &FiniteVolumes,
    positions: &[DVec3],
    psi: &[f64],
) {
    fill(velocity, rings.vertices(), |i| {
        let ring = rings.around(i);
        let mut integral = DVec3::ZERO;
        for (p, edge) in ring.iter().enumerate() {
            let next = &ring[if p + 1 == ring.len() { 0 } else { p + 1 }];
            let (j, k) = (edge.neighbor as usize, next.neighbor as usize);
            let sigma_1 = (2.0 * positions[k] - positions[i] - positions[j]) / 6.0;
            let sigma_2 = (positions[i] + positions[k] - 2.0 * positions[j]) / 6.0;
            let psi_1 = (5.0 * psi[i] + 5.0 * psi[j] + 2.0 * psi[k]) / 12.0;
            let psi_2 = (5.0 * psi[i] + 2.0 * psi[j] + 5.0 * psi[k]) / 12.0;
            // A boundary that runs counter-clockwise has its outward conormal at its right: ‖σ‖ν = σ × n.
            let normal = volumes.faces[edge.triangle as usize].unit_normal;
            integral += (psi_1 * sigma_1 + psi_2 * sigma_2).cross(normal);
        }
        match volumes.areas[i] {
            0.0 => DVec3::ZERO,
            area => {
                let v = integral / area - psi[i] * volumes.curvature_vectors[i];
                v - v.dot(volumes.normals[i]) * volumes.normals[i]
            }
        }
    });
}

/// Where the apex of an equilateral triangle over the opposite edge would be, averaged over the triangles at a vertex,
/// as a displacement in the tangent plane.
///
/// ```text
///         i'          i' = ½(j + k) + ½√3 n × (k − j). Summed over a closed ring the second terms cancel, as far as it is
///        / \   i      flat: what is left is the middle of the neighbours.
///       /   \
///      j-----k
/// ```
pub(crate) fn towards_equilateral(
    rings: &Rings,
    volumes: &FiniteVolumes,
    positions: &[DVec3],
    vertex: usize,
) -> DVec3 {
    let ring = rings.around(vertex);
    let sum: DVec3 = ring.iter().map(|e| positions[e.neighbor as usize]).sum();
    let displacement = sum / ring.len() as f64 - positions[vertex];
    let normal = volumes.normals[vertex];
    displacement - displacement.dot(normal) * normal
}
