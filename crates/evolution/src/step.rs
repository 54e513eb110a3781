//! One step of the evolution (3.2), fully discretised: Daniel 2015, section 4, with the signs of the errata.

use crate::Error;
use crate::contact;
use crate::field::{Field, Sample};
use crate::finite_volumes::FiniteVolumes;
use crate::linear::Convergence;
use crate::parallel::fill;
use crate::redistribution::{self, Redistribution};
use crate::rings::Rings;
use crate::systems::{SystemSolver, Systems};
use crate::velocity;
use glam::DVec3;
use pellicle_geometry::{VertexId, first_not_finite};
use pellicle_mesh::{TriMesh, signed_volume};
use tracing::trace_span;

/// The parameters of a step, in the units of the coordinates and a unit of time of the caller's choice.
#[derive(Clone, Debug, PartialEq)]
pub struct StepOptions {
    /// w_a of (3.2), length per time: the speed of advection along −∇d where that is the normal. The paper: 300.
    pub advection: f64,
    /// w_d of (3.2), length per time: a sphere of radius R at distance d shrinks by 2 w_d d / R. The paper: 100.
    pub diffusion: f64,
    /// τ, time. The paper: 0.001.
    pub time_step: f64,
    /// v_T, and its ω. The paper: area-uniform with ω = 100.
    pub redistribution: Redistribution,
    /// No vertex moves farther in a step than this share of its shortest edge, or of the mean edge if that is shorter,
    /// nor half as far along the surface: first τ is cut, to an eighth at most, then the moves. Infinite: no cap.
    pub move_limit: f64,
    /// What, beyond the paper, keeps a film that spans an opening in motion; none by default.
    pub deflation: Option<Deflation>,
    /// How ψ is solved for.
    pub potential_solver: SystemSolver,
    /// How the positions are solved for.
    pub motion_solver: SystemSolver,
}

impl Default for StepOptions {
    /// The paper's values for its figures 6 to 8, without a cap. They suit voxels of about one unit.
    fn default() -> Self {
        Self {
            advection: 300.0,
            diffusion: 100.0,
            time_step: 0.001,
            redistribution: Redistribution::AreaUniform { omega: 100.0 },
            move_limit: f64::INFINITY,
            deflation: None,
            potential_solver: SystemSolver::POTENTIAL,
            motion_solver: SystemSolver::MOTION,
        }
    }
}

/// A least speed inward, far from the points.
///
/// Halfway between two objects, and in the middle of a hole, ∇d lies in the film that spans them and the film is flat: neither
/// term of (3.2) moves it, and its two sheets meet never. With a speed of their own they pass through each other; a repair of
/// the topology takes away what is then inside out, and the film is open.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Deflation {
    /// The speed, length per time.
    pub speed: f64,
    /// Where d is more than this: half the width of the narrowest opening.
    pub beyond: f64,
}

/// What a step did.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepReport {
    /// τ, after the cap.
    pub time_step: f64,
    /// The farthest that a vertex moved, tangentially included.
    pub largest_move: f64,
    /// The farthest that a vertex moved along its normal: what changes the shape.
    pub largest_normal_move: f64,
    /// How many vertices had their move cut.
    pub capped: usize,
    /// Iterations for ψ; zero without redistribution.
    pub potential_iterations: usize,
    /// Iterations for the positions.
    pub motion_iterations: usize,
}

/// A closed surface in motion. Its connectivity never changes; what follows from that alone is kept from step to step.
///
/// ```
/// use pellicle_evolution::{Evolution, One, Redistribution, StepOptions};
/// use pellicle_mesh::{icosphere, signed_volume};
///
/// // The unit sphere under mean curvature flow: R² = 1 − 4t.
/// let options = StepOptions {
///     diffusion: 1.0,
///     redistribution: Redistribution::None,
///     ..StepOptions::default()
/// };
/// let mut evolution = Evolution::new(icosphere(3)?)?;
/// for _ in 0..100 {
///     evolution.step(&One, &options)?;
/// }
/// let radius = evolution.mesh().positions()[0].length();
/// assert!((radius - 0.6_f64.sqrt()).abs() < 0.01);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct Evolution {
    mesh: TriMesh,
    rings: Rings,
    systems: Systems,
    steps: u64,
    volumes: FiniteVolumes,
    samples: Vec<Sample>,
    psi: Vec<f64>,
    tangential: Vec<DVec3>,
    /// Which vertices do not move, since another sheet is near; empty for none.
    held: Vec<bool>,
    /// Which vertices do not move any more; empty for none.
    pinned: Vec<bool>,
}

