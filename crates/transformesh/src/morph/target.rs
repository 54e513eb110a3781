//! What the surface moves onto.

use super::options::{MorphOptions, Topology};
use super::start::repaired;
use crate::Error;
use pellicle_geometry::{Aabb, Progress, VertexId};
use pellicle_mesh::{MeshView, SignedDistance, TriMesh, components, summarize};

pub(super) struct Target {
    pub(super) mesh: TriMesh,
    pub(super) distance: SignedDistance,
    pub(super) bounds: Aabb,
    /// The length that edges should have in the end.
    pub(super) edge: f64,
    pub(super) topology: Topology,
    /// For each triangle a name of its component.
    component: Vec<VertexId>,
    pub(super) filled: usize,
}

impl Target {
    pub(super) fn new(
        mesh: MeshView,
        options: &MorphOptions,
        progress: &dyn Progress,
    ) -> Result<Self, Error> {
        let (mesh, filled) = repaired(mesh, "target", progress)?;
        let distance = SignedDistance::new(&mesh)?;
        let bounds = Aabb::of_points(mesh.positions());
        let summary = summarize((&mesh).into())?;
        let mean = summary.shape.map_or(0.0, |shape| shape.mean_edge);
        let diagonal = bounds.diagonal();
        Ok(Self {
            edge: options
                .edge_length
                .unwrap_or(mean.clamp(diagonal / 400.0, diagonal / 16.0)),
            topology: topology(&mesh)?,
            component: components((&mesh).into()),
            distance,
            bounds,
            mesh,
            filled,
        })
    }

    /// How many components of the target no vertex is nearest to.
    pub(super) fn missed_by(&self, mesh: &TriMesh) -> usize {
        let mut missed = self.component.clone();
        missed.sort_unstable();
        missed.dedup();
        for sample in self.distance.samples(mesh.positions()) {
            let found = self.component[sample.triangle.index()];
            missed.retain(|&c| c != found);
        }
        missed.len()
    }
}

/// The genus of each component, ascending.
pub(super) fn topology(mesh: &TriMesh) -> Result<Topology, Error> {
    let summary = summarize(mesh.into())?;
    // Closed and oriented: each has a genus.
    let mut genera: Vec<usize> = summary
        .components
        .iter()
        .filter_map(|component| component.genus())
        .collect();
    genera.sort_unstable();
    Ok(Topology { genera })
}
