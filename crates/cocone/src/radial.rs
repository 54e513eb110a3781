//! A set of facets, and how they follow each other around their edges.
//!
//! ```text
//!        f           facets f, g, h at an edge, seen from its end. Each facet has two sides, and each side
//!       1|2          sees one of the wedges between the facets: side 2 of f and side 3 of g see the same
//!        o---3 g     wedge, so turning from either through the space it sees first meets the other.
//!       /  4
//!      h
//! ```
//!
//! Everything combinatorial that happens on candidates (components, pruning, the manifold walk) needs only
//! these meetings; the tetrahedra between are turned through once.

use crate::canonical::Canonical;
use crate::facet_set::FacetSet;
use pellicle_delaunay::FacetId;
use pellicle_geometry::{VertexId, define_id};

define_id! {
    /// A side of a facet of a [`Radial`] set: `2 k` for the k-th facet as seen from its tetrahedron of
    /// lower id, `2 k + 1` from the other.
    pub(crate) struct SideId;
}

define_id! {
    /// An edge of a side: `3 s + i` for the edge of side `s` opposite the i-th of its vertices.
    pub(crate) struct SideEdge;
}

impl SideId {
    /// The place of the facet in the list.
    #[inline]
    pub(crate) fn facet(self) -> usize {
        self.index() / 2
    }

    #[inline]
    pub(crate) fn other(self) -> Self {
        Self(self.0 ^ 1)
    }

    /// The edges opposite its three vertices.
    #[inline]
    pub(crate) fn edges(self) -> [SideEdge; 3] {
        let first = 3 * self.0;
        [SideEdge(first), SideEdge(first + 1), SideEdge(first + 2)]
    }
}

impl SideEdge {
    #[inline]
    pub(crate) fn side(self) -> SideId {
        SideId(self.0 / 3)
    }

    /// Which of the side's vertices is opposite.
    #[inline]
    pub(crate) fn place(self) -> usize {
        (self.0 % 3) as usize
    }

    /// The same edge of the same facet seen from the other side, whose vertices are listed as (a, c, b)
    /// where this side has (a, b, c).
    #[inline]
    pub(crate) fn behind(self) -> Self {
        let place = (3 - self.0 % 3) % 3;
        Self(3 * self.side().other().0 + place)
    }
}

/// See the module.
pub(crate) struct Radial {
    facets: Vec<FacetId>,
    /// By facet: counter-clockwise seen from its side `2 k`.
    vertices: Vec<[VertexId; 3]>,
    /// By edge of a side: the edge of the side that sees the same wedge.
    across: Vec<SideEdge>,
    /// By facet: whether it was removed.
    removed: Vec<bool>,
}

impl Radial {
    pub(crate) fn of(canonical: &Canonical, set: &FacetSet) -> Self {
        let facets: Vec<FacetId> = set.iter(canonical).collect();
        let mut radial = Self {
            vertices: facets.iter().map(|&f| canonical.facet(f)).collect(),
            across: vec![SideEdge::NONE; 6 * facets.len()],
            removed: vec![false; facets.len()],
            facets,
        };
        let at_edges = AtEdges::of(canonical.vertex_count(), &radial.vertices);
        let mut here = Vec::new();
        for vertex in canonical.vertex_ids() {
            here.clear();
            here.extend_from_slice(at_edges.of_lower_vertex(vertex));
            here.sort_unstable();
            for edges in here.chunk_by(|a, b| a.0 == b.0) {
                match *edges {
                    [(_, edge)] => radial.join(edge, edge.behind()),
                    [(_, one), (_, other)] => radial.join_two(one, other),
                    _ => radial.join_around(canonical, set, edges),
                }
            }
        }
        radial
    }

    fn join(&mut self, one: SideEdge, other: SideEdge) {
        self.across[one.index()] = other;
        self.across[other.index()] = one;
    }

    /// Two facets at an edge: sides that see the same wedge run along the edge in opposite directions.
    fn join_two(&mut self, one: SideEdge, other: SideEdge) {
        let turned = match self.edge(one) == self.edge(other) {
            true => other.behind(),
            false => other,
        };
        self.join(one, turned);
        self.join(one.behind(), turned.behind());
    }

    /// Three facets or more: the tetrahedra between tell in which order they come.
    fn join_around(
        &mut self,
        canonical: &Canonical,
        set: &FacetSet,
        edges: &[(VertexId, SideEdge)],
    ) {
        for start in edges.iter().flat_map(|&(_, edge)| [edge, edge.behind()]) {
            let opposite = self.side_vertices(start.side())[start.place()];
            let met = canonical
                .around_edge(self.facet_of(canonical, start.side()), opposite)
                .find(|&facet| set.contains(facet));
            let same = |edge: &SideEdge| met == Some(self.facet_of(canonical, edge.side()));
            let mut sides = edges.iter().flat_map(|&(_, edge)| [edge, edge.behind()]);
            if let Some(end) = sides.find(same) {
                self.join(start, end);
            }
        }
    }

    /// How many facets there were at first; the places of sides refer to them.
    pub(crate) fn len(&self) -> usize {
        self.facets.len()
    }

