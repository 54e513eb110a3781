//! Turning around a vertex and around an edge.

use crate::{FacetId, TetId, Tetrahedralization, connectivity::Connectivity, id::FACET_CORNERS};
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
        AroundEdge::new(self, tet, from, to)
    }

    /// All tetrahedra at a vertex, infinite ones included, each once, in an order that is fixed but has no
    /// meaning. Time and memory are linear in their number. Empty for the vertex at infinity.
    pub fn around_vertex(&self, vertex: VertexId) -> AroundVertex<'_> {
        AroundVertex::new(self, self.representative(vertex))
    }

    /// The vertices that share an edge with this one, by id, the vertex at infinity excepted; those of the
    /// representative for a duplicate. O(d log d) for d of them.
    ///
    /// ```
    /// # use pellicle_delaunay::{Options, tetrahedralize};
    /// # use pellicle_geometry::{DVec3, VertexId};
    /// let points = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z, -DVec3::Z];
    /// let tetrahedralization = tetrahedralize(&points, &Options::default())?;
    /// let top = tetrahedralization.neighbors(VertexId(3));
    /// assert_eq!(top, [VertexId(0), VertexId(1), VertexId(2)]);
    /// # Ok::<(), pellicle_delaunay::Error>(())
    /// ```
    pub fn neighbors(&self, vertex: VertexId) -> Vec<VertexId> {
        neighbors(self, self.representative(vertex))
    }

    /// A tetrahedron that holds the edge between two vertices, finite or not, from which
    /// [`around_edge`](Self::around_edge) can start; `None` where they share no edge. Linear in the number
    /// of tetrahedra at `from`.
    pub fn tet_at_edge(&self, from: VertexId, to: VertexId) -> Option<TetId> {
        tet_at_edge(self, self.representative(from), self.representative(to))
    }
}

/// See [`Tetrahedralization::neighbors`].
pub(crate) fn neighbors<T: Connectivity>(among: &T, vertex: VertexId) -> Vec<VertexId> {
    let mut neighbors: Vec<VertexId> = AroundVertex::new(among, vertex)
        .flat_map(|tet| among.corners(tet))
        .filter(|&corner| corner != vertex && corner != VertexId::NONE)
        .collect();
    neighbors.sort_unstable();
    neighbors.dedup();
    neighbors
}

/// See [`Tetrahedralization::tet_at_edge`].
pub(crate) fn tet_at_edge<T: Connectivity>(
    among: &T,
    from: VertexId,
    to: VertexId,
) -> Option<TetId> {
    if from == to {
        return None;
    }
    AroundVertex::new(among, from).find(|&tet| among.place_of(tet, to).is_some())
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
#[derive(Debug)]
pub struct AroundEdge<'a, T = Tetrahedralization<'a>> {
    among: &'a T,
    from: VertexId,
    to: VertexId,
    start: TetId,
    next: Option<TetId>,
}

impl<T> Clone for AroundEdge<'_, T> {
    fn clone(&self) -> Self {
        Self { ..*self }
    }
}

impl<'a, T: Connectivity> AroundEdge<'a, T> {
    pub(crate) fn new(among: &'a T, tet: TetId, from: VertexId, to: VertexId) -> Option<Self> {
        let places = (among.place_of(tet, from)?, among.place_of(tet, to)?);
        (places.0 != places.1).then_some(Self {
            among,
            from,
            to,
            start: tet,
            next: Some(tet),
        })
    }

    /// The facet of `tet` through which one leaves it when turning counter-clockwise around the edge.
    fn way_out(&self, tet: TetId) -> Option<FacetId> {
        let i = self.among.place_of(tet, self.from)?;
        let j = self.among.place_of(tet, self.to)?;
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

impl<T: Connectivity> Iterator for AroundEdge<'_, T> {
    type Item = (TetId, FacetId);

    fn next(&mut self) -> Option<Self::Item> {
        let tet = self.next?;
        let out = self.way_out(tet)?;
        let neighbor = self.among.other_side(out).tet();
        self.next = (neighbor != self.start).then_some(neighbor);
        Some((tet, out))
    }
}

/// See [`Tetrahedralization::around_vertex`].
#[derive(Debug)]
pub struct AroundVertex<'a, T = Tetrahedralization<'a>> {
    among: &'a T,
    vertex: VertexId,
    stack: Vec<TetId>,
    seen: TetSet,
}

impl<T> Clone for AroundVertex<'_, T> {
    fn clone(&self) -> Self {
        Self {
            among: self.among,
            vertex: self.vertex,
            stack: self.stack.clone(),
            seen: self.seen.clone(),
        }
    }
}

impl<'a, T: Connectivity> AroundVertex<'a, T> {
    pub(crate) fn new(among: &'a T, vertex: VertexId) -> Self {
        let mut seen = TetSet::default();
        let stack: Vec<TetId> = among.tet_at(vertex).into_iter().collect();
        for &tet in &stack {
            seen.insert(tet);
        }
        Self {
            among,
            vertex,
            stack,
            seen,
        }
    }
}

impl<T: Connectivity> Iterator for AroundVertex<'_, T> {
    type Item = TetId;

    fn next(&mut self) -> Option<TetId> {
        let tet = self.stack.pop()?;
        let own = self.among.place_of(tet, self.vertex);
        for corner in (0..4).filter(|&corner| Some(corner) != own) {
            let neighbor = self.among.other_side(FacetId::of(tet, corner)).tet();
            if self.seen.insert(neighbor) {
                self.stack.push(neighbor);
            }
        }
        Some(tet)
    }
}

/// A set of tetrahedra: open addressing in a table at most half full.
#[derive(Clone, Debug, Default)]
struct TetSet {
    table: Vec<TetId>,
    count: usize,
}

impl TetSet {
    /// Whether `tet` is new.
    fn insert(&mut self, tet: TetId) -> bool {
        if 2 * self.count >= self.table.len() {
            self.grow();
        }
        let mask = self.table.len() - 1;
        // Fibonacci hashing: the high bits of the product are well mixed.
        let mut place = (tet.0.wrapping_mul(0x9e37_79b9) >> 7) as usize & mask;
        while self.table[place] != TetId::NONE {
            if self.table[place] == tet {
                return false;
            }
            place = (place + 1) & mask;
        }
        self.table[place] = tet;
        self.count += 1;
        true
    }

    fn grow(&mut self) {
        let larger = vec![TetId::NONE; (2 * self.table.len()).max(64)];
        self.count = 0;
        for tet in std::mem::replace(&mut self.table, larger) {
            if tet != TetId::NONE {
                self.insert(tet);
            }
        }
    }
}
