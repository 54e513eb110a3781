//! The regular triangulation of points with weights.

use crate::{
    AroundEdge, AroundVertex, Defect, Error, FacetId, Options, TetId, Tetrahedralization, build,
};
use pellicle_geometry::{DVec3, Progress, VertexId};
use pellicle_predicates::lifted;

/// The regular triangulation, or weighted Delaunay tetrahedralisation, of `points` with `weights` (one each, in
/// the square of the points' unit).
///
/// Seen from x a point p with weight w has the power |x − p|² − w. A tetrahedron belongs to the triangulation when
/// the sphere that is orthogonal to its four corners has no point with a smaller power than theirs; that is, when
/// it is a facet of the lower hull of the lifts (p, |p|² − w) (Aurenhammer 1987, Edelsbrunner and Shah 1996).
/// With equal weights it is the Delaunay tetrahedralisation. Points whose lift is above the hull are *hidden*:
/// the corners of no tetrahedron.
///
/// The result is uniquely defined, however degenerate the lifts: they are raised symbolically by the
/// lexicographic rank of their points, as [`lifted::power_test`] says. That hides no point: of the
/// points over a common facet of the hull the one raised most is a corner of any simplex that it could be hidden
/// by. So the hidden points are those strictly above the hull of the lifts as they are.
///
/// Of equal points the heaviest stands for all. One as heavy is its duplicate, a lighter one is hidden. Weights
/// may have any sign and magnitude; adding the same number to all of them changes nothing. Time and memory are
/// those of [`tetrahedralize`](crate::tetrahedralize), plus eight bytes a point.
///
/// # Errors
///
/// Those of [`tetrahedralize`](crate::tetrahedralize); weights that are not finite or not as many as the points.
///
/// ```
/// use pellicle_delaunay::{Options, tetrahedralize_weighted};
/// use pellicle_geometry::{DVec3, VertexId};
///
/// let points = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z, DVec3::splat(0.25)];
/// // The last point is at the height 3 · 0.25² − w, the sphere's hyperplane above it at 0.75.
/// let hidden = |w| {
///     let weights = [0.0, 0.0, 0.0, 0.0, w];
///     let regular = tetrahedralize_weighted(&points, &weights, &Options::default())?;
///     Ok::<_, pellicle_delaunay::Error>((regular.finite_count(), regular.hidden().to_vec()))
/// };
/// assert_eq!(hidden(0.0)?, (4, vec![]));
/// assert_eq!(hidden(-0.5625)?, (4, vec![]));
/// assert_eq!(hidden(-0.5626)?, (1, vec![VertexId(4)]));
/// # Ok::<(), pellicle_delaunay::Error>(())
/// ```
pub fn tetrahedralize_weighted<'a>(
    points: &'a [DVec3],
    weights: &'a [f64],
    options: &Options,
) -> Result<RegularTetrahedralization<'a>, Error> {
    tetrahedralize_weighted_with(points, weights, options, &())
}

/// [`tetrahedralize_weighted`], watched by `progress`, whose `Break` makes it return [`Error::Cancelled`] within
/// milliseconds.
pub fn tetrahedralize_weighted_with<'a>(
    points: &'a [DVec3],
    weights: &'a [f64],
    options: &Options,
    progress: &dyn Progress,
) -> Result<RegularTetrahedralization<'a>, Error> {
    let tetrahedra = build::tetrahedralize(points, Some(weights), options, progress)?;
    let is_hidden = |&vertex: &VertexId| {
        tetrahedra.incident(vertex).is_none() && tetrahedra.representative(vertex) == vertex
    };
    let hidden = (0..points.len())
        .map(VertexId::new)
        .filter(is_hidden)
        .collect();
    Ok(RegularTetrahedralization {
        tetrahedra,
        weights,
        hidden,
    })
}

/// The regular triangulation of a slice of points with weights: made by [`tetrahedralize_weighted`].
///
/// Tetrahedra, facets and the vertex at infinity are as in a [`Tetrahedralization`]; every point is a vertex, the
/// [duplicate](Self::duplicates) of another, or [hidden](Self::hidden).
#[derive(Clone, Debug)]
pub struct RegularTetrahedralization<'a> {
    /// Its spheres are empty of *powers*, not of points: nothing that asks for spheres may be asked of it.
    tetrahedra: Tetrahedralization<'a>,
    weights: &'a [f64],
    /// Sorted.
    hidden: Vec<VertexId>,
}

impl<'a> RegularTetrahedralization<'a> {
    /// The vertex at infinity.
    pub const INFINITE: VertexId = Tetrahedralization::INFINITE;

