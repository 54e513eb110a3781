//! The manifold walk (Dey 2006, section 4.1.4): SEED, SURFTRIANGLES and the combinatorial SURFACENEIGHBOR,
//! which is [`Radial::across`].

use crate::canonical::Canonical;
use crate::facet_set::FacetSet;
use crate::radial::{Radial, SideId};
use pellicle_delaunay::{FacetId, TetId};
use std::collections::VecDeque;

/// By place of a facet, the side on which the walk passed it, if it did: the outside.
pub(crate) type Walked = Vec<Option<SideId>>;

/// EXTRACTMANIFOLD: the sides of candidates that are seen from outside, component by component.
///
/// A component is a set of candidates joined along edges. Every component is returned, seen from the side
/// from which the walk first meets it: from the outer space where possible, otherwise through as few other
/// surfaces as possible.
pub(crate) fn extract(canonical: &Canonical, candidates: &FacetSet, radial: &Radial) -> Walked {
    let mut walked = vec![None; radial.len()];
    for seed in seeds(canonical, candidates, radial) {
        surface_triangles(radial, seed, &mut walked);
    }
    walked
}

/// SEED: one candidate of each component, as a side seen from the tetrahedron that first reaches it.
///
/// The tetrahedra are visited from infinity, those behind k candidates before those behind k + 1.
fn seeds(canonical: &Canonical, candidates: &FacetSet, radial: &Radial) -> Vec<SideId> {
    let (component, count) = radial.components();
    let mut has_seed = vec![false; count];
    let mut seeds = Vec::new();
    let mut visited = vec![false; canonical.tets().len()];
    let mut reached: Vec<TetId> = (canonical.finite_count()..canonical.tets().len())
        .rev()
        .map(TetId::new)
        .collect();
    let mut behind = VecDeque::new();
    while seeds.len() < count {
        let Some(tet) = reached.pop().or_else(|| behind.pop_front()) else {
            break;
        };
        if std::mem::replace(&mut visited[tet.index()], true) {
            continue;
        }
        for (corner, twin) in canonical.twins(tet).into_iter().enumerate() {
            let facet = FacetId::of(tet, corner);
            if !candidates.contains(facet) {
                if !visited[twin.tet().index()] {
                    reached.push(twin.tet());
                }
                continue;
            }
            behind.push_back(twin.tet());
            if let Some(side) = radial.side_of(canonical, facet) {
                let has_seed = &mut has_seed[component[side.facet()] as usize];
                if !std::mem::replace(has_seed, true) {
                    seeds.push(side);
                }
            }
        }
    }
    seeds
}

/// SURFTRIANGLES: all sides that are reached from the seed by turning through the outside around edges.
///
/// Edges between two facets are crossed before any others. An open sheet has its border, where behind a
/// triangle stands the triangle itself, but it may also have edges with three facets, around which the walk
/// gets behind it; by then all of its front is taken.
fn surface_triangles(radial: &Radial, seed: SideId, walked: &mut Walked) {
    let mut pending = VecDeque::from([seed]);
    let mut crowded = VecDeque::new();
    walked[seed.facet()] = Some(seed);
    loop {
        while let Some(side) = pending.pop_front() {
            for edge in side.edges() {
                let neighbor = radial.across(edge);
                if walked[neighbor.side().facet()].is_some() {
                    continue;
                }
                // Between two facets, both wedges join the same two.
                if radial.across(edge.behind()) == neighbor.behind() {
                    walked[neighbor.side().facet()] = Some(neighbor.side());
                    pending.push_back(neighbor.side());
                } else {
                    crowded.push_back(neighbor.side());
                }
            }
        }
        let Some(side) = crowded.pop_front() else {
            return;
        };
        if walked[side.facet()].is_none() {
            walked[side.facet()] = Some(side);
            pending.push_back(side);
        }
    }
}
