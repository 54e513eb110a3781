//! What points say of the tetrahedra: which are outside, which inside, and how loudly.
//!
//! All sizes are *widths*: lengths over the spacing of the points there.
//!
//! 1. A good vertex knows the two halves of its star. Sure are those with a wide tetrahedron in both and
//!    good neighbours; they are told to a [`Forest`] first.
//! 2. Where points are noisy there are no good vertices, but big empty balls, which lie wholly inside or
//!    wholly outside (Dey and Goswami 2006). From the widest down, tetrahedra on both sides of a wide facet,
//!    a *door*, are on the same side, unless that is known to be wrong. At a few widths on the way down,
//!    vertices look across: the ball before them and the first one behind them are on opposite sides, if enough
//!    vertices agree.
//! 3. The other good vertices follow.
//!
//! Then all of them vote.

use super::forest::Forest;
use super::scales::Scales;
use super::tet_ids;
use crate::facet_set::FacetSet;
use glam::DVec3;
use pellicle_delaunay::{FacetId, TetId};
use pellicle_geometry::VertexId;

/// A good vertex is sure where both halves have a tetrahedron this wide.
const SURE_WIDTH: f64 = 0.6;

/// And where this share of its neighbours is good: noise makes good vertices too, here and there.
const SURE_SHARE: f64 = 0.7;

/// Doors and balls are looked at from this width down: at these widths vertices look across.
const LEVELS: [f64; 8] = [4.0, 2.8, 2.0, 1.4, 1.0, 0.7, 0.5, 0.4];

/// How many more vertices must see two sets of balls on opposite sides than on the same.
const LEAST_MAJORITY: usize = 5;

/// How far vertices look across, over the spacing.
const REACH: f64 = 10.0;

/// After how many tetrahedra a vertex stops looking.
const MOST_STEPS: usize = 40;

/// What the votes of good vertices and of balls count at most, and what poles do; a facet of the boundary
/// costs about 1.
const GOOD_VOTE: f64 = 4.0;
const BALL_VOTE: f64 = 4.0;
const POLE_VOTE: f64 = 0.5;

/// From this width on balls have a full vote.
const FULL_WIDTH: f64 = 2.0;

/// What is known of the sides.
pub(super) struct Evidence {
    /// By tetrahedron: positive for inside, negative for outside.
    pub(super) votes: Vec<f64>,
    /// By tetrahedron: whether its vertices all are sure and agree, so that no cut may move it.
    pub(super) sure: Vec<bool>,
}

/// The tetrahedra around a good vertex, in the two parts that its umbrella leaves.
struct Halves {
    vertex: VertexId,
    tets: [Vec<TetId>; 2],
    /// The width of the widest tetrahedron of the narrower half.
    width: f64,
    /// The share of good vertices among its neighbours.
    share: f64,
}

/// The widest tetrahedron at a vertex, and the widest whose center lies the other way.
struct Poles {
    positive: TetId,
    negative: TetId,
    /// Towards the positive one.
    direction: DVec3,
}

impl Evidence {
    pub(super) fn of(scales: &Scales, surface: &FacetSet, good: &[bool]) -> Self {
        let canonical = scales.canonical;
        let mut forest = Forest::new(canonical.tets().len());
        let infinite = canonical.finite_count();
        for tet in infinite..canonical.tets().len() {
            forest.join(TetId::new(infinite), TetId::new(tet), false);
        }
        let halves = halves(scales, surface, good);
        let (sure, unsure): (Vec<_>, Vec<_>) = halves.iter().partition(|halves| halves.is_sure());
        sure.iter().for_each(|halves| halves.tell(&mut forest));
        let poles = poles(scales);
        open_doors(scales, surface, good, &poles, &mut forest);
        unsure.iter().for_each(|halves| halves.tell(&mut forest));

        let mut ballot = Ballot {
            scales,
            forest,
            votes: vec![0.0; canonical.tets().len()],
            sure_vertices: vec![0; canonical.tets().len()],
        };
        halves.iter().for_each(|halves| ballot.of_halves(halves));
        for (poles, _) in poles.iter().zip(good).filter(|(_, good)| !**good) {
            ballot.of_poles(poles);
        }
        ballot.of_balls();
        let full = 0.8 * 4.0 * GOOD_VOTE;
        Self {
            sure: tet_ids(canonical)
                .map(|tet| {
                    let agree = ballot.votes[tet.index()].abs() >= full;
                    !canonical.is_finite(tet) || agree && ballot.sure_vertices[tet.index()] == 4
                })
                .collect(),
            votes: ballot.votes,
        }
    }
}

/// The counting of votes.
struct Ballot<'b> {
    scales: &'b Scales<'b>,
    forest: Forest,
    votes: Vec<f64>,
    /// By tetrahedron, how many of its vertices are sure.
    sure_vertices: Vec<u8>,
}

