//! The surface on its way.

use super::motion::Motion;
use super::options::{MorphEnd, MorphOptions, MorphReport, MorphStep, Topology};
use super::target::{Target, topology};
use crate::{Error, Options, repair_with};
use pellicle_geometry::{Aabb, Progress, VertexId};
use pellicle_mesh::{
    DistanceOptions, Projection, RemeshOptions, TargetLength, TriMesh, TriangleSoup, compare,
    components, remesh, summarize,
};

/// A component whose box has a diagonal below this many edges is a crumb.
const CRUMB: f64 = 0.75;
/// Repairs over which the topology must stay, and progress is judged.
const REST: usize = 4;
/// Repairs without progress after which the surface rests.
const PATIENCE: usize = 12;

pub(super) struct State<'a> {
    pub(super) mesh: TriMesh,
    pub(super) steps: u32,
    /// L at present.
    pub(super) edge: f64,
    target: &'a Target,
    options: &'a MorphOptions,
    topology: Topology,
    record: MorphStep,
    /// Repairs since the topology changed.
    settled: usize,
    /// The least mean distance at this L, and repairs since it was reached.
    least: f64,
    stalled: usize,
    /// How often L may still be halved below the target's.
    refinements: u32,
    report: MorphReport,
}

pub(super) enum Verdict {
    Moving,
    Resting,
    Arrived,
}

impl<'a> State<'a> {
    pub(super) fn new(
        (mesh, filled): (TriMesh, usize),
        target: &'a Target,
        options: &'a MorphOptions,
    ) -> Result<Self, Error> {
        let own = summarize((&mesh).into())?
            .shape
            .map_or(target.edge, |shape| shape.mean_edge);
        let largest = (target.bounds.diagonal() / 16.0).max(target.edge);
        // L times a power of two, so that halving ends there.
        let halvings = (own.min(largest) / target.edge).log2().floor().max(0.0);
        let edge = target.edge * halvings.exp2();
        let topology = topology(&mesh)?;
        Ok(Self {
            steps: 0,
            edge,
            target,
            options,
            record: MorphStep {
                step: 0,
                edge_length: edge,
                mean_distance: f64::INFINITY,
                greatest_distance: f64::INFINITY,
                largest_move: 0.0,
                topology: topology.clone(),
                repaired_pairs: None,
            },
            settled: 0,
            least: f64::INFINITY,
            stalled: 0,
            refinements: options.refinements,
            report: MorphReport {
                end: MorphEnd::StepLimit,
                steps: 0,
                edge_length: edge,
                topology: topology.clone(),
                target_topology: target.topology.clone(),
                missed: 0,
                mean_distance: f64::INFINITY,
                greatest_distance: f64::INFINITY,
                repaired_pairs: 0,
                remaining_pairs: 0,
                topology_changes: 0,
                crumbs: 0,
                filled: filled + target.filled,
            },
            topology,
            mesh,
        })
    }

    pub(super) fn record(&self) -> MorphStep {
        self.record.clone()
    }

    /// Triangles of the length L, where they are not.
    pub(super) fn remesh(&mut self, progress: &dyn Progress) -> Result<(), Error> {
        let iterations = if self.steps == 0 { 6 } else { 1 };
        let options = RemeshOptions {
            target: TargetLength::Absolute(self.edge),
            iterations,
            projection: Projection::None,
            ..RemeshOptions::default()
        };
        self.mesh = remesh(&self.mesh, &options, progress)?.0;
        Ok(())
    }

    pub(super) fn advance(&mut self, motion: Motion) -> Result<(), Error> {
        self.mesh.set_positions(motion.positions)?;
        self.steps += 1;
        self.record = MorphStep {
            step: self.steps,
            edge_length: self.edge,
            mean_distance: motion.mean_distance,
            greatest_distance: motion.greatest_distance,
            largest_move: motion.largest_move,
            topology: self.topology.clone(),
            repaired_pairs: None,
        };
        Ok(())
    }

    /// Removes self-intersections and crumbs.
    pub(super) fn repair(
        &mut self,
        options: &Options,
        progress: &dyn Progress,
    ) -> Result<(), Error> {
        let (mesh, report) = repair_with((&self.mesh).into(), options, progress, &mut ())?;
        self.mesh = mesh;
        self.drop_crumbs()?;
        if self.mesh.triangles().is_empty() {
            return Err(Error::Vanished { step: self.steps });
        }
        let topology = topology(&self.mesh)?;
        if topology != self.topology {
            self.report.topology_changes += 1;
            self.settled = 0;
            self.topology = topology;
        } else {
            self.settled += 1;
        }
        self.report.repaired_pairs += report.pairs;
        self.report.remaining_pairs += report.remaining;
        self.record.topology = self.topology.clone();
        self.record.repaired_pairs = Some(report.pairs);
        Ok(())
    }

