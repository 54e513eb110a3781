//! Figure 2: distance functions of a curve's points and of a vase's.

use super::pictures::{Camera, OUTLIER, box_of, dots};
use super::plane::{Raster, lines, slice};
use super::runs::CLOSE;
use crate::field::Field as Solid;
use crate::polygonize::polygonize;
use crate::sheet::{Axis, Color, ColorScale, Panel, Plot, Sampling, Series, Style};
use crate::{Error, Figure, Made, Number, Paper, Run, Shape, Sheet, Verdict, shapes};
use pellicle::evolution::{DistanceGrid, DistanceOptions};
use pellicle::geometry::Aabb;
use pellicle::glam::DVec2;
use pellicle::mesh::TriangleId;
use pellicle::prelude::*;
use pellicle::render::{
    Bar, Borders, Coloring, Drawing, Options, Shading, Stroke, Style as Drawn, Values, View,
    Visibility, render,
};
use std::f64::consts::TAU;

/// Figure 2.
pub(super) const FIGURE: Figure = Figure {
    name: "evolution-2",
    paper: Paper::Evolution,
    number: "figure 2",
    title: "Distance functions of clouds",
    shows: "Graph and contours of the distance to the points of a heart curve; a slice of the graph, and two contours, of the \
            distance to the points of a vase.",
    make,
};

/// Pixels of the panels.
const SIZE: [f64; 2] = [372.0, 340.0];

fn make(run: &Run<'_>) -> Result<Made, Error> {
    let mut sheet = Sheet::new(4);
    let mut numbers = Vec::new();
    heart(run, &mut sheet, &mut numbers)?;
    let vase = Vase::new(run)?;
    numbers.extend(vase.numbers());
    for panel in [
        vase.graph()?,
        vase.contours(run.effort.pick(30, 70))?,
        vase.slice_with_contours()?,
        vase.directions()?,
        vase.lengths()?,
        vase.profile(),
    ] {
        sheet.push(panel);
    }
    let hold = vase.hold();
    Ok(Made {
        sheet,
        numbers,
        verdict: Verdict::Agrees,
        because: format!(
            "The same two functions. Fast sweeping of closest points gives exact distances near the points, where the paper solves \
             (3.1) to first order. With σ = 1 voxel the regularised distance of the vase is {hold:.2} voxels at its points: it does \
             not vanish there, nor does the diffusion."
        ),
    })
}

/// The curve x = 16 sin³t, y = 13 cos t − 5 cos 2t − 2 cos 3t − cos 4t.
fn heart_curve(count: usize) -> Vec<DVec3> {
    let at = |i: usize| {
        let t = TAU * i as f64 / count as f64;
        let cos = |k: f64| libm::cos(k * t);
        let sin = libm::sin(t);
        let y = 13.0 * cos(1.0) - 5.0 * cos(2.0) - 2.0 * cos(3.0) - cos(4.0);
        DVec3::new(16.0 * sin * sin * sin, y, 0.0)
    };
    (0..count).map(at).collect()
}

