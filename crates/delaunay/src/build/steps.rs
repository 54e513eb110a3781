//! Single steps on a kernel that lives on: what the dynamic tetrahedralisation asks of it. The storage of
//! tetrahedra, twins and marks is known up to here.

use super::{
    cavity::{Cavity, clockwise_infinity_last},
    first,
    kernel::{Kernel, MOST_TETS, Mark},
};
use crate::{Error, FacetId, TetId, id::facet_vertices};
use glam::DVec3;
use pellicle_geometry::{Aabb, VertexId};
use pellicle_predicates::StaticFilter;
use pellicle_spatial::brio;

pub(crate) use super::{cavity::BoundaryFacet, kernel::INFINITE};

/// Fewer points than this are inserted as they come: an order costs more than it saves.
const FEWEST_TO_ORDER: usize = 64;

impl Kernel {
    /// A kernel without points and tetrahedra.
    pub(crate) fn empty() -> Self {
        Self {
            points: vec![DVec3::NAN],
            weights: Vec::new(),
            tets: Vec::new(),
            twins: Vec::new(),
            marks: Vec::new(),
            vacant: Vec::new(),
            filter: StaticFilter::from_bounds(DVec3::ZERO, DVec3::ZERO),
            cavity: Cavity::for_vertices(1),
            recent: TetId(0),
        }
    }

    // What is there.

    #[inline]
    pub(crate) fn point_of(&self, vertex: VertexId) -> DVec3 {
        self.points[vertex.index()]
    }

    #[inline]
    pub(crate) fn corners(&self, tet: TetId) -> [VertexId; 4] {
        self.tets[tet.index()]
    }

    #[inline]
    pub(crate) fn twin(&self, facet: FacetId) -> FacetId {
        self.twins[facet.tet().index()][facet.corner()]
    }

    /// Tetrahedra are named by ids below this number, not all of them in use.
    #[inline]
    pub(crate) fn tet_slots(&self) -> usize {
        self.tets.len()
    }

    /// Whether the id names a tetrahedron, between two steps.
    #[inline]
    pub(crate) fn is_in_use(&self, tet: TetId) -> bool {
        let mark = self.marks.get(tet.index());
        mark.is_some_and(|mark| !matches!(mark, Mark::InConflict | Mark::Vacant))
    }

    /// A tetrahedron made by the last step.
    #[inline]
    pub(crate) fn recent(&self) -> Option<TetId> {
        (!self.tets.is_empty()).then_some(self.recent)
    }

    // Points.

    /// Puts a point into the slot of a vertex, which may be the one after the last.
    pub(crate) fn set_point(&mut self, vertex: VertexId, p: DVec3) {
        if vertex.index() == self.points.len() {
            self.points.push(p);
            self.cavity.make_room(self.points.len());
        } else {
            self.points[vertex.index()] = p;
        }
    }

    /// From now on all points lie in this box.
    pub(crate) fn set_bounds(&mut self, bounds: Aabb) {
        self.filter = StaticFilter::from_bounds(bounds.min, bounds.max);
    }

    // Whole tetrahedralisations.

    /// Leaves no tetrahedra; the storage is kept.
    pub(crate) fn clear(&mut self) {
        self.tets.clear();
        self.twins.clear();
        self.marks.clear();
        self.vacant.clear();
        self.recent = TetId(0);
    }

    /// Takes over tetrahedra among the points.
    pub(crate) fn load(&mut self, tets: Vec<[VertexId; 4]>, twins: Vec<[FacetId; 4]>) {
        self.clear();
        self.marks.resize(tets.len(), Mark::Untested);
        self.tets = tets;
        self.twins = twins;
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
        self.points.truncate(1);
        self.points
            .extend(order.iter().map(|&i| points[i as usize]));
        self.cavity.make_room(self.points.len());
        self.set_bounds(bounds);
        self.push_first_tetrahedron();
        for position in 4..order.len() {
            self.insert(position)?;
        }
        Ok(order)
    }

    // Cavities.

