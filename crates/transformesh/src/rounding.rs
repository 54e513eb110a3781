//! New vertices rounded to doubles, and what that may break.

use crate::arrangement::compare_coordinates;
use crate::hash::FastMap;
use crate::weld::is_flat;
use pellicle_geometry::{Aabb, DVec3, VertexId};
use pellicle_mesh::{MeshView, TriangleId, TriangleSoup, triangles_intersect};
use pellicle_spatial::Bvh;
use std::ops::ControlFlow;

/// Triangles with a rounded corner that have no area, or that intersect others, as pairs.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Broken {
    pub flat: usize,
    pub pairs: usize,
}

impl Broken {
    pub(crate) fn count(self) -> usize {
        self.flat + self.pairs
    }
}

/// What rounding broke: only triangles with a rounded corner can be.
pub(crate) fn broken(soup: &TriangleSoup, is_rounded: impl Fn(VertexId) -> bool) -> Broken {
    let view = MeshView::from(soup);
    let corners = |t: u32| view.corners(TriangleId(t)).unwrap_or_default();
    let moved: Vec<u32> = (0..soup.triangles.len() as u32)
        .filter(|&t| soup.triangles[t as usize].iter().any(|&v| is_rounded(v)))
        .collect();
    let mut result = Broken { flat: 0, pairs: 0 };
    if moved.is_empty() {
        return result;
    }
    result.flat = moved.iter().filter(|&&t| is_flat(corners(t))).count();
    let bvh = Bvh::new(moved.iter().map(|&t| Aabb::of_points(&corners(t))));
    let bounds = bvh.bounds();
    for t in 0..soup.triangles.len() as u32 {
        let own = corners(t);
        let own_box = Aabb::of_points(&own);
        if !own_box.overlaps(bounds) {
            continue;
        }
        let is_moved = moved.binary_search(&t).is_ok();
        let _ = bvh.overlapping(own_box, |i| {
            let other = moved[i as usize];
            // A pair of two rounded triangles is met twice.
            let first_time = !is_moved || other < t;
            if other != t && first_time && triangles_intersect(own, corners(other)) {
                result.pairs += 1;
            }
            ControlFlow::Continue(())
        });
    }
    result
}

/// Moves each rounded vertex to the place of another one that is within a distance, if there is one: of a vertex that is
/// not rounded, or else of one with lesser coordinates. Depends on the places alone.
pub(crate) fn gather(positions: &mut [DVec3], is_rounded: &[bool], distance: f64) {
    let cell = |p: DVec3| (p / (2.0 * distance)).floor().to_array().map(|x| x as i64);
    let mut order: Vec<usize> = (0..positions.len()).collect();
    order.sort_by(|&v, &w| {
        let places = compare_coordinates(&positions[v].to_array(), &positions[w].to_array());
        is_rounded[v].cmp(&is_rounded[w]).then(places)
    });
    // Only cells near rounded vertices matter.
    let mut near: FastMap<[i64; 3], Vec<DVec3>> = FastMap::default();
    let around = |p: DVec3| {
        let [x, y, z] = cell(p);
        (0..27).map(move |i| {
            let [i, j, k] = [i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1];
            [x.wrapping_add(i), y.wrapping_add(j), z.wrapping_add(k)]
        })
    };
    for &v in order.iter().filter(|&&v| is_rounded[v]) {
        near.extend(around(positions[v]).map(|cell| (cell, Vec::new())));
    }
    for v in order {
        let at = positions[v];
        if is_rounded[v] {
            let others = around(at).filter_map(|cell| near.get(&cell)).flatten();
            let close = others.filter(|p| p.distance(at) <= distance);
            let nearest = close.min_by(|p, q| {
                let places = || compare_coordinates(&p.to_array(), &q.to_array());
                (p.distance(at).total_cmp(&q.distance(at))).then_with(places)
            });
            if let Some(&nearest) = nearest {
                positions[v] = nearest;
                continue;
            }
        }
        if let Some(places) = near.get_mut(&cell(at)) {
            places.push(at);
        }
    }
}
