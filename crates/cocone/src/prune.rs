//! Pruning of triangles at sharp edges, in cascade (Dey 2006, section 4.1.3).

use crate::canonical::Canonical;
use crate::facet_set::FacetSet;
use crate::radial::{Radial, SideEdge, SideId};
use crate::umbrella::Links;
use crate::walk::Walked;
use glam::DVec3;
use pellicle_geometry::VertexId;
use pellicle_predicates::{Sign, orient3d};

/// Removes candidates at sharp edges, in cascade.
///
/// The chapter assumes a closed and densely sampled surface; on any other the cascade would eat the surface
/// from its border inwards. Two things stop it here. An edge whose ends both lack a flat cell may be a
/// border, and is left alone. And what a first walk finds to close around a flat vertex is what the walk
/// is after: it is never removed.
///
/// Where rows of points run along the rulings of a surface, slivers between neighbouring rows make a slab of
/// candidates, around no vertex of which a fan closes, and which the cascade eats whole. A pruning that
/// would leave most flat vertices without a triangle is not done at all.
pub(crate) fn prune(
    canonical: &Canonical,
    flat: &[bool],
    first_walk: &Walked,
    candidates: &mut FacetSet,
    radial: &mut Radial,
) {
    let mut pending = at_sharp_edges(canonical, flat, radial);
    if pending.is_empty() {
        return;
    }
    let fans = Fans::of(canonical, flat, first_walk, radial);
    let unpruned = candidates.clone();
    while let Some(place) = pending.pop() {
        if radial.is_removed(place) || fans.close_with(radial, place) {
            continue;
        }
        let Some(edge) = sharp_edge(canonical, flat, radial, place) else {
            continue;
        };
        let around: Vec<SideEdge> = radial.around(edge).collect();
        for place in around.iter().map(|edge| edge.side().facet()) {
            if !fans.close_with(radial, place) {
                // Its other edges may become sharp.
                for edge in SideId((2 * place) as u32).edges() {
                    pending.extend(radial.around(edge).map(|edge| edge.side().facet()));
                }
                candidates.remove(canonical, radial.facet(place));
                radial.remove(place);
            }
        }
    }
    if leaves_most_bare(canonical, flat, radial) {
        *radial = Radial::of(canonical, &unpruned);
        *candidates = unpruned;
    }
}

/// Whether most of the flat vertices that had triangles have none any more.
fn leaves_most_bare(canonical: &Canonical, flat: &[bool], radial: &Radial) -> bool {
    let mut had = vec![false; canonical.vertex_count()];
    let mut has = had.clone();
    for place in 0..radial.len() {
        for vertex in radial.vertices(place) {
            had[vertex.index()] = true;
            has[vertex.index()] |= !radial.is_removed(place);
        }
    }
    let count = |some: &[bool]| {
        let flat_ones = some
            .iter()
            .zip(flat)
            .filter(|(some, flat)| **some && **flat);
        flat_ones.count()
    };
    2 * count(&has) < count(&had)
}

/// The fans of triangles around flat vertices that a first walk found.
struct Fans<'f> {
    flat: &'f [bool],
    /// Of the triangles that were walked.
    links: Links,
    /// By triangle of the links, its place.
    places: Vec<usize>,
}

impl<'f> Fans<'f> {
    fn of(canonical: &Canonical, flat: &'f [bool], walked: &Walked, radial: &Radial) -> Self {
        let places: Vec<usize> = (0..radial.len()).filter(|&k| walked[k].is_some()).collect();
        let triangles: Vec<_> = places.iter().map(|&k| radial.vertices(k)).collect();
        Self {
            flat,
            links: Links::of(canonical.vertex_count(), &triangles),
            places,
        }
    }

    /// Whether the triangle is part of a fan that closes around one of its vertices, dead ends cut back.
    fn close_with(&self, radial: &Radial, place: usize) -> bool {
        let flat = |v: &VertexId| self.flat[v.index()];
        radial
            .vertices(place)
            .into_iter()
            .filter(flat)
            .any(|vertex| {
                let mut fan = self.links.umbrella_without_dead_ends(vertex);
                fan.any(|triangle| self.places[triangle as usize] == place)
            })
    }
}

/// The places of the facets at sharp edges with an end that is flat.
fn at_sharp_edges(canonical: &Canonical, flat: &[bool], radial: &Radial) -> Vec<usize> {
    let mut places = Vec::new();
    for place in radial.left() {
        for edge in SideId((2 * place) as u32).edges() {
            // Each edge once: from its facet of the lowest place, unless there are many.
            let neighbor = radial.across(edge).side().facet();
            let [u, v] = radial.edge(edge);
            if place <= neighbor
                && (flat[u.index()] || flat[v.index()])
                && is_sharp(canonical, radial, edge)
            {
                places.push(place);
                places.extend(radial.around(edge).map(|edge| edge.side().facet()));
            }
        }
    }
    places
}

/// A sharp edge of the facet with an end that is flat.
fn sharp_edge(
    canonical: &Canonical,
    flat: &[bool],
    radial: &Radial,
    place: usize,
) -> Option<SideEdge> {
    let edges = SideId((2 * place) as u32).edges();
    edges.into_iter().find(|&edge| {
        let [u, v] = radial.edge(edge);
        (flat[u.index()] || flat[v.index()]) && is_sharp(canonical, radial, edge)
    })
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
