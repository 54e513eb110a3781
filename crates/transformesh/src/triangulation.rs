//! The constrained triangulation of a cut triangle, exact on implicit points.
//!
//! ```text
//!          c                    Triangles turn counter-clockwise seen from the front of the cut triangle. Edge i of a
//!         / \                   triangle runs from its corner i to corner i + 1; `neighbors[i]` lies across it, and
//!        / | \                  `constraints[i]` is the plane that cuts along it, if one does.
//!       /  x  \
//!      / ´   ` \                Points are inserted where they lie; segments by flipping what crosses them (Sloan 1993).
//!     a---------b               Where a segment crosses another one, a point is made: the planes of both and of the
//!                               triangle meet in it.
//! ```

use crate::hash::FastMap;
use crate::points::{PlaneId, Points};
use pellicle_geometry::VertexId;
use pellicle_predicates::Sign;
use std::cmp::Ordering;
use std::collections::VecDeque;

/// No triangle.
pub(crate) const NONE: u32 = u32::MAX;

/// How many planes a vertex remembers.
const KNOWN: usize = 4;

/// A corner or vertex by its index in [`Triangulation::vertices`].
type Local = u32;

pub(crate) struct Triangulation {
    /// The plane of the cut triangle.
    plane: PlaneId,
    /// Seen along this axis, the cut triangle turns as `turn`.
    axis: usize,
    turn: Sign,
    /// The points; the first three are the corners.
    pub vertices: Vec<VertexId>,
    local: FastMap<VertexId, Local>,
    /// For each vertex the planes of segments that are known to run through it, as many as fit: what need not be computed.
    on: Vec<[PlaneId; KNOWN]>,
    /// For each vertex a triangle at it.
    at: Vec<u32>,
    pub triangles: Vec<[Local; 3]>,
    pub neighbors: Vec<[u32; 3]>,
    pub constraints: Vec<[PlaneId; 3]>,
}

/// The line along which a segment is inserted: through its ends, in the triangle's plane and another one.
struct Line {
    from: Local,
    to: Local,
    plane: PlaneId,
}

/// The triangle behind a constraint that a segment has crossed.
struct Across {
    right: Local,
    left: Local,
    apex: Local,
}

/// Where a point lies.
enum Place {
    Inside(u32),
    OnEdge(u32, usize),
}

/// The corner after corner `i`.
#[inline]
pub(crate) fn next(i: usize) -> usize {
    if i == 2 { 0 } else { i + 1 }
}

/// The corner before corner `i`.
#[inline]
fn previous(i: usize) -> usize {
    if i == 0 { 2 } else { i - 1 }
}

impl Triangulation {
    /// The triangle itself; its corners are points of the input, and not on one line.
    pub(crate) fn new(corners: [VertexId; 3], plane: PlaneId, points: &Points) -> Self {
        let axis = points.plane(plane).main_axis();
        let local = corners.iter().zip(0..).map(|(&v, i)| (v, i)).collect();
        Self {
            plane,
            axis,
            turn: points.plane(plane).normal_sign(axis),
            vertices: corners.to_vec(),
            local,
            on: vec![[PlaneId::NONE; KNOWN]; 3],
            at: vec![0; 3],
            triangles: vec![[0, 1, 2]],
            neighbors: vec![[NONE; 3]],
            constraints: vec![[PlaneId::NONE; 3]],
        }
    }

    fn orient(&self, points: &Points, a: Local, b: Local, c: Local) -> Sign {
        let [a, b, c] = [a, b, c].map(|v| self.vertices[v as usize]);
        self.turn * points.orient(self.axis, a, b, c)
    }

    /// The side of a line that a vertex lies on.
    fn side(&self, points: &Points, line: &Line, vertex: Local) -> Sign {
        if vertex == line.from
            || vertex == line.to
            || self.on[vertex as usize].contains(&line.plane)
        {
            return Sign::Zero;
        }
        self.orient(points, line.from, line.to, vertex)
    }

