//! The Voronoi dual and the circulators, against their definitions.

use pellicle_delaunay::{Options, TetId, Tetrahedralization, VoronoiVertex, tetrahedralize};
use pellicle_geometry::{DVec3, VertexId};
use proptest::prelude::*;

fn random_points() -> impl Strategy<Value = Vec<DVec3>> {
    prop::collection::vec(
        prop::array::uniform3(-1.0..1.0).prop_map(DVec3::from),
        5..60,
    )
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn a_voronoi_vertex_is_as_far_from_its_corners_as_from_no_other_point(
        points in random_points()
    ) {
        let tetrahedralization = tetrahedralize(&points, &Options::default()).unwrap();
        for (tet, vertex) in tetrahedralization.voronoi_vertices() {
            let VoronoiVertex::Finite(center) = vertex else { continue };
            let radius = center.distance(points[tetrahedralization.tet(tet)[0].index()]);
            for corner in tetrahedralization.tet(tet) {
                let distance = center.distance(points[corner.index()]);
                prop_assert!((distance - radius).abs() <= 1e-7 * radius);
            }
            let nearest = points.iter().map(|p| p.distance(center)).fold(f64::MAX, f64::min);
            prop_assert!(nearest >= radius * (1.0 - 1e-7));
        }
    }

    #[test]
    fn around_an_edge_each_facet_leads_to_the_next_tetrahedron(points in random_points()) {
        let tetrahedralization = tetrahedralize(&points, &Options::default()).unwrap();
        for t in 0..tetrahedralization.finite_count() {
            let tet = TetId::new(t);
            let [from, to, x, _] = tetrahedralization.tet(tet);
            let ring: Vec<_> = tetrahedralization.around_edge(tet, from, to).unwrap().collect();
            prop_assert!(ring.len() >= 3);
            // A positive tetrahedron is left through the facet opposite its third corner.
            prop_assert_eq!(tetrahedralization.corner_of(tet, x), Some(ring[0].1.corner()));
            for (k, &(tet, out)) in ring.iter().enumerate() {
                let next = ring[(k + 1) % ring.len()].0;
                prop_assert_eq!(out.tet(), tet);
                prop_assert_eq!(tetrahedralization.twin(out).tet(), next);
                prop_assert!(tetrahedralization.corner_of(tet, from).is_some());
                prop_assert!(tetrahedralization.corner_of(tet, to).is_some());
            }
            let brute = tetrahedralization
                .tets()
                .iter()
                .filter(|corners| corners.contains(&from) && corners.contains(&to))
                .count();
            prop_assert_eq!(ring.len(), brute);
        }
    }

    #[test]
    fn around_a_vertex_stand_all_its_tetrahedra(points in random_points()) {
        let tetrahedralization = tetrahedralize(&points, &Options::default()).unwrap();
        for vertex in (0..points.len()).map(VertexId::new) {
            let mut around: Vec<_> = tetrahedralization.around_vertex(vertex).collect();
            around.sort_unstable();
            let brute: Vec<_> = (0..tetrahedralization.tets().len())
                .map(TetId::new)
                .filter(|&tet| tetrahedralization.corner_of(tet, vertex).is_some())
                .collect();
            prop_assert_eq!(around, brute);
        }
    }

    #[test]
    fn a_cell_is_bounded_exactly_off_the_hull(points in random_points()) {
        let tetrahedralization = tetrahedralize(&points, &Options::default()).unwrap();
        let infinite = &tetrahedralization.tets()[tetrahedralization.finite_count()..];
        for cell in tetrahedralization.voronoi_cells() {
            let on_hull = infinite.iter().any(|tet| tet.contains(&cell.vertex));
            prop_assert_eq!(cell.is_bounded(), !on_hull);
        }
        prop_assert_eq!(tetrahedralization.unbounded_voronoi_edges().count(), infinite.len());
    }
}

#[test]
fn the_cells_of_a_cubic_lattice_are_cubes() {
    let points: Vec<DVec3> = (0..27)
        .map(|i| DVec3::new(f64::from(i % 3), f64::from(i / 3 % 3), f64::from(i / 9)))
        .collect();
    let tetrahedralization = tetrahedralize(&points, &Options::default()).unwrap();
    let middle = tetrahedralization.voronoi_cell(VertexId(13)).unwrap();
    let mut corners: Vec<[i64; 3]> = middle
        .facets
        .iter()
        .flat_map(|facet| &facet.vertices)
        .map(|vertex| match vertex {
            VoronoiVertex::Finite(p) => (*p * 2.0).to_array().map(|x| x.round() as i64),
            VoronoiVertex::Infinite(_) => panic!("the cell is bounded"),
        })
        .collect();
    corners.sort_unstable();
    corners.dedup();
    let cube: Vec<[i64; 3]> = [1, 3]
        .into_iter()
        .flat_map(|x| {
            [1, 3]
                .into_iter()
                .flat_map(move |y| [1, 3].map(|z| [x, y, z]))
        })
        .collect();
    assert_eq!(corners, cube);
}

#[test]
fn a_duplicate_has_the_cell_of_its_representative() {
    let points = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z, DVec3::X];
    let tetrahedralization = tetrahedralize(&points, &Options::default()).unwrap();
    assert_eq!(
        tetrahedralization.voronoi_cell(VertexId(4)),
        tetrahedralization.voronoi_cell(VertexId(1))
    );
    assert_eq!(
        tetrahedralization.voronoi_cell(Tetrahedralization::INFINITE),
        None
    );
}
