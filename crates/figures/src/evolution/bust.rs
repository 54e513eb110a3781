//! Figure 11: a bust, from 162 to 40,962 vertices.

use super::pictures::{Camera, box_of};
use super::runs::{Measured, Parameters, Scene, Surface};
use crate::sheet::Panel;
use crate::{Effort, Error, Figure, Made, Number, Paper, Run, Shape, Sheet, Verdict, shapes};
use pellicle::evolution::{
    Flow, Initial, Options, Outliers, Refinement, Schedule, Stage, StepOptions, Upkeep,
    ellipsoid_around, evolve_with,
};
use pellicle::mesh::{TriangleId, area, self_intersections, subdivide};
use pellicle::prelude::*;
use pellicle::render::{Drawing, Shading, Style, View, render, render_mesh};

/// Figure 11.
pub(super) const FIGURE: Figure = Figure {
    name: "evolution-11",
    paper: Paper::Evolution,
    number: "figure 11",
    title: "A bust, from coarse to fine",
    shows: "A coarse ellipsoid around a bust's points; the surface after 10, 45, 220 and 240 steps, each time refined, after 245 \
            steps, and smoothed: 40,962 vertices.",
    make,
};

/// Steps with each mesh, from coarse to fine.
const STEPS: [u32; 5] = [10, 35, 175, 20, 5];
/// Steps of mean curvature flow.
const SMOOTHING: u32 = 3;
/// Vertices of the last mesh.
const VERTICES: f64 = 40_962.0;

/// Pixels of the panels.
const SIZE: [f64; 2] = [372.0, 380.0];

const PARAMETERS: Parameters = Parameters {
    diffusion: 30.0,
    time_step: 0.01,
    ..Parameters::PLAIN
};

struct Course {
    bust: Shape,
    scene: Scene,
    /// Those of the points that pictures show.
    seen: Vec<DVec3>,
    resolution: u32,
    levels: usize,
    camera: Camera,
    sheet: Sheet,
    numbers: Vec<Number>,
}

fn make(run: &Run<'_>) -> Result<Made, Error> {
    let mut course = Course::new(run)?;
    let end = course.remeshed(run)?;
    // It takes as long as all the rest.
    let folded = match run.effort {
        Effort::Quick => String::new(),
        Effort::Full => course.as_printed(run)?,
    };
    let because = format!(
        "With the paper's steps and parameters on a bust of our own, and edges as long as after its subdivisions, the surface ends \
         {:.2} voxels from the truth on average ({:+.1} % of the volume), with angles of {:.0}° to {:.0}° and {} intersecting triangles. \
         It is remeshed between steps, and held where it would run into itself{folded}.",
        end.mean / course.scene.voxel(),
        100.0 * (end.volume - 1.0),
        end.least_angle,
        end.greatest_angle,
        end.crossings,
    );
    let well = end.crossings == 0 && end.mean < course.scene.voxel();
    Ok(Made {
        sheet: course.sheet,
        numbers: course.numbers,
        verdict: if well {
            Verdict::Better
        } else {
            Verdict::Different
        },
        because,
    })
}

impl Course {
    fn new(run: &Run<'_>) -> Result<Self, Error> {
        let bust = shapes::bust();
        let (count, resolution, levels) = run.effort.pick((6000, 80, 3), (60_000, 300, 5));
        let points = bust.sample(count, 1);
        let initial = ellipsoid_around(&points, 2.0, 2)?;
        let scene = Scene::new(points, initial, resolution)?;
        let camera = Camera {
            view: View::From(DVec3::new(0.5, 0.12, 1.0)),
            kept: 0.88,
            ..Camera::new(box_of([scene.initial.positions()]), SIZE)
        };
        let every = run.effort.pick(1, 8);
        let seen: Vec<DVec3> = scene.points.iter().copied().step_by(every).collect();
        let panel = camera.cloud(&seen, &[], Some(&scene.initial), 0.5)?;
        let words = "(a) The coarse initial surface, 162 vertices, and the cloud";
        Ok(Self {
            sheet: Sheet::new(4).with(panel.caption(words)),
            // The last one is of a smoothing of its own.
            numbers: PARAMETERS.numbers(scene.voxel())[..5].to_vec(),
            bust,
            scene,
            seen,
            resolution,
            levels,
            camera,
        })
    }

    /// The paper's stages in voxels, with remeshing to the edges that its subdivisions would have; then three steps of mean
    /// curvature flow, of which the paper does not say how strong they are.
    fn stages(&self) -> Vec<Stage> {
        let voxel = self.scene.voxel();
        let triangle = area((&self.bust.truth).into()) / (2.0 * VERTICES);
        let finest = (4.0 / 3.0_f64.sqrt() * triangle).sqrt() / voxel;
        let mut stages: Vec<Stage> = (0..self.levels)
            .map(|level| {
                let edge_length = finest * f64::from(1 << (4 - level));
                Stage {
                    flow: Flow::OntoPoints,
                    standoff: 0.0,
                    refinement: match level {
                        0 => Refinement::Keep,
                        _ => Refinement::Remesh { edge_length },
                    },
                    upkeep: match level {
                        0 => Upkeep::Keep,
                        _ => Upkeep::Remesh {
                            edge_length,
                            every: 5,
                        },
                    },
                    steps: STEPS[level],
                    tolerance: 0.0,
                    step: StepOptions {
                        advection: PARAMETERS.advection / voxel,
                        diffusion: PARAMETERS.diffusion / voxel,
                        move_limit: 0.4,
                        ..at_level(level)
                    },
                }
            })
            .collect();
        stages.push(Stage::smoothing(SMOOTHING, 0.25, Flow::MeanCurvature));
        stages
    }

