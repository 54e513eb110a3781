//! `pellicle info`.

use crate::arguments::Global;
use crate::failure::Failure;
use crate::output;
use crate::progress::Watch;
use clap::Args;
use pellicle::geometry::{Aabb, PointCloud};
use pellicle::io::Data;
use pellicle::mesh::{TriangleSoup, self_intersections, summarize};
use pellicle::spatial::median_spacing;
use pellicle::transformesh::{Segment, intersection_segments};
use serde::Serialize;
use std::fmt::{self, Display};
use std::path::{Path, PathBuf};

const EXAMPLE: &str = "\
Example:
  pellicle info mesh.ply --json

Self-intersections are pairs of triangles that share more than the vertices and edges they have in common, counted
exactly. Two triangles meet in a segment or a point, two of one plane in the segments around their overlap.";

/// So many intersecting pairs at most are looked at one by one, since each takes memory.
const MOST_PAIRS: usize = 1_000_000;

/// Say what a file holds: points, or a mesh and its defects
#[derive(Debug, Args)]
#[command(after_help = EXAMPLE)]
pub struct Info {
    /// The mesh or the points
    #[arg(value_name = "IN")]
    input: PathBuf,
}

#[derive(Serialize)]
struct PointsInfo {
    file: PathBuf,
    kind: &'static str,
    format: String,
    points: usize,
    normals: bool,
    bounds: Option<Bounds>,
    diagonal: f64,
    /// The median distance from a point to its nearest neighbour.
    spacing: Option<f64>,
}

#[derive(Serialize)]
struct MeshInfo {
    file: PathBuf,
    kind: &'static str,
    format: String,
    vertices: usize,
    edges: usize,
    triangles: usize,
    bounds: Option<Bounds>,
    diagonal: f64,
    mean_edge: Option<f64>,
    closed: bool,
    edge_manifold: bool,
    vertex_manifold: bool,
    oriented: bool,
    components: usize,
    /// The sum over the components; none unless each is an orientable manifold.
    genus: Option<usize>,
    /// Closed chains of border edges.
    borders: usize,
    border_edges: usize,
    non_manifold_edges: usize,
    non_manifold_vertices: usize,
    inconsistent_edges: usize,
    isolated_vertices: usize,
    /// Triangles that name a vertex twice.
    unusable_triangles: usize,
    duplicate_triangles: usize,
    area: f64,
    /// None unless closed and oriented.
    volume: Option<f64>,
    /// Pairs of triangles.
    self_intersections: usize,
    /// Triangles in such pairs.
    intersecting_triangles: usize,
    /// Where they meet; none if the pairs are too many.
    intersections: Option<Intersections>,
}

/// Where triangles meet that have an area.
#[derive(Serialize)]
struct Intersections {
    segments: usize,
    /// Where they meet in one point only.
    points: usize,
    /// Around all of them.
    bounds: Option<Bounds>,
}

#[derive(Serialize)]
struct Bounds {
    min: [f64; 3],
    max: [f64; 3],
}

impl Info {
    /// Reads, measures, prints.
    pub fn run(self, global: &Global, watch: &Watch) -> Result<(), Failure> {
        let read = super::read(&self.input, watch)?;
        let format = read.report.format.to_string();
        match read.data {
            Data::Points(cloud) => {
                let info = PointsInfo::of(&self.input, format, &cloud);
                print(global, &info, info.lines())
            }
            Data::Mesh { soup, .. } => {
                let info = MeshInfo::of(&self.input, format, &soup, watch)?;
                print(global, &info, info.lines())
            }
        }
    }
}

fn print(global: &Global, info: &impl Serialize, lines: Lines) -> Result<(), Failure> {
    if global.json {
        output::print_json(info)
    } else {
        output::print(&lines.to_string())
    }
}

impl PointsInfo {
    fn of(file: &Path, format: String, cloud: &PointCloud) -> Self {
        let bounds = cloud.bounds();
        Self {
            file: file.to_owned(),
            kind: "points",
            format,
            points: cloud.len(),
            normals: cloud.normals().is_some(),
            bounds: Bounds::of(bounds),
            diagonal: bounds.diagonal(),
            spacing: median_spacing(cloud.positions()),
        }
    }

    fn lines(&self) -> Lines {
        let mut lines = Lines::new(&self.file, &self.format);
        lines.add("points", self.points);
        lines.add("normals", yes(self.normals));
        lines.add_bounds(self.bounds.as_ref(), self.diagonal);
        lines.add("spacing", or_none(self.spacing));
        lines
    }
}

