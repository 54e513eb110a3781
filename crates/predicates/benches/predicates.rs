//! Nanoseconds a call, on easy and on degenerate input: `cargo bench -p pellicle-predicates`.
//!
//! `robust` runs beside, for comparison. Each figure is the least of several rounds over the same calls.

use glam::DVec3;
use pellicle_predicates::{
    Sign, StaticFilter,
    implicit::{Lattice, Plane, Point},
    insphere, lifted, orient3d,
};
use std::{hint::black_box, time::Instant};

const CALLS: usize = 20_000;
const ROUNDS: usize = 15;

/// SplitMix64: the same points in every run.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Uniform in [0, 1), a multiple of 2⁻⁵³.
    fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn below(&mut self, n: u64) -> u64 {
        self.next() % n
    }

    fn in_cube(&mut self) -> DVec3 {
        DVec3::new(self.unit(), self.unit(), self.unit())
    }

    fn on_sphere(&mut self) -> DVec3 {
        (self.in_cube() - 0.5).normalize_or(DVec3::X)
    }
}

type Call = [DVec3; 5];

/// Five corners of a unit cell of the 100³ grid, the first four not coplanar.
fn grid_cell(random: &mut Random) -> Call {
    let corner = [0; 3].map(|_| random.below(100) as f64);
    loop {
        let call: Call = std::array::from_fn(|_| {
            let bits = random.below(8);
            DVec3::from_array(corner)
                + DVec3::new(
                    (bits & 1) as f64,
                    (bits >> 1 & 1) as f64,
                    (bits >> 2) as f64,
                )
        });
        let [a, b, c, d, _] = call;
        if orient3d(a, b, c, d) != Sign::Zero {
            return call;
        }
    }
}

/// The least time of a call, in nanoseconds.
fn time<C, R>(calls: &[C], mut predicate: impl FnMut(&C) -> R) -> f64 {
    let mut least = f64::INFINITY;
    for _ in 0..ROUNDS {
        let start = Instant::now();
        for call in calls {
            black_box(predicate(black_box(call)));
        }
        least = least.min(start.elapsed().as_secs_f64() * 1e9 / calls.len() as f64);
    }
    least
}

fn robust_insphere(&[a, b, c, d, e]: &Call) -> Sign {
    let p = |v: DVec3| robust::Coord3D {
        x: v.x,
        y: v.y,
        z: v.z,
    };
    -Sign::of(robust::insphere(p(a), p(b), p(c), p(d), p(e)))
}

fn robust_orient3d(&[a, b, c, d, _]: &Call) -> Sign {
    let p = |v: DVec3| robust::Coord3D {
        x: v.x,
        y: v.y,
        z: v.z,
    };
    -Sign::of(robust::orient3d(p(a), p(b), p(c), p(d)))
}

