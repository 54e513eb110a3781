//! New vertices rounded to doubles, and what that may break.

use crate::weld::is_flat;
use pellicle_geometry::{Aabb, VertexId};
use pellicle_mesh::{MeshView, TriangleId, TriangleSoup, triangles_intersect};
use pellicle_spatial::Bvh;
use std::ops::ControlFlow;

/// Triangles with a rounded corner that have no area, or that intersect others, as pairs.
pub(crate) struct Broken {
    pub flat: usize,
    pub pairs: usize,
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
