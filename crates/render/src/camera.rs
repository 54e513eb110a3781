//! Where the viewer stands, and what lands where.

use crate::{Error, Projection, Up, View};
use pellicle_geometry::DVec3;

/// The viewer's distance from the centre of the unit ball in perspective.
const DISTANCE: f64 = 6.0;

/// An orthonormal frame: x to the right, y up, z towards the viewer.
#[derive(Clone, Copy, Debug)]
pub struct Camera {
    right: DVec3,
    up: DVec3,
    toward: DVec3,
    projection: Projection,
}

/// A point of the picture plane, and how near it is to the viewer: larger is nearer, and the value is linear on the
/// picture of a plane.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Projected {
    /// To the right.
    pub x: f64,
    /// Up.
    pub y: f64,
    /// Larger is nearer.
    pub nearness: f64,
}

impl Camera {
    /// The camera of a view.
    pub fn new(view: View, up: Up, projection: Projection) -> Result<Self, Error> {
        // The data's axes to the right, away from the viewer of the front view, and up.
        let (right, away, above) = match up {
            Up::Y => (DVec3::X, DVec3::NEG_Z, DVec3::Y),
            Up::Z => (DVec3::X, DVec3::Y, DVec3::Z),
        };
        let (direction, hint) = match view {
            View::Front => (-away, above),
            View::Back => (away, above),
            View::Left => (-right, above),
            View::Right => (right, above),
            View::Top => (above, away),
            View::Bottom => (-above, -away),
            View::ThreeQuarter => (right * 0.75 - away + above * 0.6, above),
            View::From(direction) => (direction, above),
        };
        let toward = unit(direction).ok_or(Error::NoDirection { direction })?;
        // Looking straight up or down, the front view's far side is up.
        let across = match hint.cross(toward) {
            across if across.length_squared() > 1e-12 => across,
            _ => away.cross(toward),
        };
        let right = across / across.length();
        Ok(Self {
            right,
            up: toward.cross(right),
            toward,
            projection,
        })
    }

    /// A direction in the viewer's frame.
    pub fn turn(&self, direction: DVec3) -> DVec3 {
        DVec3::new(
            self.right.dot(direction),
            self.up.dot(direction),
            self.toward.dot(direction),
        )
    }

    /// The picture of a point of the unit ball.
    pub fn project(&self, point: DVec3) -> Projected {
        let p = self.turn(point);
        match self.projection {
            Projection::Orthographic => Projected {
                x: p.x,
                y: p.y,
                nearness: p.z,
            },
            Projection::Perspective => {
                let enlargement = DISTANCE / (DISTANCE - p.z);
                Projected {
                    x: p.x * enlargement,
                    y: p.y * enlargement,
                    nearness: enlargement,
                }
            }
        }
    }

    /// The z of a point of this nearness, towards the viewer.
    pub fn height(&self, nearness: f64) -> f64 {
        match self.projection {
            Projection::Orthographic => nearness,
            Projection::Perspective => DISTANCE - DISTANCE / nearness,
        }
    }

    /// The nearness of a point at this z.
    pub fn nearness(&self, height: f64) -> f64 {
        match self.projection {
            Projection::Orthographic => height,
            Projection::Perspective => DISTANCE / (DISTANCE - height),
        }
    }

    /// How much larger than in the middle a thing of this nearness looks.
    pub fn enlargement(&self, nearness: f64) -> f64 {
        match self.projection {
            Projection::Orthographic => 1.0,
            Projection::Perspective => nearness,
        }
    }
}

/// The direction at length one; `None` if it has none. Scaled first, so that no length overflows.
pub fn unit(direction: DVec3) -> Option<DVec3> {
    let largest = direction.abs().max_element();
    if !(direction.is_finite() && largest > 0.0) {
        return None;
    }
    let scaled = direction / largest;
    Some(scaled / scaled.length())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn camera(view: View, up: Up) -> Camera {
        Camera::new(view, up, Projection::Orthographic).unwrap()
    }

    #[test]
    fn the_axes_land_where_the_views_say() {
        // Right, up and towards the viewer in the picture.
        for (view, up, expected) in [
            (View::Front, Up::Z, [DVec3::X, DVec3::Z, DVec3::NEG_Y]),
            (View::Right, Up::Z, [DVec3::Y, DVec3::Z, DVec3::X]),
            (View::Top, Up::Z, [DVec3::X, DVec3::Y, DVec3::Z]),
            (View::Bottom, Up::Z, [DVec3::X, DVec3::NEG_Y, DVec3::NEG_Z]),
            (View::Front, Up::Y, [DVec3::X, DVec3::Y, DVec3::Z]),
            (View::Left, Up::Y, [DVec3::Z, DVec3::Y, DVec3::NEG_X]),
            (View::Top, Up::Y, [DVec3::X, DVec3::NEG_Z, DVec3::Y]),
            (View::From(DVec3::Z), Up::Z, [DVec3::X, DVec3::Y, DVec3::Z]),
        ] {
            let camera = camera(view, up);
            let found = [camera.right, camera.up, camera.toward];
            assert_eq!(found, expected, "{view:?} {up:?}");
        }
    }

    #[test]
    fn every_camera_is_right_handed() {
        for view in [
            View::ThreeQuarter,
            View::From(DVec3::new(1e300, -1e300, 3.0)),
        ] {
            let c = camera(view, Up::Y);
            assert!(c.right.cross(c.up).dot(c.toward) > 1.0 - 1e-12);
        }
    }

    #[test]
    fn nearness_and_height_are_inverse() {
        for projection in [Projection::Orthographic, Projection::Perspective] {
            let camera = Camera::new(View::Front, Up::Z, projection).unwrap();
            for height in [-1.0, 0.0, 0.5, 1.0] {
                let there = camera.height(camera.nearness(height));
                assert!((there - height).abs() < 1e-12);
            }
            assert!(camera.nearness(0.5) > camera.nearness(0.25));
        }
    }

    #[test]
    fn no_direction_is_an_error() {
        for direction in [DVec3::ZERO, DVec3::NAN, DVec3::INFINITY] {
            let made = Camera::new(View::From(direction), Up::Z, Projection::Perspective);
            assert!(made.is_err(), "{direction}");
        }
    }
}
