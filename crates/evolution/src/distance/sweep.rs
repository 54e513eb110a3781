//! Fast sweeping (Zhao 2005) of the closest point.
//!
//! Every voxel knows a site, at first only those beside a site. A sweep visits the voxels in the order of one octant,
//! and each takes over the site of a neighbour that it has just left behind where that one is closer (Gauss–Seidel:
//! what a voxel takes over, the next one sees). Eight sweeps, one for each octant, carry a site along any monotone path.
//!
//! ```text
//!   z ▲  ┌───┬───┐     The two octants that differ in x alone are swept together, row by row:
//!     │  │ b │row│     1. take over from the rows a and b behind, voxel by voxel,
//!     │  ├───┼───┤     2. scan the row forwards, 3. scan it backwards.
//!     │  │   │ a │     Rows on a diagonal j + k = const do not see each other.
//!     └──┴───┴───┴▶ y
//! ```
//!
//! Rows are kept in tiles of 8 × 8; tiles on a diagonal are swept in parallel. Whatever the number of threads, each row
//! sees what it would see in sequence.

use super::sites::{Sites, TILE};
use crate::Error;
use glam::UVec3;
use pellicle_geometry::{Cancelled, Progress};
use pellicle_spatial::KdTree;
use rayon::prelude::*;
use std::array;
use std::ops::Range;

/// The closest site of each voxel and the square of its distance in voxels, of 8 × 8 rows.
#[derive(Default)]
struct Tile {
    sites: Vec<u32>,
    squares: Vec<f32>,
}

/// The closest sites of all voxels.
pub(super) struct ClosestSites<'a> {
    sites: &'a Sites,
    dims: UVec3,
    /// Tiles on the y and the z axis.
    tiles_y: u32,
    tiles_z: u32,
    tiles: Vec<Tile>,
}

/// Bytes a voxel while sweeping.
pub(super) const BYTES_PER_VOXEL: u64 = 8;

impl<'a> ClosestSites<'a> {
    /// Sweeps a lattice of `dims` voxels. O(voxels).
    pub fn new(sites: &'a Sites, dims: UVec3, progress: &dyn Progress) -> Result<Self, Error> {
        let mut field = Self::seeded(sites, dims);
        let diagonals = field.tiles_y + field.tiles_z - 1;
        let total = u64::from(4 * diagonals);
        let mut done = 0;
        for (up_y, up_z) in [(true, true), (false, true), (true, false), (false, false)] {
            for diagonal in 0..diagonals {
                Cancelled::check(progress.step("sweep", done, total))?;
                field.sweep_diagonal(diagonal, up_y, up_z);
                done += 1;
            }
        }
        Ok(field)
    }

    /// Writes the exact distances of a row of voxels from their closest sites.
    pub fn distances(&self, y: u32, z: u32, target: &mut [f32]) {
        let tile = &self.tiles[self.tile_at(y / TILE, z / TILE)];
        let row = self.row(y, z);
        for ((distance, &site), x) in target.iter_mut().zip(&tile.sites[row]).zip(0_u32..) {
            *distance = self.sites.distance(site, UVec3::new(x, y, z).as_ivec3());
        }
    }

    /// The voxels beside a site know their closest site; the others know none.
    fn seeded(sites: &'a Sites, dims: UVec3) -> Self {
        let (tiles_y, tiles_z) = (dims.y.div_ceil(TILE), dims.z.div_ceil(TILE));
        let mut field = Self {
            sites,
            dims,
            tiles_y,
            tiles_z,
            tiles: Vec::new(),
        };
        // Sites outside of the box are known to its faces: the segment from a voxel to its closest site passes there.
        let tree = sites.outside.then(|| KdTree::new(&sites.exact));
        field.tiles = (0..tiles_y * tiles_z)
            .into_par_iter()
            .map(|place| {
                let (tile_y, tile_z) = (place % tiles_y, place / tiles_y);
                let mut tile = field.seeded_tile(tile_y, tile_z);
                if let Some(tree) = &tree {
                    field.seed_faces(&mut tile, tile_y, tile_z, tree);
                }
                tile
            })
            .collect();
        field
    }

    fn seeded_tile(&self, tile_y: u32, tile_z: u32) -> Tile {
        let (ys, zs) = (
            self.span(tile_y, self.dims.y),
            self.span(tile_z, self.dims.z),
        );
        let count = self.dims.x as usize * ys.len() * zs.len();
        let mut tile = Tile {
            sites: vec![self.sites.none(); count],
            squares: vec![f32::INFINITY; count],
        };
        for z in tile_z.saturating_sub(1)..(tile_z + 2).min(self.tiles_z) {
            for y in tile_y.saturating_sub(1)..(tile_y + 2).min(self.tiles_y) {
                for site in self.sites.in_tile(y, z) {
                    self.seed(&mut tile, site, &ys, &zs);
                }
            }
        }
        tile
    }

