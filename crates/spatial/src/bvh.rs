//! A bounding-volume hierarchy: which boxes overlap, and which primitive is nearest.
//!
//! A binary tree over boxes, in one flat array in depth-first order: the left child follows its parent,
//! the parent holds the index of the right one. Built top down: the boxes of a node are halved at the median
//! of their centers along the axis on which those spread most; ties are decided by index, so that the tree
//! depends on the boxes alone, not on the threads that build it. Depth at most 32.
//!
//! Every query visits a node whose bound *equals* the best so far, so results do not depend on the shape
//! of the tree; of equally near primitives the one with the least index is reported.

use pellicle_geometry::{Aabb, DVec3};
use std::ops::ControlFlow;

/// Leaves hold at most this many boxes: measured on pairs and nearest queries, 2 to 8 differ little.
const LEAF: usize = 4;

/// A hierarchy over boxes; primitives are named by their index in the slice it was built from.
///
/// ```
/// use pellicle_geometry::{Aabb, DVec3};
/// use pellicle_spatial::Bvh;
/// let points = [DVec3::ZERO, DVec3::X, 5.0 * DVec3::X];
/// let bvh = Bvh::new(points.iter().map(|&p| Aabb::EMPTY.with(p)));
/// let nearest = bvh.nearest(3.5 * DVec3::X, |i| points[i as usize].distance_squared(3.5 * DVec3::X));
/// assert_eq!(nearest, Some((2, 2.25)));
/// ```
#[derive(Clone, Debug, Default)]
pub struct Bvh {
    nodes: Vec<Node>,
    /// The boxes in the order of the leaves, and the primitives that they belong to.
    boxes: Vec<Aabb>,
    primitives: Vec<u32>,
}

#[derive(Clone, Copy, Debug)]
struct Node {
    bounds: Aabb,
    /// A leaf's first box; else the right child (the left child is the next node).
    start_or_right: u32,
    /// How many boxes a leaf holds; 0 marks an inner node.
    count: u32,
}

/// A part of the search for overlapping pairs: two subtrees, or one with itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct OverlapTask {
    a: u32,
    b: u32,
}

impl Bvh {
    /// The hierarchy of boxes. Empty boxes, and boxes with NaN, belong to no leaf and are never found.
    /// O(n log n); 52 bytes a box and at most 28 bytes a box of nodes. At most 2³² − 1 boxes: any beyond are
    /// left out.
    pub fn new(boxes: impl IntoIterator<Item = Aabb>) -> Self {
        let mut items: Vec<Item> = boxes
            .into_iter()
            .zip(0..u32::MAX)
            .filter(|(bounds, _)| !bounds.is_empty())
            .map(|(bounds, primitive)| Item { bounds, primitive })
            .collect();
        let blank = Node {
            bounds: Aabb::EMPTY,
            start_or_right: 0,
            count: 0,
        };
        let count = match items.len() {
            0 => 0,
            n => subtree_sizes(n).0,
        };
        let mut nodes = vec![blank; count];
        if !items.is_empty() {
            build(&mut nodes, 0, &mut items, 0);
        }
        Self {
            nodes,
            boxes: items.iter().map(|item| item.bounds).collect(),
            primitives: items.iter().map(|item| item.primitive).collect(),
        }
    }

    /// How many boxes can be found.
    pub fn len(&self) -> usize {
        self.primitives.len()
    }

    /// Whether there is nothing to find.
    pub fn is_empty(&self) -> bool {
        self.primitives.is_empty()
    }

    /// The box around everything.
    pub fn bounds(&self) -> Aabb {
        self.nodes.first().map_or(Aabb::EMPTY, |root| root.bounds)
    }

    /// Visits each primitive whose box shares a point with `query`, in the order of the tree, until `Break`.
    pub fn overlapping(
        &self,
        query: Aabb,
        mut visit: impl FnMut(u32) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let mut stack: Vec<u32> = self.nodes.first().map(|_| 0).into_iter().collect();
        while let Some(index) = stack.pop() {
            let node = &self.nodes[index as usize];
            if !node.bounds.overlaps(query) {
                continue;
            }
            if node.count == 0 {
                stack.extend([node.start_or_right, index + 1]);
            }
            for i in node.leaf() {
                if self.boxes[i].overlaps(query) {
                    visit(self.primitives[i])?;
                }
            }
        }
        ControlFlow::Continue(())
    }

