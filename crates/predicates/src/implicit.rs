//! Points that are intersections of lines and planes through given points, exactly: where doubles can only
//! be near.
//!
//! The data are a [`Plane`] through three points, a [`Point`], which may be given or constructed, and the
//! [`Lattice`] that the coordinates of the input lie on. The verbs construct a point
//! ([`Lattice::line_plane`], [`Lattice::three_planes`], [`Lattice::centroid`]) or decide something about
//! points ([`Lattice::compare`], [`Lattice::orient2d`], [`Lattice::side`], [`Lattice::orient3d`]).
//!
//! ```
//! use glam::DVec3;
//! use pellicle_predicates::{Sign, implicit::Lattice};
//!
//! let [origin, x, y, z] = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
//! let lattice = Lattice::of([origin, x, y, z]);
//! let slope = lattice.plane(x, y, z);
//! // The diagonal meets the plane x + y + z = 1 where no double is.
//! let p = lattice.line_plane(origin, DVec3::ONE, &slope).unwrap();
//! assert!(!p.is_exact());
//! assert_eq!(p.rounded(), DVec3::splat(1.0 / 3.0));
//! // It is on the plane nevertheless, and the same point however it is made.
//! assert_eq!(lattice.side(&slope, &p), Sign::Zero);
//! let [f, g] = [lattice.plane(origin, x, DVec3::ONE), lattice.plane(origin, y, DVec3::ONE)];
//! let q = lattice.three_planes(&f, &g, &slope).unwrap();
//! assert!(lattice.equal(&p, &q));
//! ```
//!
//! # How it works
//!
//! *Exact at once.* Attene 2020 keeps with each implicit point what it is made of, and evaluates predicates
//! from there. Here its homogeneous coordinates (X, Y, Z, W), W > 0, are computed when it is made, as exact
//! numbers, and from them the nearest doubles (X/W, Y/W, Z/W), correctly rounded. A point that is its
//! rounded self keeps nothing else. So equal points have equal doubles, most comparisons are comparisons of
//! doubles, and a predicate is evaluated exactly from four numbers a point, whatever made it.
//!
//! *Filters.* All predicates try the rounded coordinates first, whose errors are half a unit in the last
//! place; the bounds stand beside the functions.
//!
//! *Sizes.* For coordinates of B bits above the lattice's unit, normals have 2B + 3 bits, the W and X of a
//! line with a plane 3B and 4B, of three planes 6B and 7B, the determinant of three such points 20B. The
//! numbers are sums of products, without heap memory up to 512 bits; no width is too large for them.
//!
//! Coordinates must be finite: with NaN or infinity no result means anything (there is no panic). An axis is
//! 0, 1 or 2, and counts modulo three.

mod dyadic;
mod rounding;

use crate::{Sign, determinant, integer::Parts, interval::Interval};
use dyadic::{Dyadic, Packed, View, cross, dot, sum, views};
use glam::{DVec2, DVec3};
use rounding::Divisor;
use std::{array::from_fn, cmp::Ordering};

/// u: the largest relative error of one operation in doubles, and of rounding to one.
const UNIT_ROUNDOFF: f64 = f64::EPSILON / 2.0;

/// A power of two of which all coordinates of the input are multiples.
///
/// Only the speed depends on it: coordinates of a small multiple of the unit make short numbers. Points off
/// the lattice are treated as exactly as those on it, but objects made with one lattice must not be mixed
/// with those of another.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Lattice {
    /// The unit is 2^exponent.
    exponent: i32,
}

/// A plane n · x = offset through points of the input, with its side n · x > offset above it.
#[derive(Clone, Debug)]
pub struct Plane {
    /// n times a power of two, to within a relative u; the largest component in [1, 2]. NaN where the
    /// components are too different for the filters.
    normal: DVec3,
    /// A point on the plane.
    through: DVec3,
    /// n and the offset, in lattice units.
    exact: Packed,
}

