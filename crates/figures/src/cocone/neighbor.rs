//! Figure 4.4: SURFACENEIGHBOR by turning through tetrahedra, and by numbers.

use super::edges::{AtEdges, walk_by_numbers};
use super::measured::{Stages, stages};
use super::surface::Surface;
use crate::scene::Scene;
use crate::sheet::{Color, Panel, Style, Text};
use crate::{Error, Made, Number, Random, Run, Sheet, Verdict};
use pellicle::delaunay::{FacetId, TetId};
use pellicle::glam::{DMat3, DVec2};

use pellicle::prelude::*;
use std::collections::{BTreeMap, HashSet};

/// A torus as a turntable scanner samples it, turned in space: four neighbours in a plane and on a circle, up to rounding, so
/// that there are slivers everywhere.
pub fn make(run: &Run) -> Result<Made, Error> {
    let turn = circled_edge()?;
    run.step("figure", 1, 2)?;
    let [around, rings] = run.effort.pick([40, 16], [60, 24]);
    let points = turned_grid(around, rings);
    let tetrahedra = tetrahedralize(&points, &delaunay::Options::default())?;
    let (stages, reconstruction) = stages(&tetrahedra)?;
    let at = AtEdges::of(&tetrahedra, &stages.pruned);
    let seed = (stages.walked.first()).ok_or_else(|| Error::NotShown("a surface".into()))?;
    let by_numbers = walk_by_numbers(&points, &at, tetrahedra.facet(*seed));
    let by_turning: Vec<[VertexId; 3]> = stages
        .walked
        .iter()
        .map(|&facet| tetrahedra.facet(facet))
        .collect();
    let wrong = wrong_edges(&by_numbers);
    let right = wrong_edges(&by_turning);
    let center = busiest(&points, &wrong);
    let slivers = slivers(&tetrahedra);

    let sheet = Sheet::new(3)
        .with(turn.panel().caption(format!(
            "SURFACENEIGHBOR(T₁, t, e), seen along e: from t through the tetrahedra T₁ to T{} to the next triangle t′ of the \
             pruned set. No number is compared.",
            subscript(turn.between)
        )))
        .with(zoom(&points, &by_numbers, &wrong, center).caption(
            "By numbers: the least angle, from dot products in doubles. Where slivers are flat the walk takes triangles of \
             both of their sides; edges without exactly two triangles are red.",
        ))
        .with(zoom(&points, &by_turning, &right, center).caption(
            "By turning: the same place, the same points, the same candidates. Every edge has two triangles.",
        ));
    let closed = reconstruction.mesh.is_closed() && right.is_empty();
    let count = |n: usize| n as f64;
    Ok(Made {
        sheet,
        numbers: vec![
            Number::exactly("left: tetrahedra turned through", count(turn.between)).paper("3"),
            Number::exactly("points", count(points.len())),
            Number::exactly("tetrahedra flatter than 10⁻¹²", count(slivers)),
            Number::exactly("candidate triangles after pruning", count(stages.pruned.len())),
            Number::exactly("triangles of a torus through all points", count(2 * points.len())),
            Number::exactly("by turning: triangles", count(by_turning.len())),
            Number::exactly("by turning: edges without exactly two triangles", count(right.len())).paper("0"),
            Number::exactly("by numbers: triangles", count(by_numbers.len())),
            Number::exactly("by numbers: edges without exactly two triangles", count(wrong.len())),
        ],
        verdict: if closed && !wrong.is_empty() { Verdict::Agrees } else { Verdict::Different },
        because: "The stable walk gives the closed torus through all points; the walk by angles, which computes what the text \
                  calls \"some numerical computations involving some dot product computations\", on the same candidates gives \
                  overlapping triangles. The paper zooms into a scanned model that is not published; here it is a regular scan \
                  of a torus, where every quadrangle holds a sliver. Only the walk differs: pruning is the library's in both."
            .into(),
    })
}

/// (1/3)·(2 −1 2; 2 2 −1; −1 2 2) turns exactly but for rounding, without a sine.
fn turned_grid(around: u32, rings: u32) -> Vec<DVec3> {
    let turn = DMat3::from_cols(
        DVec3::new(2.0, 2.0, -1.0),
        DVec3::new(-1.0, 2.0, 2.0),
        DVec3::new(2.0, -1.0, 2.0),
    );
    let surface = Surface::Torus { tube: 0.4 };
    (0..around * rings)
        .map(|i| {
            let (u, v) = (
                f64::from(i % around) / f64::from(around),
                f64::from(i / around) / f64::from(rings),
            );
            turn * surface.point(u, v) / 3.0
        })
        .collect()
}

/// Finite tetrahedra whose volume is below 10⁻¹² of the cube of their longest edge.
fn slivers(tetrahedra: &Tetrahedralization) -> usize {
    let is_flat = |corners: &&[VertexId; 4]| {
        let [a, b, c, d] = corners.map(|v| tetrahedra.points()[v.index()]);
        let longest = [b - a, c - a, d - a, c - b, d - b, d - c]
            .map(DVec3::length)
            .into_iter()
            .fold(0.0, f64::max);
        (b - a).cross(c - a).dot(d - a).abs() < 6e-12 * longest * longest * longest
    };
    tetrahedra.finite_tets().iter().filter(is_flat).count()
}

