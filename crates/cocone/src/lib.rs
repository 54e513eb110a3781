//! The Cocone family: surfaces through points, without normals.
//!
//! **The data.** In goes a [`Tetrahedralization`], which borrows the
//! points; out comes a [`Reconstruction`]: a [`TriMesh`] of facets of it, the point that each
//! of its vertices is, and a [`Report`]. Coordinates are in the caller's units and stay as they are, to the last
//! bit.
//!
//! **The verbs.** [`reconstruct`] takes the facets whose dual Voronoi edge meets a *cocone*, the part of a Voronoi cell
//! near the tangent plane; prunes them at sharp edges; and walks over what is left from outside (Dey 2006,
//! chapter 4), keeping away from places that are undersampled (Dey and Giesen 2001).
//! [`Method::TightCocone`] closes the surface (Dey and Goswami 2003) to the boundary of a solid, a manifold for
//! any input. [`normals`] gives unit normals at the points.
//!
//! ```
//! use pellicle_cocone::{Options, reconstruct};
//! use pellicle_delaunay::tetrahedralize;
//! use pellicle_geometry::DVec3;
//!
//! // 20 × 10 points on a torus.
//! let angle = |i: u32, n: u32| f64::from(i) / f64::from(n) * std::f64::consts::TAU;
//! let ring = |u: f64, v: f64| DVec3::new((2.0 + v.cos()) * u.cos(), (2.0 + v.cos()) * u.sin(), v.sin());
//! let points: Vec<DVec3> = (0..200).map(|i| ring(angle(i % 20, 20), angle(i / 20, 10))).collect();
//! let tetrahedra = tetrahedralize(&points, &Default::default())?;
//! let surface = reconstruct(&tetrahedra, &Options::default())?;
//! assert!(surface.mesh.is_closed());
//! assert_eq!(surface.mesh.triangles().len(), 400);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
#![forbid(unsafe_code)]

mod candidates;
mod canonical;
mod error;
mod facet_set;
mod normals;
mod observer;
mod options;
mod poles;
mod prune;
mod radial;
mod report;
mod sheet;
mod solid;
#[cfg(test)]
mod tests;
mod tight;
mod umbrella;
mod walk;

pub use error::Error;
pub use normals::{normals, normals_with};
pub use observer::Observer;
pub use options::{Acceptance, Method, Options};
pub use report::{Component, Report};

use candidates::Wishes;
use canonical::Canonical;
use facet_set::FacetSet;
use pellicle_delaunay::Tetrahedralization;
use pellicle_geometry::{Cancelled, Progress, VertexId};
use pellicle_mesh::{MeshError, OrientationPolicy, SplitOptions, TriMesh, TriangleSoup};
use poles::Poles;
use radial::Radial;
use sheet::Triangles;
use walk::Walked;

/// A surface through points, and how it came about.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Reconstruction {
    /// The surface, counter-clockwise seen from outside.
    pub mesh: TriMesh,
    /// For each vertex of the mesh, the point it is.
    pub vertices: Vec<VertexId>,
    /// What was made of the points.
    pub report: Report,
}

/// Reconstructs a surface through the points of a tetrahedralisation, whose coordinates and ids the result
/// keeps.
///
/// Near-linear in the number of tetrahedra for Cocone, and for Tight Cocone where Cocone's surface is
/// closed; elsewhere a minimum cut comes on top. A surface without triangles is a result, not an error: see
/// [`Report::undersampled`].
///
/// # Errors
///
/// More triangles than ids can name.
pub fn reconstruct(
    tetrahedralization: &Tetrahedralization,
    options: &Options,
) -> Result<Reconstruction, Error> {
    reconstruct_with(tetrahedralization, options, &())
}

/// [`reconstruct`], watched by `progress`, whose `Break` makes it return [`Error::Cancelled`].
pub fn reconstruct_with(
    tetrahedralization: &Tetrahedralization,
    options: &Options,
    progress: &dyn Progress,
) -> Result<Reconstruction, Error> {
    reconstruct_observed(tetrahedralization, options, progress, &mut ())
}

