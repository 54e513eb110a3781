//! Figure 7: changes of topology.

use super::watch::{append, is_clean, repaired, section};
use crate::sheet::{Color, Panel, Style};
use crate::{Error, Made, Number, Run, Sheet, Verdict};
use pellicle::glam::DVec2;
use pellicle::mesh::icosphere;
use pellicle::prelude::*;
use pellicle::render::{Options, Palette, Up, View};
use pellicle::transformesh::Rule;

/// A case: a mesh, and what is to become of it.
struct Case {
    name: &'static str,
    soup: TriangleSoup,
    components: [usize; 2],
    genus: usize,
    words: &'static str,
}

/// Join, split, and two ends that meet: a section through the mesh, and the result.
pub fn make(run: &Run) -> Result<Made, Error> {
    let cases = cases()?;
    let mut sheet = Sheet::new(cases.len());
    let mut results = Vec::new();
    let mut numbers = Vec::new();
    let mut holds = true;
    for (at, case) in cases.iter().enumerate() {
        run.step("repair", at as u64, cases.len() as u64)?;
        let (mesh, report, _) = repaired(&case.soup, Rule::Outside)?;
        let genus = report.genus[1].unwrap_or(0);
        holds &= is_clean(&mesh)? && report.components == case.components && genus == case.genus;
        numbers.push(Number::exactly(
            format!("{}: components before", case.name),
            report.components[0] as f64,
        ));
        numbers.push(
            Number::exactly(
                format!("{}: components after", case.name),
                report.components[1] as f64,
            )
            .paper(case.components[1].to_string()),
        );
        numbers.push(
            Number::exactly(format!("{}: handles after", case.name), genus as f64)
                .paper(case.genus.to_string()),
        );
        numbers.push(Number::exactly(
            format!("{}: pairs that intersect", case.name),
            report.pairs as f64,
        ));
        sheet.push(sections(&case.soup, &mesh).caption(case.words));
        results.push(solid(&mesh)?);
    }
    for panel in results {
        sheet.push(panel);
    }
    Ok(Made {
        sheet,
        numbers,
        verdict: if holds { Verdict::Agrees } else { Verdict::Different },
        because: "The upper row are sections through meshes in space (gray: before; bold blue: after), the lower row the \
                  surfaces after. The paper's drawings are schematic, and in the plane; its cases are not named, so these are \
                  the ones that its text names, splits and joins, of bodies and of one body with itself."
            .into(),
    })
}

/// The section, a little off the vertices.
const HEIGHT: f64 = 1e-3;

fn cases() -> Result<Vec<Case>, Error> {
    let sphere = icosphere(4)?.into_soup();
    let moved = |of: &dyn Fn(DVec3) -> DVec3| TriangleSoup {
        positions: sphere.positions.iter().map(|&p| of(p)).collect(),
        triangles: sphere.triangles.clone(),
    };
    // Two that overlap.
    let mut two = moved(&|p| p - 0.75 * DVec3::X);
    append(&mut two, &moved(&|p| p + 0.75 * DVec3::X));
    // A waist that is turned inside out, seen from the side.
    let dumbbell = moved(&|p| {
        let waist = 1.5 * libm::exp(-(4.0 * p.x) * (4.0 * p.x));
        DVec3::new(2.2 * p.x, p.y * (1.0 - waist), p.z)
    });
    // A sausage bent until its ends have moved through each other.
    let ring = moved(&|p| bent(p, 1.06));
    Ok(vec![
        Case {
            name: "join",
            soup: two,
            components: [2, 1],
            genus: 0,
            words: "Join: two that overlap become one.",
        },
        Case {
            name: "split",
            soup: dumbbell,
            components: [1, 2],
            genus: 0,
            words: "Split: a waist drawn through itself parts.",
        },
        Case {
            name: "ring",
            soup: ring,
            components: [1, 1],
            genus: 1,
            words: "A handle: two ends of one body have met.",
        },
    ])
}

/// A sphere drawn out along x and wound around z, `share` of a turn from pole to pole.
fn bent(p: DVec3, share: f64) -> DVec3 {
    // From −1 to 1 along the body, thick up to its ends.
    let along = p.x;
    let thickness = 0.32 / (1.0 - 0.75 * along * along).sqrt();
    let (sin, cos) = libm::sincos(std::f64::consts::PI * share * along);
    let radius = 1.0 + thickness * p.y + 0.1 * along;
    DVec3::new(-radius * cos, radius * sin, thickness * p.z)
}

fn sections(soup: &TriangleSoup, mesh: &TriMesh) -> Panel {
    let reach = soup
        .positions
        .iter()
        .map(|p| p.truncate().abs().max_element())
        .fold(0.0, f64::max)
        * 1.08;
    let mut panel = Panel::plane(350.0, 300.0, DVec2::splat(-reach), DVec2::splat(reach));
    for triangle in &soup.triangles {
        if let Some([a, b]) = section(triangle.map(|v| soup.positions[v.index()]), HEIGHT) {
            panel.line(a, b, Style::stroke(Color::GRAY, 1.3));
        }
    }
    for t in mesh.triangle_ids() {
        if let Some([a, b]) = section(mesh.corners(t), HEIGHT) {
            panel.line(a, b, Style::stroke(Color::BLUE, 3.4));
        }
    }
    panel
}

fn solid(mesh: &TriMesh) -> Result<Panel, Error> {
    let options = Options {
        width: 700,
        height: 520,
        views: vec![View::From(DVec3::new(0.25, -0.75, 0.9))],
        up: Up::Z,
        palette: Palette {
            background: [255, 255, 255],
            front: [140, 190, 222],
            ..Palette::default()
        },
        ..Options::default()
    };
    Panel::of_image(&render_mesh(mesh.into(), &options)?, 350.0)
}
