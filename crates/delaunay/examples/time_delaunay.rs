//! Times the tetrahedralisation of a seeded input: `time_delaunay uniform 1000000 [--dump FILE]`.
//!
//! Prints seconds, points and finite tetrahedra. `--points FILE` writes the coordinates as little-endian
//! doubles, for other programs to read; `--dump FILE` writes the set of tetrahedra as sorted `u32` ids.

use pellicle_delaunay::{Options, tetrahedralize};
use pellicle_geometry::DVec3;
use std::{env, error::Error, fs, time::Instant};

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let option = |name: &str| {
        let place = arguments.iter().position(|argument| argument == name)?;
        arguments.get(place + 1)
    };
    let (kind, count) = match &arguments[..] {
        [kind, count, ..] => (kind.as_str(), count.parse()?),
        _ => return Err("usage: time_delaunay uniform|sphere|torus|grid|rounded COUNT".into()),
    };
    let points = input(kind, count).ok_or("unknown input")?;
    if let Some(file) = option("--points") {
        let bytes: Vec<u8> = points
            .iter()
            .flat_map(|p| p.to_array())
            .flat_map(f64::to_le_bytes)
            .collect();
        fs::write(file, bytes)?;
    }

    let start = Instant::now();
    let tetrahedralization = tetrahedralize(&points, &Options::default())?;
    let seconds = start.elapsed().as_secs_f64();
    println!(
        "{seconds:.3} {} {}",
        points.len(),
        tetrahedralization.finite_count()
    );

    if let Some(file) = option("--dump") {
        let mut tets: Vec<[u32; 4]> = tetrahedralization
            .finite_tets()
            .iter()
            .map(|tet| {
                let mut corners = tet.map(|v| v.0);
                corners.sort_unstable();
                corners
            })
            .collect();
        tets.sort_unstable();
        let bytes: Vec<u8> = tets
            .iter()
            .flatten()
            .flat_map(|corner| corner.to_le_bytes())
            .collect();
        fs::write(file, bytes)?;
    }
    Ok(())
}

/// The inputs that published timings use, from a fixed seed.
fn input(kind: &str, count: usize) -> Option<Vec<DVec3>> {
    let mut random = SplitMix(12345 + count as u64);
    let points = match kind {
        "uniform" => (0..count)
            .map(|_| DVec3::new(random.unit(), random.unit(), random.unit()))
            .collect(),
        "sphere" => (0..count)
            .map(|_| {
                let d = random.direction();
                let bump = (5.0 * d.x).sin() * (5.0 * d.y).sin() * (5.0 * d.z).sin();
                d * (1.0 + 0.1 * bump)
            })
            .collect(),
        "torus" => (0..count).map(|_| random.on_torus()).collect(),
        "grid" => {
            let side = (count as f64).cbrt().round() as usize;
            let mut grid: Vec<DVec3> = (0..side.pow(3))
                .map(|i| {
                    DVec3::new(
                        (i % side) as f64,
                        (i / side % side) as f64,
                        (i / side / side) as f64,
                    )
                })
                .collect();
            for i in (1..grid.len()).rev() {
                grid.swap(i, (random.next() % (i as u64 + 1)) as usize);
            }
            grid
        }
        "rounded" => (0..count)
            .map(|_| (random.direction() * 10_000.0).round())
            .collect(),
        _ => return None,
    };
    Some(points)
}

/// The SplitMix64 generator.
struct SplitMix(u64);

impl SplitMix {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1u64 << 53) as f64
    }

    fn direction(&mut self) -> DVec3 {
        loop {
            let p = DVec3::new(self.unit(), self.unit(), self.unit()) * 2.0 - 1.0;
            let square = p.length_squared();
            if (1e-6..=1.0).contains(&square) {
                return p / square.sqrt();
            }
        }
    }

    /// R = 1, r = 0.4, uniform in area.
    fn on_torus(&mut self) -> DVec3 {
        loop {
            let (u, v) = (
                self.unit() * std::f64::consts::TAU,
                self.unit() * std::f64::consts::TAU,
            );
            let ring = 1.0 + 0.4 * v.cos();
            if self.unit() * 1.4 <= ring {
                return DVec3::new(ring * u.cos(), ring * u.sin(), 0.4 * v.sin());
            }
        }
    }
}
