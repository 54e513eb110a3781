//! Symbolic perturbation in the lifted dimension (Devillers and Teillaud 2011).
//!
//! The lift of every point is raised by a power of ε that grows with the point's lexicographic rank, so
//! that the lexicographically largest of a cospherical set lies *outside* the sphere of the others.

use crate::{Sign, insphere as exact_insphere, orient3d};
use glam::DVec3;
use std::cmp::Ordering;

/// Compares by x, then y, then z.
#[inline]
pub fn lexicographic(a: DVec3, b: DVec3) -> Ordering {
    a.x.partial_cmp(&b.x)
        .unwrap_or(Ordering::Equal)
        .then(a.y.partial_cmp(&b.y).unwrap_or(Ordering::Equal))
        .then(a.z.partial_cmp(&b.z).unwrap_or(Ordering::Equal))
}

/// The perturbed in-sphere test; never zero for distinct points with `a, b, c, d` not coplanar.
pub fn insphere(a: DVec3, b: DVec3, c: DVec3, d: DVec3, e: DVec3) -> Sign {
    match exact_insphere(a, b, c, d, e) {
        Sign::Zero => insphere_of_cospherical(a, b, c, d, e),
        sign => sign,
    }
}

/// The sign of the perturbation for five points already known to be cospherical.
#[cold]
pub fn insphere_of_cospherical(a: DVec3, b: DVec3, c: DVec3, d: DVec3, e: DVec3) -> Sign {
    let points = [a, b, c, d, e];
    let mut order = [0, 1, 2, 3, 4];
    order.sort_unstable_by(|&i, &j| lexicographic(points[j], points[i]));
    for i in order {
        let sign = match i {
            0 => orient3d(e, b, c, d),
            1 => orient3d(a, e, c, d),
            2 => orient3d(a, b, e, d),
            3 => orient3d(a, b, c, e),
            _ => return -orient3d(a, b, c, d),
        };
        if sign != Sign::Zero {
            return sign;
        }
    }
    Sign::Zero
}
