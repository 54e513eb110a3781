//! A minimum cut by augmenting paths from two trees (Boykov and Kolmogorov 2004).
//!
//! The graph is that of tetrahedra: a node has four arcs, and arc `4n + i` of node n goes to the node of the
//! arc's twin, which leads back. Capacities are integers, so that sums are exact and the cut is
//! unique: its source side are the nodes that the source still reaches.

use std::collections::VecDeque;

/// No arc: where a node has fewer than four neighbours.
pub(super) const NO_ARC: u32 = u32::MAX;

/// As `parent`: the node hangs on the terminal of its tree.
const TERMINAL: u32 = u32::MAX - 1;

/// As `parent`: the node has lost its parent, or is in no tree.
const NONE: u32 = u32::MAX;

#[derive(Clone, Copy, PartialEq, Eq)]
enum Tree {
    Free,
    Source,
    Sink,
}

/// Nodes with up to four arcs each, and residual capacities.
pub(super) struct Network {
    /// By arc, the opposite arc.
    pub(super) twins: Vec<[u32; 4]>,
    /// By arc, what it still lets through.
    pub(super) capacities: Vec<[i64; 4]>,
    /// By node: what the source can still send into it, or, negative, what it can still send to the sink.
    pub(super) terminals: Vec<i64>,
    tree: Vec<Tree>,
    /// By node, the arc from it to its parent.
    parent: Vec<u32>,
    active: VecDeque<u32>,
    is_active: Vec<bool>,
    orphans: VecDeque<u32>,
    /// By node, when its distance to the terminal was last known, and that distance.
    stamp: Vec<u32>,
    distance: Vec<u32>,
    time: u32,
}

impl Network {
    pub(super) fn new(
        twins: Vec<[u32; 4]>,
        capacities: Vec<[i64; 4]>,
        terminals: Vec<i64>,
    ) -> Self {
        let count = twins.len();
        Self {
            twins,
            capacities,
            terminals,
            tree: vec![Tree::Free; count],
            parent: vec![NONE; count],
            active: VecDeque::new(),
            is_active: vec![false; count],
            orphans: VecDeque::new(),
            stamp: vec![0; count],
            distance: vec![0; count],
            time: 0,
        }
    }

    /// By node, whether it is on the source's side of the minimum cut, the one with the fewest such nodes.
    pub(super) fn source_side(mut self) -> Vec<bool> {
        for node in 0..self.twins.len() {
            self.tree[node] = match self.terminals[node] {
                0 => continue,
                1.. => Tree::Source,
                _ => Tree::Sink,
            };
            self.parent[node] = TERMINAL;
            self.distance[node] = 1;
            self.activate(node as u32);
        }
        while let Some(&node) = self.active.front() {
            match self.grow(node) {
                Some(bridge) => {
                    self.augment(bridge);
                    self.adopt_orphans();
                }
                None => {
                    self.active.pop_front();
                    self.is_active[node as usize] = false;
                }
            }
        }
        self.tree.iter().map(|&tree| tree == Tree::Source).collect()
    }

    fn activate(&mut self, node: u32) {
        if !std::mem::replace(&mut self.is_active[node as usize], true) {
            self.active.push_back(node);
        }
    }

    #[inline]
    fn twin(&self, arc: u32) -> u32 {
        self.twins[arc as usize / 4][arc as usize % 4]
    }

    #[inline]
    fn capacity(&mut self, arc: u32) -> &mut i64 {
        &mut self.capacities[arc as usize / 4][arc as usize % 4]
    }

    /// What can flow between a node's parent and it, in the direction of its tree.
    #[inline]
    fn room(&mut self, tree: Tree, from_child: u32, to_child: u32) -> i64 {
        *match tree {
            Tree::Source => self.capacity(to_child),
            _ => self.capacity(from_child),
        }
    }

    /// Takes free neighbours into the tree of `node`; an arc from the source's tree to the sink's when
    /// they meet.
    fn grow(&mut self, node: u32) -> Option<u32> {
        let tree = self.tree[node as usize];
        if tree == Tree::Free {
            return None;
        }
        for arc in 4 * node..4 * node + 4 {
            let twin = self.twin(arc);
            if twin == NO_ARC || self.room(tree, twin, arc) == 0 {
                continue;
            }
            let other = twin / 4;
            let o = other as usize;
            if self.tree[o] == Tree::Free {
                self.tree[o] = tree;
                self.parent[o] = twin;
                self.stamp[o] = self.stamp[node as usize];
                self.distance[o] = self.distance[node as usize] + 1;
                self.activate(other);
            } else if self.tree[o] != tree {
                return Some(if tree == Tree::Source { arc } else { twin });
            } else if self.stamp[o] <= self.stamp[node as usize]
                && self.distance[o] > self.distance[node as usize] + 1
                && self.parent[o] != TERMINAL
            {
                self.parent[o] = twin;
                self.stamp[o] = self.stamp[node as usize];
                self.distance[o] = self.distance[node as usize] + 1;
            }
        }
        None
    }

