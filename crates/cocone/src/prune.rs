//! Pruning of triangles at sharp edges, in cascade (Dey 2006, section 4.1.3).

use crate::canonical::Canonical;
use crate::facet_set::FacetSet;
use crate::radial::{Radial, SideEdge, SideId};
use crate::umbrella::Links;
use crate::walk::Walked;
use glam::DVec3;
use pellicle_predicates::{Sign, orient3d};

/// Removes candidates at sharp edges, in cascade.
///
/// The chapter assumes a closed and densely sampled surface; on any other the cascade would eat the surface
/// from its border inwards. Two things stop it here. An edge whose ends both lack a flat cell may be a
/// border, and is left alone. And what a first walk finds to close around a flat vertex is what the walk
/// is after: it is never removed.
pub(crate) fn prune(
    canonical: &Canonical,
    flat: &[bool],
    first_walk: &Walked,
    candidates: &mut FacetSet,
    radial: &mut Radial,
) {
    let protected = closed_around_vertices(canonical, flat, first_walk, radial);
    let mut pending: Vec<usize> = radial.left().collect();
    while let Some(place) = pending.pop() {
        if radial.is_removed(place) || protected[place] {
            continue;
        }
        let is_sharp = |edge: &SideEdge| {
            let ends_are_flat = radial.edge(*edge).map(|v| flat[v.index()]);
            ends_are_flat.contains(&true) && is_sharp(canonical, radial, *edge)
        };
        let Some(edge) = SideId((2 * place) as u32)
            .edges()
            .into_iter()
            .find(is_sharp)
        else {
            continue;
        };
        let around: Vec<SideEdge> = radial.around(edge).collect();
        for place in around.iter().map(|edge| edge.side().facet()) {
            if !protected[place] {
                // Its other edges may become sharp.
                for edge in SideId((2 * place) as u32).edges() {
                    pending.extend(radial.around(edge).map(|edge| edge.side().facet()));
                }
                candidates.remove(canonical, radial.facet(place));
                radial.remove(place);
            }
        }
    }
}

/// By place: whether the triangle is part of a fan that the walk found to close around a flat vertex, dead
/// ends cut back.
fn closed_around_vertices(
    canonical: &Canonical,
    flat: &[bool],
    walked: &Walked,
    radial: &Radial,
) -> Vec<bool> {
    let places: Vec<usize> = (0..radial.len()).filter(|&k| walked[k].is_some()).collect();
    let triangles: Vec<_> = places.iter().map(|&k| radial.vertices(k)).collect();
    let links = Links::of(canonical.vertex_count(), &triangles);
    let mut closed = vec![false; radial.len()];
    for vertex in canonical.vertex_ids().filter(|v| flat[v.index()]) {
        for triangle in links.umbrella_without_dead_ends(vertex) {
            closed[places[triangle as usize]] = true;
        }
    }
    closed
}

/// Whether two consecutive triangles around the edge enclose an angle of more than 3π/2, as a single
/// triangle does with itself.
fn is_sharp(canonical: &Canonical, radial: &Radial, edge: SideEdge) -> bool {
    let [u, v] = radial.edge(edge).map(|vertex| canonical.point(vertex));
    let axis = v - u;
    let apex = |edge: SideEdge| canonical.point(radial.side_vertices(edge.side())[edge.place()]);
    let mut before = apex(edge);
    radial.around(edge).any(|met| {
        // The turn goes counter-clockwise seen from v, from apex x to apex y. Beyond 3π/2 its cosine is
        // positive and its sine negative, and a full turn leads back to the same triangle.
        let (x, y) = (before, apex(met));
        before = y;
        let across = |p: DVec3| (p - u).cross(axis);
        let is_single = radial.across(edge) == edge.behind();
        is_single || across(x).dot(across(y)) > 0.0 && orient3d(u, v, x, y) == Sign::Negative
    })
}
