//! Values at full resolution near the points only, and a coarse dense grid everywhere.
//!
//! ```text
//!   bricks of 64³ voxels, those near points      ┌────────┬────────┐
//!   └─ blocks of 8³ voxels, those near points    │  ▞▚    │        │   v = w · fine + (1 − w) · coarse,
//!                                                │ ▞  ▚▞▚ │        │   w = 1 where fine ≤ band / 2,
//!   coarse grid: voxels of 4 h                   ├▞──────▚┼▞▚──────┤   w = 0 where fine ≥ band
//! ```
//!
//! The weight is a function of the fine value, so the field is continuous: blocks are stored wherever the fine value
//! can be below the band.
//!
//! Fine values are the regularised *exact* distances (see [`nearest`](super::nearest)).

use super::gauss::Kernel;
use super::interpolate::{self, Axis};
use super::lattice::Lattice;
use super::nearest::{LEAF, Leaf, Region, Search};
use super::sites::Sites;
use super::{DistanceOptions, check_limit, dense_bytes, dense_values};
use crate::Error;
use glam::{DVec3, IVec3, UVec3};
use pellicle_geometry::{Cancelled, Progress};
use rayon::prelude::*;
use std::sync::atomic::{AtomicU64, Ordering};

/// Voxels along a block.
const BLOCK: u32 = 8;
const BLOCK_LEN: usize = (BLOCK * BLOCK * BLOCK) as usize;

/// Blocks along a brick.
const BRICK: u32 = 8;
const BRICK_LEN: usize = (BRICK * BRICK * BRICK) as usize;

/// Voxels along a brick.
const SIDE: u32 = BLOCK * BRICK;

/// The voxels of the coarse grid are this many times longer.
const COARSE: u32 = 4;

/// No brick, no block.
const NONE: u32 = u32::MAX;

/// Blocks of 64³ voxels.
#[derive(Clone, Debug)]
struct Brick {
    /// The place of each block in `values`, in blocks.
    blocks: Vec<u32>,
    values: Vec<f32>,
}

/// The sparse store. Values in fine voxels, except the coarse ones, in coarse voxels.
#[derive(Clone, Debug)]
pub(super) struct Sparse {
    /// In fine voxels.
    band: f64,
    coarse_dims: UVec3,
    coarse: Vec<f32>,
    /// Bricks on each axis, and the place of each in `bricks`.
    table_dims: UVec3,
    table: Vec<u32>,
    bricks: Vec<Brick>,
}

/// A brick before its values are known.
struct Plan {
    /// Its least voxel; in these coordinates the voxels of the grid begin at the reach of the kernel.
    low: IVec3,
    candidates: Vec<u32>,
    /// The blocks to compute.
    blocks: Vec<u32>,
}

impl Sparse {
    /// The store of the voxels of `lattice`.
    pub fn new(
        points: &[DVec3],
        lattice: Lattice,
        options: &DistanceOptions,
        progress: &dyn Progress,
    ) -> Result<Self, Error> {
        let coarse_lattice = lattice.coarser(COARSE);
        let coarse_kernel = Kernel::new(options.sigma / f64::from(COARSE));
        let table_dims = (lattice.dims + SIDE - 1) / SIDE;
        let table_bytes = table_dims
            .to_array()
            .iter()
            .fold(4, |bytes: u64, &n| bytes.saturating_mul(u64::from(n)));
        let known = dense_bytes(points, coarse_lattice, &coarse_kernel).saturating_add(table_bytes);
        check_limit(known, options)?;
        let coarse = dense_values(points, coarse_lattice, &coarse_kernel, progress)?;

        let kernel = Kernel::new(options.sigma);
        let sites = Sites::new(points, lattice.extended(kernel.radius() as u32));
        let plans = plans(&sites, lattice.dims, &kernel, options);
        let blocks: u64 = plans.iter().map(|plan| plan.blocks.len() as u64).sum();
        let scratch = 4 * u64::from(SIDE + 2 * kernel.radius() as u32).pow(3);
        let fine = blocks * 4 * BLOCK_LEN as u64
            + plans.len() as u64 * 4 * BRICK_LEN as u64
            + rayon::current_num_threads() as u64 * scratch;
        check_limit(
            known.max(table_bytes + 128 * points.len() as u64 + 4 * coarse.len() as u64 + fine),
            options,
        )?;

        let done = AtomicU64::new(0);
        let bricks = plans
            .par_iter()
            .map_init(Vec::new, |scratch, plan| {
                let finished = done.fetch_add(1, Ordering::Relaxed);
                Cancelled::check(progress.step("blocks", finished, plans.len() as u64))?;
                Ok(plan.brick(&sites, &kernel, scratch))
            })
            .collect::<Result<Vec<Brick>, Cancelled>>()?;
        let mut table = vec![NONE; (table_bytes / 4) as usize];
        for (plan, place) in plans.iter().zip(0..) {
            let at = (plan.low.as_uvec3()) / SIDE;
            table[index(at, table_dims)] = place;
        }
        Ok(Self {
            band: options.band,
            coarse_dims: coarse_lattice.dims,
            coarse,
            table_dims,
            table,
            bricks,
        })
    }

