//! Insertion.

use super::{DynamicTetrahedralization, Flat, inner};
use crate::{Error, Location, Options, TetId, locate::locate, tetrahedralize};
use pellicle_geometry::{DVec3, VertexId};

/// In the kernel ids are one higher.
const MOST_VERTICES: usize = crate::build::MOST_VERTICES - 1;

impl DynamicTetrahedralization {
    /// Inserts a point, anywhere, and returns its vertex: the one that is there already if it equals one
    /// (−0 equals 0).
    ///
    /// Walks to the point from the nearest of a few vertices drawn at random and one of the last step: see
    /// [`locate`](Self::locate) for the time; [`insert_near`](Self::insert_near) saves it. The rest takes
    /// time linear in the number of tetrahedra that come and go, a few dozen for points in a volume, all at
    /// worst. The step that makes flat points span something takes O(n log n).
    ///
    /// # Errors
    ///
    /// A coordinate that is not finite (the error names the id that the vertex would have had); more than
    /// 2³⁰ tetrahedra or 2³² − 2 vertices. Nothing has changed then.
    ///
    /// ```
    /// # use pellicle_delaunay::DynamicTetrahedralization;
    /// # use pellicle_geometry::DVec3;
    /// let mut tetrahedralization = DynamicTetrahedralization::new();
    /// let vertex = tetrahedralization.insert(DVec3::X)?;
    /// assert_eq!(tetrahedralization.insert(DVec3::X)?, vertex);
    /// assert!(tetrahedralization.insert(DVec3::NAN).is_err());
    /// assert_eq!(tetrahedralization.vertex_count(), 1);
    /// # Ok::<(), pellicle_delaunay::Error>(())
    /// ```
    pub fn insert(&mut self, point: DVec3) -> Result<VertexId, Error> {
        self.insert_from(point, None)
    }

    /// [`insert`](Self::insert), where `near` is a vertex thought to be near to the point: expected O(1) to
    /// get there if it is. Any other id does no harm.
    pub fn insert_near(&mut self, point: DVec3, near: VertexId) -> Result<VertexId, Error> {
        self.insert_from(point, Some(near))
    }

    fn insert_from(&mut self, point: DVec3, near: Option<VertexId>) -> Result<VertexId, Error> {
        let vertex = self.next_vertex()?;
        if !point.is_finite() {
            return Err(Error::NotFinite { vertex });
        }
        if let Some(flat) = &self.flat {
            return match flat.at(point) {
                Some(vertex) => Ok(vertex),
                None if flat.spans_with(point) => self.insert_spanning(vertex, point),
                None => Ok(self.insert_flat(vertex, point)),
            };
        }
        let start = match locate(self, point, near) {
            None => return Err(Error::NotFinite { vertex }),
            Some(Location::Vertex(vertex)) => return Ok(vertex),
            Some(Location::Edge { tet, .. } | Location::Tetrahedron(tet)) => tet,
            Some(Location::Facet(facet)) => facet.tet(),
            Some(Location::Outside(tet)) => tet,
        };
        let bounds = self.bounds.with(point);
        if bounds != self.bounds {
            self.bounds = bounds;
            self.kernel.set_bounds(bounds);
        }
        self.take_slot(vertex, point);
        match self.kernel.insert(start, inner(vertex)) {
            Ok(filling) => {
                self.filling.clear();
                self.filling.extend_from_slice(filling);
            }
            Err(error) => {
                self.free_slot(vertex);
                return Err(error);
            }
        }
        self.register();
        Ok(vertex)
    }

    /// The id that the next new vertex gets.
    fn next_vertex(&self) -> Result<VertexId, Error> {
        match self.free.last() {
            Some(&vertex) => Ok(vertex),
            None if self.incident.len() < MOST_VERTICES => Ok(VertexId::new(self.incident.len())),
            None => Err(Error::TooMany {
                of: "vertices",
                limit: MOST_VERTICES,
            }),
        }
    }

    /// Gives the next vertex its point.
    fn take_slot(&mut self, vertex: VertexId, point: DVec3) {
        self.kernel.set_point(inner(vertex), point);
        if self.free.pop().is_none() {
            self.incident.push(TetId::NONE);
        }
    }

    /// Takes the point of a vertex away, which has no tetrahedra left.
    pub(super) fn free_slot(&mut self, vertex: VertexId) {
        self.kernel.set_point(inner(vertex), DVec3::NAN);
        self.incident[vertex.index()] = TetId::NONE;
        self.free.push(vertex);
    }

    /// A further point in the plane, on the line, or one of the first.
    fn insert_flat(&mut self, vertex: VertexId, point: DVec3) -> VertexId {
        self.take_slot(vertex, point);
        if let Some(flat) = &mut self.flat {
            flat.add(vertex, point);
        }
        vertex
    }

    /// The point that makes the others span something.
    fn insert_spanning(&mut self, vertex: VertexId, point: DVec3) -> Result<VertexId, Error> {
        let (mut vertices, mut points): (Vec<_>, Vec<_>) = self.present().unzip();
        vertices.push(vertex);
        points.push(point);
        let tetrahedralization = tetrahedralize(&points, &Options::default())?;
        self.take_slot(vertex, point);
        self.adopt(&tetrahedralization, |k| vertices[k.index()]);
        Ok(vertex)
    }

    /// Goes back to points without tetrahedra, all but one, which is leaving.
    pub(super) fn fall_flat(&mut self, leaving: VertexId) {
        let mut flat = Flat::default();
        for (vertex, point) in self.present().filter(|&(vertex, _)| vertex != leaving) {
            flat.add(vertex, point);
        }
        self.flat = Some(flat);
        self.kernel.clear();
        self.incident.fill(TetId::NONE);
    }
}