    /// Remembers that a plane runs through a vertex.
    fn remember(&mut self, vertex: Local, plane: PlaneId) {
        let known = &mut self.on[vertex as usize];
        if !known.contains(&plane)
            && let Some(slot) = known.iter_mut().find(|slot| **slot == PlaneId::NONE)
        {
            *slot = plane;
        }
    }

    fn add_vertex(&mut self, point: VertexId) -> Local {
        let vertex = self.vertices.len() as Local;
        self.vertices.push(point);
        self.on.push([PlaneId::NONE; KNOWN]);
        self.at.push(NONE);
        self.local.insert(point, vertex);
        vertex
    }

    /// Inserts a point of the triangle.
    pub(crate) fn insert_point(&mut self, point: VertexId, points: &Points) -> Local {
        if let Some(&vertex) = self.local.get(&point) {
            return vertex;
        }
        let vertex = self.add_vertex(point);
        match self.locate(vertex, points) {
            Place::Inside(t) => self.split_triangle(t, vertex),
            Place::OnEdge(t, i) => self.split_edge(t, i, vertex),
        }
        vertex
    }

    /// Walks towards a point from the triangle made last.
    fn locate(&self, vertex: Local, points: &Points) -> Place {
        let mut t = self.triangles.len() as u32 - 1;
        // In a triangulation that is not Delaunay a walk may turn in circles.
        for step in 0..2 * self.triangles.len() + 8 {
            match self.place_in(t, vertex, step % 3, points) {
                Ok(place) => return place,
                Err(NONE) => break,
                Err(across) => t = across,
            }
        }
        for t in 0..self.triangles.len() as u32 {
            if let Ok(place) = self.place_in(t, vertex, 0, points) {
                return place;
            }
        }
        unreachable!("a point that is inserted lies in the triangle")
    }

    /// Where in a triangle a point lies, or the neighbour across an edge that it lies beyond.
    fn place_in(&self, t: u32, vertex: Local, from: usize, points: &Points) -> Result<Place, u32> {
        let corners = self.triangles[t as usize];
        let mut on = None;
        for i in [from, next(from), previous(from)] {
            match self.orient(points, corners[i], corners[next(i)], vertex) {
                Sign::Negative => return Err(self.neighbors[t as usize][i]),
                Sign::Zero => on = Some(i),
                Sign::Positive => {}
            }
        }
        Ok(match on {
            Some(i) => Place::OnEdge(t, i),
            None => Place::Inside(t),
        })
    }

    fn push(&mut self, corners: [Local; 3]) -> u32 {
        let t = self.triangles.len() as u32;
        self.triangles.push(corners);
        self.neighbors.push([NONE; 3]);
        self.constraints.push([PlaneId::NONE; 3]);
        t
    }

    /// Makes edge `i` of `t` and edge `j` of `u` one.
    fn join(&mut self, (t, i): (u32, usize), (u, j): (u32, usize)) {
        self.neighbors[t as usize][i] = u;
        self.neighbors[u as usize][j] = t;
    }

    /// Gives edge `i` of `t` what was across an edge of `old`, and its constraint.
    fn inherit(&mut self, (t, i): (u32, usize), old: u32, across: u32, constraint: PlaneId) {
        self.neighbors[t as usize][i] = across;
        self.constraints[t as usize][i] = constraint;
        if across != NONE && old != t {
            let slots = &mut self.neighbors[across as usize];
            let back = slots.iter().position(|&n| n == old);
            slots[back.expect("neighbours name each other")] = t;
        }
    }

    /// ```text
    ///        c
    ///       /|\          t becomes a b v; two more: b c v and c a v.
    ///      / v \
    ///     a-----b
    /// ```
    fn split_triangle(&mut self, t: u32, v: Local) {
        let [a, b, c] = self.triangles[t as usize];
        let [_, bc, ca] = self.neighbors[t as usize];
        let [_, on_bc, on_ca] = self.constraints[t as usize];
        self.triangles[t as usize] = [a, b, v];
        let second = self.push([b, c, v]);
        let third = self.push([c, a, v]);
        self.inherit((second, 0), t, bc, on_bc);
        self.inherit((third, 0), t, ca, on_ca);
        for i in [1, 2] {
            self.constraints[t as usize][i] = PlaneId::NONE;
        }
        self.join((t, 1), (second, 2));
        self.join((second, 1), (third, 2));
        self.join((third, 1), (t, 2));
        self.at[v as usize] = t;
        self.at[c as usize] = second;
        self.at[a as usize] = t;
        self.at[b as usize] = t;
    }

