//! Four determinants at once, one in each lane of a vector register.
//!
//! The operations are those of one lane, in the same order, so the lanes hold bit for bit what four calls
//! one after the other would give, whatever the machine, and the filters' error bounds hold for each.
//!
//! [`vectorized`] compiles an operation for the registers that every machine has, and for registers of 256
//! bits, and runs the one that fits this machine.

mod registers;

#[cfg(test)]
pub(crate) use registers::Plain;
pub use registers::{Registers, Vectorized, vectorized};

use crate::determinant::{self, Ring};
use glam::DVec3;

/// One value a lane.
#[derive(Clone, Copy)]
struct Lanes<R: Registers> {
    registers: R,
    four: R::Four,
}

impl<R: Registers> Lanes<R> {
    #[inline(always)]
    fn with(&self, four: R::Four) -> Self {
        Self {
            registers: self.registers,
            four,
        }
    }

    #[inline(always)]
    fn permuted<const LANES: i32>(&self) -> Self {
        self.with(self.registers.permuted::<LANES>(self.four))
    }
}

impl<R: Registers> Ring for Lanes<R> {
    #[inline(always)]
    fn add(&self, other: &Self) -> Self {
        self.with(self.registers.add(self.four, other.four))
    }
    #[inline(always)]
    fn sub(&self, other: &Self) -> Self {
        self.with(self.registers.sub(self.four, other.four))
    }
    #[inline(always)]
    fn mul(&self, other: &Self) -> Self {
        self.with(self.registers.mul(self.four, other.four))
    }
}

/// Four points, one a lane, minus `origin`.
#[inline(always)]
fn differences<R: Registers>(registers: R, points: [DVec3; 4], origin: DVec3) -> [Lanes<R>; 3] {
    let [a, b, c, d] = points;
    let lanes = |lanes, origin| Lanes {
        registers,
        four: registers.sub(registers.set(lanes), registers.set([origin; 4])),
    };
    [
        lanes([a.x, b.x, c.x, d.x], origin.x),
        lanes([a.y, b.y, c.y, d.y], origin.y),
        lanes([a.z, b.z, c.z, d.z], origin.z),
    ]
}

const fn lanes([i, j, k, l]: [i32; 4]) -> i32 {
    i | j << 2 | k << 4 | l << 6
}

/// What the filters say of four in-sphere tests: bit i stands for test i.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FourVerdicts {
    /// The spheres that surely have the point inside.
    pub inside: u8,
    /// Those that surely have it outside.
    pub outside: u8,
}

/// What the static filter says of a point and the four facets of a tetrahedron: bit i stands for the facet opposite
/// corner i.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FourSides {
    /// The facets that surely have the point and their corner on different sides.
    pub beyond: u8,
    /// Those that surely do not.
    pub within: u8,
}

/// On which side of each facet of the positive tetrahedron `corners` the point `p` lies. `half_unit` is half the least
/// determinant that is not zero, as in [`AcrossBounds`].
#[inline(always)]
pub(crate) fn sides_of_facets<R: Registers>(
    registers: R,
    corners: [DVec3; 4],
    p: DVec3,
    bound: f64,
    half_unit: f64,
) -> FourSides {
    let corners = differences(registers, corners, p);
    let [first, second, third] = facets(corners);
    let value = determinant::orient3d(&first, &second, &third).four;
    let (beyond, within) = surely(registers, value, splat(registers, bound));
    FourSides {
        beyond,
        // On a lattice what may be zero is zero: not beyond.
        within: match bound < half_unit {
            true => !beyond & 0b1111,
            false => within,
        },
    }
}

/// The corners of a tetrahedron as first, second and third corners of its facets, lane i for the facet opposite corner i:
/// seen from beyond the facet they turn counter-clockwise, so with a point beyond they are positive.
///
/// ```text
/// lane        0    1    2    3
/// first       3    2    3    1
/// second      1    0    0    0
/// third       2    3    1    2
/// ```
#[inline(always)]
fn facets<R: Registers>([x, y, z]: [Lanes<R>; 3]) -> [[Lanes<R>; 3]; 3] {
    [
        [
            x.permuted::<FIRST>(),
            y.permuted::<FIRST>(),
            z.permuted::<FIRST>(),
        ],
        [
            x.permuted::<SECOND>(),
            y.permuted::<SECOND>(),
            z.permuted::<SECOND>(),
        ],
        [
            x.permuted::<THIRD>(),
            y.permuted::<THIRD>(),
            z.permuted::<THIRD>(),
        ],
    ]
}

