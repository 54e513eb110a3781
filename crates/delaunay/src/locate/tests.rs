//! Locations and nearest vertices by brute force.

use super::*;
use crate::{
    DynamicTetrahedralization, Options, build::tests::degenerate_points, id::facet_vertices,
    tetrahedralize,
};
use dashu::rational::RBig;
use proptest::prelude::*;

/// The squared distance in rationals.
fn distance(p: DVec3, q: DVec3) -> RBig {
    let axis = |i: usize| RBig::try_from(p[i]).unwrap() - RBig::try_from(q[i]).unwrap();
    axis(0) * axis(0) + axis(1) * axis(1) + axis(2) * axis(2)
}

/// The vertices of the lowest cell that contains `p`, sorted, found among all of `tets`; `None` outside.
fn cell_of<T: Connectivity>(among: &T, tets: &[TetId], p: DVec3) -> Option<Vec<VertexId>> {
    let cells = tets.iter().filter_map(|&tet| {
        let signs = [0, 1, 2, 3].map(|corner| {
            let [a, b, c] = among.facet_points(tet, corner);
            orient3d(a, b, c, p)
        });
        let corners = among.corners(tet);
        (!signs.contains(&Sign::Negative)).then(|| {
            let mut cell: Vec<VertexId> = (0..4)
                .filter(|&corner| signs[corner] == Sign::Positive)
                .map(|corner| corners[corner])
                .collect();
            cell.sort_unstable();
            cell
        })
    });
    let mut cells: Vec<_> = cells.collect();
    cells.sort_unstable();
    cells.dedup();
    assert!(cells.len() <= 1, "{p} lies in several cells: {cells:?}");
    cells.pop()
}

/// Checks where `p` is said to lie, and what is said to be nearest.
fn check<T: Connectivity>(among: &T, tets: &[TetId], p: DVec3, hint: Option<VertexId>) {
    let location = locate(among, p, hint).unwrap();
    let expected = cell_of(among, tets, p);
    let of = |tet: TetId| among.corners(tet).to_vec();
    let found = match location {
        Location::Vertex(vertex) => Some(vec![vertex]),
        Location::Edge { tet, ends } => {
            assert!(among.has_four_points(tet) && ends.iter().all(|v| of(tet).contains(v)));
            Some(ends.to_vec())
        }
        Location::Facet(facet) => {
            let twin = among.other_side(facet);
            assert!(among.has_four_points(facet.tet()));
            assert!(facet < twin || !among.has_four_points(twin.tet()));
            Some(facet_vertices(among.corners(facet.tet()), facet.corner()).to_vec())
        }
        Location::Tetrahedron(tet) => Some(of(tet)),
        Location::Outside(tet) => {
            assert!(!among.has_four_points(tet));
            let [a, b, c] = among.facet_points(tet, 3);
            assert_eq!(
                orient3d(a, b, c, p),
                Sign::Positive,
                "{p} does not see the hull facet"
            );
            None
        }
    };
    let found = found.map(|mut cell| {
        cell.sort_unstable();
        cell
    });
    assert_eq!(found, expected, "{p} from {hint:?}");

    let mut corners: Vec<VertexId> = tets.iter().flat_map(|&tet| of(tet)).collect();
    corners.sort_unstable();
    corners.dedup();
    let nearest = nearest_of(corners.iter().map(|&v| (v, among.position(v))), p);
    assert_eq!(nearest_vertex(among, p, hint), nearest, "{p} from {hint:?}");
}

/// The nearest vertex, by rationals; of several the lexicographically lowest.
fn nearest_of(vertices: impl Iterator<Item = (VertexId, DVec3)>, p: DVec3) -> Option<VertexId> {
    let nearest = vertices.min_by(|&(_, one), &(_, other)| {
        (distance(p, one).cmp(&distance(p, other))).then_with(|| lexicographic(one, other))
    });
    nearest.map(|(vertex, _)| vertex)
}

/// Points to ask for: what is there, between it, on and off its lattice, far away.
fn question() -> impl Strategy<Value = (usize, usize, usize, u8)> {
    (0..40_usize, 0..40_usize, 0..40_usize, 0..8_u8)
}

