//! `pellicle evolve`.

use crate::arguments::{Global, Target, not_negative, number, positive};
use crate::failure::Failure;
use crate::progress::Watch;
use crate::snapshots::{Kept, Snapshots};
use crate::surface::Surface;
use crate::{interrupt, output};
use clap::{Args, ValueEnum};
use pellicle::evolution::{
    EdgeLength, Error, Evolved, Initial, Measures, Options, Outliers, Schedule, Stage, evolve_with,
};
use pellicle::geometry::{DVec3, Progress};
use pellicle::io::{Content, write_text};
use pellicle::mesh::{DistanceOptions, MeshView, TriMesh, distances};
use pellicle::{ADAPTING_GAP, evolve_adapting};
use serde::Serialize;
use std::num::NonZeroU64;
use std::ops::ControlFlow;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

const EXAMPLE: &str = "\
Examples:
  pellicle evolve scan.xyz -o surface.ply
  pellicle evolve noisy.ply -o surface.ply --diffusion 0.4 --smooth 10
  pellicle evolve several.ply -o surfaces.ply --topology adaptive
  pellicle evolve scan.xyz -o surface.ply --snapshots frames --every 5 --csv measures.csv

A voxel is the side of a cell of the grid that the distance to the points is known on: the longest side of the box \
around the points and the surface at the start, divided by --grid. Volume and area are in the units of the cloud.

An evolution that fails leaves no OUT, but its table, and its snapshots with the last good surface among them. Ctrl-C \
leaves the snapshots so far.";

