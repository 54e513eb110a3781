//! Triangulations of the plane, small enough to be searched whole: what the slides' algorithms work on.
//!
//! A triangle is three indices of points, counter-clockwise, the smallest first. The conflict test of an insertion is the
//! caller's, so that it may be wrong; where things really are, exact signs tell.

use pellicle::glam::DVec2;
use pellicle::predicates::{Sign, lifted, orient2d};
use std::collections::BTreeMap;

/// Three indices of points, counter-clockwise, the smallest first.
pub(super) type Triangle = [usize; 3];

/// What an insertion is about to replace.
pub(super) struct Cavity {
    /// The triangles in conflict, that of the new point first.
    pub region: Vec<Triangle>,
    /// The edges of which one side is in conflict, the region on their left.
    pub boundary: Vec<[usize; 2]>,
    /// What is wrong with it.
    pub defect: Option<Defect>,
}

/// Why a cavity cannot be filled from the new point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Defect {
    /// The boundary is not one closed line: there is a hole, or another part, or nothing at all.
    NotADisc,
    /// An edge of the boundary does not have the new point on its left.
    NotStarShaped,
}

/// A triangulation of a set of points whose first three are the corners of a triangle around all others.
#[derive(Clone)]
pub(super) struct Planar {
    pub triangles: Vec<Triangle>,
}

/// The triangle with its smallest corner first.
pub(super) fn canonical([a, b, c]: Triangle) -> Triangle {
    match a.min(b).min(c) {
        least if least == a => [a, b, c],
        least if least == b => [b, c, a],
        _ => [c, a, b],
    }
}

pub(super) fn edges([a, b, c]: Triangle) -> [[usize; 2]; 3] {
    [[a, b], [b, c], [c, a]]
}

impl Planar {
    /// The triangle of the first three points, which must turn counter-clockwise.
    pub fn new() -> Self {
        Self {
            triangles: vec![[0, 1, 2]],
        }
    }

    /// The Delaunay triangulation, ties broken in the lifted dimension.
    pub fn delaunay(points: &[DVec2]) -> Self {
        let mut planar = Self::new();
        for new in 3..points.len() {
            let cavity = planar.cavity(points, new, |t| is_inside(points, t, new));
            planar.fill(&cavity, new);
        }
        planar
    }

    /// The triangles that hold a point, borders included.
    pub fn holding(&self, points: &[DVec2], at: DVec2) -> impl Iterator<Item = Triangle> {
        let holds = move |t: &&Triangle| {
            edges(**t)
                .iter()
                .all(|&[a, b]| orient2d(points[a], points[b], at) != Sign::Negative)
        };
        self.triangles.iter().filter(holds).copied()
    }

    /// From each directed edge to the triangle on its left.
    pub fn sides(&self) -> BTreeMap<[usize; 2], Triangle> {
        let sides = |&t: &Triangle| edges(t).map(|edge| (edge, t));
        self.triangles.iter().flat_map(sides).collect()
    }

    /// The triangles in conflict with the point `new`, from the one that holds it over edges; the caller says which are.
    pub fn cavity(
        &self,
        points: &[DVec2],
        new: usize,
        mut in_conflict: impl FnMut(Triangle) -> bool,
    ) -> Cavity {
        let sides = self.sides();
        let mut region: Vec<Triangle> = self.holding(points, points[new]).take(1).collect();
        // Each triangle is asked once.
        let mut asked: BTreeMap<Triangle, bool> = region.iter().map(|&t| (t, true)).collect();
        let mut boundary = Vec::new();
        let mut next = 0;
        while next < region.len() {
            for [a, b] in edges(region[next]) {
                let beyond = sides.get(&[b, a]).copied();
                let joins = beyond.is_some_and(|t| {
                    *asked.entry(t).or_insert_with(|| {
                        let joins = in_conflict(t);
                        if joins {
                            region.push(t);
                        }
                        joins
                    })
                });
                if !joins {
                    boundary.push([a, b]);
                }
            }
            next += 1;
        }
        let defect = defect(points, new, &boundary);
        Cavity {
            region,
            boundary,
            defect,
        }
    }

    /// All triangles in conflict, wherever they are: as from a conflict graph or a history of the triangulation.
    pub fn scattered_cavity(
        &self,
        points: &[DVec2],
        new: usize,
        mut is_in_conflict: impl FnMut(Triangle) -> bool,
    ) -> Cavity {
        let mut region = self.triangles.clone();
        region.retain(|&t| is_in_conflict(t));
        let sides = self.sides();
        let joins = |&[a, b]: &[usize; 2]| sides.get(&[b, a]).is_some_and(|t| region.contains(t));
        let all = region.iter().flat_map(|&t| edges(t));
        let boundary: Vec<[usize; 2]> = all.filter(|edge| !joins(edge)).collect();
        let defect = defect(points, new, &boundary);
        Cavity {
            region,
            boundary,
            defect,
        }
    }

