//! The oriented manifold.

use crate::edge_table::{EdgeTable, twins_of};
use crate::{Defect, HalfEdgeId, MeshError, MeshView, TriangleId, TriangleSoup, validate};
use pellicle_geometry::{DVec3, VertexId, first_not_finite};

/// An oriented manifold triangle mesh, possibly with borders.
///
/// Guaranteed by the type, for every value of it:
///
/// - positions are finite; the three vertices of a triangle exist and differ;
/// - each edge has one triangle (a border) or two, which run along it in opposite directions;
/// - the triangles at a vertex form one fan or one ring: no vertex joins two sheets;
/// - every vertex has a triangle: isolated ones are refused ([`TriangleSoup::compact`] drops them first);
/// - no two triangles have the same three vertices.
///
/// Not guaranteed: triangles may have zero area, and may intersect each other in space.
///
/// Half-edges are laid out as [`HalfEdgeId`] says. A method that takes an id panics if the mesh has no
/// such element. 36 bytes a triangle and 28 a vertex.
///
/// ```
/// use pellicle_geometry::{DVec3, VertexId};
/// use pellicle_mesh::{TriMesh, TriangleSoup};
/// let soup = TriangleSoup {
///     positions: vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z],
///     triangles: [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]].map(|t| t.map(VertexId)).to_vec(),
/// };
/// let mesh = TriMesh::try_from(soup)?;
/// assert!(mesh.is_closed());
/// assert_eq!(mesh.neighbors(VertexId(3)).count(), 3);
/// # Ok::<(), pellicle_mesh::MeshError>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TriMesh {
    positions: Vec<DVec3>,
    triangles: Vec<[VertexId; 3]>,
    connectivity: Connectivity,
}

/// What follows from the triangles alone.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
struct Connectivity {
    /// For each half-edge the one that runs back along its edge; none on a border.
    twins: Vec<HalfEdgeId>,
    /// For each vertex the half-edge on the border that leaves it, or else the least that leaves it.
    outgoing: Vec<HalfEdgeId>,
}

impl TryFrom<TriangleSoup> for TriMesh {
    type Error = MeshError;

    /// The soup as a mesh, with the same ids. The error names every defect and hands the soup back.
    /// O(n log d), with d the largest vertex degree.
    fn try_from(soup: TriangleSoup) -> Result<Self, MeshError> {
        match Connectivity::of((&soup).into()) {
            Some(connectivity) => Ok(Self {
                positions: soup.positions,
                triangles: soup.triangles,
                connectivity,
            }),
            None => Err(MeshError::NotManifold {
                defects: validate((&soup).into()),
                soup,
            }),
        }
    }
}

impl TriMesh {
    /// The vertices.
    #[inline]
    pub fn positions(&self) -> &[DVec3] {
        &self.positions
    }

    /// Three vertices a triangle, counter-clockwise seen from outside.
    #[inline]
    pub fn triangles(&self) -> &[[VertexId; 3]] {
        &self.triangles
    }

    /// The ids of all vertices.
    pub fn vertex_ids(&self) -> impl ExactSizeIterator<Item = VertexId> + use<> {
        (0..self.positions.len()).map(VertexId::new)
    }

    /// The ids of all triangles.
    pub fn triangle_ids(&self) -> impl ExactSizeIterator<Item = TriangleId> + use<> {
        (0..self.triangles.len()).map(TriangleId::new)
    }

    /// The ids of all half-edges.
    pub fn half_edge_ids(&self) -> impl ExactSizeIterator<Item = HalfEdgeId> + use<> {
        (0..self.connectivity.twins.len()).map(HalfEdgeId::new)
    }

