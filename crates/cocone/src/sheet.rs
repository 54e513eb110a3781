//! Facet sides that form a surface, and the mesh they make.

use crate::canonical::Canonical;
use crate::facet_set::FacetSet;
use crate::radial::{Radial, SideEdge, SideId};
use crate::walk::Walked;
use pellicle_delaunay::FacetId;
use pellicle_geometry::VertexId;

/// Facets, each seen from one side: the outside.
pub(crate) struct Sheet {
    facets: FacetSet,
    /// By tetrahedron: bit i for the facet opposite corner i, seen from this tetrahedron.
    sides: Vec<u8>,
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

    /// The triangles of the sheet.
    pub(crate) fn triangles(&self, canonical: &Canonical) -> Triangles {
        let radial = Radial::of(canonical, &self.facets);
        let sides = (0..radial.len())
            .map(|place| {
                let facet = radial.facet(place);
                let first = SideId((2 * place) as u32);
                let is_first = self.sides[facet.tet().index()] >> facet.corner() & 1 != 0;
                Some(if is_first { first } else { first.other() })
            })
            .collect();
        Triangles::of(&radial, &sides)
    }
}

/// Triangles over copies of vertices.
pub(crate) struct Triangles {
    /// Counter-clockwise seen from outside.
    pub(crate) triangles: Vec<[VertexId; 3]>,
    /// By vertex of the triangles, the canonical vertex.
    pub(crate) vertices: Vec<VertexId>,
}

impl Triangles {
    /// The triangles of the sides that were walked, with a vertex for each fan of triangles around a point:
    /// where two sheets touch, each has vertices of its own. Vertices and triangles are in canonical order.
    pub(crate) fn of(radial: &Radial, walked: &Walked) -> Self {
        // By place and corner, the vertex of the fan; fans are numbered in order of discovery.
        let mut fans = vec![[VertexId::NONE; 3]; radial.len()];
        let mut vertices = Vec::new();
        for side in walked.iter().flatten() {
            for corner in 0..3 {
                if fans[side.facet()][corner] == VertexId::NONE {
                    let fan = VertexId::new(vertices.len());
                    vertices.push(radial.side_vertices(*side)[corner]);
                    mark_fan(radial, walked, *side, corner, |side, corner| {
                        let mark = &mut fans[side.facet()][corner];
                        let is_new = *mark == VertexId::NONE;
                        *mark = fan;
                        is_new
                    });
                }
            }
        }
        let fans = walked
            .iter()
            .flatten()
            .map(|side| fans[side.facet()])
            .collect();
        in_canonical_order(fans, vertices)
    }
}

/// Calls `mark` for each side, with the corner there, of the fan around a corner of `side`, in both
/// directions, until it returns false.
fn mark_fan(
    radial: &Radial,
    walked: &Walked,
    side: SideId,
    corner: usize,
    mut mark: impl FnMut(SideId, usize) -> bool,
) {
    mark(side, corner);
    let vertex = radial.side_vertices(side)[corner];
    for step in [1, 2] {
        let (mut side, mut corner) = (side, corner);
        loop {
            // Counter-clockwise the next edge is opposite the next vertex; clockwise, the last.
            let edge: SideEdge = side.edges()[(corner + step) % 3];
            let next = radial.across(edge).side();
            // Seen from behind, it is a sheet that faces the other way, or this one at its border.
            if walked[next.facet()] != Some(next) {
                break;
            }
            let place = radial.side_vertices(next).iter().position(|&v| v == vertex);
            corner = place.unwrap_or(0);
            side = next;
            if !mark(side, corner) {
                break;
            }
        }
    }
}

/// Numbers vertices by canonical vertex, then fan; the triangles are in order already.
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
