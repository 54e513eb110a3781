//! Spheres, boxes and subdivision against what is known of them.

mod common;

use common::*;
use pellicle_geometry::{DVec3, triangle};
use pellicle_mesh::{
    MeshError, SplitOptions, TriMesh, TriangleSoup, cuboid, icosphere, signed_volume, subdivide,
    summarize,
};
use proptest::prelude::*;
use std::f64::consts::PI;

#[test]
fn spheres_have_their_counts_and_face_outward() {
    let mut volume = 0.0;
    for levels in 0..6 {
        let sphere = icosphere(levels).unwrap();
        assert_eq!(sphere.validate(), []);
        let growth = 4_usize.pow(levels);
        assert_eq!(sphere.positions().len(), 10 * growth + 2);
        assert_eq!(sphere.triangles().len(), 20 * growth);
        assert_eq!(summarize((&sphere).into()).unwrap().genus(), Some(0));
        for p in sphere.positions() {
            assert!((p.length() - 1.0).abs() < 1e-15);
        }
        for t in sphere.triangle_ids() {
            let [a, b, c] = sphere.corners(t);
            assert!(triangle::double_area_normal(a, b, c).dot(a + b + c) > 0.0);
        }
        let finer = signed_volume((&sphere).into());
        assert!(finer > volume && finer < 4.0 * PI / 3.0);
        volume = finer;
    }
    assert!((volume / (4.0 * PI / 3.0) - 1.0).abs() < 1e-3);
}

#[test]
fn the_icosahedron_is_regular() {
    let sphere = icosphere(0).unwrap();
    let expected = 4.0 / (10.0 + 2.0 * 5.0_f64.sqrt()).sqrt();
    for h in sphere.edges() {
        let [a, b] = [sphere.origin(h), sphere.destination(h)].map(|v| sphere.position(v));
        assert!((a.distance(b) - expected).abs() < 1e-15);
    }
    assert_eq!(sphere.edges().count(), 30);
}

#[test]
fn too_many_levels_are_refused() {
    for levels in [14, 16, 31, 32, 64, u32::MAX] {
        let error = icosphere(levels).unwrap_err();
        assert!(matches!(error, MeshError::TooLarge { .. }), "{error}");
    }
}

proptest! {
    #[test]
    fn a_box_has_its_corners_sides_and_volume(
        ends in proptest::array::uniform2(proptest::array::uniform3(-9..9_i8)),
    ) {
        let [min, max] = ends.map(|end| DVec3::from_array(end.map(f64::from)));
        let mesh = cuboid(min, max).unwrap();
        prop_assert!(mesh.is_closed());
        prop_assert_eq!((mesh.positions()[0], mesh.positions()[7]), (min, max));
        // Integers: no rounding. Negative where an odd number of axes is turned.
        prop_assert_eq!(signed_volume((&mesh).into()), (max - min).element_product());
        for t in mesh.triangle_ids() {
            let [a, b, c] = mesh.corners(t);
            let normal = triangle::double_area_normal(a, b, c);
            let outward = normal.dot(2.0 * a - (min + max));
            prop_assert_eq!(outward, (max - min).element_product());
        }
    }
}

#[test]
fn a_box_of_any_finite_size_is_one() {
    let huge = cuboid(DVec3::splat(-f64::MAX), DVec3::splat(f64::MAX)).unwrap();
    assert_eq!(
        huge.positions()[6],
        DVec3::new(-f64::MAX, f64::MAX, f64::MAX)
    );
    let error = cuboid(DVec3::ZERO, DVec3::new(1.0, f64::NAN, 1.0)).unwrap_err();
    assert!(matches!(error, MeshError::NotManifold { .. }), "{error}");
}

/// What [`subdivide`] promises, checked against the soup's own connectivity.
fn check_subdivision(mesh: &TriMesh) {
    let finer = subdivide(mesh).unwrap();
    assert_eq!(finer.validate().len(), 4 * mesh.validate().len());
    // Equal to what the triangles alone give: twins and outgoing half-edges are the right ones.
    assert_eq!(finer, TriMesh::try_from(finer.clone().into_soup()).unwrap());
    let old = mesh.positions().len();
    assert_eq!(&finer.positions()[..old], mesh.positions());
    assert_eq!(finer.positions().len(), old + mesh.edges().count());
    assert_eq!(finer.triangles().len(), 4 * mesh.triangles().len());
    for (n, h) in mesh.edges().enumerate() {
        let [a, b] = [mesh.origin(h), mesh.destination(h)].map(|v| mesh.position(v));
        assert_eq!(finer.positions()[old + n], 0.5 * a + 0.5 * b);
    }
    for (t, triangle) in mesh.triangles().iter().enumerate() {
        for (i, &corner) in triangle.iter().enumerate() {
            assert_eq!(finer.triangles()[4 * t + i][i], corner);
        }
        assert!(
            finer.triangles()[4 * t + 3]
                .iter()
                .all(|v| v.index() >= old)
        );
    }
    let measures = |m: &TriMesh| {
        let s = summarize(m.into()).unwrap();
        let loops: usize = s.components.iter().map(|c| c.border_loops).sum();
        (s.components.len(), s.genus(), loops, s.is_closed())
    };
    assert_eq!(measures(&finer), measures(mesh));
    let [before, after] = [mesh, &finer].map(|m| summarize(m.into()).unwrap().area);
    assert!((after - before).abs() <= 1e-12 * before);
}

#[test]
fn subdivision_keeps_its_promise() {
    for soup in [
        TriangleSoup::default(),
        soup(vec![DVec3::ZERO, DVec3::X, DVec3::Y], &[[0, 1, 2]]),
        soup(vec![DVec3::ZERO, DVec3::X, 2.0 * DVec3::X], &[[0, 1, 2]]),
        tetrahedron(),
        cube(),
        sheet(1, 1),
        sheet(3, 2),
        torus(2.0, 0.5, 4, 3),
        together(sheet(2, 1), tetrahedron()),
    ] {
        check_subdivision(&TriMesh::try_from(soup).unwrap());
    }
}

#[test]
fn subdivision_does_not_overflow() {
    let far = f64::MAX;
    let corners = vec![
        DVec3::splat(far),
        DVec3::new(-far, far, far),
        DVec3::new(far, -far, far),
    ];
    let finer = subdivide(&TriMesh::try_from(soup(corners, &[[0, 1, 2]])).unwrap()).unwrap();
    assert!(finer.validate().iter().all(|d| !d.prevents_manifold()));
}

proptest! {
    #[test]
    fn subdivision_of_any_manifold(
        triangles in prop::collection::vec([0_u32..12, 0_u32..12, 0_u32..12], 1..40),
    ) {
        let positions = (0..12).map(|i| {
            let x = f64::from(i);
            DVec3::new(x, (x * 1.7).sin(), (x * 2.3).cos())
        });
        let soup = soup(positions.collect(), &triangles);
        let (mesh, _) = TriMesh::from_soup_splitting(soup, &SplitOptions::default()).unwrap();
        check_subdivision(&mesh);
    }
}