    /// Makes a vertex of a point already set, from a tetrahedron that is in conflict with it.
    pub(crate) fn insert_from(&mut self, start: TetId, vertex: VertexId) -> Result<(), Error> {
        self.dig(start, self.points[vertex.index()]);
        if let Err(error) = self.check_room(self.cavity.boundary.len()) {
            self.undo_cavity();
            return Err(error);
        }
        self.retriangulate(vertex)
    }

    /// The tetrahedra that the last insertion made.
    pub(crate) fn filling(&self) -> &[TetId] {
        &self.cavity.filling
    }

    /// Digs the tetrahedra in conflict with a point that is no vertex.
    pub(crate) fn dig_around(&mut self, p: DVec3) {
        let start = self.locate(p);
        self.dig(start, p);
    }

    /// Digs the tetrahedra at a vertex, of which `start` is one.
    pub(crate) fn dig_star(&mut self, start: TetId, vertex: VertexId) {
        let mut star = std::mem::take(&mut self.cavity.conflict);
        let mut link = std::mem::take(&mut self.cavity.boundary);
        star.clear();
        link.clear();
        self.marks[start.index()] = Mark::InConflict;
        star.push(start);
        let mut next = 0;
        while let Some(&tet) = star.get(next) {
            next += 1;
            let corners = self.tets[tet.index()];
            for (i, outer) in self.twins[tet.index()].into_iter().enumerate() {
                if corners[i] == vertex {
                    link.push(BoundaryFacet {
                        corners: clockwise_infinity_last(facet_vertices(corners, i)),
                        outer,
                    });
                } else if self.marks[outer.tet().index()] != Mark::InConflict {
                    self.marks[outer.tet().index()] = Mark::InConflict;
                    star.push(outer.tet());
                }
            }
        }
        self.cavity.conflict = star;
        self.cavity.boundary = link;
    }

    /// The tetrahedra of the cavity, and the facets around it.
    pub(crate) fn cavity(&self) -> (&[TetId], &[BoundaryFacet]) {
        (&self.cavity.conflict, &self.cavity.boundary)
    }

    /// Whether the tetrahedron is part of the cavity.
    #[inline]
    pub(crate) fn is_dug(&self, tet: TetId) -> bool {
        self.marks[tet.index()] == Mark::InConflict
    }

    /// Leaves the tetrahedra of the cavity as they were.
    pub(crate) fn undo_cavity(&mut self) {
        let outside = self.cavity.boundary.iter().map(|facet| facet.outer.tet());
        for tet in outside.chain(self.cavity.conflict.iter().copied()) {
            self.marks[tet.index()] = Mark::Untested;
        }
    }

    /// Removes the tetrahedra of the cavity; what fills it must follow.
    pub(crate) fn vacate_cavity(&mut self) {
        for tet in &self.cavity.conflict {
            self.marks[tet.index()] = Mark::Vacant;
        }
        self.vacant.append(&mut self.cavity.conflict);
    }

    /// Whether `count` tetrahedra fit, those of the cavity out of the way.
    pub(crate) fn check_room(&self, count: usize) -> Result<(), Error> {
        let vacant = self.vacant.len() + self.cavity.conflict.len();
        if count > vacant + (MOST_TETS - self.tets.len()) {
            return Err(Error::TooMany {
                of: "tetrahedra",
                limit: MOST_TETS,
            });
        }
        Ok(())
    }

    /// Adds a tetrahedron that is not joined to anything yet.
    pub(crate) fn place(&mut self, corners: [VertexId; 4]) -> Result<TetId, Error> {
        let tet = self.allocate()?;
        self.tets[tet.index()] = corners;
        self.marks[tet.index()] = Mark::Untested;
        self.recent = tet;
        Ok(tet)
    }

    /// Makes `twin` the other side of `facet`, but not yet the reverse.
    #[inline]
    pub(crate) fn set_twin(&mut self, facet: FacetId, twin: FacetId) {
        self.twins[facet.tet().index()][facet.corner()] = twin;
    }

    /// Makes two facets each other's other side.
    #[inline]
    pub(crate) fn join(&mut self, one: FacetId, other: FacetId) {
        self.set_twin(one, other);
        self.set_twin(other, one);
    }
}
