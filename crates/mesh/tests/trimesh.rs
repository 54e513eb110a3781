//! The mesh against brute force over its triangles.

mod common;

use common::*;
use pellicle_geometry::{DVec3, VertexId};
use pellicle_mesh::{Defect, HalfEdgeId, MeshError, TriMesh, TriangleId, TriangleSoup, validate};
use proptest::prelude::*;
use std::collections::BTreeSet;

/// Every query of the connectivity, recomputed from the triangles alone.
fn check_connectivity(mesh: &TriMesh) {
    assert!(mesh.validate().iter().all(|d| !d.prevents_manifold()));
    let directed = |h: HalfEdgeId| (mesh.origin(h), mesh.destination(h));
    for h in mesh.half_edge_ids() {
        let (a, b) = directed(h);
        assert_eq!(mesh.triangles()[h.triangle().index()][h.corner()], a);
        assert_eq!(h.next().previous(), h);
        assert_eq!(h.next().next().next(), h);
        assert_eq!(directed(h.next()).0, b);
        let twin = mesh.half_edge_ids().find(|&g| directed(g) == (b, a));
        assert_eq!(mesh.twin(h), twin);
        assert_eq!(mesh.half_edge_between(a, b), Some(h));
    }
    for v in mesh.vertex_ids() {
        let leaving: BTreeSet<_> = mesh
            .half_edge_ids()
            .filter(|&h| mesh.origin(h) == v)
            .collect();
        let found: Vec<_> = mesh.outgoing_half_edges(v).collect();
        assert_eq!(found.len(), leaving.len());
        assert_eq!(found.iter().copied().collect::<BTreeSet<_>>(), leaving);
        for pair in found.windows(2) {
            assert_eq!(
                mesh.destination(pair[1]),
                mesh.origin(pair[0].previous()),
                "counter-clockwise"
            );
        }
        let around: BTreeSet<VertexId> = mesh
            .half_edge_ids()
            .filter_map(|h| match directed(h) {
                (a, b) if a == v => Some(b),
                (a, b) if b == v => Some(a),
                _ => None,
            })
            .collect();
        let neighbors: Vec<_> = mesh.neighbors(v).collect();
        assert_eq!(neighbors.len(), around.len());
        assert_eq!(neighbors.into_iter().collect::<BTreeSet<_>>(), around);
        let on_border = mesh
            .half_edge_ids()
            .any(|h| mesh.twin(h).is_none() && (directed(h).0 == v || directed(h).1 == v));
        assert_eq!(mesh.is_border_vertex(v), on_border);
        assert_eq!(on_border, around.len() == leaving.len() + 1);
    }
    let mut border: Vec<_> = mesh.border_loops().concat();
    border.sort();
    let without_twin: Vec<_> = mesh
        .half_edge_ids()
        .filter(|&h| mesh.twin(h).is_none())
        .collect();
    assert_eq!(border, without_twin);
    assert_eq!(mesh.is_closed(), border.is_empty());
    for chain in mesh.border_loops() {
        for (i, &h) in chain.iter().enumerate() {
            assert_eq!(
                mesh.destination(h),
                mesh.origin(chain[(i + 1) % chain.len()])
            );
        }
    }
}

#[test]
fn known_meshes_have_their_connectivity() {
    for soup in [
        tetrahedron(),
        cube(),
        sphere(1),
        torus(2.0, 0.5, 4, 3),
        sheet(3, 2),
        sheet(1, 1),
    ] {
        let mut mesh = mesh(soup);
        check_connectivity(&mesh);
        let before = mesh.clone();
        mesh.reverse_orientation();
        check_connectivity(&mesh);
        assert_eq!(mesh, TriMesh::try_from(mesh.clone().into_soup()).unwrap());
        mesh.reverse_orientation();
        assert_eq!(mesh, before);
    }
    check_connectivity(&TriMesh::default());
    assert_eq!(mesh(sheet(3, 2)).border_loops()[0].len(), 10);
    assert_eq!(
        mesh(together(sheet(1, 1), sheet(2, 2)))
            .border_loops()
            .len(),
        2
    );
}

fn defects_of(soup: TriangleSoup) -> Vec<Defect> {
    let defects = validate((&soup).into());
    match TriMesh::try_from(soup.clone()) {
        Ok(mesh) => {
            assert!(
                defects.iter().all(|d| !d.prevents_manifold()),
                "{defects:?}"
            );
            assert_eq!(mesh.into_soup(), soup);
        }
        Err(MeshError::NotManifold {
            soup: back,
            defects: named,
        }) => {
            // NaN differs from itself: compare what is printed.
            assert_eq!(format!("{back:?}"), format!("{soup:?}"));
            assert_eq!(named, defects);
            assert!(defects.iter().any(|d| d.prevents_manifold()));
        }
        Err(other) => panic!("{other}"),
    }
    defects
}

