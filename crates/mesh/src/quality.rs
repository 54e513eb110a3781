//! How well shaped the triangles of a mesh are, in one pass without connectivity.

use crate::MeshView;
use crate::frame::{Frame, Sum};
use crate::measure::measurable;
use pellicle_geometry::triangle;
use std::f64::consts::PI;

/// What counts as a bad angle, in radians.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AngleBounds {
    /// Angles below this are small. Default 30°: the bound that Daniel 2015 leaves open.
    pub small: f64,
    /// Angles above this are large. Default 120°, its companion.
    pub large: f64,
}

impl Default for AngleBounds {
    fn default() -> Self {
        Self {
            small: 30.0_f64.to_radians(),
            large: 120.0_f64.to_radians(),
        }
    }
}

/// Shapes and sizes of triangles; lengths in the units of the positions, angles in radians. Made by [`quality`].
#[derive(Clone, Debug, PartialEq)]
pub struct Quality {
    /// How many triangles were measured.
    pub triangles: usize,
    /// The least angle.
    pub min_angle: f64,
    /// The greatest angle.
    pub max_angle: f64,
    /// How many angles are below [`AngleBounds::small`].
    pub small_angles: usize,
    /// How many angles are above [`AngleBounds::large`].
    pub large_angles: usize,
    /// The least area of a triangle.
    pub min_area: f64,
    /// The mean area of the triangles.
    pub mean_area: f64,
    /// The greatest area of a triangle.
    pub max_area: f64,
    /// Standard deviation over mean of the areas of the triangles; 0 if they are equal or all zero.
    pub area_variation: f64,
    /// Standard deviation over mean of the barycentric areas of the vertices: a third of the triangles at each.
    /// Vertices without a measured triangle are left out. 0 if they are equal or all zero.
    pub vertex_area_variation: f64,
    /// The mean length of the sides of the triangles: a side that two triangles share counts twice.
    pub mean_edge: f64,
}

/// Measures the shapes of the usable triangles with finite corners; `None` if there is none. Linear time,
/// 16 bytes a triangle and a vertex meanwhile. [`summarize`](crate::summarize) measures topology as well.
///
/// ```
/// use pellicle_mesh::{AngleBounds, icosphere, quality};
/// let sphere = icosphere(3)?;
/// let quality = quality((&sphere).into(), &AngleBounds::default()).unwrap();
/// assert!(quality.min_angle.to_degrees() > 53.0 && quality.large_angles == 0);
/// assert!(quality.area_variation < 0.1);
/// # Ok::<(), pellicle_mesh::MeshError>(())
/// ```
pub fn quality(mesh: MeshView, bounds: &AngleBounds) -> Option<Quality> {
    let frame = Frame::of(mesh.positions);
    let (mut min_angle, mut max_angle) = (PI, 0.0_f64);
    let (mut small_angles, mut large_angles) = (0, 0);
    let mut sides = Sum::default();
    let mut areas = Vec::with_capacity(mesh.triangles.len());
    let mut vertex_areas = vec![(0.0, false); mesh.positions.len()];
    for (t, corners) in measurable(mesh) {
        let [a, b, c] = corners.map(|p| frame.apply(p));
        for angle in triangle::angles(a, b, c) {
            min_angle = min_angle.min(angle);
            max_angle = max_angle.max(angle);
            small_angles += usize::from(angle < bounds.small);
            large_angles += usize::from(angle > bounds.large);
        }
        for length in triangle::edge_lengths(a, b, c) {
            sides.add(length);
        }
        let area = triangle::area(a, b, c);
        areas.push(area);
        for v in mesh.triangles[t] {
            let (sum, seen) = &mut vertex_areas[v.index()];
            *sum += area / 3.0;
            *seen = true;
        }
    }
    let triangles = areas.len();
    let square = frame.scale * frame.scale;
    let (mean_area, area_variation) = mean_and_variation(areas.iter().copied())?;
    let of_vertices = vertex_areas.iter().filter(|(_, seen)| *seen);
    let (_, vertex_area_variation) = mean_and_variation(of_vertices.map(|&(area, _)| area))?;
    Some(Quality {
        triangles,
        min_angle,
        max_angle,
        small_angles,
        large_angles,
        min_area: areas.iter().copied().fold(f64::INFINITY, f64::min) * square,
        mean_area: mean_area * square,
        max_area: areas.iter().copied().fold(0.0, f64::max) * square,
        area_variation,
        vertex_area_variation,
        mean_edge: sides.value() / (3 * triangles) as f64 * frame.scale,
    })
}

/// The mean, and standard deviation over mean; `None` for no values.
fn mean_and_variation(values: impl Iterator<Item = f64> + Clone) -> Option<(f64, f64)> {
    let (mut sum, mut count) = (Sum::default(), 0_usize);
    for value in values.clone() {
        sum.add(value);
        count += 1;
    }
    let mean = (count > 0).then(|| sum.value() / count as f64)?;
    // A second pass: the difference of mean square and squared mean would cancel for values nearly equal.
    let mut squares = Sum::default();
    values.for_each(|value| squares.add((value - mean) * (value - mean)));
    let deviation = (squares.value() / count as f64).sqrt();
    Some((mean, if mean > 0.0 { deviation / mean } else { 0.0 }))
}
