//! Ids of triangles and half-edges.

use pellicle_geometry::define_id;

define_id! {
    /// A triangle: an index into a mesh's triangles.
    pub struct TriangleId;
}

define_id! {
    /// A half-edge: `3t + i` runs from corner `i` of triangle `t` to corner `i + 1` (modulo 3).
    ///
    /// ```text
    ///            2
    ///           / \
    ///   3t+2   /   \   3t+1        counter-clockwise, seen from outside
    ///         /  t  \
    ///        0 ----- 1
    ///           3t
    /// ```
    pub struct HalfEdgeId;
}

impl HalfEdgeId {
    /// The half-edge that leaves corner `corner` (0, 1 or 2) of `triangle`.
    #[inline]
    pub fn of(triangle: TriangleId, corner: usize) -> Self {
        debug_assert!(corner < 3, "a triangle has three corners");
        Self(3 * triangle.0 + corner as u32)
    }

    /// The triangle at its left.
    #[inline]
    pub fn triangle(self) -> TriangleId {
        TriangleId(self.0 / 3)
    }

    /// The corner that it leaves: 0, 1 or 2.
    #[inline]
    pub fn corner(self) -> usize {
        (self.0 % 3) as usize
    }

    /// The next half-edge of the same triangle, counter-clockwise.
    #[inline]
    #[must_use]
    pub fn next(self) -> Self {
        if self.corner() == 2 {
            Self(self.0 - 2)
        } else {
            Self(self.0 + 1)
        }
    }

    /// The half-edge before it in the same triangle.
    #[inline]
    #[must_use]
    pub fn previous(self) -> Self {
        if self.corner() == 0 {
            Self(self.0 + 2)
        } else {
            Self(self.0 - 1)
        }
    }
}
