//! What a cloud tells of itself: its principal axes, its spacing, its noise, its outliers.

use glam::{DMat3, DVec3};
use nalgebra::{Matrix3, SymmetricEigen};
use pellicle_geometry::UnionFind;
use pellicle_spatial::{KdTree, Neighbor};
use rayon::prelude::*;

/// Centre and principal axes of some points.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Principal {
    /// The mean.
    pub(crate) center: DVec3,
    /// Unit axes, the widest spread first, right-handed.
    pub(crate) axes: DMat3,
    /// The standard deviations along them.
    pub(crate) deviations: DVec3,
}

impl Principal {
    /// The principal axes of at least one finite point.
    pub(crate) fn of(points: impl ExactSizeIterator<Item = DVec3> + Clone) -> Self {
        let count = points.len() as f64;
        let center = points.clone().map(|p| p / count).sum::<DVec3>();
        let mut covariance = Matrix3::zeros();
        for p in points {
            let offset = nalgebra::Vector3::from((p - center).to_array());
            covariance += offset * offset.transpose() / count;
        }
        let eigen = SymmetricEigen::new(covariance);
        let mut order = [0, 1, 2];
        order.sort_by(|&a, &b| eigen.eigenvalues[b].total_cmp(&eigen.eigenvalues[a]));
        let axis = |i: usize| DVec3::from_slice(eigen.eigenvectors.column(order[i]).as_slice());
        let (first, second) = (axis(0), axis(1));
        Self {
            center,
            axes: DMat3::from_cols(first, second, first.cross(second)),
            deviations: DVec3::from_array(order.map(|i| eigen.eigenvalues[i].max(0.0).sqrt())),
        }
    }
}

/// 3, or 2 for points in a plane, 1 on a line, 0 in one place, up to rounding. At least one point.
pub(crate) fn dimension(points: &[DVec3]) -> u32 {
    const ROUNDING: f64 = 1e-9;
    let principal = Principal::of(points.iter().copied());
    let local = |p: &DVec3| principal.axes.transpose() * (*p - principal.center);
    let reach = points
        .iter()
        .map(|p| local(p).abs())
        .fold(DVec3::ZERO, DVec3::max);
    let size = points
        .iter()
        .map(|p| p.abs().max_element())
        .fold(0.0, f64::max);
    let least = ROUNDING * reach.max_element().max(1e-3 * size);
    reach
        .to_array()
        .iter()
        .filter(|&&extent| extent > least)
        .count() as u32
}

/// The points that do not stand alone: their indices.
///
/// The k-distance of a point is its mean distance from its k nearest. Sparse parts of an uneven cloud are as sparse as
/// their neighbourhood, outliers are not. So, in rounds, until nothing changes:
///
/// - a point whose k-distance is more than `ratio` times the lower quartile of its neighbours' goes (after Breunig et
///   al. 2000);
/// - points are joined to neighbours that are no farther than `ratio` times the lesser of their k-distances; what hangs
///   together with fewer than one in fifty of all points goes.
///
/// O(n k log n) a round.
pub(crate) fn inliers(points: &[DVec3], ratio: f64) -> Vec<u32> {
    const ROUNDS: usize = 6;
    let mut kept: Vec<u32> = (0..points.len() as u32).collect();
    for _ in 0..ROUNDS {
        let standing: Vec<DVec3> = kept.iter().map(|&i| points[i as usize]).collect();
        let alone = alone(&standing, ratio);
        if !alone.contains(&true) {
            break;
        }
        let mut alone = alone.into_iter();
        kept.retain(|_| alone.next() != Some(true));
    }
    kept
}

