//! Changing connectivity one edge at a time: split, collapse, flip.

mod collapse;
mod flip;
mod split;

use crate::{HalfEdgeId, MeshView, TriMesh, TriangleId, VertexRemap};
use pellicle_geometry::{DVec3, VertexId};

/// Why an edit was refused: the mesh stays as it was.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Refusal {
    /// There is no such half-edge, or an edit removed it.
    #[error("half-edge {} does not exist (any more)", .0.0)]
    NoHalfEdge(HalfEdgeId),
    /// There is no such vertex, or an edit removed it.
    #[error("vertex {} does not exist (any more)", .0.0)]
    NoVertex(VertexId),
    /// The new position has a coordinate that is NaN or infinite.
    #[error("a position that is not finite: {0}")]
    NotFinite(DVec3),
    /// The half-edge lies on a border: there is no second triangle to flip.
    #[error("half-edge {} lies on a border", .0.0)]
    Border(HalfEdgeId),
    /// The two vertices that a flip would join are joined already.
    #[error("vertices {} and {} share an edge already", .0.0, .1.0)]
    EdgeExists(VertexId, VertexId),
    /// Collapsing the half-edge would pinch the surface, double a triangle or close a border.
    #[error("collapsing half-edge {} would change the topology", .0.0)]
    Link(HalfEdgeId),
    /// `u32` ids do not suffice for another vertex or triangle.
    #[error("no ids left")]
    TooLarge,
}

/// A [`TriMesh`] under change.
///
/// Ids stay valid until [`Self::finish`]: an edit may remove elements and append others, and never renumbers.
/// Each edit keeps the mesh an oriented manifold of the same topology (components, genus, border loops), or
/// refuses. Where points lie is the caller's affair: an edit looks at connectivity alone.
///
/// ```
/// use pellicle_mesh::{HalfEdgeId, MeshEditor, icosphere};
/// let mut editor = MeshEditor::new(icosphere(1)?);
/// let [a, b] = editor.ends(HalfEdgeId(0)).unwrap();
/// let middle = (editor.position(a).unwrap() + editor.position(b).unwrap()) / 2.0;
/// editor.split(HalfEdgeId(0), middle)?;
/// editor.flip(HalfEdgeId(7))?;
/// editor.collapse(HalfEdgeId(40), middle)?;
/// let (mesh, remap) = editor.finish();
/// assert_eq!(mesh.positions().len(), 42 + 1 - 1);
/// assert_eq!(remap.new_of_old.len(), 42 + 1);
/// assert!(mesh.is_closed());
/// # Ok::<(), pellicle_mesh::MeshError>(())
/// ```
#[derive(Clone, Debug)]
pub struct MeshEditor {
    pub(crate) positions: Vec<DVec3>,
    /// A removed triangle has three times [`VertexId::NONE`].
    pub(crate) triangles: Vec<[VertexId; 3]>,
    pub(crate) twins: Vec<HalfEdgeId>,
    /// A half-edge that leaves the vertex: on a border the one that runs along it. None if it was removed.
    outgoing: Vec<HalfEdgeId>,
    /// For each half-edge whether its edge is a crease: handed on by edits, of no effect on them.
    pub(crate) creases: Vec<bool>,
    /// Vertices marked with the current epoch are the neighbours of one end of an edge.
    marks: Vec<u32>,
    epoch: u32,
}

impl MeshEditor {
    /// Takes the mesh; ids stay as they are.
    pub fn new(mesh: TriMesh) -> Self {
        let outgoing = mesh.vertex_ids().map(|v| mesh.outgoing(v)).collect();
        let (positions, triangles, twins) = mesh.into_connected();
        Self {
            creases: vec![false; twins.len()],
            marks: vec![0; positions.len()],
            epoch: 0,
            positions,
            triangles,
            twins,
            outgoing,
        }
    }

    /// The mesh without the removed elements, the others in their order; and where the vertices went, from the
    /// editor's ids to the mesh's.
    pub fn finish(mut self) -> (TriMesh, VertexRemap) {
        let remap = self.compact();
        let mesh = TriMesh::from_connected(self.positions, self.triangles, self.twins);
        debug_assert!(mesh.validate().iter().all(|d| !d.prevents_manifold()));
        (mesh, remap)
    }

