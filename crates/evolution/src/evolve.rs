//! From a cloud to a surface: the whole evolution.

use crate::cloud;
use crate::{
    DistanceGrid, DistanceOptions, Error, Evolution, Field, Flow, Measures, One, Refinement, Stage,
    Upkeep, ellipsoid_around, stage,
};
use glam::DVec3;
use pellicle_geometry::{Aabb, Cancelled, Progress};
use pellicle_mesh::{
    Projection, RemeshOptions, TargetLength, TriMesh, area, remesh, signed_volume, subdivide,
};

/// How a surface evolves onto points.
#[derive(Clone, Debug)]
pub struct Options {
    /// Voxels along the longest side of the box around the initial surface. The paper: 200.
    pub resolution: u32,
    /// σ of the Gauss kernel. `None`: one voxel, or as much as the points' noise if that is more.
    pub sigma: Option<f64>,
    /// What is done about points that stand alone.
    pub outliers: Outliers,
    /// What the evolution starts from.
    pub initial: Initial,
    /// What it goes through.
    pub schedule: Schedule,
    /// What follows: steps of mean curvature flow that keep the volume.
    pub smoothing: u32,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            resolution: 200,
            sigma: None,
            outliers: Outliers::Leave { ratio: 2.5 },
            initial: Initial::Ellipsoid,
            schedule: Schedule::Adaptive {
                edge_length: 2.0,
                diffusion: 0.1,
            },
            smoothing: 0,
        }
    }
}

/// What is done about points that stand alone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Outliers {
    /// They count like all others: diffusion carries the surface past them.
    Keep,
    /// A point whose distance from its neighbours is more than `ratio` times what is usual among those is left out.
    Leave {
        /// The ratio.
        ratio: f64,
    },
}

/// What an evolution starts from.
#[derive(Clone, Debug)]
pub enum Initial {
    /// An ellipsoid around the points: see [`ellipsoid_around`].
    Ellipsoid,
    /// A closed mesh around the points.
    Mesh(TriMesh),
}

/// What an evolution goes through.
#[derive(Clone, Debug, PartialEq)]
pub enum Schedule {
    /// From coarse to fine with remeshing, until the surface rests, on a mesh with edges of this length, in voxels.
    Adaptive {
        /// The length.
        edge_length: f64,
        /// w_d / w_a. More carries the surface past outliers and over gaps, and off thin limbs. The paper has 0.1 for a
        /// rich shape, 0.33 for plain ones, and 0.4 against outliers and missing parts.
        diffusion: f64,
    },
    /// These stages, from an ellipsoid of 10 · 4ˡᵉᵛᵉˡˢ + 2 vertices.
    Stages {
        /// Subdivisions of the icosahedron; the paper has 4 and 2.
        levels: u32,
        /// The stages.
        stages: Vec<Stage>,
    },
}

/// A surface, and how it came about.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Evolved {
    /// The surface, closed, counter-clockwise seen from outside.
    pub mesh: TriMesh,
    /// How.
    pub report: Report,
}

/// How a surface came about.
#[derive(Clone, Debug, Default)]
#[non_exhaustive]
pub struct Report {
    /// The side of a voxel, in the units of the points.
    pub spacing: f64,
    /// σ in voxels.
    pub sigma: f64,
    /// The points' estimated noise, in their units.
    pub noise: f64,
    /// How many points were left out.
    pub outliers: usize,
    /// Steps, of all stages.
    pub steps: u64,
    /// Whether every stage with a tolerance met it before its steps ran out.
    pub at_rest: bool,
}

/// Evolves a closed surface onto a cloud.
///
/// # Errors
///
/// Points that are none, or lie in a plane; an initial surface that is open or does not hold them; and whatever
/// [`DistanceGrid::new`] and [`Evolution::step`] refuse.
pub fn evolve(points: &[DVec3], options: &Options) -> Result<Evolved, Error> {
    evolve_with(points, options, &(), &mut |_, _| {})
}

