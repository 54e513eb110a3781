//! The normal velocity v_N of (3.3), term by term.

use crate::field::Sample;
use crate::finite_volumes::FiniteVolumes;

/// The advection speed along N_i: w_a (−∇d · N_i), (4.5).
#[inline]
pub(crate) fn advection(w_a: f64, volumes: &FiniteVolumes, sample: &Sample, vertex: usize) -> f64 {
    w_a * -sample.gradient.dot(volumes.normals[vertex])
}

/// v_N · h at a vertex: adv_i H_i + w_d d_i |h_i|², (4.16) with the sign of the errata.
#[inline]
pub(crate) fn normal_velocity_dot_curvature(
    advection: f64,
    w_d: f64,
    volumes: &FiniteVolumes,
    sample: &Sample,
    vertex: usize,
) -> f64 {
    let diffusion = w_d * sample.value * volumes.curvature_vectors[vertex].length_squared();
    advection * volumes.curvatures[vertex] + diffusion
}
