//! The cocone test against its definition, by brute force over Voronoi cells.

use crate::candidates::Wishes;
use crate::canonical::Canonical;
use crate::options::Acceptance;
use crate::poles::Poles;
use glam::DVec3;
use pellicle_delaunay::{FacetId, Tetrahedralization, VoronoiVertex, tetrahedralize};
use pellicle_geometry::VertexId;
use proptest::prelude::*;

fn cocone_cosine() -> f64 {
    (3.0 * std::f64::consts::PI / 8.0).cos()
}

/// v_p by its definition, from the Voronoi cell of the caller's vertex.
fn pole_vector(tetrahedralization: &Tetrahedralization, vertex: VertexId) -> DVec3 {
    let p = tetrahedralization.points()[vertex.index()];
    let mut farthest = DVec3::ZERO;
    let mut sum = DVec3::ZERO;
    for tet in tetrahedralization.around_vertex(vertex) {
        match tetrahedralization.voronoi_vertex(tet) {
            VoronoiVertex::Finite(center) if (center - p).length() > farthest.length() => {
                farthest = center - p;
            }
            VoronoiVertex::Finite(_) => {}
            VoronoiVertex::Infinite(direction) => sum += direction,
        }
    }
    if sum == DVec3::ZERO { farthest } else { sum }.normalize()
}

/// How far the Voronoi edge stays out of the cocone of p: the least of cos²∠(y − p, v_p) − cos²(3π/8) over
/// its points y, sampled densely with both ends; negative where the edge meets the cocone.
///
/// Squared, the angle is between lines: both nappes at once.
fn clearance(p: DVec3, v: DVec3, ends: [VoronoiVertex; 2]) -> f64 {
    let above = |direction: DVec3| {
        let cosine = direction.normalize().dot(v);
        cosine * cosine - cocone_cosine() * cocone_cosine()
    };
    // A zero of the quadratic form between two samples of one sign would be missed by sampling alone: the
    // vertex of the parabola t ↦ (y·v)² − c² y² is a sample too.
    let form =
        |y: DVec3, z: DVec3| y.dot(v) * z.dot(v) - cocone_cosine() * cocone_cosine() * y.dot(z);
    let (a, along, is_ray) = match ends {
        // From the nearer end on: the other may be so far away that the difference loses all digits.
        [VoronoiVertex::Finite(a), VoronoiVertex::Finite(b)] => {
            let (a, b) = if a.distance(p) < b.distance(p) {
                (a, b)
            } else {
                (b, a)
            };
            (a - p, b - a, false)
        }
        [VoronoiVertex::Finite(a), VoronoiVertex::Infinite(d)]
        | [VoronoiVertex::Infinite(d), VoronoiVertex::Finite(a)] => (a - p, d, true),
        [VoronoiVertex::Infinite(_), VoronoiVertex::Infinite(_)] => panic!("no finite end"),
    };
    let vertex = -form(a, along) / form(along, along);
    let dense = (0..=200).map(|k| {
        let share = f64::from(k) / 200.0;
        if is_ray {
            a.length() * share / (1.0 - share)
        } else {
            share
        }
    });
    let mut least = if is_ray {
        above(along)
    } else {
        above(a + along)
    };
    for t in dense.chain([vertex]) {
        if (0.0..f64::INFINITY).contains(&t) && (is_ray || t <= 1.0) {
            least = least.min(above(a + along * t));
        }
    }
    least
}

/// Every facet, with whether each vertex has its Voronoi edge in the cocone; `None` where that is too close
/// to call.
fn brute_force(tetrahedralization: &Tetrahedralization) -> Vec<(FacetId, [Option<bool>; 3])> {
    let points = tetrahedralization.points();
    let vectors: Vec<DVec3> = (0..points.len())
        .map(|v| pole_vector(tetrahedralization, VertexId::new(v)))
        .collect();
    let in_cocone = |facet: FacetId| {
        let ends = tetrahedralization.voronoi_edge(facet).ends;
        tetrahedralization.facet(facet).map(|vertex| {
            let clearance = clearance(points[vertex.index()], vectors[vertex.index()], ends);
            (clearance.abs() > 1e-7).then_some(clearance < 0.0)
        })
    };
    let facets = tetrahedralization.facets();
    facets.map(|facet| (facet, in_cocone(facet))).collect()
}

