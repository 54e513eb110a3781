//! Cocircular points: each test may be answered either way, but not all answers go together.

use super::planar::{Cavity, Defect, Planar, Triangle, canonical, far_corners, is_seen};
use crate::sheet::{Color, Panel, Style, Text};
use crate::{Error, Figure, Made, Number, Paper, Random, Run, Sheet, Verdict};
use pellicle::glam::DVec2;
use pellicle::predicates::{Sign, incircle, lifted};
use std::collections::BTreeSet;

pub(super) const FIGURE: Figure = Figure {
    name: "robustness-choices",
    paper: Paper::Robustness,
    number: "degenerate cases",
    title: "Choices at cocircular points",
    shows: "lets the program choose whether a cocircular point is in the disk or outside: either choice gives a triangulation, random choices \
            are inconsistent, and always \"outside\" gives different results for different orders of the same points.",
    make,
};

/// What a program answers when a point lies on a circle.
#[derive(Clone, Copy)]
enum Choice {
    Outside,
    Inside,
    /// A coin for each test.
    Random,
    /// The perturbation in the lifted dimension.
    Lifted,
}

/// The whole points of the circle x² + y² = 25.
const CIRCLE: [[f64; 2]; 12] = [
    [5.0, 0.0],
    [4.0, 3.0],
    [3.0, 4.0],
    [0.0, 5.0],
    [-3.0, 4.0],
    [-4.0, 3.0],
    [-5.0, 0.0],
    [-4.0, -3.0],
    [-3.0, -4.0],
    [0.0, -5.0],
    [3.0, -4.0],
    [4.0, -3.0],
];

/// The first insertion that could not be made, and the triangulation before it.
struct Failure {
    planar: Planar,
    cavity: Cavity,
    new: usize,
}

/// Inserts the points in their order; the first three are the far corners.
fn insert_all(points: &[DVec2], choice: Choice, random: &mut Random) -> Result<Planar, Failure> {
    let mut planar = Planar::new();
    for new in 3..points.len() {
        let cavity =
            planar.scattered_cavity(points, new, |t| in_conflict(points, t, new, choice, random));
        if cavity.defect.is_some() {
            return Err(Failure {
                planar,
                cavity,
                new,
            });
        }
        planar.fill(&cavity, new);
    }
    Ok(planar)
}

fn in_conflict(
    points: &[DVec2],
    t: Triangle,
    new: usize,
    choice: Choice,
    random: &mut Random,
) -> bool {
    let ([a, b, c], d) = (t.map(|i| points[i]), points[new]);
    match (incircle(a, b, c, d), choice) {
        (Sign::Zero, Choice::Outside) => false,
        (Sign::Zero, Choice::Inside) => true,
        (Sign::Zero, Choice::Random) => random.bits() & 1 == 1,
        (Sign::Zero, Choice::Lifted) => lifted::incircle(a, b, c, d) == Sign::Positive,
        (sign, _) => sign == Sign::Positive,
    }
}

/// The far corners, and the points of the circle in the order of a seed; order 0 is that of the table.
fn ordered(seed: u64) -> (Vec<DVec2>, Vec<usize>) {
    let mut order: Vec<usize> = (0..CIRCLE.len()).collect();
    if seed > 0 {
        let mut random = Random::new(seed, 1);
        for i in (1..order.len()).rev() {
            order.swap(i, (random.bits() % (i as u64 + 1)) as usize);
        }
    }
    let mut points = far_corners(DVec2::ZERO, 5.0).to_vec();
    points.extend(order.iter().map(|&i| DVec2::from(CIRCLE[i])));
    (points, order)
}

/// The triangles by the points of the table, whatever their order was; the far corners come first.
fn by_points(planar: &Planar, order: &[usize]) -> Vec<Triangle> {
    let name = |i: usize| if i < 3 { i } else { order[i - 3] + 3 };
    let mut triangles: Vec<Triangle> = planar
        .triangles
        .iter()
        .map(|t| canonical(t.map(name)))
        .collect();
    triangles.sort_unstable();
    triangles
}

