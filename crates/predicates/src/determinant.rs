//! The five determinants, each written once and evaluated over doubles, intervals, integers and
//! polynomials alike.
//!
//! The arguments are vectors already translated by the last point of the predicate. The order of the
//! operations matters: the filters' error bounds count the roundings along it.

/// A commutative ring, or something that behaves like one up to rounding.
pub(crate) trait Ring: Clone {
    fn add(&self, other: &Self) -> Self;
    fn sub(&self, other: &Self) -> Self;
    fn mul(&self, other: &Self) -> Self;

    #[inline(always)]
    fn square(&self) -> Self {
        self.mul(self)
    }
}

impl Ring for f64 {
    #[inline(always)]
    fn add(&self, other: &Self) -> Self {
        self + other
    }
    #[inline(always)]
    fn sub(&self, other: &Self) -> Self {
        self - other
    }
    #[inline(always)]
    fn mul(&self, other: &Self) -> Self {
        self * other
    }
}

/// p − q, coordinate by coordinate.
#[inline(always)]
pub(crate) fn translated<R: Ring, const D: usize>(p: &[R; D], q: &[R; D]) -> [R; D] {
    std::array::from_fn(|i| p[i].sub(&q[i]))
}

/// x₀y₁ − y₀x₁: the minor of two vectors in their first two coordinates.
#[inline(always)]
fn minor<R: Ring, const D: usize>(x: &[R; D], y: &[R; D]) -> R {
    x[0].mul(&y[1]).sub(&y[0].mul(&x[1]))
}

/// det[a, b]: positive when a, b, 0 turn counter-clockwise.
#[inline(always)]
pub(crate) fn orient2d<R: Ring>(a: &[R; 2], b: &[R; 2]) -> R {
    minor(a, b)
}

/// −det[a, b, c]: positive when (a, b, c, 0) is positively oriented.
#[inline(always)]
pub(crate) fn orient3d<R: Ring>(a: &[R; 3], b: &[R; 3], c: &[R; 3]) -> R {
    let ba = minor(b, a);
    let ac = minor(a, c);
    let cb = minor(c, b);
    (b[2].mul(&ac).add(&a[2].mul(&cb))).add(&c[2].mul(&ba))
}

/// |a|² det[b, c] + |b|² det[c, a] + |c|² det[a, b]: positive when 0 lies inside the circle through the
/// counter-clockwise a, b, c.
#[inline(always)]
pub(crate) fn incircle<R: Ring>(a: &[R; 2], b: &[R; 2], c: &[R; 2]) -> R {
    let lift = |p: &[R; 2]| p[0].square().add(&p[1].square());
    (lift(a).mul(&minor(b, c)).add(&lift(b).mul(&minor(c, a)))).add(&lift(c).mul(&minor(a, b)))
}

/// Positive when 0 lies inside the sphere through the positively oriented a, b, c, d.
#[inline(always)]
pub(crate) fn insphere<R: Ring>(a: &[R; 3], b: &[R; 3], c: &[R; 3], d: &[R; 3]) -> R {
    insphere_lifted(a, b, c, d, &lift(a), &lift(b), &lift(c), &lift(d))
}

/// |p|².
#[inline(always)]
pub(crate) fn lift<R: Ring>(p: &[R; 3]) -> R {
    (p[0].square().add(&p[1].square())).add(&p[2].square())
}

/// [`insphere`] of vectors whose lifts are known.
#[inline(always)]
#[expect(clippy::too_many_arguments, reason = "four vectors and their lifts")]
pub(crate) fn insphere_lifted<R: Ring>(
    a: &[R; 3],
    b: &[R; 3],
    c: &[R; 3],
    d: &[R; 3],
    lift_a: &R,
    lift_b: &R,
    lift_c: &R,
    lift_d: &R,
) -> R {
    weighted(
        &insphere_coefficients(a, b, c, d),
        [lift_a, lift_b, lift_c, lift_d],
    )
}

/// The determinants by which [`insphere_lifted`] weights the lifts of a, b, c, d; those of b and d it takes away. The six
/// minors in x and y are shared by the four.
#[inline(always)]
pub(crate) fn insphere_coefficients<R: Ring>(
    a: &[R; 3],
    b: &[R; 3],
    c: &[R; 3],
    d: &[R; 3],
) -> [R; 4] {
    let ab = minor(a, b);
    let bc = minor(b, c);
    let cd = minor(c, d);
    let da = minor(d, a);
    let ac = minor(a, c);
    let bd = minor(b, d);
    let abc = (a[2].mul(&bc).sub(&b[2].mul(&ac))).add(&c[2].mul(&ab));
    let bcd = (b[2].mul(&cd).sub(&c[2].mul(&bd))).add(&d[2].mul(&bc));
    let cda = (c[2].mul(&da).add(&d[2].mul(&ac))).add(&a[2].mul(&cd));
    let dab = (d[2].mul(&ab).add(&a[2].mul(&bd))).add(&b[2].mul(&da));
    [bcd, cda, dab, abc]
}

/// The lifts of a, b, c, d, weighted by their coefficients.
#[inline(always)]
pub(crate) fn weighted<R: Ring>([bcd, cda, dab, abc]: &[R; 4], [a, b, c, d]: [&R; 4]) -> R {
    (c.mul(dab).sub(&d.mul(abc))).add(&(a.mul(bcd).sub(&b.mul(cda))))
}

/// Positive when the lift of 0 with weight zero lies below the hyperplane through the lifts of the positively
/// oriented points with the given weights.
#[inline(always)]
pub(crate) fn power_test<R: Ring>([a, b, c, d]: [&[R; 3]; 4], weights: &[R; 4]) -> R {
    let [wa, wb, wc, wd] = weights;
    insphere_lifted(
        a,
        b,
        c,
        d,
        &lift(a).sub(wa),
        &lift(b).sub(wb),
        &lift(c).sub(wc),
        &lift(d).sub(wd),
    )
}
