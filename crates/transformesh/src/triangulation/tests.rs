use super::*;
use crate::weld::Weld;
use pellicle_geometry::DVec3;
use pellicle_mesh::TriangleSoup;
use proptest::prelude::*;

/// A large triangle, and walls that meet it along the segments between lattice points.
struct Scene {
    weld: Weld,
    points: Points,
    triangulation: Triangulation,
}

/// The plane z = x + 2y, so that nothing is parallel to an axis.
fn lifted([x, y]: [i32; 2]) -> DVec3 {
    DVec3::new(f64::from(x), f64::from(y), f64::from(x + 2 * y))
}

fn scene(segments: &[[[i32; 2]; 2]]) -> Scene {
    let mut soup = TriangleSoup {
        positions: [[-40, -40], [100, -40], [-40, 100]].map(lifted).to_vec(),
        triangles: vec![[0, 1, 2].map(VertexId)],
    };
    let mut ends = Vec::new();
    for segment in segments {
        let first = soup.positions.len() as u32;
        soup.positions.extend(segment.map(lifted));
        soup.positions.push(lifted(segment[0]) + 50.0 * DVec3::Z);
        soup.triangles
            .push([first, first + 1, first + 2].map(VertexId));
        ends.push([VertexId(first), VertexId(first + 1)]);
    }
    let mut weld = Weld::new((&soup).into());
    let mut points = Points::new(&mut weld);
    let plane = points.plane_of_triangle(0, &weld);
    let mut triangulation = Triangulation::new(weld.triangles[0], plane, &points);
    let mut wall = 0;
    for (segment, [a, b]) in segments.iter().zip(ends) {
        // Welded: the first vertex at a place.
        let place = |v: VertexId| {
            let at = weld.positions[v.index()];
            let first = weld.positions.iter().position(|&p| p == at);
            VertexId::new(first.expect("it is there"))
        };
        let plane = match segment[0] == segment[1] {
            true => plane,
            false => {
                wall += 1;
                points.plane_of_triangle(wall, &weld)
            }
        };
        triangulation.insert_segment([place(a), place(b)], plane, &mut points);
        validate(&triangulation, &points);
    }
    Scene {
        weld,
        points,
        triangulation,
    }
}

/// Every invariant of a triangulation of a triangle.
fn validate(triangulation: &Triangulation, points: &Points) {
    let Triangulation {
        triangles,
        neighbors,
        constraints,
        ..
    } = triangulation;
    let mut border = 0;
    for t in 0..triangles.len() {
        let [a, b, c] = triangles[t];
        assert_eq!(triangulation.orient(points, a, b, c), Sign::Positive);
        for i in 0..3 {
            let [from, to] = [i, next(i)].map(|k| triangles[t][k]);
            let u = neighbors[t][i];
            if u == NONE {
                border += 1;
                // On one of the three sides.
                let sides = [[0, 1], [1, 2], [2, 0]];
                assert!(sides.iter().any(|&[p, q]| {
                    let on = |v| triangulation.orient(points, p, q, v) == Sign::Zero;
                    on(from) && on(to)
                }));
                continue;
            }
            let j = triangulation.edge_towards(u, t as u32);
            assert_eq!(triangles[u as usize][j], to);
            assert_eq!(triangles[u as usize][next(j)], from);
            assert_eq!(constraints[u as usize][j], constraints[t][i]);
        }
    }
    for (v, &t) in triangulation.at.iter().enumerate() {
        assert!(triangles[t as usize].contains(&(v as Local)));
    }
    // Euler: as many triangles as a triangulation of these vertices has, so that none covers another.
    let vertices = triangulation.vertices.len();
    assert_eq!(triangles.len(), 2 * vertices - 2 - border);
}

/// Whether a segment is covered by constrained edges.
fn is_covered(scene: &Scene, [from, to]: [[i32; 2]; 2]) -> bool {
    let cut = &scene.triangulation;
    let local = |p: [i32; 2]| {
        let at = cut.vertices.iter();
        let at = at
            .map(|&v| scene.points.rounded(v))
            .position(|q| q == lifted(p));
        at.map(|at| at as Local)
    };
    let (Some(mut at), Some(to)) = (local(from), local(to)) else {
        return false;
    };
    while at != to {
        let towards = cut.around(at).into_iter().find_map(|(t, i)| {
            let of = |k: usize| cut.triangles[t as usize][k];
            let is_cut = |k: usize| cut.constraints[t as usize][k] != PlaneId::NONE;
            [(next(i), i), (previous(i), previous(i))]
                .into_iter()
                .map(|(k, edge)| (of(k), edge))
                .find(|&(v, edge)| {
                    is_cut(edge)
                        && cut.orient(&scene.points, at, to, v) == Sign::Zero
                        && cut.is_ahead(&scene.points, at, to, v)
                })
        });
        match towards {
            Some((vertex, _)) => at = vertex,
            None => return false,
        }
    }
    true
}

#[test]
fn two_segments_that_cross() {
    let scene = scene(&[[[0, 0], [10, 7]], [[0, 7], [10, 1]]]);
    assert_eq!(scene.triangulation.vertices.len(), 3 + 4 + 1);
    let crossing = scene.points.rounded(scene.triangulation.vertices[7]);
    // 7x = 10y and y = 7 − 0.6x.
    assert!((crossing - lifted([0, 0]) - DVec3::new(70.0, 49.0, 168.0) / 13.0).length() < 1e-13);
    assert_eq!(scene.weld.degenerate, 0);
}

fn lattice_point() -> impl Strategy<Value = [i32; 2]> {
    prop_oneof![
        3 => (0..6_i32, 0..6_i32).prop_map(|(x, y)| [x, y]),
        1 => (-40..30_i32, -40..30_i32).prop_map(|(x, y)| [x, y]),
        // On a side.
        1 => (-40..100_i32).prop_map(|x| [x, -40]),
        1 => (-40..100_i32).prop_map(|x| [x, 60 - x]),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn segments_are_covered(segments in prop::collection::vec([lattice_point(), lattice_point()], 1..14)) {
        let scene = scene(&segments);
        for &segment in &segments {
            prop_assert!(is_covered(&scene, segment));
        }
        // Where segments cross there is one vertex.
        let mut places: Vec<_> = scene.triangulation.vertices.clone();
        places.sort_unstable();
        places.dedup();
        prop_assert_eq!(places.len(), scene.triangulation.vertices.len());
    }
}
