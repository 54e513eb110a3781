//! From the kernel's arrays to the caller's vertices.

use super::kernel::{INFINITE, Kernel};
use crate::{FacetId, TetId, Tetrahedralization, id::facet_vertices};
use glam::DVec3;
use pellicle_geometry::VertexId;

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
        let (mut tets, mut twins, in_use) = cells.into_plain();
        latest_first(&mut tets, &mut twins, &in_use);
        let places = places(&tets, &in_use, vertices);
        drop(in_use);
        let caller = |vertex| match vertex {
            INFINITE => Tetrahedralization::INFINITE,
            VertexId(vertex) => VertexId(order[vertex as usize - 1]),
        };
        let moved =
            |twin: FacetId| FacetId::of(TetId(places.of[twin.tet().index()]), twin.corner());
        let (tets, twins) = rayon::join(
            || places.apply(tets, |tet| tet.map(caller)),
            || places.apply(twins, |twins| twins.map(moved)),
        );
        let finite = places.finite;
        drop(places);
        Tetrahedralization::from_arrays(points, tets, twins, finite, duplicates)
    }
}

/// Turns the tetrahedra such that the corner inserted last comes first and the least one last. Those that
/// one thread made are so already.
fn latest_first(tets: &mut [[VertexId; 4]], twins: &mut [[FacetId; 4]], in_use: &[bool]) {
    for t in 0..tets.len() {
        let [a, b, c, d] = tets[t];
        if !in_use[t] || (a > b && a > c && d < b && d < c) {
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

/// By slot the tetrahedron's place in the result; [`NOWHERE`] for slots not in use.
struct Places {
    of: Vec<u32>,
    /// How many places are finite tetrahedra'.
    finite: usize,
    /// How many places there are.
    used: usize,
}

const NOWHERE: u32 = u32::MAX;

fn places(tets: &[[VertexId; 4]], in_use: &[bool], vertices: usize) -> Places {
    // 1. By latest vertex, the list of its finite tetrahedra: the last one here, the one before in `of`.
    let mut last = vec![NOWHERE; vertices];
    let mut of = vec![NOWHERE; tets.len()];
    let mut infinite: Vec<u32> = Vec::new();
    for (t, (tet, &in_use)) in tets.iter().zip(in_use).enumerate() {
        if !in_use {
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
        while t != NOWHERE {
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
    for t in infinite {
        of[t as usize] = used;
        used += 1;
    }
    Places {
        of,
        finite,
        used: used as usize,
    }
}

impl Places {
    /// Moves each item to its place, changed by `renamed`, and drops those of slots not in use.
    ///
    /// Slots and places run about alike, so items move little. Block by block the old items are read, and
    /// written at once where the old ones have been read already; those that go further on wait in blocks
    /// of their own, of which there are few at a time. Infinite ones, which all go to the end, would fill
    /// such blocks sparsely; they wait in a list.
    fn apply<T: Copy>(&self, mut items: Vec<T>, renamed: impl Fn(T) -> T) -> Vec<T> {
        const BLOCK: usize = 1024;
        let blocks = items.len().div_ceil(BLOCK);
        let mut waiting: Vec<Vec<T>> = (0..blocks).map(|_| Vec::new()).collect();
        let mut last: Vec<(u32, T)> = Vec::new();
        let mut old: Vec<T> = Vec::with_capacity(BLOCK);
        for block in 0..blocks {
            let start = block * BLOCK;
            let end = (start + BLOCK).min(items.len());
            old.clear();
            old.extend_from_slice(&items[start..end]);
            let arrived = std::mem::take(&mut waiting[block]);
            items[start..start + arrived.len()].copy_from_slice(&arrived);
            for (&item, &place) in old.iter().zip(&self.of[start..end]) {
                if place == NOWHERE {
                    continue;
                }
                let (at, item) = (place as usize, renamed(item));
                if at < end {
                    items[at] = item;
                } else if at < self.finite {
                    let there = &mut waiting[at / BLOCK];
                    if there.is_empty() {
                        there.resize(BLOCK.min(items.len() - at / BLOCK * BLOCK), item);
                    }
                    there[at % BLOCK] = item;
                } else {
                    last.push((place, item));
                }
            }
        }
        items.truncate(self.used);
        for (place, item) in last {
            items[place as usize] = item;
        }
        items.shrink_to_fit();
        items
    }
}
