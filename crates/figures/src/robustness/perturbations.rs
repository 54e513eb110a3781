//! The three symbolic perturbations on one degenerate set: what is flat, and whether the result is unique.

use super::planar::{Triangle, canonical};
use crate::sheet::{Color, Panel, Style, Text};
use crate::{Error, Figure, Made, Number, Paper, Random, Run, Sheet, Verdict};
use pellicle::delaunay;
use pellicle::glam::{DVec2, DVec3};
use pellicle::predicates::{Sign, lifted, orient2d, orient3d, sos, world};
use std::collections::BTreeSet;

pub(super) const FIGURE: Figure = Figure {
    name: "robustness-perturbations",
    paper: Paper::Robustness,
    number: "symbolic perturbations",
    title: "Three perturbations of a grid",
    shows: "compares perturbations: Simulation of Simplicity depends on the indices of the points and is heavy; perturbing the world does not; both \
            perturb orientations too and leave flat simplices; perturbing the lifted dimension leaves none, and the Delaunay triangulation is \
            uniquely defined.",
    make,
};

#[derive(Clone, Copy, PartialEq)]
enum Perturbation {
    Simplicity,
    World,
    Lifted,
}

/// The perturbed orientation and in-circle test of points with indices.
impl Perturbation {
    fn orient(self, points: &[DVec2], t: Triangle, index: &[u32]) -> Sign {
        let [a, b, c] = t.map(|i| points[i]);
        match self {
            Self::Simplicity => sos::orient2d([a, b, c], t.map(|i| index[i])),
            Self::World => world::orient2d(a, b, c),
            Self::Lifted => orient2d(a, b, c),
        }
    }

    fn incircle(self, points: &[DVec2], [a, b, c]: Triangle, d: usize, index: &[u32]) -> Sign {
        let corners = [a, b, c, d];
        let [pa, pb, pc, pd] = corners.map(|i| points[i]);
        match self {
            Self::Simplicity => sos::incircle([pa, pb, pc, pd], corners.map(|i| index[i])),
            Self::World => world::incircle(pa, pb, pc, pd),
            Self::Lifted => lifted::incircle(pa, pb, pc, pd),
        }
    }

    /// The triangles whose perturbed disc is empty: the Delaunay triangulation by its definition.
    fn triangulate(self, points: &[DVec2], index: &[u32]) -> Vec<Triangle> {
        let count = points.len();
        let mut triangles = Vec::new();
        for a in 0..count {
            for b in a + 1..count {
                for c in b + 1..count {
                    let t = match self.orient(points, [a, b, c], index) {
                        Sign::Positive => [a, b, c],
                        Sign::Negative => [a, c, b],
                        Sign::Zero => continue,
                    };
                    let outside =
                        |d| t.contains(&d) || self.incircle(points, t, d, index) != Sign::Positive;
                    if (0..count).all(outside) {
                        triangles.push(canonical(t));
                    }
                }
            }
        }
        triangles.sort_unstable();
        triangles
    }
}

fn grid(side: usize) -> Vec<DVec2> {
    let at = |i: usize| DVec2::new((i % side) as f64, (i / side) as f64);
    (0..side * side).map(at).collect()
}

/// A permutation of the indices from 1; seed 0 leaves them in their order.
fn indices(count: usize, seed: u64) -> Vec<u32> {
    let mut indices: Vec<u32> = (1..=count as u32).collect();
    if seed > 0 {
        let mut random = Random::new(seed, 3);
        for i in (1..count).rev() {
            indices.swap(i, (random.bits() % (i as u64 + 1)) as usize);
        }
    }
    indices
}

fn is_flat(points: &[DVec2], t: &Triangle) -> bool {
    let [a, b, c] = t.map(|i| points[i]);
    orient2d(a, b, c) == Sign::Zero
}

/// What one perturbation makes of the grid in many orders.
struct Tally {
    results: BTreeSet<Vec<Triangle>>,
    fewest_flat: usize,
    most_flat: usize,
}

