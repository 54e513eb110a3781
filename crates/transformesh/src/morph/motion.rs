//! Where vertices go in a step.

use super::options::MorphOptions;
use super::target::Target;
use pellicle_geometry::{DVec3, VertexId, triangle};
use pellicle_mesh::{SignedDistanceSample, TriMesh};
use rayon::prelude::*;

/// A step, not yet taken.
pub(super) struct Motion {
    pub(super) positions: Vec<DVec3>,
    /// |d| over the vertices, before the step.
    pub(super) mean_distance: f64,
    pub(super) greatest_distance: f64,
    pub(super) largest_move: f64,
}

impl Motion {
    pub(super) fn of(mesh: &TriMesh, target: &Target, edge: f64, options: &MorphOptions) -> Self {
        let samples = target.distance.samples(mesh.positions());
        let positions: Vec<DVec3> = (0..samples.len())
            .into_par_iter()
            .map(|v| {
                let vertex = VertexId::new(v);
                let p = mesh.position(vertex);
                p + displacement(mesh, vertex, &samples[v], edge, options)
            })
            .collect();
        let moves = mesh.positions().iter().zip(&positions);
        let distances = samples.iter().map(|s| s.distance.abs());
        Self {
            mean_distance: distances.clone().sum::<f64>() / samples.len().max(1) as f64,
            greatest_distance: distances.fold(0.0, f64::max),
            largest_move: moves.map(|(p, q)| p.distance(*q)).fold(0.0, f64::max),
            positions,
        }
    }
}

/// How far a vertex moves: by −d along its normal n; nearer than L, and where the target faces as the surface does,
/// towards the nearest point instead; and towards the middle of its neighbours, less so across the surface when near.
fn displacement(
    mesh: &TriMesh,
    vertex: VertexId,
    sample: &SignedDistanceSample,
    edge: f64,
    options: &MorphOptions,
) -> DVec3 {
    let p = mesh.position(vertex);
    let d = sample.distance;
    let normal = normal(mesh, vertex);
    let limit = options.step * edge;
    let along = normal * (-d).clamp(-limit, limit);
    let foot = sample.nearest - p;
    // The gradient of the distance points outwards, on either side; on the target itself it is unknown, and does no harm.
    let facing = match d == 0.0 {
        true => 1.0,
        false => (-foot / d).dot(normal),
    };
    let aligned = (2.0 * facing - 0.5).clamp(0.0, 1.0);
    let near = (2.0 - 2.0 * d.abs() / edge).clamp(0.0, 1.0);
    let pull = aligned * near;
    let advance = along.lerp(foot.clamp_length_max(limit), pull);

    let (sum, count) = mesh
        .neighbors(vertex)
        .fold((DVec3::ZERO, 0.0), |(sum, n), v| {
            (sum + mesh.position(v), n + 1.0)
        });
    let to_middle = sum / count - p;
    let across = normal * to_middle.dot(normal);
    let along_surface = to_middle - across;
    let smooth = along_surface + across * (1.0 - pull);
    (advance + smooth * options.smoothing).clamp_length_max(limit)
}

/// The outward normal, from the triangles around by their angles; zero where they cancel.
pub(super) fn normal(mesh: &TriMesh, vertex: VertexId) -> DVec3 {
    let mut sum = DVec3::ZERO;
    for h in mesh.outgoing_half_edges(vertex) {
        let [a, b, c] = [h, h.next(), h.previous()].map(|h| mesh.position(mesh.origin(h)));
        if let Some(normal) = triangle::unit_normal(a, b, c) {
            sum += normal * triangle::angle_between(b - a, c - a);
        }
    }
    sum.normalize_or_zero()
}
