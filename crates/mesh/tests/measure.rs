//! Measures against closed forms, and against the same mesh in another guise.

mod common;

use common::*;
use pellicle_geometry::DVec3;
use pellicle_mesh::{
    OrientationPolicy, SplitOptions, Summary, TriMesh, TriangleSoup, area, signed_volume, summarize,
};
use proptest::prelude::*;
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI, TAU};

fn summary(soup: &TriangleSoup) -> Summary {
    summarize(soup.into()).unwrap()
}

fn assert_close(found: f64, expected: f64, relative: f64) {
    assert!(
        (found - expected).abs() <= relative * expected.abs(),
        "{found} is not {expected}"
    );
}

#[test]
fn a_cube_is_a_cube() {
    let s = summary(&cube());
    assert_eq!((s.vertices, s.edges, s.triangles), (8, 18, 12));
    assert_eq!(s.volume, Some(1.0));
    assert_close(s.area, 6.0, 1e-15);
    assert!(s.is_closed() && s.is_oriented() && s.is_edge_manifold() && s.is_vertex_manifold());
    assert_eq!(
        (s.genus(), s.euler_characteristic(), s.border_loops()),
        (Some(0), 2, 0)
    );
    let shape = s.shape.unwrap();
    assert_eq!((shape.min_edge, shape.max_edge), (1.0, 2_f64.sqrt()));
    assert_close(shape.mean_edge, (12.0 + 6.0 * 2_f64.sqrt()) / 18.0, 1e-15);
    assert_eq!((shape.min_angle, shape.max_angle), (FRAC_PI_4, FRAC_PI_2));
    let mut histogram = [0; 18];
    (histogram[4], histogram[9]) = (24, 12);
    assert_eq!(shape.angle_histogram, histogram);
    let mut inside_out = mesh(cube());
    inside_out.reverse_orientation();
    assert_eq!(signed_volume((&inside_out).into()), -1.0);
}

#[test]
fn sphere_and_torus_converge_to_their_closed_forms() {
    // Inscribed: from below, four times nearer with each halving of the edges.
    let errors: Vec<f64> = (2..6)
        .map(|level| 4.0 / 3.0 * PI - summary(&sphere(level)).volume.unwrap())
        .collect();
    let areas: Vec<f64> = (2..6)
        .map(|level| 4.0 * PI - area((&sphere(level)).into()))
        .collect();
    for e in [errors, areas] {
        assert!(e.iter().all(|&e| e > 0.0));
        for pair in e.windows(2) {
            assert!((3.5..4.5).contains(&(pair[0] / pair[1])), "{e:?}");
        }
    }
    // A torus of n by m flat quads: each horizontal section is a ring between regular n-gons, and the
    // profile is a regular m-gon, so with Pappus the volume is that of the smooth torus times sin(h)/h, for
    // h = 2π/n and h = 2π/m.
    let (big, small, rings, sides) = (2.0, 0.5, 48, 24);
    let s = summary(&torus(big, small, rings, sides));
    let shrink = |n: u32| {
        let h = TAU / f64::from(n);
        h.sin() / h
    };
    assert_eq!((s.genus(), s.components.len()), (Some(1), 1));
    let smooth = 2.0 * PI * PI * big * small * small;
    assert_close(
        s.volume.unwrap(),
        smooth * shrink(rings) * shrink(sides),
        0.02,
    );
}

#[test]
fn volume_does_not_suffer_far_from_the_origin() {
    let near = summary(&sphere(3));
    let far = summary(&moved(sphere(3), DVec3::new(4e6, -5e6, 1e6)));
    assert_close(far.volume.unwrap(), near.volume.unwrap(), 1e-8);
    for exponent in [-340, 340, 1020] {
        let scale = 2_f64.powi(exponent);
        let mut scaled = sphere(2);
        scaled.positions.iter_mut().for_each(|p| *p *= scale);
        let (s, unit) = (summary(&scaled), summary(&sphere(2)));
        // A power of two changes nothing but the exponent, until that ends.
        assert_eq!(s.area, unit.area * scale * scale);
        let volume = unit.volume.unwrap() * scale * scale * scale;
        assert_eq!(s.volume, Some(volume));
        assert_eq!(
            s.shape.unwrap().mean_edge,
            unit.shape.unwrap().mean_edge * scale
        );
    }
}

#[test]
fn pieces_are_told_apart() {
    let many = together(
        together(torus(3.0, 1.0, 6, 5), moved(sheet(3, 2), 9.0 * DVec3::X)),
        cube(),
    );
    let s = summary(&many);
    let genera: Vec<_> = s.components.iter().map(|c| c.genus()).collect();
    assert_eq!(genera, [Some(1), Some(0), Some(0)]);
    let loops: Vec<_> = s.components.iter().map(|c| c.border_loops).collect();
    assert_eq!(loops, [0, 1, 0]);
    assert_eq!(
        s.components
            .iter()
            .map(|c| c.volume.is_some())
            .collect::<Vec<_>>(),
        [true, false, true]
    );
    assert_eq!((s.volume, s.is_closed(), s.border_edges), (None, false, 10));
    assert_eq!(s.components[1].area, 6.0);
    // A hole in the torus: a second loop for the whole.
    let mut holed = many;
    holed.triangles.remove(7);
    let s = summary(&holed);
    assert_eq!((s.border_loops(), s.components[0].genus()), (2, Some(1)));
    // Nested spheres with the inner one inside out: a shell.
    let mut inner = sphere(2);
    inner.positions.iter_mut().for_each(|p| *p *= 0.5);
    inner.triangles.iter_mut().for_each(|t| t.swap(0, 1));
    let shell = summary(&together(sphere(2), inner));
    assert_close(
        shell.volume.unwrap(),
        summary(&sphere(2)).volume.unwrap() * 7.0 / 8.0,
        1e-14,
    );
}

