//! Flipping an edge.

use super::{MeshEditor, Refusal};
use crate::HalfEdgeId;

impl MeshEditor {
    /// Turns an edge inside the quadrilateral of its two triangles. Refused on a border, and where the other
    /// diagonal exists already. Time of the degrees of the vertices around.
    ///
    /// ```text
    ///        c                    c
    ///       / \                  /^\
    ///      /   \                / | \
    ///     a --> b     →        a  |  b        the half-edge a → b becomes d → c
    ///      \   /                \ | /
    ///       \ /                  \|/
    ///        d                    d
    /// ```
    pub fn flip(&mut self, half_edge: HalfEdgeId) -> Result<(), Refusal> {
        self.can_flip(half_edge)?;
        let h = half_edge;
        let Some(g) = self.twin_of(h) else {
            return Err(Refusal::Border(h));
        };
        let (a, b) = (self.origin(h), self.destination(h));
        let (c, d) = (self.origin(h.previous()), self.origin(g.previous()));
        let [bc, ca] = [h.next(), h.previous()].map(|side| self.side(side));
        let [ad, db] = [g.next(), g.previous()].map(|side| self.side(side));
        // h: d → c, then c → a, a → d; and g: c → d, then d → b, b → c.
        for (half_edge, origin) in [
            (h, d),
            (h.next(), c),
            (h.previous(), a),
            (g, c),
            (g.next(), d),
            (g.previous(), b),
        ] {
            self.triangles.as_flattened_mut()[half_edge.index()] = origin;
        }
        self.join(h, g, false);
        self.join(h.next(), ca.0, ca.1);
        self.join(h.previous(), ad.0, ad.1);
        self.join(g.next(), db.0, db.1);
        self.join(g.previous(), bc.0, bc.1);
        for leaving in [h.next(), h.previous(), g.next(), g.previous()] {
            self.set_outgoing(leaving);
        }
        Ok(())
    }

    /// Whether [`Self::flip`] would succeed.
    pub fn can_flip(&self, half_edge: HalfEdgeId) -> Result<(), Refusal> {
        self.check_half_edge(half_edge)?;
        let Some(twin) = self.twin_of(half_edge) else {
            return Err(Refusal::Border(half_edge));
        };
        let (c, d) = (
            self.origin(half_edge.previous()),
            self.origin(twin.previous()),
        );
        match self.neighbors(c).any(|n| n == d) {
            true => Err(Refusal::EdgeExists(c, d)),
            false => Ok(()),
        }
    }
}
