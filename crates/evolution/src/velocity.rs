//! The normal velocity v_N of (3.3), term by term.

use crate::field::Sample;
use crate::finite_volumes::FiniteVolumes;
use crate::step::Deflation;

/// The advection speed along N_i: w_a (−∇d · N_i), (4.5).
#[inline]
pub(crate) fn advection(w_a: f64, volumes: &FiniteVolumes, sample: &Sample, vertex: usize) -> f64 {
    w_a * -sample.gradient.dot(volumes.normals[vertex])
}

/// The advection speed with at least the speed inward of a [`Deflation`], where the points are far.
#[inline]
pub(crate) fn deflated(advection: f64, deflation: Option<Deflation>, sample: &Sample) -> f64 {
    match deflation {
        Some(deflation) if sample.value > deflation.beyond => advection.min(-deflation.speed),
        _ => advection,
    }
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
