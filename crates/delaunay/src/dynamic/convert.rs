//! From and to tetrahedralisations that do not change.

use super::{DynamicTetrahedralization, inner, outer};
use crate::{
    Defect, Error, FacetId, Options, TetId, Tetrahedralization, build::INFINITE,
    connectivity::Connectivity, tetrahedralization::last_incident, tetrahedralize,
};
use pellicle_geometry::{DVec3, VertexId, first_not_finite};

impl DynamicTetrahedralization {
    /// The tetrahedralisation of some points, in the time of [`tetrahedralize`](crate::tetrahedralize):
    /// inserting them one by one takes longer.
    ///
    /// Vertex ids index `points`. Equal points are one vertex, under the lowest of their ids; the others are
    /// free. Points that span nothing are no error here.
    ///
    /// # Errors
    ///
    /// A coordinate that is not finite; more than 2³⁰ tetrahedra.
    pub fn of_points(points: &[DVec3]) -> Result<Self, Error> {
        match tetrahedralize(points, &Options::default()) {
            Ok(tetrahedralization) => Ok(Self::from(&tetrahedralization)),
            Err(Error::TooFewPoints { .. } | Error::Collinear { .. } | Error::Coplanar { .. }) => {
                Self::of_flat_points(points)
            }
            Err(error) => Err(error),
        }
    }

    fn of_flat_points(points: &[DVec3]) -> Result<Self, Error> {
        if let Some(vertex) = first_not_finite(points) {
            return Err(Error::NotFinite { vertex });
        }
        let mut dynamic = Self::new();
        let mut duplicates = Vec::new();
        for (i, &point) in points.iter().enumerate() {
            let vertex = VertexId::new(i);
            dynamic.kernel.set_point(inner(vertex), point);
            dynamic.incident.push(TetId::NONE);
            if let Some(flat) = &mut dynamic.flat {
                match flat.at(point) {
                    Some(_) => duplicates.push(vertex),
                    None => flat.add(vertex, point),
                }
            }
        }
        for vertex in duplicates.into_iter().rev() {
            dynamic.free_slot(vertex);
        }
        Ok(dynamic)
    }

    /// Takes over the tetrahedra among points that are set already; `id` tells which vertices they are.
    pub(super) fn adopt(
        &mut self,
        tetrahedralization: &Tetrahedralization<'_>,
        id: impl Fn(VertexId) -> VertexId,
    ) {
        let named = |vertex: VertexId| match vertex {
            Tetrahedralization::INFINITE => INFINITE,
            vertex => inner(id(vertex)),
        };
        let tets = tetrahedralization.tets().iter().map(|tet| tet.map(named));
        let tets: Vec<[VertexId; 4]> = tets.collect();
        for (t, tet) in tets.iter().enumerate() {
            for &corner in tet.iter().filter(|&&corner| corner != INFINITE) {
                self.incident[outer(corner).index()] = TetId::new(t);
            }
        }
        self.flat = None;
        self.bounds = self.tight_bounds();
        self.removals = 0;
        let twins = tetrahedralization.twins().to_vec();
        self.kernel.load(tets, twins, self.bounds);
    }

