//! What the lemmas of Dey 2006, chapter 4, bound, measured on a sample; and the bounds.
//!
//! | letter | meaning |
//! |---|---|
//! | n_p, f(p) | the surface's normal at p, and its local feature size |
//! | v_p | the pole vector |
//! | n_t | the normal of a triangle t |
//! | r | the radius of the smallest empty ball whose boundary holds the corners of t |
//! | H | the plane of the circle in which the balls of two neighbouring restricted Delaunay triangles meet |

use super::surface::Surface;
use pellicle::cocone::{Observer, reconstruct_observed};
use pellicle::delaunay::{FacetId, VoronoiVertex};
use pellicle::geometry::triangle;
use pellicle::prelude::*;
use std::collections::{BTreeMap, HashSet};

/// α(ε) = ε / (1 − 3ε): how much normals differ at a distance of ε f (normal variation lemma, 3.3).
pub fn alpha(epsilon: f64) -> f64 {
    epsilon / (1.0 - 3.0 * epsilon)
}

/// β(ε) = arcsin ε + arcsin((2/√3) sin(2 arcsin ε)): how much the normal of a triangle of circumradius ε f differs from
/// the surface's at the corner of its largest angle (triangle normal lemma, 3.5).
pub fn beta(epsilon: f64) -> f64 {
    let half = libm::asin(epsilon);
    half + libm::asin(2.0 / 3.0_f64.sqrt() * libm::sin(2.0 * half))
}

/// Lemma 4.1: ∠(n_p, v_p) is at most this, in radians.
pub fn pole_bound(epsilon: f64) -> f64 {
    2.0 * libm::asin(epsilon / (1.0 - epsilon))
}

/// Lemma 4.2: r / f(p) and the circumradius over f(p) are at most this.
pub fn radius_bound(epsilon: f64) -> f64 {
    1.15 * epsilon / (1.0 - epsilon)
}

/// Lemma 4.3: ∠(n_p, n_t) is at most this, in radians.
pub fn normal_bound(epsilon: f64) -> f64 {
    alpha(2.3 * epsilon / (1.0 - epsilon)) + beta(radius_bound(epsilon))
}

/// Theorem 4.1: the angle between H and n_p is at most this, in radians.
pub fn plane_bound(epsilon: f64) -> f64 {
    alpha(epsilon) + libm::asin(epsilon / (1.0 - epsilon))
}

/// The largest of some numbers, and their mean.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Extent {
    /// The largest.
    pub largest: f64,
    sum: f64,
    count: usize,
}

impl Extent {
    fn take(&mut self, value: f64) {
        self.largest = self.largest.max(value);
        self.sum += value;
        self.count += 1;
    }

    /// The mean, zero of none.
    pub fn mean(&self) -> f64 {
        self.sum / self.count.max(1) as f64
    }

    /// How many numbers.
    pub fn count(&self) -> usize {
        self.count
    }
}

/// The stages of a reconstruction.
#[derive(Clone, Debug, Default)]
pub struct Stages {
    /// By point.
    pub pole_vectors: Vec<DVec3>,
    /// T, sorted.
    pub candidates: Vec<FacetId>,
    /// T after pruning, sorted.
    pub pruned: Vec<FacetId>,
    /// E, each seen from outside.
    pub walked: Vec<FacetId>,
}

impl Observer for Stages {
    fn is_watching(&self) -> bool {
        true
    }
    fn pole_vectors(&mut self, vectors: &[DVec3]) {
        self.pole_vectors = vectors.to_vec();
    }
    fn candidates(&mut self, facets: &[FacetId]) {
        self.candidates = facets.to_vec();
    }
    fn pruned(&mut self, facets: &[FacetId]) {
        self.pruned = facets.to_vec();
    }
    fn walked(&mut self, facets: &[FacetId]) {
        self.walked = facets.to_vec();
    }
}

/// The stages of Cocone on a tetrahedralisation, and its result.
pub fn stages(tetrahedra: &Tetrahedralization) -> Result<(Stages, Reconstruction), cocone::Error> {
    let mut stages = Stages::default();
    let options = cocone::Options::default();
    let surface = reconstruct_observed(tetrahedra, &options, &(), &mut stages)?;
    Ok((stages, surface))
}

