//! What is asked for, and what happened.

use crate::Error;

/// How to morph. Lengths are in edge lengths L unless said otherwise.
#[derive(Clone, Debug, PartialEq)]
pub struct MorphOptions {
    /// L, the length that edges have in the end (but see `refinements`), in the units of the positions. Default `None`: the target's mean edge,
    /// but at least 1/400 and at most 1/16 of the diagonal of its box.
    pub edge_length: Option<f64>,
    /// No vertex moves farther in a step. Default 0.5: sheets that approach each other both move, and must not come out at
    /// the other side of what lies behind.
    pub step: f64,
    /// How much of the way to the middle of its neighbours a vertex goes in a step, 0 to 1. Default 0.3.
    pub smoothing: f64,
    /// Steps from one repair to the next. Default 2.
    pub repair_every: u32,
    /// How often L may be halved once more where the surface rests with another topology than the target's: a slit narrower
    /// than an edge hides between vertices. Default 2.
    pub refinements: u32,
    /// Where the source is put. Default [`Placement::Keep`].
    pub placement: Placement,
    /// The surface has arrived when its mean distance from the target, and the target's from it, is at most this.
    /// Default 0.2.
    pub mean_distance: f64,
    /// And the greatest at most this. Default 1.
    pub greatest_distance: f64,
    /// The end, wherever the surface is. As a default, 2000 steps.
    pub max_steps: u32,
}

/// Where the source is put before it moves.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Placement {
    /// Where it is.
    #[default]
    Keep,
    /// Moved and scaled, the same on all axes, to the middle and the diagonal of the target's box.
    Fit,
    /// Moved to the middle of the target's box and scaled until the target lies inside of it. Only for a source whose
    /// inside holds a ball around its middle; others are kept as [`Placement::Fit`] puts them.
    Enclose,
}

impl Default for MorphOptions {
    fn default() -> Self {
        Self {
            edge_length: None,
            step: 0.5,
            smoothing: 0.3,
            repair_every: 2,
            refinements: 2,
            placement: Placement::Keep,
            mean_distance: 0.2,
            greatest_distance: 1.0,
            max_steps: 2000,
        }
    }
}

impl MorphOptions {
    pub(super) fn check(&self) -> Result<(), Error> {
        let positive = |option, value: f64| {
            let good = value > 0.0 && value.is_finite();
            good.then_some(()).ok_or(Error::Option {
                option,
                value,
                expected: "must be positive and finite",
            })
        };
        positive("edge_length", self.edge_length.unwrap_or(1.0))?;
        positive("step", self.step)?;
        positive("mean_distance", self.mean_distance)?;
        positive("greatest_distance", self.greatest_distance)?;
        positive("repair_every", f64::from(self.repair_every))?;
        match (0.0..=1.0).contains(&self.smoothing) {
            true => Ok(()),
            false => Err(Error::Option {
                option: "smoothing",
                value: self.smoothing,
                expected: "must be from 0 to 1",
            }),
        }
    }
}

/// The components of a closed surface, by the genus of each, ascending.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
pub struct Topology {
    /// One entry for each component.
    pub genera: Vec<usize>,
}

impl MorphStep {
    pub(super) fn times(mut self, unit: f64) -> Self {
        self.edge_length *= unit;
        self.mean_distance *= unit;
        self.greatest_distance *= unit;
        self.largest_move *= unit;
        self
    }
}

impl MorphReport {
    pub(super) fn times(mut self, unit: f64) -> Self {
        self.edge_length *= unit;
        self.mean_distance *= unit;
        self.greatest_distance *= unit;
        self
    }
}

impl Topology {
    /// How many components.
    pub fn components(&self) -> usize {
        self.genera.len()
    }

    /// The sum of the genera.
    pub fn genus(&self) -> usize {
        self.genera.iter().sum()
    }
}

/// The surface after a step.
#[derive(Clone, Debug, PartialEq)]
pub struct MorphStep {
    /// Steps so far.
    pub step: u32,
    /// L at present, in the units of the positions.
    pub edge_length: f64,
    /// The mean of |d| over the vertices before the last move, in the units of the positions.
    pub mean_distance: f64,
    /// The greatest.
    pub greatest_distance: f64,
    /// How far the vertex that moved most has moved.
    pub largest_move: f64,
    /// Components and genus, as of the last repair.
    pub topology: Topology,
    /// Pairs of triangles that the last repair found; `None` if the surface was not repaired in this step.
    pub repaired_pairs: Option<usize>,
}

/// How a morph ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum MorphEnd {
    /// On the target, and with its topology.
    Arrived,
    /// It does not move any more, but is not what was asked for: see the distances, the topology, and
    /// [`MorphReport::missed`].
    Resting,
    /// The steps ran out.
    StepLimit,
}

/// How a morph went. Distances are in the units of the positions.
#[derive(Clone, Debug, PartialEq)]
pub struct MorphReport {
    /// How it ended.
    pub end: MorphEnd,
    /// Steps.
    pub steps: u32,
    /// L in the end, in the units of the positions.
    pub edge_length: f64,
    /// The result's topology.
    pub topology: Topology,
    /// The target's topology, after repair.
    pub target_topology: Topology,
    /// Components of the target's surface that no vertex of the result is nearest to.
    pub missed: usize,
    /// The mean distance, the greater of both ways.
    pub mean_distance: f64,
    /// The greatest distance, both ways.
    pub greatest_distance: f64,
    /// Pairs of intersecting triangles that repairs found, of all steps together.
    pub repaired_pairs: usize,
    /// Pairs that repairs left, all steps together: zero but in hopeless cases.
    pub remaining_pairs: usize,
    /// How often topology changed.
    pub topology_changes: usize,
    /// Components that were too small for edges of the length L, and were dropped.
    pub crumbs: usize,
    /// Holes of a single triangle that were filled in source and target before anything else.
    pub filled: usize,
}
