//! What is reached from outside: [`crate::Rule::Outside`].

use crate::arrangement::Arrangement;
use crate::fan::fan;
use crate::points::Points;
use crate::ray::Rays;
use crate::stitch::Fate;
use crate::weld::Weld;
use pellicle_geometry::UnionFind;
use pellicle_mesh::{EdgeTable, MeshView, TriMesh, TriangleId, TriangleSoup};

/// The triangles of a closed mesh without self-intersections that no other component encloses: without the borders of
/// sealed voids, and whatever lies in them. Returns the triangles kept, and whether those are all.
pub(crate) fn reached(mesh: &TriMesh) -> (Vec<bool>, bool) {
    let component_of = components(mesh);
    let weld = Weld::new(mesh.into());
    let mut is_first = vec![true; mesh.positions().len()];
    let firsts: Vec<usize> = (0..weld.triangles.len())
        .filter(|&t| {
            let component = component_of[weld.sources[t].index()] as usize;
            std::mem::replace(&mut is_first[component], false)
        })
        .collect();
    let mut is_enclosed = vec![false; mesh.positions().len()];
    if firsts.len() > 1 {
        let mut weld = weld;
        let mut points = Points::new(&mut weld);
        let rays = Rays::new(&weld, firsts.len());
        for first in firsts {
            let own = component_of[weld.sources[first].index()];
            let mut turns: Vec<(u32, i32)> = Vec::new();
            rays.turns(first, &mut points, |t, turn| {
                turns.push((component_of[weld.sources[t].index()], turn));
            });
            turns.sort_unstable();
            is_enclosed[own as usize] = turns.chunk_by(|a, b| a.0 == b.0).any(|of_one| {
                of_one[0].0 != own && of_one.iter().map(|&(_, turn)| turn).sum::<i32>() != 0
            });
        }
    }
    let kept: Vec<bool> = component_of
        .iter()
        .map(|&component| !is_enclosed[component as usize])
        .collect();
    let all = !kept.contains(&false);
    (kept, all)
}

/// For each triangle the least vertex of its component.
fn components(mesh: &TriMesh) -> Vec<u32> {
    let mut sets = UnionFind::new(mesh.positions().len());
    for &[a, b, c] in mesh.triangles() {
        sets.union(a.0, b.0);
        sets.union(a.0, c.0);
    }
    let triangles = mesh.triangles().iter();
    triangles.map(|t| sets.find(t[0].0)).collect()
}

/// Some triangles of a mesh, and those that they were.
pub(crate) fn select(mesh: MeshView, kept: &[bool]) -> (TriangleSoup, Vec<TriangleId>) {
    let chosen = (0..mesh.triangles.len()).filter(|&t| kept[t]);
    let sources: Vec<TriangleId> = chosen.map(TriangleId::new).collect();
    let triangles = sources.iter().map(|t| mesh.triangles[t.index()]);
    let soup = TriangleSoup {
        positions: mesh.positions.to_vec(),
        triangles: triangles.collect(),
    };
    (soup, sources)
}

/// What is seen from outside of an open surface: the region grows over fronts from seeds in front of which nothing lies,
/// across every edge where sheets cross, but not around a border (Zaharescu et al. 2007, section 2.3). Facets with the
/// outside in front are kept.
pub(crate) fn fates_of_open(
    arrangement: &Arrangement,
    table: &EdgeTable,
    weld: &Weld,
    points: &mut Points,
) -> Vec<Fate> {
    let front = |facet: u32| 2 * facet;
    let back = |facet: u32| 2 * facet + 1;
    let mut sides = UnionFind::new(2 * arrangement.facets.len());
    for (edge, entries) in table.edges() {
        if entries.len() < 2 {
            continue;
        }
        let leaves = fan(arrangement, weld, points, edge, entries);
        for (i, leaf) in leaves.iter().enumerate() {
            let next = &leaves[if i + 1 == leaves.len() { 0 } else { i + 1 }];
            let later = if leaf.forward {
                front(leaf.facet)
            } else {
                back(leaf.facet)
            };
            let earlier = if next.forward {
                back(next.facet)
            } else {
                front(next.facet)
            };
            sides.union(later, earlier);
        }
    }
    let rays = Rays::new(weld, usize::MAX);
    let mut is_outside = vec![false; 2 * arrangement.facets.len()];
    for (piece, &facet) in arrangement.pieces.iter().zip(&arrangement.facet_of) {
        let region = sides.find(front(facet)) as usize;
        let triangle = arrangement.facets[facet as usize].triangle as usize;
        if !is_outside[region] && rays.escapes(triangle, *piece, points) {
            is_outside[region] = true;
        }
    }
    let mut is_seen = |facet: u32| is_outside[sides.find(front(facet)) as usize];
    let facets = arrangement.facets.iter().zip(0..);
    facets
        .map(|(of, facet)| match is_seen(facet) && of.multiplicity > 0 {
            true => Fate::Kept,
            false => Fate::Dropped,
        })
        .collect()
}
