//! A point cloud as a scene.

use crate::camera::{Camera, Projected, unit};
use crate::frame::{Fitted, Frame};
use crate::samples::Samples;
use crate::shade::{Color, linear, lit};
use crate::sheet::{Scene, View};
use crate::{Error, Options};
use pellicle_geometry::{DVec3, first_not_finite};

/// A disc's radius as a share of the estimated spacing: neighbours just touch.
const RADIUS_SHARE: f64 = 0.62;

/// Discs are at least this many pixels in radius, and by themselves at most this share of the unit ball.
const LEAST_PIXELS: f64 = 0.55;
const LARGEST: f64 = 0.03;

/// A disc seen edge-on is drawn as if tilted so much towards the viewer.
const LEAST_TILT: f64 = 0.2;

/// A cloud inside the unit ball.
pub struct CloudScene {
    positions: Vec<DVec3>,
    /// Of length one, or zero where there is none; empty where no point has one.
    normals: Vec<DVec3>,
    radius: f64,
    fitted: Fitted,
    front: Color,
    back: Color,
    ball: Color,
}

/// Refuses what cannot be drawn.
pub fn check(points: &[DVec3], normals: Option<&[DVec3]>) -> Result<(), Error> {
    if points.len() > (u32::MAX - 8) as usize {
        return Err(Error::TooMany {
            count: points.len(),
        });
    }
    if let Some(vertex) = first_not_finite(points) {
        let position = points[vertex.index()];
        return Err(Error::NotFinite { vertex, position });
    }
    match normals {
        Some(normals) if normals.len() != points.len() => Err(Error::NormalCount {
            points: points.len(),
            normals: normals.len(),
        }),
        _ => Ok(()),
    }
}

impl CloudScene {
    /// The scene of a cloud that [`check`] passed.
    pub fn new(points: &[DVec3], normals: Option<&[DVec3]>, options: &Options) -> Self {
        let (frame, fitted) = Frame::with_bounds(points.iter().copied(), options.bounds);
        let positions: Vec<DVec3> = points.iter().map(|&p| frame.place(p)).collect();
        let normals = normals
            .unwrap_or_default()
            .iter()
            .map(|&normal| unit(normal).unwrap_or(DVec3::ZERO))
            .collect();
        let radius = match options.point_radius {
            Some(radius) => frame.scale(radius),
            None => (RADIUS_SHARE * spacing(&positions)).min(LARGEST),
        };
        Self {
            positions,
            normals,
            // A radius that is not a positive number draws the smallest discs.
            radius: radius.clamp(0.0, 1.0).max(0.0),
            fitted,
            front: linear(options.palette.front),
            back: linear(options.palette.back),
            ball: linear(options.palette.point),
        }
    }

    /// The normal in the viewer's frame; `None` where there is none.
    fn normal(&self, camera: &Camera, point: usize) -> Option<DVec3> {
        let normal = *self.normals.get(point)?;
        (normal != DVec3::ZERO).then(|| camera.turn(normal))
    }

    /// A disc's radius in samples and in the ball's units.
    fn radii(&self, view: &View, nearness: f64) -> (f64, f64) {
        let scale = view.placement.scale * view.camera.enlargement(nearness);
        let in_samples = (self.radius * scale).max(LEAST_PIXELS * view.samples_per_pixel);
        (in_samples, in_samples / scale)
    }
}

impl Scene for CloudScene {
    fn project(&self, camera: &Camera, visit: &mut dyn FnMut(Projected)) {
        if !self.fitted.project(camera, visit) {
            return;
        }
        for &position in &self.positions {
            visit(camera.project(position));
        }
    }

