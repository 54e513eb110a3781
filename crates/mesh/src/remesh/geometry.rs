//! Whether a change of triangles folds the surface, and how good a triangle is.

use crate::edit::MeshEditor;
use crate::{HalfEdgeId, TriangleId};
use pellicle_geometry::triangle::double_area_normal;
use pellicle_geometry::{DVec3, VertexId};

/// A triangle whose height is below this part of its longest side has no normal worth keeping.
const FLAT: f64 = 1e-3;
/// No change makes a triangle flatter than this, unless it was.
const THIN: f64 = 0.02;
/// The cosine of the greatest turn of a triangle's normal by one change: 60°.
const TURN: f64 = 0.5;
/// The cosine of the greatest turn of the surface across an edge that a change may make: about 100°.
const FOLD: f64 = -0.17;

/// The cosine of the angle between two vectors; 1 where one of them vanishes.
#[inline]
pub(super) fn cosine(u: DVec3, v: DVec3) -> f64 {
    let lengths = (u.length_squared() * v.length_squared()).sqrt();
    if lengths > 0.0 {
        u.dot(v) / lengths
    } else {
        1.0
    }
}

#[inline]
fn longest_squared(a: DVec3, b: DVec3, c: DVec3) -> f64 {
    let (ab, bc) = (a.distance_squared(b), b.distance_squared(c));
    ab.max(bc).max(c.distance_squared(a))
}

/// How far a triangle is within the bounds of 30° and 120°: the lesser of (1 − cos α) / (1 − cos 30°) and
/// (1 + cos γ) / (1 + cos 120°), with α its least and γ its greatest angle. Above 1 if both hold, 3 for the
/// equilateral, 0 without area. Square roots only: the same bits on every machine.
pub(super) fn score([a, b, c]: [DVec3; 3]) -> f64 {
    /// 1 / (1 − cos 30°).
    const SMALL: f64 = 7.464_101_615_137_755;
    /// 1 / (1 + cos 120°).
    const LARGE: f64 = 2.0;
    let [s, t, u] = [
        b.distance_squared(c),
        c.distance_squared(a),
        a.distance_squared(b),
    ];
    if s.min(t).min(u) <= 0.0 {
        return 0.0;
    }
    let [x, y, z] = [
        (t + u - s) / (2.0 * (t * u).sqrt()),
        (u + s - t) / (2.0 * (u * s).sqrt()),
        (s + t - u) / (2.0 * (s * t).sqrt()),
    ];
    let small = (1.0 - x.max(y).max(z)) * SMALL;
    let large = (1.0 + x.min(y).min(z)) * LARGE;
    small.min(large).max(0.0)
}

impl MeshEditor {
    /// The normal of a triangle, as long as twice its area.
    #[inline]
    pub(super) fn normal(&self, t: TriangleId) -> DVec3 {
        let [a, b, c] = self.corners(t);
        double_area_normal(a, b, c)
    }

    /// The sum of the normals of the triangles at a vertex, weighted by area.
    #[inline]
    pub(super) fn vertex_normal(&self, v: VertexId) -> DVec3 {
        self.around(v)
            .fold(DVec3::ZERO, |sum, h| sum + self.normal(h.triangle()))
    }

    /// Whether the triangles at a vertex neither fold nor vanish when it moves; `gone` are left out.
    pub(super) fn may_move(&self, v: VertexId, to: DVec3, gone: &[TriangleId]) -> bool {
        let from = self.at(v);
        let mut average = None;
        self.around(v).all(|h| {
            if gone.contains(&h.triangle()) {
                return true;
            }
            let (x, y) = (
                self.at(self.destination(h)),
                self.at(self.origin(h.previous())),
            );
            let (before, after) = (double_area_normal(from, x, y), double_area_normal(to, x, y));
            let flatness = before.length() / longest_squared(from, x, y).max(f64::MIN_POSITIVE);
            let thinness = after.length() / longest_squared(to, x, y).max(f64::MIN_POSITIVE);
            let reference = if flatness > FLAT {
                before
            } else {
                *average.get_or_insert_with(|| self.vertex_normal(v))
            };
            (thinness >= THIN || thinness >= flatness) && cosine(after, reference) > TURN
        })
    }

