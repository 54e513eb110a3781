//! A k-d tree: which points are nearest.
//!
//! Points are halved at the median along the axis on which they spread most (Friedman et al. 1977), ties
//! decided by index: any number of points may coincide, or share a coordinate. The tree is implicit: a node
//! is a range of the sorted points, its split the middle one. Depth at most 32.
//!
//! A half-space at exactly the best distance so far is searched too, so that of equally near points the one
//! with the least index is found, whatever the shape of the tree.

use crate::bvh::longest_axis;
use pellicle_geometry::{Aabb, DVec3};
use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// Ranges this short are scanned.
const LEAF: usize = 8;

/// A point found, with the square of its distance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Neighbor {
    /// The index of the point in the slice that the tree was built from.
    pub index: u32,
    /// The square of its distance from the query; infinite where that overflows.
    pub distance_squared: f64,
}

/// Points sorted for search; points are named by their index in the slice it was built from.
///
/// ```
/// use pellicle_geometry::DVec3;
/// use pellicle_spatial::KdTree;
/// let tree = KdTree::new(&[DVec3::ZERO, DVec3::X, 5.0 * DVec3::X]);
/// assert_eq!(tree.nearest(2.0 * DVec3::X).unwrap().index, 1);
/// assert_eq!(tree.within(DVec3::ZERO, 1.0).len(), 2);
/// ```
#[derive(Clone, Debug, Default)]
pub struct KdTree {
    points: Vec<DVec3>,
    indices: Vec<u32>,
    /// The axis of the split whose middle point has this place.
    axes: Vec<u8>,
}

impl KdTree {
    /// The tree of some points. Points that are not finite are left out and never found. O(n log n), 29
    /// bytes a point. At most 2³² − 1 points: any beyond are left out.
    pub fn new(points: &[DVec3]) -> Self {
        let mut items: Vec<(DVec3, u32)> = points
            .iter()
            .zip(0..u32::MAX)
            .filter(|(p, _)| p.is_finite())
            .map(|(&p, i)| (p, i))
            .collect();
        let mut axes = vec![0; items.len()];
        build(&mut items, &mut axes);
        Self {
            points: items.iter().map(|item| item.0).collect(),
            indices: items.iter().map(|item| item.1).collect(),
            axes,
        }
    }

    /// How many points can be found.
    pub fn len(&self) -> usize {
        self.points.len()
    }

    /// Whether there is nothing to find.
    pub fn is_empty(&self) -> bool {
        self.points.is_empty()
    }

    /// The point nearest to `query`; of equals the least index. `None` only for an empty tree.
    ///
    /// The query must be finite.
    pub fn nearest(&self, query: DVec3) -> Option<Neighbor> {
        let mut best: Option<Neighbor> = None;
        self.search(query, f64::INFINITY, |found| match best {
            Some(least) if least.order(&found).is_le() => least.distance_squared,
            _ => {
                best = Some(found);
                found.distance_squared
            }
        });
        best
    }

    /// The `k` points nearest to `query`, the nearest first, of equals the least index; all points if
    /// there are fewer.
    pub fn nearest_k(&self, query: DVec3, k: usize) -> Vec<Neighbor> {
        if k == 0 {
            return Vec::new();
        }
        let mut heap: BinaryHeap<Farthest> = BinaryHeap::with_capacity(k.min(self.len()) + 1);
        self.search(query, f64::INFINITY, |found| {
            heap.push(Farthest(found));
            if heap.len() > k {
                heap.pop();
            }
            match heap.peek() {
                Some(farthest) if heap.len() == k => farthest.0.distance_squared,
                _ => f64::INFINITY,
            }
        });
        heap.into_sorted_vec().into_iter().map(|f| f.0).collect()
    }

    /// The points whose squared distance from `query` is at most `radius` squared, sorted by index.
    /// A negative radius finds nothing.
    pub fn within(&self, query: DVec3, radius: f64) -> Vec<Neighbor> {
        let mut found = Vec::new();
        let limit = radius * radius;
        if radius >= 0.0 {
            self.search(query, limit, |neighbor| {
                if neighbor.distance_squared <= limit {
                    found.push(neighbor);
                }
                limit
            });
        }
        found.sort_unstable_by_key(|n| n.index);
        found
    }

