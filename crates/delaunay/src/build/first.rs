//! The first tetrahedron.

use crate::Error;
use glam::{DVec2, DVec3};
use pellicle_predicates::{Sign, orient2d, orient3d};

/// Moves the first four points of `order` that span a tetrahedron to its front, positively oriented; the
/// others keep their order. Linear time.
pub(super) fn four_that_span(points: &[DVec3], order: &mut [u32]) -> Result<(), Error> {
    let distinct = order.len();
    let at = |order: &[u32], i: usize| points[order[i] as usize];
    if distinct < 4 {
        return Err(Error::TooFewPoints { distinct });
    }
    let (a, b) = (at(order, 0), at(order, 1));

    let third = (2..distinct)
        .find(|&i| !collinear(a, b, at(order, i)))
        .ok_or(Error::Collinear { distinct })?;
    order[2..=third].rotate_right(1);
    let c = at(order, 2);

    let fourth = (3..distinct)
        .find(|&i| orient3d(a, b, c, at(order, i)) != Sign::Zero)
        .ok_or(Error::Coplanar { distinct })?;
    order[3..=fourth].rotate_right(1);

    if orient3d(a, b, c, at(order, 3)) == Sign::Negative {
        order.swap(0, 1);
    }
    Ok(())
}

/// Whether three points lie on one line, exactly: their projections along each axis do.
pub(crate) fn collinear(a: DVec3, b: DVec3, c: DVec3) -> bool {
    let projected = |along: fn(DVec3) -> DVec2| orient2d(along(a), along(b), along(c));
    projected(|p| DVec2::new(p.x, p.y)) == Sign::Zero
        && projected(|p| DVec2::new(p.y, p.z)) == Sign::Zero
        && projected(|p| DVec2::new(p.z, p.x)) == Sign::Zero
}