fn check(points: &[DVec3]) -> (usize, usize) {
    let Ok(tetrahedralization) = tetrahedralize(points, &Default::default()) else {
        return (0, 0);
    };
    let canonical = Canonical::of(&tetrahedralization);
    let poles = Poles::of(&canonical);
    let brute_force = brute_force(&tetrahedralization);
    let (mut inside, mut outside) = (0, 0);
    for &(facet, expected) in &brute_force {
        let found = poles.wishes(&canonical, facet);
        for (found, expected) in found.into_iter().zip(expected) {
            if let Some(expected) = expected {
                assert_eq!(found, expected, "facet {facet:?} of {points:?}");
                *(if expected { &mut inside } else { &mut outside }) += 1;
            }
        }
    }

    // Candidates by either rule, were every vertex flat, or every second one.
    let wishes = Wishes::of(&canonical, &poles);
    for every in [1, 2] {
        let flat: Vec<bool> = (0..canonical.vertex_count())
            .map(|v| v % every == 0)
            .collect();
        for acceptance in [Acceptance::AnyVertex, Acceptance::AllVertices] {
            let candidates = wishes.candidates(&canonical, &flat, acceptance);
            for &(facet, expected) in &brute_force {
                let votes: Option<Vec<bool>> = canonical
                    .facet(facet)
                    .into_iter()
                    .zip(expected)
                    .filter(|(vertex, _)| flat[vertex.index()])
                    .map(|(_, vote)| vote)
                    .collect();
                let Some(votes) = votes else { continue };
                let accepted = match acceptance {
                    Acceptance::AnyVertex => votes.contains(&true),
                    Acceptance::AllVertices => !votes.is_empty() && !votes.contains(&false),
                };
                assert_eq!(
                    candidates.contains(facet),
                    accepted,
                    "{acceptance:?} {facet:?} of {points:?}"
                );
                assert_eq!(candidates.contains(canonical.twin(facet)), accepted);
            }
        }
    }
    (inside, outside)
}

fn coordinates() -> impl Strategy<Value = Vec<DVec3>> {
    let point = (-1.0..1.0, -1.0..1.0, -1.0..1.0).prop_map(|(x, y, z)| DVec3::new(x, y, z));
    // A thin slab has long cells, whose double cones matter.
    (
        proptest::collection::vec(point, 4..40),
        prop_oneof![Just(1.0), Just(0.1)],
    )
        .prop_map(|(points, z)| {
            points
                .into_iter()
                .map(|p| p * DVec3::new(1.0, 1.0, z))
                .collect()
        })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, ..ProptestConfig::default() })]

    #[test]
    fn the_cocone_test_is_its_definition(points in coordinates()) {
        check(&points);
    }
}

#[test]
fn both_answers_are_common() {
    // Two bumpy layers.
    let points: Vec<DVec3> = (0..72)
        .map(|i: u32| {
            let [x, y, z] = [i % 6, i / 6 % 6, i / 36].map(f64::from);
            DVec3::new(
                x + 0.1 * y * y,
                y + 0.05 * x,
                3.0 * z + 0.2 * (x * 1.3 + y * 0.7).sin(),
            )
        })
        .collect();
    let (inside, outside) = check(&points);
    assert!(inside > 100 && outside > 100, "{inside} in, {outside} out");
}

/// An edge through the cocone from nappe to nappe, with both ends far from the cocone.
#[test]
fn an_edge_between_opposite_nappes_meets_the_cocone() {
    let finite = |x: f64, z: f64| VoronoiVertex::Finite(DVec3::new(x, 0.0, z));
    let v = DVec3::Z;
    assert!(clearance(DVec3::ZERO, v, [finite(0.1, 5.0), finite(0.1, -5.0)]) < 0.0);
    assert!(clearance(DVec3::ZERO, v, [finite(0.1, 5.0), finite(0.1, 1.0)]) > 0.0);
    let down = VoronoiVertex::Infinite(-DVec3::Z);
    assert!(clearance(DVec3::ZERO, v, [finite(0.1, 5.0), down]) < 0.0);
    assert!(
        clearance(
            DVec3::ZERO,
            v,
            [finite(0.1, 5.0), VoronoiVertex::Infinite(DVec3::Z)]
        ) > 0.0
    );
}