/// A point of space: given in doubles, or constructed and exact beyond them.
#[derive(Clone, Debug)]
pub struct Point {
    rounded: DVec3,
    /// X, Y, Z and W > 0 with the position (X, Y, Z) / W in lattice units, if that is not `rounded`.
    exact: Option<Packed>,
}

impl Lattice {
    /// The lattice of the largest unit that divides all coordinates; O(n).
    ///
    /// Any unit would do for the results. If all coordinates are zero, it is one.
    pub fn of(points: impl IntoIterator<Item = DVec3>) -> Self {
        let coordinates = points.into_iter().flat_map(|point| point.to_array());
        let parts = coordinates.map(Parts::of).filter(|p| p.mantissa != 0);
        Self {
            exponent: parts.map(|part| part.exponent).min().unwrap_or(0),
        }
    }

    fn coordinates(&self, point: DVec3) -> [Dyadic; 3] {
        point.to_array().map(|c| Dyadic::of(c, self.exponent))
    }

    /// to − from.
    fn difference(&self, to: DVec3, from: DVec3) -> [Dyadic; 3] {
        from_fn(|k| Dyadic::difference(to[k], from[k], self.exponent))
    }

    /// The plane through three points, n = (b − a) × (c − a): `a, b, c` turn counter-clockwise seen from
    /// above. [Degenerate](Plane::is_degenerate) if they are collinear.
    pub fn plane(&self, a: DVec3, b: DVec3, c: DVec3) -> Plane {
        let (u, v) = (self.difference(b, a), self.difference(c, a));
        self.plane_through(a, cross(views(&u), views(&v)))
    }

    /// The plane that holds the line `ab` and is parallel to a coordinate axis, n = (b − a) × e_axis.
    /// [Degenerate](Plane::is_degenerate) if the line is parallel to that axis.
    pub fn edge_plane(&self, a: DVec3, b: DVec3, axis: usize) -> Plane {
        let [i, j] = others(axis);
        let zero = || Dyadic::new(false, 0, 0);
        let mut normal = [zero(), zero(), zero()];
        normal[i] = Dyadic::difference(b[j], a[j], self.exponent);
        normal[j] = Dyadic::difference(a[i], b[i], self.exponent);
        self.plane_through(a, normal)
    }

    fn plane_through(&self, a: DVec3, normal: [Dyadic; 3]) -> Plane {
        let n = views(&normal);
        let offset = dot(n, views(&self.coordinates(a)));
        Plane {
            normal: scaled_to_doubles(n),
            through: a,
            exact: Packed::new([n[0], n[1], n[2], offset.view()]),
        }
    }

    /// Where the line `pq` meets a plane; `None` if it is parallel to it or no line.
    ///
    /// ```text
    /// W = n · (q − p)     X = W p + (offset − n · p) (q − p)
    /// ```
    pub fn line_plane(&self, p: DVec3, q: DVec3, plane: &Plane) -> Option<Point> {
        let (n, offset) = plane.views();
        let (start, direction) = (self.coordinates(p), self.difference(q, p));
        let (p, d) = (views(&start), views(&direction));
        let w = dot(n, d);
        if w.sign() == Sign::Zero {
            return None;
        }
        let rest = sum([
            (offset, View::ONE),
            (-n[0], p[0]),
            (-n[1], p[1]),
            (-n[2], p[2]),
        ]);
        let x = from_fn(|k| sum([(w.view(), p[k]), (rest.view(), d[k])]));
        self.point(&x, &w)
    }

    /// Where three planes meet; `None` if that is not one point.
    ///
    /// ```text
    /// W = f · (g × h)     X = f₀ (g × h) + g₀ (h × f) + h₀ (f × g)     with the normals f, g, h and
    ///                                                                   the offsets f₀, g₀, h₀
    /// ```
    pub fn three_planes(&self, f: &Plane, g: &Plane, h: &Plane) -> Option<Point> {
        let [(f, f0), (g, g0), (h, h0)] = [f, g, h].map(Plane::views);
        let gh = cross(g, h);
        let gh = views(&gh);
        let w = dot(f, gh);
        if w.sign() == Sign::Zero {
            return None;
        }
        let (hf, fg) = (cross(h, f), cross(f, g));
        let (hf, fg) = (views(&hf), views(&fg));
        let x = from_fn(|k| sum([(f0, gh[k]), (g0, hf[k]), (h0, fg[k])]));
        self.point(&x, &w)
    }

