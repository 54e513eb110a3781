//! Arithmetic with two decimal digits, and what it makes of sums and of an orientation.

use super::sign_map::SignMap;
use crate::sheet::{Anchor, Color, Panel, Style, Text};
use crate::{Error, Figure, Made, Number, Paper, Run, Sheet, Verdict};
use pellicle::glam::DVec2;
use pellicle::predicates::{Sign, orient2d};
use std::fmt;

pub(super) const FIGURE: Figure = Figure {
    name: "robustness-toy-model",
    paper: Paper::Robustness,
    number: "toy model",
    title: "Arithmetic with two decimal digits",
    shows: "computes with two decimal digits: a sum depends on its order, and an orientation that is 112 comes out as −1000.",
    make,
};

/// A decimal number of two digits: `digits` · 10^`exponent`, |digits| < 100.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Toy {
    digits: i64,
    exponent: i32,
}

impl Toy {
    /// The nearest number of two digits; of two equally near ones that with an even last digit.
    pub(super) fn rounded(mut value: i64, mut exponent: i32) -> Self {
        let sign = value.signum();
        value = value.abs();
        let mut dropped = 1;
        while value / dropped >= 100 {
            dropped *= 10;
            exponent += 1;
        }
        let (mut digits, rest) = (value / dropped, value % dropped);
        if 2 * rest > dropped || (2 * rest == dropped && digits % 2 == 1) {
            digits += 1;
        }
        if digits == 100 {
            (digits, exponent) = (10, exponent + 1);
        }
        Self {
            digits: sign * digits,
            exponent,
        }
    }

    pub(super) fn of(value: i64) -> Self {
        Self::rounded(value, 0)
    }

    fn plus(self, other: Self) -> Self {
        let exponent = self.exponent.min(other.exponent);
        let aligned = |n: Self| n.digits * 10_i64.pow((n.exponent - exponent) as u32);
        Self::rounded(aligned(self) + aligned(other), exponent)
    }

    fn minus(self, other: Self) -> Self {
        let digits = -other.digits;
        self.plus(Self { digits, ..other })
    }

    fn times(self, other: Self) -> Self {
        Self::rounded(self.digits * other.digits, self.exponent + other.exponent)
    }

    pub(super) fn sign(self) -> Sign {
        Sign::of(self.digits as f64)
    }

    fn value(self) -> f64 {
        match self.exponent {
            0.. => (self.digits * 10_i64.pow(self.exponent as u32)) as f64,
            _ => self.digits as f64 / 10_i64.pow(self.exponent.unsigned_abs()) as f64,
        }
    }
}

impl fmt::Display for Toy {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.value().to_string().replace('-', "−"))
    }
}

/// A point with whole coordinates of at most two digits (and zeros behind them).
pub(super) type Point = [i64; 2];

/// (qx − px)(ry − py) − (qy − py)(rx − px), each operation rounded; all that comes up on the way.
pub(super) struct Orientation {
    /// The four differences, in the order of the formula.
    differences: [Toy; 4],
    products: [Toy; 2],
    pub(super) result: Toy,
}

pub(super) fn orientation(p: Point, q: Point, r: Point) -> Orientation {
    let [p, q, r] = [p, q, r].map(|point| point.map(Toy::of));
    let differences = [
        q[0].minus(p[0]),
        r[1].minus(p[1]),
        q[1].minus(p[1]),
        r[0].minus(p[0]),
    ];
    let [a, b, c, d] = differences;
    let products = [a.times(b), c.times(d)];
    Orientation {
        differences,
        products,
        result: products[0].minus(products[1]),
    }
}

/// The true sign.
pub(super) fn exact_sign(p: Point, q: Point, r: Point) -> Sign {
    let [p, q, r] = [p, q, r].map(position);
    orient2d(p, q, r)
}

/// The true determinant.
pub(super) fn exact(p: Point, q: Point, r: Point) -> i64 {
    (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])
}

pub(super) fn position(point: Point) -> DVec2 {
    DVec2::new(point[0] as f64, point[1] as f64)
}

/// The points of the slides.
pub(super) const P: Point = [-94, 0];
pub(super) const Q: Point = [400, 180];
pub(super) const R: Point = [92, 68];

