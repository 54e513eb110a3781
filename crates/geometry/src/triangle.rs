//! Measures of a single triangle, and the point of a segment or triangle closest to another.
//!
//! Lengths are in the caller's units, angles in radians. Degenerate triangles are ordinary input: each
//! item says what it gives for them. Results that do not fit a double are infinite, never NaN, for finite
//! corners whose differences are finite.

use glam::DVec3;
use std::f64::consts::PI;

/// Twice the area times the unit normal; the normal points to the side from which `a, b, c` turn
/// counter-clockwise. Zero, up to rounding, for a triangle without area. Overflows for edges beyond 1e154.
#[inline]
pub fn double_area_normal(a: DVec3, b: DVec3, c: DVec3) -> DVec3 {
    (b - a).cross(c - a)
}

/// The unit normal on the side from which `a, b, c` turn counter-clockwise; `None` for a triangle whose
/// computed area is zero.
///
/// ```
/// # use pellicle_geometry::{DVec3, triangle};
/// assert_eq!(triangle::unit_normal(DVec3::ZERO, DVec3::X, DVec3::Y), Some(DVec3::Z));
/// assert_eq!(triangle::unit_normal(DVec3::ZERO, DVec3::X, -DVec3::X), None);
/// ```
pub fn unit_normal(a: DVec3, b: DVec3, c: DVec3) -> Option<DVec3> {
    let edges = Edges::of(a, b, c);
    // Two scalings: the cross product of a sliver is tiny even between edges of length one.
    let normal = edges.ab.cross(edges.ac);
    let scale = power_of_two_near(normal.abs().max_element());
    (normal / scale).try_normalize()
}

/// The area.
///
/// ```
/// # use pellicle_geometry::{DVec3, triangle};
/// assert_eq!(triangle::area(DVec3::ZERO, DVec3::X, DVec3::Y), 0.5);
/// assert_eq!(triangle::area(DVec3::ZERO, 1e-200 * DVec3::X, 1e200 * DVec3::Y), 0.5);
/// ```
#[inline]
pub fn area(a: DVec3, b: DVec3, c: DVec3) -> f64 {
    let plain = double_area_normal(a, b, c).length_squared();
    // Far from overflow and underflow the plain formula loses nothing.
    if (1e-200..1e200).contains(&plain) {
        return 0.5 * plain.sqrt();
    }
    let (ab, ac) = (b - a, c - a);
    let (s, t) = (
        power_of_two_near(ab.abs().max_element()),
        power_of_two_near(ac.abs().max_element()),
    );
    // Larger scale first meets the small unit area, so that no partial product overflows needlessly.
    0.5 * (ab / s).cross(ac / t).length() * s.min(t) * s.max(t)
}

/// The middle of the corners.
#[inline]
pub fn centroid(a: DVec3, b: DVec3, c: DVec3) -> DVec3 {
    a / 3.0 + b / 3.0 + c / 3.0
}

/// The lengths of the edges `ab`, `bc`, `ca`.
#[inline]
pub fn edge_lengths(a: DVec3, b: DVec3, c: DVec3) -> [f64; 3] {
    [length(b - a), length(c - b), length(a - c)]
}

/// The angles at `a`, `b` and `c`. Their sum is π up to rounding, unless corners coincide: the angle at a
/// corner on another corner is zero.
///
/// ```
/// # use pellicle_geometry::{DVec3, triangle};
/// # use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};
/// let [a, b, c] = triangle::angles(DVec3::ZERO, DVec3::X, DVec3::Y);
/// assert_eq!((a, b, c), (FRAC_PI_2, FRAC_PI_4, FRAC_PI_4));
/// ```
pub fn angles(a: DVec3, b: DVec3, c: DVec3) -> [f64; 3] {
    [
        angle_between(b - a, c - a),
        angle_between(c - b, a - b),
        angle_between(a - c, b - c),
    ]
}

/// The angle between two directions, from 0 to π, accurate for small and flat angles too; zero if one of
/// them is zero.
pub fn angle_between(u: DVec3, v: DVec3) -> f64 {
    let unit = |w: DVec3| w / power_of_two_near(w.abs().max_element());
    let (u, v) = (unit(u), unit(v));
    u.cross(v).length().atan2(u.dot(v)).min(PI)
}

