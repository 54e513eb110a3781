//! Measures of a single triangle.

use glam::DVec3;

/// Twice the area times the unit normal; the normal points to the side from which `a, b, c` turn
/// counter-clockwise.
#[inline]
pub fn double_area_normal(a: DVec3, b: DVec3, c: DVec3) -> DVec3 {
    (b - a).cross(c - a)
}

/// The area.
///
/// ```
/// # use pellicle_geometry::{DVec3, triangle};
/// assert_eq!(triangle::area(DVec3::ZERO, DVec3::X, DVec3::Y), 0.5);
/// ```
#[inline]
pub fn area(a: DVec3, b: DVec3, c: DVec3) -> f64 {
    0.5 * double_area_normal(a, b, c).length()
}
