//! The sign of orient(p, q, r) for 256 × 256 positions of p about a line, one unit in the last place apart.
//!
//! p = (0.5 + x·u, 0.5 + y·u) with 0 ≤ x, y < 256 and u = 2⁻⁵³; q = (12, 12); r = (24, 24). The line through q and r is
//! the diagonal, so that the true sign is that of y − x.

use super::doubles;
use super::sign_map::SignMap;
use crate::{Error, Figure, Made, Paper, Run, Sheet, Verdict};
use pellicle::glam::DVec2;
use pellicle::predicates::{Sign, orient2d};

pub(super) const FIGURE: Figure = Figure {
    name: "robustness-orientation",
    paper: Paper::Robustness,
    number: "orientation predicate with double",
    title: "The sign of an orientation near a line",
    shows: "draws the sign of orient(p, q, r), evaluated with doubles, for 256 × 256 points p one unit in the last place \
            apart: three colours, and instead of one straight border blocks of all three.",
    make,
};

/// Points along a side.
const SIDE: u32 = 256;

/// The unit in the last place of numbers from a half to one.
const UNIT: f64 = 1.0 / (1_u64 << 53) as f64;

const Q: DVec2 = DVec2::splat(12.0);
const R: DVec2 = DVec2::splat(24.0);

/// The sign that is right: p is to the left of the diagonal from q to r when y is larger than x.
fn truth(x: u32, y: u32) -> Sign {
    match y.cmp(&x) {
        std::cmp::Ordering::Greater => Sign::Positive,
        std::cmp::Ordering::Equal => Sign::Zero,
        std::cmp::Ordering::Less => Sign::Negative,
    }
}

/// What one formula says about all points.
fn map(sign: &dyn Fn(DVec2) -> Sign) -> SignMap {
    let at = |x: u32, y: u32| DVec2::splat(0.5) + UNIT * DVec2::new(f64::from(x), f64::from(y));
    SignMap::new(SIDE, |x, y| sign(at(x, y)), truth)
}

/// The same for quick and full: it takes milliseconds.
fn make(run: &Run<'_>) -> Result<Made, Error> {
    run.step("signs", 0, 1)?;
    let mut sheet = Sheet::new(3);
    let mut numbers = Vec::new();
    let mut wrong = Vec::new();
    for (name, caption, sign) in [
        (
            "doubles",
            "doubles: (q − p) × (r − p), as the slides print it",
            &(|p| Sign::of(doubles::orient(p, Q, R))) as &dyn Fn(DVec2) -> Sign,
        ),
        (
            "doubles, from r",
            "doubles: (p − r) × (q − r), the same determinant",
            &|p| Sign::of(doubles::orient(R, p, Q)),
        ),
        ("exact", "pellicle::predicates::orient2d", &|p| {
            orient2d(p, Q, R)
        }),
    ] {
        let map = map(sign);
        sheet.push(map.panel(300.0)?.caption(caption));
        numbers.extend(map.numbers(name));
        wrong.push(map.wrong);
    }
    if wrong[0] == 0 {
        return Err(Error::NotShown("plain doubles are never wrong".into()));
    }
    Ok(Made {
        sheet,
        numbers,
        verdict: if wrong[2] == 0 {
            Verdict::Better
        } else {
            Verdict::Different
        },
        because: format!(
            "Plain doubles give the slide's blocks: {} of 65536 signs are wrong, and another order of the same operations gives other blocks. The \
             exact predicate gives one straight border, one point wide, and is wrong {} times.",
            wrong[0], wrong[2]
        ),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// All coordinates are multiples of u below 2⁵⁸·u, so that their determinant fits 128 bits.
    fn by_integers(p: [i128; 2]) -> i128 {
        let scaled = |value: i128| value << 53;
        let [q, r] = [scaled(12), scaled(24)];
        (q - p[0]) * (r - p[1]) - (q - p[1]) * (r - p[0])
    }

    #[test]
    fn the_truth_is_that_of_integers() {
        for y in 0..SIDE {
            for x in 0..SIDE {
                let p = [x, y].map(|i| (1_i128 << 52) + i128::from(i));
                let sign = match by_integers(p).signum() {
                    1 => Sign::Positive,
                    0 => Sign::Zero,
                    _ => Sign::Negative,
                };
                assert_eq!(sign, truth(x, y), "{x} {y}");
            }
        }
    }

    #[test]
    fn every_position_is_a_double_of_its_own() {
        let position = |i: u32| 0.5 + UNIT * f64::from(i);
        for i in 1..SIDE {
            assert_eq!(position(i), position(i - 1).next_up());
        }
    }

    #[test]
    fn the_picture_has_the_signs() {
        let exact = map(&|p| orient2d(p, Q, R));
        assert_eq!((exact.wrong, exact.zero), (0, SIDE));
        // Upper left: y large, x small.
        assert_eq!(
            exact.image.pixels[0][..3],
            super::super::sign_map::color(Sign::Positive).0
        );
    }
}
