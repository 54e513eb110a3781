//! Four determinants at once, one in each lane of a vector register.
//!
//! The operations are those of one lane, in the same order, so the lanes hold bit for bit what four calls
//! one after the other would give, whatever the machine, and the filters' error bounds hold for each.
//!
//! [`vectorized`] compiles an operation for the registers that every machine has, and for registers of 256
//! bits, and runs the one that fits this machine.

use crate::determinant::{self, Ring};
use glam::DVec3;

/// Registers of four doubles.
pub trait Registers: Copy {
    /// Four doubles.
    type Four: Copy;
    /// One number a lane.
    fn set(self, lanes: [f64; 4]) -> Self::Four;
    /// Sums, lane by lane.
    fn add(self, a: Self::Four, b: Self::Four) -> Self::Four;
    /// Differences, lane by lane.
    fn sub(self, a: Self::Four, b: Self::Four) -> Self::Four;
    /// Products, lane by lane.
    fn mul(self, a: Self::Four, b: Self::Four) -> Self::Four;
    /// The lanes named by the pairs of bits of `LANES`, the lowest pair first.
    fn permuted<const LANES: i32>(self, a: Self::Four) -> Self::Four;
    /// Bit i says whether lane i is greater than `bound`.
    fn above(self, a: Self::Four, bound: f64) -> u8;
    /// Bit i says whether lane i is less than `bound`.
    fn below(self, a: Self::Four, bound: f64) -> u8;
}

/// Work that is compiled once for each kind of registers. All that [`run`](Self::run) calls must be inlined
/// into it.
pub trait Vectorized {
    /// What it results in.
    type Output;
    /// Does the work; `inline(always)`.
    fn run<R: Registers>(self, registers: R) -> Self::Output;
}

/// Runs an operation with the best registers that this machine has.
///
/// ```
/// use pellicle_predicates::lanes::{Registers, Vectorized, vectorized};
///
/// struct Positive([f64; 4]);
/// impl Vectorized for Positive {
///     type Output = u8;
///     #[inline(always)]
///     fn run<R: Registers>(self, registers: R) -> u8 {
///         registers.above(registers.set(self.0), 0.0)
///     }
/// }
/// assert_eq!(vectorized(Positive([1.0, -1.0, 2.0, 0.0])), 0b0101);
/// ```
#[inline]
pub fn vectorized<W: Vectorized>(work: W) -> W::Output {
    #[cfg(target_arch = "x86_64")]
    if let Some(instructions) = pulp::x86::V3::try_new() {
        struct Call<W>(W, Avx2);
        impl<W: Vectorized> pulp::NullaryFnOnce for Call<W> {
            type Output = W::Output;
            #[inline(always)]
            fn call(self) -> W::Output {
                self.0.run(self.1)
            }
        }
        return instructions.vectorize(Call(work, Avx2(instructions)));
    }
    work.run(Plain)
}

/// An array in place of a register.
#[derive(Clone, Copy)]
struct Plain;

#[inline(always)]
fn zip([a, b, c, d]: [f64; 4], [e, f, g, h]: [f64; 4], of: impl Fn(f64, f64) -> f64) -> [f64; 4] {
    [of(a, e), of(b, f), of(c, g), of(d, h)]
}

#[inline(always)]
fn bits(lanes: [f64; 4], holds: impl Fn(f64) -> bool) -> u8 {
    let [a, b, c, d] = lanes.map(|lane| u8::from(holds(lane)));
    a | b << 1 | c << 2 | d << 3
}

impl Registers for Plain {
    type Four = [f64; 4];

    #[inline(always)]
    fn set(self, lanes: [f64; 4]) -> [f64; 4] {
        lanes
    }
    #[inline(always)]
    fn add(self, a: [f64; 4], b: [f64; 4]) -> [f64; 4] {
        zip(a, b, |x, y| x + y)
    }
    #[inline(always)]
    fn sub(self, a: [f64; 4], b: [f64; 4]) -> [f64; 4] {
        zip(a, b, |x, y| x - y)
    }
    #[inline(always)]
    fn mul(self, a: [f64; 4], b: [f64; 4]) -> [f64; 4] {
        zip(a, b, |x, y| x * y)
    }
    #[inline(always)]
    fn permuted<const LANES: i32>(self, a: [f64; 4]) -> [f64; 4] {
        std::array::from_fn(|i| a[(LANES >> (2 * i) & 3) as usize])
    }
    #[inline(always)]
    fn above(self, a: [f64; 4], bound: f64) -> u8 {
        bits(a, |lane| lane > bound)
    }
    #[inline(always)]
    fn below(self, a: [f64; 4], bound: f64) -> u8 {
        bits(a, |lane| lane < bound)
    }
}