    /// The centroid of three points.
    ///
    /// ```text
    /// W = 3 Wa Wb Wc     X = Xa Wb Wc + Xb Wc Wa + Xc Wa Wb
    /// ```
    pub fn centroid(&self, corners: [&Point; 3]) -> Point {
        let homogeneous = corners.map(|corner| self.homogeneous(corner));
        let [a, b, c] = homogeneous.each_ref().map(Homogeneous::views);
        let product = |x, y| sum([(x, y)]);
        let weights = [
            product(b[3], c[3]),
            product(c[3], a[3]),
            product(a[3], b[3]),
        ];
        let weight = views(&weights);
        let x = from_fn(|k| sum([(a[k], weight[0]), (b[k], weight[1]), (c[k], weight[2])]));
        let three = Dyadic::new(false, 3, 0);
        let product = product(a[3], weight[0]);
        let w = sum([(product.view(), three.view())]);
        self.point(&x, &w).unwrap_or(Point::exactly(DVec3::ZERO))
    }

    /// The point of these homogeneous coordinates, if w is not zero.
    fn point(&self, x: &[Dyadic; 3], w: &Dyadic) -> Option<Point> {
        let mut x = views(x);
        match w.sign() {
            Sign::Zero => return None,
            Sign::Positive => {}
            Sign::Negative => x = x.map(|x| -x),
        }
        let w = w.view().magnitude();
        let divisor = Divisor::new(w);
        let rounded = x.map(|x| divisor.quotient(x, self.exponent));
        let is_exact = rounded.iter().all(|coordinate| coordinate.is_exact);
        Some(Point {
            rounded: DVec3::from_array(rounded.map(|coordinate| coordinate.value)),
            exact: (!is_exact).then(|| Packed::new([x[0], x[1], x[2], w])),
        })
    }

