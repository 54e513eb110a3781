//! Poles, pole vectors and cocones (Dey 2006, section 4.1.1).
//!
//! | letter | meaning |
//! |---|---|
//! | V_p | the Voronoi cell of p |
//! | p⁺, p⁻ | its poles |
//! | v_p | the pole vector, here of unit length |
//! | C_p | the cocone: the y of V_p with ∠(y − p, v_p) ≥ 3π/8, the angle between lines |

use crate::canonical::Canonical;
use glam::DVec3;
use pellicle_delaunay::{FACET_CORNERS, FacetId, TetId, circumcenter};
use pellicle_geometry::{VertexId, triangle};
use rayon::prelude::*;

/// cos(3π/8): a point y of V_p is in the cocone when |v_p · (y − p)| ≤ this |y − p|.
pub(crate) const COCONE_COSINE: f64 = 0.382_683_432_365_089_8;

/// Where a Voronoi vertex of V_p lies as seen from p.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub(crate) enum Nappe {
    /// In the cocone.
    Between = 0,
    /// In the nappe of the double cone around v_p.
    Positive = 1,
    /// In the opposite nappe.
    Negative = 2,
}

/// Everything that is known of the Voronoi cells.
pub(crate) struct Poles {
    /// By vertex: v_p, of unit length; zero where the cell gives none.
    pub(crate) vectors: Vec<DVec3>,
    /// By vertex: |p⁻ − p|; zero where there is no negative pole.
    pub(crate) heights: Vec<f64>,
    /// By vertex: the largest distance of a Voronoi vertex in the cocone, infinite for an unbounded cocone.
    pub(crate) widths: Vec<f64>,
    /// By tetrahedron: its circumcenter, or the outward unit normal of an infinite one's hull facet.
    centers: Vec<DVec3>,
    /// By tetrahedron: the [`Nappe`] of its Voronoi vertex for each corner, two bits each.
    nappes: Vec<u8>,
}

impl Poles {
    /// 1. Voronoi vertices. 2. Pole vectors. 3. Negative poles, nappes and widths.
    pub(crate) fn of(canonical: &Canonical) -> Self {
        let centers = centers(canonical);
        let vectors = pole_vectors(canonical, &centers);
        let mut poles = Self {
            heights: vec![0.0; vectors.len()],
            widths: vec![0.0; vectors.len()],
            nappes: Vec::with_capacity(centers.len()),
            vectors,
            centers,
        };
        for (t, tet) in canonical.tets().iter().enumerate() {
            poles.sort_into_nappes(canonical, t, *tet);
        }
        poles
    }

    fn sort_into_nappes(&mut self, canonical: &Canonical, t: usize, tet: [VertexId; 4]) {
        let center = self.centers[t];
        let is_finite = t < canonical.finite_count();
        // The four corners are equally far from the circumcenter.
        let distance = match is_finite {
            true => center.distance(canonical.point(tet[0])),
            false => f64::INFINITY,
        };
        let mut nappes = 0;
        for (corner, vertex) in tet.into_iter().enumerate().take(3 + usize::from(is_finite)) {
            let v = vertex.index();
            let cosine = match is_finite {
                true => self.vectors[v].dot(center - canonical.point(vertex)) / distance,
                false => self.vectors[v].dot(center),
            };
            if cosine < 0.0 {
                self.heights[v] = self.heights[v].max(distance);
            }
            let nappe = if cosine > COCONE_COSINE {
                Nappe::Positive
            } else if cosine < -COCONE_COSINE {
                Nappe::Negative
            } else {
                self.widths[v] = self.widths[v].max(distance);
                Nappe::Between
            };
            nappes |= (nappe as u8) << (2 * corner);
        }
        self.nappes.push(nappes);
    }

    #[inline]
    fn nappe(&self, tet: TetId, corner: usize) -> u8 {
        self.nappes[tet.index()] >> (2 * corner) & 3
    }

