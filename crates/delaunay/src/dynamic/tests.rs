//! After any changes: the tetrahedra of the points that are there.

use super::*;
use crate::{
    Error, Options,
    build::tests::{as_sets, degenerate_points},
    tetrahedralize,
};
use proptest::prelude::*;
use std::collections::BTreeMap;

/// Compares with the tetrahedralisation made at once of the points that should be there.
fn check(dynamic: &DynamicTetrahedralization, expected: &BTreeMap<VertexId, DVec3>) {
    let vertices: Vec<_> = dynamic.vertices().collect();
    assert_eq!(vertices, expected.keys().copied().collect::<Vec<_>>());
    assert_eq!(dynamic.vertex_count(), expected.len());
    for (&vertex, &point) in expected {
        assert_eq!(dynamic.point(vertex), Some(point));
    }
    assert_eq!(dynamic.validate(), [], "{expected:?}");

    let points: Vec<DVec3> = expected.values().copied().collect();
    let mut own = Vec::new();
    match (
        tetrahedralize(&points, &Options::default()),
        dynamic.to_tetrahedralization(&mut own),
    ) {
        (Ok(at_once), Ok(dynamic)) => {
            assert_eq!(as_sets(&at_once), as_sets(&dynamic), "{points:?}");
        }
        (at_once, changed) => {
            assert_eq!(at_once.err(), changed.err(), "{points:?}");
            assert_eq!(dynamic.tets().count(), 0);
        }
    }
}

/// A structure and what should be in it.
#[derive(Default)]
struct Watched {
    dynamic: DynamicTetrahedralization,
    expected: BTreeMap<VertexId, DVec3>,
}

impl Watched {
    fn insert(&mut self, point: DVec3, near: Option<VertexId>) {
        let vertex = match near {
            Some(near) => self.dynamic.insert_near(point, near).unwrap(),
            None => self.dynamic.insert(point).unwrap(),
        };
        let known = self.expected.iter().find(|(_, other)| **other == point);
        match known {
            Some((&known, _)) => assert_eq!(vertex, known),
            None => assert_eq!(self.expected.insert(vertex, point), None),
        }
    }

    /// Removes the vertex that comes at this place.
    fn remove(&mut self, place: usize) {
        let Some((&vertex, &point)) = self.expected.iter().nth(place % self.expected.len().max(1))
        else {
            return;
        };
        assert_eq!(self.dynamic.remove(vertex), Ok(point));
        assert_eq!(
            self.dynamic.remove(vertex),
            Err(Error::NotAVertex { vertex })
        );
        self.expected.remove(&vertex);
    }

    fn check(&self) {
        check(&self.dynamic, &self.expected);
    }
}

#[derive(Clone, Copy, Debug)]
enum Change {
    /// The point at this place of the pool, from near this id.
    Insert(usize, Option<u32>),
    Remove(usize),
}

