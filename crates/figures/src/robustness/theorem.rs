//! If pqv, qrv and rpv turn counter-clockwise, so does pqr: not with two digits.

use super::toy::{P, Point, Q, R, exact, exact_sign, orientation, position};
use crate::sheet::{Anchor, Axis, Color, Panel, Plot, Series, Style, Text};
use crate::{Error, Figure, Made, Number, Paper, Run, Sheet, Verdict};
use pellicle::glam::DVec2;
use pellicle::predicates::Sign;

pub(super) const FIGURE: Figure = Figure {
    name: "robustness-theorem",
    paper: Paper::Robustness,
    number: "failure of geometric theorems",
    title: "A theorem that does not survive rounding",
    shows: "states that pqr turns counter-clockwise if pqv, qrv and rpv do, and gives four points for which this fails with two digits: \
            p (−94, 0), q (400, 180), r (92, 68), v (−5, 34).",
    make,
};

/// The v of the slides.
const V: Point = [-5, 34];

fn toy_sign(a: Point, b: Point, c: Point) -> Sign {
    orientation(a, b, c).result.sign()
}

/// Whether v is to the left of all three edges.
fn premise(v: Point, sign: fn(Point, Point, Point) -> Sign) -> bool {
    [(P, Q), (Q, R), (R, P)]
        .into_iter()
        .all(|(a, b)| sign(a, b, v) == Sign::Positive)
}

/// Every point whose coordinates have two digits, in the box of p, q and r.
fn candidates() -> impl Iterator<Item = Point> {
    let two_digits = |value: &i64| value.abs() < 100 || value % 10 == 0;
    (P[0]..=Q[0])
        .filter(two_digits)
        .flat_map(move |x| (P[1]..=Q[1]).filter(two_digits).map(move |y| [x, y]))
}

fn make(_: &Run<'_>) -> Result<Made, Error> {
    let counterexamples = |sign: fn(Point, Point, Point) -> Sign| -> Vec<Point> {
        let conclusion = sign(P, Q, R) == Sign::Positive;
        candidates()
            .filter(|&v| premise(v, sign) && !conclusion)
            .collect()
    };
    let toy = counterexamples(toy_sign);
    let exactly = counterexamples(exact_sign);
    if toy.is_empty() {
        return Err(Error::NotShown("the theorem holds with two digits".into()));
    }
    let mut numbers = Vec::new();
    for (name, [a, b, c], printed) in [
        ("pqv", [P, Q, V], 1.0),
        ("qrv", [Q, R, V], 1.0),
        ("rpv", [R, P, V], 1.0),
        ("pqr", [P, Q, R], -1.0),
    ] {
        let sign = f64::from(toy_sign(a, b, c) as i8);
        let turn = if printed > 0.0 {
            "counter-clockwise"
        } else {
            "clockwise"
        };
        numbers.push(Number::exactly(format!("{name}, sign with two digits"), sign).paper(turn));
        numbers.push(Number::exactly(
            format!("{name}, exact"),
            exact(a, b, c) as f64,
        ));
    }
    numbers.push(
        Number::exactly("points v against the theorem, two digits", toy.len() as f64).paper("1"),
    );
    numbers.push(Number::exactly(
        "points v against the theorem, exact signs",
        exactly.len() as f64,
    ));
    let as_printed = premise(V, toy_sign);
    let nearest = nearest(&toy);
    Ok(Made {
        sheet: Sheet::new(1).with(picture(nearest)).with(heights(&toy)),
        numbers,
        verdict: match (exactly.is_empty(), as_printed) {
            (true, true) => Verdict::Agrees,
            (true, false) => Verdict::Better,
            (false, _) => Verdict::Different,
        },
        because: format!(
            "The theorem fails with two digits, but not for the v that is printed: with it rpv turns clockwise, exactly ({}) and with \
             two digits ({}). It does fail for {} other points; of these ({}, {}) is nearest to the printed one. With exact \
             signs it never fails.",
            exact(R, P, V),
            orientation(R, P, V).result,
            toy.len(),
            nearest[0],
            nearest[1]
        )
        .replace('-', "−"),
    })
}

/// The counterexample nearest to the printed v.
fn nearest(points: &[Point]) -> Point {
    let square = |v: &Point| (v[0] - V[0]).pow(2) + (v[1] - V[1]).pow(2);
    points.iter().copied().min_by_key(square).unwrap_or(V)
}

/// Where the points are.
fn picture(nearest: Point) -> Panel {
    let [min, max] = [DVec2::new(-130.0, -30.0), DVec2::new(440.0, 200.0)];
    let mut panel = Panel::plane(800.0, 300.0, min, max)
        .caption("p, q and r turn counter-clockwise, exactly; with two digits they turn clockwise");
    let [p, q, r] = [P, Q, R].map(position);
    panel.polygon(
        &[p, q, r],
        Style::fill(Color::PALE).outlined(Color::BLACK, 1.0),
    );
    let text = Text::default().size(14.0).halo();
    let above = text.anchor(Anchor::End).shift(-6.0, -8.0);
    let below = text.anchor(Anchor::Start).shift(4.0, 20.0);
    for (point, name, place) in [
        (p, "p (−94, 0)", below),
        (q, "q (400, 180)", above),
        (r, "r (92, 68)", below),
    ] {
        panel.dot(point, 4.5, Style::fill(Color::BLACK));
        panel.text(point, name, place);
    }
    let words = format!("v ({}, {})", nearest[0], nearest[1]).replace('-', "−");
    panel.dot(position(V), 5.0, Style::stroke(Color::BLUE, 2.0));
    panel.text(position(V), "printed: v (−5, 34)", above.color(Color::BLUE));
    panel.dot(position(nearest), 4.5, Style::fill(Color::VERMILION));
    panel.text(position(nearest), &words, below.color(Color::VERMILION));
    panel
}

/// How high over the line pq a point is.
fn height(v: Point) -> f64 {
    exact(P, Q, v) as f64 / (position(Q) - position(P)).length()
}

/// The same, the line pq laid level and heights drawn large.
fn heights(counterexamples: &[Point]) -> Panel {
    let at = |v: Point| DVec2::new(v[0] as f64, height(v));
    let points = |points: &[Point]| -> Vec<DVec2> { points.iter().map(|&v| at(v)).collect() };
    let triangle = points(&[P, Q, R, P]);
    Plot::new(
        Axis::new("x").range(-110.0, 410.0),
        Axis::new("height over the line pq").range(-0.5, 2.2),
    )
    .with(Series::line("the triangle pqr", triangle).color(Color::BLACK))
    .with(
        Series::dots(
            "v with pqv, qrv and rpv counter-clockwise, all with two digits",
            points(counterexamples),
        )
        .color(Color::VERMILION),
    )
    .with(Series::dots("the printed v", points(&[V])).color(Color::BLUE))
    .panel(800.0, 280.0)
    .caption("the same, the line pq laid level: heights are drawn large")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_theorem_holds_for_integers() {
        // Its proof: the three determinants with v sum up to that of pqr.
        for v in candidates() {
            let sum = exact(P, Q, v) + exact(Q, R, v) + exact(R, P, v);
            assert_eq!(sum, exact(P, Q, R));
        }
    }

    #[test]
    fn exact_signs_are_those_of_integers() {
        for v in candidates() {
            for [a, b] in [[P, Q], [Q, R], [R, P]] {
                assert_eq!(exact_sign(a, b, v) as i64, exact(a, b, v).signum());
            }
        }
    }
}
