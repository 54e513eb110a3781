//! The exact closest sites of the voxels of a region, from lists of candidates that shrink with the region.
//!
//! ```text
//!     ┌─────┐ near           A voxel of the region is at most `far` of p from p, whichever p: so its closest
//!     │     ├──────▶ q       site is at most u = min far away. A site q with near > u is nowhere closest: not
//!     │     │                in the region nor in any part of it.
//!     └─────┘
//!    p ◀───┘ far
//! ```

use super::sites::Sites;
use glam::{IVec3, UVec3, Vec3};

/// The side of the regions that are not divided further.
pub(super) const LEAF: u32 = 4;

const SIDE: usize = LEAF as usize;

/// Voxels of a leaf.
pub(super) const LEAF_LEN: usize = (LEAF * LEAF * LEAF) as usize;

/// A box of voxels, which may reach beyond the lattice.
#[derive(Clone, Copy, Debug)]
pub(super) struct Region {
    /// The least voxel.
    pub low: IVec3,
    /// How many on each axis.
    pub size: UVec3,
}

impl Region {
    /// The region and `count` voxels more on every side.
    pub fn inflated(self, count: u32) -> Self {
        Self {
            low: self.low - count as i32,
            size: self.size + 2 * count,
        }
    }

    /// Whether it shares a voxel with another.
    pub fn overlaps(self, other: Self) -> bool {
        let (end, other_end) = (
            self.low + self.size.as_ivec3(),
            other.low + other.size.as_ivec3(),
        );
        self.low.cmplt(other_end).all() && other.low.cmplt(end).all()
    }

    /// Halves it on every axis that is longer than `unit`, at multiples of `unit` from its least voxel.
    fn parts(self, unit: u32) -> impl Iterator<Item = Self> {
        let first = ((self.size + 2 * unit - 1) / (2 * unit) * unit).min(self.size);
        (0..8_u32).filter_map(move |octant| {
            let upper = UVec3::new(octant & 1, octant >> 1 & 1, octant >> 2);
            let low = self.low + (upper * first).as_ivec3();
            let size = UVec3::select(upper.cmpeq(UVec3::ONE), self.size - first, first);
            size.cmpgt(UVec3::ZERO).all().then_some(Self { low, size })
        })
    }
}

/// How regions are searched.
#[derive(Clone, Copy)]
pub(super) struct Search<'a> {
    pub sites: &'a Sites,
    /// Regions are divided until they are this long.
    pub unit: u32,
    /// Candidates are also right for this many voxels around a region.
    pub halo: u32,
}

impl Search<'_> {
    /// Divides a region into cubes of side `unit`, with their candidates. Regions that are not `wanted`, given a lower
    /// bound of the distance of their voxels from any site, are left out.
    pub fn divide(
        self,
        region: Region,
        candidates: &[u32],
        wanted: &mut impl FnMut(Region, f32) -> bool,
        found: &mut impl FnMut(Region, &[u32]),
    ) {
        let (mut squares, mut kept) = (Vec::new(), Vec::new());
        let lower = self.filter(region, candidates, &mut squares, &mut kept);
        if !wanted(region, lower) {
            return;
        }
        if region.size.cmple(UVec3::splat(self.unit)).all() {
            found(region, &kept);
            return;
        }
        drop(squares);
        for part in region.parts(self.unit) {
            self.divide(part, &kept, wanted, found);
        }
    }

    /// Keeps the candidates of a region, and tells a lower bound of their distance from it.
    fn filter(
        self,
        region: Region,
        candidates: &[u32],
        squares: &mut Vec<f32>,
        kept: &mut Vec<u32>,
    ) -> f32 {
        let region = region.inflated(self.halo);
        let half = (region.size.as_vec3() - 1.0) * 0.5;
        let middle = region.low.as_vec3() + half;
        let (mut nearest, mut upper) = (f32::INFINITY, f32::INFINITY);
        squares.extend(candidates.iter().map(|&site| {
            let offset = (self.sites.position(site) - middle).abs();
            let beside = offset - half;
            let near = beside.max(Vec3::ZERO).length_squared();
            nearest = if near < nearest { near } else { nearest };
            let far = (offset + half).length_squared();
            upper = if far < upper { far } else { upper };
            near
        }));
        // Rounded up: a candidate too many does no harm.
        let limit = upper.sqrt() * 1.0001 + 1e-3;
        let limit = limit * limit;
        let pairs = candidates.iter().zip(squares.iter());
        kept.extend(
            pairs
                .filter(|&(_, &near)| near <= limit)
                .map(|(&site, _)| site),
        );
        nearest.sqrt()
    }
}

/// The closest site of each voxel of a leaf, and the square of its distance. Of equally close sites the first.
pub(super) struct Leaf {
    pub sites: [u32; LEAF_LEN],
    squares: [f32; LEAF_LEN],
}

impl Leaf {
    /// Of the cube whose least voxel is `low`, x fastest.
    pub fn new(low: IVec3, candidates: &[u32], sites: &Sites) -> Self {
        let mut leaf = Self {
            sites: [sites.none(); LEAF_LEN],
            squares: [f32::INFINITY; LEAF_LEN],
        };
        let xs = [0, 1, 2, 3].map(|i| (low.x + i) as f32);
        let rows = leaf.sites.as_chunks_mut::<SIDE>().0;
        let rows = rows.iter_mut().zip(leaf.squares.as_chunks_mut::<SIDE>().0);
        // A row at a time, its four voxels at once and without branches.
        for ((closest, least), row) in rows.zip(0..) {
            let (y, z) = ((low.y + row % 4) as f32, (low.z + row / 4) as f32);
            for &site in candidates {
                let [px, py, pz, _] = sites.rounded[site as usize];
                let (dy, dz) = (py - y, pz - z);
                let across = dy * dy + dz * dz;
                for i in 0..SIDE {
                    let dx = px - xs[i];
                    let square = dx * dx + across;
                    let closer = u32::from(square < least[i]).wrapping_neg();
                    closest[i] = (site & closer) | (closest[i] & !closer);
                    least[i] = if square < least[i] { square } else { least[i] };
                }
            }
        }
        leaf
    }
}