fn heart(run: &Run<'_>, sheet: &mut Sheet, numbers: &mut Vec<Number>) -> Result<(), Error> {
    let points = heart_curve(90);
    let (low, high) = (DVec2::new(-23.0, -23.0), DVec2::new(23.0, 19.0));
    let resolution = run.effort.pick(80, 200);
    let thin = 4.0 * (high.x - low.x) / f64::from(resolution);
    let options = DistanceOptions {
        resolution,
        bounds: Some(Aabb {
            min: low.extend(-thin),
            max: high.extend(thin),
        }),
        sigma: 0.0,
        ..DistanceOptions::default()
    };
    let grid = DistanceGrid::new(&points, &options, run.progress)?;
    let d = |p: DVec2| grid.sample(p.extend(0.0)).value;

    // The error at voxel centres, where nothing is interpolated.
    let dims = grid.dims();
    let layer = dims.z / 2;
    let mut greatest = 0.0_f64;
    let mut too_small = 0;
    for y in 0..dims.y {
        for x in 0..dims.x {
            let at = grid.center(pellicle::glam::UVec3::new(x, y, layer));
            let exact = points
                .iter()
                .map(|p| p.distance(at))
                .fold(f64::INFINITY, f64::min);
            let error = grid.sample(at).value - exact;
            greatest = greatest.max(error.abs());
            too_small += u32::from(error < -1e-5 * exact);
        }
    }
    numbers.extend([
        Number::exactly("heart: points", points.len() as f64),
        Number::within(
            "heart: greatest error of d",
            greatest / grid.spacing(),
            1e-2,
        )
        .unit("voxels"),
        Number::exactly(
            "heart: values of d that are too small",
            f64::from(too_small),
        ),
    ]);

    let raster = Raster::of(low, high, 140, d);
    let scale = ColorScale::sequential(0.0, 18.0);
    sheet.push(
        graph(&raster, &points, 0.8)?
            .caption("(a) Graph of the distance to 90 points of a heart curve"),
    );
    let mut panel = Panel::plane(SIZE[0], SIZE[1], low, high);
    panel.picture(low, raster.end(), &raster.image(&scale), Sampling::Smooth)?;
    contours(
        &mut panel,
        &raster,
        &[1.0, 2.0, 4.0, 6.0, 8.0, 10.0, 12.0, 14.0, 16.0],
        Color::WHITE,
        0.8,
    );
    for p in &points {
        panel.dot(p.truncate(), 1.8, Style::fill(Color::VERMILION));
    }
    panel.color_bar(DVec2::new(SIZE[0] - 46.0, 60.0), 200.0, &scale, "d");
    sheet.push(panel.caption("(b) Its contours, and the points"));
    Ok(())
}

/// d less a level, as a solid.
struct Level<'a> {
    grid: &'a DistanceGrid,
    level: f64,
}

impl Solid for Level<'_> {
    fn bounds(&self) -> Aabb {
        self.grid.bounds()
    }

    fn at(&self, p: DVec3) -> (f64, DVec3) {
        let sample = self.grid.sample(p);
        (sample.value - self.level, sample.gradient)
    }
}

/// The two contours.
const LEVELS: [f64; 2] = [6.0, 20.0];

/// A vase's points and their distance.
struct Vase {
    shape: Shape,
    points: Vec<DVec3>,
    /// σ = 1 voxel.
    grid: DistanceGrid,
    /// σ = 0.
    plain: DistanceGrid,
    /// d in the plane z = 0.
    raster: Raster,
}

impl Vase {
    fn new(run: &Run<'_>) -> Result<Self, Error> {
        let shape = shapes::vase();
        let points = shape.sample_evenly(run.effort.pick(2000, 6000), 1);
        let grid = |sigma| {
            let options = DistanceOptions {
                resolution: run.effort.pick(60, 200),
                sigma,
                ..DistanceOptions::default()
            };
            DistanceGrid::new(&points, &options, run.progress)
        };
        let (grid, plain) = (grid(1.0)?, grid(0.0)?);
        let Aabb { min, max } = grid.bounds();
        let raster = Raster::of(min.truncate(), max.truncate(), 140, |p| {
            grid.sample(p.extend(0.0)).value
        });
        Ok(Self {
            shape,
            points,
            grid,
            plain,
            raster,
        })
    }

    /// The mean of d at the points, in voxels.
    fn hold(&self) -> f64 {
        let values = self.points.iter().map(|&p| self.grid.sample(p).value);
        values.sum::<f64>() / self.points.len() as f64 / self.grid.spacing()
    }

