//! Figure 5: the special cases of stitching; and figure 6: how a singular vertex comes about.

use super::toy::RED;
use super::watch::{copies, cube, is_clean, repaired, welded};
use crate::scene::Scene;
use crate::sheet::{Anchor, Color, Panel, Style, Text};
use crate::{Error, Made, Number, Run, Sheet, Verdict};
use pellicle::mesh::{components, icosphere, summarize};
use pellicle::prelude::*;
use pellicle::transformesh::Rule;
use std::collections::BTreeMap;

/// A case of figure 5.
struct Case {
    name: &'static str,
    /// Where the second cube stands.
    shift: DVec3,
    /// What the paper adds: vertices and edges.
    adds: [i64; 2],
    words: &'static str,
}

const CASES: [Case; 3] = [
    Case {
        name: "vertex",
        shift: DVec3::new(1.0, 1.0, 1.0),
        adds: [1, 0],
        words: "Singular vertex: its triangles make two umbrellas; each gets a vertex of its own.",
    },
    Case {
        name: "edge",
        shift: DVec3::new(1.0, 0.0, 1.0),
        adds: [2, 1],
        words: "Singular edge: four triangles at one edge; two vertices and an edge are added.",
    },
    Case {
        name: "face",
        shift: DVec3::new(1.0, 0.0, 0.0),
        adds: [0, 0],
        words: "Singular face: two faces on each other that look at each other; both bound nothing and vanish.",
    },
];

/// Two cubes that touch in a corner, along an edge, in a face.
pub fn special_cases(run: &Run) -> Result<Made, Error> {
    let mut sheet = Sheet::new(3);
    let mut after_row = Vec::new();
    let mut numbers = Vec::new();
    let mut holds = true;
    for (at, case) in CASES.iter().enumerate() {
        run.step("repair", at as u64, 3)?;
        // One vertex a place, as after stitching whatever has equal coordinates.
        let soup = welded(&copies(&cube(), &[DVec3::ZERO, case.shift]));
        let (mesh, report, _) = repaired(&soup, Rule::Union)?;
        let [before, after] = [summarize((&soup).into())?, summarize((&mesh).into())?];
        let added = [
            mesh.positions().len() as i64 - soup.positions.len() as i64,
            after.edges as i64 - before.edges as i64,
        ];
        holds &= is_clean(&mesh)?;
        if case.name != "face" {
            holds &= added == case.adds;
            numbers.push(
                Number::exactly(format!("{}: vertices added", case.name), added[0] as f64)
                    .paper(case.adds[0].to_string()),
            );
            numbers.push(
                Number::exactly(format!("{}: edges added", case.name), added[1] as f64)
                    .paper(case.adds[1].to_string()),
            );
        } else {
            let vanished = before.triangles - after.triangles;
            holds &= vanished == 4;
            numbers
                .push(Number::exactly("face: triangles that vanish", vanished as f64).paper("4"));
        }
        numbers.push(Number::exactly(
            format!("{}: edges with more than two triangles", case.name),
            before.non_manifold_edges as f64,
        ));
        numbers.push(Number::exactly(
            format!("{}: singular vertices", case.name),
            report.singular_vertices as f64,
        ));
        numbers.push(Number::exactly(
            format!("{}: components after", case.name),
            report.components[1] as f64,
        ));
        sheet.push(touching(&soup, case).caption(case.words));
        after_row.push(parted(&mesh, case).caption(match case.name {
            "face" => "After: one body.",
            _ => "After: two bodies, drawn apart; on each the added vertices.",
        }));
    }
    for panel in after_row {
        sheet.push(panel);
    }
    Ok(Made {
        sheet,
        numbers,
        verdict: if holds { Verdict::Better } else { Verdict::Different },
        because: "Each case is resolved as the paper says, and exactly: vertices and edges added are the ones it names. The paper \
                  detects the cases after stitching and does not say what becomes of two faces on each other; here facets are \
                  glued to the next one that bounds the same inside, so that the cases do not arise, and the double face is \
                  dissolved."
            .into(),
    })
}

fn scene() -> Scene {
    Scene::new(DVec3::new(0.55, -1.0, 0.55), DVec3::Z)
}

const PANEL: [f64; 2] = [360.0, 290.0];

/// Which of the places are shared by both cubes.
fn shared(shift: DVec3) -> Vec<DVec3> {
    let corners = cube().positions;
    corners
        .iter()
        .copied()
        .filter(|p| corners.contains(&(*p - shift)))
        .collect()
}

