//! The steps that change connectivity: split, collapse, flip.

use super::geometry::score;
use super::{Kind, State};
use crate::{HalfEdgeId, MeshError, Refusal, TriangleId};
use pellicle_geometry::{DVec3, VertexId};

/// Edges longer than this part of the wanted length are split, and none longer is made by a collapse.
const LONG: f64 = 4.0 / 3.0;
/// Edges shorter than this part of the wanted length are collapsed.
const SHORT: f64 = 4.0 / 5.0;
/// Edges shorter than this part are collapsed whatever lengths that makes.
const TINY: f64 = 0.1;
/// Edges shorter than these parts of the wanted and of the mean length are needles.
const NEEDLE: [f64; 2] = [0.02, 0.05];
/// Repetitions of each step within one round; a split halves, so that 64 are enough for any number.
const SPLIT_PASSES: usize = 64;
const COLLAPSE_PASSES: usize = 3;
const FLIP_PASSES: usize = 4;

/// How a split or collapse ends.
type Outcome = Result<(), MeshError>;

impl State {
    /// The length of an edge over the length wanted there: the lesser of those at its ends.
    pub(super) fn relative_length(&self, h: HalfEdgeId) -> f64 {
        let (a, b) = (self.editor.origin(h), self.editor.destination(h));
        self.relative_distance(a, b, self.editor.at(a), self.editor.at(b))
    }

    fn relative_distance(&self, a: VertexId, b: VertexId, at_a: DVec3, at_b: DVec3) -> f64 {
        at_a.distance(at_b) / self.lengths[a.index()].min(self.lengths[b.index()])
    }

    /// Splits long edges, the longest first, until there is none.
    pub(super) fn split_long(&mut self) -> Outcome {
        for _ in 0..SPLIT_PASSES {
            let mut long = self.edges_where(|length| length > LONG);
            if long.is_empty() {
                break;
            }
            long.sort_unstable_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
            for (_, h) in long {
                // A split nearby may have given the id to another edge.
                if self.relative_length(h) > LONG {
                    self.split(h)?;
                }
            }
        }
        Ok(())
    }

    fn edges_where(&self, wanted: impl Fn(f64) -> bool) -> Vec<(f64, HalfEdgeId)> {
        self.editor
            .edges()
            .map(|h| (self.relative_length(h), h))
            .filter(|&(length, _)| wanted(length))
            .collect()
    }

    /// Puts a vertex in the middle of an edge, on the curve if the edge belongs to one.
    pub(super) fn split(&mut self, h: HalfEdgeId) -> Outcome {
        let (a, b) = (self.editor.origin(h), self.editor.destination(h));
        let kind = match (self.is_crease(h), self.editor.twin_of(h)) {
            (false, _) => Kind::Free,
            (true, None) => Kind::Border,
            (true, Some(_)) => Kind::Crease,
        };
        let middle = self.editor.at(a) * 0.5 + self.editor.at(b) * 0.5;
        let m = match self.editor.split(h, middle) {
            Ok(m) => m,
            Err(Refusal::TooLarge) => {
                return Err(MeshError::TooLarge {
                    vertices: self.editor.positions.len() + 1,
                    triangles: self.editor.triangles.len() + 2,
                });
            }
            Err(refusal) => return Err(refusal.into()),
        };
        self.kinds.push(kind);
        self.lengths
            .push(0.5 * self.lengths[a.index()] + 0.5 * self.lengths[b.index()]);
        self.report.splits += 1;
        let reach = 0.5 * self.editor.at(a).distance(self.editor.at(b));
        if kind != Kind::Free
            && let Some((foot, _)) = self.on_curve(m, middle, reach)
            && self.editor.may_move(m, foot, &[])
        {
            self.editor.positions[m.index()] = foot;
        }
        Ok(())
    }

    /// Collapses short edges, the shortest first.
    pub(super) fn collapse_short(&mut self) {
        for _ in 0..COLLAPSE_PASSES {
            if self.collapse_below(|length| length < SHORT) == 0 {
                break;
            }
        }
    }