/// Moves a closed surface by one step. [`Evolution`] does the same for many steps and keeps what they share.
///
/// # Errors
///
/// Those of [`Evolution::new`] and [`Evolution::step`].
pub fn step(mesh: TriMesh, field: &dyn Field, options: &StepOptions) -> Result<TriMesh, Error> {
    let mut evolution = Evolution::new(mesh)?;
    evolution.step(field, options)?;
    Ok(evolution.into_mesh())
}

impl Evolution {
    /// A surface at rest.
    ///
    /// # Errors
    ///
    /// [`Error::NotClosed`] for a mesh with a border or without triangles.
    pub fn new(mesh: TriMesh) -> Result<Self, Error> {
        let rings = match Rings::of(&mesh) {
            Some(rings) if rings.vertices() > 0 => rings,
            _ => return Err(Error::not_closed(&mesh)),
        };
        Ok(Self {
            systems: Systems::new(&rings)?,
            psi: vec![0.0; rings.vertices()],
            mesh,
            rings,
            steps: 0,
            volumes: FiniteVolumes::default(),
            samples: Vec::new(),
            tangential: Vec::new(),
            held: Vec::new(),
            pinned: Vec::new(),
        })
    }

    /// The surface as it is.
    pub fn mesh(&self) -> &TriMesh {
        &self.mesh
    }

    /// The surface as it is.
    pub fn into_mesh(self) -> TriMesh {
        self.mesh
    }

    /// How many steps were done.
    pub fn steps(&self) -> u64 {
        self.steps
    }

    /// One step. After an error the surface stands where it stood before.
    ///
    /// Linear in the number of vertices but for the solvers. Its parts are spans of `tracing`, at the level of a trace.
    ///
    /// # Errors
    ///
    /// [`Error::NotFinite`] if the field has no finite value at a vertex, or the vertex would leave all bounds;
    /// [`Error::Linear`] if a solver stalls.
    pub fn step(&mut self, field: &dyn Field, options: &StepOptions) -> Result<StepReport, Error> {
        // 1. Measure the surface, and the field at its vertices.
        let positions = self.mesh.positions();
        trace_span!("measure").in_scope(|| self.volumes.measure(&self.rings, positions));
        trace_span!("sample").in_scope(|| {
            fill(&mut self.samples, positions.len(), |i| {
                field.sample(positions[i])
            });
        });
        let broken = |s: &Sample| !s.value.is_finite() || !s.gradient.is_finite();
        if let Some(i) = self.samples.iter().position(broken) {
            return Err(self.not_finite(VertexId::new(i)));
        }
        for (i, sample) in self.samples.iter_mut().enumerate() {
            if is_still(&self.held, &self.pinned, i) {
                *sample = Sample {
                    value: 0.0,
                    gradient: DVec3::ZERO,
                };
            }
        }

        // 2. The normal velocity, as a speed along N from advection, and as w_d d h from diffusion.
        let w_d = options.diffusion;
        let (volumes, samples) = (&self.volumes, &self.samples);
        let advection: Vec<f64> = (0..positions.len())
            .map(|i| {
                let advection = velocity::advection(options.advection, volumes, &samples[i], i);
                velocity::deflated(advection, options.deflation, &samples[i])
            })
            .collect();

        // 3. The tangential velocity.
        let potential =
            trace_span!("redistribute").in_scope(|| self.redistribute(&advection, options))?;

        // 4. The step in time that no vertex goes too far in; half as far along the surface.
        let reach = self.reach();
        for (i, velocity) in self.tangential.iter_mut().enumerate() {
            if is_still(&self.held, &self.pinned, i) {
                *velocity = DVec3::ZERO;
            }
        }
        for (velocity, reach) in self.tangential.iter_mut().zip(&reach) {
            let limit = 0.5 * options.move_limit * reach / options.time_step;
            *velocity = velocity.clamp_length_max(limit);
        }
        let tau = self.time_step(&advection, &reach, options);

        // 5. (diag μ + τ w_d D K) Fⁿ = μ (F + τ adv N + τ v_T).
        let positions = self.mesh.positions();
        let (volumes, samples, tangential) = (&self.volumes, &self.samples, &self.tangential);
        let mut right_side = Vec::new();
        fill(&mut right_side, positions.len(), |i| {
            let motion = advection[i] * volumes.normals[i] + tangential[i];
            volumes.areas[i] * (positions[i] + tau * motion)
        });
        let mut moved = positions.to_vec();
        let motion = trace_span!("solve for the positions").in_scope(|| {
            self.systems.solve_motion(
                &self.rings,
                volumes,
                |i| tau * w_d * samples[i].value,
                &right_side,
                &mut moved,
                &options.motion_solver,
            )
        })?;
        if let Some(vertex) = first_not_finite(&moved) {
            return Err(self.not_finite(vertex));
        }

        // 6. Cut what still goes too far, and move.
        let mut report = StepReport {
            time_step: tau,
            largest_move: 0.0,
            largest_normal_move: 0.0,
            capped: 0,
            potential_iterations: potential.map_or(0, |c| c.iterations),
            motion_iterations: motion.iterations,
        };
        for (i, target) in moved.iter_mut().enumerate() {
            let displacement = *target - positions[i];
            let limit = options.move_limit * reach[i];
            let length = displacement.length();
            if length > limit {
                *target = positions[i] + displacement * (limit / length);
                report.capped += 1;
            }
            let displacement = *target - positions[i];
            report.largest_move = report.largest_move.max(displacement.length());
            let normal_move = displacement.dot(volumes.normals[i]).abs();
            report.largest_normal_move = report.largest_normal_move.max(normal_move);
        }
        self.mesh.set_positions(moved)?;
        self.steps += 1;
        Ok(report)
    }

