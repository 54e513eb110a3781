//! Removal.
//!
//! The tetrahedra at a vertex p leave a hole, which its link bounds. Of the Delaunay tetrahedralisation of the
//! remaining points, those tetrahedra fill it that are in conflict with p; their corners are vertices of the
//! link, so they are also the ones in conflict with p in the Delaunay tetrahedralisation of the link's vertices
//! alone (Devillers and Teillaud 2003), which is small:
//!
//! ```text
//!      b ------- c              b ------- c             b ------- c
//!     / \       / \            / \       / \           / \      ./ \
//!    a --- p ----- d          a    hole     d         a -- \ ./---- d
//!     \   / \     /            \           /           \    /'     /
//!      f ------- e              f ------- e             f ------- e
//! ```
//!
//! That holds with ties, since the perturbation of five points depends on their mutual order alone, and on the
//! hull, where the link contains infinity and the conflict test knows of it.
//!
//! There is one exception: the vertices of the link may all lie in one plane. Then p is a hull vertex, and what
//! the hole leaves open is the hull itself: each finite tetrahedron at p becomes an infinite one.

use super::{DynamicTetrahedralization, inner};
use crate::{
    Error, FacetId, TetId,
    build::{BoundaryFacet, INFINITE, Kernel},
};
use pellicle_geometry::{Aabb, DVec3, VertexId};

/// A facet known by its vertices, sorted.
type NamedFacet = ([VertexId; 3], FacetId);

/// Storage that one removal leaves to the next.
pub(super) struct Workplace {
    /// The tetrahedralisation of the link's vertices.
    small: Kernel,
    /// The vertices of the link, as the kernel names them, without infinity.
    link: Vec<VertexId>,
    points: Vec<DVec3>,
    /// By tetrahedron of `small` that fills the hole: where it stands in the whole.
    places: Vec<TetId>,
    facets: Vec<NamedFacet>,
    /// The new tetrahedra.
    filling: Vec<TetId>,
}

impl Default for Workplace {
    fn default() -> Self {
        Self {
            small: Kernel::empty(),
            link: Vec::new(),
            points: Vec::new(),
            places: Vec::new(),
            facets: Vec::new(),
            filling: Vec::new(),
        }
    }
}

impl DynamicTetrahedralization {
    /// Removes a vertex and returns its point; its id is free for the next insertion.
    ///
    /// O(d log d) for d neighbours, about fifteen in a volume, wherever their tetrahedralisation is of linear
    /// size; O(d²) at worst. The step after which the points span nothing takes O(n), and so do, while they
    /// do not, at worst, all others.
    ///
    /// # Errors
    ///
    /// The id names no vertex; more than 2³⁰ tetrahedra. Nothing has changed then.
    ///
    /// ```
    /// # use pellicle_delaunay::{DynamicTetrahedralization, Error};
    /// # use pellicle_geometry::DVec3;
    /// let corners = (0..8).map(|i| DVec3::new((i & 1) as f64, (i >> 1 & 1) as f64, (i >> 2) as f64));
    /// let mut cube = DynamicTetrahedralization::of_points(&corners.collect::<Vec<_>>())?;
    /// let corner = cube.nearest_vertex(DVec3::ONE, None).unwrap();
    /// assert_eq!(cube.remove(corner)?, DVec3::ONE);
    /// assert_eq!(cube.remove(corner), Err(Error::NotAVertex { vertex: corner }));
    /// assert_eq!(cube.vertex_count(), 7);
    /// # Ok::<(), pellicle_delaunay::Error>(())
    /// ```
    pub fn remove(&mut self, vertex: VertexId) -> Result<DVec3, Error> {
        let point = self.point(vertex).ok_or(Error::NotAVertex { vertex })?;
        if let Some(mut flat) = self.flat.take() {
            let others = self.present().filter(|&(other, _)| other != vertex);
            flat.remove(vertex, point, others);
            self.flat = Some(flat);
        } else {
            self.dig_out(vertex, point)?;
        }
        self.free_slot(vertex);
        self.removals += 1;
        if self.removals > self.vertex_count() && self.flat.is_none() {
            self.fit_bounds();
        }
        Ok(point)
    }

    /// Takes the tetrahedra at a vertex away and fills the hole.
    fn dig_out(&mut self, vertex: VertexId, p: DVec3) -> Result<(), Error> {
        // 1. The hole and the vertices around it.
        let (kernel, work) = (&mut self.kernel, &mut *self.workplace);
        kernel.dig_star(self.incident[vertex.index()], inner(vertex));
        let (_, boundary) = kernel.cavity();
        work.gather(kernel, boundary);

        // 2. Their tetrahedralisation; then what of it fills the hole.
        let bounds = Aabb::of_points(&work.points).with(p);
        let filled = match work.small.restart(&work.points, bounds) {
            Ok(order) => {
                work.small.dig_around(p);
                work.fill(kernel, &order)
            }
            Err(error @ Error::TooMany { .. }) => Err(error),
            // 3. They all lie in a plane.
            Err(_) if is_all(boundary, kernel) => {
                self.fall_flat(vertex);
                return Ok(());
            }
            Err(_) => work.cap(kernel, inner(vertex)),
        };
        if let Err(error) = filled {
            kernel.undo_cavity();
            return Err(error);
        }

        // 4. The tetrahedra at the vertices around.
        for k in 0..self.workplace.filling.len() {
            self.register(self.workplace.filling[k]);
        }
        Ok(())
    }
}

