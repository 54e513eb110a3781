//! The distance of points from a closed surface, negative inside.
//!
//! Distances round; their signs do not: they are winding numbers, which are exact.

use crate::edge_table::{EdgeTable, origin};
use crate::winding::RayTarget;
use crate::{MeshError, MeshView, TriangleId};
use pellicle_geometry::triangle::{closest_point, power_of_two_near};
use pellicle_geometry::{Aabb, DVec2, DVec3};
use pellicle_predicates::{Sign, orient2d, orient3d};
use rayon::prelude::*;
use std::ops::ControlFlow;

/// The signed distance from a closed triangle mesh: negative where the mesh winds around a point at least once.
///
/// Built once, asked often. It holds its own copy of the triangles: about 150 bytes each.
///
/// ```
/// use pellicle_geometry::DVec3;
/// use pellicle_mesh::{SignedDistance, icosphere};
/// let distance = SignedDistance::new(&icosphere(4)?)?;
/// let above = distance.sample(2.0 * DVec3::Z);
/// assert!((above.distance - 1.0).abs() < 1e-2 && above.nearest.distance(DVec3::Z) < 1e-2);
/// assert!(distance.sample(0.5 * DVec3::Z).distance < -0.49);
/// # Ok::<(), pellicle_mesh::MeshError>(())
/// ```
#[derive(Clone, Debug)]
pub struct SignedDistance {
    surface: RayTarget,
}

/// What [`SignedDistance`] knows of a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SignedDistanceSample {
    /// The distance from the surface, in the units of the positions: negative inside, positive outside, zero on it.
    pub distance: f64,
    /// The nearest point of the surface.
    pub nearest: DVec3,
    /// The triangle that it lies on; of equally near ones the least.
    pub triangle: TriangleId,
}

impl SignedDistance {
    /// Takes in a mesh without borders: along each edge as many triangles run forth as back. It may have triangles without
    /// area, edges of more than two triangles, and may intersect itself. Unusable triangles are left out.
    ///
    /// O(n log n).
    ///
    /// # Errors
    /// [`MeshError::NotClosed`] names an edge of the border; [`MeshError::NotFinite`] a vertex, if a triangle has it;
    /// [`MeshError::NothingToMeasure`] if there is no usable triangle; [`MeshError::TooLarge`].
    pub fn new<'a>(mesh: impl Into<MeshView<'a>>) -> Result<Self, MeshError> {
        let mesh = mesh.into();
        mesh.check_size()?;
        check_closed(mesh)?;
        let surface = RayTarget::new(mesh);
        match surface.bvh.is_empty() {
            true => Err(MeshError::NothingToMeasure {
                side: "the surface",
            }),
            false => Ok(Self { surface }),
        }
    }

    /// The distance from the surface and its nearest point.
    ///
    /// The sign is that of [`crate::winding_numbers`], inside being 1 and more, and exact for any coordinates; the distance
    /// is +0 if and only if the point lies exactly on a triangle. (One so near that its distance rounds to zero has −0 on the
    /// inside, and the smallest positive number outside.) Otherwise the distance is off by rounding: relative to the
    /// larger of itself and the size of the surface, about 1e-15. From farther than 10⁷ times that size the nearest point is
    /// off by up to 10⁻⁷ of it. For a point that is not finite all three are NaN or none.
    ///
    /// O(log n) where triangles are spread evenly and a ray crosses few.
    pub fn sample(&self, point: DVec3) -> SignedDistanceSample {
        if !point.is_finite() {
            return SignedDistanceSample {
                distance: f64::NAN,
                nearest: DVec3::NAN,
                triangle: TriangleId::NONE,
            };
        }
        if let Some(triangle) = self.triangle_through(point) {
            return SignedDistanceSample {
                distance: 0.0,
                nearest: point,
                triangle,
            };
        }
        let (triangle, nearest, distance) = self.nearest(point);
        let inside = self.is_inside(point);
        SignedDistanceSample {
            distance: match inside {
                true => -distance,
                false => distance.max(f64::from_bits(1)),
            },
            nearest,
            triangle,
        }
    }

    /// [`Self::sample`] for each point, on all threads; the result does not depend on how many.
    pub fn samples(&self, points: &[DVec3]) -> Vec<SignedDistanceSample> {
        points.par_iter().map(|&p| self.sample(p)).collect()
    }

    /// Whether the mesh winds around a point at least once, exactly. A point on the surface counts to the side that
    /// [`crate::winding_numbers`] says.
    pub fn is_inside(&self, point: DVec3) -> bool {
        self.surface.winding(point) >= 1
    }

    /// The triangle that a point lies exactly on; of several the least.
    fn triangle_through(&self, point: DVec3) -> Option<TriangleId> {
        let at = Aabb::EMPTY.with(self.surface.frame.apply(point));
        let mut least = TriangleId::NONE;
        let _ = self.surface.bvh.overlapping(at, |t| {
            if t < least.0 && lies_on(point, self.surface.corners[t as usize]) {
                least = TriangleId(t);
            }
            ControlFlow::Continue(())
        });
        least.some()
    }

    /// The nearest triangle, its nearest point, and the distance.
    fn nearest(&self, point: DVec3) -> (TriangleId, DVec3, f64) {
        let frame = self.surface.frame;
        let actual = frame.apply(point);
        // From farther away all of the surface is nearly as near, and rounding would choose; from here the nearest point is
        // that one to 10⁻⁷ of the surface's size. Nor must squares overflow.
        const FAR: f64 = 1e8;
        let far = actual.abs().max_element();
        let at = match far > FAR {
            true if far.is_finite() => actual / far * FAR,
            true => actual.clamp(DVec3::splat(-FAR), DVec3::splat(FAR)),
            false => actual,
        };
        let framed = |t: u32| self.surface.corners[t as usize].map(|p| frame.apply(p));
        let foot = |t: u32| {
            let [a, b, c] = framed(t);
            closest_point(at, a, b, c)
        };
        let found = self
            .surface
            .bvh
            .nearest(at, |t| at.distance_squared(foot(t)));
        // There is a triangle, and no distance is NaN.
        let t = found.map_or(0, |(t, _)| t);
        let foot = foot(t);
        let corners = self.surface.corners[t as usize];
        // A corner comes back as it is, anything else within the triangle's box.
        let corner = framed(t).iter().position(|&corner| corner == foot);
        let nearest = match corner {
            Some(i) => corners[i],
            None => {
                let bounds = Aabb::of_points(&corners);
                frame.restore(foot).clamp(bounds.min, bounds.max)
            }
        };
        let distance = match far > FAR {
            true => length(point - nearest),
            false => length(actual - foot) * frame.scale,
        };
        (TriangleId(t), nearest, distance)
    }
}

