//! Point location: the remembering walk.

use super::{
    cells::four,
    kernel::{INFINITE, Kernel},
    worker::Worker,
};
use crate::{FacetId, TetId, id::facet_vertices};
use glam::DVec3;
use pellicle_predicates::{Sign, lanes::Registers};

/// Steps after which a walk among tetrahedra that others change is given up.
const MOST_SHARED_STEPS: usize = 1 << 16;

impl Worker {
    /// A tetrahedron in conflict with `p`: the finite one that contains it, or an infinite one whose hull
    /// facet sees it from outside. `None` when others changed what the walk went through.
    ///
    /// Walks from the last insertion, through any facet that has `p` strictly beyond it (Devillers et al. 2002). It ends because the tetrahedralisation is a
    /// regular one and the signs are exact.
    #[inline(always)]
    pub(super) fn locate<const SHARED: bool, R: Registers>(
        &self,
        registers: R,
        kernel: &Kernel,
        p: DVec3,
    ) -> Option<TetId> {
        let cells = &kernel.cells;
        let mut tet = self.recent;
        if cells.corners(tet)[3] == INFINITE {
            tet = cells.twins(tet)[3].tet();
        }
        let mut steps = 0;
        loop {
            if SHARED {
                steps += 1;
                if steps > MOST_SHARED_STEPS {
                    return None;
                }
            }
            let Some(facet) = kernel.facet_before(registers, tet, p) else {
                return Some(tet);
            };
            tet = cells.twin(facet).tet();
            if cells.corners(tet)[3] == INFINITE {
                return Some(tet);
            }
        }
    }
}

impl Kernel {
    /// A facet of a finite tetrahedron that has `p` strictly beyond it.
    #[inline(always)]
    fn facet_before<R: Registers>(&self, registers: R, tet: TetId, p: DVec3) -> Option<FacetId> {
        let cells = &self.cells;
        // On its way while the sides are computed.
        let twins = cells.twins(tet);
        four(|i| cells.prefetch_corners(twins[i].tet()));
        let corners = cells.corners(tet);
        let points = four(|i| self.point(corners[i]));
        let sides = self.filter.sides_of_facets(registers, points, p);
        if sides.beyond != 0 {
            return Some(FacetId::of(tet, sides.beyond.trailing_zeros() as usize));
        }
        let mut undecided = !sides.within & 0b1111;
        while undecided != 0 {
            let i = undecided.trailing_zeros() as usize;
            undecided &= undecided - 1;
            let [a, b, c] = facet_vertices(corners, i).map(|v| self.point(v));
            if self.filter.orient3d(a, b, c, p) == Sign::Negative {
                return Some(FacetId::of(tet, i));
            }
        }
        None
    }

    /// Whether a finite tetrahedron contains `p`, its boundary included.
    #[cold]
    pub(super) fn contains(&self, tet: TetId, p: DVec3) -> bool {
        let corners = self.cells.corners(tet);
        corners[3] != INFINITE
            && (0..4).all(|i| {
                let [a, b, c] = facet_vertices(corners, i).map(|v| self.point(v));
                self.filter.orient3d(a, b, c, p) != Sign::Negative
            })
    }
}