    /// Whether the surface stays unfolded across the edges opposite a vertex when it moves.
    pub(super) fn opposite_edges_stay_open(
        &self,
        v: VertexId,
        to: DVec3,
        gone: &[TriangleId],
    ) -> bool {
        self.around(v).all(|h| {
            let Some(beyond) = self.twin_of(h.next()) else {
                return true;
            };
            if gone.contains(&h.triangle()) || gone.contains(&beyond.triangle()) {
                return true;
            }
            let (x, y) = (
                self.at(self.destination(h)),
                self.at(self.origin(h.previous())),
            );
            let outer = self.normal(beyond.triangle());
            let cos = cosine(double_area_normal(to, x, y), outer);
            cos > FOLD || cos >= cosine(double_area_normal(self.at(v), x, y), outer)
        })
    }

    /// The two triangles that a flip would make; `None` on a border.
    pub(super) fn flipped(&self, h: HalfEdgeId) -> Option<[[DVec3; 3]; 2]> {
        let g = self.twin_of(h)?;
        let [a, b, c, d] = [h, g, h.previous(), g.previous()].map(|h| self.at(self.origin(h)));
        Some([[a, d, c], [d, b, c]])
    }

    /// Whether the surface stays unfolded when an edge is flipped.
    ///
    /// The new triangles face as the old ones do together, bend at most 60° between them (or no more than the old
    /// ones), and do not fold onto the four neighbours.
    pub(super) fn flip_stays_open(&self, h: HalfEdgeId) -> bool {
        let (Some(g), Some([upper, lower])) = (self.twin_of(h), self.flipped(h)) else {
            return false;
        };
        let old = [h, g].map(|h| self.normal(h.triangle()));
        let [m, n] = [upper, lower].map(|[a, b, c]| double_area_normal(a, b, c));
        let both = old[0] + old[1];
        // Where the old triangles have no area to speak of, any normal is as good.
        let bend = if self.is_flat(h.triangle()) || self.is_flat(g.triangle()) {
            TURN
        } else {
            cosine(old[0], old[1]).min(TURN)
        };
        let faces = |n: DVec3| n.dot(both) > 0.0 || both == DVec3::ZERO;
        // Both normals nonzero: a flip that makes a triangle without area is none.
        if m == DVec3::ZERO || n == DVec3::ZERO || !faces(m) || !faces(n) || cosine(m, n) < bend {
            return false;
        }
        [
            (h.previous(), m, old[0]),
            (g.next(), m, old[1]),
            (g.previous(), n, old[1]),
            (h.next(), n, old[0]),
        ]
        .into_iter()
        .all(|(side, new, old)| {
            let Some(beyond) = self.twin_of(side) else {
                return true;
            };
            let outer = self.normal(beyond.triangle());
            let cos = cosine(new, outer);
            cos > FOLD || cos >= cosine(old, outer)
        })
    }

    /// Whether a triangle is too flat for its normal to mean anything.
    pub(super) fn is_flat(&self, t: TriangleId) -> bool {
        let [a, b, c] = self.corners(t);
        double_area_normal(a, b, c).length() <= FLAT * longest_squared(a, b, c)
    }

    /// The least score of the triangles at a vertex if it lay elsewhere; `gone` are left out.
    pub(super) fn star_score(&self, v: VertexId, at: DVec3, gone: &[TriangleId]) -> f64 {
        self.around(v)
            .filter(|h| !gone.contains(&h.triangle()))
            .map(|h| {
                let (x, y) = (
                    self.at(self.destination(h)),
                    self.at(self.origin(h.previous())),
                );
                score([at, x, y])
            })
            .fold(f64::INFINITY, f64::min)
    }
}
