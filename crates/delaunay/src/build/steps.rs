//! A kernel that lives on, changed a step at a time: what the dynamic tetrahedralisation asks for. How
//! tetrahedra, twins and marks are stored is known up to here.

use super::{
    cavity::Cavity,
    first,
    kernel::{INFINITE, Kernel, MOST_TETS, Mark},
};
use crate::{Error, FacetId, TetId, id::facet_vertices};
use glam::DVec3;
use pellicle_geometry::{Aabb, VertexId};
use pellicle_predicates::StaticFilter;
use pellicle_spatial::brio;

/// Fewer points than this are inserted as they come: an order costs more than it saves.
const FEWEST_TO_ORDER: usize = 64;

/// A kernel between insertions and removals. Vertex 0 is the one at infinity.
pub(crate) struct Stepwise {
    kernel: Kernel,
    /// The tetrahedra that are to leave.
    hole: Vec<TetId>,
    link: Vec<LinkFacet>,
}

/// A facet of the link of a vertex: opposite it, in one of its tetrahedra.
#[derive(Clone, Copy)]
pub(crate) struct LinkFacet {
    /// Counter-clockwise seen from the vertex.
    pub(crate) corners: [VertexId; 3],
    /// The facet seen from the other side.
    pub(crate) outer: FacetId,
}

impl LinkFacet {
    /// Whether none of its corners is at infinity.
    #[inline]
    pub(crate) fn is_finite(&self) -> bool {
        !self.corners.contains(&INFINITE)
    }
}

impl Stepwise {
    /// A kernel without points and tetrahedra.
    pub(crate) fn new() -> Self {
        let kernel = Kernel {
            points: vec![DVec3::NAN],
            weights: Vec::new(),
            tets: Vec::new(),
            twins: Vec::new(),
            marks: Vec::new(),
            vacant: Vec::new(),
            filter: StaticFilter::from_bounds(DVec3::ZERO, DVec3::ZERO),
            cavity: Cavity::for_vertices(1),
            recent: TetId(0),
        };
        Self {
            kernel,
            hole: Vec::new(),
            link: Vec::new(),
        }
    }

    // What is there.

    #[inline]
    pub(crate) fn point(&self, vertex: VertexId) -> DVec3 {
        self.kernel.points[vertex.index()]
    }

    #[inline]
    pub(crate) fn corners(&self, tet: TetId) -> [VertexId; 4] {
        self.kernel.tets[tet.index()]
    }

    #[inline]
    pub(crate) fn twin(&self, facet: FacetId) -> FacetId {
        self.kernel.twins[facet.tet().index()][facet.corner()]
    }

    /// Tetrahedra are named by ids below this number, not all of them in use.
    #[inline]
    pub(crate) fn tet_slots(&self) -> usize {
        self.kernel.tets.len()
    }

    /// Whether the id names a tetrahedron, between two steps.
    #[inline]
    pub(crate) fn is_in_use(&self, tet: TetId) -> bool {
        let mark = self.kernel.marks.get(tet.index());
        mark.is_some_and(|mark| !matches!(mark, Mark::InConflict | Mark::Vacant))
    }

    /// A tetrahedron made by the last step.
    #[inline]
    pub(crate) fn recent(&self) -> Option<TetId> {
        (self.tet_slots() > 0).then_some(self.kernel.recent)
    }

    // Points.

    /// Puts a point into the slot of a vertex, which may be the one after the last.
    pub(crate) fn set_point(&mut self, vertex: VertexId, p: DVec3) {
        let points = &mut self.kernel.points;
        if vertex.index() == points.len() {
            points.push(p);
            self.kernel.cavity.make_room(points.len());
        } else {
            points[vertex.index()] = p;
        }
    }

    /// From now on all points lie in this box.
    pub(crate) fn set_bounds(&mut self, bounds: Aabb) {
        self.kernel.filter = StaticFilter::from_bounds(bounds.min, bounds.max);
    }

    // Whole tetrahedralisations.

    /// Leaves no tetrahedra; the storage is kept.
    pub(crate) fn clear(&mut self) {
        self.kernel.tets.clear();
        self.kernel.twins.clear();
        self.kernel.marks.clear();
        self.kernel.vacant.clear();
        self.kernel.recent = TetId(0);
    }

    /// Takes over tetrahedra among the points, of which all lie in `bounds`.
    pub(crate) fn load(
        &mut self,
        tets: Vec<[VertexId; 4]>,
        twins: Vec<[FacetId; 4]>,
        bounds: Aabb,
    ) {
        self.clear();
        self.kernel.marks.resize(tets.len(), Mark::Untested);
        self.kernel.tets = tets;
        self.kernel.twins = twins;
        self.set_bounds(bounds);
    }

