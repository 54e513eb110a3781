//! Splitting an edge.

use super::{MeshEditor, Refusal};
use crate::HalfEdgeId;
use pellicle_geometry::{DVec3, VertexId};

impl MeshEditor {
    /// Puts a new vertex on an edge, and with it one new triangle at each side. Constant time but for the
    /// degrees of the vertices around.
    ///
    /// ```text
    ///        c                    c
    ///       / \                 / | \
    ///      /   \               /  |  \
    ///     a --> b     →       a -→m-- b        the half-edge a → b becomes a → m;
    ///      \   /               \  |  /         m is the new vertex, returned
    ///       \ /                 \ | /
    ///        d                    d
    /// ```
    pub fn split(&mut self, half_edge: HalfEdgeId, position: DVec3) -> Result<VertexId, Refusal> {
        self.check_half_edge(half_edge)?;
        if !position.is_finite() {
            return Err(Refusal::NotFinite(position));
        }
        if self.positions.len() + 2 > u32::MAX as usize
            || self.triangles.len() + 3 > u32::MAX as usize / 3
        {
            return Err(Refusal::TooLarge);
        }
        let h = half_edge;
        let (twin, crease) = self.side(h);
        let m = self.push_vertex(position);
        let upper = self.split_side(h, m);
        match twin.some() {
            // Along a border only the half-edges of the upper side exist.
            None => self.join(upper, HalfEdgeId::NONE, crease),
            Some(g) => {
                // g becomes b → m and its new neighbour m → a; h becomes a → m, and `upper` m → b.
                let lower = self.split_side(g, m);
                self.join(h, lower, crease);
                self.join(upper, g, crease);
            }
        }
        // The ends' half-edges may have become others: a → d and b → c lie in new triangles now.
        for leaving in [upper, upper.next(), h] {
            self.set_outgoing(leaving);
        }
        Ok(m)
    }

    /// Splits the triangle of a half-edge a → b with apex c: it becomes (a, m, c), and a new one is (m, b, c).
    /// Returns the half-edge m → b of the new one; its twin is left to the caller.
    fn split_side(&mut self, h: HalfEdgeId, m: VertexId) -> HalfEdgeId {
        let (b, c) = (self.destination(h), self.origin(h.previous()));
        let (beyond, crease) = self.side(h.next());
        let new = HalfEdgeId::of(self.push_triangle([m, b, c]), 0);
        self.triangles.as_flattened_mut()[h.next().index()] = m;
        self.join(new.next(), beyond, crease);
        self.join(h.next(), new.previous(), false);
        new
    }
}