impl MeshInfo {
    fn of(
        file: &Path,
        format: String,
        soup: &TriangleSoup,
        watch: &Watch,
    ) -> Result<Self, Failure> {
        let failed = |reason| Failure::Mesh {
            path: file.to_owned(),
            reason,
        };
        let summary = summarize(soup.into()).map_err(failed)?;
        let pairs = self_intersections(soup.into(), watch).map_err(failed)?;
        let mut concerned: Vec<_> = pairs.iter().flat_map(|&(t, u)| [t, u]).collect();
        concerned.sort_unstable();
        concerned.dedup();
        let intersections = match pairs.len() {
            0 => Some(Intersections::of(&[])),
            1..=MOST_PAIRS => {
                let segments = intersection_segments(soup.into(), watch);
                Some(Intersections::of(
                    &segments.map_err(super::repair_failure(file))?,
                ))
            }
            _ => None,
        };
        Ok(Self {
            file: file.to_owned(),
            kind: "mesh",
            format,
            vertices: summary.vertices,
            edges: summary.edges,
            triangles: summary.triangles,
            bounds: Bounds::of(summary.bounds),
            diagonal: summary.bounds.diagonal(),
            mean_edge: summary.shape.as_ref().map(|shape| shape.mean_edge),
            closed: summary.is_closed(),
            edge_manifold: summary.is_edge_manifold(),
            vertex_manifold: summary.is_vertex_manifold(),
            oriented: summary.is_oriented(),
            components: summary.components.len(),
            genus: summary.genus(),
            borders: summary.border_loops(),
            border_edges: summary.border_edges,
            non_manifold_edges: summary.non_manifold_edges,
            non_manifold_vertices: summary.non_manifold_vertices,
            inconsistent_edges: summary.inconsistent_edges,
            isolated_vertices: summary.isolated_vertices,
            unusable_triangles: summary.unusable_triangles,
            duplicate_triangles: summary.duplicate_triangles,
            area: summary.area,
            volume: summary.volume,
            self_intersections: pairs.len(),
            intersecting_triangles: concerned.len(),
            intersections,
        })
    }

    fn lines(&self) -> Lines {
        let mut lines = Lines::new(&self.file, &self.format);
        lines.add("vertices", self.vertices);
        lines.add("triangles", self.triangles);
        lines.add_bounds(self.bounds.as_ref(), self.diagonal);
        lines.add("mean edge", or_none(self.mean_edge));
        lines.add("closed", yes(self.closed));
        lines.add(
            "edge-manifold",
            with_count(self.edge_manifold, self.non_manifold_edges),
        );
        let vertices = with_count(self.vertex_manifold, self.non_manifold_vertices);
        lines.add("vertex-manifold", vertices);
        lines.add(
            "oriented",
            with_count(self.oriented, self.inconsistent_edges),
        );
        lines.add("components", self.components);
        lines.add("genus", or_none(self.genus));
        lines.add("borders", self.borders);
        lines.add("area", self.area);
        lines.add("volume", or_none(self.volume));
        lines.add("self-intersections", self.intersections());
        for (name, count) in [
            ("isolated vertices", self.isolated_vertices),
            ("unusable triangles", self.unusable_triangles),
            ("duplicate triangles", self.duplicate_triangles),
        ] {
            if count > 0 {
                lines.add(name, count);
            }
        }
        lines
    }
}

impl MeshInfo {
    /// Self-intersections in words.
    fn intersections(&self) -> String {
        let pairs = self.self_intersections;
        if pairs == 0 {
            return pairs.to_string();
        }
        let mut text = format!("{pairs} pairs of {} triangles", self.intersecting_triangles);
        if let Some(found) = &self.intersections {
            let (segments, points) = (found.segments, found.points);
            text += &match (segments, points) {
                (0, 0) => String::new(),
                (_, 0) => format!(", in {segments} segments"),
                (0, _) => format!(", in {points} points"),
                _ => format!(", in {segments} segments and {points} points"),
            };
        }
        text
    }
}

impl Intersections {
    fn of(segments: &[Segment]) -> Self {
        let points = segments.iter().filter(|s| s.ends[0] == s.ends[1]).count();
        let ends: Vec<_> = segments.iter().flat_map(|s| s.ends).collect();
        Self {
            segments: segments.len() - points,
            points,
            bounds: Bounds::of(Aabb::of_points(&ends)),
        }
    }
}

impl Bounds {
    fn of(bounds: Aabb) -> Option<Self> {
        (!bounds.is_empty()).then(|| Self {
            min: bounds.min.to_array(),
            max: bounds.max.to_array(),
        })
    }
}

/// Names and values in two columns.
struct Lines {
    text: String,
}

impl Lines {
    fn new(file: &Path, format: &str) -> Self {
        Self {
            text: format!("{} ({format})\n", file.display()),
        }
    }

    fn add(&mut self, name: &str, value: impl Display) {
        self.text.push_str(&format!("  {name:<20}{value}\n"));
    }

    fn add_bounds(&mut self, bounds: Option<&Bounds>, diagonal: f64) {
        if let Some(Bounds { min, max }) = bounds {
            self.add("least", format!("{} {} {}", min[0], min[1], min[2]));
            self.add("greatest", format!("{} {} {}", max[0], max[1], max[2]));
        }
        self.add("diagonal", diagonal);
    }
}

impl Display for Lines {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

fn yes(value: bool) -> &'static str {
    if value { "yes" } else { "no" }
}

/// `yes`, or `no` and how many places say so.
fn with_count(value: bool, count: usize) -> String {
    if value {
        yes(value).to_owned()
    } else {
        format!("no: {count}")
    }
}

fn or_none(value: Option<impl Display>) -> String {
    value.map_or_else(|| "none".to_owned(), |value| value.to_string())
}
