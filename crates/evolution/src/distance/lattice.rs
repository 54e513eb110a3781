//! Where the voxels lie.

use super::DistanceOptions;
use crate::Error;
use glam::{DVec3, UVec3};
use pellicle_geometry::Aabb;

/// At least this many voxels on every axis: the stencil of the interpolated gradient.
const LEAST: f64 = 4.0;

/// Cubic voxels in a box. In *voxel coordinates* the centre of voxel (i, j, k) is the point (i, j, k) itself.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Lattice {
    /// The least corner of the box.
    pub min: DVec3,
    /// The side h of a voxel.
    pub spacing: f64,
    /// Voxels on each axis.
    pub dims: UVec3,
}

impl Lattice {
    /// The lattice over the box of the options, widened about its middle to whole voxels.
    pub fn new(cloud: Aabb, options: &DistanceOptions) -> Result<Self, Error> {
        let given = match options.bounds {
            Some(bounds) => bounds,
            None => {
                let margin = DVec3::splat(options.margin * cloud.extent().max_element());
                Aabb {
                    min: cloud.min - margin,
                    max: cloud.max + margin,
                }
            }
        };
        if !(given.min.is_finite() && given.max.is_finite()) {
            return Err(Error::BoundsNotFinite);
        }
        let extent = given.extent();
        let longest = extent.max_element();
        if !longest.is_finite() {
            return Err(Error::BoundsNotFinite);
        }
        // Without margin a flat cloud's box may be flat, but not the longest side of it.
        let spacing = longest / f64::from(options.resolution);
        if !spacing.is_normal() {
            return Err(Error::ZeroExtent);
        }
        // Rounded a little before rounding up, so that a side of 7 voxels does not become 8 by the division's rounding.
        let counts = (extent / spacing - DVec3::splat(1e-9))
            .ceil()
            .max(DVec3::splat(LEAST));
        // A side that is whole already keeps the corner that it was given.
        let widening = (counts * spacing - extent).max(DVec3::ZERO);
        let widening = DVec3::select(widening.cmpgt(extent * 1e-9), widening * 0.5, DVec3::ZERO);
        Ok(Self {
            min: given.min - widening,
            spacing,
            dims: counts.as_uvec3(),
        })
    }

    /// The same lattice with `count` more voxels on every side.
    pub fn extended(self, count: u32) -> Self {
        Self {
            min: self.min - DVec3::splat(self.spacing * f64::from(count)),
            spacing: self.spacing,
            dims: self.dims + 2 * count,
        }
    }

    /// The lattice of voxels `factor` times as long whose centres enclose those of this one.
    pub fn coarser(self, factor: u32) -> Self {
        let spacing = self.spacing * f64::from(factor);
        Self {
            min: self.min - spacing,
            spacing,
            dims: (self.dims + factor - 1) / factor + 2,
        }
    }

    /// How many voxels; saturates.
    pub fn len(self) -> u64 {
        self.dims
            .to_array()
            .iter()
            .fold(1, |product: u64, &n| product.saturating_mul(u64::from(n)))
    }

    /// Voxel coordinates of a point.
    #[inline]
    pub fn to_voxels(self, point: DVec3) -> DVec3 {
        (point - self.min) / self.spacing - 0.5
    }

    /// The point that has these voxel coordinates.
    #[inline]
    pub fn point_at(self, voxels: DVec3) -> DVec3 {
        self.min + (voxels + 0.5) * self.spacing
    }

    /// The box, of whole voxels.
    pub fn bounds(self) -> Aabb {
        Aabb {
            min: self.min,
            max: self.min + self.dims.as_dvec3() * self.spacing,
        }
    }
}
