//! The shapes against closed forms, and the polygoniser's and the sampler's promises.

use crate::field::{Ellipsoid, Field};
use crate::shape::volume;
use crate::{AreaSampler, Random, Shape, shapes};
use crate::{clouds, crossing};
use pellicle::geometry::{Aabb, triangle};
use pellicle::mesh::{
    TriMesh, TriangleSoup, area, count_self_intersections, signed_volume, summarize,
    winding_numbers,
};
use pellicle::prelude::{DVec3, MeshView, VertexId};
use std::f64::consts::PI;
use std::sync::OnceLock;

/// Every shape, made once.
fn all() -> &'static [Shape] {
    static ALL: OnceLock<Vec<Shape>> = OnceLock::new();
    ALL.get_or_init(shapes::all)
}

fn sphere() -> Shape {
    let semi_axes = DVec3::ONE;
    Shape::new("sphere", Ellipsoid { semi_axes }, 40, 4.0 / 3.0 * PI)
}

#[test]
fn truths_are_closed_spheres_without_self_intersections() {
    for shape in all() {
        let name = shape.name;
        let summary = summarize((&shape.truth).into()).unwrap();
        assert!(shape.truth.validate().is_empty(), "{name}");
        assert!(shape.truth.is_closed(), "{name}");
        let topology = (summary.components.len(), summary.genus());
        assert_eq!(topology, (1, Some(0)), "{name}");
        let met = count_self_intersections((&shape.truth).into(), &()).unwrap();
        assert_eq!(met, 0, "{name}");
    }
}

#[test]
fn a_ring_has_a_hole() {
    // (|p|² + R² − r²)² = 4R²(x² + y²): the polygoniser makes what the function says, not spheres alone.
    struct Torus;
    impl Field for Torus {
        fn bounds(&self) -> Aabb {
            let corner = DVec3::new(1.4, 1.4, 0.4);
            Aabb {
                min: -corner,
                max: corner,
            }
        }
        fn at(&self, p: DVec3) -> (f64, DVec3) {
            let sum = p.length_squared() + 1.0 - 0.09;
            let flat = DVec3::new(p.x, p.y, 0.0);
            let value = sum * sum - 4.0 * flat.length_squared();
            (value, 4.0 * sum * p - 8.0 * flat)
        }
    }
    let torus = Shape::measured("torus", Torus, 60);
    assert!(torus.truth.is_closed());
    let summary = summarize((&torus.truth).into()).unwrap();
    assert_eq!(summary.genus(), Some(1));
    let expected = 2.0 * PI * PI * 0.09;
    assert!((torus.volume / expected - 1.0).abs() < 1e-5);
}

#[test]
fn closed_volumes_are_those_of_the_refined_meshes() {
    for shape in all().iter().chain([&sphere()]) {
        let refined = volume(shape.field(), &shape.truth);
        let error = refined / shape.volume - 1.0;
        assert!(error.abs() < 2e-6, "{}: {error:e}", shape.name);
        // The flat triangles lose what their size allows, and no more.
        let flat = signed_volume((&shape.truth).into()) / shape.volume - 1.0;
        assert!(flat.abs() < 2e-3, "{}: {flat:e}", shape.name);
    }
}

#[test]
fn the_volume_of_the_vase_is_the_integral_of_its_circles() {
    // ∫ π r² by the midpoint rule, r where the function changes sign along x.
    let vase = shapes::vase();
    let bounds = vase.field().bounds();
    let slices = 2000;
    let height = bounds.extent().y / f64::from(slices);
    let integral: f64 = (0..slices)
        .map(|i| {
            let y = bounds.min.y + (f64::from(i) + 0.5) * height;
            let inside = |x: f64| vase.field().at(DVec3::new(x, y, 0.0)).0 < 0.0;
            let (mut low, mut high) = (0.0, bounds.max.x);
            if !inside(low) {
                return 0.0;
            }
            for _ in 0..50 {
                let middle = 0.5 * (low + high);
                *(if inside(middle) { &mut low } else { &mut high }) = middle;
            }
            PI * low * low * height
        })
        .sum();
    assert!((integral / vase.volume - 1.0).abs() < 1e-5, "{integral}");
}

