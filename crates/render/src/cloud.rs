//! A point cloud as a scene.

use crate::camera::{Camera, Projected, unit};
use crate::frame::{Fitted, Frame};
use crate::marks::{self, Marks};
use crate::paint::Painted;
use crate::samples::{Bins, Samples, rows_between};
use crate::shade::{Color, linear, lit};
use crate::sheet::{Kind, Scene, View};
use crate::{Drawing, Error, Options, Shading};
use pellicle_geometry::{DVec3, first_not_finite};

/// A disc's radius as a share of the estimated spacing: neighbours just touch.
const RADIUS_SHARE: f64 = 0.62;

/// Discs are at least this many pixels in radius, and by themselves at most this share of the unit ball.
const LEAST_PIXELS: f64 = 0.55;
const LARGEST: f64 = 0.03;

/// A disc seen edge-on is drawn as if tilted so much towards the viewer.
const LEAST_TILT: f64 = 0.2;

/// A cloud inside the unit ball, and marks on it.
pub struct CloudScene<'a> {
    positions: Vec<DVec3>,
    /// Of length one, or zero where there is none; empty where no point has one.
    normals: Vec<DVec3>,
    radius: f64,
    fitted: Fitted,
    shading: Shading,
    front: Color,
    back: Color,
    ball: Color,
    painted: Painted<'a>,
    marks: Marks,
}

/// A cloud among the samples of a view.
pub struct Placed {
    discs: Vec<Disc>,
    bins: Bins,
    marks: marks::Placed,
}

/// A point among the samples.
struct Disc {
    center: (f64, f64),
    height: f64,
    /// In samples.
    reach: f64,
    /// In the ball's units.
    radius: f64,
    /// The normal in the viewer's frame, tilted towards the viewer.
    tilted: Option<DVec3>,
}

/// Refuses what cannot be drawn.
pub fn check(points: &[DVec3], normals: Option<&[DVec3]>) -> Result<(), Error> {
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

impl<'a> CloudScene<'a> {
    /// The scene of a drawing that [`check`] passed.
    pub fn new(
        points: &[DVec3],
        normals: Option<&[DVec3]>,
        drawing: &Drawing<'a>,
        options: &Options,
    ) -> Self {
        let shown = points.iter().copied();
        let shown = shown.chain(marks::points(drawing.strokes, drawing.dots));
        let (frame, fitted) = Frame::with_bounds(shown, options.bounds);
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
            shading: options.shading,
            painted: Painted::new(&drawing.coloring, &options.palette),
            marks: Marks::new(&frame, drawing.strokes, drawing.dots),
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

    fn disc(&self, view: &View, point: usize) -> Disc {
        let projected = view.camera.project(self.positions[point]);
        let (reach, radius) = self.radii(view, projected.nearness);
        Disc {
            center: view.placement.place(projected),
            height: view.camera.height(projected.nearness),
            reach,
            radius,
            tilted: self.normal(&view.camera, point).map(tilt),
        }
    }
}

impl Scene for CloudScene<'_> {
    type Placed = Placed;

    fn project(&self, camera: &Camera, visit: &mut dyn FnMut(Projected)) {
        if !self.fitted.project(camera, visit) {
            return;
        }
        for &position in &self.positions {
            visit(camera.project(position));
        }
        self.marks.project(camera, visit);
    }

    fn place(&self, view: &View) -> Placed {
        let points = 0..self.positions.len();
        let discs: Vec<Disc> = points.map(|point| self.disc(view, point)).collect();
        let bins = view.bins(discs.len(), |point| {
            let Disc { center, reach, .. } = discs[point];
            rows_between([center.1; 2], reach, view.height)
        });
        Placed {
            discs,
            bins,
            marks: self.marks.place(view),
        }
    }

    fn draw(&self, placed: &Placed, band: usize, camera: &Camera, samples: &mut Samples<'_>) {
        for point in placed.bins.of(band) {
            let disc = &placed.discs[point];
            let radius = disc.radius;
            let unit_length = radius / disc.reach;
            samples.around(disc.center, disc.reach, |samples, at, dx, dy| {
                // Samples count y downwards.
                let (x, y) = (dx * unit_length, -dy * unit_length);
                let rise = match disc.tilted {
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
                    let nearness = camera.nearness(disc.height + rise);
                    samples.put(at, nearness as f32, point as u32);
                }
            });
        }
        placed.marks.draw(band, samples, self.positions.len());
    }

    fn shade(&self, view: &View, placed: &Placed, what: u32, at: (f64, f64)) -> Color {
        let point = what as usize;
        if let Some(mark) = point.checked_sub(self.positions.len()) {
            return self.marks.color(mark);
        }
        let normal = self.normal(&view.camera, point);
        let surface = match (&self.painted, normal) {
            (Painted::Each(colors), _) => linear(colors[point]),
            (Painted::Values(scale), _) => scale.of(point),
            (Painted::Sides, None) => self.ball,
            (Painted::Sides, Some(normal)) if normal.z >= 0.0 => self.front,
            (Painted::Sides, Some(_)) => self.back,
        };
        if self.shading == Shading::Unlit {
            return surface;
        }
        if let Some(normal) = normal {
            return lit(surface, if normal.z >= 0.0 { normal } else { -normal });
        }
        let Disc { center, reach, .. } = placed.discs[point];
        let (x, y) = ((at.0 - center.0) / reach, (center.1 - at.1) / reach);
        let z = (1.0 - x * x - y * y).max(0.0).sqrt();
        lit(surface, unit(DVec3::new(x, y, z)).unwrap_or(DVec3::Z))
    }

    fn kind(&self, what: u32) -> Kind {
        match what as usize >= self.positions.len() {
            true => Kind::Mark,
            false => Kind::Surface,
        }
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
