//! Figure 1: a toy example, from a mesh that crosses itself to one that does not.

use super::watch::{is_clean, repaired};
use crate::crossing::two_spheres;
use crate::scene::Scene;
use crate::sheet::{Color, ColorScale, Panel, Style};
use crate::{Error, Made, Number, Run, Sheet, Verdict};
use pellicle::mesh::{TriangleId, summarize};
use pellicle::prelude::*;
use pellicle::transformesh::Rule;

/// Two spheres through each other, as one mesh would look that was deformed too far.
pub fn make(run: &Run) -> Result<Made, Error> {
    let soup = two_spheres(6);
    run.step("repair", 0, 1)?;
    let (mesh, report, seen) = repaired(&soup, Rule::Union)?;
    let half = soup.triangles.len() / 2;
    let color_of = |t: TriangleId| {
        if t.index() < half {
            Color::SKY
        } else {
            Color::PURPLE
        }
    };
    let pale = |color: Color| color.mixed(Color::WHITE, 0.35);

    let mut input = scene();
    for (triangle, corners) in seen.pieces(&soup) {
        draw(&mut input, &corners, pale(color_of(triangle)));
    }
    let mut crossing = scene();
    for (triangle, corners) in seen.pieces(&soup) {
        let is_cut = seen.cut.contains_key(&triangle);
        let color = if is_cut {
            Color::YELLOW.mixed(Color::WHITE, 0.2)
        } else {
            pale(color_of(triangle)).mixed(Color::WHITE, 0.5)
        };
        if crossing.is_front(&corners) {
            crossing.area(
                &corners,
                Style::fill(color).outlined(Color::GRAY, 0.4).opacity(0.75),
            );
        }
    }
    for segment in &seen.segments {
        crossing.line_over(&segment.ends, Style::stroke(RED, 2.2));
    }
    let mut growing = scene();
    let scale = ColorScale::sequential(0.0, seen.grown.len() as f64);
    let state = seen.grown.len() * 4 / 5;
    for (triangle, corners) in seen.pieces(&soup) {
        let taken = seen
            .grown
            .iter()
            .position(|piece| piece.triangle == triangle && piece.corners == corners);
        if taken.is_none_or(|at| at >= state) && growing.is_front(&corners) {
            growing.area(
                &corners,
                Style::fill(Color::WHITE)
                    .outlined(Color::GRAY, 0.4)
                    .opacity(0.35),
            );
        }
    }
    for (at, piece) in seen.grown.iter().enumerate().take(state) {
        draw(
            &mut growing,
            &piece.corners,
            scale.at(at as f64).mixed(Color::WHITE, 0.25),
        );
    }
    let seed = seen
        .seeds
        .first()
        .ok_or_else(|| Error::NotShown("a seed".into()))?;
    growing.area_over(&seed.corners, Style::fill(RED).outlined(Color::BLACK, 1.0));
    let mut result = scene();
    for (t, source) in mesh.triangle_ids().zip(&report.sources) {
        draw(&mut result, &mesh.corners(t), pale(color_of(*source)));
    }

    let [before, after] = [summarize((&soup).into())?, summarize((&mesh).into())?];
    let clean = is_clean(&mesh)?;
    let sheet = Sheet::new(4)
        .with(panel(&input).caption("A mesh of two components that pass through each other."))
        .with(panel(&crossing).caption(
            "Self-intersections: the segments in which triangles meet, and the triangles they cut.",
        ))
        .with(
            panel(&growing)
                .caption("The valid region grows from the seed (red), over the crossing onto the other sphere: dark was taken first."),
        )
        .with(panel(&result).caption("The result: the outside, stitched together."));
    let holds = clean && report.components == [2, 1] && after.genus() == Some(0);
    Ok(Made {
        sheet,
        numbers: vec![
            Number::exactly("triangles before", soup.triangles.len() as f64),
            Number::exactly("pairs of triangles that intersect", report.pairs as f64),
            Number::exactly("triangles cut", report.cut as f64),
            Number::exactly("triangles after", mesh.triangles().len() as f64),
            Number::exactly("components before", before.components.len() as f64),
            Number::exactly("components after", after.components.len() as f64),
            Number::exactly("intersecting pairs after", if clean { 0.0 } else { 1.0 }).paper("0"),
            Number::exactly("new vertices", report.new_vertices as f64),
            Number::within("volume after", report.volume[1], 1e-12),
        ],
        verdict: if holds { Verdict::Agrees } else { Verdict::Different },
        because: "The stages are the real ones, seen by the observer of `repair_with`. The result is closed, a manifold, and free \
                  of self-intersections, by exact tests."
            .into(),
    })
}

/// What is wrong, and seeds.
pub const RED: Color = Color([206, 0, 24]);

fn scene() -> Scene {
    Scene::new(DVec3::new(-0.25, -1.0, 0.3), DVec3::Z)
}

fn panel(scene: &Scene) -> Panel {
    scene.panel(370.0, 290.0)
}

/// A triangle of a closed surface, if it is seen.
fn draw(scene: &mut Scene, corners: &[DVec3], color: Color) {
    if scene.is_front(corners) {
        scene.outlined_face(corners, color, Color::BLACK.mixed(color, 0.5), 0.5);
    }
}
