//! The regularised distance function to a cloud of points on a grid.
//!
//! Source: Daniel 2015, sections 3.1, 3.2 and 4, and equation (4.4); sweeping: Zhao 2005.

mod gauss;
mod interpolate;
mod lattice;
mod nearest;
mod sites;
mod sparse;
mod sweep;

use crate::{Error, Field, Sample};
use gauss::Kernel;
use glam::{DVec3, UVec3};
use lattice::Lattice;
use pellicle_geometry::{Aabb, Cancelled, Progress};
use rayon::prelude::*;
use sites::Sites;
use sparse::Sparse;
use sweep::ClosestSites;

/// How a [`DistanceGrid`] is built.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DistanceOptions {
    /// Voxels along the longest side of the box: N in section 4 of Daniel 2015, whose first experiments take 200. At
    /// least 4, at most 2²⁰.
    pub resolution: u32,
    /// The box Ω. `None`: the box of the points with a margin. Points outside of a given box count like any others.
    pub bounds: Option<Aabb>,
    /// The margin on every side of the points' box, as a fraction of its longest side; not used with `bounds`. Room for
    /// an initial surface around the points: default 0.2.
    pub margin: f64,
    /// The standard deviation σ of the Gauss kernel in voxels (Daniel 2015, section 3.2, gives no value); 0 for none,
    /// at most 16. Larger values pull an evolved surface inside the points by about 2 σ² w_d / (w_a R) where its radius
    /// of curvature is R. Default 1.
    pub sigma: f64,
    /// How the values are kept.
    pub storage: Storage,
    /// Half the width of the narrow band of sparse storage, in voxels: at least as far from the points as this, values
    /// have the full resolution. Default 4.
    pub band: f64,
    /// The most memory that building may take at its peak, in bytes. Default 4 GiB.
    pub memory_limit: u64,
}

impl Default for DistanceOptions {
    fn default() -> Self {
        Self {
            resolution: 200,
            bounds: None,
            margin: 0.2,
            sigma: 1.0,
            storage: Storage::Auto,
            band: 8.0,
            memory_limit: 4 << 30,
        }
    }
}

/// How the values of a [`DistanceGrid`] are kept.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Storage {
    /// Dense up to 2²⁵ voxels (about 320³), sparse beyond.
    #[default]
    Auto,
    /// All voxels.
    Dense,
    /// Blocks of voxels near the points, and a grid of a quarter of the resolution everywhere else.
    Sparse,
}

/// The regularised distance function d = G_σ ∗ d₀ to a cloud of points, on cubic voxels with values at their centres.
///
/// Immutable. The field depends on the set of points alone: not on their order, not on the number of threads.
///
/// # Accuracy
/// - *Dense.* Before regularisation, values within 3.5 voxels of the points are the exact distances. Farther out, sweeping
///   loses sites whose cells are narrower than a voxel: values are too large by at most 0.3 voxels in all that was tried,
///   on average by 10⁻⁴ where points are several voxels apart and by 10⁻² where they are closer than a voxel. No value
///   is too small.
/// - *Sparse.* Exact distances are regularised wherever the value is at most half the band. From there to the band, and
///   beyond, values go over to those of a grid of voxels four times as long: about half a voxel off in between, and the
///   length of the gradient by 5 %, less the farther out.
/// - Values are kept in `f32`, in voxels: at a distance of 200 voxels they are rounded by 10⁻⁵ voxels.
///
/// ```
/// use pellicle_evolution::{DistanceGrid, DistanceOptions};
/// use pellicle_geometry::DVec3;
///
/// let corners: Vec<DVec3> = (0..8)
///     .map(|i| DVec3::new((i & 1) as f64, (i >> 1 & 1) as f64, (i >> 2) as f64))
///     .collect();
/// let options = DistanceOptions { resolution: 50, ..Default::default() };
/// let grid = DistanceGrid::new(&corners, &options, &())?;
/// let sample = grid.sample(DVec3::new(1.15, 1.0, 1.0));
/// assert!((sample.value - 0.15).abs() < 0.02);
/// assert!((sample.gradient - DVec3::X).length() < 0.2);
/// # Ok::<(), pellicle_evolution::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct DistanceGrid {
    lattice: Lattice,
    store: Store,
}

