//! Biased randomized insertion order (Amenta et al. 2003): rounds of points, each in Hilbert order.
//!
//! Each point falls into the last round with probability 7/8, into the one before with 7/64, and so on.
//! The chance is a hash of the coordinates, so the order depends on the points alone, not on how the
//! caller happened to list them.

use crate::hilbert;
use glam::DVec3;
use pellicle_geometry::Aabb;
use pellicle_predicates::lifted::lexicographic;
use rayon::prelude::*;

/// About how many points the first round holds.
const FIRST_ROUND: usize = 64;

/// Points in one cell of the Hilbert grid beyond this number are ordered by a finer grid of their own.
const CROWD: usize = 32;

/// A permutation of `points` for incremental insertion: random enough that the expected cost stays low,
/// local enough that consecutive points are close.
///
/// Equal points (0.0 and −0.0 are equal) stand next to each other, lowest index first. The sequence of
/// coordinates does not depend on the order of `points`. All coordinates must be finite.
/// O(n log n) time, 16 bytes a point of working memory.
///
/// ```
/// use pellicle_geometry::DVec3;
/// let points = [DVec3::ZERO, DVec3::X, DVec3::ZERO];
/// let order = pellicle_spatial::brio::order(&points);
/// let at = |i: u32| order.iter().position(|&j| j == i).unwrap();
/// assert_eq!(at(0) + 1, at(2));
/// ```
pub fn order(points: &[DVec3]) -> Vec<u32> {
    let rounds = rounds(points.len());
    let all: Vec<u32> = (0..points.len() as u32).collect();
    curve_order(points, all, |p| {
        u64::from(round(p, rounds)) << (3 * hilbert::BITS)
    })
}

/// How many rounds: as many as leave about [`FIRST_ROUND`] points in the first, sixteen at most.
fn rounds(points: usize) -> u32 {
    ((points / FIRST_ROUND).max(1).ilog2() / 3 + 1).min(16)
}

/// The round of a point, from 0 for the first.
fn round(p: DVec3, rounds: u32) -> u32 {
    let skipped = hash(p).trailing_zeros() / 3;
    (rounds - 1).saturating_sub(skipped)
}

