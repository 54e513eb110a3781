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
pub(super) struct Axis {
    pub places: [usize; 4],
    /// Of i and i + 1.
    value: [f64; 2],
    derivative: [f64; 4],
}

impl Axis {
    /// `position` within 0 ..= count − 1, `count` at least 2.
    #[inline]
    pub fn new(position: f64, count: u32, stride: usize) -> Self {
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
pub(super) fn combine(
    at: impl Fn(usize, usize, usize) -> f64,
    x: &Axis,
    y: &Axis,
    z: &Axis,
) -> (f64, DVec3) {
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
    // Scaled: the square of a finite distance may overflow.
    let offset = position - inside;
    let scale = offset.abs().max_element();
    let scaled = offset / scale;
    let length = scaled.length();
    // Along the axes on which the point was moved the value at the nearest point does not change.
    let kept = DVec3::select(inside.cmpeq(position), gradient, DVec3::ZERO);
    (value + length * scale, kept + scaled / length)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Trilinear functions are reproduced, and of linear ones the gradient, up to the faces.
    #[test]
    fn linear_functions_are_reproduced() {
        let dims = UVec3::new(4, 5, 6);
        let function = |p: DVec3| 3.0 + 2.0 * p.x - p.y + 0.5 * p.z;
        let mut values = Vec::new();
        for z in 0..6 {
            for y in 0..5 {
                for x in 0..4 {
                    values.push(function(DVec3::new(x.into(), y.into(), z.into())) as f32);
                }
            }
        }
        for i in 0..1000_u32 {
            let fractions =
                DVec3::new((i % 10).into(), (i / 10 % 10).into(), (i / 100).into()) / 9.0;
            let at = fractions * DVec3::new(3.0, 4.0, 5.0);
            let (value, gradient) = within(&values, dims, at);
            assert!((value - function(at)).abs() < 1e-12, "{at}: {value}");
            assert!(
                (gradient - DVec3::new(2.0, -1.0, 0.5)).length() < 1e-12,
                "{at}: {gradient}"
            );
        }
    }

    /// (4.4) at a centre, by hand.
    #[test]
    fn at_a_centre_the_gradient_is_the_central_difference() {
        let dims = UVec3::new(5, 5, 5);
        let values: Vec<f32> = (0..125_u32).map(|i| (i * i % 31) as f32).collect();
        let at = |x: usize, y: usize, z: usize| f64::from(values[x + 5 * (y + 5 * z)]);
        for (x, y, z) in [(1, 1, 1), (2, 3, 1), (3, 2, 2), (3, 3, 3)] {
            let (value, gradient) = within(&values, dims, DVec3::new(x as f64, y as f64, z as f64));
            let by_hand = DVec3::new(
                at(x + 1, y, z) - at(x - 1, y, z),
                at(x, y + 1, z) - at(x, y - 1, z),
                at(x, y, z + 1) - at(x, y, z - 1),
            );
            assert_eq!(value, at(x, y, z));
            assert_eq!(gradient, by_hand / 2.0);
        }
        let (_, corner) = within(&values, dims, DVec3::ZERO);
        let one_sided = DVec3::new(at(1, 0, 0), at(0, 1, 0), at(0, 0, 1)) - at(0, 0, 0);
        assert_eq!(corner, one_sided);
    }
}
