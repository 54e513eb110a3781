//! Evolution with changes of topology: the loop that brings `evolution` and `transformesh` together.

use crate::evolution::{Error, Evolved, Measures, Options, Topology};
use crate::geometry::{DVec3, Progress};
use crate::mesh::TriMesh;
use crate::transformesh::{Options as RepairOptions, Rule, repair};

/// A gap for [`evolve_adapting`] that suits clouds without larger holes: in voxels.
pub const ADAPTING_GAP: f64 = 12.0;

/// [`evolution::evolve_with`](crate::evolution::evolve_with), with changes of topology: one surface around several objects ends as
/// several, and handles open.
///
/// Every few steps what crosses itself is repaired ([`transformesh`](crate::transformesh), what is reached from outside stays),
/// then remeshed where needed. Openings wider than `gap` voxels are opened, [`ADAPTING_GAP`] by default: also those that points
/// are missing from, which a surface of fixed topology would span.
///
/// ```
/// use pellicle::prelude::*;
///
/// // Two spheres.
/// let sphere = mesh::icosphere(3)?;
/// let points: Vec<DVec3> = (sphere.positions().iter())
///     .flat_map(|&p| [p - 2.0 * DVec3::X, p + 2.0 * DVec3::X])
///     .collect();
/// let options = evolution::Options { resolution: 60, ..evolution::Options::default() };
/// let evolved = pellicle::evolve_adapting(&points, &options, pellicle::ADAPTING_GAP, &(), &mut |_, _| {})?;
/// let summary = mesh::summarize((&evolved.mesh).into())?;
/// assert_eq!(summary.components.len(), 2);
/// assert_eq!(mesh::count_self_intersections((&evolved.mesh).into(), &())?, 0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn evolve_adapting(
    points: &[DVec3],
    options: &Options,
    gap: f64,
    progress: &dyn Progress,
    each_step: &mut dyn FnMut(&Measures, &TriMesh),
) -> Result<Evolved, Error> {
    let outside = RepairOptions {
        rule: Rule::Outside,
        ..RepairOptions::default()
    };
    let mut topology = Topology::Adaptive {
        gap,
        repair: &mut |mesh| match repair(&mesh, &outside) {
            Ok((mesh, _)) => Ok(mesh),
            Err(error) => Err(error.to_string()),
        },
    };
    crate::evolution::evolve_adapting(points, options, &mut topology, progress, each_step)
}
