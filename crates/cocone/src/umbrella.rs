//! Umbrellas: whether the triangles at a vertex form a disk around it.

use pellicle_geometry::VertexId;

/// By vertex, the edges opposite it in the triangles it has: the vertex's link.
pub(crate) struct Links {
    /// By vertex, where its edges start in `edges`; one more at the end.
    starts: Vec<u32>,
    edges: Vec<[VertexId; 2]>,
    /// By edge, the place of its triangle in the list of triangles.
    triangles: Vec<u32>,
}

impl Links {
    pub(crate) fn of(vertex_count: usize, triangles: &[[VertexId; 3]]) -> Self {
        let mut starts = vec![0_u32; vertex_count + 1];
        for vertex in triangles.iter().flatten() {
            starts[vertex.index() + 1] += 1;
        }
        for vertex in 0..vertex_count {
            starts[vertex + 1] += starts[vertex];
        }
        let mut next = starts.clone();
        let mut edges = vec![[VertexId::NONE; 2]; 3 * triangles.len()];
        let mut places = vec![0; 3 * triangles.len()];
        for (k, &[a, b, c]) in triangles.iter().enumerate() {
            for (vertex, edge) in [(a, [b, c]), (b, [c, a]), (c, [a, b])] {
                let place = &mut next[vertex.index()];
                edges[*place as usize] = edge;
                places[*place as usize] = k as u32;
                *place += 1;
            }
        }
        Self {
            starts,
            edges,
            triangles: places,
        }
    }

    /// How many triangles the vertex has.
    pub(crate) fn degree(&self, vertex: VertexId) -> usize {
        (self.starts[vertex.index() + 1] - self.starts[vertex.index()]) as usize
    }

    /// Whether the vertex's triangles form one closed fan: its link is a single simple cycle.
    pub(crate) fn is_umbrella(&self, vertex: VertexId) -> bool {
        is_simple_cycle(&self.edges[self.range(vertex)])
    }

    /// The triangles of the vertex, as places in the list of triangles, that form an umbrella once dead ends
    /// of its link are cut back, again and again; none where they do not.
    pub(crate) fn umbrella_without_dead_ends(
        &self,
        vertex: VertexId,
    ) -> impl Iterator<Item = u32> + '_ {
        let range = self.range(vertex);
        let triangles = &self.triangles[range.clone()];
        let edges = &self.edges[range];
        let mut left = without_dead_ends(edges);
        let cycle: Vec<_> = left.iter().map(|&k| edges[k]).collect();
        if !is_simple_cycle(&cycle) {
            left.clear();
        }
        left.into_iter().map(|k| triangles[k])
    }

    fn range(&self, vertex: VertexId) -> std::ops::Range<usize> {
        self.starts[vertex.index()] as usize..self.starts[vertex.index() + 1] as usize
    }
}

/// Whether edges form one cycle that visits no vertex twice. O(n log n).
fn is_simple_cycle(edges: &[[VertexId; 2]]) -> bool {
    if edges.len() < 3 {
        return false;
    }
    // Each vertex with the edges at it, sorted by vertex: exactly two each.
    let mut ends: Vec<(VertexId, u32)> = (0..edges.len() as u32)
        .flat_map(|k| edges[k as usize].map(|vertex| (vertex, k)))
        .collect();
    ends.sort_unstable();
    let two_each = ends.chunk_by(|a, b| a.0 == b.0).all(|at| at.len() == 2);
    if !two_each {
        return false;
    }
    let other_edge = |vertex: VertexId, edge: u32| {
        let place = ends.partition_point(|end| end.0 < vertex);
        match ends[place].1 == edge {
            true => ends[place + 1].1,
            false => ends[place].1,
        }
    };
    let start = edges[0][0];
    let (mut edge, mut vertex, mut length) = (0, edges[0][1], 1);
    while vertex != start {
        edge = other_edge(vertex, edge);
        let [a, b] = edges[edge as usize];
        vertex = if a == vertex { b } else { a };
        length += 1;
    }
    length == edges.len()
}

/// The edges that are left when those with an end that no other edge has are removed, again and again.
fn without_dead_ends(edges: &[[VertexId; 2]]) -> Vec<usize> {
    let mut left: Vec<usize> = (0..edges.len()).collect();
    loop {
        let mut ends: Vec<VertexId> = left.iter().flat_map(|&k| edges[k]).collect();
        ends.sort_unstable();
        let has_others = |end: VertexId| {
            let place = ends.partition_point(|&other| other < end);
            ends.get(place + 1) == Some(&end)
        };
        let before = left.len();
        left.retain(|&k| edges[k].into_iter().all(has_others));
        if left.len() == before {
            return left;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cycle(edges: &[[u32; 2]]) -> bool {
        let edges: Vec<_> = edges.iter().map(|edge| edge.map(VertexId)).collect();
        is_simple_cycle(&edges)
    }

    #[test]
    fn only_a_single_simple_cycle_is_an_umbrella() {
        assert!(cycle(&[[0, 1], [1, 2], [2, 0]]));
        assert!(cycle(&[[5, 9], [3, 9], [3, 7], [7, 5]]));
        assert!(!cycle(&[]));
        assert!(!cycle(&[[0, 1], [1, 2]]), "open");
        assert!(!cycle(&[[0, 1], [1, 0]]), "two sides of one triangle");
        let two = [[0, 1], [1, 2], [2, 0], [3, 4], [4, 5], [5, 3]];
        assert!(!cycle(&two), "two cycles");
        let eight = [[0, 1], [1, 2], [2, 0], [0, 4], [4, 5], [5, 0]];
        assert!(!cycle(&eight), "a vertex visited twice");
        assert!(!cycle(&[[0, 1], [1, 2], [2, 0], [2, 3]]), "a tail");
    }
}