#[test]
fn the_volume_of_the_bust_is_the_length_of_its_columns() {
    // How much of each upright line is inside, its ends found by halving, over a grid of lines; its error falls
    // with the square of their spacing, and was seen to be 4e-5 at half of this one.
    let bust = shapes::bust();
    let bounds = bust.field().bounds();
    let (spacing, step) = (1.0, 0.9);
    let [columns, steps, rows] = (bounds.extent() / DVec3::new(spacing, step, spacing))
        .to_array()
        .map(|count| count as u32 + 1);
    let mut length = 0.0;
    for (i, k) in (0..columns).flat_map(|i| (0..rows).map(move |k| (i, k))) {
        let (x, z) = (f64::from(i) + 0.31, f64::from(k) + 0.67);
        let at = |y: f64| bounds.min + DVec3::new(spacing * x, y, spacing * z);
        let inside = |y: f64| bust.field().at(at(y)).0 < 0.0;
        let mut below = inside(0.0);
        for j in 1..=steps {
            let (mut low, mut high) = (step * f64::from(j - 1), step * f64::from(j));
            let above = inside(high);
            if above != below {
                for _ in 0..30 {
                    let middle = 0.5 * (low + high);
                    *(if inside(middle) == below {
                        &mut low
                    } else {
                        &mut high
                    }) = middle;
                }
                length += if above { -low } else { low };
            }
            below = above;
        }
    }
    let volume = length * spacing * spacing;
    assert!(
        (volume / bust.volume - 1.0).abs() < 4e-4,
        "{volume} {}",
        bust.volume
    );
}

#[test]
fn gradients_are_differences() {
    for shape in all() {
        let step = 1e-6 * shape.diagonal();
        let mut random = Random::new(5, 0);
        for p in shape.sample(200, 3) {
            let p = p + 1e-3 * shape.diagonal() * random.vector(Random::normal);
            let at = |q: DVec3| shape.field().at(q).0;
            let difference =
                DVec3::AXES.map(|e| (at(p + step * e) - at(p - step * e)) / 2.0 / step);
            let (_, gradient) = shape.field().at(p);
            let error = (gradient - DVec3::from(difference)).length() / gradient.length();
            assert!(error < 1e-5, "{} at {p}: {error:e}", shape.name);
        }
    }
}

#[test]
fn samples_lie_on_the_surface() {
    for shape in all() {
        let points = shape.sample(1000, 1);
        assert_eq!(points.len(), 1000);
        let even = shape.sample_evenly(1000, 1);
        assert!((700..1000).contains(&even.len()), "{}", even.len());
        for p in points.iter().chain(&even) {
            let (value, gradient) = shape.field().at(*p);
            let off = (value / gradient.length()).abs() / shape.diagonal();
            assert!(off < 1e-13, "{} at {p}: {off:e}", shape.name);
        }
    }
}

#[test]
fn the_vertices_of_the_truths_lie_on_the_surface() {
    for shape in all() {
        for &p in shape.truth.positions() {
            let (value, gradient) = shape.field().at(p);
            let off = (value / gradient.length()).abs() / shape.diagonal();
            assert!(off < 1e-13, "{} at {p}: {off:e}", shape.name);
        }
    }
}

/// Σ (n − e)²/e, for counts n and expected counts e.
fn chi_square(counts: &[f64], expected: &[f64]) -> f64 {
    let term = |(n, e): (&f64, &f64)| (n - e) * (n - e) / e;
    counts.iter().zip(expected).map(term).sum()
}

/// The 0.1 % point of chi-square with 19 degrees of freedom.
const BOUND_OF_19: f64 = 43.8;

