//! What was made of the points.

use pellicle_geometry::VertexId;

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
    /// How many tetrahedra changed sides so that the boundary is a manifold (Tight Cocone only).
    pub moved_tetrahedra: usize,
}