#[derive(Clone, Debug)]
enum Store {
    /// One value a voxel, in voxels, x fastest.
    Dense(Vec<f32>),
    Sparse(Sparse),
}

impl DistanceGrid {
    /// The field of a cloud.
    ///
    /// 1. Lay cubic voxels over the box, 2. sort the points by the voxels that they lie in, 3. give the voxels near the
    ///    points their closest points, 4. sweep the closest points over the grid, 5. convolve with the Gauss kernel.
    ///
    /// The grid is computed larger by the reach of the kernel, so the box has no border effects. O(n log n + voxels),
    /// about 12 bytes a voxel at the peak when dense; when sparse, a quarter of the resolution on each axis counts, and
    /// the blocks near the points.
    ///
    /// # Errors
    /// An empty cloud, a point that is not finite (its index), a box that is empty or not finite or far from all
    /// points, an option out of its range, more memory than allowed, or the observer's `Break`.
    pub fn new(
        points: &[DVec3],
        options: &DistanceOptions,
        progress: &dyn Progress,
    ) -> Result<Self, Error> {
        check(points, options)?;
        let lattice = Lattice::new(Aabb::of_points(points), options)?;
        check_nearness(points, lattice)?;
        let sparse = match options.storage {
            Storage::Auto => lattice.len() > MOST_DENSE,
            Storage::Dense => false,
            Storage::Sparse => true,
        };
        let store = if sparse {
            Store::Sparse(Sparse::new(points, lattice, options, progress)?)
        } else {
            let kernel = Kernel::new(options.sigma);
            check_limit(dense_bytes(points, lattice, &kernel), options)?;
            Store::Dense(dense_values(points, lattice, &kernel, progress)?)
        };
        Ok(Self { lattice, store })
    }

    /// The distance and its gradient at any point: trilinear interpolation of the values, and of their central
    /// differences (4.4). Both are continuous.
    ///
    /// Beyond the outermost voxel centres the value is that at the nearest point of their box plus the distance from
    /// there, and the gradient is the gradient of that, which jumps at the faces of the box. NaN where a coordinate is
    /// not finite. Constant time: 32 values are read.
    #[inline]
    pub fn sample(&self, point: DVec3) -> Sample {
        let position = self.lattice.to_voxels(point);
        let dims = self.lattice.dims;
        let field = |position| match &self.store {
            Store::Dense(values) => interpolate::within(values, dims, position),
            Store::Sparse(sparse) => sparse.within(dims, position),
        };
        let (value, gradient) = interpolate::extended(self.lattice, position, field);
        Sample {
            value: value * self.lattice.spacing,
            gradient,
        }
    }

    /// The side h of a voxel.
    pub fn spacing(&self) -> f64 {
        self.lattice.spacing
    }

    /// Voxels on each axis.
    pub fn dims(&self) -> UVec3 {
        self.lattice.dims
    }

    /// The box Ω, of whole voxels.
    pub fn bounds(&self) -> Aabb {
        self.lattice.bounds()
    }

    /// The centre of voxel (i, j, k), which need not lie inside the box.
    pub fn center(&self, voxel: UVec3) -> DVec3 {
        self.lattice.point_at(voxel.as_dvec3())
    }

    /// Bytes that the values take.
    pub fn memory(&self) -> u64 {
        match &self.store {
            Store::Dense(values) => size_of_val(values.as_slice()) as u64,
            Store::Sparse(sparse) => sparse.memory(),
        }
    }
}

impl Field for DistanceGrid {
    #[inline]
    fn sample(&self, at: DVec3) -> Sample {
        self.sample(at)
    }
}

/// The farthest that the nearest point may lie outside of the box, in voxels: beyond, `f32` values in voxels are coarser
/// than a hundredth.
const FARTHEST: f64 = 1e5;

/// The most voxels that [`Storage::Auto`] keeps densely.
const MOST_DENSE: u64 = 1 << 25;