/// [`evolve`], watched: `progress` is told of the steps and may stop it; `each_step` gets the measures and the surface
/// at the start of every stage and after every step.
pub fn evolve_with(
    points: &[DVec3],
    options: &Options,
    progress: &dyn Progress,
    each_step: &mut dyn FnMut(&Measures, &TriMesh),
) -> Result<Evolved, Error> {
    // 1. The points that count, and the surface around them.
    let kept = keep(points, options.outliers)?;
    let noise = cloud::noise(&kept);
    let (initial, stages) = begin(&kept, options)?;

    // 2. Their distance.
    let grid_options = |sigma: f64| DistanceOptions {
        resolution: options.resolution,
        bounds: Some(room(&kept, &initial)),
        sigma,
        ..DistanceOptions::default()
    };
    let spacing = room(&kept, &initial).extent().max_element() / f64::from(options.resolution);
    let sigma = options.sigma.unwrap_or((noise / spacing).clamp(1.0, 16.0));
    let grid = DistanceGrid::new(&kept, &grid_options(sigma), progress)?;

    // 3. The stages, and the smoothing.
    let mut run = Run {
        grid: &grid,
        progress,
        each_step,
        started: std::time::Instant::now(),
        report: Report {
            spacing: grid.spacing(),
            sigma,
            noise,
            outliers: points.len() - kept.len(),
            steps: 0,
            at_rest: true,
        },
    };
    let stages = match (options.schedule.clone(), stages) {
        (Schedule::Stages { stages, .. }, _) => stages,
        (
            Schedule::Adaptive {
                edge_length,
                diffusion,
            },
            first,
        ) => stage::coarse_to_fine(first / grid.spacing(), edge_length, diffusion),
    };
    let mut mesh = initial;
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

/// The points without outliers.
fn keep(points: &[DVec3], outliers: Outliers) -> Result<Vec<DVec3>, Error> {
    if points.is_empty() {
        return Err(Error::EmptyCloud);
    }
    Ok(match outliers {
        Outliers::Keep => points.to_vec(),
        Outliers::Leave { ratio } => cloud::inliers(points, ratio)
            .iter()
            .map(|&i| points[i as usize])
            .collect(),
    })
}

/// The initial surface, and the length of its edges.
fn begin(points: &[DVec3], options: &Options) -> Result<(TriMesh, f64), Error> {
    const MARGIN: f64 = 0.05;
    let mesh = match &options.initial {
        Initial::Mesh(mesh) => mesh.clone(),
        Initial::Ellipsoid => {
            let levels = match options.schedule {
                Schedule::Adaptive { .. } => 3,
                Schedule::Stages { levels, .. } => levels,
            };
            let margin = MARGIN * Aabb::of_points(points).extent().max_element();
            ellipsoid_around(points, margin, levels)?
        }
    };
    let triangles = mesh.triangles().len() as f64;
    let edge_length = (area((&mesh).into()) / triangles * 4.0 / 3.0_f64.sqrt()).sqrt();
    Ok((mesh, edge_length))
}

/// The box around the points and the initial surface, with a little room.
fn room(points: &[DVec3], initial: &TriMesh) -> Aabb {
    const ROOM: f64 = 0.02;
    let inner = Aabb::of_points(points).union(Aabb::of_points(initial.positions()));
    let pad = DVec3::splat(ROOM * inner.extent().max_element());
    Aabb::of_points(&[inner.min - pad, inner.max + pad])
}

/// Less than this many voxels inside: the surface holds nothing.
const SMALLEST_VOLUME: f64 = 30.0;

/// What all stages share.
struct Run<'a> {
    grid: &'a DistanceGrid,
    progress: &'a dyn Progress,
    each_step: &'a mut dyn FnMut(&Measures, &TriMesh),
    started: std::time::Instant,
    report: Report,
}

impl Run<'_> {
    /// One stage.
    fn stage(&mut self, mesh: TriMesh, stage: &Stage, number: usize) -> Result<TriMesh, Error> {
        let spacing = self.grid.spacing();
        let mesh = match stage.refinement {
            Refinement::Keep => mesh,
            Refinement::Subdivide => subdivide(&mesh)?,
            Refinement::Remesh { edge_length } => {
                remeshed(&mesh, edge_length * spacing, 3, self.progress)?
            }
        };
        let volume = signed_volume((&mesh).into());
        let options = stage.step_options(spacing);
        let field: &dyn Field = match stage.flow {
            Flow::OntoPoints => self.grid,
            Flow::MeanCurvature | Flow::VolumePreserving => &One,
        };
        let mut evolution = Evolution::new(mesh)?;
        let mut rests = false;
        for step in 0..stage.steps {
            Cancelled::check(
                self.progress
                    .step("evolve", step.into(), stage.steps.into()),
            )?;
            let report = evolution.step(field, &options)?;
            if stage.flow == Flow::VolumePreserving {
                evolution.restore_volume(volume)?;
            }
            self.report.steps += 1;
            let seconds = self.started.elapsed().as_secs_f64();
            let measures = Measures::of(
                evolution.mesh(),
                number,
                self.report.steps,
                &report,
                spacing,
                seconds,
            );
            (self.each_step)(&measures, evolution.mesh());
            if measures.volume < SMALLEST_VOLUME * spacing.powi(3) {
                return Err(Error::Collapsed {
                    step: self.report.steps,
                });
            }
            rests = report.largest_normal_move <= stage.tolerance * spacing;
            if rests && stage.tolerance > 0.0 {
                break;
            }
            if let Upkeep::Remesh { edge_length, every } = stage.upkeep
                && (step + 1) % every.max(1) == 0
                && wants_upkeep(&measures, edge_length * spacing)
            {
                let remeshed = remeshed(evolution.mesh(), edge_length * spacing, 1, self.progress)?;
                evolution = Evolution::new(remeshed)?;
            }
        }
        self.report.at_rest &= rests || stage.tolerance == 0.0;
        Ok(evolution.into_mesh())
    }
}

/// Edges of about one length, on the surface as it is.
fn remeshed(
    mesh: &TriMesh,
    edge_length: f64,
    iterations: u32,
    progress: &dyn Progress,
) -> Result<TriMesh, Error> {
    let options = RemeshOptions {
        target: TargetLength::Absolute(edge_length),
        iterations,
        projection: Projection::Surface,
        ..RemeshOptions::default()
    };
    Ok(remesh(mesh, &options, progress)?.0)
}

/// Whether triangles have become bad, or too large for the edges wanted.
fn wants_upkeep(measures: &Measures, edge_length: f64) -> bool {
    const SMALL: f64 = 25.0;
    const LARGE: f64 = 130.0;
    let wanted = 0.433 * edge_length * edge_length;
    measures.least_angle < SMALL
        || measures.greatest_angle > LARGE
        || measures.greatest_area > 3.0 * wanted
        || measures.least_area < 0.2 * wanted
}