fn main() {
    let random = &mut Random(1);
    let mut inputs: Vec<(&str, Vec<Call>)> = Vec::new();
    let mut add = |name, mut make: Box<dyn FnMut() -> Call + '_>| {
        inputs.push((name, (0..CALLS).map(|_| make()).collect()));
    };
    add(
        "uniform in a cube",
        Box::new(|| [0; 5].map(|_| random.in_cube())),
    );
    add("cells of an integer grid", Box::new(|| grid_cell(random)));
    add(
        "the same × 0.1",
        Box::new(|| grid_cell(random).map(|p| p * 0.1)),
    );
    add(
        "unit sphere, rounded",
        Box::new(|| [0; 5].map(|_| random.on_sphere())),
    );
    add(
        "sphere of radius 1e4, integers",
        Box::new(|| [0; 5].map(|_| (random.on_sphere() * 1e4).round())),
    );
    println!("| insphere, ns a call | static | semi-static | perturbed | `robust` |");
    println!("|---|---|---|---|---|");
    for (name, calls) in &inputs {
        let points = || calls.iter().flatten().copied();
        let min = points().fold(DVec3::INFINITY, DVec3::min);
        let max = points().fold(DVec3::NEG_INFINITY, DVec3::max);
        let filter = StaticFilter::from_bounds(min, max);
        println!(
            "| {name} | {:.0} | {:.0} | {:.0} | {:.0} |",
            time(calls, |&[a, b, c, d, e]| filter.insphere(a, b, c, d, e)),
            time(calls, |&[a, b, c, d, e]| insphere(a, b, c, d, e)),
            time(calls, |&[a, b, c, d, e]| lifted::insphere(a, b, c, d, e)),
            time(calls, robust_insphere),
        );
    }
    println!("\n| orient3d, ns a call | static | semi-static | `robust` |");
    println!("|---|---|---|---|");
    for (name, calls) in &inputs {
        let points = || calls.iter().flatten().copied();
        let min = points().fold(DVec3::INFINITY, DVec3::min);
        let max = points().fold(DVec3::NEG_INFINITY, DVec3::max);
        let filter = StaticFilter::from_bounds(min, max);
        println!(
            "| {name} | {:.0} | {:.0} | {:.0} |",
            time(calls, |&[a, b, c, d, _]| filter.orient3d(a, b, c, d)),
            time(calls, |&[a, b, c, d, _]| orient3d(a, b, c, d)),
            time(calls, robust_orient3d),
        );
    }
    println!(
        "\n| implicit points, ns a call | plane | line and plane | three planes | centroid | compare | orient2d, filtered | orient2d, exact | side | side, exact |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|");
    for (name, calls) in &inputs {
        implicit(name, calls);
    }
    // Coordinates of about 110 bits.
    let random = &mut Random(2);
    let mut wide = || {
        DVec3::from_array([0; 3].map(|_| random.unit() * 2_f64.powi(-(random.below(56) as i32))))
    };
    let calls: Vec<Call> = (0..CALLS).map(|_| [0; 5].map(|_| wide())).collect();
    implicit("of sizes from 2⁻⁵⁶ to 1", &calls);
}

/// A row of timings: each point is made from the corners of a few calls.
fn implicit(name: &str, calls: &[Call]) {
    let calls = &calls[..CALLS / 10];
    let lattice = Lattice::of(calls.iter().flatten().copied());
    let planes: Vec<[Plane; 3]> = calls
        .iter()
        .map(|&[a, b, c, d, e]| {
            [[a, b, c], [b, d, e], [c, e, a]].map(|[p, q, r]| lattice.plane(p, q, r))
        })
        .collect();
    let meet = |[f, g, h]: &[Plane; 3]| lattice.three_planes(f, g, h);
    let points: Vec<Point> = planes
        .windows(3)
        .filter_map(|w| meet(&[w[0][0].clone(), w[1][1].clone(), w[2][2].clone()]))
        .collect();
    let triples: Vec<[Point; 3]> = points
        .windows(3)
        .map(|w| [0, 1, 2].map(|i| w[i].clone()))
        .collect();
    // A point three times: collinear beyond what a filter can see.
    let alike: Vec<[Point; 3]> = (points.iter().filter(|p| !p.is_exact()))
        .map(|p| [0; 3].map(|_| p.clone()))
        .collect();
    let lines: Vec<_> = calls
        .windows(2)
        .zip(&planes)
        .map(|(w, f)| (w[1][0], w[1][3], f[0].clone()))
        .collect();
    let mixed: Vec<[Plane; 3]> = (planes.windows(3))
        .map(|w| [w[0][0].clone(), w[1][1].clone(), w[2][2].clone()])
        .collect();
    let on: Vec<(Plane, Option<Point>)> = lines
        .iter()
        .map(|(p, q, f)| (f.clone(), lattice.line_plane(*p, *q, f)))
        .collect();
    let side = |(f, p): &(Plane, Option<Point>)| p.as_ref().map(|p| lattice.side(f, p));
    println!(
        "| {name} | {:.0} | {:.0} | {:.0} | {:.0} | {:.1} | {:.0} | {:.0} | {:.0} | {:.0} |",
        time(calls, |&[a, b, c, ..]| lattice.plane(a, b, c)),
        time(&lines, |(p, q, f)| lattice.line_plane(*p, *q, f)),
        time(&mixed, meet),
        time(&triples, |[a, b, c]| lattice.centroid([a, b, c])),
        time(&triples, |[a, b, _]| lattice.compare(a, b, 0)),
        time(&triples, |[a, b, c]| lattice.orient2d(0, a, b, c)),
        time(&alike, |[a, b, c]| lattice.orient2d(0, a, b, c)),
        time(&triples[..triples.len().min(planes.len())], |[a, ..]| {
            lattice.side(&planes[0][0], a)
        }),
        time(&on, side),
    );
}
