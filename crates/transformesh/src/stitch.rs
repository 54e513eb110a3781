//! The kept pieces made a manifold: each is glued along its edges to the next one that bounds the same inside.
//!
//! ```text
//!      outside                 Four kept facets at an edge (the page cuts it). Those that bound one wedge of the inside
//!   ╲    ↑    ╱                are glued, so that solids that touch along an edge come apart:
//!    ╲   │   ╱
//!  in ╲──×──╱ in               in ╲ × × ╱ in
//!     ╱     ╲                     ╱     ╲
//! ```
//!
//! Corners that are glued become one vertex; a point with several umbrellas becomes several vertices (the singular vertex
//! of Zaharescu et al. 2007). Where two pairs of facets at one edge share both of its vertices all the same, the edge is
//! halved in each (the singular edge), since a mesh has one edge between two vertices.

use crate::arrangement::Arrangement;
use crate::fan::{Leaf, fan};
use crate::hash::FastMap;
use crate::points::Points;
use crate::weld::Weld;
use pellicle_geometry::{DVec3, UnionFind, VertexId};
use pellicle_mesh::{EdgeTable, HalfEdgeId, TriangleId, TriangleSoup};

/// What becomes of a facet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Fate {
    Dropped,
    Kept,
    /// Kept, seen from its back.
    Reversed,
}

/// The surface that is left.
pub(crate) struct Stitched {
    pub soup: TriangleSoup,
    /// For each triangle the one, of those over places, that it is a piece of.
    pub sources: Vec<u32>,
    /// For each vertex its point.
    pub points: Vec<VertexId>,
    /// Points of which there are several vertices.
    pub singular_vertices: usize,
    /// Edges that were halved.
    pub singular_edges: usize,
}

/// Glues the kept pieces.
pub(crate) fn stitch(
    arrangement: &Arrangement,
    fates: &[Fate],
    table: &EdgeTable,
    weld: &Weld,
    points: &mut Points,
) -> Stitched {
    let fate = |leaf: &Leaf| fates[leaf.facet as usize];
    let mut gluing = Gluing {
        arrangement,
        corners: UnionFind::new(3 * arrangement.pieces.len()),
        crowded: Vec::new(),
    };
    // 1. Along each edge.
    for (edge, entries) in table.edges() {
        let is_kept = |h: HalfEdgeId| {
            let facet = arrangement.facet_of[h.triangle().index()];
            fates[facet as usize] != Fate::Dropped
        };
        let kept = entries.iter().filter(|e| is_kept(e.half_edge)).count();
        match kept {
            // None, or a border.
            0 | 1 => {}
            2 => {
                let mut both = entries.iter().map(|e| e.half_edge).filter(|&h| is_kept(h));
                if let (Some(a), Some(b)) = (both.next(), both.next()) {
                    gluing.glue(edge, a, b);
                }
            }
            _ => {
                let mut leaves = fan(arrangement, weld, points, edge, entries);
                leaves.retain(|leaf| fate(leaf) != Fate::Dropped);
                // Whether the inside is on the later side: it is behind a facet that is kept as it is.
                let inside_later = |leaf: &Leaf| leaf.forward == (fate(leaf) == Fate::Reversed);
                let mut pairs = Vec::with_capacity(leaves.len() / 2);
                for (i, leaf) in leaves.iter().enumerate() {
                    let next = &leaves[if i + 1 == leaves.len() { 0 } else { i + 1 }];
                    // At a border of an open mesh nothing may bound the other end of the wedge.
                    if inside_later(leaf) && !inside_later(next) {
                        gluing.glue(edge, leaf.half_edge, next.half_edge);
                        pairs.push([leaf.half_edge, next.half_edge]);
                    }
                }
                gluing.crowded.push((edge, pairs));
            }
        }
    }
    // 2. Umbrellas become vertices.
    gluing.finish(fates, points)
}

struct Gluing<'a> {
    arrangement: &'a Arrangement,
    corners: UnionFind,
    /// Edges with more than one pair of facets.
    crowded: Vec<([VertexId; 2], Vec<[HalfEdgeId; 2]>)>,
}