    /// Offers points to `visit`, which returns the square of the distance beyond which it wants no more.
    fn search(&self, query: DVec3, limit: f64, mut visit: impl FnMut(Neighbor) -> f64) {
        let mut limit = limit;
        let mut offer = |place: usize, limit: &mut f64| {
            let distance_squared = (query - self.points[place]).length_squared();
            if distance_squared <= *limit {
                *limit = visit(Neighbor {
                    index: self.indices[place],
                    distance_squared,
                });
            }
        };
        // Ranges still to search, with the gap on each axis between the query and their half-spaces.
        let mut stack = Vec::with_capacity(64);
        stack.push((0, self.points.len(), DVec3::ZERO));
        while let Some((mut start, mut end, gap)) = stack.pop() {
            if gap.length_squared() > limit {
                continue;
            }
            // Down to the leaf on the side of the query; the gap does not grow on the way.
            while end - start > LEAF {
                let middle = usize::midpoint(start, end);
                let axis = usize::from(self.axes[middle]);
                let offset = query[axis] - self.points[middle][axis];
                let mut across = gap;
                across[axis] = across[axis].max(offset.abs());
                if offset < 0.0 {
                    stack.push((middle + 1, end, across));
                    end = middle;
                } else {
                    stack.push((start, middle, across));
                    start = middle + 1;
                }
                offer(middle, &mut limit);
            }
            for place in start..end {
                offer(place, &mut limit);
            }
        }
    }
}

impl Neighbor {
    /// By distance, then by index.
    fn order(&self, other: &Self) -> Ordering {
        self.distance_squared
            .total_cmp(&other.distance_squared)
            .then(self.index.cmp(&other.index))
    }
}

/// Sorts the farthest neighbor to the top of a heap.
struct Farthest(Neighbor);

impl Ord for Farthest {
    fn cmp(&self, other: &Self) -> Ordering {
        self.0.order(&other.0)
    }
}

impl PartialOrd for Farthest {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Farthest {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Farthest {}

/// The median distance from a point to the nearest other place: coinciding points count as one.
/// `None` if all finite points coincide.
///
/// Of more than 100,000 distinct points every n-th in lexicographic order is asked, always among all
/// others; so the estimate depends on the set of points alone. O(n log n).
///
/// ```
/// use pellicle_geometry::DVec3;
/// use pellicle_spatial::median_spacing;
/// let line: Vec<DVec3> = (0..10).flat_map(|i| [0.5 * f64::from(i) * DVec3::X; 2]).collect();
/// assert_eq!(median_spacing(&line), Some(0.5));
/// ```
pub fn median_spacing(points: &[DVec3]) -> Option<f64> {
    const ASKED: usize = 100_000;
    let mut distinct: Vec<DVec3> = points.iter().copied().filter(|p| p.is_finite()).collect();
    // Adding zero makes -0 and 0 one.
    distinct.iter_mut().for_each(|p| *p += DVec3::ZERO);
    let lexicographic = |a: &DVec3, b: &DVec3| {
        let by = |axis: usize| a[axis].total_cmp(&b[axis]);
        by(0).then_with(|| by(1)).then_with(|| by(2))
    };
    distinct.sort_unstable_by(lexicographic);
    distinct.dedup();
    // Squares must neither overflow nor vanish: bring the longest side to about one.
    let bounds = Aabb::of_points(&distinct);
    let half = 0.5 * bounds.max - 0.5 * bounds.min;
    let scale = pellicle_geometry::triangle::power_of_two_near(half.max_element());
    let center = bounds.center();
    let scaled: Vec<DVec3> = distinct
        .iter()
        .map(|&p| p / scale - center / scale)
        .collect();
    let tree = KdTree::new(&scaled);
    let stride = scaled.len().div_ceil(ASKED).max(1);
    let mut spacings: Vec<f64> = (0..scaled.len())
        .step_by(stride)
        .filter_map(|i| {
            let nearest = tree.nearest_k(scaled[i], 2);
            let other = nearest.iter().find(|n| n.index as usize != i)?;
            // The unscaled difference of neighbours is the more exact one.
            Some((distinct[other.index as usize] / scale - distinct[i] / scale).length() * scale)
        })
        .collect();
    if spacings.is_empty() {
        return None;
    }
    let middle = spacings.len() / 2;
    Some(*spacings.select_nth_unstable_by(middle, f64::total_cmp).1)
}

/// Sorts points so that each range longer than a leaf is split at its middle, and notes the axes.
fn build(items: &mut [(DVec3, u32)], axes: &mut [u8]) {
    if items.len() <= LEAF {
        return;
    }
    let bounds = items.iter().fold(Aabb::EMPTY, |b, item| b.with(item.0));
    let axis = longest_axis(bounds);
    let middle = items.len() / 2;
    items.select_nth_unstable_by(middle, |a, b| {
        a.0[axis].total_cmp(&b.0[axis]).then(a.1.cmp(&b.1))
    });
    axes[middle] = axis as u8;
    // The middle point stays where it is: it is the split.
    build(&mut items[..middle], &mut axes[..middle]);
    build(&mut items[middle + 1..], &mut axes[middle + 1..]);
}
