//! Evolves surfaces onto clouds whose truth is known, and onto scans, and measures what comes out: one line of JSON an
//! experiment. `cargo xtask bench --evolution` runs all of them and writes `docs/benchmarks/evolution.md`.
//!
//! `cargo run --release -p pellicle-figures --example evolution_table -- COMMAND`, where a command is one of
//!
//! - `list`: the names of the experiments, SHAPE/CLOUD/SCHEDULE;
//! - `cloud EXPERIMENT FILE`: writes the experiment's points;
//! - `evolve EXPERIMENT`: evolves a surface onto them and measures it;
//! - `time EXPERIMENT`: the same, without measures: seconds of all, and of that before the first step;
//! - `measure EXPERIMENT MESH…`: measures meshes that other programs made of the same points.

use pellicle::evolution::{
    EdgeLength, Evolved, Options, Outliers, Schedule, Stage, evolve, evolve_with,
};
use pellicle::mesh::{AngleBounds, DistanceOptions, compare, count_self_intersections, distances};
use pellicle::mesh::{quality, summarize};
use pellicle::prelude::*;
use pellicle_figures::{Shape, clouds, shapes};
use std::time::Instant;

type Result<T> = std::result::Result<T, Box<dyn std::error::Error>>;

const SHAPES: [&str; 4] = ["ellipsoid", "vase", "body", "bust"];
const DEFECTS: [&str; 5] = ["clean", "noise", "outliers", "patch", "uneven"];
const VESICLES: [&str; 2] = ["left vesicle", "right vesicle"];
const SCANS: [&str; 4] = [
    "kitten.xyz",
    "sphere_20k.xyz",
    "oni.pwn",
    "pcl_ism_train_cat.pcd",
];