    fn draw(&self, view: &View, samples: &mut Samples) {
        for (point, &position) in self.positions.iter().enumerate() {
            let projected = view.camera.project(position);
            let (in_samples, radius) = self.radii(view, projected.nearness);
            let height = view.camera.height(projected.nearness);
            let tilted = self.normal(&view.camera, point).map(tilt);
            let unit_length = radius / in_samples;
            let center = view.placement.place(projected);
            samples.around(center, in_samples, |samples, at, dx, dy| {
                // Samples count y downwards.
                let (x, y) = (dx * unit_length, -dy * unit_length);
                let rise = match tilted {
                    Some(normal) => {
                        let rise = -(normal.x * x + normal.y * y) / normal.z;
                        (x * x + y * y + rise * rise <= radius * radius).then_some(rise)
                    }
                    None => {
                        let left = radius * radius - x * x - y * y;
                        (left >= 0.0).then(|| left.sqrt())
                    }
                };
                if let Some(rise) = rise {
                    let nearness = view.camera.nearness(height + rise);
                    samples.put(at, nearness as f32, point as u32);
                }
            });
        }
    }

    fn shade(&self, view: &View, what: u32, at: (f64, f64)) -> Color {
        let point = what as usize;
        if let Some(normal) = self.normal(&view.camera, point) {
            return if normal.z >= 0.0 {
                lit(self.front, normal)
            } else {
                lit(self.back, -normal)
            };
        }
        let projected = view.camera.project(self.positions[point]);
        let (in_samples, _) = self.radii(view, projected.nearness);
        let (x, y) = view.placement.place(projected);
        let (x, y) = ((at.0 - x) / in_samples, (y - at.1) / in_samples);
        let z = (1.0 - x * x - y * y).max(0.0).sqrt();
        lit(self.ball, unit(DVec3::new(x, y, z)).unwrap_or(DVec3::Z))
    }

    fn is_mark(&self, _what: u32) -> bool {
        false
    }

    fn is_uniform(&self) -> bool {
        false
    }
}

/// The normal towards the viewer, at least [`LEAST_TILT`] so.
fn tilt(normal: DVec3) -> DVec3 {
    let facing = if normal.z < 0.0 { -normal } else { normal };
    facing.with_z(facing.z.max(LEAST_TILT))
}

/// About the distance between neighbours on the surface that the points sample, in the ball's units.
///
/// The area is that of the occupied cells of a grid, the finest of a few in which a cell holds four points on
/// average. Linear time but for sorts of one integer a point.
fn spacing(positions: &[DVec3]) -> f64 {
    for cells in [512_u32, 256, 128, 64, 32, 16, 8] {
        let side = 2.0 / f64::from(cells);
        let mut keys: Vec<[u16; 3]> = positions
            .iter()
            .map(|p| ((*p + DVec3::ONE) / side).to_array().map(|v| v as u16))
            .collect();
        keys.sort_unstable();
        keys.dedup();
        if keys.len() * 4 <= positions.len() {
            return side * (keys.len() as f64 / positions.len() as f64).sqrt();
        }
    }
    0.25
}

#[cfg(test)]
mod tests {
    use super::*;
    use pellicle_geometry::VertexId;

    #[test]
    fn spacing_of_a_square_grid() {
        for n in [50_u32, 200] {
            let step = 1.0 / f64::from(n);
            let points: Vec<DVec3> = (0..n * n)
                .map(|i| DVec3::new(f64::from(i % n), f64::from(i / n), 0.0) * step)
                .collect();
            let found = spacing(&points) / step;
            assert!((0.8..1.6).contains(&found), "{found}");
        }
    }

    #[test]
    fn edge_on_discs_are_tilted() {
        assert_eq!(tilt(DVec3::X).z, LEAST_TILT);
        assert_eq!(tilt(DVec3::NEG_Z), DVec3::Z);
    }

    #[test]
    fn wrong_input_is_refused() {
        let points = [DVec3::ZERO, DVec3::INFINITY];
        let refused = check(&points, None);
        let vertex = VertexId(1);
        assert!(matches!(refused, Err(Error::NotFinite { vertex: v, .. }) if v == vertex));
        assert!(check(&points[..1], Some(&[])).is_err());
        assert!(check(&points[..1], Some(&[DVec3::NAN])).is_ok());
    }
}
