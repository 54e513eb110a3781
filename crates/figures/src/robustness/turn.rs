//! Turning around a vertex from triangle to triangle: with a wrong sign the start never comes again.

use super::doubles;
use super::toy::{self, Point};
use crate::sheet::{Color, Panel, Style, Text};
use crate::{Error, Figure, Made, Number, Paper, Run, Sheet, Verdict};
use pellicle::glam::DVec2;
use pellicle::predicates::{Sign, orient2d};

pub(super) const FIGURE: Figure = Figure {
    name: "robustness-turn",
    paper: Paper::Robustness,
    number: "turn around a vertex",
    title: "A turn around a vertex that does not end",
    shows: "goes around v through the triangles vpq, each entered over vp and left over qv, until the first one comes again; with a \
            rounded orientation it never does: LOOP.",
    make,
};

/// A vertex v, and its neighbours in counter-clockwise order.
struct Star {
    v: DVec2,
    ring: Vec<DVec2>,
}

/// The triangles in the order of the turn, and whether it came back to the first.
struct Turn {
    visited: Vec<usize>,
    ends: bool,
}

/// Triangle i has v and the neighbours i and i + 1, and knows no order of them: the sign of vab tells which is p.
fn turn(star: &Star, start: usize, sign: impl Fn(DVec2, DVec2, DVec2) -> Sign) -> Turn {
    let count = star.ring.len();
    let mut visited = vec![start];
    let mut seen = vec![false; count];
    seen[start] = true;
    let mut triangle = start;
    loop {
        let (a, b) = (triangle, (triangle + 1) % count);
        let counter_clockwise = sign(star.v, star.ring[a], star.ring[b]) == Sign::Positive;
        // Over the edge qv: the next triangle, or, if q is taken for p, the one before.
        triangle = if counter_clockwise {
            b
        } else {
            (a + count - 1) % count
        };
        visited.push(triangle);
        if triangle == start {
            return Turn {
                visited,
                ends: true,
            };
        }
        // What follows depends on the triangle alone, so that from now on it is repeated.
        if std::mem::replace(&mut seen[triangle], true) {
            return Turn {
                visited,
                ends: false,
            };
        }
    }
}

/// Neighbours for which v, the first and the second make the widest triangle that two digits turn around: 3.8 degrees.
const V: Point = [-60, -60];
const RING: [Point; 5] = [[54, 55], [66, 85], [-70, 80], [-99, -70], [20, -95]];

fn of_two_digits() -> Star {
    Star {
        v: toy::position(V),
        ring: RING.map(toy::position).to_vec(),
    }
}

fn toy_sign(a: DVec2, b: DVec2, c: DVec2) -> Sign {
    let [a, b, c] = [a, b, c].map(|p| [p.x as i64, p.y as i64]);
    toy::orientation(a, b, c).result.sign()
}

fn plain(a: DVec2, b: DVec2, c: DVec2) -> Sign {
    Sign::of(doubles::orient(a, b, c))
}

/// The first point of the orientation picture for which doubles take left for right, as v between neighbours on the diagonal.
fn of_doubles() -> Result<Star, Error> {
    let unit = 1.0 / (1_u64 << 53) as f64;
    let [a, b] = [DVec2::splat(12.0), DVec2::splat(24.0)];
    let grid = (0..256 * 256).map(|i| [i % 256, i / 256].map(f64::from));
    let v = grid
        .map(|[x, y]| DVec2::new(0.5 + x * unit, 0.5 + y * unit))
        .find(|&v| orient2d(v, a, b) == Sign::Positive && plain(v, a, b) == Sign::Negative)
        .ok_or_else(|| Error::NotShown("doubles never take left for right".into()))?;
    let others = [[-4.0, 20.0], [-18.0, 2.0], [16.0, -14.0]];
    let ring = [a, b].into_iter().chain(others.map(DVec2::from)).collect();
    Ok(Star { v, ring })
}

