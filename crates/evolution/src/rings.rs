//! The triangles around each vertex, laid out for sums over them.

use pellicle_mesh::{HalfEdgeId, TriMesh};

/// What the finite volumes ask of connectivity, computed once and kept while it stands.
///
/// ```text
///             k = neighbor of the next edge
///            / \
///           /   \          edge (i, j) has the triangle on its left and that of the twin on
///          /     \         its right; its two opposite corners are those at k and at l
///         i ----- j
///          \     /
///           \   /
///             l
/// ```
#[derive(Clone, Debug)]
pub(crate) struct Rings {
    offsets: Vec<u32>,
    edges: Vec<RingEdge>,
    /// Which connected component a vertex belongs to.
    component: Vec<u32>,
    /// The first vertex of each component.
    pub(crate) first_vertices: Vec<u32>,
    /// Three vertices a triangle.
    pub(crate) triangles: Vec<[u32; 3]>,
}

/// An edge that leaves a vertex, and the triangle on its left.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RingEdge {
    /// j.
    pub(crate) neighbor: u32,
    /// The triangle (i, j, k).
    pub(crate) triangle: u32,
    /// The corners 3t + c opposite to the edge, in both of its triangles.
    pub(crate) opposite: [u32; 2],
}

impl Rings {
    /// `None` if the mesh has a border.
    pub(crate) fn of(mesh: &TriMesh) -> Option<Self> {
        let vertices = mesh.positions().len();
        let mut offsets = Vec::with_capacity(vertices + 1);
        let mut edges = Vec::with_capacity(mesh.triangles().len() * 3);
        offsets.push(0);
        for vertex in mesh.vertex_ids() {
            for half_edge in mesh.outgoing_half_edges(vertex) {
                let twin = mesh.twin(half_edge)?;
                edges.push(RingEdge {
                    neighbor: mesh.destination(half_edge).0,
                    triangle: half_edge.triangle().0,
                    opposite: [half_edge, twin].map(|h: HalfEdgeId| h.previous().0),
                });
            }
            offsets.push(edges.len() as u32);
        }
        let (component, first_vertices) = components(&offsets, &edges);
        Some(Self {
            offsets,
            edges,
            component,
            first_vertices,
            triangles: mesh.triangles().iter().map(|t| t.map(|v| v.0)).collect(),
        })
    }

    /// The number of vertices.
    pub(crate) fn vertices(&self) -> usize {
        self.offsets.len() - 1
    }

    /// The edges that leave a vertex, counter-clockwise seen from outside.
    #[inline]
    pub(crate) fn around(&self, vertex: usize) -> &[RingEdge] {
        &self.edges[self.offsets[vertex] as usize..self.offsets[vertex + 1] as usize]
    }

    /// An edge by its place among all.
    #[inline]
    pub(crate) fn edge(&self, edge: usize) -> &RingEdge {
        &self.edges[edge]
    }

    /// Where the edges of a vertex begin among all.
    #[inline]
    pub(crate) fn offset(&self, vertex: usize) -> usize {
        self.offsets[vertex] as usize
    }

    /// The component of a vertex.
    #[inline]
    pub(crate) fn component(&self, vertex: usize) -> usize {
        self.component[vertex] as usize
    }

    /// The sum of a quantity over each component, in the order of the vertices.
    pub(crate) fn sum_by_component(&self, of: impl Fn(usize) -> f64) -> Vec<f64> {
        let mut sums = vec![0.0; self.first_vertices.len()];
        for i in 0..self.vertices() {
            sums[self.component(i)] += of(i);
        }
        sums
    }

    /// The number of half-edges.
    pub(crate) fn len(&self) -> usize {
        self.edges.len()
    }
}

/// The component of each vertex, and the first vertex of each component.
fn components(offsets: &[u32], edges: &[RingEdge]) -> (Vec<u32>, Vec<u32>) {
    const NONE: u32 = u32::MAX;
    let vertices = offsets.len() - 1;
    let mut component = vec![NONE; vertices];
    let mut first_vertices = Vec::new();
    let mut stack = Vec::new();
    for start in 0..vertices {
        if component[start] != NONE {
            continue;
        }
        let label = first_vertices.len() as u32;
        first_vertices.push(start as u32);
        component[start] = label;
        stack.push(start);
        while let Some(i) = stack.pop() {
            for edge in &edges[offsets[i] as usize..offsets[i + 1] as usize] {
                let j = edge.neighbor as usize;
                if component[j] == NONE {
                    component[j] = label;
                    stack.push(j);
                }
            }
        }
    }
    (component, first_vertices)
}
