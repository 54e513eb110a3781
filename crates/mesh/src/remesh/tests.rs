//! The checks that keep the surface unfolded, each at its limit.

use super::geometry::score;
use super::*;
use crate::{TriMesh, TriangleId, TriangleSoup, icosphere};

fn editor(positions: Vec<DVec3>, triangles: &[[u32; 3]]) -> MeshEditor {
    let triangles = triangles.iter().map(|t| t.map(VertexId)).collect();
    let soup = TriangleSoup {
        positions,
        triangles,
    };
    MeshEditor::new(TriMesh::try_from(soup).expect("a manifold"))
}

fn on_circle(degrees: f64) -> DVec3 {
    let (sin, cos) = degrees.to_radians().sin_cos();
    DVec3::new(cos, sin, 0.0)
}

/// Vertex 0 in the middle of six others at distance one.
fn hexagon() -> MeshEditor {
    let around = (0..6).map(|i| on_circle(60.0 * f64::from(i)));
    let positions = std::iter::once(DVec3::ZERO).chain(around).collect();
    let triangles: Vec<[u32; 3]> = (0..6).map(|i| [0, 1 + i, 1 + (i + 1) % 6]).collect();
    editor(positions, &triangles)
}

#[test]
fn scores_at_the_bounds_and_at_their_ends() {
    let triangle = |apex: f64| [DVec3::ZERO, DVec3::X, on_circle(apex)];
    assert!((score(triangle(60.0)) - 3.0).abs() < 1e-14);
    // 30° between equal sides: the other angles are 75°. 120° between them: the others are 30°.
    for at_bounds in [30.0, 120.0] {
        assert!((score(triangle(at_bounds)) - 1.0).abs() < 1e-14);
    }
    assert!(score(triangle(29.0)) < 1.0 && score(triangle(121.0)) < 1.0);
    assert!(score(triangle(31.0)) > 1.0 && score(triangle(119.0)) > 1.0);
    assert!(score(triangle(180.0)).abs() < 1e-14);
    assert_eq!(score([DVec3::ONE; 3]), 0.0);
}

#[test]
fn a_move_may_not_turn_or_flatten_a_triangle() {
    let hexagon = hexagon();
    let may = |p: DVec3| hexagon.may_move(VertexId(0), p, &[]);
    // The sides are √3/2 from the middle.
    let side = on_circle(30.0) * 0.75_f64.sqrt();
    assert!(may(DVec3::ZERO) && may(side * 0.9));
    assert!(!may(side * 0.999), "flat");
    assert!(!may(side * 1.001) && !may(side * 2.0), "over the side");
    // Upward: the normals lean by the angle whose tangent is the height over √3/2.
    let height = |degrees: f64| DVec3::Z * (degrees.to_radians().tan() * 0.75_f64.sqrt());
    assert!(may(height(59.0)) && may(-height(59.0)));
    assert!(!may(height(61.0)) && !may(-height(61.0)));
    // What goes is not asked.
    let gone = hexagon
        .around(VertexId(0))
        .map(HalfEdgeId::triangle)
        .next()
        .unwrap();
    assert!(hexagon.may_move(VertexId(0), side * 1.5, &[gone]));
}

#[test]
fn a_triangle_without_area_is_judged_by_its_neighbours() {
    let mut hexagon = hexagon();
    // On one side, so that one triangle has no area; and back up, the right way or over the side.
    let side = on_circle(30.0) * 0.75_f64.sqrt();
    hexagon.positions[0] = side;
    assert!(hexagon.is_flat(TriangleId(0)));
    assert!(hexagon.may_move(VertexId(0), side * 0.5, &[]));
    assert!(!hexagon.may_move(VertexId(0), side * 1.5, &[]));
}

/// Triangles 0-1-2 and 1-0-3 over the edge 0-1 of length 2, the second turned down by an angle.
fn hinge(degrees: f64, apices: [f64; 2]) -> MeshEditor {
    let (sin, cos) = degrees.to_radians().sin_cos();
    let positions = vec![
        -DVec3::X,
        DVec3::X,
        DVec3::new(apices[0], 1.0, 0.0),
        DVec3::new(apices[1], -cos, -sin),
    ];
    editor(positions, &[[0, 1, 2], [1, 0, 3]])
}

