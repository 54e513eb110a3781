//! Point location: the remembering walk.

use super::{
    kernel::{INFINITE, Kernel},
    worker::Worker,
};
use crate::{TetId, id::facet_vertices};
use glam::DVec3;
use pellicle_predicates::Sign;

/// Steps after which a walk among tetrahedra that others change is given up.
const MOST_SHARED_STEPS: usize = 1 << 16;

impl Worker {
    /// A tetrahedron in conflict with `p`: the finite one that contains it, or an infinite one whose hull
    /// facet sees it from outside. `None` when others changed what the walk went through.
    ///
    /// Walks from the last insertion, through any facet that has `p` strictly beyond it, but not back
    /// through the one just crossed (Devillers et al. 2002). It ends because the tetrahedralisation is a
    /// regular one and the signs are exact.
    #[inline(always)]
    pub(super) fn locate<const SHARED: bool>(&self, kernel: &Kernel, p: DVec3) -> Option<TetId> {
        let cells = &kernel.cells;
        let mut tet = self.recent;
        if cells.corners(tet)[3] == INFINITE {
            tet = cells.twins(tet)[3].tet();
        }
        let mut entered_through = usize::MAX;
        let mut steps = 0;
        'walk: loop {
            if SHARED {
                steps += 1;
                if steps > MOST_SHARED_STEPS {
                    return None;
                }
            }
            let corners = cells.corners(tet);
            for i in 0..4 {
                let [a, b, c] = facet_vertices(corners, i);
                if i == entered_through {
                    continue;
                }
                let (a, b, c) = (kernel.point(a), kernel.point(b), kernel.point(c));
                if kernel.filter.orient3d(a, b, c, p) == Sign::Negative {
                    let twin = cells.twins(tet)[i];
                    tet = twin.tet();
                    entered_through = twin.corner();
                    if cells.corners(tet)[3] == INFINITE {
                        return Some(tet);
                    }
                    continue 'walk;
                }
            }
            return Some(tet);
        }
    }
}

impl Kernel {
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
