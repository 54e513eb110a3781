//! Figure 5: the finite volumes around a vertex.

use super::pictures::{Camera, box_of};
use super::runs::{Parameters, Scene, Surface, ellipsoid};
use crate::sheet::{Color, Panel, Sheet, Style, Text};
use crate::{Error, Figure, Made, Number, Paper, Run, Verdict, shapes};
use pellicle::evolution::Covolumes;
use pellicle::glam::DVec2;
use pellicle::mesh::area;
use pellicle::prelude::*;
use pellicle::render::{
    Bar, Coloring, Drawing, Stroke, Style as Drawn, Values, Visibility, render,
};

/// Figure 5.
pub(super) const FIGURE: Figure = Figure {
    name: "evolution-5",
    paper: Paper::Evolution,
    number: "figure 5",
    title: "The co-volume around a vertex",
    shows: "A co-volume of the abstract triangulation, with its parts, and its image in space with the outward normals of its boundary.",
    make,
};

/// Pixels of the panels.
const SIZE: [f64; 2] = [470.0, 430.0];
/// Which triangle of the ring has its parts named: p.
const NAMED: usize = 1;

const AREA: Color = Color([206, 226, 240]);
const PART_1: Color = Color([247, 206, 150]);
const PART_2: Color = Color([250, 228, 150]);

/// The triangles around a vertex, counter-clockwise seen from outside.
struct Ring {
    center: DVec3,
    neighbors: Vec<DVec3>,
}

impl Ring {
    fn of(mesh: &TriMesh, vertex: VertexId) -> Self {
        let at = |h| mesh.position(mesh.destination(h));
        Self {
            center: mesh.position(vertex),
            neighbors: mesh.outgoing_half_edges(vertex).map(at).collect(),
        }
    }

    fn len(&self) -> usize {
        self.neighbors.len()
    }

    /// X_{i_p}; the last is followed by the first.
    fn neighbor(&self, p: usize) -> DVec3 {
        self.neighbors[p % self.len()]
    }

    /// C_p, the middle of an edge.
    fn middle(&self, p: usize) -> DVec3 {
        0.5 * (self.center + self.neighbor(p))
    }

    /// B_p, the barycentre of a triangle.
    fn barycentre(&self, p: usize) -> DVec3 {
        (self.center + self.neighbor(p) + self.neighbor(p + 1)) / 3.0
    }

    /// The unit normal of a triangle.
    fn normal(&self, p: usize) -> DVec3 {
        let [a, b] = [p, p + 1].map(|p| self.neighbor(p) - self.center);
        a.cross(b).normalize_or_zero()
    }

    /// ‖σ‖ν of both parts of the boundary in a triangle: σ × n, outward.
    fn conormals(&self, p: usize) -> [DVec3; 2] {
        let [c, b, d] = [self.middle(p), self.barycentre(p), self.middle(p + 1)];
        [b - c, d - b].map(|sigma| sigma.cross(self.normal(p)))
    }
}

fn make(run: &Run<'_>) -> Result<Made, Error> {
    // A surface as it comes out of the evolution.
    let body = shapes::body();
    let initial = ellipsoid(1.3 * DVec3::new(62.0, 54.0, 48.0) + 3.0, 3)?;
    let scene = Scene::new(
        body.sample_evenly(2000, 1),
        initial,
        run.effort.pick(50, 100),
    )?;
    let mut surface = Surface::new(scene.initial.clone())?;
    let mesh = surface.steps(&scene.distance, &Parameters::PLAIN.onto_points(), 95)?;
    let covolumes = Covolumes::of(&mesh)?;

    // The most curved vertex that has six triangles and looks forwards.
    let usual =
        |v: &VertexId| mesh.neighbors(*v).count() == 6 && covolumes.normals[v.index()].z > 0.3;
    let curved = |v: &VertexId| covolumes.curvatures[v.index()].abs();
    let vertex = mesh
        .vertex_ids()
        .filter(usual)
        .max_by(|a, b| curved(a).total_cmp(&curved(b)))
        .ok_or_else(|| Error::NotShown("no vertex with six triangles".into()))?;
    let ring = Ring::of(&mesh, vertex);

    let mut sheet = Sheet::new(3);
    sheet
        .push(abstract_ring(ring.len()).caption(
            "The triangulation of X around a vertex: Vᵢ, and its parts in the triangle p",
        ));
    sheet.push(
        embedded(&mesh, vertex, &ring, covolumes.normals[vertex.index()])
            .caption("Its image on the surface of figure 6, and the normals ν of its boundary"),
    );
    sheet.push(all(&mesh, &covolumes)?.caption("All co-volumes of the surface, and their areas"));

    let (numbers, because) = measure(&mesh, &covolumes);
    Ok(Made {
        sheet,
        numbers,
        verdict: Verdict::Better,
        because,
    })
}