    /// ```text
    ///         c
    ///        /|\           t = a b c becomes a v c; a further one: v b c.
    ///       / | \
    ///      a--v--b         Across, u = b a d becomes b v d; a further one: v a d.
    ///       \ | /
    ///        \|/
    ///         d
    /// ```
    fn split_edge(&mut self, t: u32, i: usize, v: Local) {
        let u = self.neighbors[t as usize][i];
        let constraint = self.constraints[t as usize][i];
        let above = self.split_side(t, i, v, constraint);
        if u == NONE {
            return;
        }
        let j = self.edge_towards(u, t);
        let below = self.split_side(u, j, v, constraint);
        // a v of t lies along v a of `below`; v b of `above` along b v of u.
        self.join((t, 0), (below, 0));
        self.join((above, 0), (u, 0));
    }

    /// One side of [`Self::split_edge`]: t = (a, b, c) with a b at edge `i` becomes (a, v, c), and (v, b, c) is made.
    fn split_side(&mut self, t: u32, i: usize, v: Local, constraint: PlaneId) -> u32 {
        let at = t as usize;
        let [a, b, c] = [i, next(i), previous(i)].map(|k| self.triangles[at][k]);
        let [bc, ca] = [next(i), previous(i)].map(|k| self.neighbors[at][k]);
        let [on_bc, on_ca] = [next(i), previous(i)].map(|k| self.constraints[at][k]);
        self.triangles[at] = [a, v, c];
        self.neighbors[at] = [NONE, NONE, ca];
        self.constraints[at] = [constraint, PlaneId::NONE, on_ca];
        let other = self.push([v, b, c]);
        self.constraints[other as usize][0] = constraint;
        self.inherit((other, 1), t, bc, on_bc);
        self.join((t, 1), (other, 2));
        self.at[a as usize] = t;
        self.at[v as usize] = t;
        self.at[c as usize] = t;
        self.at[b as usize] = other;
        other
    }

    /// The edge of `t` across which `u` lies.
    fn edge_towards(&self, t: u32, u: u32) -> usize {
        let at = self.neighbors[t as usize].iter().position(|&n| n == u);
        at.expect("neighbours name each other")
    }

    /// Inserts a segment between two points of the triangle, cut along by a plane.
    pub(crate) fn insert_segment(
        &mut self,
        [from, to]: [VertexId; 2],
        plane: PlaneId,
        points: &mut Points,
    ) {
        let from = self.insert_point(from, points);
        let to = self.insert_point(to, points);
        self.remember(from, plane);
        self.remember(to, plane);
        let line = Line { from, to, plane };
        let (mut at, mut across) = (from, None);
        while at != to {
            (at, across) = self.advance(&line, at, across, points);
            self.remember(at, plane);
        }
    }

    /// Inserts the first part of what is left of a segment, up to the first vertex on it or the first constraint that it
    /// crosses. Returns the vertex there and, after a constraint, what lies across it.
    fn advance(
        &mut self,
        line: &Line,
        from: Local,
        across: Option<Across>,
        points: &mut Points,
    ) -> (Local, Option<Across>) {
        let first = match across {
            Some(across) => self.first_across(line, &across, points),
            None => self.first_crossed(line, from, points),
        };
        let (mut t, mut i) = match first {
            Crossed::Vertex(vertex) => {
                self.constrain(from, vertex, line.plane);
                return (vertex, None);
            }
            Crossed::Edge(t, i) => (t, i),
        };
        let mut crossed = VecDeque::new();
        let end = loop {
            let [right, left] = [i, next(i)].map(|k| self.triangles[t as usize][k]);
            let other = self.constraints[t as usize][i];
            if other != PlaneId::NONE {
                break self.cross(line, (t, i), other, points);
            }
            crossed.push_back((right, left));
            let u = self.neighbors[t as usize][i];
            let j = self.edge_towards(u, t);
            let apex = self.triangles[u as usize][previous(j)];
            t = u;
            i = match self.side(points, line, apex) {
                Sign::Zero => break (apex, None),
                // The apex is at the left: the segment leaves between the right end and the apex.
                Sign::Positive => next(j),
                Sign::Negative => previous(j),
            };
        };
        self.flip_away(line, [from, end.0], crossed, points);
        self.constrain(from, end.0, line.plane);
        end
    }

