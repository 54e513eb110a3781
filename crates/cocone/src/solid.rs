//! A set of tetrahedra whose boundary is made a manifold.
//!
//! A subset of a Delaunay tetrahedralisation has a boundary that is closed, consistently oriented and free
//! of self-intersections, whatever the subset. It is an edge- and vertex-manifold exactly when around
//! each vertex the tetrahedra inside are connected through facets, and so are those outside: the star of a
//! vertex is a sphere of tetrahedra, and two connected parts of a sphere meet in one simple closed curve.
//!
//! ```text
//!      in │out         in │ in           the link of a vertex as a disk: one part each on the left,
//!      ───┼───         ───┼───           two parts outside on the right, which meet in a point (an edge
//!      in │ in         out│ out          with four facets) or not at all (a vertex with two fans)
//! ```
//!
//! So where a vertex has several parts on one side, all but the weightiest change sides. That may
//! disturb other vertices, which are looked at again. It ends: a tetrahedron leaves the inside at most
//! [`MOST_REMOVALS`] times; after that the inside only grows, and all finite tetrahedra together, the
//! convex hull, have a manifold boundary.

use crate::canonical::Canonical;
use crate::sheet::Sheet;
use crate::umbrella::Links;
use pellicle_delaunay::{FacetId, TetId};
use pellicle_geometry::VertexId;
use std::collections::BTreeSet;

/// How often a tetrahedron may be moved from inside to outside.
const MOST_REMOVALS: u8 = 2;

/// Where a tetrahedron is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Side {
    Inside,
    Outside,
}

impl Side {
    pub(crate) fn opposite(self) -> Self {
        match self {
            Self::Inside => Self::Outside,
            Self::Outside => Self::Inside,
        }
    }
}

/// A side for each tetrahedron; the infinite ones are outside.
pub(crate) struct Solid<'s> {
    canonical: &'s Canonical<'s>,
    sides: Vec<Side>,
    /// By vertex: whether what it says of its tetrahedra is trusted more.
    good: &'s [bool],
    /// By tetrahedron.
    removals: Vec<u8>,
}

/// Tetrahedra around a vertex that are on one side and connected through facets at the vertex.
struct Part {
    side: Side,
    tets: Vec<TetId>,
    /// How much speaks against moving it; infinite for one that reaches infinity.
    weight: f64,
    /// Whether all of it may leave the inside.
    removable: bool,
}

impl<'s> Solid<'s> {
    pub(crate) fn new(canonical: &'s Canonical<'s>, sides: Vec<Side>, good: &'s [bool]) -> Self {
        Self {
            canonical,
            removals: vec![0; sides.len()],
            sides,
            good,
        }
    }

    /// Moves tetrahedra until the boundary is a manifold and not empty; how many moves that took.
    pub(crate) fn make_manifold(&mut self) -> usize {
        let mut moves = 0;
        let mut pending = self.suspects();
        while let Some(vertex) = pending.pop_first() {
            for tet in self.cheapest_move(vertex) {
                moves += 1;
                self.change_side(tet);
                pending.extend(self.canonical.tets()[tet.index()]);
            }
        }
        let finite = self.canonical.finite_count();
        if !self.sides[..finite].contains(&Side::Inside) {
            // Nothing is left: the convex hull is the one solid that always is.
            self.sides[..finite].fill(Side::Inside);
            moves += finite;
        }
        moves
    }

    /// Draws the boundary to vertices whose stars lie on one side and next to it; how many moves that took.
    ///
    /// A tetrahedron at the vertex whose opposite facet is in the boundary changes sides: that puts three
    /// facets at the vertex for the one, so the boundary stays the manifold it was.
    pub(crate) fn reach(&mut self, vertices: &[VertexId]) -> usize {
        let mut moves = 0;
        for &vertex in vertices {
            let star: Vec<TetId> = self.canonical.around_vertex(vertex).collect();
            if star.iter().any(|&tet| self.side(tet) != self.side(star[0])) {
                continue;
            }
            let behind =
                |tet: TetId| self.canonical.twins(tet)[self.canonical.corner_of(tet, vertex)];
            let next_to_it = star.iter().copied().filter(|&tet| {
                self.canonical.is_finite(tet) && self.side(behind(tet).tet()) != self.side(tet)
            });
            let reach = |tet: TetId| -> f64 {
                let corners = self.canonical.tets()[tet.index()].map(|v| self.canonical.point(v));
                let point = self.canonical.point(vertex);
                corners.iter().map(|corner| corner.distance(point)).sum()
            };
            let nearest = next_to_it
                .filter(|&tet| self.is_near(tet, vertex))
                .min_by(|&a, &b| reach(a).total_cmp(&reach(b)).then(a.cmp(&b)));
            if let Some(tet) = nearest {
                moves += 1;
                self.change_side(tet);
            }
        }
        moves
    }

    /// Whether each edge at `vertex` is at most twice as long as the longest of the facet opposite: no spike.
    fn is_near(&self, tet: TetId, vertex: VertexId) -> bool {
        let facet = FacetId::of(tet, self.canonical.corner_of(tet, vertex));
        let [a, b, c] = self.canonical.facet(facet).map(|v| self.canonical.point(v));
        let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
        let point = self.canonical.point(vertex);
        [a, b, c]
            .iter()
            .all(|corner| corner.distance(point) <= 2.0 * longest)
    }

