//! Where a surface is about to run into itself.
//!
//! The method lets the surface shrink over a hole of the object from both sides, or onto both sides of an open sheet of
//! points; nothing in (3.2) keeps the two sheets apart.
//!
//! ```text
//!     N ↑
//!    ───i───        i is held if the sheet across, with its normal turned away, is nearer than `reach`
//!       ↕ gap       and nearer than twice the distance d to the points: were the points
//!    ───j───        between i and the middle of the gap, they would stop it.
//!     N ↓
//! ```

use crate::field::Sample;
use crate::finite_volumes::FiniteVolumes;
use crate::rings::Rings;
use glam::DVec3;
use pellicle_spatial::KdTree;
use rayon::prelude::*;

/// Which vertices have to be held. O(n log n) where few vertices are within `reach` of each other.
pub(crate) fn held(
    rings: &Rings,
    volumes: &FiniteVolumes,
    samples: &[Sample],
    positions: &[DVec3],
    reach: f64,
) -> Vec<bool> {
    /// The cosine beyond which two normals count as turned away from each other.
    const TURNED_AWAY: f64 = -0.3;
    let tree = KdTree::new(positions);
    (0..positions.len())
        .into_par_iter()
        .map(|i| {
            let normal = volumes.normals[i];
            let near = tree.within(positions[i], reach);
            near.iter().any(|other| {
                let j = other.index as usize;
                let turned_away = volumes.normals[j].dot(normal) < TURNED_AWAY;
                if !turned_away || rings.around(i).iter().any(|e| e.neighbor == other.index) {
                    return false;
                }
                // The sheet across is taken for its tangent plane at j, as far as its triangles may reach from there.
                let across = positions[i] - positions[j];
                let gap = across.dot(volumes.normals[j]).abs();
                let aside = (across.length_squared() - gap * gap).max(0.0).sqrt();
                gap < reach.min(2.0 * samples[i].value) && aside < 0.5 * reach
            })
        })
        .collect()
}
