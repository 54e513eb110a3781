//! A surface moves onto another, and changes its topology on the way (Zaharescu et al. 2007, section 4).
//!
//! Notation: d is the signed distance of a vertex from the target, negative inside; n its outward normal; L the length
//! that edges should have.

mod motion;
mod options;
mod start;
mod state;
mod target;

pub use options::{MorphEnd, MorphOptions, MorphReport, MorphStep, Placement, Topology};

use crate::{Error, Options};
use motion::Motion;
use pellicle_geometry::{Cancelled, Progress};
use pellicle_mesh::{MeshError, MeshView, TriMesh, TriangleSoup};
use state::{State, Verdict};
use target::Target;

/// Deforms a closed surface into another, topology included.
///
/// Every vertex moves along its normal by −d, at most a part of an edge: outside of the target the surface shrinks, inside
/// it grows. Two sheets that pass through each other while they shrink leave something inside out between them, which
/// [`repair`](crate::repair) removes: a hole opens, or a piece splits off or vanishes. Two that grow into each other overlap, and repair
/// merges them. So the solid becomes the target's, wherever it can come to:
///
/// - A component of the target is found if the source's inside and its inside overlap. One that is not is missing from
///   the result, and [`MorphReport::missed`] counts it. A source around everything finds all ([`Placement::Enclose`]).
/// - A cavity of the target that lies in the source entirely stays closed, since no surface is there to move.
///
/// 1. Repair both; place the source.
/// 2. Remesh to the length L.
/// 3. Some steps along the normals; near the target towards the nearest point, and smoothed.
/// 4. Repair, and drop crumbs that edges of the length L cannot resolve.
/// 5. On from step 2, until the surface stands on the target and its topology rests.
///
/// L begins at the source's own and is halved, whenever the surface rests, down to [`MorphOptions::edge_length`].
/// A step is O(n log n). The result does not depend on the number of threads.
///
/// ```
/// use pellicle_geometry::{DVec3, VertexId};
/// use pellicle_mesh::{TriangleSoup, icosphere};
/// use pellicle_transformesh::{MorphEnd, MorphOptions, morph};
///
/// // A sphere around two becomes these two.
/// let mut sphere = icosphere(2)?.into_soup();
/// let ball = |x: f64| sphere.positions.iter().map(move |&p| p + x * DVec3::X);
/// let count = sphere.positions.len() as u32;
/// let shifted = sphere.triangles.iter().map(|t| t.map(|v| VertexId(v.0 + count)));
/// let two = TriangleSoup {
///     positions: ball(-1.5).chain(ball(1.5)).collect(),
///     triangles: sphere.triangles.iter().copied().chain(shifted).collect(),
/// };
/// sphere.positions.iter_mut().for_each(|p| *p *= 3.0);
///
/// let (mesh, report) = morph(&sphere, &two, &MorphOptions::default())?;
/// assert_eq!(report.end, MorphEnd::Arrived);
/// assert_eq!(report.topology.genera, [0, 0]);
/// assert!(report.mean_distance < 0.25 * report.edge_length);
/// assert_eq!(pellicle_mesh::count_self_intersections((&mesh).into(), &())?, 0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`Error::Side`] if one of the two has a border other than that of a single missing triangle, or a position that is not
/// finite; [`Error::Empty`] if one encloses nothing; [`Error::Vanished`] if the surface shrank to nothing, since it did not overlap the target;
/// [`Error::Option`]; [`Error::Cancelled`].
pub fn morph<'a, 'b>(
    source: impl Into<MeshView<'a>>,
    target: impl Into<MeshView<'b>>,
    options: &MorphOptions,
) -> Result<(TriMesh, MorphReport), Error> {
    morph_with(source.into(), target.into(), options, &(), &mut |_, _| ())
}

/// [`morph`], watched: `progress` may stop it, `each_step` sees the surface after every step, the first being the start.
pub fn morph_with(
    source: MeshView,
    target: MeshView,
    options: &MorphOptions,
    progress: &dyn Progress,
    each_step: &mut dyn FnMut(&MorphStep, &TriMesh),
) -> Result<(TriMesh, MorphReport), Error> {
    options.check()?;
    let outcome = match start::scaled(source, target) {
        Some((source, target, unit)) => {
            run_scaled((&source, &target), unit, options, progress, each_step)
        }
        None => run(source, target, options, progress, each_step),
    };
    outcome.map_err(|error| match error {
        Error::Mesh(MeshError::Cancelled(cancelled)) => cancelled.into(),
        error => error,
    })
}

/// [`run`] with meshes that were divided by `unit`.
fn run_scaled(
    (source, target): (&TriangleSoup, &TriangleSoup),
    unit: f64,
    options: &MorphOptions,
    progress: &dyn Progress,
    each_step: &mut dyn FnMut(&MorphStep, &TriMesh),
) -> Result<(TriMesh, MorphReport), Error> {
    let options = MorphOptions {
        edge_length: options.edge_length.map(|length| length / unit),
        ..options.clone()
    };
    let mut each_step = |step: &MorphStep, mesh: &TriMesh| {
        // Only positions beyond the largest double cannot be told.
        if let Ok(mesh) = start::times(mesh, unit) {
            each_step(&step.clone().times(unit), &mesh);
        }
    };
    let (source, target) = (source.into(), target.into());
    let (mesh, report) = run(source, target, &options, progress, &mut each_step)?;
    Ok((start::times(&mesh, unit)?, report.times(unit)))
}

fn run(
    source: MeshView,
    target: MeshView,
    options: &MorphOptions,
    progress: &dyn Progress,
    each_step: &mut dyn FnMut(&MorphStep, &TriMesh),
) -> Result<(TriMesh, MorphReport), Error> {
    // 1.
    let target = Target::new(target, options, progress)?;
    let source = start::placed(source, &target, options.placement, progress)?;
    let mut state = State::new(source, &target, options)?;
    each_step(&state.record(), &state.mesh);
    while state.steps < options.max_steps {
        let total = u64::from(options.max_steps);
        Cancelled::check(progress.step("morph", u64::from(state.steps), total))?;
        // 2.
        state.remesh(progress)?;
        // 3.
        for left in (0..options.repair_every).rev() {
            let motion = Motion::of(&state.mesh, &target, state.edge, options);
            state.advance(motion)?;
            if left > 0 {
                each_step(&state.record(), &state.mesh);
            }
        }
        // 4.
        state.repair(&Options::default(), progress)?;
        each_step(&state.record(), &state.mesh);
        // 5.
        match state.judge()? {
            Verdict::Moving => {}
            Verdict::Resting if state.refine() => {}
            Verdict::Resting => return state.finish(MorphEnd::Resting),
            Verdict::Arrived => return state.finish(MorphEnd::Arrived),
        }
    }
    state.finish(MorphEnd::StepLimit)
}