    /// The places of the facets that are left.
    pub(crate) fn left(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.facets.len()).filter(|&place| !self.removed[place])
    }

    #[inline]
    pub(crate) fn is_removed(&self, place: usize) -> bool {
        self.removed[place]
    }

    /// The facet at a place, seen from its side `2 k`.
    pub(crate) fn facet(&self, place: usize) -> FacetId {
        self.facets[place]
    }

    /// The vertices of the facet at a place, counter-clockwise seen from its side `2 k`.
    #[inline]
    pub(crate) fn vertices(&self, place: usize) -> [VertexId; 3] {
        self.vertices[place]
    }

    /// The vertices of a side, counter-clockwise seen from there.
    #[inline]
    pub(crate) fn side_vertices(&self, side: SideId) -> [VertexId; 3] {
        let [a, b, c] = self.vertices[side.facet()];
        if side.0 & 1 == 0 {
            [a, b, c]
        } else {
            [a, c, b]
        }
    }

    /// The side as a facet seen from a tetrahedron.
    pub(crate) fn facet_of(&self, canonical: &Canonical, side: SideId) -> FacetId {
        let facet = self.facets[side.facet()];
        if side.0 & 1 == 0 {
            facet
        } else {
            canonical.twin(facet)
        }
    }

    /// The side of a facet seen from a tetrahedron.
    pub(crate) fn side_of(&self, canonical: &Canonical, facet: FacetId) -> Option<SideId> {
        let twin = canonical.twin(facet);
        let stored = if facet.tet() < twin.tet() {
            facet
        } else {
            twin
        };
        let place = self.facets.binary_search(&stored).ok()?;
        Some(SideId((2 * place + usize::from(stored != facet)) as u32))
    }

    /// The first edge of a side met when turning around the edge through the space it is seen from: at last
    /// its own, from behind.
    #[inline]
    pub(crate) fn across(&self, edge: SideEdge) -> SideEdge {
        self.across[edge.index()]
    }

    /// The edge from u to v, where the side is (u, v, w).
    #[inline]
    pub(crate) fn edge(&self, edge: SideEdge) -> [VertexId; 2] {
        let vertices = self.side_vertices(edge.side());
        [
            vertices[(edge.place() + 1) % 3],
            vertices[(edge.place() + 2) % 3],
        ]
    }

    /// The edges of sides met when turning once around, the last of them the edge itself from behind.
    pub(crate) fn around(&self, edge: SideEdge) -> impl Iterator<Item = SideEdge> + '_ {
        let last = edge.behind();
        let mut next = Some(self.across(edge));
        std::iter::from_fn(move || {
            let met = next?;
            next = (met != last).then(|| self.across(met.behind()));
            Some(met)
        })
    }

    /// Removes a facet: the wedges on its two sides become one.
    pub(crate) fn remove(&mut self, place: usize) {
        self.removed[place] = true;
        for edge in SideId((2 * place) as u32).edges() {
            let (before, after) = (self.across(edge), self.across(edge.behind()));
            self.across[before.index()] = after;
            self.across[after.index()] = before;
        }
    }

    /// Marks, by place, the facets that are joined to this one along edges, and counts them.
    pub(crate) fn mark_component(&self, seed: SideId, marked: &mut [bool]) -> usize {
        let mut count = 1;
        let mut pending = vec![seed];
        marked[seed.facet()] = true;
        while let Some(side) = pending.pop() {
            for edge in side.edges().into_iter().chain(side.other().edges()) {
                let neighbor = self.across(edge).side();
                if !std::mem::replace(&mut marked[neighbor.facet()], true) {
                    count += 1;
                    pending.push(neighbor);
                }
            }
        }
        count
    }
}

/// The edges of facets by their lower vertex.
struct AtEdges {
    starts: Vec<u32>,
    /// (higher vertex, edge of side `2 k`).
    edges: Vec<(VertexId, SideEdge)>,
}

impl AtEdges {
    fn of(vertex_count: usize, facets: &[[VertexId; 3]]) -> Self {
        // Opposite a, b and c.
        let ends = |[a, b, c]: [VertexId; 3]| [(b, c), (c, a), (a, b)];
        let mut starts = vec![0_u32; vertex_count + 1];
        for &facet in facets {
            for (u, v) in ends(facet) {
                starts[u.min(v).index() + 1] += 1;
            }
        }
        for vertex in 0..vertex_count {
            starts[vertex + 1] += starts[vertex];
        }
        let mut next = starts.clone();
        let mut edges = vec![(VertexId::NONE, SideEdge::NONE); 3 * facets.len()];
        for (place, &facet) in facets.iter().enumerate() {
            let side = SideId((2 * place) as u32);
            for ((u, v), edge) in ends(facet).into_iter().zip(side.edges()) {
                let next = &mut next[u.min(v).index()];
                edges[*next as usize] = (u.max(v), edge);
                *next += 1;
            }
        }
        Self { starts, edges }
    }

    fn of_lower_vertex(&self, vertex: VertexId) -> &[(VertexId, SideEdge)] {
        &self.edges[self.starts[vertex.index()] as usize..self.starts[vertex.index() + 1] as usize]
    }
}
