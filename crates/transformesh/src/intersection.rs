//! Where two triangles meet: a point, a segment, or the border of a polygon.
//!
//! Two triangles in different planes meet on the line of the planes, in the common part of two intervals:
//!
//! ```text
//!     T meets the line in      t₀────────────t₁
//!     S meets the line in             s₀────────────s₁
//!     both                            s₀─────t₁
//! ```
//!
//! The ends are corners that lie on the other plane, or where edges pierce it. In one plane, each edge of one triangle is
//! clipped by the other.

use crate::points::{PlaneId, Points};
use crate::weld::Weld;
use pellicle_geometry::VertexId;
use pellicle_mesh::TriangleId;
use pellicle_predicates::implicit::Point;
use pellicle_predicates::{Sign, orient3d};
use std::cmp::Ordering;

/// A segment in a triangle along which another one meets it; a point where both ends are the same.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Constraint {
    /// The triangle.
    pub triangle: u32,
    /// The other triangle.
    pub other: u32,
    /// From, to.
    pub ends: [VertexId; 2],
    /// A plane that meets the triangle's plane in the line of the segment.
    pub plane: PlaneId,
}

/// An end before it is known to be needed.
#[derive(Clone)]
enum End {
    Known(VertexId),
    New(Point),
}

impl End {
    fn point<'a>(&'a self, points: &'a Points) -> &'a Point {
        match self {
            Self::Known(id) => points.get(*id),
            Self::New(point) => point,
        }
    }

    fn intern(self, points: &mut Points) -> VertexId {
        match self {
            Self::Known(id) => id,
            Self::New(point) => points.intern(point),
        }
    }

    fn compare(&self, other: &Self, points: &Points, axis: usize) -> Ordering {
        points
            .lattice
            .compare(self.point(points), other.point(points), axis)
    }
}

/// What the pairs of triangles have in common.
#[derive(Default)]
pub(crate) struct Meetings {
    /// Segments and points, each twice: in both triangles.
    pub constraints: Vec<Constraint>,
    /// Pairs that lie in one plane.
    pub coplanar: Vec<(u32, u32)>,
}

impl Meetings {
    /// The intersections of all pairs of triangles that have an area.
    pub(crate) fn new(
        weld: &Weld,
        pairs: &[(TriangleId, TriangleId)],
        points: &mut Points,
    ) -> Self {
        let mut this = Self::default();
        this.constraints.reserve(2 * pairs.len());
        for &(t, u) in pairs {
            this.add(weld, points, t.index(), u.index());
        }
        this
    }

    fn add(&mut self, weld: &Weld, points: &mut Points, t: usize, u: usize) {
        let sides_of_t = sides(weld, t, u);
        if sides_of_t == [Sign::Zero; 3] {
            self.coplanar.push((t as u32, u as u32));
            return self.overlap(weld, points, t, u);
        }
        let sides_of_u = sides(weld, u, t);
        let (plane_t, plane_u) = (
            points.plane_of_triangle(t, weld),
            points.plane_of_triangle(u, weld),
        );
        // The line of the planes runs along an axis on which it is not constant.
        let along = (0..3)
            .find(|&k| points.plane(plane_t).cross_sign(points.plane(plane_u), k) != Sign::Zero);
        let Some(axis) = along else { return };
        let of_t = interval(weld.triangles[t], sides_of_t, plane_u, points, axis);
        let of_u = interval(weld.triangles[u], sides_of_u, plane_t, points, axis);
        let (Some([t0, t1]), Some([u0, u1])) = (of_t, of_u) else {
            return;
        };
        let low = match t0.compare(&u0, points, axis) {
            Ordering::Less => u0,
            _ => t0,
        };
        let high = match t1.compare(&u1, points, axis) {
            Ordering::Less => t1,
            _ => u1,
        };
        if low.compare(&high, points, axis) == Ordering::Greater {
            return;
        }
        let ends = [low, high].map(|end| end.intern(points));
        self.push(t, u, ends, plane_u);
        self.push(u, t, ends, plane_t);
    }