/// Evolve a closed surface onto points, noisy or with gaps
///
/// A surface around the points shrinks onto them, and keeps well shaped triangles while it moves. The points may be
/// noisy or uneven, may have outliers, and may miss a part. The result is closed, of the same genus as the surface at the
/// start: a sphere's, unless --initial gives another, or --topology adaptive lets it part and open.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLE)]
pub struct Evolve {
    /// The points: any point or mesh format
    #[arg(value_name = "CLOUD")]
    input: PathBuf,
    #[command(flatten)]
    target: Target,
    /// Voxels along the longest side: more resolve finer shapes, and take more time and memory
    #[arg(
        long,
        value_name = "VOXELS",
        default_value_t = Options::default().resolution,
        value_parser = clap::value_parser!(u32).range(4..=1 << 20)
    )]
    grid: u32,
    /// The length of edges, in the units of the cloud; two voxels by default
    #[arg(long, value_name = "LENGTH", value_parser = positive, conflicts_with = "preset")]
    resolution: Option<f64>,
    /// Other stages than the adaptive ones, which go from coarse to fine until the surface rests
    #[arg(long, value_name = "NAME")]
    preset: Option<Preset>,
    /// How far distances are blurred (sigma), in voxels: at most 16. By default 1, or the points' noise if that is more
    #[arg(long, value_name = "VOXELS", value_parser = sigma)]
    sigma: Option<f64>,
    /// Diffusion relative to advection: more carries the surface past outliers and over gaps, and off thin limbs
    ///
    /// By default 0.1, or 1/3 in the paper's preset. The paper has 0.4 against outliers and missing parts.
    #[arg(long, value_name = "RATIO", value_parser = not_negative)]
    diffusion: Option<f64>,
    /// Let outliers count, instead of leaving out points that stand alone
    #[arg(long)]
    keep_outliers: bool,
    /// Steps of mean curvature flow at the end; they keep the volume. The paper's preset has 25 that do not
    #[arg(long, value_name = "STEPS")]
    smooth: Option<u32>,
    /// Start from this mesh, which must be closed, enclose the points and not intersect itself; else from an ellipsoid
    #[arg(long, value_name = "MESH")]
    initial: Option<PathBuf>,
    /// What happens where the surface would run into itself: it is held there, or cut open and parted
    #[arg(
        long,
        value_name = "RULE",
        default_value = "fixed",
        conflicts_with = "preset"
    )]
    topology: Topology,
    /// With --topology adaptive: openings wider than this are opened, in voxels
    #[arg(long, value_name = "VOXELS", default_value_t = ADAPTING_GAP, value_parser = positive)]
    gap: f64,
    /// Write numbered meshes into this folder, an animation evolution.glb, and pictures side by side, evolution.png
    #[arg(long, value_name = "DIR")]
    snapshots: Option<PathBuf>,
    /// Steps from one snapshot to the next
    #[arg(
        long,
        value_name = "STEPS",
        default_value = "10",
        requires = "snapshots"
    )]
    every: NonZeroU64,
    /// Write the measures of every step as a table
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Preset {
    /// The stages of figures 6 to 10 of Daniel 2015: 95 steps with 2,562 vertices, 25 of smoothing; sigma is 1, and
    /// outliers count
    Paper,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
enum Topology {
    /// The surface keeps the components and the genus of the surface at the start
    #[default]
    Fixed,
    /// One surface around several objects becomes several, and holes open
    Adaptive,
}

#[derive(Serialize)]
struct Done {
    input: PathBuf,
    output: PathBuf,
    points: usize,
    points_left_out: usize,
    #[serde(flatten)]
    surface: Surface,
    /// The side of a voxel, in the units of the cloud.
    voxel: f64,
    /// In voxels.
    sigma: f64,
    /// The points' estimated noise.
    noise: f64,
    steps: u64,
    /// Vertices that were held, since the surface would have run into itself there.
    held: usize,
    /// None where a number of steps was asked for, not rest.
    at_rest: Option<bool>,
    /// Of all points from the surface, outliers included.
    mean_distance: f64,
    mean_distance_voxels: f64,
    greatest_distance: f64,
    snapshots: Option<Kept>,
    csv: Option<PathBuf>,
    bytes: u64,
}

impl Evolve {
    /// As without any option.
    pub fn with_defaults(input: PathBuf, target: Target) -> Self {
        Self {
            input,
            target,
            grid: Options::default().resolution,
            resolution: None,
            preset: None,
            sigma: None,
            diffusion: None,
            keep_outliers: false,
            smooth: None,
            initial: None,
            topology: Topology::Fixed,
            gap: ADAPTING_GAP,
            snapshots: None,
            every: NonZeroU64::MIN,
            csv: None,
        }
    }

    /// Reads points, evolves, writes.
    pub fn run(self, global: &Global, watch: &Watch) -> Result<(), Failure> {
        self.target.check(Content::Mesh)?;
        self.target.check_further(self.csv.as_deref())?;
        let folder = self.snapshots.as_deref();
        let snapshots = folder
            .map(|folder| {
                Snapshots::new(
                    folder,
                    "evolution",
                    self.every.get(),
                    self.target.force,
                    watch,
                )
            })
            .transpose()?;
        let cloud = super::read_points(&self.input, watch)?;
        let options = self.options(watch)?;

        let mut record = Record::new(snapshots, self.csv.is_some(), watch);
        let gap = (self.topology == Topology::Adaptive).then_some(self.gap);
        let evolved = match record.evolve(cloud.positions(), &options, gap) {
            Ok(evolved) => evolved,
            Err(Ended::Record(failure)) => return Err(failure),
            Err(Ended::Evolution(reason)) => {
                let failure = self.explain(reason);
                if record.steps > 0 && !failure.is_interruption() {
                    self.keep(record, None)?;
                }
                return Err(failure);
            }
        };
        let mesh = &evolved.mesh;
        let written = self.target.write_mesh(mesh, watch)?;
        let snapshots = self.keep(record, Some(mesh))?;

        let done = self.done(cloud.positions(), &evolved, snapshots, written.bytes, watch)?;
        done.log();
        output::report(global, &done)
    }

    /// Writes the table, and puts the snapshots together, of which the result, or else the last good surface, is the last.
    fn keep(&self, record: Record, result: Option<&TriMesh>) -> Result<Option<Kept>, Failure> {
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

    fn options(&self, watch: &Watch) -> Result<Options, Failure> {
        let mut options = Options {
            resolution: self.grid,
            sigma: self.sigma,
            smoothing: self.smooth.unwrap_or(0),
            ..Options::default()
        };
        if let Some(path) = &self.initial {
            options.initial = Initial::Mesh(super::read_manifold(path, watch)?);
        }
        if self.keep_outliers {
            options.outliers = Outliers::Keep;
        }
        if let Some(Preset::Paper) = self.preset {
            let diffusion = self.diffusion.map_or(100.0, |ratio| 300.0 * ratio);
            options.sigma = self.sigma.or(Some(1.0));
            options.outliers = Outliers::Keep;
            options.smoothing = 0;
            options.schedule = Schedule::Stages {
                levels: 4,
                stages: Stage::paper(95, diffusion, self.smooth.unwrap_or(25), 450.0),
            };
        } else if let Schedule::Adaptive {
            edge_length,
            diffusion,
        } = &mut options.schedule
        {
            *diffusion = self.diffusion.unwrap_or(*diffusion);
            *edge_length = self.resolution.map_or(*edge_length, EdgeLength::Absolute);
        }
        Ok(options)
    }

    /// Names the file that is the reason of a failure.
    fn explain(&self, reason: Error) -> Failure {
        let path = match (&reason, &self.initial) {
            (
                Error::NotClosed { .. }
                | Error::InitialIntersectsItself { .. }
                | Error::NotEnclosed { .. },
                Some(initial),
            ) => initial,
            _ => &self.input,
        };
        Failure::Evolution {
            path: path.clone(),
            reason,
        }
    }

    fn done(
        self,
        points: &[DVec3],
        evolved: &Evolved,
        snapshots: Option<Kept>,
        bytes: u64,
        watch: &Watch,
    ) -> Result<Done, Failure> {
        let (mesh, report) = (&evolved.mesh, &evolved.report);
        let failed = super::mesh_failure(&self.target.output);
        let cloud = MeshView {
            positions: points,
            triangles: &[],
        };
        let distances =
            distances(cloud, mesh.into(), &DistanceOptions::default(), watch).map_err(&failed)?;
        Ok(Done {
            points: points.len(),
            points_left_out: report.outliers,
            surface: Surface::of(mesh, watch).map_err(&failed)?,
            voxel: report.spacing,
            sigma: report.sigma,
            noise: report.noise,
            steps: report.steps,
            held: report.held,
            at_rest: self.preset.is_none().then_some(report.at_rest),
            mean_distance: distances.mean,
            mean_distance_voxels: distances.mean / report.spacing,
            greatest_distance: distances.max,
            snapshots,
            csv: self.csv,
            input: self.input,
            output: self.target.output,
            bytes,
        })
    }
}

fn sigma(text: &str) -> Result<f64, String> {
    number(
        text,
        |value| (0.0..=16.0).contains(&value),
        "must be from 0 to 16 voxels",
    )
}

impl Done {
    fn log(&self) {
        tracing::info!(
            "{} points, {} left out as outliers; a voxel is {}, sigma is {:.2} voxels",
            self.points,
            self.points_left_out,
            output::digits(self.voxel),
            self.sigma
        );
        self.surface.log();
        tracing::info!(
            "{} steps{}; the mean distance of all points from the surface is {} ({:.3} voxels)",
            self.steps,
            if self.at_rest == Some(true) {
                ", and at rest"
            } else {
                ""
            },
            output::digits(self.mean_distance),
            self.mean_distance_voxels
        );
        if self.held > 0 {
            tracing::warn!(
                "{} vertices were held where the surface would have run into itself: parts of the object nearly touch \
                 there, or it has a hole, which --topology adaptive opens",
                self.held
            );
        }
        if self.at_rest == Some(false) {
            tracing::warn!(
                "the surface is still moving: its steps ran out before it came to rest; see the largest move in a \
                 table of --csv"
            );
        }
    }
}

/// What is kept of an evolution while it runs.
struct Record<'a> {
    watch: &'a Watch,
    snapshots: Option<Snapshots<'a>>,
    wants_table: bool,
    table: String,
    steps: u64,
    /// The surface after the last step, where there are snapshots.
    last: Option<(u64, TriMesh)>,
    failure: Option<Failure>,
}

/// Why an evolution ended early.
enum Ended {
    /// A snapshot was not written.
    Record(Failure),
    /// The evolution itself.
    Evolution(Error),
}

impl<'a> Record<'a> {
    fn new(snapshots: Option<Snapshots<'a>>, wants_table: bool, watch: &'a Watch) -> Self {
        Self {
            watch,
            snapshots,
            wants_table,
            table: format!("{}\n", Measures::CSV_HEADER),
            steps: 0,
            last: None,
            failure: None,
        }
    }

    /// With a gap, its topology adapts.
    fn evolve(
        &mut self,
        points: &[DVec3],
        options: &Options,
        gap: Option<f64>,
    ) -> Result<Evolved, Ended> {
        let observer = Observer {
            watch: self.watch,
            moving: AtomicBool::new(false),
            failed: AtomicBool::new(false),
        };
        let each_step = &mut |measures: &Measures, mesh: &TriMesh| {
            observer.moving.store(true, Relaxed);
            observer
                .failed
                .fetch_or(!self.step(measures, mesh), Relaxed);
        };
        let evolved = match gap {
            None => evolve_with(points, options, &observer, each_step),
            Some(gap) => evolve_adapting(points, options, gap, &observer, each_step),
        };
        match self.failure.take() {
            Some(failure) => Err(Ended::Record(failure)),
            None => evolved.map_err(Ended::Evolution),
        }
    }

    /// Whether all went well.
    fn step(&mut self, measures: &Measures, mesh: &TriMesh) -> bool {
        self.watch.tell(|| {
            format!(
                "evolve: stage {}, step {}, move {:.4} voxels, volume {:.6e}",
                measures.stage + 1,
                measures.step,
                measures.largest_move / measures.spacing,
                measures.volume
            )
        });
        self.steps = measures.step;
        if self.wants_table {
            self.table.push_str(&measures.to_csv());
            self.table.push('\n');
        }
        if let (Some(snapshots), None) = (&mut self.snapshots, &self.failure) {
            self.failure = snapshots.step(measures.step, mesh).err();
            self.last = Some((measures.step, mesh.clone()));
        }
        self.failure.is_none()
    }
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
