//! `pellicle repair`.

use crate::arguments::{Global, Target};
use crate::failure::Failure;
use crate::interrupt;
use crate::output::{self, digits};
use crate::progress::Watch;
use crate::surface::Surface;
use clap::{Args, ValueEnum};
use pellicle::io::{self, Content, Note, write_text};
use pellicle::mesh::TriMesh;
use pellicle::transformesh::{self, Options, Report, repair_with};
use serde::Serialize;
use std::path::{Path, PathBuf};

const EXAMPLE: &str = "\
Examples:
  pellicle repair crossing.off -o clean.ply
  pellicle repair model.stl -o shell.ply --rule outside --report repair.json
  pellicle repair inside-out.obj -o turned.ply --rule nonzero

A place has winding number 1 where one closed mesh facing outwards encloses it, 2 where two overlap, -1 inside of one \
that faces inwards. A mesh that is in order comes back as it is. Vertices that stay do not move.

The report holds what is printed, and the triangle of IN that each triangle of OUT is a piece of, as \"sources\".";

/// Remove a mesh's self-intersections, exactly
///
/// Where the mesh crosses itself it is cut, and what bounds its outside is kept: overlaps merge, folds are cut off, parts
/// that are inside out vanish. The result is closed, an oriented manifold, and does not intersect itself.
#[derive(Debug, Args)]
#[command(after_help = EXAMPLE)]
pub struct Repair {
    /// The mesh: closed, or open with --rule outside; it need not be a manifold
    #[arg(value_name = "IN")]
    input: PathBuf,
    #[command(flatten)]
    target: Target,
    /// Which surface is kept
    #[arg(long, value_name = "RULE", default_value = "union")]
    rule: Rule,
    /// Write what was found and done into this file, as JSON
    #[arg(long, value_name = "FILE")]
    report: Option<PathBuf>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum, Serialize)]
#[serde(rename_all = "lowercase")]
enum Rule {
    /// What is reached from outside: as union, but sealed voids are filled. Open meshes keep their borders
    Outside,
    /// The border of where the winding number is at least 1: overlaps merge, voids stay
    Union,
    /// The border of where the winding number is not 0: parts that are inside out are turned
    Nonzero,
}

#[derive(Serialize)]
struct Done {
    input: PathBuf,
    output: PathBuf,
    rule: Rule,
    /// Whether the result is the input, number for number.
    unchanged: bool,
    /// Of triangles of the input that intersected.
    pairs: usize,
    /// Triangles that were cut.
    cut: usize,
    /// Triangles of the input without area, which were left out.
    degenerate: usize,
    /// Triangles of the input that were turned, so that neighbours agree.
    reoriented: usize,
    seeds: usize,
    /// Points at which the result has several vertices.
    singular_vertices: usize,
    /// Edges that were halved.
    singular_edges: usize,
    new_vertices: usize,
    /// New vertices whose exact place is no triple of doubles.
    rounded: usize,
    /// How often the work was done again, since rounding made new intersections.
    repeats: u32,
    /// Pairs that rounding made and that still intersect.
    remaining: usize,
    components_before: usize,
    /// None unless the input is a closed manifold.
    genus_before: Option<usize>,
    /// Signed, overlaps counted each time.
    volume_before: f64,
    /// Signed; the surface's `volume` is none unless it is closed.
    volume_after: f64,
    closed: bool,
    #[serde(flatten)]
    surface: Surface,
    bytes: u64,
}

/// What `--report` writes.
#[derive(Serialize)]
struct Record<'a> {
    #[serde(flatten)]
    done: &'a Done,
    /// For each triangle of the result the one of the input that it is a piece of.
    sources: Vec<u32>,
}

impl Repair {
    /// Reads a mesh, repairs it, writes it.
    pub fn run(self, global: &Global, watch: &Watch) -> Result<(), Failure> {
        self.target.check(Content::Mesh)?;
        self.target.check_further(self.report.as_deref())?;
        let read = io::read_mesh(&self.input, &super::read_options(watch))?;
        output::log_notes(&self.input, &read.report.notes);
        let options = Options {
            rule: self.rule.into(),
            ..Options::default()
        };
        let (mesh, report) = repair_with((&read.soup).into(), &options, watch, &mut ())
            .map_err(super::repair_failure(&self.input))?;
        let written = self.target.write_mesh(&mesh, watch)?;
        if written
            .notes
            .iter()
            .any(|n| matches!(n, Note::Rounded { .. }))
        {
            warn_of_rounding(&self.target.output);
        }
        let surface =
            Surface::of(&mesh, watch).map_err(super::mesh_failure(&self.target.output))?;
        let done = self.done(&mesh, &report, surface, written.bytes);
        if let Some(path) = &self.report {
            let sources = report.sources.iter().map(|t| t.0).collect();
            let record = Record {
                done: &done,
                sources,
            };
            let text = output::json(&record)?;
            let options = self.target.options(watch);
            interrupt::while_writing(|| write_text(path, &text, &options))?;
        }
        done.log();
        output::report(global, &done)
    }

