//! What follows a static filter that could not decide, kept out of the callers' loops.

use super::{DVec2, DVec3, Sign, lifted};

#[cold]
#[inline(never)]
pub(super) fn orient2d(a: DVec2, b: DVec2, c: DVec2) -> Sign {
    crate::orient2d(a, b, c)
}

#[cold]
#[inline(never)]
pub(super) fn orient3d(a: DVec3, b: DVec3, c: DVec3, d: DVec3) -> Sign {
    crate::orient3d(a, b, c, d)
}

#[cold]
#[inline(never)]
pub(super) fn incircle(a: DVec2, b: DVec2, c: DVec2, d: DVec2) -> Sign {
    crate::incircle(a, b, c, d)
}

#[cold]
#[inline(never)]
pub(super) fn insphere(a: DVec3, b: DVec3, c: DVec3, d: DVec3, e: DVec3) -> Sign {
    crate::insphere(a, b, c, d, e)
}

#[cold]
#[inline(never)]
pub(super) fn power_test(
    a: DVec3,
    b: DVec3,
    c: DVec3,
    d: DVec3,
    e: DVec3,
    weights: [f64; 5],
) -> Sign {
    crate::power_test(a, b, c, d, e, weights)
}

#[cold]
#[inline(never)]
pub(super) fn power_test_perturbed(
    a: DVec3,
    b: DVec3,
    c: DVec3,
    d: DVec3,
    e: DVec3,
    weights: [f64; 5],
) -> Sign {
    lifted::power_test(a, b, c, d, e, weights)
}

#[cold]
#[inline(never)]
pub(super) fn insphere_perturbed(a: DVec3, b: DVec3, c: DVec3, d: DVec3, e: DVec3) -> Sign {
    lifted::insphere(a, b, c, d, e)
}