/// A hash of the coordinates in which every bit depends on every input bit (the mixer is SplitMix64's).
fn hash(p: DVec3) -> u64 {
    let mut state = 0x9e37_79b9_7f4a_7c15_u64;
    for coordinate in p.to_array() {
        // Adding 0.0 turns −0.0 into 0.0.
        state = state.wrapping_add((coordinate + 0.0).to_bits());
        state = (state ^ (state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        state = (state ^ (state >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        state ^= state >> 31;
    }
    state
}

/// The points named by `indices`, by `prefix`, then along the Hilbert curve through their box, then by
/// ever finer curves where many share a cell, at last lexicographically.
fn curve_order(
    points: &[DVec3],
    indices: Vec<u32>,
    prefix: impl Fn(DVec3) -> u64 + Sync,
) -> Vec<u32> {
    let grid = Grid::around(indices.iter().map(|&i| points[i as usize]));
    let mut keyed: Vec<(u64, u32)> = indices
        .par_iter()
        .map(|&i| {
            let p = points[i as usize];
            (prefix(p) | grid.key(p), i)
        })
        .collect();
    let mut order = indices;
    keyed.par_sort_unstable();

    let mut start = 0;
    for run in keyed.chunk_by(|a, b| a.0 == b.0) {
        let place = &mut order[start..start + run.len()];
        for (slot, &(_, i)) in place.iter_mut().zip(run) {
            *slot = i;
        }
        // A curve that tells no two points apart cannot be refined: they differ by denormals at most.
        if run.len() > CROWD && run.len() < keyed.len() {
            order_crowd(points, place);
        } else {
            order_lexicographically(points, place);
        }
        start += run.len();
    }
    order
}

/// Orders many points that share a cell by a curve through their own, far smaller box.
fn order_crowd(points: &[DVec3], cell: &mut [u32]) {
    let first = points[cell[0] as usize];
    if cell.iter().all(|&i| points[i as usize] == first) {
        cell.sort_unstable();
    } else {
        let finer = curve_order(points, cell.to_vec(), |_| 0);
        cell.copy_from_slice(&finer);
    }
}

fn order_lexicographically(points: &[DVec3], cell: &mut [u32]) {
    cell.sort_unstable_by(|&i, &j| {
        lexicographic(points[i as usize], points[j as usize]).then(i.cmp(&j))
    });
}

/// A grid of 2²⁰ cells along the longest side of a box.
struct Grid {
    /// Half the least corner: halves, so that no difference of finite coordinates overflows.
    half_min: DVec3,
    /// Half the longest side.
    half_side: f64,
}

impl Grid {
    fn around(points: impl Iterator<Item = DVec3>) -> Self {
        let bounds = points.fold(Aabb::EMPTY, Aabb::with);
        let half_min = bounds.min * 0.5;
        Self {
            half_min,
            half_side: (bounds.max * 0.5 - half_min).max_element(),
        }
    }

    #[inline]
    fn key(&self, p: DVec3) -> u64 {
        if self.half_side <= 0.0 {
            return 0;
        }
        let cells = f64::from(1 << hilbert::BITS);
        // Below `cells` even for the greatest coordinate; the cast saturates.
        let unit = (p * 0.5 - self.half_min) / self.half_side;
        let cell = (unit * cells).min(DVec3::splat(cells - 1.0));
        hilbert::key(cell.x as u32, cell.y as u32, cell.z as u32)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn coordinate() -> impl Strategy<Value = f64> {
        prop_oneof![
            (-4..4_i32).prop_map(f64::from),
            -1.0..1.0,
            Just(-0.0),
            Just(f64::MAX),
            Just(f64::MIN),
            Just(5e-324),
            any::<f64>().prop_filter("finite", |x| x.is_finite()),
        ]
    }

    fn cloud() -> impl Strategy<Value = Vec<DVec3>> {
        let point = (coordinate(), coordinate(), coordinate());
        prop::collection::vec(point.prop_map(|(x, y, z)| DVec3::new(x, y, z)), 0..200)
    }

    fn ordered(points: &[DVec3]) -> Vec<DVec3> {
        order(points).iter().map(|&i| points[i as usize]).collect()
    }

    proptest! {
        #[test]
        fn the_sequence_of_coordinates_does_not_depend_on_the_order_of_the_input(
            (points, shuffled) in cloud()
                .prop_flat_map(|points| (Just(points.clone()), Just(points).prop_shuffle()))
        ) {
            prop_assert_eq!(ordered(&points), ordered(&shuffled));
        }

        #[test]
        fn it_is_a_permutation_with_equal_points_side_by_side(points in cloud()) {
            let order = order(&points);
            let mut sorted = order.clone();
            sorted.sort_unstable();
            prop_assert_eq!(sorted, (0..points.len() as u32).collect::<Vec<_>>());
            let mut runs: Vec<DVec3> = order.iter().map(|&i| points[i as usize]).collect();
            runs.dedup();
            let mut distinct = runs.clone();
            distinct.sort_by(|a, b| lexicographic(*a, *b));
            distinct.dedup();
            prop_assert_eq!(runs.len(), distinct.len());
        }
    }

    #[test]
    fn a_crowded_cell_beside_an_outlier_is_ordered_by_a_finer_curve() {
        // Everything but the outlier shares one cell of the outer grid.
        let mut points: Vec<DVec3> = (0..4096)
            .map(|i| {
                DVec3::new(
                    f64::from(i % 16),
                    f64::from(i / 16 % 16),
                    f64::from(i / 256),
                )
            })
            .collect();
        points.push(DVec3::splat(1e300));
        let order = curve_order(&points, (0..points.len() as u32).collect(), |_| 0);
        let walk: f64 = order[..4096]
            .windows(2)
            .map(|pair| points[pair[0] as usize].distance(points[pair[1] as usize]))
            .sum();
        assert!(walk < 1.5 * 4096.0, "{walk}");
    }

    #[test]
    fn many_points_that_differ_by_denormals_only_end_the_refinement() {
        let points: Vec<DVec3> = (0..1000)
            .map(|i| DVec3::new(f64::from(i % 2) * 5e-324, 0.0, 0.0))
            .collect();
        let sequence = ordered(&points);
        assert!(sequence.is_sorted_by(|a, b| a.x <= b.x));
    }

    #[test]
    fn later_rounds_hold_seven_eighths() {
        let points: Vec<DVec3> = (0..100_000)
            .map(|i| DVec3::new(f64::from(i), 0.5, 0.25))
            .collect();
        let rounds = rounds(points.len());
        let last = points.iter().filter(|p| round(**p, rounds) == rounds - 1);
        let share = last.count() as f64 / points.len() as f64;
        assert!((0.86..0.89).contains(&share), "{share}");
    }
}
