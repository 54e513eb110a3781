//! From the kernel's arrays to the caller's vertices.

use super::kernel::{INFINITE, Kernel};
use crate::{FacetId, TetId, Tetrahedralization, id::facet_vertices};
use glam::DVec3;
use pellicle_geometry::VertexId;
use rayon::prelude::*;

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
        } = places(&tets, vertices);
        twins.par_iter_mut().for_each(|twins| {
            *twins = twins.map(|twin| FacetId::of(TetId(of[twin.tet().index()]), twin.corner()));
        });
        arrange(&mut of, &mut tets, &mut twins);
        drop(of);
        tets.truncate(used);
        twins.truncate(used);
        tets.shrink_to_fit();
        twins.shrink_to_fit();
        tets.par_iter_mut().for_each(|tet| {
            *tet = tet.map(|vertex| match vertex {
                INFINITE => Tetrahedralization::INFINITE,
                VertexId(vertex) => VertexId(order[vertex as usize - 1]),
            });
        });
        Tetrahedralization::from_arrays(points, tets, twins, finite, duplicates)
    }
}

/// Turns the tetrahedra such that the corner inserted last comes first and the least one last. Those that
/// one thread made are so already.
fn latest_first(tets: &mut [[VertexId; 4]], twins: &mut [[FacetId; 4]]) {
    for t in 0..tets.len() {
        let [a, b, c, d] = tets[t];
        if a == UNUSED || (a > b && a > c && d < b && d < c) {
            continue;
        }
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

/// By slot the tetrahedron's place in the result; those of slots without one come last.
struct Places {
    of: Vec<u32>,
    /// How many places are finite tetrahedra'.
    finite: usize,
    /// How many are tetrahedra's.
    used: usize,
}

/// No slot.
const NONE: u32 = u32::MAX;

/// The first corner of a slot without a tetrahedron.
const UNUSED: VertexId = VertexId::NONE;

fn places(tets: &[[VertexId; 4]], vertices: usize) -> Places {
    // 1. By latest vertex, the list of its finite tetrahedra: the last one here, the one before in `of`.
    let mut last = vec![NONE; vertices];
    let mut of = vec![NONE; tets.len()];
    let mut infinite: Vec<u32> = Vec::new();
    for (t, tet) in tets.iter().enumerate() {
        if tet[0] == UNUSED {
            continue;
        }
        if tet[3] == INFINITE {
            infinite.push(t as u32);
        } else {
            of[t] = std::mem::replace(&mut last[tet[0].index()], t as u32);
        }
    }
    // 2. Each list in order, and in place of the list the places. Of two tetrahedra with the same latest
    //    and least corners no two have the same second one: they would share a facet and lie on the same
    //    side of it.
    let mut used = 0;
    let mut list: Vec<(u64, u32)> = Vec::new();
    for mut t in last {
        while t != NONE {
            let [_, second, _, least] = tets[t as usize];
            list.push((u64::from(least.0) << 32 | u64::from(second.0), t));
            t = of[t as usize];
        }
        list.sort_unstable();
        for (_, t) in list.drain(..) {
            of[t as usize] = used;
            used += 1;
        }
    }
    let finite = used as usize;
    infinite.sort_unstable_by_key(|&t| tets[t as usize]);
    let unused = (0..tets.len() as u32).filter(|&t| tets[t as usize][0] == UNUSED);
    let slots_used = finite + infinite.len();
    for t in infinite.into_iter().chain(unused) {
        of[t as usize] = used;
        used += 1;
    }
    Places {
        of,
        finite,
        used: slots_used,
    }
}

/// Moves the tetrahedra, with their places, to these places.
///
/// Slots and places run about alike, but swapping along the cycles of the permutation would jump through all of
/// memory all the same. So each goes into the right block first, to where the blocks' next free places are,
/// which are few enough to stay in the cache; then to its place in the block (McIlroy et al. 1993).
fn arrange(of: &mut [u32], tets: &mut [[VertexId; 4]], twins: &mut [[FacetId; 4]]) {
    const BLOCK: u32 = 1 << 15;
    let count = of.len() as u32;
    let mut swap = |of: &mut [u32], one: u32, other: u32| {
        let (one, other) = (one as usize, other as usize);
        of.swap(one, other);
        tets.swap(one, other);
        twins.swap(one, other);
    };
    let blocks = count.div_ceil(BLOCK);
    let mut next: Vec<u32> = (0..blocks).map(|block| block * BLOCK).collect();
    for block in 0..blocks {
        let end = (block + 1).saturating_mul(BLOCK).min(count);
        let mut slot = next[block as usize];
        while slot < end {
            let home = of[slot as usize] / BLOCK;
            if home == block {
                slot += 1;
                continue;
            }
            // Those before `next` are home; so may be the next ones.
            let place = &mut next[home as usize];
            while of[*place as usize] / BLOCK == home {
                *place += 1;
            }
            let place = *place;
            next[home as usize] += 1;
            swap(of, slot, place);
        }
        for slot in block * BLOCK..end {
            while of[slot as usize] != slot {
                let place = of[slot as usize];
                swap(of, slot, place);
            }
        }
    }
}
