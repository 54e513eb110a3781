//! One winding number, by the triangles that a ray crosses: exact from an implicit point.
//!
//! The ray leaves the center of a piece along the main axis of its plane, so that it runs inside no triangle that it
//! starts on. Where it meets an edge or a vertex of another triangle it is moved, in thought, by (ε, ε²) across the axis.

use crate::arrangement::Facet;
use crate::points::Points;
use crate::weld::{Weld, projected};
use pellicle_geometry::{Aabb, DVec3, VertexId};
use pellicle_predicates::Sign;
use pellicle_predicates::implicit::Point;
use pellicle_spatial::Bvh;
use std::ops::ControlFlow;

/// What is crossed by rays.
pub(crate) struct Rays<'a> {
    weld: &'a Weld,
    /// Only where there are so many rays that it pays.
    bvh: Option<Bvh>,
}

impl<'a> Rays<'a> {
    pub(crate) fn new(weld: &'a Weld, count: usize) -> Self {
        /// Building takes about as long as this many walks over all triangles.
        const FEW: usize = 16;
        let boxes = || (0..weld.triangles.len()).map(|t| Aabb::of_points(&weld.corners(t)));
        Self {
            weld,
            bvh: (count > FEW).then(|| Bvh::new(boxes())),
        }
    }

    /// The winding number just in front of a facet.
    pub(crate) fn in_front(&self, facet: &Facet, piece: [VertexId; 3], points: &mut Points) -> i32 {
        let plane = points.plane_of_triangle(facet.triangle as usize, self.weld);
        let plane = points.plane(plane);
        let axis = plane.main_axis();
        let front_is_ahead = plane.normal_sign(axis) == Sign::Positive;
        let center = points.lattice.centroid(piece.map(|v| points.get(v)));
        let mut ahead = 0;
        self.crossings(&center, axis, points, |_, turns| ahead += turns);
        match front_is_ahead {
            true => ahead,
            false => ahead - facet.multiplicity,
        }
    }

    /// For the center of a triangle, how often the ray from it along the main axis leaves each other triangle's component
    /// less how often it enters.
    pub(crate) fn turns(
        &self,
        triangle: usize,
        points: &mut Points,
        visit: impl FnMut(usize, i32),
    ) {
        let plane = points.plane_of_triangle(triangle, self.weld);
        let axis = points.plane(plane).main_axis();
        let corners = self.weld.triangles[triangle].map(|v| points.get(v));
        let center = points.lattice.centroid(corners);
        self.crossings(&center, axis, points, visit);
    }

    /// Visits the triangles that the ray from a point up an axis crosses: 1 where it leaves, −1 where it enters. Triangles
    /// through the point are not crossed.
    fn crossings(
        &self,
        from: &Point,
        axis: usize,
        points: &mut Points,
        mut visit: impl FnMut(usize, i32),
    ) {
        // The rounded point is at most one step away from the point.
        let at = from.rounded();
        let mut tube = Aabb {
            min: DVec3::from_array(at.to_array().map(f64::next_down)),
            max: DVec3::from_array(at.to_array().map(f64::next_up)),
        };
        tube.max[axis] = f64::INFINITY;
        let mut meet = |t: usize| match self.crossing(t, from, axis, points) {
            0 => {}
            turns => visit(t, turns),
        };
        match &self.bvh {
            Some(bvh) => {
                let _ = bvh.overlapping(tube, |t| {
                    meet(t as usize);
                    ControlFlow::Continue(())
                });
            }
            None => (0..self.weld.triangles.len())
                .filter(|&t| Aabb::of_points(&self.weld.corners(t)).overlaps(tube))
                .for_each(meet),
        }
    }

    /// 1 if the ray leaves through the triangle, −1 if it enters, 0 if it misses.
    fn crossing(&self, t: usize, from: &Point, axis: usize, points: &mut Points) -> i32 {
        let plane = points.plane_of_triangle(t, self.weld);
        let normal = points.plane(plane).normal_sign(axis);
        if normal == Sign::Zero {
            return 0;
        }
        let [a, b, c] = self.weld.corners(t);
        let is_inside = [(a, b), (b, c), (c, a)]
            .into_iter()
            .all(|(a, b)| side(a, b, from, axis, points) == normal);
        let side = points.lattice.side(points.plane(plane), from);
        // Ahead, if the normal points up and the point is behind, or the other way round.
        match (is_inside, normal, side) {
            (true, Sign::Positive, Sign::Negative) => 1,
            (true, Sign::Negative, Sign::Positive) => -1,
            _ => 0,
        }
    }
}

/// The side of the line from `a` to `b`, seen against an axis, that the moved point lies on.
fn side(a: DVec3, b: DVec3, p: &Point, axis: usize, points: &Points) -> Sign {
    let sign = (points.lattice).orient2d(axis, &Point::exactly(a), &Point::exactly(b), p);
    let (a, b) = (projected(a, axis), projected(b, axis));
    let order = |less: f64, more: f64| match less.total_cmp(&more) {
        std::cmp::Ordering::Less => Sign::Positive,
        std::cmp::Ordering::Greater => Sign::Negative,
        std::cmp::Ordering::Equal => Sign::Zero,
    };
    // ∂/∂p₁ = a₂ − b₂, ∂/∂p₂ = b₁ − a₁.
    match (sign, order(b.y + 0.0, a.y + 0.0)) {
        (Sign::Zero, Sign::Zero) => order(a.x + 0.0, b.x + 0.0),
        (Sign::Zero, sign) => sign,
        (sign, _) => sign,
    }
}
