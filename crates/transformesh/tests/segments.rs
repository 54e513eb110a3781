//! Intersection segments, against closed forms and against the triangles that they lie in.

use pellicle_geometry::{DVec3, VertexId};
use pellicle_mesh::{
    MeshView, TriangleId, TriangleSoup, icosphere, self_intersections, triangles_intersect,
};
use pellicle_predicates::{Sign, orient3d};
use pellicle_transformesh::{
    Error, Observer, Options, Segment, intersection_segments, repair, repair_with,
};
use proptest::prelude::*;
use std::ops::ControlFlow;

fn v(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, y, z)
}

/// A soup in which no triangles share a vertex, though corners may be equal.
fn soup(triangles: &[[DVec3; 3]]) -> TriangleSoup {
    TriangleSoup {
        positions: triangles.as_flattened().to_vec(),
        triangles: (0..triangles.len() as u32)
            .map(|t| [3 * t, 3 * t + 1, 3 * t + 2].map(VertexId))
            .collect(),
    }
}

fn segments(triangles: &[[DVec3; 3]]) -> Vec<Segment> {
    intersection_segments((&soup(triangles)).into(), &()).unwrap()
}

/// The ends of the segments of two triangles, in either order of them and from any corner on.
fn check(first: [DVec3; 3], second: [DVec3; 3], expected: &[[DVec3; 2]]) {
    for turn in 0..3 {
        for reverse in [false, true] {
            let mut turned = first;
            turned.rotate_left(turn);
            if reverse {
                turned.reverse();
            }
            for pair in [[turned, second], [second, turned]] {
                let found = segments(&pair);
                assert!(found.iter().all(|s| s.triangles == [0, 1].map(TriangleId)));
                let ends: Vec<_> = found.iter().map(|s| s.ends).collect();
                assert_eq!(ends, expected, "{pair:?}");
            }
        }
    }
}

const FLOOR: [DVec3; 3] = [
    DVec3::ZERO,
    DVec3::new(8.0, 0.0, 0.0),
    DVec3::new(0.0, 8.0, 0.0),
];

#[test]
fn two_crossing_triangles() {
    // The wall x = 1 reaches from y = 1 to 5 at the height of the floor.
    let wall = [v(1.0, 1.0, -1.0), v(1.0, 1.0, 1.0), v(1.0, 5.0, 0.0)];
    check(FLOOR, wall, &[[v(1.0, 1.0, 0.0), v(1.0, 5.0, 0.0)]]);
    // It reaches beyond: the floor's long edge ends the segment, at y = 7.
    let wall = [v(1.0, 1.0, -1.0), v(1.0, 1.0, 1.0), v(1.0, 9.0, 0.0)];
    check(FLOOR, wall, &[[v(1.0, 1.0, 0.0), v(1.0, 7.0, 0.0)]]);
    // The end is not a double, and rounded to the nearest one.
    let wall = [v(1.0, 1.0, -1.0), v(1.0, 1.0, 2.0), v(1.0, 2.0, 2.0)];
    check(FLOOR, wall, &[[v(1.0, 1.0, 0.0), v(1.0, 4.0 / 3.0, 0.0)]]);
}

#[test]
fn a_vertex_on_a_face_or_on_an_edge_is_a_point() {
    let stander = |foot: DVec3| [foot, foot + v(1.0, 0.0, 2.0), foot + v(0.0, 1.0, 2.0)];
    for foot in [v(2.0, 3.0, 0.0), v(2.0, 0.0, 0.0), v(4.0, 4.0, 0.0)] {
        check(FLOOR, stander(foot), &[[foot, foot]]);
    }
    // In a common corner they fit, and beyond the floor they do not meet.
    check(FLOOR, stander(DVec3::ZERO), &[]);
    check(FLOOR, stander(v(5.0, 4.0, 0.0)), &[]);
}

#[test]
fn an_edge_through_an_edge_is_a_point() {
    let wall = [v(3.0, 0.0, -1.0), v(3.0, 0.0, 1.0), v(3.0, -2.0, 0.0)];
    check(FLOOR, wall, &[[v(3.0, 0.0, 0.0); 2]]);
    // Edges that lie on each other, in part.
    let wall = [v(3.0, 0.0, 0.0), v(11.0, 0.0, 0.0), v(3.0, 0.0, 5.0)];
    check(FLOOR, wall, &[[v(3.0, 0.0, 0.0), v(8.0, 0.0, 0.0)]]);
}