    /// Makes the vertex in which a segment crosses a constraint, edge `i` of `t`.
    fn cross(
        &mut self,
        line: &Line,
        (t, i): (u32, usize),
        other: PlaneId,
        points: &mut Points,
    ) -> (Local, Option<Across>) {
        let crossing = points
            .crossing([self.plane, line.plane, other])
            .expect("segments that cross have planes that meet in a point");
        if let Some(&vertex) = self.local.get(&crossing) {
            return (vertex, None);
        }
        let [right, left] = [i, next(i)].map(|k| self.triangles[t as usize][k]);
        let across = match self.neighbors[t as usize][i] {
            NONE => None,
            u => {
                let j = self.edge_towards(u, t);
                let apex = self.triangles[u as usize][previous(j)];
                Some(Across { right, left, apex })
            }
        };
        let vertex = self.add_vertex(crossing);
        self.remember(vertex, other);
        self.split_edge(t, i, vertex);
        (vertex, across)
    }

    /// What a segment meets first behind a constraint that it has crossed: one sign tells.
    fn first_across(&self, line: &Line, across: &Across, points: &Points) -> Crossed {
        let edge = match self.side(points, line, across.apex) {
            Sign::Zero => None,
            Sign::Positive => self.find_edge(across.right, across.apex),
            Sign::Negative => self.find_edge(across.apex, across.left),
        };
        match edge {
            Some((t, i)) => Crossed::Edge(t, i),
            None => Crossed::Vertex(across.apex),
        }
    }

    /// What a segment meets first after it leaves a vertex.
    fn first_crossed(&self, line: &Line, from: Local, points: &Points) -> Crossed {
        let fan = self.around(from);
        let side = |vertex| self.side(points, line, vertex);
        // Neighbours in the fan share a corner, so each is looked at once.
        let mut last = None;
        for (t, i) in fan {
            let [right, left] = [next(i), previous(i)].map(|k| self.triangles[t as usize][k]);
            if right == line.to || left == line.to {
                return Crossed::Vertex(line.to);
            }
            let of_right = match last {
                Some((vertex, side)) if vertex == right => side,
                _ => side(right),
            };
            let of_left = match last {
                Some((vertex, side)) if vertex == left => side,
                _ => side(left),
            };
            for (vertex, side) in [(right, of_right), (left, of_left)] {
                if side == Sign::Zero && self.is_ahead(points, from, line.to, vertex) {
                    return Crossed::Vertex(vertex);
                }
            }
            if of_right == Sign::Negative && of_left == Sign::Positive {
                return Crossed::Edge(t, next(i));
            }
            last = Some((left, of_left));
        }
        unreachable!("a segment inside the triangle leaves its end through a triangle there")
    }

    /// Whether a point on the line through two others lies on the second's side of the first.
    fn is_ahead(&self, points: &Points, from: Local, to: Local, vertex: Local) -> bool {
        let [from, to, vertex] = [from, to, vertex].map(|v| self.vertices[v as usize]);
        let towards = points.compare_all(from, to);
        towards != Ordering::Equal && points.compare_all(from, vertex) == towards
    }

    /// The triangles at a vertex, with its corner in each.
    fn around(&self, vertex: Local) -> Vec<(u32, usize)> {
        let corner = |t: u32| {
            let corners = self.triangles[t as usize];
            let at = corners.iter().position(|&v| v == vertex);
            at.expect("the triangle is at the vertex")
        };
        let start = self.at[vertex as usize];
        let mut fan = vec![(start, corner(start))];
        // Counter-clockwise, then clockwise from the start where a border ended that.
        for clockwise in [false, true] {
            let (mut t, mut i) = fan[0];
            loop {
                t = self.neighbors[t as usize][if clockwise { i } else { previous(i) }];
                if t == NONE {
                    break;
                }
                if t == start {
                    return fan;
                }
                i = corner(t);
                fan.push((t, i));
            }
        }
        fan
    }

