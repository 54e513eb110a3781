//! Which edges are curves to keep, and what their vertices may do.

use super::geometry::cosine;
use super::{Kind, RemeshOptions, State, curve_neighbors};
use crate::HalfEdgeId;
use pellicle_geometry::VertexId;

impl State {
    /// Marks borders and sharp edges as creases, and gives each vertex its kind.
    pub(super) fn mark_creases(&mut self, options: &RemeshOptions) {
        for h in 0..self.editor.twins.len() {
            self.editor.creases[h] = self.is_sharp(HalfEdgeId::new(h), options.crease_angle);
        }
        self.unmark_lone_creases();
        for v in 0..self.kinds.len() {
            self.kinds[v] = self.kind_of(VertexId::new(v), options.corner_angle);
        }
    }

    /// Whether a half-edge lies on a border, or the surface turns across it by more than an angle. Triangles
    /// without area to speak of have no normal to turn.
    fn is_sharp(&self, h: HalfEdgeId, angle: Option<f64>) -> bool {
        let Some(twin) = self.editor.twin_of(h) else {
            return true;
        };
        let (s, t) = (h.triangle(), twin.triangle());
        angle.is_some_and(|angle| {
            !self.editor.is_flat(s)
                && !self.editor.is_flat(t)
                && cosine(self.editor.normal(s), self.editor.normal(t)) < angle.cos()
        })
    }

    /// A sharp edge that no other continues is a dent, not a crease.
    fn unmark_lone_creases(&mut self) {
        let degree = |state: &Self, v: VertexId| {
            let creases = state.editor.around(v).filter(|&h| state.is_crease(h));
            creases.count() + usize::from(state.editor.is_border_vertex(v))
        };
        let lone: Vec<HalfEdgeId> = self
            .editor
            .edges()
            .filter(|&h| {
                let ends = [self.editor.origin(h), self.editor.destination(h)];
                self.is_crease(h) && ends.iter().all(|&v| degree(self, v) == 1)
            })
            .collect();
        for h in lone {
            self.editor.creases[h.index()] = false;
            if let Some(twin) = self.editor.twin_of(h) {
                self.editor.creases[twin.index()] = false;
            }
        }
    }

    fn kind_of(&self, v: VertexId, corner_angle: f64) -> Kind {
        let border = self.editor.is_border_vertex(v);
        let marked = self.editor.around(v).any(|h| self.is_crease(h));
        if !border && !marked {
            return Kind::Free;
        }
        let Some([a, b]) = curve_neighbors(&self.editor, v) else {
            return Kind::Corner;
        };
        let p = self.editor.at(v);
        match cosine(p - self.editor.at(a), self.editor.at(b) - p) < corner_angle.cos() {
            true => Kind::Corner,
            false if border => Kind::Border,
            false => Kind::Crease,
        }
    }
}
