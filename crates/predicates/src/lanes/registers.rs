//! Registers of the machine behind one trait, and what is compiled for each kind of them.

/// Registers of four doubles.
pub trait Registers: Copy {
    /// Four doubles.
    type Four: Copy;
    /// Yes or no, one a lane.
    type Mask: Copy;
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
    /// Absolute values, lane by lane.
    fn abs(self, a: Self::Four) -> Self::Four;
    /// The greater one, lane by lane; not for NaN.
    fn max(self, a: Self::Four, b: Self::Four) -> Self::Four;
    /// Bit i says whether lane i of `a` is greater than that of `b`.
    fn greater(self, a: Self::Four, b: Self::Four) -> u8;
    /// Whether `a` is greater than `b`, lane by lane.
    fn is_greater(self, a: Self::Four, b: Self::Four) -> Self::Mask;
    /// Whether `a` equals `b`, lane by lane.
    fn is_equal(self, a: Self::Four, b: Self::Four) -> Self::Mask;
    /// Whether both are, lane by lane.
    fn both(self, a: Self::Mask, b: Self::Mask) -> Self::Mask;
    /// Whether one of them is, lane by lane.
    fn either(self, a: Self::Mask, b: Self::Mask) -> Self::Mask;
    /// Where `mask` says yes the lane of `yes`, elsewhere that of `no`.
    fn select(self, mask: Self::Mask, yes: Self::Four, no: Self::Four) -> Self::Four;
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
///         registers.greater(registers.set(self.0), registers.set([0.0; 4]))
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
        let call = Call(work, Avx2(instructions));
        // With these there are twice as many registers of 256 bits, and masks have registers of their own.
        return match pulp::x86::V4::try_new() {
            Some(more) => more.vectorize(call),
            None => instructions.vectorize(call),
        };
    }
    work.run(Plain)
}

/// An array in place of a register.
#[derive(Clone, Copy)]
pub(crate) struct Plain;

#[inline(always)]
fn zip([a, b, c, d]: [f64; 4], [e, f, g, h]: [f64; 4], of: impl Fn(f64, f64) -> f64) -> [f64; 4] {
    [of(a, e), of(b, f), of(c, g), of(d, h)]
}

impl Registers for Plain {
    type Four = [f64; 4];
    type Mask = [bool; 4];

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
    fn abs(self, [a, b, c, d]: [f64; 4]) -> [f64; 4] {
        [a.abs(), b.abs(), c.abs(), d.abs()]
    }
    #[inline(always)]
    fn max(self, a: [f64; 4], b: [f64; 4]) -> [f64; 4] {
        zip(a, b, |x, y| if x > y { x } else { y })
    }
    #[inline(always)]
    fn greater(self, a: [f64; 4], b: [f64; 4]) -> u8 {
        let bit = |i: usize| u8::from(a[i] > b[i]) << i;
        bit(0) | bit(1) | bit(2) | bit(3)
    }
    #[inline(always)]
    fn is_greater(self, a: [f64; 4], b: [f64; 4]) -> [bool; 4] {
        std::array::from_fn(|i| a[i] > b[i])
    }
    #[inline(always)]
    fn is_equal(self, a: [f64; 4], b: [f64; 4]) -> [bool; 4] {
        std::array::from_fn(|i| a[i] == b[i])
    }
    #[inline(always)]
    fn both(self, a: [bool; 4], b: [bool; 4]) -> [bool; 4] {
        std::array::from_fn(|i| a[i] & b[i])
    }
    #[inline(always)]
    fn either(self, a: [bool; 4], b: [bool; 4]) -> [bool; 4] {
        std::array::from_fn(|i| a[i] | b[i])
    }
    #[inline(always)]
    fn select(self, mask: [bool; 4], yes: [f64; 4], no: [f64; 4]) -> [f64; 4] {
        std::array::from_fn(|i| if mask[i] { yes[i] } else { no[i] })
    }
}

/// The registers of a machine with AVX2, which the token proves this one to be.
#[cfg(target_arch = "x86_64")]
#[derive(Clone, Copy)]
struct Avx2(pulp::x86::V3);

#[cfg(target_arch = "x86_64")]
impl Registers for Avx2 {
    type Four = std::arch::x86_64::__m256d;
    type Mask = std::arch::x86_64::__m256d;

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
    fn abs(self, a: Self::Four) -> Self::Four {
        let sign = self.0.avx._mm256_set1_pd(-0.0);
        self.0.avx._mm256_andnot_pd(sign, a)
    }
    #[inline(always)]
    fn max(self, a: Self::Four, b: Self::Four) -> Self::Four {
        self.0.avx._mm256_max_pd(a, b)
    }
    #[inline(always)]
    fn greater(self, a: Self::Four, b: Self::Four) -> u8 {
        let avx = self.0.avx;
        let greater = avx._mm256_cmp_pd::<{ std::arch::x86_64::_CMP_GT_OQ }>(a, b);
        avx._mm256_movemask_pd(greater) as u8
    }
    #[inline(always)]
    fn is_greater(self, a: Self::Four, b: Self::Four) -> Self::Mask {
        self.0
            .avx
            ._mm256_cmp_pd::<{ std::arch::x86_64::_CMP_GT_OQ }>(a, b)
    }
    #[inline(always)]
    fn is_equal(self, a: Self::Four, b: Self::Four) -> Self::Mask {
        self.0
            .avx
            ._mm256_cmp_pd::<{ std::arch::x86_64::_CMP_EQ_OQ }>(a, b)
    }
    #[inline(always)]
    fn both(self, a: Self::Mask, b: Self::Mask) -> Self::Mask {
        self.0.avx._mm256_and_pd(a, b)
    }
    #[inline(always)]
    fn either(self, a: Self::Mask, b: Self::Mask) -> Self::Mask {
        self.0.avx._mm256_or_pd(a, b)
    }
    #[inline(always)]
    fn select(self, mask: Self::Mask, yes: Self::Four, no: Self::Four) -> Self::Four {
        self.0.avx._mm256_blendv_pd(no, yes, mask)
    }
}
