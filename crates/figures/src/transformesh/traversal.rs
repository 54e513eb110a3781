//! Figure 3: how a partially valid triangle is traversed.

use super::toy::RED;
use super::watch::{Seen, append, copies, cube, is_clean, repaired};
use crate::sheet::{Color, Panel, Style, Text};
use crate::{Error, Made, Number, Run, Sheet, Verdict};
use pellicle::glam::DVec2;
use pellicle::mesh::{TriangleId, icosphere};
use pellicle::prelude::*;
use pellicle::transformesh::{Piece, Rule};

/// The upper right triangle of a cube's top, into which three small bodies are stuck.
pub fn make(run: &Run) -> Result<Made, Error> {
    let mut soup = copies(&cube(), &[DVec3::new(0.0, 0.0, -1.0)]);
    let small = icosphere(0)?.into_soup();
    for (center, radius) in [
        (DVec3::new(0.78, 0.62, 0.03), 0.11),
        (DVec3::new(0.5, 0.33, 0.02), 0.17),
        (DVec3::new(0.95, 0.12, -0.02), 0.2),
    ] {
        let positions = small
            .positions
            .iter()
            .map(|&p| center + radius * p)
            .collect();
        append(
            &mut soup,
            &TriangleSoup {
                positions,
                triangles: small.triangles.clone(),
            },
        );
    }
    run.step("repair", 0, 1)?;
    let (mesh, report, seen) = repaired(&soup, Rule::Union)?;
    // The two triangles of the top are those whose corners all have z = 0.
    let shown = (seen.cut.keys().copied())
        .filter(|t| t.index() < 12)
        .filter(|t| {
            soup.triangles[t.index()]
                .iter()
                .all(|v| soup.positions[v.index()].z == 0.0)
        })
        .max_by_key(|t| (seen.cut[t].len(), *t))
        .ok_or_else(|| Error::NotShown("a cut triangle".into()))?;
    let pieces = &seen.cut[&shown];
    let segments: Vec<[DVec3; 2]> = (seen.segments.iter())
        .filter(|segment| segment.triangles.contains(&shown))
        .map(|segment| segment.ends)
        .collect();
    let kept: Vec<&Piece> = seen
        .grown
        .iter()
        .filter(|piece| piece.triangle == shown)
        .collect();
    let entrance =
        entrance(&soup, &seen, shown).ok_or_else(|| Error::NotShown("an entrance".into()))?;
    let triangle = soup.triangles[shown.index()].map(|v| soup.positions[v.index()]);

    let mut given = outline(triangle);
    for [a, b] in &segments {
        given.line(a.truncate(), b.truncate(), Style::stroke(RED, 2.4));
    }
    label(&mut given, triangle);
    let mut cut = outline(triangle);
    for piece in pieces {
        cut.polygon(&flat(&piece.corners), Style::stroke(Color::GRAY, 0.9));
    }
    constraints(&mut cut, pieces);
    let mut filled = outline(triangle);
    let middle =
        |piece: &Piece| (piece.corners[0] + piece.corners[1] + piece.corners[2]).truncate() / 3.0;
    for piece in pieces {
        let is_kept = kept.iter().any(|k| same(k, piece));
        let color = if is_kept {
            Color::GREEN.mixed(Color::WHITE, 0.55)
        } else {
            Color::WHITE
        };
        filled.polygon(
            &flat(&piece.corners),
            Style::fill(color).outlined(Color::GRAY, 0.7),
        );
    }
    constraints(&mut filled, pieces);
    // The traversal from piece to piece over edges that are no constraints.
    for [from, to] in traversal(&kept) {
        filled.arrow(
            middle(from),
            middle(to),
            0.0,
            Style::fill(Color::BLUE).outlined(Color::BLUE, 1.3),
        );
    }
    let [a, b] = entrance.map(DVec3::truncate);
    let inward = (b - a).perp().normalize();
    filled.line(a, b, Style::stroke(Color::BLUE, 4.0));
    filled.arrow(
        0.5 * (a + b) - 0.13 * inward,
        0.5 * (a + b) + 0.05 * inward,
        0.0,
        Style::fill(Color::BLUE).outlined(Color::BLUE, 3.0),
    );
    filled.text(
        0.5 * (a + b) - 0.13 * inward,
        "entrance",
        Text::default()
            .size(13.0)
            .bold()
            .color(Color::BLUE)
            .halo()
            .shift(-14.0, -7.0),
    );

    let reached = traversal(&kept).len() + 1;
    let clean = is_clean(&mesh)?;
    let sheet = Sheet::new(3)
        .with(given.caption("A triangle t: its half-edges h_t, and the segments s_t in which others meet it (red)."))
        .with(cut.caption("The constrained triangulation in its plane: all segments are edges of it."))
        .with(filled.caption(
            "The traversal from the entrance half-edge, piece to piece (arrows), stopping at constraints. White is never reached.",
        ));
    let holds = clean && reached == kept.len() && report.components == [4, 1];
    Ok(Made {
        sheet,
        numbers: vec![
            Number::exactly("segments in the triangle", segments.len() as f64),
            Number::exactly("pieces", pieces.len() as f64),
            Number::exactly("pieces on the outside", kept.len() as f64),
            Number::exactly("pieces reached from the entrance", reached as f64),
            Number::exactly("components before", report.components[0] as f64),
            Number::exactly("components after", report.components[1] as f64),
        ],
        verdict: if holds { Verdict::Agrees } else { Verdict::Different },
        because: "Segments, pieces and what is kept of them are the algorithm's; every piece on the outside is reached from the \
                  entrance without crossing a constraint. The triangulation is constrained, but not Delaunay: the library \
                  does not need it."
            .into(),
    })
}