    /// Bytes that the values take.
    pub fn memory(&self) -> u64 {
        let bricks = self.bricks.iter();
        let fine: usize = bricks
            .map(|brick| brick.values.len() + brick.blocks.len())
            .sum();
        4 * (fine + self.coarse.len() + self.table.len()) as u64
    }

    /// The value and the derivatives in voxels, at voxel coordinates within the outermost centres.
    pub fn within(&self, dims: UVec3, position: DVec3) -> (f64, DVec3) {
        let fine = self.fine(dims, position);
        if let Some((value, _)) = fine
            && value <= 0.5 * self.band
        {
            return fine.unwrap_or_default();
        }
        let scale = f64::from(COARSE);
        let (coarse, coarse_gradient) = interpolate::within(
            &self.coarse,
            self.coarse_dims,
            (position + 0.5) / scale + 0.5,
        );
        let coarse = coarse * scale;
        match fine {
            Some((value, gradient)) if value < self.band => {
                let w = 2.0 * (1.0 - value / self.band);
                (
                    coarse + w * (value - coarse),
                    coarse_gradient + w * (gradient - coarse_gradient),
                )
            }
            _ => (coarse, coarse_gradient),
        }
    }

    /// The same from the blocks; `None` where some value of the stencil is not stored.
    fn fine(&self, dims: UVec3, position: DVec3) -> Option<(f64, DVec3)> {
        let x = Axis::new(position.x, dims.x, 1);
        let y = Axis::new(position.y, dims.y, 1);
        let z = Axis::new(position.z, dims.z, 1);
        // At most two blocks on each axis.
        let side = BLOCK as usize;
        let [[x0, x1], [y0, y1], [z0, z1]] =
            [&x, &y, &z].map(|axis| [axis.places[0] / side, axis.places[3] / side]);
        let first = self.block(x0, y0, z0)?;
        let mut blocks = [first; 8];
        for (octant, block) in blocks.iter_mut().enumerate().skip(1) {
            let [bx, by, bz] = [octant & 1, octant >> 1 & 1, octant >> 2];
            if (bx == 1 && x0 == x1) || (by == 1 && y0 == y1) || (bz == 1 && z0 == z1) {
                continue;
            }
            *block = self.block(
                if bx == 0 { x0 } else { x1 },
                if by == 0 { y0 } else { y1 },
                if bz == 0 { z0 } else { z1 },
            )?;
        }
        // Which of two blocks, and where in it.
        let split = |axis: &Axis, first: usize| {
            axis.places
                .map(|place| (usize::from(place / side != first), place % side))
        };
        let (px, py, pz) = (split(&x, x0), split(&y, y0), split(&z, z0));
        let at = |i: usize, j: usize, k: usize| {
            let ((bx, ix), (by, iy), (bz, iz)) = (px[i], py[j], pz[k]);
            f64::from(blocks[bx + 2 * by + 4 * bz][ix + side * (iy + side * iz)])
        };
        Some(interpolate::combine(at, &x, &y, &z))
    }

    /// The values of a block, by its number on each axis.
    #[inline]
    fn block(&self, x: usize, y: usize, z: usize) -> Option<&[f32]> {
        let side = BRICK as usize;
        let [nx, ny] = [self.table_dims.x as usize, self.table_dims.y as usize];
        let brick = self.table[x / side + nx * (y / side + ny * (z / side))];
        let brick = self.bricks.get(brick as usize)?;
        let block = brick.blocks[x % side + side * (y % side + side * (z % side))];
        (block != NONE).then(|| &brick.values[block as usize * BLOCK_LEN..][..BLOCK_LEN])
    }
}

/// The bricks and blocks in which the fine value can be below the band.
///
/// Let it be so at some point. Then it is at a corner of the point's cell. Regularisation moves no value by more than
/// the kernel's mean |t| < 1.6 σ, since d₀ is 1-Lipschitz, so d₀ ≤ band + 1.6 σ at the corner. The 4³ voxels about the
/// cell are at most 2 √3 from it.
fn plans(sites: &Sites, dims: UVec3, kernel: &Kernel, options: &DistanceOptions) -> Vec<Plan> {
    let reach = kernel.radius() as u32;
    let farthest = (options.band + 1.6 * options.sigma + 2.0 * 3.0_f64.sqrt() + 0.01) as f32;
    let grid = Region {
        low: IVec3::splat(reach as i32),
        size: dims,
    };
    let mut wanted = |region: Region, lower: f32| lower <= farthest && region.overlaps(grid);
    let search = Search {
        sites,
        unit: SIDE,
        // Leaves may stick out of a brick and its halo by all but one voxel.
        halo: reach + LEAF,
    };
    let whole = Region {
        low: grid.low,
        size: (dims + SIDE - 1) / SIDE * SIDE,
    };
    let all: Vec<u32> = (0..sites.none()).collect();
    let mut bricks = Vec::new();
    search.divide(whole, &all, &mut wanted, &mut |region, candidates| {
        bricks.push((region, candidates.to_vec()));
    });
    let plan = |(region, candidates): (Region, Vec<u32>)| {
        let mut wanted = |region: Region, lower: f32| lower <= farthest && region.overlaps(grid);
        let mut blocks = Vec::new();
        let search = Search {
            sites,
            unit: BLOCK,
            halo: 0,
        };
        search.divide(region, &candidates, &mut wanted, &mut |block, _| {
            let at = (block.low - region.low).as_uvec3() / BLOCK;
            blocks.push(index(at, UVec3::splat(BRICK)) as u32);
        });
        Plan {
            low: region.low - reach as i32,
            candidates,
            blocks,
        }
    };
    let plans = bricks.into_par_iter().map(plan);
    plans.filter(|plan| !plan.blocks.is_empty()).collect()
}