    /// The points, as the caller gave them.
    pub fn points(&self) -> &'a [DVec3] {
        self.tetrahedra.points()
    }

    /// The weights, as the caller gave them.
    pub fn weights(&self) -> &'a [f64] {
        self.weights
    }

    /// The points that are the corners of no tetrahedron because of the weights, by id, duplicates excepted.
    pub fn hidden(&self) -> &[VertexId] {
        &self.hidden
    }

    /// Whether the point, or the one that it is a duplicate of, is hidden. O(log n).
    pub fn is_hidden(&self, vertex: VertexId) -> bool {
        let vertex = self.representative(vertex);
        self.hidden.binary_search(&vertex).is_ok()
    }

    /// (duplicate, representative) for each point that equals one with a lower id in position and weight, and no
    /// heavier one; sorted. The representative may be hidden.
    pub fn duplicates(&self) -> &[(VertexId, VertexId)] {
        self.tetrahedra.duplicates()
    }

    /// The point that stands for this one: itself, unless it is a duplicate. O(log n).
    pub fn representative(&self, vertex: VertexId) -> VertexId {
        self.tetrahedra.representative(vertex)
    }

    /// How many points are vertices: neither duplicates nor hidden.
    pub fn vertex_count(&self) -> usize {
        self.tetrahedra.vertex_count() - self.hidden.len()
    }

    /// The corners of all tetrahedra, finite ones first.
    pub fn tets(&self) -> &[[VertexId; 4]] {
        self.tetrahedra.tets()
    }

    /// The corners of the finite tetrahedra; their ids are 0 to [`finite_count`](Self::finite_count).
    pub fn finite_tets(&self) -> &[[VertexId; 4]] {
        self.tetrahedra.finite_tets()
    }

    /// By tetrahedron and corner, the facet opposite that corner as seen from the other side.
    pub fn twins(&self) -> &[[FacetId; 4]] {
        self.tetrahedra.twins()
    }

    /// How many tetrahedra are finite.
    pub fn finite_count(&self) -> usize {
        self.tetrahedra.finite_count()
    }

    /// Whether none of the tetrahedron's corners is at infinity.
    pub fn is_finite(&self, tet: TetId) -> bool {
        self.tetrahedra.is_finite(tet)
    }

    /// The four corners of a tetrahedron.
    pub fn tet(&self, tet: TetId) -> [VertexId; 4] {
        self.tetrahedra.tet(tet)
    }

    /// The same facet seen from the other side.
    pub fn twin(&self, facet: FacetId) -> FacetId {
        self.tetrahedra.twin(facet)
    }

    /// The three vertices of a facet, counter-clockwise seen from its tetrahedron. One is infinite where both
    /// tetrahedra are.
    pub fn facet(&self, facet: FacetId) -> [VertexId; 3] {
        self.tetrahedra.facet(facet)
    }

    /// Every facet once, seen from the tetrahedron with the lower id; those between two infinite tetrahedra
    /// excepted.
    pub fn facets(&self) -> impl Iterator<Item = FacetId> + '_ {
        self.tetrahedra.facets()
    }

    /// Where `vertex` stands among the corners of `tet`.
    pub fn corner_of(&self, tet: TetId, vertex: VertexId) -> Option<usize> {
        self.tetrahedra.corner_of(tet, vertex)
    }

    /// A finite tetrahedron at the vertex, or at its representative. `None` for hidden points, for the vertex at
    /// infinity and for ids out of range.
    pub fn incident(&self, vertex: VertexId) -> Option<TetId> {
        self.tetrahedra.incident(vertex)
    }

    /// As [`Tetrahedralization::around_edge`].
    pub fn around_edge(&self, tet: TetId, from: VertexId, to: VertexId) -> Option<AroundEdge<'_>> {
        self.tetrahedra.around_edge(tet, from, to)
    }

    /// As [`Tetrahedralization::around_vertex`]; empty for hidden points.
    pub fn around_vertex(&self, vertex: VertexId) -> AroundVertex<'_> {
        self.tetrahedra.around_vertex(vertex)
    }

    /// All defects of combinatorics and orientation, of the local regularity, which implies the global one, and
    /// of hidden points that should be vertices. Exact; O(n log n) time, and a walk for each hidden point.
    pub fn validate(&self) -> Vec<Defect> {
        self.tetrahedra.validate_by(
            &|corners, vertex| self.power_test(corners, vertex),
            &self.hidden,
        )
    }

    /// Every point inside the perturbed sphere of any tetrahedron, by brute force: O(points × tetrahedra), for
    /// small sets.
    pub fn validate_globally(&self) -> Vec<Defect> {
        self.tetrahedra
            .validate_globally_by(&|corners, vertex| self.power_test(corners, vertex))
    }

    /// Positive when the vertex is inside the perturbed sphere of the positive tetrahedron, unfiltered.
    fn power_test(&self, corners: [VertexId; 4], vertex: VertexId) -> pellicle_predicates::Sign {
        let [a, b, c, d] = corners.map(|v| self.points()[v.index()]);
        let [wa, wb, wc, wd] = corners.map(|v| self.weights[v.index()]);
        let (e, we) = (self.points()[vertex.index()], self.weights[vertex.index()]);
        lifted::power_test(a, b, c, d, e, [wa, wb, wc, wd, we])
    }
}

#[cfg(test)]
mod tests;