    /// One half-edge of each edge: the lesser of the two, or the only one on a border.
    pub fn edges(&self) -> impl Iterator<Item = HalfEdgeId> + '_ {
        self.half_edge_ids()
            .filter(|&h| self.twin(h).is_none_or(|twin| h < twin))
    }

    /// A position.
    #[inline]
    pub fn position(&self, vertex: VertexId) -> DVec3 {
        self.positions[vertex.index()]
    }

    /// The corners of a triangle.
    #[inline]
    pub fn corners(&self, triangle: TriangleId) -> [DVec3; 3] {
        self.triangles[triangle.index()].map(|v| self.position(v))
    }

    /// The half-edge that runs back along the same edge; `None` on a border.
    #[inline]
    pub fn twin(&self, half_edge: HalfEdgeId) -> Option<HalfEdgeId> {
        self.connectivity.twins[half_edge.index()].some()
    }

    /// The vertex that a half-edge leaves.
    #[inline]
    pub fn origin(&self, half_edge: HalfEdgeId) -> VertexId {
        self.triangles.as_flattened()[half_edge.index()]
    }

    /// The vertex that a half-edge reaches.
    #[inline]
    pub fn destination(&self, half_edge: HalfEdgeId) -> VertexId {
        self.origin(half_edge.next())
    }

    /// A half-edge that leaves a vertex: on a border the one that runs along it, else the least.
    #[inline]
    pub fn outgoing(&self, vertex: VertexId) -> HalfEdgeId {
        self.connectivity.outgoing[vertex.index()]
    }

    /// The half-edge from one vertex to another, if it exists. Linear in the degree of `from`.
    pub fn half_edge_between(&self, from: VertexId, to: VertexId) -> Option<HalfEdgeId> {
        self.outgoing_half_edges(from)
            .find(|&h| self.destination(h) == to)
    }

    /// Whether a vertex lies on a border.
    #[inline]
    pub fn is_border_vertex(&self, vertex: VertexId) -> bool {
        self.twin(self.outgoing(vertex)).is_none()
    }

    /// Whether there is no border.
    pub fn is_closed(&self) -> bool {
        self.connectivity.twins.iter().all(|t| t.some().is_some())
    }

    /// The half-edges that leave a vertex, counter-clockwise seen from outside, from [`Self::outgoing`]
    /// on; one for each triangle at the vertex.
    ///
    /// ```text
    ///      2     1
    ///       \   /
    ///    3 -- v -- 0     v on a border: 0 is the border, and all of the fan follows
    /// ```
    pub fn outgoing_half_edges(&self, vertex: VertexId) -> impl Iterator<Item = HalfEdgeId> + '_ {
        let start = self.outgoing(vertex);
        std::iter::successors(Some(start), move |h| {
            self.twin(h.previous()).filter(|&next| next != start)
        })
    }

    /// The triangles at a vertex, counter-clockwise seen from outside.
    pub fn triangles_around(&self, vertex: VertexId) -> impl Iterator<Item = TriangleId> + '_ {
        self.outgoing_half_edges(vertex).map(HalfEdgeId::triangle)
    }

    /// The vertices that share an edge with a vertex, each once, counter-clockwise seen from outside. On a
    /// border there is one more of them than triangles.
    pub fn neighbors(&self, vertex: VertexId) -> impl Iterator<Item = VertexId> + '_ {
        self.outgoing_half_edges(vertex).flat_map(|h| {
            let last = h.previous();
            let end = self.twin(last).is_none().then(|| self.origin(last));
            std::iter::once(self.destination(h)).chain(end)
        })
    }

    /// The borders: each a closed chain of half-edges without a twin, the surface at their left, from its
    /// least half-edge on; in the order of those. Linear time.
    pub fn border_loops(&self) -> Vec<Vec<HalfEdgeId>> {
        let mut seen = vec![false; self.connectivity.twins.len()];
        let mut loops = Vec::new();
        for start in self.half_edge_ids() {
            if self.twin(start).is_some() || seen[start.index()] {
                continue;
            }
            let mut chain = Vec::new();
            let mut h = start;
            while !seen[h.index()] {
                seen[h.index()] = true;
                chain.push(h);
                h = self.outgoing(self.destination(h));
            }
            loops.push(chain);
        }
        loops
    }

    /// Moves the vertices. As many positions as vertices, all finite; otherwise the mesh stays as it was.
    pub fn set_positions(&mut self, positions: Vec<DVec3>) -> Result<(), MeshError> {
        if positions.len() != self.positions.len() {
            return Err(MeshError::PositionCount {
                positions: positions.len(),
                vertices: self.positions.len(),
            });
        }
        if let Some(vertex) = first_not_finite(&positions) {
            return Err(MeshError::NotFinite {
                vertex,
                position: positions[vertex.index()],
            });
        }
        self.positions = positions;
        Ok(())
    }

    /// Turns the mesh inside out: every triangle `[a, b, c]` becomes `[a, c, b]`. Linear time.
    pub fn reverse_orientation(&mut self) {
        // Half-edges a→b, b→c, c→a of a triangle become a→c, c→b, b→a: 0 and 2 change places.
        let reversed = |h: HalfEdgeId| match h.some() {
            Some(h) => HalfEdgeId::of(h.triangle(), 2 - h.corner()),
            None => h,
        };
        for triangle in &mut self.triangles {
            triangle.swap(1, 2);
        }
        for twins in self.connectivity.twins.chunks_exact_mut(3) {
            twins.swap(0, 2);
            twins.iter_mut().for_each(|h| *h = reversed(*h));
        }
        self.connectivity.outgoing = outgoing(
            &self.triangles,
            &self.connectivity.twins,
            self.positions.len(),
        );
    }

    /// The mesh with these triangles and twins, which the caller knows to be those of an oriented manifold.
    /// Linear time.
    pub(crate) fn from_connected(
        positions: Vec<DVec3>,
        triangles: Vec<[VertexId; 3]>,
        twins: Vec<HalfEdgeId>,
    ) -> Self {
        let outgoing = outgoing(&triangles, &twins, positions.len());
        Self {
            positions,
            triangles,
            connectivity: Connectivity { twins, outgoing },
        }
    }

    /// Positions, triangles and twins: what [`Self::from_connected`] takes.
    pub(crate) fn into_connected(self) -> (Vec<DVec3>, Vec<[VertexId; 3]>, Vec<HalfEdgeId>) {
        (self.positions, self.triangles, self.connectivity.twins)
    }

    /// The positions and triangles, without the guarantee.
    pub fn into_soup(self) -> TriangleSoup {
        TriangleSoup {
            positions: self.positions,
            triangles: self.triangles,
        }
    }

    /// All defects, the stored connectivity included. Only [`Defect::ZeroArea`] can occur unless this crate
    /// is broken.
    pub fn validate(&self) -> Vec<Defect> {
        let mut defects = validate(self.into());
        let twins = &self.connectivity.twins;
        for h in self.half_edge_ids() {
            let twin = twins[h.index()];
            let good = match twin.some() {
                None => true,
                Some(twin) => {
                    twins.get(twin.index()) == Some(&h)
                        && self.origin(twin) == self.destination(h)
                        && self.destination(twin) == self.origin(h)
                }
            };
            if !good {
                defects.push(Defect::BrokenTwin { half_edge: h });
            }
        }
        // A missing twin looks like a border: the edges themselves tell.
        for (_, group) in EdgeTable::new(self.into()).edges() {
            if let Some((a, b)) = twins_of(&self.triangles, group) {
                let missing = [a, b]
                    .into_iter()
                    .filter(|h| twins[h.index()].some().is_none());
                defects.extend(missing.map(|half_edge| Defect::BrokenTwin { half_edge }));
            }
        }
        let expected = outgoing(&self.triangles, twins, self.positions.len());
        for v in self.vertex_ids() {
            if self.connectivity.outgoing.get(v.index()) != Some(&expected[v.index()]) {
                defects.push(Defect::BrokenOutgoing { vertex: v });
            }
        }
        defects.sort();
        defects.dedup();
        defects
    }
}