    fn collapse_below(&mut self, wanted: impl Fn(f64) -> bool) -> usize {
        let mut short = self.edges_where(&wanted);
        short.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let mut done = 0;
        for (_, h) in short {
            if self.editor.exists(h) && wanted(self.relative_length(h)) {
                done += usize::from(self.collapse(h, |_, _, _| true));
            }
        }
        done
    }

    /// Collapses an edge to the best of its ends and middle that neither folds the surface nor makes long edges, and
    /// that `allows` (the half-edge, the position, the triangles that go).
    pub(super) fn collapse(
        &mut self,
        h: HalfEdgeId,
        allows: impl Fn(&Self, HalfEdgeId, DVec3) -> bool,
    ) -> bool {
        let Some(h) = self.collapse_direction(h) else {
            return false;
        };
        if self.editor.can_collapse(h).is_err() {
            return false;
        }
        let (a, b) = (self.editor.origin(h), self.editor.destination(h));
        let (at_a, at_b) = (self.editor.at(a), self.editor.at(b));
        let middle = at_a * 0.5 + at_b * 0.5;
        let both_alike = self.kind(a) == self.kind(b);
        let middle = match self.kind(b) {
            Kind::Border | Kind::Crease if both_alike => self
                .on_curve(b, middle, 0.5 * at_a.distance(at_b))
                .map_or(at_b, |(foot, _)| foot),
            _ => middle,
        };
        let candidates: &[DVec3] = match both_alike {
            true => &[middle, at_b, at_a],
            false => &[at_b],
        };
        let found = candidates
            .iter()
            .find(|&&p| self.collapse_is_sound(h, p) && allows(self, h, p));
        let Some(&position) = found else {
            return false;
        };
        let length = 0.5 * self.lengths[a.index()] + 0.5 * self.lengths[b.index()];
        let done = self.editor.collapse(h, position).is_ok();
        if done {
            if both_alike {
                self.lengths[b.index()] = length;
            }
            self.report.collapses += 1;
        }
        done
    }

    /// The half-edge of the edge whose origin may go; `None` if neither may.
    fn collapse_direction(&self, h: HalfEdgeId) -> Option<HalfEdgeId> {
        let crease = self.is_crease(h);
        let may_go = |v: VertexId, to: VertexId| match (self.kind(v), self.kind(to)) {
            (Kind::Free, _) => true,
            (Kind::Corner, _) => false,
            (Kind::Border | Kind::Crease, _) => crease,
        };
        let (a, b) = (self.editor.origin(h), self.editor.destination(h));
        // Two curves that meet in the apex of a triangle of the edge would become one.
        let merges = |h: HalfEdgeId| self.is_crease(h.next()) && self.is_crease(h.previous());
        if crease && (merges(h) || self.editor.twin_of(h).is_some_and(merges)) {
            return None;
        }
        // A free vertex goes before one on a curve.
        if may_go(a, b) && (self.kind(a) == Kind::Free || self.kind(b) != Kind::Free) {
            Some(h)
        } else if may_go(b, a) {
            // Along a border there is no other half-edge; a corner there stays, and the vertex before it too.
            self.editor.twin_of(h)
        } else {
            None
        }
    }

    fn collapse_is_sound(&self, h: HalfEdgeId, to: DVec3) -> bool {
        let (a, b) = (self.editor.origin(h), self.editor.destination(h));
        let gone = self.triangles_of(h);
        let longest = if self.relative_length(h) < TINY {
            f64::INFINITY
        } else {
            LONG
        };
        let short_enough = |v: VertexId, other: VertexId| {
            let from = self.editor.at(v);
            self.editor.neighbors(v).all(|n| {
                let at = self.editor.at(n);
                let length = self.relative_distance(b, n, to, at);
                n == other || length <= longest || length <= self.relative_distance(v, n, from, at)
            })
        };
        short_enough(a, b)
            && short_enough(b, a)
            && [a, b].iter().all(|&v| {
                self.editor.may_move(v, to, &gone)
                    && self.editor.opposite_edges_stay_open(v, to, &gone)
            })
    }