#[test]
fn each_defect_is_named() {
    let t = TriangleId;
    let v = VertexId;
    let five = || vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z, DVec3::ONE];
    let cases = [
        (
            vec![[0, 1, 2], [0, 1, 9], [3, 4, 0]],
            vec![
                Defect::IndexOutOfRange {
                    triangle: t(1),
                    vertex: v(9),
                },
                Defect::NonManifoldVertex {
                    vertex: v(0),
                    umbrellas: 2,
                },
            ],
        ),
        (
            vec![
                [0, 1, 2],
                [2, 1, 3],
                [3, 1, 4],
                [3, 3, 1],
                [2, 4, 2],
                [0, 4, 4],
            ],
            vec![
                Defect::RepeatedVertex {
                    triangle: t(3),
                    vertex: v(3),
                },
                Defect::RepeatedVertex {
                    triangle: t(4),
                    vertex: v(2),
                },
                Defect::RepeatedVertex {
                    triangle: t(5),
                    vertex: v(4),
                },
            ],
        ),
        (
            vec![[0, 1, 2], [1, 0, 3], [0, 1, 4]],
            vec![Defect::NonManifoldEdge {
                edge: [v(0), v(1)],
                triangles: vec![t(0), t(1), t(2)],
            }],
        ),
        (
            vec![[0, 1, 2], [0, 1, 3]],
            vec![
                Defect::InconsistentEdge {
                    edge: [v(0), v(1)],
                    triangles: [t(0), t(1)],
                },
                Defect::IsolatedVertex { vertex: v(4) },
            ],
        ),
        (
            vec![[0, 1, 2], [0, 3, 4]],
            vec![Defect::NonManifoldVertex {
                vertex: v(0),
                umbrellas: 2,
            }],
        ),
        (
            vec![[0, 1, 2], [3, 4, 2], [1, 0, 2]],
            vec![
                Defect::DuplicateTriangle {
                    triangle: t(2),
                    first: t(0),
                },
                Defect::NonManifoldVertex {
                    vertex: v(2),
                    umbrellas: 2,
                },
            ],
        ),
        (
            vec![[0, 1, 2], [1, 2, 0], [2, 0, 3], [2, 3, 4]],
            vec![
                Defect::DuplicateTriangle {
                    triangle: t(1),
                    first: t(0),
                },
                Defect::NonManifoldEdge {
                    edge: [v(0), v(2)],
                    triangles: vec![t(0), t(1), t(2)],
                },
                Defect::InconsistentEdge {
                    edge: [v(0), v(1)],
                    triangles: [t(0), t(1)],
                },
                Defect::InconsistentEdge {
                    edge: [v(1), v(2)],
                    triangles: [t(0), t(1)],
                },
            ],
        ),
    ];
    for (triangles, expected) in cases {
        assert_eq!(
            defects_of(soup(five(), &triangles)),
            expected,
            "{triangles:?}"
        );
    }
    // Two triangles back to back: every edge and vertex is manifold.
    let back_to_back = soup(five()[..3].to_vec(), &[[0, 1, 2], [0, 2, 1]]);
    let duplicate = Defect::DuplicateTriangle {
        triangle: t(1),
        first: t(0),
    };
    assert_eq!(defects_of(back_to_back), [duplicate]);
    let mut not_finite = tetrahedron();
    not_finite.positions[2].y = f64::NAN;
    assert_eq!(defects_of(not_finite), [Defect::NotFinite { vertex: v(2) }]);
}

#[test]
fn zero_area_is_exact() {
    let p = |x: f64, y: f64, z: f64| DVec3::new(x, y, z);
    // Doubling is exact, so 0, (0.1, 0.3), (0.2, 0.6) lie on a line; as doubles 3 * 0.1 > 0.3, so
    // 0, (0.1, 0.3), (0.3, 0.9) do not.
    let thin = soup(
        vec![p(0.0, 0.0, 1.0), p(0.1, 0.3, 1.0), p(0.2, 0.6, 1.0)],
        &[[0, 1, 2]],
    );
    let thicker = soup(
        vec![p(0.0, 0.0, 1.0), p(0.1, 0.3, 1.0), p(0.3, 0.9, 1.0)],
        &[[0, 1, 2]],
    );
    let point = soup(vec![DVec3::ONE; 3], &[[0, 1, 2]]);
    let zero = [Defect::ZeroArea {
        triangle: TriangleId(0),
    }];
    assert_eq!(defects_of(thin), zero);
    assert_eq!(defects_of(thicker), []);
    assert_eq!(defects_of(point), zero);
}

#[test]
fn positions_are_checked() {
    let mut mesh = mesh(tetrahedron());
    let before = mesh.clone();
    assert!(matches!(
        mesh.set_positions(vec![DVec3::ZERO; 3]),
        Err(MeshError::PositionCount {
            positions: 3,
            vertices: 4
        })
    ));
    let bad = vec![DVec3::ZERO, DVec3::INFINITY, DVec3::ZERO, DVec3::NAN];
    assert!(matches!(
        mesh.set_positions(bad),
        Err(MeshError::NotFinite {
            vertex: VertexId(1),
            ..
        })
    ));
    assert_eq!(mesh, before);
    mesh.set_positions(vec![DVec3::X; 4]).unwrap();
    assert_eq!(mesh.position(VertexId(3)), DVec3::X);
}

