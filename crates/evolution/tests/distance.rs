//! The distance grid against brute force, closed forms and finite differences.

use glam::{DVec3, UVec3};
use pellicle_evolution::{DistanceGrid, DistanceOptions, Error, Sample, Storage};
use pellicle_geometry::{Aabb, Progress};
use proptest::prelude::*;
use std::f64::consts::PI;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};

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

/// How far unregularised values lie above the exact distances at the centres, in voxels.
#[derive(Debug, Default)]
struct Excess {
    /// The most, anywhere.
    most: f64,
    /// The most where the distance is at most `EXACT`.
    near: f64,
    /// The share of the voxels that have any.
    share: f64,
}

/// Panics where a value lies below the exact one by more than the rounding.
fn excess(points: &[DVec3], grid: &DistanceGrid) -> Excess {
    let mut excess = Excess::default();
    let mut all = 0.0;
    for voxel in voxels(grid) {
        let center = grid.center(voxel);
        let exact = brute_force(points, center) / grid.spacing();
        let value = grid.sample(center).value / grid.spacing();
        let rounding = 1e-6 * exact + 1e-6;
        assert!(value >= exact - rounding, "{voxel}: {value} below {exact}");
        all += 1.0;
        if value > exact + rounding {
            excess.share += 1.0;
            excess.most = excess.most.max(value - exact);
            if exact <= EXACT {
                excess.near = excess.near.max(value - exact);
            }
        }
    }
    excess.share /= all;
    excess
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

/// Clouds of many kinds, with their names.
fn clouds() -> Vec<(&'static str, Vec<DVec3>)> {
    let mut random = Random(1);
    let mut clouds: Vec<(&str, Vec<DVec3>)> = Vec::new();
    for n in [2, 3, 5, 10, 30, 100, 1000] {
        let mut make = |scale: DVec3| (0..n).map(|_| random.point() * scale).collect();
        clouds.push(("volume", make(DVec3::ONE)));
        clouds.push(("plane", make(DVec3::new(1.0, 1.0, 0.0))));
        clouds.push(("edge", make(DVec3::X)));
        clouds.push(("sphere", (0..n).map(|_| random.on_sphere()).collect()));
        clouds.push((
            "line",
            (0..n)
                .map(|_| random.number() * DVec3::new(1.0, 0.7, 0.3))
                .collect(),
        ));
    }
    let lattice: Vec<DVec3> = (0..125)
        .map(|i| DVec3::new((i % 5).into(), (i / 5 % 5).into(), (i / 25).into()))
        .collect();
    clouds.push(("lattice", lattice.clone()));
    clouds.push(("duplicates", [lattice.clone(), lattice].concat()));
    clouds
}

/// Before the sweeps, closest sites are exact this far from the points, in voxels.
const EXACT: f64 = 3.5;

/// Sweeping loses the sites whose cells are narrower than a voxel. The most seen over these clouds and the random ones
/// below is 0.29 voxels; no value is too small, and none near the points is wrong.
const MOST_EXCESS: f64 = 0.4;

fn check_against_brute_force(name: &str, points: &[DVec3], grid: &DistanceGrid) {
    let excess = excess(points, grid);
    assert!(excess.near == 0.0, "{name}: {excess:?}");
    assert!(excess.most < MOST_EXCESS, "{name}: {excess:?}");
    println!("{name:10} {:5} points: {excess:?}", points.len());
}

#[test]
fn unregularised_values_are_the_distances_of_many_kinds_of_clouds() {
    for (name, points) in clouds() {
        check_against_brute_force(name, &points, &build(&points, &options(40, 0.0)));
    }
}

#[test]
fn points_may_lie_on_the_faces_of_the_box_or_outside() {
    let mut random = Random(2);
    for (name, points) in clouds() {
        let tight = DistanceOptions {
            margin: 0.0,
            ..options(25, 0.0)
        };
        check_against_brute_force(name, &points, &build(&points, &tight));
    }
    let points: Vec<DVec3> = (0..300).map(|_| random.on_sphere()).collect();
    for (low, high) in [(-0.5, 0.5), (0.0, 2.0), (-0.1, 0.7), (3.0, 4.0)] {
        let bounds = Some(Aabb {
            min: DVec3::splat(low),
            max: DVec3::splat(high),
        });
        let cut = DistanceOptions {
            bounds,
            ..options(30, 0.0)
        };
        let excess = excess(&points, &build(&points, &cut));
        assert!(excess.most < MOST_EXCESS, "{low} {high}: {excess:?}");
    }
}

#[test]
fn one_point_is_enough_when_the_box_is_given() {
    for point in [
        DVec3::ZERO,
        DVec3::new(0.3, -0.2, 0.9),
        DVec3::new(5.0, 0.0, 0.0),
    ] {
        let bounds = Aabb {
            min: DVec3::splat(-1.0),
            max: DVec3::splat(1.0),
        };
        let grid = build(
            &[point],
            &DistanceOptions {
                bounds: Some(bounds),
                ..options(20, 0.0)
            },
        );
        assert_eq!(grid.dims(), UVec3::splat(20));
        assert_eq!(grid.bounds(), bounds);
        assert_eq!(excess(&[point], &grid).most, 0.0);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    #[test]
    fn unregularised_values_are_the_distances(
        points in prop::collection::vec((0.0..1.0, 0.0..1.0, 0.0..1.0), 2..80),
        flat in 0..3_u32,
        snap in any::<bool>(),
    ) {
        let shape = [DVec3::ONE, DVec3::new(1.0, 0.6, 0.05), DVec3::new(1.0, 1.0, 0.0)][flat as usize];
        let points: Vec<DVec3> = points.into_iter().map(|(x, y, z)| {
            let p = DVec3::new(x, y, z) * shape;
            if snap { (p * 8.0).round() / 8.0 } else { p }
        }).collect();
        prop_assume!(Aabb::of_points(&points).diagonal() > 0.0);
        check_against_brute_force("random", &points, &build(&points, &options(24, 0.0)));
    }

    /// The interpolated central difference is the central difference of the interpolated values.
    #[test]
    fn the_gradient_is_the_central_difference(
        points in prop::collection::vec((0.0..1.0, 0.0..1.0, 0.0..1.0), 2..40),
        queries in prop::collection::vec((0.0..1.0, 0.0..1.0, 0.0..1.0), 20),
    ) {
        let points: Vec<DVec3> = points.into_iter().map(DVec3::from).collect();
        for sigma in [0.0, 1.0] {
            let grid = build(&points, &options(24, sigma));
            let h = grid.spacing();
            let bounds = grid.bounds();
            for &query in &queries {
                let inner = bounds.extent() - 3.0 * h;
                let at = bounds.min + 1.5 * h + DVec3::from(query) * inner;
                let difference = DVec3::from([DVec3::X, DVec3::Y, DVec3::Z].map(|axis| {
                    let side = |sign: f64| grid.sample(at + sign * h * axis).value;
                    (side(1.0) - side(-1.0)) / (2.0 * h)
                }));
                let gradient = grid.sample(at).gradient;
                prop_assert!((gradient - difference).length() < 1e-9, "{gradient} {difference}");
            }
        }
    }
}

/// The error function by Simpson's rule.
fn erf(x: f64) -> f64 {
    if x > 6.0 {
        return 1.0;
    }
    let n = 200;
    let f = |i: i32| (-(x * f64::from(i) / f64::from(n)).powi(2)).exp();
    let sum: f64 = (0..=n)
        .map(|i| {
            f(i) * if i == 0 || i == n {
                1.0
            } else {
                f64::from(2 + 2 * (i % 2))
            }
        })
        .sum();
    2.0 / PI.sqrt() * sum * x / (3.0 * f64::from(n))
}

/// G_σ ∗ |x| in three dimensions at a distance r from the origin, and its derivative by r.
fn smoothed_cone(r: f64, sigma: f64) -> (f64, f64) {
    let bell = (2.0 / PI).sqrt() * (-0.5 * (r / sigma).powi(2)).exp();
    let erf = erf(r / (2.0_f64.sqrt() * sigma));
    let value = sigma * bell + (r + sigma * sigma / r) * erf;
    let slope = (1.0 - (sigma / r).powi(2)) * erf + bell * sigma / r;
    (value, slope)
}

#[test]
fn one_regularised_point_is_the_smoothed_cone() {
    for (resolution, sigma) in [(41, 1.0), (41, 1.5), (61, 3.0), (80, 1.0)] {
        let bounds = Some(Aabb {
            min: DVec3::splat(-1.0),
            max: DVec3::splat(1.0),
        });
        let grid = build(
            &[DVec3::ZERO],
            &DistanceOptions {
                bounds,
                ..options(resolution, sigma)
            },
        );
        let h = grid.spacing();
        let (mut tip, mut worst, mut slope_error) = (0.0_f64, 0.0_f64, 0.0_f64);
        for voxel in voxels(&grid) {
            let center = grid.center(voxel);
            let r = center.length() / h;
            let sample = grid.sample(center);
            let (value, slope) = smoothed_cone(r.max(1e-6), sigma);
            let error = (sample.value / h - value).abs();
            // Values at the centres miss the tip of the cone: by the lattice sum of its spectrum 8 π / k⁴, damped by
            // nothing but the distance from the tip, about 0.02 voxels.
            if r < 4.0 * sigma {
                tip = tip.max(error);
            } else {
                worst = worst.max(error);
                // Differences over two voxels miss a sixth of the third derivative on each axis, which is below 3 / r².
                let inside = voxel.cmpgt(UVec3::ZERO) & voxel.cmplt(grid.dims() - 1);
                if inside.all() {
                    let along = sample.gradient.dot(center / center.length());
                    slope_error = slope_error.max((along - slope).abs() * r * r);
                }
            }
        }
        println!("sigma {sigma}: {tip:.1e}, {worst:.1e} voxels, slope {slope_error:.1e} / r²");
        assert!(tip < 0.02, "sigma {sigma}: {tip}");
        assert!(worst < 2e-3 * sigma, "sigma {sigma}: {worst}");
        assert!(slope_error < 0.75, "sigma {sigma}: {slope_error}");
    }
}

#[test]
fn the_gradient_is_a_unit_vector_away_from_points_and_medial_axis() {
    let mut random = Random(3);
    let points: Vec<DVec3> = (0..20_000).map(|_| random.on_sphere()).collect();
    for storage in [Storage::Dense, Storage::Sparse] {
        let options = DistanceOptions {
            storage,
            ..options(150, 1.0)
        };
        let grid = build(&points, &options);
        let mut worst = 0.0_f64;
        for _ in 0..2000 {
            let direction = random.on_sphere();
            let radius = 0.5 + 0.85 * random.number();
            let outside = (radius - 1.0_f64) / grid.spacing();
            // Nearer, gaps between the points show: they are up to five voxels wide.
            if outside.abs() < 8.0 {
                continue;
            }
            let gradient = grid.sample(radius * direction).gradient;
            let along = gradient.dot(direction) * outside.signum();
            // Going over to the coarse grid costs accuracy where its cells reach the points.
            let tolerance = match storage {
                Storage::Sparse => 0.1,
                _ => 0.03,
            };
            worst = worst.max((gradient.length() - 1.0).abs());
            assert!(
                along > 1.0 - tolerance && gradient.length() < 1.0 + tolerance,
                "{storage:?} {radius}: {gradient}"
            );
        }
        println!("{storage:?}: lengths of the gradient off by at most {worst:.3}");
    }
}

/// Bits of samples all over the grid and beyond.
fn bits(grid: &DistanceGrid) -> Vec<[u64; 4]> {
    let mut random = Random(4);
    let bounds = grid.bounds();
    (0..20_000)
        .map(|_| {
            let sample = grid.sample(bounds.min + (1.2 * random.point() - 0.1) * bounds.extent());
            let g = sample.gradient;
            [sample.value, g.x, g.y, g.z].map(f64::to_bits)
        })
        .collect()
}

#[test]
fn the_field_depends_on_the_set_of_points_alone() {
    for storage in [Storage::Dense, Storage::Sparse] {
        let options = DistanceOptions {
            storage,
            ..options(70, 1.0)
        };
        let mut clouds = clouds();
        clouds.retain(|cloud| cloud.1.len() <= 200);
        for (name, mut points) in clouds {
            let expected = bits(&build(&points, &options));
            points.reverse();
            let middle = points.len() / 2;
            points.rotate_left(middle);
            points.push(points[0]);
            assert!(
                bits(&build(&points, &options)) == expected,
                "{name} {storage:?}"
            );
        }
    }
}

/// Every voxel has eight points, as far from its centre as each other, and most of them are lost in sweeping.
#[test]
fn ties_do_not_show_the_order_of_the_points() {
    let cube = |i: u32| DVec3::new((i % 20).into(), (i / 20 % 20).into(), (i / 400).into());
    let mut points: Vec<DVec3> = (0..1200).map(cube).collect();
    let bounds = Some(Aabb {
        min: DVec3::splat(-0.5),
        max: DVec3::splat(59.5),
    });
    let options = DistanceOptions {
        bounds,
        ..options(30, 0.0)
    };
    let expected = bits(&build(&points, &options));
    points.reverse();
    assert!(bits(&build(&points, &options)) == expected);
    points.sort_by(|a, b| (a.z - 2.0 * a.x).total_cmp(&(b.z - 2.0 * b.x)));
    assert!(bits(&build(&points, &options)) == expected);
}

#[test]
fn the_field_is_the_same_on_any_number_of_threads() {
    let mut random = Random(5);
    let points: Vec<DVec3> = (0..3000)
        .map(|_| random.on_sphere() * DVec3::new(1.0, 0.8, 0.6))
        .collect();
    let bounds = Some(Aabb {
        min: DVec3::splat(-0.9),
        max: DVec3::splat(1.5),
    });
    for storage in [Storage::Dense, Storage::Sparse] {
        let options = DistanceOptions {
            storage,
            bounds,
            ..options(90, 1.0)
        };
        let on = |threads| {
            let pool = rayon::ThreadPoolBuilder::new()
                .num_threads(threads)
                .build()
                .unwrap();
            bits(&pool.install(|| build(&points, &options)))
        };
        let one = on(1);
        assert!(one == on(2) && one == on(3), "{storage:?}");
    }
}

#[test]
fn powers_of_two_scale_exactly() {
    let mut random = Random(6);
    let points: Vec<DVec3> = (0..100).map(|_| random.point()).collect();
    for storage in [Storage::Dense, Storage::Sparse] {
        let options = DistanceOptions {
            storage,
            ..options(50, 1.0)
        };
        let grid = build(&points, &options);
        for exponent in [-100, -3, 100] {
            let scale = 2.0_f64.powi(exponent);
            let scaled: Vec<DVec3> = points.iter().map(|&p| p * scale).collect();
            let scaled = build(&scaled, &options);
            for _ in 0..1000 {
                let at = 2.0 * random.point() - 0.5;
                let (a, b) = (grid.sample(at), scaled.sample(at * scale));
                assert_eq!(
                    (a.value * scale, a.gradient),
                    (b.value, b.gradient),
                    "{storage:?} {exponent}"
                );
            }
        }
    }
}

#[test]
fn a_tiny_cloud_may_lie_far_from_the_origin() {
    let mut random = Random(7);
    let points: Vec<DVec3> = (0..100)
        .map(|_| (random.point() * 1024.0).round() / 1024.0)
        .collect();
    let far = DVec3::new(1e9, -2e9, 5e8);
    let moved: Vec<DVec3> = points.iter().map(|&p| p + far).collect();
    assert!(
        points.iter().zip(&moved).all(|(&p, &q)| q - far == p),
        "no rounding"
    );
    for storage in [Storage::Dense, Storage::Sparse] {
        let options = DistanceOptions {
            storage,
            ..options(50, 1.0)
        };
        let (grid, moved) = (build(&points, &options), build(&moved, &options));
        for _ in 0..1000 {
            let at = ((1.4 * random.point() - 0.2) * 1024.0).round() / 1024.0;
            let (a, b) = (grid.sample(at), moved.sample(at + far));
            // Coordinates are rounded by 2⁻²³, the box by as much.
            assert!((a.value - b.value).abs() < 2e-6, "{a:?} {b:?}");
            assert!((a.gradient - b.gradient).length() < 2e-4, "{a:?} {b:?}");
        }
    }
}

#[test]
fn beyond_the_outermost_centres_the_distance_to_them_is_added() {
    let mut random = Random(8);
    let points: Vec<DVec3> = (0..50).map(|_| random.point()).collect();
    for storage in [Storage::Dense, Storage::Sparse] {
        let grid = build(
            &points,
            &DistanceOptions {
                storage,
                ..options(30, 1.0)
            },
        );
        let half = 0.5 * grid.spacing();
        let (low, high) = (grid.bounds().min + half, grid.bounds().max - half);
        for _ in 0..1000 {
            let at = 8.0 * random.point() - 4.0;
            let nearest = at.clamp(low, high);
            let beyond = (at - nearest).length();
            let (sample, inner) = (grid.sample(at), grid.sample(nearest));
            assert!((sample.value - inner.value - beyond).abs() < 1e-9);
            // The gradient is that of the extended field.
            if beyond > 0.1 {
                let e = 1e-6;
                let difference = DVec3::from([DVec3::X, DVec3::Y, DVec3::Z].map(|axis| {
                    (grid.sample(at + e * axis).value - grid.sample(at - e * axis).value)
                        / (2.0 * e)
                }));
                let moved = at.cmpne(nearest);
                let difference = DVec3::select(moved, difference, sample.gradient);
                assert!((sample.gradient - difference).length() < 1e-6, "{at}");
            }
        }
        for at in [
            DVec3::NAN,
            DVec3::new(0.0, f64::NAN, 0.0),
            DVec3::INFINITY,
            DVec3::new(0.1, 0.1, f64::NEG_INFINITY),
        ] {
            assert!(
                grid.sample(at).value.is_nan() && grid.sample(at).gradient.is_nan(),
                "{at}"
            );
        }
        for at in [
            DVec3::splat(1e300),
            DVec3::new(-1e300, 0.0, 1.0),
            DVec3::splat(f64::MIN_POSITIVE),
        ] {
            let sample = grid.sample(at);
            assert!(
                sample.value >= 0.0 && sample.gradient.is_finite(),
                "{at}: {sample:?}"
            );
        }
    }
}

#[test]
fn sparse_is_dense_near_the_points() {
    let (mut equal, mut all) = (0, 0);
    let mut most = 0.0_f64;
    for (name, points) in clouds() {
        let dense = build(&points, &options(120, 1.0));
        let h = dense.spacing();
        for band in [4.0, 8.0] {
            let storage = Storage::Sparse;
            let sparse = build(
                &points,
                &DistanceOptions {
                    storage,
                    band,
                    ..options(120, 1.0)
                },
            );
            assert_eq!(
                (dense.dims(), dense.bounds()),
                (sparse.dims(), sparse.bounds())
            );
            let mut random = Random(9);
            for _ in 0..500 {
                let point = points[(random.number() * points.len() as f64) as usize];
                let at = point + 0.6 * band * h * random.number() * random.on_sphere();
                let (a, b) = (dense.sample(at), sparse.sample(at));
                // Farther out sparse values go over to those of the coarse grid.
                if b.value > 0.5 * band * h {
                    continue;
                }
                all += 1;
                if a == b {
                    equal += 1;
                } else {
                    // The kernel reaches values that sweeping has got wrong: two points are never too few for it.
                    assert!(points.len() > 2, "{name} {at}: {a:?} {b:?}");
                }
                let difference = (a.value - b.value) / h;
                assert!(
                    (-1e-6..0.05).contains(&difference),
                    "{name} {at}: {a:?} {b:?}"
                );
                most = most.max(difference);
            }
        }
    }
    println!("{equal} of {all} have equal bits; largest difference {most:.1e} voxels");
    assert!(
        all > 5000 && f64::from(equal) > 0.8 * f64::from(all),
        "{equal} {all}"
    );
}

#[test]
fn sparse_is_continuous_and_near_the_distance_everywhere() {
    let mut worst = [0.0_f64; 3];
    for (name, points) in clouds() {
        for (band, sigma) in [(8.0, 1.0), (8.0, 0.0), (12.0, 1.0)] {
            let options = DistanceOptions {
                storage: Storage::Sparse,
                band,
                ..options(150, sigma)
            };
            let grid = build(&points, &options);
            let h = grid.spacing();
            let mut random = Random(10);
            for _ in 0..5 {
                let bounds = grid.bounds();
                let inner = bounds.extent() - h;
                let mut point = || bounds.min + 0.5 * h + random.point() * inner;
                let (from, to) = (point(), point());
                let steps = ((to - from).length() / (0.02 * h)) as u32;
                let mut last: Option<Sample> = None;
                for i in 0..steps {
                    let at = from.lerp(to, f64::from(i) / f64::from(steps));
                    let sample = grid.sample(at);
                    if let Some(last) = last {
                        let jump = (sample.value - last.value).abs() / h;
                        let turn = (sample.gradient - last.gradient).length();
                        assert!(jump < 0.04, "{name} {at}: {jump}");
                        assert!(turn < 0.05, "{name} {at}: {turn}");
                        worst = [worst[0].max(jump), worst[1].max(turn), worst[2]];
                    }
                    last = Some(sample);
                    if i % 100 == 0 {
                        let off = (sample.value - brute_force(&points, at)).abs() / h;
                        worst[2] = worst[2].max(off);
                        assert!(off < 4.0, "{name} {at}: {off}");
                    }
                }
            }
        }
    }
    println!(
        "largest step {}, turn {}, error {}",
        worst[0], worst[1], worst[2]
    );
}

#[test]
fn bad_input_is_an_error() {
    let good = [DVec3::ZERO, DVec3::ONE];
    let run =
        |points: &[DVec3], options: &DistanceOptions| DistanceGrid::new(points, options, &()).err();
    let default = options(20, 1.0);
    assert!(matches!(run(&[], &default), Some(Error::EmptyCloud)));
    for bad in [f64::NAN, f64::INFINITY] {
        let points = [DVec3::ZERO, DVec3::ONE, DVec3::new(0.0, bad, 0.0)];
        assert!(matches!(
            run(&points, &default),
            Some(Error::PointNotFinite { index: 2 })
        ));
    }
    assert!(matches!(
        run(&[DVec3::ONE; 3], &default),
        Some(Error::ZeroExtent)
    ));
    assert!(matches!(
        run(&[DVec3::ZERO, DVec3::splat(1e-320)], &default),
        Some(Error::ZeroExtent)
    ));
    let huge = [DVec3::splat(-1.7e308), DVec3::splat(1.7e308)];
    assert!(matches!(run(&huge, &default), Some(Error::BoundsNotFinite)));
    let bounds = |min, max| DistanceOptions {
        bounds: Some(Aabb { min, max }),
        ..default
    };
    assert!(matches!(
        run(&good, &bounds(DVec3::NAN, DVec3::ONE)),
        Some(Error::BoundsNotFinite)
    ));
    assert!(matches!(
        run(&good, &bounds(DVec3::ONE, DVec3::ZERO)),
        Some(Error::ZeroExtent)
    ));
    let far = bounds(DVec3::splat(1e9), DVec3::splat(1e9) + 1.0);
    assert!(
        matches!(run(&good, &far), Some(Error::BoundsFarFromPoints { voxels, .. }) if voxels > 1e9)
    );
    for (option, options) in [
        (
            "resolution",
            DistanceOptions {
                resolution: 3,
                ..default
            },
        ),
        (
            "resolution",
            DistanceOptions {
                resolution: u32::MAX,
                ..default
            },
        ),
        (
            "margin",
            DistanceOptions {
                margin: -0.1,
                ..default
            },
        ),
        (
            "sigma",
            DistanceOptions {
                sigma: f64::NAN,
                ..default
            },
        ),
        (
            "sigma",
            DistanceOptions {
                sigma: 17.0,
                ..default
            },
        ),
        (
            "band",
            DistanceOptions {
                band: 0.0,
                ..default
            },
        ),
    ] {
        assert!(
            matches!(run(&good, &options), Some(Error::Option { option: name, .. }) if name == option),
            "{option}"
        );
    }
}

#[test]
fn too_much_memory_is_an_error_before_it_is_taken() {
    let points = [DVec3::ZERO, DVec3::ONE];
    for (storage, resolution) in [
        (Storage::Dense, 1000),
        (Storage::Sparse, 4000),
        (Storage::Auto, 1 << 20),
    ] {
        let options = DistanceOptions {
            storage,
            resolution,
            memory_limit: 1 << 30,
            ..Default::default()
        };
        let error = DistanceGrid::new(&points, &options, &()).unwrap_err();
        assert!(
            matches!(error, Error::GridTooLarge { needed, limit } if needed > limit && limit == 1 << 30),
            "{error}"
        );
    }
    // Enough for the coarse grid, not for the blocks.
    let mut random = Random(11);
    let points: Vec<DVec3> = (0..20_000).map(|_| random.point()).collect();
    let options = DistanceOptions {
        storage: Storage::Sparse,
        resolution: 200,
        memory_limit: 10 << 20,
        ..Default::default()
    };
    let error = DistanceGrid::new(&points, &options, &()).unwrap_err();
    assert!(
        matches!(error, Error::GridTooLarge { needed, .. } if needed > 10 << 20),
        "{error}"
    );
}

/// Stops at the step with this number.
struct Stop(AtomicU64);

impl Progress for Stop {
    fn step(&self, _stage: &'static str, done: u64, total: u64) -> ControlFlow<()> {
        assert!(done <= total);
        let left = self
            .0
            .fetch_update(Relaxed, Relaxed, |left| left.checked_sub(1));
        if left.is_ok() {
            ControlFlow::Continue(())
        } else {
            ControlFlow::Break(())
        }
    }
}

#[test]
fn every_step_can_be_the_last() {
    let mut random = Random(12);
    let points: Vec<DVec3> = (0..500).map(|_| random.point()).collect();
    for storage in [Storage::Dense, Storage::Sparse] {
        let options = DistanceOptions {
            storage,
            ..options(70, 1.0)
        };
        let mut stopped = 0;
        while let Err(error) = DistanceGrid::new(&points, &options, &Stop(AtomicU64::new(stopped)))
        {
            assert!(matches!(error, Error::Cancelled(_)), "{error}");
            stopped += 1;
        }
        assert!(stopped > 20, "{storage:?}: {stopped} steps");
    }
}
