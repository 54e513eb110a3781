//! Axis-aligned boxes.

use glam::DVec3;

/// An axis-aligned box from `min` to `max`, both inclusive; [`Aabb::EMPTY`] holds nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb {
    /// The least coordinate on each axis.
    pub min: DVec3,
    /// The greatest coordinate on each axis.
    pub max: DVec3,
}

impl Aabb {
    /// The box that holds no point: the neutral element of [`Aabb::union`].
    pub const EMPTY: Self = Self {
        min: DVec3::INFINITY,
        max: DVec3::NEG_INFINITY,
    };

    /// The smallest box around `points`; [`Aabb::EMPTY`] for none. Linear time.
    ///
    /// ```
    /// # use pellicle_geometry::{Aabb, DVec3};
    /// let bounds = Aabb::of_points(&[DVec3::ZERO, DVec3::new(1.0, -2.0, 3.0)]);
    /// assert_eq!(bounds.extent(), DVec3::new(1.0, 2.0, 3.0));
    /// ```
    pub fn of_points(points: &[DVec3]) -> Self {
        points.iter().fold(Self::EMPTY, |bounds, &p| bounds.with(p))
    }

    /// The smallest box around this one and a point.
    #[inline]
    pub fn with(self, point: DVec3) -> Self {
        Self {
            min: self.min.min(point),
            max: self.max.max(point),
        }
    }

    /// The smallest box around both.
    #[inline]
    pub fn union(self, other: Self) -> Self {
        Self {
            min: self.min.min(other.min),
            max: self.max.max(other.max),
        }
    }

    /// Whether the two boxes share a point (touching counts).
    #[inline]
    pub fn overlaps(self, other: Self) -> bool {
        self.min.cmple(other.max).all() && other.min.cmple(self.max).all()
    }

    /// Whether the box holds no point.
    #[inline]
    pub fn is_empty(self) -> bool {
        !self.min.cmple(self.max).all()
    }

    /// The middle of the box, without overflow for any finite corners.
    #[inline]
    pub fn center(self) -> DVec3 {
        self.min * 0.5 + self.max * 0.5
    }

    /// The edge lengths; zero on every axis for the empty box. Infinite where they exceed `f64::MAX`.
    #[inline]
    pub fn extent(self) -> DVec3 {
        if self.is_empty() {
            DVec3::ZERO
        } else {
            self.max - self.min
        }
    }

    /// The length of the diagonal.
    #[inline]
    pub fn diagonal(self) -> f64 {
        self.extent().length()
    }

    /// The square of the distance from a point to the box: zero inside, infinite for the empty box.
    ///
    /// Never above the computed square of the distance from `point` to any point of the box: subtraction,
    /// square and sum round monotonically.
    ///
    /// ```
    /// # use pellicle_geometry::{Aabb, DVec3};
    /// let unit = Aabb { min: DVec3::ZERO, max: DVec3::ONE };
    /// assert_eq!(unit.distance_squared(DVec3::new(0.5, 3.0, -1.0)), 5.0);
    /// ```
    #[inline]
    pub fn distance_squared(self, point: DVec3) -> f64 {
        let gap = (self.min - point).max(point - self.max).max(DVec3::ZERO);
        gap.length_squared()
    }
}