fn change() -> impl Strategy<Value = Change> {
    prop_oneof![
        (any::<usize>(), prop::option::of(0..50_u32))
            .prop_map(|(place, near)| Change::Insert(place, near)),
        any::<usize>().prop_map(Change::Remove),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(128))]

    #[test]
    fn after_any_changes_the_tetrahedra_are_those_of_the_points_that_are_there(
        pool in degenerate_points(),
        start in 0..40_usize,
        changes in prop::collection::vec(change(), 0..60),
    ) {
        let start = start.min(pool.len());
        let mut watched = Watched {
            dynamic: DynamicTetrahedralization::of_points(&pool[..start]).unwrap(),
            expected: BTreeMap::new(),
        };
        for (i, &point) in pool[..start].iter().enumerate() {
            if !watched.expected.values().any(|&other| other == point) {
                watched.expected.insert(VertexId::new(i), point);
            }
        }
        watched.check();
        for change in changes {
            match change {
                Change::Insert(place, near) if !pool.is_empty() => {
                    watched.insert(pool[place % pool.len()], near.map(VertexId));
                }
                Change::Insert(..) => {}
                Change::Remove(place) => watched.remove(place),
            }
            watched.check();
        }
    }

    #[test]
    fn all_points_come_and_go(
        points in degenerate_points(),
        order in prop::collection::vec(any::<usize>(), 40),
    ) {
        let mut watched = Watched::default();
        for &point in &points {
            watched.insert(point, None);
            watched.check();
        }
        for place in order {
            watched.remove(place);
            watched.check();
        }
        prop_assert_eq!(watched.dynamic.vertex_count(), 0);
        prop_assert_eq!(watched.dynamic.dimension(), None);
        // The room is used again.
        for &point in &points {
            watched.insert(point, None);
        }
        watched.check();
    }

    #[test]
    fn a_tetrahedralisation_taken_over_is_the_same(points in degenerate_points()) {
        let Ok(at_once) = tetrahedralize(&points, &Options::default()) else { return Ok(()) };
        let dynamic = DynamicTetrahedralization::from(&at_once);
        let mut own = Vec::new();
        let back = dynamic.to_tetrahedralization(&mut own).unwrap();
        prop_assert_eq!(as_sets(&at_once), as_sets(&back));
        prop_assert_eq!(dynamic.vertex_count(), at_once.vertex_count());
        for vertex in (0..points.len()).map(VertexId::new) {
            let is_vertex = at_once.representative(vertex) == vertex;
            prop_assert_eq!(dynamic.point(vertex), is_vertex.then_some(points[vertex.index()]));
        }
    }

    #[test]
    fn circulators_and_cells_are_those_of_the_points_that_are_there(
        points in degenerate_points(),
        removed in prop::collection::vec(any::<usize>(), 0..8),
    ) {
        let mut watched = Watched::default();
        for &point in &points {
            watched.insert(point, None);
        }
        for place in removed {
            watched.remove(place);
        }
        let dynamic = &watched.dynamic;
        let mut own = Vec::new();
        let Ok(still) = dynamic.to_tetrahedralization(&mut own) else {
            prop_assert_eq!(dynamic.voronoi_cells().count(), 0);
            return Ok(());
        };
        let vertices: Vec<VertexId> = dynamic.vertices().collect();
        for (k, &vertex) in vertices.iter().enumerate() {
            let same = VertexId::new(k);
            let neighbors: Vec<_> = still.neighbors(same).iter().map(|v| vertices[v.index()]).collect();
            prop_assert_eq!(dynamic.neighbors(vertex), neighbors.clone());
            prop_assert_eq!(dynamic.around_vertex(vertex).count(), still.around_vertex(same).count());
            let (cell, still_cell) = (dynamic.voronoi_cell(vertex).unwrap(), still.voronoi_cell(same).unwrap());
            prop_assert_eq!(cell.is_bounded(), still_cell.is_bounded());
            prop_assert_eq!(cell.facets.len(), still_cell.facets.len());
            for (facet, neighbor) in cell.facets.iter().zip(neighbors) {
                prop_assert_eq!(facet.edge, [vertex, neighbor]);
                let tet = dynamic.tet_at_edge(vertex, neighbor).unwrap();
                let around: Vec<_> = dynamic.around_edge(tet, vertex, neighbor).unwrap().collect();
                prop_assert_eq!(around.len(), facet.vertices.len());
                for (i, (tet, out)) in around.iter().enumerate() {
                    prop_assert_eq!(out.tet(), *tet);
                    prop_assert_eq!(dynamic.twin(*out).tet(), around[(i + 1) % around.len()].0);
                    let corners = dynamic.tet(*tet);
                    prop_assert!(corners.contains(&vertex) && corners.contains(&neighbor));
                }
            }
        }
    }
}

fn watched(points: impl IntoIterator<Item = DVec3>) -> Watched {
    let mut watched = Watched::default();
    for point in points {
        watched.insert(point, None);
    }
    watched.check();
    watched
}

fn lattice(side: i32) -> impl Iterator<Item = DVec3> {
    (0..side.pow(3)).map(move |i| {
        DVec3::new(
            f64::from(i % side),
            f64::from(i / side % side),
            f64::from(i / side / side),
        )
    })
}