/// What many orders of the same points give.
struct Tally {
    results: BTreeSet<Vec<Triangle>>,
    failures: u32,
    /// The one with most points, and its order.
    latest_failure: Option<(u64, Failure)>,
}

fn tally(choice: Choice, orders: u64) -> Tally {
    let mut tally = Tally {
        results: BTreeSet::new(),
        failures: 0,
        latest_failure: None,
    };
    for seed in 0..orders {
        let (points, order) = ordered(seed);
        match insert_all(&points, choice, &mut Random::new(seed, 2)) {
            Ok(planar) => {
                tally.results.insert(by_points(&planar, &order));
            }
            Err(failure) => {
                tally.failures += 1;
                let latest = tally
                    .latest_failure
                    .as_ref()
                    .map_or(0, |(_, failure)| failure.new);
                if failure.new > latest {
                    tally.latest_failure = Some((seed, failure));
                }
            }
        }
    }
    tally
}

fn make(run: &Run<'_>) -> Result<Made, Error> {
    let orders = run.effort.pick(100, 2_000);
    let mut numbers = vec![Number::exactly("orders of insertion", orders as f64)];
    let mut sheet = Sheet::new(3);
    let mut found = Vec::new();
    for (done, (choice, name, caption)) in [
        (
            Choice::Outside,
            "always outside",
            "always \"outside\": a result of one order",
        ),
        (
            Choice::Outside,
            "",
            "always \"outside\": the same points in another order",
        ),
        (
            Choice::Random,
            "a coin each",
            "a coin for each test: the answers do not go together",
        ),
        (
            Choice::Inside,
            "always in the disk",
            "always \"in the disk\"",
        ),
        (
            Choice::Lifted,
            "perturbed",
            "perturbed in the lifted dimension: every order gives this",
        ),
    ]
    .into_iter()
    .enumerate()
    {
        run.step("orders", done as u64, 5)?;
        let tally = tally(choice, orders);
        if !name.is_empty() {
            numbers.push(Number::exactly(
                format!("different results, {name}"),
                tally.results.len() as f64,
            ));
            numbers.push(Number::exactly(
                format!("orders that fail, {name}"),
                f64::from(tally.failures),
            ));
        }
        let table = ordered(0).0;
        // The second panel of "outside" shows another result.
        let result = if name.is_empty() {
            tally.results.last()
        } else {
            tally.results.first()
        };
        sheet.push(
            match (&tally.latest_failure, result) {
                (Some((seed, failure)), _) => inconsistent(&ordered(*seed).0, failure),
                (None, Some(triangles)) => picture(&table, triangles),
                (None, None) => Panel::pixels(SIZE, SIZE),
            }
            .caption(caption),
        );
        found.push(tally);
    }
    let [outside, _, coin, inside, perturbed] = &found[..] else {
        return Err(Error::NotShown("five cases".into()));
    };
    sheet.push(table(
        orders,
        &[
            ("always outside", outside),
            ("always in the disk", inside),
            ("a coin each", coin),
            ("perturbed", perturbed),
        ],
    ));
    if coin.failures == 0 || outside.results.len() < 2 {
        return Err(Error::NotShown("random choices go together".into()));
    }
    let unique = perturbed.results.len() == 1 && perturbed.failures == 0;
    Ok(Made {
        sheet,
        numbers,
        verdict: if unique {
            Verdict::Agrees
        } else {
            Verdict::Different
        },
        because: format!(
            "Twelve points of one circle in {orders} orders. Coins fail in {} of them: the triangles in conflict do not hang together and cannot be \
             replaced. Always \"outside\" never failed here, in the plane, but gives {} different triangulations; always \"in the disk\" gives {}, \
             fans around the last point. The perturbation in the lifted dimension gives one triangulation for all orders.",
            coin.failures,
            outside.results.len(),
            inside.results.len()
        ),
    })
}

const SIZE: f64 = 280.0;

fn empty() -> Panel {
    Panel::plane(SIZE, SIZE, DVec2::splat(-6.4), DVec2::splat(6.4))
}

