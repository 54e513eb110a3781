//! Strokes and dots over a scene.

use crate::camera::{Camera, Projected};
use crate::frame::Frame;
use crate::samples::{Bins, Samples, rows_between};
use crate::shade::{Color, linear};
use crate::sheet::View;
use crate::{Dot, Error, Stroke, Visibility};
use pellicle_geometry::DVec3;

/// A mark lies so much nearer, in the ball's units, than the surface it lies on, and as much more as it is wide: so that
/// a surface which falls off steeply beside it does not swallow it.
const LIFT: f64 = 0.004;

/// Strokes, then dots, inside the unit ball.
pub struct Marks {
    marks: Vec<Mark>,
}

/// A stroke; a dot is one with equal ends.
#[derive(Clone, Copy)]
struct Mark {
    ends: [DVec3; 2],
    color: Color,
    half_width: f64,
    visibility: Visibility,
}

/// The marks of one view.
pub struct Placed {
    lines: Vec<Line>,
    bins: Bins,
}

/// A segment among the samples, and how it is drawn.
#[derive(Clone, Copy)]
pub struct Line {
    ends: [((f64, f64), f64); 2],
    half_width: f64,
    lift: f64,
}

/// Refuses marks that are not finite.
pub fn check(strokes: &[Stroke], dots: &[Dot]) -> Result<(), Error> {
    let ends = strokes.iter().flat_map(|stroke| stroke.ends);
    let mut points = ends.chain(dots.iter().map(|dot| dot.position));
    match points.position(|point| !point.is_finite()) {
        None => Ok(()),
        Some(at) if at < 2 * strokes.len() => Err(Error::StrokeNotFinite { stroke: at / 2 }),
        Some(at) => Err(Error::DotNotFinite {
            dot: at - 2 * strokes.len(),
        }),
    }
}

/// All points that a picture with these marks must fit.
pub fn points<'a>(
    strokes: &'a [Stroke],
    dots: &'a [Dot],
) -> impl Iterator<Item = DVec3> + Clone + 'a {
    let ends = strokes.iter().flat_map(|stroke| stroke.ends);
    ends.chain(dots.iter().map(|dot| dot.position))
}

impl Marks {
    /// The marks that [`check`] passed.
    pub fn new(frame: &Frame, strokes: &[Stroke], dots: &[Dot]) -> Self {
        let strokes = strokes.iter().map(|stroke| Mark {
            ends: stroke.ends.map(|end| frame.place(end)),
            color: linear(stroke.color),
            half_width: 0.5 * stroke.width,
            visibility: stroke.visibility,
        });
        let dots = dots.iter().map(|dot| Mark {
            ends: [frame.place(dot.position); 2],
            color: linear(dot.color),
            half_width: dot.radius,
            visibility: dot.visibility,
        });
        Self {
            marks: strokes.chain(dots).collect(),
        }
    }

    /// Visits every end.
    pub fn project(&self, camera: &Camera, visit: &mut dyn FnMut(Projected)) {
        for end in self.marks.iter().flat_map(|mark| mark.ends) {
            visit(camera.project(end));
        }
    }

    /// The colour of a mark.
    pub fn color(&self, mark: usize) -> Color {
        self.marks[mark].color
    }

    /// The marks among a view's samples.
    pub fn place(&self, view: &View) -> Placed {
        let line = |mark: &Mark| Line::new(view, mark.ends, mark.half_width, mark.visibility);
        let lines: Vec<Line> = self.marks.iter().map(line).collect();
        let bins = view.bins(lines.len(), |i| lines[i].rows(view));
        Placed { lines, bins }
    }
}

impl Placed {
    /// Draws those of a band; the first mark's id is `first`.
    pub fn draw(&self, band: usize, samples: &mut Samples<'_>, first: usize) {
        for mark in self.bins.of(band) {
            self.lines[mark].draw(samples, (first + mark) as u32);
        }
    }
}

impl Line {
    /// A segment of the unit ball, half its width in pixels; one that is not a positive number is thin.
    pub fn new(view: &View, ends: [DVec3; 2], half_width: f64, visibility: Visibility) -> Self {
        // No wider than the view, and at least half a sample.
        let widest = view.height as f64;
        let half_width = (half_width * view.samples_per_pixel).max(0.5).min(widest);
        let lift = match visibility {
            Visibility::Hidden => {
                let height = (LIFT + 2.0 * half_width / view.placement.scale).min(1.0);
                view.camera.nearness(height) - view.camera.nearness(0.0)
            }
            Visibility::Through => f64::INFINITY,
        };
        Self {
            ends: ends.map(|end| {
                let projected = view.camera.project(end);
                (view.placement.place(projected), projected.nearness)
            }),
            half_width,
            lift,
        }
    }

    /// The rows that it may cover.
    pub fn rows(&self, view: &View) -> std::ops::Range<usize> {
        let y = self.ends.map(|((_, y), _)| y);
        rows_between(y, self.half_width, view.height)
    }

    /// Draws what lies in the band.
    pub fn draw(&self, samples: &mut Samples<'_>, what: u32) {
        samples.line(self.ends, self.half_width, self.lift, what);
    }
}
