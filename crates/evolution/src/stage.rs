//! The stages of an evolution: what moves the surface, how long, and on which mesh.

use crate::{Deflation, Redistribution, StepOptions};

/// A run of steps with the same parameters. Lengths are in voxels, so that the same stages suit any cloud.
#[derive(Clone, Debug, PartialEq)]
pub struct Stage {
    /// What moves the surface.
    pub flow: Flow,
    /// How far short of the points the surface stops, in voxels: see [`ShortOf`](crate::ShortOf). Zero: it does not.
    pub standoff: f64,
    /// What is done to the mesh before the first step.
    pub refinement: Refinement,
    /// What is done to the mesh between steps.
    pub upkeep: Upkeep,
    /// The most steps.
    pub steps: u32,
    /// The stage ends when no vertex moves farther than this along its normal in a step, in voxels; zero: it takes all
    /// its steps.
    pub tolerance: f64,
    /// The parameters of a step, with lengths in voxels.
    pub step: StepOptions,
}

/// What moves the surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Flow {
    /// (3.2): onto the points.
    OntoPoints,
    /// Mean curvature flow: w_a = 0 and d = 1 voxel (Daniel 2015, section 5). It smooths, and shrinks.
    MeanCurvature,
    /// The same, and after each step the surface is pushed out along its normals until it holds the volume that it held
    /// at the start of the stage.
    VolumePreserving,
}

/// What is done to the mesh before a stage.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Refinement {
    /// Nothing.
    Keep,
    /// Every triangle in four.
    Subdivide,
    /// Remeshing to edges of this length, in voxels.
    Remesh {
        /// The length.
        edge_length: f64,
    },
}

/// What is done to the mesh between the steps of a stage.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Upkeep {
    /// Nothing: connectivity stands.
    Keep,
    /// Remeshing to edges of this length, in voxels, when angles have become bad or edges too long.
    Remesh {
        /// The length.
        edge_length: f64,
        /// Looked at every so many steps.
        every: u32,
    },
}

impl Stage {
    /// The stages of figures 6 to 10 of Daniel 2015: on an ellipsoid of 2,562 vertices, `steps` steps onto the points
    /// with w_a = 300, the given w_d (100, or 120 against outliers and missing parts), τ = 0.001, ω = 100; then
    /// `smoothing` steps of mean curvature flow with τ = 0.0005 and the given strength (450 or 500).
    pub fn paper(steps: u32, diffusion: f64, smoothing: u32, strength: f64) -> Vec<Self> {
        let onto = Self {
            flow: Flow::OntoPoints,
            standoff: 0.0,
            refinement: Refinement::Keep,
            upkeep: Upkeep::Keep,
            steps,
            tolerance: 0.0,
            step: StepOptions {
                diffusion,
                ..StepOptions::default()
            },
        };
        let smooth = Self {
            flow: Flow::MeanCurvature,
            steps: smoothing,
            step: StepOptions {
                time_step: 0.0005,
                diffusion: strength,
                ..StepOptions::default()
            },
            ..onto.clone()
        };
        vec![onto, smooth]
    }

    /// The stages of figure 11: from 162 vertices to 40,962 by four subdivisions, after 10, 45, 220 and 240 of 245
    /// steps; w_a = 300, w_d = 30, τ = 0.01 at first and four times smaller after each; then three steps of mean
    /// curvature flow.
    pub fn paper_coarse_to_fine() -> Vec<Self> {
        let mut stages = Vec::new();
        for (level, steps) in [10, 35, 175, 20, 5].into_iter().enumerate() {
            stages.push(Self {
                flow: Flow::OntoPoints,
                standoff: 0.0,
                refinement: if level == 0 {
                    Refinement::Keep
                } else {
                    Refinement::Subdivide
                },
                upkeep: Upkeep::Keep,
                steps,
                tolerance: 0.0,
                step: StepOptions {
                    diffusion: 30.0,
                    time_step: 0.01 / f64::from(1 << (2 * level)),
                    ..StepOptions::default()
                },
            });
        }
        stages.push(Self::smoothing(3, 0.25, Flow::MeanCurvature));
        stages
    }

    /// Steps of mean curvature flow; in each, τ w_d is `strength`, in square voxels: details of width √(strength) go.
    pub fn smoothing(steps: u32, strength: f64, flow: Flow) -> Self {
        Self {
            flow,
            standoff: 0.0,
            refinement: Refinement::Keep,
            upkeep: Upkeep::Keep,
            steps,
            tolerance: 0.0,
            step: StepOptions {
                advection: 0.0,
                diffusion: strength,
                time_step: 1.0,
                move_limit: 0.4,
                redistribution: Redistribution::AreaUniform { omega: 0.2 },
                ..StepOptions::default()
            },
        }
    }

    /// The same stage in the units of the coordinates.
    pub(crate) fn step_options(&self, spacing: f64) -> StepOptions {
        let squared = match self.flow {
            Flow::OntoPoints => 1.0,
            // d is one unit there, not one voxel.
            Flow::MeanCurvature | Flow::VolumePreserving => spacing,
        };
        StepOptions {
            advection: match self.flow {
                Flow::OntoPoints => self.step.advection * spacing,
                Flow::MeanCurvature | Flow::VolumePreserving => 0.0,
            },
            diffusion: self.step.diffusion * spacing * squared,
            deflation: self.step.deflation.map(|deflation| Deflation {
                speed: deflation.speed * spacing,
                beyond: deflation.beyond * spacing,
            }),
            ..self.step.clone()
        }
    }
}

/// From coarse to fine, to edges of `edge_length` voxels, each stage with half the edges of the one before, from about
/// `first_edge_length` on.
///
/// In a step the surface moves by at most 0.15 edges towards the points, and by `diffusion` times that times d h by diffusion.
///
/// All but the last stop short of the points: see [`Stage::standoff`]. With a gap, openings wider than that many voxels are
/// opened, those wider than two edges in the first stages too.
pub(crate) fn coarse_to_fine(
    first_edge_length: f64,
    edge_length: f64,
    diffusion: f64,
    gap: Option<f64>,
) -> Vec<Stage> {
    const STANDOFF: f64 = 0.5;
    let levels = (first_edge_length / edge_length)
        .log2()
        .round()
        .clamp(0.0, 30.0) as i32;
    let mut stages = Vec::new();
    for level in (0..=levels).rev() {
        let edge_length = edge_length * 2.0_f64.powi(level);
        let advection = 0.15 * edge_length;
        stages.push(Stage {
            flow: Flow::OntoPoints,
            standoff: if level == 0 {
                0.0
            } else {
                STANDOFF * edge_length
            },
            refinement: Refinement::Remesh { edge_length },
            upkeep: Upkeep::Remesh {
                edge_length,
                every: 5,
            },
            steps: if level == levels { 1000 } else { 200 },
            tolerance: if level == 0 { 0.01 } else { 0.1 * advection },
            step: StepOptions {
                advection,
                diffusion: diffusion * advection,
                time_step: 1.0,
                redistribution: Redistribution::AngleAware {
                    omega: 0.3,
                    omega_angles: 0.2,
                },
                move_limit: 0.4,
                deflation: gap.map(|gap| Deflation {
                    speed: 0.5 * advection,
                    beyond: (0.5 * gap).max(edge_length),
                }),
                ..StepOptions::default()
            },
        });
    }
    stages
}
