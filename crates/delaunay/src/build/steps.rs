//! A kernel that lives on, changed a step at a time: what the dynamic tetrahedralisation asks for. How
//! tetrahedra, twins and marks are stored is known up to here.

use super::{
    cells::{AT_REST, IN_CONFLICT, KEPT},
    first,
    kernel::{INFINITE, Kernel, MOST_TETS},
    worker::{Room, Worker},
};
use crate::{Error, FacetId, TetId, id::facet_vertices};
use glam::DVec3;
use pellicle_geometry::{Aabb, VertexId};
use pellicle_predicates::{
    StaticFilter,
    lanes::{Registers, Vectorized, vectorized},
};
use pellicle_spatial::brio;

/// Fewer points than this are inserted as they come: an order costs more than it saves.
const FEWEST_TO_ORDER: usize = 64;

/// A kernel between insertions and removals. Vertex 0 is the one at infinity.
pub(crate) struct Stepwise {
    kernel: Kernel,
    /// The only one.
    worker: Worker,
    /// The tetrahedra that are to leave.
    hole: Vec<TetId>,
    link: Vec<LinkFacet>,
    /// How many slots for tetrahedra there may be; lower in tests.
    pub(crate) most_tets: usize,
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
        Self {
            kernel: Kernel::empty(),
            worker: Worker::new(0, 1),
            hole: Vec::new(),
            link: Vec::new(),
            most_tets: MOST_TETS,
        }
    }

    // What is there.

    #[inline]
    pub(crate) fn point(&self, vertex: VertexId) -> DVec3 {
        self.kernel.point(vertex)
    }

    #[inline]
    pub(crate) fn corners(&self, tet: TetId) -> [VertexId; 4] {
        self.kernel.cells.corners(tet)
    }

    #[inline]
    pub(crate) fn twin(&self, facet: FacetId) -> FacetId {
        self.kernel.cells.twin(facet)
    }

    /// Tetrahedra are named by ids below this number, not all of them in use.
    #[inline]
    pub(crate) fn tet_slots(&self) -> usize {
        self.kernel.cells.len()
    }

    /// Whether the id names a tetrahedron, between two steps.
    #[inline]
    pub(crate) fn is_in_use(&self, tet: TetId) -> bool {
        tet.index() < self.tet_slots() && self.kernel.cells.mark(tet) == AT_REST
    }

    /// A tetrahedron made by the last step.
    #[inline]
    pub(crate) fn recent(&self) -> Option<TetId> {
        (self.tet_slots() > 0).then_some(self.worker.recent)
    }

    // Points.

    /// Puts a point into the slot of a vertex, which may be the one after the last.
    pub(crate) fn set_point(&mut self, vertex: VertexId, p: DVec3) {
        let points = &mut self.kernel.points;
        if vertex.index() == points.len() {
            points.push(p);
            self.worker.cavity.make_room_for_vertices(points.len());
        } else {
            points[vertex.index()] = p;
        }
    }

    /// From now on all points lie in this box.
    pub(crate) fn set_bounds(&mut self, bounds: Aabb) {
        self.kernel.filter = StaticFilter::from_bounds(bounds.min, bounds.max);
        self.kernel.points[INFINITE.index()] = bounds.min;
    }

    // Whole tetrahedralisations.

    /// Leaves no tetrahedra; the storage is kept.
    pub(crate) fn clear(&mut self) {
        self.kernel.cells.clear();
        self.kernel.reset_regions();
        self.worker.start_round(TetId(0));
    }

    /// Takes over tetrahedra among the points, of which all lie in `bounds`.
    pub(crate) fn load(
        &mut self,
        tets: Vec<[VertexId; 4]>,
        twins: Vec<[FacetId; 4]>,
        bounds: Aabb,
    ) {
        self.clear();
        let cells = &mut self.kernel.cells;
        cells.grow(tets.len());
        for (t, (corners, twins)) in tets.into_iter().zip(twins).enumerate() {
            cells.set(TetId::new(t), corners, twins, AT_REST);
        }
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
        let vertices = kernel.points.len();
        self.worker.cavity.make_room_for_vertices(vertices);
        kernel.make_first_tetrahedron();
        for vertex in (5..vertices).map(VertexId::new) {
            self.dig_around(self.kernel.point(vertex));
            self.fill_cavity(vertex)?;
        }
        Ok(order)
    }

    // Insertion.

    /// Makes a vertex of a point already set, from a tetrahedron that is in conflict with it, and returns the
    /// tetrahedra that fill the cavity.
    pub(crate) fn insert(&mut self, start: TetId, vertex: VertexId) -> Result<&[TetId], Error> {
        self.dig_from(start, self.kernel.point(vertex));
        self.fill_cavity(vertex)?;
        Ok(self.worker.cavity.conflict())
    }

    fn dig_from(&mut self, start: TetId, p: DVec3) {
        self.kernel.cells.set_mark(start, IN_CONFLICT);
        let is_dug = vectorized(Dig {
            kernel: &self.kernel,
            worker: &mut self.worker,
            start,
            p,
        });
        debug_assert!(is_dug, "nobody else is in the way");
    }

    /// Fills the cavity with tetrahedra around a vertex; without room for them, leaves it as it was.
    fn fill_cavity(&mut self, vertex: VertexId) -> Result<(), Error> {
        let growth = self.worker.cavity.growth();
        while self.worker.reserve::<false>(&self.kernel, growth) != Room::Enough {
            if let Err(error) = self.grow() {
                self.worker.release(&self.kernel);
                return Err(error);
            }
        }
        self.worker.retriangulate(&self.kernel, vertex);
        Ok(())
    }

    // Removal.

    /// Marks the tetrahedra in conflict with a point that is no vertex, and returns them.
    pub(crate) fn dig_around(&mut self, p: DVec3) -> &[TetId] {
        self.dig_from(self.locate(p), p);
        self.dug()
    }

    /// A tetrahedron in conflict with a point.
    fn locate(&self, p: DVec3) -> TetId {
        let tet = vectorized(Locate {
            kernel: &self.kernel,
            worker: &self.worker,
            p,
        });
        tet.expect("no walk is given up where nobody else is")
    }

    /// The tetrahedra that the last [`dig_around`](Self::dig_around) found.
    pub(crate) fn dug(&self) -> &[TetId] {
        self.worker.cavity.conflict()
    }

    /// Whether the last [`dig_around`](Self::dig_around) found this one.
    #[inline]
    pub(crate) fn is_dug(&self, tet: TetId) -> bool {
        self.kernel.cells.mark(tet) == IN_CONFLICT
    }

    /// Makes the tetrahedra at a vertex, of which `start` is one, the hole.
    pub(crate) fn dig_star(&mut self, start: TetId, vertex: VertexId) {
        let cells = &self.kernel.cells;
        let Self { hole, link, .. } = self;
        hole.clear();
        link.clear();
        cells.set_mark(start, IN_CONFLICT);
        hole.push(start);
        let mut next = 0;
        while let Some(&tet) = hole.get(next) {
            next += 1;
            let corners = cells.corners(tet);
            for (i, outer) in cells.twins(tet).into_iter().enumerate() {
                if corners[i] == vertex {
                    link.push(LinkFacet {
                        corners: facet_vertices(corners, i),
                        outer,
                    });
                } else if cells.mark(outer.tet()) != IN_CONFLICT {
                    cells.set_mark(outer.tet(), IN_CONFLICT);
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
        for &tet in &self.hole {
            self.kernel.cells.set_mark(tet, AT_REST);
        }
    }

    /// Removes the tetrahedra of the hole, for which `count` others are to come; refuses before anything has
    /// changed if these are too many.
    pub(crate) fn vacate_hole(&mut self, count: usize) -> Result<(), Error> {
        self.check_room(self.hole.len(), count)?;
        for &tet in &self.hole {
            self.kernel.cells.set_mark(tet, KEPT);
        }
        self.worker.kept.append(&mut self.hole);
        Ok(())
    }

    /// Adds a tetrahedron that is not joined to anything yet.
    pub(crate) fn place(&mut self, corners: [VertexId; 4]) -> Result<TetId, Error> {
        while self.worker.reserve::<false>(&self.kernel, 1) != Room::Enough {
            self.grow()?;
        }
        let tet = self.worker.kept.pop().expect("a slot is reserved");
        let cells = &self.kernel.cells;
        cells.set(tet, corners, [FacetId::NONE; 4], AT_REST);
        self.worker.recent = tet;
        Ok(tet)
    }

    /// Makes `twin` the other side of `facet`, but not yet the reverse.
    #[inline]
    pub(crate) fn set_twin(&mut self, facet: FacetId, twin: FacetId) {
        self.kernel.cells.set_twin(facet, twin);
    }

    /// Makes two facets each other's other side.
    #[inline]
    pub(crate) fn join(&mut self, one: FacetId, other: FacetId) {
        self.set_twin(one, other);
        self.set_twin(other, one);
    }

    /// Whether there is room for tetrahedra that come when others leave.
    fn check_room(&self, leave: usize, come: usize) -> Result<(), Error> {
        if self.tet_slots() + come > self.most_tets + self.worker.kept.len() + leave {
            return Err(self.too_many());
        }
        Ok(())
    }

    /// Makes new slots.
    #[cold]
    fn grow(&mut self) -> Result<(), Error> {
        if self.tet_slots() >= self.most_tets {
            return Err(self.too_many());
        }
        self.kernel.grow(self.tet_slots() / 64, 1)
    }

    fn too_many(&self) -> Error {
        Error::TooMany {
            of: "tetrahedra",
            limit: self.most_tets,
        }
    }
}

/// A point is located.
struct Locate<'a> {
    kernel: &'a Kernel,
    worker: &'a Worker,
    p: DVec3,
}

impl Vectorized for Locate<'_> {
    type Output = Option<TetId>;

    #[inline(always)]
    fn run<R: Registers>(self, registers: R) -> Option<TetId> {
        let Self { kernel, worker, p } = self;
        worker.locate::<false, R>(registers, kernel, p)
    }
}

/// A point digs its cavity from a tetrahedron in conflict.
struct Dig<'a> {
    kernel: &'a Kernel,
    worker: &'a mut Worker,
    start: TetId,
    p: DVec3,
}

impl Vectorized for Dig<'_> {
    type Output = bool;

    #[inline(always)]
    fn run<R: Registers>(self, registers: R) -> bool {
        let (kernel, worker) = (self.kernel, self.worker);
        worker.dig::<false, R>(registers, kernel, self.start, self.p)
    }
}