impl Gluing<'_> {
    /// The corner of a half-edge's piece at one end of its edge.
    fn corner_at(&self, h: HalfEdgeId, end: VertexId) -> u32 {
        let piece = self.arrangement.pieces[h.triangle().index()];
        match piece[h.corner()] == end {
            true => h.0,
            false => h.next().0,
        }
    }

    fn glue(&mut self, edge: [VertexId; 2], a: HalfEdgeId, b: HalfEdgeId) {
        for end in edge {
            let (a, b) = (self.corner_at(a, end), self.corner_at(b, end));
            self.corners.union(a, b);
        }
    }

    fn finish(mut self, fates: &[Fate], points: &Points) -> Stitched {
        let arrangement = self.arrangement;
        let triangle_of =
            |piece: u32| arrangement.facets[arrangement.facet_of[piece as usize] as usize].triangle;
        let fate_of = |piece: u32| fates[arrangement.facet_of[piece as usize] as usize];
        let mut kept: Vec<u32> = (0..arrangement.pieces.len() as u32)
            .filter(|&piece| fate_of(piece) != Fate::Dropped)
            .collect();
        kept.sort_by_key(|&piece| triangle_of(piece));

        // Vertices in the order of their points, the copies of one point in the order of their first corners.
        let mut umbrellas: Vec<(VertexId, u32)> = Vec::with_capacity(kept.len() / 2 + 2);
        let mut vertex_of = vec![VertexId::NONE; 3 * arrangement.pieces.len()];
        for &piece in &kept {
            for (i, &point) in arrangement.pieces[piece as usize].iter().enumerate() {
                let root = self.corners.find(3 * piece + i as u32);
                if vertex_of[root as usize] == VertexId::NONE {
                    vertex_of[root as usize] = VertexId(0);
                    umbrellas.push((point, root));
                }
            }
        }
        umbrellas.sort_by_key(|&(point, _)| point);
        for (v, &(_, root)) in umbrellas.iter().enumerate() {
            vertex_of[root as usize] = VertexId::new(v);
        }
        let singular_vertices = umbrellas
            .chunk_by(|a, b| a.0 == b.0)
            .filter(|copies| copies.len() > 1)
            .count();
        let mut stitched = Stitched {
            soup: TriangleSoup {
                positions: umbrellas.iter().map(|&(p, _)| points.rounded(p)).collect(),
                triangles: Vec::with_capacity(kept.len()),
            },
            sources: kept.iter().map(|&piece| triangle_of(piece)).collect(),
            points: umbrellas.iter().map(|&(point, _)| point).collect(),
            singular_vertices,
            singular_edges: 0,
        };
        let mut place_of: FastMap<u32, u32> = FastMap::default();
        for (place, &piece) in kept.iter().enumerate() {
            let mut corners = [0, 1, 2].map(|i| {
                let root = self.corners.find(3 * piece + i);
                vertex_of[root as usize]
            });
            if fate_of(piece) == Fate::Reversed {
                corners.swap(1, 2);
            }
            stitched.soup.triangles.push(corners);
            if !self.crowded.is_empty() {
                place_of.insert(piece, place as u32);
            }
        }
        // 3. Edges between the same two vertices.
        for (edge, pairs) in std::mem::take(&mut self.crowded) {
            let ends: Vec<[VertexId; 2]> = pairs
                .iter()
                .map(|pair| {
                    edge.map(|end| {
                        let corner = self.corner_at(pair[0], end);
                        vertex_of[self.corners.find(corner) as usize]
                    })
                })
                .collect();
            let shared = (0..ends.len()).any(|i| ends[..i].contains(&ends[i]));
            if shared {
                let middle = middle(points, edge);
                stitched.singular_edges += 1;
                for (pair, &ends) in pairs.iter().zip(&ends) {
                    let pieces = pair.map(|h| place_of[&h.triangle().0] as usize);
                    stitched.halve(pieces, ends, middle);
                }
            }
        }
        stitched
    }
}

fn middle(points: &Points, edge: [VertexId; 2]) -> DVec3 {
    let [a, b] = edge.map(|v| points.rounded(v));
    0.5 * a + 0.5 * b
}

impl Stitched {
    /// Halves the edge that two triangles share; both ends are named by each of them.
    fn halve(&mut self, triangles: [usize; 2], ends: [VertexId; 2], middle: DVec3) {
        let vertex = VertexId::new(self.soup.positions.len());
        self.soup.positions.push(middle);
        self.points.push(VertexId::NONE);
        for t in triangles {
            // A triangle may have been halved before, at another edge: then the part that holds this one.
            let holds = |corners: &[VertexId; 3]| ends.iter().all(|end| corners.contains(end));
            let source = self.sources[t];
            let at = match holds(&self.soup.triangles[t]) {
                true => Some(t),
                false => (self.soup.triangles.iter().zip(&self.sources))
                    .rposition(|(corners, &of)| of == source && holds(corners)),
            };
            let Some(t) = at else { continue };
            let corners = self.soup.triangles[t];
            let first = corners.map(|v| if v == ends[0] { vertex } else { v });
            let second = corners.map(|v| if v == ends[1] { vertex } else { v });
            self.soup.triangles[t] = first;
            self.soup.triangles.push(second);
            self.sources.push(source);
        }
    }

    /// The triangle that each triangle of the input that it is a piece of, by the ids of the input.
    pub(crate) fn sources_in(&self, weld: &Weld) -> Vec<TriangleId> {
        let sources = self.sources.iter();
        sources.map(|&t| weld.sources[t as usize]).collect()
    }
}
