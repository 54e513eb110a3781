//! From a cloud to a surface: the whole evolution.

use crate::placement::Placement;
use crate::run::Run;
use crate::{
    DistanceGrid, DistanceOptions, EdgeLength, Error, Evolved, Flow, Measures, Options, Outliers,
    Schedule, Stage, cloud, initial, stage,
};
use glam::DVec3;
use pellicle_geometry::{Aabb, Progress, first_not_finite};
use pellicle_mesh::TriMesh;
use std::cmp::Ordering;

/// Evolves a closed surface onto a cloud.
///
/// # Errors
///
/// Points that are none, or lie in a plane; an initial surface that is open or does not hold them; and whatever
/// [`DistanceGrid::new`] and [`Evolution::step`](crate::Evolution::step) refuse.
pub fn evolve(points: &[DVec3], options: &Options) -> Result<Evolved, Error> {
    evolve_with(points, options, &(), &mut |_, _| {})
}

/// What happens where the surface would run into itself.
pub enum Topology<'a> {
    /// It is held there: the topology of the initial surface stays.
    Fixed,
    /// It goes on, and every few steps what crosses itself is cut away: see [`evolve_adapting`].
    Adaptive {
        /// Openings wider than this many voxels are opened: between objects, through holes, and where points are missing.
        gap: f64,
        /// Makes the closed manifold that bounds the outside of a surface that crosses itself.
        repair: &'a mut dyn FnMut(TriMesh) -> Result<TriMesh, String>,
    },
}

/// [`evolve`], watched: `progress` is told of the steps and may stop it; `each_step` gets the measures and the surface
/// after every step, in the units of the points.
pub fn evolve_with(
    points: &[DVec3],
    options: &Options,
    progress: &dyn Progress,
    each_step: &mut dyn FnMut(&Measures, &TriMesh),
) -> Result<Evolved, Error> {
    evolve_adapting(points, options, &mut Topology::Fixed, progress, each_step)
}

/// [`evolve_with`], with a say in the topology. Adaptive, one surface around several objects ends as several, and handles
/// open, as in the temple of Zaharescu et al. 2007.
///
/// The film between two objects moves on by a [`Deflation`](crate::Deflation) until its sheets have passed through each other; the repair then takes
/// away what is inside out. This crate does not know how to repair; `pellicle::evolve_adapting` brings the two together.
/// The smoothing and the stages of the paper keep the topology.
pub fn evolve_adapting(
    points: &[DVec3],
    options: &Options,
    topology: &mut Topology,
    progress: &dyn Progress,
    each_step: &mut dyn FnMut(&Measures, &TriMesh),
) -> Result<Evolved, Error> {
    if let Topology::Adaptive { gap, .. } = topology
        && (gap.is_nan() || *gap <= 0.0)
    {
        return Err(Error::Option {
            option: "gap (in voxels)",
            value: *gap,
            expected: "positive",
        });
    }
    let Some(placement) = Placement::of(points) else {
        return evolve_in_place(points, options, topology, progress, each_step);
    };
    let inside: Vec<DVec3> = points.iter().map(|&p| placement.inside(p)).collect();
    let options = placement.options(options)?;
    let each_step = &mut |measures: &Measures, mesh: &TriMesh| {
        // A surface beyond all doubles cannot be shown.
        if let Ok(mesh) = placement.mesh(mesh) {
            each_step(&placement.measures(measures), &mesh);
        }
    };
    match evolve_in_place(&inside, &options, topology, progress, each_step) {
        Ok(evolved) => placement.evolved(evolved),
        Err(error) => Err(placement.error(error)),
    }
}

/// [`evolve_adapting`] for a cloud that is not far from the origin, nor very large or small.
fn evolve_in_place(
    points: &[DVec3],
    options: &Options,
    topology: &mut Topology,
    progress: &dyn Progress,
    each_step: &mut dyn FnMut(&Measures, &TriMesh),
) -> Result<Evolved, Error> {
    // 1. The points that count, and the surface around them.
    let kept = keep(points, options.outliers)?;
    let noise = cloud::noise(&kept);
    let (start, first_edge_length) = initial::begin(&kept, options)?;

    // 2. Their distance.
    let grid_options = |sigma: f64| DistanceOptions {
        resolution: options.resolution,
        bounds: Some(room(&kept, &start)),
        sigma,
        ..DistanceOptions::default()
    };
    let spacing = room(&kept, &start).extent().max_element() / f64::from(options.resolution);
    let sigma = options.sigma.unwrap_or((noise / spacing).clamp(1.0, 16.0));
    let grid = DistanceGrid::new(&kept, &grid_options(sigma), progress)?;

    // 3. The stages, and the smoothing.
    let gap = match topology {
        Topology::Fixed => None,
        Topology::Adaptive { gap, .. } => Some(*gap),
    };
    let mut run = Run::new(&grid, topology, progress, each_step);
    run.report.sigma = sigma;
    run.report.noise = noise;
    run.report.outliers = points.len() - kept.len();
    let stages = match options.schedule.clone() {
        Schedule::Stages { stages, .. } => stages,
        Schedule::Adaptive {
            edge_length,
            diffusion,
        } => {
            let edge_length = match edge_length {
                EdgeLength::Voxels(length) => length,
                EdgeLength::Absolute(length) => length / grid.spacing(),
            };
            if !(edge_length > 0.0 && edge_length * 8.0 <= f64::from(options.resolution)) {
                return Err(Error::Option {
                    option: "edge_length (in voxels)",
                    value: edge_length,
                    expected: "positive and at most an eighth of the resolution: longer edges hold no shape",
                });
            }
            stage::coarse_to_fine(
                first_edge_length / grid.spacing(),
                edge_length,
                diffusion,
                gap,
            )
        }
    };
    let mut mesh = start;
    for (number, stage) in stages.iter().enumerate() {
        mesh = run.stage(mesh, stage, number)?;
    }
    if options.smoothing > 0 {
        let stage = Stage::smoothing(options.smoothing, 0.5, Flow::VolumePreserving);
        mesh = run.stage(mesh, &stage, stages.len())?;
    }
    Ok(Evolved {
        mesh,
        report: run.report,
    })
}

/// The points without outliers, which hold a volume, in lexicographic order: nothing depends on the order given.
fn keep(points: &[DVec3], outliers: Outliers) -> Result<Vec<DVec3>, Error> {
    if let Some(index) = first_not_finite(points) {
        return Err(Error::PointNotFinite {
            index: index.index(),
        });
    }
    let mut points = points.to_vec();
    points.sort_by(|a, b| {
        let axes = (0..3).map(|axis| a[axis].total_cmp(&b[axis]));
        axes.fold(Ordering::Equal, Ordering::then)
    });
    let kept = match outliers {
        Outliers::Keep => points,
        Outliers::Leave { ratio } => {
            let inliers = cloud::inliers(&points, ratio);
            inliers.iter().map(|&i| points[i as usize]).collect()
        }
    };
    if kept.is_empty() {
        return Err(Error::EmptyCloud);
    }
    match cloud::dimension(&kept) {
        3 => Ok(kept),
        dimension => Err(Error::Flat {
            points: kept.len(),
            dimension,
        }),
    }
}

/// The box around the points and the initial surface, with a little room.
fn room(points: &[DVec3], initial: &TriMesh) -> Aabb {
    const ROOM: f64 = 0.02;
    let inner = Aabb::of_points(points).union(Aabb::of_points(initial.positions()));
    let pad = DVec3::splat(ROOM * inner.extent().max_element());
    Aabb::of_points(&[inner.min - pad, inner.max + pad])
}
