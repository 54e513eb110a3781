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
    build::{INFINITE, Stepwise},
    id::facet_vertices,
};
use pellicle_geometry::{Aabb, DVec3, VertexId};

/// A facet known by its vertices, sorted.
type NamedFacet = ([VertexId; 3], FacetId);

/// Storage that one removal leaves to the next.
pub(super) struct Workplace {
    /// The tetrahedralisation of the link's vertices.
    small: Stepwise,
    /// The vertices of the link, as the kernel names them, without infinity.
    link: Vec<VertexId>,
    points: Vec<DVec3>,
    /// By tetrahedron of `small` that fills the hole: where it stands in the whole.
    places: Vec<TetId>,
    /// The open facets on both sides of the hole's boundary.
    facets: Vec<NamedFacet>,
}

impl Default for Workplace {
    fn default() -> Self {
        Self {
            small: Stepwise::new(),
            link: Vec::new(),
            points: Vec::new(),
            places: Vec::new(),
            facets: Vec::new(),
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
            self.removals = 0;
            self.bounds = self.tight_bounds();
            self.kernel.set_bounds(self.bounds);
        }
        Ok(point)
    }

    /// Takes the tetrahedra at a vertex away and fills the hole.
    fn dig_out(&mut self, vertex: VertexId, p: DVec3) -> Result<(), Error> {
        // 1. The hole and the vertices around it.
        let Self {
            kernel,
            workplace: work,
            filling,
            ..
        } = self;
        kernel.dig_star(self.incident[vertex.index()], inner(vertex));
        work.gather(kernel);

        // 2. Their tetrahedralisation; then what of it fills the hole.
        let bounds = Aabb::of_points(&work.points).with(p);
        let filled = match work.small.restart(&work.points, bounds) {
            Ok(order) => {
                work.small.dig_around(p);
                work.fill(kernel, &order, filling)
            }
            Err(error @ Error::TooMany { .. }) => Err(error),
            // 3. They all lie in a plane.
            Err(_) if nothing_is_beyond(kernel) => {
                self.fall_flat(vertex);
                return Ok(());
            }
            Err(_) => work.cap(kernel, filling),
        };
        if let Err(error) = filled {
            kernel.close_hole();
            return Err(error);
        }

        // 4. The tetrahedra at the vertices around.
        self.register();
        Ok(())
    }
}

/// Whether, of a hole whose vertices lie in a plane, nothing is on the other side of that plane: no points are
/// left besides.
fn nothing_is_beyond(kernel: &Stepwise) -> bool {
    let mut finite = kernel.link().iter().filter(|facet| facet.is_finite());
    finite.any(|facet| kernel.corners(facet.outer.tet())[3] == INFINITE)
}

impl Workplace {
    /// The facets and vertices of the link, and their points.
    fn gather(&mut self, kernel: &Stepwise) {
        let facets = kernel.link().iter();
        self.facets.clear();
        self.facets
            .extend(facets.map(|facet| (sorted(facet.corners), facet.outer)));
        self.link.clear();
        self.link
            .extend(self.facets.iter().flat_map(|facet| facet.0));
        self.link.sort_unstable();
        self.link.dedup();
        self.link.retain(|&vertex| vertex != INFINITE);
        self.points.clear();
        self.points
            .extend(self.link.iter().map(|&vertex| kernel.point(vertex)));
    }

    /// Fills the hole with the tetrahedra of the small kernel that are in conflict with the vertex.
    fn fill(
        &mut self,
        kernel: &mut Stepwise,
        order: &[u32],
        filling: &mut Vec<TetId>,
    ) -> Result<(), Error> {
        let dug = self.small.dug();
        let whole = |vertex: VertexId| match vertex {
            INFINITE => INFINITE,
            vertex => self.link[order[vertex.index() - 1] as usize],
        };

        // 1. The tetrahedra.
        kernel.vacate_hole(dug.len())?;
        self.places.resize(self.small.tet_slots(), TetId::NONE);
        filling.clear();
        for &tet in dug {
            let place = kernel.place(self.small.corners(tet).map(whole))?;
            self.places[tet.index()] = place;
            filling.push(place);
        }

        // 2. Joined to each other as in the small kernel; what is open there has a facet of the link as its
        // other side.
        let placed = |facet: FacetId| FacetId::of(self.places[facet.tet().index()], facet.corner());
        for (&tet, &place) in dug.iter().zip(&*filling) {
            for corner in 0..4 {
                let twin = self.small.twin(FacetId::of(tet, corner));
                let facet = FacetId::of(place, corner);
                if self.small.is_dug(twin.tet()) {
                    kernel.set_twin(facet, placed(twin));
                } else {
                    self.facets.push(named(kernel, facet));
                }
            }
        }
        join_equal(kernel, &mut self.facets);
        Ok(())
    }

    /// Closes the hull over a hole whose vertices lie in a plane: in each finite tetrahedron of the hole,
    /// infinity takes the place of the vertex, which was beyond the facet on the same side.
    fn cap(&mut self, kernel: &mut Stepwise, filling: &mut Vec<TetId>) -> Result<(), Error> {
        let facets = kernel.link().iter().filter(|facet| facet.is_finite());
        let caps: Vec<[VertexId; 3]> = facets.map(|facet| facet.corners).collect();
        kernel.vacate_hole(caps.len())?;
        filling.clear();
        for [a, b, c] in caps {
            let tet = kernel.place([a, b, c, INFINITE])?;
            filling.push(tet);
            let facets = (0..4).map(|corner| named(kernel, FacetId::of(tet, corner)));
            self.facets.extend(facets);
        }
        join_equal(kernel, &mut self.facets);
        Ok(())
    }
}

/// A facet with its name.
fn named(kernel: &Stepwise, facet: FacetId) -> NamedFacet {
    let corners = facet_vertices(kernel.corners(facet.tet()), facet.corner());
    (sorted(corners), facet)
}

/// Joins facets of equal names; each name is there twice.
fn join_equal(kernel: &mut Stepwise, facets: &mut [NamedFacet]) {
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