    /// Holds the vertices at which the surface is about to run into itself, until this is called again: those for which
    /// another sheet, with its normal turned away, is nearer than `reach` and than twice the distance to the points.
    /// Returns how many. O(n log n).
    pub fn hold_contacts(&mut self, field: &dyn Field, reach: f64) -> usize {
        let positions = self.mesh.positions();
        self.volumes.measure(&self.rings, positions);
        fill(&mut self.samples, positions.len(), |i| {
            field.sample(positions[i])
        });
        self.held = contact::held(&self.rings, &self.volumes, &self.samples, positions, reach);
        self.held.iter().filter(|&&held| held).count()
    }

    /// Goes back to an earlier position, and never moves again the vertices named, nor their neighbours.
    pub(crate) fn rewind(&mut self, earlier: &TriMesh, vertices: &[usize]) -> Result<(), Error> {
        self.mesh.set_positions(earlier.positions().to_vec())?;
        self.pinned.resize(self.rings.vertices(), false);
        for &i in vertices {
            self.pinned[i] = true;
            for edge in self.rings.around(i) {
                self.pinned[edge.neighbor as usize] = true;
            }
        }
        Ok(())
    }

    /// Pushes the surface along its normals until it holds a volume: two steps of Newton's method, whose derivative is
    /// the area.
    ///
    /// # Errors
    ///
    /// [`Error::NotFinite`] if that would take a vertex out of all bounds.
    pub fn restore_volume(&mut self, volume: f64) -> Result<(), Error> {
        for _ in 0..2 {
            self.volumes.measure(&self.rings, self.mesh.positions());
            let area: f64 = self.volumes.total_areas.iter().sum();
            let lacking = volume - signed_volume((&self.mesh).into());
            let pushed = self.mesh.positions().iter().zip(&self.volumes.normals);
            let pushed: Vec<DVec3> = pushed.map(|(&p, &n)| p + lacking / area * n).collect();
            if let Some(vertex) = first_not_finite(&pushed) {
                return Err(self.not_finite(vertex));
            }
            self.mesh.set_positions(pushed)?;
        }
        Ok(())
    }

