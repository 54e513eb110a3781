//! The winding number on both sides of every facet.
//!
//! Behind a facet it is greater than in front by the facet's multiplicity, and across the wedge between two facets that
//! follow each other around an edge it does not change. So one number a connected part is enough; a ray gives it.

use crate::arrangement::Arrangement;
use crate::fan::{Leaf, fan};
use crate::points::Points;
use crate::ray::Rays;
use crate::weld::Weld;
use pellicle_geometry::{Cancelled, Progress, VertexId};
use pellicle_mesh::EdgeTable;

/// For each facet the winding number in front of it.
pub(crate) struct Windings {
    pub in_front: Vec<i32>,
    /// How many connected parts there are: one ray each.
    pub parts: usize,
}

/// Edges at which the sheets do not add up: the surface is open there.
#[derive(Clone, Debug)]
pub(crate) struct OpenEdges {
    pub first: [VertexId; 2],
    pub count: usize,
}

impl Windings {
    /// Or where the surface is open.
    pub(crate) fn new(
        arrangement: &Arrangement,
        table: &EdgeTable,
        weld: &Weld,
        points: &mut Points,
        progress: &dyn Progress,
    ) -> Result<Result<Self, OpenEdges>, Cancelled> {
        let mut levels = Levels::new(arrangement.facets.len());
        let mut open: Option<OpenEdges> = None;
        let height = |leaf: &Leaf| arrangement.facets[leaf.facet as usize].multiplicity;
        let total = (3 * arrangement.pieces.len() / 2) as u64;
        for (done, (edge, entries)) in table.edges().enumerate() {
            if done % 16_384 == 0 {
                Cancelled::check(progress.step("windings", done as u64, total))?;
            }
            // Two pieces of one facet have nothing to say.
            if let [a, b] = entries {
                let [a, b] = [a, b].map(|e| arrangement.facet_of[e.half_edge.triangle().index()]);
                if a == b {
                    continue;
                }
            }
            let leaves = fan(arrangement, weld, points, edge, entries);
            let balance: i32 = leaves
                .iter()
                .map(|leaf| {
                    if leaf.forward {
                        height(leaf)
                    } else {
                        -height(leaf)
                    }
                })
                .sum();
            if balance != 0 {
                open.get_or_insert(OpenEdges {
                    first: edge,
                    count: 0,
                })
                .count += 1;
                continue;
            }
            for (i, leaf) in leaves.iter().enumerate() {
                let next = &leaves[if i + 1 == leaves.len() { 0 } else { i + 1 }];
                // The later side of one and the earlier side of the next, each above its front by:
                let later = if leaf.forward { 0 } else { height(leaf) };
                let earlier = if next.forward { height(next) } else { 0 };
                levels.join(leaf.facet, later, next.facet, earlier);
            }
        }
        if let Some(open) = open {
            return Ok(Err(open));
        }
        Ok(Ok(levels.solve(arrangement, weld, points)))
    }
}

/// Facets whose winding numbers are known relative to each other: disjoint sets with differences.
struct Levels {
    parent: Vec<u32>,
    /// The number in front of a facet less that in front of its parent.
    above_parent: Vec<i32>,
}

impl Levels {
    fn new(count: usize) -> Self {
        Self {
            parent: (0..count as u32).collect(),
            above_parent: vec![0; count],
        }
    }

    /// The root of a facet, and by how much the facet is above it.
    fn find(&mut self, mut x: u32) -> (u32, i32) {
        let mut above = 0;
        while self.parent[x as usize] != x {
            let parent = self.parent[x as usize];
            self.above_parent[x as usize] += self.above_parent[parent as usize];
            self.parent[x as usize] = self.parent[parent as usize];
            above += self.above_parent[x as usize];
            x = self.parent[x as usize];
        }
        (x, above)
    }

    /// States that `a` plus one number is `b` plus another one.
    fn join(&mut self, a: u32, more_than_a: i32, b: u32, more_than_b: i32) {
        let ((root_a, a), (root_b, b)) = (self.find(a), self.find(b));
        let (least, other) = (root_a.min(root_b), root_a.max(root_b));
        if least == other {
            // They agree, unless the surface is open elsewhere.
            return;
        }
        // root_a + a + more_than_a = root_b + b + more_than_b.
        let a_above_b = b + more_than_b - a - more_than_a;
        self.parent[other as usize] = least;
        self.above_parent[other as usize] = if other == root_a {
            a_above_b
        } else {
            -a_above_b
        };
    }

    /// One ray for each set, from its first facet: a whole triangle, if the set has one.
    fn solve(&mut self, arrangement: &Arrangement, weld: &Weld, points: &mut Points) -> Windings {
        let first_piece = {
            let mut first = vec![u32::MAX; arrangement.facets.len()];
            for (piece, &facet) in arrangement.facet_of.iter().enumerate().rev() {
                first[facet as usize] = piece as u32;
            }
            first
        };
        let roots: Vec<usize> = (0..self.parent.len())
            .filter(|&f| self.parent[f] == f as u32)
            .collect();
        let rays = Rays::new(weld, roots.len());
        let mut in_front = vec![0; arrangement.facets.len()];
        for &root in &roots {
            let piece = arrangement.pieces[first_piece[root] as usize];
            in_front[root] = rays.in_front(&arrangement.facets[root], piece, points);
        }
        for facet in 0..in_front.len() {
            let (root, above) = self.find(facet as u32);
            if root as usize != facet {
                in_front[facet] = in_front[root as usize] + above;
            }
        }
        Windings {
            in_front,
            parts: roots.len(),
        }
    }
}
