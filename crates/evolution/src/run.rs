//! The stages of an evolution, one after the other, and the care that the mesh takes meanwhile.

use crate::{
    DistanceGrid, Error, Evolution, Field, Flow, Measures, One, Redistribution, Refinement, Report,
    ShortOf, Stage, StepOptions, StepReport, Topology, Upkeep,
};
use pellicle_geometry::{Aabb, Cancelled, Progress, VertexId};
use pellicle_mesh::{
    Projection, RemeshOptions, TargetLength, TriMesh, components, remesh, self_intersections,
    signed_volume, subdivide,
};
use std::time::Instant;

/// Two sheets within this many edge lengths are about to meet: each goes at most 0.15 of one in a step, and contacts are
/// looked for every five.
const CONTACT: f64 = 1.5;

/// Less than this many voxels inside: the surface holds nothing.
const SMALLEST_VOLUME: f64 = 30.0;

/// What all stages share.
pub(crate) struct Run<'a, 'b> {
    grid: &'a DistanceGrid,
    topology: &'a mut Topology<'b>,
    progress: &'a dyn Progress,
    each_step: &'a mut dyn FnMut(&Measures, &TriMesh),
    started: Instant,
    pub(crate) report: Report,
}

/// The surface of a stage.
struct Moving {
    evolution: Evolution,
    /// As it was when last found without self-intersections, with the same connectivity.
    safe: TriMesh,
}

impl<'a, 'b> Run<'a, 'b> {
    pub(crate) fn new(
        grid: &'a DistanceGrid,
        topology: &'a mut Topology<'b>,
        progress: &'a dyn Progress,
        each_step: &'a mut dyn FnMut(&Measures, &TriMesh),
    ) -> Self {
        Self {
            grid,
            topology,
            progress,
            each_step,
            started: Instant::now(),
            report: Report {
                spacing: grid.spacing(),
                at_rest: true,
                ..Report::default()
            },
        }
    }

    /// One stage.
    pub(crate) fn stage(
        &mut self,
        mesh: TriMesh,
        stage: &Stage,
        number: usize,
    ) -> Result<TriMesh, Error> {
        let spacing = self.grid.spacing();
        let grid = self.grid;
        let short_of_points = ShortOf {
            field: grid,
            distance: stage.standoff * spacing,
        };
        let field: &dyn Field = match stage.flow {
            Flow::OntoPoints if stage.standoff > 0.0 => &short_of_points,
            Flow::OntoPoints => grid,
            Flow::MeanCurvature | Flow::VolumePreserving => &One,
        };
        let options = stage.step_options(spacing);

        // 1. Refine.
        let mesh = self.refined(mesh, stage.refinement)?;
        let volume = signed_volume((&mesh).into());
        let mut moving = Moving {
            evolution: Evolution::new(mesh.clone())?,
            safe: mesh,
        };
        if let Upkeep::Remesh { edge_length, .. } = stage.upkeep {
            self.hold_contacts(&mut moving, edge_length);
        }
        let mut rests = false;
        for step in 0..stage.steps {
            let observed = self
                .progress
                .step("evolve", step.into(), stage.steps.into());
            Cancelled::check(observed)?;

            // 2. Move.
            let report = self.step(&mut moving, field, &options, stage.upkeep)?;
            if stage.flow == Flow::VolumePreserving {
                moving.evolution.restore_volume(volume)?;
            }
            self.report.steps += 1;
            rests =
                report.largest_normal_move <= stage.tolerance * spacing && stage.tolerance > 0.0;

            // 3. Measure.
            let mesh = moving.evolution.mesh();
            let seconds = self.started.elapsed().as_secs_f64();
            let steps = self.report.steps;
            let measures = Measures::of(mesh, number, steps, &report, spacing, seconds);
            (self.each_step)(&measures, mesh);
            if measures.volume < SMALLEST_VOLUME * spacing.powi(3) {
                return Err(Error::Collapsed { step: steps });
            }

            // 4. Look after the mesh.
            if let Upkeep::Remesh { edge_length, every } = stage.upkeep
                && (rests || step + 1 == stage.steps || (step + 1) % every.max(1) == 0)
            {
                rests &= self.look_after(&mut moving, edge_length, &measures)?;
            }
            if rests {
                break;
            }
        }
        self.report.at_rest &= rests || stage.tolerance == 0.0;
        Ok(moving.evolution.into_mesh())
    }