const FIRST: i32 = lanes([3, 2, 3, 1]);
const SECOND: i32 = lanes([1, 0, 0, 0]);
const THIRD: i32 = lanes([2, 3, 1, 2]);

/// Where the vertex at infinity is among the four neighbours of a tetrahedron. Its coordinates have no say.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct AtInfinity {
    /// Bit i: it is opposite corner i, of a finite tetrahedron.
    pub opposite: u8,
    /// It is corner 3 of the tetrahedron itself.
    pub corner: bool,
}

impl AtInfinity {
    /// The neighbours that have it as a vertex.
    #[inline(always)]
    fn lanes(self) -> u8 {
        if self.corner { 0b0111 } else { self.opposite }
    }
}

/// For each corner of the positive tetrahedron `corners`: whether `p` is inside the sphere of
/// the neighbour opposite that corner, whose fourth vertex is `opposite`. The static filter, and where that is
/// not enough, the semi-static one; on a lattice ties too, by the perturbation of [`lifted`](crate::lifted).
///
/// The neighbour opposite corner i has the other three corners, turned around, and opposite vertex i (see [`facets`]).
#[inline(always)]
pub(crate) fn insphere_across<R: Registers>(
    registers: R,
    corners: [DVec3; 4],
    opposite: [DVec3; 4],
    p: DVec3,
    at_infinity: AtInfinity,
    bounds: AcrossBounds,
) -> FourVerdicts {
    let corners = differences(registers, corners, p);
    let opposite = differences(registers, opposite, p);
    let neighbors = Neighbors::across(corners, opposite);
    let value = neighbors.determinant(determinant::lift(&corners), determinant::lift(&opposite));
    let no_weights = splat(registers, 0.0);
    neighbors.verdicts(value, [no_weights; 2], at_infinity, bounds)
}

/// The same for points with weights: whether the lift of `p` lies below the hyperplane through those of the neighbour's vertices. Ties are
/// not decided, on a lattice neither.
#[inline(always)]
pub(crate) fn power_test_across<R: Registers>(
    registers: R,
    corners: [(DVec3, f64); 4],
    opposite: [(DVec3, f64); 4],
    p: (DVec3, f64),
    at_infinity: AtInfinity,
    bounds: AcrossBounds,
) -> FourVerdicts {
    let (corners, weights_of_corners) = weighted_differences(registers, corners, p);
    let (opposite, weights_of_opposite) = weighted_differences(registers, opposite, p);
    let neighbors = Neighbors::across(corners, opposite);
    let value = neighbors.determinant(
        determinant::lift(&corners).sub(&weights_of_corners),
        determinant::lift(&opposite).sub(&weights_of_opposite),
    );
    let weights = [weights_of_corners.four, weights_of_opposite.four];
    neighbors.verdicts(value, weights, at_infinity, bounds)
}

/// Four points and their weights, one a lane, minus those of `origin`.
#[inline(always)]
fn weighted_differences<R: Registers>(
    registers: R,
    [a, b, c, d]: [(DVec3, f64); 4],
    (origin, weight): (DVec3, f64),
) -> ([Lanes<R>; 3], Lanes<R>) {
    let weights = registers.set([a.1, b.1, c.1, d.1]);
    let four = registers.sub(weights, splat(registers, weight));
    (
        differences(registers, [a.0, b.0, c.0, d.0], origin),
        Lanes { registers, four },
    )
}

/// The neighbours of a tetrahedron, lane i for the one opposite corner i, seen from a point.
struct Neighbors<R: Registers> {
    /// First to third the corners of the tetrahedron (see [`facets`]), then the vertex opposite.
    points: [[Lanes<R>; 3]; 4],
    /// What the lifts of the points are weighted by.
    coefficients: [Lanes<R>; 4],
}

impl<R: Registers> Neighbors<R> {
    #[inline(always)]
    fn across(corners: [Lanes<R>; 3], opposite: [Lanes<R>; 3]) -> Self {
        let [first, second, third] = facets(corners);
        Self {
            points: [first, second, third, opposite],
            coefficients: determinant::insphere_coefficients(&first, &second, &third, &opposite),
        }
    }

    /// Positive where the origin is inside.
    #[inline(always)]
    fn determinant(&self, lift_of_corners: Lanes<R>, lift_of_opposite: Lanes<R>) -> R::Four {
        let lifts = [
            &lift_of_corners.permuted::<FIRST>(),
            &lift_of_corners.permuted::<SECOND>(),
            &lift_of_corners.permuted::<THIRD>(),
            &lift_of_opposite,
        ];
        determinant::weighted(&self.coefficients, lifts).four
    }

