//! Trilinear interpolation of the values and of their central differences (4.4).
//!
//! Between the voxel centres i and i + 1 of an axis, at the fraction t, four values enter:
//!
//! ```text
//!                 i − 1      i       i + 1    i + 2
//!   value           0      1 − t       t        0
//!   derivative  −(1 − t)/2  −t/2   (1 − t)/2   t/2
//! ```
//!
//! The derivative is the linear interpolation of the central differences at i and i + 1, so the gradient is continuous.
//! At the first and the last centre of the lattice the difference is one-sided.

use super::lattice::Lattice;
use glam::{DVec3, UVec3};

/// Places and weights on one axis.
#[derive(Clone, Copy)]
struct Axis {
    places: [usize; 4],
    /// Of i and i + 1.
    value: [f64; 2],
    derivative: [f64; 4],
}

impl Axis {
    /// `position` within 0 ..= count − 1, `count` at least 2.
    #[inline]
    fn new(position: f64, count: u32, stride: usize) -> Self {
        let i = (position as u32).min(count - 2);
        let t = position - f64::from(i);
        let (before, after) = (i.saturating_sub(1), (i + 2).min(count - 1));
        let left = (1.0 - t) * if i == 0 { 1.0 } else { 0.5 };
        let right = t * if i + 2 == count { 1.0 } else { 0.5 };
        Self {
            places: [before, i, i + 1, after].map(|place| place as usize * stride),
            value: [1.0 - t, t],
            derivative: [-left, -right, left, right],
        }
    }
}

/// The value and the derivatives by voxel coordinates, in voxels, at a point within the centres of a dense array.
#[inline]
pub(super) fn within(values: &[f32], dims: UVec3, position: DVec3) -> (f64, DVec3) {
    let x = Axis::new(position.x, dims.x, 1);
    let y = Axis::new(position.y, dims.y, dims.x as usize);
    let z = Axis::new(position.z, dims.z, dims.x as usize * dims.y as usize);
    let at =
        |i: usize, j: usize, k: usize| f64::from(values[x.places[i] + y.places[j] + z.places[k]]);
    combine(at, &x, &y, &z)
}

/// Sums over the 32 values of the stencil: the cube of 8 about the point, and 4 beyond each of its faces.
#[inline(always)]
fn combine(at: impl Fn(usize, usize, usize) -> f64, x: &Axis, y: &Axis, z: &Axis) -> (f64, DVec3) {
    let mut value = 0.0;
    let mut gradient = DVec3::ZERO;
    for k in 0..2 {
        for j in 0..2 {
            let weight = y.value[j] * z.value[k];
            let row = [0, 1, 2, 3].map(|i| at(i, j + 1, k + 1));
            value += weight * (x.value[0] * row[1] + x.value[1] * row[2]);
            gradient.x += weight
                * (x.derivative[0] * row[0]
                    + x.derivative[1] * row[1]
                    + x.derivative[2] * row[2]
                    + x.derivative[3] * row[3]);
        }
    }
    for k in 0..2 {
        for i in 0..2 {
            let weight = x.value[i] * z.value[k];
            for j in 0..4 {
                gradient.y += weight * y.derivative[j] * at(i + 1, j, k + 1);
            }
        }
    }
    for j in 0..2 {
        for i in 0..2 {
            let weight = x.value[i] * y.value[j];
            for k in 0..4 {
                gradient.z += weight * z.derivative[k] * at(i + 1, j + 1, k);
            }
        }
    }
    (value, gradient)
}

/// Extends a field beyond the outermost centres of a lattice: the value at the nearest point of their box plus the
/// distance from there, in voxels.
#[inline]
pub(super) fn extended(
    lattice: Lattice,
    position: DVec3,
    field: impl Fn(DVec3) -> (f64, DVec3),
) -> (f64, DVec3) {
    let last = lattice.dims.as_dvec3() - 1.0;
    let inside = position.clamp(DVec3::ZERO, last);
    if inside == position {
        return field(position);
    }
    if !position.is_finite() {
        return (f64::NAN, DVec3::NAN);
    }
    let (value, gradient) = field(inside);
    let offset = position - inside;
    let distance = offset.length();
    // Along the axes on which the point was moved the value at the nearest point does not change.
    let kept = DVec3::select(inside.cmpeq(position), gradient, DVec3::ZERO);
    (value + distance, kept + offset / distance)
}
