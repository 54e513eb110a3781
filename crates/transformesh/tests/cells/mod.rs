//! Unions of boxes with integer corners, by unit cells: the oracle for volume and topology.

use crate::common::{cuboid, inverted, joined};
use pellicle_geometry::UnionFind;
use pellicle_mesh::TriangleSoup;
use proptest::prelude::*;
use std::collections::HashMap;

/// Corners are 0 to SIDE; the cells around them are outside.
const SIDE: i32 = 5;

type Cell = [i32; 3];

/// Two opposite corners, and whether the box is outward.
#[derive(Clone, Debug)]
pub struct Block {
    min: Cell,
    max: Cell,
    outward: bool,
}

pub fn any_box() -> impl Strategy<Value = Block> {
    let range = || (0..SIDE, 0..SIDE).prop_map(|(a, b)| (a.min(b), a.max(b) + 1));
    let outward = prop::bool::weighted(0.75);
    (range(), range(), range(), outward).prop_map(|(x, y, z, outward)| Block {
        min: [x.0, y.0, z.0],
        max: [x.1, y.1, z.1],
        outward,
    })
}

pub fn soup(boxes: &[Block]) -> TriangleSoup {
    joined(boxes.iter().map(|block| {
        let corner = |c: Cell| glam::IVec3::from(c).as_dvec3();
        let cuboid = cuboid(corner(block.min), corner(block.max));
        match block.outward {
            true => cuboid,
            false => inverted(cuboid),
        }
    }))
}

/// Which unit cells are inside.
#[derive(Clone, PartialEq)]
pub struct Cells(Vec<bool>);

/// One more cell on each side.
const ROW: i32 = SIDE + 2;

fn place([x, y, z]: Cell) -> usize {
    (((x + 1) * ROW + y + 1) * ROW + z + 1) as usize
}

fn all() -> impl Iterator<Item = Cell> {
    (-1..=SIDE).flat_map(|x| (-1..=SIDE).flat_map(move |y| (-1..=SIDE).map(move |z| [x, y, z])))
}

