//! How often a filter is sure, and what each stage costs, on the in-sphere tests that real inputs ask.
//!
//! The tests are those that show a tetrahedralisation to be Delaunay: each inner facet's tetrahedron on one side, and the
//! opposite corner on the other. They are harder than most that are asked on the way there: the point is close to the
//! sphere, or on it.

use crate::sheet::{Anchor, Color, Panel, Style, Text};
use crate::{Error, Figure, Made, Number, Paper, Random, Run, Sheet, Verdict};
use pellicle::delaunay::{self, Tetrahedralization};
use pellicle::geometry::Aabb;
use pellicle::glam::{DVec2, DVec3};
use pellicle::io::{ReadOptions, read_points};
use pellicle::predicates::statistics::Stage;
use pellicle::predicates::{Sign, StaticFilter, insphere, stages};
use std::hint::black_box;
use std::time::Instant;

pub(super) const FIGURE: Figure = Figure {
    name: "robustness-stages",
    paper: Paper::Robustness,
    number: "static and dynamic filtering",
    title: "Who decides, and at what cost",
    shows: "says of static filters: very fast, reasonable success rate; of interval arithmetic: slower, excellent success rate; and that filtered \
            exact predicates cost about what approximate ones do, since easy cases are more frequent.",
    make,
};

/// The four corners of a positive tetrahedron, and the point that is tested.
type Call = [DVec3; 5];

/// What decides a call in the slides' order: the static filter, else intervals, else integers.
#[derive(Clone, Copy, Default)]
struct Decided {
    calls: usize,
    by_static: usize,
    by_interval: usize,
    /// Whatever the static filter says.
    interval_alone: usize,
    ties: usize,
    wrong: usize,
}

impl Decided {
    fn share(&self, count: usize) -> f64 {
        100.0 * count as f64 / self.calls.max(1) as f64
    }

    fn by_integers(&self) -> usize {
        self.calls - self.by_static - self.by_interval
    }
}

/// The test across each inner facet.
fn calls(tetrahedra: &Tetrahedralization<'_>) -> Vec<Call> {
    let points = tetrahedra.points();
    tetrahedra
        .facets()
        .filter_map(|facet| {
            let twin = tetrahedra.twin(facet);
            if !tetrahedra.is_finite(twin.tet()) {
                return None;
            }
            let [a, b, c, d] = tetrahedra.tet(facet.tet());
            let opposite = tetrahedra.tet(twin.tet())[twin.corner()];
            Some([a, b, c, d, opposite].map(|vertex| points[vertex.index()]))
        })
        .collect()
}

fn decide(filter: &StaticFilter, calls: &[Call]) -> Decided {
    let mut decided = Decided::default();
    for &[a, b, c, d, e] in calls {
        let truth = stages::insphere(Stage::AnyWidth, a, b, c, d, e);
        let by_static = filter.insphere_filtered(a, b, c, d, e);
        let by_interval = stages::insphere(Stage::Interval, a, b, c, d, e);
        decided.calls += 1;
        decided.by_static += usize::from(by_static.is_some());
        decided.interval_alone += usize::from(by_interval.is_some());
        decided.by_interval += usize::from(by_static.is_none() && by_interval.is_some());
        decided.ties += usize::from(truth == Some(Sign::Zero));
        let lies = |answer: Option<Sign>| answer.is_some() && answer != truth;
        let wrong = lies(by_static) || lies(by_interval) || Some(insphere(a, b, c, d, e)) != truth;
        decided.wrong += usize::from(wrong);
    }
    decided
}

/// The input on which costs are measured.
const TIMED: &str = "kitten, a scan";

/// What is tetrahedralised.
struct Input {
    name: &'static str,
    points: Vec<DVec3>,
    /// Neither made to be degenerate nor nearly so.
    ordinary: bool,
}

fn inputs(run: &Run<'_>) -> Result<Vec<Input>, Error> {
    let mut random = Random::new(1, 0);
    let uniform = (0..run.effort.pick(2_000, 10_000))
        .map(|_| random.vector(Random::unit))
        .collect();
    let files: &[_] = run.effort.pick(
        &[(TIMED, "kitten.xyz")],
        &[
            (TIMED, "kitten.xyz"),
            ("building, a scan", "building.xyz"),
            ("half, a scan", "half.xyz"),
            ("sphere, rounded", "sphere_20k.xyz"),
        ],
    );
    let ordinary = |name, points| Input {
        name,
        points,
        ordinary: true,
    };
    let degenerate = |name, points| Input {
        name,
        points,
        ordinary: false,
    };
    let mut inputs = vec![ordinary("uniform", uniform)];
    for (name, file) in files {
        let read = read_points(run.fixture(file), &ReadOptions::default())?;
        inputs.push(ordinary(name, read.cloud.positions().to_vec()));
    }
    let count = run.effort.pick(500, 4_000);
    let mut near_a_sphere = |noise: f64| -> Vec<DVec3> {
        let direction =
            |random: &mut Random| random.vector(|random| random.unit() - 0.5).normalize();
        let mut point = || direction(&mut random) * (1.0 + noise * (random.unit() - 0.5));
        (0..count).map(|_| point()).collect()
    };
    inputs.push(degenerate("sphere, noise of 10⁻¹²", near_a_sphere(1e-12)));
    inputs.push(degenerate("sphere, in doubles", near_a_sphere(0.0)));
    inputs.push(degenerate("grid", grid(run.effort.pick(6, 14))));
    inputs.push(degenerate(
        "cospherical",
        cospherical(run.effort.pick(9, 65)),
    ));
    Ok(inputs)
}