#[test]
fn a_common_corner_with_crossing_insides() {
    let wall = [DVec3::ZERO, v(6.0, 6.0, -3.0), v(6.0, 6.0, 3.0)];
    check(FLOOR, wall, &[[DVec3::ZERO, v(4.0, 4.0, 0.0)]]);
    let wall = [DVec3::ZERO, v(2.0, 2.0, -3.0), v(2.0, 2.0, 3.0)];
    check(FLOOR, wall, &[[DVec3::ZERO, v(2.0, 2.0, 0.0)]]);
}

#[test]
fn an_overlap_in_one_plane_is_a_border() {
    // A triangle inside of the other: its three edges.
    let inner = [v(1.0, 1.0, 0.0), v(2.0, 1.0, 0.0), v(1.0, 3.0, 0.0)];
    check(
        FLOOR,
        inner,
        &[
            [inner[0], inner[2]],
            [inner[0], inner[1]],
            [inner[2], inner[1]],
        ],
    );
    // A corner cut off by the long edge of the other: a quadrilateral, from edges of both.
    let other = [v(8.0, 8.0, 0.0), v(8.0, -6.0, 0.0), v(-6.0, 8.0, 0.0)];
    let [a, b, c, d] = [v(0.0, 2.0, 0.0), v(2.0, 0.0, 0.0), FLOOR[1], FLOOR[2]];
    check(FLOOR, other, &[[a, d], [a, b], [d, c], [b, c]]);
    // The same triangle twice.
    check(
        FLOOR,
        FLOOR,
        &[
            [FLOOR[0], FLOOR[2]],
            [FLOOR[0], FLOOR[1]],
            [FLOOR[2], FLOOR[1]],
        ],
    );
    // A common edge, folded over.
    let folded = [FLOOR[0], FLOOR[1], v(0.0, 4.0, 0.0)];
    check(
        FLOOR,
        folded,
        &[
            [FLOOR[0], v(0.0, 4.0, 0.0)],
            [FLOOR[0], FLOOR[1]],
            [v(0.0, 4.0, 0.0), FLOOR[1]],
        ],
    );
}

#[test]
fn touches_in_one_plane() {
    // Along a part of an edge, and in a point.
    let beside = [v(1.0, 0.0, 0.0), v(3.0, 0.0, 0.0), v(2.0, -2.0, 0.0)];
    check(FLOOR, beside, &[[beside[0], beside[1]]]);
    let beside = [v(1.0, -2.0, 0.0), v(3.0, -2.0, 0.0), v(2.0, 0.0, 0.0)];
    check(FLOOR, beside, &[[beside[2], beside[2]]]);
    // A hexagon: six segments, each an end of two.
    let star = [v(4.0, 4.0, 0.0), v(4.0, -2.0, 0.0), v(-2.0, 4.0, 0.0)];
    let small = [v(0.0, 0.0, 0.0), v(5.0, 0.0, 0.0), v(0.0, 5.0, 0.0)];
    let border = segments(&[small, star]);
    assert_eq!(border.len(), 6);
    assert!(border.iter().all(|s| s.ends[0] != s.ends[1]));
    for end in border.iter().flat_map(|s| s.ends) {
        assert_eq!(border.iter().filter(|s| s.ends.contains(&end)).count(), 2);
    }
}

#[test]
fn triangles_without_area_are_left_out_and_ids_stay() {
    let wall = [v(1.0, 1.0, -1.0), v(1.0, 1.0, 1.0), v(1.0, 5.0, 0.0)];
    let needle = [v(2.0, 2.0, -1.0), v(2.0, 2.0, 1.0), v(2.0, 2.0, 3.0)];
    let all = [needle, FLOOR, needle, wall];
    let pairs = self_intersections((&soup(&all)).into(), &()).unwrap();
    assert!(pairs.contains(&(TriangleId(0), TriangleId(1))));
    let found = segments(&all);
    assert_eq!(found.len(), 1);
    assert_eq!(found[0].triangles, [1, 3].map(TriangleId));
}