#[test]
fn a_flip_may_not_fold() {
    let may = |degrees, apices| hinge(degrees, apices).flip_stays_open(HalfEdgeId(0));
    assert!(may(0.0, [0.0, 0.0]) && may(40.0, [0.0, 0.0]));
    // Over a short edge the new triangles bend more than the old ones: by 32° and by 118°.
    let over_short = |degrees| {
        let mut hinge = hinge(degrees, [0.0, 0.0]);
        hinge.positions[0] *= 0.3;
        hinge.positions[1] *= 0.3;
        hinge.flip_stays_open(HalfEdgeId(0))
    };
    assert!(over_short(10.0) && !over_short(60.0));
    // Bent far already, and less so after the flip.
    assert!(may(100.0, [0.0, 0.0]));
    // No convex quadrilateral: the other diagonal passes outside.
    assert!(!may(0.0, [3.0, 3.0]) && !may(0.0, [3.0, 1.0]));
    assert!(
        !hinge(0.0, [0.0; 2]).flip_stays_open(HalfEdgeId(1)),
        "a border"
    );
    // A cap without area on a good triangle may flip, as its normal means nothing.
    let mut cap = hinge(0.0, [0.0, 0.0]);
    cap.positions[3] = DVec3::ZERO;
    assert!(cap.flip_stays_open(HalfEdgeId(0)));
}

#[test]
fn a_flip_may_not_fold_onto_its_neighbours() {
    // On the side 1-2 of a hinge a wing that rises by an angle. The flip leans the triangle there inward: towards a
    // wing that rises, and away from one that hangs.
    let winged = |degrees: f64| {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let mut positions = hinge(40.0, [0.0, 0.0]).positions;
        let side = 0.5 * (positions[1] + positions[2]);
        positions.push(side + (DVec3::X + DVec3::Y).normalize() * cos + DVec3::Z * sin);
        editor(positions, &[[0, 1, 2], [1, 0, 3], [2, 1, 4]]).flip_stays_open(HalfEdgeId(0))
    };
    assert!(winged(0.0) && winged(80.0) && winged(-40.0));
    assert!(!winged(-80.0));
}

#[test]
fn a_move_may_not_fold_the_edge_across() {
    // Vertex 2 above the edge 0-1; beyond it the other triangle, level or bent.
    let stays = |degrees: f64, to: DVec3| {
        hinge(degrees, [0.0; 2]).opposite_edges_stay_open(VertexId(2), to, &[])
    };
    let lifted = |degrees: f64| {
        let (sin, cos) = f64::to_radians(degrees).sin_cos();
        DVec3::new(0.0, cos, sin)
    };
    assert!(stays(0.0, lifted(90.0)) && stays(0.0, lifted(-90.0)));
    assert!(!stays(0.0, lifted(110.0)) && !stays(0.0, lifted(-110.0)));
    // Folded before: it may open, not close.
    assert!(stays(120.0, lifted(0.0)) && stays(120.0, lifted(10.0)));
    assert!(!stays(120.0, lifted(-10.0)));
}

#[test]
fn a_vertex_is_projected_to_its_own_side_of_a_wall() {
    // Two sheets a tenth apart that face away from each other.
    let at = |z: f64| {
        [
            DVec3::new(-1.0, -1.0, z),
            DVec3::new(1.0, -1.0, z),
            DVec3::new(0.0, 1.0, z),
        ]
    };
    let positions = at(0.1).into_iter().chain(at(0.0)).collect();
    let (mesh, _) = editor(positions, &[[0, 1, 2], [3, 5, 4]]).finish();
    let surface = Surface::new(&mesh, vec![1.0; 6]);
    let nearer_the_lower = DVec3::Z * 0.04;
    for (normal, z) in [(DVec3::Z, 0.1), (-DVec3::Z, 0.0)] {
        let (foot, length) = surface.closest(nearer_the_lower, normal, 1.0).unwrap();
        assert_eq!((foot, length), (DVec3::Z * z, 1.0));
    }
    // Far nearer, compared with the length: then the side does not matter.
    let (foot, _) = surface.closest(nearer_the_lower, DVec3::Z, 0.01).unwrap();
    assert_eq!(foot, DVec3::ZERO);
}

