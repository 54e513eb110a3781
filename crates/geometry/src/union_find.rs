//! Disjoint sets of `0..n`.

/// Disjoint sets; the representative is always the least member, so results depend on nothing else.
/// Near-constant amortised time by path halving; four bytes a member.
///
/// ```
/// use pellicle_geometry::UnionFind;
/// let mut sets = UnionFind::new(4);
/// assert!(sets.union(3, 1));
/// assert_eq!((sets.find(3), sets.find(2)), (1, 2));
/// ```
#[derive(Clone, Debug)]
pub struct UnionFind {
    parent: Vec<u32>,
}

impl UnionFind {
    /// `n` sets of one member each.
    pub fn new(n: usize) -> Self {
        Self {
            parent: (0..n as u32).collect(),
        }
    }

    /// The least member of the set of `x`. Panics if there is no such member.
    pub fn find(&mut self, mut x: u32) -> u32 {
        while self.parent[x as usize] != x {
            let above = self.parent[self.parent[x as usize] as usize];
            self.parent[x as usize] = above;
            x = above;
        }
        x
    }

    /// Joins the sets of `x` and `y`; whether they were apart.
    pub fn union(&mut self, x: u32, y: u32) -> bool {
        let (x, y) = (self.find(x), self.find(y));
        self.parent[x.max(y) as usize] = x.min(y);
        x != y
    }
}
