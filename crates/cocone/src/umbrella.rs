//! Umbrellas: whether the triangles at a vertex form a disk around it.

use crate::canonical::Canonical;
use pellicle_delaunay::FacetId;
use pellicle_geometry::VertexId;

/// By vertex, the edges opposite it in the triangles it has: the vertex's link.
pub(crate) struct Links {
    /// By vertex, where its edges start in `edges`; one more at the end.
    starts: Vec<u32>,
    edges: Vec<[VertexId; 2]>,
}

impl Links {
    pub(crate) fn of(canonical: &Canonical, facets: &[FacetId]) -> Self {
        let mut starts = vec![0_u32; canonical.vertex_count() + 1];
        for &facet in facets {
            for vertex in canonical.facet(facet) {
                starts[vertex.index() + 1] += 1;
            }
        }
        for vertex in 0..canonical.vertex_count() {
            starts[vertex + 1] += starts[vertex];
        }
        let mut next = starts.clone();
        let mut edges = vec![[VertexId::NONE; 2]; 3 * facets.len()];
        for &facet in facets {
            let [a, b, c] = canonical.facet(facet);
            for (vertex, edge) in [(a, [b, c]), (b, [c, a]), (c, [a, b])] {
                let place = &mut next[vertex.index()];
                edges[*place as usize] = edge;
                *place += 1;
            }
        }
        Self { starts, edges }
    }

    /// How many triangles the vertex has.
    pub(crate) fn degree(&self, vertex: VertexId) -> usize {
        (self.starts[vertex.index() + 1] - self.starts[vertex.index()]) as usize
    }

    /// Whether the vertex's triangles form one closed fan: its link is a single simple cycle.
    pub(crate) fn is_umbrella(&self, vertex: VertexId) -> bool {
        let range = self.starts[vertex.index()] as usize..self.starts[vertex.index() + 1] as usize;
        is_simple_cycle(&self.edges[range])
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
