//! The surface that an evolution starts from (Daniel 2015, section 4.1).

use crate::cloud::Principal;
use crate::{Error, Initial, Options, Schedule};
use glam::DVec3;
use pellicle_geometry::Aabb;
use pellicle_mesh::{TriMesh, area, count_self_intersections, icosphere, winding_numbers};

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

/// The initial surface, and the length of its edges.
pub(crate) fn begin(points: &[DVec3], options: &Options) -> Result<(TriMesh, f64), Error> {
    const MARGIN: f64 = 0.05;
    let mesh = match &options.initial {
        Initial::Mesh(mesh) => {
            check_initial(mesh, points)?;
            mesh.clone()
        }
        Initial::Ellipsoid => {
            let levels = match options.schedule {
                Schedule::Adaptive { .. } => 3,
                Schedule::Stages { levels, .. } => levels,
            };
            let margin = MARGIN * Aabb::of_points(points).extent().max_element();
            ellipsoid_around(points, margin, levels)?
        }
    };
    let triangles = mesh.triangles().len() as f64;
    let edge_length = (area((&mesh).into()) / triangles * 4.0 / 3.0_f64.sqrt()).sqrt();
    Ok((mesh, edge_length))
}

/// Closed, without self-intersections, around all points.
fn check_initial(mesh: &TriMesh, points: &[DVec3]) -> Result<(), Error> {
    if !mesh.is_closed() || mesh.triangles().is_empty() {
        return Err(Error::not_closed(mesh));
    }
    let pairs = count_self_intersections(mesh.into(), &())?;
    if pairs > 0 {
        return Err(Error::InitialIntersectsItself { pairs });
    }
    let winding = winding_numbers(mesh.into(), points);
    let outside = || {
        points
            .iter()
            .zip(&winding)
            .filter(|(_, winding)| **winding < 1)
    };
    match outside().next() {
        None => Ok(()),
        Some((&position, _)) => Err(Error::NotEnclosed {
            position,
            outside: outside().count(),
            points: points.len(),
        }),
    }
}