/// [`reconstruct_with`], whose stages are shown to `observer`.
pub fn reconstruct_observed(
    tetrahedralization: &Tetrahedralization,
    options: &Options,
    progress: &dyn Progress,
    observer: &mut dyn Observer,
) -> Result<Reconstruction, Error> {
    let step = |done| Cancelled::check(progress.step("reconstruct", done, 7));
    step(0)?;

    // 1. Poles and pole vectors.
    let canonical = Canonical::of(tetrahedralization);
    let poles = Poles::of(&canonical);
    observer::show_pole_vectors(observer, &canonical, &poles);
    step(1)?;

    // 2. The triangles that meet cocones, and the vertices that are sampled well enough to say so.
    let wishes = Wishes::of(&canonical, &poles);
    let flat = wishes.flat(&canonical, &poles);
    step(2)?;

    // 3. Candidate triangles.
    let mut candidates = wishes.candidates(&canonical, &flat, options.acceptance);
    drop((wishes, poles));
    let candidate_triangles = candidates.len();
    if observer.is_watching() {
        observer.candidates(&observer::facets(&canonical, &candidates));
    }
    step(3)?;

    // 4. Prune sharp edges, but for what a first walk shows to be surface; then walk the manifold.
    let mut radial = Radial::of(&canonical, &candidates);
    let mut walked = walk::extract(&canonical, &candidates, &radial);
    step(4)?;
    prune::prune(&canonical, &flat, &walked, &mut candidates, &mut radial);
    if candidates.len() < candidate_triangles {
        walked = walk::extract(&canonical, &candidates, &radial);
    }
    if observer.is_watching() {
        observer.pruned(&observer::facets(&canonical, &candidates));
    }
    observer::show_walked(observer, &canonical, &radial, &walked);
    step(5)?;

    // 5. The surface itself, or the solid that it bounds where it is closed.
    let (triangles, moved_tetrahedra) = match options.method {
        Method::Cocone => (Triangles::of(&radial, &walked), 0),
        Method::TightCocone => {
            let surface = walked_facets(&canonical, &radial, &walked);
            let (sheet, moved) = tight::close(&canonical, &surface);
            (sheet.triangles(&canonical), moved)
        }
    };
    step(6)?;

    // 6. The mesh, and the report.
    let mut reconstruction = mesh(&canonical, triangles)?;
    step(7)?;
    let report = &mut reconstruction.report;
    report.candidate_triangles = candidate_triangles;
    report.pruned_triangles = candidate_triangles - candidates.len();
    report.moved_tetrahedra = moved_tetrahedra;
    report.undersampled = canonical
        .vertex_ids()
        .filter(|v| !flat[v.index()])
        .map(|v| canonical.original(v))
        .collect();
    report.undersampled.sort_unstable();
    Ok(reconstruction)
}

/// The facets of which the walk passed a side.
fn walked_facets(canonical: &Canonical, radial: &Radial, walked: &Walked) -> FacetSet {
    let mut facets = FacetSet::empty(canonical);
    for side in walked.iter().flatten() {
        facets.insert(canonical, radial.facet(side.facet()));
    }
    facets
}

/// The mesh of the triangles, with a report of the points in it.
fn mesh(canonical: &Canonical, triangles: Triangles) -> Result<Reconstruction, Error> {
    let original = |vertex: &VertexId| canonical.original(*vertex);
    let positions = canonical.original_points();
    let soup = TriangleSoup {
        positions: triangles
            .vertices
            .iter()
            .map(|v| positions[original(v).index()])
            .collect(),
        triangles: triangles.triangles,
    };
    let (mesh, vertices) = match TriMesh::try_from(soup) {
        Ok(mesh) => (mesh, triangles.vertices),
        Err(MeshError::NotManifold { soup, .. }) => {
            // Where the walk left sheets half joined.
            let options = SplitOptions {
                orientation: OrientationPolicy::Keep,
            };
            let (mesh, split) = TriMesh::from_soup_splitting(soup, &options)?;
            let origin = split.vertex_origin.iter();
            (
                mesh,
                origin.map(|v| triangles.vertices[v.index()]).collect(),
            )
        }
        Err(error) => return Err(error.into()),
    };
    let vertices: Vec<VertexId> = vertices.iter().map(original).collect();

    let mut copies = vec![0_u32; positions.len()];
    for vertex in &vertices {
        copies[vertex.index()] += 1;
    }
    let with = |wanted: fn(u32) -> bool| -> Vec<VertexId> {
        let ids = (0..copies.len()).filter(|&v| wanted(copies[v]));
        ids.map(VertexId::new).collect()
    };
    let dropped = with(|copies| copies == 0);
    let report = Report {
        used: copies.len() - dropped.len(),
        dropped,
        split: with(|copies| copies > 1),
        components: Component::all(&mesh),
        ..Report::default()
    };
    Ok(Reconstruction {
        mesh,
        vertices,
        report,
    })
}