fn grid(side: u32) -> Vec<DVec3> {
    let at = |i: u32| [i % side, i / side % side, i / side / side].map(f64::from);
    (0..side.pow(3)).map(|i| DVec3::from(at(i))).collect()
}

/// The points with whole coordinates on the sphere of this radius.
fn cospherical(radius: i64) -> Vec<DVec3> {
    let mut points = Vec::new();
    for x in -radius..=radius {
        for y in -radius..=radius {
            let rest = radius * radius - x * x - y * y;
            let z = (-radius..=radius).filter(|z| z * z == rest);
            points.extend(z.map(|z| DVec3::new(x as f64, y as f64, z as f64)));
        }
    }
    points
}

/// The determinant in doubles, e moved into the origin.
fn plain([a, b, c, d, e]: Call) -> Sign {
    let [a, b, c, d] = [a, b, c, d].map(|p| p - e);
    let turn = |p: DVec3, q: DVec3, r: DVec3| p.dot(q.cross(r));
    let [aa, bb, cc, dd] = [a, b, c, d].map(DVec3::length_squared);
    Sign::of(aa * turn(b, c, d) - bb * turn(a, c, d) + cc * turn(a, b, d) - dd * turn(a, b, c))
}

/// Nanoseconds a call. Of each short run of calls the least of several rounds counts, so that other work on the machine
/// hardly shows.
fn cost(calls: &[Call], decide: impl Fn(Call) -> bool) -> f64 {
    const ROUNDS: usize = 7;
    const SHORT: usize = 200;
    let mut least = vec![f64::INFINITY; calls.len().div_ceil(SHORT)];
    for _ in 0..ROUNDS {
        for (run, least) in calls.chunks(SHORT).zip(&mut least) {
            let start = Instant::now();
            for &call in run {
                black_box(decide(black_box(call)));
            }
            *least = least.min(start.elapsed().as_secs_f64());
        }
    }
    1e9 * least.iter().sum::<f64>() / calls.len().max(1) as f64
}

fn make(run: &Run<'_>) -> Result<Made, Error> {
    let mut numbers = Vec::new();
    let mut rows = Vec::new();
    let mut costs = Vec::new();
    let inputs = inputs(run)?;
    let mut excellent = true;
    for (
        done,
        Input {
            name,
            points,
            ordinary,
        },
    ) in inputs.iter().enumerate()
    {
        run.step("inputs", done as u64, inputs.len() as u64)?;
        let tetrahedra =
            delaunay::tetrahedralize_with(points, &delaunay::Options::default(), run.progress)?;
        let calls = calls(&tetrahedra);
        let bounds = Aabb::of_points(points);
        let filter = StaticFilter::from_bounds(bounds.min, bounds.max);
        let decided = decide(&filter, &calls);
        numbers.push(Number::exactly(
            format!("{name}: tests"),
            decided.calls as f64,
        ));
        for (what, count) in [
            ("static filter is sure", decided.by_static),
            ("intervals alone are sure", decided.interval_alone),
            ("left to integers", decided.by_integers()),
            ("ties", decided.ties),
        ] {
            numbers
                .push(Number::exactly(format!("{name}: {what}"), decided.share(count)).unit("%"));
        }
        rows.push((*name, decided));
        excellent &= !ordinary || decided.share(decided.interval_alone) > 99.0;
        if *name == TIMED && run.effort == crate::Effort::Full {
            costs = measure(&filter, &calls[..calls.len().min(20_000)]);
        }
    }
    for (name, nanoseconds) in &costs {
        numbers.push(Number::uncompared(format!("a test by {name}"), *nanoseconds).unit("ns"));
    }
    let wrong: usize = rows.iter().map(|(_, decided)| decided.wrong).sum();
    numbers.push(Number::exactly("wrong answers of any stage", wrong as f64));
    let mut sheet = Sheet::new(1).with(rates(&rows));
    if !costs.is_empty() {
        sheet.push(cost_panel(&costs));
    }
    Ok(Made {
        sheet,
        numbers,
        verdict: if wrong == 0 && excellent { Verdict::Agrees } else { Verdict::Different },
        because: "The tests across the facets of the Delaunay tetrahedralisation of each input. On scans and random points intervals are always sure, and \
                  the static filter nearly always. Both are at a loss where points are cospherical up to rounding, and neither can ever \
                  be sure of a tie, which grids are full of: there exact signs are needed. No stage is ever wrong where it is sure. \
                  The filtered predicate costs little more than doubles. Integers of fixed width, which the slides do not have, cost less \
                  than our intervals, so `insphere` tries them first."
            .into(),
    })
}