#[test]
fn compaction_remaps() {
    let mut soup = moved(tetrahedron(), DVec3::X);
    soup.positions.insert(2, DVec3::NAN);
    for v in soup.triangles.as_flattened_mut() {
        v.0 += u32::from(v.0 >= 2);
    }
    soup.positions.push(DVec3::ZERO);
    let remap = soup.compact();
    assert_eq!(soup, moved(tetrahedron(), DVec3::X));
    assert_eq!(remap.old_of_new, [0, 1, 3, 4].map(VertexId));
    assert_eq!(remap.new_of_old[3], VertexId(2));
    assert_eq!(remap.new_of_old[2], VertexId::NONE);
    assert_eq!(
        remap.apply(&["a", "b", "c", "d", "e", "f"]),
        ["a", "b", "d", "e"]
    );
}

/// Few vertices, many triangles: nearly every such soup is full of defects.
pub fn any_soup() -> impl Strategy<Value = TriangleSoup> {
    (1_u32..8).prop_flat_map(|n| {
        (
            prop::collection::vec((0..3_u8, 0..3_u8, 0..3_u8), n as usize),
            prop::collection::vec([0..n + 1, 0..n + 1, 0..n + 1], 0..10),
        )
            .prop_map(|(points, triangles)| {
                let positions = points
                    .iter()
                    .map(|&(x, y, z)| DVec3::new(x.into(), y.into(), z.into()));
                soup(positions.collect(), &triangles)
            })
    })
}

/// The definition of each defect of connectivity, as directly as it can be said.
fn brute_force(soup: &TriangleSoup) -> Vec<Defect> {
    let n = soup.positions.len() as u32;
    let mut defects = Vec::new();
    let usable: Vec<(TriangleId, [VertexId; 3])> = (0..soup.triangles.len())
        .map(|t| (TriangleId(t as u32), soup.triangles[t]))
        .filter(|(_, [a, b, c])| a != b && b != c && c != a && [a, b, c].iter().all(|v| v.0 < n))
        .collect();
    let set = |t: [VertexId; 3]| BTreeSet::from(t);
    for (i, &(triangle, t)) in usable.iter().enumerate() {
        if let Some(&(first, _)) = usable[..i].iter().find(|(_, s)| set(*s) == set(t)) {
            defects.push(Defect::DuplicateTriangle { triangle, first });
        }
    }
    let forward = |t: [VertexId; 3], a, b| (0..3).any(|i| t[i] == a && t[(i + 1) % 3] == b);
    for a in (0..n).map(VertexId) {
        for b in (a.0 + 1..n).map(VertexId) {
            let along: Vec<_> = usable
                .iter()
                .filter(|(_, t)| t.contains(&a) && t.contains(&b))
                .collect();
            match along[..] {
                [] | [_] => {}
                [(s, p), (t, q)] => {
                    if forward(*p, a, b) == forward(*q, a, b) {
                        defects.push(Defect::InconsistentEdge {
                            edge: [a, b],
                            triangles: [*s, *t],
                        });
                    }
                }
                _ => defects.push(Defect::NonManifoldEdge {
                    edge: [a, b],
                    triangles: along.iter().map(|x| x.0).collect(),
                }),
            }
        }
        // Grow pieces of the triangles at `a` that share a second vertex.
        let mut left: Vec<_> = usable
            .iter()
            .filter(|(_, t)| t.contains(&a))
            .map(|x| x.1)
            .collect();
        let mut pieces = 0;
        while let Some(seed) = left.pop() {
            pieces += 1;
            let mut piece = vec![seed];
            while let Some(at) = left.iter().position(|t| {
                piece
                    .iter()
                    .any(|s| set(*s).intersection(&set(*t)).count() >= 2)
            }) {
                piece.push(left.swap_remove(at));
            }
        }
        match pieces {
            0 => defects.push(Defect::IsolatedVertex { vertex: a }),
            1 => {}
            umbrellas => defects.push(Defect::NonManifoldVertex {
                vertex: a,
                umbrellas,
            }),
        }
    }
    defects.sort();
    defects
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4000))]

    #[test]
    fn defects_equal_brute_force(soup in any_soup()) {
        let found: Vec<_> = defects_of(soup.clone())
            .into_iter()
            .filter(|d| !matches!(
                d,
                Defect::ZeroArea { .. } | Defect::IndexOutOfRange { .. } | Defect::RepeatedVertex { .. }
            ))
            .collect();
        prop_assert_eq!(found, brute_force(&soup));
        if let Ok(mesh) = TriMesh::try_from(soup) {
            check_connectivity(&mesh);
        }
    }

    #[test]
    fn part_of_a_torus_is_a_mesh_exactly_when_brute_force_says_so(
        keep in prop::collection::vec(prop::bool::weighted(0.8), 24)
    ) {
        let mut part = torus(2.0, 0.5, 4, 3);
        let mut keep = keep.into_iter();
        part.triangles.retain(|_| keep.next().unwrap());
        part.compact();
        prop_assert_eq!(TriMesh::try_from(part.clone()).is_ok(), brute_force(&part).is_empty());
        if let Ok(mesh) = TriMesh::try_from(part) {
            check_connectivity(&mesh);
        }
    }
}