    /// What is sure by the static filter, by the semi-static one, and of ties on a lattice. `weights` are the differences that the
    /// lifts of the corners and of the opposite vertices take away.
    #[inline(always)]
    fn verdicts(
        &self,
        value: R::Four,
        weights: [R::Four; 2],
        at_infinity: AtInfinity,
        bounds: AcrossBounds,
    ) -> FourVerdicts {
        let Self {
            points,
            coefficients,
        } = *self;
        let registers = coefficients[0].registers;
        let (inside, outside) = surely(registers, value, splat(registers, bounds.of_box));
        let mut verdicts = FourVerdicts { inside, outside };
        let infinite = at_infinity.lanes();
        if infinite != 0 {
            let half_spaces =
                half_spaces(registers, coefficients, at_infinity, bounds.of_orientations);
            verdicts.inside = verdicts.inside & !infinite | half_spaces.inside;
            verdicts.outside = verdicts.outside & !infinite | half_spaces.outside;
        }
        let undecided = !(verdicts.inside | verdicts.outside | infinite) & 0b1111;
        if undecided == 0 {
            return verdicts;
        }
        let mut cospherical = undecided;
        if bounds.of_box >= bounds.half_unit {
            let (bound, is_usable) = semi_static_bound(registers, points, weights, bounds);
            let usable = undecided & is_usable;
            let (inside, outside) = surely(registers, value, bound);
            verdicts.inside |= usable & inside;
            verdicts.outside |= usable & outside;
            let undecided = usable & !(verdicts.inside | verdicts.outside);
            cospherical = undecided & registers.greater(splat(registers, bounds.half_unit), bound);
        }
        if cospherical != 0 {
            let inside = insphere_of_cospherical(registers, points, coefficients);
            verdicts.inside |= cospherical & inside;
            verdicts.outside |= cospherical & !inside;
        }
        verdicts
    }
}

#[inline(always)]
fn splat<R: Registers>(registers: R, x: f64) -> R::Four {
    registers.set([x; 4])
}

/// The lanes that are surely positive, and those that are surely negative: beyond the bound on their error.
#[inline(always)]
fn surely<R: Registers>(registers: R, value: R::Four, bound: R::Four) -> (u8, u8) {
    let negated = registers.sub(splat(registers, 0.0), value);
    (
        registers.greater(value, bound),
        registers.greater(negated, bound),
    )
}

/// The spheres through the vertex at infinity are half-spaces: in the determinant its lift outweighs everything, and what that is
/// weighted by says on which side of the other three vertices the origin lies. The static filter of orientations decides.
#[inline(always)]
fn half_spaces<R: Registers>(
    registers: R,
    [bcd, _, dab, abc]: [Lanes<R>; 4],
    at_infinity: AtInfinity,
    bound: f64,
) -> FourVerdicts {
    let bound = splat(registers, bound);
    if at_infinity.corner {
        // The first vertex in lanes 0 and 2, the third in lane 1 (see `facets`).
        let first = surely(registers, bcd.four, bound);
        let third = surely(registers, dab.four, bound);
        FourVerdicts {
            inside: first.0 & 0b0101 | third.0 & 0b0010,
            outside: first.1 & 0b0101 | third.1 & 0b0010,
        }
    } else {
        let (outside, inside) = surely(registers, abc.four, bound);
        FourVerdicts {
            inside: inside & at_infinity.opposite,
            outside: outside & at_infinity.opposite,
        }
    }
}

/// The bound on the error of each lane's determinant from the spreads of its points, and which lanes it holds for.
#[inline(always)]
fn semi_static_bound<R: Registers>(
    registers: R,
    points: [[Lanes<R>; 3]; 4],
    weights: [R::Four; 2],
    bounds: AcrossBounds,
) -> (R::Four, u8) {
    let x = spread(registers, points, 0);
    let y = spread(registers, points, 1);
    let z = spread(registers, points, 2);
    let squares = registers.add(
        registers.add(registers.mul(x, x), registers.mul(y, y)),
        registers.mul(z, z),
    );
    let weight = weight_spread(registers, weights);
    let volume = registers.mul(registers.mul(x, y), z);
    let bound = registers.mul(
        registers.mul(volume, registers.add(squares, weight)),
        splat(registers, bounds.factor),
    );
    let (least, most) = (
        splat(registers, bounds.least),
        splat(registers, bounds.most),
    );
    let is_usable = registers.greater(x, least)
        & registers.greater(y, least)
        & registers.greater(z, least)
        & registers.greater(most, x)
        & registers.greater(most, y)
        & registers.greater(most, z)
        & registers.greater(splat(registers, bounds.most_weight), weight);
    (bound, is_usable)
}