/// An error unless along each edge as many usable triangles run forth as back, over finite positions.
fn check_closed(mesh: MeshView) -> Result<(), MeshError> {
    let usable = mesh.triangles.iter().filter(|&&t| mesh.is_usable(t));
    for &vertex in usable.flatten() {
        let position = mesh.positions[vertex.index()];
        if !position.is_finite() {
            return Err(MeshError::NotFinite { vertex, position });
        }
    }
    for (edge, group) in EdgeTable::new(mesh).edges() {
        let forward = group
            .iter()
            .filter(|e| origin(mesh.triangles, e.half_edge) == edge[0])
            .count();
        let backward = group.len() - forward;
        if forward != backward {
            return Err(MeshError::NotClosed {
                edge,
                forward,
                backward,
            });
        }
    }
    Ok(())
}

/// Whether a point lies on a triangle, its border included, exactly. A triangle without area is a segment or a point.
fn lies_on(p: DVec3, [a, b, c]: [DVec3; 3]) -> bool {
    let bounds = Aabb::of_points(&[a, b, c]);
    if !bounds.overlaps(Aabb::EMPTY.with(p)) || orient3d(a, b, c, p) != Sign::Zero {
        return false;
    }
    // Seen along each axis, p must not lie outside: in a plane that is not seen edge-on, this decides.
    let drops = [
        |v: DVec3| DVec2::new(v.y, v.z),
        |v: DVec3| DVec2::new(v.z, v.x),
        |v: DVec3| DVec2::new(v.x, v.y),
    ];
    let mut flat = true;
    for drop in drops {
        let [u, v, w, q] = [a, b, c, p].map(drop);
        let facing = orient2d(u, v, w);
        if facing != Sign::Zero {
            flat = false;
            let outside = |from, to| {
                let side = orient2d(from, to, q);
                side != Sign::Zero && side != facing
            };
            if outside(u, v) || outside(v, w) || outside(w, u) {
                return false;
            }
        }
    }
    // On one line with the corners and in their box is between them.
    let on_line = |s: DVec3, t: DVec3| {
        drops
            .iter()
            .all(|drop| orient2d(drop(s), drop(t), drop(p)) == Sign::Zero)
    };
    !flat || (on_line(a, b) && on_line(b, c) && on_line(c, a))
}

/// The length, without overflow or underflow on the way.
fn length(v: DVec3) -> f64 {
    let scale = power_of_two_near(v.abs().max_element());
    (v / scale).length() * scale
}
