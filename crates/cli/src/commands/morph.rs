//! `pellicle morph`.

use crate::arguments::{Global, Target, number, positive};
use crate::failure::Failure;
use crate::progress::Watch;
use crate::snapshots::{Kept, Snapshots};
use crate::surface::Surface;
use crate::{interrupt, output};
use clap::{Args, ValueEnum};
use pellicle::geometry::Progress;
use pellicle::io::{Content, read_mesh, write_text};
use pellicle::mesh::{MeshView, TriMesh, TriangleSoup};
use pellicle::transformesh::{
    Error, MorphEnd, MorphOptions, MorphReport, MorphStep, Placement, morph_with,
};
use serde::Serialize;
use std::num::{NonZeroU32, NonZeroU64};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

const EXAMPLE: &str = "\
Examples:
  pellicle morph ball.ply knot.off -o out.ply --place enclose
  pellicle morph torus.off genus3.off -o out.ply --place fit --snapshots frames --every 2

An edge is --edge-length; the surface has arrived when its mean distance from the target, and the target's from it, is at \
most a fifth of that, and it has the target's components and genus.

A morph that fails leaves no OUT, but its table, and its snapshots with the last surface among them. Ctrl-C leaves the \
snapshots so far.";

const CSV_HEADER: &str = "step,edge_length,vertices,triangles,mean_distance,greatest_distance,largest_move,components,genus,repaired_pairs";

/// Deform a closed surface into another, topology included
///
/// The source moves along its normals onto the target: outside of it the surface shrinks, inside it grows. Holes open, and
/// pieces split off, merge or vanish on the way. A component of the target is found if the source overlaps it at the
/// start. Both are repaired first where they cross themselves.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLE)]
pub struct Morph {
    /// The closed mesh that moves
    #[arg(value_name = "SOURCE")]
    source: PathBuf,
    /// The closed mesh that it becomes
    #[arg(value_name = "TARGET")]
    into: PathBuf,
    #[command(flatten)]
    target: Target,
    /// Where the source starts
    #[arg(long = "place", value_name = "WHERE", default_value = "keep")]
    placement: Place,
    /// The length of edges in the end, in the units of the target; its own mean edge by default
    #[arg(long, value_name = "LENGTH", value_parser = positive)]
    edge_length: Option<f64>,
    /// How far a vertex moves in a step at most, in edge lengths
    #[arg(long, value_name = "EDGES", default_value_t = MorphOptions::default().step, value_parser = positive)]
    step: f64,
    /// How much of the way to the middle of its neighbours a vertex goes in a step
    #[arg(long, value_name = "PART", default_value_t = MorphOptions::default().smoothing, value_parser = part)]
    smoothing: f64,
    /// Steps from one repair to the next
    #[arg(long, value_name = "STEPS", default_value = "2")]
    repair_every: NonZeroU32,
    /// The end, wherever the surface is
    #[arg(long, value_name = "STEPS", default_value_t = MorphOptions::default().max_steps)]
    max_steps: u32,
    /// Write numbered meshes into this folder, an animation morph.glb, and pictures side by side, morph.png
    #[arg(long, value_name = "DIR")]
    snapshots: Option<PathBuf>,
    /// Steps from one snapshot to the next; multiples of --repair-every show surfaces just repaired
    #[arg(
        long,
        value_name = "STEPS",
        default_value = "4",
        requires = "snapshots"
    )]
    every: NonZeroU64,
    /// Write the measures of every step as a table
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Place {
    /// Where it is
    Keep,
    /// Moved and scaled to the target's box
    Fit,
    /// Around the target
    Enclose,
}

#[derive(Serialize)]
struct Done {
    source: PathBuf,
    target: PathBuf,
    output: PathBuf,
    #[serde(flatten)]
    surface: Surface,
    /// Whether the surface is on the target, with its topology.
    arrived: bool,
    steps: u32,
    edge_length: f64,
    target_components: usize,
    target_genus: usize,
    /// Components of the target that the surface did not come to.
    missed: usize,
    mean_distance: f64,
    mean_distance_edges: f64,
    greatest_distance: f64,
    greatest_distance_edges: f64,
    repaired_pairs: usize,
    topology_changes: usize,
    snapshots: Option<Kept>,
    csv: Option<PathBuf>,
    bytes: u64,
}

