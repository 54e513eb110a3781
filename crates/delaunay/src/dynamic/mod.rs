//! A tetrahedralisation that owns its points and changes with them.

mod convert;
mod flat;
mod insert;
mod queries;
mod remove;

#[cfg(test)]
mod tests;

use crate::{
    TetId,
    build::{INFINITE, Stepwise},
};
use flat::Flat;
use pellicle_geometry::{Aabb, DVec3, VertexId};

/// The Delaunay tetrahedralisation of a set of points that grows and shrinks.
///
/// After any sequence of [`insert`](Self::insert) and [`remove`](Self::remove) the set of tetrahedra is that
/// of [`tetrahedralize`](crate::tetrahedralize) on the points that are there: it depends on them alone, not
/// on what happened before. Their ids and order do depend on it.
///
/// *Ids.* A vertex keeps its id until it is removed; then the id is free for the next insertion. A
/// tetrahedron keeps its id, and the order of its corners, until an insertion or removal takes it away; ids
/// of tetrahedra have gaps. Infinite tetrahedra have [`INFINITE`](Self::INFINITE) as their corner 3.
///
/// *Few points.* While the points span no tetrahedron (fewer than four, or all on a line or in a plane) there
/// is none, and [`dimension`](Self::dimension) is less than 3.
///
/// For points that do not change [`tetrahedralize`](crate::tetrahedralize) is faster and takes less memory.
/// Here each vertex takes about 32 bytes and each tetrahedron 33, those that were removed included until
/// their room is used again; there is half a megabyte of working storage.
///
/// ```
/// use pellicle_delaunay::DynamicTetrahedralization;
/// use pellicle_geometry::DVec3;
///
/// let mut tetrahedralization = DynamicTetrahedralization::new();
/// for point in [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z] {
///     tetrahedralization.insert(point)?;
/// }
/// assert_eq!(tetrahedralization.finite_tets().count(), 1);
///
/// let inside = tetrahedralization.insert(DVec3::splat(0.1))?;
/// assert_eq!(tetrahedralization.finite_tets().count(), 4);
///
/// assert_eq!(tetrahedralization.remove(inside)?, DVec3::splat(0.1));
/// assert_eq!(tetrahedralization.finite_tets().count(), 1);
/// # Ok::<(), pellicle_delaunay::Error>(())
/// ```
pub struct DynamicTetrahedralization {
    /// The tetrahedra, and the points. A vertex of the kernel has the next higher id, since the kernel's 0
    /// is the vertex at infinity. The point of an id that is free is not a number.
    kernel: Stepwise,
    /// By vertex, one tetrahedron at it, finite or not; `NONE` for free ids and while the points are flat.
    incident: Vec<TetId>,
    /// The ids that are free.
    free: Vec<VertexId>,
    /// Stands for the tetrahedra while there are none.
    flat: Option<Flat>,
    /// Holds all points, and perhaps some that were removed.
    bounds: Aabb,
    /// How many removals ago `bounds` was a tight box.
    removals: usize,
    /// The tetrahedra that the last step made.
    filling: Vec<TetId>,
    /// Where the holes of removed vertices are tetrahedralised; its storage is kept.
    workplace: Box<remove::Workplace>,
}

impl DynamicTetrahedralization {
    /// The vertex at infinity.
    pub const INFINITE: VertexId = VertexId::NONE;

    /// A tetrahedralisation without points.
    pub fn new() -> Self {
        Self {
            kernel: Stepwise::new(),
            incident: Vec::new(),
            free: Vec::new(),
            flat: Some(Flat::default()),
            bounds: Aabb::EMPTY,
            removals: 0,
            filling: Vec::new(),
            workplace: Box::default(),
        }
    }

    /// How many vertices there are.
    #[inline]
    pub fn vertex_count(&self) -> usize {
        self.incident.len() - self.free.len()
    }

    /// The point of a vertex; `None` if the id names none.
    #[inline]
    pub fn point(&self, vertex: VertexId) -> Option<DVec3> {
        if vertex.index() >= self.incident.len() {
            return None;
        }
        let point = self.kernel.point(inner(vertex));
        (!point.x.is_nan()).then_some(point)
    }

    /// All vertices, by id.
    pub fn vertices(&self) -> impl Iterator<Item = VertexId> + '_ {
        (0..self.incident.len())
            .map(VertexId::new)
            .filter(|&vertex| self.point(vertex).is_some())
    }

    /// The dimension of the points: 3 if they span a tetrahedron, 2 in a plane, 1 on a line, 0 for a single
    /// one, `None` without any.
    pub fn dimension(&self) -> Option<usize> {
        match &self.flat {
            None => Some(3),
            Some(flat) => flat.dimension(),
        }
    }

    /// The points as the kernel has them, without the vertex at infinity; free ids have no number.
    fn present(&self) -> impl Iterator<Item = (VertexId, DVec3)> + '_ {
        (0..self.incident.len())
            .map(VertexId::new)
            .map(|vertex| (vertex, self.kernel.point(inner(vertex))))
            .filter(|(_, point)| !point.x.is_nan())
    }

    /// The smallest box around all points.
    fn tight_bounds(&self) -> Aabb {
        (self.present()).fold(Aabb::EMPTY, |bounds, (_, point)| bounds.with(point))
    }

    /// Records the tetrahedra of `filling` at each of their corners.
    fn register(&mut self) {
        for &tet in &self.filling {
            for corner in self.kernel.corners(tet) {
                if corner != INFINITE {
                    self.incident[outer(corner).index()] = tet;
                }
            }
        }
    }
}

impl Default for DynamicTetrahedralization {
    fn default() -> Self {
        Self::new()
    }
}

impl std::fmt::Debug for DynamicTetrahedralization {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("DynamicTetrahedralization")
            .field("vertices", &self.vertex_count())
            .field("dimension", &self.dimension())
            .finish_non_exhaustive()
    }
}

/// The kernel's id of a vertex.
#[inline(always)]
fn inner(vertex: VertexId) -> VertexId {
    VertexId(vertex.0.wrapping_add(1))
}

/// The vertex of a kernel's id: infinity, 0 there, becomes `NONE`.
#[inline(always)]
fn outer(vertex: VertexId) -> VertexId {
    VertexId(vertex.0.wrapping_sub(1))
}
