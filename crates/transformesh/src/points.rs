//! The points of an arrangement: corners of triangles, and where planes meet; each place once.

use crate::hash::FastMap;
use crate::weld::{Weld, key};
use pellicle_geometry::{DVec3, VertexId, define_id};
use pellicle_predicates::Sign;
use pellicle_predicates::implicit::{Lattice, Plane, Point};
use std::cmp::Ordering;

define_id! {
    /// A plane: of a triangle, or through an edge along a coordinate axis.
    pub(crate) struct PlaneId;
}

/// Points by id: those of the input first, under their ids.
pub(crate) struct Points {
    pub lattice: Lattice,
    points: Vec<Point>,
    /// The first point with given rounded coordinates; further ones hang in `next`.
    first: FastMap<[u64; 3], VertexId>,
    next: FastMap<VertexId, VertexId>,
    /// Where three planes meet.
    crossings: FastMap<[PlaneId; 3], VertexId>,
    planes: Vec<Plane>,
    plane_of_triangle: Vec<PlaneId>,
    plane_of_edge: FastMap<(VertexId, VertexId, u32), PlaneId>,
}

impl Points {
    pub(crate) fn new(weld: &mut Weld) -> Self {
        let used = weld.triangles.as_flattened().iter();
        Self {
            lattice: Lattice::of(used.map(|v| weld.positions[v.index()])),
            points: weld.positions.iter().map(|&p| Point::exactly(p)).collect(),
            first: std::mem::take(&mut weld.places),
            next: FastMap::default(),
            crossings: FastMap::default(),
            planes: Vec::new(),
            plane_of_triangle: vec![PlaneId::NONE; weld.triangles.len()],
            plane_of_edge: FastMap::default(),
        }
    }

    /// All points, rounded to nearest doubles.
    pub(crate) fn rounded_all(&self) -> Vec<DVec3> {
        self.points.iter().map(Point::rounded).collect()
    }

    pub(crate) fn get(&self, id: VertexId) -> &Point {
        &self.points[id.index()]
    }

    pub(crate) fn rounded(&self, id: VertexId) -> DVec3 {
        self.points[id.index()].rounded()
    }

    /// The id of a point; equal points have one id, however they were made.
    pub(crate) fn intern(&mut self, point: Point) -> VertexId {
        let new = VertexId::new(self.points.len());
        let mut at = *self.first.entry(key(point.rounded())).or_insert(new);
        while at != new {
            if self.lattice.equal(&self.points[at.index()], &point) {
                return at;
            }
            at = *self.next.entry(at).or_insert(new);
        }
        self.points.push(point);
        new
    }

    pub(crate) fn plane(&self, id: PlaneId) -> &Plane {
        &self.planes[id.index()]
    }

    fn add_plane(&mut self, plane: Plane) -> PlaneId {
        self.planes.push(plane);
        PlaneId::new(self.planes.len() - 1)
    }

    /// The plane of a triangle, its normal that of the triangle.
    pub(crate) fn plane_of_triangle(&mut self, triangle: usize, weld: &Weld) -> PlaneId {
        if self.plane_of_triangle[triangle] == PlaneId::NONE {
            let [a, b, c] = weld.corners(triangle);
            let plane = self.lattice.plane(a, b, c);
            self.plane_of_triangle[triangle] = self.add_plane(plane);
        }
        self.plane_of_triangle[triangle]
    }

    /// The plane through an edge of the input along an axis; the same for both directions of the edge.
    pub(crate) fn plane_of_edge(&mut self, a: VertexId, b: VertexId, axis: usize) -> PlaneId {
        let (a, b) = (a.min(b), a.max(b));
        if let Some(&plane) = self.plane_of_edge.get(&(a, b, axis as u32)) {
            return plane;
        }
        let plane = self
            .lattice
            .edge_plane(self.rounded(a), self.rounded(b), axis);
        let id = self.add_plane(plane);
        self.plane_of_edge.insert((a, b, axis as u32), id);
        id
    }

    /// Where the line through two vertices of the input meets a plane.
    pub(crate) fn line_plane(&self, p: VertexId, q: VertexId, plane: PlaneId) -> Option<Point> {
        // In one order, so that the same integers come out for both triangles at an edge.
        let (p, q) = (p.min(q), p.max(q));
        self.lattice
            .line_plane(self.rounded(p), self.rounded(q), self.plane(plane))
    }

    /// Where three planes meet.
    pub(crate) fn crossing(&mut self, mut planes: [PlaneId; 3]) -> Option<VertexId> {
        planes.sort_unstable();
        if let Some(&point) = self.crossings.get(&planes) {
            return Some(point);
        }
        let [f, g, h] = planes.map(|p| self.plane(p));
        let point = self.lattice.three_planes(f, g, h)?;
        let id = self.intern(point);
        self.crossings.insert(planes, id);
        Some(id)
    }

    /// How three points turn, seen against an axis: as [`crate::weld::projected`].
    pub(crate) fn orient(&self, axis: usize, a: VertexId, b: VertexId, c: VertexId) -> Sign {
        self.lattice
            .orient2d(axis, self.get(a), self.get(b), self.get(c))
    }

    pub(crate) fn compare(&self, a: VertexId, b: VertexId, axis: usize) -> Ordering {
        self.lattice.compare(self.get(a), self.get(b), axis)
    }

    /// By x, then y, then z.
    pub(crate) fn compare_all(&self, a: VertexId, b: VertexId) -> Ordering {
        (0..3).fold(Ordering::Equal, |order, axis| {
            order.then_with(|| self.compare(a, b, axis))
        })
    }
}
