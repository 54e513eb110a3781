//! Clouds far from the origin, very large or very small, moved to where doubles are fine enough and products do not
//! overflow.

use crate::{EdgeLength, Error, Evolved, Initial, Measures, Options, Schedule};
use glam::DVec3;
use pellicle_geometry::triangle::power_of_two_near;
use pellicle_geometry::{Aabb, first_not_finite};
use pellicle_mesh::TriMesh;

/// inside = (outside − center) / scale.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Placement {
    center: DVec3,
    /// A power of two: scaling rounds nothing.
    scale: f64,
}

impl Placement {
    /// `None` where the points are well placed as they are, or where nothing can be made of them.
    pub(crate) fn of(points: &[DVec3]) -> Option<Self> {
        /// Beyond this many times its size from the origin, a cloud loses digits that a step needs.
        const FAR: f64 = 1e3;
        /// Between this and its inverse, areas and volumes and their squares are normal numbers.
        const LARGE: f64 = 1e30;
        if points.is_empty() || first_not_finite(points).is_some() {
            return None;
        }
        let bounds = Aabb::of_points(points);
        // Halved first: the sum or difference might overflow.
        let center = 0.5 * bounds.min + 0.5 * bounds.max;
        let half_extent = (0.5 * bounds.max - 0.5 * bounds.min).max_element();
        let fair = (LARGE.recip()..LARGE).contains(&half_extent)
            && center.abs().max_element() <= FAR * half_extent;
        (!fair && half_extent > 0.0).then(|| Self {
            center,
            scale: power_of_two_near(half_extent),
        })
    }

    pub(crate) fn inside(&self, point: DVec3) -> DVec3 {
        point / self.scale - self.center / self.scale
    }

    fn outside(&self, point: DVec3) -> DVec3 {
        point * self.scale + self.center
    }

    /// A mesh moved by a map that leaves it finite.
    fn moved(mesh: &TriMesh, map: impl Fn(DVec3) -> DVec3) -> Result<TriMesh, Error> {
        let mut mesh = mesh.clone();
        let moved = mesh.positions().iter().map(|&p| map(p)).collect();
        mesh.set_positions(moved)?;
        Ok(mesh)
    }

    pub(crate) fn options(&self, options: &Options) -> Result<Options, Error> {
        let mut options = options.clone();
        if let Initial::Mesh(mesh) = &options.initial {
            options.initial = Initial::Mesh(Self::moved(mesh, |p| self.inside(p))?);
        }
        if let Schedule::Adaptive {
            edge_length: EdgeLength::Absolute(length),
            ..
        } = &mut options.schedule
        {
            *length /= self.scale;
        }
        Ok(options)
    }

    pub(crate) fn mesh(&self, mesh: &TriMesh) -> Result<TriMesh, Error> {
        Self::moved(mesh, |p| self.outside(p))
    }

    pub(crate) fn measures(&self, measures: &Measures) -> Measures {
        let scale = self.scale;
        Measures {
            spacing: scale * measures.spacing,
            area: scale * scale * measures.area,
            volume: scale * scale * scale * measures.volume,
            least_area: scale * scale * measures.least_area,
            greatest_area: scale * scale * measures.greatest_area,
            largest_move: scale * measures.largest_move,
            largest_normal_move: scale * measures.largest_normal_move,
            ..*measures
        }
    }

    pub(crate) fn evolved(&self, mut evolved: Evolved) -> Result<Evolved, Error> {
        evolved.mesh = self.mesh(&evolved.mesh)?;
        evolved.report.spacing *= self.scale;
        evolved.report.noise *= self.scale;
        Ok(evolved)
    }

    pub(crate) fn error(&self, error: Error) -> Error {
        match error {
            Error::NotFinite {
                step,
                vertex,
                position,
            } => Error::NotFinite {
                step,
                vertex,
                position: self.outside(position),
            },
            Error::NotEnclosed {
                position,
                outside,
                points,
            } => Error::NotEnclosed {
                position: self.outside(position),
                outside,
                points,
            },
            error => error,
        }
    }
}
