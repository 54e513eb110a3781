//! Each numbered formula against a closed form or a finite difference.

use crate::field::{One, Sample};
use crate::finite_volumes::{FiniteVolumes, laplacian};
use crate::redistribution::{
    CurvatureDensity, CurvatureFunction, Redistribution, gradient_velocity, right_side,
    target_shares, towards_equilateral,
};
use crate::rings::Rings;
use crate::{Evolution, Field, StepOptions, velocity};
use glam::DVec3;
use pellicle_geometry::VertexId;
use pellicle_mesh::{TriMesh, TriangleSoup, area, icosphere, signed_volume};
use std::f64::consts::TAU;

/// A closed surface without symmetry: a sphere, bent.
fn blob(levels: u32) -> TriMesh {
    let mut mesh = icosphere(levels).unwrap();
    let bent = mesh.positions().iter().map(|&p| {
        let q = DVec3::new(1.3 * p.x, 0.9 * p.y, 1.1 * p.z);
        q + 0.15
            * DVec3::new(
                (2.0 * p.y).sin(),
                (1.5 * p.z + 0.3).cos(),
                (p.x * p.y).sin(),
            )
    });
    let bent = bent.collect();
    mesh.set_positions(bent).unwrap();
    mesh
}

fn sphere(levels: u32, radius: f64) -> TriMesh {
    let mut mesh = icosphere(levels).unwrap();
    let scaled = mesh.positions().iter().map(|&p| radius * p).collect();
    mesh.set_positions(scaled).unwrap();
    mesh
}

/// The torus around z, outward, `n` by `m` vertices; vertex `i m + j` at angles `i` around z and `j` around the tube.
fn torus(large: f64, small: f64, n: u32, m: u32) -> TriMesh {
    let at = |i: u32, j: u32| {
        let (u, v) = (
            TAU * f64::from(i) / f64::from(n),
            TAU * f64::from(j) / f64::from(m),
        );
        let ring = large + small * v.cos();
        DVec3::new(ring * u.cos(), ring * u.sin(), small * v.sin())
    };
    let id = |i: u32, j: u32| VertexId((i % n) * m + j % m);
    let cells = (0..n).flat_map(|i| (0..m).map(move |j| (i, j)));
    TriMesh::try_from(TriangleSoup {
        positions: cells.clone().map(|(i, j)| at(i, j)).collect(),
        triangles: cells
            .flat_map(|(i, j)| {
                let [a, b, c, d] = [id(i, j), id(i + 1, j), id(i + 1, j + 1), id(i, j + 1)];
                [[a, b, c], [a, c, d]]
            })
            .collect(),
    })
    .unwrap()
}

/// The surface of the cube [0, n]³ with its unit squares halved: flat around most vertices.
fn cube(n: i32) -> TriMesh {
    let mut soup = TriangleSoup {
        positions: Vec::new(),
        triangles: Vec::new(),
    };
    let mut ids = std::collections::BTreeMap::new();
    let axes = [glam::IVec3::X, glam::IVec3::Y, glam::IVec3::Z];
    for side in 0..3 {
        let (u, v, w) = (axes[side], axes[(side + 1) % 3], axes[(side + 2) % 3]);
        for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
            for top in [false, true] {
                let corner =
                    |i: i32, j: i32| u * i + v * j + if top { w * n } else { glam::IVec3::ZERO };
                let [a, b, c, d] = [
                    corner(i, j),
                    corner(i + 1, j),
                    corner(i + 1, j + 1),
                    corner(i, j + 1),
                ];
                let triangles = if top {
                    [[a, b, c], [a, c, d]]
                } else {
                    [[a, c, b], [a, d, c]]
                };
                for triangle in triangles {
                    soup.triangles.push(triangle.map(|p| {
                        *ids.entry(p.to_array()).or_insert_with(|| {
                            soup.positions.push(p.as_dvec3());
                            VertexId::new(soup.positions.len() - 1)
                        })
                    }));
                }
            }
        }
    }
    TriMesh::try_from(soup).unwrap()
}

