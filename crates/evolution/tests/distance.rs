//! The distance grid against brute force, closed forms and finite differences.

use glam::{DVec3, UVec3};
use pellicle_evolution::{DistanceGrid, DistanceOptions, Storage};

fn options(resolution: u32, sigma: f64) -> DistanceOptions {
    DistanceOptions {
        resolution,
        sigma,
        storage: Storage::Dense,
        ..Default::default()
    }
}

fn build(points: &[DVec3], options: &DistanceOptions) -> DistanceGrid {
    DistanceGrid::new(points, options, &()).unwrap()
}

fn voxels(grid: &DistanceGrid) -> impl Iterator<Item = UVec3> + use<> {
    let n = grid.dims();
    (0..n.z)
        .flat_map(move |z| (0..n.y).flat_map(move |y| (0..n.x).map(move |x| UVec3::new(x, y, z))))
}

fn brute_force(points: &[DVec3], x: DVec3) -> f64 {
    let squares = points.iter().map(|&p| (x - p).length_squared());
    squares.fold(f64::INFINITY, f64::min).sqrt()
}

/// How far unregularised values lie above the exact distances at the centres, in voxels: the largest excess and the
/// share of voxels with one. Panics where a value lies below by more than the rounding.
fn excess(points: &[DVec3], grid: &DistanceGrid) -> (f64, f64) {
    let (mut most, mut count, mut all) = (0.0_f64, 0.0, 0.0);
    for voxel in voxels(grid) {
        let center = grid.center(voxel);
        let exact = brute_force(points, center) / grid.spacing();
        let value = grid.sample(center).value / grid.spacing();
        let rounding = 1e-6 * exact + 1e-6;
        assert!(value >= exact - rounding, "{voxel}: {value} below {exact}");
        all += 1.0;
        if value > exact + rounding {
            count += 1.0;
            most = most.max(value - exact);
        }
    }
    (most, count / all)
}

/// A reproducible sequence of numbers in 0 .. 1 (Steele et al. 2014).
struct Random(u64);

impl Random {
    fn number(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn point(&mut self) -> DVec3 {
        DVec3::new(self.number(), self.number(), self.number())
    }

    fn on_sphere(&mut self) -> DVec3 {
        loop {
            let p = 2.0 * self.point() - 1.0;
            if (0.01..1.0).contains(&p.length_squared()) {
                return p.normalize();
            }
        }
    }
}

#[test]
fn sweeping_is_nearly_exact_for_many_kinds_of_clouds() {
    let mut random = Random(1);
    let mut clouds: Vec<(&str, Vec<DVec3>)> = Vec::new();
    for n in [2, 3, 5, 10, 30, 100, 1000] {
        clouds.push(("volume", (0..n).map(|_| random.point()).collect()));
        clouds.push(("sphere", (0..n).map(|_| random.on_sphere()).collect()));
        clouds.push((
            "plane",
            (0..n)
                .map(|_| random.point() * DVec3::new(1.0, 1.0, 0.0))
                .collect(),
        ));
        clouds.push((
            "line",
            (0..n)
                .map(|_| random.number() * DVec3::new(1.0, 0.7, 0.3))
                .collect(),
        ));
    }
    for (kind, points) in clouds {
        let grid = build(&points, &options(40, 0.0));
        let (most, share) = excess(&points, &grid);
        println!(
            "{kind:8} {:5} points: {most:.2e} voxels, {share:.2e}",
            points.len()
        );
    }
}