    fn homogeneous<'a>(&self, point: &'a Point) -> Homogeneous<'a> {
        match &point.exact {
            Some(packed) => Homogeneous::Constructed(packed),
            None => Homogeneous::Given(self.coordinates(point.rounded)),
        }
    }

    /// Compares one coordinate of two points.
    ///
    /// Rounding is monotone, so rounded coordinates decide when they differ.
    #[inline]
    pub fn compare(&self, p: &Point, q: &Point, axis: usize) -> Ordering {
        let axis = axis % 3;
        match p.rounded[axis].partial_cmp(&q.rounded[axis]) {
            Some(Ordering::Equal) | None if !(p.is_exact() && q.is_exact()) => {
                self.compare_exactly(p, q, axis)
            }
            order => order.unwrap_or(Ordering::Equal),
        }
    }

    #[cold]
    #[inline(never)]
    fn compare_exactly(&self, p: &Point, q: &Point, axis: usize) -> Ordering {
        let (p, q) = (self.homogeneous(p), self.homogeneous(q));
        let (p, q) = (p.views(), q.views());
        let difference = sum([(p[axis], q[3]), (-q[axis], p[3])]);
        difference.sign().cmp(&Sign::Zero)
    }

    /// Whether two points are one.
    #[inline]
    pub fn equal(&self, p: &Point, q: &Point) -> bool {
        // A point that is exact is never like one that is not.
        p.rounded == q.rounded
            && p.is_exact() == q.is_exact()
            && (p.is_exact() || (0..3).all(|k| self.compare_exactly(p, q, k).is_eq()))
    }

    /// The orientation of three points seen along a coordinate axis, that is of their (y, z) for axis 0,
    /// (z, x) for axis 1 and (x, y) for axis 2: positive when `a, b, c` turn counter-clockwise for a viewer
    /// to whom that axis points.
    #[inline]
    pub fn orient2d(&self, axis: usize, a: &Point, b: &Point, c: &Point) -> Sign {
        let [i, j] = others(axis);
        let [p, q, r] = [a, b, c].map(|p| DVec2::new(p.rounded[i], p.rounded[j]));
        if a.is_exact() && b.is_exact() && c.is_exact() {
            return crate::orient2d(p, q, r);
        }
        filtered_orient2d(p, q, r).unwrap_or_else(|| self.orient2d_exactly([i, j], [a, b, c]))
    }

    /// The determinant of the rows (X, Y, W), whose W are positive.
    #[cold]
    #[inline(never)]
    fn orient2d_exactly(&self, [i, j]: [usize; 2], points: [&Point; 3]) -> Sign {
        let homogeneous = points.map(|point| self.homogeneous(point));
        let rows = homogeneous.each_ref().map(|row| {
            let row = row.views();
            [row[i], row[j], row[3]]
        });
        let [a, b, c] = rows;
        dyadic::determinant(a, b, c).sign()
    }

    /// On which side of a plane a point lies: the sign of n · p − offset.
    ///
    /// The filter evaluates n · (p − a) for a point a of the plane. With u the unit roundoff, each n has a
    /// relative error u from rounding, each difference and product one more, and two additions follow:
    /// together less than 6u Σ |n (p − a)|. If p is not exact, its errors u |p| add u Σ |n| |p|. What
    /// underflows is less than 2⁻¹⁰⁶⁰ in sum, the components of n being at least 2⁻⁹⁰⁰ (or zero) and at
    /// most 2.
    #[inline]
    pub fn side(&self, plane: &Plane, p: &Point) -> Sign {
        let (n, d) = (plane.normal, p.rounded - plane.through);
        let value = n.dot(d);
        let mut bound = 6.02 * n.abs().dot(d.abs());
        if !p.is_exact() {
            bound += 1.02 * n.abs().dot(p.rounded.abs());
        }
        certain(value, bound * UNIT_ROUNDOFF + UNDERFLOW)
            .unwrap_or_else(|| self.side_exactly(plane, p))
    }

    #[cold]
    #[inline(never)]
    fn side_exactly(&self, plane: &Plane, p: &Point) -> Sign {
        let ([a, b, c], offset) = plane.views();
        let p = self.homogeneous(p);
        let [x, y, z, w] = p.views();
        sum([(a, x), (b, y), (c, z), (-offset, w)]).sign()
    }

    /// The sign of det[b − a, c − a, d − a], as [`crate::orient3d`].
    pub fn orient3d(&self, a: &Point, b: &Point, c: &Point, d: &Point) -> Sign {
        let points = [a, b, c, d];
        let [p, q, r, s] = points.map(|point| point.rounded);
        if points.iter().all(|point| point.is_exact()) {
            return crate::orient3d(p, q, r, s);
        }
        let [a, b, c, d] = points.map(Point::intervals);
        let [a, b, c] = [a, b, c].map(|p| determinant::translated(&p, &d));
        let sign = determinant::orient3d(&a, &b, &c).sign();
        sign.unwrap_or_else(|| self.orient3d_exactly(points))
    }

    /// The determinant of the three vectors from the first point, each times two positive W.
    #[cold]
    #[inline(never)]
    fn orient3d_exactly(&self, points: [&Point; 4]) -> Sign {
        let homogeneous = points.map(|point| self.homogeneous(point));
        let [a, b, c, d] = homogeneous.each_ref().map(Homogeneous::views);
        let vectors = [b, c, d].map(|p| from_fn(|k| sum([(p[k], a[3]), (-a[k], p[3])])));
        let [b, c, d] = vectors.each_ref().map(views);
        dyadic::determinant(b, c, d).sign()
    }
}