/// The edges that do not have exactly two triangles.
fn wrong_edges(triangles: &[[VertexId; 3]]) -> Vec<[VertexId; 2]> {
    let mut counts: BTreeMap<[VertexId; 2], u32> = BTreeMap::new();
    for &[a, b, c] in triangles {
        for [u, v] in [[a, b], [b, c], [c, a]] {
            *counts.entry([u.min(v), u.max(v)]).or_default() += 1;
        }
    }
    counts
        .into_iter()
        .filter(|(_, count)| *count != 2)
        .map(|(edge, _)| edge)
        .collect()
}

/// Half the width of the zoom.
const ZOOM: f64 = 0.4;

/// The middle of the edge around which there are most others.
fn busiest(points: &[DVec3], edges: &[[VertexId; 2]]) -> DVec3 {
    let middles: Vec<DVec3> = (edges.iter())
        .map(|edge| 0.5 * (points[edge[0].index()] + points[edge[1].index()]))
        .collect();
    let near = |m: DVec3| {
        middles
            .iter()
            .filter(|other| other.distance(m) < 0.8 * ZOOM)
            .count()
    };
    middles
        .iter()
        .copied()
        .max_by_key(|&m| near(m))
        .unwrap_or(points[0])
}

/// The triangles near a place, seen from outside.
fn zoom(
    points: &[DVec3],
    triangles: &[[VertexId; 3]],
    wrong: &[[VertexId; 2]],
    center: DVec3,
) -> Panel {
    let turn = DMat3::from_cols(
        DVec3::new(2.0, 2.0, -1.0),
        DVec3::new(-1.0, 2.0, 2.0),
        DVec3::new(2.0, -1.0, 2.0),
    ) / 3.0;
    let normal = turn * Surface::Torus { tube: 0.4 }.normal(turn.transpose() * center);
    let mut scene = Scene::new(
        normal + 0.35 * normal.any_orthonormal_vector(),
        normal.any_orthonormal_vector().cross(normal),
    );
    let wrong: HashSet<[VertexId; 2]> = wrong.iter().copied().collect();
    for triangle in triangles {
        let corners = triangle.map(|v| points[v.index()]);
        if corners
            .iter()
            .any(|corner| corner.distance(center) < 1.5 * ZOOM)
            && scene.is_front(&corners)
        {
            let color = scene.shaded(&corners, Color::SKY.mixed(Color::WHITE, 0.35));
            scene.area(
                &corners,
                Style::fill(color).outlined(Color::BLACK, 0.7).opacity(0.6),
            );
            for i in 0..3 {
                let [u, v] = [triangle[i], triangle[(i + 1) % 3]];
                if wrong.contains(&[u.min(v), u.max(v)]) {
                    let ends = [points[u.index()], points[v.index()]];
                    scene.line_over(&ends, Style::stroke(Color([206, 0, 24]), 2.2));
                }
            }
        }
    }
    let (x, y) = normal.any_orthonormal_pair();
    for corner in [x + y, x - y, y - x, -x - y] {
        scene.fit(center + 0.75 * ZOOM * corner);
    }
    scene.panel(430.0, 400.0)
}

/// Tetrahedra around an edge of the surface.
struct Turn {
    /// By triangle around the edge, from t on: the direction of its third vertex across the edge, and whether it is of the
    /// pruned set.
    spokes: Vec<(DVec2, bool)>,
    /// Tetrahedra from t to t′.
    between: usize,
    /// Whether each tetrahedron, from T₁ on, is finite.
    finite: Vec<bool>,
}

/// An edge where three finite tetrahedra lie between t and t′ on the outside.
fn circled_edge() -> Result<Turn, Error> {
    let points = Surface::Torus { tube: 0.6 }.scatter(0.3, &mut Random::new(46, 0));
    let tetrahedra = tetrahedralize(&points, &delaunay::Options::default())?;
    let (stages, _) = stages(&tetrahedra)?;
    let mut best: Option<(f64, Turn)> = None;
    for &side in &stages.walked {
        let [a, b, c] = tetrahedra.facet(side);
        for [u, v, apex] in [[a, b, c], [b, c, a], [c, a, b]] {
            let turn = turn_at(&tetrahedra, &stages, side, [u, v, apex]);
            if let Some(turn) =
                turn.filter(|turn| turn.between == 3 && turn.finite.iter().all(|finite| *finite))
            {
                let clarity = turn.least_angle();
                if best.as_ref().is_none_or(|(most, _)| clarity > *most) {
                    best = Some((clarity, turn));
                }
            }
        }
    }
    let (_, turn) =
        best.ok_or_else(|| Error::NotShown("three tetrahedra between two triangles".into()))?;
    Ok(turn)
}