fn touching(soup: &TriangleSoup, case: &Case) -> Panel {
    let mut scene = scene();
    // The first twelve triangles are those of the first cube.
    for (t, triangle) in soup.triangles.iter().enumerate() {
        let corners = triangle.map(|v| soup.positions[v.index()]);
        if scene.is_front(&corners) {
            let color = if t < 12 { Color::SKY } else { Color::PURPLE };
            let style = Style::fill(scene.shaded(&corners, color.mixed(Color::WHITE, 0.3)));
            scene.area(&corners, style.outlined(Color::GRAY, 0.6).opacity(0.8));
        }
    }
    mark(&mut scene, &shared(case.shift));
    scene.panel(PANEL[0], PANEL[1])
}

/// The singular place: a vertex, an edge, or a face.
fn mark(scene: &mut Scene, places: &[DVec3]) {
    match places {
        [p, q] => scene.line_over(&[*p, *q], Style::stroke(RED, 3.5)),
        [a, b, c, d] => {
            scene.area_over(
                &[*a, *b, *d, *c],
                Style::fill(RED).outlined(RED, 2.0).opacity(0.45),
            );
        }
        _ => {}
    }
    for &place in places {
        scene.dot_over(place, 4.5, Style::fill(RED));
    }
}

fn parted(mesh: &TriMesh, case: &Case) -> Panel {
    let mut scene = scene();
    let of_triangle = components(mesh.into());
    let mut is_in_first = vec![false; mesh.positions().len()];
    for (triangle, component) in mesh.triangles().iter().zip(&of_triangle) {
        for v in triangle {
            is_in_first[v.index()] = *component == of_triangle[0];
        }
    }
    let gap = 0.2 * case.shift.normalize();
    let moved = |v: VertexId| match is_in_first[v.index()] {
        true => mesh.position(v) - gap,
        false => mesh.position(v) + gap,
    };
    for triangle in mesh.triangles() {
        let corners = triangle.map(moved);
        if scene.is_front(&corners) {
            let color = if is_in_first[triangle[0].index()] {
                Color::SKY
            } else {
                Color::PURPLE
            };
            let style = Style::fill(scene.shaded(&corners, color.mixed(Color::WHITE, 0.3)));
            scene.area(&corners, style.outlined(Color::GRAY, 0.6).opacity(0.8));
        }
    }
    if case.name != "face" {
        for part in [true, false] {
            let places: Vec<DVec3> = (mesh.vertex_ids())
                .filter(|v| is_in_first[v.index()] == part)
                .filter(|v| shared(case.shift).contains(&mesh.position(*v)))
                .map(moved)
                .collect();
            mark(&mut scene, &places);
        }
    }
    scene.panel(PANEL[0], PANEL[1])
}

/// How far the vertex is pushed, in distances to the neighbour.
const PUSH: f64 = 1.4;

