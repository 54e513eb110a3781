//! Figure 4.1: a pole, and a cocone.

use super::measured::{line_angle, pole_bound, restricted_delaunay, stages};
use super::surface::Surface;
use crate::scene::Scene;
use crate::sheet::{Anchor, Color, Style, Text};
use crate::{Error, Made, Number, Random, Run, Sheet, Verdict};
use pellicle::delaunay::{FacetId, VoronoiCell, VoronoiVertex};
use pellicle::prelude::*;
use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::{PI, TAU};

const SURFACE: Surface = Surface::Torus { tube: 0.4 };

/// cos(3π/8).
const COCONE_COSINE: f64 = 0.382_683_432_365_089_8;

/// Half the opening of the cocone: π/2 − 3π/8.
const HALF_OPENING: f64 = PI / 8.0;

/// The Voronoi cell of a point at the inner side of a torus: its poles are near the ring in the tube and near the axis.
pub fn make(run: &Run) -> Result<Made, Error> {
    let points = SURFACE.scatter(0.34, &mut Random::new(41, 0));
    let tetrahedra = tetrahedralize(&points, &delaunay::Options::default())?;
    let (stages, _) = stages(&tetrahedra)?;
    run.step("figure", 1, 2)?;

    // T by the definition, for all points, beside the library's.
    let mut met_by: BTreeMap<VertexId, BTreeSet<FacetId>> = BTreeMap::new();
    for facet in tetrahedra.facets() {
        for corner in tetrahedra.facet(facet) {
            let vector = stages.pole_vectors[corner.index()];
            if meets_cocone(&tetrahedra, facet, corner, vector) {
                met_by.entry(corner).or_default().insert(facet);
            }
        }
    }
    let by_definition: BTreeSet<FacetId> = met_by.values().flatten().copied().collect();
    let candidates: BTreeSet<FacetId> = stages.candidates.iter().copied().collect();
    let differing = by_definition.symmetric_difference(&candidates).count();
    let mut restricted_at: BTreeMap<VertexId, BTreeSet<FacetId>> = BTreeMap::new();
    for (facet, _) in restricted_delaunay(SURFACE, &tetrahedra) {
        for corner in tetrahedra.facet(facet) {
            restricted_at.entry(corner).or_default().insert(facet);
        }
    }
    let restricted: BTreeSet<FacetId> = restricted_at.values().flatten().copied().collect();
    let missed = restricted.difference(&by_definition).count();

    // Of the points whose cocone meets more than the surface does, the one nearest to the inner equator.
    let from_equator = |v: &VertexId| {
        let p = points[v.index()];
        libm::hypot(p.truncate().length() - 0.6, p.z)
    };
    let has_others = |v: &&VertexId| met_by[*v].len() > restricted_at[*v].len() + 1;
    let vertex = (restricted_at.keys())
        .filter(has_others)
        .min_by(|a, b| from_equator(a).total_cmp(&from_equator(b)))
        .copied()
        .ok_or_else(|| Error::NotShown("a cocone that meets more than the surface".into()))?;
    let cell = (tetrahedra.voronoi_cell(vertex))
        .filter(VoronoiCell::is_bounded)
        .ok_or_else(|| Error::NotShown("a bounded cell".into()))?;
    let shown = Shown::new(&tetrahedra, &cell, stages.pole_vectors[vertex.index()]);
    let (met_here, here) = (&met_by[&vertex], &restricted_at[&vertex]);
    let missed_here = here.difference(met_here).count();
    let [_, epsilon] = SURFACE.epsilon(&points);
    let angle = line_angle(SURFACE.normal(shown.p), shown.pole_vector);

    let sheet = Sheet::new(3)
        .with(shown.cell().caption(
            "The Voronoi cell V_p of a sample point p of a torus, long and thin across the surface. The pole vector v_p from \
             p to the farthest corner p⁺ stands in for the normal n_p.",
        ))
        .with(shown.cocone().caption(
            "Near p: the cocone C_p (blue) is what the double cone of 3π/8 about v_p leaves of the cell. It holds the \
             restricted cell V_p|Σ (orange).",
        ))
        .with(shown.triangles(&tetrahedra, met_here, here).caption(
            "The triangles dual to the Voronoi edges that meet C_p: all restricted Delaunay triangles at p (orange), and \
             others (blue).",
        ));
    let holds = differing == 0 && missed == 0 && angle <= pole_bound(epsilon);
    Ok(Made {
        sheet,
        numbers: vec![
            Number::exactly("sample points", points.len() as f64),
            Number::within("ε of the sample", epsilon, 1e-9),
            Number::within("angle between v_p and n_p", angle.to_degrees(), 1e-7).unit("°"),
            Number::within("lemma 4.1 allows", pole_bound(epsilon).to_degrees(), 1e-9).unit("°"),
            Number::within("height of the cell over width of its cocone", shown.slenderness(), 1e-9),
            Number::exactly("Voronoi edges of the cell that meet its cocone", met_here.len() as f64),
            Number::exactly("Voronoi edges of the cell that meet the surface", here.len() as f64),
            Number::exactly("of these, missed by the cocone", missed_here as f64).paper("0"),
            Number::exactly("restricted Delaunay triangles missed, all points", missed as f64).paper("0"),
            Number::exactly("triangles in which definition 4.2 and the library differ", differing as f64),
        ],
        verdict: if holds { Verdict::Agrees } else { Verdict::Different },
        because: "A cell and a cocone of a real sample, seen as in the figure, whose drawing is schematic. The triangles that \
                  the library takes are, for every point, those of definition 4.2 with the condition that the text garbles \
                  (an end of the Voronoi edge in the cocone, or the ends in opposite nappes)."
            .into(),
    })
}

