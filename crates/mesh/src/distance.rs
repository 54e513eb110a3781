//! How far one mesh or cloud lies from another.

use crate::frame::{Frame, Sum};
use crate::measure::measurable;
use crate::{MeshError, MeshView};
use pellicle_geometry::{Aabb, Cancelled, DVec3, Progress, triangle};
use pellicle_spatial::{Bvh, KdTree};
use rayon::prelude::*;
use std::sync::atomic::{AtomicU64, Ordering};

/// How points of a surface are chosen.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DistanceOptions {
    /// How many points of a surface are asked besides its vertices, uniform over its area. Default 100,000: the
    /// mean is then good to about 0.3 % of the spread. 0 asks vertices only.
    pub samples: usize,
    /// What the choice of those points depends on. Default 0.
    pub seed: u64,
}

impl Default for DistanceOptions {
    fn default() -> Self {
        Self {
            samples: 100_000,
            seed: 0,
        }
    }
}

/// Distances from points of one mesh or cloud to another, in the units of the positions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Distances {
    /// The greatest, over vertices and samples: from below the one-sided Hausdorff distance.
    pub max: f64,
    /// The mean.
    pub mean: f64,
    /// The root of the mean square.
    pub rms: f64,
    /// The point with the greatest distance.
    pub farthest: DVec3,
    /// How many points were asked for the greatest.
    pub points: usize,
}

/// Distances both ways, and the diagonal of the box around both.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Comparison {
    /// From the first to the second.
    pub forward: Distances,
    /// From the second to the first.
    pub backward: Distances,
    /// The diagonal of the smallest box around both, for relative figures.
    pub diagonal: f64,
}

impl Comparison {
    /// The Hausdorff distance, from below: the greater of both maxima.
    pub fn hausdorff(&self) -> f64 {
        self.forward.max.max(self.backward.max)
    }
}

/// [`distances`] both ways.
pub fn compare(
    first: MeshView,
    second: MeshView,
    options: &DistanceOptions,
    progress: &impl Progress,
) -> Result<Comparison, MeshError> {
    let frame = common_frame(first, second);
    let both = [first, second]
        .map(|mesh| mesh.positions)
        .into_iter()
        .flatten();
    let bounds = both
        .filter(|p| p.is_finite())
        .fold(Aabb::EMPTY, |bounds, &p| bounds.with(frame.apply(p)));
    Ok(Comparison {
        forward: distances(first, second, options, progress)?,
        backward: distances(second, first, options, progress)?,
        diagonal: bounds.diagonal() * frame.scale,
    })
}

/// Distances from points of `from` to the nearest point of `to`.
///
/// Of a mesh with usable triangles these make up the surface, and other vertices are ignored; without
/// triangles, the finite positions are the points. The maximum is taken over the vertices and
/// [`DistanceOptions::samples`] points of the surface of `from`, mean and root mean square over the
/// samples alone, or over the vertices where there are none.
///
/// O((n + m) log m). The result does not depend on the number of threads.
///
/// ```
/// use pellicle_geometry::DVec3;
/// use pellicle_mesh::{DistanceOptions, MeshView, distances};
/// let cloud = [DVec3::ZERO, DVec3::X];
/// let shifted = cloud.map(|p| p + 3.0 * DVec3::Y);
/// let view = |positions| MeshView { positions, triangles: &[] };
/// let result = distances(view(&cloud), view(&shifted), &DistanceOptions::default(), &())?;
/// assert_eq!((result.max, result.mean, result.rms), (3.0, 3.0, 3.0));
/// # Ok::<(), pellicle_mesh::MeshError>(())
/// ```
pub fn distances(
    from: MeshView,
    to: MeshView,
    options: &DistanceOptions,
    progress: &impl Progress,
) -> Result<Distances, MeshError> {
    let frame = common_frame(from, to);
    let target =
        Target::new(to, frame).ok_or(MeshError::NothingToMeasure { side: "the target" })?;
    let source = Source::new(from, frame, options);
    if source.vertices.is_empty() {
        return Err(MeshError::NothingToMeasure { side: "the source" });
    }
    let total = measure(&source, &target, progress)?;
    let count = match source.samples {
        0 => source.vertices.len(),
        samples => samples,
    } as f64;
    Ok(Distances {
        max: total.max.sqrt() * frame.scale,
        mean: total.sum.value() / count * frame.scale,
        rms: (total.squares.value() / count).sqrt() * frame.scale,
        farthest: frame.restore(source.point(total.farthest)),
        points: source.len(),
    })
}