/// The largest absolute value of a coordinate.
#[inline(always)]
fn spread<R: Registers>(
    registers: R,
    [a, b, c, d]: [[Lanes<R>; 3]; 4],
    coordinate: usize,
) -> R::Four {
    let a = registers.abs(a[coordinate].four);
    let b = registers.abs(b[coordinate].four);
    let c = registers.abs(c[coordinate].four);
    let d = registers.abs(d[coordinate].four);
    registers.max(registers.max(a, b), registers.max(c, d))
}

/// The largest absolute value of a weight: of the corners, all in one register, and of the opposite vertex.
#[inline(always)]
fn weight_spread<R: Registers>(registers: R, [corners, opposite]: [R::Four; 2]) -> R::Four {
    let corners = registers.abs(corners);
    let corners = registers.max(
        corners,
        registers.permuted::<{ lanes([1, 0, 3, 2]) }>(corners),
    );
    let corners = registers.max(
        corners,
        registers.permuted::<{ lanes([2, 3, 0, 1]) }>(corners),
    );
    registers.max(corners, registers.abs(opposite))
}

/// Bit i says whether the perturbation (see [`lifted`](crate::lifted)) has the origin inside the sphere of the positive
/// tetrahedron in lane i, on which it lies. The origin is none of the corners.
///
/// The factors of the perturbation are the coefficients of the lifts, that of the origin being negative. They are exact: they
/// are multiples of u³ for a lattice of unit u, of three spreads X, Y, Z that are at least u. The error of the in-sphere
/// determinant being less than u⁵ / 2, `factor` X Y Z (X² + Y² + Z²) is, so X Y Z < u³ / (6 `factor`). With
/// `factor` > 2⁻⁵³ all terms and sums of the coefficients, six products of three differences, are below 2⁵³ u³.
#[inline(always)]
fn insphere_of_cospherical<R: Registers>(
    registers: R,
    [a, b, c, d]: [[Lanes<R>; 3]; 4],
    [bcd, cda, dab, abc]: [Lanes<R>; 4],
) -> u8 {
    let zero = splat(registers, 0.0);
    let largest = Largest {
        registers,
        zero,
        point: [zero; 3],
        factor: splat(registers, -1.0),
    };
    let largest = largest.or(a, bcd.four);
    let largest = largest.or(b, registers.sub(zero, cda.four));
    let largest = largest.or(c, dab.four);
    let largest = largest.or(d, registers.sub(zero, abc.four));
    registers.greater(largest.factor, zero)
}

/// In each lane, the lexicographically largest point so far whose factor is not zero, and its factor.
struct Largest<R: Registers> {
    registers: R,
    zero: R::Four,
    point: [R::Four; 3],
    factor: R::Four,
}

impl<R: Registers> Largest<R> {
    #[inline(always)]
    fn or(self, [x, y, z]: [Lanes<R>; 3], factor: R::Four) -> Self {
        let Self {
            registers,
            zero,
            point: [u, v, w],
            factor: other,
        } = self;
        let (x, y, z) = (x.four, y.four, z.four);
        let by_z = registers.both(registers.is_equal(y, v), registers.is_greater(z, w));
        let by_y = registers.either(registers.is_greater(y, v), by_z);
        let by_y = registers.both(registers.is_equal(x, u), by_y);
        let is_larger = registers.either(registers.is_greater(x, u), by_y);
        let is_positive = registers.is_greater(factor, zero);
        let is_negative = registers.is_greater(zero, factor);
        let decides = registers.both(is_larger, registers.either(is_positive, is_negative));
        Self {
            registers,
            zero,
            point: [
                registers.select(decides, x, u),
                registers.select(decides, y, v),
                registers.select(decides, z, w),
            ],
            factor: registers.select(decides, factor, other),
        }
    }
}

/// Bounds on the error of the determinant of in-sphere or power tests.
#[derive(Clone, Copy)]
pub(crate) struct AcrossBounds {
    /// For all points of a box.
    pub(crate) of_box: f64,
    /// For their orientation determinant.
    pub(crate) of_orientations: f64,
    /// Where the points are on a lattice, half the least determinant that is not zero: with a smaller error, one
    /// that may be zero is zero. 0 elsewhere.
    pub(crate) half_unit: f64,
    /// The bound for a single call is this times X Y Z (X² + Y² + Z² + W) of its spreads.
    pub(crate) factor: f64,
    /// Exclusive limits for the spreads.
    pub(crate) least: f64,
    pub(crate) most: f64,
    /// The same for that of the weights.
    pub(crate) most_weight: f64,
}
