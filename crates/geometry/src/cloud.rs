//! Point clouds.

use crate::{Aabb, VertexId};
use glam::DVec3;

/// Points with finite coordinates, and optionally a normal each.
///
/// ```
/// use pellicle_geometry::{DVec3, PointCloud};
/// let cloud = PointCloud::new(vec![DVec3::ZERO, DVec3::X])?;
/// assert_eq!(cloud.len(), 2);
/// assert!(PointCloud::new(vec![DVec3::NAN]).is_err());
/// # Ok::<(), pellicle_geometry::CloudError>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PointCloud {
    positions: Vec<DVec3>,
    normals: Option<Vec<DVec3>>,
}

/// Why points do not make a cloud.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CloudError {
    /// A coordinate is NaN or infinite.
    #[error("point {} has a coordinate that is not finite: {position}", .vertex.0)]
    NotFinite {
        /// The first such point.
        vertex: VertexId,
        /// Its coordinates.
        position: DVec3,
    },
    /// There are not as many normals as points.
    #[error("{normals} normals for {points} points")]
    NormalCount {
        /// How many points.
        points: usize,
        /// How many normals.
        normals: usize,
    },
    /// More points than `u32` ids can name.
    #[error("{points} points: at most 2^32 - 2 are supported")]
    TooManyPoints {
        /// How many points.
        points: usize,
    },
}

impl PointCloud {
    /// A cloud without normals. Refuses NaN and infinity. Linear time.
    pub fn new(positions: Vec<DVec3>) -> Result<Self, CloudError> {
        if positions.len() >= u32::MAX as usize {
            return Err(CloudError::TooManyPoints {
                points: positions.len(),
            });
        }
        match first_not_finite(&positions) {
            Some(vertex) => Err(CloudError::NotFinite {
                vertex,
                position: positions[vertex.index()],
            }),
            None => Ok(Self {
                positions,
                normals: None,
            }),
        }
    }

    /// The same cloud with a normal for each point. Normals may be of any length, zero and NaN included:
    /// they are data, not decided upon.
    pub fn with_normals(mut self, normals: Vec<DVec3>) -> Result<Self, CloudError> {
        if normals.len() != self.positions.len() {
            return Err(CloudError::NormalCount {
                points: self.positions.len(),
                normals: normals.len(),
            });
        }
        self.normals = Some(normals);
        Ok(self)
    }

    /// The points.
    pub fn positions(&self) -> &[DVec3] {
        &self.positions
    }

    /// The normals, one a point, if there are any.
    pub fn normals(&self) -> Option<&[DVec3]> {
        self.normals.as_deref()
    }

    /// The points and normals themselves.
    pub fn into_parts(self) -> (Vec<DVec3>, Option<Vec<DVec3>>) {
        (self.positions, self.normals)
    }

    /// How many points.
    pub fn len(&self) -> usize {
        self.positions.len()
    }

    /// Whether there is no point.
    pub fn is_empty(&self) -> bool {
        self.positions.is_empty()
    }

    /// The smallest box around the points.
    pub fn bounds(&self) -> Aabb {
        Aabb::of_points(&self.positions)
    }
}

/// The first point with a coordinate that is NaN or infinite. Linear time.
pub fn first_not_finite(points: &[DVec3]) -> Option<VertexId> {
    points
        .iter()
        .position(|p| !p.is_finite())
        .map(VertexId::new)
}