    fn drop_crumbs(&mut self) -> Result<(), Error> {
        let component = components((&self.mesh).into());
        let mut boxes = vec![Aabb::EMPTY; self.mesh.positions().len()];
        for (t, &c) in self.mesh.triangle_ids().zip(&component) {
            let corners = self.mesh.corners(t);
            boxes[c.index()] = boxes[c.index()].union(Aabb::of_points(&corners));
        }
        let is_small = |b: &Aabb| b.diagonal() < CRUMB * self.edge;
        let is_crumb = |c: VertexId| is_small(&boxes[c.index()]);
        let crumbs = boxes
            .iter()
            .filter(|b| !b.is_empty() && is_small(b))
            .count();
        if crumbs == 0 {
            return Ok(());
        }
        self.report.crumbs += crumbs;
        let kept = self.mesh.triangles().iter().zip(&component);
        let mut soup = TriangleSoup {
            positions: self.mesh.positions().to_vec(),
            triangles: kept
                .filter(|(_, c)| !is_crumb(**c))
                .map(|(t, _)| *t)
                .collect(),
        };
        soup.compact();
        self.mesh = TriMesh::try_from(soup)?;
        Ok(())
    }

    /// Whether the surface is there, or gets no nearer.
    pub(super) fn judge(&mut self) -> Result<Verdict, Error> {
        let mean = self.record.mean_distance / self.edge;
        if mean < 0.98 * self.least || self.settled == 0 {
            self.least = mean.min(self.least);
            self.stalled = 0;
        } else {
            self.stalled += 1;
        }
        let record = (self.record.mean_distance, self.record.greatest_distance);
        let near = self.is_near(record);
        if near && self.settled >= REST {
            if self.edge > self.target.edge {
                return Ok(Verdict::Resting);
            }
            if self.topology == self.target.topology && self.has_arrived()? {
                return Ok(Verdict::Arrived);
            }
        }
        match self.stalled >= PATIENCE {
            true => Ok(Verdict::Resting),
            false => Ok(Verdict::Moving),
        }
    }

    fn has_arrived(&mut self) -> Result<bool, Error> {
        self.measure()?;
        Ok(self.is_near((self.report.mean_distance, self.report.greatest_distance)))
    }

    /// Whether mean and greatest distance are small against L, as it was before it was refined for topology's sake.
    fn is_near(&self, (mean, greatest): (f64, f64)) -> bool {
        let length = self.edge.max(self.target.edge);
        mean <= self.options.mean_distance * length
            && greatest <= self.options.greatest_distance * length
    }

    fn measure(&mut self) -> Result<(), Error> {
        let options = DistanceOptions {
            samples: 20_000,
            seed: 0,
        };
        let c = compare(
            (&self.mesh).into(),
            (&self.target.mesh).into(),
            &options,
            &(),
        )?;
        self.report.mean_distance = c.forward.mean.max(c.backward.mean);
        self.report.greatest_distance = c.hausdorff();
        Ok(())
    }

    /// Halves L, if it is not yet what it should be, or hides what should be seen.
    pub(super) fn refine(&mut self) -> bool {
        if self.edge > self.target.edge {
            self.edge = (0.5 * self.edge).max(self.target.edge);
        } else if self.refinements > 0
            && self.topology != self.target.topology
            && self.target.missed_by(&self.mesh) == 0
        {
            self.refinements -= 1;
            self.edge *= 0.5;
        } else {
            return false;
        }
        tracing::debug!(edge_length = self.edge, step = self.steps, "refined");
        self.least = f64::INFINITY;
        self.stalled = 0;
        self.settled = 0;
        true
    }

    pub(super) fn finish(mut self, end: MorphEnd) -> Result<(TriMesh, MorphReport), Error> {
        self.measure()?;
        self.report.missed = self.target.missed_by(&self.mesh);
        let report = MorphReport {
            end,
            steps: self.steps,
            edge_length: self.edge,
            topology: self.topology,
            ..self.report
        };
        Ok((self.mesh, report))
    }
}
