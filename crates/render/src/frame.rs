//! From the data's coordinates to the unit ball, and what the picture must fit.

use crate::camera::{Camera, Projected};
use pellicle_geometry::{Aabb, DVec3};

/// What a picture must fit, in the unit ball.
#[derive(Clone, Debug)]
pub struct Fitted {
    /// The corners of a box that was asked for.
    corners: Vec<DVec3>,
    /// Whether what is drawn must fit as well: not where it lies in the box.
    drawn_too: bool,
}

impl Fitted {
    /// Visits the corners; returns whether what is drawn is to be visited too.
    pub fn project(&self, camera: &Camera, visit: &mut dyn FnMut(Projected)) -> bool {
        for &corner in &self.corners {
            visit(camera.project(corner));
        }
        self.drawn_too
    }
}

/// A shift and a scale that bring points into the unit ball around the middle of their box.
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    center: DVec3,
    /// Half the longest edge of the box; zero where all points coincide.
    half_extent: f64,
    /// The largest distance from the centre, in half extents.
    radius: f64,
}

impl Frame {
    /// The frame of some finite points. Linear time; two passes.
    pub fn of(points: impl Iterator<Item = DVec3> + Clone) -> Self {
        let bounds = points.clone().fold(Aabb::EMPTY, Aabb::with);
        let mut frame = Self {
            center: DVec3::ZERO,
            half_extent: 0.0,
            radius: 1.0,
        };
        if bounds.is_empty() {
            return frame;
        }
        frame.center = bounds.center();
        // Halves, so that no finite box overflows.
        frame.half_extent = (bounds.max * 0.5 - bounds.min * 0.5).max_element();
        let farthest = points
            .map(|point| frame.place(point).length_squared())
            .fold(0.0, f64::max)
            .sqrt();
        if farthest > 0.0 {
            frame.radius = farthest;
        }
        frame
    }

    /// The frame of some finite points and a box, and what their picture must fit.
    ///
    /// All points that lie in the box have one and the same frame: that of its corners.
    pub fn with_bounds(
        points: impl Iterator<Item = DVec3> + Clone,
        bounds: Option<Aabb>,
    ) -> (Self, Fitted) {
        let Some(bounds) = bounds.filter(|bounds| !bounds.is_empty()) else {
            let fitted = Fitted {
                corners: Vec::new(),
                drawn_too: true,
            };
            return (Self::of(points), fitted);
        };
        let corners = corners(bounds);
        let inside = points.clone().all(|p| bounds.with(p) == bounds);
        let frame = match inside {
            true => Self::of(corners.into_iter()),
            false => Self::of(points.chain(corners)),
        };
        let fitted = Fitted {
            corners: corners.map(|corner| frame.place(corner)).to_vec(),
            drawn_too: !inside,
        };
        (frame, fitted)
    }

    /// The point inside the unit ball.
    pub fn place(&self, point: DVec3) -> DVec3 {
        if self.half_extent > 0.0 {
            (point * 0.5 - self.center * 0.5) / self.half_extent * (2.0 / self.radius)
        } else {
            DVec3::ZERO
        }
    }

    /// A length of the data in the ball's units.
    pub fn scale(&self, length: f64) -> f64 {
        if self.half_extent > 0.0 {
            length / self.half_extent / self.radius
        } else {
            length
        }
    }
}

fn corners(bounds: Aabb) -> [DVec3; 8] {
    let pick = |bit: usize, axis: usize| match bit & 1 {
        0 => bounds.min[axis],
        _ => bounds.max[axis],
    };
    std::array::from_fn(|i| DVec3::new(pick(i, 0), pick(i >> 1, 1), pick(i >> 2, 2)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn any_finite_points_fit_the_unit_ball() {
        for scale in [1.0, 1e-300, 8e307, f64::MIN_POSITIVE] {
            for shift in [0.0, 1.0] {
                let points = [DVec3::ZERO, DVec3::X, DVec3::new(0.5, 1.0, -0.25)]
                    .map(|p| (p + DVec3::splat(shift)) * scale);
                let frame = Frame::of(points.iter().copied());
                let placed = points.map(|p| frame.place(p).length());
                let farthest = placed.iter().copied().fold(0.0, f64::max);
                assert!(
                    (farthest - 1.0).abs() < 1e-12,
                    "{scale} {shift}: {placed:?}"
                );
            }
        }
    }

    #[test]
    fn a_box_wider_than_the_largest_number_fits() {
        let points = [DVec3::splat(-1.7e308), DVec3::splat(1.7e308), DVec3::ZERO];
        let frame = Frame::of(points.iter().copied());
        let [least, greatest, middle] = points.map(|p| frame.place(p));
        assert!(
            (least.length() - 1.0).abs() < 1e-12 && least.x < 0.0,
            "{least}"
        );
        assert_eq!((greatest, middle), (-least, DVec3::ZERO));
    }

    #[test]
    fn a_box_is_fitted_by_its_corners_and_what_sticks_out() {
        let bounds = Aabb {
            min: DVec3::new(-1.0, -2.0, 3.0),
            max: DVec3::new(1.0, 4.0, 5.0),
        };
        let camera = Camera::new(
            crate::View::Top,
            crate::Up::Z,
            crate::Projection::Orthographic,
        )
        .unwrap();
        let fit = |point: DVec3| {
            let (frame, fitted) = Frame::with_bounds([point].into_iter(), Some(bounds));
            let mut seen = Vec::new();
            let drawn_too = fitted.project(&camera, &mut |p| seen.push(p));
            (frame, seen, drawn_too)
        };
        for (point, sticks_out) in [
            (bounds.center(), false),
            (bounds.max, false),
            (DVec3::new(0.0, 0.0, 5.0), false),
            (DVec3::new(0.0, 0.0, 5.1), true),
            (DVec3::new(0.0, -2.1, 4.0), true),
        ] {
            let (frame, seen, drawn_too) = fit(point);
            assert_eq!(drawn_too, sticks_out, "{point}");
            assert!(frame.place(point).length() <= 1.0 + 1e-12);
            // Every corner once.
            for i in 0..8 {
                let corner = |bit: usize| if i & bit == 0 { bounds.min } else { bounds.max };
                let corner = DVec3::new(corner(1).x, corner(2).y, corner(4).z);
                let expected = camera.project(frame.place(corner));
                let times = seen.iter().filter(|&&found| found == expected).count();
                assert_eq!(times, 1, "{corner}");
            }
            assert_eq!(seen.len(), 8);
        }
    }

    #[test]
    fn one_point_and_none() {
        let point = DVec3::splat(1e300);
        assert_eq!(Frame::of([point].into_iter()).place(point), DVec3::ZERO);
        assert_eq!(Frame::of(std::iter::empty()).place(point), DVec3::ZERO);
    }
}