fn check(points: &[DVec3], options: &DistanceOptions) -> Result<(), Error> {
    if points.is_empty() {
        return Err(Error::EmptyCloud);
    }
    if points.len() >= u32::MAX as usize {
        return Err(Error::TooManyPoints {
            count: points.len(),
        });
    }
    if let Some(index) = points.iter().position(|point| !point.is_finite()) {
        return Err(Error::PointNotFinite { index });
    }
    let within = |option, value: f64, least: f64, most: f64, expected| {
        if (least..=most).contains(&value) {
            Ok(())
        } else {
            Err(Error::Option {
                option,
                value,
                expected,
            })
        }
    };
    let resolution = f64::from(options.resolution);
    within(
        "resolution",
        resolution,
        4.0,
        1_048_576.0,
        "from 4 to 1048576",
    )?;
    within("margin", options.margin, 0.0, 1e6, "from 0 to 10⁶")?;
    within("sigma", options.sigma, 0.0, 16.0, "from 0 to 16 voxels")?;
    within("band", options.band, 1.0, 64.0, "from 1 to 64 voxels")
}

fn check_nearness(points: &[DVec3], lattice: Lattice) -> Result<(), Error> {
    let last = lattice.dims.as_dvec3() - 1.0;
    let square = points
        .par_iter()
        .map(|&point| {
            let position = lattice.to_voxels(point);
            (position - position.clamp(DVec3::ZERO, last)).length_squared()
        })
        .reduce(|| f64::INFINITY, f64::min);
    let voxels = square.sqrt();
    if voxels > FARTHEST {
        return Err(Error::BoundsFarFromPoints {
            voxels,
            limit: FARTHEST,
        });
    }
    Ok(())
}

fn check_limit(needed: u64, options: &DistanceOptions) -> Result<(), Error> {
    if needed > options.memory_limit {
        return Err(Error::GridTooLarge {
            needed,
            limit: options.memory_limit,
        });
    }
    Ok(())
}

/// Bytes at the peak of [`dense_values`]: closest sites and distances; while sorting, about 128 a point.
fn dense_bytes(points: &[DVec3], lattice: Lattice, kernel: &Kernel) -> u64 {
    lattice
        .extended(kernel.radius() as u32)
        .len()
        .saturating_mul(sweep::BYTES_PER_VOXEL + 4)
        .saturating_add(128 * points.len() as u64)
}

/// The regularised distances at the centres of all voxels, in voxels.
fn dense_values(
    points: &[DVec3],
    lattice: Lattice,
    kernel: &Kernel,
    progress: &dyn Progress,
) -> Result<Vec<f32>, Error> {
    let extended = lattice.extended(kernel.radius() as u32);
    Cancelled::check(progress.step("sort", 0, points.len() as u64))?;
    let sites = Sites::new(points, extended);
    let closest = ClosestSites::new(&sites, extended.dims, progress)?;
    regularised(closest, extended.dims, lattice.dims, kernel, progress)
}

/// The distances convolved with the kernel along x, y and z, cut to `dims` from the middle of the lattice that was
/// swept.
fn regularised(
    closest: ClosestSites<'_>,
    swept: UVec3,
    dims: UVec3,
    kernel: &Kernel,
    progress: &dyn Progress,
) -> Result<Vec<f32>, Error> {
    let (swept_x, swept_y) = (swept.x as usize, swept.y as usize);
    let (nx, ny) = (dims.x as usize, dims.y as usize);
    Cancelled::check(progress.step("regularise", 0, 2))?;
    // Along x and y, plane by plane.
    let mut planes = vec![0.0_f32; nx * ny * swept.z as usize];
    planes.par_chunks_mut(nx * ny).enumerate().for_each_init(
        || (vec![0.0; swept_x], vec![0.0; nx * swept_y]),
        |(row, rows), (z, plane)| {
            for (y, target) in rows.chunks_mut(nx).enumerate() {
                closest.distances(y as u32, z as u32, row);
                kernel.along(row, target);
            }
            for (y, target) in plane.chunks_mut(nx).enumerate() {
                kernel.across(|t| &rows[(y + t) * nx..], target);
            }
        },
    );
    drop(closest);
    if kernel.radius() == 0 {
        return Ok(planes);
    }
    Cancelled::check(progress.step("regularise", 1, 2))?;
    let mut values = vec![0.0_f32; nx * ny * dims.z as usize];
    values
        .par_chunks_mut(nx)
        .enumerate()
        .for_each(|(row, target)| {
            let (y, z) = (row % ny, row / ny);
            kernel.across(|t| &planes[((z + t) * ny + y) * nx..], target);
        });
    Ok(values)
}
