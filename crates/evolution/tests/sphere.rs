//! Figures that a right implementation shows on a sphere.

use pellicle_evolution::{Covolumes, Error, Evolution, One, Redistribution, StepOptions};
use pellicle_geometry::DVec3;
use pellicle_mesh::{AngleBounds, icosphere, quality};

#[test]
fn mean_curvature_flow_shrinks_a_sphere_with_second_order() {
    // R(t) = √(1 − 4t), to t = 0.2, with τ ~ h².
    let error = |levels: u32, steps: u32| {
        let options = StepOptions {
            advection: 0.0,
            diffusion: 1.0,
            time_step: 0.2 / f64::from(steps),
            redistribution: Redistribution::None,
            ..StepOptions::default()
        };
        let mut evolution = Evolution::new(icosphere(levels).unwrap()).unwrap();
        let mut largest = 0.0_f64;
        for step in 1..=steps {
            evolution.step(&One, &options).unwrap();
            let exact = (1.0 - 0.8 * f64::from(step) / f64::from(steps)).sqrt();
            for p in evolution.mesh().positions() {
                largest = largest.max((p.length() - exact).abs());
            }
        }
        largest
    };
    let errors = [error(2, 20), error(3, 80), error(4, 320)];
    println!("errors of the radius {errors:?}");
    let order = |a: usize, b: usize| (errors[a] / errors[b]).log2() / (b - a) as f64;
    assert!(order(0, 2) >= 1.8 && order(1, 2) >= 1.8, "{errors:?}");
}

#[test]
fn redistribution_alone_makes_areas_uniform_and_keeps_the_sphere() {
    // 2,562 vertices, crowded towards one side.
    let mut mesh = icosphere(4).unwrap();
    let crowded = mesh.positions().iter();
    let crowded = crowded.map(|&p| (p + DVec3::new(0.0, 0.0, 0.3)).normalize());
    let crowded = crowded.collect();
    mesh.set_positions(crowded).unwrap();
    let area_variation = |evolution: &Evolution| {
        let bounds = AngleBounds::default();
        quality(evolution.mesh().into(), &bounds)
            .unwrap()
            .vertex_area_variation
    };
    let options = StepOptions {
        advection: 0.0,
        diffusion: 0.0,
        time_step: 0.001,
        redistribution: Redistribution::AreaUniform { omega: 100.0 },
        ..StepOptions::default()
    };
    let mut evolution = Evolution::new(mesh).unwrap();
    let mut variations = vec![area_variation(&evolution)];
    let mut radii = (f64::INFINITY, 0.0_f64);
    for _ in 0..100 {
        evolution.step(&One, &options).unwrap();
        variations.push(area_variation(&evolution));
        for p in evolution.mesh().positions() {
            radii = (radii.0.min(p.length()), radii.1.max(p.length()));
        }
    }
    println!("variation {:?}", [0, 10, 30, 100].map(|i| variations[i]));
    println!("radius {radii:?}");
    assert!(variations[0] > 0.3);
    assert!(variations[100] <= 0.01, "{}", variations[100]);
    assert!(radii.0 >= 0.995 && radii.1 <= 1.005, "{radii:?}");
}

#[test]
fn angle_aware_redistribution_mends_angles() {
    // The paper's open problem is angles. Here on a sphere, squeezed along one axis and pushed out again.
    let squeezed = || {
        let mut mesh = icosphere(3).unwrap();
        let positions = mesh.positions().iter();
        let positions = positions.map(|&p| DVec3::new(p.x, 0.3 * p.y, p.z).normalize());
        let positions = positions.collect();
        mesh.set_positions(positions).unwrap();
        mesh
    };
    let after = |redistribution: Redistribution| {
        let options = StepOptions {
            advection: 0.0,
            diffusion: 0.0,
            time_step: 0.001,
            redistribution,
            ..StepOptions::default()
        };
        let mut evolution = Evolution::new(squeezed()).unwrap();
        for _ in 0..200 {
            evolution.step(&One, &options).unwrap();
        }
        quality(evolution.mesh().into(), &AngleBounds::default()).unwrap()
    };
    let omega = 100.0;
    let uniform = after(Redistribution::AreaUniform { omega });
    let aware = after(Redistribution::AngleAware {
        omega,
        omega_angles: 30.0,
    });
    let five_degrees = 5.0_f64.to_radians();
    assert!(
        aware.min_angle > uniform.min_angle + five_degrees,
        "{uniform:?} {aware:?}"
    );
    assert!(
        aware.max_angle < uniform.max_angle - five_degrees,
        "{uniform:?} {aware:?}"
    );
    assert!(aware.vertex_area_variation < 0.05, "{aware:?}");
}

#[test]
fn covolumes_measure_a_sphere() {
    let mut mesh = icosphere(4).unwrap();
    let radius = 3.0;
    let scaled = mesh.positions().iter().map(|&p| radius * p).collect();
    mesh.set_positions(scaled).unwrap();
    let covolumes = Covolumes::of(&mesh).unwrap();
    let sum: f64 = covolumes.areas.iter().sum();
    let area = pellicle_mesh::area((&mesh).into());
    assert!((sum - area).abs() < 1e-10 * area);
    for (i, p) in mesh.positions().iter().enumerate() {
        assert!(covolumes.normals[i].dot(*p) > 0.999 * radius);
        assert!(covolumes.curvature_vectors[i].dot(*p) < 0.0);
        // At vertices of five triangles −2.29, elsewhere −2.
        let curvature = covolumes.curvatures[i] * radius;
        let valence = mesh.neighbors(pellicle_geometry::VertexId::new(i)).count();
        let bounds = if valence == 5 { 2.25..2.33 } else { 1.9..2.1 };
        assert!(bounds.contains(&-curvature), "{valence} {curvature}");
    }
    // An open surface has none.
    let mut open = mesh.into_soup();
    open.triangles.pop();
    let open = pellicle_mesh::TriMesh::try_from(open).unwrap();
    assert!(matches!(Covolumes::of(&open), Err(Error::NotClosed { .. })));
}