fn measure(filter: &StaticFilter, calls: &[Call]) -> Vec<(&'static str, f64)> {
    let stage =
        |stage| move |[a, b, c, d, e]: Call| stages::insphere(stage, a, b, c, d, e).is_some();
    vec![
        (
            "doubles, perhaps wrong",
            cost(calls, |call| plain(call) == Sign::Positive),
        ),
        (
            "the static filter",
            cost(calls, |[a, b, c, d, e]| {
                filter.insphere_filtered(a, b, c, d, e).is_some()
            }),
        ),
        (
            "all stages, filter first",
            cost(calls, |[a, b, c, d, e]| {
                filter.insphere(a, b, c, d, e) == Sign::Positive
            }),
        ),
        (
            "integers of fixed width",
            cost(calls, stage(Stage::FixedWidth)),
        ),
        ("intervals", cost(calls, stage(Stage::Interval))),
        ("integers of any width", cost(calls, stage(Stage::AnyWidth))),
    ]
}

const LABELS: f64 = 170.0;
const BARS: f64 = 520.0;

/// A bar for each input, divided by who decides.
fn rates(rows: &[(&str, Decided)]) -> Panel {
    let height = 50.0 + 30.0 * rows.len() as f64;
    let mut panel = Panel::pixels(LABELS + BARS + 110.0, height)
        .caption("who decides the in-sphere tests of each input, in this order");
    let stages = [
        (Color::GREEN, "static filter"),
        (Color::ORANGE, "intervals"),
        (Color::VERMILION, "integers"),
    ];
    for (at, (color, words)) in stages.into_iter().enumerate() {
        panel.legend(
            DVec2::new(LABELS + 130.0 * at as f64, 6.0),
            &[(Style::fill(color), words)],
        );
    }
    for (row, (name, decided)) in rows.iter().enumerate() {
        let y = 34.0 + 30.0 * row as f64;
        panel.text(
            DVec2::new(LABELS - 8.0, y + 15.0),
            name,
            Text::default().anchor(Anchor::End),
        );
        let mut left = LABELS;
        for ((color, _), count) in stages.iter().zip([
            decided.by_static,
            decided.by_interval,
            decided.by_integers(),
        ]) {
            let right = left + BARS * decided.share(count) / 100.0;
            panel.rectangle(
                DVec2::new(left, y),
                DVec2::new(right, y + 20.0),
                Style::fill(*color),
            );
            left = right;
        }
        let words = format!("{:.1} % ties", decided.share(decided.ties));
        panel.text(
            DVec2::new(LABELS + BARS + 8.0, y + 15.0),
            &words,
            Text::default().size(11.0).anchor(Anchor::Start),
        );
    }
    panel
}

/// A bar for each way to decide, by the logarithm of its cost.
fn cost_panel(costs: &[(&str, f64)]) -> Panel {
    let height = 20.0 + 30.0 * costs.len() as f64;
    let mut panel = Panel::pixels(LABELS + BARS + 110.0, height)
        .caption("nanoseconds a test on the kitten, on a logarithmic scale from 1");
    let most = costs
        .iter()
        .map(|(_, cost)| *cost)
        .fold(10.0, f64::max)
        .log10();
    for (row, (name, cost)) in costs.iter().enumerate() {
        let y = 8.0 + 30.0 * row as f64;
        panel.text(
            DVec2::new(LABELS - 8.0, y + 15.0),
            name,
            Text::default().anchor(Anchor::End),
        );
        let right = LABELS + BARS * (cost.max(1.0).log10() / most);
        panel.rectangle(
            DVec2::new(LABELS, y),
            DVec2::new(right, y + 20.0),
            Style::fill(Color::BLUE),
        );
        let words = format!("{cost:.0} ns");
        panel.text(
            DVec2::new(right + 8.0, y + 15.0),
            &words,
            Text::default().size(11.0).anchor(Anchor::Start),
        );
    }
    panel
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cospherical_points_are() {
        let points = cospherical(9);
        assert!(points.len() > 30);
        assert!(points.iter().all(|p| p.length_squared() == 81.0));
    }

    #[test]
    fn each_inner_facet_is_asked_once_and_none_is_in_conflict() {
        let points = grid(4);
        let tetrahedra =
            delaunay::tetrahedralize(&points, &delaunay::Options::default()).expect("tetrahedra");
        let calls = calls(&tetrahedra);
        // Four facets a tetrahedron: each inner one is counted twice, each hull one once.
        let finite = tetrahedra.finite_count();
        let hull = tetrahedra.tets().len() - finite;
        assert_eq!(2 * calls.len() + hull, 4 * finite);
        for [a, b, c, d, e] in calls {
            assert_ne!(insphere(a, b, c, d, e), Sign::Positive);
        }
    }

    #[test]
    fn plain_doubles_have_the_right_sign_where_it_is_clear() {
        let [a, b, c, d] = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
        assert_eq!(plain([a, b, c, d, DVec3::splat(0.4)]), Sign::Positive);
        assert_eq!(plain([a, b, c, d, DVec3::splat(1.4)]), Sign::Negative);
    }
}
