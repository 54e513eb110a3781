//! Pruning of triangles at sharp edges, in cascade (Dey 2006, section 4.1.3).

use crate::canonical::Canonical;
use crate::facet_set::FacetSet;
use crate::umbrella::Links;
use crate::walk;
use glam::DVec3;
use pellicle_delaunay::FacetId;
use pellicle_geometry::VertexId;
use pellicle_predicates::{Sign, orient3d};

/// Removes candidates at sharp edges, in cascade.
///
/// The chapter assumes a closed and densely sampled surface; on any other the cascade would eat the surface
/// from its border inwards. Two things stop it here. An edge whose ends both lack a flat cell may be a
/// border, and is left alone. And what a first walk finds to close around a flat vertex is what the walk
/// is after: it is never removed.
pub(crate) fn prune(canonical: &Canonical, flat: &[bool], candidates: &mut FacetSet) {
    let protected = closed_around_vertices(canonical, flat, candidates);
    let mut pending: Vec<FacetId> = candidates.iter(canonical).collect();
    let mut around = Vec::new();
    while let Some(facet) = pending.pop() {
        if !candidates.contains(facet) || protected.contains(facet) {
            continue;
        }
        for opposite in canonical.facet(facet) {
            let edge = edge_opposite(canonical.facet(facet), opposite);
            if !edge.iter().any(|v| flat[v.index()]) {
                continue;
            }
            around.clear();
            let turn = canonical.around_edge(facet, opposite);
            around.extend(turn.filter(|&side| candidates.contains(side)));
            if !is_sharp(canonical, edge, &around) {
                continue;
            }
            for &side in around.iter().filter(|&&side| !protected.contains(side)) {
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

/// The triangles of a first walk that form a closed fan around a flat vertex, dead ends cut back.
fn closed_around_vertices(canonical: &Canonical, flat: &[bool], candidates: &FacetSet) -> FacetSet {
    let walked = walk::extract(canonical, candidates);
    let facets: Vec<FacetId> = walked.facets().iter(canonical).collect();
    let links = Links::of(canonical, &facets);
    let mut closed = FacetSet::empty(canonical);
    for vertex in canonical.vertex_ids().filter(|v| flat[v.index()]) {
        for triangle in links.umbrella_without_dead_ends(vertex) {
            closed.insert(canonical, facets[triangle as usize]);
        }
    }
    closed
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