/// What was measured on one sample. Angles in radians.
#[derive(Clone, Debug, Default)]
pub struct Measured {
    /// How many points.
    pub points: usize,
    /// The sample is an ε-sample for the first and no lesser one than the second, which differ by 0.2 % at most.
    pub epsilon: [f64; 2],
    /// Points whose Voronoi cell is unbounded.
    pub unbounded: usize,
    /// ∠(n_p, v_p), of lines, by point.
    pub pole: Extent,
    /// r / f(p), by candidate and corner.
    pub ball: Extent,
    /// Circumradius over f(p), by candidate and corner.
    pub circumradius: Extent,
    /// ∠(n_p, n_t), of lines, by candidate and corner.
    pub normal: Extent,
    /// Candidate triangles.
    pub candidates: usize,
    /// Restricted Delaunay triangles.
    pub restricted: usize,
    /// V − E + F of these, which is the surface's own where they are homeomorphic to it.
    pub euler_characteristic: i64,
    /// Restricted Delaunay triangles that are no candidates.
    pub missed: usize,
    /// Edges of restricted Delaunay triangles that do not have two of them.
    pub odd_edges: usize,
    /// Between H and n_p, by pair of neighbours and common vertex.
    pub plane: Extent,
    /// Between a restricted Delaunay triangle and n_p's tangent plane, by corner.
    pub restricted_normal: Extent,
    /// The smallest angle between two neighbours, from 0 to π.
    pub dihedral: f64,
    /// Triangles and Euler characteristic of the result.
    pub result: (usize, i64),
}

/// Measures the points as a sample of the surface.
pub fn measure(surface: Surface, points: &[DVec3]) -> Result<Measured, crate::Error> {
    let tetrahedra = tetrahedralize(points, &delaunay::Options::default())?;
    let (stages, reconstruction) = stages(&tetrahedra)?;
    let [least, most] = surface.epsilon(points);
    let mut measured = Measured {
        points: points.len(),
        epsilon: [most, least],
        candidates: stages.candidates.len(),
        dihedral: std::f64::consts::PI,
        ..Measured::default()
    };
    let on_hull: HashSet<VertexId> = (tetrahedra.unbounded_voronoi_edges())
        .flat_map(|edge| tetrahedra.facet(edge.facet))
        .collect();
    measured.unbounded = on_hull.len();
    // Lemma 4.1.
    for (&p, &vector) in points.iter().zip(&stages.pole_vectors) {
        measured.pole.take(line_angle(surface.normal(p), vector));
    }
    // Lemmas 4.2 and 4.3.
    for &facet in &stages.candidates {
        let corners = tetrahedra.facet(facet).map(|v| points[v.index()]);
        let [a, b, c] = corners;
        let circumradius = triangle::circumradius(a, b, c);
        let radius = smallest_empty_ball(&tetrahedra, facet, corners);
        let normal = triangle::unit_normal(a, b, c).unwrap_or(DVec3::ZERO);
        for p in corners {
            let f = surface.feature_size(p);
            measured.ball.take(radius / f);
            measured.circumradius.take(circumradius / f);
            measured.normal.take(line_angle(surface.normal(p), normal));
        }
    }
    measure_restricted(surface, &tetrahedra, &stages, &mut measured);
    let mesh = &reconstruction.mesh;
    let (vertices, triangles) = (mesh.positions().len() as i64, mesh.triangles().len() as i64);
    let borders: i64 = mesh
        .border_loops()
        .iter()
        .map(|loop_| loop_.len() as i64)
        .sum();
    measured.result = (
        mesh.triangles().len(),
        vertices - (3 * triangles + borders) / 2 + triangles,
    );
    Ok(measured)
}

/// Theorem 4.1 and what its proof bounds.
fn measure_restricted(
    surface: Surface,
    tetrahedra: &Tetrahedralization,
    stages: &Stages,
    measured: &mut Measured,
) {
    let points = tetrahedra.points();
    let restricted = restricted_delaunay(surface, tetrahedra);
    measured.restricted = restricted.len();
    let mut at_edge: BTreeMap<[VertexId; 2], Vec<(VertexId, DVec3)>> = BTreeMap::new();
    for &(facet, center) in &restricted {
        measured.missed += usize::from(stages.candidates.binary_search(&facet).is_err());
        let corners = tetrahedra.facet(facet);
        let [a, b, c] = corners.map(|v| points[v.index()]);
        let normal = triangle::unit_normal(a, b, c).unwrap_or(DVec3::ZERO);
        for i in 0..3 {
            let [u, v, apex] = [corners[(i + 1) % 3], corners[(i + 2) % 3], corners[i]];
            at_edge
                .entry([u.min(v), u.max(v)])
                .or_default()
                .push((apex, center));
            let n = surface.normal(points[apex.index()]);
            measured.restricted_normal.take(line_angle(n, normal));
        }
    }
    let used: HashSet<VertexId> = at_edge.keys().flatten().copied().collect();
    measured.euler_characteristic =
        used.len() as i64 - at_edge.len() as i64 + restricted.len() as i64;
    for (edge, triangles) in &at_edge {
        let [(one, v1), (other, v2)] = triangles[..] else {
            measured.odd_edges += 1;
            continue;
        };
        let [p, q, x, y] = [edge[0], edge[1], one, other].map(|v| points[v.index()]);
        for end in [p, q] {
            // H is perpendicular to v1 v2.
            let from_normal = line_angle(surface.normal(end), v2 - v1);
            measured
                .plane
                .take(std::f64::consts::FRAC_PI_2 - from_normal);
        }
        let axis = q - p;
        let dihedral = triangle::angle_between((x - p).cross(axis), (y - p).cross(axis));
        measured.dihedral = measured.dihedral.min(dihedral);
    }
}