/// Whether, of a hole whose vertices lie in a plane, nothing is on the other side of that plane: no points are
/// left besides.
fn is_all(boundary: &[BoundaryFacet], kernel: &Kernel) -> bool {
    (boundary.iter())
        .filter(|facet| facet.corners[2] != INFINITE)
        .any(|facet| kernel.corners(facet.outer.tet())[3] == INFINITE)
}

impl Workplace {
    /// The vertices of the link and their points.
    fn gather(&mut self, kernel: &Kernel, boundary: &[BoundaryFacet]) {
        self.link.clear();
        self.link
            .extend(boundary.iter().flat_map(|facet| facet.corners));
        self.link.sort_unstable();
        self.link.dedup();
        self.link.retain(|&vertex| vertex != INFINITE);
        self.points.clear();
        let points = self.link.iter().map(|&vertex| kernel.point_of(vertex));
        self.points.extend(points);
    }

    /// Fills the hole with the tetrahedra of the small kernel's cavity.
    fn fill(&mut self, kernel: &mut Kernel, order: &[u32]) -> Result<(), Error> {
        let (conflict, small_boundary) = self.small.cavity();
        kernel.check_room(conflict.len())?;
        let whole = |vertex: VertexId| match vertex {
            INFINITE => INFINITE,
            vertex => self.link[order[vertex.index() - 1] as usize],
        };
        self.facets.clear();
        name_outer_facets(kernel, &mut self.facets);

        // 1. The tetrahedra.
        kernel.vacate_cavity();
        self.places.resize(self.small.tet_slots(), TetId::NONE);
        self.filling.clear();
        for &tet in conflict {
            let place = kernel.place(self.small.corners(tet).map(whole))?;
            self.places[tet.index()] = place;
            self.filling.push(place);
        }

        // 2. Joined to each other as in the small kernel.
        let placed = |facet: FacetId| FacetId::of(self.places[facet.tet().index()], facet.corner());
        for &tet in conflict {
            for corner in 0..4 {
                let facet = FacetId::of(tet, corner);
                let twin = self.small.twin(facet);
                if self.small.is_dug(twin.tet()) {
                    kernel.set_twin(placed(facet), placed(twin));
                }
            }
        }

        // 3. Joined to what is around.
        for facet in small_boundary {
            let name = sorted(facet.corners.map(whole));
            self.facets
                .push((name, placed(self.small.twin(facet.outer))));
        }
        join_equal(kernel, &mut self.facets);
        Ok(())
    }

    /// Closes the hull over a hole whose vertices lie in a plane: in each finite tetrahedron of the hole,
    /// infinity takes the place of the vertex.
    fn cap(&mut self, kernel: &mut Kernel, vertex: VertexId) -> Result<(), Error> {
        let (_, boundary) = kernel.cavity();
        let caps: Vec<[VertexId; 3]> = (boundary.iter())
            .map(|facet| facet.corners)
            .filter(|corners| corners[2] != INFINITE)
            .collect();
        debug_assert!(caps.iter().flatten().all(|&corner| corner != vertex));
        kernel.check_room(caps.len())?;
        self.facets.clear();
        name_outer_facets(kernel, &mut self.facets);
        kernel.vacate_cavity();
        self.filling.clear();
        for [a, b, c] in caps {
            // (vertex, a, b, c) was positive, and (a, c, b, vertex) is an even permutation.
            let corners = [a, c, b, INFINITE];
            let tet = kernel.place(corners)?;
            self.filling.push(tet);
            for corner in 0..4 {
                let facet = crate::id::facet_vertices(corners, corner);
                self.facets.push((sorted(facet), FacetId::of(tet, corner)));
            }
        }
        join_equal(kernel, &mut self.facets);
        Ok(())
    }
}

/// The facets around the hole, seen from outside.
fn name_outer_facets(kernel: &Kernel, facets: &mut Vec<NamedFacet>) {
    let (_, boundary) = kernel.cavity();
    facets.extend(
        boundary
            .iter()
            .map(|facet| (sorted(facet.corners), facet.outer)),
    );
}

/// Joins facets of equal names; each name is there twice.
fn join_equal(kernel: &mut Kernel, facets: &mut [NamedFacet]) {
    facets.sort_unstable();
    for pair in facets.chunks_exact(2) {
        debug_assert_eq!(
            pair[0].0, pair[1].0,
            "the hole and its filling have the same boundary"
        );
        kernel.join(pair[0].1, pair[1].1);
    }
}

fn sorted(mut facet: [VertexId; 3]) -> [VertexId; 3] {
    facet.sort_unstable();
    facet
}
