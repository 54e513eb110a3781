//! The triangles cut along their intersections: pieces that meet in common corners and edges only.
//!
//! - A *piece* is a triangle of the result's material: a whole triangle of the input, or one of the constrained
//!   triangulation of a cut one.
//! - A *facet* is a set of pieces of one triangle that no constraint divides. Its sides see one winding number each.
//! - Facets of triangles in one plane that cover the same place are one, with the sum of their orientations as
//!   *multiplicity*: 2 for two equal sheets, 0 for two opposite ones.

use crate::hash::FastMap;
use crate::intersection::{Constraint, Meetings};
use crate::points::{PlaneId, Points};
use crate::triangulation::{NONE, Triangulation, next};
use crate::weld::Weld;
use pellicle_geometry::{Cancelled, DVec3, Progress, UnionFind, VertexId};
use pellicle_mesh::TriangleId;
use pellicle_predicates::Sign;
use std::cmp::Ordering;

/// A part of one triangle that no other one divides.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Facet {
    /// The triangle, of those over places.
    pub triangle: u32,
    /// By how much the winding number is greater behind the facet than in front of it.
    pub multiplicity: i32,
}

/// The cut triangles.
pub(crate) struct Arrangement {
    /// Corners, counter-clockwise seen from the front of the facet's triangle. Pieces of one facet follow each other.
    pub pieces: Vec<[VertexId; 3]>,
    /// For each piece its facet.
    pub facet_of: Vec<u32>,
    pub facets: Vec<Facet>,
    /// How many triangles were cut.
    pub cut: usize,
    /// Of triangles that overlap others in their plane: the plane's number, and whether the normal points against its
    /// main axis.
    coplanar: FastMap<u32, (u32, bool)>,
    /// The facet at the left of an edge in such a plane, seen against the main axis.
    merged: FastMap<(u32, VertexId, VertexId), u32>,
}

impl Arrangement {
    /// Cuts each triangle of the pairs along the others. Whole triangles come first, in order, then the pieces of cut
    /// ones in an order that depends on their coordinates alone.
    pub(crate) fn new(
        weld: &Weld,
        pairs: &[(TriangleId, TriangleId)],
        points: &mut Points,
        progress: &dyn Progress,
        mut visit: impl FnMut(u32, &Triangulation, &Points),
    ) -> Result<Self, Cancelled> {
        let mut is_cut = vec![false; weld.triangles.len()];
        for &(t, u) in pairs {
            is_cut[t.index()] = true;
            is_cut[u.index()] = true;
        }
        let mut this = Self {
            pieces: Vec::with_capacity(weld.triangles.len() + 8 * pairs.len()),
            facet_of: Vec::with_capacity(weld.triangles.len() + 8 * pairs.len()),
            facets: Vec::with_capacity(weld.triangles.len() + 4 * pairs.len()),
            cut: is_cut.iter().filter(|&&cut| cut).count(),
            coplanar: FastMap::default(),
            merged: FastMap::default(),
        };
        for (t, &corners) in weld.triangles.iter().enumerate() {
            if !is_cut[t] {
                this.add_facet(t as u32, [corners].into_iter());
            }
        }
        let mut meetings = Meetings::new(weld, pairs, points);
        this.coplanar = coplanar(weld, &meetings.coplanar, points);
        canonical_order(&mut meetings.constraints, weld, points);
        let by_triangle = |a: &Constraint, b: &Constraint| a.triangle == b.triangle;
        let total = this.cut as u64;
        for (done, constraints) in (meetings.constraints.chunk_by(by_triangle)).enumerate() {
            Cancelled::check(progress.step("cut", done as u64, total))?;
            let triangle = constraints[0].triangle;
            let cut = cut(weld, constraints, points);
            visit(triangle, &cut, points);
            this.add(triangle, &cut);
        }
        Ok(this)
    }

    fn add_facet(&mut self, triangle: u32, pieces: impl Iterator<Item = [VertexId; 3]>) {
        self.pieces.extend(pieces);
        self.facet_of
            .resize(self.pieces.len(), self.facets.len() as u32);
        self.facets.push(Facet {
            triangle,
            multiplicity: 1,
        });
    }

    /// Adds the facets of a cut triangle; those that are there already from another triangle of the same plane only count.
    fn add(&mut self, triangle: u32, cut: &Triangulation) {
        let plane = self.coplanar.get(&triangle).copied();
        for members in facets_of(cut) {
            if let Some((plane, reversed)) = plane {
                let border = members.iter().flat_map(|&t| border_of(cut, t));
                let mut border = border.map(|[a, b]| match reversed {
                    true => (plane, b, a),
                    false => (plane, a, b),
                });
                let Some(first) = border.next() else { continue };
                if let Some(&same) = self.merged.get(&first) {
                    let same = &mut self.facets[same as usize];
                    let agrees = self.coplanar[&same.triangle].1 == reversed;
                    same.multiplicity += if agrees { 1 } else { -1 };
                    continue;
                }
                let facet = self.facets.len() as u32;
                let border = std::iter::once(first).chain(border);
                self.merged.extend(border.map(|edge| (edge, facet)));
            }
            let corners = |&t: &u32| cut.triangles[t as usize].map(|v| cut.vertices[v as usize]);
            self.add_facet(triangle, members.iter().map(corners));
        }
    }
}

