//! Triangles without a guarantee.

use crate::{MeshError, TriMesh, TriangleId};
use pellicle_geometry::{Aabb, DVec3, VertexId};

/// Triangles over positions, with nothing promised: what a file holds.
///
/// [`TriMesh::try_from`] takes it if it is an oriented manifold; [`TriMesh::from_soup_splitting`] makes
/// one of any soup.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TriangleSoup {
    /// The vertices.
    pub positions: Vec<DVec3>,
    /// Three vertices a triangle, counter-clockwise seen from outside.
    pub triangles: Vec<[VertexId; 3]>,
}

/// A borrowed mesh or soup: what measures, writers and pictures take.
#[derive(Clone, Copy, Debug)]
pub struct MeshView<'a> {
    /// The vertices.
    pub positions: &'a [DVec3],
    /// Three vertices a triangle, counter-clockwise seen from outside.
    pub triangles: &'a [[VertexId; 3]],
}

/// Where the vertices went when isolated ones were dropped; made by [`TriangleSoup::compact`].
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct VertexRemap {
    /// For each vertex that stayed, in order, its id before.
    pub old_of_new: Vec<VertexId>,
    /// For each vertex before, its id now; [`VertexId::NONE`] if it was dropped.
    pub new_of_old: Vec<VertexId>,
}

impl VertexRemap {
    /// The attributes of the vertices that stayed, in their new order; `attributes` holds one value for
    /// each vertex before.
    ///
    /// # Panics
    /// If `attributes` is shorter than that.
    pub fn apply<T: Clone>(&self, attributes: &[T]) -> Vec<T> {
        self.old_of_new
            .iter()
            .map(|old| attributes[old.index()].clone())
            .collect()
    }
}

impl TriangleSoup {
    /// Drops the vertices that no triangle names, and keeps the order of the others. Corners that are out
    /// of range are left as they are when nothing is dropped, and become [`VertexId::NONE`] otherwise.
    /// Linear time.
    ///
    /// ```
    /// use pellicle_geometry::{DVec3, VertexId};
    /// use pellicle_mesh::TriangleSoup;
    /// let mut soup = TriangleSoup {
    ///     positions: vec![DVec3::ONE, DVec3::ZERO, DVec3::X, DVec3::Y],
    ///     triangles: vec![[1, 2, 3].map(VertexId)],
    /// };
    /// let remap = soup.compact();
    /// assert_eq!(soup.triangles, [[0, 1, 2].map(VertexId)]);
    /// assert_eq!(remap.old_of_new, [1, 2, 3].map(VertexId));
    /// ```
    pub fn compact(&mut self) -> VertexRemap {
        let mut used = vec![false; self.positions.len()];
        for vertex in self.triangles.as_flattened() {
            if let Some(slot) = used.get_mut(vertex.index()) {
                *slot = true;
            }
        }
        let old_of_new: Vec<VertexId> = (0..used.len())
            .filter(|&v| used[v])
            .map(VertexId::new)
            .collect();
        let mut new_of_old = vec![VertexId::NONE; used.len()];
        for (new, old) in old_of_new.iter().enumerate() {
            new_of_old[old.index()] = VertexId::new(new);
        }
        if old_of_new.len() < used.len() {
            for vertex in self.triangles.as_flattened_mut() {
                *vertex = new_of_old
                    .get(vertex.index())
                    .copied()
                    .unwrap_or(VertexId::NONE);
            }
            self.positions = old_of_new
                .iter()
                .map(|old| self.positions[old.index()])
                .collect();
        }
        VertexRemap {
            old_of_new,
            new_of_old,
        }
    }
}

impl<'a> MeshView<'a> {
    /// The corners of a triangle; `None` if one is out of range.
    #[inline]
    pub fn corners(self, triangle: TriangleId) -> Option<[DVec3; 3]> {
        let [a, b, c] = *self.triangles.get(triangle.index())?;
        Some([
            *self.positions.get(a.index())?,
            *self.positions.get(b.index())?,
            *self.positions.get(c.index())?,
        ])
    }

    /// The smallest box around all vertices, isolated ones included.
    pub fn bounds(self) -> Aabb {
        Aabb::of_points(self.positions)
    }

    /// Whether the triangle's vertices exist and differ, so that connectivity can be read from it.
    #[inline]
    pub(crate) fn is_usable(self, triangle: [VertexId; 3]) -> bool {
        let [a, b, c] = triangle;
        a != b && b != c && c != a && triangle.iter().all(|v| v.index() < self.positions.len())
    }

    /// An error unless `u32` ids can name every vertex and half-edge.
    pub(crate) fn check_size(self) -> Result<(), MeshError> {
        match self.fits_ids() {
            true => Ok(()),
            false => Err(MeshError::TooLarge {
                vertices: self.positions.len(),
                triangles: self.triangles.len(),
            }),
        }
    }

    /// Whether `u32` ids can name every vertex and half-edge.
    pub(crate) fn fits_ids(self) -> bool {
        self.positions.len() < u32::MAX as usize && self.triangles.len() < u32::MAX as usize / 3
    }
}

impl<'a> From<&'a TriangleSoup> for MeshView<'a> {
    fn from(soup: &'a TriangleSoup) -> Self {
        Self {
            positions: &soup.positions,
            triangles: &soup.triangles,
        }
    }
}

impl<'a> From<&'a TriMesh> for MeshView<'a> {
    fn from(mesh: &'a TriMesh) -> Self {
        Self {
            positions: mesh.positions(),
            triangles: mesh.triangles(),
        }
    }
}
