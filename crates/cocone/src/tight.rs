//! Tight Cocone (Dey and Goswami 2003): mark tetrahedra inside and outside, peel, take the boundary.
//!
//! 1. A vertex is *good* when the triangles that Cocone found at it form an umbrella: then it knows which of the tetrahedra
//!    around it lie on the same side.
//! 2. *Mark.* Outside spreads from infinity: across a facet with a good vertex the side changes exactly
//!    where the facet is one of those triangles.
//! 3. *Peel.* Tetrahedra without a good vertex say nothing. Outside enters them through any facet but their
//!    smallest, the widest first; then marking goes on behind them.
//! 4. What outside has not reached is inside. The set is made such that its boundary is a manifold, which
//!    the published method leaves open.

use crate::canonical::Canonical;
use crate::facet_set::FacetSet;
use crate::sheet::Sheet;
use crate::solid::{Side, Solid};
use crate::umbrella::Links;
use pellicle_delaunay::{FacetId, TetId};
use pellicle_geometry::triangle;
use std::collections::{BinaryHeap, VecDeque};

/// The boundary of the tetrahedra inside, seen from outside, and how many of them were moved to make it a
/// manifold. `surface` is what Cocone found.
pub(crate) fn close(canonical: &Canonical, surface: &FacetSet) -> (Sheet, usize) {
    let facets: Vec<_> = surface
        .iter(canonical)
        .map(|facet| canonical.facet(facet))
        .collect();
    let links = Links::of(canonical.vertex_count(), &facets);
    let good: Vec<bool> = canonical
        .vertex_ids()
        .map(|v| links.is_umbrella(v))
        .collect();

    let sides = Marking::of(canonical, surface, &good);
    let mut solid = Solid::new(canonical, sides, &good);
    let moved = solid.make_manifold();
    (solid.boundary(), moved)
}

/// Sides known so far, and what waits to be marked.
struct Marking<'m> {
    canonical: &'m Canonical<'m>,
    surface: &'m FacetSet,
    good: &'m [bool],
    sides: Vec<Option<Side>>,
    /// By number of good vertices less one: who is on which side. The surest go first.
    marks: [VecDeque<(TetId, Side)>; 3],
    /// Facets through which outside may enter a tetrahedron, seen from the tetrahedron.
    doors: BinaryHeap<Door>,
}

/// A facet without good vertices that an unmarked tetrahedron has on the outside.
struct Door {
    circumradius: f64,
    into: FacetId,
}

impl Marking<'_> {
    fn of(canonical: &Canonical, surface: &FacetSet, good: &[bool]) -> Vec<Side> {
        let mut marking = Marking {
            canonical,
            surface,
            good,
            sides: vec![None; canonical.tets().len()],
            marks: Default::default(),
            doors: BinaryHeap::new(),
        };
        for infinite in canonical.finite_count()..canonical.tets().len() {
            marking.sides[infinite] = Some(Side::Outside);
        }
        for infinite in canonical.finite_count()..canonical.tets().len() {
            marking.spread_from(TetId::new(infinite), Side::Outside);
        }
        marking.mark();
        while let Some(door) = marking.doors.pop() {
            let tet = door.into.tet();
            if marking.sides[tet.index()].is_none() && !marking.is_smallest(door.into) {
                marking.set(tet, Side::Outside);
                marking.mark();
            }
        }
        let unreached = |side: Option<Side>| side.unwrap_or(Side::Inside);
        marking.sides.into_iter().map(unreached).collect()
    }

    fn mark(&mut self) {
        while let Some((tet, side)) = self.marks.iter_mut().rev().find_map(VecDeque::pop_front) {
            if self.sides[tet.index()].is_none() {
                self.set(tet, side);
            }
        }
    }

    fn set(&mut self, tet: TetId, side: Side) {
        self.sides[tet.index()] = Some(side);
        self.spread_from(tet, side);
    }

    /// What the side of `tet` says of its neighbours.
    fn spread_from(&mut self, tet: TetId, side: Side) {
        for (corner, twin) in self.canonical.twins(tet).into_iter().enumerate() {
            if self.sides[twin.tet().index()].is_some() {
                continue;
            }
            let facet = FacetId::of(tet, corner);
            let vertices = self.canonical.facet(facet);
            let is_good = |v: &&pellicle_geometry::VertexId| {
                **v != Canonical::INFINITE && self.good[v.index()]
            };
            let neighbor_side = match self.surface.contains(facet) {
                true => side.opposite(),
                false => side,
            };
            match vertices.iter().filter(is_good).count() {
                0 if side == Side::Outside => self.doors.push(Door {
                    circumradius: self.circumradius(facet),
                    into: twin,
                }),
                0 => {}
                count => self.marks[count - 1].push_back((twin.tet(), neighbor_side)),
            }
        }
    }

    /// Whether no facet of the tetrahedron has a smaller circumcircle.
    fn is_smallest(&self, facet: FacetId) -> bool {
        let others = (0..4).map(|corner| FacetId::of(facet.tet(), corner));
        let smallest = others
            .map(|other| (self.circumradius(other), other))
            .min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        smallest.is_some_and(|(_, smallest)| smallest == facet)
    }

    fn circumradius(&self, facet: FacetId) -> f64 {
        let [a, b, c] = self.canonical.facet(facet).map(|v| self.canonical.point(v));
        let product = a.distance(b) * b.distance(c) * c.distance(a);
        product / (4.0 * triangle::area(a, b, c))
    }
}

impl PartialEq for Door {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Door {}

impl PartialOrd for Door {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Door {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        let by_width = self.circumradius.total_cmp(&other.circumradius);
        by_width.then(self.into.cmp(&other.into))
    }
}