#[test]
fn large_triangles_get_more_points_and_each_is_filled_evenly() {
    // Right triangles with legs 1 and 3 apart from each other, each cut into four alike by the middles of its sides.
    let corner = |x: f64, y: f64| DVec3::new(x, y, 0.0);
    let positions = [
        corner(0.0, 0.0),
        corner(1.0, 0.0),
        corner(0.0, 1.0),
        corner(10.0, 0.0),
        corner(13.0, 0.0),
        corner(10.0, 3.0),
    ];
    let triangles = [[0, 1, 2], [3, 4, 5]].map(|t| t.map(VertexId));
    let sampler = AreaSampler::new(MeshView {
        positions: &positions,
        triangles: &triangles,
    });
    assert_eq!(sampler.area(), 5.0);
    let mut random = Random::new(3, 0);
    let mut counts = [0.0; 8];
    for _ in 0..8000 {
        let p = sampler.point(&mut random);
        let (large, x, y) = match p.x < 5.0 {
            true => (0, p.x, p.y),
            false => (4, (p.x - 10.0) / 3.0, p.y / 3.0),
        };
        assert!(x >= 0.0 && y >= 0.0 && x + y <= 1.0 + 1e-12, "{p}");
        let part = match (x > 0.5, y > 0.5, x + y > 0.5) {
            (true, ..) => 0,
            (_, true, _) => 1,
            (.., true) => 2,
            _ => 3,
        };
        counts[large + part] += 1.0;
    }
    let expected = [200.0, 200.0, 200.0, 200.0, 1800.0, 1800.0, 1800.0, 1800.0];
    // The 0.1 % point of chi-square with 7 degrees of freedom.
    let found = chi_square(&counts, &expected);
    assert!(found < 24.3, "{counts:?}");
}

/// How much of `weight` lies in each of 20 slabs across an axis.
fn slabs(bounds: Aabb, axis: usize, weighted: impl Iterator<Item = (DVec3, f64)>) -> [f64; 20] {
    let mut sums = [0.0; 20];
    for (p, weight) in weighted {
        let along = (p[axis] - bounds.min[axis]) / bounds.extent()[axis];
        sums[((20.0 * along) as usize).min(19)] += weight;
    }
    sums
}

#[test]
fn samples_of_the_sphere_are_uniform_by_archimedes() {
    let cube = Aabb {
        min: -DVec3::ONE,
        max: DVec3::ONE,
    };
    let points = sphere().sample(20_000, 4);
    for axis in 0..3 {
        let counts = slabs(cube, axis, points.iter().map(|&p| (p, 1.0)));
        let found = chi_square(&counts, &[1000.0; 20]);
        assert!(found < BOUND_OF_19, "{axis}: {found}");
    }
}

/// The area in each slab times a density there, from the truth's triangles cut into 16, scaled to a sum of `count`.
fn expected(shape: &Shape, axis: usize, count: f64, density: impl Fn(DVec3) -> f64) -> [f64; 20] {
    let bounds = Aabb::of_points(shape.truth.positions());
    let pieces = shape.truth.triangle_ids().flat_map(|id| {
        let [a, b, c] = shape.truth.corners(id);
        let share = triangle::area(a, b, c) / 16.0;
        (0..16).map(move |piece| {
            let (i, j) = (f64::from(piece / 4) + 0.5, f64::from(piece % 4) + 0.5);
            let (u, v) = (i / 4.0, j / 4.0);
            let (u, v) = if u + v > 1.0 {
                (1.0 - u, 1.0 - v)
            } else {
                (u, v)
            };
            (a + u * (b - a) + v * (c - a), share)
        })
    });
    let sums = slabs(
        bounds,
        axis,
        pieces.map(|(p, share)| (p, share * density(p))),
    );
    let whole: f64 = sums.iter().sum();
    sums.map(|sum| sum * count / whole)
}

