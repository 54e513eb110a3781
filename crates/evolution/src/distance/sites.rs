//! The points in the order in which the grid meets them, whatever the order of the input.

use super::lattice::Lattice;
use glam::{DVec3, IVec3, UVec3, Vec3};
use rayon::prelude::*;
use std::cmp::Ordering;

/// Rows of voxels that share a tile, on the y and the z axis.
pub(super) const TILE: u32 = 8;

/// The distinct points in voxel coordinates, sorted by tile, then along the rows: neighbours in space are neighbours
/// in memory, and the order depends on the set of points alone.
pub(super) struct Sites {
    /// Voxel coordinates.
    pub exact: Vec<DVec3>,
    /// The same rounded, for the sweeps; one more than there are sites, infinitely far: the site of voxels that know
    /// none yet.
    pub rounded: Vec<[f32; 4]>,
    /// The voxel that a site lies in, or the one nearest to it where it lies outside.
    pub voxels: Vec<UVec3>,
    /// Whether some site lies outside of the lattice.
    pub outside: bool,
}

impl Sites {
    /// The sites of finite points. O(n log n).
    pub fn new(points: &[DVec3], lattice: Lattice) -> Self {
        let last = lattice.dims.as_dvec3() - 1.0;
        let mut items: Vec<(u64, DVec3, UVec3)> = points
            .par_iter()
            .map(|&point| {
                let exact = lattice.to_voxels(point);
                let voxel = exact.round().clamp(DVec3::ZERO, last).as_uvec3();
                (key(voxel), exact, voxel)
            })
            .collect();
        items.par_sort_unstable_by(|a, b| a.0.cmp(&b.0).then_with(|| lexicographic(a.1, b.1)));
        items.dedup_by(|a, b| a.1 == b.1);
        let rounded = items
            .iter()
            .map(|item| item.1.as_vec3().extend(0.0).to_array())
            .chain([[f32::INFINITY; 4]])
            .collect();
        let outside = items.iter().any(|item| item.1.round() != item.2.as_dvec3());
        Self {
            exact: items.iter().map(|item| item.1).collect(),
            voxels: items.iter().map(|item| item.2).collect(),
            rounded,
            outside,
        }
    }

    /// The name of the site that is infinitely far.
    pub fn none(&self) -> u32 {
        self.exact.len() as u32
    }

    /// Rounded voxel coordinates.
    #[inline]
    pub fn position(&self, site: u32) -> Vec3 {
        let [x, y, z, _] = self.rounded[site as usize];
        Vec3::new(x, y, z)
    }

    /// The distance of a site from a voxel's centre, rounded once.
    #[inline]
    pub fn distance(&self, site: u32, voxel: IVec3) -> f32 {
        (self.exact[site as usize] - voxel.as_dvec3()).length() as f32
    }

    /// The range of the sites whose voxels lie in the rows of one tile.
    pub fn in_tile(&self, tile_y: u32, tile_z: u32) -> std::ops::Range<usize> {
        let of = |voxel: &UVec3| (voxel.z / TILE, voxel.y / TILE);
        let start = self.voxels.partition_point(|v| of(v) < (tile_z, tile_y));
        let end = self.voxels.partition_point(|v| of(v) <= (tile_z, tile_y));
        start..end
    }
}

/// Sorts by tile, then by x: 20 bits suffice for a coordinate, since a lattice has at most 2⁶⁰ voxels.
fn key(voxel: UVec3) -> u64 {
    let part = |n: u32, shift: u32| u64::from(n) << shift;
    part(voxel.z / TILE, 42) | part(voxel.y / TILE, 21) | part(voxel.x, 0)
}

fn lexicographic(a: DVec3, b: DVec3) -> Ordering {
    a.x.total_cmp(&b.x)
        .then(a.y.total_cmp(&b.y))
        .then(a.z.total_cmp(&b.z))
}