impl Morph {
    /// Reads both, morphs, writes.
    pub fn run(self, global: &Global, watch: &Watch) -> Result<(), Failure> {
        self.target.check(Content::Mesh)?;
        self.target.check_further(self.csv.as_deref())?;
        let (every, force) = (self.every.get(), self.target.force);
        let folder = self.snapshots.as_deref();
        let snapshots = folder
            .map(|folder| Snapshots::new(folder, "morph", every, force, watch))
            .transpose()?;
        let source = read(&self.source, watch)?;
        let into = read(&self.into, watch)?;

        let mut record = Record::new(snapshots, self.csv.is_some(), watch);
        let morphed = record.morph(&source, &into, &self.options());
        if let Some(failure) = record.failure.take() {
            return Err(failure);
        }
        let (mesh, report) = match morphed {
            Ok(morphed) => morphed,
            Err(reason) => {
                let failure = self.explain(reason);
                if !failure.is_interruption() {
                    self.keep(record, None)?;
                }
                return Err(failure);
            }
        };
        let written = self.target.write_mesh(&mesh, watch)?;
        let snapshots = self.keep(record, Some(&mesh))?;
        let done = self.done(&mesh, report, snapshots, written.bytes, watch)?;
        done.log();
        output::report(global, &done)
    }

    fn options(&self) -> MorphOptions {
        MorphOptions {
            edge_length: self.edge_length,
            step: self.step,
            smoothing: self.smoothing,
            repair_every: self.repair_every.get(),
            placement: match self.placement {
                Place::Keep => Placement::Keep,
                Place::Fit => Placement::Fit,
                Place::Enclose => Placement::Enclose,
            },
            max_steps: self.max_steps,
            ..MorphOptions::default()
        }
    }

    /// Writes the table, and puts the snapshots together, of which the result, or else the last surface, is the last.
    fn keep(&self, record: Record, result: Option<&TriMesh>) -> Result<Option<Kept>, Failure> {
        if record.last.is_none() {
            return Ok(None);
        }
        let options = self.target.options(record.watch);
        if let Some(path) = &self.csv {
            interrupt::while_writing(|| write_text(path, &record.table, &options))?;
        }
        match (record.snapshots, record.last) {
            (Some(snapshots), Some((step, last))) => {
                snapshots.finish(step, result.unwrap_or(&last)).map(Some)
            }
            _ => Ok(None),
        }
    }

    /// Names the file that is the reason of a failure.
    fn explain(&self, reason: Error) -> Failure {
        let is_target = matches!(
            &reason,
            Error::Empty { side: "target" } | Error::Side { side: "target", .. }
        );
        Failure::Morph {
            path: match is_target {
                true => self.into.clone(),
                false => self.source.clone(),
            },
            reason,
        }
    }

    fn done(
        self,
        mesh: &TriMesh,
        report: MorphReport,
        snapshots: Option<Kept>,
        bytes: u64,
        watch: &Watch,
    ) -> Result<Done, Failure> {
        let failed = super::mesh_failure(&self.target.output);
        Ok(Done {
            surface: Surface::of(mesh, watch).map_err(failed)?,
            arrived: report.end == MorphEnd::Arrived,
            steps: report.steps,
            edge_length: report.edge_length,
            target_components: report.target_topology.components(),
            target_genus: report.target_topology.genus(),
            missed: report.missed,
            mean_distance: report.mean_distance,
            mean_distance_edges: report.mean_distance / report.edge_length,
            greatest_distance: report.greatest_distance,
            greatest_distance_edges: report.greatest_distance / report.edge_length,
            repaired_pairs: report.repaired_pairs,
            topology_changes: report.topology_changes,
            snapshots,
            csv: self.csv,
            source: self.source,
            target: self.into,
            output: self.target.output,
            bytes,
        })
    }
}

/// Any mesh; it is repaired later.
fn read(path: &Path, watch: &Watch) -> Result<TriangleSoup, Failure> {
    let read = read_mesh(path, &super::read_options(watch))?;
    output::log_notes(path, &read.report.notes);
    Ok(read.soup)
}

fn part(text: &str) -> Result<f64, String> {
    number(
        text,
        |value| (0.0..=1.0).contains(&value),
        "must be from 0 to 1",
    )
}