#[test]
fn samples_are_uniform_over_the_area() {
    for shape in all() {
        let bounds = Aabb::of_points(shape.truth.positions());
        let points = shape.sample(20_000, 2);
        for axis in 0..3 {
            let counts = slabs(bounds, axis, points.iter().map(|&p| (p, 1.0)));
            let found = chi_square(&counts, &expected(shape, axis, 20_000.0, |_| 1.0));
            assert!(found < BOUND_OF_19, "{} {axis}: {found}", shape.name);
        }
    }
}

#[test]
fn uneven_samples_have_the_density_that_was_asked_for() {
    for shape in [shapes::ellipsoid(), shapes::vase()] {
        let bounds = Aabb::of_points(shape.truth.positions());
        let axis = bounds.extent().max_position();
        let points = clouds::unevenly(&shape, 20_000, 30.0, 7);
        let counts = slabs(bounds, axis, points.iter().map(|&p| (p, 1.0)));
        let density = |p: DVec3| {
            let below = (bounds.max[axis] - p[axis]) / bounds.extent()[axis];
            1.0 / (1.0 + 29.0 * below)
        };
        let found = chi_square(&counts, &expected(&shape, axis, 20_000.0, density));
        assert!(found < BOUND_OF_19, "{}: {found}", shape.name);
    }
}

#[test]
fn the_rich_shapes_are_hollow_somewhere() {
    // Between two points of a convex body nothing is outside.
    let outside = |shape: &Shape| {
        let points = shape.sample(2000, 9);
        let middles = points.windows(2).map(|pair| 0.5 * (pair[0] + pair[1]));
        middles.filter(|&p| shape.field().at(p).0 > 0.0).count()
    };
    assert_eq!(outside(&shapes::ellipsoid()), 0);
    for shape in [
        shapes::body(),
        shapes::bust(),
        shapes::vase(),
        shapes::bumpy_sphere(),
    ] {
        assert!(outside(&shape) > 20, "{}: {}", shape.name, outside(&shape));
    }
}

#[test]
fn an_ellipsoid_has_its_area() {
    // A spheroid with semi-axes 1, 1, 1/2: 2π + π/(4e)·ln((1 + e)/(1 − e)), e = √3/2.
    let semi_axes = DVec3::new(1.0, 1.0, 0.5);
    let shape = Shape::measured("spheroid", Ellipsoid { semi_axes }, 100);
    let e = 0.75_f64.sqrt();
    let expected = 2.0 * PI + PI / (4.0 * e) * ((1.0 + e) / (1.0 - e)).ln();
    let found = area((&shape.truth).into());
    assert!((found / expected - 1.0).abs() < 1e-3, "{found} {expected}");
}

#[test]
fn noise_has_its_deviation() {
    let points = shapes::ellipsoid().sample(20_000, 1);
    let noisy = clouds::with_noise(&points, 0.01, 2);
    let deviation = 0.01 * Aabb::of_points(&points).diagonal();
    for axis in 0..3 {
        let moves: Vec<f64> = points
            .iter()
            .zip(&noisy)
            .map(|(p, q)| q[axis] - p[axis])
            .collect();
        let mean = moves.iter().sum::<f64>() / 20_000.0;
        let square = moves.iter().map(|x| x * x).sum::<f64>() / 20_000.0;
        assert!(mean.abs() < 4.0 * deviation / 20_000.0_f64.sqrt());
        assert!((square.sqrt() / deviation - 1.0).abs() < 0.02, "{axis}");
    }
}

#[test]
fn outliers_fill_the_enlarged_box() {
    let points = shapes::ellipsoid().sample(1000, 1);
    let cloud = clouds::with_outliers(&points, 0.5, 2);
    assert_eq!(cloud[..1000], points);
    assert_eq!(cloud.len(), 1500);
    let bounds = Aabb::of_points(&points);
    let share = (cloud[1000..]
        .iter()
        .map(|p| (p - bounds.min) / bounds.extent()))
    .collect::<Vec<_>>();
    let found = Aabb::of_points(&share);
    assert!(found.min.min_element() > -0.1 && found.max.max_element() < 1.1);
    assert!(found.min.max_element() < -0.08 && found.max.min_element() > 1.08);
}