#[test]
fn each_vertex_of_a_lattice_leaves_and_comes_back() {
    let mut watched = watched(lattice(4));
    for vertex in (0..64).map(VertexId) {
        let point = watched.dynamic.remove(vertex).unwrap();
        watched.expected.remove(&vertex);
        watched.check();
        watched.insert(point, None);
        watched.check();
    }
}

#[test]
fn an_apex_over_a_plane_leaves_and_comes_back() {
    let plane: Vec<DVec3> = lattice(5).filter(|p| p.z == 0.0).collect();
    let mut watched = watched(plane.iter().copied().chain([DVec3::new(2.0, 2.0, 3.0)]));
    assert_eq!(watched.dynamic.dimension(), Some(3));
    for height in [1.0, -2.0, 5e-324, -1e300] {
        watched.remove(25);
        assert_eq!(watched.dynamic.dimension(), Some(2));
        watched.check();
        watched.insert(DVec3::new(1.0, 0.5, height), None);
        assert_eq!(watched.dynamic.dimension(), Some(3));
        watched.check();
    }
}

/// The link of the apex lies in a plane, with other points below: the hull closes without new tetrahedra.
#[test]
fn a_tip_on_a_flat_roof_leaves_and_comes_back() {
    let tip = DVec3::new(2.0, 2.0, 5.0);
    let mut watched = watched(lattice(4).chain([tip]));
    let infinite = watched.dynamic.infinite_tets().count();
    watched.remove(64);
    watched.check();
    assert_ne!(watched.dynamic.infinite_tets().count(), infinite);
    watched.insert(tip, None);
    watched.check();
    assert_eq!(watched.dynamic.infinite_tets().count(), infinite);
}

#[test]
fn a_hub_with_hundreds_of_neighbors_leaves_and_comes_back() {
    let n = 600;
    let rim = (0..n).map(|i| {
        let angle = f64::from(i) / f64::from(n) * std::f64::consts::TAU;
        DVec3::new(angle.cos(), angle.sin(), 0.01 * (7.0 * angle).sin())
    });
    let hub = DVec3::new(1e-3, 2e-3, 3e-3);
    let mut watched = watched(rim.chain([DVec3::Z, -DVec3::Z, hub]));
    assert!(watched.dynamic.neighbors(VertexId(602)).len() > 256);
    let mut around: Vec<TetId> = watched.dynamic.around_vertex(VertexId(602)).collect();
    around.sort_unstable();
    let holding = watched.dynamic.tets();
    let holding = holding.filter(|&tet| watched.dynamic.tet(tet).contains(&VertexId(602)));
    assert_eq!(around, holding.collect::<Vec<_>>());
    watched.remove(602);
    watched.check();
    watched.insert(hub, None);
    watched.check();
}

#[test]
fn two_skew_lines_lose_their_points() {
    let n = 12;
    let one = (0..n).map(|i| DVec3::new(f64::from(i), 0.0, 0.0));
    let other = (0..n).map(|i| DVec3::new(0.0, f64::from(i), 1.0));
    let mut watched = watched(one.chain(other));
    for place in [5, 17, 0, 20, 11, 3, 8, 8, 8, 8] {
        watched.remove(place);
        watched.check();
    }
}

#[test]
fn outliers_widen_the_box_and_it_shrinks_again() {
    let mut watched = watched(lattice(3).map(|p| p * 0.1));
    for outlier in [
        DVec3::X * 1e300,
        DVec3::splat(f64::MAX),
        DVec3::Y * -1e9,
        DVec3::splat(5e-324),
    ] {
        watched.insert(outlier, None);
        watched.check();
    }
    for _ in 0..4 {
        watched.remove(27);
        watched.check();
    }
    for _ in 0..40 {
        watched.insert(DVec3::splat(0.05), None);
        watched.remove(27);
    }
    watched.check();
    assert!(watched.dynamic.bounds.extent().max_element() < 1.0);
}

