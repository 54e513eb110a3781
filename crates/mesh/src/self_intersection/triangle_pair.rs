//! Whether two triangles meet where they should not, decided by signs alone.
//!
//! Let V₁ and V₂ be the corners of the triangles T₁ and T₂, as places: corners with equal coordinates are one
//! corner, whatever their ids. The triangles *fit* when T₁ ∩ T₂ is the convex hull of V₁ ∩ V₂: nothing, a
//! corner, or an edge. Otherwise they intersect; so do two triangles with the same corners.
//!
//! ```text
//!   no common corner      one                  two                   three
//!   any common point      a point beyond it    a point beyond the    always (a duplicate)
//!                                              edge: folded over
//! ```
//!
//! The definition holds for triangles without area too, which are segments or points here.
//!
//! T₁ ∩ T₂ is convex, so it lies in the hull of V₁ ∩ V₂ exactly when its extreme points do. An extreme point
//! is the meeting of the relative interiors of one face of T₁ and one of T₂, and only these meet in a point:
//!
//! 1. a corner of one that lies in the other; bad unless it is a common corner;
//! 2. two edges that cross inside both; bad, unless both triangles are segments with a common corner, which
//!    then is where they cross;
//! 3. an edge that pierces the inside of the other; always bad, as common corners lie on its boundary.

use crate::validate::are_collinear;
use pellicle_geometry::{DVec2, DVec3};
use pellicle_predicates::{Sign, orient2d, orient3d};

/// Whether two triangles with finite corners intersect other than in common corners or a common edge. Exact.
///
/// Corners with equal coordinates count as the same corner; see the module for triangles without area.
///
/// ```
/// use pellicle_geometry::DVec3;
/// use pellicle_mesh::triangles_intersect;
/// let floor = [DVec3::ZERO, DVec3::X, DVec3::Y];
/// let wall = [DVec3::ZERO, DVec3::X, DVec3::Z];
/// let folded_over = [DVec3::ZERO, DVec3::X, DVec3::X + DVec3::Y];
/// assert!(!triangles_intersect(floor, wall));
/// assert!(triangles_intersect(floor, folded_over));
/// ```
pub fn triangles_intersect(first: [DVec3; 3], second: [DVec3; 3]) -> bool {
    let shared_by_first = first.map(|p| second.contains(&p));
    let shared_by_second = second.map(|p| first.contains(&p));
    // Same places on both sides: a duplicate.
    if shared_by_first == [true; 3] && shared_by_second == [true; 3] {
        return true;
    }
    if fit_by_side(first, shared_by_first, second) || fit_by_side(second, shared_by_second, first) {
        return false;
    }
    let (t, u) = (Simplex::of(first), Simplex::of(second));
    let both_segments = matches!((&t, &u), (Simplex::Segment(_), Simplex::Segment(_)));
    let cross_in_corner = both_segments && shared_by_first.contains(&true);
    t.has_corner_in(&u, &second)
        || u.has_corner_in(&t, &first)
        || !cross_in_corner && t.edges().any(|e| u.edges().any(|f| cross(e, f)))
        || t.edges().any(|e| u.is_pierced_by(e))
        || u.edges().any(|f| t.is_pierced_by(f))
}

/// Whether all corners of `t` but the common ones lie strictly on one side of the plane of `u`. Then the
/// plane meets `t` in the hull of the common corners only, so the triangles fit. Settles nearly all pairs.
fn fit_by_side(t: [DVec3; 3], shared: [bool; 3], u: [DVec3; 3]) -> bool {
    let mut side = Sign::Zero;
    for (p, shared) in t.into_iter().zip(shared) {
        if shared {
            continue;
        }
        let sign = orient3d(u[0], u[1], u[2], p);
        if sign == Sign::Zero || sign == -side {
            return false;
        }
        side = sign;
    }
    // All common: `t` may still be a segment along an edge of `u`, or across it.
    side != Sign::Zero
}

/// The convex hull of three points: its extreme points.
enum Simplex {
    Point([DVec3; 1]),
    Segment([DVec3; 2]),
    Triangle([DVec3; 3]),
}

