//! Edits against the plain operation on triangles, and what they must keep.

mod common;

use common::*;
use pellicle_geometry::{DVec3, VertexId};
use pellicle_mesh::{HalfEdgeId, MeshEditor, Refusal, TriMesh, TriangleSoup, icosphere};
use proptest::prelude::*;

/// The mesh of an editor; its stored connectivity must be what the triangles alone say.
fn finished(editor: &MeshEditor) -> TriMesh {
    let (mesh, _) = editor.clone().finish();
    let defects = mesh.validate();
    assert!(
        defects.iter().all(|d| !d.prevents_manifold()),
        "{defects:?}"
    );
    assert_eq!(mesh, TriMesh::try_from(mesh.clone().into_soup()).unwrap());
    mesh
}

/// The collapse done on triangles: one vertex for another, and what degenerates goes. `None` if that is no manifold,
/// or more than one vertex went: an ear of the border has no triangle left.
fn collapsed(editor: &MeshEditor, h: HalfEdgeId) -> Option<TriMesh> {
    let [a, b] = editor.ends(h)?;
    let (mesh, remap) = editor.clone().finish();
    let [a, b] = [a, b].map(|v| remap.new_of_old[v.index()]);
    let mut soup = mesh.into_soup();
    for v in soup.triangles.as_flattened_mut() {
        *v = if *v == a { b } else { *v };
    }
    soup.triangles
        .retain(|[a, b, c]| a != b && b != c && c != a);
    let remap = soup.compact();
    let one_went = remap.old_of_new.len() + 1 == remap.new_of_old.len();
    one_went.then(|| TriMesh::try_from(soup).ok()).flatten()
}

fn sorted(mesh: &TriMesh) -> Vec<[VertexId; 3]> {
    let mut triangles: Vec<_> = mesh
        .triangles()
        .iter()
        .map(|&[a, b, c]| {
            let least = a.min(b).min(c);
            if a == least {
                [a, b, c]
            } else if b == least {
                [b, c, a]
            } else {
                [c, a, b]
            }
        })
        .collect();
    triangles.sort_unstable();
    triangles
}

/// Collapses if and only if the plain operation gives a manifold of the same topology, and gives the same.
fn check_collapse(editor: &mut MeshEditor, h: HalfEdgeId) {
    let before = topology(&finished(editor));
    let expected = collapsed(editor, h).filter(|mesh| topology(mesh) == before);
    let to = editor
        .ends(h)
        .and_then(|[_, b]| editor.position(b))
        .unwrap();
    let kept = sorted(&finished(editor));
    match (editor.collapse(h, to), expected) {
        (Ok(b), Some(expected)) => {
            assert_eq!(editor.position(b), Some(to));
            assert_eq!(editor.ends(h), None);
            assert_eq!(sorted(&finished(editor)), sorted(&expected));
        }
        (Err(Refusal::Link(refused)), None) => {
            assert_eq!(refused, h);
            assert_eq!(sorted(&finished(editor)), kept);
        }
        (got, expected) => panic!("{got:?}, but the plain operation gives {expected:?}"),
    }
}

fn check_flip(editor: &mut MeshEditor, h: HalfEdgeId) {
    let before = finished(editor);
    let [a, b] = editor.ends(h).unwrap();
    let border = editor.twin(h).is_none();
    match editor.flip(h) {
        Ok(()) => {
            let after = finished(editor);
            assert_eq!(topology(&after), topology(&before));
            assert_eq!(after.edges().count(), before.edges().count());
            // There and back: the other diagonal, then the same triangles.
            let [d, c] = editor.ends(h).unwrap();
            assert!(d != a && d != b && c != a && c != b);
            let mut back = editor.clone();
            back.flip(h).unwrap();
            assert_eq!(sorted(&finished(&back)), sorted(&before));
        }
        Err(Refusal::Border(_)) => assert!(border),
        Err(Refusal::EdgeExists(c, d)) => {
            let mesh = before;
            // No edit has left a gap in these tests' ids if the vertices map to themselves.
            let (_, remap) = editor.clone().finish();
            let [c, d] = [c, d].map(|v| remap.new_of_old[v.index()]);
            assert!(
                mesh.half_edge_between(c, d)
                    .or(mesh.half_edge_between(d, c))
                    .is_some()
            );
        }
        Err(other) => panic!("{other}"),
    }
}

fn check_split(editor: &mut MeshEditor, h: HalfEdgeId) {
    let before = finished(editor);
    let [a, b] = editor.ends(h).unwrap();
    let inner = editor.twin(h).is_some();
    let middle = (editor.position(a).unwrap() + editor.position(b).unwrap()) / 2.0;
    let m = editor.split(h, middle).unwrap();
    assert_eq!(editor.ends(h), Some([a, m]));
    assert_eq!(editor.position(m), Some(middle));
    let after = finished(editor);
    assert_eq!(topology(&after), topology(&before));
    assert_eq!(after.positions().len(), before.positions().len() + 1);
    assert_eq!(
        after.triangles().len(),
        before.triangles().len() + 1 + usize::from(inner)
    );
}

fn meshes() -> Vec<TriangleSoup> {
    vec![
        soup(vec![DVec3::ZERO, DVec3::X, DVec3::Y], &[[0, 1, 2]]),
        sheet(1, 1),
        sheet(4, 1),
        sheet(3, 3),
        tetrahedron(),
        cube(),
        sphere(1),
        torus(2.0, 0.5, 4, 3),
        together(torus(2.0, 0.5, 3, 3), sheet(2, 2)),
        ring(),
        cone(),
    ]
}