    fn done(&self, mesh: &TriMesh, report: &Report, surface: Surface, bytes: u64) -> Done {
        Done {
            input: self.input.clone(),
            output: self.target.output.clone(),
            rule: self.rule,
            unchanged: report.unchanged,
            pairs: report.pairs,
            cut: report.cut,
            degenerate: report.degenerate,
            reoriented: report.reoriented,
            seeds: report.seeds,
            singular_vertices: report.singular_vertices,
            singular_edges: report.singular_edges,
            new_vertices: report.new_vertices,
            rounded: report.rounded,
            repeats: report.repeats,
            remaining: report.remaining,
            components_before: report.components[0],
            genus_before: report.genus[0],
            volume_before: report.volume[0],
            volume_after: report.volume[1],
            closed: mesh.is_closed(),
            surface,
            bytes,
        }
    }
}

impl Done {
    fn log(&self) {
        self.log_found();
        if self.unchanged {
            tracing::info!("nothing to repair: the mesh stays as it is");
        } else {
            self.log_done();
        }
        if self.surface.is_empty() {
            return tracing::warn!(
                "{}: nothing is left, and {}",
                self.output.display(),
                self.why_empty()
            );
        }
        if !self.closed {
            tracing::info!(
                "the mesh is open: by the rule outside, what is seen from outside is kept, with its borders"
            );
        }
        self.surface.log();
    }

    fn log_found(&self) {
        tracing::info!(
            "{} pairs of triangles intersect, {} triangles cut",
            self.pairs,
            self.cut
        );
        if self.degenerate > 0 {
            tracing::info!("{} triangles without area left out", self.degenerate);
        }
        if self.reoriented > 0 {
            tracing::info!(
                "{} triangles turned so that neighbours agree",
                self.reoriented
            );
        }
    }

    fn log_done(&self) {
        let genus =
            |genus: Option<usize>| genus.map_or_else(|| "none".to_owned(), |g| g.to_string());
        tracing::info!(
            "components {} -> {}, genus {} -> {}, volume {} -> {}",
            self.components_before,
            self.surface.components,
            genus(self.genus_before),
            genus(self.surface.genus),
            digits(self.volume_before),
            digits(self.volume_after)
        );
        tracing::info!(
            "{} new vertices, {} of them rounded",
            self.new_vertices,
            self.rounded
        );
        if self.singular_vertices + self.singular_edges > 0 {
            tracing::info!(
                "sheets that touch are apart: {} points with several vertices, {} edges halved",
                self.singular_vertices,
                self.singular_edges
            );
        }
        if self.repeats > 0 {
            tracing::info!(
                "rounding made new intersections: repaired {} times more",
                self.repeats
            );
        }
        if self.remaining > 0 {
            tracing::warn!(
                "rounding keeps {} pairs of triangles intersecting: move the mesh nearer to the origin, or repair again",
                self.remaining
            );
        }
    }

    fn why_empty(&self) -> &'static str {
        match self.rule {
            Rule::Nonzero => "an empty mesh is written: IN encloses nothing, or its parts cancel",
            _ => {
                "an empty mesh is written: IN encloses no place with winding number 1 or more; if it is inside out, \
                 --rule nonzero turns it"
            }
        }
    }
}

/// Where a file in single precision may not be what was repaired.
fn warn_of_rounding(path: &Path) {
    tracing::warn!(
        "{}: in single precision the surface may intersect itself again; PLY, OFF and OBJ keep it as it was repaired",
        path.display()
    );
}

impl From<Rule> for transformesh::Rule {
    fn from(rule: Rule) -> Self {
        match rule {
            Rule::Outside => Self::Outside,
            Rule::Union => Self::Union,
            Rule::Nonzero => Self::Nonzero,
        }
    }
}
