//! The half-edges of a soup, grouped by the undirected edge that they lie on.

use crate::{HalfEdgeId, MeshView, TriangleId};
use pellicle_geometry::VertexId;

/// A half-edge at an edge of an [`EdgeTable`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct EdgeEntry {
    /// The higher of the two vertices.
    upper: u32,
    /// The half-edge.
    pub half_edge: HalfEdgeId,
}

/// Half-edges of the usable triangles (three vertices that exist and differ), sorted by lower vertex,
/// then upper vertex, then id.
///
/// One counting sort by the lower vertex, then a small sort in each bucket: O(n log d), with d the
/// largest degree, and faster than a hash map. 8 bytes a half-edge and 4 a vertex.
///
/// ```
/// use pellicle_geometry::VertexId;
/// use pellicle_mesh::{EdgeTable, icosphere};
/// let sphere = icosphere(0)?;
/// let table = EdgeTable::new((&sphere).into());
/// assert_eq!(table.edges().count(), 30);
/// assert!(table.edges().all(|(_, entries)| entries.len() == 2));
/// # Ok::<(), pellicle_mesh::MeshError>(())
/// ```
#[derive(Clone, Debug)]
pub struct EdgeTable {
    first: Vec<u32>,
    entries: Vec<EdgeEntry>,
}

impl EdgeTable {
    /// The table of a mesh whose elements `u32` ids can name. Positions are only counted.
    pub fn new(mesh: MeshView) -> Self {
        debug_assert!(mesh.fits_ids());
        let mut first = vec![0_u32; mesh.positions.len() + 1];
        for_each_half_edge(mesh, |lower, _, _| first[lower + 1] += 1);
        for v in 1..first.len() {
            first[v] += first[v - 1];
        }
        let blank = EdgeEntry {
            upper: 0,
            half_edge: HalfEdgeId::NONE,
        };
        let mut entries = vec![blank; first.last().map_or(0, |&n| n as usize)];
        let mut cursor = first.clone();
        for_each_half_edge(mesh, |lower, upper, half_edge| {
            entries[cursor[lower] as usize] = EdgeEntry { upper, half_edge };
            cursor[lower] += 1;
        });
        for v in 0..mesh.positions.len() {
            entries[first[v] as usize..first[v + 1] as usize].sort_unstable();
        }
        Self { first, entries }
    }

    /// The edges in the order of (lower vertex, upper vertex), each with its half-edges in order of id.
    pub fn edges(&self) -> impl Iterator<Item = ([VertexId; 2], &[EdgeEntry])> {
        (0..self.first.len() - 1).flat_map(move |v| {
            self.entries[self.first[v] as usize..self.first[v + 1] as usize]
                .chunk_by(|a, b| a.upper == b.upper)
                .map(move |group| ([VertexId::new(v), VertexId(group[0].upper)], group))
        })
    }
}

fn for_each_half_edge(mesh: MeshView, mut visit: impl FnMut(usize, u32, HalfEdgeId)) {
    for (t, &triangle) in mesh.triangles.iter().enumerate() {
        if !mesh.is_usable(triangle) {
            continue;
        }
        for i in 0..3 {
            let (a, b) = (triangle[i], triangle[(i + 1) % 3]);
            let half_edge = HalfEdgeId::of(TriangleId::new(t), i);
            visit(a.min(b).index(), a.max(b).0, half_edge);
        }
    }
}

/// The vertex that a half-edge leaves.
#[inline]
pub(crate) fn origin(triangles: &[[VertexId; 3]], h: HalfEdgeId) -> VertexId {
    triangles.as_flattened()[h.0 as usize]
}

/// The corner (as the half-edge that leaves it) of a half-edge's triangle at one end of its edge.
#[inline]
pub(crate) fn corner_at(triangles: &[[VertexId; 3]], h: HalfEdgeId, end: VertexId) -> HalfEdgeId {
    if origin(triangles, h) == end {
        h
    } else {
        h.next()
    }
}

/// The half-edges of an edge as an oriented manifold has them where there is no border: two, in opposite
/// directions.
#[inline]
pub(crate) fn twins_of(
    triangles: &[[VertexId; 3]],
    group: &[EdgeEntry],
) -> Option<(HalfEdgeId, HalfEdgeId)> {
    match group {
        [a, b] if origin(triangles, a.half_edge) != origin(triangles, b.half_edge) => {
            Some((a.half_edge, b.half_edge))
        }
        _ => None,
    }
}
