//! The validator: every defect, by id.

use crate::{FacetId, TetId, Tetrahedralization};
use pellicle_geometry::{DVec3, VertexId};
use pellicle_predicates::{Sign, lifted, orient3d};

/// What is wrong with a tetrahedralisation. One that comes from
/// [`tetrahedralize`](crate::tetrahedralize) has none.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Defect {
    /// A corner is not a vertex, or appears twice, or is infinite in a place where none may be.
    Corners(TetId),
    /// The twin of the facet's twin is not the facet.
    Twin(FacetId),
    /// The facet and its twin do not have the same vertices in opposite order.
    FacetMismatch(FacetId),
    /// A finite tetrahedron is flat or negative.
    Orientation(TetId),
    /// The vertex beyond the facet lies inside the sphere of the facet's tetrahedron, or the hull is not
    /// convex there.
    NotLocallyDelaunay(FacetId),
    /// A vertex lies inside the sphere of a tetrahedron.
    NotDelaunay(TetId, VertexId),
    /// The tetrahedron that the vertex names does not hold it; or none holds it.
    Incident(VertexId),
    /// A point that is hidden by its weight lies inside the sphere of a tetrahedron, or is a vertex.
    Hidden(VertexId),
    /// A duplicate does not equal its representative.
    Duplicate(VertexId),
    /// Vertices − edges + facets − tetrahedra, infinity included, is not 0 as on a 3-sphere; the value.
    Euler(i64),
}

/// The sign of the perturbed test whether a vertex is inside the sphere of four others.
type Inside<'a> = dyn Fn([VertexId; 4], VertexId) -> Sign + 'a;

