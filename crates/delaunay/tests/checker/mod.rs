//! An exact checker of Delaunay tetrahedralisations that shares no code with the library.
//!
//! It takes arrays, not the library's types, and decides every sign by its own means (`numbers.rs`). What it finds to be
//! sound is the Delaunay tetrahedralisation, by this chain:
//!
//! 1. Twins are an involution, and a facet and its twin have the same corners in opposite order. So the boundary of the sum of
//!    all finite tetrahedra is the sum of the hull's facets, which close.
//! 2. All facets of the hull turn the same way around a point inside, and a ray from there meets one of them. So, seen from
//!    there, they cover each direction once. Where two of them meet, the hull is convex; so it is the boundary of a convex
//!    body, and being convex with all vertices used, of the convex hull.
//! 3. Every finite tetrahedron is positive. Their sum covers each place once inside (the winding number of its boundary) and
//!    not at all outside, so they tile the hull. The sum of their volumes is that of the hull, exactly.
//! 4. No vertex beyond a facet lies inside the facet's sphere, ties told apart by the perturbation. So the lifted surface is
//!    convex at each facet, hence convex: the tetrahedralisation is the Delaunay one, and there is but one.
//! 5. Each distinct point is a vertex, under the lowest id of its equals.
//!
//! *Ties*: the lift of a point is raised by an infinitesimal, infinitely larger for a point that is lexicographically larger.
#![allow(dead_code)] // tests and the example use a part each

mod numbers;

use numbers::{Big, Integers, Signs, det3, difference};
use rayon::prelude::*;
use std::cmp::Ordering;

/// The id of the vertex at infinity.
pub const INFINITE: u32 = u32::MAX;

/// What is claimed to be a Delaunay tetrahedralisation.
pub struct Claim<'a> {
    pub points: &'a [[f64; 3]],
    /// Four corners each: first the finite ones, positive (a right-handed frame at the first corner); then those with
    /// [`INFINITE`] as their last corner, whose other three are a facet of the hull, counter-clockwise from outside.
    pub tets: &'a [[u32; 4]],
    /// By tetrahedron and corner: 4 × the tetrahedron beyond the facet opposite the corner, plus the corner opposite there.
    pub twins: &'a [[u32; 4]],
    pub finite: usize,
}

/// Something wrong.
#[derive(Clone, Debug, PartialEq)]
pub enum Defect {
    /// Corners or twins out of range, repeated, or infinite at the wrong place.
    Corners { tet: usize },
    /// Not an involution, or other corners, or the same way around.
    Twin { tet: usize, corner: usize },
    /// A finite tetrahedron is flat or negative.
    Orientation { tet: usize },
    /// A vertex beyond a facet lies inside the sphere.
    NotDelaunay { tet: usize, corner: usize },
    /// The hull is not convex there.
    NotConvex { tet: usize, corner: usize },
    /// A facet of the hull does not turn around the point inside.
    Hull { tet: usize },
    /// So many facets of the hull meet a ray from inside.
    Covering { facets: usize },
    /// The volumes are not that of the hull.
    Volume,
    /// A point is not a vertex though none of its equals is, or is one beside its equal.
    Use { point: usize },
    /// The fast way to a sign and the long one disagree: the checker is wrong.
    Checker { tet: usize },
}

/// What was looked at.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Looked {
    pub finite: usize,
    pub hull_facets: usize,
    pub vertices: usize,
    /// In-sphere tests, and how many of them were ties.
    pub spheres: usize,
    pub ties: usize,
    /// Tests that were done again in big integers.
    pub repeated: usize,
}

/// One facet in so many is decided again by big integers.
const REPEAT_ONE_IN: usize = 1009;

/// Corners of the facet opposite corner i, counter-clockwise seen from there when the tetrahedron is positive.
const FACETS: [[usize; 3]; 4] = [[1, 3, 2], [0, 2, 3], [0, 3, 1], [0, 1, 2]];