    /// Visits each pair of different primitives whose boxes share a point, once, as (lesser, greater)
    /// index, until `Break`. O(n log n + pairs) where boxes are spread evenly.
    pub fn self_overlaps(&self, visit: impl FnMut(u32, u32) -> ControlFlow<()>) -> ControlFlow<()> {
        match self.nodes.is_empty() {
            true => ControlFlow::Continue(()),
            false => self.overlaps_of(OverlapTask { a: 0, b: 0 }, visit),
        }
    }

    /// The search of [`Self::self_overlaps`] in at least `count` parts where it is large enough, for
    /// [`Self::overlaps_of`]; together they find each pair once. The parts depend on the boxes and `count`
    /// alone.
    pub fn overlap_tasks(&self, count: usize) -> Vec<OverlapTask> {
        let mut tasks = Vec::new();
        if !self.nodes.is_empty() {
            tasks.push(OverlapTask { a: 0, b: 0 });
        }
        let mut divisible = true;
        while divisible && tasks.len() < count {
            divisible = false;
            let mut finer = Vec::new();
            for task in tasks {
                divisible |= self.refine(task, |part| finer.push(part));
            }
            tasks = finer;
        }
        tasks
    }

    /// Visits the pairs of one part of the search, each as (lesser, greater) index, until `Break`.
    pub fn overlaps_of(
        &self,
        task: OverlapTask,
        mut visit: impl FnMut(u32, u32) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        let mut stack = vec![task];
        while let Some(task) = stack.pop() {
            if !self.refine(task, |part| stack.push(part)) {
                // It pushed the task itself, which is two leaves.
                stack.pop();
                self.leaf_pairs(task, &mut visit)?;
            }
        }
        ControlFlow::Continue(())
    }

    /// The primitive with the least `distance_squared`, and that; of equals the least index. `None` if
    /// there is no primitive or every distance is NaN.
    ///
    /// `distance_squared(i)` must not be below the computed distance of `point` from the box of `i`
    /// ([`Aabb::distance_squared`]), as the distance of any point of that box is.
    pub fn nearest(
        &self,
        point: DVec3,
        mut distance_squared: impl FnMut(u32) -> f64,
    ) -> Option<(u32, f64)> {
        let mut best: Option<(u32, f64)> = None;
        let mut stack: Vec<(u32, f64)> = Vec::with_capacity(64);
        if let Some(root) = self.nodes.first() {
            stack.push((0, root.bounds.distance_squared(point)));
        }
        while let Some((index, bound)) = stack.pop() {
            if best.is_some_and(|(_, least)| bound > least) {
                continue;
            }
            let node = &self.nodes[index as usize];
            if node.count == 0 {
                let [left, right] = [index + 1, node.start_or_right]
                    .map(|i| (i, self.nodes[i as usize].bounds.distance_squared(point)));
                // The nearer child last, so that it is popped first.
                stack.extend(if left.1 <= right.1 {
                    [right, left]
                } else {
                    [left, right]
                });
            }
            for i in node.leaf() {
                if best.is_some_and(|(_, least)| self.boxes[i].distance_squared(point) > least) {
                    continue;
                }
                let primitive = self.primitives[i];
                let distance = distance_squared(primitive);
                let nearer = match best {
                    Some((other, least)) => {
                        distance < least || (distance == least && primitive < other)
                    }
                    None => !distance.is_nan(),
                };
                if nearer {
                    best = Some((primitive, distance));
                }
            }
        }
        best
    }

    /// Pushes the smaller tasks that a task consists of, as far as their boxes meet, and is true; or, if it
    /// is two leaves, pushes the task itself and is false.
    fn refine(&self, task: OverlapTask, mut push: impl FnMut(OverlapTask)) -> bool {
        let OverlapTask { a, b } = task;
        let (na, nb) = (&self.nodes[a as usize], &self.nodes[b as usize]);
        if a == b {
            if na.count > 0 {
                push(task);
                return false;
            }
            let (left, right) = (a + 1, na.start_or_right);
            push(OverlapTask { a: left, b: left });
            push(OverlapTask { a: right, b: right });
            self.push_if_meeting(left, right, &mut push);
            return true;
        }
        // Descend into the larger of the two, and never into a leaf.
        let size = |node: &Node| node.bounds.extent().max_element();
        if na.count == 0 && (nb.count > 0 || size(na) >= size(nb)) {
            self.push_if_meeting(a + 1, b, &mut push);
            self.push_if_meeting(na.start_or_right, b, &mut push);
            true
        } else if nb.count == 0 {
            self.push_if_meeting(a, b + 1, &mut push);
            self.push_if_meeting(a, nb.start_or_right, &mut push);
            true
        } else {
            push(task);
            false
        }
    }