impl Ballot<'_> {
    /// 1 where a tetrahedron is inside, −1 outside, none where nobody knows.
    fn sign(&mut self, tet: TetId) -> Option<f64> {
        let infinite = TetId::new(self.scales.canonical.finite_count());
        let is_inside = self.forest.are_opposite(infinite, tet)?;
        Some(if is_inside { 1.0 } else { -1.0 })
    }

    /// The signs of two tetrahedra that should lie on opposite sides, if they do.
    fn opposite_signs(&mut self, a: TetId, b: TetId) -> Option<[f64; 2]> {
        let signs = [self.sign(a)?, self.sign(b)?];
        (signs[0] != signs[1]).then_some(signs)
    }

    /// The sides as the vertex has them, if all the others left its halves apart.
    fn of_halves(&mut self, halves: &Halves) {
        let [Some(&a), Some(&b)] = halves.tets.each_ref().map(|half| half.first()) else {
            return;
        };
        let Some(signs) = self.opposite_signs(a, b) else {
            return;
        };
        let vote = GOOD_VOTE * halves.width.min(1.0) * halves.share.powi(2).max(0.05);
        for (half, sign) in halves.tets.iter().zip(signs) {
            for tet in half {
                self.votes[tet.index()] += sign * vote;
                self.sure_vertices[tet.index()] += u8::from(halves.is_sure());
            }
        }
    }

    fn of_poles(&mut self, poles: &Poles) {
        let (Some(a), Some(b)) = (poles.positive.some(), poles.negative.some()) else {
            return;
        };
        if let Some(signs) = self.opposite_signs(a, b) {
            let width = self.scales.tet_width(a).min(self.scales.tet_width(b));
            for (tet, sign) in [a, b].into_iter().zip(signs) {
                self.votes[tet.index()] += sign * POLE_VOTE * width.min(1.0);
            }
        }
    }

    fn of_balls(&mut self) {
        for tet in (0..self.scales.canonical.finite_count()).map(TetId::new) {
            let width = self.scales.tet_width(tet);
            if width >= LEVELS[LEVELS.len() - 1]
                && let Some(sign) = self.sign(tet)
            {
                let share = (width / FULL_WIDTH).min(1.0);
                self.votes[tet.index()] += sign * BALL_VOTE * share * share;
            }
        }
    }
}

impl Halves {
    fn is_sure(&self) -> bool {
        self.width >= SURE_WIDTH && self.share >= SURE_SHARE
    }

    fn tell(&self, forest: &mut Forest) {
        for half in &self.tets {
            for pair in half.windows(2) {
                forest.join(pair[0], pair[1], false);
            }
        }
        if let [Some(&a), Some(&b)] = self.tets.each_ref().map(|half| half.first()) {
            forest.join(a, b, true);
        }
    }
}

/// The halves at each good vertex, the widest first.
fn halves(scales: &Scales, surface: &FacetSet, good: &[bool]) -> Vec<Halves> {
    let canonical = scales.canonical;
    // By tetrahedron, the last vertex whose star it was found in.
    let mut seen = vec![VertexId::NONE; canonical.tets().len()];
    let mut halves: Vec<Halves> = Vec::new();
    for vertex in canonical.vertex_ids().filter(|v| good[v.index()]) {
        let mut tets = [Vec::new(), Vec::new()];
        let mut pending: Vec<(TetId, usize)> = canonical
            .incident(vertex)
            .map(|tet| (tet, 0))
            .into_iter()
            .collect();
        pending
            .iter()
            .for_each(|(tet, _)| seen[tet.index()] = vertex);
        while let Some((tet, half)) = pending.pop() {
            tets[half].push(tet);
            let own = canonical.corner_of(tet, vertex);
            for (corner, twin) in canonical.twins(tet).into_iter().enumerate() {
                let neighbor = twin.tet();
                if corner != own && seen[neighbor.index()] != vertex {
                    seen[neighbor.index()] = vertex;
                    pending.push((neighbor, half ^ usize::from(surface.contains(twin))));
                }
            }
        }
        let widest = |half: &Vec<TetId>| {
            half.iter()
                .map(|&tet| scales.tet_width(tet))
                .fold(0.0, f64::max)
        };
        halves.push(Halves {
            vertex,
            width: widest(&tets[0]).min(widest(&tets[1])),
            share: scales.share_of_neighbors(vertex, good),
            tets,
        });
    }
    halves.sort_by(|a, b| b.width.total_cmp(&a.width).then(a.vertex.cmp(&b.vertex)));
    halves
}

