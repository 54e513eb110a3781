//! The conflict test: the only place that knows of infinity and of ties.

use super::kernel::{INFINITE, Kernel};
use crate::TetId;
use glam::DVec3;
use pellicle_predicates::Sign;

impl Kernel {
    /// Whether `p` lies inside the circumsphere of `tet`, cospherical points being told apart by the
    /// perturbation in the lifted dimension (Devillers and Teillaud 2011).
    #[inline(always)]
    pub(super) fn is_in_conflict(&self, tet: TetId, p: DVec3) -> bool {
        let [a, b, c, d] = self.tets[tet.index()];
        if d == INFINITE {
            return self.is_infinite_in_conflict(tet, p);
        }
        let (a, b, c, d) = (self.point(a), self.point(b), self.point(c), self.point(d));
        self.filter.insphere_perturbed(a, b, c, d, p) == Sign::Positive
    }

    /// The sphere of an infinite tetrahedron is the half-space beyond its hull facet, and of the facet's
    /// plane the part inside the circumcircle of the facet.
    ///
    /// In that plane the finite tetrahedron behind the facet decides: its sphere cuts the plane in the
    /// circumcircle, and its fourth corner has no say in the perturbation, the other four points being
    /// coplanar.
    fn is_infinite_in_conflict(&self, tet: TetId, p: DVec3) -> bool {
        let [a, b, c, _] = self.tets[tet.index()];
        let [a, b, c] = [a, b, c].map(|v| self.point(v));
        match self.filter.orient3d(a, b, c, p) {
            Sign::Positive => true,
            Sign::Negative => false,
            Sign::Zero => self.is_in_conflict_behind(tet, p),
        }
    }

    #[cold]
    fn is_in_conflict_behind(&self, infinite: TetId, p: DVec3) -> bool {
        let finite = self.twins[infinite.index()][3].tet();
        let [a, b, c, d] = self.tets[finite.index()].map(|v| self.point(v));
        self.filter.insphere_perturbed(a, b, c, d, p) == Sign::Positive
    }
}
