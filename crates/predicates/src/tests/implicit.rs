//! Implicit points against exact rationals: every construction, every predicate, every rounding.

use super::{config, inputs};
use crate::{
    Sign,
    implicit::{Lattice, Plane, Point},
};
use dashu::{
    integer::{IBig, UBig},
    rational::RBig,
};
use glam::DVec3;
use proptest::prelude::*;
use std::{array::from_fn, cmp::Ordering};

type Vector = [RBig; 3];

fn rational(value: f64) -> RBig {
    RBig::try_from(value).expect("a finite double")
}

fn vector(point: DVec3) -> Vector {
    point.to_array().map(rational)
}

fn sign(value: &RBig) -> Sign {
    match value.cmp(&RBig::ZERO) {
        Ordering::Less => Sign::Negative,
        Ordering::Equal => Sign::Zero,
        Ordering::Greater => Sign::Positive,
    }
}

fn minus(x: &Vector, y: &Vector) -> Vector {
    from_fn(|k| &x[k] - &y[k])
}

fn cross(x: &Vector, y: &Vector) -> Vector {
    from_fn(|k| {
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        &x[i] * &y[j] - &x[j] * &y[i]
    })
}

fn dot(x: &Vector, y: &Vector) -> RBig {
    &x[0] * &y[0] + &x[1] * &y[1] + &x[2] * &y[2]
}

/// Whether `rounded` is nearest to `value`, the even one of two: by its neighbours' midpoints alone.
fn is_nearest(rounded: f64, value: &RBig) -> bool {
    let beyond = rational(f64::MAX) + rational(f64::powi(2.0, 970));
    if rounded.is_infinite() {
        let beyond = if rounded > 0.0 {
            *value >= beyond
        } else {
            *value <= -beyond
        };
        return beyond;
    }
    let middle = |neighbour: f64| match neighbour.is_infinite() {
        true => beyond.clone() * RBig::from(IBig::from(neighbour.signum() as i32)),
        false => (rational(rounded) + rational(neighbour)) / RBig::from(2),
    };
    let (low, high) = (middle(rounded.next_down()), middle(rounded.next_up()));
    let even = rounded.to_bits().is_multiple_of(2);
    rounded.to_bits() != (-0.0_f64).to_bits()
        && (low < *value || (even && low == *value))
        && (*value < high || (even && high == *value))
}

/// A plane, twice.
struct TwinPlane {
    plane: Plane,
    normal: Vector,
    offset: RBig,
}

/// A point, twice.
struct Twin {
    point: Point,
    exact: Vector,
}

/// How to make a point from the given ones, by their indices.
#[derive(Clone, Debug)]
enum Recipe {
    Given(usize),
    LinePlane([usize; 2], Facet),
    ThreePlanes([Facet; 3]),
    Centroid([usize; 3]),
}

#[derive(Clone, Debug)]
enum Facet {
    Triangle([usize; 3]),
    Edge([usize; 2], usize),
}

struct World {
    lattice: Lattice,
    given: Vec<DVec3>,
}

impl World {
    fn new(given: Vec<DVec3>) -> Self {
        Self {
            lattice: Lattice::of(given.iter().copied()),
            given,
        }
    }

    fn at(&self, i: usize) -> DVec3 {
        self.given[i % self.given.len()]
    }

    fn plane(&self, facet: &Facet) -> TwinPlane {
        let (plane, normal, through) = match *facet {
            Facet::Triangle(corners) => {
                let [a, b, c] = corners.map(|i| self.at(i));
                let [x, y, z] = [a, b, c].map(vector);
                let normal = cross(&minus(&y, &x), &minus(&z, &x));
                (self.lattice.plane(a, b, c), normal, x)
            }
            Facet::Edge(ends, axis) => {
                let [a, b] = ends.map(|i| self.at(i));
                let [x, y] = [a, b].map(vector);
                let mut unit = [RBig::ZERO, RBig::ZERO, RBig::ZERO];
                unit[axis] = RBig::ONE;
                let normal = cross(&minus(&y, &x), &unit);
                (self.lattice.edge_plane(a, b, axis), normal, x)
            }
        };
        let offset = dot(&normal, &through);
        TwinPlane {
            plane,
            normal,
            offset,
        }
    }