fn picture(points: &[DVec2], triangles: &[Triangle]) -> Panel {
    let mut panel = empty();
    panel.circle(DVec2::ZERO, 5.0, Style::stroke(Color::PALE, 1.5));
    for t in triangles {
        let of_circle = t.iter().all(|&corner| corner > 2);
        let fill = if of_circle {
            Color::SKY.mixed(Color::WHITE, 0.6)
        } else {
            Color::WHITE
        };
        panel.polygon(
            &t.map(|i| points[i]),
            Style::fill(fill).outlined(Color::GRAY, 1.0),
        );
    }
    for &point in &points[3..] {
        panel.dot(point, 3.5, Style::fill(Color::BLACK));
    }
    panel
}

/// The cavity that cannot be filled.
fn inconsistent(points: &[DVec2], failure: &Failure) -> Panel {
    let Failure {
        planar,
        cavity,
        new,
    } = failure;
    let mut panel = picture(&points[..*new], &planar.triangles);
    for t in &cavity.region {
        panel.polygon(
            &t.map(|i| points[i]),
            Style::fill(Color::ORANGE)
                .outlined(Color::GRAY, 1.0)
                .opacity(0.55),
        );
    }
    for &[a, b] in &cavity.boundary {
        let seen = is_seen(points, *new, [a, b]);
        let color = if seen { Color::GREEN } else { Color::VERMILION };
        panel.line(points[a], points[b], Style::stroke(color, 2.6));
    }
    panel.dot(
        points[*new],
        5.0,
        Style::fill(Color::VERMILION).outlined(Color::WHITE, 1.0),
    );
    let words = match cavity.defect {
        Some(Defect::NotADisc) => "in conflict with the new point",
        _ => "in conflict, but not star-shaped",
    };
    panel.text_at_pixel(
        DVec2::new(SIZE / 2.0, SIZE - 6.0),
        words,
        Text::default().halo().color(Color::VERMILION),
    );
    panel
}

fn table(orders: u64, rows: &[(&str, &Tally)]) -> Panel {
    let mut panel =
        Panel::pixels(SIZE, SIZE).caption(format!("{orders} orders of twelve cocircular points"));
    let columns = [80.0, 165.0, 235.0];
    let bold = Text::default().bold();
    for (x, words) in columns.into_iter().zip(["a tie is", "results", "failures"]) {
        panel.text(DVec2::new(x, 60.0), words, bold);
    }
    for (row, (name, tally)) in rows.iter().enumerate() {
        let y = 92.0 + 30.0 * row as f64;
        let cells = [
            (*name).to_owned(),
            tally.results.len().to_string(),
            tally.failures.to_string(),
        ];
        for (x, words) in columns.into_iter().zip(cells) {
            panel.text(DVec2::new(x, y), &words, Text::default());
        }
    }
    panel
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_points_are_cocircular_and_differ() {
        let points: BTreeSet<[i64; 2]> = CIRCLE.iter().map(|p| p.map(|c| c as i64)).collect();
        assert_eq!(points.len(), 12);
        assert!(points.iter().all(|[x, y]| x * x + y * y == 25));
    }

    #[test]
    fn what_does_not_fail_is_a_triangulation() {
        for choice in [
            Choice::Outside,
            Choice::Inside,
            Choice::Random,
            Choice::Lifted,
        ] {
            for seed in 0..50 {
                let (points, _) = ordered(seed);
                let Ok(planar) = insert_all(&points, choice, &mut Random::new(seed, 2)) else {
                    continue;
                };
                // All turn counter-clockwise, and together they have the area of the outer triangle.
                let area = |t: &Triangle| {
                    let [a, b, c] = t.map(|i| points[i]);
                    (b - a).perp_dot(c - a)
                };
                assert!(planar.triangles.iter().all(|t| area(t) > 0.0));
                assert_eq!(
                    planar.triangles.iter().map(area).sum::<f64>(),
                    area(&[0, 1, 2])
                );
            }
        }
    }
}