/// The distance of each point from the nearest point of `to`, which is as for [`distances`]; NaN for a point that is not
/// finite.
///
/// O((n + m) log m), on all threads; the result does not depend on how many.
///
/// ```
/// use pellicle_geometry::DVec3;
/// let sphere = pellicle_mesh::icosphere(3)?;
/// let points = [DVec3::ZERO, 3.0 * sphere.positions()[0]];
/// let found = pellicle_mesh::point_distances(&points, (&sphere).into(), &())?;
/// assert!(found[0] > 0.98 && (found[1] - 2.0).abs() < 1e-12);
/// # Ok::<(), pellicle_mesh::MeshError>(())
/// ```
pub fn point_distances(
    points: &[DVec3],
    to: MeshView,
    progress: &impl Progress,
) -> Result<Vec<f64>, MeshError> {
    const CHUNK: usize = 1024;
    let frame = Frame::of(points.iter().chain(to.positions));
    let target =
        Target::new(to, frame).ok_or(MeshError::NothingToMeasure { side: "the target" })?;
    let done = AtomicU64::new(0);
    let total = points.len() as u64;
    let distance = |p: &DVec3| match p.is_finite() {
        true => target.distance_squared(frame.apply(*p)).sqrt() * frame.scale,
        false => f64::NAN,
    };
    let parts = points.par_chunks(CHUNK).map(|chunk| {
        let found: Vec<f64> = chunk.iter().map(distance).collect();
        let length = chunk.len() as u64;
        let finished = done.fetch_add(length, Ordering::Relaxed) + length;
        Cancelled::check(progress.step("distances", finished, total))?;
        Ok(found)
    });
    Ok(parts.collect::<Result<Vec<_>, Cancelled>>()?.concat())
}

fn common_frame(a: MeshView, b: MeshView) -> Frame {
    Frame::of(a.positions.iter().chain(b.positions))
}

/// The points to ask, in the frame: vertices first, then samples, each a function of its index.
struct Source {
    vertices: Vec<DVec3>,
    triangles: Vec<[DVec3; 3]>,
    /// The area of the triangles up to and including each.
    areas: Vec<f64>,
    samples: usize,
    seed: u64,
}

impl Source {
    fn new(mesh: MeshView, frame: Frame, options: &DistanceOptions) -> Self {
        let mut used = vec![false; mesh.positions.len()];
        let mut triangles = Vec::new();
        let mut areas = Vec::new();
        let mut area = Sum::default();
        for (t, corners) in measurable(mesh) {
            mesh.triangles[t]
                .iter()
                .for_each(|v| used[v.index()] = true);
            let corners = corners.map(|p| frame.apply(p));
            area.add(triangle::area(corners[0], corners[1], corners[2]));
            triangles.push(corners);
            areas.push(area.value());
        }
        let cloud = triangles.is_empty();
        let vertices = mesh.positions.iter().zip(&used);
        Self {
            vertices: vertices
                .filter(|(p, used)| p.is_finite() && (cloud || **used))
                .map(|(&p, _)| frame.apply(p))
                .collect(),
            triangles,
            areas,
            samples: if area.value() > 0.0 {
                options.samples
            } else {
                0
            },
            seed: options.seed,
        }
    }

    fn len(&self) -> usize {
        self.vertices.len() + self.samples
    }

    fn point(&self, index: usize) -> DVec3 {
        match index.checked_sub(self.vertices.len()) {
            None => self.vertices[index],
            Some(k) => self.sample(k),
        }
    }