/// The radius of the circle through the corners: |ab| |bc| |ca| / (4 area). Infinite for three corners on
/// one line, zero if all coincide.
///
/// ```
/// # use pellicle_geometry::{DVec3, triangle};
/// let r = triangle::circumradius(DVec3::ZERO, 3.0 * DVec3::X, 4.0 * DVec3::Y);
/// assert_eq!(r, 2.5);
/// ```
pub fn circumradius(a: DVec3, b: DVec3, c: DVec3) -> f64 {
    let edges = Edges::of(a, b, c);
    let product = edges.ab.length() * edges.ac.length() * (edges.ac - edges.ab).length();
    let double_area = edges.ab.cross(edges.ac).length();
    if edges.ab == DVec3::ZERO && edges.ac == DVec3::ZERO {
        0.0
    } else if double_area == 0.0 {
        f64::INFINITY
    } else {
        0.5 * product / double_area * edges.scale
    }
}

/// The point of the segment from `a` to `b` closest to `p`.
#[inline]
pub fn closest_point_on_segment(p: DVec3, a: DVec3, b: DVec3) -> DVec3 {
    let ab = b - a;
    let t = (p - a).dot(ab) / ab.dot(ab);
    // NaN for a segment of no length: `a` then.
    if t > 0.0 {
        let on_line = if t < 0.5 {
            a + ab * t
        } else {
            b - ab * (1.0 - t.min(1.0))
        };
        on_line.clamp(a.min(b), a.max(b))
    } else {
        a
    }
}

/// The point of the triangle closest to `p`, up to rounding; inside the triangle's bounding box.
///
/// The projection of `p` is compared with the closest points of the three edges, instead of trusting a
/// case distinction (Ericson 2005, section 5.1.5) that rounding defeats on slivers. Coordinates between
/// about 1e-75 and 1e75 relative to `p`: scale others first.
///
/// ```
/// # use pellicle_geometry::{DVec3, triangle};
/// let (a, b, c) = (DVec3::ZERO, DVec3::X, DVec3::Y);
/// assert_eq!(triangle::closest_point(DVec3::new(0.25, 0.25, 7.0), a, b, c), DVec3::new(0.25, 0.25, 0.0));
/// assert_eq!(triangle::closest_point(DVec3::new(3.0, -1.0, 0.0), a, b, c), b);
/// ```
pub fn closest_point(p: DVec3, a: DVec3, b: DVec3, c: DVec3) -> DVec3 {
    let (ab, ac, ap) = (b - a, c - a, p - a);
    let normal = ab.cross(ac);
    let square = normal.length_squared();
    let (v, w) = (
        ap.cross(ac).dot(normal) / square,
        ab.cross(ap).dot(normal) / square,
    );
    let mut best = closest_point_on_segment(p, a, b);
    let mut least = p.distance_squared(best);
    let inside = v >= 0.0 && w >= 0.0 && v + w <= 1.0;
    let projection = inside.then(|| (a + ab * v + ac * w).clamp(a.min(b).min(c), a.max(b).max(c)));
    let others = [
        closest_point_on_segment(p, b, c),
        closest_point_on_segment(p, c, a),
    ];
    for candidate in others.into_iter().chain(projection) {
        let distance = p.distance_squared(candidate);
        if distance < least {
            (best, least) = (candidate, distance);
        }
    }
    best
}

/// Two edges divided by one power of two, so that the longer has length about one.
struct Edges {
    ab: DVec3,
    ac: DVec3,
    scale: f64,
}

impl Edges {
    fn of(a: DVec3, b: DVec3, c: DVec3) -> Self {
        let (ab, ac) = (b - a, c - a);
        let scale = power_of_two_near(ab.abs().max(ac.abs()).max_element());
        Self {
            ab: ab / scale,
            ac: ac / scale,
            scale,
        }
    }
}

fn length(v: DVec3) -> f64 {
    let scale = power_of_two_near(v.abs().max_element());
    (v / scale).length() * scale
}

/// The largest power of two not above a positive number; 1 for zero, infinity and NaN. Dividing by it is
/// exact but for results below the normal range.
#[inline]
pub fn power_of_two_near(x: f64) -> f64 {
    const EXPONENT: u64 = 0x7ff0_0000_0000_0000;
    let bits = x.to_bits() & EXPONENT;
    if bits == EXPONENT || x.is_nan() || x == 0.0 {
        1.0
    } else if bits == 0 {
        f64::MIN_POSITIVE
    } else {
        f64::from_bits(bits)
    }
}