/// A flat ring between two triangles: two borders of three edges.
fn ring() -> TriangleSoup {
    let at = |r: f64, i: u32| {
        let (sin, cos) = (f64::from(i) * std::f64::consts::TAU / 3.0).sin_cos();
        DVec3::new(r * cos, r * sin, 0.0)
    };
    let positions = (0..3)
        .map(|i| at(2.0, i))
        .chain((0..3).map(|i| at(1.0, i)))
        .collect();
    let triangles: Vec<[u32; 3]> = (0..3)
        .flat_map(|i| {
            let j = (i + 1) % 3;
            [[i, j, 3 + j], [i, 3 + j, 3 + i]]
        })
        .collect();
    soup(positions, &triangles)
}

/// A vertex of valence three in the middle of a triangle.
fn cone() -> TriangleSoup {
    soup(
        vec![
            DVec3::ZERO,
            3.0 * DVec3::X,
            3.0 * DVec3::Y,
            DVec3::new(1.0, 1.0, 0.0),
        ],
        &[[0, 1, 3], [1, 2, 3], [2, 0, 3]],
    )
}

#[test]
fn every_edit_of_every_edge() {
    for soup in meshes() {
        let mesh = mesh(soup);
        for h in mesh.half_edge_ids() {
            check_collapse(&mut MeshEditor::new(mesh.clone()), h);
            check_flip(&mut MeshEditor::new(mesh.clone()), h);
            check_split(&mut MeshEditor::new(mesh.clone()), h);
        }
    }
}

#[test]
fn what_is_minimal_does_not_collapse() {
    for soup in [
        tetrahedron(),
        soup(vec![DVec3::ZERO, DVec3::X, DVec3::Y], &[[0, 1, 2]]),
    ] {
        let mut editor = MeshEditor::new(mesh(soup));
        for h in editor.half_edges().collect::<Vec<_>>() {
            assert_eq!(editor.collapse(h, DVec3::ZERO), Err(Refusal::Link(h)));
        }
    }
    // Everything collapses to a tetrahedron, and no further.
    let mut editor = MeshEditor::new(icosphere(2).unwrap());
    let mut shrunk = true;
    while shrunk {
        shrunk = false;
        for h in editor.half_edges().collect::<Vec<_>>() {
            shrunk |= editor.collapse(h, DVec3::ZERO).is_ok();
        }
    }
    assert_eq!(finished(&editor).triangles().len(), 4);
}

#[test]
fn nothing_is_done_to_what_is_not_there() {
    let mut editor = MeshEditor::new(mesh(sphere(1)));
    let gone = HalfEdgeId(5);
    editor.collapse(gone, DVec3::ZERO).unwrap();
    for h in [gone, HalfEdgeId(100_000), HalfEdgeId::NONE] {
        assert_eq!(editor.collapse(h, DVec3::ZERO), Err(Refusal::NoHalfEdge(h)));
        assert_eq!(editor.split(h, DVec3::ZERO), Err(Refusal::NoHalfEdge(h)));
        assert_eq!(editor.flip(h), Err(Refusal::NoHalfEdge(h)));
        assert_eq!((editor.ends(h), editor.twin(h)), (None, None));
    }
    for v in [VertexId(100_000), VertexId::NONE] {
        assert_eq!(editor.position(v), None);
        assert_eq!(
            editor.set_position(v, DVec3::ZERO),
            Err(Refusal::NoVertex(v))
        );
    }
    let before = finished(&editor);
    let far = DVec3::new(f64::INFINITY, 0.0, 0.0);
    let h = editor.edges().next().unwrap();
    assert_eq!(editor.collapse(h, far), Err(Refusal::NotFinite(far)));
    assert_eq!(editor.split(h, far), Err(Refusal::NotFinite(far)));
    assert_eq!(
        editor.set_position(VertexId(0), far),
        Err(Refusal::NotFinite(far))
    );
    assert_eq!(finished(&editor), before);
}

#[test]
fn the_remap_leads_from_the_editor_to_the_mesh() {
    let mut editor = MeshEditor::new(mesh(sphere(1)));
    for h in [3, 30] {
        let h = HalfEdgeId(h);
        let [_, b] = editor.ends(h).unwrap();
        let to = editor.position(b).unwrap();
        editor.collapse(h, to).unwrap();
    }
    editor.split(HalfEdgeId(50), DVec3::ONE).unwrap();
    let positions: Vec<_> = (0..19).map(|v| editor.position(VertexId(v))).collect();
    let (mesh, remap) = editor.finish();
    assert_eq!(remap.new_of_old.len(), 19);
    assert_eq!(remap.old_of_new.len(), 17);
    for (v, position) in positions.into_iter().enumerate() {
        let new = remap.new_of_old[v].some();
        assert_eq!(new.map(|v| mesh.position(v)), position);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    #[test]
    fn any_sequence_of_edits(
        which in 0..meshes().len(),
        edits in prop::collection::vec((0..3_u8, any::<prop::sample::Index>()), 1..60),
    ) {
        let mut editor = MeshEditor::new(mesh(meshes().swap_remove(which)));
        let before = topology(&finished(&editor));
        for (kind, index) in edits {
            let half_edges: Vec<_> = editor.half_edges().collect();
            let h = *index.get(&half_edges);
            match kind {
                0 => check_split(&mut editor, h),
                1 => check_flip(&mut editor, h),
                _ => check_collapse(&mut editor, h),
            }
        }
        prop_assert_eq!(topology(&finished(&editor)), before);
    }
}
