//! Mending the worst triangles one by one.

use super::geometry::score;
use super::{Kind, State};
use crate::{HalfEdgeId, TriangleId};
use pellicle_geometry::{DVec3, VertexId};

/// Triangles below this score are worked at: about 33° and 114°.
const POOR: f64 = 1.2;
/// A change must raise the least score around it by this much.
const GAIN: f64 = 1e-3;
const PASSES: usize = 10;
/// How far vertices are moved to try, as parts of the mean distance to their neighbours.
const STEPS: [f64; 3] = [0.3, 0.12, 0.04];
/// Directions tried around a vertex: eight in a circle.
const DIRECTIONS: [[f64; 2]; 8] = {
    use std::f64::consts::FRAC_1_SQRT_2 as R;
    [
        [1.0, 0.0],
        [R, R],
        [0.0, 1.0],
        [-R, R],
        [-1.0, 0.0],
        [-R, -R],
        [0.0, -1.0],
        [R, -R],
    ]
};

/// What may be done about a bad triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Freedom {
    /// Flip edges, move vertices, collapse edges.
    All,
    /// Flip edges and move vertices.
    KeepVertices,
}

impl State {
    /// Works at the poor triangles, the worst first, until nothing helps.
    pub(super) fn polish(&mut self, freedom: Freedom) {
        for _ in 0..PASSES {
            let mut poor: Vec<(f64, TriangleId)> = (0..self.editor.triangles.len())
                .map(TriangleId::new)
                .filter(|&t| self.editor.exists(HalfEdgeId::of(t, 0)))
                .map(|t| (score(self.editor.corners(t)), t))
                .filter(|&(score, _)| score < POOR)
                .collect();
            poor.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            let mut changed = false;
            for (_, t) in poor {
                changed |= self.mend(t, freedom);
            }
            if !changed {
                break;
            }
        }
        self.compact();
    }

    fn mend(&mut self, t: TriangleId, freedom: Freedom) -> bool {
        let sides = [0, 1, 2].map(|i| HalfEdgeId::of(t, i));
        if !self.editor.exists(sides[0]) || score(self.editor.corners(t)) >= POOR {
            return false;
        }
        if sides
            .iter()
            .any(|&h| self.flip(h, |old, new| new > old + GAIN))
        {
            return true;
        }
        let mut changed = false;
        for v in self.editor.triangles[t.index()] {
            changed |= self.nudge(v);
        }
        let now = score(self.editor.corners(t));
        if freedom == Freedom::All && now < 1.0 {
            let collapsed = sides
                .iter()
                .any(|&h| self.collapse(h, |state, h, to| state.collapse_gains(h, to)));
            changed |= collapsed;
        }
        changed
    }

    /// Whether a collapse leaves the triangles around both ends better than they are.
    fn collapse_gains(&self, h: HalfEdgeId, to: DVec3) -> bool {
        let ends = [self.editor.origin(h), self.editor.destination(h)];
        let gone = self.triangles_of(h);
        let least =
            |of: &dyn Fn(VertexId) -> f64| ends.map(of).into_iter().fold(f64::INFINITY, f64::min);
        let before = least(&|v| self.editor.star_score(v, self.editor.at(v), &[]));
        let after = least(&|v| self.editor.star_score(v, to, &gone));
        after > before + GAIN
    }

    /// Moves a vertex to the best of a few places around it, if that raises the least score of its triangles.
    fn nudge(&mut self, v: VertexId) -> bool {
        let from = self.editor.at(v);
        let before = self.editor.star_score(v, from, &[]);
        let mut best = (before + GAIN, None);
        let mut try_place = |place: DVec3| {
            let after = self.editor.star_score(v, place, &[]);
            if after > best.0 {
                best = (after, Some(place));
            }
        };
        match self.kind(v) {
            Kind::Corner => {}
            Kind::Free => {
                let Some(normal) = self.editor.vertex_normal(v).try_normalize() else {
                    return false;
                };
                let (x, y) = normal.any_orthonormal_pair();
                let reach = self.reach(v);
                for step in STEPS {
                    for [right, up] in DIRECTIONS {
                        try_place(from + (x * right + y * up) * (step * reach));
                    }
                }
            }
            Kind::Border | Kind::Crease => {
                let Some(neighbors) = self.curve_around(v) else {
                    return false;
                };
                for step in STEPS {
                    for at in neighbors {
                        try_place(from + (at - from) * step);
                    }
                }
            }
        }
        let (_, Some(place)) = best else {
            return false;
        };
        let Some((to, length)) = self.projected(v, place) else {
            return false;
        };
        let gains = self.editor.star_score(v, to, &[]) > before + GAIN;
        if gains && self.editor.may_move(v, to, &[]) {
            self.editor.positions[v.index()] = to;
            self.lengths[v.index()] = length;
            return true;
        }
        false
    }

    /// A place near a vertex on what it may not leave.
    fn projected(&self, v: VertexId, place: DVec3) -> Option<(DVec3, f64)> {
        match self.kind(v) {
            Kind::Free => self.on_surface(v, place, self.editor.vertex_normal(v)),
            Kind::Border | Kind::Crease => {
                let [a, b] = self.curve_around(v)?;
                self.on_curve(v, place, 0.5 * a.distance(b))
            }
            Kind::Corner => None,
        }
    }

    /// The mean distance to the neighbours.
    fn reach(&self, v: VertexId) -> f64 {
        let from = self.editor.at(v);
        let distances = self
            .editor
            .neighbors(v)
            .map(|n| self.editor.at(n).distance(from));
        let (sum, count) = distances.fold((0.0, 0_usize), |(sum, count), d| (sum + d, count + 1));
        sum / count as f64
    }
}
