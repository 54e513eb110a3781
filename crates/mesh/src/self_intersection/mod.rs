//! Pairs of triangles that meet where they should not: candidates by boxes, decision by signs.

mod triangle_pair;

pub use triangle_pair::triangles_intersect;

use crate::{MeshError, MeshView, TriangleId};
use pellicle_geometry::{Aabb, Cancelled, Progress};
use pellicle_spatial::Bvh;
use pellicle_spatial::bvh::OverlapTask;
use rayon::prelude::*;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicU64, Ordering};

/// Parts of the search: enough to keep any number of threads busy and to stop soon when asked.
const TASKS: usize = 4096;

/// All pairs of triangles that intersect other than in common corners or a common edge, each as (lesser,
/// greater), sorted. Exact; see [`triangles_intersect`] for what counts.
///
/// Triangles with a corner out of range or not finite are left out. O(n log n + c), with c the pairs whose
/// boxes meet: quadratic where very many triangles share a vertex. The result does not depend on the number
/// of threads. The one error is [`MeshError::Cancelled`].
///
/// ```
/// use pellicle_geometry::{DVec3, VertexId};
/// use pellicle_mesh::{TriangleId, TriangleSoup, self_intersections};
/// let soup = TriangleSoup {
///     positions: vec![
///         DVec3::ZERO, DVec3::X, DVec3::Y,
///         DVec3::new(0.2, 0.2, -1.0), DVec3::new(0.2, 0.3, 1.0), DVec3::new(0.3, 0.2, 1.0),
///     ],
///     triangles: vec![[0, 1, 2].map(VertexId), [3, 4, 5].map(VertexId)],
/// };
/// let pairs = self_intersections((&soup).into(), &())?;
/// assert_eq!(pairs, [(TriangleId(0), TriangleId(1))]);
/// # Ok::<(), pellicle_mesh::MeshError>(())
/// ```
pub fn self_intersections(
    mesh: MeshView,
    progress: &impl Progress,
) -> Result<Vec<(TriangleId, TriangleId)>, MeshError> {
    let search = Search::new(mesh)?;
    let parts: Vec<Vec<_>> = search.run(progress, |pairs: &mut Vec<_>, pair| pairs.push(pair))?;
    let mut pairs = parts.concat();
    pairs.par_sort_unstable();
    Ok(pairs)
}

/// How many pairs [`self_intersections`] finds, without holding them.
pub fn count_self_intersections(
    mesh: MeshView,
    progress: &impl Progress,
) -> Result<u64, MeshError> {
    let search = Search::new(mesh)?;
    let parts: Vec<u64> = search.run(progress, |count: &mut u64, _| *count += 1)?;
    Ok(parts.into_iter().sum())
}

struct Search<'a> {
    mesh: MeshView<'a>,
    bvh: Bvh,
    tasks: Vec<OverlapTask>,
}

impl<'a> Search<'a> {
    fn new(mesh: MeshView<'a>) -> Result<Self, MeshError> {
        mesh.check_size()?;
        let boxes: Vec<Aabb> = (0..mesh.triangles.len())
            .into_par_iter()
            .map(|t| bounds(mesh, TriangleId::new(t)))
            .collect();
        let bvh = Bvh::new(boxes);
        let tasks = bvh.overlap_tasks(TASKS);
        Ok(Self { mesh, bvh, tasks })
    }

    /// Folds the intersecting pairs of each task, in the order of the tasks.
    fn run<T: Default + Send>(
        &self,
        progress: &impl Progress,
        add: impl Fn(&mut T, (TriangleId, TriangleId)) + Sync,
    ) -> Result<Vec<T>, Cancelled> {
        const STAGE: &str = "self-intersections";
        let total = self.tasks.len() as u64;
        let done = AtomicU64::new(0);
        self.tasks
            .par_iter()
            .map(|&task| {
                let mut found = T::default();
                let mut tested = 0_u32;
                let flow = self.bvh.overlaps_of(task, |s, t| {
                    let pair = (TriangleId(s), TriangleId(t));
                    if let (Some(a), Some(b)) =
                        (self.mesh.corners(pair.0), self.mesh.corners(pair.1))
                        && triangles_intersect(a, b)
                    {
                        add(&mut found, pair);
                    }
                    tested += 1;
                    match tested % 16_384 {
                        0 => progress.step(STAGE, done.load(Ordering::Relaxed), total),
                        _ => ControlFlow::Continue(()),
                    }
                });
                Cancelled::check(flow)?;
                let finished = done.fetch_add(1, Ordering::Relaxed) + 1;
                Cancelled::check(progress.step(STAGE, finished, total))?;
                Ok(found)
            })
            .collect()
    }
}

/// The box of a triangle; empty if a corner is out of range or not finite.
pub(crate) fn bounds(mesh: MeshView, triangle: TriangleId) -> Aabb {
    match mesh.corners(triangle) {
        Some(corners) if corners.iter().all(|p| p.is_finite()) => Aabb::of_points(&corners),
        _ => Aabb::EMPTY,
    }
}
