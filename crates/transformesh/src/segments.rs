//! Where triangles meet, as segments for whoever wants to see them.

use crate::Error;
use crate::intersection::Meetings;
use crate::observer::Segment;
use crate::points::Points;
use crate::repair::{Watch, check};
use crate::weld::Weld;
use pellicle_geometry::{Cancelled, DVec3, Progress, VertexId};
use pellicle_mesh::{MeshView, TriangleId, self_intersections};
use std::cmp::Ordering;

/// Pairs looked at from one question whether to stop to the next.
const CHUNK: usize = 4096;

/// The segments in which the triangles of a mesh meet where they should not: their ends exact, then rounded to the
/// nearest doubles.
///
/// Of each pair of [`self_intersections`]:
///
/// ```text
///   in two planes: a segment, or a point            in one plane: the border of the common polygon
///
///            ╱╲                                        ┌───────┐
///           ╱  ╲                                       │   ┏━━━┓───┐
///     ─────●━━━━●─────  seen along the plane           │   ┃   ┃   │
///         ╱      ╲                                     └───┗━━━┛   │
///        ╱────────╲                                        └───────┘
/// ```
///
/// A point is a segment with equal ends. Of triangles that meet in a common corner and further, the segment starts in that
/// corner; of two that lie on each other, their edges are segments. Each segment of a pair comes once, from its lesser end
/// (by x, then y, then z) to its greater one; they are sorted by their triangles, then by their ends. A place at which three
/// triangles meet is in the segments of three pairs.
///
/// Triangles without area have no plane and are left out, although [`self_intersections`] counts them; such pairs have no
/// segment. Fails if a vertex is not finite or does not exist, or if stopped. O(n log n + c), with c the candidate pairs.
///
/// ```
/// use pellicle_geometry::{DVec3, VertexId};
/// use pellicle_mesh::TriangleSoup;
/// use pellicle_transformesh::intersection_segments;
/// let crossing = TriangleSoup {
///     positions: vec![
///         DVec3::ZERO, 4.0 * DVec3::X, 4.0 * DVec3::Y,
///         DVec3::new(1.0, 1.0, -1.0), DVec3::new(1.0, 1.0, 1.0), DVec3::new(1.0, 9.0, 0.0),
///     ],
///     triangles: vec![[0, 1, 2].map(VertexId), [3, 4, 5].map(VertexId)],
/// };
/// let segments = intersection_segments((&crossing).into(), &())?;
/// assert_eq!(segments[0].ends, [DVec3::new(1.0, 1.0, 0.0), DVec3::new(1.0, 3.0, 0.0)]);
/// # Ok::<(), pellicle_transformesh::Error>(())
/// ```
pub fn intersection_segments(
    mesh: MeshView,
    progress: &dyn Progress,
) -> Result<Vec<Segment>, Error> {
    check(mesh)?;
    let mut weld = Weld::new(mesh);
    let pairs = self_intersections(weld.view(), &Watch(progress))?;
    let mut points = Points::new(&mut weld);
    segments(&weld, &pairs, &mut points, progress)
}

/// The segments of these pairs. Points are interned in the order in which [`Meetings::new`] does for all pairs.
pub(crate) fn segments(
    weld: &Weld,
    pairs: &[(TriangleId, TriangleId)],
    points: &mut Points,
    progress: &dyn Progress,
) -> Result<Vec<Segment>, Error> {
    let mut segments = Vec::with_capacity(pairs.len());
    for (i, chunk) in pairs.chunks(CHUNK).enumerate() {
        let done = (i * CHUNK) as u64;
        Cancelled::check(progress.step("segments", done, pairs.len() as u64))?;
        let meetings = Meetings::new(weld, chunk, points);
        // Each stands in both triangles: the lesser one's.
        let once = meetings.constraints.iter().filter(|c| c.triangle < c.other);
        let mut once: Vec<_> = once
            .map(|c| ([c.triangle, c.other], in_order(c.ends, points)))
            .collect();
        // Equal points have equal ids.
        once.sort_unstable();
        once.dedup();
        for of_pair in once.chunk_by(|a, b| a.0 == b.0) {
            let is_point = |ends: [VertexId; 2]| ends[0] == ends[1];
            // In one plane, corners of the common polygon where an edge ends or turns away.
            let has_length = of_pair.iter().any(|&(_, ends)| !is_point(ends));
            let kept = of_pair
                .iter()
                .filter(|&&(_, ends)| !(has_length && is_point(ends)));
            segments.extend(kept.map(|&(triangles, ends)| Segment {
                triangles: triangles.map(|t| weld.sources[t as usize]),
                ends: ends.map(|v| points.rounded(v)),
            }));
        }
    }
    segments.sort_by(|a, b| {
        let ends = a.ends.iter().zip(&b.ends);
        ends.fold(a.triangles.cmp(&b.triangles), |order, (p, q)| {
            order.then_with(|| compare(*p, *q))
        })
    });
    Ok(segments)
}

fn in_order([a, b]: [VertexId; 2], points: &Points) -> [VertexId; 2] {
    match points.compare_all(a, b) {
        Ordering::Greater => [b, a],
        _ => [a, b],
    }
}

fn compare(p: DVec3, q: DVec3) -> Ordering {
    let axes = p.to_array().into_iter().zip(q.to_array());
    axes.fold(Ordering::Equal, |order, (a, b)| {
        order.then_with(|| a.total_cmp(&b))
    })
}
