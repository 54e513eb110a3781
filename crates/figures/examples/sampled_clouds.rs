//! Samples meshes whose topology is known, reconstructs the samples, and compares: five meshes, seven ways to
//! sample each, one row of a Markdown table a cloud.
//!
//! `cargo run --release -p pellicle-figures --example sampled_clouds -- [tight-cocone|cocone] [SEED]`; by default Tight
//! Cocone and seed 1. The same seed gives the same clouds.

use pellicle::geometry::Aabb;
use pellicle::mesh::{DistanceOptions, Summary, compare, count_self_intersections, summarize};
use pellicle::prelude::*;
use pellicle_figures::{AreaSampler, Random, clouds};
use std::collections::HashMap;
use std::time::Instant;

type Result<T> = std::result::Result<T, Box<dyn std::error::Error>>;

/// The meshes, and how many points to take from each (see [`AreaSampler::scatter`]).
const MESHES: [(&str, usize); 5] = [
    ("fandisk.off", 12_000),
    ("tm_featuretype.stl", 16_000),
    ("couplingdown.off", 20_000),
    ("anchor_dense.off", 14_000),
    ("elephant.off", 16_000),
];

const RECIPES: [(&str, Recipe); 7] = [
    ("even", Recipe::Even),
    ("uniform", Recipe::Uniform),
    ("varying", Recipe::Varying),
    ("noise 0.1 %", Recipe::Noise(0.001)),
    ("noise 0.5 %", Recipe::Noise(0.005)),
    ("outliers", Recipe::Outliers),
    ("missing patch", Recipe::MissingPatch),
];

/// How points are taken from a surface. All but `Uniform` keep a distance from each other.
#[derive(Clone, Copy)]
enum Recipe {
    /// The same distance everywhere.
    Even,
    /// Independent of each other, uniform over the area: gaps and clumps.
    Uniform,
    /// The distance grows from 35 % beside the first vertex to 100 % at 0.5 diagonals from it.
    Varying,
    /// Even, then each coordinate moved by a normal error of this share of the diagonal.
    Noise(f64),
    /// Even, and 1 % more points anywhere in the bounding box and a tenth of it beyond each side.
    Outliers,
    /// Even, without the points within 4 % of the diagonal from one of them.
    MissingPatch,
}

fn main() -> Result<()> {
    let (options, seed) = arguments()?;
    println!(
        "| cloud | points | components/genus | truth | closed | self-intersections | mean distance, % of the \
         diagonal | dropped | seconds |\n|---|---:|---:|---:|---|---:|---:|---:|---:|"
    );
    let mut rows = Vec::new();
    for (mesh, &(file, count)) in MESHES.iter().enumerate() {
        let truth = Truth::read(file)?;
        for (recipe, &(name, how)) in RECIPES.iter().enumerate() {
            let stream = (mesh * RECIPES.len() + recipe) as u64;
            let points = truth.sample(how, count, &mut Random::new(seed, stream));
            let row = Row::measure(&points, &truth, &options)?;
            println!("| {file}, {name} | {} | {row} |", points.len());
            rows.push(row);
        }
    }
    let count = |holds: fn(&Row) -> bool| rows.iter().filter(|row| holds(row)).count();
    let logarithms: f64 = rows.iter().map(|row| row.distance.ln()).sum();
    println!(
        "\nRight topology {} of {n}; geometric mean distance {:.4} %; closed {} of {n}; {} self-intersections.",
        count(|row| row.right),
        (logarithms / rows.len() as f64).exp(),
        count(|row| row.found.is_closed()),
        rows.iter().map(|row| row.self_intersections).sum::<u64>(),
        n = rows.len(),
    );
    Ok(())
}

/// The method and the seed.
fn arguments() -> Result<(cocone::Options, u64)> {
    let mut arguments = std::env::args().skip(1);
    let mut options = cocone::Options::default();
    options.method = match arguments.next().as_deref() {
        None | Some("tight-cocone") => cocone::Method::TightCocone,
        Some("cocone") => cocone::Method::Cocone,
        Some(other) => return Err(format!("no method `{other}`: tight-cocone or cocone").into()),
    };
    let seed = arguments.next().map_or(Ok(1), |seed| seed.parse())?;
    Ok((options, seed))
}