#[test]
fn a_patch_is_missing_and_nothing_else() {
    let points = shapes::ellipsoid().sample(5000, 1);
    let center = DVec3::new(70.0, 0.0, 0.0);
    let cloud = clouds::without_patch(&points, center, 20.0);
    let missing = points.iter().filter(|p| p.distance(center) <= 20.0).count();
    assert!(missing > 50);
    assert_eq!(cloud.len(), 5000 - missing);
    assert!(cloud.iter().all(|p| p.distance(center) > 20.0));
}

#[test]
fn a_seed_makes_one_cloud() {
    let shape = shapes::vesicles().into_iter().next().unwrap();
    let make = |seed| {
        let points = shape.sample(300, seed);
        clouds::with_outliers(&clouds::with_noise(&points, 0.01, seed), 0.02, seed)
    };
    assert_eq!(make(1), make(1));
    assert_ne!(make(1), make(2));
    assert_eq!(
        clouds::unevenly(&shape, 100, 30.0, 1),
        clouds::unevenly(&shape, 100, 30.0, 1)
    );
}

#[test]
fn geodesic_spheres_are_even_spheres() {
    for frequency in [1, 2, 7] {
        let sphere = TriMesh::try_from(crossing::geodesic_sphere(frequency)).unwrap();
        let f = frequency as usize;
        assert_eq!(sphere.positions().len(), 10 * f * f + 2);
        assert_eq!(sphere.triangles().len(), 20 * f * f);
        assert!(sphere.is_closed());
        let summary = summarize((&sphere).into()).unwrap();
        assert_eq!((summary.components.len(), summary.genus()), (1, Some(0)));
        assert!(
            sphere
                .positions()
                .iter()
                .all(|p| (p.length() - 1.0).abs() < 1e-15)
        );
        let lengths = summary.shape.unwrap();
        assert!(lengths.max_edge < 1.4 * lengths.min_edge);
    }
}

#[test]
fn surfaces_cross_themselves_as_they_say() {
    let pairs = |soup: &TriangleSoup| {
        let mesh = TriMesh::try_from(soup.clone()).unwrap();
        assert!(mesh.is_closed() && mesh.validate().is_empty());
        count_self_intersections((&mesh).into(), &()).unwrap()
    };
    assert_eq!(pairs(&crossing::geodesic_sphere(20)), 0);
    assert!((200..600).contains(&pairs(&crossing::two_spheres(24))));
    assert!((50..500).contains(&pairs(&crossing::valley(20))));
    let bumpy = |seed| crossing::bumpy_offset(20, 0.05, seed);
    assert!(pairs(&bumpy(1)) > 1000);
    assert!(bumpy(1) == bumpy(1) && bumpy(1) != bumpy(2));
    let before = crossing::bumpy_offset(20, 0.0, 1);
    assert_eq!(pairs(&before), 0);
}

#[test]
fn the_valley_is_a_dent_with_three_bridges() {
    // The surface winds once around what is inside. Above the valley's middle the lips meet at longitudes 0 and ±1/2, and
    // between them the way is free.
    let valley = crossing::valley(20);
    let inside = |longitude: f64| {
        let latitude = 0.05 * (2.0 * longitude).sin();
        let (sin, cos) = longitude.sin_cos();
        let up = DVec3::new(cos * latitude.cos(), sin * latitude.cos(), latitude.sin());
        let along = (0..400).map(|i| (0.8 + 0.0005 * f64::from(i)) * up);
        let windings = winding_numbers((&valley).into(), &along.collect::<Vec<_>>());
        windings.into_iter().any(|winding| winding >= 1)
    };
    for (longitude, bridged) in [
        (0.0, true),
        (0.5, true),
        (-0.5, true),
        (0.25, false),
        (-0.25, false),
    ] {
        assert_eq!(inside(longitude), bridged, "{longitude}");
    }
}
