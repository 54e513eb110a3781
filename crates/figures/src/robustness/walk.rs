//! The visibility walk to a point, from triangle to triangle: with rounded signs it goes around in circles.

use super::doubles;
use super::planar::{Planar, Triangle, edges, far_corners};
use crate::sheet::{Axis, Color, Panel, Plot, Sampling, Series, Style, Text};
use crate::{Error, Figure, Made, Number, Paper, Random, Run, Sheet, Verdict};
use pellicle::glam::DVec2;
use pellicle::predicates::{Sign, orient2d};
use pellicle::render::Image;
use std::collections::BTreeMap;

pub(super) const FIGURE: Figure = Figure {
    name: "robustness-walk",
    paper: Paper::Robustness,
    number: "visibility walk",
    title: "A walk that goes around in circles",
    shows: "states that the visibility walk, which goes over any edge that has the query on its other side, may have cycles with \
            rounded signs, even in a Delaunay triangulation.",
    make,
};

type Orientation = fn(DVec2, DVec2, DVec2) -> Sign;

fn as_printed(a: DVec2, b: DVec2, q: DVec2) -> Sign {
    Sign::of(doubles::orient_of_rows(a, b, q))
}

fn by_differences(a: DVec2, b: DVec2, q: DVec2) -> Sign {
    Sign::of(doubles::orient(a, b, q))
}

/// How a walk ends.
enum End {
    /// No edge has the query on its other side.
    At(Triangle),
    /// It comes back to where it was; the triangles between.
    Cycle(Vec<Triangle>),
}

/// A Delaunay triangulation, by exact signs.
struct Ground {
    points: Vec<DVec2>,
    planar: Planar,
    sides: BTreeMap<[usize; 2], Triangle>,
}

impl Ground {
    /// Random multiples of 2⁻²⁰ in the unit square, which stay exact when they are moved by `offset`.
    fn new(seed: u64, offset: f64) -> Self {
        let mut random = Random::new(seed, 0);
        let mut points = far_corners(DVec2::splat(0.5), 0.5).to_vec();
        points.extend((0..POINTS).map(|_| on_lattice(DVec2::new(random.unit(), random.unit()))));
        let points: Vec<DVec2> = points.iter().map(|&p| p + DVec2::splat(offset)).collect();
        let planar = Planar::delaunay(&points);
        let sides = planar.sides();
        Self {
            points,
            planar,
            sides,
        }
    }

    fn holds(&self, t: Triangle, query: DVec2) -> bool {
        let left =
            |[a, b]: [usize; 2]| orient2d(self.points[a], self.points[b], query) != Sign::Negative;
        edges(t).into_iter().all(left)
    }

    /// Walks from the first triangle to `query`: over the first edge that has the query on its other side. Each step depends on
    /// the triangle alone, so that what repeats once repeats for ever.
    fn walk(&self, query: DVec2, sign: Orientation) -> End {
        let mut path = vec![self.planar.triangles[0]];
        loop {
            let at = path[path.len() - 1];
            let beyond = edges(at).into_iter().find_map(|[a, b]| {
                let crossed = sign(self.points[a], self.points[b], query) == Sign::Negative;
                crossed.then(|| self.sides.get(&[b, a])).flatten()
            });
            let Some(&next) = beyond else {
                return End::At(at);
            };
            match path.iter().position(|&before| before == next) {
                Some(first) => return End::Cycle(path.split_off(first)),
                None => path.push(next),
            }
        }
    }

    /// The area of the smallest triangle of a cycle: how well it can be seen. Nothing if it goes far away.
    fn clarity(&self, cycle: &[Triangle]) -> f64 {
        let area = |t: &Triangle| {
            let [a, b, c] = t.map(|i| self.points[i]);
            (b - a).perp_dot(c - a)
        };
        if cycle.iter().flatten().any(|&corner| corner < 3) {
            return 0.0;
        }
        cycle.iter().map(area).fold(f64::INFINITY, f64::min)
    }
}

fn on_lattice(point: DVec2) -> DVec2 {
    let steps = f64::from(1 << 20);
    (point * steps).floor() / steps
}

const POINTS: usize = 24;

/// How the walks to a square of queries end.
struct Outcomes {
    image: Image,
    wrong: u32,
    cycles: u32,
    /// Triangles in the longest cycle.
    longest: usize,
    /// The query whose cycle, of at least four triangles, is seen best, and the cycle.
    clearest: Option<(DVec2, Vec<Triangle>)>,
    clarity: f64,
}

