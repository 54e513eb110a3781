//! A 3D Delaunay tetrahedralisation that is uniquely defined, and its Voronoi dual.
//!
//! **The data.** [`Tetrahedralization`] is two flat arrays: four corners a tetrahedron, and for each of
//! its facets the *twin*, the same facet seen from the other side. One vertex at infinity closes the hull,
//! so every facet has a twin. Vertex ids index the caller's points.
//!
//! **The verb.** [`tetrahedralize`] inserts the points one by one in a biased randomised order along the
//! Hilbert curve (Amenta et al. 2003); each digs the tetrahedra whose circumspheres contain it and fills
//! the cavity with tetrahedra around itself (Bowyer 1981, Watson 1981). All decisions are exact signs, and
//! cospherical points are told apart by a perturbation in the lifted dimension (Devillers and Teillaud
//! 2011), so the tetrahedra depend on the *set* of points alone, however degenerate.
//!
//! A [`DynamicTetrahedralization`] owns its points and changes with them: [`insert`] and [`remove`]. What one
//! can ask of either, with examples and costs, is in the [`guide`].
//!
//! [`insert`]: DynamicTetrahedralization::insert
//! [`remove`]: DynamicTetrahedralization::remove
//!
//! ```
//! use pellicle_delaunay::{Options, tetrahedralize};
//! use pellicle_geometry::DVec3;
//!
//! // The corners of a cube: eight cospherical points.
//! let corners: Vec<DVec3> = (0..8)
//!     .map(|i| DVec3::new((i & 1) as f64, (i >> 1 & 1) as f64, (i >> 2) as f64))
//!     .collect();
//! let tetrahedralization = tetrahedralize(&corners, &Options::default())?;
//! assert!(matches!(tetrahedralization.finite_count(), 5 | 6));
//! assert!(tetrahedralization.validate().is_empty());
//! # Ok::<(), pellicle_delaunay::Error>(())
//! ```
//!
//! **Weights.** [`tetrahedralize_weighted`] makes the regular triangulation of points with weights, and names the
//! points that their weights hide.
#![forbid(unsafe_code)]

mod build;
mod circulate;
mod circumcenter;
mod connectivity;
mod dynamic;
mod error;
pub mod guide;
mod id;
mod locate;
mod options;
mod regular;
mod tetrahedralization;
mod validate;
mod voronoi;

pub use circulate::{AroundEdge, AroundVertex};
pub use circumcenter::circumcenter;
pub use dynamic::DynamicTetrahedralization;
pub use error::Error;
pub use id::{FACET_CORNERS, FacetId, TetId};
pub use locate::Location;
pub use options::{InsertionOrder, Options};
pub use regular::{
    RegularTetrahedralization, tetrahedralize_weighted, tetrahedralize_weighted_with,
};
pub use tetrahedralization::Tetrahedralization;
pub use validate::Defect;
pub use voronoi::{VoronoiCell, VoronoiEdge, VoronoiFacet, VoronoiVertex};

use pellicle_geometry::{DVec3, Progress};

/// The Delaunay tetrahedralisation of `points`, in the caller's units.
///
/// The points are neither moved nor changed; equal points count once, under the lowest of their ids.
/// Expected O(n log n) for points in a volume and for generic samples of surfaces, O(n²) at worst; about
/// 38 bytes a tetrahedron at the peak, the caller's points not counted. Works on the threads of the current
/// `rayon` pool; the result does not depend on their number.
///
/// # Errors
///
/// A coordinate that is not finite; fewer than four distinct points; all points on one line or in one
/// plane; more than 2³⁰ tetrahedra.
///
/// ```
/// use pellicle_delaunay::{Error, Options, tetrahedralize};
/// use pellicle_geometry::DVec3;
///
/// let square = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::X + DVec3::Y];
/// let flat = tetrahedralize(&square, &Options::default());
/// assert_eq!(flat.unwrap_err(), Error::Coplanar { distinct: 4 });
/// ```
pub fn tetrahedralize<'a>(
    points: &'a [DVec3],
    options: &Options,
) -> Result<Tetrahedralization<'a>, Error> {
    tetrahedralize_with(points, options, &())
}

/// [`tetrahedralize`], watched by `progress`, whose `Break` makes it return [`Error::Cancelled`] within
/// milliseconds.
pub fn tetrahedralize_with<'a>(
    points: &'a [DVec3],
    options: &Options,
    progress: &dyn Progress,
) -> Result<Tetrahedralization<'a>, Error> {
    build::tetrahedralize(points, None, options, progress)
}