fn both(first: &TriMesh, second: &TriMesh) -> TriMesh {
    let mut soup = first.clone().into_soup();
    let offset = soup.positions.len() as u32;
    soup.positions.extend(second.positions());
    let moved = second
        .triangles()
        .iter()
        .map(|t| t.map(|v| VertexId(v.0 + offset)));
    soup.triangles.extend(moved);
    TriMesh::try_from(soup).unwrap()
}

fn measured(mesh: &TriMesh) -> (Rings, FiniteVolumes) {
    let rings = Rings::of(mesh).unwrap();
    let mut volumes = FiniteVolumes::default();
    volumes.measure(&rings, mesh.positions());
    (rings, volumes)
}

fn area_at(mesh: &TriMesh, positions: Vec<DVec3>) -> f64 {
    let mut mesh = mesh.clone();
    mesh.set_positions(positions).unwrap();
    area((&mesh).into())
}

#[test]
fn co_volumes_are_thirds_of_triangles() {
    // (4.10), (4.11).
    let mesh = blob(2);
    let (rings, volumes) = measured(&mesh);
    let total: f64 = volumes.areas.iter().sum();
    assert!((total - area((&mesh).into())).abs() < 1e-12 * total);
    assert!((volumes.total_areas[0] - total).abs() < 1e-12 * total);
    let third: f64 = mesh
        .triangles_around(VertexId(7))
        .map(|t| {
            let [a, b, c] = mesh.corners(t);
            pellicle_geometry::triangle::area(a, b, c) / 3.0
        })
        .sum();
    assert!((volumes.areas[7] - third).abs() < 1e-14);
    assert_eq!(rings.vertices(), 162);
}

#[test]
fn the_stiffness_is_the_gradient_of_the_area() {
    // (4.6), (4.15) with the errata's sign: Σ ½ (cot + cot)(F_p − F_i) = −∂A/∂F_i.
    let mesh = blob(2);
    let (rings, volumes) = measured(&mesh);
    let positions = mesh.positions();
    for i in [0, 5, 11, 42, 100, 161] {
        let sum: DVec3 = laplacian(&rings, &volumes.weights, i, |e| {
            positions[e.neighbor as usize] - positions[i]
        });
        let step = 1e-5;
        let gradient = DVec3::AXES.map(|axis| {
            let shifted = |by: f64| {
                let mut moved = positions.to_vec();
                moved[i] += by * axis;
                area_at(&mesh, moved)
            };
            (shifted(step) - shifted(-step)) / (2.0 * step)
        });
        let difference = (sum + DVec3::from_array(gradient)).length();
        assert!(difference < 1e-8, "vertex {i}: {difference:e}");
        let h = volumes.curvature_vectors[i];
        assert!((h * volumes.areas[i] - sum).length() < 1e-14);
        assert_eq!(volumes.curvatures[i], h.dot(volumes.normals[i]));
    }
}

#[test]
fn mean_curvature_is_minus_two_over_the_radius() {
    // (4.14), (4.15): inwards on a sphere. The mean is weighted with the areas, since at the twelve vertices of degree
    // five the barycentric co-volume is not the right one.
    let (_, volumes) = measured(&sphere(4, 3.0));
    let integral: f64 = volumes
        .areas
        .iter()
        .zip(&volumes.curvatures)
        .map(|(a, h)| a * h)
        .sum();
    let mean = integral / volumes.total_areas[0];
    assert!((mean + 2.0 / 3.0).abs() < 2e-3, "{mean}");
}

#[test]
fn mean_curvature_of_a_torus() {
    // Both signs of the second principal curvature: H = −(R + 2r cos v) / (r (R + r cos v)).
    let (large, small) = (3.0, 1.0);
    let error = |n: u32| {
        let mesh = torus(large, small, 3 * n, n);
        let (_, volumes) = measured(&mesh);
        let errors = (0..mesh.positions().len()).map(|i| {
            let v = TAU * (i % n as usize) as f64 / f64::from(n);
            let exact = -(large + 2.0 * small * v.cos()) / (small * (large + small * v.cos()));
            (volumes.curvatures[i] - exact).abs()
        });
        errors.fold(0.0, f64::max)
    };
    let (coarse, fine) = (error(24), error(48));
    assert!(fine < 0.01, "{fine}");
    assert!(coarse / fine > 3.0, "{coarse} {fine}");
}

