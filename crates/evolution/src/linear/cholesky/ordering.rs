//! An order of elimination that keeps a factor sparse: nested dissection (George 1973) by distances in the graph.
//!
//! ```text
//!    a · · · s · · · b        s: the vertices on a's side, or on b's, that touch the other; ordered last.
//!    · · · · s · · · ·        What is left of each side is dissected in its turn.
//! ```
//!
//! a and b are far apart (as in George and Liu 1978); a vertex belongs to the one that is nearer, up to a shift that
//! makes the sides equal.

use crate::linear::CsrPattern;

/// Sets this small are not dissected.
const LEAF: usize = 8;

/// The vertices in the order in which to eliminate them. Time O(entries · log rows) on meshes.
pub(super) fn nested_dissection(pattern: &CsrPattern) -> Vec<u32> {
    let rows = pattern.rows();
    let mut dissection = Dissection {
        pattern,
        set: vec![0; rows],
        sets: 0,
        distance: vec![[0; 2]; rows],
        queue: Vec::with_capacity(rows),
    };
    let mut order = vec![0; rows];
    // Each set fills the places before `end`.
    let mut todo = vec![((0..rows as u32).collect::<Vec<_>>(), rows)];
    while let Some((vertices, end)) = todo.pop() {
        if vertices.len() <= LEAF {
            order[end - vertices.len()..end].copy_from_slice(&vertices);
            continue;
        }
        let (separator, parts) = dissection.dissect(&vertices);
        let mut end = end - separator.len();
        order[end..end + separator.len()].copy_from_slice(&separator);
        for part in parts {
            let size = part.len();
            todo.push((part, end));
            end -= size;
        }
    }
    order
}

struct Dissection<'a> {
    pattern: &'a CsrPattern,
    /// The set to which a vertex belongs at present.
    set: Vec<u32>,
    sets: u32,
    /// From either end.
    distance: Vec<[u32; 2]>,
    queue: Vec<u32>,
}

impl Dissection<'_> {
    /// A separator, and sets without an edge between them: two sides, or as many as are not connected and then no
    /// separator.
    fn dissect(&mut self, vertices: &[u32]) -> (Vec<u32>, Vec<Vec<u32>>) {
        self.sets += 1;
        for &vertex in vertices {
            self.set[vertex as usize] = self.sets;
        }
        self.measure(vertices[0], 0);
        if self.queue.len() < vertices.len() {
            return (vec![], self.components(vertices));
        }
        let a = self.last();
        self.measure(a, 0);
        let b = self.last();
        self.measure(b, 1);
        let split = self.halves(vertices);
        let [low, high] = [true, false].map(|side| self.rim(vertices, split, side));
        // Of equal rims that of the larger side: the other may be all of its own.
        let is_low = |&&vertex: &&u32| self.is_low(vertex, split);
        let larger_is_low = 2 * vertices.iter().filter(is_low).count() > vertices.len();
        let takes_low = low.len() < high.len() || (low.len() == high.len() && larger_is_low);
        let separator = if takes_low { low } else { high };
        self.sets += 1;
        for &vertex in &separator {
            self.set[vertex as usize] = self.sets;
        }
        let rest = |side| {
            let belongs = |&&vertex: &&u32| {
                self.set[vertex as usize] != self.sets && self.is_low(vertex, split) == side
            };
            vertices.iter().filter(belongs).copied().collect()
        };
        (separator, vec![rest(false), rest(true)])
    }

    /// The connected components of the present set.
    fn components(&mut self, vertices: &[u32]) -> Vec<Vec<u32>> {
        let set = self.sets;
        let mut components = Vec::new();
        for &vertex in vertices {
            if self.set[vertex as usize] == set {
                self.measure(vertex, 0);
                let component = std::mem::take(&mut self.queue);
                self.sets += 1;
                for &vertex in &component {
                    self.set[vertex as usize] = self.sets;
                }
                components.push(component);
            }
        }
        components
    }

    /// Distances from `start` within its set; the queue then holds all that was reached, the farthest last.
    fn measure(&mut self, start: u32, end: usize) {
        let set = self.set[start as usize];
        // Vertices that are reached form a set of their own for the time being.
        let reached = set | 1 << 31;
        self.queue.clear();
        self.queue.push(start);
        self.set[start as usize] = reached;
        self.distance[start as usize][end] = 0;
        let mut next = 0;
        while next < self.queue.len() {
            let vertex = self.queue[next] as usize;
            next += 1;
            for &neighbor in &self.pattern.columns()[self.pattern.row(vertex)] {
                if self.set[neighbor as usize] == set {
                    self.set[neighbor as usize] = reached;
                    self.distance[neighbor as usize][end] = self.distance[vertex][end] + 1;
                    self.queue.push(neighbor);
                }
            }
        }
        for &vertex in &self.queue {
            self.set[vertex as usize] = set;
        }
    }

    fn last(&self) -> u32 {
        *self.queue.last().expect("the start at least")
    }

    /// How much nearer a vertex lies to a than to b, negated.
    fn side(&self, vertex: u32) -> i64 {
        let [a, b] = self.distance[vertex as usize];
        i64::from(a) - i64::from(b)
    }

    fn is_low(&self, vertex: u32, split: i64) -> bool {
        self.side(vertex) < split
    }

    /// The split into sides as equal as can be, neither of them empty.
    fn halves(&mut self, vertices: &[u32]) -> i64 {
        let mut sides: Vec<i64> = vertices.iter().map(|&vertex| self.side(vertex)).collect();
        sides.sort_unstable();
        let middle = sides[sides.len() / 2];
        let below = sides.partition_point(|&side| side < middle);
        let up_to = sides.partition_point(|&side| side <= middle);
        let is_better = sides.len() - up_to > below;
        if below == 0 || is_better {
            middle + 1
        } else {
            middle
        }
    }

    /// The vertices of one side that have a neighbour on the other.
    fn rim(&self, vertices: &[u32], split: i64, low: bool) -> Vec<u32> {
        let set = self.sets;
        let touches = |&&vertex: &&u32| {
            let neighbors = &self.pattern.columns()[self.pattern.row(vertex as usize)];
            self.is_low(vertex, split) == low
                && neighbors.iter().any(|&neighbor| {
                    self.set[neighbor as usize] == set && self.is_low(neighbor, split) != low
                })
        };
        vertices.iter().filter(touches).copied().collect()
    }
}
