//! From the kernel's arrays to the caller's vertices.

mod places;
mod rows;

use super::kernel::{INFINITE, Kernel};
use crate::{
    FacetId, TetId, Tetrahedralization, id::facet_vertices, tetrahedralization::last_incident,
};
use glam::DVec3;
use pellicle_geometry::VertexId;
use places::{Places, UNUSED};
use rayon::prelude::*;
use rows::Rows;

impl Kernel {
    /// Puts the tetrahedra into an order that does not depend on how they came to be, and names the
    /// caller's vertices.
    ///
    /// The order: by the vertex that comes last in the order of insertion, then by the other corners;
    /// infinite ones after all others.
    pub(super) fn finish<'a>(
        self,
        points: &'a [DVec3],
        order: &[u32],
        duplicates: Vec<(VertexId, VertexId)>,
    ) -> Tetrahedralization<'a> {
        let vertices = self.points.len();
        let cells = self.cells;
        drop(self.points);
        let (mut tets, mut twins) = cells.into_plain();
        latest_first(&mut tets, &mut twins);
        let Places {
            mut of,
            finite,
            used,
        } = Places::of_tetrahedra(&tets, vertices);
        twins.par_iter_mut().for_each(|twins| {
            *twins = twins.map(|twin| FacetId::of(TetId(of[twin.tet().index()]), twin.corner()));
        });
        Rows::new(&mut of, &mut tets, &mut twins).arrange();
        drop(of);
        tets.truncate(used);
        twins.truncate(used);
        tets.shrink_to_fit();
        twins.shrink_to_fit();
        // The kernel's vertices lie about as the tetrahedra do, the caller's anywhere.
        let last = last_incident(vertices, &tets[..finite]);
        let mut incident = vec![TetId::NONE; points.len()];
        for (&vertex, &tet) in order.iter().zip(&last[1..]) {
            incident[vertex as usize] = tet;
        }
        tets.par_iter_mut().for_each(|tet| {
            *tet = tet.map(|vertex| match vertex {
                INFINITE => Tetrahedralization::INFINITE,
                VertexId(vertex) => VertexId(order[vertex as usize - 1]),
            });
        });
        Tetrahedralization::from_arrays(points, tets, twins, finite, incident, duplicates)
    }
}

/// Turns the tetrahedra such that the corner inserted last comes first and the least one last. Those that
/// one thread made are so already.
fn latest_first(tets: &mut [[VertexId; 4]], twins: &mut [[FacetId; 4]]) {
    let slots = (0..tets.len() as u32).into_par_iter();
    let others = slots.filter(|&t| {
        let [a, b, c, d] = tets[t as usize];
        !(a == UNUSED || a > b && a > c && d < b && d < c)
    });
    for t in others.collect::<Vec<u32>>() {
        let t = t as usize;
        let latest = (0..4).max_by_key(|&i| tets[t][i]).unwrap_or(0);
        let mut turned = [0; 4];
        turned[0] = latest;
        // (corner, facet opposite it) is odd, so the facet is turned around.
        let [x, y, z] = facet_vertices([0, 1, 2, 3].map(VertexId), latest);
        let [x, y, z] = [y.index(), x.index(), z.index()];
        let least = [x, y, z].into_iter().min_by_key(|&i| tets[t][i]);
        let facet = if least == Some(x) {
            [y, z, x]
        } else if least == Some(y) {
            [z, x, y]
        } else {
            [x, y, z]
        };
        turned[1..].copy_from_slice(&facet);
        let (tet, mut around) = (tets[t], twins[t]);
        // Twins within the tetrahedron itself do not occur, so one after the other may be told.
        around = turned.map(|i| around[i]);
        tets[t] = turned.map(|i| tet[i]);
        twins[t] = around;
        for (corner, twin) in around.into_iter().enumerate() {
            twins[twin.tet().index()][twin.corner()] = FacetId::of(TetId::new(t), corner);
        }
    }
}
