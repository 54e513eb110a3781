//! A surface that evolves onto a cloud with the paper's parameters, in the paper's units.

use crate::sheet::{Axis, Color, Panel, Plot, Series};
use crate::{Error, Number, Shape};
use pellicle::evolution::{
    DistanceGrid, DistanceOptions, Evolution, Field, One, Redistribution, StepOptions,
};
use pellicle::geometry::Aabb;
use pellicle::glam::DVec2;
use pellicle::mesh::{
    self, AngleBounds, DistanceOptions as Sampling, compare, quality, signed_volume,
};
use pellicle::prelude::*;

/// The parameters of section 5, in its units: a body is 100 to 200 of them, a voxel a little less than one.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Parameters {
    /// w_a.
    pub(crate) advection: f64,
    /// w_d.
    pub(crate) diffusion: f64,
    /// τ.
    pub(crate) time_step: f64,
    /// ω.
    pub(crate) omega: f64,
    /// w_d of the mean curvature flow at the end.
    pub(crate) smoothing: f64,
    /// τ of the mean curvature flow at the end.
    pub(crate) smoothing_time_step: f64,
}

impl Parameters {
    /// Figures 6 and 7.
    pub(crate) const PLAIN: Self = Self {
        advection: 300.0,
        diffusion: 100.0,
        time_step: 0.001,
        omega: 100.0,
        smoothing: 450.0,
        smoothing_time_step: 0.0005,
    };
    /// Figure 8.
    pub(crate) const NOISY: Self = Self {
        smoothing: 500.0,
        ..Self::PLAIN
    };
    /// Figures 9 and 10.
    pub(crate) const OUTLYING: Self = Self {
        diffusion: 120.0,
        ..Self::PLAIN
    };

    /// A step onto the points.
    pub(crate) fn onto_points(&self) -> StepOptions {
        StepOptions {
            advection: self.advection,
            diffusion: self.diffusion,
            time_step: self.time_step,
            redistribution: Redistribution::AreaUniform { omega: self.omega },
            ..StepOptions::default()
        }
    }

    /// A step of mean curvature flow: w_a = 0 and d = 1.
    pub(crate) fn smoothing(&self) -> StepOptions {
        StepOptions {
            advection: 0.0,
            diffusion: self.smoothing,
            time_step: self.smoothing_time_step,
            ..self.onto_points()
        }
    }

    /// What the paper's numbers are in voxels, of which the options of `evolve` are made.
    pub(crate) fn numbers(&self, voxel: f64) -> Vec<Number> {
        let step = self.advection * self.time_step;
        let smoothed = self.smoothing * self.smoothing_time_step;
        vec![
            Number::within("side of a voxel", voxel, CLOSE).unit("units"),
            Number::exactly("w_a τ, advection in a step", step)
                .unit("units")
                .paper(format!("{} × {}", self.advection, self.time_step)),
            Number::within("w_a τ in voxels", step / voxel, CLOSE).unit("voxels"),
            Number::exactly("w_d / w_a", self.diffusion / self.advection)
                .paper(format!("{} / {}", self.diffusion, self.advection)),
            Number::exactly("ω τ", self.omega * self.time_step)
                .paper(format!("{} × {}", self.omega, self.time_step)),
            Number::within(
                "w_d τ of the smoothing in square voxels",
                smoothed / voxel / voxel,
                CLOSE,
            )
            .unit("voxels²")
            .paper(format!("{} × {}", self.smoothing, self.smoothing_time_step)),
        ]
    }
}

/// Rounding of another machine's exponential, grown by a hundred steps.
pub(crate) const CLOSE: f64 = 1e-5;

/// A cloud, the distance to it, and the surface around it that is to come down on it.
pub(crate) struct Scene {
    /// The points.
    pub(crate) points: Vec<DVec3>,
    /// d.
    pub(crate) distance: DistanceGrid,
    /// A surface around the points.
    pub(crate) initial: TriMesh,
}

impl Scene {
    /// A surface around a cloud, in a grid with `resolution` voxels along its longest side, and σ of one voxel.
    pub(crate) fn new(
        points: Vec<DVec3>,
        initial: TriMesh,
        resolution: u32,
    ) -> Result<Self, Error> {
        Self::regularised(points, initial, resolution, 1.0)
    }

    /// The same with another σ, in voxels.
    pub(crate) fn regularised(
        points: Vec<DVec3>,
        initial: TriMesh,
        resolution: u32,
        sigma: f64,
    ) -> Result<Self, Error> {
        let windings = mesh::winding_numbers((&initial).into(), &points);
        if windings.iter().any(|&winding| winding < 1) {
            let reason = "the initial surface does not hold all points";
            return Err(Error::NotShown(reason.into()));
        }
        let around = Aabb::of_points(initial.positions()).union(Aabb::of_points(&points));
        let room = DVec3::splat(0.02 * around.extent().max_element());
        let options = DistanceOptions {
            resolution,
            sigma,
            bounds: Some(Aabb {
                min: around.min - room,
                max: around.max + room,
            }),
            ..DistanceOptions::default()
        };
        Ok(Self {
            distance: DistanceGrid::new(&points, &options, &())?,
            points,
            initial,
        })
    }

    /// The side of a voxel.
    pub(crate) fn voxel(&self) -> f64 {
        self.distance.spacing()
    }
}

/// An ellipsoid along the axes, of 10·4ˡᵉᵛᵉˡˢ + 2 vertices.
pub(crate) fn ellipsoid(semi_axes: DVec3, levels: u32) -> Result<TriMesh, Error> {
    let mut mesh = mesh::icosphere(levels)?;
    let positions = mesh.positions().iter().map(|&p| semi_axes * p).collect();
    mesh.set_positions(positions)?;
    Ok(mesh)
}

