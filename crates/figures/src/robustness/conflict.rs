//! The region in conflict with a new point: star-shaped by exact signs, anything by rounded ones.

use super::doubles;
use super::planar::{Cavity, Defect, Planar, far_corners, is_inside, is_seen};
use crate::sheet::{Axis, Color, Panel, Plot, Series, Style, Text};
use crate::{Error, Figure, Made, Number, Paper, Random, Run, Sheet, Verdict};
use pellicle::glam::DVec2;

pub(super) const FIGURE: Figure = Figure {
    name: "robustness-conflict",
    paper: Paper::Robustness,
    number: "insertion in a Delaunay triangulation",
    title: "A conflict region that is not star-shaped",
    shows: "inserts a point into a Delaunay triangulation: with exact signs the region in conflict is star-shaped; with inexact ones \
            it need not be, and what fills it may be no triangulation, or one that crosses itself.",
    make,
};

/// Points of a triangulation, without the far corners and the new one.
const POINTS: usize = 40;

/// The in-disk test of three corners and a point, in doubles.
type Formula = fn([DVec2; 3], DVec2) -> f64;

/// Random multiples of 2⁻²⁰ in the unit square, which stay exact when they are moved, and a last one: the new point.
fn points(seed: u64, offset: f64) -> Vec<DVec2> {
    let mut random = Random::new(seed, 0);
    let steps = f64::from(1 << 20);
    let mut points = far_corners(DVec2::splat(0.5), 0.5).to_vec();
    points.extend(
        (0..=POINTS).map(|_| (DVec2::new(random.unit(), random.unit()) * steps).floor() / steps),
    );
    points.iter().map(|&p| p + DVec2::splat(offset)).collect()
}

/// The region of the last point, by exact and by rounded signs.
fn cavities(points: &[DVec2], formula: Formula) -> (Planar, Cavity, Cavity) {
    let new = points.len() - 1;
    let planar = Planar::delaunay(&points[..new]);
    let exact = planar.cavity(points, new, |t| is_inside(points, t, new));
    let rounded = planar.cavity(points, new, |t| {
        formula(t.map(|i| points[i]), points[new]) > 0.0
    });
    (planar, exact, rounded)
}

/// Of many insertions at one offset, how many have which defect.
#[derive(Default)]
struct Rates {
    not_star_shaped: u32,
    not_a_disc: u32,
    other_region: u32,
    exact_defects: u32,
}

fn rates(offset: f64, formula: Formula, trials: u64) -> Rates {
    let mut rates = Rates::default();
    for seed in 0..trials {
        let (_, exact, rounded) = cavities(&points(seed, offset), formula);
        let sorted = |cavity: &Cavity| {
            let mut region = cavity.region.clone();
            region.sort_unstable();
            region
        };
        rates.exact_defects += u32::from(exact.defect.is_some());
        rates.other_region += u32::from(sorted(&exact) != sorted(&rounded));
        rates.not_star_shaped += u32::from(rounded.defect == Some(Defect::NotStarShaped));
        rates.not_a_disc += u32::from(rounded.defect == Some(Defect::NotADisc));
    }
    rates
}

/// Where the pictures are taken: nearer than map coordinates in metres are.
const OFFSET: f64 = 30_000.0;

/// The seed whose region has this defect and shows it best: the triangles that are turned over, or those in the hole, are largest.
fn search(run: &Run<'_>, defect: Defect) -> Result<u64, Error> {
    const SEEDS: u64 = 1_500;
    let mut best = (0.0, None);
    for seed in 0..SEEDS {
        run.step("search for regions", seed, SEEDS)?;
        let points = points(seed, OFFSET);
        let (_, exact, rounded) = cavities(&points, doubles::in_disk_of_rows);
        let inside = |cavity: &Cavity| cavity.region.iter().flatten().all(|&corner| corner > 2);
        let small = rounded.region.len() <= 14 && inside(&rounded) && inside(&exact);
        let area = turned_over(&points, &rounded).1;
        if rounded.defect == Some(defect) && small && area > best.0 {
            best = (area, Some(seed));
        }
    }
    best.1
        .ok_or_else(|| Error::NotShown(format!("no conflict region is {defect:?}")))
}