/// Areas add up; and Σ‖σ‖ν = μh at every vertex, which fixes the sign of (4.6), (4.13) and (4.15).
fn measure(mesh: &TriMesh, covolumes: &Covolumes) -> (Vec<Number>, String) {
    let total: f64 = covolumes.areas.iter().sum();
    let mut right = 0;
    let mut as_printed = 0;
    for vertex in mesh.vertex_ids() {
        let ring = Ring::of(mesh, vertex);
        let sum: DVec3 = (0..ring.len()).flat_map(|p| ring.conormals(p)).sum();
        let i = vertex.index();
        let vector = covolumes.areas[i] * covolumes.curvature_vectors[i];
        let least = 1e-9 * covolumes.areas[i].sqrt();
        right += usize::from((sum - vector).length() < least);
        as_printed += usize::from((sum + vector).length() < least);
    }
    let vertices = mesh.positions().len();
    let numbers = vec![
        Number::exactly("vertices", vertices as f64),
        Number::within(
            "sum of the co-volumes over the area",
            total / area(mesh.into()),
            1e-12,
        )
        .paper("1"),
        Number::exactly("vertices where Σ‖σ‖ν = μh", right as f64),
        Number::exactly(
            "vertices where Σ‖σ‖ν = μh with h as printed in (4.15)",
            as_printed as f64,
        ),
    ];
    let because = format!(
        "The construction is the paper's. On it, Σ‖σ‖ν = μh holds at {right} of {vertices} vertices with h from (F_p − F_i), and at \
         {as_printed} with (F_i − F_p), as (4.6), (4.13) and (4.15) are printed: their sign is an error. θ_{{p,1}} sits at X_{{i_p}}."
    );
    (numbers, because)
}

/// The ring of m equilateral triangles, as far as m allows.
fn abstract_ring(m: usize) -> Panel {
    let corner = |p: usize| {
        let turn = std::f64::consts::TAU * (p as f64 - NAMED as f64 - 0.5) / m as f64;
        DVec2::from_angle(turn)
    };
    let ring = Ring {
        center: DVec3::ZERO,
        neighbors: (0..m).map(|p| corner(p).extend(0.0)).collect(),
    };
    let mut panel = Panel::plane(SIZE[0], SIZE[1], DVec2::splat(-1.22), DVec2::splat(1.22));
    let flat = |p: DVec3| p.truncate();
    draw_ring(&mut panel, &ring, &flat, |_| Color::WHITE);
    name(&mut panel, &ring, &flat, "X");
    // The edges go on.
    for p in 0..m {
        let outer = flat(ring.neighbor(p));
        for turn in [-0.6, 0.0, 0.6] {
            let away = DVec2::from_angle(turn).rotate(outer);
            panel.line(outer, outer + 0.3 * away, Style::stroke(Color::PALE, 1.2));
        }
    }
    let text = Text::default().size(15.0).bold().halo();
    panel.text(DVec2::new(-0.38, -0.2), "Vᵢ", text);
    panel
}