    fn push_if_meeting(&self, a: u32, b: u32, push: &mut impl FnMut(OverlapTask)) {
        if self.nodes[a as usize]
            .bounds
            .overlaps(self.nodes[b as usize].bounds)
        {
            push(OverlapTask { a, b });
        }
    }

    fn leaf_pairs(
        &self,
        OverlapTask { a, b }: OverlapTask,
        visit: &mut impl FnMut(u32, u32) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        for i in self.nodes[a as usize].leaf() {
            for j in self.nodes[b as usize].leaf() {
                // A leaf with itself: each pair once.
                if (a != b || i < j) && self.boxes[i].overlaps(self.boxes[j]) {
                    let (p, q) = (self.primitives[i], self.primitives[j]);
                    visit(p.min(q), p.max(q))?;
                }
            }
        }
        ControlFlow::Continue(())
    }
}

impl Node {
    /// The boxes of a leaf; none for an inner node.
    #[inline]
    fn leaf(&self) -> std::ops::Range<usize> {
        match self.count {
            0 => 0..0,
            count => self.start_or_right as usize..(self.start_or_right + count) as usize,
        }
    }
}

#[derive(Clone, Copy)]
struct Item {
    bounds: Aabb,
    primitive: u32,
}

/// How many nodes the trees over n and n + 1 boxes have, n > 0.
fn subtree_sizes(n: usize) -> (usize, usize) {
    if n < LEAF {
        return (1, 1);
    }
    // With h = n/2 rounded down: the halves of n and n + 1 are h and h + 1.
    let (half, more) = subtree_sizes(n / 2);
    let tree = |n: usize, inner: usize| if n <= LEAF { 1 } else { inner };
    match n % 2 {
        0 => (tree(n, 1 + 2 * half), tree(n + 1, 1 + half + more)),
        _ => (tree(n, 1 + half + more), tree(n + 1, 1 + 2 * more)),
    }
}

/// Fills in the subtree over `items`, which are the boxes from `start` on, and sorts them into its leaves. `first` is the
/// id of the first of its nodes, which are all that it has.
fn build(nodes: &mut [Node], first: u32, items: &mut [Item], start: u32) {
    /// Below this many boxes a thread of its own does not pay.
    const LARGE: usize = 4096;
    let bounds = items
        .iter()
        .fold(Aabb::EMPTY, |b, item| b.union(item.bounds));
    let (this, below) = match nodes.split_first_mut() {
        Some(split) => split,
        None => return,
    };
    *this = Node {
        bounds,
        start_or_right: start,
        count: items.len() as u32,
    };
    if items.len() <= LEAF {
        return;
    }
    let centers = items
        .iter()
        .fold(Aabb::EMPTY, |b, item| b.with(item.bounds.center()));
    let axis = longest_axis(centers);
    let middle = items.len() / 2;
    items.select_nth_unstable_by(middle, |a, b| {
        let key = |item: &Item| item.bounds.center()[axis];
        key(a)
            .total_cmp(&key(b))
            .then(a.primitive.cmp(&b.primitive))
    });
    let is_large = items.len() > LARGE;
    let (left, right) = items.split_at_mut(middle);
    let left_size = subtree_sizes(left.len()).0;
    let (left_nodes, right_nodes) = below.split_at_mut(left_size);
    let right_first = first + 1 + left_size as u32;
    this.start_or_right = right_first;
    this.count = 0;
    let mut build_left = || build(left_nodes, first + 1, left, start);
    let mut build_right = || build(right_nodes, right_first, right, start + middle as u32);
    if is_large {
        rayon::join(build_left, build_right);
    } else {
        build_left();
        build_right();
    }
}

/// The axis on which a box is longest; the first of equals.
pub(crate) fn longest_axis(bounds: Aabb) -> usize {
    let extent = bounds.extent();
    (1..3).fold(0, |best, axis| {
        if extent[axis] > extent[best] {
            axis
        } else {
            best
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn subtrees_have_as_many_nodes_as_they_are_given() {
        fn count(n: usize) -> usize {
            match n {
                0..=LEAF => 1,
                _ => 1 + count(n / 2) + count(n - n / 2),
            }
        }
        for n in 1..3000 {
            assert_eq!(subtree_sizes(n), (count(n), count(n + 1)), "{n}");
        }
    }
}