fn same(a: &Piece, b: &Piece) -> bool {
    a.corners.iter().all(|corner| b.corners.contains(corner))
}

fn flat(corners: &[DVec3; 3]) -> Vec<DVec2> {
    corners.iter().map(|c| c.truncate()).collect()
}

/// The half-edge of the triangle by which the growing region came first: an edge of a piece, on a neighbour taken before.
fn entrance(soup: &TriangleSoup, seen: &Seen, triangle: TriangleId) -> Option<[DVec3; 2]> {
    let sides = soup.triangles[triangle.index()].map(|v| soup.positions[v.index()]);
    let (place, first) = seen
        .grown
        .iter()
        .enumerate()
        .find(|(_, piece)| piece.triangle == triangle)?;
    let before = &seen.grown[..place];
    let on_side = |a: DVec3, b: DVec3| {
        (0..3).any(|i| {
            let [p, q] = [sides[i], sides[(i + 1) % 3]];
            [a, b]
                .iter()
                .all(|x| (q - p).cross(*x - p).length() < 1e-12)
        })
    };
    (0..3)
        .map(|i| [first.corners[i], first.corners[(i + 1) % 3]])
        .find(|[a, b]| {
            on_side(*a, *b)
                && before
                    .iter()
                    .any(|piece| piece.corners.contains(a) && piece.corners.contains(b))
        })
}

/// Each piece but the first with the one from which it was reached, breadth first, never over a cut.
fn traversal<'a>(kept: &[&'a Piece]) -> Vec<[&'a Piece; 2]> {
    let mut reached = vec![false; kept.len()];
    let mut queue = std::collections::VecDeque::from([0]);
    let mut steps = Vec::new();
    if let Some(first) = reached.first_mut() {
        *first = true;
    }
    while let Some(at) = queue.pop_front().filter(|at| *at < kept.len()) {
        for i in (0..3).filter(|&i| !kept[at].is_cut[i]) {
            let [a, b] = [kept[at].corners[i], kept[at].corners[(i + 1) % 3]];
            let next = kept.iter().position(|p| {
                !std::ptr::eq(*p, kept[at]) && p.corners.contains(&a) && p.corners.contains(&b)
            });
            if let Some(next) = next.filter(|&next| !reached[next]) {
                reached[next] = true;
                steps.push([kept[at], kept[next]]);
                queue.push_back(next);
            }
        }
    }
    steps
}

fn outline(triangle: [DVec3; 3]) -> Panel {
    let corners = flat(&triangle);
    let min = corners.iter().copied().fold(DVec2::INFINITY, DVec2::min);
    let max = corners
        .iter()
        .copied()
        .fold(DVec2::NEG_INFINITY, DVec2::max);
    let mut panel = Panel::plane(460.0, 440.0, min - 0.12, max + 0.08);
    panel.polygon(
        &corners,
        Style::fill(Color::PALE.mixed(Color::WHITE, 0.6)).outlined(Color::BLACK, 2.0),
    );
    panel
}

fn constraints(panel: &mut Panel, pieces: &[Piece]) {
    for piece in pieces {
        for i in (0..3).filter(|&i| piece.is_cut[i]) {
            let [a, b] = [piece.corners[i], piece.corners[(i + 1) % 3]].map(DVec3::truncate);
            panel.line(a, b, Style::stroke(RED, 2.4));
        }
    }
}

fn label(panel: &mut Panel, triangle: [DVec3; 3]) {
    let text = Text::default().size(14.0).halo();
    let center = (triangle[0] + triangle[1] + triangle[2]).truncate() / 3.0;
    for (i, name) in ["h_t₁", "h_t₂", "h_t₃"].iter().enumerate() {
        let [a, b] = [triangle[i], triangle[(i + 1) % 3]].map(DVec3::truncate);
        let middle = 0.37 * a + 0.63 * b;
        panel.text(
            middle - 0.06 * (center - middle).normalize(),
            name,
            text.shift(0.0, 5.0),
        );
    }
}