    /// The triangle and edge that run from one vertex to another.
    fn find_edge(&self, from: Local, to: Local) -> Option<(u32, usize)> {
        self.around(from)
            .into_iter()
            .find(|&(t, i)| self.triangles[t as usize][next(i)] == to)
    }

    /// Marks an edge as cut along by a plane, on both sides.
    fn constrain(&mut self, a: Local, b: Local, plane: PlaneId) {
        for (from, to) in [(a, b), (b, a)] {
            if let Some((t, i)) = self.find_edge(from, to) {
                self.constraints[t as usize][i] = plane;
            }
        }
    }

    /// Flips edges until none crosses the part of a line between two vertices. Ends, since all signs are exact (Sloan 1993).
    fn flip_away(
        &mut self,
        line: &Line,
        ends: [Local; 2],
        mut crossed: VecDeque<(Local, Local)>,
        points: &Points,
    ) {
        while let Some((right, left)) = crossed.pop_front() {
            let Some((t, i)) = self.find_edge(right, left) else {
                continue;
            };
            let u = self.neighbors[t as usize][i];
            let j = self.edge_towards(u, t);
            let near = self.triangles[t as usize][previous(i)];
            let far = self.triangles[u as usize][previous(j)];
            let is_convex = self.orient(points, near, right, far) == Sign::Positive
                && self.orient(points, far, left, near) == Sign::Positive;
            if !is_convex {
                crossed.push_back((right, left));
                continue;
            }
            self.flip(t, i, u, j);
            let sides = [near, far].map(|v| match ends.contains(&v) {
                true => Sign::Zero,
                false => self.side(points, line, v),
            });
            if sides[0] * sides[1] == Sign::Negative {
                let [right, left] = match sides[0] {
                    Sign::Negative => [near, far],
                    _ => [far, near],
                };
                crossed.push_back((right, left));
            }
        }
    }

    /// ```text
    ///        b                    b
    ///       /|\                  / \         t = a b c with a b at edge i, u = b a d at edge j
    ///      c | d    becomes     c---d        become t = c d b and u = d c a.
    ///       \|/                  \ /
    ///        a                    a
    /// ```
    fn flip(&mut self, t: u32, i: usize, u: u32, j: usize) {
        let [a, b, c] = [i, next(i), previous(i)].map(|k| self.triangles[t as usize][k]);
        let d = self.triangles[u as usize][previous(j)];
        let outer =
            |s: &Self, t: u32, i: usize| (s.neighbors[t as usize][i], s.constraints[t as usize][i]);
        let (bc, on_bc) = outer(self, t, next(i));
        let (ca, on_ca) = outer(self, t, previous(i));
        let (ad, on_ad) = outer(self, u, next(j));
        let (db, on_db) = outer(self, u, previous(j));
        self.triangles[t as usize] = [c, d, b];
        self.triangles[u as usize] = [d, c, a];
        self.neighbors[t as usize] = [u, NONE, NONE];
        self.neighbors[u as usize] = [t, NONE, NONE];
        self.constraints[t as usize] = [PlaneId::NONE; 3];
        self.constraints[u as usize] = [PlaneId::NONE; 3];
        self.inherit((t, 1), u, db, on_db);
        self.inherit((t, 2), t, bc, on_bc);
        self.inherit((u, 1), t, ca, on_ca);
        self.inherit((u, 2), u, ad, on_ad);
        self.at[a as usize] = u;
        self.at[b as usize] = t;
        self.at[c as usize] = t;
        self.at[d as usize] = t;
    }
}

/// What a segment meets first.
enum Crossed {
    Vertex(Local),
    Edge(u32, usize),
}

#[cfg(test)]
mod tests;
