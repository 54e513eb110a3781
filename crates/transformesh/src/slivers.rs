//! Triangles thinner than rounding can keep apart, taken out of a manifold.
//!
//! ```text
//!     needle: two corners close together          cap: a corner close to the opposite edge
//!
//!     a ─────────────── b                               c
//!       `──────────────c                          a ─── ´ ─────── b        flip ab
//!     collapse bc                                       d
//! ```
//!
//! Only corners that rounding moved vanish, into the other end of their edge; no vertex moves.

use crate::weld::key;
use pellicle_geometry::{DVec3, VertexId};
use pellicle_mesh::{HalfEdgeId, MeshEditor, TriMesh, TriangleId};
use std::cmp::Ordering;

/// The mesh without its slivers.
pub(crate) struct Cleaned {
    pub mesh: TriMesh,
    /// For each triangle the one that it was.
    pub triangles: Vec<TriangleId>,
    /// For each vertex the one that it was.
    pub vertices: Vec<VertexId>,
}

/// Takes out triangles with a rounded corner and a height of at most `thickness`, as far as the topology allows. The
/// result depends on coordinates alone, up to the order of its elements.
pub(crate) fn without_slivers(mesh: TriMesh, is_rounded: &[bool], thickness: f64) -> Cleaned {
    /// A flip may make a sliver of the neighbour; most are gone after two.
    const PASSES: usize = 8;
    let mut editor = MeshEditor::new(mesh);
    for _ in 0..PASSES {
        let mut slivers: Vec<_> = triangles(&editor)
            .filter(|&t| is_sliver(&editor, t, is_rounded, thickness))
            .map(|t| (sorted_keys(&editor, t), t))
            .collect();
        slivers.sort();
        let mut changed = false;
        for (_, t) in slivers {
            // It may have gone or changed meanwhile.
            if is_sliver(&editor, t, is_rounded, thickness) {
                changed |= collapse(&mut editor, t, is_rounded, thickness) || flip(&mut editor, t);
            }
        }
        if !changed {
            break;
        }
    }
    let triangles = triangles(&editor).collect();
    let (mesh, remap) = editor.finish();
    Cleaned {
        mesh,
        triangles,
        vertices: remap.old_of_new,
    }
}

fn triangles(editor: &MeshEditor) -> impl Iterator<Item = TriangleId> + '_ {
    let half_edges = editor.half_edges().filter(|h| h.corner() == 0);
    half_edges.map(HalfEdgeId::triangle)
}

/// The corners of a triangle that is still there, with their places.
fn corners(editor: &MeshEditor, t: TriangleId) -> Option<[(VertexId, DVec3); 3]> {
    let corner = |i| {
        let [v, _] = editor.ends(HalfEdgeId::of(t, i))?;
        Some((v, editor.position(v)?))
    };
    Some([corner(0)?, corner(1)?, corner(2)?])
}

fn sorted_keys(editor: &MeshEditor, t: TriangleId) -> [[u64; 3]; 3] {
    let mut keys = corners(editor, t).map_or([[0; 3]; 3], |c| c.map(|(_, p)| key(p)));
    keys.sort_unstable();
    keys
}

/// The least height of a triangle; 0 where it has none.
fn height([a, b, c]: [DVec3; 3]) -> f64 {
    let longest = (b - a).length().max((c - b).length()).max((a - c).length());
    let height = (b - a).cross(c - a).length() / longest;
    if height.is_nan() { 0.0 } else { height }
}

fn is_sliver(editor: &MeshEditor, t: TriangleId, is_rounded: &[bool], thickness: f64) -> bool {
    corners(editor, t).is_some_and(|corners| {
        corners.iter().any(|&(v, _)| is_rounded[v.index()])
            && height(corners.map(|(_, p)| p)) <= thickness
    })
}

/// Collapses the shortest edge of a needle.
fn collapse(editor: &mut MeshEditor, t: TriangleId, is_rounded: &[bool], thickness: f64) -> bool {
    let mut edges = [0, 1, 2].map(|i| {
        let h = HalfEdgeId::of(t, i);
        let ends = editor
            .ends(h)
            .map(|ends| ends.map(|v| (v, editor.position(v))));
        (h, ends)
    });
    let length = |ends: &Option<[(VertexId, Option<DVec3>); 2]>| match ends {
        Some([(_, Some(a)), (_, Some(b))]) => a.distance(*b),
        _ => f64::INFINITY,
    };
    edges.sort_by(|(_, a), (_, b)| length(a).total_cmp(&length(b)));
    for (h, ends) in edges {
        // The sides of the sliver that are about as short as it is thin.
        if length(&ends) > 4.0 * thickness {
            return false;
        }
        let Some([(a, Some(at_a)), (b, Some(at_b))]) = ends else {
            return false;
        };
        let first_is_less = key(at_a).cmp(&key(at_b)) == Ordering::Less;
        let goes_first = match (is_rounded[a.index()], is_rounded[b.index()]) {
            (true, false) => true,
            (false, true) => false,
            (true, true) => first_is_less,
            (false, false) => continue,
        };
        // The vertex that a half-edge leaves goes.
        let (leaving, to) = match goes_first {
            true => (Some(h), at_b),
            false => (editor.twin(h), at_a),
        };
        if leaving.is_some_and(|h| editor.collapse(h, to).is_ok()) {
            return true;
        }
    }
    false
}

/// Flips the longest edge of a cap, if that makes the thinner of the two triangles thicker.
fn flip(editor: &mut MeshEditor, t: TriangleId) -> bool {
    let Some(at) = corners(editor, t).map(|corners| corners.map(|(_, p)| p)) else {
        return false;
    };
    let length = |i: usize| at[i].distance(at[(i + 1) % 3]);
    let longest = (0..3).max_by(|&i, &j| length(i).total_cmp(&length(j)));
    let Some(i) = longest else { return false };
    let h = HalfEdgeId::of(t, i);
    let Some(d) = (editor.twin(h))
        .and_then(|twin| editor.ends(twin.previous()))
        .and_then(|[d, _]| editor.position(d))
    else {
        return false;
    };
    let [a, b, c] = [i, (i + 1) % 3, (i + 2) % 3].map(|k| at[k]);
    let before = height([a, b, c]).min(height([b, a, d]));
    let after = height([a, d, c]).min(height([d, b, c]));
    after > before && editor.flip(h).is_ok()
}
