//! From a function of space to a closed mesh.
//!
//! Each cube of a grid is cut into six tetrahedra around the diagonal from its corner 0 to its corner 7; the six share
//! their faces with those of the neighbouring cubes. In each tetrahedron one or two triangles part the corners inside
//! from the corners outside. Their vertices lie on its edges, so that no triangle leaves its tetrahedron: the mesh is
//! closed and cannot meet itself.

use crate::field::Field;
use pellicle::geometry::VertexId;
use pellicle::mesh::{TriMesh, TriangleSoup};
use pellicle::prelude::DVec3;
use std::collections::HashMap;

/// The corners of a cube's tetrahedra: bits are steps along x, y and z. Each is positive: det[b − a, c − a, d − a] > 0.
const TETRAHEDRA: [[usize; 4]; 6] = [
    [0, 1, 3, 7],
    [0, 3, 2, 7],
    [0, 2, 6, 7],
    [0, 6, 4, 7],
    [0, 4, 5, 7],
    [0, 5, 1, 7],
];

/// Even permutations that bring corner i to the front.
const FIRST: [[usize; 4]; 4] = [[0, 1, 2, 3], [1, 0, 3, 2], [2, 0, 1, 3], [3, 0, 2, 1]];

/// Even permutations that bring two corners to the front.
const PAIRS: [[usize; 4]; 6] = [
    [0, 1, 2, 3],
    [0, 2, 3, 1],
    [0, 3, 1, 2],
    [1, 2, 0, 3],
    [1, 3, 2, 0],
    [2, 3, 0, 1],
];

/// How many steps a root may take; it is found to the last bits in about six.
const ROOT_STEPS: usize = 80;

/// The surface of a solid, with `cells` cubes along the longest side of its box. Memory is eight bytes a cube, time
/// one evaluation a cube and about six a vertex.
pub(crate) fn polygonize(field: &dyn Field, cells: usize) -> TriMesh {
    let grid = Grid::new(field, cells);
    let mut surface = Surface {
        field,
        grid: &grid,
        vertices: HashMap::new(),
        soup: TriangleSoup {
            positions: Vec::new(),
            triangles: Vec::new(),
        },
    };
    let [nx, ny, nz] = grid.nodes;
    for z in 0..nz - 1 {
        for y in 0..ny - 1 {
            for x in 0..nx - 1 {
                surface.cube(grid.index([x, y, z]));
            }
        }
    }
    TriMesh::try_from(surface.soup).expect("neighbouring tetrahedra share their faces")
}

/// The values of a field at the nodes of a grid.
struct Grid {
    origin: DVec3,
    spacing: f64,
    nodes: [usize; 3],
    values: Vec<f64>,
}

impl Grid {
    fn new(field: &dyn Field, cells: usize) -> Self {
        let bounds = field.bounds();
        let spacing = bounds.extent().max_element() / cells as f64;
        let nodes = bounds
            .extent()
            .to_array()
            .map(|side| (side / spacing).ceil() as usize + 3);
        // Off the middle by an odd share of a cell: planes of symmetry go through no node.
        let middle = DVec3::from(nodes.map(|n| (n - 1) as f64 / 2.0));
        let shift = DVec3::new(0.137, 0.211, 0.173);
        let mut grid = Self {
            origin: bounds.center() - spacing * (middle + shift),
            spacing,
            nodes,
            values: Vec::new(),
        };
        let count = nodes.iter().product();
        grid.values = (0..count).map(|i| field.at(grid.position(i)).0).collect();
        grid
    }

    fn index(&self, [x, y, z]: [usize; 3]) -> usize {
        (z * self.nodes[1] + y) * self.nodes[0] + x
    }

    /// The node that lies `corner` away from `node`, each bit a step.
    fn step(&self, node: usize, corner: usize) -> usize {
        node + self.index([corner & 1, corner >> 1 & 1, corner >> 2])
    }

    fn position(&self, node: usize) -> DVec3 {
        let [nx, ny, _] = self.nodes;
        let at = [node % nx, node / nx % ny, node / nx / ny];
        self.origin + self.spacing * DVec3::from(at.map(|i| i as f64))
    }
}

struct Surface<'a> {
    field: &'a dyn Field,
    grid: &'a Grid,
    /// By the lower and the upper node of the edge on which a vertex lies.
    vertices: HashMap<[usize; 2], VertexId>,
    soup: TriangleSoup,
}

impl Surface<'_> {
    fn cube(&mut self, node: usize) {
        let nodes: [usize; 8] = std::array::from_fn(|corner| self.grid.step(node, corner));
        let inside = nodes.map(|node| self.grid.values[node] < 0.0);
        if inside == [inside[0]; 8] {
            return;
        }
        for tetrahedron in TETRAHEDRA {
            self.tetrahedron(
                tetrahedron.map(|corner| nodes[corner]),
                tetrahedron.map(|corner| inside[corner]),
            );
        }
    }

    /// With a the only corner inside, the triangle over the edges to b, c, d is seen from outside; with a and b
    /// inside, the quadrilateral
    ///
    /// ```text
    ///   ac ── ad
    ///   │      │     seen from c and d
    ///   bc ── bd
    /// ```
    fn tetrahedron(&mut self, nodes: [usize; 4], inside: [bool; 4]) {
        let count = inside.iter().filter(|&&inside| inside).count();
        match count {
            1 | 3 => {
                let lone = count == 1;
                let first = inside.iter().position(|&i| i == lone).unwrap_or_default();
                let [a, b, c, d] = FIRST[first].map(|i| nodes[i]);
                let [b, c, d] = [b, c, d].map(|other| self.vertex(a, other));
                self.soup
                    .triangles
                    .push(if lone { [b, c, d] } else { [b, d, c] });
            }
            2 => {
                for pair in PAIRS
                    .iter()
                    .filter(|pair| inside[pair[0]] && inside[pair[1]])
                {
                    let [a, b, c, d] = pair.map(|i| nodes[i]);
                    let [ac, ad, bd, bc] =
                        [[a, c], [a, d], [b, d], [b, c]].map(|[i, o]| self.vertex(i, o));
                    self.soup.triangles.extend([[ac, ad, bd], [ac, bd, bc]]);
                }
            }
            _ => {}
        }
    }

    fn vertex(&mut self, one: usize, other: usize) -> VertexId {
        let key = [one.min(other), one.max(other)];
        if let Some(&vertex) = self.vertices.get(&key) {
            return vertex;
        }
        let vertex = VertexId::new(self.soup.positions.len());
        let [low, high] = key.map(|node| self.grid.position(node));
        let root = root(self.field, low, high, self.grid.values[key[0]]);
        self.soup.positions.push(root);
        self.vertices.insert(key, vertex);
        vertex
    }
}

/// Where the field vanishes between two points at which it has different signs: Newton's steps along the line, and
/// halves where they leave the bracket.
fn root(field: &dyn Field, low: DVec3, high: DVec3, value_at_low: f64) -> DVec3 {
    let along = high - low;
    let (mut from, mut to) = (0.0_f64, 1.0_f64);
    let mut t = 0.5;
    for _ in 0..ROOT_STEPS {
        let (value, gradient) = field.at(low + t * along);
        if (value < 0.0) == (value_at_low < 0.0) {
            from = t;
        } else {
            to = t;
        }
        let newton = t - value / gradient.dot(along);
        let next = match newton > from && newton < to {
            true => newton,
            false => 0.5 * (from + to),
        };
        let step = (next - t).abs();
        t = next;
        if step < 1e-15 {
            break;
        }
    }
    low + t * along
}