    /// The vertices that a half-edge leaves and reaches; `None` if it was removed or never was.
    pub fn ends(&self, half_edge: HalfEdgeId) -> Option<[VertexId; 2]> {
        self.exists(half_edge)
            .then(|| [self.origin(half_edge), self.destination(half_edge)])
    }

    /// Where a vertex lies; `None` if it was removed or never was.
    pub fn position(&self, vertex: VertexId) -> Option<DVec3> {
        self.has_vertex(vertex)
            .then(|| self.positions[vertex.index()])
    }

    /// Moves a vertex.
    pub fn set_position(&mut self, vertex: VertexId, position: DVec3) -> Result<(), Refusal> {
        if !self.has_vertex(vertex) {
            return Err(Refusal::NoVertex(vertex));
        }
        if !position.is_finite() {
            return Err(Refusal::NotFinite(position));
        }
        self.positions[vertex.index()] = position;
        Ok(())
    }

    /// The half-edge that runs back along the same edge; `None` on a border, or if there is no such half-edge.
    pub fn twin(&self, half_edge: HalfEdgeId) -> Option<HalfEdgeId> {
        self.exists(half_edge)
            .then(|| self.twin_of(half_edge))
            .flatten()
    }

    /// The half-edges that exist, in the order of their ids.
    pub fn half_edges(&self) -> impl Iterator<Item = HalfEdgeId> + '_ {
        (0..self.twins.len())
            .map(HalfEdgeId::new)
            .filter(|&h| self.exists(h))
    }

    /// One half-edge of each edge, as [`TriMesh::edges`].
    pub fn edges(&self) -> impl Iterator<Item = HalfEdgeId> + '_ {
        self.half_edges()
            .filter(|&h| self.twin_of(h).is_none_or(|twin| h < twin))
    }
}

/// Queries without checks, for elements that exist.
impl MeshEditor {
    #[inline]
    pub(crate) fn exists(&self, h: HalfEdgeId) -> bool {
        self.triangles
            .get(h.index() / 3)
            .is_some_and(|t| t[0] != VertexId::NONE)
    }

    #[inline]
    pub(crate) fn has_vertex(&self, v: VertexId) -> bool {
        self.outgoing
            .get(v.index())
            .is_some_and(|&h| h != HalfEdgeId::NONE)
    }

    #[inline]
    pub(crate) fn origin(&self, h: HalfEdgeId) -> VertexId {
        self.triangles.as_flattened()[h.index()]
    }

    #[inline]
    pub(crate) fn destination(&self, h: HalfEdgeId) -> VertexId {
        self.origin(h.next())
    }

    #[inline]
    pub(crate) fn twin_of(&self, h: HalfEdgeId) -> Option<HalfEdgeId> {
        self.twins[h.index()].some()
    }

    #[inline]
    pub(crate) fn at(&self, v: VertexId) -> DVec3 {
        self.positions[v.index()]
    }

    #[inline]
    pub(crate) fn corners(&self, t: TriangleId) -> [DVec3; 3] {
        self.triangles[t.index()].map(|v| self.at(v))
    }

    #[inline]
    pub(crate) fn is_border_vertex(&self, v: VertexId) -> bool {
        self.twin_of(self.outgoing[v.index()]).is_none()
    }

    /// The half-edges that leave a vertex, as [`TriMesh::outgoing_half_edges`].
    #[inline]
    pub(crate) fn around(&self, v: VertexId) -> impl Iterator<Item = HalfEdgeId> + '_ {
        let start = self.outgoing[v.index()];
        std::iter::successors(Some(start), move |h| {
            self.twin_of(h.previous()).filter(|&next| next != start)
        })
    }

    /// The vertices that share an edge with a vertex, each once.
    #[inline]
    pub(crate) fn neighbors(&self, v: VertexId) -> impl Iterator<Item = VertexId> + '_ {
        self.around(v).flat_map(|h| {
            let last = h.previous();
            let end = self.twin_of(last).is_none().then(|| self.origin(last));
            std::iter::once(self.destination(h)).chain(end)
        })
    }

    pub(crate) fn view(&self) -> MeshView<'_> {
        MeshView {
            positions: &self.positions,
            triangles: &self.triangles,
        }
    }
}