    /// `None` if there is no such point, which both must find.
    fn point(&self, recipe: &Recipe, earlier: &[Twin]) -> Option<Twin> {
        let (point, exact) = match recipe {
            Recipe::Given(i) => {
                let p = self.at(*i);
                (Some(Point::exactly(p)), Some(vector(p)))
            }
            Recipe::LinePlane(ends, facet) => {
                let [p, q] = ends.map(|i| self.at(i));
                let f = self.plane(facet);
                let point = self.lattice.line_plane(p, q, &f.plane);
                let (p, d) = (vector(p), minus(&vector(q), &vector(p)));
                let slope = dot(&f.normal, &d);
                let exact = (slope != RBig::ZERO).then(|| {
                    let t = (&f.offset - dot(&f.normal, &p)) / slope;
                    from_fn(|k| &p[k] + &t * &d[k])
                });
                (point, exact)
            }
            Recipe::ThreePlanes(facets) => {
                let [f, g, h] = facets.each_ref().map(|facet| self.plane(facet));
                let point = self.lattice.three_planes(&f.plane, &g.plane, &h.plane);
                (point, intersection(&f, &g, &h))
            }
            Recipe::Centroid(_) if earlier.is_empty() => (None, None),
            Recipe::Centroid(corners) => {
                let corners = corners.map(|i| &earlier[i % earlier.len()]);
                let point = self.lattice.centroid(corners.map(|twin| &twin.point));
                let [a, b, c] = corners.map(|twin| &twin.exact);
                let exact = from_fn(|k| (&a[k] + &b[k] + &c[k]) / RBig::from(3));
                (Some(point), Some(exact))
            }
        };
        assert_eq!(point.is_some(), exact.is_some(), "{recipe:?}");
        let (point, exact) = (point?, exact?);
        Some(Twin { point, exact })
    }
}

/// By elimination along the line of the first two planes, and checked in all equations.
fn intersection(f: &TwinPlane, g: &TwinPlane, h: &TwinPlane) -> Option<Vector> {
    let line = cross(&f.normal, &g.normal);
    let slope = dot(&h.normal, &line);
    if slope == RBig::ZERO {
        return None;
    }
    // A point of the line in the coordinate plane that the line is not parallel to.
    let k = (0..3).find(|&k| line[k] != RBig::ZERO)?;
    let (i, j) = ((k + 1) % 3, (k + 2) % 3);
    let mut start = [RBig::ZERO, RBig::ZERO, RBig::ZERO];
    start[i] = (&f.offset * &g.normal[j] - &g.offset * &f.normal[j]) / &line[k];
    start[j] = (&f.normal[i] * &g.offset - &g.normal[i] * &f.offset) / &line[k];
    let t = (&h.offset - dot(&h.normal, &start)) / slope;
    let point = from_fn(|k| &start[k] + &t * &line[k]);
    for plane in [f, g, h] {
        assert_eq!(dot(&plane.normal, &point), plane.offset);
    }
    Some(point)
}

fn facet() -> impl Strategy<Value = Facet> + Clone {
    prop_oneof![
        3 => [0..10_usize, 0..10, 0..10].prop_map(Facet::Triangle),
        1 => ([0..10_usize, 0..10], 0..3_usize).prop_map(|(ends, axis)| Facet::Edge(ends, axis)),
    ]
}

fn recipe() -> impl Strategy<Value = Recipe> {
    prop_oneof![
        1 => (0..10_usize).prop_map(Recipe::Given),
        3 => ([0..10_usize, 0..10], facet()).prop_map(|(ends, facet)| Recipe::LinePlane(ends, facet)),
        3 => [facet(), facet(), facet()].prop_map(Recipe::ThreePlanes),
        1 => [0..4_usize, 0..4, 0..4].prop_map(Recipe::Centroid),
    ]
}

/// Points whose planes are nearly, but not quite, parallel or one.
fn near_parallel() -> impl Strategy<Value = Vec<DVec3>> {
    let move_by = prop_oneof![2 => Just(0_i32), 1 => -3..=3];
    let points = proptest::collection::vec(([-8..=8_i32, -8..=8], move_by), 10);
    (points, 0..60_i32).prop_map(|(points, steepness)| {
        let slope = DVec3::new(1.0, f64::powi(2.0, -steepness), 0.375);
        let place = |([x, y], m): ([i32; 2], i32)| {
            let (x, y) = (f64::from(x) * 0.1, f64::from(y) * 0.3);
            let z = slope.x * x + slope.y * y + slope.z;
            DVec3::new(x, y, z * (1.0 + f64::from(m) * f64::EPSILON))
        };
        points.into_iter().map(place).collect()
    })
}