    /// The triangles at an edge: twice the same on a border.
    pub(super) fn triangles_of(&self, h: HalfEdgeId) -> [TriangleId; 2] {
        let twin = self.editor.twin_of(h).unwrap_or(h);
        [h.triangle(), twin.triangle()]
    }

    /// Flips edges where that brings the valences of the four vertices nearer to six, or four on a border.
    pub(super) fn equalize_valences(&mut self) {
        let valence = |v| self.editor.neighbors(v).count() as i64;
        let mut excess: Vec<i64> = (0..self.kinds.len())
            .map(VertexId::new)
            .map(|v| {
                valence(v)
                    - if self.editor.is_border_vertex(v) {
                        4
                    } else {
                        6
                    }
            })
            .collect();
        for _ in 0..FLIP_PASSES {
            let mut changed = false;
            for h in 0..self.editor.twins.len() {
                let h = HalfEdgeId::new(h);
                let Some(g) = self.editor.twin_of(h).filter(|&g| h < g) else {
                    continue;
                };
                let [a, b, c, d] =
                    [h, g, h.previous(), g.previous()].map(|h| self.editor.origin(h).index());
                // (x ∓ 1)² − x² for each.
                let gain = excess[a] + excess[b] - excess[c] - excess[d] - 2;
                if gain > 0 && self.flip(h, |old, new| new > old.min(0.5)) {
                    excess[a] -= 1;
                    excess[b] -= 1;
                    excess[c] += 1;
                    excess[d] += 1;
                    changed = true;
                }
            }
            if !changed {
                break;
            }
        }
    }

    /// Flips edges where that makes the worse of the two triangles better.
    pub(super) fn enlarge_angles(&mut self) {
        for _ in 0..FLIP_PASSES {
            let mut changed = false;
            for h in 0..self.editor.twins.len() {
                let h = HalfEdgeId::new(h);
                if self.editor.twin_of(h).is_some_and(|g| h < g) {
                    changed |= self.flip(h, |old, new| new > old + 1e-9);
                }
            }
            if !changed {
                break;
            }
        }
    }

    /// Flips an edge that is no crease if the surface stays unfolded and `allows` the least scores of the two
    /// triangles before and after.
    pub(super) fn flip(&mut self, h: HalfEdgeId, allows: impl Fn(f64, f64) -> bool) -> bool {
        if self.is_crease(h) {
            return false;
        }
        let Some([upper, lower]) = self.editor.flipped(h) else {
            return false;
        };
        let [s, t] = self.triangles_of(h).map(|t| score(self.editor.corners(t)));
        let done = allows(s.min(t), score(upper).min(score(lower)))
            && self.editor.flip_stays_open(h)
            && self.editor.flip(h).is_ok();
        self.report.flips += usize::from(done);
        done
    }

    /// Collapses edges that are tiny beside the lengths wanted and given, and flips the caps of flat triangles, before
    /// creases are looked for: the normals of such triangles mean nothing.
    pub(super) fn drop_needles(&mut self) {
        let (mut sum, mut count) = (0.0, 0_usize);
        for h in self.editor.edges() {
            sum += self.relative_length(h);
            count += 1;
        }
        let limit = NEEDLE[0].min(NEEDLE[1] * sum / count.max(1) as f64);
        while self.collapse_below(|length| length < limit) > 0 {}
        self.compact();
        let flat: Vec<TriangleId> = (0..self.editor.triangles.len())
            .map(TriangleId::new)
            .filter(|&t| score(self.editor.corners(t)) < 0.05)
            .collect();
        for t in flat {
            for corner in 0..3 {
                self.flip(HalfEdgeId::of(t, corner), |old, new| new > 2.0 * old);
            }
        }
    }
}