    /// The boundary, each facet as seen from outside.
    pub(crate) fn boundary(&self) -> Sheet {
        let mut sheet = Sheet::empty(self.canonical);
        for side in self.boundary_sides() {
            sheet.insert(self.canonical, side);
        }
        sheet
    }

    fn boundary_sides(&self) -> impl Iterator<Item = FacetId> + '_ {
        self.canonical.facets().filter_map(|facet| {
            let twin = self.canonical.twin(facet);
            match (self.side(facet.tet()), self.side(twin.tet())) {
                (Side::Outside, Side::Inside) => Some(facet),
                (Side::Inside, Side::Outside) => Some(twin),
                _ => None,
            }
        })
    }

    #[inline]
    fn side(&self, tet: TetId) -> Side {
        self.sides[tet.index()]
    }

    fn change_side(&mut self, tet: TetId) {
        let side = &mut self.sides[tet.index()];
        if *side == Side::Inside {
            self.removals[tet.index()] += 1;
        }
        *side = side.opposite();
    }

    /// The vertices on the boundary whose facets there form no umbrella.
    fn suspects(&self) -> BTreeSet<VertexId> {
        let triangles: Vec<_> = self
            .boundary_sides()
            .map(|side| self.canonical.facet(side))
            .collect();
        let links = Links::of(self.canonical.vertex_count(), &triangles);
        let is_suspect = |v: &VertexId| links.degree(*v) > 0 && !links.is_umbrella(*v);
        self.canonical.vertex_ids().filter(is_suspect).collect()
    }

    /// What to move so that `vertex` gets nearer to one part on each side; nothing where it has that.
    fn cheapest_move(&self, vertex: VertexId) -> Vec<TetId> {
        if vertex == Canonical::INFINITE {
            return Vec::new();
        }
        let parts = self.parts(vertex);
        let [inside, outside] = [Side::Inside, Side::Outside].map(|side| {
            let mut parts: Vec<&Part> = parts.iter().filter(|part| part.side == side).collect();
            // The weightiest stays; of equals, the first.
            let heaviest = (0..parts.len())
                .rev()
                .max_by(|&i, &j| parts[i].weight.total_cmp(&parts[j].weight));
            if let Some(heaviest) = heaviest {
                parts.remove(heaviest);
            }
            parts
        });
        let removable = inside.iter().all(|part| part.removable);
        let weight = |parts: &[&Part]| parts.iter().map(|part| part.weight).sum::<f64>();
        let chosen = match (inside.is_empty(), outside.is_empty()) {
            (true, true) => return Vec::new(),
            (false, true) if removable => inside,
            (false, true) => return self.all_outside(&parts),
            (true, false) => outside,
            (false, false) if removable && weight(&inside) < weight(&outside) => inside,
            (false, false) => outside,
        };
        chosen
            .iter()
            .flat_map(|part| part.tets.iter().copied())
            .collect()
    }

    /// Every finite tetrahedron outside: with all of its star inside, a vertex is in the interior, or on
    /// the convex hull.
    fn all_outside(&self, parts: &[Part]) -> Vec<TetId> {
        let outside = parts.iter().filter(|part| part.side == Side::Outside);
        let tets = outside.flat_map(|part| part.tets.iter().copied());
        tets.filter(|&tet| self.canonical.is_finite(tet)).collect()
    }

    /// The parts of a vertex's star, in the order of their first tetrahedra.
    fn parts(&self, vertex: VertexId) -> Vec<Part> {
        let mut star: Vec<TetId> = self.canonical.around_vertex(vertex).collect();
        star.sort_unstable();
        let mut part_of = vec![usize::MAX; star.len()];
        let mut parts = Vec::new();
        for first in 0..star.len() {
            if part_of[first] != usize::MAX {
                continue;
            }
            let mut part = Part {
                side: self.side(star[first]),
                tets: Vec::new(),
                weight: 0.0,
                removable: true,
            };
            part_of[first] = parts.len();
            let mut pending = vec![star[first]];
            while let Some(tet) = pending.pop() {
                part.weight += self.weight(tet);
                part.removable &= self.removals[tet.index()] < MOST_REMOVALS;
                part.tets.push(tet);
                for neighbor in neighbors_at(self.canonical, tet, vertex) {
                    let Ok(place) = star.binary_search(&neighbor) else {
                        continue;
                    };
                    if part_of[place] == usize::MAX && self.side(neighbor) == part.side {
                        part_of[place] = parts.len();
                        pending.push(neighbor);
                    }
                }
            }
            parts.push(part);
        }
        parts
    }

    fn weight(&self, tet: TetId) -> f64 {
        if !self.canonical.is_finite(tet) {
            return f64::INFINITY;
        }
        let corners = self.canonical.tets()[tet.index()];
        let good = corners.iter().filter(|v| self.good[v.index()]).count();
        1.0 + 2.0 * good as f64
    }
}

/// The neighbours of `tet` across the facets that hold `vertex`.
fn neighbors_at(
    canonical: &Canonical,
    tet: TetId,
    vertex: VertexId,
) -> impl Iterator<Item = TetId> + use<> {
    let own = canonical.corner_of(tet, vertex);
    let twins = canonical.twins(tet);
    (0..4)
        .filter(move |&corner| corner != own)
        .map(move |corner| twins[corner].tet())
}