impl Done {
    fn log(&self) {
        self.surface.log();
        tracing::info!(
            "{} steps; topology changed in {} repairs, and {} pairs of triangles crossed",
            self.steps,
            self.topology_changes,
            self.repaired_pairs
        );
        tracing::info!(
            "the mean distance from the target is {} ({:.3} edges), the greatest {} ({:.3})",
            output::digits(self.mean_distance),
            self.mean_distance_edges,
            output::digits(self.greatest_distance),
            self.greatest_distance_edges
        );
        if self.missed > 0 {
            tracing::warn!(
                "{} components of the target's surface were not found: the source did not overlap them, or it held a whole \
                 cavity; --place enclose starts from around everything",
                self.missed
            );
        } else if !self.arrived {
            tracing::warn!(
                "the surface did not arrive: the target has {} components of genus {} in all; a shorter --edge-length \
                 sees narrower slits",
                self.target_components,
                self.target_genus
            );
        }
    }
}

/// What is kept of a morph while it runs.
struct Record<'a> {
    watch: &'a Watch,
    snapshots: Option<Snapshots<'a>>,
    wants_table: bool,
    table: String,
    /// The surface after the last step.
    last: Option<(u64, TriMesh)>,
    failure: Option<Failure>,
}

impl<'a> Record<'a> {
    fn new(snapshots: Option<Snapshots<'a>>, wants_table: bool, watch: &'a Watch) -> Self {
        Self {
            watch,
            snapshots,
            wants_table,
            table: format!("{CSV_HEADER}\n"),
            last: None,
            failure: None,
        }
    }

    fn morph(
        &mut self,
        source: &TriangleSoup,
        target: &TriangleSoup,
        options: &MorphOptions,
    ) -> Result<(TriMesh, MorphReport), Error> {
        let observer = Observer {
            watch: self.watch,
            moving: AtomicBool::new(false),
            failed: AtomicBool::new(false),
        };
        let (source, target) = (MeshView::from(source), MeshView::from(target));
        morph_with(source, target, options, &observer, &mut |step, mesh| {
            observer.moving.store(true, Relaxed);
            observer.failed.fetch_or(!self.step(step, mesh), Relaxed);
        })
    }

    /// Whether all went well.
    fn step(&mut self, step: &MorphStep, mesh: &TriMesh) -> bool {
        self.watch.tell(|| {
            format!(
                "morph: step {}, {} vertices, {} components, genus {}, mean distance {:.3} edges",
                step.step,
                mesh.positions().len(),
                step.topology.components(),
                step.topology.genus(),
                step.mean_distance / step.edge_length
            )
        });
        if self.wants_table {
            self.table.push_str(&row(step, mesh));
        }
        if let (Some(snapshots), None) = (&mut self.snapshots, &self.failure) {
            self.failure = snapshots.step(step.step.into(), mesh).err();
        }
        self.last = Some((step.step.into(), mesh.clone()));
        self.failure.is_none()
    }
}

/// A row of the table; distances are unknown before the first step.
fn row(step: &MorphStep, mesh: &TriMesh) -> String {
    let known = |value: f64| match value.is_finite() {
        true => value.to_string(),
        false => String::new(),
    };
    format!(
        "{},{},{},{},{},{},{},{},{},{}\n",
        step.step,
        step.edge_length,
        mesh.positions().len(),
        mesh.triangles().len(),
        known(step.mean_distance),
        known(step.greatest_distance),
        step.largest_move,
        step.topology.components(),
        step.topology.genus(),
        step.repaired_pairs
            .map_or_else(String::new, |pairs| pairs.to_string())
    )
}

/// Shows the stages before the surface moves, and stops where a snapshot was not written.
struct Observer<'a> {
    watch: &'a Watch,
    moving: AtomicBool,
    failed: AtomicBool,
}

impl Progress for Observer<'_> {
    fn step(&self, stage: &'static str, done: u64, total: u64) -> ControlFlow<()> {
        if self.failed.load(Relaxed) || interrupt::requested() {
            ControlFlow::Break(())
        } else if self.moving.load(Relaxed) {
            // The line of the last step stays.
            ControlFlow::Continue(())
        } else {
            self.watch.step(stage, done, total)
        }
    }
}