    /// The tetrahedralisation as it is now, over the points that are there, which replace the contents of
    /// `points`, by vertex id: the k-th of [`vertices`](Self::vertices) has id k in it. Linear time.
    ///
    /// # Errors
    ///
    /// Fewer than four vertices; all on one line or in one plane.
    ///
    /// ```
    /// # use pellicle_delaunay::DynamicTetrahedralization;
    /// # use pellicle_geometry::DVec3;
    /// let mut dynamic = DynamicTetrahedralization::new();
    /// for point in [DVec3::ONE, DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z] {
    ///     dynamic.insert(point)?;
    /// }
    /// let first = dynamic.vertices().next().unwrap();
    /// dynamic.remove(first)?;
    /// let mut points = Vec::new();
    /// let tetrahedralization = dynamic.to_tetrahedralization(&mut points)?;
    /// assert_eq!(tetrahedralization.points(), [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z]);
    /// assert_eq!(tetrahedralization.finite_count(), 1);
    /// # Ok::<(), pellicle_delaunay::Error>(())
    /// ```
    pub fn to_tetrahedralization<'a>(
        &self,
        points: &'a mut Vec<DVec3>,
    ) -> Result<Tetrahedralization<'a>, Error> {
        let distinct = self.vertex_count();
        match self.dimension() {
            Some(3) => {}
            _ if distinct < 4 => return Err(Error::TooFewPoints { distinct }),
            Some(2) => return Err(Error::Coplanar { distinct }),
            _ => return Err(Error::Collinear { distinct }),
        }
        points.clear();
        let mut vertices = vec![VertexId::NONE; self.incident.len()];
        for (vertex, point) in self.present() {
            vertices[vertex.index()] = VertexId::new(points.len());
            points.push(point);
        }

        // The finite tetrahedra first.
        let finite: Vec<TetId> = self.finite_tets().collect();
        let infinite = self.infinite_tets();
        let order: Vec<TetId> = finite.iter().copied().chain(infinite).collect();
        let mut places = vec![TetId::NONE; self.kernel.tet_slots()];
        for (place, tet) in order.iter().enumerate() {
            places[tet.index()] = TetId::new(place);
        }
        let named = |vertex: VertexId| match vertex {
            Self::INFINITE => Tetrahedralization::INFINITE,
            vertex => vertices[vertex.index()],
        };
        let placed = |facet: FacetId| FacetId::of(places[facet.tet().index()], facet.corner());
        let twins = |tet: TetId| [0, 1, 2, 3].map(|i| placed(self.twin(FacetId::of(tet, i))));
        let tets: Vec<_> = order.iter().map(|&tet| self.tet(tet).map(named)).collect();
        let incident = last_incident(points.len(), &tets[..finite.len()]);
        Ok(Tetrahedralization::from_arrays(
            points,
            tets,
            order.iter().map(|&tet| twins(tet)).collect(),
            finite.len(),
            incident,
            Vec::new(),
        ))
    }

    /// All defects, by the ids of [`to_tetrahedralization`](Self::to_tetrahedralization):
    /// see [`Tetrahedralization::validate`]. None while the points are flat.
    pub fn validate(&self) -> Vec<Defect> {
        let mut points = Vec::new();
        let Ok(tetrahedralization) = self.to_tetrahedralization(&mut points) else {
            return Vec::new();
        };
        let mut defects = tetrahedralization.validate();
        for (k, vertex) in self.vertices().enumerate() {
            let held = (self.incident(vertex))
                .is_some_and(|tet| self.is_finite(tet) && self.place_of(tet, vertex).is_some());
            if !held {
                defects.push(Defect::Incident(VertexId::new(k)));
            }
        }
        defects
    }
}

impl From<&Tetrahedralization<'_>> for DynamicTetrahedralization {
    /// The same vertices under the same ids; those of duplicates are free. Linear time.
    fn from(tetrahedralization: &Tetrahedralization<'_>) -> Self {
        let mut dynamic = Self::new();
        for (i, &point) in tetrahedralization.points().iter().enumerate() {
            dynamic.kernel.set_point(inner(VertexId::new(i)), point);
            dynamic.incident.push(TetId::NONE);
        }
        for &(duplicate, _) in tetrahedralization.duplicates().iter().rev() {
            dynamic.free_slot(duplicate);
        }
        dynamic.adopt(tetrahedralization, |vertex| vertex);
        dynamic
    }
}

impl Connectivity for DynamicTetrahedralization {
    #[inline]
    fn corners(&self, tet: TetId) -> [VertexId; 4] {
        self.kernel.corners(tet).map(outer)
    }

    #[inline]
    fn other_side(&self, facet: FacetId) -> FacetId {
        self.kernel.twin(facet)
    }

    #[inline]
    fn position(&self, vertex: VertexId) -> DVec3 {
        self.kernel.point(inner(vertex))
    }

    #[inline]
    fn tet_at(&self, vertex: VertexId) -> Option<TetId> {
        let tet = self.incident.get(vertex.index())?.some()?;
        // Behind the hull facet of an infinite tetrahedron at the vertex is a finite one at the vertex.
        Some(match self.has_four_points(tet) {
            true => tet,
            false => self.kernel.twin(FacetId::of(tet, 3)).tet(),
        })
    }

    #[inline]
    fn vertex_limit(&self) -> usize {
        self.incident.len()
    }

    #[inline]
    fn any_tet(&self) -> Option<TetId> {
        self.kernel.recent()
    }
}