    /// Replaces everything by the Delaunay tetrahedralisation of a few distinct points, and returns their
    /// order: vertex k + 1 is point `order[k]`. All these points and those that are asked for later lie in
    /// `bounds`.
    pub(crate) fn restart(&mut self, points: &[DVec3], bounds: Aabb) -> Result<Vec<u32>, Error> {
        let mut order = match points.len() {
            0..FEWEST_TO_ORDER => (0..points.len() as u32).collect(),
            _ => brio::order(points),
        };
        first::four_that_span(points, &mut order)?;
        self.clear();
        self.set_bounds(bounds);
        let kernel = &mut self.kernel;
        kernel.points.truncate(1);
        let sorted = order.iter().map(|&i| points[i as usize]);
        kernel.points.extend(sorted);
        kernel.cavity.make_room(kernel.points.len());
        kernel.push_first_tetrahedron();
        for position in 4..order.len() {
            kernel.insert(position)?;
        }
        Ok(order)
    }

    // Insertion.

    /// Makes a vertex of a point already set, from a tetrahedron that is in conflict with it, and returns the
    /// tetrahedra that fill the cavity.
    pub(crate) fn insert(&mut self, start: TetId, vertex: VertexId) -> Result<&[TetId], Error> {
        let kernel = &mut self.kernel;
        kernel.dig(start, kernel.points[vertex.index()]);
        let (leave, come) = (kernel.cavity.conflict.len(), kernel.cavity.boundary.len());
        if let Err(error) = self.check_room(leave, come) {
            let kernel = &mut self.kernel;
            let outside = kernel.cavity.boundary.iter().map(|facet| facet.outer.tet());
            for tet in outside.chain(kernel.cavity.conflict.iter().copied()) {
                kernel.marks[tet.index()] = Mark::Untested;
            }
            return Err(error);
        }
        self.kernel.retriangulate(vertex)?;
        Ok(&self.kernel.cavity.filling)
    }

    // Removal.

    /// Marks the tetrahedra in conflict with a point that is no vertex, and returns them.
    pub(crate) fn dig_around(&mut self, p: DVec3) -> &[TetId] {
        let start = self.kernel.locate(p);
        self.kernel.dig(start, p);
        &self.kernel.cavity.conflict
    }

    /// The tetrahedra that the last [`dig_around`](Self::dig_around) found.
    pub(crate) fn dug(&self) -> &[TetId] {
        &self.kernel.cavity.conflict
    }

    /// Whether the last [`dig_around`](Self::dig_around) found this one.
    #[inline]
    pub(crate) fn is_dug(&self, tet: TetId) -> bool {
        self.kernel.marks[tet.index()] == Mark::InConflict
    }

    /// Makes the tetrahedra at a vertex, of which `start` is one, the hole.
    pub(crate) fn dig_star(&mut self, start: TetId, vertex: VertexId) {
        let Self { kernel, hole, link } = self;
        hole.clear();
        link.clear();
        kernel.marks[start.index()] = Mark::InConflict;
        hole.push(start);
        let mut next = 0;
        while let Some(&tet) = hole.get(next) {
            next += 1;
            let corners = kernel.tets[tet.index()];
            for (i, outer) in kernel.twins[tet.index()].into_iter().enumerate() {
                let mark = &mut kernel.marks[outer.tet().index()];
                if corners[i] == vertex {
                    link.push(LinkFacet {
                        corners: facet_vertices(corners, i),
                        outer,
                    });
                } else if *mark != Mark::InConflict {
                    *mark = Mark::InConflict;
                    hole.push(outer.tet());
                }
            }
        }
    }

    /// The facets around the hole.
    pub(crate) fn link(&self) -> &[LinkFacet] {
        &self.link
    }

    /// Leaves the tetrahedra of the hole as they were.
    pub(crate) fn close_hole(&mut self) {
        for tet in &self.hole {
            self.kernel.marks[tet.index()] = Mark::Untested;
        }
    }

    /// Removes the tetrahedra of the hole, for which `count` others are to come; refuses before anything has
    /// changed if these are too many.
    pub(crate) fn vacate_hole(&mut self, count: usize) -> Result<(), Error> {
        self.check_room(self.hole.len(), count)?;
        for tet in &self.hole {
            self.kernel.marks[tet.index()] = Mark::Vacant;
        }
        self.kernel.vacant.append(&mut self.hole);
        Ok(())
    }

    /// Adds a tetrahedron that is not joined to anything yet.
    pub(crate) fn place(&mut self, corners: [VertexId; 4]) -> Result<TetId, Error> {
        let tet = self.kernel.allocate()?;
        self.kernel.tets[tet.index()] = corners;
        self.kernel.marks[tet.index()] = Mark::Untested;
        self.kernel.recent = tet;
        Ok(tet)
    }

    /// Makes `twin` the other side of `facet`, but not yet the reverse.
    #[inline]
    pub(crate) fn set_twin(&mut self, facet: FacetId, twin: FacetId) {
        self.kernel.twins[facet.tet().index()][facet.corner()] = twin;
    }

    /// Makes two facets each other's other side.
    #[inline]
    pub(crate) fn join(&mut self, one: FacetId, other: FacetId) {
        self.set_twin(one, other);
        self.set_twin(other, one);
    }

    /// Whether there is room for tetrahedra that come when others leave.
    fn check_room(&self, leave: usize, come: usize) -> Result<(), Error> {
        let unused = MOST_TETS - self.kernel.tets.len();
        if come > self.kernel.vacant.len() + leave + unused {
            return Err(Error::TooMany {
                of: "tetrahedra",
                limit: MOST_TETS,
            });
        }
        Ok(())
    }
}
