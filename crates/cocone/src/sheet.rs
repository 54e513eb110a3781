//! Facet sides that form a surface, and the mesh they make.

use crate::canonical::Canonical;
use crate::facet_set::FacetSet;
use pellicle_delaunay::FacetId;
use pellicle_geometry::VertexId;

/// Facets, each seen from one side: the outside.
pub(crate) struct Sheet {
    facets: FacetSet,
    /// By tetrahedron: bit i for the facet opposite corner i, seen from this tetrahedron.
    sides: Vec<u8>,
}

/// Triangles over copies of vertices.
pub(crate) struct Triangles {
    /// Counter-clockwise seen from outside.
    pub(crate) triangles: Vec<[VertexId; 3]>,
    /// By vertex of the triangles, the canonical vertex.
    pub(crate) vertices: Vec<VertexId>,
}

impl Sheet {
    pub(crate) fn empty(canonical: &Canonical) -> Self {
        Self {
            facets: FacetSet::empty(canonical),
            sides: vec![0; canonical.tets().len()],
        }
    }

    /// Whether neither side of the facet was in the sheet.
    pub(crate) fn insert(&mut self, canonical: &Canonical, side: FacetId) -> bool {
        let is_new = self.facets.insert(canonical, side);
        if is_new {
            self.sides[side.tet().index()] |= 1 << side.corner();
        }
        is_new
    }

    /// The facets, whichever side they are seen from.
    pub(crate) fn facets(&self) -> &FacetSet {
        &self.facets
    }

    fn contains(&self, side: FacetId) -> bool {
        self.sides[side.tet().index()] >> side.corner() & 1 != 0
    }

    /// The triangles, with a vertex for each fan of triangles around a point: where two sheets touch, each
    /// has vertices of its own. Vertices and triangles are in canonical order.
    pub(crate) fn triangles(&self, canonical: &Canonical) -> Triangles {
        let sides: Vec<FacetId> = canonical
            .tet_ids()
            .flat_map(|tet| (0..4).map(move |corner| FacetId::of(tet, corner)))
            .filter(|&side| self.contains(side))
            .collect();
        let rank = Rank::of(canonical, &sides);

        // By side and corner of its facet, the vertex of the fan; fans are numbered in order of discovery.
        let mut fans = vec![[VertexId::NONE; 3]; sides.len()];
        let mut vertices = Vec::new();
        for (k, &side) in sides.iter().enumerate() {
            for place in 0..3 {
                if fans[k][place] == VertexId::NONE {
                    let fan = VertexId::new(vertices.len());
                    let vertex = canonical.facet(side)[place];
                    vertices.push(vertex);
                    self.mark_fan(canonical, side, vertex, |side, place| {
                        let mark = &mut fans[rank.of_side(side)][place];
                        let is_new = *mark == VertexId::NONE;
                        *mark = fan;
                        is_new
                    });
                }
            }
        }
        in_canonical_order(fans, vertices)
    }

    /// Calls `mark` for each side of the fan around `vertex` that holds `side`, in both directions, until
    /// it returns false.
    fn mark_fan(
        &self,
        canonical: &Canonical,
        side: FacetId,
        vertex: VertexId,
        mut mark: impl FnMut(FacetId, usize) -> bool,
    ) {
        let place_in = |side: FacetId| {
            let facet = canonical.facet(side);
            facet.iter().position(|&v| v == vertex).unwrap_or(0)
        };
        mark(side, place_in(side));
        for step in [1, 2] {
            let mut side = side;
            loop {
                // Counter-clockwise the next edge is opposite the next vertex; clockwise, the last.
                let opposite = canonical.facet(side)[(place_in(side) + step) % 3];
                match self.neighbor(canonical, side, opposite) {
                    Some(next) if mark(next, place_in(next)) => side = next,
                    _ => break,
                }
            }
        }
    }

    /// SURFACENEIGHBOR: the next side across the edge opposite a vertex, through the outside.
    fn neighbor(
        &self,
        canonical: &Canonical,
        side: FacetId,
        opposite: VertexId,
    ) -> Option<FacetId> {
        let next = canonical
            .around_edge(side, opposite)
            .find(|&next| self.facets.contains(next))?;
        // Seen from behind, it is a sheet that faces the other way, or the same triangle at a border.
        self.contains(next).then_some(next)
    }
}

/// Numbers vertices by canonical vertex, then fan, and sorts nothing else: the sides are in order already.
fn in_canonical_order(fans: Vec<[VertexId; 3]>, vertices: Vec<VertexId>) -> Triangles {
    let mut order: Vec<VertexId> = (0..vertices.len()).map(VertexId::new).collect();
    order.sort_by_key(|fan| vertices[fan.index()]);
    let mut number = vec![VertexId::NONE; vertices.len()];
    for (new, fan) in order.iter().enumerate() {
        number[fan.index()] = VertexId::new(new);
    }
    Triangles {
        triangles: fans
            .into_iter()
            .map(|triangle| triangle.map(|fan| number[fan.index()]))
            .collect(),
        vertices: order.iter().map(|fan| vertices[fan.index()]).collect(),
    }
}

/// Where a side stands in a sorted list.
struct Rank {
    /// By tetrahedron: how many sides of the list come before those of it.
    before: Vec<u32>,
    sides: Vec<u8>,
}

impl Rank {
    fn of(canonical: &Canonical, sides: &[FacetId]) -> Self {
        let mut bits = vec![0_u8; canonical.tets().len()];
        for side in sides {
            bits[side.tet().index()] |= 1 << side.corner();
        }
        let mut count = 0;
        let before = bits
            .iter()
            .map(|bits| {
                count += bits.count_ones();
                count - bits.count_ones()
            })
            .collect();
        Self {
            before,
            sides: bits,
        }
    }

    fn of_side(&self, side: FacetId) -> usize {
        let below = self.sides[side.tet().index()] & ((1 << side.corner()) - 1);
        (self.before[side.tet().index()] + below.count_ones()) as usize
    }
}
