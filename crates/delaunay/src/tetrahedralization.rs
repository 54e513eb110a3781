//! The tetrahedralisation: two flat arrays.

use crate::{FacetId, TetId, id::facet_vertices};
use pellicle_geometry::{DVec3, VertexId};
use rayon::prelude::*;
use std::sync::atomic::{AtomicU32, Ordering::Relaxed};

/// The Delaunay tetrahedralisation of a slice of points: made by [`tetrahedralize`](crate::tetrahedralize).
///
/// ```text
///   tets[t]  = [v0, v1, v2, v3]     orient3d(v0, v1, v2, v3) is positive
///   twins[t] = [f0, f1, f2, f3]     f_i: the facet opposite v_i, seen from the neighbour there
/// ```
///
/// The finite tetrahedra come first; the infinite ones, one a facet of the convex hull, have
/// [`Tetrahedralization::INFINITE`] as their corner 3 and are oriented as if it were any point beyond that
/// facet.
#[derive(Clone, Debug)]
pub struct Tetrahedralization<'a> {
    points: &'a [DVec3],
    tets: Vec<[VertexId; 4]>,
    twins: Vec<[FacetId; 4]>,
    finite: usize,
    /// By vertex, one tetrahedron at it; a duplicate has its representative's.
    incident: Vec<TetId>,
    /// (duplicate, representative), sorted.
    duplicates: Vec<(VertexId, VertexId)>,
}

impl<'a> Tetrahedralization<'a> {
    /// The vertex at infinity.
    pub const INFINITE: VertexId = VertexId::NONE;

    pub(crate) fn from_arrays(
        points: &'a [DVec3],
        tets: Vec<[VertexId; 4]>,
        twins: Vec<[FacetId; 4]>,
        finite: usize,
        mut incident: Vec<TetId>,
        duplicates: Vec<(VertexId, VertexId)>,
    ) -> Self {
        for &(duplicate, representative) in &duplicates {
            incident[duplicate.index()] = incident[representative.index()];
        }
        Self {
            points,
            tets,
            twins,
            finite,
            incident,
            duplicates,
        }
    }

    /// The points, as the caller gave them.
    #[inline]
    pub fn points(&self) -> &'a [DVec3] {
        self.points
    }

    /// The corners of all tetrahedra, finite ones first.
    #[inline]
    pub fn tets(&self) -> &[[VertexId; 4]] {
        &self.tets
    }

    /// The corners of the finite tetrahedra; their ids are 0 to [`finite_count`](Self::finite_count).
    #[inline]
    pub fn finite_tets(&self) -> &[[VertexId; 4]] {
        &self.tets[..self.finite]
    }

    /// By tetrahedron and corner, the facet opposite that corner as seen from the other side.
    #[inline]
    pub fn twins(&self) -> &[[FacetId; 4]] {
        &self.twins
    }

    /// How many tetrahedra are finite.
    #[inline]
    pub fn finite_count(&self) -> usize {
        self.finite
    }

    /// Whether none of the tetrahedron's corners is at infinity.
    #[inline]
    pub fn is_finite(&self, tet: TetId) -> bool {
        tet.index() < self.finite
    }

    /// The four corners of a tetrahedron.
    #[inline]
    pub fn tet(&self, tet: TetId) -> [VertexId; 4] {
        self.tets[tet.index()]
    }

    /// The same facet seen from the other side.
    #[inline]
    pub fn twin(&self, facet: FacetId) -> FacetId {
        self.twins[facet.tet().index()][facet.corner()]
    }

    /// The three vertices of a facet, counter-clockwise seen from its tetrahedron. One is infinite where
    /// both tetrahedra are.
    #[inline]
    pub fn facet(&self, facet: FacetId) -> [VertexId; 3] {
        facet_vertices(self.tet(facet.tet()), facet.corner())
    }

    /// Every facet once, seen from the tetrahedron with the lower id; those between two infinite
    /// tetrahedra excepted.
    pub fn facets(&self) -> impl Iterator<Item = FacetId> + '_ {
        (0..self.finite).flat_map(move |t| {
            (0..4)
                .map(move |corner| FacetId::of(TetId::new(t), corner))
                .filter(|&facet| facet.tet() < self.twin(facet).tet())
        })
    }

    /// Where `vertex` stands among the corners of `tet`.
    #[inline]
    pub fn corner_of(&self, tet: TetId, vertex: VertexId) -> Option<usize> {
        self.tet(tet).iter().position(|&corner| corner == vertex)
    }

    /// A finite tetrahedron at the vertex, or at its representative. `None` for the vertex at infinity and
    /// for ids out of range.
    #[inline]
    pub fn incident(&self, vertex: VertexId) -> Option<TetId> {
        self.incident.get(vertex.index()).and_then(|tet| tet.some())
    }

    /// (duplicate, representative) for each point that equals one with a lower id, sorted.
    #[inline]
    pub fn duplicates(&self) -> &[(VertexId, VertexId)] {
        &self.duplicates
    }

    /// The vertex that stands for this point: itself, unless it equals one with a lower id. O(log n).
    pub fn representative(&self, vertex: VertexId) -> VertexId {
        match self.duplicates.binary_search_by_key(&vertex, |pair| pair.0) {
            Ok(place) => self.duplicates[place].1,
            Err(_) => vertex,
        }
    }

    /// How many points are vertices: all but the duplicates.
    #[inline]
    pub fn vertex_count(&self) -> usize {
        self.points.len() - self.duplicates.len()
    }
}

/// By vertex the last of these tetrahedra that it is a corner of, or none.
pub(crate) fn last_incident(vertices: usize, tets: &[[VertexId; 4]]) -> Vec<TetId> {
    const CHUNK: usize = 1 << 15;
    // One more than the tetrahedron's number.
    let vertices = (0..vertices).into_par_iter();
    let last: Vec<AtomicU32> = vertices.map(|_| AtomicU32::new(0)).collect();
    let chunks = tets.par_chunks(CHUNK).enumerate();
    chunks.for_each(|(chunk, tets)| {
        let before = chunk * CHUNK;
        // From the last one down, so that most of the time there is nothing to write.
        for (k, tet) in tets.iter().enumerate().rev() {
            let number = (before + k) as u32 + 1;
            for vertex in tet {
                let last = &last[vertex.index()];
                if last.load(Relaxed) < number {
                    last.fetch_max(number, Relaxed);
                }
            }
        }
    });
    let tet = |number: AtomicU32| TetId(number.into_inner().wrapping_sub(1));
    last.into_iter().map(tet).collect()
}