/// Removal reuses the room that insertion leaves and the other way round.
#[test]
fn a_thousand_points_come_and_go_without_growth() {
    let mut state = 1_u64;
    let mut random = || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    let mut watched = watched((0..1000).map(|_| DVec3::new(random(), random(), random())));
    let slots = watched.dynamic.kernel.tet_slots();
    for round in 0..3000 {
        watched.remove((random() * 1000.0) as usize);
        watched.insert(DVec3::new(random(), random(), random()), None);
        if round % 500 == 0 {
            watched.check();
        }
    }
    watched.check();
    assert!(watched.dynamic.kernel.tet_slots() < slots + slots / 10);
    assert_eq!(watched.dynamic.incident.len(), 1000);
}

/// Too many tetrahedra are refused before anything has changed.
#[test]
fn a_step_for_which_there_is_no_room_changes_nothing() {
    let mut watched = watched(lattice(3));
    let most = watched.dynamic.kernel.tet_slots();
    watched.dynamic.kernel.most_tets = most;
    let refused = |limit| Error::TooMany {
        of: "tetrahedra",
        limit,
    };

    // Insertions, until there is no room.
    let spiral = |i: i32| {
        let (sin, cos) = f64::from(i).sin_cos();
        DVec3::new(sin, cos, 0.003 + 0.01 * f64::from(i))
    };
    let full = (0..1000).find(|&i| watched.dynamic.insert(spiral(i)) == Err(refused(most)));
    let full = full.expect("there is room for no thousand points");
    for vertex in watched.dynamic.vertices().collect::<Vec<_>>() {
        let point = watched.dynamic.point(vertex).unwrap();
        watched.expected.insert(vertex, point);
    }
    assert_eq!(watched.expected.len(), 27 + full as usize);
    watched.check();
    assert_eq!(watched.dynamic.insert(spiral(full)), Err(refused(most)));
    watched.check();

    // No removal takes half of them away.
    let fewer = watched.dynamic.tets().count() / 2;
    watched.dynamic.kernel.most_tets = fewer;
    for vertex in watched.dynamic.vertices().collect::<Vec<_>>() {
        assert_eq!(watched.dynamic.remove(vertex), Err(refused(fewer)));
    }
    watched.check();

    // And what was refused works where there is room.
    watched.dynamic.kernel.most_tets = 2 * most + 1000;
    watched.insert(spiral(full), None);
    watched.remove(0);
    watched.check();
}

#[test]
fn ids_that_name_nothing_do_no_harm() {
    let mut dynamic = DynamicTetrahedralization::new();
    let none = [VertexId(0), VertexId(7), VertexId::NONE];
    for vertex in none {
        assert_eq!(dynamic.remove(vertex), Err(Error::NotAVertex { vertex }));
        assert_eq!(dynamic.point(vertex), None);
        assert_eq!(dynamic.incident(vertex), None);
        assert_eq!(dynamic.neighbors(vertex), []);
        assert_eq!(dynamic.voronoi_cell(vertex), None);
        assert_eq!(dynamic.tet_at_edge(vertex, vertex), None);
        assert_eq!(
            dynamic.around_edge(TetId(3), vertex, vertex).map(|_| ()),
            None
        );
    }
    assert_eq!(dynamic.locate(DVec3::ZERO, Some(VertexId::NONE)), None);
    assert_eq!(
        dynamic.insert(DVec3::NAN),
        Err(Error::NotFinite {
            vertex: VertexId(0)
        })
    );
    for point in [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z] {
        dynamic.insert_near(point, VertexId::NONE).unwrap();
    }
    assert_eq!(
        dynamic.insert(DVec3::INFINITY),
        Err(Error::NotFinite {
            vertex: VertexId(4)
        })
    );
    let center = dynamic
        .insert_near(DVec3::splat(0.1), VertexId(99))
        .unwrap();
    let tets: Vec<TetId> = dynamic.around_vertex(center).collect();
    dynamic.remove(center).unwrap();
    // Of the four tetrahedra at the vertex that left, three are gone.
    let gone = tets
        .iter()
        .filter(|&&tet| dynamic.around_edge(tet, VertexId(0), VertexId(1)).is_none());
    assert!(gone.count() >= 3);
}