fn make(_: &Run<'_>) -> Result<Made, Error> {
    let [toy_star, double_star] = [of_two_digits(), of_doubles()?];
    // Three triangles before the one whose sign is wrong.
    const START: usize = 2;
    let cases = [
        (
            "exact",
            "pellicle::predicates::orient2d",
            &toy_star,
            turn(&toy_star, START, orient2d),
        ),
        (
            "two digits",
            "two digits: v, 0, 1 is taken for clockwise",
            &toy_star,
            turn(&toy_star, START, toy_sign),
        ),
        (
            "doubles",
            "doubles: so is v, 0, 1 here, far narrower",
            &double_star,
            turn(&double_star, START, plain),
        ),
    ];
    let exact_of_doubles = turn(&double_star, START, orient2d);
    let mut sheet = Sheet::new(3);
    let mut numbers = Vec::new();
    for (name, caption, star, turn) in &cases {
        sheet.push(picture(star, turn).caption(*caption));
        numbers.push(Number::exactly(
            format!("the turn ends, {name}"),
            f64::from(u8::from(turn.ends)),
        ));
        numbers.push(Number::exactly(
            format!("triangles until then, {name}"),
            (turn.visited.len() - 1) as f64,
        ));
    }
    // Exactly 12 (y − x) is the determinant of v = (x, y), (12, 12) and (24, 24).
    let narrow = 12.0 * (double_star.v.y - double_star.v.x);
    for (name, star, determinant) in [
        (
            "two digits",
            &toy_star,
            toy::exact(V, RING[0], RING[1]) as f64,
        ),
        ("doubles", &double_star, narrow),
    ] {
        let lengths = (star.ring[0] - star.v).length() * (star.ring[1] - star.v).length();
        let degrees = (determinant / lengths).to_degrees();
        numbers.push(
            Number::within(
                format!("angle of the triangle in question, {name}"),
                degrees,
                1e-12,
            )
            .unit("°"),
        );
    }
    if cases[1].3.ends || cases[2].3.ends {
        return Err(Error::NotShown("a turn with wrong signs ends".into()));
    }
    let better = cases[0].3.ends && exact_of_doubles.ends;
    Ok(Made {
        sheet,
        numbers,
        verdict: if better { Verdict::Better } else { Verdict::Different },
        because: "One triangle taken for clockwise is left over the edge over which it was entered, and the turn goes to and fro for ever; \
                  what follows depends on the triangle alone, so the first repetition proves it. With two digits the triangle \
                  is 3.8 degrees wide, with doubles it is one of the points of the orientation picture. With exact signs both \
                  turns end after five triangles."
            .into(),
    })
}

fn picture(star: &Star, turn: &Turn) -> Panel {
    let corners = star.ring.iter().copied().chain([star.v]);
    let [min, max] = corners.fold([DVec2::INFINITY, DVec2::NEG_INFINITY], |[min, max], p| {
        [min.min(p), max.max(p)]
    });
    let room = DVec2::splat(0.08 * (max - min).max_element());
    let mut panel = Panel::plane(300.0, 300.0, min - room, max + room);
    let count = star.ring.len();
    let corners = |i: usize| [star.v, star.ring[i], star.ring[(i + 1) % count]];
    for i in 0..count {
        let fill = match (i == turn.visited[0], turn.ends) {
            (true, _) => Color::SKY.mixed(Color::WHITE, 0.5),
            (false, false) if turn.visited[turn.visited.len() - 3..].contains(&i) => {
                Color::ORANGE.mixed(Color::WHITE, 0.4)
            }
            _ => Color::WHITE,
        };
        panel.polygon(&corners(i), Style::fill(fill).outlined(Color::GRAY, 1.2));
    }
    // Arrows from the inside of a triangle to that of the next one, each further out.
    let inside = |i: usize, share: f64| {
        let [v, a, b] = corners(i);
        v + ((a + b) / 2.0 - v) * share
    };
    let mut share = 0.42;
    for pair in turn.visited.windows(2) {
        let style = if turn.ends {
            Color::GREEN
        } else {
            Color::VERMILION
        };
        panel.arrow(
            inside(pair[0], share),
            inside(pair[1], share + 0.07),
            0.0,
            Style::stroke(style, 2.0),
        );
        share += 0.07;
    }
    panel.text(
        inside(turn.visited[0], 0.75),
        "t₀",
        Text::default().size(15.0).bold().halo(),
    );
    panel.dot(star.v, 4.0, Style::fill(Color::BLACK));
    panel.text(
        star.v,
        "v",
        Text::default().bold().halo().shift(-10.0, 12.0),
    );
    for (i, &neighbour) in star.ring.iter().enumerate() {
        let outward = (panel.place(neighbour) - panel.place(star.v)).normalize_or_zero() * 12.0;
        let text = Text::default().halo().shift(outward.x, outward.y + 4.0);
        panel.text(neighbour, &i.to_string(), text);
    }
    panel
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_stars_are_what_they_should_be() {
        for star in [of_two_digits(), of_doubles().expect("a star")] {
            let count = star.ring.len();
            for i in 0..count {
                let [a, b] = [star.ring[i], star.ring[(i + 1) % count]];
                assert_eq!(orient2d(star.v, a, b), Sign::Positive, "{i}");
            }
            // Once around: the angles sum up to a full turn.
            let angle = |i: usize| {
                let [a, b] = [star.ring[i] - star.v, star.ring[(i + 1) % count] - star.v];
                a.perp_dot(b).atan2(a.dot(b))
            };
            let sum: f64 = (0..count).map(angle).sum();
            assert!((sum - std::f64::consts::TAU).abs() < 1e-9, "{sum}");
        }
    }

    #[test]
    fn only_the_first_triangle_is_turned_around() {
        let star = of_two_digits();
        for i in 0..star.ring.len() {
            let sign = toy_sign(star.v, star.ring[i], star.ring[(i + 1) % star.ring.len()]);
            assert_eq!(sign == Sign::Negative, i == 0, "{i}");
        }
    }
}
