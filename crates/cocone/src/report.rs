//! What was made of the points.

use pellicle_geometry::VertexId;
use pellicle_mesh::{HalfEdgeId, TriMesh, TriangleId};

/// What [`reconstruct`](crate::reconstruct) did; all ids are those of the caller's points.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Report {
    /// How many points are vertices of the mesh.
    pub used: usize,
    /// The points that are not, duplicates of others included; sorted.
    pub dropped: Vec<VertexId>,
    /// How many facets of the tetrahedralisation were candidates.
    pub candidate_triangles: usize,
    /// How many candidates were pruned at sharp edges.
    pub pruned_triangles: usize,
    /// The points whose Voronoi cells show that the surface is undersampled there, or has a border; sorted.
    pub undersampled: Vec<VertexId>,
    /// The points that the mesh holds more than one vertex for, because sheets touch there; sorted.
    pub split: Vec<VertexId>,
    /// The connected components of the mesh, in the order of their first triangles.
    pub components: Vec<Component>,
    /// How many tetrahedra changed sides so that the boundary is a manifold (Tight Cocone only).
    pub moved_tetrahedra: usize,
}

/// A connected component of the mesh.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Component {
    /// How many triangles.
    pub triangles: usize,
    /// How many vertices.
    pub vertices: usize,
    /// How many loops of border edges; none on a closed surface.
    pub borders: usize,
    /// How many handles: (2 − borders − V + E − F) / 2, every border thought closed by a disk.
    pub genus: usize,
}

impl Component {
    /// Those of a mesh. Linear time.
    pub(crate) fn all(mesh: &TriMesh) -> Vec<Self> {
        let mut component_of = vec![u32::MAX; mesh.triangles().len()];
        let mut components: Vec<Self> = Vec::new();
        let mut border_edges: Vec<usize> = Vec::new();
        let mut pending = Vec::new();
        for first in mesh.triangle_ids() {
            if component_of[first.index()] != u32::MAX {
                continue;
            }
            let number = components.len();
            let (mut triangles, mut borders) = (0, 0);
            component_of[first.index()] = number as u32;
            pending.push(first);
            while let Some(triangle) = pending.pop() {
                triangles += 1;
                for half_edge in half_edges(triangle) {
                    let Some(twin) = mesh.twin(half_edge) else {
                        borders += 1;
                        continue;
                    };
                    let neighbor = &mut component_of[twin.triangle().index()];
                    if *neighbor == u32::MAX {
                        *neighbor = number as u32;
                        pending.push(twin.triangle());
                    }
                }
            }
            components.push(Self {
                triangles,
                ..Self::default()
            });
            border_edges.push(borders);
        }
        let of = |triangle: TriangleId| component_of[triangle.index()] as usize;
        for vertex in mesh.vertex_ids() {
            components[of(mesh.outgoing(vertex).triangle())].vertices += 1;
        }
        for border in mesh.border_loops() {
            components[of(border[0].triangle())].borders += 1;
        }
        for (component, borders) in components.iter_mut().zip(border_edges) {
            let edges = (3 * component.triangles + borders) / 2;
            // Never negative: a connected orientable surface.
            let twice = (2 + edges)
                .saturating_sub(component.borders + component.vertices + component.triangles);
            component.genus = twice / 2;
        }
        components
    }
}

fn half_edges(triangle: TriangleId) -> [HalfEdgeId; 3] {
    [0, 1, 2].map(|corner| HalfEdgeId::of(triangle, corner))
}