/// Whether the Voronoi edge dual to the facet meets the cocone of a corner: an end is in it, or the ends lie in opposite nappes
/// of the double cone.
fn meets_cocone(
    tetrahedra: &Tetrahedralization,
    facet: FacetId,
    corner: VertexId,
    vector: DVec3,
) -> bool {
    let p = tetrahedra.points()[corner.index()];
    let cosines = tetrahedra.voronoi_edge(facet).ends.map(|end| match end {
        VoronoiVertex::Finite(v) => vector.dot(v - p) / (v - p).length(),
        VoronoiVertex::Infinite(direction) => vector.dot(direction),
    });
    cosines.iter().any(|cosine| cosine.abs() <= COCONE_COSINE) || cosines[0] * cosines[1] < 0.0
}

/// What the panels draw.
struct Shown {
    p: DVec3,
    normal: DVec3,
    pole_vector: DVec3,
    poles: [DVec3; 2],
    polygons: Vec<Vec<DVec3>>,
    /// The points whose cells are neighbours.
    neighbors: Vec<DVec3>,
    /// The boundary of the restricted cell.
    restricted: Vec<DVec3>,
}

impl Shown {
    fn new(tetrahedra: &Tetrahedralization, cell: &VoronoiCell, pole_vector: DVec3) -> Self {
        let p = tetrahedra.points()[cell.vertex.index()];
        let polygons: Vec<Vec<DVec3>> = (cell.facets.iter())
            .map(|facet| {
                let finite = facet.vertices.iter().filter_map(|vertex| match vertex {
                    VoronoiVertex::Finite(v) => Some(*v),
                    VoronoiVertex::Infinite(_) => None,
                });
                finite.collect()
            })
            .collect();
        let farthest = |is_wanted: &dyn Fn(DVec3) -> bool| {
            let corners = polygons.iter().flatten().copied().filter(|v| is_wanted(*v));
            corners.fold(p, |best, v| {
                if v.distance(p) > best.distance(p) {
                    v
                } else {
                    best
                }
            })
        };
        let positive = farthest(&|_| true);
        let negative = farthest(&|v| (v - p).dot(positive - p) < 0.0);
        let others = cell.facets.iter().map(|facet| facet.edge[1]);
        let mut shown = Self {
            p,
            normal: SURFACE.normal(p),
            pole_vector,
            poles: [positive, negative],
            neighbors: others.map(|v| tetrahedra.points()[v.index()]).collect(),
            polygons,
            restricted: Vec::new(),
        };
        shown.restricted = (0..96)
            .map(|i| shown.restricted_boundary(TAU * f64::from(i) / 96.0))
            .collect();
        shown
    }

    /// A unit vector at a right angle to `axis`, turned about it.
    fn across(axis: DVec3, turn: f64) -> DVec3 {
        let (x, y) = axis.any_orthonormal_pair();
        let (sin, cos) = libm::sincos(turn);
        cos * x + sin * y
    }