impl Plane {
    #[inline]
    fn views(&self) -> ([View<'_>; 3], View<'_>) {
        let [a, b, c, offset] = self.exact.views();
        ([a, b, c], offset)
    }

    /// Whether the points it was made of were collinear: its normal is zero, and every point is on it.
    pub fn is_degenerate(&self) -> bool {
        self.views().0.iter().all(|n| n.is_zero())
    }

    /// The axis of the largest |component| of the normal, the first of them on ties.
    pub fn main_axis(&self) -> usize {
        let n = self.views().0;
        let is_larger = |i: usize, j: usize| {
            // The doubles are monotone in the components.
            match self.normal[i].abs().partial_cmp(&self.normal[j].abs()) {
                Some(Ordering::Greater) => true,
                Some(Ordering::Less) => false,
                Some(Ordering::Equal) | None => {
                    let [x, y] = [n[i], n[j]].map(View::magnitude);
                    sum([(x, View::ONE), (-y, View::ONE)]).sign() == Sign::Positive
                }
            }
        };
        let first = usize::from(is_larger(1, 0));
        if is_larger(2, first) { 2 } else { first }
    }

    /// The sign of one component of the normal.
    #[inline]
    pub fn normal_sign(&self, axis: usize) -> Sign {
        self.views().0[axis % 3].sign()
    }

    /// The sign of one component of n₁ × n₂, n₁ the normal of `self`.
    ///
    /// Each component of a normal has a relative error u, each product and the difference one more: 4u.
    #[inline]
    pub fn cross_sign(&self, other: &Plane, axis: usize) -> Sign {
        let [i, j] = others(axis);
        let (x, y) = (
            self.normal[i] * other.normal[j],
            self.normal[j] * other.normal[i],
        );
        let bound = 4.02 * UNIT_ROUNDOFF * (x.abs() + y.abs()) + UNDERFLOW;
        certain(x - y, bound).unwrap_or_else(|| self.cross_sign_exactly(other, [i, j]))
    }

    #[cold]
    #[inline(never)]
    fn cross_sign_exactly(&self, other: &Plane, [i, j]: [usize; 2]) -> Sign {
        let (m, n) = (self.views().0, other.views().0);
        sum([(m[i], n[j]), (-m[j], n[i])]).sign()
    }

    /// The sign of n₁ · n₂.
    ///
    /// Each component of a normal has a relative error u, each product and two sums one more: 5u.
    #[inline]
    pub fn dot_sign(&self, other: &Plane) -> Sign {
        let products = self.normal * other.normal;
        let bound = 5.02 * UNIT_ROUNDOFF * products.abs().element_sum() + UNDERFLOW;
        certain(products.element_sum(), bound).unwrap_or_else(|| self.dot_sign_exactly(other))
    }

    #[cold]
    #[inline(never)]
    fn dot_sign_exactly(&self, other: &Plane) -> Sign {
        dot(self.views().0, other.views().0).sign()
    }

    /// The same plane with its sides exchanged.
    pub fn reversed(&self) -> Plane {
        Plane {
            normal: -self.normal,
            through: self.through,
            exact: Packed::new(self.exact.views().map(|number| -number)),
        }
    }
}

impl Point {
    /// A point given in doubles; −0 is 0.
    pub fn exactly(position: DVec3) -> Point {
        Point {
            rounded: position + DVec3::ZERO,
            exact: None,
        }
    }

    /// The nearest doubles, each coordinate to nearest with ties to even: infinite where the coordinate is
    /// beyond the largest double, never −0.
    #[inline]
    pub fn rounded(&self) -> DVec3 {
        self.rounded
    }

    /// Whether [`rounded`](Self::rounded) is the point itself.
    #[inline]
    pub fn is_exact(&self) -> bool {
        self.exact.is_none()
    }

    /// Intervals that hold its coordinates.
    fn intervals(&self) -> [Interval; 3] {
        let exact = self.is_exact();
        self.rounded.to_array().map(|c| match exact {
            true => Interval::exactly(c),
            false => Interval {
                low: c.next_down(),
                high: c.next_up(),
            },
        })
    }
}

/// The homogeneous coordinates of a point, wherever they are.
#[expect(
    clippy::large_enum_variant,
    reason = "it lives on the stack, and briefly"
)]
enum Homogeneous<'a> {
    Constructed(&'a Packed),
    Given([Dyadic; 3]),
}