/// Walks to `side` × `side` queries, evenly over the unit square moved by `offset`.
fn outcomes(ground: &Ground, offset: f64, side: u32, sign: Orientation) -> Outcomes {
    let mut outcomes = Outcomes {
        image: Image {
            width: side,
            height: side,
            pixels: Vec::new(),
        },
        wrong: 0,
        cycles: 0,
        longest: 0,
        clearest: None,
        clarity: 0.0,
    };
    for y in (0..side).rev() {
        for x in 0..side {
            let place =
                (DVec2::new(f64::from(x), f64::from(y)) + DVec2::splat(0.5)) / f64::from(side);
            let query = on_lattice(place) + DVec2::splat(offset);
            let color = match ground.walk(query, sign) {
                End::At(t) if ground.holds(t, query) => ARRIVES.mixed(Color::WHITE, 0.5),
                End::At(_) => {
                    outcomes.wrong += 1;
                    ELSEWHERE
                }
                End::Cycle(cycle) => {
                    outcomes.cycles += 1;
                    outcomes.longest = outcomes.longest.max(cycle.len());
                    let clarity = ground.clarity(&cycle);
                    if cycle.len() > 3 && clarity > outcomes.clarity {
                        (outcomes.clearest, outcomes.clarity) = (Some((query, cycle)), clarity);
                    }
                    CYCLES
                }
            };
            let [red, green, blue] = color.0;
            outcomes.image.pixels.push([red, green, blue, 255]);
        }
    }
    outcomes
}

const ARRIVES: Color = Color::GREEN;
const ELSEWHERE: Color = Color::YELLOW;
const CYCLES: Color = Color::VERMILION;

/// Where the picture is taken, in widths of the cloud from the origin.
const OFFSET: f64 = 1e7;

/// Among the first seeds the one whose clearest cycle is clearest, on a coarse square.
fn search(run: &Run<'_>) -> Result<u64, Error> {
    const SEEDS: u64 = 100;
    let mut best = (0.0, 0);
    for seed in 0..SEEDS {
        run.step("search for cycles", seed, SEEDS)?;
        let clarity = outcomes(&Ground::new(seed, OFFSET), OFFSET, SIDE, as_printed).clarity;
        if clarity > best.0 {
            best = (clarity, seed);
        }
    }
    match best {
        (0.0, _) => Err(Error::NotShown("no walk has a cycle".into())),
        (_, seed) => Ok(seed),
    }
}

/// Queries along a side of the square.
const SIDE: u32 = 64;

fn make(run: &Run<'_>) -> Result<Made, Error> {
    let seed = search(run)?;
    let ground = Ground::new(seed, OFFSET);
    let mut numbers = vec![Number::exactly("seed of the points", seed as f64)];
    let mut maps = Vec::new();
    let mut found = Vec::new();
    for (name, caption, sign) in [
        (
            "printed",
            "the printed determinant, in doubles",
            as_printed as Orientation,
        ),
        ("exact", "pellicle::predicates::orient2d", orient2d),
    ] {
        let outcomes = outcomes(&ground, OFFSET, SIDE, sign);
        for (what, count) in [
            ("walks that cycle", outcomes.cycles),
            ("walks that end elsewhere", outcomes.wrong),
        ] {
            numbers.push(Number::exactly(format!("{what}, {name}"), f64::from(count)));
        }
        maps.push(map(&outcomes, caption)?);
        found.push(outcomes);
    }
    numbers.push(Number::exactly("longest cycle", found[0].longest as f64).unit("triangles"));
    let Some((query, cycle)) = &found[0].clearest else {
        return Err(Error::NotShown("no walk has a cycle".into()));
    };
    let (plot, [exact_failures, translated_failures]) = by_distance(run, &mut numbers)?;
    let mut sheet = Sheet::new(2).with(picture(&ground, *query, cycle));
    for map in maps {
        sheet.push(map);
    }
    sheet.push(plot);
    let all_arrive = found[1].cycles + found[1].wrong + exact_failures == 0;
    Ok(Made {
        sheet,
        numbers,
        verdict: if all_arrive {
            Verdict::Better
        } else {
            Verdict::Different
        },
        because: format!(
            "The triangulation is Delaunay, by exact signs; the walk evaluates the printed determinant of three rows in doubles, on a cloud one unit \
             wide and {OFFSET} units from the origin. {} of {} walks cycle, around up to {} triangles, and {} end in a triangle that does not \
             hold the query. With exact signs all arrive, here and at every other distance. The determinant of two rows leads {} of them astray: \
             its differences are exact here.",
            found[0].cycles,
            SIDE * SIDE,
            found[0].longest,
            found[0].wrong,
            translated_failures,
        ),
    })
}