#[test]
fn normals_are_the_mean_of_unit_normals() {
    let mesh = cube(2);
    let (_, volumes) = measured(&mesh);
    for (p, n) in mesh.positions().iter().zip(&volumes.normals) {
        // In the middle of a face, and pointing outwards elsewhere.
        let outward = *p - DVec3::ONE;
        assert!(n.dot(outward) > 0.0);
        if outward.abs().element_sum() == 1.0 {
            assert!((*n - outward).length() < 1e-15);
        }
    }
}

#[test]
fn advection_and_its_product_with_curvature() {
    // (4.5), (4.16) on a sphere of radius 2 at distance 0.5 of a field that grows outwards.
    let mesh = sphere(4, 2.0);
    let (_, volumes) = measured(&mesh);
    let (w_a, w_d, d) = (3.0, 7.0, 0.5);
    let mut integral = 0.0;
    for (i, &p) in mesh.positions().iter().enumerate() {
        let sample = Sample {
            value: d,
            gradient: p.normalize(),
        };
        let speed = velocity::advection(w_a, &volumes, &sample, i);
        assert!((speed + w_a).abs() < 1e-3 * w_a);
        let q = velocity::normal_velocity_dot_curvature(speed, w_d, &volumes, &sample, i);
        integral += volumes.areas[i] * q;
    }
    // v_N = −(w_a + w_d d 2/R) N and h = −2/R N.
    let exact = (w_a + w_d * d) * volumes.total_areas[0];
    assert!((integral / exact - 1.0).abs() < 0.02, "{integral} {exact}");
}

#[test]
fn the_area_changes_by_the_integral_of_velocity_and_curvature() {
    // (2.8): dA/dt = −∫ v_N · h, for a normal velocity that varies.
    let mesh = blob(4);
    let (_, volumes) = measured(&mesh);
    let speed = |p: DVec3| 1.0 + 0.5 * (2.0 * p.x).sin() - p.z;
    let integral: f64 = mesh
        .positions()
        .iter()
        .enumerate()
        .map(|(i, &p)| volumes.areas[i] * speed(p) * volumes.curvatures[i])
        .sum();
    let after = |t: f64| {
        let moved = mesh.positions().iter().zip(&volumes.normals);
        area_at(&mesh, moved.map(|(&p, &n)| p + t * speed(p) * n).collect())
    };
    let derivative = (after(1e-5) - after(-1e-5)) / 2e-5;
    assert!(
        (derivative + integral).abs() < 1e-6 * integral.abs(),
        "{derivative} {integral}"
    );
}

#[test]
fn target_shares_sum_to_one_over_each_component() {
    let mesh = both(&blob(1), &sphere(2, 0.5));
    let (rings, _) = measured(&mesh);
    let function = CurvatureFunction::CubeRoot { epsilon: 0.1 };
    let shares = target_shares(&rings, |i| function.value(i as f64));
    let sums = rings.sum_by_component(|i| shares[i]);
    assert_eq!(sums.len(), 2);
    assert!(sums.iter().all(|s| (s - 1.0).abs() < 1e-14));
    // (2.16): G f(H) is constant.
    let constant = shares[3] * function.value(3.0);
    assert!((shares[30] * function.value(30.0) - constant).abs() < 1e-15);
}

#[test]
fn the_three_densities() {
    let at = |function: CurvatureFunction| function.value(-7.0);
    assert!((at(CurvatureFunction::CubeRoot { epsilon: 1.0 }) - 2.0).abs() < 1e-15);
    assert!((at(CurvatureFunction::CubeRootSquared { epsilon: 1.0 }) - 4.0).abs() < 1e-15);
    assert!((at(CurvatureFunction::Exponential { alpha: 0.5 }) - 3.5_f64.exp()).abs() < 1e-12);
    assert!(
        CurvatureFunction::Exponential { alpha: 1.0 }
            .value(1e9)
            .is_finite()
    );
}