#[test]
fn unusable_meshes_are_refused() {
    let mut mesh = soup(&[FLOOR]);
    mesh.positions[2].y = f64::NAN;
    let refused = intersection_segments((&mesh).into(), &()).unwrap_err();
    assert!(matches!(
        refused,
        Error::NotFinite {
            vertex: VertexId(2),
            ..
        }
    ));
    let mut mesh = soup(&[FLOOR]);
    mesh.triangles[0][1] = VertexId(3);
    let refused = intersection_segments((&mesh).into(), &()).unwrap_err();
    assert!(matches!(
        refused,
        Error::NoSuchVertex {
            vertex: VertexId(3),
            ..
        }
    ));
    assert_eq!(intersection_segments((&soup(&[])).into(), &()), Ok(vec![]));
}

/// Stops in the stage of this name.
struct StopIn(&'static str);

impl pellicle_geometry::Progress for StopIn {
    fn step(&self, stage: &'static str, _: u64, _: u64) -> ControlFlow<()> {
        match stage == self.0 {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        }
    }
}

#[test]
fn it_can_be_stopped() {
    let wall = [v(1.0, 1.0, -1.0), v(1.0, 1.0, 1.0), v(1.0, 5.0, 0.0)];
    for stage in ["self-intersections", "segments"] {
        let mesh = soup(&[FLOOR, wall]);
        let stopped = intersection_segments((&mesh).into(), &StopIn(stage)).unwrap_err();
        let is_cancelled = matches!(
            stopped,
            Error::Cancelled(_) | Error::Mesh(pellicle_mesh::MeshError::Cancelled(_))
        );
        assert!(is_cancelled, "{stage}: {stopped:?}");
    }
}

fn two_spheres() -> TriangleSoup {
    let mut soup = icosphere(2).unwrap().into_soup();
    let count = soup.positions.len() as u32;
    let shifted = soup.positions.iter().map(|&p| p + v(0.7, 0.3, 0.2));
    let shifted: Vec<DVec3> = shifted.collect();
    soup.positions.extend(shifted);
    let again: Vec<_> = (soup.triangles.iter())
        .map(|t| t.map(|v| VertexId(v.0 + count)))
        .collect();
    soup.triangles.extend(again);
    soup
}

#[test]
fn the_curve_of_two_spheres_is_closed() {
    let soup = two_spheres();
    let found = intersection_segments((&soup).into(), &()).unwrap();
    let mut ends: Vec<[u64; 3]> = found
        .iter()
        .flat_map(|s| s.ends.map(|p| p.to_array().map(f64::to_bits)))
        .collect();
    ends.sort_unstable();
    assert!(ends.len() > 50);
    // Exact points round alike, so that the ends fit bit for bit.
    for pair in ends.chunks(2) {
        assert_eq!(pair[0], pair[1]);
    }
    // They lie in the plane halfway between the centres, but for the sagitta of an edge.
    let axis = v(0.7, 0.3, 0.2);
    for s in &found {
        let off = (s.ends[0] - 0.5 * axis).dot(axis.normalize()).abs();
        assert!(off < 0.05, "{off}");
    }
}

#[derive(Default)]
struct Seen {
    watching: bool,
    pairs: usize,
    segments: Vec<Vec<Segment>>,
}

impl Observer for Seen {
    fn pairs(&mut self, pairs: &[(TriangleId, TriangleId)]) {
        assert_eq!(self.pairs, self.segments.len() * usize::from(self.watching));
        self.pairs += 1;
        assert!(!pairs.is_empty());
    }
    fn segments(&mut self, segments: &[Segment]) {
        self.segments.push(segments.to_vec());
    }
    fn is_watching(&self) -> bool {
        self.watching
    }
}

#[test]
fn an_observer_sees_them_and_changes_nothing() {
    let soup = two_spheres();
    let expected = intersection_segments((&soup).into(), &()).unwrap();
    let alone = repair(&soup, &Options::default()).unwrap();
    for watching in [false, true] {
        let mut seen = Seen {
            watching,
            ..Seen::default()
        };
        let watched = repair_with((&soup).into(), &Options::default(), &(), &mut seen).unwrap();
        assert_eq!(watched, alone);
        assert_eq!(seen.segments.first(), watching.then_some(&expected));
        assert_eq!(seen.segments.len(), seen.pairs * usize::from(watching));
    }
}

/// The squared distance from a point to a triangle.
fn distance_squared(p: DVec3, [a, b, c]: [DVec3; 3]) -> f64 {
    let normal = (b - a).cross(c - a);
    let inside = [[a, b], [b, c], [c, a]]
        .iter()
        .all(|[a, b]| (b - a).cross(p - a).dot(normal) >= 0.0);
    if inside {
        return (p - a).dot(normal).powi(2) / normal.length_squared();
    }
    let to_edge = |[a, b]: [DVec3; 2]| {
        let t = (p - a).dot(b - a) / (b - a).length_squared();
        p.distance_squared(a + t.clamp(0.0, 1.0) * (b - a))
    };
    [[a, b], [b, c], [c, a]]
        .map(to_edge)
        .into_iter()
        .fold(f64::INFINITY, f64::min)
}

fn has_area([a, b, c]: [DVec3; 3]) -> bool {
    [DVec3::X, DVec3::Y, DVec3::Z]
        .iter()
        .any(|&d| orient3d(a, b, c, a + d) != Sign::Zero)
}

fn corners(mesh: MeshView, t: TriangleId) -> [DVec3; 3] {
    mesh.corners(t).unwrap()
}

fn triangles_of(coordinate: impl Strategy<Value = f64>) -> impl Strategy<Value = Vec<[DVec3; 3]>> {
    let point = proptest::array::uniform3(coordinate).prop_map(DVec3::from_array);
    proptest::collection::vec(proptest::array::uniform3(point), 2..9)
}

/// Ends lie in both triangles but for rounding; pairs are those that intersect; order and uniqueness are as promised.
fn hold(triangles: &[[DVec3; 3]]) {
    let soup = soup(triangles);
    let mesh = MeshView::from(&soup);
    let found = intersection_segments(mesh, &()).unwrap();
    let largest = soup.positions.iter().map(|p| p.abs().max_element());
    // An end is off by half a unit in the last place an axis, the measure of the distance by a few.
    let rounding = 8.0 * f64::EPSILON * largest.fold(0.0, f64::max);
    for segment in &found {
        let [t, u] = segment.triangles;
        assert!(t < u && triangles_intersect(corners(mesh, t), corners(mesh, u)));
        for end in segment.ends {
            for t in [t, u] {
                let distance = distance_squared(end, corners(mesh, t)).sqrt();
                assert!(distance <= rounding, "{distance} {segment:?}");
            }
        }
    }
    let mut pairs: Vec<_> = found.iter().map(|s| s.triangles).collect();
    pairs.dedup();
    let expected: Vec<_> = self_intersections(mesh, &()).unwrap();
    let expected: Vec<_> = expected
        .into_iter()
        .filter(|&(t, u)| has_area(corners(mesh, t)) && has_area(corners(mesh, u)))
        .map(|(t, u)| [t, u])
        .collect();
    assert_eq!(pairs, expected, "each pair that intersects, in order");
    // The other order of the triangles gives the same places.
    let reversed: Vec<_> = triangles.iter().rev().copied().collect();
    let key = |s: &Segment| s.ends.map(|p| (p + 0.0).to_array().map(f64::to_bits));
    let mut places: Vec<_> = found.iter().map(key).collect();
    let mut others: Vec<_> = segments(&reversed).iter().map(key).collect();
    places.sort_unstable();
    others.sort_unstable();
    assert_eq!(places, others);
}

proptest! {
    #[test]
    fn small_integers(triangles in triangles_of((-2_i32..3).prop_map(f64::from))) {
        hold(&triangles);
    }

    #[test]
    fn flat_integers(triangles in triangles_of((-2_i32..3).prop_map(f64::from))) {
        let flat: Vec<_> = triangles.iter().map(|t| t.map(|p| v(p.x, p.y, p.x + 2.0 * p.y))).collect();
        hold(&flat);
    }

    #[test]
    fn anywhere(triangles in triangles_of(-1.0..1.0)) {
        hold(&triangles);
    }
}