    /// Where the surface leaves the cell in a tangent direction.
    fn restricted_boundary(&self, turn: f64) -> DVec3 {
        let tangent = Self::across(self.normal, turn);
        let at = |s: f64| {
            let x = self.p + s * tangent;
            x - SURFACE.distance(x) * SURFACE.normal(x)
        };
        let is_inside = |x: DVec3| {
            self.neighbors
                .iter()
                .all(|q| x.distance(self.p) <= x.distance(*q))
        };
        let (mut near, mut far) = (0.0, 0.01);
        while is_inside(at(far)) && far < 1.0 {
            near = far;
            far += 0.01;
        }
        for _ in 0..40 {
            let middle = 0.5 * (near + far);
            if is_inside(at(middle)) {
                near = middle
            } else {
                far = middle
            }
        }
        at(near)
    }

    /// Where a ray from p leaves the cell.
    fn boundary(&self, direction: DVec3) -> DVec3 {
        let reach = (self.neighbors.iter())
            .map(|&q| (q - self.p, direction.dot(q - self.p)))
            .filter(|(_, along)| *along > 0.0)
            .map(|(to, along)| 0.5 * to.length_squared() / along)
            .fold(f64::INFINITY, f64::min);
        self.p + reach * direction
    }

    /// The distance of the poles over twice the largest distance in the cocone.
    fn slenderness(&self) -> f64 {
        let height: f64 = self.poles[0].distance(self.poles[1]);
        let width = (0..360)
            .flat_map(|i| {
                [-1.0, -0.5, 0.0, 0.5, 1.0]
                    .map(|k| self.cocone_direction(f64::from(i) * TAU / 360.0, k))
            })
            .map(|direction| self.boundary(direction).distance(self.p))
            .fold(0.0, f64::max);
        height / (2.0 * width)
    }

    /// A direction in the cocone, `share` of its half opening above the plane across the pole vector.
    fn cocone_direction(&self, turn: f64, share: f64) -> DVec3 {
        let (sin, cos) = libm::sincos(share * HALF_OPENING);
        cos * Self::across(self.pole_vector, turn) + sin * self.pole_vector
    }

    /// To the right in the picture: where the normal leans.
    fn right(&self) -> DVec3 {
        let up = self.pole_vector;
        let outward = self.normal * self.normal.dot(up).signum();
        (outward - outward.dot(up) * up).normalize_or(Self::across(up, 0.0))
    }

    /// The pole vector up, seen from `above` by this share.
    fn scene(&self, above: f64) -> Scene {
        let up = self.pole_vector;
        Scene::new(self.right().cross(up) + above * up, up)
    }

    fn cell(&self) -> crate::sheet::Panel {
        let mut scene = self.scene(0.22);
        for polygon in &self.polygons {
            scene.area(
                polygon,
                Style::fill(Color::SKY.mixed(Color::WHITE, 0.55)).opacity(0.35),
            );
            let mut closed = polygon.clone();
            closed.extend(polygon.first());
            scene.line(
                &closed,
                Style::stroke(Color::BLUE.mixed(Color::BLACK, 0.2), 0.9),
            );
        }
        scene.area_over(
            &self.restricted,
            Style::fill(Color::ORANGE)
                .outlined(Color::BLACK, 0.8)
                .opacity(0.8),
        );
        let [positive, negative] = self.poles;
        let length = self.pole_vector.dot(positive - self.p);
        let tip = self.p + 0.62 * length * self.normal * self.normal.dot(self.pole_vector).signum();
        scene.arrow_over(self.p, tip, Style::stroke(Color::GREEN, 2.4));
        scene.arrow_over(self.p, positive, Style::stroke(Color::VERMILION, 1.8));
        for (place, name) in [(positive, "p⁺"), (negative, "p⁻"), (self.p, "p")] {
            scene.dot_over(place, 3.5, Style::fill(Color::BLACK));
            scene.words(
                place,
                name,
                Text::default()
                    .size(16.0)
                    .bold()
                    .halo()
                    .anchor(Anchor::Start)
                    .shift(8.0, 5.0),
            );
        }
        let label = Text::default().size(15.0).halo();
        scene.words(
            tip,
            "n_p",
            label
                .color(Color::GREEN)
                .anchor(Anchor::Start)
                .shift(9.0, 4.0),
        );
        let middle = self.p + 0.82 * (positive - self.p);
        scene.words(
            middle,
            "v_p",
            label
                .color(Color::VERMILION)
                .anchor(Anchor::Start)
                .shift(8.0, 0.0),
        );
        scene.panel(380.0, 460.0)
    }