impl Tetrahedralization<'_> {
    /// All defects of combinatorics, orientation, and the local Delaunay property, which implies the
    /// global one. Exact; O(n log n) time.
    pub fn validate(&self) -> Vec<Defect> {
        self.validate_by(&self.unweighted(), &[])
    }

    /// The in-sphere test, unfiltered.
    fn unweighted(&self) -> impl Fn([VertexId; 4], VertexId) -> Sign {
        |corners, vertex| {
            let [a, b, c, d] = self.positions(corners);
            lifted::insphere(a, b, c, d, self.points()[vertex.index()])
        }
    }

    /// [`validate`](Self::validate) with another test of spheres, and points that are no vertices.
    pub(crate) fn validate_by(&self, inside: &Inside, hidden: &[VertexId]) -> Vec<Defect> {
        let mut defects = Vec::new();
        self.validate_corners(&mut defects);
        if !defects.is_empty() {
            return defects; // nothing below could be asked
        }
        self.validate_twins(&mut defects);
        self.validate_vertices(hidden, &mut defects);
        self.validate_orientation(&mut defects);
        if defects.is_empty() {
            self.validate_euler(hidden.len(), &mut defects);
            self.validate_locally(inside, &mut defects);
            self.validate_hidden(inside, hidden, &mut defects);
        }
        defects
    }

    /// Every vertex inside the perturbed sphere of any tetrahedron, by brute force: O(vertices ×
    /// tetrahedra), for small sets.
    pub fn validate_globally(&self) -> Vec<Defect> {
        self.validate_globally_by(&self.unweighted())
    }

    /// [`validate_globally`](Self::validate_globally) with another test of spheres.
    pub(crate) fn validate_globally_by(&self, inside: &Inside) -> Vec<Defect> {
        let mut defects = Vec::new();
        for t in (0..self.tets().len()).map(TetId::new) {
            for vertex in (0..self.points().len()).map(VertexId::new) {
                let is_corner = self.corner_of(t, self.representative(vertex)).is_some();
                if !is_corner && self.holds_inside(inside, t, vertex) {
                    defects.push(Defect::NotDelaunay(t, vertex));
                }
            }
        }
        defects
    }

    fn validate_corners(&self, defects: &mut Vec<Defect>) {
        for (t, tet) in self.tets().iter().enumerate() {
            let finite = if t < self.finite_count() { 4 } else { 3 };
            let in_range = tet[..finite]
                .iter()
                .all(|vertex| vertex.index() < self.points().len());
            let infinite = tet[finite..].iter().all(|&v| v == Self::INFINITE);
            let distinct = (0..4).all(|i| (0..i).all(|j| tet[i] != tet[j]));
            let twins_in_range = self.twins()[t]
                .iter()
                .all(|twin| twin.tet().index() < self.tets().len());
            if !(in_range && infinite && distinct && twins_in_range) {
                defects.push(Defect::Corners(TetId::new(t)));
            }
        }
    }

    fn validate_twins(&self, defects: &mut Vec<Defect>) {
        for t in 0..self.tets().len() {
            for corner in 0..4 {
                let facet = FacetId::of(TetId::new(t), corner);
                let twin = self.twin(facet);
                if self.twin(twin) != facet || twin.tet() == facet.tet() {
                    defects.push(Defect::Twin(facet));
                }
                let [a, b, c] = self.facet(twin);
                let turned = [[c, b, a], [b, a, c], [a, c, b]];
                if !turned.contains(&self.facet(facet)) {
                    defects.push(Defect::FacetMismatch(facet));
                }
            }
        }
    }

    fn validate_vertices(&self, hidden: &[VertexId], defects: &mut Vec<Defect>) {
        for vertex in (0..self.points().len()).map(VertexId::new) {
            let representative = self.representative(vertex);
            if self.points()[vertex.index()] != self.points()[representative.index()] {
                defects.push(Defect::Duplicate(vertex));
            }
            let held = self.incident(vertex).filter(|tet| {
                self.is_finite(*tet) && self.corner_of(*tet, representative).is_some()
            });
            if hidden.binary_search(&representative).is_ok() {
                if self.incident(vertex).is_some() {
                    defects.push(Defect::Hidden(vertex));
                }
            } else if held.is_none() {
                defects.push(Defect::Incident(vertex));
            }
        }
    }

    fn validate_orientation(&self, defects: &mut Vec<Defect>) {
        for (t, &tet) in self.finite_tets().iter().enumerate() {
            let [a, b, c, d] = self.positions(tet);
            if orient3d(a, b, c, d) != Sign::Positive {
                defects.push(Defect::Orientation(TetId::new(t)));
            }
        }
    }

    /// Over the one-point compactification, a 3-sphere.
    fn validate_euler(&self, hidden: usize, defects: &mut Vec<Defect>) {
        let mut edges: Vec<(VertexId, VertexId)> = self
            .tets()
            .iter()
            .flat_map(|tet| {
                [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)]
                    .map(|(i, j)| (tet[i].min(tet[j]), tet[i].max(tet[j])))
            })
            .collect();
        edges.sort_unstable();
        edges.dedup();
        let tets = self.tets().len() as i64;
        let vertices = self.vertex_count() as i64 - hidden as i64 + 1;
        let euler = vertices - edges.len() as i64 + 2 * tets - tets;
        if euler != 0 {
            defects.push(Defect::Euler(euler));
        }
    }

    fn validate_locally(&self, inside: &Inside, defects: &mut Vec<Defect>) {
        for t in 0..self.tets().len() {
            for corner in 0..4 {
                let facet = FacetId::of(TetId::new(t), corner);
                let twin = self.twin(facet);
                let beyond = self.tet(twin.tet())[twin.corner()];
                if beyond != Self::INFINITE && self.holds_inside(inside, facet.tet(), beyond) {
                    defects.push(Defect::NotLocallyDelaunay(facet));
                }
            }
        }
    }

    /// A hidden point is inside no sphere if it is not inside that of the tetrahedron that contains it.
    fn validate_hidden(&self, inside: &Inside, hidden: &[VertexId], defects: &mut Vec<Defect>) {
        for &vertex in hidden {
            let contained_in = self.containing(self.points()[vertex.index()]);
            if contained_in.is_none_or(|tet| self.holds_inside(inside, tet, vertex)) {
                defects.push(Defect::Hidden(vertex));
            }
        }
    }

    /// A finite tetrahedron that contains the point, by a walk as long as there are tetrahedra at most.
    fn containing(&self, p: DVec3) -> Option<TetId> {
        let mut tet = TetId(0);
        for _ in 0..=self.tets().len() {
            let beyond = (0..4)
                .map(|corner| FacetId::of(tet, corner))
                .find(|&facet| {
                    let [a, b, c] = self.facet(facet).map(|v| self.points()[v.index()]);
                    orient3d(a, b, c, p) == Sign::Negative
                });
            match beyond.map(|facet| self.twin(facet).tet()) {
                None => return Some(tet),
                Some(next) if self.is_finite(next) => tet = next,
                Some(_) => return None,
            }
        }
        None
    }

    /// Whether the vertex is inside the perturbed sphere of the tetrahedron, by the unfiltered signs.
    fn holds_inside(&self, inside: &Inside, tet: TetId, vertex: VertexId) -> bool {
        let e = self.points()[vertex.index()];
        if self.is_finite(tet) {
            return inside(self.tet(tet), vertex) == Sign::Positive;
        }
        let corners = self.tet(tet);
        let [a, b, c] = [corners[0], corners[1], corners[2]].map(|v| self.points()[v.index()]);
        match orient3d(a, b, c, e) {
            Sign::Positive => true,
            Sign::Negative => false,
            Sign::Zero => {
                let behind = self.twin(FacetId::of(tet, 3)).tet();
                // On the facet's plane the sphere behind it is the facet's circle.
                inside(self.tet(behind), vertex) == Sign::Positive
            }
        }
    }

    fn positions(&self, tet: [VertexId; 4]) -> [DVec3; 4] {
        tet.map(|v| self.points()[v.index()])
    }
}
