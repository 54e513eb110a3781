//! What is reached from outside: [`crate::Rule::Outside`].

use crate::arrangement::{Arrangement, compare_coordinates};
use crate::fan::fan;
use crate::points::Points;
use crate::ray::Rays;
use crate::stitch::Fate;
use crate::weld::Weld;
use pellicle_geometry::{DVec3, UnionFind, VertexId};
use pellicle_mesh::{EdgeTable, MeshView, TriMesh, TriangleId, TriangleSoup, components};
use rayon::prelude::*;
use std::cmp::Ordering;
use std::f64::consts::PI;

/// The triangles of a closed mesh without self-intersections that no other component encloses: without the borders of
/// sealed voids, and whatever lies in them. Returns the triangles kept, and whether those are all.
pub(crate) fn reached(mesh: &TriMesh) -> (Vec<bool>, bool) {
    let component_of = components(mesh.into());
    let weld = Weld::new(mesh.into());
    let mut is_first = vec![true; mesh.positions().len()];
    let firsts: Vec<usize> = (0..weld.triangles.len())
        .filter(|&t| {
            let component = component_of[weld.sources[t].index()].index();
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
            let mut turns: Vec<(VertexId, i32)> = Vec::new();
            rays.turns(first, &mut points, |t, turn| {
                turns.push((component_of[weld.sources[t].index()], turn));
            });
            turns.sort_unstable();
            is_enclosed[own.index()] = turns.chunk_by(|a, b| a.0 == b.0).any(|of_one| {
                of_one[0].0 != own && of_one.iter().map(|&(_, turn)| turn).sum::<i32>() != 0
            });
        }
    }
    let kept: Vec<bool> = component_of
        .iter()
        .map(|component| !is_enclosed[component.index()])
        .collect();
    let all = !kept.contains(&false);
    (kept, all)
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

/// What is outside of an open surface: regions grow over fronts, across every edge where sheets cross, but not around a
/// border (Zaharescu et al. 2007, section 2.3). A region is outside if the generalised winding number (Jacobson et al. 2013) is
/// below one half in front of most of it: a ray would not do, since it may come out through the opening.
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
    // The largest pieces of each region stand for it.
    let corners = |piece: usize| arrangement.pieces[piece].map(|v| points.rounded(v));
    let mut pieces: Vec<(u32, f64, [[f64; 3]; 3], usize)> = (0..arrangement.pieces.len())
        .map(|piece| {
            let region = sides.find(front(arrangement.facet_of[piece]));
            let [a, b, c] = corners(piece);
            let mut key = [a, b, c].map(|p| p.to_array());
            key.sort_by(compare_coordinates);
            (region, (b - a).cross(c - a).length(), key, piece)
        })
        .collect();
    pieces.sort_by(|a, b| {
        let places = a.2.iter().zip(&b.2);
        (a.0.cmp(&b.0)).then(b.1.total_cmp(&a.1)).then(
            places.fold(Ordering::Equal, |order, (p, q)| {
                order.then(compare_coordinates(p, q))
            }),
        )
    });
    let mut is_outside = vec![false; 2 * arrangement.facets.len()];
    for of_region in pieces.chunk_by(|a, b| a.0 == b.0) {
        const SAMPLES: usize = 9;
        let samples = &of_region[..of_region.len().min(SAMPLES)];
        let outside = samples
            .iter()
            .filter(|&&(_, _, _, piece)| {
                let [a, b, c] = corners(piece);
                let facet = arrangement.facet_of[piece] as usize;
                let own = arrangement.facets[facet].triangle as usize;
                winding_beside(weld, own, (a + b + c) / 3.0) - 0.5 < 0.5
            })
            .count();
        is_outside[of_region[0].0 as usize] = 2 * outside > samples.len();
    }
    let facets = arrangement.facets.iter().zip(0..);
    facets
        .map(|(of, facet)| {
            let is_seen = is_outside[sides.find(front(facet)) as usize];
            match is_seen && of.multiplicity > 0 {
                true => Fate::Kept,
                false => Fate::Dropped,
            }
        })
        .collect()
}

/// The generalised winding number at a point of a triangle, without what that triangle itself adds: ±½ behind it and in
/// front of it.
fn winding_beside(weld: &Weld, own: usize, at: DVec3) -> f64 {
    // In order, so that threads do not show.
    let parts: Vec<f64> = (0..weld.triangles.len())
        .into_par_iter()
        .with_min_len(4096)
        .map(|t| {
            if t == own {
                0.0
            } else {
                solid_angle(weld.corners(t), at)
            }
        })
        .collect();
    parts.iter().sum::<f64>() / (4.0 * PI)
}

/// The angle under which a triangle is seen, positive from behind (van Oosterom and Strackee 1983).
fn solid_angle(corners: [DVec3; 3], at: DVec3) -> f64 {
    let [a, b, c] = corners.map(|p| (p - at).normalize_or_zero());
    let sine = a.dot(b.cross(c));
    let cosine = 1.0 + a.dot(b) + b.dot(c) + c.dot(a);
    2.0 * sine.atan2(cosine)
}