/// The same on a surface, seen from over the vertex, aslant.
fn embedded(mesh: &TriMesh, vertex: VertexId, ring: &Ring, normal: DVec3) -> Panel {
    // x along the middle of the named triangle, y across it; the view tilted by 35°.
    let along = ring.barycentre(NAMED) - ring.center;
    let across = normal.cross(along).normalize_or_zero();
    let along = across.cross(normal).normalize_or_zero();
    let (sin, cos) = (0.574, 0.819);
    let flat = move |p: DVec3| {
        let p = p - ring.center;
        DVec2::new(p.dot(along), cos * p.dot(across) + sin * p.dot(normal))
    };
    let size = (0..ring.len())
        .map(|p| flat(ring.neighbor(p)).length())
        .fold(0.0, f64::max);
    let reach = DVec2::splat(1.25 * size);
    let middle = DVec2::new(0.0, -0.12 * size);
    let mut panel = Panel::plane(SIZE[0], SIZE[1], middle - reach, middle + reach);
    let shade = |n: DVec3| {
        let light = (0.45 * along + 0.3 * across + 0.84 * normal).normalize_or_zero();
        Color([120, 128, 138]).mixed(Color::WHITE, n.dot(light).max(0.0))
    };
    // What lies around, from far to near.
    for neighbor in mesh.neighbors(vertex) {
        for triangle in mesh.triangles_around(neighbor) {
            let corners = mesh.corners(triangle);
            let n = (corners[1] - corners[0])
                .cross(corners[2] - corners[0])
                .normalize_or_zero();
            if n.dot(cos * normal - sin * across) > 0.0 {
                let style =
                    Style::fill(shade(n).mixed(Color::WHITE, 0.5)).outlined(Color::GRAY, 0.8);
                panel.polygon(&corners.map(flat), style);
            }
        }
    }
    draw_ring(&mut panel, ring, &flat, shade);
    name(&mut panel, ring, &flat, "F");
    let [c, b, d] = [
        ring.middle(NAMED),
        ring.barycentre(NAMED),
        ring.middle(NAMED + 1),
    ];
    let named = [("νₚ,₁", [4.0, 18.0]), ("νₚ,₂", [-4.0, -9.0])];
    for (i, (words, [right, down])) in named.into_iter().enumerate() {
        let middle = 0.5 * (b + [c, d][i]);
        let tip = middle + 0.3 * size * ring.conormals(NAMED)[i].normalize_or_zero();
        let style = Style::stroke(Color::VERMILION, 2.2);
        panel.arrow(flat(middle), flat(tip), 0.0, style);
        let text = Text::default().size(14.0).color(Color::VERMILION);
        panel.text(flat(tip), words, text.bold().halo().shift(right, down));
    }
    let tip = ring.center + 0.55 * size * normal;
    panel.arrow(
        flat(ring.center),
        flat(tip),
        0.0,
        Style::stroke(Color::GREEN, 2.2),
    );
    panel.text(
        flat(tip),
        "Nᵢ",
        Text::default()
            .size(14.0)
            .color(Color::GREEN)
            .bold()
            .halo()
            .shift(14.0, 4.0),
    );
    panel
}

/// Triangles, co-volume and its parts in the named triangle.
fn draw_ring(
    panel: &mut Panel,
    ring: &Ring,
    flat: &dyn Fn(DVec3) -> DVec2,
    shade: impl Fn(DVec3) -> Color,
) {
    let m = ring.len();
    let edge = Style::stroke(Color::BLACK, 1.6);
    for p in 0..m {
        let corners = [ring.center, ring.neighbor(p), ring.neighbor(p + 1)].map(flat);
        panel.polygon(&corners, Style::fill(shade(ring.normal(p))));
    }
    let boundary: Vec<DVec2> = (0..m)
        .flat_map(|p| [ring.middle(p), ring.barycentre(p)])
        .map(flat)
        .collect();
    panel.polygon(&boundary, Style::fill(AREA).opacity(0.85));
    let [c, b, d] = [
        ring.middle(NAMED),
        ring.barycentre(NAMED),
        ring.middle(NAMED + 1),
    ];
    panel.polygon(&[ring.center, c, b].map(flat), Style::fill(PART_1));
    panel.polygon(&[ring.center, b, d].map(flat), Style::fill(PART_2));
    panel.line(
        flat(ring.center),
        flat(b),
        Style::stroke(Color::GRAY, 1.2).dashed(4.0),
    );
    panel.polygon(&boundary, Style::stroke(Color::BLUE, 2.2));
    for p in 0..m {
        panel.line(flat(ring.center), flat(ring.neighbor(p)), edge);
        panel.line(flat(ring.neighbor(p)), flat(ring.neighbor(p + 1)), edge);
    }
    for (from, to) in [(c, b), (b, d)] {
        panel.line(flat(from), flat(to), Style::stroke(Color::BLUE, 3.6));
    }
    // The two angles of the cotangent scheme.
    for (at, toward) in [(NAMED, NAMED + 1), (NAMED + 1, NAMED)] {
        let [apex, one, other] = [ring.neighbor(at), ring.center, ring.neighbor(toward)];
        let radius = 0.2 * apex.distance(one);
        let arc: Vec<DVec2> = (0..=12)
            .map(|i| {
                let share = f64::from(i) / 12.0;
                let between = (one - apex)
                    .normalize_or_zero()
                    .lerp((other - apex).normalize_or_zero(), share);
                flat(apex + radius * between.normalize_or_zero())
            })
            .collect();
        panel.polyline(&arc, Style::stroke(Color::PURPLE, 2.0));
    }
    for p in 0..m {
        panel.dot(flat(ring.barycentre(p)), 2.6, Style::fill(Color::BLUE));
        panel.dot(flat(ring.middle(p)), 2.6, Style::fill(Color::BLUE));
        panel.dot(flat(ring.neighbor(p)), 3.2, Style::fill(Color::BLACK));
    }
    panel.dot(flat(ring.center), 4.2, Style::fill(Color::BLACK));
}

