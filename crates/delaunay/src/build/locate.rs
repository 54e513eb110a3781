//! Point location: the remembering walk.

use super::kernel::{INFINITE, Kernel};
use crate::{TetId, id::facet_vertices};
use glam::DVec3;
use pellicle_predicates::Sign;

impl Kernel {
    /// A tetrahedron in conflict with `p`: the finite one that contains it, or an infinite one whose hull
    /// facet sees it from outside.
    ///
    /// Walks from the last insertion, through any facet that has `p` strictly beyond it, but not back
    /// through the one just crossed (Devillers et al. 2002). It ends because the tetrahedralisation is a
    /// regular one and the signs are exact.
    #[inline(never)]
    pub(super) fn locate(&self, p: DVec3) -> TetId {
        let mut tet = self.recent;
        if self.tets[tet.index()][3] == INFINITE {
            tet = self.twins[tet.index()][3].tet();
        }
        let mut entered_through = usize::MAX;
        'walk: loop {
            let corners = self.tets[tet.index()];
            for i in 0..4 {
                if i != entered_through && self.is_beyond(corners, i, p) {
                    let twin = self.twins[tet.index()][i];
                    tet = twin.tet();
                    entered_through = twin.corner();
                    if self.tets[tet.index()][3] == INFINITE {
                        return tet;
                    }
                    continue 'walk;
                }
            }
            return tet;
        }
    }

    /// Whether `p` is strictly beyond the facet opposite `corner`.
    #[inline(always)]
    fn is_beyond(
        &self,
        corners: [pellicle_geometry::VertexId; 4],
        corner: usize,
        p: DVec3,
    ) -> bool {
        let [a, b, c] = facet_vertices(corners, corner);
        self.filter
            .orient3d(self.point(a), self.point(b), self.point(c), p)
            == Sign::Negative
    }
}
