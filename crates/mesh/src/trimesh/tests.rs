//! The validator finds connectivity that was broken from inside.

use super::*;

/// Two triangles, 0-1-2 and 0-2-3.
fn square() -> TriMesh {
    let soup = TriangleSoup {
        positions: vec![DVec3::ZERO, DVec3::X, DVec3::X + DVec3::Y, DVec3::Y],
        triangles: vec![[0, 1, 2].map(VertexId), [0, 2, 3].map(VertexId)],
    };
    TriMesh::try_from(soup).expect("a manifold")
}

#[test]
fn broken_connectivity_is_named() {
    let good = square();
    assert_eq!(good.validate(), []);
    let [inner, back] = [HalfEdgeId(2), HalfEdgeId(3)];
    assert_eq!(
        (good.twin(inner), good.twin(back)),
        (Some(back), Some(inner))
    );

    let broken = |half_edge| Defect::BrokenTwin { half_edge };
    let mut one_missing = good.clone();
    one_missing.connectivity.twins[2] = HalfEdgeId::NONE;
    let defects = one_missing.validate();
    assert!(
        defects.contains(&broken(inner)) && defects.contains(&broken(back)),
        "{defects:?}"
    );

    let mut both_missing = good.clone();
    both_missing.connectivity.twins[2] = HalfEdgeId::NONE;
    both_missing.connectivity.twins[3] = HalfEdgeId::NONE;
    let defects = both_missing.validate();
    assert!(
        defects.contains(&broken(inner)) && defects.contains(&broken(back)),
        "{defects:?}"
    );

    for wrong in [HalfEdgeId(0), HalfEdgeId(4), HalfEdgeId(77)] {
        let mut mesh = good.clone();
        mesh.connectivity.twins[2] = wrong;
        assert!(mesh.validate().contains(&broken(inner)), "{wrong:?}");
    }

    for v in good.vertex_ids() {
        for wrong in good.half_edge_ids().chain([HalfEdgeId::NONE]) {
            let mut mesh = good.clone();
            mesh.connectivity.outgoing[v.index()] = wrong;
            let expected = match good.outgoing(v) == wrong {
                true => vec![],
                false => vec![Defect::BrokenOutgoing { vertex: v }],
            };
            assert_eq!(mesh.validate(), expected);
        }
    }
}