fn make(run: &Run<'_>) -> Result<Made, Error> {
    let trials = run.effort.pick(60, 1_000);
    let mut numbers = Vec::new();
    let (plot, exact_defects) = by_distance(run, trials, &mut numbers)?;
    let mut sheet = Sheet::new(3);
    let mut turned = 0;
    for (defect, words) in [
        (
            Defect::NotStarShaped,
            "the red part of the border is not seen from the point",
        ),
        (
            Defect::NotADisc,
            "the region has a hole: its border is two lines",
        ),
    ] {
        let seed = search(run, defect)?;
        let points = points(seed, OFFSET);
        let (planar, exact, rounded) = cavities(&points, doubles::in_disk_of_rows);
        sheet.push(
            region(&points, &planar, &exact, &rounded)
                .caption("exact signs: the region in conflict is star-shaped"),
        );
        sheet.push(
            region(&points, &planar, &rounded, &rounded)
                .caption(format!("the printed determinant, in doubles: {words}")),
        );
        numbers.push(Number::exactly(
            format!("seed of the region, {defect:?}"),
            seed as f64,
        ));
        if defect == Defect::NotStarShaped {
            turned = turned_over(&points, &rounded).0;
            sheet.push(filled(&points, &planar, &rounded).caption("filled all the same: combinatorially a triangulation, but the red triangles are turned over"));
        }
    }
    numbers.push(Number::exactly(
        "triangles turned over in the picture",
        turned as f64,
    ));
    sheet.push(plot);
    Ok(Made {
        sheet,
        numbers,
        verdict: if exact_defects == 0 {
            Verdict::Better
        } else {
            Verdict::Different
        },
        because: format!(
            "A cloud one unit wide, {OFFSET} units from the origin, is enough for the printed determinant, in doubles, to make regions that are not \
             star-shaped; filled all the same, {turned} triangles of the pictured one are turned over. Others have a hole, and filling \
             them gives no triangulation at all. With exact signs no region at any distance has a defect. If the query is moved into \
             the origin before the determinant is taken, the differences of these points are exact, and there is no defect either.",
        ),
    })
}

/// Shares of regions with a defect, by the distance from the origin; and how many exact ones have one.
fn by_distance(
    run: &Run<'_>,
    trials: u64,
    numbers: &mut Vec<Number>,
) -> Result<(Panel, u32), Error> {
    let (mut exact_defects, mut translated) = (0, 0);
    let mut plot = Plot::new(
        Axis::new("distance from the origin, in widths of the cloud").logarithmic(),
        Axis::new("insertions, %").range(0.0, 100.0),
    );
    for (formula, name) in [
        (doubles::in_disk_of_rows as Formula, "printed determinant"),
        (doubles::in_disk, "query in the origin"),
    ] {
        let mut defects = Vec::new();
        let mut others = Vec::new();
        for power in 2..=6 {
            run.step("insertions", power - 2, 5)?;
            let offset = 10_f64.powi(power as i32);
            let rates = rates(offset, formula, trials);
            let share = |count: u32| 100.0 * f64::from(count) / trials as f64;
            if name == "printed determinant" {
                for (what, count) in [
                    ("other regions", rates.other_region),
                    ("not star-shaped", rates.not_star_shaped),
                    ("with a hole", rates.not_a_disc),
                ] {
                    let name = format!("{what}, 10^{power} from the origin");
                    numbers.push(Number::exactly(name, share(count)).unit("%"));
                }
            } else {
                translated += rates.other_region;
            }
            exact_defects += rates.exact_defects;
            defects.push(DVec2::new(
                offset,
                share(rates.not_star_shaped + rates.not_a_disc),
            ));
            others.push(DVec2::new(offset, share(rates.other_region)));
        }
        plot = plot
            .with(Series::line(format!("{name}: not the right region"), others).marked())
            .with(Series::line(format!("{name}: with a defect"), defects).marked());
    }
    numbers.push(Number::exactly(
        "other regions at any distance, query in the origin",
        f64::from(translated),
    ));
    numbers.push(Number::exactly(
        "regions with a defect, exact signs",
        f64::from(exact_defects),
    ));
    Ok((
        plot.panel(WIDTH, HEIGHT)
            .caption(format!("{trials} insertions each")),
        exact_defects,
    ))
}

