//! The manifold walk (Dey 2006, section 4.1.4): SEED, SURFTRIANGLES and the combinatorial SURFACENEIGHBOR,
//! which is [`Radial::across`].

use crate::canonical::Canonical;
use crate::facet_set::FacetSet;
use crate::radial::{Radial, SideId};
use pellicle_delaunay::{FacetId, TetId};
use std::collections::VecDeque;
use std::ops::ControlFlow;

/// By place of a facet, the side on which the walk passed it, if it did: the outside.
pub(crate) type Walked = Vec<Option<SideId>>;

/// EXTRACTMANIFOLD: the sides of candidates that are seen from outside, component by component.
///
/// A component is a set of candidates joined along edges. Every component is returned, seen from the side
/// from which the walk first meets it: from the outer space where possible, otherwise through as few other
/// surfaces as possible.
pub(crate) fn extract(canonical: &Canonical, candidates: &FacetSet, radial: &Radial) -> Walked {
    let mut walked = vec![None; radial.len()];
    let mut in_seeded_component = vec![false; radial.len()];
    let mut left = candidates.len();
    for_sides_from_outside(canonical, candidates, |facet| {
        // SEED: the first side met of each component.
        let Some(side) = radial.side_of(canonical, facet) else {
            return ControlFlow::Continue(());
        };
        if walked[side.facet()].is_none() && !in_seeded_component[side.facet()] {
            let count = surface_triangles(radial, side, &mut walked);
            // Where the walk took every candidate that is left, there is no other component.
            left -= match count < left {
                true => radial.mark_component(side, &mut in_seeded_component),
                false => count,
            };
        }
        match left {
            0 => ControlFlow::Break(()),
            _ => ControlFlow::Continue(()),
        }
    });
    walked
}

/// Visits the candidates, each side as seen from the tetrahedron that first reaches it, those behind k
/// candidates before those behind k + 1, starting at infinity.
fn for_sides_from_outside(
    canonical: &Canonical,
    candidates: &FacetSet,
    mut visit: impl FnMut(FacetId) -> ControlFlow<()>,
) {
    let mut visited = vec![false; canonical.tets().len()];
    let mut reached: Vec<TetId> = (canonical.finite_count()..canonical.tets().len())
        .rev()
        .map(TetId::new)
        .collect();
    let mut behind = VecDeque::new();
    while let Some(tet) = reached.pop().or_else(|| behind.pop_front()) {
        if std::mem::replace(&mut visited[tet.index()], true) {
            continue;
        }
        for (corner, twin) in canonical.twins(tet).into_iter().enumerate() {
            let facet = FacetId::of(tet, corner);
            if candidates.contains(facet) {
                behind.push_back(twin.tet());
                if visit(facet).is_break() {
                    return;
                }
            } else if !visited[twin.tet().index()] {
                reached.push(twin.tet());
            }
        }
    }
}

/// SURFTRIANGLES: all sides that are reached from the seed by turning through the outside around edges.
///
/// Edges between two facets are crossed before any others. An open sheet has its border, where behind a
/// triangle stands the triangle itself, but it may also have edges with three facets, around which the walk
/// gets behind it; by then all of its front is taken.
fn surface_triangles(radial: &Radial, seed: SideId, walked: &mut Walked) -> usize {
    let mut count = 1;
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
                    count += 1;
                    pending.push_back(neighbor.side());
                } else {
                    crowded.push_back(neighbor.side());
                }
            }
        }
        let Some(side) = crowded.pop_front() else {
            return count;
        };
        if walked[side.facet()].is_none() {
            walked[side.facet()] = Some(side);
            count += 1;
            pending.push_back(side);
        }
    }
}