/// Whether each point stands alone.
fn alone(points: &[DVec3], ratio: f64) -> Vec<bool> {
    const NEIGHBORS: usize = 12;
    const LEAST_SHARE: usize = 50;
    let tree = KdTree::new(points);
    let neighbors: Vec<Vec<Neighbor>> = points
        .par_iter()
        .enumerate()
        .map(|(i, &p)| {
            let mut nearest = tree.nearest_k(p, NEIGHBORS + 1);
            nearest.retain(|n| n.index as usize != i);
            nearest
        })
        .collect();
    let distance = |around: &Vec<Neighbor>| {
        let sum: f64 = around.iter().map(|n| n.distance_squared.sqrt()).sum();
        sum / around.len().max(1) as f64
    };
    let distances: Vec<f64> = neighbors.iter().map(distance).collect();

    let mut groups = UnionFind::new(points.len());
    for (i, around) in neighbors.iter().enumerate() {
        for n in around {
            let reach = ratio * distances[i].min(distances[n.index as usize]);
            if n.distance_squared <= reach * reach {
                groups.union(i as u32, n.index);
            }
        }
    }
    let mut sizes = vec![0_usize; points.len()];
    for i in 0..points.len() as u32 {
        sizes[groups.find(i) as usize] += 1;
    }
    let mut alone = Vec::with_capacity(points.len());
    for (i, around) in neighbors.iter().enumerate() {
        let mut theirs: Vec<f64> = around.iter().map(|n| distances[n.index as usize]).collect();
        theirs.sort_by(f64::total_cmp);
        let quartile = theirs.get(theirs.len() / 4);
        let lonely = quartile.is_some_and(|quartile| distances[i] > ratio * quartile);
        let size = sizes[groups.find(i as u32) as usize];
        alone.push(lonely || size * LEAST_SHARE < points.len());
    }
    alone
}

/// The standard deviation of the points from the surface that they were taken from: the median over places spread through
/// the cloud. Zero for fewer than 16 points.
///
/// Around each place, neighbourhoods of 16, 32, … points are fitted by a quadric; the noise is what the first of
/// them leaves that is wide compared with what it leaves. In smaller ones noise is taken for shape, in larger ones shape
/// for noise.
pub(crate) fn noise(points: &[DVec3]) -> f64 {
    const PLACES: usize = 256;
    let tree = KdTree::new(points);
    let stride = points.len().div_ceil(PLACES).max(1);
    let places: Vec<DVec3> = points.iter().step_by(stride).copied().collect();
    let mut residuals: Vec<f64> = places
        .par_iter()
        .filter_map(|&place| local_noise(points, &tree, place))
        .collect();
    residuals.sort_by(f64::total_cmp);
    residuals.get(residuals.len() / 2).copied().unwrap_or(0.0)
}

fn local_noise(points: &[DVec3], tree: &KdTree, place: DVec3) -> Option<f64> {
    const WIDE: f64 = 6.0;
    let largest = 1024.min(points.len() / 8);
    let nearest = tree.nearest_k(place, largest.max(16));
    let mut last = None;
    let mut count = 16;
    while count <= nearest.len() {
        let patch = nearest[..count].iter().map(|n| points[n.index as usize]);
        let principal = Principal::of(patch.clone());
        let residual = quadric_residual(patch, &principal)?;
        last = Some(residual);
        if principal.deviations.y > WIDE * residual {
            break;
        }
        count *= 2;
    }
    last
}

/// What the least-squares quadric z(x, y) over the plane of a patch leaves: the standard deviation, six parameters
/// accounted for.
fn quadric_residual(
    patch: impl ExactSizeIterator<Item = DVec3> + Clone,
    principal: &Principal,
) -> Option<f64> {
    let count = patch.len();
    let scale = principal.deviations.x;
    if scale <= 0.0 || count <= 6 {
        return None;
    }
    let local: Vec<DVec3> = patch
        .map(|p| principal.axes.transpose() * (p - principal.center) / scale)
        .collect();
    let row = |p: &DVec3| [1.0, p.x, p.y, p.x * p.x, p.x * p.y, p.y * p.y];
    let mut normal = nalgebra::Matrix6::<f64>::zeros();
    let mut right = nalgebra::Vector6::<f64>::zeros();
    for p in &local {
        let row = nalgebra::Vector6::from(row(p));
        normal += row * row.transpose();
        right += row * p.z;
    }
    // A patch along a line leaves the matrix singular.
    let ridge = 1e-9 * count as f64;
    for i in 0..6 {
        normal[(i, i)] += ridge;
    }
    let fit = normal.cholesky()?.solve(&right);
    let squares: f64 = local
        .iter()
        .map(|p| (p.z - nalgebra::Vector6::from(row(p)).dot(&fit)).powi(2))
        .sum();
    Some(scale * (squares / (count - 6) as f64).sqrt())
}
