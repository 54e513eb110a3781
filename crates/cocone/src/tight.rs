//! Tight Cocone (Dey and Goswami 2003): mark tetrahedra inside and outside, take the boundary.
//!
//! 1. A vertex is *good* when the triangles that Cocone found at it form an umbrella: then it knows which of
//!    the tetrahedra around it lie on the same side.
//! 2. Where all vertices are good, *mark*: outside spreads from infinity, and the side changes exactly at
//!    those triangles. The boundary is Cocone's surface.
//! 3. Otherwise good vertices may contradict each other, and elsewhere nobody says anything. The published
//!    method takes what comes first and peels the rest. Here all evidence is collected, and
//!    a minimum cut (Labatut et al. 2009) takes the sides that agree best with it and whose boundary costs least.
//! 4. The set inside is made such that its boundary is a manifold, which the published method leaves open.

mod cut;
mod evidence;
mod forest;
mod scales;

use crate::canonical::Canonical;
use crate::facet_set::FacetSet;
use crate::sheet::Sheet;
use crate::solid::{Side, Solid};
use crate::umbrella::Links;
use cut::{NO_ARC, Network};
use evidence::Evidence;
use pellicle_delaunay::{FacetId, TetId};
use pellicle_geometry::VertexId;
use scales::Scales;

/// The boundary of the tetrahedra inside, seen from outside, and how many of them were moved to make it a
/// manifold. `surface` is what Cocone found.
pub(crate) fn close(canonical: &Canonical, surface: &FacetSet) -> (Sheet, usize) {
    let facets: Vec<_> = surface
        .iter(canonical)
        .map(|facet| canonical.facet(facet))
        .collect();
    let links = Links::of(canonical.vertex_count(), &facets);
    let good: Vec<bool> = canonical
        .vertex_ids()
        .map(|v| links.is_umbrella(v))
        .collect();

    let (sides, wanted) = match good.contains(&false) {
        false => (mark(canonical, surface), Vec::new()),
        true => cut_apart(canonical, surface, &good),
    };
    let mut solid = Solid::new(canonical, sides, &good);
    let moved = solid.make_manifold() + solid.reach(&wanted);
    (solid.boundary(), moved)
}

/// The sides when all vertices are good: the surface is closed, so every way from infinity says the same.
fn mark(canonical: &Canonical, surface: &FacetSet) -> Vec<Side> {
    let mut sides = vec![None; canonical.tets().len()];
    let mut pending: Vec<TetId> = tet_ids(canonical).skip(canonical.finite_count()).collect();
    for tet in &pending {
        sides[tet.index()] = Some(Side::Outside);
    }
    while let Some(tet) = pending.pop() {
        let side = sides[tet.index()].unwrap_or(Side::Outside);
        for twin in canonical.twins(tet) {
            let neighbor = &mut sides[twin.tet().index()];
            if neighbor.is_none() {
                *neighbor = Some(match surface.contains(twin) {
                    true => side.opposite(),
                    false => side,
                });
                pending.push(twin.tet());
            }
        }
    }
    let known = |side: Option<Side>| side.unwrap_or(Side::Outside);
    sides.into_iter().map(known).collect()
}

/// The sides that agree best with the evidence and have a cheap boundary, and the vertices that the boundary
/// ought to reach: those with many good neighbours, which are not noise, but no outliers.
fn cut_apart(
    canonical: &Canonical,
    surface: &FacetSet,
    good: &[bool],
) -> (Vec<Side>, Vec<VertexId>) {
    let scales = Scales::of(canonical);
    let Evidence { votes, sure } = Evidence::of(&scales, surface, good);
    let mut sides: Vec<Side> = (tet_ids(canonical).zip(&votes))
        .map(
            |(tet, &vote)| match canonical.is_finite(tet) && vote >= 0.0 {
                true => Side::Inside,
                false => Side::Outside,
            },
        )
        .collect();

    // Only tetrahedra in doubt are nodes; the others add what a boundary to them costs to the terminals.
    let doubtful: Vec<TetId> = tet_ids(canonical).filter(|t| !sure[t.index()]).collect();
    let mut nodes = vec![NO_ARC; sides.len()];
    for (node, tet) in doubtful.iter().enumerate() {
        nodes[tet.index()] = node as u32;
    }
    let mut twins = vec![[NO_ARC; 4]; doubtful.len()];
    let mut capacities = vec![[0; 4]; doubtful.len()];
    let mut terminals = Vec::with_capacity(doubtful.len());
    for (node, &tet) in doubtful.iter().enumerate() {
        let mut terminal = -to_capacity(votes[tet.index()]);
        for (corner, twin) in canonical.twins(tet).into_iter().enumerate() {
            let cost = facet_cost(&scales, surface, twin.min(FacetId::of(tet, corner)));
            let neighbor = twin.tet().index();
            match (nodes[neighbor], sides[neighbor]) {
                (NO_ARC, Side::Outside) => terminal += cost,
                (NO_ARC, Side::Inside) => terminal -= cost,
                (neighbor, _) => {
                    twins[node][corner] = 4 * neighbor + twin.corner() as u32;
                    capacities[node][corner] = cost;
                }
            }
        }
        terminals.push(terminal);
    }
    let is_outside = Network::new(twins, capacities, terminals).source_side();
    for (tet, is_outside) in doubtful.iter().zip(is_outside) {
        sides[tet.index()] = match is_outside {
            true => Side::Outside,
            false => Side::Inside,
        };
    }
    let is_wanted =
        |v: &VertexId| scales.share_of_neighbors(*v, good) >= 0.4 && !scales.is_remote(*v);
    (sides, canonical.vertex_ids().filter(is_wanted).collect())
}

fn tet_ids(canonical: &Canonical) -> impl ExactSizeIterator<Item = TetId> + use<> {
    (0..canonical.tets().len()).map(TetId::new)
}

/// What the facet costs in the boundary: little where it looks like one of a well-sampled surface, a lot where
/// it is large for the points there, a fifth where Cocone has it too. The same from both sides.
fn facet_cost(scales: &Scales, surface: &FacetSet, facet: FacetId) -> i64 {
    let width = scales.facet_width(facet).min(20.0);
    let cost = 0.05 + scales.facet_bend(facet) + 0.25 * width * width;
    to_capacity(match surface.contains(facet) {
        true => 0.2 * cost,
        false => cost,
    })
}

/// Integers, so that sums do not depend on their order.
fn to_capacity(cost: f64) -> i64 {
    (cost * 65536.0) as i64
}
