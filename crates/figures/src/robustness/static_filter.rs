//! The error of an orientation in doubles against the bound 2⁻⁴⁸ M², and what a filter with that bound decides.

use super::doubles;
use crate::sheet::{Axis, Color, Plot, Series};
use crate::{Error, Figure, Made, Number, Paper, Random, Run, Sheet, Verdict};
use pellicle::glam::DVec2;
use pellicle::predicates::{Sign, orient2d};

pub(super) const FIGURE: Figure = Figure {
    name: "robustness-static-filter",
    paper: Paper::Robustness,
    number: "static filtering",
    title: "The static filter's bound",
    shows: "derives that the orientation of points with coordinates up to M, in doubles, is off by at most 2⁻⁴⁸ M²: a sign beyond that is sure.",
    make,
};

/// M = 1.
const BOUND: f64 = 1.0 / (1_u64 << 48) as f64;

/// Coordinates are multiples of 2⁻⁵², so that the determinant is one of 2⁻¹⁰⁴.
const STEPS: f64 = (1_u64 << 52) as f64;

fn random_point(random: &mut Random) -> DVec2 {
    let mut coordinate = || 2.0 * random.unit() - 1.0;
    DVec2::new(coordinate(), coordinate())
}

/// The determinant in units of 2⁻¹⁰⁴.
fn exact(points: [DVec2; 3]) -> i128 {
    let [p, q, r] = points.map(|point| point.to_array().map(|c| (c * STEPS) as i128));
    (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])
}

/// How far doubles are off, exactly but for one rounding at the end.
fn error(points @ [p, q, r]: [DVec2; 3]) -> f64 {
    // A multiple of the unit: rounding makes no smaller digits.
    let rounded = (doubles::orient(p, q, r) * STEPS * STEPS) as i128;
    (rounded - exact(points)).unsigned_abs() as f64 / STEPS / STEPS
}

/// Of points at one distance from a line, how many does the filter decide, and for how many are doubles right.
struct Near {
    sure: u32,
    right: u32,
    /// Sure, and wrong.
    lies: u32,
}

/// r is put between p and q and then moved off their line by `distance`, up to the rounding of its coordinates.
fn near(random: &mut Random, distance: f64, trials: u32) -> Near {
    let mut near = Near {
        sure: 0,
        right: 0,
        lies: 0,
    };
    for _ in 0..trials {
        let [p, q] = [random_point(random), random_point(random)];
        let side = if random.bits() & 1 == 1 {
            distance
        } else {
            -distance
        };
        let r = p + (q - p) * random.unit() + (q - p).perp().normalize_or_zero() * side;
        let value = doubles::orient(p, q, r);
        let right = Sign::of(value) == orient2d(p, q, r);
        let sure = value.abs() > BOUND;
        near.sure += u32::from(sure);
        near.right += u32::from(right);
        near.lies += u32::from(sure && !right);
    }
    near
}

fn make(run: &Run<'_>) -> Result<Made, Error> {
    let trials = run.effort.pick(100_000_u64, 4_000_000);
    let mut random = Random::new(1, 4);
    let mut largest = 0.0_f64;
    for done in 0..trials {
        if done % 10_000 == 0 {
            run.step("errors", done, trials)?;
        }
        largest = largest.max(error([(); 3].map(|()| random_point(&mut random))));
    }
    let share = largest / BOUND;
    let mut numbers = vec![
        Number::exactly("random triples", trials as f64),
        Number::exactly("largest error, in units of M²", largest).paper("at most 2⁻⁴⁸ = 3.55e−15"),
        Number::exactly("largest error, share of the bound", 100.0 * share).unit("%"),
    ];
    let per_distance = run.effort.pick(500, 20_000);
    let (mut sure, mut right, mut lies) = (Vec::new(), Vec::new(), 0);
    for (power, decade) in [
        (-17, 1e-17),
        (-16, 1e-16),
        (-15, 1e-15),
        (-14, 1e-14),
        (-13, 1e-13),
    ] {
        for part in [1.0, 1.78, 3.16, 5.62] {
            let distance = decade * part;
            let near = near(&mut random, distance, per_distance);
            let share = |count: u32| 100.0 * f64::from(count) / f64::from(per_distance);
            sure.push(DVec2::new(distance, share(near.sure)));
            right.push(DVec2::new(distance, share(near.right)));
            lies += near.lies;
            if part == 1.0 {
                let place = format!("10^{power} from the line");
                numbers.push(
                    Number::exactly(format!("the filter is sure, {place}"), share(near.sure))
                        .unit("%"),
                );
                numbers.push(
                    Number::exactly(format!("doubles are right, {place}"), share(near.right))
                        .unit("%"),
                );
            }
        }
    }
    numbers.push(Number::exactly("sure and wrong", f64::from(lies)));
    let plot = Plot::new(
        Axis::new("distance of r from the line pq, in units of M").logarithmic(),
        Axis::new("signs, %").range(0.0, 105.0),
    )
    .with(
        Series::line("doubles are right", right)
            .marked()
            .color(Color::BLUE),
    )
    .with(
        Series::line("the filter is sure", sure)
            .marked()
            .color(Color::GREEN),
    );
    Ok(Made {
        sheet: Sheet::new(1).with(
            plot.panel(560.0, 360.0)
                .caption(format!("{per_distance} random lines at each distance")),
        ),
        numbers,
        verdict: if largest <= BOUND && lies == 0 {
            Verdict::Agrees
        } else {
            Verdict::Different
        },
        because: format!(
            "The largest error of {trials} random triples, measured with integers, is {:.0} % of the bound; the filter is never sure and wrong. Beyond \
             10⁻¹⁴ M from the line it is nearly always sure; nearer, it leaves alone what doubles still mostly get right: that is the price of one \
             comparison.",
            100.0 * share
        ),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn integers_give_the_sign_of_the_exact_predicate() {
        let mut random = Random::new(9, 0);
        for i in 0..10_000 {
            let [p, q, mut r] = [(); 3].map(|()| random_point(&mut random));
            if i % 2 == 0 {
                // The middle of p and q, cut off to a multiple of the unit: close to the line.
                r = ((p + q) / 2.0 * STEPS).floor() / STEPS;
            }
            let sign = exact([p, q, r]).signum();
            assert_eq!(sign, i128::from(orient2d(p, q, r) as i8));
        }
    }

    #[test]
    fn an_error_that_is_known_is_measured() {
        // (1 + u)² with u = 2⁻⁵²: the square of u is lost, and nothing else.
        let p = DVec2::ZERO;
        let points = [
            p,
            DVec2::new(1.0 + 1.0 / STEPS, 0.0),
            DVec2::new(0.0, 1.0 + 1.0 / STEPS),
        ];
        assert_eq!(error(points), 1.0 / STEPS / STEPS);
    }
}
