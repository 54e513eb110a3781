//! Moving vertices along the surface.

use super::geometry::cosine;
use super::{Kind, State, curve_neighbors};
use pellicle_geometry::triangle::double_area_normal;
use pellicle_geometry::{DVec3, VertexId};
use rayon::prelude::*;

/// A place for a vertex, and the edge length wanted there.
type Place = (DVec3, f64);

impl State {
    /// Moves each vertex towards the middle of its triangles, within the surface or along its curve, wherever that
    /// folds nothing.
    pub(super) fn relax(&mut self) {
        // All places from the positions before, so that threads do not matter; then one after the other.
        let places: Vec<Option<Place>> = (0..self.kinds.len())
            .into_par_iter()
            .map(|v| self.relaxed(VertexId::new(v)))
            .collect();
        for (v, place) in places.into_iter().enumerate() {
            if let Some(place) = place {
                self.move_towards(VertexId::new(v), place);
            }
        }
    }

    /// Moves a vertex, or half the way, or not at all.
    fn move_towards(&mut self, v: VertexId, (to, length): Place) {
        let from = self.editor.at(v);
        for part in [1.0, 0.5] {
            let position = from + (to - from) * part;
            if self.editor.may_move(v, position, &[]) {
                self.editor.positions[v.index()] = position;
                self.lengths[v.index()] += (length - self.lengths[v.index()]) * part;
                return;
            }
        }
        self.report.refused_moves += 1;
    }

    fn relaxed(&self, v: VertexId) -> Option<Place> {
        match self.kind(v) {
            Kind::Free => {
                let normal = self.editor.vertex_normal(v).try_normalize()?;
                let from = self.editor.at(v);
                let move_by = self.middle_of_triangles(v)? - from;
                self.on_surface(v, from + move_by - normal * normal.dot(move_by), normal)
            }
            Kind::Border | Kind::Crease => {
                let [a, b] = self.curve_around(v)?;
                self.on_curve(v, a * 0.5 + b * 0.5, 0.5 * a.distance(b))
            }
            Kind::Corner => None,
        }
    }

    /// The places of the two neighbours along the curve of a vertex; `None` where the curve now turns by more than 60°:
    /// the middle of the neighbours may then be nearer to another part of it.
    pub(super) fn curve_around(&self, v: VertexId) -> Option<[DVec3; 2]> {
        let [a, b] = curve_neighbors(&self.editor, v)?.map(|n| self.editor.at(n));
        let p = self.editor.at(v);
        (cosine(p - a, b - p) >= 0.5).then_some([a, b])
    }

    /// The point of the curve of a vertex nearest to a place, unless that is most of `reach` away: another curve then.
    pub(super) fn on_curve(&self, v: VertexId, place: DVec3, reach: f64) -> Option<Place> {
        let foot = self.curves.closest(place, self.kind(v) == Kind::Border)?;
        (foot.distance(place) <= 0.6 * reach).then_some((foot, self.lengths[v.index()]))
    }

    /// A place near a free vertex, projected if vertices are.
    pub(super) fn on_surface(&self, v: VertexId, place: DVec3, normal: DVec3) -> Option<Place> {
        let length = self.lengths[v.index()];
        match &self.surface {
            Some(surface) => surface.closest(place, normal, length),
            None => Some((place, length)),
        }
    }

    /// The mean of the middles of the triangles at a vertex, weighted by area over wanted area: with the wanted
    /// lengths, Σ |t| m / L² over Σ |t| / L² (after Dunyach et al. 2013, who weight by L).
    pub(super) fn middle_of_triangles(&self, v: VertexId) -> Option<DVec3> {
        let (mut sum, mut weights) = (DVec3::ZERO, 0.0);
        let p = self.editor.at(v);
        for h in self.editor.around(v) {
            let [x, y] = [self.editor.destination(h), self.editor.origin(h.previous())];
            let wanted = [v, x, y].map(|v| self.lengths[v.index()]);
            let length = (wanted[0] + wanted[1] + wanted[2]) / 3.0;
            let (x, y) = (self.editor.at(x), self.editor.at(y));
            let weight = double_area_normal(p, x, y).length() / (length * length);
            // Relative to the vertex, so that nothing cancels far from the origin.
            sum += ((x - p) + (y - p)) * (weight / 3.0);
            weights += weight;
        }
        (weights > 0.0).then(|| p + sum / weights)
    }
}