    /// The k-th sample: one in each of as many equal shares of the area, uniform in its triangle by the
    /// square root of Osada et al. 2002.
    fn sample(&self, k: usize) -> DVec3 {
        let [share, u, v] = [0, 1, 2].map(|i| uniform(self.seed, 3 * k as u64 + i));
        let total = self.areas.last().copied().unwrap_or_default();
        let area = (k as f64 + share) / self.samples as f64 * total;
        let at = self.areas.partition_point(|&up_to| up_to <= area);
        let [a, b, c] = self.triangles[at.min(self.triangles.len() - 1)];
        let root = u.sqrt();
        a * (1.0 - root) + b * (root * (1.0 - v)) + c * (root * v)
    }
}

/// What distances are measured to, in the frame.
enum Target {
    Surface {
        bvh: Bvh,
        triangles: Vec<[DVec3; 3]>,
    },
    Cloud(KdTree),
}

impl Target {
    /// `None` if there is nothing to measure to.
    fn new(mesh: MeshView, frame: Frame) -> Option<Self> {
        let triangles: Vec<[DVec3; 3]> = measurable(mesh)
            .map(|(_, corners)| corners.map(|p| frame.apply(p)))
            .collect();
        if !triangles.is_empty() {
            let bvh = Bvh::new(triangles.iter().map(|corners| Aabb::of_points(corners)));
            return Some(Self::Surface { bvh, triangles });
        }
        let finite = mesh.positions.iter().filter(|p| p.is_finite());
        let points: Vec<DVec3> = finite.map(|&p| frame.apply(p)).collect();
        (!points.is_empty()).then(|| Self::Cloud(KdTree::new(&points)))
    }

    fn distance_squared(&self, p: DVec3) -> f64 {
        let found = match self {
            Self::Cloud(tree) => tree.nearest(p).map(|n| n.distance_squared),
            Self::Surface { bvh, triangles } => bvh
                .nearest(p, |t| {
                    let [a, b, c] = triangles[t as usize];
                    p.distance_squared(triangle::closest_point(p, a, b, c))
                })
                .map(|(_, square)| square),
        };
        found.unwrap_or(f64::INFINITY)
    }
}

/// What some points add up to; `max` is a square.
#[derive(Default)]
struct Total {
    max: f64,
    farthest: usize,
    sum: Sum,
    squares: Sum,
}

/// Chunks of fixed size, added up in order: the same sums for any number of threads.
fn measure(source: &Source, target: &Target, progress: &impl Progress) -> Result<Total, MeshError> {
    const CHUNK: usize = 1024;
    let count = source.len();
    let done = AtomicU64::new(0);
    let averaged_from = if source.samples > 0 {
        source.vertices.len()
    } else {
        0
    };
    let parts: Vec<Total> = (0..count.div_ceil(CHUNK))
        .into_par_iter()
        .map(|chunk| {
            let range = chunk * CHUNK..((chunk + 1) * CHUNK).min(count);
            let mut part = Total::default();
            for i in range.clone() {
                let square = target.distance_squared(source.point(i));
                if square > part.max {
                    (part.max, part.farthest) = (square, i);
                }
                if i >= averaged_from {
                    part.sum.add(square.sqrt());
                    part.squares.add(square);
                }
            }
            let finished =
                done.fetch_add(range.len() as u64, Ordering::Relaxed) + range.len() as u64;
            Cancelled::check(progress.step("distances", finished, count as u64))?;
            Ok(part)
        })
        .collect::<Result<_, Cancelled>>()?;
    let mut total = Total::default();
    for part in parts {
        if part.max > total.max {
            (total.max, total.farthest) = (part.max, part.farthest);
        }
        total.sum.add(part.sum.value());
        total.squares.add(part.squares.value());
    }
    Ok(total)
}

/// The n-th number of a sequence uniform in [0, 1): SplitMix64 (Steele et al. 2014).
fn uniform(seed: u64, n: u64) -> f64 {
    let mut z = seed.wrapping_add(n.wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15));
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^= z >> 31;
    (z >> 11) as f64 * 2_f64.powi(-53)
}