    /// Sends as much as fits along the path through `bridge`.
    fn augment(&mut self, bridge: u32) {
        let ends = [
            (Tree::Source, bridge / 4),
            (Tree::Sink, self.twin(bridge) / 4),
        ];
        let mut flow = *self.capacity(bridge);
        for (tree, start) in ends {
            let mut node = start;
            while self.parent[node as usize] != TERMINAL {
                let up = self.parent[node as usize];
                let down = self.twin(up);
                flow = flow.min(self.room(tree, up, down));
                node = down / 4;
            }
            flow = flow.min(self.terminals[node as usize].abs());
        }
        let back = self.twin(bridge);
        *self.capacity(bridge) -= flow;
        *self.capacity(back) += flow;
        for (tree, start) in ends {
            let mut node = start;
            while self.parent[node as usize] != TERMINAL {
                let up = self.parent[node as usize];
                let down = self.twin(up);
                let (forth, back) = match tree {
                    Tree::Source => (down, up),
                    _ => (up, down),
                };
                *self.capacity(forth) -= flow;
                *self.capacity(back) += flow;
                if *self.capacity(forth) == 0 {
                    self.orphan(node);
                }
                node = down / 4;
            }
            let sign = if tree == Tree::Source { 1 } else { -1 };
            self.terminals[node as usize] -= sign * flow;
            if self.terminals[node as usize] == 0 {
                self.orphan(node);
            }
        }
    }

    fn orphan(&mut self, node: u32) {
        self.parent[node as usize] = NONE;
        self.orphans.push_back(node);
    }

    fn adopt_orphans(&mut self) {
        self.time += 1;
        while let Some(node) = self.orphans.pop_front() {
            self.adopt(node);
        }
    }

    /// Finds the orphan a parent that is nearest to its terminal, or sets it free.
    fn adopt(&mut self, node: u32) {
        let tree = self.tree[node as usize];
        let mut best = (u32::MAX, NONE);
        for arc in 4 * node..4 * node + 4 {
            let twin = self.twin(arc);
            if twin == NO_ARC
                || self.tree[twin as usize / 4] != tree
                || self.room(tree, arc, twin) == 0
            {
                continue;
            }
            if let Some(distance) = self.distance_to_terminal(twin / 4)
                && distance < best.0
            {
                best = (distance, arc);
            }
        }
        let n = node as usize;
        if best.1 != NONE {
            self.parent[n] = best.1;
            self.stamp[n] = self.time;
            self.distance[n] = best.0 + 1;
            return;
        }
        for arc in 4 * node..4 * node + 4 {
            let twin = self.twin(arc);
            if twin == NO_ARC || self.tree[twin as usize / 4] != tree {
                continue;
            }
            let other = twin / 4;
            if self.room(tree, arc, twin) > 0 {
                self.activate(other);
            }
            if self.parent[other as usize] == twin {
                self.orphan(other);
            }
        }
        self.tree[n] = Tree::Free;
        self.stamp[n] = 0;
    }

    /// How many steps up from `start` the terminal is; none where the way ends at an orphan.
    fn distance_to_terminal(&mut self, start: u32) -> Option<u32> {
        let (mut node, mut steps) = (start, 0);
        let distance = loop {
            let n = node as usize;
            if self.stamp[n] == self.time {
                break steps + self.distance[n];
            }
            match self.parent[n] {
                TERMINAL => {
                    self.stamp[n] = self.time;
                    self.distance[n] = 1;
                    break steps + 1;
                }
                NONE => return None,
                up => node = self.twin(up) / 4,
            }
            steps += 1;
        };
        let (mut node, mut left) = (start, distance);
        while self.stamp[node as usize] != self.time {
            self.stamp[node as usize] = self.time;
            self.distance[node as usize] = left;
            left -= 1;
            node = self.twin(self.parent[node as usize]) / 4;
        }
        Some(distance)
    }
}

#[cfg(test)]
mod tests;