/// All sorts, often two sorts together.
fn points() -> impl Strategy<Value = Vec<DVec3>> {
    let grid = [-2..=2_i32, -2..=2, -2..=2].prop_map(|p| DVec3::from_array(p.map(f64::from)));
    let exponent = prop_oneof![2 => Just(0), 1 => Just(-1074), 1 => -1074..1020_i32];
    let grid = (proptest::collection::vec(grid, 10), exponent).prop_map(|(points, e)| {
        let (first, second) = (f64::powi(2.0, e / 2), f64::powi(2.0, e - e / 2));
        points.into_iter().map(|p| p * first * second).collect()
    });
    prop_oneof![
        2 => inputs::points().prop_map(Vec::from),
        1 => (inputs::points(), inputs::points()).prop_map(|(p, q)| [p, q].concat()),
        2 => grid,
        1 => near_parallel(),
    ]
}

fn made(world: &World, recipes: &[Recipe]) -> Vec<Twin> {
    let mut twins = Vec::new();
    for recipe in recipes {
        twins.extend(world.point(recipe, &twins));
    }
    twins
}

proptest! {
    #![proptest_config(config())]

    #[test]
    fn constructions_are_exact_and_correctly_rounded(
        points in points(), recipes in proptest::collection::vec(recipe(), 4)
    ) {
        let world = World::new(points);
        for twin in made(&world, &recipes) {
            let (rounded, exact) = (twin.point.rounded().to_array(), &twin.exact);
            for k in 0..3 {
                prop_assert!(is_nearest(rounded[k], &exact[k]), "{} for {}", rounded[k], exact[k]);
            }
            let is_exact = rounded.iter().all(|c| c.is_finite())
                && vector(twin.point.rounded()) == *exact;
            prop_assert_eq!(twin.point.is_exact(), is_exact);
            // The homogeneous coordinates themselves.
            if let Some(xyzw) = twin.point.homogeneous_rationals() {
                for k in 0..3 {
                    let x = &xyzw[k] / &xyzw[3] * world.lattice.unit_rational();
                    prop_assert_eq!(&x, &exact[k]);
                }
            }
        }
    }

    #[test]
    fn predicates_of_points_are_exact(
        points in points(), recipes in proptest::collection::vec(recipe(), 5)
    ) {
        let world = World::new(points);
        let lattice = &world.lattice;
        let twins = made(&world, &recipes);
        for p in &twins {
            for q in &twins {
                for axis in 0..3 {
                    let truth = p.exact[axis].cmp(&q.exact[axis]);
                    prop_assert_eq!(lattice.compare(&p.point, &q.point, axis), truth);
                }
                let truth = p.exact == q.exact;
                prop_assert_eq!(lattice.equal(&p.point, &q.point), truth);
                prop_assert!(!truth || p.point.rounded() == q.point.rounded());
            }
        }
        for window in twins.windows(3) {
            let [a, b, c] = [0, 1, 2].map(|i| &window[i]);
            let normal = cross(&minus(&b.exact, &a.exact), &minus(&c.exact, &a.exact));
            for (axis, component) in normal.iter().enumerate() {
                let found = lattice.orient2d(axis, &a.point, &b.point, &c.point);
                prop_assert_eq!(found, sign(component));
                prop_assert_eq!(lattice.orient2d(axis, &b.point, &a.point, &c.point), -found);
            }
        }
        for window in twins.windows(4) {
            let [a, b, c, d] = [0, 1, 2, 3].map(|i| &window[i]);
            let [u, v, w] = [b, c, d].map(|p| minus(&p.exact, &a.exact));
            let truth = sign(&dot(&u, &cross(&v, &w)));
            let found = lattice.orient3d(&a.point, &b.point, &c.point, &d.point);
            prop_assert_eq!(found, truth);
        }
    }

    #[test]
    fn predicates_of_planes_are_exact(
        points in points(),
        facets in proptest::collection::vec(facet(), 3),
        recipes in proptest::collection::vec(recipe(), 3),
    ) {
        let world = World::new(points);
        let twins = made(&world, &recipes);
        let planes: Vec<TwinPlane> = facets.iter().map(|facet| world.plane(facet)).collect();
        for f in &planes {
            let reversed = f.plane.reversed();
            let size = |k: usize| if f.normal[k] < RBig::ZERO { -&f.normal[k] } else { f.normal[k].clone() };
            let main = (0..3).fold(0, |best, k| if size(k) > size(best) { k } else { best });
            prop_assert_eq!(f.plane.main_axis(), main);
            prop_assert_eq!(reversed.main_axis(), main);
            prop_assert_eq!(f.plane.is_degenerate(), f.normal.iter().all(|n| *n == RBig::ZERO));
            for axis in 0..3 {
                prop_assert_eq!(f.plane.normal_sign(axis), sign(&f.normal[axis]));
                prop_assert_eq!(reversed.normal_sign(axis), -sign(&f.normal[axis]));
            }
            for g in &planes {
                let truth = cross(&f.normal, &g.normal);
                for (axis, truth) in truth.iter().enumerate() {
                    prop_assert_eq!(f.plane.cross_sign(&g.plane, axis), sign(truth));
                    prop_assert_eq!(reversed.cross_sign(&g.plane, axis), -sign(truth));
                }
                let truth = sign(&dot(&f.normal, &g.normal));
                prop_assert_eq!(f.plane.dot_sign(&g.plane), truth);
                prop_assert_eq!(g.plane.dot_sign(&reversed), -truth);
            }
            let given = world.given.iter().map(|&p| (Point::exactly(p), vector(p)));
            let made = twins.iter().map(|twin| (twin.point.clone(), twin.exact.clone()));
            for (point, exact) in given.chain(made) {
                let truth = sign(&(dot(&f.normal, &exact) - &f.offset));
                prop_assert_eq!(world.lattice.side(&f.plane, &point), truth);
                prop_assert_eq!(world.lattice.side(&reversed, &point), -truth);
            }
        }
    }

    /// On the edge between both roundings: (2k + 1) / 2 units in the last place, and next to that.
    #[test]
    fn ties_go_to_the_even_double(
        digits in 1..1_u64 << 53, exponent in -1074..960_i32, aside in -1..=1_i32, negative: bool
    ) {
        let unit = f64::powi(2.0, exponent / 2) * f64::powi(2.0, exponent - exponent / 2);
        let value = digits as f64 * unit;
        let value = if negative { -value } else { value };
        let (low, high) = (value, value.next_up());
        // The middle of the diagonal of a square in the plane x = 0, and where it is cut a little higher.
        let aside = f64::from(aside) * f64::powi(2.0, -30);
        let (p, q) = (DVec3::new(low, -1.0, 0.0), DVec3::new(high, 1.0, 0.0));
        let corners = [DVec3::new(0.0, aside, 0.0), DVec3::new(1.0, aside, 0.0), DVec3::new(0.0, aside, 1.0)];
        let world = World::new(vec![p, q, corners[0], corners[1], corners[2]]);
        let twin = world.point(&Recipe::LinePlane([0, 1], Facet::Triangle([2, 3, 4])), &[]);
        let twin = twin.expect("not parallel");
        let rounded = twin.point.rounded().x;
        prop_assert!(is_nearest(rounded, &twin.exact[0]));
        if aside == 0.0 {
            let even = if low.to_bits().is_multiple_of(2) { low } else { high };
            prop_assert_eq!(rounded, even + 0.0);
        } else {
            prop_assert_eq!(rounded, if aside < 0.0 { low } else { high } + 0.0);
        }
    }
}