    /// Replaces the region by triangles from its boundary to the new point.
    pub fn fill(&mut self, cavity: &Cavity, new: usize) {
        self.triangles.retain(|t| !cavity.region.contains(t));
        let fan = cavity.boundary.iter().map(|&[a, b]| canonical([a, b, new]));
        self.triangles.extend(fan);
        self.triangles.sort_unstable();
    }
}

/// The exact conflict test, ties broken in the lifted dimension.
pub(super) fn is_inside(points: &[DVec2], t: Triangle, new: usize) -> bool {
    let [a, b, c] = t.map(|i| points[i]);
    lifted::incircle(a, b, c, points[new]) == Sign::Positive
}

fn defect(points: &[DVec2], new: usize, boundary: &[[usize; 2]]) -> Option<Defect> {
    let next: BTreeMap<usize, usize> = boundary.iter().map(|&[a, b]| (a, b)).collect();
    // Along the boundary from its first edge, until the line closes.
    let first = boundary.first().map(|edge| edge[0]);
    let follow = |at: &usize| next.get(at).copied().filter(|&at| Some(at) != first);
    let length = std::iter::successors(first, follow)
        .take(boundary.len() + 1)
        .count();
    if boundary.is_empty() || next.len() != boundary.len() || length != boundary.len() {
        return Some(Defect::NotADisc);
    }
    let seen = |&edge: &[usize; 2]| is_seen(points, new, edge);
    (!boundary.iter().all(seen)).then_some(Defect::NotStarShaped)
}

/// Whether the new point is strictly on the left of an edge.
pub(super) fn is_seen(points: &[DVec2], new: usize, [a, b]: [usize; 2]) -> bool {
    orient2d(points[a], points[b], points[new]) == Sign::Positive
}

/// A corner triangle around the box from `center − radius` to `center + radius`, far away from it.
pub(super) fn far_corners(center: DVec2, radius: f64) -> [DVec2; 3] {
    [[-64.0, -32.0], [64.0, -32.0], [0.0, 64.0]].map(|corner| center + radius * DVec2::from(corner))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Random;

    fn cloud(seed: u64, count: usize, steps: f64) -> Vec<DVec2> {
        let mut random = Random::new(seed, 0);
        let mut points = far_corners(DVec2::splat(0.5), 0.5).to_vec();
        while points.len() < count + 3 {
            let point = DVec2::new(random.unit(), random.unit());
            // On a lattice there are many ties.
            let point = (point * steps).floor() / steps;
            if !points.contains(&point) {
                points.push(point);
            }
        }
        points
    }

    /// By the definition: the triangles whose disc is empty.
    fn by_definition(points: &[DVec2]) -> Vec<Triangle> {
        let count = points.len();
        let mut triangles = Vec::new();
        for a in 0..count {
            for b in a + 1..count {
                for c in b + 1..count {
                    let t = match orient2d(points[a], points[b], points[c]) {
                        Sign::Positive => [a, b, c],
                        Sign::Negative => [a, c, b],
                        Sign::Zero => continue,
                    };
                    let free = |i| t.contains(&i) || !is_inside(points, t, i);
                    if (0..count).all(free) {
                        triangles.push(t);
                    }
                }
            }
        }
        triangles.sort_unstable();
        triangles
    }

    #[test]
    fn insertion_gives_what_the_definition_says() {
        for seed in 0..20 {
            for steps in [4.0, 8.0, 1e6] {
                let points = cloud(seed, 14, steps);
                assert_eq!(
                    Planar::delaunay(&points).triangles,
                    by_definition(&points),
                    "{seed}"
                );
            }
        }
    }

    #[test]
    fn cavities_of_exact_signs_have_no_defect() {
        let points = cloud(1, 30, 6.0);
        let planar = Planar::delaunay(&points[..25]);
        for new in 25..points.len() {
            let cavity = planar.cavity(&points, new, |t| is_inside(&points, t, new));
            assert_eq!(cavity.defect, None);
        }
    }

    #[test]
    fn defects_are_found() {
        let points = cloud(2, 20, 1e6);
        let planar = Planar::delaunay(&points[..22]);
        // Everything in conflict but one inner triangle: a ring.
        let inner = planar
            .holding(&points, points[22])
            .next()
            .expect("a triangle");
        let other = *planar
            .triangles
            .iter()
            .find(|t| {
                t.iter()
                    .all(|&corner| corner > 2 && !inner.contains(&corner))
            })
            .expect("an inner triangle elsewhere");
        let ring = planar.cavity(&points, 22, |t| t != other);
        assert_eq!(ring.defect, Some(Defect::NotADisc));
    }
}
