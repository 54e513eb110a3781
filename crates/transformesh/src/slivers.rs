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
///
/// `scale`, a power of two near the largest coordinate, keeps products from overflow and underflow.
pub(crate) fn without_slivers(
    mesh: TriMesh,
    is_rounded: &[bool],
    thickness: f64,
    scale: f64,
) -> Cleaned {
    /// A flip may make a sliver of the neighbour; most are gone after two.
    const PASSES: usize = 8;
    let mut work = Work {
        is_rounded,
        thickness: thickness / scale,
        scale,
        origins: mesh.triangle_ids().collect(),
        editor: MeshEditor::new(mesh),
    };
    for _ in 0..PASSES {
        let mut slivers: Vec<_> = (work.triangles())
            .filter(|&t| work.is_sliver(t))
            .map(|t| (work.sorted_keys(t), t))
            .collect();
        slivers.sort();
        let mut changed = false;
        for (_, t) in slivers {
            // It may have gone or changed meanwhile.
            if work.is_sliver(t) {
                changed |= work.collapse(t) || work.flip(t);
            }
        }
        if !changed {
            break;
        }
    }
    let triangles = work.triangles().map(|t| work.origins[t.index()]).collect();
    let (mesh, remap) = work.editor.finish();
    Cleaned {
        mesh,
        triangles,
        vertices: remap.old_of_new,
    }
}

struct Work<'a> {
    editor: MeshEditor,
    is_rounded: &'a [bool],
    /// In units of the scale.
    thickness: f64,
    scale: f64,
    /// For each triangle the one that it is nearly a part of.
    origins: Vec<TriangleId>,
}

impl Work<'_> {
    fn triangles(&self) -> impl Iterator<Item = TriangleId> + '_ {
        let half_edges = self.editor.half_edges().filter(|h| h.corner() == 0);
        half_edges.map(HalfEdgeId::triangle)
    }

    /// The ends of a half-edge that is still there.
    fn ends(&self, h: HalfEdgeId) -> Option<[(VertexId, DVec3); 2]> {
        let [a, b] = self.editor.ends(h)?;
        Some([(a, self.editor.position(a)?), (b, self.editor.position(b)?)])
    }

    /// The corners of a triangle that is still there.
    fn corners(&self, t: TriangleId) -> Option<[(VertexId, DVec3); 3]> {
        let [a, b] = self.ends(HalfEdgeId::of(t, 0))?;
        let [c, _] = self.ends(HalfEdgeId::of(t, 2))?;
        Some([a, b, c])
    }

    fn sorted_keys(&self, t: TriangleId) -> [[u64; 3]; 3] {
        let mut keys = (self.corners(t)).map_or([[0; 3]; 3], |c| c.map(|(_, p)| key(p)));
        keys.sort_unstable();
        keys
    }

    /// The least height of a triangle, in units of the scale; 0 where it has none.
    fn height(&self, corners: [DVec3; 3]) -> f64 {
        let [a, b, c] = corners.map(|p| p / self.scale);
        let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
        let height = (b - a).cross(c - a).length() / longest;
        if height.is_nan() { 0.0 } else { height }
    }

    fn is_sliver(&self, t: TriangleId) -> bool {
        self.corners(t).is_some_and(|corners| {
            corners.iter().any(|&(v, _)| self.is_rounded[v.index()])
                && self.height(corners.map(|(_, p)| p)) <= self.thickness
        })
    }

    /// Collapses the shortest edge of a needle.
    fn collapse(&mut self, t: TriangleId) -> bool {
        let edges = [0, 1, 2].map(|i| HalfEdgeId::of(t, i));
        let length = |h: HalfEdgeId| match self.ends(h) {
            Some([(_, a), (_, b)]) => (a / self.scale).distance(b / self.scale),
            None => f64::INFINITY,
        };
        let mut edges = edges.map(|h| (length(h), h));
        edges.sort_by(|(a, _), (b, _)| a.total_cmp(b));
        for (length, h) in edges {
            // The sides of the sliver that are about as short as it is thin.
            if length > 4.0 * self.thickness {
                return false;
            }
            let Some([(a, at_a), (b, at_b)]) = self.ends(h) else {
                return false;
            };
            let a_goes = match (self.is_rounded[a.index()], self.is_rounded[b.index()]) {
                (true, false) => true,
                (false, true) => false,
                (true, true) => key(at_a) < key(at_b),
                (false, false) => continue,
            };
            // The vertex that a half-edge leaves goes.
            let (leaving, to) = match a_goes {
                true => (Some(h), at_b),
                false => (self.editor.twin(h), at_a),
            };
            if leaving.is_some_and(|h| self.editor.collapse(h, to).is_ok()) {
                return true;
            }
        }
        false
    }

    /// Flips the longest edge of a cap, if that makes the thinner of the two triangles thicker.
    fn flip(&mut self, t: TriangleId) -> bool {
        let Some(at) = self.corners(t).map(|corners| corners.map(|(_, p)| p)) else {
            return false;
        };
        let length = |i: usize| (at[i] / self.scale).distance(at[(i + 1) % 3] / self.scale);
        let longest = (0..3).max_by(|&i, &j| length(i).total_cmp(&length(j)));
        let Some(i) = longest else { return false };
        let h = HalfEdgeId::of(t, i);
        let across = self
            .editor
            .twin(h)
            .and_then(|twin| self.ends(twin.previous()));
        let Some([(_, d), _]) = across else {
            return false;
        };
        let [a, b, c] = [i, (i + 1) % 3, (i + 2) % 3].map(|k| at[k]);
        let before = self.height([a, b, c]).min(self.height([b, a, d]));
        let after = self.height([a, d, c]).min(self.height([d, b, c]));
        let Some(twin) = self.editor.twin(h) else {
            return false;
        };
        let flipped = after > before && self.editor.flip(h).is_ok();
        if flipped {
            // Both halve the thicker of the two; the sliver is no more.
            let thicker = match self.height([a, b, c]) < self.height([b, a, d]) {
                true => twin.triangle(),
                false => t,
            };
            let origin = self.origins[thicker.index()];
            self.origins[t.index()] = origin;
            self.origins[twin.triangle().index()] = origin;
        }
        flipped
    }
}