/// For each triangle that overlaps another one in its plane the number of the plane, and whether its normal points
/// against the plane's main axis.
fn coplanar(weld: &Weld, pairs: &[(u32, u32)], points: &mut Points) -> FastMap<u32, (u32, bool)> {
    let mut planes = FastMap::default();
    if pairs.is_empty() {
        return planes;
    }
    let mut groups = UnionFind::new(weld.triangles.len());
    for &(t, u) in pairs {
        groups.union(t, u);
    }
    for t in pairs.iter().flat_map(|&(t, u)| [t, u]) {
        let plane = points.plane_of_triangle(t as usize, weld);
        let plane = points.plane(plane);
        let reversed = plane.normal_sign(plane.main_axis()) == Sign::Negative;
        planes.insert(t, (groups.find(t), reversed));
    }
    planes
}

/// Sorts constraints by triangle, and in each by place, all by coordinates; each is kept once.
fn canonical_order(constraints: &mut Vec<Constraint>, weld: &Weld, points: &Points) {
    for constraint in constraints.iter_mut() {
        let [a, b] = constraint.ends;
        if points.compare_all(a, b) == Ordering::Greater {
            constraint.ends = [b, a];
        }
    }
    let corners = |t: u32| -> [[f64; 3]; 3] {
        let mut corners = weld.corners(t as usize).map(|p| (p + 0.0).to_array());
        corners.sort_by(compare_coordinates);
        corners
    };
    let mut keyed: Vec<_> = constraints
        .drain(..)
        .map(|c| (corners(c.triangle), c))
        .collect();
    keyed.sort_by(|(key, a), (other_key, b)| {
        let corners = key.iter().zip(other_key);
        corners
            .map(|(p, q)| compare_coordinates(p, q))
            .fold(Ordering::Equal, Ordering::then)
            .then(a.triangle.cmp(&b.triangle))
            .then_with(|| points.compare_all(a.ends[0], b.ends[0]))
            .then_with(|| points.compare_all(a.ends[1], b.ends[1]))
    });
    constraints.extend(keyed.into_iter().map(|(_, constraint)| constraint));
    constraints.dedup_by(|a, b| a.triangle == b.triangle && a.ends == b.ends);
}

/// By x, then y, then z.
pub(crate) fn compare_coordinates(p: &[f64; 3], q: &[f64; 3]) -> Ordering {
    let axes = p.iter().zip(q).map(|(a, b)| a.total_cmp(b));
    axes.fold(Ordering::Equal, Ordering::then)
}

/// The constrained triangulation of one triangle.
fn cut(weld: &Weld, constraints: &[Constraint], points: &mut Points) -> Triangulation {
    let triangle = constraints[0].triangle as usize;
    let plane = points.plane_of_triangle(triangle, weld);
    // From the least corner on, so that it does not matter which comes first in the input.
    let mut corners = weld.triangles[triangle];
    let least = |i: &usize| {
        let p: DVec3 = weld.positions[corners[*i].index()] + 0.0;
        p.to_array()
    };
    let start = (0..3).min_by(|i, j| compare_coordinates(&least(i), &least(j)));
    corners.rotate_left(start.unwrap_or(0));
    let mut cut = Triangulation::new(corners, plane, points);
    for constraint in constraints {
        cut.insert_segment(constraint.ends, constraint.plane, points);
    }
    cut
}

/// The triangles of a triangulation that hang together without crossing a constraint.
fn facets_of(cut: &Triangulation) -> Vec<Vec<u32>> {
    let mut facets = Vec::new();
    let mut seen = vec![false; cut.triangles.len()];
    for start in 0..cut.triangles.len() as u32 {
        if seen[start as usize] {
            continue;
        }
        seen[start as usize] = true;
        let mut members = vec![start];
        let mut done = 0;
        while let Some(&t) = members.get(done) {
            done += 1;
            for i in 0..3 {
                let across = cut.neighbors[t as usize][i];
                let is_open = cut.constraints[t as usize][i] == PlaneId::NONE;
                if is_open && across != NONE && !seen[across as usize] {
                    seen[across as usize] = true;
                    members.push(across);
                }
            }
        }
        facets.push(members);
    }
    facets
}

/// The edges of a triangle that bound its facet, at its left.
fn border_of(cut: &Triangulation, t: u32) -> impl Iterator<Item = [VertexId; 2]> + '_ {
    let corners = cut.triangles[t as usize].map(|v| cut.vertices[v as usize]);
    (0..3)
        .filter(move |&i| {
            cut.neighbors[t as usize][i] == NONE || cut.constraints[t as usize][i] != PlaneId::NONE
        })
        .map(move |i| [corners[i], corners[next(i)]])
}
