//! The surface that an evolution starts from (Daniel 2015, section 4.1).

use crate::Error;
use crate::cloud::Principal;
use glam::DVec3;
use pellicle_mesh::{TriMesh, icosphere};

/// An ellipsoid around points, its axes their principal ones: every semi-axis is the points' half-extent along it, all
/// multiplied by the least common factor such that every point lies inside or on it, and lengthened by `margin`. The
/// least semi-axis is at least a tenth of the greatest. Vertices as [`icosphere`] has them, mapped.
///
/// # Errors
///
/// [`Error::EmptyCloud`]; [`Error::Mesh`] for more vertices than ids can name.
///
/// ```
/// use pellicle_evolution::ellipsoid_around;
/// use pellicle_geometry::DVec3;
///
/// let mesh = ellipsoid_around(&[-DVec3::X, DVec3::X, 0.5 * DVec3::Y], 0.1, 2)?;
/// assert_eq!(mesh.positions().len(), 162);
/// # Ok::<(), pellicle_evolution::Error>(())
/// ```
pub fn ellipsoid_around(points: &[DVec3], margin: f64, levels: u32) -> Result<TriMesh, Error> {
    const FLATTEST: f64 = 0.1;
    if points.is_empty() {
        return Err(Error::EmptyCloud);
    }
    let principal = Principal::of(points.iter().copied());
    let local = |p: &DVec3| principal.axes.transpose() * (*p - principal.center);
    let (low, high) = points
        .iter()
        .map(local)
        .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), p| {
            (low.min(p), high.max(p))
        });
    let middle = 0.5 * (low + high);
    let extent = 0.5 * (high - low);
    let extent = extent.max(DVec3::splat(FLATTEST * extent.max_element()));
    let factor = points
        .iter()
        .map(|p| ((local(p) - middle) / extent).length())
        .filter(|length| length.is_finite())
        .fold(0.0, f64::max);
    let semi_axes = factor * extent + margin;
    let mut mesh = icosphere(levels)?;
    let mapped = mesh.positions().iter();
    let mapped = mapped.map(|&p| principal.center + principal.axes * (middle + semi_axes * p));
    let mapped = mapped.collect();
    mesh.set_positions(mapped)?;
    Ok(mesh)
}