#[test]
fn lengths_are_graded() {
    // A strip of points with one short length at its end.
    let mut positions = Vec::new();
    let mut triangles = Vec::new();
    for i in 0..20_u32 {
        positions.extend([DVec3::X * f64::from(i), DVec3::X * f64::from(i) + DVec3::Y]);
        if i > 0 {
            let [a, b, c, d] = [2 * i - 2, 2 * i, 2 * i + 1, 2 * i - 1];
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    for short in [0, 20, 39] {
        let strip = editor(positions.clone(), &triangles);
        let mut lengths = vec![3.0; 40];
        lengths[short] = 1.0;
        sizing::grade(strip.view(), 0.25, &mut lengths);
        for h in strip.edges() {
            let [a, b] = [strip.origin(h), strip.destination(h)];
            let slack = 0.25 * strip.at(a).distance(strip.at(b));
            assert!((lengths[a.index()] - lengths[b.index()]).abs() <= slack + 1e-15);
        }
        assert_eq!(lengths[short], 1.0);
        assert_eq!(lengths[(short + 18) % 40], 3.0);
    }
}

#[test]
fn lengths_from_curvature_are_graded_too() {
    let mut pill = icosphere(4).unwrap();
    let stretched = pill
        .positions()
        .iter()
        .map(|p| p.with_z(6.0 * p.z))
        .collect();
    pill.set_positions(stretched).unwrap();
    let editor = MeshEditor::new(pill);
    let kinds = vec![Kind::Free; editor.positions.len()];
    let wanted = |gradation| CurvatureLength {
        gradation,
        ..CurvatureLength::new(0.01, 0.01, 10.0)
    };
    let steepest = |gradation| {
        let lengths = sizing::curvature_lengths(&editor, &kinds, &wanted(gradation));
        let slope = |h| {
            let [a, b] = [editor.origin(h), editor.destination(h)];
            let rise = (lengths[a.index()] - lengths[b.index()]).abs();
            rise / editor.at(a).distance(editor.at(b))
        };
        editor.edges().map(slope).fold(0.0, f64::max)
    };
    assert!(steepest(1e3) > 0.1, "there is something to grade");
    assert!(steepest(0.05) < 0.05 + 1e-12);
    assert!(steepest(0.0) < 1e-12);
}

#[test]
fn creases_do_not_merge_and_do_not_flip() {
    let options = RemeshOptions {
        crease_angle: Some(0.5),
        ..RemeshOptions::default()
    };
    // Every edge of an icosahedron is sharper than that: every vertex is a corner, and nothing may change.
    let sharp = icosphere(0).unwrap();
    let mut state = State::new(&sharp, &options).unwrap().unwrap();
    state.mark_creases(&options);
    assert!(state.kinds.iter().all(|&k| k == Kind::Corner));
    for h in sharp.half_edge_ids() {
        assert!(!state.flip(h, |_, _| true) && !state.collapse(h, |_, _, _| true));
    }
    // Two creases that run to one apex stay two, though the edge between them is one as well.
    let mut state = State::new(&icosphere(2).unwrap(), &RemeshOptions::default())
        .unwrap()
        .unwrap();
    state.lengths.fill(10.0);
    let sides = [0, 1, 2].map(HalfEdgeId);
    let free = state.editor.clone();
    assert!(state.collapse(sides[0], |_, _, _| true));
    state.editor = free;
    for h in sides {
        let twin = state.editor.twin_of(h).unwrap();
        state.editor.creases[h.index()] = true;
        state.editor.creases[twin.index()] = true;
        let v = state.editor.origin(h);
        state.kinds[v.index()] = Kind::Crease;
    }
    assert!(!state.collapse(sides[0], |_, _, _| true));
    // With one of the three gone, the chain of the other two may shorten.
    let twin = state.editor.twin_of(sides[1]).unwrap();
    state.editor.creases[sides[1].index()] = false;
    state.editor.creases[twin.index()] = false;
    assert!(state.collapse(sides[0], |_, _, _| true));
}