fn make(_: &Run<'_>) -> Result<Made, Error> {
    let [one, two, three] = [Toy::of(35), Toy::rounded(33, -1), Toy::rounded(4, -1)];
    let [left, right] = [one.plus(two).plus(three), one.plus(two.plus(three))];
    let toy = orientation(P, Q, R);
    let toy_map = map(|r| orientation(P, Q, r).result.sign());
    let exact_map = map(|r| exact_sign(P, Q, r));
    let [wrong, none] = [&toy_map, &exact_map].map(|map| map.wrong);
    let numbers = vec![
        Number::exactly("(35 + 3.3) + 0.4", left.value()).paper("38"),
        Number::exactly("35 + (3.3 + 0.4)", right.value()).paper("39"),
        Number::exactly("orient(p, q, r), exact", exact(P, Q, R) as f64).paper("112"),
        Number::exactly("orient(p, q, r), two digits", toy.result.value()).paper("−1000"),
        Number::exactly(
            "wrong signs of 10,000 positions of r, two digits",
            f64::from(wrong),
        ),
        Number::exactly(
            "wrong signs of 10,000 positions of r, exact",
            f64::from(none),
        ),
    ];
    let agrees = numbers[..4]
        .iter()
        .zip([38.0, 39.0, 112.0, -1000.0])
        .all(|(number, printed)| number.value == printed);
    let mut sheet = Sheet::new(3);
    sheet.push(steps(left, right, &toy));
    sheet.push(picture(
        &toy_map,
        "the sign of orient(p, q, r) for r in 0 … 99, two digits",
    )?);
    sheet.push(picture(
        &exact_map,
        "the same, pellicle::predicates::orient2d",
    )?);
    Ok(Made {
        sheet,
        numbers,
        verdict: if agrees && none == 0 {
            Verdict::Agrees
        } else {
            Verdict::Different
        },
        because: format!(
            "The same sums, the same 112 and −1000. Beside it the signs for all r with coordinates from 0 to 99: {wrong} of \
             10,000 are wrong with two digits, {none} with the exact predicate."
        ),
    })
}

/// What is computed, line by line, as on the slides.
fn steps(left: Toy, right: Toy, toy: &Orientation) -> Panel {
    let [a, b, c, d] = toy.differences;
    let [one, two] = toy.products;
    let lines = [
        "35 + 3.7 = 38.7, exactly".to_owned(),
        format!("(35 + 3.3) + 0.4 ≈ {left}"),
        format!("35 + (3.3 + 0.4) ≈ {right}"),
        String::new(),
        "p = (−94, 0)   q = (400, 180)   r = (92, 68)".into(),
        format!("(400 + 94)·68 − (180 − 0)·(92 + 94) = {}", exact(P, Q, R)),
        format!("≈ {a}·{b} − {c}·{d}"),
        format!("≈ {one} − {two}"),
        format!("= {}", toy.result),
    ];
    let mut panel = Panel::pixels(300.0, 270.0).caption("every operation rounded to two digits");
    for (row, words) in lines.iter().enumerate() {
        let at = DVec2::new(4.0, 36.0 + 26.0 * row as f64);
        let text = Text::default().anchor(Anchor::Start);
        let last = row + 1 == lines.len();
        panel.text(
            at,
            words,
            if last {
                text.bold().color(Color::VERMILION)
            } else {
                text
            },
        );
    }
    panel
}

/// The signs for every r with coordinates from 0 to 99.
fn map(sign: impl Fn(Point) -> Sign) -> SignMap {
    let at = |x: u32, y: u32| [x, y].map(i64::from);
    SignMap::new(
        100,
        |x, y| sign(at(x, y)),
        |x, y| Sign::of(exact(P, Q, at(x, y)) as f64),
    )
}

fn picture(map: &SignMap, caption: &str) -> Result<Panel, Error> {
    const SIZE: f64 = 270.0;
    let mut panel = map.panel(SIZE)?.caption(caption);
    // The middle of r's square, in pixels.
    let r = (position(R) + DVec2::splat(0.5)) * (SIZE / 100.0);
    let r = DVec2::new(r.x, SIZE - r.y);
    panel.dot(
        r,
        4.0,
        Style::fill(Color::WHITE).outlined(Color::BLACK, 1.5),
    );
    panel.text(r, "r", Text::default().bold().halo().shift(-10.0, 4.0));
    Ok(panel)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The same rounding by printing with two digits, where that is no tie.
    #[test]
    fn rounding_is_to_two_digits() {
        for value in -20_000..20_000_i64 {
            let printed = format!("{:.1e}", value as f64);
            let tie = format!("{value}")
                .trim_start_matches('-')
                .get(2..)
                .is_some_and(|rest| rest.starts_with('5') && rest[1..].chars().all(|c| c == '0'));
            if !tie {
                assert_eq!(
                    Toy::of(value).value(),
                    printed.parse::<f64>().expect("a number")
                );
            }
        }
    }

    #[test]
    fn ties_go_to_even_digits() {
        for (value, rounded) in [
            (245, 240),
            (255, 260),
            (995, 1000),
            (-245, -240),
            (46_500, 46_000),
        ] {
            assert_eq!(Toy::of(value).value(), rounded as f64, "{value}");
        }
    }

    #[test]
    fn numbers_of_two_digits_are_themselves() {
        for digits in -99..100 {
            for exponent in -2..3 {
                let toy = Toy::rounded(digits, exponent);
                assert_eq!((toy.digits, toy.exponent), (digits, exponent));
            }
        }
    }
}
