//! A surface in numbers, as several verbs tell of what they made.

use crate::output::digits;
use crate::progress::Watch;
use pellicle::mesh::{
    AngleBounds, Component, MeshError, MeshView, TriMesh, area, count_self_intersections, quality,
    signed_volume, summarize,
};
use serde::Serialize;

/// A closed or open surface in numbers: lengths in the units of its positions, angles in degrees.
#[derive(Serialize)]
pub struct Surface {
    vertices: usize,
    triangles: usize,
    pub components: usize,
    /// Of all components together; none unless closed.
    pub genus: Option<usize>,
    area: f64,
    /// None unless closed.
    volume: Option<f64>,
    /// None without a triangle that has corners apart.
    least_angle: Option<f64>,
    greatest_angle: Option<f64>,
    mean_edge: Option<f64>,
    self_intersections: u64,
}

impl Surface {
    /// Measures it; self-intersections are counted exactly.
    pub fn of(mesh: &TriMesh, watch: &Watch) -> Result<Self, MeshError> {
        let view = MeshView::from(mesh);
        let quality = quality(view, &AngleBounds::default());
        let quality = quality.as_ref();
        let components = summarize(view)?.components;
        Ok(Self {
            components: components.len(),
            genus: components.iter().map(Component::genus).sum(),
            vertices: mesh.positions().len(),
            triangles: mesh.triangles().len(),
            area: area(view),
            volume: mesh.is_closed().then(|| signed_volume(view)),
            least_angle: quality.map(|q| q.min_angle.to_degrees()),
            greatest_angle: quality.map(|q| q.max_angle.to_degrees()),
            mean_edge: quality.map(|q| q.mean_edge),
            self_intersections: count_self_intersections(view, watch)?,
        })
    }

    /// Whether there is no triangle.
    pub fn is_empty(&self) -> bool {
        self.triangles == 0
    }

    /// Says it, and warns of what a surface should not have.
    pub fn log(&self) {
        tracing::info!(
            "{} vertices, {} triangles, {}{}; area {}{}",
            self.vertices,
            self.triangles,
            match self.components {
                1 => "1 component".to_owned(),
                components => format!("{components} components"),
            },
            self.genus
                .map_or_else(String::new, |genus| format!(" of genus {genus}")),
            digits(self.area),
            self.volume
                .map_or_else(String::new, |volume| format!(", volume {}", digits(volume)))
        );
        if let (Some(least), Some(greatest)) = (self.least_angle, self.greatest_angle) {
            tracing::info!("angles from {least:.1} to {greatest:.1} degrees");
        }
        match self.self_intersections {
            0 => tracing::info!("no self-intersections"),
            pairs => tracing::warn!("the surface intersects itself: {pairs} pairs of triangles do"),
        }
    }
}
