//! A triangle mesh that crosses itself becomes the manifold that bounds its outside, exactly.
//!
//! The data are a [`TriMesh`](pellicle_mesh::TriMesh) or a soup that bounds something, and an [`Options`] with the [`Rule`]; the
//! verb is [`repair`], which returns a closed, oriented manifold without self-intersections and a [`Report`].
//!
//! ```
//! use pellicle_geometry::DVec3;
//! use pellicle_mesh::{count_self_intersections, icosphere, signed_volume};
//! use pellicle_transformesh::{Options, repair};
//!
//! // Two overlapping spheres.
//! let mut soup = icosphere(2)?.into_soup();
//! let other = soup.clone();
//! let count = soup.positions.len() as u32;
//! soup.positions.extend(other.positions.iter().map(|&p| p + 0.7 * DVec3::ONE));
//! soup.triangles.extend(other.triangles.iter().map(|t| t.map(|v| pellicle_geometry::VertexId(v.0 + count))));
//!
//! let (mesh, report) = repair(&soup, &Options::default())?;
//! assert_eq!(report.components, [2, 1]);
//! assert!(mesh.is_closed());
//! assert_eq!(count_self_intersections((&mesh).into(), &())?, 0);
//! assert!(report.volume[1] < report.volume[0]);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! [`morph`] moves a surface onto another with it, through changes of topology.
//!
//! The method is that of Zaharescu et al. 2007, with what they leave open decided by winding numbers; see [`repair`].
#![forbid(unsafe_code)]

mod arrangement;
mod error;
mod fan;
mod grow;
mod hash;
mod intersection;
mod morph;
mod observer;
mod options;
mod outside;
mod points;
mod ray;
mod repair;
mod rounding;
mod segments;
mod slivers;
mod stitch;
mod surface;
mod triangulation;
mod weld;
mod winding;

pub use error::Error;
pub use morph::{
    MorphEnd, MorphOptions, MorphReport, MorphStep, Placement, Topology, morph, morph_with,
};
pub use observer::{Observer, Piece, Segment};
pub use options::{Options, Report, Rule};
pub use repair::{repair, repair_with};
pub use segments::intersection_segments;
