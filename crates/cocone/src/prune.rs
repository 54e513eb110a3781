//! Pruning of triangles at sharp edges, in cascade (Dey 2006, section 4.1.3).

use crate::canonical::Canonical;
use crate::facet_set::FacetSet;
use glam::DVec3;
use pellicle_delaunay::FacetId;
use pellicle_geometry::VertexId;
use pellicle_predicates::{Sign, orient3d};

/// Removes all candidates at sharp edges until no edge is sharp. Edges at a vertex that is not flat are
/// left alone: there the surface may have its border, and the cascade must not eat it from there.
pub(crate) fn prune(canonical: &Canonical, flat: &[bool], candidates: &mut FacetSet) {
    let mut pending: Vec<FacetId> = candidates.iter(canonical).collect();
    let mut around = Vec::new();
    while let Some(facet) = pending.pop() {
        if !candidates.contains(facet) {
            continue;
        }
        for opposite in canonical.facet(facet) {
            let edge = edge_opposite(canonical.facet(facet), opposite);
            if !edge.iter().all(|v| flat[v.index()]) {
                continue;
            }
            around.clear();
            let turn = canonical.around_edge(facet, opposite);
            around.extend(turn.filter(|&side| candidates.contains(side)));
            if !is_sharp(canonical, edge, &around) {
                continue;
            }
            for &side in &around {
                candidates.remove(canonical, side);
                for opposite in canonical.facet(side) {
                    let turn = canonical.around_edge(side, opposite);
                    pending.extend(turn.filter(|&side| candidates.contains(side)));
                }
            }
            break;
        }
    }
}

/// The edge from u to v of a triangle (u, v, `opposite`).
pub(crate) fn edge_opposite(facet: [VertexId; 3], opposite: VertexId) -> [VertexId; 2] {
    let place = facet.iter().position(|&v| v == opposite).unwrap_or(0);
    [facet[(place + 1) % 3], facet[(place + 2) % 3]]
}

/// Whether two consecutive triangles around the edge enclose an angle of more than 3π/2, as a single
/// triangle does with itself.
fn is_sharp(canonical: &Canonical, edge: [VertexId; 2], around: &[FacetId]) -> bool {
    let apex = |side: &FacetId| {
        let facet = canonical.facet(*side);
        let apex = facet.iter().find(|v| !edge.contains(v));
        apex.map_or(canonical.point(edge[0]), |&v| canonical.point(v))
    };
    let [u, v] = edge.map(|vertex| canonical.point(vertex));
    let axis = v - u;
    around.len() == 1
        || around.iter().enumerate().any(|(k, side)| {
            // The turn goes counter-clockwise seen from v, from apex x to apex y. Beyond 3π/2 its cosine is
            // positive and its sine negative.
            let (x, y) = (apex(side), apex(&around[(k + 1) % around.len()]));
            let across = |p: DVec3| (p - u).cross(axis);
            across(x).dot(across(y)) > 0.0 && orient3d(u, v, x, y) == Sign::Negative
        })
}