impl Simplex {
    fn of(corners: [DVec3; 3]) -> Self {
        let [a, b, c] = corners;
        if !are_collinear(a, b, c) {
            return Self::Triangle(corners);
        }
        // Along a line the lexicographic order is the order on the line.
        let before = |p: DVec3, q: DVec3| p.to_array() < q.to_array();
        let pick = |p: DVec3, q: DVec3, first: bool| if before(p, q) == first { p } else { q };
        let least = pick(pick(a, b, true), c, true);
        let greatest = pick(pick(a, b, false), c, false);
        if least == greatest {
            Self::Point([least])
        } else {
            Self::Segment([least, greatest])
        }
    }

    fn corners(&self) -> &[DVec3] {
        match self {
            Self::Point(p) => p,
            Self::Segment(p) => p,
            Self::Triangle(p) => p,
        }
    }

    fn edges(&self) -> impl Iterator<Item = [DVec3; 2]> + '_ {
        let corners = self.corners();
        let count = match self {
            Self::Point(_) => 0,
            Self::Segment(_) => 1,
            Self::Triangle(_) => 3,
        };
        (0..count).map(move |i| [corners[i], corners[(i + 1) % corners.len()]])
    }

    /// Case 1: whether an extreme point of this lies in `other` and is none of its `corners`.
    fn has_corner_in(&self, other: &Self, corners: &[DVec3; 3]) -> bool {
        self.corners()
            .iter()
            .any(|&p| !corners.contains(&p) && other.contains(p))
    }

    /// Whether a point lies in the hull, boundary included.
    fn contains(&self, p: DVec3) -> bool {
        match *self {
            Self::Point([a]) => p == a,
            Self::Segment([a, b]) => {
                let in_box = p.cmpge(a.min(b)).all() && p.cmple(a.max(b)).all();
                in_box && are_collinear(a, b, p)
            }
            Self::Triangle([a, b, c]) => {
                if orient3d(a, b, c, p) != Sign::Zero {
                    return false;
                }
                let (axis, turn) = projection(a, b, c);
                let [a, b, c, p] = [a, b, c, p].map(|q| project(q, axis));
                let outside = |a, b| orient2d(a, b, p) == -turn;
                turn != Sign::Zero && !outside(a, b) && !outside(b, c) && !outside(c, a)
            }
        }
    }

    /// Case 3: whether a segment runs from one side of this triangle to the other through its inside, the
    /// boundary excluded.
    fn is_pierced_by(&self, [p, q]: [DVec3; 2]) -> bool {
        let Self::Triangle([a, b, c]) = *self else {
            return false;
        };
        // An end that is a corner lies on the plane: no need for exact arithmetic to say so.
        let is_corner = |p| p == a || p == b || p == c;
        if is_corner(p) || is_corner(q) {
            return false;
        }
        if orient3d(a, b, c, p) * orient3d(a, b, c, q) != Sign::Negative {
            return false;
        }
        let turn = orient3d(p, q, a, b);
        turn != Sign::Zero && turn == orient3d(p, q, b, c) && turn == orient3d(p, q, c, a)
    }
}

/// Case 2: whether two segments cross in one point that is inside both.
fn cross([a, b]: [DVec3; 2], [c, d]: [DVec3; 2]) -> bool {
    // With a common end they meet there, or lie on one line.
    if a == c || a == d || b == c || b == d || orient3d(a, b, c, d) != Sign::Zero {
        return false;
    }
    // In a common plane; `c` on the line through `a` and `b` rules out a crossing inside `cd`.
    let (axis, turn) = projection(a, b, c);
    let [a, b, c, d] = [a, b, c, d].map(|p| project(p, axis));
    turn * orient2d(a, b, d) == Sign::Negative
        && orient2d(c, d, a) * orient2d(c, d, b) == Sign::Negative
}

/// An axis along which the plane of three points is seen from the side that keeps points apart, and how
/// they turn there; zero if they lie on one line.
fn projection(a: DVec3, b: DVec3, c: DVec3) -> (usize, Sign) {
    for axis in 0..3 {
        let turn = orient2d(project(a, axis), project(b, axis), project(c, axis));
        if turn != Sign::Zero {
            return (axis, turn);
        }
    }
    (0, Sign::Zero)
}

fn project(p: DVec3, axis: usize) -> DVec2 {
    match axis {
        0 => DVec2::new(p.y, p.z),
        1 => DVec2::new(p.z, p.x),
        _ => DVec2::new(p.x, p.y),
    }
}