/// The same points in other orders: the points are permuted, and take their indices from their new places.
fn tally(
    run: &Run<'_>,
    perturbation: Perturbation,
    points: &[DVec2],
    orders: u64,
) -> Result<Tally, Error> {
    let mut tally = Tally {
        results: BTreeSet::new(),
        fewest_flat: usize::MAX,
        most_flat: 0,
    };
    for seed in 0..orders {
        run.step("orders of the grid", seed, orders)?;
        let place = indices(points.len(), seed);
        let mut permuted = vec![DVec2::ZERO; points.len()];
        let mut origin = vec![0; points.len()];
        for (i, &to) in place.iter().enumerate() {
            permuted[to as usize - 1] = points[i];
            origin[to as usize - 1] = i;
        }
        let own = indices(points.len(), 0);
        let triangles = perturbation.triangulate(&permuted, &own);
        let mut named: Vec<Triangle> = triangles
            .iter()
            .map(|t| canonical(t.map(|i| origin[i])))
            .collect();
        named.sort_unstable();
        let flat = named.iter().filter(|t| is_flat(points, t)).count();
        tally.fewest_flat = tally.fewest_flat.min(flat);
        tally.most_flat = tally.most_flat.max(flat);
        tally.results.insert(named);
    }
    Ok(tally)
}

/// The corners of a box of unit cubes.
fn lattice([x, y, z]: [usize; 3]) -> Vec<DVec3> {
    let mut points = Vec::new();
    for i in 0..x * y * z {
        points.push(DVec3::new(
            (i % x) as f64,
            (i / x % y) as f64,
            (i / x / y) as f64,
        ));
    }
    points
}

/// The flat tetrahedra of a lattice, and all of them, by Simulation of Simplicity and by definition.
fn flat_of_simplicity(points: &[DVec3]) -> (usize, usize) {
    let count = points.len();
    let (mut flat, mut all) = (0, 0);
    for a in 0..count {
        for b in a + 1..count {
            for c in b + 1..count {
                for d in c + 1..count {
                    let corners = [a, b, c, d];
                    let index = corners.map(|i| i as u32 + 1);
                    let orientation = sos::orient3d(corners.map(|i| points[i]), index);
                    let outside = |e: usize| {
                        let five = [a, b, c, d, e];
                        let sign =
                            sos::insphere(five.map(|i| points[i]), five.map(|i| i as u32 + 1));
                        corners.contains(&e) || sign * orientation == Sign::Negative
                    };
                    if (0..count).all(outside) {
                        all += 1;
                        let [a, b, c, d] = corners.map(|i| points[i]);
                        flat += usize::from(orient3d(a, b, c, d) == Sign::Zero);
                    }
                }
            }
        }
    }
    (flat, all)
}

/// The same by `delaunay::tetrahedralize`, which perturbs the lifted dimension.
fn flat_of_lifted(points: &[DVec3]) -> Result<(usize, usize), Error> {
    let tetrahedra = delaunay::tetrahedralize(points, &delaunay::Options::default())?;
    let (mut flat, mut all) = (0, 0);
    for tet in tetrahedra.finite_tets() {
        let [a, b, c, d] = tet.map(|vertex| points[vertex.index()]);
        all += 1;
        flat += usize::from(orient3d(a, b, c, d) == Sign::Zero);
    }
    Ok((flat, all))
}

fn make(run: &Run<'_>) -> Result<Made, Error> {
    let side = run.effort.pick(4, 5);
    let orders = run.effort.pick(6, 30);
    let points = grid(side);
    let mut sheet = Sheet::new(3);
    let mut numbers = vec![
        Number::exactly("points of the grid", points.len() as f64),
        Number::exactly("orders of the points", orders as f64),
    ];
    let mut found = Vec::new();
    for (perturbation, name, words) in [
        (
            Perturbation::Simplicity,
            "SoS",
            "Simulation of Simplicity, one order of several",
        ),
        (Perturbation::World, "world", "the world perturbed"),
        (
            Perturbation::Lifted,
            "lifted",
            "the lifted dimension perturbed",
        ),
    ] {
        let tally = tally(run, perturbation, &points, orders)?;
        numbers.push(Number::exactly(
            format!("different triangulations, {name}"),
            tally.results.len() as f64,
        ));
        numbers.push(Number::exactly(
            format!("flat triangles at least, {name}"),
            tally.fewest_flat as f64,
        ));
        numbers.push(Number::exactly(
            format!("flat triangles at most, {name}"),
            tally.most_flat as f64,
        ));
        if let Some(triangles) = tally.results.first() {
            sheet.push(picture(&points, triangles).caption(words));
        }
        found.push(tally);
    }
    let lattice = lattice(run.effort.pick([2, 2, 2], [3, 2, 2]));
    run.step("flat tetrahedra", 0, 1)?;
    let (flat, all) = flat_of_simplicity(&lattice);
    let (flat_lifted, all_lifted) = flat_of_lifted(&lattice)?;
    for (name, flat, all) in [("SoS", flat, all), ("lifted", flat_lifted, all_lifted)] {
        numbers.push(Number::exactly(
            format!(
                "tetrahedra of {} points of a lattice, {name}",
                lattice.len()
            ),
            all as f64,
        ));
        numbers.push(Number::exactly(
            format!("flat ones of them, {name}"),
            flat as f64,
        ));
    }
    let [simplicity, world, lifted] = &found[..] else {
        return Err(Error::NotShown("three perturbations".into()));
    };
    let as_said = simplicity.results.len() > 1
        && world.results.len() == 1
        && world.most_flat > 0
        && lifted.results.len() == 1
        && lifted.most_flat == 0
        && flat_lifted == 0;
    Ok(Made {
        sheet,
        numbers,
        verdict: if as_said {
            Verdict::Agrees
        } else {
            Verdict::Different
        },
        because: format!(
            "As the slides say. {orders} orders of a grid of {side} × {side} points give {} triangulations by Simulation of Simplicity, with {} to {} \
             flat triangles; one by perturbing the world, with {}; one by perturbing the lifted dimension, with none. In space \
             Simulation of Simplicity makes {flat} of {all} tetrahedra of a small lattice flat, `delaunay::tetrahedralize` {flat_lifted} of \
             {all_lifted}.",
            simplicity.results.len(),
            simplicity.fewest_flat,
            simplicity.most_flat,
            world.most_flat,
        ),
    })
}