/// What came of one cloud.
struct Row {
    found: Summary,
    /// Components and genus of the mesh that was sampled.
    truth: (usize, usize),
    /// Whether the result is a closed oriented manifold with the true components and genus.
    right: bool,
    self_intersections: u64,
    /// The mean of the mean distances either way, in percent of the true mesh's diagonal.
    distance: f64,
    dropped: usize,
    /// Wall time of the tetrahedralisation and the reconstruction.
    seconds: f64,
}

impl Row {
    fn measure(points: &[DVec3], truth: &Truth, options: &cocone::Options) -> Result<Self> {
        let start = Instant::now();
        let tetrahedra = tetrahedralize(points, &delaunay::Options::default())?;
        let surface = reconstruct(&tetrahedra, options)?;
        let seconds = start.elapsed().as_secs_f64();

        let mesh = MeshView::from(&surface.mesh);
        let found = summarize(mesh)?;
        let far = compare(mesh, (&truth.soup).into(), &DistanceOptions::default(), &())?;
        // A genus is had by edge-manifolds alone.
        let sound = found.is_closed() && found.is_oriented() && found.is_vertex_manifold();
        Ok(Self {
            truth: truth.topology,
            right: sound && topology(&found) == Some(truth.topology),
            self_intersections: count_self_intersections(mesh, &())?,
            distance: 50.0 * (far.forward.mean + far.backward.mean) / truth.diagonal,
            dropped: surface.report.dropped.len(),
            seconds,
            found,
        })
    }
}

impl std::fmt::Display for Row {
    /// The cells from the topology on; wrong topology is in bold.
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        let (components, genus) = self.truth;
        let found = self.found.genus().map_or("–".into(), |g| g.to_string());
        let found = format!("{}/{found}", self.found.components.len());
        let bold = if self.right { "" } else { "**" };
        let closed = if self.found.is_closed() { "yes" } else { "no" };
        write!(
            f,
            "{bold}{found}{bold} | {components}/{genus} | {closed} | "
        )?;
        write!(f, "{} | {:.4} | ", self.self_intersections, self.distance)?;
        write!(f, "{} | {:.2}", self.dropped, self.seconds)
    }
}

/// Components and the sum of their genera.
fn topology(summary: &Summary) -> Option<(usize, usize)> {
    Some((summary.components.len(), summary.genus()?))
}

/// A mesh to sample.
struct Truth {
    soup: TriangleSoup,
    diagonal: f64,
    topology: (usize, usize),
}

impl Truth {
    /// A fixture; an error unless it is closed, after vertices that nearly coincide are one if need be.
    fn read(file: &str) -> Result<Self> {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures");
        let mut soup = read_mesh(format!("{folder}/{file}"), &ReadOptions::default())?.soup;
        let diagonal = Aabb::of_points(&soup.positions).extent().length();
        if !summarize((&soup).into())?.is_closed() {
            merge(&mut soup, 1e-5 * diagonal);
        }
        let summary = summarize((&soup).into())?;
        let topology = topology(&summary)
            .filter(|_| summary.is_closed())
            .ok_or_else(|| format!("{file} is no closed manifold"))?;
        Ok(Self {
            soup,
            diagonal,
            topology,
        })
    }

    fn sample(&self, recipe: Recipe, count: usize, random: &mut Random) -> Vec<DVec3> {
        let sampler = AreaSampler::new((&self.soup).into());
        let mut points = match recipe {
            Recipe::Uniform => (0..count).map(|_| sampler.point(random)).collect(),
            Recipe::Varying => sampler.scatter(count, random, 0.35),
            _ => sampler.scatter(count, random, 1.0),
        };
        match recipe {
            Recipe::Even | Recipe::Uniform | Recipe::Varying => {}
            Recipe::Noise(share) => clouds::displace(&mut points, share * self.diagonal, random),
            Recipe::Outliers => {
                let region = Aabb::of_points(&self.soup.positions);
                let count = points.len() / 100;
                points.extend((0..count).map(|_| clouds::around(region, random)));
            }
            Recipe::MissingPatch => {
                let center = points[points.len() / 3];
                points = clouds::without_patch(&points, center, 0.04 * self.diagonal);
            }
        }
        points
    }
}

/// Makes one vertex of those that round to the same multiples of `spacing`.
fn merge(soup: &mut TriangleSoup, spacing: f64) {
    let mut first: HashMap<[i64; 3], VertexId> = HashMap::new();
    for corner in soup.triangles.as_flattened_mut() {
        let p = soup.positions[corner.index()] / spacing;
        let cell = p.round().to_array().map(|x| x as i64);
        *corner = *first.entry(cell).or_insert(*corner);
    }
}
