//! Sizes of tetrahedra and facets, over the spacing of the points there.

use crate::canonical::Canonical;
use glam::DVec3;
use pellicle_delaunay::{FacetId, TetId, circumcenter};
use pellicle_geometry::{VertexId, triangle};

/// The spacing at a vertex is the distance of so many Delaunay neighbours, the nearest ones.
const NEIGHBORS: usize = 5;

/// A vertex's nearest Delaunay neighbours with squared distances, nearest first.
type Nearest = [(f64, VertexId); NEIGHBORS];

/// See the module.
pub(super) struct Scales<'s> {
    pub(super) canonical: &'s Canonical<'s>,
    /// By vertex, the distance of the farthest of its [`NEIGHBORS`]; positive.
    pub(super) spacings: Vec<f64>,
    nearest: Vec<Nearest>,
    /// By finite tetrahedron, the circumcenter; infinite where doubles give none.
    centers: Vec<DVec3>,
    radii: Vec<f64>,
}

impl<'s> Scales<'s> {
    /// O(n) in the number of tetrahedra.
    pub(super) fn of(canonical: &'s Canonical<'s>) -> Self {
        let finite = &canonical.tets()[..canonical.finite_count()];
        let center = |tet: &[VertexId; 4]| {
            let [a, b, c, d] = tet.map(|v| canonical.point(v));
            circumcenter(a, b, c, d).unwrap_or(DVec3::INFINITY)
        };
        let centers: Vec<DVec3> = finite.iter().map(center).collect();
        let radius = |(center, tet): (&DVec3, &[VertexId; 4])| {
            let radius = center.distance(canonical.point(tet[0]));
            if radius.is_nan() {
                f64::INFINITY
            } else {
                radius
            }
        };
        let nearest = nearest(canonical);
        let spacing = |nearest: &Nearest| {
            let squares = nearest.iter().map(|near| near.0);
            let known = squares.filter(|square| square.is_finite());
            known.fold(f64::MIN_POSITIVE, f64::max).sqrt()
        };
        Self {
            canonical,
            spacings: nearest.iter().map(spacing).collect(),
            nearest,
            radii: centers.iter().zip(finite).map(radius).collect(),
            centers,
        }
    }

    /// The circumcenter of a finite tetrahedron.
    pub(super) fn center(&self, tet: TetId) -> DVec3 {
        self.centers[tet.index()]
    }

    /// The circumradius; infinite at infinity.
    pub(super) fn radius(&self, tet: TetId) -> f64 {
        self.radii
            .get(tet.index())
            .copied()
            .unwrap_or(f64::INFINITY)
    }

    /// The circumradius over the spacing; infinite at infinity.
    pub(super) fn tet_width(&self, tet: TetId) -> f64 {
        let radius = self.radius(tet);
        if radius.is_infinite() {
            return radius;
        }
        radius / self.spacing(&self.canonical.tets()[tet.index()])
    }

    /// The circumradius of a facet over the spacing; infinite where it has no area.
    pub(super) fn facet_width(&self, facet: FacetId) -> f64 {
        let corners = self.canonical.facet(facet);
        let [a, b, c] = corners.map(|v| self.canonical.point(v));
        let product = a.distance(b) * b.distance(c) * c.distance(a);
        let width = product / (4.0 * triangle::area(a, b, c)) / self.spacing(&corners);
        if width.is_nan() { f64::INFINITY } else { width }
    }

    /// The largest spacing at some vertices.
    fn spacing(&self, vertices: &[VertexId]) -> f64 {
        let spacings = vertices.iter().map(|v| self.spacings[v.index()]);
        spacings.fold(0.0, f64::max)
    }

    /// How many of the nearest neighbours are in a set, as a share.
    pub(super) fn share_of_neighbors(&self, vertex: VertexId, set: &[bool]) -> f64 {
        let neighbors = self.nearest[vertex.index()].iter().map(|near| near.1);
        let known = neighbors.filter(|&neighbor| neighbor != VertexId::NONE);
        known.filter(|v| set[v.index()]).count() as f64 / NEIGHBORS as f64
    }

    /// Whether a vertex is much farther from its neighbours than the nearest of them is from its own.
    pub(super) fn is_remote(&self, vertex: VertexId) -> bool {
        let (_, neighbor) = self.nearest[vertex.index()][0];
        let spacing = |v: VertexId| self.spacings.get(v.index()).copied().unwrap_or(0.0);
        spacing(vertex) > 1.5 * spacing(neighbor)
    }

    /// 1 − min(cos φ, cos ψ), with φ and ψ the angles in which the facet meets the circumspheres of the
    /// tetrahedra at it (Labatut et al. 2009): 0 where both spheres are nearly flat there, as at a
    /// well-sampled surface, up to 2.
    pub(super) fn facet_bend(&self, facet: FacetId) -> f64 {
        let cosine = |facet: FacetId| {
            let radius = self.radius(facet.tet());
            if radius.is_infinite() {
                return 1.0;
            }
            let corners = self.canonical.facet(facet);
            // The tetrahedron sees the corners turn counter-clockwise: this points into it.
            let inward = self.normal(&corners);
            let from = self.canonical.point(corners[0]);
            (inward.dot(self.center(facet.tet()) - from) / radius).clamp(-1.0, 1.0)
        };
        1.0 - cosine(facet).min(cosine(self.canonical.twin(facet)))
    }

    /// The unit normal of a triangle, on the side from which its vertices turn counter-clockwise.
    pub(super) fn normal(&self, corners: &[VertexId]) -> DVec3 {
        let [a, b, c] = [0, 1, 2].map(|i| self.canonical.point(corners[i]));
        triangle::double_area_normal(a, b, c).normalize_or_zero()
    }

    /// A facet of a finite tetrahedron that has the point behind it, as far as doubles tell.
    pub(super) fn facet_towards(&self, tet: TetId, point: DVec3) -> Option<FacetId> {
        let mut facets = (0..4).map(|corner| FacetId::of(tet, corner));
        facets.find(|&facet| {
            let corners = self.canonical.facet(facet);
            let from = self.canonical.point(corners[0]);
            self.normal(&corners).dot(point - from) < 0.0
        })
    }
}

fn nearest(canonical: &Canonical) -> Vec<Nearest> {
    let nothing = [(f64::INFINITY, VertexId::NONE); NEIGHBORS];
    let mut nearest = vec![nothing; canonical.vertex_count()];
    let mut note = |vertex: VertexId, neighbor: VertexId, square: f64| {
        let list = &mut nearest[vertex.index()];
        // Of equally near ones, those met first: tetrahedra are in canonical order.
        if square >= list[NEIGHBORS - 1].0 || list.iter().any(|near| near.1 == neighbor) {
            return;
        }
        let place = list.partition_point(|near| near.0 <= square);
        list[place..].rotate_right(1);
        list[place] = (square, neighbor);
    };
    for tet in &canonical.tets()[..canonical.finite_count()] {
        for (i, j) in [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)] {
            let (p, q) = (canonical.point(tet[i]), canonical.point(tet[j]));
            note(tet[i], tet[j], p.distance_squared(q));
            note(tet[j], tet[i], p.distance_squared(q));
        }
    }
    nearest
}