#[test]
fn the_right_side_sums_to_zero_over_each_component() {
    // (2.19), (4.16)–(4.18).
    let mesh = both(&blob(3), &torus(2.0, 0.7, 30, 12));
    let (rings, volumes) = measured(&mesh);
    let q: Vec<f64> = (0..rings.vertices())
        .map(|i| (i as f64).sin() + 0.2)
        .collect();
    let shares = target_shares(&rings, |i| 1.0 + (i % 5) as f64);
    let right = right_side(&rings, &volumes, &q, &shares, 100.0);
    let sizes = rings.sum_by_component(|i| right[i].abs());
    for (sum, size) in rings.sum_by_component(|i| right[i]).iter().zip(&sizes) {
        assert!(sum.abs() < 1e-13 * size, "{sum:e} of {size:e}");
    }
}

#[test]
fn the_gradient_of_a_linear_function_is_exact_where_the_surface_is_flat() {
    // (4.8), (4.9).
    let mesh = cube(4);
    let (rings, volumes) = measured(&mesh);
    let slope = DVec3::new(0.3, -2.0, 1.1);
    let psi: Vec<f64> = mesh
        .positions()
        .iter()
        .map(|p| slope.dot(*p) + 5.0)
        .collect();
    let mut velocity = Vec::new();
    gradient_velocity(&mut velocity, &rings, &volumes, mesh.positions(), &psi);
    let mut flat = 0;
    for (i, p) in mesh.positions().iter().enumerate() {
        let sides = (0..3).filter(|&a| p[a] == 0.0 || p[a] == 4.0).count();
        if sides == 1 {
            let n = volumes.normals[i];
            let exact = slope - slope.dot(n) * n;
            assert!(
                (velocity[i] - exact).length() < 1e-13,
                "{} {exact}",
                velocity[i]
            );
            flat += 1;
        }
    }
    assert_eq!(flat, 6 * 9);
}

#[test]
fn the_gradient_on_a_sphere() {
    let error = |levels: u32| {
        let mesh = sphere(levels, 1.0);
        let (rings, volumes) = measured(&mesh);
        let psi: Vec<f64> = mesh.positions().iter().map(|p| p.z).collect();
        let mut velocity = Vec::new();
        gradient_velocity(&mut velocity, &rings, &volumes, mesh.positions(), &psi);
        let squares = mesh.positions().iter().zip(&velocity).zip(&volumes.areas);
        let square: f64 = squares
            .map(|((&p, v), a)| a * v.distance_squared(DVec3::Z - p.z * p))
            .sum();
        square.sqrt()
    };
    let (coarse, fine) = (error(3), error(4));
    assert!(fine < 0.02 && coarse / fine > 1.8, "{coarse} {fine}");
}

#[test]
fn a_constant_added_to_the_potential_changes_nothing() {
    // Errata 5: so it is only with h of the right sign.
    let mesh = blob(3);
    let (rings, volumes) = measured(&mesh);
    let psi: Vec<f64> = mesh
        .positions()
        .iter()
        .map(|p| (3.0 * p.x).sin() + p.y)
        .collect();
    let velocity = |shift: f64| {
        let psi: Vec<f64> = psi.iter().map(|value| value + shift).collect();
        let mut velocity = Vec::new();
        gradient_velocity(&mut velocity, &rings, &volumes, mesh.positions(), &psi);
        velocity
    };
    let largest = velocity(0.0).iter().map(|v| v.length()).fold(0.0, f64::max);
    for (a, b) in velocity(0.0).iter().zip(velocity(1000.0)) {
        assert!((*a - b).length() < 1e-10 * largest);
    }
}