/// A sphere, a vertex of which was pushed past its neighbour: triangles between them turn over.
pub fn inverted_triangle(run: &Run) -> Result<Made, Error> {
    let sphere = icosphere(2)?;
    let pushed = VertexId(0);
    run.step("repair", 0, 1)?;
    let neighbor =
        (sphere.neighbors(pushed).next()).ok_or_else(|| Error::NotShown("a neighbour".into()))?;
    let [from, past] = [pushed, neighbor].map(|v| sphere.position(v));
    let mut soup = sphere.clone().into_soup();
    let to = (from + PUSH * (past - from)).normalize();
    soup.positions[pushed.index()] = to;
    let (mesh, report, seen) = repaired(&soup, Rule::Union)?;
    let is_inverted = |t: &[VertexId; 3]| {
        let [a, b, c] = t.map(|v| soup.positions[v.index()]);
        (b - a).cross(c - a).dot(a + b + c) < 0.0
    };
    let inverted = soup.triangles.iter().filter(|t| is_inverted(t)).count();
    let view = || {
        let mut scene = Scene::new(
            past + 0.15 * (to - past).normalize(),
            (past - from).normalize(),
        );
        for (x, y) in [(0.3, 0.26), (-0.3, -0.26)] {
            scene.fit(past + x * past.cross(from).normalize() + y * (past - from).normalize());
        }
        scene
    };
    let mut before = view();
    for triangle in &sphere.clone().into_soup().triangles {
        let corners = triangle.map(|v| sphere.position(v));
        if before.is_front(&corners) {
            before.face(&corners, Color::SKY.mixed(Color::WHITE, 0.3));
        }
    }
    before.dot_over(from, 4.5, Style::fill(Color::BLACK));
    before.arrow_over(from, to, Style::stroke(RED, 2.0));
    let mut pushed_view = view();
    for (t, corners) in seen.pieces(&soup) {
        let triangle = &soup.triangles[t.index()];
        if is_inverted(triangle) {
            continue;
        }
        if pushed_view.is_front(&corners) {
            let shade = pushed_view.shaded(&corners, Color::SKY.mixed(Color::WHITE, 0.3));
            pushed_view.area(
                &corners,
                // The outline closes the seams between pieces.
                Style::fill(shade).outlined(shade, 0.8),
            );
        }
    }
    for triangle in &soup.triangles {
        let corners = triangle.map(|v| soup.positions[v.index()]);
        if is_inverted(triangle) {
            pushed_view.area_over(&corners, Style::fill(RED).outlined(RED, 1.5).opacity(0.6));
        } else if pushed_view.is_front(&corners) {
            let outline = [corners[0], corners[1], corners[2], corners[0]];
            pushed_view.line_over(&outline, Style::stroke(Color::BLACK, 0.7));
        }
    }
    for segment in &seen.segments {
        pushed_view.line_over(&segment.ends, Style::stroke(Color::BLACK, 2.4));
    }
    pushed_view.dot_over(to, 4.5, Style::fill(Color::BLACK));
    pushed_view.dot_over(
        past,
        4.5,
        Style::fill(Color::WHITE).outlined(Color::BLACK, 1.5),
    );
    let mut after = view();
    let singular = singular_places(&mesh);
    // Both umbrellas: that of the first vertex, and that of the added one.
    let umbrellas: Vec<Vec<VertexId>> = (singular.iter())
        .map(|place| {
            mesh.vertex_ids()
                .filter(|v| mesh.position(*v) == *place)
                .collect()
        })
        .collect();
    for triangle in mesh.triangles() {
        let corners = triangle.map(|v| mesh.position(v));
        let of = |k: usize| {
            umbrellas
                .iter()
                .any(|copies| copies.get(k).is_some_and(|v| triangle.contains(v)))
        };
        let color = match (of(0), of(1)) {
            (true, _) => Color::YELLOW,
            (_, true) => Color::ORANGE,
            _ => Color::SKY,
        };
        if after.is_front(&corners) {
            after.face(&corners, color.mixed(Color::WHITE, 0.3));
        }
    }
    for &place in &singular {
        after.dot_over(place, 5.5, Style::fill(RED));
        let text = Text::default()
            .size(13.0)
            .bold()
            .color(RED)
            .halo()
            .anchor(Anchor::Start);
        after.words(place, "singular vertex", text.shift(10.0, -4.0));
    }
    let clean = is_clean(&mesh)?;
    let size = 420.0;
    let sheet = Sheet::new(3)
        .with(before.panel(size, 0.85 * size).caption("A valid mesh. The vertex is to move past its neighbour (arrow)."))
        .with(pushed_view.panel(size, 0.85 * size).caption(
            "Moved: the triangles between the two are turned over (red), and cross others (black segments).",
        ))
        .with(after.panel(size, 0.85 * size).caption(
            "Repaired: at one point two umbrellas touch (yellow and orange); it has two vertices.",
        ));
    let copies = umbrellas.iter().map(Vec::len).max().unwrap_or(1);
    let holds = clean && report.singular_vertices == 1 && copies == 2 && inverted > 0;
    Ok(Made {
        sheet,
        numbers: vec![
            Number::exactly("inverted triangles", inverted as f64),
            Number::exactly("pairs of triangles that intersect", report.pairs as f64),
            Number::exactly("singular vertices", report.singular_vertices as f64).paper("1"),
            Number::exactly("vertices at that point after", copies as f64).paper("2"),
            Number::exactly("components after", report.components[1] as f64),
            Number::exactly("handles after", report.genus[1].unwrap_or(0) as f64),
        ],
        verdict: if holds { Verdict::Agrees } else { Verdict::Different },
        because: "The same thing happens: a vertex that moves past its neighbour along the surface turns triangles over, and the \
                  repaired surface touches itself in a point, which is split. The paper shows one inverted triangle; here a \
                  vertex has several on that side."
            .into(),
    })
}

/// Places with more than one vertex.
fn singular_places(mesh: &TriMesh) -> Vec<DVec3> {
    let mut at: BTreeMap<[u64; 3], (DVec3, u32)> = BTreeMap::new();
    for &p in mesh.positions() {
        at.entry(p.to_array().map(f64::to_bits)).or_insert((p, 0)).1 += 1;
    }
    at.into_values()
        .filter(|(_, count)| *count > 1)
        .map(|(p, _)| p)
        .collect()
}
