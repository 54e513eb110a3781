//! Points: of fixtures, and by formula from fixed seeds.
#![allow(dead_code)]

use pellicle_cocone::{Method, Options, Reconstruction, reconstruct};
use pellicle_delaunay::{Tetrahedralization, tetrahedralize};
use pellicle_geometry::DVec3;
use pellicle_mesh::{Summary, TriMesh, summarize};
use std::collections::HashMap;
use std::f64::consts::TAU;

pub const METHODS: [Method; 2] = [Method::Cocone, Method::TightCocone];

pub fn options(method: Method) -> Options {
    let mut options = Options::default();
    options.method = method;
    options
}

pub fn delaunay(points: &[DVec3]) -> Tetrahedralization<'_> {
    tetrahedralize(points, &Default::default()).expect("four points that are not coplanar")
}

pub fn run(points: &[DVec3], method: Method) -> Reconstruction {
    reconstruct(&delaunay(points), &options(method)).expect("nothing cancels, and ids suffice")
}

pub fn summary(mesh: &TriMesh) -> Summary {
    summarize(mesh.into()).expect("a mesh with finite positions")
}

fn path(name: &str) -> String {
    format!("{}/../../fixtures/{name}", env!("CARGO_MANIFEST_DIR"))
}

fn fixture(name: &str) -> String {
    let path = path(name);
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{path}: {error}"))
}

fn numbers(line: &str) -> Vec<f64> {
    line.split_whitespace()
        .map(|word| word.parse().expect("a number"))
        .collect()
}

/// The vertices of an OFF file.
pub fn off(name: &str) -> Vec<DVec3> {
    let text = fixture(name);
    let mut lines = text
        .lines()
        .map(|line| line.split('#').next().unwrap_or_default().trim())
        .filter(|line| !line.is_empty())
        .skip(1);
    let count = numbers(lines.next().expect("a line of counts"))[0] as usize;
    let points: Vec<DVec3> = lines
        .take(count)
        .map(|line| DVec3::from_slice(&numbers(line)))
        .collect();
    assert_eq!(points.len(), count, "{name}");
    points
}

/// Points and the normals in the file.
pub fn xyz(name: &str) -> (Vec<DVec3>, Vec<DVec3>) {
    let text = fixture(name);
    let rows = text.lines().map(numbers).filter(|row| !row.is_empty());
    rows.map(|row| (DVec3::from_slice(&row), DVec3::from_slice(&row[3..])))
        .unzip()
}

/// Points and normals of a little-endian PLY file whose vertices have six doubles and nothing else.
pub fn ply(name: &str) -> (Vec<DVec3>, Vec<DVec3>) {
    let bytes = std::fs::read(path(name)).expect("a fixture");
    let end = b"end_header\n";
    let start = bytes.windows(end.len()).position(|window| window == end);
    let start = start.expect("a header") + end.len();
    let header = String::from_utf8_lossy(&bytes[..start]);
    assert!(header.contains("binary_little_endian"), "{name}");
    assert_eq!(header.matches("property double").count(), 6, "{name}");
    let (values, _) = bytes[start..].as_chunks::<8>();
    let values: Vec<f64> = values.iter().map(|b| f64::from_le_bytes(*b)).collect();
    let rows = values.as_chunks::<6>().0.iter();
    rows.map(|row| (DVec3::from_slice(row), DVec3::from_slice(&row[3..])))
        .unzip()
}

/// SplitMix64 (Steele et al. 2014).
pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// In 0..1.
    pub fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub fn below(&mut self, n: usize) -> usize {
        (self.next() % n as u64) as usize
    }

    /// In the cube from −1 to 1.
    pub fn point(&mut self) -> DVec3 {
        DVec3::new(self.unit(), self.unit(), self.unit()) * 2.0 - 1.0
    }

    pub fn direction(&mut self) -> DVec3 {
        loop {
            let p = self.point();
            if (0.01..=1.0).contains(&p.length_squared()) {
                return p.normalize();
            }
        }
    }

    pub fn shuffle<T>(&mut self, items: &mut [T]) {
        for i in (1..items.len()).rev() {
            items.swap(i, self.below(i + 1));
        }
    }
}

/// Points on the unit sphere along a spiral.
pub fn sphere(count: usize) -> Vec<DVec3> {
    (0..count)
        .map(|i| {
            let z = 1.0 - (2.0 * i as f64 + 1.0) / count as f64;
            let (sin, cos) = (2.399_963 * i as f64).sin_cos();
            DVec3::new(cos, sin, 0.0) * (1.0 - z * z).sqrt() + DVec3::Z * z
        })
        .collect()
}

/// A random sample of {f = 0}, no two points nearer than `spacing`, and no place much farther than that
/// from all of them: points of the box from −`half` to `half` are moved to the surface, and kept if none is near.
pub fn implicit(f: impl Fn(DVec3) -> f64, half: DVec3, spacing: f64, seed: u64) -> Vec<DVec3> {
    let mut random = Random(seed);
    let mut kept: Vec<DVec3> = Vec::new();
    let mut grid: HashMap<[i64; 3], Vec<usize>> = HashMap::new();
    let mut refused = 0;
    while refused < 40 * kept.len() + 10_000 {
        let Some(p) = onto_surface(&f, random.point() * half) else {
            continue;
        };
        let cell = (p / spacing).floor().to_array().map(|x| x as i64);
        let near = (0..27).any(|k| {
            let cell = [
                cell[0] + k % 3 - 1,
                cell[1] + k / 3 % 3 - 1,
                cell[2] + k / 9 - 1,
            ];
            let points = grid.get(&cell).map_or(&[][..], Vec::as_slice);
            points.iter().any(|&q| kept[q].distance(p) < spacing)
        });
        if near {
            refused += 1;
        } else {
            grid.entry(cell).or_default().push(kept.len());
            kept.push(p);
        }
    }
    kept
}

/// By Newton's iteration along the gradient.
fn onto_surface(f: &impl Fn(DVec3) -> f64, mut p: DVec3) -> Option<DVec3> {
    for _ in 0..20 {
        let g = gradient(f, p);
        let step = g * (f(p) / g.length_squared());
        if !step.is_finite() || step.length() > 0.5 {
            return None;
        }
        p -= step;
    }
    (f(p).abs() < 1e-9).then_some(p)
}

pub fn gradient(f: &impl Fn(DVec3) -> f64, p: DVec3) -> DVec3 {
    let h = 1e-5;
    let along = |axis: DVec3| (f(p + axis * h) - f(p - axis * h)) / (2.0 * h);
    DVec3::new(along(DVec3::X), along(DVec3::Y), along(DVec3::Z))
}

/// The torus about z with radii 1 and 0.4; negative inside.
pub fn torus(p: DVec3) -> f64 {
    (p.truncate().length() - 1.0).hypot(p.z) - 0.4
}

/// The boundary of a thickened figure eight, of genus two; negative inside.
pub fn double_torus(p: DVec3) -> f64 {
    let x2 = p.x * p.x;
    let eight = p.y * p.y - x2 * (1.0 - x2);
    eight * eight + p.z * p.z - 0.15 * 0.15
}

/// Turns of a helix about z.
pub fn helix(count: usize, turns: f64) -> Vec<DVec3> {
    (0..count)
        .map(|i| {
            let t = i as f64 / count as f64;
            let (sin, cos) = (TAU * turns * t).sin_cos();
            DVec3::new(cos, sin, 2.0 * t)
        })
        .collect()
}