impl Plan {
    /// Computes the distances that its blocks need, then the blocks. `raw` is room that is used again.
    fn brick(&self, sites: &Sites, kernel: &Kernel, raw: &mut Vec<f32>) -> Brick {
        let reach = 2 * kernel.radius() as u32;
        let leaves = UVec3::splat((SIDE + reach).div_ceil(LEAF));
        let side = (leaves.x * LEAF) as usize;
        raw.resize(side * side * side, 0.0);

        let mut needed = vec![false; index(leaves, leaves) + 1];
        for &block in &self.blocks {
            let low = position(block) * (BLOCK / LEAF);
            let high = (position(block) * BLOCK + BLOCK + reach - 1) / LEAF;
            for at in each(low, high) {
                needed[index(at, leaves)] = true;
            }
        }
        let whole = Region {
            low: self.low,
            size: leaves * LEAF,
        };
        let mut wanted = |region: Region, _: f32| {
            let low = (region.low - self.low).as_uvec3();
            let high = (low + region.size - 1) / LEAF;
            each(low / LEAF, high).any(|at| needed[index(at, leaves)])
        };
        let search = Search {
            sites,
            unit: LEAF,
            halo: 0,
        };
        search.divide(
            whole,
            &self.candidates,
            &mut wanted,
            &mut |region, candidates| {
                let leaf = Leaf::new(region.low, candidates, sites);
                let low = (region.low - self.low).as_uvec3();
                for (at, &site) in each(UVec3::ZERO, UVec3::splat(LEAF - 1)).zip(&leaf.sites) {
                    let voxel = region.low + at.as_ivec3();
                    raw[index(low + at, UVec3::splat(side as u32))] = sites.distance(site, voxel);
                }
            },
        );

        let mut brick = Brick {
            blocks: vec![NONE; BRICK_LEN],
            values: vec![0.0; self.blocks.len() * BLOCK_LEN],
        };
        let mut rows = Rows::default();
        let targets = brick.values.chunks_exact_mut(BLOCK_LEN);
        for ((&block, target), place) in self.blocks.iter().zip(targets).zip(0..) {
            brick.blocks[block as usize] = place;
            let low = index(position(block) * BLOCK, UVec3::splat(side as u32));
            rows.convolve(kernel, &raw[low..], side, target);
        }
        brick
    }
}

/// Room for the convolution of one block.
#[derive(Default)]
struct Rows {
    along_x: Vec<f32>,
    along_y: Vec<f32>,
}

impl Rows {
    /// Along x, y and z, with the same operations in the same order as in a dense grid.
    fn convolve(&mut self, kernel: &Kernel, raw: &[f32], side: usize, target: &mut [f32]) {
        let n = BLOCK as usize;
        let long = n + 2 * kernel.radius();
        self.along_x.resize(n * long * long, 0.0);
        self.along_y.resize(n * n * long, 0.0);
        for (row, target) in self.along_x.chunks_exact_mut(n).enumerate() {
            let (y, z) = (row % long, row / long);
            kernel.along(&raw[(z * side + y) * side..][..long], target);
        }
        for (row, target) in self.along_y.chunks_exact_mut(n).enumerate() {
            let (y, z) = (row % n, row / n);
            kernel.across(|t| &self.along_x[(z * long + y + t) * n..], target);
        }
        for (z, target) in target.chunks_exact_mut(n * n).enumerate() {
            kernel.across(|t| &self.along_y[(z + t) * n * n..], target);
        }
    }
}

fn index(at: UVec3, dims: UVec3) -> usize {
    at.x as usize + dims.x as usize * (at.y as usize + dims.y as usize * at.z as usize)
}

/// Where a block lies in its brick, in blocks.
fn position(block: u32) -> UVec3 {
    UVec3::new(
        block % BRICK,
        block / BRICK % BRICK,
        block / (BRICK * BRICK),
    )
}

/// From `low` to `high`, both inclusive, x fastest.
fn each(low: UVec3, high: UVec3) -> impl Iterator<Item = UVec3> {
    (low.z..=high.z).flat_map(move |z| {
        (low.y..=high.y).flat_map(move |y| (low.x..=high.x).map(move |x| UVec3::new(x, y, z)))
    })
}