    fn remeshed(&mut self, run: &Run<'_>) -> Result<Measured, Error> {
        let options = Options {
            resolution: self.resolution,
            sigma: Some(1.0),
            outliers: Outliers::Keep,
            initial: Initial::Mesh(self.scene.initial.clone()),
            schedule: Schedule::Stages {
                levels: 2,
                stages: self.stages(),
            },
            smoothing: 0,
        };
        // The surface at the end of each stage but the last.
        let ends: Vec<u64> = (1..=self.levels)
            .map(|stages| STEPS[..stages].iter().map(|&s| u64::from(s)).sum())
            .collect();
        let mut seen = Vec::new();
        let evolved = evolve_with(
            &self.scene.points,
            &options,
            run.progress,
            &mut |m, mesh| {
                if ends.contains(&m.step) {
                    seen.push(mesh.clone());
                }
            },
        )?;
        for ((mesh, steps), letter) in seen.iter().zip(ends).zip('b'..) {
            let words = format!("after {steps} steps");
            self.measure(mesh, &words)?;
            let panel = match letter {
                'b'..='d' => self.camera.surface(mesh, &self.seen, &[])?,
                _ => plain(&self.camera, mesh)?,
            };
            let vertices = mesh.positions().len();
            self.sheet.push(panel.caption(format!(
                "({letter}) After {steps} steps, {vertices} vertices"
            )));
        }
        let mesh = &evolved.mesh;
        let panel = plain(&self.camera, mesh)?;
        let vertices = mesh.positions().len();
        self.sheet.push(panel.caption(format!(
            "(g) After {SMOOTHING} steps of mean curvature flow, {vertices} vertices"
        )));
        self.measure(mesh, "smoothed")
    }

    fn measure(&mut self, mesh: &TriMesh, words: &str) -> Result<Measured, Error> {
        let measured = Measured::of(mesh, &self.bust)?;
        self.numbers
            .extend(measured.numbers(words, self.scene.voxel()));
        let name = format!("{words}: vertices");
        let vertices = Number::exactly(name, mesh.positions().len() as f64);
        self.numbers.push(match words {
            "smoothed" => vertices.paper("40962"),
            _ => vertices,
        });
        Ok(measured)
    }

    /// The first three stages with subdivisions alone, and what becomes of them.
    fn as_printed(&mut self, run: &Run<'_>) -> Result<String, Error> {
        let mut mesh = self.scene.initial.clone();
        for (level, steps) in STEPS.into_iter().take(3).enumerate() {
            run.step("evolve", level as u64, 3)?;
            if level > 0 {
                mesh = subdivide(&mesh)?;
            }
            let options = StepOptions {
                move_limit: 0.4,
                ..at_level(level)
            };
            mesh = Surface::new(mesh)?.steps(&self.scene.distance, &options, steps)?;
        }
        let measured = Measured::of(&mesh, &self.bust)?;
        let words = "subdivided alone, after 220 steps";
        self.numbers.extend([
            Number::within(
                format!("{words}: volume over the true one"),
                measured.volume,
                1e-2,
            ),
            // Where triangles have collapsed, rounding decides which ones.
            Number::uncompared(format!("{words}: least angle"), measured.least_angle).unit("°"),
            Number::uncompared(
                format!("{words}: intersecting pairs of triangles"),
                measured.crossings as f64,
            ),
        ]);
        let pairs = self_intersections((&mesh).into(), &())?;
        let marked: Vec<TriangleId> = pairs.iter().flat_map(|&(a, b)| [a, b]).collect();
        let drawing = Drawing {
            marked: &marked,
            ..Drawing::mesh(&mesh)
        };
        let image = render(&drawing, &self.camera.options(Style::SurfaceAndEdges))?;
        self.sheet.push(self.camera.panel(&image)?.caption(
            "With subdivisions alone, after 220 steps: triangles that intersect are marked",
        ));
        Ok(format!(
            ": subdivided alone, as in the paper, the mesh of {} vertices folds at the neck even with capped moves, with angles down to {:.2}° and {} pairs of \
             intersecting triangles",
            mesh.positions().len(),
            measured.least_angle,
            pairs.len()
        ))
    }
}

/// The paper's step: τ is four times smaller after each refinement.
fn at_level(level: usize) -> StepOptions {
    StepOptions {
        time_step: PARAMETERS.time_step / f64::from(1 << (2 * level)),
        ..PARAMETERS.onto_points()
    }
}

/// Without edges, which would be all that one sees.
fn plain(camera: &Camera, mesh: &TriMesh) -> Result<Panel, Error> {
    let mut options = camera.options(Style::Surface);
    options.shading = Shading::Smooth;
    camera.panel(&render_mesh(mesh.into(), &options)?)
}
