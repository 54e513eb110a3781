//! Triangles around edges: the angles between them, and SURFACENEIGHBOR by numbers.

use pellicle::delaunay::FacetId;
use pellicle::prelude::*;
use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::TAU;

/// The triangles at each edge: the third vertex of each.
#[derive(Clone, Debug, Default)]
pub struct AtEdges(pub BTreeMap<[VertexId; 2], Vec<VertexId>>);

impl AtEdges {
    /// Of facets of a tetrahedralisation.
    pub fn of(tetrahedra: &Tetrahedralization, facets: &[FacetId]) -> Self {
        let mut at = BTreeMap::<_, Vec<_>>::new();
        for &facet in facets {
            let [a, b, c] = tetrahedra.facet(facet);
            for [u, v, apex] in [[a, b, c], [b, c, a], [c, a, b]] {
                at.entry([u.min(v), u.max(v)]).or_default().push(apex);
            }
        }
        Self(at)
    }

    /// The apexes at an edge in the order of their turn, counter-clockwise seen from its second vertex, each with the angle
    /// from it to the next.
    pub fn fan(&self, points: &[DVec3], edge: [VertexId; 2]) -> Vec<(VertexId, f64)> {
        let [u, v] = edge.map(|end| points[end.index()]);
        let axis = (v - u).normalize_or_zero();
        let (x, y) = axis.any_orthonormal_pair();
        let mut fan: Vec<(VertexId, f64)> = (self.0.get(&edge).into_iter().flatten())
            .map(|&apex| {
                let arm = points[apex.index()] - u;
                (apex, libm::atan2(arm.dot(y), arm.dot(x)))
            })
            .collect();
        fan.sort_by(|a, b| a.1.total_cmp(&b.1).then(a.0.cmp(&b.0)));
        let angles: Vec<f64> = fan.iter().map(|&(_, angle)| angle).collect();
        for (i, (_, gap)) in fan.iter_mut().enumerate() {
            *gap = match angles.get(i + 1) {
                Some(next) => next - angles[i],
                None => TAU + angles[0] - angles[i],
            };
        }
        fan
    }

    /// The largest angle between triangles that follow each other around an edge; a full turn for a single one.
    pub fn largest_gap(&self, points: &[DVec3], edge: [VertexId; 2]) -> f64 {
        let fan = self.fan(points, edge);
        fan.iter().map(|&(_, gap)| gap).fold(0.0, f64::max)
    }
}

/// SURFTRIANGLES with a SURFACENEIGHBOR that computes: at each edge it goes on to the triangle with the least angle, turning
/// from where it stands through the outside; all angles from dot products.
///
/// Triangles are counter-clockwise seen from outside. A triangle that was reached once is not taken again.
pub fn walk_by_numbers(points: &[DVec3], at: &AtEdges, seed: [VertexId; 3]) -> Vec<[VertexId; 3]> {
    let key = |mut t: [VertexId; 3]| {
        t.sort_unstable();
        t
    };
    let mut taken = BTreeSet::from([key(seed)]);
    let mut surface = vec![seed];
    let mut pending = vec![seed];
    while let Some([a, b, c]) = pending.pop() {
        for [u, v, apex] in [[a, b, c], [b, c, a], [c, a, b]] {
            let Some(others) = at.0.get(&[u.min(v), u.max(v)]) else {
                continue;
            };
            let angle = |other: VertexId| turn(points, [u, v, apex], other);
            let next = (others.iter().copied().filter(|&other| other != apex))
                .min_by(|&x, &y| angle(x).total_cmp(&angle(y)));
            // Across the edge the neighbour runs the other way.
            if let Some(next) = next
                && taken.insert(key([v, u, next]))
            {
                surface.push([v, u, next]);
                pending.push([v, u, next]);
            }
        }
    }
    surface
}

/// The angle in 0 to 2π by which the half-plane of (u, v, apex) turns around (u, v), through the side from which these are
/// counter-clockwise, until it meets `other`.
fn turn(points: &[DVec3], [u, v, apex]: [VertexId; 3], other: VertexId) -> f64 {
    let [u, v, apex, other] = [u, v, apex, other].map(|vertex| points[vertex.index()]);
    let axis = (v - u).normalize_or_zero();
    let arm = apex - u;
    let ahead = (arm - arm.dot(axis) * axis).normalize_or_zero();
    let outward = axis.cross(ahead);
    let angle = libm::atan2((other - u).dot(outward), (other - u).dot(ahead));
    if angle < 0.0 { angle + TAU } else { angle }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Random;
    use crate::cocone::measured::stages;
    use crate::cocone::surface::Surface;
    use std::f64::consts::PI;

    #[test]
    fn gaps_around_an_edge() {
        // Arms at 0°, 90° and 180° about z.
        let points = [DVec3::ZERO, DVec3::Z, DVec3::X, DVec3::Y, -DVec3::X];
        let [u, v] = [VertexId(0), VertexId(1)];
        let apexes =
            |ids: &[u32]| AtEdges([([u, v], ids.iter().map(|&i| VertexId(i)).collect())].into());
        let gap = |ids: &[u32]| apexes(ids).largest_gap(&points, [u, v]);
        assert!((gap(&[2, 3]) - 1.5 * PI).abs() < 1e-12);
        assert!((gap(&[2, 4]) - PI).abs() < 1e-12);
        assert!((gap(&[4, 3, 2]) - PI).abs() < 1e-12);
        assert!((gap(&[3]) - TAU).abs() < 1e-12);
        // From x through +z ∧ … counter-clockwise seen from (0, 0, ∞) or not.
        assert!((turn(&points, [u, v, VertexId(2)], VertexId(3)) - 0.5 * PI).abs() < 1e-12);
        assert!((turn(&points, [v, u, VertexId(2)], VertexId(3)) - 1.5 * PI).abs() < 1e-12);
    }

    #[test]
    fn without_slivers_numbers_find_what_the_walk_finds() {
        let points = Surface::Torus { tube: 0.4 }.scatter(0.3, &mut Random::new(5, 0));
        let tetrahedra = tetrahedralize(&points, &Default::default()).unwrap();
        let (stages, _) = stages(&tetrahedra).unwrap();
        let at = AtEdges::of(&tetrahedra, &stages.pruned);
        let seed = tetrahedra.facet(stages.walked[0]);
        // A facet is counter-clockwise seen from its tetrahedron, here the outer one.
        let found = walk_by_numbers(&points, &at, seed);
        let sorted = |triangles: Vec<[VertexId; 3]>| -> BTreeSet<[VertexId; 3]> {
            triangles
                .into_iter()
                .map(|[a, b, c]| match a.min(b).min(c) {
                    first if first == a => [a, b, c],
                    first if first == b => [b, c, a],
                    _ => [c, a, b],
                })
                .collect()
        };
        let walked = stages
            .walked
            .iter()
            .map(|&facet| tetrahedra.facet(facet))
            .collect();
        assert_eq!(sorted(found), sorted(walked));
    }
}