/// A surface under way, and how it fared.
pub(crate) struct Surface {
    evolution: Evolution,
    /// A line a step.
    pub(crate) trace: Vec<Trace>,
}

/// A surface after a step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Trace {
    /// Volume.
    pub(crate) volume: f64,
    /// Standard deviation over mean of the co-volume areas.
    pub(crate) area_variation: f64,
    /// Of the triangles, in degrees.
    pub(crate) least_angle: f64,
}

impl Surface {
    pub(crate) fn new(mesh: TriMesh) -> Result<Self, Error> {
        let mut surface = Self {
            evolution: Evolution::new(mesh)?,
            trace: Vec::new(),
        };
        surface.note();
        Ok(surface)
    }

    /// The surface as it is.
    pub(crate) fn mesh(&self) -> &TriMesh {
        self.evolution.mesh()
    }

    /// Steps in a field; the surface then.
    pub(crate) fn steps(
        &mut self,
        field: &dyn Field,
        options: &StepOptions,
        steps: u32,
    ) -> Result<TriMesh, Error> {
        for _ in 0..steps {
            self.evolution.step(field, options)?;
            self.note();
        }
        Ok(self.mesh().clone())
    }

    /// Steps of mean curvature flow.
    pub(crate) fn smooth(&mut self, options: &StepOptions, steps: u32) -> Result<TriMesh, Error> {
        self.steps(&One, options, steps)
    }

    fn note(&mut self) {
        let view: MeshView<'_> = self.evolution.mesh().into();
        if let Some(quality) = quality(view, &AngleBounds::default()) {
            self.trace.push(Trace {
                volume: signed_volume(view),
                area_variation: quality.vertex_area_variation,
                least_angle: quality.min_angle.to_degrees(),
            });
        }
    }
}

/// How a surface compares with the truth, and its triangles.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Measured {
    /// Volume over the true one.
    pub(crate) volume: f64,
    /// Mean distance, the mean of both ways.
    pub(crate) mean: f64,
    /// Hausdorff distance.
    pub(crate) greatest: f64,
    /// Of the triangles, in degrees.
    pub(crate) least_angle: f64,
    /// Of the triangles, in degrees.
    pub(crate) greatest_angle: f64,
    /// Standard deviation over mean of the co-volume areas.
    pub(crate) area_variation: f64,
    /// Pairs of triangles that intersect.
    pub(crate) crossings: u64,
}

impl Measured {
    pub(crate) fn of(surface: &TriMesh, truth: &Shape) -> Result<Self, Error> {
        // The mean is good to a hundredth of the spread.
        let options = Sampling {
            samples: 10_000,
            ..Sampling::default()
        };
        let compared = compare(surface.into(), (&truth.truth).into(), &options, &())?;
        let quality = quality(surface.into(), &AngleBounds::default())
            .ok_or_else(|| Error::NotShown("the surface has no triangles".into()))?;
        Ok(Self {
            volume: signed_volume(surface.into()) / truth.volume,
            mean: 0.5 * (compared.forward.mean + compared.backward.mean),
            greatest: compared.hausdorff(),
            least_angle: quality.min_angle.to_degrees(),
            greatest_angle: quality.max_angle.to_degrees(),
            area_variation: quality.vertex_area_variation,
            crossings: mesh::count_self_intersections(surface.into(), &())? as u64,
        })
    }

    /// As numbers, lengths in voxels.
    pub(crate) fn numbers(&self, of: &str, voxel: f64) -> Vec<Number> {
        vec![
            Number::within(
                format!("{of}: volume over the true one"),
                self.volume,
                CLOSE,
            ),
            Number::within(
                format!("{of}: mean distance to the truth"),
                self.mean / voxel,
                1e-4,
            )
            .unit("voxels"),
            Number::within(
                format!("{of}: greatest distance to the truth"),
                self.greatest / voxel,
                1e-3,
            )
            .unit("voxels"),
            Number::within(format!("{of}: least angle"), self.least_angle, 1e-3).unit("°"),
            Number::within(format!("{of}: greatest angle"), self.greatest_angle, 1e-3).unit("°"),
            Number::within(
                format!("{of}: variation of the areas"),
                self.area_variation,
                1e-3,
            ),
            Number::exactly(
                format!("{of}: intersecting pairs of triangles"),
                self.crossings as f64,
            ),
        ]
    }
}

/// Volume over the true one, step by step, with marks where something changes.
pub(crate) fn volume_plot(trace: &[Trace], truth: f64, marks: &[usize], size: [f64; 2]) -> Panel {
    let point = |step: usize| {
        trace
            .get(step)
            .map(|t| DVec2::new(step as f64, t.volume / truth))
    };
    let points: Vec<DVec2> = (0..trace.len()).filter_map(point).collect();
    let marked: Vec<DVec2> = marks.iter().filter_map(|&step| point(step)).collect();
    let last = trace.len().saturating_sub(1) as f64;
    Plot::new(Axis::new("step"), Axis::new("volume / true volume"))
        .with(Series::line("", points).color(Color::BLUE))
        .with(Series::dots("the pictures", marked).color(Color::VERMILION))
        .with(
            Series::line("the truth", [0.0, last].map(|x| DVec2::new(x, 1.0)))
                .look(crate::sheet::Look::Dashed)
                .color(Color::GREEN),
        )
        .panel(size[0], size[1])
}