    fn numbers(&self) -> Vec<Number> {
        // Away from the cloud and from where two points are equally near, ‖∇d‖ = 1.
        let raster = &self.raster;
        let far = |&i: &usize| raster.values[i] > 4.0 * self.grid.spacing();
        let length = |i| {
            self.grid
                .sample(raster.node(i).extend(0.0))
                .gradient
                .length()
        };
        let mut lengths: Vec<f64> = (0..raster.values.len()).filter(far).map(length).collect();
        lengths.sort_unstable_by(f64::total_cmp);
        vec![
            Number::exactly("vase: points", self.points.len() as f64),
            Number::within(
                "vase: mean of d at the points, σ = 1 voxel",
                self.hold(),
                CLOSE,
            )
            .unit("voxels"),
            Number::within(
                "vase: median of ‖∇d‖ farther than 4 voxels from the points",
                lengths[lengths.len() / 2],
                CLOSE,
            )
            .paper("1"),
        ]
    }

    fn graph(&self) -> Result<Panel, Error> {
        let near = self.points.iter().copied().filter(|p| p.z.abs() < 2.0);
        let near: Vec<DVec3> = near.collect();
        Ok(graph(&self.raster, &near, 0.8)?
            .caption("(c) Slice of the graph of the distance to points of a vase"))
    }

    /// Two contours, the front half of the outer one taken away.
    fn contours(&self, cells: usize) -> Result<Panel, Error> {
        let grid = &self.grid;
        let [inner, outer] = LEVELS.map(|level| polygonize(&Level { grid, level }, cells));
        let mut soup = inner.into_soup();
        let mut colors = vec![[222, 196, 120]; soup.triangles.len()];
        let offset = soup.positions.len();
        let behind = |t: &TriangleId| outer.corners(*t).iter().all(|p| p.z < 0.0);
        for t in outer.triangle_ids().filter(behind) {
            let moved = |v: VertexId| VertexId::new(v.index() + offset);
            soup.triangles.push(outer.triangles()[t.index()].map(moved));
            colors.push([120, 170, 206]);
        }
        soup.positions.extend(outer.positions());
        let camera = Camera {
            kept: 1.0,
            ..Camera::new(box_of([outer.positions()]), SIZE)
        };
        let drawing = Drawing {
            coloring: Coloring::Each(&colors),
            ..Drawing::mesh(&soup)
        };
        let options = Options {
            borders: Borders::Plain,
            shading: Shading::Smooth,
            ..camera.options(Drawn::Surface)
        };
        let panel = camera.panel(&render(&drawing, &options)?)?;
        let [inner, outer] = LEVELS;
        Ok(panel.caption(format!(
            "(d) Contours d = {inner} and, cut open, d = {outer}"
        )))
    }

    /// The slice as a picture.
    fn slice(&self) -> Result<(Panel, ColorScale), Error> {
        let raster = &self.raster;
        let top = raster.values.iter().copied().fold(0.0, f64::max);
        let scale = ColorScale::sequential(0.0, top);
        let mut panel = Panel::plane(SIZE[0], SIZE[1], raster.origin, raster.end());
        let image = raster.image(&scale);
        panel.picture(raster.origin, raster.end(), &image, Sampling::Smooth)?;
        Ok((panel, scale))
    }

    fn slice_with_contours(&self) -> Result<Panel, Error> {
        let (mut panel, scale) = self.slice()?;
        contours(&mut panel, &self.raster, &LEVELS, Color::WHITE, 1.2);
        for line in lines(&slice((&self.shape.truth).into(), 0.0)) {
            panel.polyline(&line, Style::stroke(Color::VERMILION, 1.6));
        }
        panel.color_bar(DVec2::new(SIZE[0] - 52.0, 60.0), 200.0, &scale, "d");
        Ok(
            panel
                .caption("(e) The slice from above, with both contours (white) and the vase (red)"),
        )
    }

