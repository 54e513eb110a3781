//! Figures 1 and 4: simple clouds, and the initial surface.

use super::pictures::{Camera, box_of};
use super::runs::CLOSE;
use crate::sheet::{Axis, Plot, Series};
use crate::{Error, Figure, Made, Number, Paper, Run, Sheet, Verdict, shapes};
use pellicle::evolution::Covolumes;
use pellicle::glam::DVec2;
use pellicle::mesh::{AngleBounds, area, icosphere, mean_curvatures, quality};
use pellicle::prelude::*;
use pellicle::render::{Style, View, render_mesh};
use std::f64::consts::PI;

/// Figures 1 and 4.
pub(super) const FIGURES: [Figure; 2] = [
    Figure {
        name: "evolution-1",
        paper: Paper::Evolution,
        number: "figure 1",
        title: "Clouds of simple objects",
        shows: "Point clouds of simple closed objects: points and nothing else.",
        make: make_clouds,
    },
    Figure {
        name: "evolution-4",
        paper: Paper::Evolution,
        number: "figure 4",
        title: "The unit sphere by subdivision of the icosahedron",
        shows: "Triangulations of the unit sphere with 12, 42, 162, 642 and 2562 points.",
        make: make_spheres,
    },
];

fn make_clouds(run: &Run<'_>) -> Result<Made, Error> {
    let mut sheet = Sheet::new(4);
    let mut numbers = Vec::new();
    for shape in [
        shapes::vase(),
        shapes::body(),
        shapes::bumpy_sphere(),
        shapes::bust(),
    ] {
        run.step("sample", sheet_len(&numbers), 4)?;
        let points = shape.sample_evenly(run.effort.pick(1000, 2500), 1);
        let camera = Camera::new(box_of([shape.truth.positions()]), [372.0, 350.0]);
        let radius = 0.0045 * shape.diagonal();
        sheet.push(camera.cloud(&points, &[], None, radius)?.caption(format!(
            "{}: {} points",
            shape.name,
            points.len()
        )));
        let spacing = (area((&shape.truth).into()) / points.len() as f64).sqrt();
        numbers.push(Number::exactly(
            format!("{}: points", shape.name),
            points.len() as f64,
        ));
        numbers.push(Number::within(
            format!("{}: spacing over the diagonal", shape.name),
            spacing / shape.diagonal(),
            CLOSE,
        ));
    }
    Ok(Made {
        sheet,
        numbers,
        verdict: Verdict::Agrees,
        because: "Clouds of closed bodies of our own with known surfaces and volumes, in place of the paper's, which are not to be had."
            .into(),
    })
}

fn sheet_len(numbers: &[Number]) -> u64 {
    numbers.len() as u64 / 2
}

fn make_spheres(_: &Run<'_>) -> Result<Made, Error> {
    let mut sheet = Sheet::new(6);
    let mut numbers = Vec::new();
    let mut series = [const { Vec::new() }; 4];
    for levels in 0..5_u32 {
        let sphere = icosphere(levels)?;
        let count = sphere.positions().len();
        let camera = Camera {
            view: View::ThreeQuarter,
            ..Camera::new(box_of([sphere.positions()]), [250.0, 250.0])
        };
        let mut options = camera.options(Style::SurfaceAndEdges);
        options.edge_width = 1.2;
        let image = render_mesh((&sphere).into(), &options)?;
        sheet.push(camera.panel(&image)?.caption(format!(
            "{count} points, {} triangles",
            sphere.triangles().len()
        )));

        let quality = quality((&sphere).into(), &AngleBounds::default())
            .ok_or_else(|| Error::NotShown("a sphere without triangles".into()))?;
        let share = 1.0 - area((&sphere).into()) / (4.0 * PI);
        let curvatures = Covolumes::of(&sphere)?.curvatures;
        // 1/R for −2/R.
        let mixed: Vec<f64> = mean_curvatures((&sphere).into())
            .iter()
            .map(|h| -2.0 * h)
            .collect();
        let greatest = |curvatures: &[f64], five: bool| {
            let of_valence = |&i: &usize| (sphere.neighbors(VertexId::new(i)).count() == 5) == five;
            let error = |i: usize| (curvatures[i] / -2.0 - 1.0).abs();
            let errors = (0..count).filter(of_valence).map(error);
            DVec2::new(quality.mean_edge, errors.fold(0.0, f64::max))
        };
        // On the icosahedron itself H is right.
        if levels > 0 {
            series[1].push(greatest(&curvatures, false));
            series[2].push(greatest(&curvatures, true));
        }
        // Nor does it err, by mixed areas, on its first subdivision.
        if levels > 1 {
            let [six, five] = [false, true].map(|five| greatest(&mixed, five));
            series[3].push(six.max(five));
        }
        series[0].push(DVec2::new(quality.mean_edge, share));
        numbers.extend([
            Number::exactly(format!("level {levels}: points"), count as f64)
                .paper(format!("{count}")),
            Number::within(
                format!("level {levels}: area lacking to 4π"),
                100.0 * share,
                1e-9,
            )
            .unit("%"),
            Number::within(
                format!("level {levels}: least angle"),
                quality.min_angle.to_degrees(),
                1e-9,
            )
            .unit("°"),
            Number::within(
                format!("level {levels}: H of a vertex of five triangles"),
                curvatures[0],
                1e-6,
            ),
        ]);
    }
    for (name, errors) in [
        ("area", &series[0]),
        ("H, six triangles", &series[1]),
        ("H, five triangles", &series[2]),
        ("H by mixed areas", &series[3]),
    ] {
        let last = errors.last().map_or(0.0, |error| error.y);
        let name = format!("2562 points: greatest relative error of {name}");
        numbers.push(Number::within(name, last, 1e-4));
    }
    let order = order(&series[0]);
    numbers.push(Number::within("order of the area", order, 1e-6));
    let axes = ["mean edge", "relative error"].map(|label| Axis::new(label).logarithmic());
    let [across, up] = axes;
    let names = [
        "area",
        "H, six triangles, worst vertex",
        "H, five triangles",
        "H by mixed areas, worst vertex",
    ];
    let plot = names
        .into_iter()
        .zip(series)
        .fold(Plot::new(across, up), |plot, (name, points)| {
            plot.with(Series::line(name, points).marked())
        });
    sheet.push(
        plot.panel(300.0, 250.0)
            .caption("What the sphere loses, and the mean curvature on it"),
    );
    Ok(Made {
        sheet,
        numbers,
        verdict: Verdict::Agrees,
        because: format!(
            "The same counts of points. The area converges with order {order:.2}. At the twelve vertices of five triangles the mean \
             curvature by barycentric co-volumes, (4.15), does not converge: −2.29 for −2, which the paper does not mention; by the mixed areas of Meyer et al. 2003 (mesh::mean_curvatures) it does."
        ),
    })
}

/// The order of the last halving of a series of lengths and errors.
pub(super) fn order(errors: &[DVec2]) -> f64 {
    let [.., before, last] = errors else {
        return 0.0;
    };
    libm::log(before.y / last.y) / libm::log(before.x / last.x)
}
