//! The inputs that published timings use, from fixed seeds.

use super::random::SplitMix;
use pellicle_geometry::DVec3;

/// What [`input`] can make.
pub const KINDS: [&str; 6] = ["uniform", "sphere", "torus", "grid", "rounded", "weighted"];

/// `count` points of a kind, the same in every run; `None` for a kind that is not in [`KINDS`].
///
/// * `uniform`: in the unit cube;
/// * `sphere`: on a bumpy sphere, r = 1 + sin 5x sin 5y sin 5z / 10 over uniform directions;
/// * `torus`: R = 1, r = 0.4, uniform in area;
/// * `grid`: the integer points of a cube, shuffled; the cube nearest to `count`;
/// * `rounded`: on a sphere of radius 1000, rounded to integers, so that many are cospherical and some equal;
/// * `weighted`: in the unit cube, with [`weights`].
pub fn input(kind: &str, count: usize) -> Option<Vec<DVec3>> {
    let mut random = SplitMix(12345 + count as u64);
    let points = match kind {
        "uniform" | "weighted" => (0..count).map(|_| random.in_cube()).collect(),
        "sphere" => (0..count)
            .map(|_| {
                let d = random.direction();
                let bump = (5.0 * d.x).sin() * (5.0 * d.y).sin() * (5.0 * d.z).sin();
                d * (1.0 + 0.1 * bump)
            })
            .collect(),
        "torus" => (0..count).map(|_| on_torus(&mut random)).collect(),
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
            random.shuffle(&mut grid);
            grid
        }
        "rounded" => (0..count)
            .map(|_| (random.direction() * 1000.0).round())
            .collect(),
        _ => return None,
    };
    Some(points)
}

/// The weights of `count` points of a kind, for a kind that has them: the squares of radii, up to the edge of the cube that
/// each point would have to itself. About eight points in a hundred are hidden.
pub fn weights(kind: &str, count: usize) -> Option<Vec<f64>> {
    if kind != "weighted" {
        return None;
    }
    let mut random = SplitMix(54321 + count as u64);
    let edge = (count as f64).cbrt().recip();
    let mut weight = || (random.unit() * edge).powi(2);
    Some((0..count).map(|_| weight()).collect())
}

/// Uniform in area.
fn on_torus(random: &mut SplitMix) -> DVec3 {
    loop {
        let u = random.unit() * std::f64::consts::TAU;
        let v = random.unit() * std::f64::consts::TAU;
        let ring = 1.0 + 0.4 * v.cos();
        if random.unit() * 1.4 <= ring {
            return DVec3::new(ring * u.cos(), ring * u.sin(), 0.4 * v.sin());
        }
    }
}