    /// Offers a site to the voxels about its own.
    fn seed(&self, tile: &mut Tile, site: usize, ys: &Range<u32>, zs: &Range<u32>) {
        let voxel = self.sites.voxels[site];
        let xs = around(voxel.x, &(0..self.dims.x));
        for z in around(voxel.z, zs) {
            for y in around(voxel.y, ys) {
                let row = self.row(y, z).start;
                let row = row + xs.start as usize..row + xs.end as usize;
                let offset = Offset::new(self.sites.rounded[site], y, z);
                let voxels = tile.sites[row.clone()]
                    .iter_mut()
                    .zip(&mut tile.squares[row]);
                for ((known, square), x) in voxels.zip(xs.start as i32..) {
                    let other = offset.square_at(x as f32);
                    *known = if other < *square { site as u32 } else { *known };
                    *square = if other < *square { other } else { *square };
                }
            }
        }
    }

    fn seed_faces(&self, tile: &mut Tile, tile_y: u32, tile_z: u32, tree: &KdTree) {
        let last = self.dims - 1;
        for z in self.span(tile_z, self.dims.z) {
            for y in self.span(tile_y, self.dims.y) {
                let on_face = y == 0 || y == last.y || z == 0 || z == last.z;
                let stride = if on_face { 1 } else { last.x as usize };
                for x in (0..self.dims.x).step_by(stride) {
                    let voxel = UVec3::new(x, y, z);
                    if let Some(found) = tree.nearest(voxel.as_dvec3()) {
                        let place = self.row(y, z).start + x as usize;
                        let offset = Offset::new(self.sites.rounded[found.index as usize], y, z);
                        tile.sites[place] = found.index;
                        tile.squares[place] = offset.square_at(x as f32);
                    }
                }
            }
        }
    }

    /// Sweeps the tiles of one diagonal, in parallel.
    fn sweep_diagonal(&mut self, diagonal: u32, up_y: bool, up_z: bool) {
        let first = diagonal.saturating_sub(self.tiles_z - 1);
        let last = diagonal.min(self.tiles_y - 1);
        let mut taken: Vec<(u32, u32, Tile)> = (first..=last)
            .map(|j| {
                let tile_y = ordered(j, self.tiles_y, up_y);
                let tile_z = ordered(diagonal - j, self.tiles_z, up_z);
                let place = self.tile_at(tile_y, tile_z);
                (tile_y, tile_z, std::mem::take(&mut self.tiles[place]))
            })
            .collect();
        let field = &*self;
        taken.par_iter_mut().for_each(|(tile_y, tile_z, tile)| {
            field.sweep_tile(tile, *tile_y, *tile_z, up_y, up_z);
        });
        for (tile_y, tile_z, tile) in taken {
            let place = self.tile_at(tile_y, tile_z);
            self.tiles[place] = tile;
        }
    }

    fn sweep_tile(&self, tile: &mut Tile, tile_y: u32, tile_z: u32, up_y: bool, up_z: bool) {
        let (ys, zs) = (
            self.span(tile_y, self.dims.y),
            self.span(tile_z, self.dims.z),
        );
        for k in 0..zs.len() as u32 {
            let z = zs.start + ordered(k, zs.len() as u32, up_z);
            for j in 0..ys.len() as u32 {
                let y = ys.start + ordered(j, ys.len() as u32, up_y);
                for (behind_y, behind_z) in [
                    (Some(y), behind(z, self.dims.z, up_z)),
                    (behind(y, self.dims.y, up_y), Some(z)),
                ] {
                    if let (Some(from_y), Some(from_z)) = (behind_y, behind_z) {
                        self.take_over(tile, (y, z), (from_y, from_z));
                    }
                }
                let row = self.row(y, z);
                let sites = &mut tile.sites[row.clone()];
                let squares = &mut tile.squares[row];
                self.scan(sites.iter_mut().zip(squares.iter_mut()).zip(0_i32..), y, z);
                let backwards = (0..self.dims.x as i32).rev();
                self.scan(
                    sites
                        .iter_mut()
                        .zip(squares.iter_mut())
                        .rev()
                        .zip(backwards),
                    y,
                    z,
                );
            }
        }
    }

    /// Each voxel of a row takes over the site of the voxel beside it in another row where that is closer.
    fn take_over(&self, tile: &mut Tile, (y, z): (u32, u32), (from_y, from_z): (u32, u32)) {
        let (row, from) = (self.row(y, z), self.row(from_y, from_z));
        let (own, other) = ((y / TILE, z / TILE), (from_y / TILE, from_z / TILE));
        let (sites, source) = if own == other {
            two_rows(&mut tile.sites, row.start, from.start, self.dims.x as usize)
        } else {
            let source = &self.tiles[self.tile_at(other.0, other.1)].sites[from];
            (&mut tile.sites[row.clone()], source)
        };
        let squares = &mut tile.squares[row];
        let (site_chunks, last_sites) = sites.as_chunks_mut::<CHUNK>();
        let (square_chunks, last_squares) = squares.as_chunks_mut::<CHUNK>();
        let (source_chunks, last_source) = source.as_chunks::<CHUNK>();
        let mut x = 0;
        for ((sites, squares), source) in
            site_chunks.iter_mut().zip(square_chunks).zip(source_chunks)
        {
            if differ(sites, source) {
                self.take_over_chunk(sites, squares, source, (x, y, z));
            }
            x += CHUNK as u32;
        }
        for ((site, square), &source) in last_sites.iter_mut().zip(last_squares).zip(last_source) {
            self.take_over_chunk(
                array::from_mut(site),
                array::from_mut(square),
                &[source],
                (x, y, z),
            );
            x += 1;
        }
    }