fn picture(points: &[DVec2], triangles: &[Triangle]) -> Panel {
    let max = points.iter().copied().fold(DVec2::ZERO, DVec2::max);
    let mut panel = Panel::plane(
        280.0,
        300.0,
        DVec2::new(-0.5, -0.9),
        max + DVec2::splat(0.5),
    );
    let (flat, solid): (Vec<&Triangle>, Vec<&Triangle>) =
        triangles.iter().partition(|t| is_flat(points, t));
    for t in solid {
        let fill = Color::SKY.mixed(Color::WHITE, 0.7);
        panel.polygon(
            &t.map(|i| points[i]),
            Style::fill(fill).outlined(Color::GRAY, 1.0),
        );
    }
    // A flat triangle is its longest edge: drawn bulged away from the middle, so that each shows.
    for t in &flat {
        let mut corners = t.map(|i| points[i]);
        corners.sort_by(|p, q| lifted::lexicographic2d(*p, *q));
        let [a, b, c] = corners;
        let outward =
            (b - max / 2.0).dot((c - a).perp()).signum() * (c - a).perp().normalize_or_zero();
        let bulge = outward * 0.09 * (c - a).length();
        let style = Style::fill(Color::VERMILION).outlined(Color::VERMILION, 1.0);
        panel.polygon(
            &[
                a,
                b,
                c,
                c + bulge * 0.2,
                (a + c) / 2.0 + bulge,
                a + bulge * 0.2,
            ],
            style.opacity(0.8),
        );
    }
    for &point in points {
        panel.dot(point, 3.0, Style::fill(Color::BLACK));
    }
    let words = format!("{} triangles, {} of them flat", triangles.len(), flat.len());
    let color = if flat.is_empty() {
        Color::BLACK
    } else {
        Color::VERMILION
    };
    panel.text_at_pixel(
        DVec2::new(140.0, 292.0),
        &words,
        Text::default().color(color),
    );
    panel
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whatever is flat has no area: the others cover the grid exactly, and there are as many triangles as Euler's formula
    /// says for the points of the perturbed hull.
    #[test]
    fn every_perturbation_triangulates_the_grid() {
        let points = grid(3);
        for perturbation in [
            Perturbation::Simplicity,
            Perturbation::World,
            Perturbation::Lifted,
        ] {
            let triangles = perturbation.triangulate(&points, &indices(9, 0));
            let area: f64 = triangles
                .iter()
                .map(|t| {
                    let [a, b, c] = t.map(|i| points[i]);
                    (b - a).perp_dot(c - a)
                })
                .sum();
            assert_eq!(area, 8.0);
            let sides: BTreeSet<[usize; 2]> = triangles
                .iter()
                .flat_map(|&t| super::super::planar::edges(t))
                .collect();
            assert_eq!(
                sides.len(),
                3 * triangles.len(),
                "an edge has two triangles on one side"
            );
            let hull = sides
                .iter()
                .filter(|[a, b]| !sides.contains(&[*b, *a]))
                .count();
            assert_eq!(triangles.len(), 2 * points.len() - 2 - hull);
        }
    }
}