#[test]
fn beyond_the_doubles() {
    let huge = f64::MAX;
    // Lines so steep that they meet the plane z = 0 beyond all doubles, and below the least.
    let (p, q) = (
        DVec3::new(-huge, -huge, huge),
        DVec3::new(huge, huge.next_down(), huge.next_down()),
    );
    let ground = [DVec3::ZERO, DVec3::X, DVec3::Y];
    let world = World::new([vec![p, q], ground.to_vec()].concat());
    let lattice = &world.lattice;
    let far = Recipe::LinePlane([0, 1], Facet::Triangle([2, 3, 4]));
    let far = world.point(&far, &[]).expect("not parallel");
    assert_eq!(
        far.point.rounded(),
        DVec3::new(f64::INFINITY, f64::INFINITY, 0.0)
    );
    assert!(!far.point.is_exact());
    let farther = Recipe::LinePlane([0, 2], Facet::Triangle([2, 3, 4]));
    let near = world.point(&farther, &[]).expect("not parallel");
    assert_eq!(near.point.rounded(), DVec3::ZERO);
    assert_eq!(
        lattice.compare(&far.point, &near.point, 0),
        Ordering::Greater
    );
    assert_eq!(lattice.compare(&far.point, &far.point, 0), Ordering::Equal);
    let y_before_x = far.exact[1].cmp(&far.exact[0]);
    assert_ne!(y_before_x, Ordering::Equal);
    let given = Point::exactly(p);
    let truth = {
        let u = minus(&vector(p), &far.exact);
        let v = minus(&near.exact, &far.exact);
        sign(&cross(&u, &v)[2])
    };
    assert_eq!(lattice.orient2d(2, &far.point, &given, &near.point), truth);
}