/// From the side (u, v, apex), counter-clockwise seen from its tetrahedron, once around (u, v).
fn turn_at(
    tetrahedra: &Tetrahedralization,
    stages: &Stages,
    side: FacetId,
    [u, v, apex]: [VertexId; 3],
) -> Option<Turn> {
    let points = tetrahedra.points();
    let [from, to] = [u, v].map(|end| points[end.index()]);
    let axis = (to - from).normalize();
    let arm = |vertex: VertexId| {
        let arm = points[vertex.index()] - from;
        arm - arm.dot(axis) * axis
    };
    let ahead = arm(apex).normalize();
    let outward = axis.cross(ahead);
    let place = |vertex: VertexId| DVec2::new(ahead.dot(arm(vertex)), outward.dot(arm(vertex)));
    let is_in_set = |facet: FacetId| {
        let seen = facet.min(tetrahedra.twin(facet));
        stages.pruned.binary_search(&seen).is_ok()
    };
    let mut turn = Turn {
        spokes: vec![(place(apex), true)],
        between: 0,
        finite: Vec::new(),
    };
    // Turning about u → v from the apex leads to the side from which (u, v, apex) runs counter-clockwise.
    let around: Vec<(TetId, FacetId)> = tetrahedra.around_edge(side.tet(), u, v)?.collect();
    for (count, (tet, out)) in around.iter().enumerate() {
        turn.finite.push(tetrahedra.is_finite(*tet));
        let third = tetrahedra
            .facet(*out)
            .into_iter()
            .find(|w| *w != u && *w != v)?;
        let is_met = is_in_set(*out);
        if is_met && turn.between == 0 {
            turn.between = count + 1;
        }
        if count + 1 < around.len() && third != Tetrahedralization::INFINITE {
            turn.spokes.push((place(third), is_met));
        }
    }
    Some(turn)
}

impl Turn {
    fn least_angle(&self) -> f64 {
        let next = self.spokes.iter().cycle().skip(1);
        (self.spokes.iter().zip(next))
            .map(|((a, _), (b, _))| a.angle_to(*b).abs())
            .fold(f64::INFINITY, f64::min)
    }

    fn panel(&self) -> Panel {
        let mut panel = Panel::plane(430.0, 400.0, DVec2::splat(-1.15), DVec2::splat(1.15));
        // Turned so that the outside is above.
        let end = self.spokes[self.between].0;
        let middle = {
            let [a, b] = [0.0, end.to_angle()];
            let full = if b < a { b + std::f64::consts::TAU } else { b };
            0.5 * (a + full)
        };
        let up = DVec2::from_angle(std::f64::consts::FRAC_PI_2 - middle);
        // All spokes of one length, the angles as they are.
        let rim: Vec<DVec2> = self
            .spokes
            .iter()
            .map(|(at, _)| up.rotate(at.normalize()))
            .collect();
        let label = Text::default().size(17.0).halo();
        for (i, from) in rim.iter().enumerate() {
            let to = rim[(i + 1) % rim.len()];
            let is_outside = i < self.between;
            let color = if is_outside {
                Color::YELLOW.mixed(Color::WHITE, 0.5)
            } else {
                Color::PALE.mixed(Color::WHITE, 0.5)
            };
            panel.polygon(
                &[DVec2::ZERO, *from, to],
                Style::fill(color).outlined(Color::GRAY, 1.0),
            );
            if is_outside {
                let name = format!("T{}", subscript(i + 1));
                panel.text(0.42 * (*from + to), &name, label.shift(0.0, 5.0));
            }
        }
        for (at, (_, is_in_set)) in rim.iter().zip(&self.spokes) {
            if *is_in_set {
                panel.line(DVec2::ZERO, *at, Style::stroke(Color::BLUE, 4.5));
            }
        }
        let arc: Vec<DVec2> = (4..=56)
            .map(|i| {
                let [start, stop] = [rim[0], rim[self.between]].map(DVec2::to_angle);
                let stop = if stop < start {
                    stop + std::f64::consts::TAU
                } else {
                    stop
                };
                0.2 * DVec2::from_angle(start + (stop - start) * f64::from(i) / 60.0)
            })
            .collect();
        panel.polyline(&arc, Style::stroke(Color::VERMILION, 2.2));
        panel.arrow(
            arc[arc.len() - 4],
            arc[arc.len() - 1],
            -4.0,
            Style::fill(Color::VERMILION).outlined(Color::VERMILION, 2.2),
        );
        panel.dot(DVec2::ZERO, 5.5, Style::fill(Color::BLACK));
        let bold = label.bold();
        panel.text(DVec2::ZERO, "e", bold.shift(0.0, 24.0));
        panel.text(1.08 * rim[0], "t", bold.color(Color::BLUE).shift(0.0, 6.0));
        panel.text(
            1.08 * rim[self.between],
            "t′",
            bold.color(Color::BLUE).shift(0.0, 6.0),
        );
        panel
    }
}

fn subscript(digit: usize) -> char {
    char::from_u32('₀' as u32 + digit as u32).unwrap_or('?')
}
