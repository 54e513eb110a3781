//! The growing tetrahedralisation: flat arrays over vertices in insertion order.
//!
//! Inside the kernel vertex 0 is the vertex at infinity and vertex k + 1 is the k-th point of the order of
//! insertion, so points that are inserted together lie together in memory. Corner 3 is the only one that
//! may be infinite.

use super::{cavity::Cavity, weighted::Weighted};
use crate::{Error, FacetId, TetId, id::FACET_CORNERS};
use glam::DVec3;
use pellicle_geometry::{Aabb, VertexId};
use pellicle_predicates::StaticFilter;

/// The vertex at infinity, inside the kernel.
pub(crate) const INFINITE: VertexId = VertexId(0);

/// Facet ids leave 30 bits for tetrahedra.
pub(super) const MOST_TETS: usize = 1 << 30;

/// What the current insertion knows of a tetrahedron.
#[derive(Clone, Copy, PartialEq, Eq)]
#[repr(u8)]
pub(super) enum Mark {
    Untested,
    InConflict,
    Free,
    Vacant,
}

pub(super) struct Kernel {
    /// By vertex; the first stands for infinity and is never read.
    pub(super) points: Vec<DVec3>,
    /// By vertex, or none: of a regular triangulation.
    pub(super) weights: Vec<f64>,
    /// Four corners each, positively oriented; an infinite one as if its vertex at infinity were any point
    /// beyond its hull facet.
    pub(super) tets: Vec<[VertexId; 4]>,
    /// By tetrahedron and corner: the facet opposite the corner, seen from the other side.
    pub(super) twins: Vec<[FacetId; 4]>,
    pub(super) marks: Vec<Mark>,
    /// Slots of `tets` that hold no tetrahedron.
    pub(super) vacant: Vec<TetId>,
    pub(super) filter: StaticFilter,
    pub(super) cavity: Cavity,
    /// A tetrahedron of the last insertion: where the next walk starts.
    pub(super) recent: TetId,
}

impl Kernel {
    /// One tetrahedron of the first four points of `order`, which are positively oriented, and four
    /// infinite ones around it.
    pub(super) fn of_first_tetrahedron(points: &[DVec3], order: &[u32]) -> Self {
        let bounds = Aabb::of_points(points);
        let mut sorted = Vec::with_capacity(order.len() + 1);
        sorted.push(DVec3::ZERO);
        sorted.extend(order.iter().map(|&i| points[i as usize]));

        // Samples of volumes have 6.8 tetrahedra a point; memory that is not touched costs nothing.
        let expected = (7 * order.len()).min(MOST_TETS);
        let mut kernel = Self {
            cavity: Cavity::for_vertices(sorted.len()),
            points: sorted,
            weights: Vec::new(),
            tets: Vec::with_capacity(expected),
            twins: Vec::with_capacity(expected),
            marks: Vec::with_capacity(expected),
            vacant: Vec::new(),
            filter: StaticFilter::from_bounds(bounds.min, bounds.max),
            recent: TetId(0),
        };
        kernel.push_first_tetrahedron();
        kernel
    }

    pub(super) fn push_first_tetrahedron(&mut self) {
        let first = [1, 2, 3, 4].map(VertexId);
        self.push(first);
        for corners in FACET_CORNERS {
            // The facet seen from outside, so that the point at infinity sees it counter-clockwise.
            let [a, b, c] = corners.map(|i| first[i]);
            self.push([a, c, b, INFINITE]);
        }
        // Each pair of the five shares one facet: the one opposite the corner that the other lacks.
        for t in 0..5 {
            for corner in 0..4 {
                let facet = without(self.tets[t], corner);
                for other in (0..5).filter(|&other| other != t) {
                    for other_corner in 0..4 {
                        if without(self.tets[other], other_corner) == facet {
                            self.twins[t][corner] = FacetId::of(TetId::new(other), other_corner);
                        }
                    }
                }
            }
        }
    }

    fn push(&mut self, corners: [VertexId; 4]) {
        self.tets.push(corners);
        self.twins.push([FacetId::NONE; 4]);
        self.marks.push(Mark::Untested);
    }

    /// A slot for a new tetrahedron.
    #[inline]
    pub(super) fn allocate(&mut self) -> Result<TetId, Error> {
        if let Some(slot) = self.vacant.pop() {
            return Ok(slot);
        }
        if self.tets.len() >= MOST_TETS {
            return Err(Error::TooMany {
                of: "tetrahedra",
                limit: MOST_TETS,
            });
        }
        self.push([INFINITE; 4]);
        Ok(TetId::new(self.tets.len() - 1))
    }

    /// Inserts the point at `position` of the order.
    pub(super) fn insert(&mut self, position: usize) -> Result<(), Error> {
        let vertex = VertexId::new(position + 1);
        let p = self.points[vertex.index()];
        let start = self.locate(p);
        match self.weights.get(vertex.index()) {
            None => self.dig(start, p),
            Some(&weight) => {
                let weighted = Weighted {
                    position: p,
                    weight,
                };
                if !self.is_in_conflict(start, weighted) {
                    return Ok(()); // hidden
                }
                self.dig(start, weighted);
            }
        }
        self.retriangulate(vertex)
    }

    #[inline]
    pub(super) fn point(&self, vertex: VertexId) -> DVec3 {
        self.points[vertex.index()]
    }
}

/// The corners but one, sorted.
fn without(tet: [VertexId; 4], corner: usize) -> [VertexId; 3] {
    let mut facet = FACET_CORNERS[corner].map(|i| tet[i]);
    facet.sort_unstable();
    facet
}
