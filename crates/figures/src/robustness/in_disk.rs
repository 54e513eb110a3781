//! The sign of in_disk(p, q, r, s) for 256 × 256 positions of s about the circle, by construction and by determinant.

use super::doubles;
use super::sign_map::SignMap;
use crate::{Error, Figure, Made, Paper, Run, Sheet, Verdict};
use pellicle::glam::DVec2;
use pellicle::predicates::{Sign, incircle};

pub(super) const FIGURE: Figure = Figure {
    name: "robustness-in-disk",
    paper: Paper::Robustness,
    number: "in_disk predicate",
    title: "The circle's center is a bad idea",
    shows: "warns against constructing center and radius of the circle through p, q and r: rounded, the circle goes through none of them, and what it \
            says of a fourth point s near it is random; the determinant is the predicate.",
    make,
};

/// Positions along a side.
const SIDE: u32 = 256;

/// Counter-clockwise, and nearly on a line: the center is 3,258 units away.
const CORNERS: [[f64; 2]; 3] = [[17.0, 17.0], [29.0, 29.0], [23.0, 23.015625]];

/// The unit in the last place of numbers from 16 to 32.
const UNIT: f64 = 1.0 / (1_u64 << 48) as f64;

/// The lower left corner of the window, whose middle is near the circle.
fn window() -> DVec2 {
    let corners = CORNERS.map(DVec2::from);
    // Bisection by the exact predicate along a level line, between a point on the left and one of the chord.
    let level = 20.0;
    let (mut outside, mut inside) = (19.0_f64, 20.0_f64);
    let [a, b, c] = corners;
    while inside - outside > UNIT {
        let middle = (inside + outside) / 2.0;
        match incircle(a, b, c, DVec2::new(middle, level)) {
            Sign::Negative => outside = middle,
            _ => inside = middle,
        }
    }
    let middle = DVec2::new((inside / UNIT).floor() * UNIT, level);
    middle - DVec2::splat(f64::from(SIDE / 2) * UNIT)
}

fn make(run: &Run<'_>) -> Result<Made, Error> {
    run.step("signs", 0, 1)?;
    let corners = CORNERS.map(DVec2::from);
    let corner = window();
    let at = |x: u32, y: u32| corner + UNIT * DVec2::new(f64::from(x), f64::from(y));
    let exact = |s: DVec2| incircle(corners[0], corners[1], corners[2], s);
    let mut sheet = Sheet::new(2);
    let mut numbers = Vec::new();
    let mut wrong = Vec::new();
    for (name, caption, sign) in [
        (
            "center and radius",
            "doubles: center and radius",
            &(|s| Sign::of(doubles::in_disk_by_center(corners, s))) as &dyn Fn(DVec2) -> Sign,
        ),
        (
            "determinant of four rows",
            "doubles: the determinant of rows 1, x, y, x² + y²",
            &|s| Sign::of(doubles::in_disk_of_rows(corners, s)),
        ),
        (
            "determinant, s in the origin",
            "doubles: the same, s moved into the origin",
            &|s| Sign::of(doubles::in_disk(corners, s)),
        ),
        ("exact", "pellicle::predicates::incircle", &exact),
    ] {
        let map = SignMap::new(SIDE, |x, y| sign(at(x, y)), |x, y| exact(at(x, y)));
        sheet.push(map.panel(300.0)?.caption(caption));
        numbers.extend(map.numbers(name));
        wrong.push(map.wrong);
    }
    if wrong[0] == 0 {
        return Err(Error::NotShown("center and radius are never wrong".into()));
    }
    Ok(Made {
        sheet,
        numbers,
        verdict: Verdict::Agrees,
        because: format!(
            "Of {} points s, a unit in the last place apart, {} have a wrong sign by center and radius, {} by the determinant as printed and {} by the \
             same determinant with s moved into the origin first; with exact signs none has. The circle is large, so that its center and radius \
             have fewer digits left for s than s has.",
            SIDE * SIDE,
            wrong[0],
            wrong[1],
            wrong[2]
        ),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_border_runs_through_the_window() {
        let corner = window();
        let corners = CORNERS.map(DVec2::from);
        let sign = |x: u32, y: u32| {
            let s = corner + UNIT * DVec2::new(f64::from(x), f64::from(y));
            incircle(corners[0], corners[1], corners[2], s)
        };
        // The circle rises through the window: outside is to the upper left, and along a row the sign never falls.
        assert_eq!(sign(0, SIDE - 1), Sign::Negative);
        assert_eq!(sign(SIDE - 1, 0), Sign::Positive);
        for y in 0..SIDE {
            assert!((1..SIDE).all(|x| sign(x, y) >= sign(x - 1, y)), "row {y}");
        }
    }

    #[test]
    fn the_center_is_where_it_is_said_to_be() {
        let [a, b, c] = CORNERS.map(DVec2::from);
        // The radius is the product of the sides over four times the area.
        let area = doubles::orient(a, b, c) / 2.0;
        let radius = (a - b).length() * (b - c).length() * (c - a).length() / (4.0 * area);
        assert!((radius - 3_258.348).abs() < 1e-3, "{radius}");
    }

    #[test]
    fn every_position_is_a_double_of_its_own() {
        let corner = window();
        for i in 1..SIDE {
            let [a, b] = [i - 1, i].map(|i| corner + DVec2::splat(f64::from(i) * UNIT));
            assert_eq!(b - a, DVec2::splat(UNIT));
        }
    }
}