/// What the edits are made of.
impl MeshEditor {
    fn check_half_edge(&self, h: HalfEdgeId) -> Result<(), Refusal> {
        match self.exists(h) {
            true => Ok(()),
            false => Err(Refusal::NoHalfEdge(h)),
        }
    }

    /// Makes two half-edges, or one and a border, lie on the same edge.
    fn join(&mut self, a: HalfEdgeId, b: HalfEdgeId, crease: bool) {
        for (h, twin) in [(a, b), (b, a)] {
            if h != HalfEdgeId::NONE {
                self.twins[h.index()] = twin;
                self.creases[h.index()] = crease;
            }
        }
    }

    /// Makes the half-edge, or the border found by turning clockwise from it, the one that leaves its origin.
    fn set_outgoing(&mut self, start: HalfEdgeId) {
        let mut h = start;
        while let Some(twin) = self.twin_of(h) {
            h = twin.next();
            if h == start {
                break;
            }
        }
        let v = self.origin(h);
        self.outgoing[v.index()] = h;
    }

    /// A half-edge and everything about its edge: its twin or none, and whether it is a crease.
    fn side(&self, h: HalfEdgeId) -> (HalfEdgeId, bool) {
        (self.twins[h.index()], self.creases[h.index()])
    }

    fn push_triangle(&mut self, triangle: [VertexId; 3]) -> TriangleId {
        let t = TriangleId::new(self.triangles.len());
        self.triangles.push(triangle);
        self.twins.extend([HalfEdgeId::NONE; 3]);
        self.creases.extend([false; 3]);
        t
    }

    fn push_vertex(&mut self, position: DVec3) -> VertexId {
        let v = VertexId::new(self.positions.len());
        self.positions.push(position);
        self.outgoing.push(HalfEdgeId::NONE);
        self.marks.push(0);
        v
    }

    fn remove_triangle(&mut self, t: TriangleId) {
        self.triangles[t.index()] = [VertexId::NONE; 3];
    }

    /// Drops what was removed and renumbers the rest in its order.
    pub(crate) fn compact(&mut self) -> VertexRemap {
        let old_of_new: Vec<VertexId> = (0..self.positions.len())
            .map(VertexId::new)
            .filter(|&v| self.has_vertex(v))
            .collect();
        let mut new_of_old = vec![VertexId::NONE; self.positions.len()];
        for (new, old) in old_of_new.iter().enumerate() {
            new_of_old[old.index()] = VertexId::new(new);
        }
        let kept: Vec<usize> = (0..self.triangles.len())
            .filter(|&t| self.triangles[t][0] != VertexId::NONE)
            .collect();
        let mut new_triangle = vec![u32::MAX; self.triangles.len()];
        for (new, &old) in kept.iter().enumerate() {
            new_triangle[old] = new as u32;
        }
        let renumbered = |h: HalfEdgeId| match h.some() {
            Some(h) => HalfEdgeId::of(TriangleId(new_triangle[h.triangle().index()]), h.corner()),
            None => h,
        };
        let vertex = |v: VertexId| new_of_old[v.index()];
        let sides = || kept.iter().flat_map(|&t| 3 * t..3 * t + 3);
        self.twins = sides().map(|h| renumbered(self.twins[h])).collect();
        self.creases = sides().map(|h| self.creases[h]).collect();
        self.triangles = kept
            .iter()
            .map(|&t| self.triangles[t].map(vertex))
            .collect();
        let stayed = || old_of_new.iter().map(|v| v.index());
        self.positions = stayed().map(|v| self.positions[v]).collect();
        self.outgoing = stayed().map(|v| renumbered(self.outgoing[v])).collect();
        self.marks = vec![0; self.positions.len()];
        self.epoch = 0;
        VertexRemap {
            old_of_new,
            new_of_old,
        }
    }
}

#[cfg(test)]
mod tests;