/// Step 2 of the module's list.
fn open_doors(
    scales: &Scales,
    surface: &FacetSet,
    good: &[bool],
    poles: &[Poles],
    forest: &mut Forest,
) {
    let canonical = scales.canonical;
    let width = |facet: FacetId| {
        let tets = scales.tet_width(facet.tet());
        let tets = tets.min(scales.tet_width(canonical.twin(facet).tet()));
        tets.min(scales.facet_width(facet))
    };
    let facets = canonical.facets().filter(|&facet| !surface.contains(facet));
    let mut doors: Vec<(f64, FacetId)> = facets
        .map(|facet| (width(facet), facet))
        .filter(|door| door.0 >= LEVELS[LEVELS.len() - 1])
        .collect();
    doors.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
    let mut doors = doors.into_iter().peekable();
    let lookouts: Vec<VertexId> = canonical
        .vertex_ids()
        .filter(|v| !good[v.index()] && poles[v.index()].positive != TetId::NONE)
        .collect();
    for level in LEVELS {
        while let Some((_, facet)) = doors.next_if(|door| door.0 >= level) {
            forest.join(facet.tet(), canonical.twin(facet).tet(), false);
        }
        look_across(scales, &lookouts, poles, level, forest);
    }
}

/// Joins the balls before and behind vertices as opposite where a majority of the vertices has them so.
fn look_across(
    scales: &Scales,
    lookouts: &[VertexId],
    poles: &[Poles],
    width: f64,
    forest: &mut Forest,
) {
    // Two roots each, the lower first, and whether those are seen on opposite sides.
    let mut sights: Vec<([TetId; 2], bool)> = Vec::new();
    for &vertex in lookouts {
        let poles = &poles[vertex.index()];
        if scales.tet_width(poles.positive) < width {
            continue;
        }
        let point = scales.canonical.point(vertex);
        let target = point - poles.direction * scales.spacings[vertex.index()] * REACH;
        let start = poles.negative.some().unwrap_or(poles.positive);
        if let Some(behind) = first_wide(scales, start, target, width) {
            let ((a, at_a), (b, at_b)) = (forest.find(poles.positive), forest.find(behind));
            if a != b {
                sights.push(([a.min(b), a.max(b)], at_a == at_b));
            }
        }
    }
    sights.sort_unstable();
    let mut majorities: Vec<(usize, [TetId; 2], bool)> = sights
        .chunk_by(|a, b| a.0 == b.0)
        .map(|of_pair| {
            let opposite = of_pair.iter().filter(|sight| sight.1).count();
            let same = of_pair.len() - opposite;
            (opposite.abs_diff(same), of_pair[0].0, opposite >= same)
        })
        .filter(|majority| majority.0 >= LEAST_MAJORITY)
        .collect();
    majorities.sort_by(|a, b| b.0.cmp(&a.0).then(a.1.cmp(&b.1)));
    for (_, [a, b], opposite) in majorities {
        forest.join(a, b, opposite);
    }
}

/// The first tetrahedron so wide on a walk from one towards a point.
fn first_wide(scales: &Scales, start: TetId, target: DVec3, width: f64) -> Option<TetId> {
    let mut tet = start;
    for _ in 0..MOST_STEPS {
        if scales.tet_width(tet) >= width {
            return Some(tet);
        }
        let towards = scales.facet_towards(tet, target)?;
        tet = scales.canonical.twin(towards).tet();
    }
    None
}

/// By vertex, the poles (Dey 2006): as for the cocones, but tetrahedra instead of their centers.
fn poles(scales: &Scales) -> Vec<Poles> {
    let canonical = scales.canonical;
    let nothing = || Poles {
        positive: TetId::NONE,
        negative: TetId::NONE,
        direction: DVec3::ZERO,
    };
    let mut poles: Vec<Poles> = canonical.vertex_ids().map(|_| nothing()).collect();
    let (finite, infinite) = canonical.tets().split_at(canonical.finite_count());
    for (k, tet) in infinite.iter().enumerate() {
        let outward = scales.normal(&tet[..3]);
        for vertex in &tet[..3] {
            poles[vertex.index()].direction += outward;
        }
        let tet_id = TetId::new(finite.len() + k);
        tet[..3]
            .iter()
            .for_each(|v| poles[v.index()].positive = tet_id);
    }
    let is_wider = |tet: TetId, than: TetId| scales.radius(tet) > scales.radius(than);
    for (tet, corners) in tet_ids(canonical).zip(finite) {
        for vertex in corners {
            let pole = &mut poles[vertex.index()];
            if pole.positive == TetId::NONE || is_wider(tet, pole.positive) {
                pole.positive = tet;
                pole.direction = scales.center(tet) - canonical.point(*vertex);
            }
        }
    }
    for pole in &mut poles {
        pole.direction = pole.direction.normalize_or_zero();
    }
    for (tet, corners) in tet_ids(canonical).zip(finite) {
        for vertex in corners {
            let pole = &mut poles[vertex.index()];
            let along = pole
                .direction
                .dot(scales.center(tet) - canonical.point(*vertex));
            if along < 0.0 && (pole.negative == TetId::NONE || is_wider(tet, pole.negative)) {
                pole.negative = tet;
            }
        }
    }
    poles
}
