//! The manifold walk (Dey 2006, section 4.1.4): SEED, SURFTRIANGLES and the combinatorial SURFACENEIGHBOR.

use crate::canonical::Canonical;
use crate::facet_set::FacetSet;
use crate::sheet::Sheet;
use pellicle_delaunay::{FacetId, TetId};
use std::collections::VecDeque;

/// The sides of candidates that are seen from outside, component by component.
///
/// A component is a set of candidates joined along edges. Every component is returned, seen from the side
/// from which the walk first meets it: from the outer space where possible, otherwise through as few other
/// surfaces as possible.
pub(crate) fn extract(canonical: &Canonical, candidates: &FacetSet) -> Sheet {
    let mut sheet = Sheet::empty(canonical);
    for seed in seeds(canonical, candidates) {
        surface_triangles(canonical, candidates, seed, &mut sheet);
    }
    sheet
}

/// SEED: one candidate of each component, as a side seen from the tetrahedron that first reaches it.
///
/// The tetrahedra are visited from infinity, those behind k candidates before those behind k + 1.
fn seeds(canonical: &Canonical, candidates: &FacetSet) -> Vec<FacetId> {
    let mut seeds = Vec::new();
    let mut in_component = FacetSet::empty(canonical);
    let mut visited = vec![false; canonical.tets().len()];
    let mut queue: VecDeque<TetId> = (canonical.finite_count()..canonical.tets().len())
        .map(TetId::new)
        .collect();
    while let Some(tet) = queue.pop_front() {
        if std::mem::replace(&mut visited[tet.index()], true) {
            continue;
        }
        for (corner, twin) in canonical.twins(tet).into_iter().enumerate() {
            let side = FacetId::of(tet, corner);
            let is_candidate = candidates.contains(side);
            if is_candidate && !in_component.contains(side) {
                seeds.push(side);
                mark_component(canonical, candidates, side, &mut in_component);
            }
            if visited[twin.tet().index()] {
                continue;
            }
            match is_candidate {
                true => queue.push_back(twin.tet()),
                false => queue.push_front(twin.tet()),
            }
        }
    }
    seeds
}

fn mark_component(
    canonical: &Canonical,
    candidates: &FacetSet,
    seed: FacetId,
    in_component: &mut FacetSet,
) {
    let mut pending = vec![seed];
    in_component.insert(canonical, seed);
    while let Some(facet) = pending.pop() {
        for opposite in canonical.facet(facet) {
            for side in canonical.around_edge(facet, opposite) {
                if candidates.contains(side) && in_component.insert(canonical, side) {
                    pending.push(side);
                }
            }
        }
    }
}

/// SURFTRIANGLES: all sides that are reached from the seed by turning through the outside around edges.
fn surface_triangles(
    canonical: &Canonical,
    candidates: &FacetSet,
    seed: FacetId,
    sheet: &mut Sheet,
) {
    let mut pending = VecDeque::from([seed]);
    sheet.insert(canonical, seed);
    while let Some(side) = pending.pop_front() {
        for opposite in canonical.facet(side) {
            let neighbor = canonical
                .around_edge(side, opposite)
                .find(|&next| candidates.contains(next));
            // An open sheet is walked on one side only: behind its border stands the triangle itself.
            if let Some(neighbor) = neighbor
                && sheet.insert(canonical, neighbor)
            {
                pending.push_back(neighbor);
            }
        }
    }
}