impl Homogeneous<'_> {
    fn views(&self) -> [View<'_>; 4] {
        match self {
            Self::Constructed(packed) => packed.views(),
            Self::Given(coordinates) => {
                let [x, y, z] = views(coordinates);
                [x, y, z, View::ONE]
            }
        }
    }
}

/// The two axes that follow an axis in turn.
#[inline]
fn others(axis: usize) -> [usize; 2] {
    let axis = axis % 3;
    [(axis + 1) % 3, (axis + 2) % 3]
}

/// More than all that can be lost by underflow in a filter.
const UNDERFLOW: f64 = f64::from_bits(1 << (1074 - 1060));

/// The sign of `value` unless its error, up to `bound`, could change it. NaN and infinity decide nothing.
#[inline]
fn certain(value: f64, bound: f64) -> Option<Sign> {
    (value.abs() > bound).then(|| Sign::of(value))
}

/// The components times one power of two, the largest in [1, 2]; NaN if one is less than 2⁻⁹⁰⁰ of that.
fn scaled_to_doubles(n: [View; 3]) -> DVec3 {
    const RANGE: i64 = 900;
    let orders = n.iter().filter(|n| !n.is_zero()).map(|n| n.order());
    let Some(largest) = orders.max() else {
        return DVec3::ZERO;
    };
    DVec3::from_array(n.map(|n| {
        let below = largest - n.order();
        let magnitude = match below {
            _ if n.is_zero() => 0.0,
            0..=RANGE => n.leading() as f64 * f64::from_bits(((1023 - 63 - below) as u64) << 52),
            _ => f64::NAN,
        };
        match n.sign() {
            Sign::Negative => -magnitude,
            _ => magnitude,
        }
    }))
}

/// The sign of det[a − c, b − c] for points that were rounded, if it is certain.
///
/// Let M and N bound the rounded |x| and |y|. The exact coordinates are within u M and u N (half a unit in
/// the last place), so exact differences are within e = 2u M and f = 2u N of those of the rounded points.
/// If X and Y bound the computed differences, then rounding costs 8u XY (see [`crate::filter`]) and
/// the errors of the points, in two products, 2 (X f + Y e + e f) (1 + u)².
///
/// The filter stands aside unless 2⁻¹⁹⁰ ≤ M, N ≤ 2¹⁹⁰. Then half a unit of a subnormal coordinate, 2⁻¹⁰⁷⁵, is
/// far below u M too, nothing overflows, and what underflows, less than 2⁻¹⁰⁷², is nothing beside e f ≥ 2⁻⁴⁸⁴.
#[inline]
fn filtered_orient2d(a: DVec2, b: DVec2, c: DVec2) -> Option<Sign> {
    const RANGE: std::ops::RangeInclusive<f64> = power(-190)..=power(190);
    let largest = a.abs().max(b.abs()).max(c.abs());
    if !RANGE.contains(&largest.x) || !RANGE.contains(&largest.y) {
        return None;
    }
    let (u, v) = (a - c, b - c);
    let spread = u.abs().max(v.abs());
    let error = 2.0 * UNIT_ROUNDOFF * largest;
    let bound = 8.02 * UNIT_ROUNDOFF * spread.x * spread.y
        + 2.01 * (spread.x * error.y + spread.y * error.x + error.x * error.y);
    certain(u.x * v.y - u.y * v.x, bound)
}

/// 2^exponent, a normal double.
const fn power(exponent: i64) -> f64 {
    f64::from_bits(((1023 + exponent) as u64) << 52)
}

/// What the tests look at.
#[cfg(test)]
mod inside {
    use super::{Lattice, Point};

    impl Point {
        /// Sign, limbs and place of X, Y, Z, W.
        pub(crate) fn exact_parts(&self) -> Option<[(bool, &[u64], i32); 4]> {
            let packed = self.exact.as_ref()?;
            Some(packed.views().map(|number| number.parts()))
        }
    }

    impl Lattice {
        pub(crate) fn exponent(&self) -> i32 {
            self.exponent
        }
    }
}
