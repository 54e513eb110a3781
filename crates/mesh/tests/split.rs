//! Soups made manifolds: what must stay, what must be cut, and what must be said about it.

mod common;

use common::*;
use pellicle_geometry::{DVec3, VertexId};
use pellicle_mesh::{
    DropReason, MeshView, OrientationPolicy, SplitOptions, SplitReport, TriMesh, TriangleId,
    TriangleSoup, validate,
};
use proptest::prelude::*;
use std::collections::BTreeSet;

fn split(soup: &TriangleSoup, orientation: OrientationPolicy) -> (TriMesh, SplitReport) {
    let options = SplitOptions { orientation };
    let (mesh, report) = TriMesh::from_soup_splitting(soup.clone(), &options).expect("any soup");
    check(soup, &mesh, &report, orientation);
    (mesh, report)
}

/// What the report says is exactly what happened.
fn check(soup: &TriangleSoup, mesh: &TriMesh, report: &SplitReport, policy: OrientationPolicy) {
    assert!(mesh.validate().iter().all(|d| !d.prevents_manifold()));
    let reversed: BTreeSet<_> = report.reversed.iter().copied().collect();
    assert_eq!(report.triangle_origin.len(), mesh.triangles().len());
    for (triangle, &origin) in mesh.triangles().iter().zip(&report.triangle_origin) {
        let mut before = soup.triangles[origin.index()];
        if reversed.contains(&origin) {
            before.swap(1, 2);
        }
        assert_eq!(triangle.map(|v| report.vertex_origin[v.index()]), before);
    }
    for (position, origin) in mesh.positions().iter().zip(&report.vertex_origin) {
        assert_eq!(*position, soup.positions[origin.index()]);
    }
    let dropped: BTreeSet<_> = report.dropped.iter().map(|d| d.0).collect();
    let kept: BTreeSet<_> = report.triangle_origin.iter().copied().collect();
    assert!(dropped.is_disjoint(&kept));
    assert_eq!(dropped.len() + kept.len(), soup.triangles.len());
    for (v, _) in soup.positions.iter().enumerate() {
        let vertex = VertexId::new(v);
        let copies = report
            .vertex_origin
            .iter()
            .filter(|&&o| o == vertex)
            .count() as u32;
        assert_eq!(copies == 0, report.isolated.contains(&vertex));
        assert_eq!(
            copies > 1,
            report.split_vertices.contains(&(vertex, copies))
        );
    }
    if policy == OrientationPolicy::Keep {
        assert!(report.reversed.is_empty());
    }
    let manifold = validate(soup.into()).iter().all(|d| !d.prevents_manifold());
    assert_eq!(
        report.is_unchanged() && kept.len() == soup.triangles.len(),
        manifold
    );
    if manifold {
        assert_eq!(&mesh.clone().into_soup(), soup);
    }
}

#[test]
fn a_book_of_three_pages_is_cut_at_its_spine() {
    let points = vec![DVec3::ZERO, DVec3::Z, DVec3::X, DVec3::Y, -DVec3::X];
    let book = soup(points, &[[0, 1, 2], [1, 0, 3], [0, 1, 4]]);
    let (mesh, report) = split(&book, OrientationPolicy::Keep);
    assert_eq!(report.non_manifold_edges, [[VertexId(0), VertexId(1)]]);
    assert_eq!(report.split_vertices, [(VertexId(0), 3), (VertexId(1), 3)]);
    assert_eq!(mesh.positions().len(), 9);
    assert_eq!(mesh.border_loops().len(), 3);
}

#[test]
fn two_tetrahedra_that_share_an_edge_come_apart_closed() {
    let mut two = together(tetrahedron(), moved(tetrahedron(), DVec3::ONE));
    // The second gets the edge 0-1 of the first.
    for v in two.triangles.as_flattened_mut() {
        v.0 = match v.0 {
            4 => 1,
            5 => 0,
            v => v,
        };
    }
    let (mesh, report) = split(&two, OrientationPolicy::Keep);
    assert!(mesh.is_closed());
    assert_eq!(mesh.positions().len(), 8);
    assert_eq!(report.isolated, [VertexId(4), VertexId(5)]);
    assert_eq!(report.split_vertices, [(VertexId(0), 2), (VertexId(1), 2)]);
}

#[test]
fn a_few_reversed_triangles_are_turned_back() {
    for (original, wrong) in [
        (torus(2.0, 0.5, 5, 4), vec![0, 7, 8, 31]),
        (sheet(4, 4), vec![0, 1, 2]),
    ] {
        let mut turned = original.clone();
        for &t in &wrong {
            turned.triangles[t].swap(1, 2);
        }
        let (mesh, report) = split(&turned, OrientationPolicy::Reorient);
        assert_eq!(
            report.reversed,
            wrong
                .iter()
                .map(|&t| TriangleId(t as u32))
                .collect::<Vec<_>>()
        );
        assert!(report.split_vertices.is_empty() && report.inconsistent_edges.is_empty());
        let as_sets = |view: MeshView| -> Vec<BTreeSet<VertexId>> {
            view.triangles.iter().map(|t| BTreeSet::from(*t)).collect()
        };
        assert_eq!(as_sets((&mesh).into()), as_sets((&original).into()));
        let (kept, report) = split(&turned, OrientationPolicy::Keep);
        assert!(kept.border_loops().len() > 1 && !report.inconsistent_edges.is_empty());
    }
}

#[test]
fn a_moebius_strip_is_cut_once() {
    let strip = moebius(12);
    for policy in [OrientationPolicy::Keep, OrientationPolicy::Reorient] {
        let (mesh, report) = split(&strip, policy);
        assert_eq!(report.inconsistent_edges.len(), 1, "{policy:?}");
        assert_eq!(mesh.border_loops().len(), 1);
        assert_eq!(mesh.positions().len(), strip.positions.len() + 2);
        // A disk: V - E + F = 1.
        let euler = mesh.positions().len() as i64 - mesh.edges().count() as i64 + 24;
        assert_eq!(euler, 1);
    }
}

#[test]
fn what_cannot_be_kept_is_dropped_with_its_reason() {
    let mut bad = tetrahedron();
    bad.positions.push(DVec3::NAN);
    bad.triangles
        .extend([[0, 1, 8], [3, 3, 2], [0, 1, 4], [2, 0, 1]].map(|t| t.map(VertexId)));
    let (mesh, report) = split(&bad, OrientationPolicy::Keep);
    assert_eq!(mesh.into_soup(), tetrahedron());
    assert_eq!(
        report.dropped,
        [
            (TriangleId(4), DropReason::IndexOutOfRange),
            (TriangleId(5), DropReason::RepeatedVertex),
            (TriangleId(6), DropReason::NotFinite),
            (
                TriangleId(7),
                DropReason::Duplicate {
                    first: TriangleId(0)
                }
            ),
        ]
    );
}

/// Few vertices, many triangles: nearly every such soup is full of defects.
fn any_soup() -> impl Strategy<Value = TriangleSoup> {
    (1_u32..9).prop_flat_map(|n| {
        prop::collection::vec([0..n + 1, 0..n + 1, 0..n + 1], 0..20).prop_map(move |triangles| {
            soup((0..n).map(|i| DVec3::splat(i.into())).collect(), &triangles)
        })
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(8000))]

    #[test]
    fn any_soup_becomes_a_mesh(soup in any_soup(), reorient in any::<bool>()) {
        let policy = if reorient { OrientationPolicy::Reorient } else { OrientationPolicy::Keep };
        split(&soup, policy);
    }
}
