//! What is measured after each step.

use crate::StepReport;
use pellicle_mesh::{AngleBounds, TriMesh, area, quality, signed_volume};

/// The surface after a step, in numbers. Lengths in the units of the points, angles in degrees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measures {
    /// The stage, from zero.
    pub stage: usize,
    /// The step, from one, over all stages.
    pub step: u64,
    /// τ of the step.
    pub time_step: f64,
    /// The side of a voxel, in which moves are judged.
    pub spacing: f64,
    /// Vertices.
    pub vertices: usize,
    /// The area of the surface.
    pub area: f64,
    /// The volume inside, (6.2).
    pub volume: f64,
    /// The least area of a triangle.
    pub least_area: f64,
    /// The greatest area of a triangle.
    pub greatest_area: f64,
    /// Standard deviation over mean of the co-volume areas.
    pub area_variation: f64,
    /// The least angle of a triangle.
    pub least_angle: f64,
    /// The greatest angle of a triangle.
    pub greatest_angle: f64,
    /// The farthest that a vertex moved.
    pub largest_move: f64,
    /// The farthest that a vertex moved along its normal.
    pub largest_normal_move: f64,
    /// Iterations of the solver for ψ.
    pub potential_iterations: usize,
    /// Iterations of the solver for the positions.
    pub motion_iterations: usize,
    /// Seconds since the start.
    pub seconds: f64,
}

impl Measures {
    /// The names of the columns of [`Measures::to_csv`].
    pub const CSV_HEADER: &'static str = "stage,step,time_step,spacing,vertices,area,volume,least_area,\
        greatest_area,area_variation,least_angle,greatest_angle,largest_move,largest_normal_move,\
        potential_iterations,motion_iterations,seconds";

    pub(crate) fn of(
        mesh: &TriMesh,
        stage: usize,
        step: u64,
        report: &StepReport,
        spacing: f64,
        seconds: f64,
    ) -> Self {
        let quality = quality(mesh.into(), &AngleBounds::default());
        let of = |f: fn(&pellicle_mesh::Quality) -> f64| quality.as_ref().map_or(f64::NAN, f);
        Self {
            stage,
            step,
            time_step: report.time_step,
            spacing,
            vertices: mesh.positions().len(),
            area: area(mesh.into()),
            volume: signed_volume(mesh.into()),
            least_area: of(|q| q.min_area),
            greatest_area: of(|q| q.max_area),
            area_variation: of(|q| q.vertex_area_variation),
            least_angle: of(|q| q.min_angle.to_degrees()),
            greatest_angle: of(|q| q.max_angle.to_degrees()),
            largest_move: report.largest_move,
            largest_normal_move: report.largest_normal_move,
            potential_iterations: report.potential_iterations,
            motion_iterations: report.motion_iterations,
            seconds,
        }
    }

    /// One line of a table, without its end.
    pub fn to_csv(&self) -> String {
        let Self {
            stage,
            step,
            time_step,
            spacing,
            vertices,
            area,
            volume,
            least_area,
            greatest_area,
            area_variation,
            least_angle,
            greatest_angle,
            largest_move,
            largest_normal_move,
            potential_iterations,
            motion_iterations,
            seconds,
        } = self;
        format!(
            "{stage},{step},{time_step},{spacing},{vertices},{area},{volume},{least_area},{greatest_area},\
             {area_variation},{least_angle},{greatest_angle},{largest_move},{largest_normal_move},\
             {potential_iterations},{motion_iterations},{seconds:.3}"
        )
    }
}