fn main() -> Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match words[..] {
        ["list"] => experiments().iter().for_each(|name| println!("{name}")),
        ["cloud", name, file] => {
            let cloud = PointCloud::new(Experiment::new(name)?.points)?;
            let options = WriteOptions {
                overwrite: pellicle::io::Overwrite::Replace,
                ..WriteOptions::default()
            };
            write_points(file, &cloud, &options)?;
        }
        ["evolve", name] => {
            let experiment = Experiment::new(name)?;
            let options = experiment.options()?;
            let start = Instant::now();
            let outcome = evolve(&experiment.points, &options);
            let seconds = start.elapsed().as_secs_f64();
            match outcome {
                Ok(evolved) => println!("{}", experiment.describe(&evolved, seconds)?),
                Err(error) => {
                    let error = error.to_string().replace(['"', '\\'], "'");
                    println!(r#"{{"experiment": "{name}", "error": "{error}"}}"#);
                }
            }
        }
        ["time", name] => {
            let experiment = Experiment::new(name)?;
            let options = experiment.options()?;
            let mut steps_took = 0.0;
            let start = Instant::now();
            let evolved = evolve_with(&experiment.points, &options, &(), &mut |measures, _| {
                steps_took = measures.seconds;
            })?;
            let seconds = start.elapsed().as_secs_f64();
            println!(
                r#"{{"experiment": "{name}", "steps": {}, "vertices": {}, "seconds": {seconds}, "before": {}}}"#,
                evolved.report.steps,
                evolved.mesh.positions().len(),
                seconds - steps_took,
            );
        }
        ["measure", name, ref files @ ..] => {
            let experiment = Experiment::new(name)?;
            for file in files {
                let soup = read_mesh(file, &ReadOptions::default())?.soup;
                let measures = experiment.measures((&soup).into())?;
                println!(r#"{{"experiment": "{name}"{measures}}}"#);
            }
        }
        _ => {
            return Err(
                "list, cloud EXPERIMENT FILE, evolve EXPERIMENT, time EXPERIMENT, measure EXPERIMENT MESH…".into(),
            );
        }
    }
    Ok(())
}

/// Every experiment.
fn experiments() -> Vec<String> {
    let mut names = Vec::new();
    for shape in SHAPES {
        names.extend(DEFECTS.map(|defect| format!("{shape}/{defect}/adaptive")));
    }
    names.extend(VESICLES.map(|vesicle| format!("{vesicle}/sparse/adaptive")));
    for shape in ["ellipsoid", "body"] {
        names.extend(DEFECTS.map(|defect| format!("{shape}/{defect}/paper")));
    }
    names.extend(["paper", "adaptive"].map(|schedule| format!("bust/fine/{schedule}")));
    names.extend(SCANS.map(|scan| format!("{scan}/scan/adaptive")));
    names
}

/// A cloud, and the shape that it was taken from, if that is known.
struct Experiment {
    name: String,
    points: Vec<DVec3>,
    truth: Option<Shape>,
}

impl Experiment {
    /// The experiment SHAPE/CLOUD/SCHEDULE.
    fn new(name: &str) -> Result<Self> {
        let (shape, cloud, _) = parts(name)?;
        let truth = match shape {
            "ellipsoid" => Some(shapes::ellipsoid()),
            "vase" => Some(shapes::vase()),
            "body" => Some(shapes::body()),
            "bust" => Some(shapes::bust()),
            vesicle if VESICLES.contains(&vesicle) => shapes::vesicles()
                .into_iter()
                .find(|shape| shape.name == vesicle),
            _ => None,
        };
        let points = match &truth {
            Some(shape) => sample(shape, cloud)?,
            None => {
                let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures");
                let scan = read_points(format!("{folder}/{shape}"), &ReadOptions::default())?;
                scan.cloud.positions().to_vec()
            }
        };
        Ok(Self {
            name: name.to_owned(),
            points,
            truth,
        })
    }

    /// How the surface evolves.
    fn options(&self) -> Result<Options> {
        let (_, cloud, schedule) = parts(&self.name)?;
        let mut options = Options::default();
        if cloud == "fine" {
            options.resolution = 300;
        }
        match schedule {
            "adaptive" if cloud == "fine" => {
                options.schedule = Schedule::Adaptive {
                    edge_length: EdgeLength::Voxels(FINE_EDGE_LENGTH),
                    diffusion: 0.1,
                };
            }
            "adaptive" => {}
            "paper" => {
                let (levels, stages) = match cloud {
                    "fine" => (2, Stage::paper_coarse_to_fine()),
                    "outliers" | "patch" => (4, Stage::paper(100, 120.0, 30, 500.0)),
                    _ => (4, Stage::paper(100, 100.0, 30, 450.0)),
                };
                options.schedule = Schedule::Stages { levels, stages };
                options.outliers = Outliers::Keep;
                options.sigma = Some(1.0);
            }
            other => return Err(format!("no schedule `{other}`").into()),
        }
        Ok(options)
    }

    /// The line of an evolution.
    fn describe(&self, evolved: &Evolved, seconds: f64) -> Result<String> {
        let report = &evolved.report;
        let measures = self.measures((&evolved.mesh).into())?;
        Ok(format!(
            r#"{{"experiment": "{}", "steps": {}, "at_rest": {}, "seconds": {seconds}, "voxel": {}, "sigma": {}, "noise": {}, "outliers": {}{measures}}}"#,
            self.name,
            report.steps,
            report.at_rest,
            report.spacing,
            report.sigma,
            report.noise,
            report.outliers,
        ))
    }

    /// The measures of a mesh, as the rest of a JSON object. Lengths in the units of the points, angles in degrees.
    fn measures(&self, mesh: MeshView) -> Result<String> {
        let summary = summarize(mesh)?;
        let manifold = summary.is_edge_manifold() && summary.is_vertex_manifold();
        let closed = manifold && summary.is_oriented() && summary.is_closed();
        let genus = summary.genus().map_or("null".into(), |g| g.to_string());
        // Some programs' triangles are clockwise.
        let volume = summary.volume.map(f64::abs);
        let bounds = AngleBounds {
            small: 20.0_f64.to_radians(),
            large: 140.0_f64.to_radians(),
        };
        let shape = quality(mesh, &bounds).ok_or("no triangles")?;
        let (folded, greatest_turn) = turns(mesh);
        let mut text = format!(
            r#", "points": {}, "vertices": {}, "triangles": {}, "closed_manifold": {closed}, "components": {}, "genus": {genus}, "least_angle": {}, "greatest_angle": {}, "small_angles": {}, "large_angles": {}, "folded": {folded}, "greatest_turn": {greatest_turn}, "self_intersections": {}, "diagonal": {}"#,
            self.points.len(),
            summary.vertices - summary.isolated_vertices,
            summary.triangles,
            summary.components.len(),
            shape.min_angle.to_degrees(),
            shape.max_angle.to_degrees(),
            shape.small_angles,
            shape.large_angles,
            count_self_intersections(mesh, &())?,
            self.diagonal(),
        );
        let options = DistanceOptions::default();
        text += &match &self.truth {
            Some(shape) => {
                let far = compare((&shape.truth).into(), mesh, &options, &())?;
                format!(
                    r#", "volume_ratio": {}, "truth_to_mesh": {}, "mesh_to_truth": {}, "hausdorff": {}"#,
                    volume.map_or("null".into(), |v| (v / shape.volume).to_string()),
                    far.forward.mean,
                    far.backward.mean,
                    far.hausdorff(),
                )
            }
            None => {
                let far = distances(view(&self.points), mesh, &options, &())?;
                format!(
                    r#", "points_to_mesh": {}, "farthest_point": {}"#,
                    far.mean, far.max
                )
            }
        };
        Ok(text)
    }

    /// The diagonal of the truth, or of the points.
    fn diagonal(&self) -> f64 {
        self.truth.as_ref().map_or_else(
            || pellicle::geometry::Aabb::of_points(&self.points).diagonal(),
            Shape::diagonal,
        )
    }
}

/// In voxels of the bust's 300³ grid: gives about 41,000 vertices.
const FINE_EDGE_LENGTH: f64 = 1.35;

/// SHAPE, CLOUD and SCHEDULE.
fn parts(name: &str) -> Result<(&str, &str, &str)> {
    let parts: Vec<&str> = name.split('/').collect();
    match parts[..] {
        [shape, cloud, schedule] => Ok((shape, cloud, schedule)),
        _ => Err(format!("{name}: SHAPE/CLOUD/SCHEDULE is wanted").into()),
    }
}

/// A cloud of a shape.
fn sample(shape: &Shape, cloud: &str) -> Result<Vec<DVec3>> {
    const COUNT: usize = 20_000;
    let plain = || shape.sample(COUNT, 1);
    Ok(match cloud {
        "clean" => plain(),
        "noise" => clouds::with_noise(&plain(), 0.01, 1),
        "outliers" => clouds::with_outliers(&plain(), 0.01, 1),
        "patch" => {
            let positions = shape.truth.positions().iter();
            let center = positions.max_by(|p, q| p.x.total_cmp(&q.x));
            let center = *center.ok_or("a shape without vertices")?;
            clouds::without_patch(&plain(), center, 0.12 * shape.diagonal())
        }
        "uneven" => clouds::unevenly(shape, COUNT, 30.0, 1),
        "fine" => shape.sample(3 * COUNT, 1),
        "sparse" => clouds::with_outliers(&shape.sample(600, 1), 0.01, 1),
        other => return Err(format!("no cloud `{other}`").into()),
    })
}

/// How many triangles are folded: the surface turns by more than 120° between them and a neighbour. And the greatest
/// turn across an edge, in degrees.
fn turns(mesh: MeshView) -> (usize, f64) {
    const FOLD: f64 = -0.5;
    let normal = |triangle: &[VertexId; 3]| {
        let [a, b, c] = triangle.map(|v| mesh.positions[v.index()]);
        (b - a).cross(c - a).normalize_or_zero()
    };
    let normals: Vec<DVec3> = mesh.triangles.iter().map(normal).collect();
    let mut sides = Vec::new();
    for (t, triangle) in mesh.triangles.iter().enumerate() {
        for i in 0..3 {
            let (u, v) = (triangle[i].index(), triangle[(i + 1) % 3].index());
            sides.push((u.min(v), u.max(v), t));
        }
    }
    sides.sort_unstable();
    let mut folded = vec![false; normals.len()];
    let mut least = 1.0_f64;
    for pair in sides.windows(2) {
        let (first, second) = (pair[0], pair[1]);
        if (first.0, first.1) == (second.0, second.1) {
            let cosine = normals[first.2].dot(normals[second.2]);
            least = least.min(cosine);
            if cosine < FOLD {
                folded[first.2] = true;
                folded[second.2] = true;
            }
        }
    }
    let count = folded.iter().filter(|&&folded| folded).count();
    (count, least.clamp(-1.0, 1.0).acos().to_degrees())
}

fn view(positions: &[DVec3]) -> MeshView<'_> {
    MeshView {
        positions,
        triangles: &[],
    }
}