    /// A step; where triangles have collapsed since the last look, from the surface as it was then, mended, and without
    /// moving along the surface.
    fn step(
        &mut self,
        moving: &mut Moving,
        field: &dyn Field,
        options: &StepOptions,
        upkeep: Upkeep,
    ) -> Result<StepReport, Error> {
        match (moving.evolution.step(field, options), upkeep) {
            (Err(Error::Linear(_)), Upkeep::Remesh { edge_length, .. }) => {
                let mut mended = self.remeshed(&moving.safe, edge_length, 3)?;
                if self.adapts() {
                    mended = self.repaired(mended)?;
                }
                self.take(moving, mended)?;
                self.hold_contacts(moving, edge_length);
                let plain = StepOptions {
                    redistribution: Redistribution::None,
                    ..options.clone()
                };
                moving.evolution.step(field, &plain)
            }
            (report, _) => report,
        }
    }

    /// The mesh for a stage. Remeshing that makes the surface intersect itself is not done.
    fn refined(&mut self, mesh: TriMesh, refinement: Refinement) -> Result<TriMesh, Error> {
        match refinement {
            Refinement::Keep => Ok(mesh),
            Refinement::Subdivide => Ok(subdivide(&mesh)?),
            Refinement::Remesh { edge_length } => {
                let remeshed = self.remeshed(&mesh, edge_length, 3)?;
                match intersecting(&remeshed)?.is_empty() {
                    true => Ok(remeshed),
                    false if self.adapts() => self.repaired(remeshed),
                    // Subdivision leaves the surface as it is; the look after the first steps mends the triangles.
                    false => Ok(subdivide(&mesh)?),
                }
            }
        }
    }

    /// Takes the surface back where it ran into itself; else remeshes it if its triangles want it. Whether it was found
    /// without self-intersections.
    fn look_after(
        &mut self,
        moving: &mut Moving,
        edge_length: f64,
        measures: &Measures,
    ) -> Result<bool, Error> {
        if self.adapts() {
            return self.adapt(moving, edge_length, measures);
        }
        let crossing = intersecting(moving.evolution.mesh())?;
        let sound = crossing.is_empty();
        if sound {
            moving.safe = moving.evolution.mesh().clone();
            if wants_upkeep(measures, edge_length * self.grid.spacing()) {
                let remeshed = self.remeshed(&moving.safe, edge_length, 1)?;
                if intersecting(&remeshed)?.is_empty() {
                    self.take(moving, remeshed)?;
                }
            }
        } else {
            moving.evolution.rewind(&moving.safe, &crossing)?;
        }
        self.hold_contacts(moving, edge_length);
        Ok(sound)
    }

    fn adapts(&self) -> bool {
        matches!(self.topology, Topology::Adaptive { .. })
    }

    /// Cuts away what crosses itself, and remeshes what that left; whether there was nothing.
    fn adapt(
        &mut self,
        moving: &mut Moving,
        edge_length: f64,
        measures: &Measures,
    ) -> Result<bool, Error> {
        let before = moving.evolution.mesh();
        let mut mesh = self.repaired(before.clone())?;
        let sound = mesh == *moving.evolution.mesh();
        if !sound || wants_upkeep(measures, edge_length * self.grid.spacing()) {
            let remeshed = self.remeshed(&mesh, edge_length, 1)?;
            mesh = self.repaired(remeshed)?;
            self.take(moving, mesh)?;
        }
        Ok(sound)
    }