    fn directions(&self) -> Result<Panel, Error> {
        let (mut panel, _) = self.slice()?;
        let (low, high) = (self.raster.origin, self.raster.end());
        let step = (high - low).max_element() / 22.0;
        let count = ((high - low) / step).floor();
        for i in 0..(count.x * count.y) as u32 {
            let node = DVec2::new(f64::from(i) % count.x, (f64::from(i) / count.x).floor());
            let at = low + step * (node + 0.5);
            let down = -self.grid.sample(at.extend(0.0)).gradient.truncate();
            let half = 0.42 * step * down;
            if down.length() > 0.3 {
                panel.arrow(at - half, at + half, 0.0, Style::stroke(Color::WHITE, 1.0));
            }
        }
        Ok(panel.caption("(f) −∇d, the direction of the advection"))
    }

    fn lengths(&self) -> Result<Panel, Error> {
        let (low, high) = (self.raster.origin, self.raster.end());
        let length = |p: DVec2| self.grid.sample(p.extend(0.0)).gradient.length();
        let raster = Raster::of(low, high, self.raster.columns, length);
        let scale = ColorScale::sequential(0.0, 1.0);
        let mut panel = Panel::plane(SIZE[0], SIZE[1], low, high);
        panel.picture(low, raster.end(), &raster.image(&scale), Sampling::Smooth)?;
        panel.color_bar(DVec2::new(SIZE[0] - 52.0, 60.0), 200.0, &scale, "");
        Ok(panel.caption("(g) ‖∇d‖ is 1 but at the points and where two are equally near"))
    }

    /// d along a line through a point, before and after regularisation.
    fn profile(&self) -> Panel {
        let voxel = self.grid.spacing();
        let through = self.points[0];
        let along = |grid: &DistanceGrid| -> Vec<DVec2> {
            let at = |i: i32| {
                let voxels = 0.1 * f64::from(i);
                let d = grid.sample(through + voxels * voxel * DVec3::X).value;
                DVec2::new(voxels, d / voxel)
            };
            (-60..=60).map(at).collect()
        };
        let axes = ["voxels from a point, along x", "d, voxels"].map(Axis::new);
        let [across, up] = axes;
        Plot::new(across, up)
            .with(Series::line("d₀, σ = 0", along(&self.plain)))
            .with(Series::line("d = G ∗ d₀, σ = 1 voxel", along(&self.grid)))
            .panel(SIZE[0], SIZE[1])
            .caption("(h) The distance across a point before and after regularisation")
    }
}

/// A graph as a landscape, with its points and some contours on it.
fn graph(raster: &Raster, points: &[DVec3], height: f64) -> Result<Panel, Error> {
    let soup = raster.graph(height);
    let top = raster.values.iter().copied().fold(0.0, f64::max);
    let mut strokes = Vec::new();
    for step in 1..10 {
        let level = top * f64::from(step) / 10.0;
        for ends in raster.contour(level) {
            strokes.push(Stroke {
                ends: ends.map(|p| p.extend(height * level)),
                color: [30, 30, 30],
                width: 0.8,
                visibility: Visibility::Hidden,
            });
        }
    }
    let flat: Vec<DVec3> = points.iter().map(|p| p.truncate().extend(0.0)).collect();
    let marks = dots(&flat, OUTLIER, 2.0);
    let drawing = Drawing {
        coloring: Coloring::Values(Values {
            bar: Bar::Absent,
            ..Values::new(&raster.values)
        }),
        strokes: &strokes,
        dots: &marks,
        ..Drawing::mesh(&soup)
    };
    let camera = Camera {
        view: View::From(DVec3::new(-0.25, -0.75, 1.1)),
        bounds: None,
        size: SIZE,
        kept: 0.9,
    };
    let mut options = camera.options(Drawn::Surface);
    options.up = pellicle::render::Up::Z;
    options.borders = Borders::Plain;
    options.shading = Shading::Smooth;
    camera.panel(&render(&drawing, &options)?)
}

fn contours(panel: &mut Panel, raster: &Raster, levels: &[f64], color: Color, width: f64) {
    for &level in levels {
        for line in lines(&raster.contour(level)) {
            panel.polyline(&line, Style::stroke(color, width));
        }
    }
}