#[test]
fn shares_of_the_area_approach_their_targets_at_the_rate_omega() {
    // (2.13): d/dt (G/A) = ω (1/A_X − G/A), whatever the normal velocity does: here it is large and uneven, so that the
    // first two terms of (2.19) weigh as much as the third.
    struct Uneven;
    impl Field for Uneven {
        fn sample(&self, at: DVec3) -> Sample {
            Sample {
                value: 0.4 + 0.3 * at.z.abs(),
                gradient: (0.5 + at.x) * at.normalize(),
            }
        }
    }
    // Without a density, and with one.
    let function = CurvatureFunction::CubeRoot { epsilon: 0.5 };
    let density = CurvatureDensity {
        function,
        unit: Some(1.0),
    };
    let (omega, tau) = (4.0, 1e-5);
    let relative_error = |levels: u32, redistribution: Redistribution| {
        let options = StepOptions {
            advection: 2.0,
            diffusion: 1.0,
            time_step: tau,
            redistribution,
            ..StepOptions::default()
        };
        let mut evolution = Evolution::new(blob(levels)).unwrap();
        let (rings, before) = measured(evolution.mesh());
        let shares = match redistribution {
            Redistribution::CurvatureDriven { .. } => {
                let curvatures = evolution.curvatures_for_test();
                target_shares(&rings, |i| function.value(curvatures[i]))
            }
            _ => target_shares(&rings, |_| 1.0),
        };
        evolution.step(&Uneven, &options).unwrap();
        let (_, after) = measured(evolution.mesh());
        let (mut error, mut size) = (0.0, 0.0);
        for (i, target) in shares.iter().enumerate() {
            let share = |v: &FiniteVolumes| v.areas[i] / v.total_areas[0];
            let exact = omega * (target - share(&before));
            let rate = (share(&after) - share(&before)) / tau;
            error += (rate - exact).abs();
            size += exact.abs();
        }
        error / size
    };
    for redistribution in [
        Redistribution::AreaUniform { omega },
        Redistribution::CurvatureDriven { omega, density },
    ] {
        let errors = [2, 3, 4, 5].map(|levels| relative_error(levels, redistribution));
        // Of first order in the length of the edges, from some length on.
        assert!(errors.windows(2).all(|e| e[1] < 0.75 * e[0]), "{errors:?}");
        assert!(errors[3] < 0.6 * errors[2], "{errors:?}");
    }
}

#[test]
fn equilateral_triangles_stay() {
    let mesh = sphere(0, 1.0);
    let (rings, volumes) = measured(&mesh);
    for i in 0..12 {
        let move_by = towards_equilateral(&rings, &volumes, mesh.positions(), i);
        assert!(move_by.length() < 1e-15);
    }
    // One vertex of the regular tiling, pushed aside, is wanted back: each of the six apexes is where it was.
    let mut mesh = cube(6);
    let sheared = mesh
        .positions()
        .iter()
        .map(|p| DVec3::new(p.x - 0.5 * p.y, 0.75_f64.sqrt() * p.y, p.z));
    let mut sheared: Vec<DVec3> = sheared.collect();
    let middle = DVec3::new(3.0 - 1.5, 0.75_f64.sqrt() * 3.0, 6.0);
    let v = (0..sheared.len())
        .find(|&i| sheared[i].distance(middle) < 1e-9)
        .unwrap();
    let push = DVec3::new(0.2, -0.1, 0.0);
    sheared[v] += push;
    mesh.set_positions(sheared).unwrap();
    let (rings, volumes) = measured(&mesh);
    let back = towards_equilateral(&rings, &volumes, mesh.positions(), v);
    assert!((back + push).length() < 1e-12, "{back}");
}

#[test]
fn one_semi_implicit_step_of_a_sphere() {
    // (4.1) for d = 1, w_a = 0: the scheme takes h at the old surface but F at the new, so R' (1 + 2 τ w_d / R²) = R.
    let options = StepOptions {
        advection: 0.0,
        diffusion: 3.0,
        time_step: 0.2,
        redistribution: Redistribution::None,
        ..StepOptions::default()
    };
    let mut evolution = Evolution::new(sphere(4, 2.0)).unwrap();
    let report = evolution.step(&One, &options).unwrap();
    let exact = 2.0 / (1.0 + 2.0 * 0.6 / 4.0);
    let volume = signed_volume(evolution.mesh().into());
    let radius = (0.75 * volume / std::f64::consts::PI).cbrt();
    assert!((radius - exact).abs() < 5e-3, "{radius} {exact}");
    assert!((report.largest_move - (2.0 - exact)).abs() < 0.02);
    assert_eq!((report.potential_iterations, report.capped), (0, 0));
    assert!(report.motion_iterations > 0);
}