    /// For each vertex p of a facet, whether the dual Voronoi edge (a, b) meets the cocone of p: an end is
    /// in it, or the ends lie in opposite nappes. A nappe is convex, so otherwise it does not.
    #[inline]
    pub(crate) fn wishes(&self, canonical: &Canonical, facet: FacetId) -> [bool; 3] {
        let twin = canonical.twin(facet);
        let (a, b) = (facet.tet(), twin.tet());
        // From the other side the vertices come in opposite order, starting with any of them.
        let [i, j, k] = FACET_CORNERS[facet.corner()];
        let [x, y, z] = FACET_CORNERS[twin.corner()];
        let first = canonical.tets()[a.index()][i];
        let others = canonical.tets()[b.index()];
        let [l, m, n] = if others[x] == first {
            [x, z, y]
        } else if others[y] == first {
            [y, x, z]
        } else {
            [z, y, x]
        };
        let wishes = |at_a: u8, at_b: u8| {
            let between = Nappe::Between as u8;
            at_a == between || at_b == between || at_a != at_b
        };
        [
            wishes(self.nappe(a, i), self.nappe(b, l)),
            wishes(self.nappe(a, j), self.nappe(b, m)),
            wishes(self.nappe(a, k), self.nappe(b, n)),
        ]
    }

    /// How far from p the Voronoi edge dual to the facet crosses the plane through p across v_p; `None`
    /// where it does not.
    pub(crate) fn crossing(
        &self,
        canonical: &Canonical,
        facet: FacetId,
        vertex: VertexId,
    ) -> Option<f64> {
        let p = canonical.point(vertex);
        let normal = self.vectors[vertex.index()];
        let (s, t) = (facet.tet(), canonical.twin(facet).tet());
        let (s, t) = if canonical.is_finite(s) {
            (s, t)
        } else {
            (t, s)
        };
        let a = self.centers[s.index()] - p;
        let along = match canonical.is_finite(t) {
            true => self.centers[t.index()] - p - a,
            false => self.centers[t.index()],
        };
        let share = -normal.dot(a) / normal.dot(along);
        let end = if canonical.is_finite(t) {
            1.0
        } else {
            f64::INFINITY
        };
        (0.0..=end)
            .contains(&share)
            .then(|| (a + share * along).length())
    }
}

/// The Voronoi vertices, directions for those at infinity.
fn centers(canonical: &Canonical) -> Vec<DVec3> {
    let of_finite = |corners: [VertexId; 4]| {
        let [a, b, c, d] = corners;
        let (a, b, c, d) = (
            canonical.point(a),
            canonical.point(b),
            canonical.point(c),
            canonical.point(d),
        );
        circumcenter(a, b, c, d).unwrap_or_else(|| {
            // Too flat for doubles: as good as at infinity, on the side of the fourth corner.
            let normal = triangle::double_area_normal(a, b, c).normalize_or_zero();
            a + normal * 1e100
        })
    };
    let of_infinite = |corners: [VertexId; 4]| {
        let [a, b, c] = [0, 1, 2].map(|i| canonical.point(corners[i]));
        triangle::double_area_normal(a, b, c).normalize_or_zero()
    };
    let (finite, infinite) = canonical.tets().split_at(canonical.finite_count());
    let mut centers: Vec<DVec3> = Vec::with_capacity(canonical.tets().len());
    finite
        .par_iter()
        .map(|&tet| of_finite(tet))
        .collect_into_vec(&mut centers);
    centers.extend(infinite.iter().map(|&tet| of_infinite(tet)));
    centers
}

/// v_p: towards the farthest Voronoi vertex, or along the sum of the unit directions of the unbounded
/// Voronoi edges where there are any.
fn pole_vectors(canonical: &Canonical, centers: &[DVec3]) -> Vec<DVec3> {
    let mut farthest = vec![(0.0, TetId::NONE); canonical.vertex_count()];
    for (t, tet) in canonical.tets()[..canonical.finite_count()]
        .iter()
        .enumerate()
    {
        let square = centers[t].distance_squared(canonical.point(tet[0]));
        for vertex in tet {
            let best = &mut farthest[vertex.index()];
            if square > best.0 {
                *best = (square, TetId::new(t));
            }
        }
    }
    let mut vectors = vec![DVec3::ZERO; canonical.vertex_count()];
    for (t, tet) in canonical
        .tets()
        .iter()
        .enumerate()
        .skip(canonical.finite_count())
    {
        for vertex in &tet[..3] {
            vectors[vertex.index()] += centers[t];
        }
    }
    for (vertex, vector) in vectors.iter_mut().enumerate() {
        *vector = match farthest[vertex].1.some() {
            Some(tet) if *vector == DVec3::ZERO => {
                centers[tet.index()] - canonical.points()[vertex]
            }
            _ => *vector,
        }
        .normalize_or_zero();
    }
    vectors
}
