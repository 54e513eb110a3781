//! Which tetrahedra lie on the same side, and which on opposite ones, as far as is known.

use pellicle_delaunay::TetId;

/// Disjoint sets of tetrahedra, whose members each lie on the side of their root, or on the other.
pub(super) struct Forest {
    /// By member: twice its parent, plus one where it lies on the other side than that.
    parents: Vec<u32>,
    sizes: Vec<u32>,
}

impl Forest {
    pub(super) fn new(count: usize) -> Self {
        Self {
            parents: (0..count as u32).map(|member| 2 * member).collect(),
            sizes: vec![1; count],
        }
    }

    /// The root of a member, and whether the member lies on the other side than it.
    pub(super) fn find(&mut self, member: TetId) -> (TetId, bool) {
        let (mut root, mut parity) = (member.0, 0);
        while self.parents[root as usize] >> 1 != root {
            parity ^= self.parents[root as usize] & 1;
            root = self.parents[root as usize] >> 1;
        }
        let (mut member, mut left) = (member.0, parity);
        while self.parents[member as usize] >> 1 != root {
            let parent = self.parents[member as usize];
            self.parents[member as usize] = 2 * root + left;
            left ^= parent & 1;
            member = parent >> 1;
        }
        (TetId(root), parity == 1)
    }

    /// Whether two members are known to lie on opposite sides; none where nothing is known.
    pub(super) fn are_opposite(&mut self, a: TetId, b: TetId) -> Option<bool> {
        let ((a, at_a), (b, at_b)) = (self.find(a), self.find(b));
        (a == b).then_some(at_a != at_b)
    }

    /// Notes how two members lie, unless that is known; whether it is so now.
    pub(super) fn join(&mut self, a: TetId, b: TetId, opposite: bool) -> bool {
        let ((a, at_a), (b, at_b)) = (self.find(a), self.find(b));
        let (mut a, mut b) = (a.0, b.0);
        let parity = u32::from((at_a != at_b) != opposite);
        if a == b {
            return parity == 0;
        }
        if self.sizes[a as usize] < self.sizes[b as usize] {
            std::mem::swap(&mut a, &mut b);
        }
        self.sizes[a as usize] += self.sizes[b as usize];
        self.parents[b as usize] = 2 * a + parity;
        true
    }
}
