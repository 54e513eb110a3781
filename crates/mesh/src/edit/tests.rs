//! Creases, which only this crate sees.

use super::*;
use crate::icosphere;

/// The creases as pairs of vertices, lower first, sorted.
fn creases(editor: &MeshEditor) -> Vec<[u32; 2]> {
    for h in editor.half_edges() {
        if let Some(twin) = editor.twin_of(h) {
            assert_eq!(editor.creases[h.index()], editor.creases[twin.index()]);
        }
    }
    let mut pairs: Vec<[u32; 2]> = editor
        .edges()
        .filter(|h| editor.creases[h.index()])
        .map(|h| {
            let [a, b] = [editor.origin(h), editor.destination(h)];
            [a.min(b).0, a.max(b).0]
        })
        .collect();
    pairs.sort_unstable();
    pairs
}

#[test]
fn creases_are_handed_on() {
    let mut editor = MeshEditor::new(icosphere(1).unwrap());
    let h = HalfEdgeId(0);
    let [a, b] = editor.ends(h).unwrap();
    let twin = editor.twin_of(h).unwrap();
    editor.creases[h.index()] = true;
    editor.creases[twin.index()] = true;
    assert_eq!(creases(&editor).len(), 1);
    let m = editor.split(h, DVec3::X).unwrap();
    assert_eq!(creases(&editor), [[a.0, m.0], [b.0, m.0]]);

    // Flipping an edge there and back moves half-edges, not creases.
    for h in (0..editor.twins.len()).map(HalfEdgeId::new) {
        for _ in 0..2 {
            if !editor.creases[h.index()] && editor.can_flip(h).is_ok() {
                editor.flip(h).unwrap();
                assert_eq!(creases(&editor), [[a.0, m.0], [b.0, m.0]]);
            }
        }
    }
    // m into b: the crease is a–b again.
    let to_b = editor
        .half_edges()
        .find(|&h| editor.ends(h) == Some([m, b]))
        .unwrap();
    editor.collapse(to_b, DVec3::X).unwrap();
    assert_eq!(creases(&editor), [[a.0.min(b.0), a.0.max(b.0)]]);
    let remap = editor.compact();
    let [low, high] = [a.min(b), a.max(b)].map(|v| remap.new_of_old[v.index()].0);
    assert_eq!(creases(&editor), [[low, high]]);
}