    fn push(&mut self, t: usize, other: usize, ends: [VertexId; 2], plane: PlaneId) {
        self.constraints.push(Constraint {
            triangle: t as u32,
            other: other as u32,
            ends,
            plane,
        });
    }

    /// Two triangles in one plane: the edges of each, clipped by the other.
    fn overlap(&mut self, weld: &Weld, points: &mut Points, t: usize, u: usize) {
        let plane = points.plane_of_triangle(t, weld);
        let axis = points.plane(plane).main_axis();
        for (t, u) in [(t, u), (u, t)] {
            let [a, b, c] = weld.triangles[t];
            let turn = points.orient(axis, a, b, c);
            let [d, e, f] = weld.triangles[u];
            for [p, q] in [[d, e], [e, f], [f, d]] {
                if let Some(ends) = clip(weld.triangles[t], turn, [p, q], axis, points) {
                    let plane = points.plane_of_edge(p, q, axis);
                    self.push(t, u, ends, plane);
                    self.push(u, t, ends, plane);
                }
            }
        }
    }
}

/// The sides of the plane of `u` that the corners of `t` lie on.
fn sides(weld: &Weld, t: usize, u: usize) -> [Sign; 3] {
    let [a, b, c] = weld.corners(u);
    weld.corners(t).map(|p| orient3d(a, b, c, p))
}

/// The part of a triangle on a plane that does not hold all of it, from low to high along an axis.
fn interval(
    corners: [VertexId; 3],
    sides: [Sign; 3],
    plane: PlaneId,
    points: &Points,
    axis: usize,
) -> Option<[End; 2]> {
    let mut ends = Vec::with_capacity(2);
    for i in 0..3 {
        let j = (i + 1) % 3;
        if sides[i] == Sign::Zero {
            ends.push(End::Known(corners[i]));
        }
        if sides[i] * sides[j] == Sign::Negative {
            ends.push(End::New(points.line_plane(corners[i], corners[j], plane)?));
        }
    }
    extremes(ends, points, axis)
}

/// The least and the greatest of some points along an axis.
fn extremes(ends: Vec<End>, points: &Points, axis: usize) -> Option<[End; 2]> {
    let mut ends = ends.into_iter();
    let first = ends.next()?;
    let mut range = [first.clone(), first];
    for end in ends {
        if end.compare(&range[0], points, axis) == Ordering::Less {
            range[0] = end;
        } else if end.compare(&range[1], points, axis) == Ordering::Greater {
            range[1] = end;
        }
    }
    Some(range)
}

/// The part of a segment in a triangle of the same plane, which turns as `turn` seen along `axis`.
fn clip(
    triangle: [VertexId; 3],
    turn: Sign,
    [p, q]: [VertexId; 2],
    axis: usize,
    points: &mut Points,
) -> Option<[VertexId; 2]> {
    let [a, b, c] = triangle;
    let edges = [[a, b], [b, c], [c, a]];
    let is_inside = |points: &Points, v: VertexId| {
        edges
            .iter()
            .all(|&[a, b]| points.orient(axis, a, b, v) != -turn)
    };
    // An axis of the plane on which the segment is not constant.
    let along = [(axis + 1) % 3, (axis + 2) % 3]
        .into_iter()
        .find(|&k| points.compare(p, q, k) != Ordering::Equal)?;
    let is_between =
        |points: &Points, v: VertexId| points.compare(p, v, along) != points.compare(q, v, along);
    let mut ends = Vec::with_capacity(4);
    for end in [p, q] {
        if is_inside(points, end) {
            ends.push(End::Known(end));
        }
    }
    for [a, b] in edges {
        let of_a = points.orient(axis, p, q, a);
        if of_a == Sign::Zero && is_between(points, a) {
            ends.push(End::Known(a));
        }
        let crosses = of_a * points.orient(axis, p, q, b) == Sign::Negative
            && points.orient(axis, a, b, p) * points.orient(axis, a, b, q) == Sign::Negative;
        if crosses {
            let plane = points.plane_of_edge(a, b, axis);
            ends.push(End::New(points.line_plane(p, q, plane)?));
        }
    }
    let ends = extremes(ends, points, along)?;
    Some(ends.map(|end| end.intern(points)))
}