    fn cocone(&self) -> crate::sheet::Panel {
        const TURNS: u32 = 60;
        let mut scene = self.scene(0.22);
        let turn = |i: u32| f64::from(i) * TAU / f64::from(TURNS);
        let rim = |share: f64| -> Vec<DVec3> {
            (0..=TURNS)
                .map(|i| self.boundary(self.cocone_direction(turn(i), share)))
                .collect()
        };
        let radius = rim(0.0)
            .iter()
            .map(|r| r.distance(self.p))
            .fold(0.0, f64::max);
        // The cell near p, behind and before.
        for polygon in &self.polygons {
            let mut closed = polygon.clone();
            closed.extend(polygon.first());
            scene.line(&closed, Style::stroke(Color::SKY, 0.9));
        }
        let blue = Color::SKY.mixed(Color::BLUE, 0.4);
        // Its sides on the boundary of the cell, and on the two nappes.
        for i in 0..TURNS {
            for [low, high] in [[-1.0, -0.5], [-0.5, 0.0], [0.0, 0.5], [0.5, 1.0]] {
                let at = |i: u32, share: f64| self.boundary(self.cocone_direction(turn(i), share));
                let corners = [at(i, low), at(i + 1, low), at(i + 1, high), at(i, high)];
                let color = scene.shaded(&corners, blue);
                scene.area(&corners, Style::fill(color).opacity(0.5));
            }
            for share in [-1.0, 1.0] {
                let [a, b] =
                    [i, i + 1].map(|i| self.boundary(self.cocone_direction(turn(i), share)));
                let corners = [self.p, a, b];
                let color = scene.shaded(&corners, blue);
                scene.area(&corners, Style::fill(color).opacity(0.35));
            }
        }
        for share in [-1.0, 1.0] {
            scene.line(
                &rim(share),
                Style::stroke(Color::BLUE.mixed(Color::BLACK, 0.3), 1.0),
            );
            // The nappe itself, as far as the picture goes.
            for i in (0..TURNS).step_by(6) {
                let end = self.p + 1.3 * radius * self.cocone_direction(turn(i), share);
                scene.line(&[self.p, end], Style::stroke(Color::GRAY, 0.7).dashed(4.0));
            }
        }
        scene.area_over(
            &self.restricted,
            Style::fill(Color::ORANGE)
                .outlined(Color::BLACK, 0.8)
                .opacity(0.75),
        );
        self.point_and_pole_vector(&mut scene, 0.95 * radius);
        let low = self.boundary(self.cocone_direction(4.2, -1.0));
        let label = Text::default().size(15.0).halo();
        scene.words(low, "C_p", label.color(Color::BLUE).shift(0.0, 34.0));
        for end in [1.0, -1.0] {
            for side in [1.0, -1.0] {
                let corner = side * self.right() + 0.9 * end * self.pole_vector;
                scene.fit(self.p + 1.1 * radius * corner);
            }
        }
        scene.panel(440.0, 460.0)
    }

    /// The point p, and the arrow v_p from it, so long.
    fn point_and_pole_vector(&self, scene: &mut Scene, length: f64) {
        let tip = self.p + length * self.pole_vector;
        scene.arrow_over(self.p, tip, Style::stroke(Color::VERMILION, 1.8));
        scene.dot_over(self.p, 3.5, Style::fill(Color::BLACK));
        let label = Text::default().size(15.0).halo();
        scene.words(
            tip,
            "v_p",
            label
                .color(Color::VERMILION)
                .anchor(Anchor::Start)
                .shift(8.0, 4.0),
        );
        scene.words(
            self.p,
            "p",
            label.bold().anchor(Anchor::Start).shift(7.0, -5.0),
        );
    }

    fn triangles(
        &self,
        tetrahedra: &Tetrahedralization,
        met: &BTreeSet<FacetId>,
        restricted: &BTreeSet<FacetId>,
    ) -> crate::sheet::Panel {
        let mut scene = self.scene(1.3);
        for &facet in met {
            let corners = tetrahedra
                .facet(facet)
                .map(|v| tetrahedra.points()[v.index()]);
            let is_restricted = restricted.contains(&facet);
            let color = if is_restricted {
                Color::ORANGE
            } else {
                Color::BLUE
            };
            scene.face(&corners, color.mixed(Color::WHITE, 0.35));
        }
        let radius = self
            .restricted
            .iter()
            .map(|r| r.distance(self.p))
            .fold(0.0, f64::max);
        let outline: Vec<DVec3> = self
            .restricted
            .iter()
            .chain(self.restricted.first())
            .copied()
            .collect();
        scene.line_over(&outline, Style::stroke(Color::BLACK, 1.2).dashed(4.0));
        self.point_and_pole_vector(&mut scene, 2.0 * radius);
        scene.panel(380.0, 460.0)
    }
}