fn plus(a: Cell, b: Cell) -> Cell {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

fn minus(a: Cell) -> Cell {
    a.map(|c| -c)
}

const DIRECTIONS: [Cell; 6] = [
    [1, 0, 0],
    [-1, 0, 0],
    [0, 1, 0],
    [0, -1, 0],
    [0, 0, 1],
    [0, 0, -1],
];

impl Cells {
    pub fn of(boxes: &[Block], is_inside: impl Fn(i32) -> bool) -> Self {
        let winding = |cell: Cell| -> i32 {
            let around = boxes
                .iter()
                .filter(|block| (0..3).all(|i| (block.min[i]..block.max[i]).contains(&cell[i])));
            around.map(|block| if block.outward { 1 } else { -1 }).sum()
        };
        Self(all().map(|cell| is_inside(winding(cell))).collect())
    }

    fn holds(&self, cell: Cell) -> bool {
        cell.iter().all(|c| (-1..=SIDE).contains(c)) && self.0[place(cell)]
    }

    pub fn volume(&self) -> f64 {
        self.0.iter().filter(|&&inside| inside).count() as f64
    }

    /// With every void filled that outside does not reach; none if it reaches one only across an edge or a corner.
    pub fn filled(&self) -> Option<Self> {
        let by_faces = self.reached(1);
        let by_corners = self.reached(3);
        (by_faces == by_corners).then(|| Self(by_faces.iter().map(|reached| !reached).collect()))
    }

    /// The cells that outside reaches by steps along at most so many axes at once.
    fn reached(&self, axes: i32) -> Vec<bool> {
        let mut reached = vec![false; self.0.len()];
        let mut open = vec![[-1, -1, -1]];
        reached[place([-1, -1, -1])] = true;
        while let Some(cell) = open.pop() {
            for step in (0..27).map(|i| [i / 9 - 1, i / 3 % 3 - 1, i % 3 - 1]) {
                let next = plus(cell, step);
                let along: i32 = step.iter().map(|s| s.abs()).sum();
                let there = next.iter().all(|c| (-1..=SIDE).contains(c));
                if along <= axes && there && !self.holds(next) && !reached[place(next)] {
                    reached[place(next)] = true;
                    open.push(next);
                }
            }
        }
        reached
    }

    /// Components of the surface, and their genera summed. Two faces are neighbours across an edge if the inside
    /// between them is one; a corner is one vertex for each fan of faces.
    ///
    /// ```text
    ///           |  n + d             Across the edge from the face of c towards d:
    ///     d ↑   |                    a. n = c + t is outside: the face of c towards t;
    ///   --------+--------            b. n is inside, n + d outside: the face of n towards d;
    ///      c    |    n    → t        c. both are inside: the face of n + d towards −t.
    /// ```
    pub fn topology(&self) -> (usize, usize) {
        let mut faces: Vec<(Cell, Cell)> = Vec::new();
        for cell in all().filter(|&cell| self.holds(cell)) {
            let outward = DIRECTIONS.iter().filter(|&&d| !self.holds(plus(cell, d)));
            faces.extend(outward.map(|&d| (cell, d)));
        }
        let of_face: HashMap<(Cell, Cell), usize> = faces
            .iter()
            .enumerate()
            .map(|(i, &face)| (face, i))
            .collect();
        let across = |(c, d): (Cell, Cell), t: Cell| {
            let n = plus(c, t);
            match (self.holds(n), self.holds(plus(n, d))) {
                (false, _) => (c, t),
                (true, false) => (n, d),
                (true, true) => (plus(n, d), minus(t)),
            }
        };
        // Corners of faces, eight to a face at most: by the corner's place in the lattice.
        let mut corner_of: HashMap<(usize, Cell), usize> = HashMap::new();
        for (f, &(c, d)) in faces.iter().enumerate() {
            for corner in corners(c, d) {
                let next = corner_of.len();
                corner_of.insert((f, corner), next);
            }
        }
        let mut bodies = UnionFind::new(faces.len());
        let mut fans = UnionFind::new(corner_of.len());
        for (f, &(c, d)) in faces.iter().enumerate() {
            for t in DIRECTIONS.into_iter().filter(|&t| t != d && t != minus(d)) {
                let other = of_face[&across((c, d), t)];
                bodies.union(f as u32, other as u32);
                // Both ends of the edge.
                for corner in corners(c, d).into_iter().filter(|&p| on_edge(c, t, p)) {
                    let (a, b) = (corner_of[&(f, corner)], corner_of[&(other, corner)]);
                    fans.union(a as u32, b as u32);
                }
            }
        }
        let components = roots(&mut bodies, faces.len());
        let vertices = roots(&mut fans, corner_of.len());
        // Every face has four edges, every edge two faces.
        let euler = vertices as i64 - 2 * faces.len() as i64 + faces.len() as i64;
        let genus = (2 * components as i64 - euler) / 2;
        (
            components,
            usize::try_from(genus).expect("at most 2 a component"),
        )
    }
}

/// How many sets there are.
fn roots(sets: &mut UnionFind, count: usize) -> usize {
    (0..count)
        .filter(|&i| sets.find(i as u32) == i as u32)
        .count()
}

/// The corners of the face of a cell in a direction.
fn corners(cell: Cell, d: Cell) -> Vec<Cell> {
    let all = (0..8).map(|i| [i & 1, i >> 1 & 1, i >> 2]);
    let on_face = all.filter(|at| (0..3).all(|i| d[i] == 0 || at[i] == (d[i] + 1) / 2));
    on_face.map(|at| plus(cell, at)).collect()
}

/// Whether a corner of a cell's face lies towards t.
fn on_edge(cell: Cell, t: Cell, corner: Cell) -> bool {
    (0..3).all(|i| t[i] == 0 || corner[i] == cell[i] + (t[i] + 1) / 2)
}

/// The oracle itself, where the answer is plain.
#[test]
fn cells_know_their_topology() {
    let block = |min: Cell, max: Cell, outward| Block { min, max, outward };
    let one = block([0, 0, 0], [1, 1, 1], true);
    let check = |boxes: &[Block], volume: f64, topology: (usize, usize)| {
        let cells = Cells::of(boxes, |winding| winding >= 1);
        assert_eq!(
            (cells.volume(), cells.topology()),
            (volume, topology),
            "{boxes:?}"
        );
    };
    check(&[], 0.0, (0, 0));
    check(std::slice::from_ref(&one), 1.0, (1, 0));
    check(
        &[one.clone(), block([1, 0, 0], [2, 1, 1], true)],
        2.0,
        (1, 0),
    );
    check(
        &[one.clone(), block([1, 1, 0], [2, 2, 1], true)],
        2.0,
        (2, 0),
    );
    check(
        &[one.clone(), block([1, 1, 1], [2, 2, 2], true)],
        2.0,
        (2, 0),
    );
    // A tunnel, a void, and nothing at all.
    let plate = block([0, 0, 0], [3, 3, 1], true);
    check(&[plate, block([1, 1, 0], [2, 2, 1], false)], 8.0, (1, 1));
    let large = block([0, 0, 0], [3, 3, 3], true);
    check(&[large, block([1, 1, 1], [2, 2, 2], false)], 26.0, (2, 0));
    check(
        &[one.clone(), block([0, 0, 0], [1, 1, 1], false)],
        0.0,
        (0, 0),
    );
}
