//! The conflict test: the only place that knows of infinity and of ties.

use super::kernel::{INFINITE, Kernel};
use crate::TetId;
use glam::DVec3;
use pellicle_geometry::VertexId;
use pellicle_predicates::Sign;

/// A point that asks which tetrahedra it is in conflict with: a [`DVec3`], or one with a weight.
pub(super) trait Query: Copy {
    fn position(self) -> DVec3;

    /// Whether the point lies inside the sphere of a finite tetrahedron, cospherical points being told apart
    /// by the perturbation in the lifted dimension (Devillers and Teillaud 2011). For a point in the plane of
    /// three of the corners the fourth one must have no say.
    fn is_inside(self, kernel: &Kernel, corners: [VertexId; 4]) -> bool;
}

impl Query for DVec3 {
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
}

impl Kernel {
    /// Whether the point lies inside the sphere of `tet`.
    #[inline(always)]
    pub(super) fn is_in_conflict(&self, tet: TetId, query: impl Query) -> bool {
        let corners = self.tets[tet.index()];
        if corners[3] == INFINITE {
            return self.is_infinite_in_conflict(tet, query);
        }
        query.is_inside(self, corners)
    }

    /// The sphere of an infinite tetrahedron is the half-space beyond its hull facet, and of the facet's
    /// plane the part inside the circumcircle of the facet.
    ///
    /// In that plane the finite tetrahedron behind the facet decides: its sphere cuts the plane in the
    /// circumcircle, and its fourth corner has no say in the perturbation, the other four points being
    /// coplanar.
    fn is_infinite_in_conflict(&self, tet: TetId, query: impl Query) -> bool {
        let [a, b, c, _] = self.tets[tet.index()];
        let [a, b, c] = [a, b, c].map(|v| self.point(v));
        match self.filter.orient3d(a, b, c, query.position()) {
            Sign::Positive => true,
            Sign::Negative => false,
            Sign::Zero => self.is_in_conflict_behind(tet, query),
        }
    }

    #[cold]
    fn is_in_conflict_behind(&self, infinite: TetId, query: impl Query) -> bool {
        let finite = self.twins[infinite.index()][3].tet();
        query.is_inside(self, self.tets[finite.index()])
    }
}