#[test]
fn less_than_the_least_double() {
    let tiny = f64::from_bits(1);
    let at = |x, z| DVec3::new(x, 0.0, z);
    let ground = [DVec3::ZERO, DVec3::X, DVec3::Y];
    for (from, to, rounded) in [
        (at(0.0, 1.0), at(tiny, -1.0), 0.0),
        (at(0.0, 1.0), at(-tiny, -1.0), 0.0),
        (at(0.0, 1.0), at(tiny, -0.5), tiny),
        (at(0.0, 1.0), at(-tiny, -0.5), -tiny),
        (at(tiny, 1.0), at(2.0 * tiny, -1.0), 2.0 * tiny),
        (at(0.0, 1.0), at(tiny, -1e300), 0.0),
    ] {
        let world = World::new([vec![from, to], ground.to_vec()].concat());
        let recipe = Recipe::LinePlane([0, 1], Facet::Triangle([2, 3, 4]));
        let twin = world.point(&recipe, &[]).expect("not parallel");
        let x = twin.point.rounded().x;
        assert_eq!(x.to_bits(), rounded.to_bits(), "{from} {to}");
        assert!(!twin.point.is_exact());
        assert!(is_nearest(x, &twin.exact[0]));
    }
}

/// Points off the lattice are exact all the same.
#[test]
fn a_coarse_lattice_changes_nothing() {
    let coarse = Lattice::of([DVec3::splat(1024.0)]);
    let [a, b, c] = [[0.1, 0.2, 0.3], [1.7, -0.3, 2.9], [-3.1, 0.7, 1.1]].map(DVec3::from_array);
    let fine = Lattice::of([a, b, c]);
    let (p, q) = (DVec3::new(0.3, 5.1, -7.7), DVec3::new(0.9, -4.3, 9.1));
    let made = |lattice: &Lattice| {
        let point = lattice.line_plane(p, q, &lattice.plane(a, b, c));
        point.expect("not parallel").rounded()
    };
    assert_eq!(made(&coarse), made(&fine));
}

#[test]
fn nothing_panics_without_finite_coordinates() {
    let values = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1.0, -1e300];
    let points: Vec<DVec3> = (0..40)
        .map(|i| DVec3::new(values[i % 5], values[i / 5 % 5], values[i / 3 % 5]))
        .collect();
    let lattice = Lattice::of(points.iter().copied());
    for window in points.windows(9) {
        let planes: [Plane; 3] =
            from_fn(|i| lattice.plane(window[i], window[2 * i], window[i + 5]));
        let [f, g, h] = &planes;
        let mut made = vec![Point::exactly(window[0]), Point::exactly(window[4])];
        made.extend(lattice.three_planes(f, g, h));
        made.extend(lattice.line_plane(window[1], window[7], f));
        made.extend(lattice.line_plane(
            window[2],
            window[3],
            &lattice.edge_plane(window[1], window[4], 1),
        ));
        made.push(lattice.centroid([&made[0], &made[1], &made[made.len() - 1]]));
        for p in &made {
            for q in &made {
                let _ = (
                    lattice.equal(p, q),
                    lattice.compare(p, q, 5),
                    lattice.side(g, p),
                );
                let _ = lattice.orient2d(2, p, q, &made[0]);
                let _ = lattice.orient3d(p, q, &made[0], &made[1]);
            }
        }
        let _ = (
            f.main_axis(),
            f.cross_sign(g, 0),
            f.dot_sign(h),
            f.is_degenerate(),
        );
    }
}

impl Point {
    /// X, Y, Z and W of a point that is not a double.
    fn homogeneous_rationals(&self) -> Option<[RBig; 4]> {
        self.exact_parts().map(|parts| {
            parts.map(|(negative, limbs, low)| {
                let bytes: Vec<u8> = limbs.iter().flat_map(|limb| limb.to_le_bytes()).collect();
                let magnitude = IBig::from(UBig::from_le_bytes(&bytes));
                let value = RBig::from(if negative { -magnitude } else { magnitude });
                value * power_of_two(64 * i64::from(low))
            })
        })
    }
}

impl Lattice {
    fn unit_rational(&self) -> RBig {
        power_of_two(i64::from(self.exponent()))
    }
}

fn power_of_two(exponent: i64) -> RBig {
    let power = RBig::from(IBig::ONE << exponent.unsigned_abs() as usize);
    if exponent < 0 {
        RBig::ONE / power
    } else {
        power
    }
}
