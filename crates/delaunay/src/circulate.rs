//! Turning around a vertex and around an edge.

use crate::{FacetId, TetId, Tetrahedralization, id::FACET_CORNERS};
use pellicle_geometry::VertexId;

impl Tetrahedralization<'_> {
    /// The tetrahedra around an edge, infinite ones included, counter-clockwise seen from `to` looking at
    /// `from`; starts with `tet`.
    ///
    /// Each item is a tetrahedron and the facet through which the circulator leaves it. `None` where `tet`
    /// does not hold both vertices.
    ///
    /// ```
    /// # use pellicle_delaunay::{Options, tetrahedralize, TetId};
    /// # use pellicle_geometry::{DVec3, VertexId};
    /// let points = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    /// let tetrahedralization = tetrahedralize(&points, &Options::default())?;
    /// let around = tetrahedralization.around_edge(TetId(0), VertexId(0), VertexId(1)).unwrap();
    /// assert_eq!(around.count(), 3); // the tetrahedron and two infinite ones
    /// # Ok::<(), pellicle_delaunay::Error>(())
    /// ```
    pub fn around_edge(&self, tet: TetId, from: VertexId, to: VertexId) -> Option<AroundEdge<'_>> {
        let corners = (self.corner_of(tet, from)?, self.corner_of(tet, to)?);
        (corners.0 != corners.1).then_some(AroundEdge {
            tetrahedralization: self,
            from,
            to,
            start: tet,
            next: Some(tet),
        })
    }

    /// All tetrahedra at a vertex, infinite ones included, each once, in an order that is fixed but has no
    /// meaning. Time and memory are linear in their number. Empty for the vertex at infinity.
    pub fn around_vertex(&self, vertex: VertexId) -> AroundVertex<'_> {
        let stack: Vec<TetId> = self.incident(vertex).into_iter().collect();
        AroundVertex {
            tetrahedralization: self,
            vertex: self.representative(vertex),
            seen: stack.iter().copied().collect(),
            stack,
        }
    }

    /// The facet of `tet` through which one leaves it when turning counter-clockwise around the edge.
    fn way_out(&self, tet: TetId, from: VertexId, to: VertexId) -> Option<FacetId> {
        let (i, j) = (self.corner_of(tet, from)?, self.corner_of(tet, to)?);
        // With (from, to, x, y) positive, seen from `to` the turn runs from x to y, out through the facet
        // opposite x:
        //
        //        y
        //       / \          the edge stands upright at o, `to` up
        //      o---x
        let [x, _] = others(i, j)?;
        Some(FacetId::of(tet, x))
    }
}

/// The two corners besides i and j, ordered such that (i, j, x, y) is an even permutation.
#[inline]
pub(crate) fn others(i: usize, j: usize) -> Option<[usize; 2]> {
    let facet = FACET_CORNERS[i]; // counter-clockwise seen from i: (facet, i) is even
    let place = facet.iter().position(|&corner| corner == j)?;
    let (next, last) = (facet[(place + 1) % 3], facet[(place + 2) % 3]);
    // (j, next, last, i) is even; so is (i, j, last, next): two transpositions and a three-cycle.
    Some([last, next])
}

/// See [`Tetrahedralization::around_edge`].
#[derive(Clone, Debug)]
pub struct AroundEdge<'a> {
    tetrahedralization: &'a Tetrahedralization<'a>,
    from: VertexId,
    to: VertexId,
    start: TetId,
    next: Option<TetId>,
}

impl Iterator for AroundEdge<'_> {
    type Item = (TetId, FacetId);

    fn next(&mut self) -> Option<Self::Item> {
        let tet = self.next?;
        let out = self.tetrahedralization.way_out(tet, self.from, self.to)?;
        let neighbor = self.tetrahedralization.twin(out).tet();
        self.next = (neighbor != self.start).then_some(neighbor);
        Some((tet, out))
    }
}

/// See [`Tetrahedralization::around_vertex`].
#[derive(Clone, Debug)]
pub struct AroundVertex<'a> {
    tetrahedralization: &'a Tetrahedralization<'a>,
    vertex: VertexId,
    stack: Vec<TetId>,
    seen: std::collections::BTreeSet<TetId>,
}

impl Iterator for AroundVertex<'_> {
    type Item = TetId;

    fn next(&mut self) -> Option<TetId> {
        let tet = self.stack.pop()?;
        let own = self.tetrahedralization.corner_of(tet, self.vertex);
        for corner in (0..4).filter(|&corner| Some(corner) != own) {
            let neighbor = self.tetrahedralization.twin(FacetId::of(tet, corner)).tet();
            if self.seen.insert(neighbor) {
                self.stack.push(neighbor);
            }
        }
        Some(tet)
    }
}