impl Connectivity {
    /// The connectivity of an oriented manifold without isolated vertices and with finite positions; `None`
    /// for any other soup.
    fn of(mesh: MeshView) -> Option<Self> {
        let sound = mesh.fits_ids()
            && mesh.triangles.iter().all(|&t| mesh.is_usable(t))
            && first_not_finite(mesh.positions).is_none();
        if !sound {
            return None;
        }
        let twins = twins(mesh)?;
        if has_duplicates(&twins) {
            return None;
        }
        let outgoing = outgoing(mesh.triangles, &twins, mesh.positions.len());
        let result = Self { twins, outgoing };
        result.every_vertex_is_one_umbrella(mesh).then_some(result)
    }

    /// Whether rotating about each vertex reaches all its corners: not so where two umbrellas meet, nor at
    /// an isolated vertex.
    fn every_vertex_is_one_umbrella(&self, mesh: MeshView) -> bool {
        let mut unreached = vec![0_u32; mesh.positions.len()];
        for vertex in mesh.triangles.as_flattened() {
            unreached[vertex.index()] += 1;
        }
        self.outgoing
            .iter()
            .zip(unreached)
            .all(|(&start, corners)| {
                let mut reached = 0;
                let mut next = start.some();
                while let Some(h) = next {
                    reached += 1;
                    next = self.twins[h.previous().index()]
                        .some()
                        .filter(|&h| h != start);
                }
                reached == corners && corners > 0
            })
    }
}

/// For each half-edge its twin or none; `None` if an edge has too many triangles, or two that run along
/// it in the same direction.
fn twins(mesh: MeshView) -> Option<Vec<HalfEdgeId>> {
    let mut twins = vec![HalfEdgeId::NONE; 3 * mesh.triangles.len()];
    for (_, group) in EdgeTable::new(mesh).edges() {
        if let Some((a, b)) = twins_of(mesh.triangles, group) {
            twins[a.index()] = b;
            twins[b.index()] = a;
        } else if group.len() > 1 {
            return None;
        }
    }
    Some(twins)
}

/// Whether two triangles lie back to back on the same vertices, given that edges are manifold and
/// oriented.
fn has_duplicates(twins: &[HalfEdgeId]) -> bool {
    twins.chunks_exact(3).any(|of| {
        let across = |h: HalfEdgeId| h.some().map(HalfEdgeId::triangle);
        across(of[0]).is_some() && across(of[0]) == across(of[1])
    })
}

/// For each vertex the half-edge that leaves it along a border, or else the least that leaves it.
fn outgoing(
    triangles: &[[VertexId; 3]],
    twins: &[HalfEdgeId],
    vertex_count: usize,
) -> Vec<HalfEdgeId> {
    let mut outgoing = vec![HalfEdgeId::NONE; vertex_count];
    for (h, vertex) in triangles.as_flattened().iter().enumerate() {
        let slot = &mut outgoing[vertex.index()];
        if slot.some().is_none() || twins[h] == HalfEdgeId::NONE {
            *slot = HalfEdgeId::new(h);
        }
    }
    outgoing
}

#[cfg(test)]
mod tests;
