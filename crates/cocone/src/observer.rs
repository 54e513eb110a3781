//! Watching the stages of the reconstruction: for pictures, for measurements, and for finding out why.

use crate::canonical::Canonical;
use crate::facet_set::FacetSet;
use crate::poles::Poles;
use crate::radial::Radial;
use crate::walk::Walked;
use glam::DVec3;
use pellicle_delaunay::FacetId;

/// Sees each stage once, in the order of the methods; `()` sees nothing, and costs nothing.
///
/// Facets are those of the tetrahedralisation that is reconstructed from. Until the walk each stands for itself, seen
/// from its tetrahedron of lower id, and they come sorted.
///
/// ```
/// use pellicle_cocone::{Observer, Options, reconstruct_observed};
/// use pellicle_delaunay::{FacetId, tetrahedralize};
/// use pellicle_geometry::DVec3;
///
/// #[derive(Default)]
/// struct Counts { candidates: usize, walked: usize }
/// impl Observer for Counts {
///     fn is_watching(&self) -> bool { true }
///     fn candidates(&mut self, facets: &[FacetId]) { self.candidates = facets.len() }
///     fn walked(&mut self, facets: &[FacetId]) { self.walked = facets.len() }
/// }
/// // An octahedron.
/// let points: Vec<DVec3> = DVec3::AXES.iter().flat_map(|&axis| [axis, -axis]).collect();
/// let tetrahedra = tetrahedralize(&points, &Default::default())?;
/// let mut counts = Counts::default();
/// let surface = reconstruct_observed(&tetrahedra, &Options::default(), &(), &mut counts)?;
/// assert_eq!(counts.candidates, surface.report.candidate_triangles);
/// assert_eq!(counts.walked, surface.mesh.triangles().len());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub trait Observer {
    /// Whether the other methods are called.
    fn is_watching(&self) -> bool {
        false
    }
    /// The pole vector v_p of each point by the caller's ids, of unit length: towards the positive pole, or the mean
    /// direction of the unbounded Voronoi edges. Zero for duplicates, and where the cell gives none.
    fn pole_vectors(&mut self, _vectors: &[DVec3]) {}
    /// The candidate triangles: those whose dual Voronoi edges meet the cocones of vertices that are sampled well.
    fn candidates(&mut self, _facets: &[FacetId]) {}
    /// The candidates that pruning left.
    fn pruned(&mut self, _facets: &[FacetId]) {}
    /// The triangles of the manifold walk, each seen from the tetrahedron from which the walk met it: the outside.
    fn walked(&mut self, _facets: &[FacetId]) {}
}

impl Observer for () {}

/// The pole vectors by the caller's ids.
pub(crate) fn show_pole_vectors(observer: &mut dyn Observer, canonical: &Canonical, poles: &Poles) {
    if observer.is_watching() {
        let mut vectors = vec![DVec3::ZERO; canonical.original_points().len()];
        for vertex in canonical.vertex_ids() {
            vectors[canonical.original(vertex).index()] = poles.vectors[vertex.index()];
        }
        observer.pole_vectors(&vectors);
    }
}

/// The facets of a set.
pub(crate) fn facets(canonical: &Canonical, set: &FacetSet) -> Vec<FacetId> {
    set.iter(canonical).collect()
}

/// The sides that the walk passed, as facets seen from there.
pub(crate) fn show_walked(
    observer: &mut dyn Observer,
    canonical: &Canonical,
    radial: &Radial,
    walked: &Walked,
) {
    if observer.is_watching() {
        let sides = walked.iter().flatten();
        let facets: Vec<FacetId> = sides.map(|&s| radial.facet_of(canonical, s)).collect();
        observer.walked(&facets);
    }
}