    /// Sets v_T.
    fn redistribute(
        &mut self,
        advection: &[f64],
        options: &StepOptions,
    ) -> Result<Option<Convergence>, Error> {
        let vertices = self.rings.vertices();
        let (omega, curvature, omega_angles) = match options.redistribution {
            Redistribution::None => {
                self.tangential.clear();
                self.tangential.resize(vertices, DVec3::ZERO);
                return Ok(None);
            }
            Redistribution::AreaUniform { omega } => (omega, None, 0.0),
            Redistribution::CurvatureDriven { omega, density } => (omega, Some(density), 0.0),
            Redistribution::AngleAware {
                omega,
                omega_angles,
            } => (omega, None, omega_angles),
        };
        let shares = match curvature {
            None => redistribution::target_shares(&self.rings, |_| 1.0),
            Some(density) => {
                let curvatures = self.regularised_curvatures(&options.motion_solver)?;
                let area: f64 = self.volumes.total_areas.iter().sum();
                let unit = density
                    .unit
                    .unwrap_or((area / (4.0 * std::f64::consts::PI)).sqrt());
                redistribution::target_shares(&self.rings, |i| {
                    density.function.value(unit * curvatures[i])
                })
            }
        };
        let (rings, volumes) = (&self.rings, &self.volumes);
        let q: Vec<f64> = (0..vertices)
            .map(|i| {
                let sample = &self.samples[i];
                velocity::normal_velocity_dot_curvature(
                    advection[i],
                    options.diffusion,
                    volumes,
                    sample,
                    i,
                )
            })
            .collect();
        let right_side = redistribution::right_side(rings, volumes, &q, &shares, omega);
        let solved = trace_span!("solve for ψ").in_scope(|| {
            self.systems.solve_potential(
                rings,
                volumes,
                &right_side,
                &mut self.psi,
                &options.potential_solver,
            )
        })?;
        let positions = self.mesh.positions();
        redistribution::gradient_velocity(
            &mut self.tangential,
            rings,
            volumes,
            positions,
            &self.psi,
        );
        if omega_angles > 0.0 {
            let gradient = std::mem::take(&mut self.tangential);
            fill(&mut self.tangential, vertices, |i| {
                let towards = redistribution::towards_equilateral(rings, volumes, positions, i);
                gradient[i] + omega_angles * towards
            });
        }
        Ok(Some(solved))
    }

    /// H̃: the mean curvature after three steps of mean curvature flow, each of half the mean co-volume area, so that
    /// what it smooths is as wide as the mesh is coarse.
    fn regularised_curvatures(&mut self, solver: &SystemSolver) -> Result<Vec<f64>, Error> {
        let mut positions = self.mesh.positions().to_vec();
        let mut volumes = self.volumes.clone();
        for _ in 0..3 {
            let area: f64 = volumes.total_areas.iter().sum();
            let time = 0.5 * area / positions.len() as f64;
            let mut right_side = Vec::new();
            fill(&mut right_side, positions.len(), |i| {
                volumes.areas[i] * positions[i]
            });
            self.systems.solve_motion(
                &self.rings,
                &volumes,
                |_| time,
                &right_side,
                &mut positions,
                solver,
            )?;
            volumes.measure(&self.rings, &positions);
        }
        Ok(volumes.curvatures)
    }

    /// H̃ of the surface as it is.
    #[cfg(test)]
    pub(crate) fn curvatures_for_test(&mut self) -> Vec<f64> {
        self.volumes.measure(&self.rings, self.mesh.positions());
        self.regularised_curvatures(&SystemSolver::MOTION).unwrap()
    }

    /// The shortest edge of each vertex, or the mean length of all if that is less.
    fn reach(&self) -> Vec<f64> {
        let positions = self.mesh.positions();
        let edges = |i: usize| {
            let around = self.rings.around(i).iter();
            around.map(move |e| positions[e.neighbor as usize].distance_squared(positions[i]))
        };
        let sum: f64 = (0..positions.len()).map(|i| edges(i).sum::<f64>()).sum();
        let mean_square = sum / self.rings.len() as f64;
        let mut reach = Vec::new();
        fill(&mut reach, positions.len(), |i| {
            edges(i).fold(mean_square, f64::min).sqrt()
        });
        reach
    }

    /// τ, cut where a vertex would go too far by the explicit velocity.
    fn time_step(&self, advection: &[f64], reach: &[f64], options: &StepOptions) -> f64 {
        const DEEPEST_CUT: f64 = 0.125;
        if options.move_limit == f64::INFINITY {
            return options.time_step;
        }
        let (volumes, w_d) = (&self.volumes, options.diffusion);
        let share = (0..reach.len()).map(|i| {
            let velocity = advection[i] * volumes.normals[i]
                + w_d * self.samples[i].value * volumes.curvature_vectors[i]
                + self.tangential[i];
            options.move_limit * reach[i] / (options.time_step * velocity.length())
        });
        options.time_step * share.fold(1.0, f64::min).max(DEEPEST_CUT)
    }

    fn not_finite(&self, vertex: VertexId) -> Error {
        Error::NotFinite {
            step: self.steps + 1,
            vertex,
            position: self.mesh.position(vertex),
        }
    }
}

fn is_still(held: &[bool], pinned: &[bool], vertex: usize) -> bool {
    [held, pinned]
        .iter()
        .any(|mask| mask.get(vertex) == Some(&true))
}
