//! What an evolution is asked for, and what it returns.

use crate::Stage;
use pellicle_mesh::TriMesh;

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
                edge_length: EdgeLength::Voxels(2.0),
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
    /// An ellipsoid around the points: see [`ellipsoid_around`](crate::ellipsoid_around).
    Ellipsoid,
    /// A closed mesh around the points.
    Mesh(TriMesh),
}

/// What an evolution goes through.
#[derive(Clone, Debug, PartialEq)]
pub enum Schedule {
    /// From coarse to fine with remeshing, until the surface rests, on a mesh with edges of this length. Where the surface
    /// is about to run into itself, it is held.
    Adaptive {
        /// The length.
        edge_length: EdgeLength,
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

/// The length of the edges of the result.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum EdgeLength {
    /// In voxels. Below one, edges are shorter than what the grid resolves.
    Voxels(f64),
    /// In the units of the points.
    Absolute(f64),
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
    /// How many vertices were held at the end, since the surface would have run into itself there.
    pub held: usize,
    /// Whether every stage with a tolerance met it before its steps ran out.
    pub at_rest: bool,
}