const WIDTH: f64 = 320.0;
const HEIGHT: f64 = 320.0;

/// How many of the triangles that fill a cavity turn clockwise, and twice their area. (The differences are exact.)
fn turned_over(points: &[DVec2], cavity: &Cavity) -> (usize, f64) {
    let new = points[points.len() - 1];
    let areas = cavity
        .boundary
        .iter()
        .map(|&[a, b]| (points[a] - new).perp_dot(points[b] - new));
    let turned = areas.filter(|&area| area < 0.0);
    turned.fold((0, 0.0), |(count, sum), area| (count + 1, sum - area))
}

/// A panel with the box around the region and a little more.
fn window(points: &[DVec2], cavity: &Cavity) -> Panel {
    let corners = cavity.region.iter().flatten().map(|&i| points[i]);
    let [min, max] = corners.fold([DVec2::INFINITY, DVec2::NEG_INFINITY], |[min, max], p| {
        [min.min(p), max.max(p)]
    });
    let room = DVec2::splat(0.15 * (max - min).max_element());
    Panel::plane(WIDTH, HEIGHT, min - room, max + room)
}

fn region(points: &[DVec2], planar: &Planar, cavity: &Cavity, shown: &Cavity) -> Panel {
    let new = points.len() - 1;
    let mut panel = window(points, shown);
    for t in &planar.triangles {
        let fill = if cavity.region.contains(t) {
            Color::SKY.mixed(Color::WHITE, 0.55)
        } else {
            Color::WHITE
        };
        panel.polygon(
            &t.map(|i| points[i]),
            Style::fill(fill).outlined(Color::GRAY, 0.8),
        );
    }
    for &[a, b] in &cavity.boundary {
        let color = if is_seen(points, new, [a, b]) {
            Color::GREEN
        } else {
            Color::VERMILION
        };
        panel.line(points[a], points[b], Style::stroke(color, 3.0));
    }
    mark(&mut panel, points[new]);
    panel
}

fn filled(points: &[DVec2], planar: &Planar, cavity: &Cavity) -> Panel {
    let new = points.len() - 1;
    let mut panel = window(points, cavity);
    for t in planar
        .triangles
        .iter()
        .filter(|t| !cavity.region.contains(t))
    {
        panel.polygon(
            &t.map(|i| points[i]),
            Style::fill(Color::WHITE).outlined(Color::GRAY, 0.8),
        );
    }
    for seen in [true, false] {
        for &[a, b] in cavity
            .boundary
            .iter()
            .filter(|&&edge| is_seen(points, new, edge) == seen)
        {
            let (fill, line) = match seen {
                true => (Color::GREEN.mixed(Color::WHITE, 0.7), Color::GREEN),
                false => (Color::VERMILION, Color::VERMILION),
            };
            let opacity = if seen { 1.0 } else { 0.75 };
            let corners = [points[a], points[b], points[new]];
            panel.polygon(
                &corners,
                Style::fill(fill).outlined(line, 1.4).opacity(opacity),
            );
        }
    }
    mark(&mut panel, points[new]);
    panel
}

fn mark(panel: &mut Panel, point: DVec2) {
    panel.dot(
        point,
        5.0,
        Style::fill(Color::BLACK).outlined(Color::WHITE, 1.0),
    );
    panel.text(
        point,
        "new",
        Text::default().bold().halo().shift(0.0, -10.0),
    );
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn moving_the_points_is_exact() {
        let [here, there] = [0.0, 1e6].map(|offset| points(5, offset));
        for (p, q) in here.iter().zip(&there) {
            assert_eq!(*q - DVec2::splat(1e6), *p);
        }
        assert_eq!(
            Planar::delaunay(&here).triangles,
            Planar::delaunay(&there).triangles
        );
    }
}