/// The letters of the paper.
fn name(panel: &mut Panel, ring: &Ring, flat: &dyn Fn(DVec3) -> DVec2, letter: &str) {
    let text = Text::default().size(14.0).halo();
    let outward = |p: DVec3, by: f64| {
        let away = (flat(p) - flat(ring.center)).normalize_or_zero();
        [by * away.x, 4.5 - by * away.y]
    };
    let put = |panel: &mut Panel, p: DVec3, words: &str, by: f64, color: Color| {
        let [right, down] = outward(p, by);
        panel.text(flat(p), words, text.color(color).shift(right, down));
    };
    let subscripts = ["₁", "₂", "₃", "₄", "₅", "₆", "₇", "₈", "₉"];
    for p in 0..ring.len() {
        let words = match p {
            NAMED => format!("{letter}ᵢₚ"),
            p if p == NAMED + 1 => format!("{letter}ᵢₚ₊₁"),
            _ => format!("{letter}ᵢ{}", subscripts[p % 9]),
        };
        put(panel, ring.neighbor(p), &words, 22.0, Color::BLACK);
    }
    panel.text(
        flat(ring.center),
        &format!("{letter}ᵢ"),
        text.bold().shift(-16.0, -7.0),
    );
    let [c, b, d] = [
        ring.middle(NAMED),
        ring.barycentre(NAMED),
        ring.middle(NAMED + 1),
    ];
    put(panel, b, "Bₚ", 16.0, Color::BLUE);
    panel.text(flat(c), "Cₚ", text.color(Color::BLUE).shift(8.0, 19.0));
    panel.text(flat(d), "Cₚ₊₁", text.color(Color::BLUE).shift(-8.0, -12.0));
    let third = |x: DVec3, y: DVec3| (ring.center + x + y) / 3.0;
    panel.text(flat(third(c, b)), "Vₚ,₁", text.size(12.0).shift(2.0, 6.0));
    panel.text(flat(third(b, d)), "Vₚ,₂", text.size(12.0).shift(2.0, 4.0));
    if letter == "X" {
        panel.text(
            flat(0.5 * (c + b)),
            "σₚ,₁",
            text.color(Color::BLUE).shift(26.0, 14.0),
        );
        panel.text(
            flat(0.5 * (b + d)),
            "σₚ,₂",
            text.color(Color::BLUE).shift(26.0, -4.0),
        );
    }
    // On the surface there is no room beside the normals.
    let angles = [(NAMED, NAMED + 1, "θₚ,₁"), (NAMED + 1, NAMED, "θₚ,₂")];
    for (at, toward, words) in angles.into_iter().filter(|_| letter == "X") {
        let apex = ring.neighbor(at);
        let inside = apex.lerp((ring.center + ring.neighbor(toward) + apex) / 3.0, 0.5);
        panel.text(
            flat(inside),
            words,
            text.color(Color::PURPLE).shift(6.0, 5.0),
        );
    }
}

/// The whole surface with the boundaries of its co-volumes.
fn all(mesh: &TriMesh, covolumes: &Covolumes) -> Result<Panel, Error> {
    let mut strokes = Vec::new();
    for triangle in mesh.triangle_ids() {
        let corners = mesh.corners(triangle);
        let barycentre = (corners[0] + corners[1] + corners[2]) / 3.0;
        for i in 0..3 {
            strokes.push(Stroke {
                ends: [barycentre, 0.5 * (corners[i] + corners[(i + 1) % 3])],
                color: Color::BLUE.0,
                width: 0.9,
                visibility: Visibility::Hidden,
            });
        }
    }
    let camera = Camera {
        kept: 1.0,
        ..Camera::new(box_of([mesh.positions()]), SIZE)
    };
    let drawing = Drawing {
        coloring: Coloring::Values(Values {
            bar: Bar::Right,
            title: "area",
            ..Values::new(&covolumes.areas)
        }),
        strokes: &strokes,
        ..Drawing::mesh(mesh)
    };
    camera.panel(&render(&drawing, &camera.options(Drawn::SurfaceAndEdges))?)
}
