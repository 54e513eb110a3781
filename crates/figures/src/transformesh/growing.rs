//! Figure 2: the valid region grows.

use super::toy::RED;
use super::watch::{Seen, TIP, double_cone, is_clean, repaired, section};
use crate::sheet::{Anchor, Color, Panel, Style, Text};
use crate::{Error, Made, Number, Run, Sheet, Verdict};
use pellicle::glam::DVec2;
use pellicle::mesh::TriangleId;
use pellicle::prelude::*;
use pellicle::transformesh::{Piece, Rule};
use std::f64::consts::TAU;

/// The plane of the picture, a little above the curve's own.
const HEIGHT: f64 = 0.02 * TIP;

/// A body that has grown until its waist moved through itself, above and below.
pub fn make(run: &Run) -> Result<Made, Error> {
    let curve = grown_peanut();
    let soup = double_cone(&curve);
    run.step("repair", 0, 1)?;
    let (mesh, report, seen) = repaired(&soup, Rule::Outside)?;
    // The states between which V is empty.
    let first_partial = seen.grown.iter().position(|piece| seen.is_partial(piece));
    let first =
        first_partial.ok_or_else(|| Error::NotShown("a partially valid triangle".into()))?;
    let pieces = seen.grown[first..]
        .iter()
        .take_while(|piece| seen.is_partial(piece))
        .count();
    let last = seen.grown.len();
    let elements = |taken: &[Piece]| taken.iter().filter_map(shown).count();
    let mut sheet = Sheet::new(5);
    for (taken, letter, words) in [
        (
            0,
            "a",
            "All elements are non-visited; the circles are self-intersections.",
        ),
        (1, "b", "The seed, whose normal meets nothing."),
        (
            first,
            "c",
            "V is empty: all valid elements reached from the seed. Partially valid ones wait in P (blue).",
        ),
        (
            first + pieces,
            "d",
            "P is empty: each was entered, left at the crossing, and continued on the other sheet.",
        ),
        (
            last,
            "e",
            "The end: the outside. What lies inside was never reached.",
        ),
    ] {
        let panel = state(&soup, &seen, &curve, taken, taken == first);
        sheet.push(panel.caption(format!("({letter}) {words}")));
    }
    let clean = is_clean(&mesh)?;
    let holds = clean && report.components == [1, 1] && seen.seeds.len() == 1;
    Ok(Made {
        sheet,
        numbers: vec![
            Number::exactly("elements of the curve", curve.len() as f64),
            Number::exactly("elements that cross others", (seen.cut.keys().filter(|t| is_upper(**t)).count()) as f64),
            Number::exactly("seeds", seen.seeds.len() as f64),
            Number::exactly("(b): elements taken", elements(&seen.grown[..1]) as f64),
            Number::exactly("(c): elements taken", elements(&seen.grown[..first]) as f64),
            Number::exactly("(d): elements taken", elements(&seen.grown[..first + pieces]) as f64),
            Number::exactly("(e): elements taken", elements(&seen.grown) as f64),
            Number::exactly("triangles of the result", mesh.triangles().len() as f64),
        ],
        verdict: if holds { Verdict::Agrees } else { Verdict::Different },
        because: "The view is not simplified: the mesh is a double cone over the curve, every triangle of its upper half is one \
                  element of the picture, and the states are those of the algorithm on the mesh. The region is grown over what \
                  exact winding numbers keep, so the seed needs no test of its normal."
            .into(),
    })
}

/// A peanut, moved outwards along its normals by more than its waist is bent: there it crosses itself, twice.
fn grown_peanut() -> Vec<DVec2> {
    const PARTS: u32 = 44;
    const OFFSET: f64 = 0.65;
    let at = |i: u32| {
        let turn = TAU * f64::from(i) / f64::from(PARTS);
        let (sin, cos) = libm::sincos(turn);
        let (sin_twice, cos_twice) = libm::sincos(2.0 * turn);
        let (radius, growth) = (1.0 + 0.8 * cos_twice, -1.6 * sin_twice);
        let (outward, onward) = (DVec2::new(cos, sin), DVec2::new(-sin, cos));
        let tangent = (radius * onward + growth * outward).normalize();
        // To the right of the counter-clockwise curve.
        radius * outward - OFFSET * tangent.perp()
    };
    (0..PARTS).map(at).collect()
}

/// Whether a triangle of the double cone leads to its upper tip.
fn is_upper(triangle: TriangleId) -> bool {
    triangle.0.is_multiple_of(2)
}

/// The element of the picture that a piece is, for pieces of the upper half.
fn shown(piece: &Piece) -> Option<[DVec2; 2]> {
    is_upper(piece.triangle)
        .then(|| section(piece.corners, HEIGHT))
        .flatten()
}

fn state(
    soup: &TriangleSoup,
    seen: &Seen,
    curve: &[DVec2],
    taken: usize,
    show_waiting: bool,
) -> Panel {
    let reach = curve.iter().map(|p| p.abs()).fold(DVec2::ZERO, DVec2::max);
    let reach = reach * DVec2::new(1.24, 1.08);
    let mut panel = Panel::plane(304.0, 214.0, -reach, reach);
    let shrunk = 1.0 - HEIGHT / TIP;
    for (i, from) in curve.iter().enumerate() {
        let to = curve[(i + 1) % curve.len()];
        panel.line(shrunk * *from, shrunk * to, Style::stroke(Color::GRAY, 1.2));
        panel.dot(shrunk * *from, 1.8, Style::fill(Color::GRAY));
    }
    let waits = |piece: &Piece| {
        let is_new = !seen.grown[..taken].contains(piece);
        let corner_taken =
            |c: &DVec3| c.z == 0.0 && seen.grown[..taken].iter().any(|p| p.corners.contains(c));
        is_new && seen.is_partial(piece) && piece.corners.iter().any(corner_taken)
    };
    if show_waiting {
        for piece in seen.grown.iter().filter(|piece| waits(piece)) {
            // The whole triangle waits, not yet the piece.
            if is_upper(piece.triangle)
                && let Some([a, b]) = section(
                    soup.triangles[piece.triangle.index()].map(|v| soup.positions[v.index()]),
                    HEIGHT,
                )
            {
                panel.line(a, b, Style::stroke(Color::BLUE, 3.0));
            }
        }
    }
    for piece in &seen.grown[..taken] {
        if let Some([a, b]) = shown(piece) {
            panel.line(a, b, Style::stroke(Color::BLACK, 4.2));
        }
    }
    if taken == 1
        && let Some([a, b]) = shown(&seen.grown[0])
    {
        let middle = 0.5 * (a + b);
        let outward = -(b - a).perp().normalize_or_zero();
        panel.arrow(
            middle,
            middle + 0.55 * outward,
            0.0,
            Style::fill(RED).outlined(RED, 1.6),
        );
        let text = Text::default().size(13.0).color(RED).anchor(Anchor::End);
        panel.text(middle, "seed", text.shift(-7.0, 5.0));
    }
    for segment in &seen.segments {
        // From a crossing of the curve to a tip.
        if let Some(end) = segment.ends.iter().find(|end| end.z == 0.0)
            && segment.ends.iter().any(|end| end.z > 0.0)
        {
            panel.dot(shrunk * end.truncate(), 5.5, Style::stroke(RED, 1.6));
        }
    }
    panel
}
