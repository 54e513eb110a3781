//! The conflict test: the only place that knows of infinity and of ties.

use super::{
    cells::{IN_CONFLICT, four},
    kernel::{INFINITE, Kernel},
};
use crate::{FacetId, TetId};
use glam::DVec3;
use pellicle_geometry::VertexId;
use pellicle_predicates::{
    Sign,
    lanes::{AtInfinity, FourVerdicts, Registers},
};

/// A point that asks which tetrahedra it is in conflict with: a [`DVec3`], or one with a weight.
pub(super) trait Query: Copy {
    /// Whether the tetrahedron that contains the point may not be in conflict with it.
    const MAY_BE_HIDDEN: bool;

    /// What a vertex of the kernel asks when it is inserted.
    fn of_vertex(kernel: &Kernel, vertex: VertexId) -> Self;

    fn position(self) -> DVec3;

    /// Whether the point lies inside the sphere of a finite tetrahedron, cospherical points being told apart
    /// by the perturbation in the lifted dimension (Devillers and Teillaud 2011). For a point in the plane of
    /// three of the corners the fourth one must have no say.
    fn is_inside(self, kernel: &Kernel, corners: [VertexId; 4]) -> bool;

    /// Of the four neighbours of a tetrahedron, which have the fourth vertices `opposite`: what filters can say at once.
    fn is_inside_across<R: Registers>(
        self,
        registers: R,
        kernel: &Kernel,
        corners: [VertexId; 4],
        opposite: [VertexId; 4],
        at_infinity: AtInfinity,
    ) -> FourVerdicts;
}

impl Query for DVec3 {
    const MAY_BE_HIDDEN: bool = false;

    #[inline(always)]
    fn of_vertex(kernel: &Kernel, vertex: VertexId) -> Self {
        kernel.point(vertex)
    }

    #[inline(always)]
    fn position(self) -> DVec3 {
        self
    }

    #[inline(always)]
    fn is_inside(self, kernel: &Kernel, [a, b, c, d]: [VertexId; 4]) -> bool {
        let [a, b] = [kernel.point(a), kernel.point(b)];
        let [c, d] = [kernel.point(c), kernel.point(d)];
        kernel.filter.insphere_perturbed(a, b, c, d, self) == Sign::Positive
    }

    #[inline(always)]
    fn is_inside_across<R: Registers>(
        self,
        registers: R,
        kernel: &Kernel,
        corners: [VertexId; 4],
        opposite: [VertexId; 4],
        at_infinity: AtInfinity,
    ) -> FourVerdicts {
        let corners = four(|i| kernel.point(corners[i]));
        let opposite = four(|i| kernel.point(opposite[i]));
        let filter = &kernel.filter;
        filter.insphere_across(registers, corners, opposite, self, at_infinity)
    }
}

impl Kernel {
    /// Whether the point lies inside the sphere of `tet`.
    #[inline]
    pub(super) fn is_in_conflict(&self, tet: TetId, query: impl Query) -> bool {
        let corners = self.cells.corners(tet);
        if corners[3] == INFINITE {
            return self.is_infinite_in_conflict(tet, corners, query);
        }
        query.is_inside(self, corners)
    }

    /// [`is_in_conflict`](Self::is_in_conflict) of the neighbours of a tetrahedron, bit i that of the one opposite corner i.
    #[inline(always)]
    pub(super) fn are_in_conflict<R: Registers>(
        &self,
        registers: R,
        corners: [VertexId; 4],
        twins: [FacetId; 4],
        query: impl Query,
    ) -> u8 {
        let opposite = four(|i| self.cells.opposite(twins[i]));
        let [a, b, c, d] = four(|i| u8::from(opposite[i] == INFINITE) << i);
        let at_infinity = AtInfinity {
            opposite: a | b | c | d,
            corner: corners[3] == INFINITE,
        };
        let verdicts = query.is_inside_across(registers, self, corners, opposite, at_infinity);
        let mut inside = verdicts.inside;
        let mut undecided = !(verdicts.inside | verdicts.outside) & 0b1111;
        while undecided != 0 {
            let i = undecided.trailing_zeros();
            undecided &= undecided - 1;
            let neighbor = twins[i as usize].tet();
            let is_inside =
                self.cells.mark(neighbor) == IN_CONFLICT || self.is_in_conflict(neighbor, query);
            inside |= u8::from(is_inside) << i;
        }
        inside
    }

    /// The sphere of an infinite tetrahedron is the half-space beyond its hull facet, and of the facet's
    /// plane the part inside the circumcircle of the facet.
    fn is_infinite_in_conflict(
        &self,
        tet: TetId,
        [a, b, c, _]: [VertexId; 4],
        query: impl Query,
    ) -> bool {
        let facet = (self.point(a), self.point(b), self.point(c));
        let side = |p: DVec3| self.filter.orient3d(facet.0, facet.1, facet.2, p);
        match side(query.position()) {
            Sign::Positive => true,
            Sign::Negative => false,
            Sign::Zero => {
                let behind = self.spanning.and_then(|spanning| {
                    let mut points = spanning.into_iter();
                    points.find(|&d| side(self.point(d)) == Sign::Negative)
                });
                self.is_in_conflict_in_plane(tet, [a, b, c], behind, query)
            }
        }
    }

    /// In the plane of a hull facet any tetrahedron of the facet and a point behind it decides, for instance
    /// the one that is there: its sphere cuts the plane in the circumcircle, and its fourth corner has no say
    /// in the perturbation, the other four points being coplanar.
    #[cold]
    fn is_in_conflict_in_plane(
        &self,
        infinite: TetId,
        [a, b, c]: [VertexId; 3],
        behind: Option<VertexId>,
        query: impl Query,
    ) -> bool {
        let corners = match behind {
            Some(d) => [b, a, c, d],
            None => self.cells.corners(self.cells.twins(infinite)[3].tet()),
        };
        query.is_inside(self, corners)
    }
}