/// The registers of a machine with AVX2, which the token proves this one to be.
#[cfg(target_arch = "x86_64")]
#[derive(Clone, Copy)]
struct Avx2(pulp::x86::V3);

#[cfg(target_arch = "x86_64")]
impl Registers for Avx2 {
    type Four = std::arch::x86_64::__m256d;

    #[inline(always)]
    fn set(self, [a, b, c, d]: [f64; 4]) -> Self::Four {
        self.0.avx._mm256_setr_pd(a, b, c, d)
    }
    #[inline(always)]
    fn add(self, a: Self::Four, b: Self::Four) -> Self::Four {
        self.0.avx._mm256_add_pd(a, b)
    }
    #[inline(always)]
    fn sub(self, a: Self::Four, b: Self::Four) -> Self::Four {
        self.0.avx._mm256_sub_pd(a, b)
    }
    #[inline(always)]
    fn mul(self, a: Self::Four, b: Self::Four) -> Self::Four {
        self.0.avx._mm256_mul_pd(a, b)
    }
    #[inline(always)]
    fn permuted<const LANES: i32>(self, a: Self::Four) -> Self::Four {
        self.0.avx2._mm256_permute4x64_pd::<LANES>(a)
    }
    #[inline(always)]
    fn above(self, a: Self::Four, bound: f64) -> u8 {
        let bound = self.0.avx._mm256_set1_pd(bound);
        let greater = self
            .0
            .avx
            ._mm256_cmp_pd::<{ std::arch::x86_64::_CMP_GT_OQ }>(a, bound);
        self.0.avx._mm256_movemask_pd(greater) as u8
    }
    #[inline(always)]
    fn below(self, a: Self::Four, bound: f64) -> u8 {
        let bound = self.0.avx._mm256_set1_pd(bound);
        let less = self
            .0
            .avx
            ._mm256_cmp_pd::<{ std::arch::x86_64::_CMP_LT_OQ }>(a, bound);
        self.0.avx._mm256_movemask_pd(less) as u8
    }
}

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

/// By corner of the positive tetrahedron `corners`: the in-sphere determinant, positive when `p` is inside,
/// of the neighbour opposite that corner, whose fourth vertex is `opposite`. Bit sets of those above `bound`
/// and of those below `-bound`.
///
/// The neighbour opposite corner i has the other three corners, turned around, and opposite vertex i:
///
/// ```text
/// lane        0    1    2    3
/// first       3    2    3    1       (first, second, third, opposite) is positive
/// second      1    0    0    0
/// third       2    3    1    2
/// ```
#[inline(always)]
pub(crate) fn insphere_across<R: Registers>(
    registers: R,
    corners: [DVec3; 4],
    opposite: [DVec3; 4],
    p: DVec3,
    bound: f64,
) -> (u8, u8) {
    const FIRST: i32 = lanes([3, 2, 3, 1]);
    const SECOND: i32 = lanes([1, 0, 0, 0]);
    const THIRD: i32 = lanes([2, 3, 1, 2]);
    let [x, y, z] = differences(registers, corners, p);
    let lift = determinant::lift(&[x, y, z]);
    let opposite = differences(registers, opposite, p);
    let value = determinant::insphere_lifted(
        &[
            x.permuted::<FIRST>(),
            y.permuted::<FIRST>(),
            z.permuted::<FIRST>(),
        ],
        &[
            x.permuted::<SECOND>(),
            y.permuted::<SECOND>(),
            z.permuted::<SECOND>(),
        ],
        &[
            x.permuted::<THIRD>(),
            y.permuted::<THIRD>(),
            z.permuted::<THIRD>(),
        ],
        &opposite,
        &lift.permuted::<FIRST>(),
        &lift.permuted::<SECOND>(),
        &lift.permuted::<THIRD>(),
        &determinant::lift(&opposite),
    );
    (
        registers.above(value.four, bound),
        registers.below(value.four, -bound),
    )
}
