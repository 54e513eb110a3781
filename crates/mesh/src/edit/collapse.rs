//! Collapsing an edge.

use super::{MeshEditor, Refusal};
use crate::HalfEdgeId;
use pellicle_geometry::{DVec3, VertexId};

impl MeshEditor {
    /// Draws the two ends of an edge together at `position`; returns the vertex that stays: the one that the
    /// half-edge reaches. Time of the degrees of the vertices around.
    ///
    /// ```text
    ///         c                  c
    ///       / | \                |
    ///    \ /  |  \ /           \ | /
    ///     a ----> b      →       b             a goes, and with it the triangles abc and bad
    ///    / \  |  / \           / | \
    ///       \ | /                |
    ///         d                  d
    /// ```
    ///
    /// Refused where the topology would change: see [`Self::can_collapse`].
    pub fn collapse(
        &mut self,
        half_edge: HalfEdgeId,
        position: DVec3,
    ) -> Result<VertexId, Refusal> {
        if !position.is_finite() {
            return Err(Refusal::NotFinite(position));
        }
        self.can_collapse(half_edge)?;
        let h = half_edge;
        let twin = self.twin_of(h);
        let (a, b) = (self.origin(h), self.destination(h));
        let mut next = Some(self.outgoing[a.index()]);
        let start = next;
        while let Some(leaving) = next {
            self.triangles.as_flattened_mut()[leaving.index()] = b;
            next = self
                .twin_of(leaving.previous())
                .filter(|&n| Some(n) != start);
        }
        self.outgoing[a.index()] = HalfEdgeId::NONE;
        self.positions[b.index()] = position;
        self.close_triangle(h);
        if let Some(g) = twin {
            self.close_triangle(g);
        }
        Ok(b)
    }

    /// Whether [`Self::collapse`] would succeed: the link condition (Dey et al. 1999), with every border closed
    /// by a vertex at infinity.
    ///
    /// The ends have no common neighbour but the apices of the edge's triangles; they do not lie on a border both
    /// unless their edge does; and the triangles are not a whole tetrahedron or a lone triangle.
    pub fn can_collapse(&mut self, half_edge: HalfEdgeId) -> Result<(), Refusal> {
        self.check_half_edge(half_edge)?;
        let h = half_edge;
        let twin = self.twin_of(h);
        let refused = Err(Refusal::Link(h));
        let (a, b) = (self.origin(h), self.destination(h));
        match twin {
            Some(_) if self.is_border_vertex(a) && self.is_border_vertex(b) => return refused,
            None if self.twin_of(h.next()).is_none() && self.twin_of(h.previous()).is_none() => {
                return refused;
            }
            _ => {}
        }
        let apices = 1 + usize::from(twin.is_some());
        let (common, degrees) = self.common_neighbors(a, b);
        let tetrahedron =
            degrees == [3, 3] && !self.is_border_vertex(a) && !self.is_border_vertex(b);
        match common == apices && !tetrahedron {
            true => Ok(()),
            false => refused,
        }
    }

    /// How many vertices share edges with both, and how many with each.
    fn common_neighbors(&mut self, a: VertexId, b: VertexId) -> (usize, [usize; 2]) {
        if self.epoch == u32::MAX {
            self.marks.fill(0);
            self.epoch = 0;
        }
        self.epoch += 1;
        let epoch = self.epoch;
        // Taken out, so that the connectivity can be walked meanwhile.
        let mut marks = std::mem::take(&mut self.marks);
        let mut degrees = [0, 0];
        for n in self.neighbors(a) {
            marks[n.index()] = epoch;
            degrees[0] += 1;
        }
        let mut common = 0;
        for n in self.neighbors(b) {
            common += usize::from(marks[n.index()] == epoch);
            degrees[1] += 1;
        }
        self.marks = marks;
        (common, degrees)
    }

    /// Removes the triangle of a half-edge whose ends have become one vertex b, and glues its other two sides.
    fn close_triangle(&mut self, h: HalfEdgeId) {
        let c = self.origin(h.previous());
        let (bc, ca) = (self.side(h.next()), self.side(h.previous()));
        self.remove_triangle(h.triangle());
        // bc.0 runs c → b and ca.0 runs b → c.
        self.join(bc.0, ca.0, bc.1 || ca.1);
        // One of them exists: c has another triangle.
        let (from_c, from_b) = match (bc.0.some(), ca.0.some()) {
            (Some(cb), _) => (cb, cb.next()),
            (None, Some(bc)) => (bc.next(), bc),
            (None, None) => return,
        };
        debug_assert_eq!(self.origin(from_c), c);
        self.set_outgoing(from_c);
        self.set_outgoing(from_b);
    }
}
