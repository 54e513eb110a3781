//! How often a mesh winds around a point, exactly, by the triangles that a ray crosses.
//!
//! The ray goes from p along +x. Where it meets an edge or a vertex, p is moved, in thought, to p + (0, ε, ε²) with an
//! infinitesimal ε: then no ray meets an edge, unless the edge is a point, and signs that vanish are decided by their
//! derivatives.
//!
//! ```text
//!            n      n = (b − a) × (c − a), the triangle's outward normal.
//!        c ↗        p → crosses it ahead if n·(p − a) and n_x have opposite signs:
//!   p →  |\  →      outwards, and winds once more, if n_x > 0; inwards, once less, if n_x < 0.
//!        | \
//!        a--b
//! ```

use crate::MeshView;
use crate::frame::Frame;
use crate::measure::measurable;
use pellicle_geometry::{Aabb, DVec2, DVec3};
use pellicle_predicates::{Sign, orient2d, orient3d};
use pellicle_spatial::Bvh;
use rayon::prelude::*;
use std::ops::ControlFlow;

/// How often a closed mesh winds around each of some points: 1 inside of a mesh whose triangles are counter-clockwise
/// seen from outside, 0 outside, 2 where two such solids overlap, −1 inside of one turned inside out.
///
/// Exact for any coordinates. A point on the surface counts to the side on which p + (0, ε, ε²) lies, for an infinitesimal
/// ε. Unusable triangles count for nothing; for an open mesh the result depends on the axes. Points that are not finite
/// have 0. O((n + points) log n) where rays cross few triangles, on all threads.
///
/// ```
/// use pellicle_geometry::DVec3;
/// use pellicle_mesh::{icosphere, winding_numbers};
/// let sphere = icosphere(2)?;
/// let points = [DVec3::ZERO, 0.9 * DVec3::X, 1.1 * DVec3::X];
/// assert_eq!(winding_numbers((&sphere).into(), &points), [1, 1, 0]);
/// # Ok::<(), pellicle_mesh::MeshError>(())
/// ```
pub fn winding_numbers(mesh: MeshView, points: &[DVec3]) -> Vec<i32> {
    let surface = RayTarget::new(mesh);
    points.par_iter().map(|&p| surface.winding(p)).collect()
}

/// Triangles that rays are tested against, in a hierarchy.
///
/// Its boxes are those of the triangles in the frame, so that the same hierarchy serves for distances. No candidate is lost
/// to rounding there: a frame rounds monotonically, so boxes that meet still meet; candidates are decided by the corners as
/// given.
#[derive(Clone, Debug)]
pub(crate) struct RayTarget {
    pub(crate) frame: Frame,
    /// The corners of each triangle; those of unusable triangles are NaN, and their boxes are empty.
    pub(crate) corners: Vec<[DVec3; 3]>,
    pub(crate) bvh: Bvh,
}

impl RayTarget {
    pub(crate) fn new(mesh: MeshView) -> Self {
        // Isolated vertices must not set the scale.
        let used: Vec<[DVec3; 3]> = measurable(mesh).map(|(_, corners)| corners).collect();
        let frame = Frame::of(used.as_flattened());
        let mut corners = vec![[DVec3::NAN; 3]; mesh.triangles.len()];
        let mut boxes = vec![Aabb::EMPTY; mesh.triangles.len()];
        for (t, found) in measurable(mesh) {
            corners[t] = found;
            boxes[t] = Aabb::of_points(&found.map(|p| frame.apply(p)));
        }
        Self {
            frame,
            corners,
            bvh: Bvh::new(boxes),
        }
    }

    /// How often the triangles wind around `p`; 0 if that is not finite.
    pub(crate) fn winding(&self, p: DVec3) -> i32 {
        if !p.is_finite() {
            return 0;
        }
        let start = self.frame.apply(p);
        let ray = Aabb::of_points(&[start, start.with_x(f64::INFINITY)]);
        let mut winding = 0;
        let _ = self.bvh.overlapping(ray, |t| {
            winding += crossing(self.corners[t as usize], p);
            ControlFlow::Continue(())
        });
        winding
    }
}

/// 1 if the ray from `p` along +x leaves through the triangle, −1 if it enters, 0 if it misses.
fn crossing([a, b, c]: [DVec3; 3], p: DVec3) -> i32 {
    let yz = |v: DVec3| DVec2::new(v.y, v.z);
    // A triangle parallel to the ray has no inside that a moved ray could meet.
    let n_x = orient2d(yz(a), yz(b), yz(c));
    if n_x == Sign::Zero {
        return 0;
    }
    let sides = [(a, b), (b, c), (c, a)].map(|(from, to)| side(yz(from), yz(to), yz(p)));
    if sides != [n_x; 3] {
        return 0;
    }
    let ahead = match orient3d(a, b, c, p) {
        Sign::Zero => {
            let n_y = orient2d(
                DVec2::new(a.z, a.x),
                DVec2::new(b.z, b.x),
                DVec2::new(c.z, c.x),
            );
            let n_z = orient2d(
                DVec2::new(a.x, a.y),
                DVec2::new(b.x, b.y),
                DVec2::new(c.x, c.y),
            );
            if n_y == Sign::Zero { n_z } else { n_y }
        }
        sign => sign,
    };
    match (n_x, ahead) {
        (Sign::Positive, Sign::Negative) => 1,
        (Sign::Negative, Sign::Positive) => -1,
        _ => 0,
    }
}

/// The side of the line from `a` to `b` that p + (ε, ε²) lies on; zero only if they coincide.
fn side(a: DVec2, b: DVec2, p: DVec2) -> Sign {
    let sign_of = |less: f64, more: f64| match less.partial_cmp(&more) {
        Some(std::cmp::Ordering::Less) => Sign::Positive,
        Some(std::cmp::Ordering::Greater) => Sign::Negative,
        _ => Sign::Zero,
    };
    // ∂/∂p_x = a_y − b_y, ∂/∂p_y = b_x − a_x.
    match orient2d(a, b, p) {
        Sign::Zero => match sign_of(b.y, a.y) {
            Sign::Zero => sign_of(a.x, b.x),
            sign => sign,
        },
        sign => sign,
    }
}