#[test]
fn a_moebius_strip_is_one_sided() {
    let s = summary(&moebius(20));
    assert_eq!(
        (
            s.components.len(),
            s.border_loops(),
            s.euler_characteristic()
        ),
        (1, 1, 0)
    );
    assert!(!s.components[0].orientable && !s.is_oriented());
    assert_eq!((s.genus(), s.volume, s.inconsistent_edges), (None, None, 1));
    // A reversed triangle alone is not one-sided.
    let mut turned = torus(2.0, 0.5, 5, 4);
    turned.triangles[3].swap(0, 1);
    let s = summary(&turned);
    assert!(s.components[0].orientable && !s.is_oriented() && s.is_closed());
    assert_eq!((s.genus(), s.volume), (Some(1), None));
}

#[test]
fn pinched_and_branching_soups_are_named() {
    // Two tetrahedra that share a vertex: two components, each a sphere, one bad vertex.
    let mut pinched = together(tetrahedron(), moved(tetrahedron(), DVec3::ONE));
    pinched.triangles[4..]
        .as_flattened_mut()
        .iter_mut()
        .for_each(|v| {
            if v.0 == 4 {
                v.0 = 3;
            }
        });
    let s = summary(&pinched);
    assert_eq!(
        (
            s.components.len(),
            s.non_manifold_vertices,
            s.isolated_vertices
        ),
        (2, 1, 1)
    );
    assert_eq!(
        (s.genus(), s.is_closed(), s.is_vertex_manifold()),
        (Some(0), true, false)
    );
    // Three pages at one spine.
    let points = vec![DVec3::ZERO, DVec3::Z, DVec3::X, DVec3::Y, -DVec3::X];
    let book = summary(&soup(
        points,
        &[[0, 1, 2], [1, 0, 3], [0, 1, 4], [0, 1, 9], [2, 2, 3]],
    ));
    assert_eq!(
        (
            book.components.len(),
            book.non_manifold_edges,
            book.unusable_triangles
        ),
        (1, 1, 2)
    );
    assert_eq!((book.genus(), book.is_closed()), (None, false));
    let nothing = summary(&TriangleSoup::default());
    assert!(!nothing.is_closed() && nothing.volume.is_none() && nothing.shape.is_none());
    assert_eq!((nothing.area, nothing.genus()), (0.0, Some(0)));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(3000))]

    /// Counts that a manifold made of the soup must share with the mesh's own circulators.
    #[test]
    fn summaries_of_meshes_agree_with_their_connectivity(
        triangles in prop::collection::vec([0..8_u32, 0..8_u32, 0..8_u32], 0..16)
    ) {
        let any = soup((0..8).map(|i| DVec3::new(f64::from(i), f64::from(i * i), 0.0)).collect(), &triangles);
        let of_soup = summary(&any);
        let defects = pellicle_mesh::validate((&any).into());
        let count = |kind: fn(&pellicle_mesh::Defect) -> bool| defects.iter().filter(|d| kind(d)).count();
        use pellicle_mesh::Defect::*;
        prop_assert_eq!(of_soup.isolated_vertices, count(|d| matches!(d, IsolatedVertex { .. })));
        prop_assert_eq!(of_soup.non_manifold_edges, count(|d| matches!(d, NonManifoldEdge { .. })));
        prop_assert_eq!(of_soup.inconsistent_edges, count(|d| matches!(d, InconsistentEdge { .. })));
        prop_assert_eq!(of_soup.non_manifold_vertices, count(|d| matches!(d, NonManifoldVertex { .. })));
        prop_assert_eq!(of_soup.duplicate_triangles, count(|d| matches!(d, DuplicateTriangle { .. })));

        let options = SplitOptions { orientation: OrientationPolicy::Reorient };
        let (mesh, _) = TriMesh::from_soup_splitting(any, &options).unwrap();
        let s = summarize((&mesh).into()).unwrap();
        prop_assert_eq!(s.edges, mesh.edges().count());
        prop_assert_eq!(s.border_loops(), mesh.border_loops().len());
        prop_assert_eq!(s.is_closed(), mesh.is_closed() && !mesh.triangles().is_empty());
        prop_assert!(s.is_oriented() && s.is_edge_manifold() && s.is_vertex_manifold());
        // Every component of an oriented manifold has a genus: χ + b is even and at most 2.
        prop_assert!(s.genus().is_some());
        for c in &s.components {
            let even = c.euler_characteristic() + c.border_loops as i64;
            prop_assert!(even % 2 == 0 && even <= 2);
        }
        prop_assert_eq!(s.components.iter().map(|c| c.vertices).sum::<usize>(), s.vertices);
    }
}

proptest! {
    /// Orientability does not depend on how single triangles happen to face.
    #[test]
    fn orientability_survives_any_reversal(reversed in prop::collection::vec(any::<bool>(), 40)) {
        for (mut soup, orientable) in [(moebius(20), false), (torus(2.0, 0.5, 5, 4), true)] {
            for (triangle, _) in soup.triangles.iter_mut().zip(&reversed).filter(|(_, r)| **r) {
                triangle.swap(0, 1);
            }
            prop_assert_eq!(summary(&soup).components[0].orientable, orientable);
        }
    }
}

#[test]
fn vertices_that_are_not_finite_leave_the_rest_measured() {
    let mut bad = together(cube(), tetrahedron());
    bad.positions[9] = DVec3::new(f64::INFINITY, 0.0, 0.0);
    let s = summary(&bad);
    assert_eq!(s.not_finite_vertices, 1);
    assert!(s.area.is_finite() && s.components[0].volume == Some(1.0));
    assert_eq!(s.components[1].first.0, 12);
}