/// The angle between two lines, from 0 to π/2.
pub fn line_angle(a: DVec3, b: DVec3) -> f64 {
    let angle = libm::atan2(a.cross(b).length(), a.dot(b));
    angle.min(std::f64::consts::PI - angle)
}

/// The radius of the smallest ball with these corners on its boundary and no point inside: its centre is the place of the
/// dual Voronoi edge nearest to them.
fn smallest_empty_ball(
    tetrahedra: &Tetrahedralization,
    facet: FacetId,
    corners: [DVec3; 3],
) -> f64 {
    let p = corners[0];
    let (start, along, end) = match tetrahedra.voronoi_edge(facet).ends {
        [VoronoiVertex::Finite(a), VoronoiVertex::Finite(b)] => (a, b - a, 1.0),
        [VoronoiVertex::Finite(a), VoronoiVertex::Infinite(direction)]
        | [VoronoiVertex::Infinite(direction), VoronoiVertex::Finite(a)] => {
            (a, direction, f64::INFINITY)
        }
        [VoronoiVertex::Infinite(_), VoronoiVertex::Infinite(_)] => return f64::INFINITY,
    };
    let square = along.length_squared();
    let share = if square > 0.0 {
        (p - start).dot(along) / square
    } else {
        0.0
    };
    (start + share.clamp(0.0, end) * along).distance(p)
}

/// Far enough for a ray to be beyond the surfaces.
const FAR: f64 = 10.0;

/// The triangles whose dual Voronoi edge crosses the surface once, with the place where it does.
pub fn restricted_delaunay(
    surface: Surface,
    tetrahedra: &Tetrahedralization,
) -> Vec<(FacetId, DVec3)> {
    let crossing = |facet| {
        let edge = tetrahedra.voronoi_edge(facet);
        let (a, b) = match edge.ends {
            [VoronoiVertex::Finite(a), VoronoiVertex::Finite(b)] => (a, b),
            [VoronoiVertex::Finite(a), VoronoiVertex::Infinite(d)]
            | [VoronoiVertex::Infinite(d), VoronoiVertex::Finite(a)] => (a, a + FAR * d),
            [VoronoiVertex::Infinite(_), VoronoiVertex::Infinite(_)] => return None,
        };
        let is_inside = |share: f64| surface.distance(a + share * (b - a)) < 0.0;
        let (mut near, mut far) = (0.0, 1.0);
        let starts_inside = is_inside(near);
        if starts_inside == is_inside(far) {
            return None;
        }
        for _ in 0..60 {
            let middle = 0.5 * (near + far);
            match is_inside(middle) == starts_inside {
                true => near = middle,
                false => far = middle,
            }
        }
        Some((facet, a + near * (b - a)))
    };
    tetrahedra.facets().filter_map(crossing).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Random;

    #[test]
    fn the_bounds_are_those_of_the_text_at_the_largest_epsilon() {
        let degrees = |radians: f64| radians.to_degrees();
        assert!((radius_bound(0.06) - 0.073_404_255).abs() < 1e-9);
        // "H makes at most 9°"; "differ from the surface normal by at most 14°" is β alone.
        assert!(degrees(plane_bound(0.06)) < 9.0 && degrees(plane_bound(0.06)) > 7.0);
        assert!((degrees(beta(radius_bound(0.06))) - 14.0).abs() < 0.1);
        assert!(
            (degrees(normal_bound(0.06)) - 28.97).abs() < 0.01,
            "{}",
            degrees(normal_bound(0.06))
        );
        assert!((degrees(pole_bound(0.5)) - 180.0).abs() < 1e-9);
    }

    #[test]
    fn a_dense_sample_keeps_all_bounds_and_has_the_topology_of_the_surface() {
        for surface in [Surface::Sphere, Surface::Torus { tube: 0.6 }] {
            let points = surface.scatter(0.075, &mut Random::new(4, 0));
            let found = measure(surface, &points).unwrap();
            let epsilon = found.epsilon[0];
            assert!(epsilon < 0.1);
            assert!(found.pole.largest <= pole_bound(epsilon));
            assert!(found.ball.largest <= radius_bound(epsilon));
            // No smaller than the circumradius, and no smaller than half an edge.
            assert!(found.circumradius.largest <= found.ball.largest * (1.0 + 1e-12));
            assert!(found.circumradius.mean() > 0.3 * epsilon);
            assert!(found.normal.largest <= normal_bound(epsilon));
            let characteristic = surface.euler_characteristic();
            assert_eq!(found.euler_characteristic, characteristic);
            assert_eq!(found.result.1, characteristic);
            let expected = 2 * (points.len() as i64 - characteristic);
            assert_eq!(found.restricted as i64, expected);
            assert_eq!((found.missed, found.odd_edges), (0, 0));
            assert!(found.dihedral.to_degrees() > 134.0);
            assert_eq!(found.pole.count(), points.len());
        }
    }
}