/// Shares of walks that cycle, by the distance from the origin; and how many exact ones, and how many by two rows, do not arrive.
fn by_distance(run: &Run<'_>, numbers: &mut Vec<Number>) -> Result<(Panel, [u32; 2]), Error> {
    let seeds = run.effort.pick(3, 20);
    let mut series = [
        ("printed", as_printed as Orientation),
        ("differences", by_differences),
        ("exact", orient2d),
    ]
    .map(|(name, sign)| (name, sign, Vec::new()));
    let (mut failures, mut translated_failures) = (0, 0);
    for power in 3..=9 {
        run.step("distances", power - 3, 7)?;
        let offset = 10_f64.powi(power as i32);
        let grounds: Vec<Ground> = (0..seeds).map(|seed| Ground::new(seed, offset)).collect();
        for (name, sign, points) in &mut series {
            let (mut cycles, mut wrong) = (0, 0);
            for ground in &grounds {
                let outcomes = outcomes(ground, offset, 32, *sign);
                cycles += outcomes.cycles;
                wrong += outcomes.wrong;
            }
            let share = 100.0 * f64::from(cycles) / (seeds * 32 * 32) as f64;
            points.push(DVec2::new(offset, share));
            match *name {
                "exact" => failures += cycles + wrong,
                "differences" => translated_failures += cycles + wrong,
                _ => numbers.push(
                    Number::exactly(
                        format!("walks that cycle, 10^{power} from the origin"),
                        share,
                    )
                    .unit("%"),
                ),
            }
        }
    }
    numbers.push(Number::exactly(
        "walks that do not arrive at any distance, exact",
        f64::from(failures),
    ));
    numbers.push(Number::exactly(
        "walks that do not arrive at any distance, determinant of two rows",
        f64::from(translated_failures),
    ));
    let mut plot = Plot::new(
        Axis::new("distance from the origin, in widths of the cloud").logarithmic(),
        Axis::new("walks that cycle, %"),
    );
    for ((_, _, points), name) in
        series
            .into_iter()
            .zip(["printed determinant", "differences first", "exact"])
    {
        plot = plot.with(Series::line(name, points).marked());
    }
    Ok((
        plot.panel(SIZE, SIZE)
            .caption(format!("{} walks each", seeds * 32 * 32)),
        [failures, translated_failures],
    ))
}

const SIZE: f64 = 360.0;

fn map(outcomes: &Outcomes, caption: &str) -> Result<Panel, Error> {
    let size = DVec2::splat(SIZE);
    let mut panel = Panel::pixels(size.x, size.y).caption(caption);
    panel.picture(DVec2::ZERO, size, &outcomes.image, Sampling::Squares)?;
    let rim = |color| Style::fill(color).outlined(Color::BLACK, 0.7);
    let entries = [
        (rim(ARRIVES.mixed(Color::WHITE, 0.5)), "arrives"),
        (rim(ELSEWHERE), "ends elsewhere"),
        (rim(CYCLES), "cycles"),
    ];
    panel.legend(DVec2::new(8.0, 8.0), &entries);
    Ok(panel)
}

fn picture(ground: &Ground, query: DVec2, cycle: &[Triangle]) -> Panel {
    let origin = DVec2::splat(OFFSET);
    let mut panel = Panel::plane(SIZE, SIZE, origin, origin + DVec2::ONE).caption(format!(
        "a cycle of {} triangles; the query is the blue point",
        cycle.len()
    ));
    for &t in &ground.planar.triangles {
        let fill = if cycle.contains(&t) {
            Color::ORANGE.mixed(Color::WHITE, 0.6)
        } else {
            Color::WHITE
        };
        panel.polygon(
            &t.map(|i| ground.points[i]),
            Style::fill(fill).outlined(Color::GRAY, 0.8),
        );
    }
    let middle = |t: Triangle| t.iter().map(|&i| ground.points[i]).sum::<DVec2>() / 3.0;
    for (i, &t) in cycle.iter().enumerate() {
        let next = cycle[(i + 1) % cycle.len()];
        panel.arrow(
            middle(t),
            middle(next),
            0.0,
            Style::stroke(Color::VERMILION, 1.8),
        );
    }
    panel.dot(
        query,
        4.5,
        Style::fill(Color::BLUE).outlined(Color::WHITE, 1.0),
    );
    panel.text(
        query,
        "q",
        Text::default()
            .bold()
            .color(Color::BLUE)
            .halo()
            .shift(9.0, -6.0),
    );
    panel
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cycle_is_one() {
        let run = Run {
            effort: crate::Effort::Quick,
            progress: &(),
        };
        let ground = Ground::new(search(&run).expect("a seed"), OFFSET);
        let found = outcomes(&ground, OFFSET, SIDE, as_printed);
        let (query, cycle) = found.clearest.expect("a cycle");
        assert!(cycle.len() > 3);
        // Each step is over a common edge that doubles have the query behind, and by exact signs not all can be right.
        let mut lies = 0;
        for (i, t) in cycle.iter().enumerate() {
            let next = cycle[(i + 1) % cycle.len()];
            let [a, b] = edges(*t)
                .into_iter()
                .find(|&[a, b]| edges(next).contains(&[b, a]))
                .expect("a common edge")
                .map(|i| ground.points[i]);
            assert_eq!(as_printed(a, b, query), Sign::Negative);
            lies += usize::from(orient2d(a, b, query) != Sign::Negative);
        }
        assert!(lies > 0);
    }
}