    /// The outside of a surface that may cross itself, without droplets in which there can be no points.
    fn repaired(&mut self, mesh: TriMesh) -> Result<TriMesh, Error> {
        let Topology::Adaptive { repair, .. } = self.topology else {
            return Ok(mesh);
        };
        let step = self.report.steps;
        let mesh = repair(mesh).map_err(|reason| Error::Repair { step, reason })?;
        let least = SMALLEST_VOLUME * self.grid.spacing().powi(3);
        without_droplets(mesh, least)?.ok_or(Error::Collapsed { step })
    }

    /// Goes on with another mesh.
    fn take(&self, moving: &mut Moving, mesh: TriMesh) -> Result<(), Error> {
        moving.safe = mesh.clone();
        moving.evolution = Evolution::new(mesh)?;
        Ok(())
    }

    fn hold_contacts(&mut self, moving: &mut Moving, edge_length: f64) {
        if self.adapts() {
            return;
        }
        let reach = CONTACT * edge_length * self.grid.spacing();
        self.report.held = moving.evolution.hold_contacts(self.grid, reach);
    }

    /// Edges of about one length, in voxels, on the surface as it is.
    fn remeshed(
        &self,
        mesh: &TriMesh,
        edge_length: f64,
        iterations: u32,
    ) -> Result<TriMesh, Error> {
        let options = RemeshOptions {
            target: TargetLength::Absolute(edge_length * self.grid.spacing()),
            iterations,
            projection: Projection::Surface,
            ..RemeshOptions::default()
        };
        Ok(remesh(mesh, &options, self.progress)?.0)
    }
}

/// The vertices of triangles that intersect others, by ascending index.
fn intersecting(mesh: &TriMesh) -> Result<Vec<usize>, Error> {
    let pairs = self_intersections(mesh.into(), &())?;
    let triangles = pairs.iter().flat_map(|&(a, b)| [a, b]);
    let corners = triangles.flat_map(|t| mesh.triangles()[t.index()]);
    let mut vertices: Vec<usize> = corners.map(|v| v.index()).collect();
    vertices.sort_unstable();
    vertices.dedup();
    Ok(vertices)
}

/// The components of a closed mesh that hold at least some volume; `None` if none does.
fn without_droplets(mesh: TriMesh, least: f64) -> Result<Option<TriMesh>, Error> {
    let component_of = components((&mesh).into());
    let origin = Aabb::of_points(mesh.positions()).center();
    let mut volumes = vec![0.0; mesh.positions().len()];
    for t in mesh.triangle_ids() {
        let [a, b, c] = mesh.corners(t).map(|p| p - origin);
        volumes[component_of[t.index()].index()] += a.dot(b.cross(c)) / 6.0;
    }
    let is_kept = |component: &VertexId| volumes[component.index()] >= least;
    if component_of.iter().all(is_kept) {
        return Ok((!component_of.is_empty()).then_some(mesh));
    }
    let mut soup = mesh.into_soup();
    let mut of_triangles = component_of.iter();
    soup.triangles
        .retain(|_| of_triangles.next().is_some_and(is_kept));
    soup.compact();
    match soup.triangles.is_empty() {
        true => Ok(None),
        false => Ok(Some(TriMesh::try_from(soup)?)),
    }
}

/// Whether triangles have become bad, or too large or small for the edges wanted.
fn wants_upkeep(measures: &Measures, edge_length: f64) -> bool {
    const SMALL: f64 = 25.0;
    const LARGE: f64 = 130.0;
    const EQUILATERAL: f64 = 0.433;
    let wanted = EQUILATERAL * edge_length * edge_length;
    measures.least_angle < SMALL
        || measures.greatest_angle > LARGE
        || measures.greatest_area > 3.0 * wanted
        || measures.least_area < 0.2 * wanted
}