    /// Without branches: they would go either way at the borders of the closest sites' cells.
    #[inline(always)]
    fn take_over_chunk<const N: usize>(
        &self,
        sites: &mut [u32; N],
        squares: &mut [f32; N],
        source: &[u32; N],
        (x, y, z): (u32, u32, u32),
    ) {
        let mut others = [0.0; N];
        for i in 0..N {
            let offset = Offset::new(self.sites.rounded[source[i] as usize], y, z);
            others[i] = offset.square_at((x + i as u32) as f32);
        }
        for i in 0..N {
            let closer = u32::from(others[i] < squares[i]).wrapping_neg();
            sites[i] = (source[i] & closer) | (sites[i] & !closer);
            squares[i] =
                f32::from_bits((others[i].to_bits() & closer) | (squares[i].to_bits() & !closer));
        }
    }

    /// Carries the last site along a row, replacing sites that are farther, replaced by the first that is not.
    #[inline(always)]
    fn scan<'b>(
        &self,
        row: impl Iterator<Item = ((&'b mut u32, &'b mut f32), i32)>,
        y: u32,
        z: u32,
    ) {
        let mut carried = self.sites.none();
        let mut offset = Offset::new(self.sites.rounded[carried as usize], y, z);
        for ((site, square), x) in row {
            if *site != carried {
                let other = offset.square_at(x as f32);
                if other < *square {
                    *square = other;
                    *site = carried;
                } else {
                    carried = *site;
                    offset = Offset::new(self.sites.rounded[carried as usize], y, z);
                }
            }
        }
    }

    fn tile_at(&self, tile_y: u32, tile_z: u32) -> usize {
        (tile_z * self.tiles_y + tile_y) as usize
    }

    /// The rows of a tile on an axis.
    fn span(&self, tile: u32, dim: u32) -> Range<u32> {
        tile * TILE..((tile + 1) * TILE).min(dim)
    }

    /// Where a row lies in its tile.
    fn row(&self, y: u32, z: u32) -> Range<usize> {
        let height = self.span(y / TILE, self.dims.y).len();
        let start = ((z % TILE) as usize * height + (y % TILE) as usize) * self.dims.x as usize;
        start..start + self.dims.x as usize
    }
}

/// A site is offered to the voxels that are at most this many from its own on every axis, so before the sweeps begin
/// closest sites are exact up to a distance of half a voxel more.
const REACH: u32 = 3;

/// Voxels whose sites are compared at once before any is looked at.
const CHUNK: usize = 8;

/// Whether two rows differ anywhere; a call to compare memory costs more than this for so few.
#[inline(always)]
fn differ(a: &[u32; CHUNK], b: &[u32; CHUNK]) -> bool {
    a.iter().zip(b).fold(0, |bits, (a, b)| bits | (a ^ b)) != 0
}

/// What the square of the distance from one site is along one row.
#[derive(Clone, Copy)]
struct Offset {
    x: f32,
    across: f32,
}

impl Offset {
    #[inline]
    fn new(site: [f32; 4], y: u32, z: u32) -> Self {
        let (dy, dz) = (site[1] - y as f32, site[2] - z as f32);
        Self {
            x: site[0],
            across: dy * dy + dz * dz,
        }
    }

    #[inline]
    fn square_at(self, x: f32) -> f32 {
        let dx = self.x - x;
        dx * dx + self.across
    }
}

fn ordered(i: u32, count: u32, up: bool) -> u32 {
    if up { i } else { count - 1 - i }
}

/// The row that a sweep visits before this one.
fn behind(i: u32, count: u32, up: bool) -> Option<u32> {
    if up {
        i.checked_sub(1)
    } else {
        (i + 1 < count).then_some(i + 1)
    }
}

/// The voxels at most `REACH` from one on an axis, those within a range.
fn around(voxel: u32, range: &Range<u32>) -> Range<u32> {
    voxel.saturating_sub(REACH).max(range.start)..(voxel + REACH + 1).min(range.end)
}

/// Two different rows of one array, the first to be changed.
fn two_rows<T>(all: &mut [T], row: usize, other: usize, len: usize) -> (&mut [T], &[T]) {
    if row < other {
        let (before, after) = all.split_at_mut(other);
        (&mut before[row..row + len], &after[..len])
    } else {
        let (before, after) = all.split_at_mut(row);
        (&mut after[..len], &before[other..other + len])
    }
}
