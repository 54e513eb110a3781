//! The result, in the order in which the paper's region takes it in.
//!
//! Zaharescu et al. 2007, section 2.3: from a seed, whole triangles are taken from a queue V of valid ones; where one borders
//! on a piece of a cut triangle, that waits in a queue P of partially valid ones until V is empty. What was taken is G.

use crate::observer::{Observer, Piece};
use pellicle_mesh::{HalfEdgeId, MeshView, TriMesh, TriangleId};
use std::collections::VecDeque;

/// Shows an observer the result, component by component: the seed, then each piece as it is taken.
pub(crate) fn grow(
    input: MeshView,
    mesh: &TriMesh,
    sources: &[TriangleId],
    observer: &mut dyn Observer,
) {
    let source = |t: TriangleId| sources.get(t.index()).copied().unwrap_or(t);
    // Whole is what has the corners of its source; of a cut one there may be a single piece left.
    let is_whole = |t: TriangleId| {
        let corners = mesh.corners(t);
        let given = input.corners(source(t));
        given.is_some_and(|given| given.iter().all(|corner| corners.contains(corner)))
    };
    let piece = |t: TriangleId| Piece {
        triangle: source(t),
        corners: mesh.corners(t),
        is_cut: [0, 1, 2].map(|i| {
            let across = mesh.twin(HalfEdgeId::of(t, i)).map(HalfEdgeId::triangle);
            across.is_none_or(|across| {
                source(across) != source(t) && !(is_whole(t) && is_whole(across))
            })
        }),
    };
    let mut seen = vec![false; mesh.triangles().len()];
    for whole_seeds in [true, false] {
        for seed in mesh.triangle_ids() {
            if seen[seed.index()] || is_whole(seed) != whole_seeds {
                continue;
            }
            seen[seed.index()] = true;
            observer.seed(&piece(seed));
            let mut valid = VecDeque::from([seed]);
            let mut partial = VecDeque::new();
            while let Some(t) = valid.pop_front().or_else(|| partial.pop_front()) {
                observer.grown(&piece(t));
                for i in 0..3 {
                    let across = mesh.twin(HalfEdgeId::of(t, i)).map(HalfEdgeId::triangle);
                    if let Some(u) = across
                        && !std::mem::replace(&mut seen[u.index()], true)
                    {
                        match is_whole(u) {
                            true => valid.push_back(u),
                            false => partial.push_back(u),
                        }
                    }
                }
            }
        }
    }
}