fn answerable(points: &[DVec3], (i, j, k, kind): (usize, usize, usize, u8)) -> DVec3 {
    let at = |i: usize| points[i % points.len()];
    let (a, b, c) = (at(i), at(j), at(k));
    let p = match kind {
        0 => a,
        1 => a * 0.5 + b * 0.5,
        2 => a * 0.5 + b * 0.25 + c * 0.25,
        3 => a * 0.25 + b * 0.25 + c * 0.25 + at(i + j) * 0.25,
        4 => (a * 0.5 + b * 0.5).map(f64::next_up),
        5 => a * 2.0 - b,
        6 => a - b * 0.5 + c * 0.5,
        _ => DVec3::new(a.x, b.y, c.z),
    };
    if p.is_finite() { p } else { a }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    #[test]
    fn locations_and_nearest_vertices_are_those_of_brute_force(
        points in degenerate_points(),
        questions in prop::collection::vec((question(), prop::option::of(0..50_u32)), 1..12),
    ) {
        let Ok(whole) = tetrahedralize(&points, &Options::default()) else { return Ok(()) };
        let tets: Vec<TetId> = (0..whole.finite_count()).map(TetId::new).collect();
        for (question, hint) in questions {
            check(&whole, &tets, answerable(&points, question), hint.map(VertexId));
        }
    }

    #[test]
    fn also_after_removals(
        points in degenerate_points(),
        removed in prop::collection::vec(0..40_u32, 1..20),
        questions in prop::collection::vec((question(), prop::option::of(0..50_u32)), 1..12),
    ) {
        let mut dynamic = DynamicTetrahedralization::of_points(&points).unwrap();
        for vertex in removed.into_iter().map(VertexId) {
            if dynamic.point(vertex).is_some() {
                dynamic.remove(vertex).unwrap();
            }
        }
        let tets: Vec<TetId> = dynamic.finite_tets().collect();
        if tets.is_empty() {
            for (question, hint) in questions.into_iter().filter(|_| !points.is_empty()) {
                let (p, hint) = (answerable(&points, question), hint.map(VertexId));
                let vertices = dynamic.vertices().map(|v| (v, dynamic.position(v)));
                prop_assert_eq!(dynamic.nearest_vertex(p, hint), nearest_of(vertices, p));
                prop_assert_eq!(dynamic.locate(p, hint), None);
            }
            return Ok(());
        }
        for (question, hint) in questions {
            check(&dynamic, &tets, answerable(&points, question), hint.map(VertexId));
        }
    }
}

#[test]
fn every_kind_of_location_in_a_lattice() {
    let points: Vec<DVec3> = (0..125)
        .map(|i| DVec3::new(f64::from(i % 5), f64::from(i / 5 % 5), f64::from(i / 25)))
        .collect();
    let whole = tetrahedralize(&points, &Options::default()).unwrap();
    let tets: Vec<TetId> = (0..whole.finite_count()).map(TetId::new).collect();
    let mut kinds = [0; 5];
    for i in 0..11_i32.pow(3) {
        let p = DVec3::new(
            f64::from(i % 11),
            f64::from(i / 11 % 11),
            f64::from(i / 121),
        ) * 0.5
            - 0.5;
        for p in [
            p,
            p + DVec3::new(0.0, 0.2, 0.3),
            p + DVec3::new(0.1, 0.2, 0.3),
        ] {
            check(&whole, &tets, p, None);
            kinds[match whole.locate(p, None).unwrap() {
                Location::Vertex(_) => 0,
                Location::Edge { .. } => 1,
                Location::Facet(_) => 2,
                Location::Tetrahedron(_) => 3,
                Location::Outside(_) => 4,
            }] += 1;
        }
    }
    assert!(kinds.iter().all(|&count| count > 50), "{kinds:?}");
}

#[test]
fn the_nearest_vertex_of_points_in_a_plane() {
    let points: Vec<DVec3> = (0..25)
        .map(|i| DVec3::new(f64::from(i % 5), f64::from(i / 5), 0.5))
        .collect();
    let dynamic = DynamicTetrahedralization::of_points(&points).unwrap();
    for i in 0..11_i32.pow(2) {
        let p = DVec3::new(f64::from(i % 11), f64::from(i / 11), 0.0) * 0.5;
        let vertices = dynamic.vertices().map(|v| (v, dynamic.position(v)));
        assert_eq!(dynamic.nearest_vertex(p, None), nearest_of(vertices, p));
    }
}

#[test]
fn points_that_are_not_finite_lie_nowhere() {
    let points = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    let whole = tetrahedralize(&points, &Options::default()).unwrap();
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        assert_eq!(whole.locate(DVec3::X * bad, None), None);
        assert_eq!(
            whole.nearest_vertex(DVec3::X * bad, Some(VertexId(2))),
            None
        );
    }
}