impl Claim<'_> {
    /// All defects; or what was looked at.
    pub fn check(&self) -> Result<Looked, Vec<Defect>> {
        let sound = |defects: Vec<Defect>| match defects.is_empty() {
            true => Ok(()),
            false => Err(defects),
        };
        // What follows could not be asked if ids were out of range or twins were not twins.
        sound(self.corners())?;
        sound(self.twins_match())?;
        let signs = Signs::of(self.points);
        let big = Integers::<Big>::of(self.points);
        sound(self.orientations(&signs))?;
        let mut defects = self.uses();
        let looked = self.locally(&signs, &big, &mut defects);
        defects.extend(self.hull(&big));
        if self.volume(&big) != self.hull_volume(&big) {
            defects.push(Defect::Volume);
        }
        sound(defects)?;
        Ok(Looked {
            finite: self.finite,
            hull_facets: self.tets.len() - self.finite,
            ..looked
        })
    }

    fn corners(&self) -> Vec<Defect> {
        let count = self.tets.len();
        let sound = |t: usize| {
            let tet = self.tets[t];
            let infinite = t >= self.finite;
            let in_range = tet[..3].iter().all(|&v| (v as usize) < self.points.len())
                && match infinite {
                    true => tet[3] == INFINITE,
                    false => (tet[3] as usize) < self.points.len(),
                };
            let distinct = (0..4).all(|i| (0..i).all(|j| tet[i] != tet[j]));
            in_range && distinct && self.twins[t].iter().all(|&twin| twin as usize / 4 < count)
        };
        if self.twins.len() != count || !(1..count).contains(&self.finite) {
            return vec![Defect::Corners { tet: count }];
        }
        find(0..count, |t| {
            (!sound(t)).then_some(Defect::Corners { tet: t })
        })
    }

    fn facet(&self, tet: usize, corner: usize) -> [u32; 3] {
        FACETS[corner].map(|i| self.tets[tet][i])
    }

    fn twin(&self, tet: usize, corner: usize) -> (usize, usize) {
        let twin = self.twins[tet][corner] as usize;
        (twin / 4, twin % 4)
    }

    fn twins_match(&self) -> Vec<Defect> {
        find(0..4 * self.tets.len(), |facet| {
            let (tet, corner) = (facet / 4, facet % 4);
            let (other, there) = self.twin(tet, corner);
            let [a, b, c] = self.facet(tet, corner);
            let turned = [[a, c, b], [c, b, a], [b, a, c]];
            let sound = other != tet
                && self.twin(other, there) == (tet, corner)
                && turned.contains(&self.facet(other, there));
            (!sound).then_some(Defect::Twin { tet, corner })
        })
    }

    fn orientations(&self, signs: &Signs) -> Vec<Defect> {
        find(0..self.finite, |tet| {
            let positive = signs.orientation(self.tets[tet]) == Ordering::Greater;
            (!positive).then_some(Defect::Orientation { tet })
        })
    }

    /// Each distinct point is a vertex, under its lowest id.
    fn uses(&self) -> Vec<Defect> {
        let mut used = vec![false; self.points.len()];
        for &v in self.tets[..self.finite].iter().flatten() {
            used[v as usize] = true;
        }
        let mut order: Vec<usize> = (0..self.points.len()).collect();
        order.par_sort_unstable_by(|&i, &j| {
            lexicographic(self.points[i], self.points[j]).then(i.cmp(&j))
        });
        let equal = |i: usize, j: usize| self.points[i] == self.points[j];
        find(0..order.len(), |place| {
            let is_first = place == 0 || !equal(order[place - 1], order[place]);
            let point = order[place];
            (used[point] != is_first).then_some(Defect::Use { point })
        })
    }

    /// Every facet between two finite tetrahedra, and every edge of the hull.
    fn locally(&self, signs: &Signs, big: &Integers<Big>, defects: &mut Vec<Defect>) -> Looked {
        let one = |facet: usize| {
            let (tet, corner) = (facet / 4, facet % 4);
            let (other, there) = self.twin(tet, corner);
            let beyond = self.tets[other][there];
            let mut looked = Looked::default();
            if other < tet || beyond == INFINITE || tet < self.finite && other >= self.finite {
                return (looked, Vec::new());
            }
            let repeat = facet.is_multiple_of(REPEAT_ONE_IN);
            looked.repeated = usize::from(repeat);
            let mut defects = Vec::new();
            let mut sphere = |of: usize| {
                let corners = self.tets[of];
                let sign = signs.sphere(corners, beyond);
                looked.spheres += 1;
                looked.ties += usize::from(sign == Ordering::Equal);
                if repeat && big.sphere(corners, beyond) != sign {
                    defects.push(Defect::Checker { tet: of });
                }
                match sign {
                    Ordering::Equal => self.raised_inside(signs, corners, beyond),
                    sign => sign == Ordering::Greater,
                }
            };
            if tet < self.finite {
                if sphere(tet) {
                    defects.push(Defect::NotDelaunay { tet, corner });
                }
                return (looked, defects);
            }
            // Two facets of the hull, which meet at an edge.
            let [a, b, c, _] = self.tets[tet];
            let outside = signs.orientation([a, b, c, beyond]);
            let is_repeated = repeat && big.orientation([a, b, c, beyond]) != outside;
            // In one plane the circle of the facet decides, in which the sphere behind it cuts the plane.
            let inside = outside == Ordering::Equal && sphere(self.twin(tet, 3).0);
            if is_repeated {
                defects.push(Defect::Checker { tet });
            }
            if outside == Ordering::Greater {
                defects.push(Defect::NotConvex { tet, corner });
            }
            if inside {
                defects.push(Defect::NotDelaunay { tet, corner });
            }
            (looked, defects)
        };
        let (looked, found) = (0..4 * self.tets.len())
            .into_par_iter()
            .with_min_len(4096)
            .fold(
                || (Looked::default(), Vec::new()),
                |(all, mut defects), facet| {
                    let (looked, found) = one(facet);
                    defects.extend(found);
                    (all.and(&looked), defects)
                },
            )
            .reduce(
                || (Looked::default(), Vec::new()),
                |(one, mut defects), (other, found)| {
                    defects.extend(found);
                    (one.and(&other), defects)
                },
            );
        defects.extend(found);
        let mut vertices = self.tets[..self.finite].as_flattened().to_vec();
        vertices.par_sort_unstable();
        vertices.dedup();
        Looked {
            vertices: vertices.len(),
            ..looked
        }
    }

    /// Whether a point on the sphere of a tetrahedron is inside once the lifts are raised.
    ///
    /// Let λᵢ be the barycentric coordinates of the point, and δ what each lift is raised by. The point is inside when its lift
    /// is below the hyperplane through the corners' lifts: Σ λᵢ δᵢ − δ > 0. The largest δ that has a factor decides; the sign
    /// of λᵢ is that of the tetrahedron with the point in the place of corner i.
    fn raised_inside(&self, signs: &Signs, corners: [u32; 4], point: u32) -> bool {
        let mut order = [0, 1, 2, 3, 4];
        let at = |i: usize| if i < 4 { corners[i] } else { point };
        order.sort_unstable_by(|&i, &j| {
            lexicographic(self.points[at(j) as usize], self.points[at(i) as usize])
        });
        for i in order {
            if i == 4 {
                return false;
            }
            let mut replaced = corners;
            replaced[i] = point;
            match signs.orientation(replaced) {
                Ordering::Equal => {}
                sign => return sign == Ordering::Greater,
            }
        }
        unreachable!("the point itself is among the five")
    }

    /// Whether the facets of the hull cover the directions from a point inside once.
    fn hull(&self, big: &Integers<Big>) -> Vec<Defect> {
        // Four times the place, so that the barycentre of the first tetrahedron has integer coordinates.
        let four = Big::from(4);
        let inside: [Big; 3] = std::array::from_fn(|axis| {
            let corners = self.tets[0].iter().map(|&v| &big.points[v as usize][axis]);
            corners.fold(Big::ZERO, |sum, coordinate| sum + coordinate)
        });
        let from_inside = |v: u32| -> [Big; 3] {
            std::array::from_fn(|axis| &big.points[v as usize][axis] * &four - &inside[axis])
        };
        let hull = self.finite..self.tets.len();
        let turned = find(hull.clone(), |tet| {
            let [a, b, c, _] = self.tets[tet];
            let sign = det3(&from_inside(a), &from_inside(b), &from_inside(c)).cmp(&Big::ZERO);
            (sign != Ordering::Greater).then_some(Defect::Hull { tet })
        });
        if !turned.is_empty() {
            return turned;
        }
        for attempt in 1_i32.. {
            let ray = [
                7919 * attempt,
                1 - 104_729 * attempt,
                15_485_863 % (attempt + 91),
            ]
            .map(Big::from);
            let met: Vec<bool> = hull
                .clone()
                .into_par_iter()
                .filter_map(|tet| {
                    let [a, b, c] = [0, 1, 2].map(|i| from_inside(self.tets[tet][i]));
                    let least = [(&a, &b), (&b, &c), (&c, &a)]
                        .map(|(p, q)| det3(p, q, &ray).cmp(&Big::ZERO))
                        .into_iter()
                        .min();
                    // Equal: the ray meets an edge.
                    (least != Some(Ordering::Less)).then_some(least == Some(Ordering::Greater))
                })
                .collect();
            if met.iter().all(|&within| within) {
                let facets = met.len();
                return match facets {
                    1 => Vec::new(),
                    _ => vec![Defect::Covering { facets }],
                };
            }
        }
        unreachable!("finitely many rays through edges")
    }

    /// Six times the volume of all tetrahedra.
    fn volume(&self, big: &Integers<Big>) -> Big {
        self.tets[..self.finite]
            .par_iter()
            .with_min_len(4096)
            .map(|tet| {
                let [a, b, c, d] = tet.map(|v| &big.points[v as usize]);
                det3(&difference(b, a), &difference(c, a), &difference(d, a))
            })
            .reduce(|| Big::ZERO, |one, other| one + other)
    }

    /// Six times the volume that the hull's facets bound.
    fn hull_volume(&self, big: &Integers<Big>) -> Big {
        self.tets[self.finite..]
            .par_iter()
            .map(|&[a, b, c, _]| {
                let [a, b, c] = [a, b, c].map(|v| &big.points[v as usize]);
                det3(a, b, c)
            })
            .reduce(|| Big::ZERO, |one, other| one + other)
    }
}

impl Looked {
    fn and(&self, other: &Self) -> Self {
        Self {
            spheres: self.spheres + other.spheres,
            ties: self.ties + other.ties,
            repeated: self.repeated + other.repeated,
            ..Self::default()
        }
    }
}

fn find(
    range: std::ops::Range<usize>,
    defect: impl Fn(usize) -> Option<Defect> + Sync + Send,
) -> Vec<Defect> {
    range.into_par_iter().filter_map(defect).collect()
}

/// By x, then y, then z; −0 equals 0.
fn lexicographic(p: [f64; 3], q: [f64; 3]) -> Ordering {
    p.partial_cmp(&q).expect("finite coordinates compare")
}
