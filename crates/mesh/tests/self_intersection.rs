//! The triangle–triangle test against rational linear algebra, and the search against all pairs.

mod common;

use common::*;
use dashu::Rational;
use pellicle_geometry::{Cancelled, DVec3, Progress, VertexId};
use pellicle_mesh::{
    MeshError, MeshView, TriangleId, TriangleSoup, count_self_intersections, self_intersections,
    triangles_intersect,
};
use proptest::prelude::*;
use std::ops::ControlFlow;

type Point = [Rational; 3];

fn rational(p: DVec3) -> Point {
    p.to_array().map(|x| Rational::try_from(x).expect("finite"))
}

/// The only solution of `rows · x = right`, if there is exactly one: Gaussian elimination.
fn solve(mut rows: Vec<Vec<Rational>>, unknowns: usize) -> Option<Vec<Rational>> {
    for column in 0..unknowns {
        let pivot = (column..rows.len()).find(|&r| rows[r][column] != Rational::ZERO)?;
        rows.swap(column, pivot);
        let scale = rows[column][column].clone();
        for entry in &mut rows[column] {
            *entry = &*entry / &scale;
        }
        let head = rows[column].clone();
        for (r, row) in rows.iter_mut().enumerate() {
            if r != column && row[column] != Rational::ZERO {
                let factor = row[column].clone();
                for (entry, above) in row.iter_mut().zip(&head) {
                    *entry = &*entry - &factor * above;
                }
            }
        }
    }
    let consistent = rows[unknowns..]
        .iter()
        .all(|row| row[unknowns] == Rational::ZERO);
    consistent.then(|| {
        rows[..unknowns]
            .iter()
            .map(|row| row[unknowns].clone())
            .collect()
    })
}

/// Points whose hull is the intersection of the hulls of `a` and `b`: the images of the basic feasible
/// solutions of Σ λᵢ aᵢ = Σ μⱼ bⱼ, Σ λᵢ = Σ μⱼ = 1, λ, μ ≥ 0. No geometry, so no special case.
fn intersection(a: &[Point], b: &[Point]) -> Vec<Point> {
    let columns: Vec<(usize, bool)> = (0..a.len())
        .map(|i| (i, true))
        .chain((0..b.len()).map(|j| (j, false)))
        .collect();
    let mut found = Vec::new();
    for mask in 1_u32..1 << columns.len() {
        let basis: Vec<_> = columns
            .iter()
            .enumerate()
            .filter(|(k, _)| mask >> k & 1 == 1)
            .map(|(_, c)| *c)
            .collect();
        if basis.len() > 5 {
            continue;
        }
        let mut rows: Vec<Vec<Rational>> = (0..3)
            .map(|axis| {
                let mut row: Vec<Rational> = basis
                    .iter()
                    .map(|&(i, first)| {
                        if first {
                            a[i][axis].clone()
                        } else {
                            -b[i][axis].clone()
                        }
                    })
                    .collect();
                row.push(Rational::ZERO);
                row
            })
            .collect();
        for side in [true, false] {
            let mut row: Vec<Rational> = basis
                .iter()
                .map(|&(_, first)| {
                    if first == side {
                        Rational::ONE
                    } else {
                        Rational::ZERO
                    }
                })
                .collect();
            row.push(Rational::ONE);
            rows.push(row);
        }
        let Some(weights) = solve(rows, basis.len()) else {
            continue;
        };
        if weights.iter().any(|w| *w < Rational::ZERO) {
            continue;
        }
        let mut point: Point = [Rational::ZERO, Rational::ZERO, Rational::ZERO];
        for (&(i, _), weight) in basis.iter().zip(&weights).filter(|((_, first), _)| *first) {
            for axis in 0..3 {
                point[axis] = &point[axis] + weight * &a[i][axis];
            }
        }
        found.push(point);
    }
    found
}

/// The definition: the intersection has a point outside the hull of the common corners, or all are common.
fn oracle(first: [DVec3; 3], second: [DVec3; 3]) -> bool {
    let (a, b) = (first.map(rational), second.map(rational));
    let common: Vec<Point> = a.iter().filter(|p| b.contains(p)).cloned().collect();
    if a.iter().all(|p| b.contains(p)) && b.iter().all(|p| a.contains(p)) {
        return true;
    }
    let in_hull = |p: &Point| {
        !common.is_empty() && !intersection(std::slice::from_ref(p), &common).is_empty()
    };
    intersection(&a, &b).iter().any(|p| !in_hull(p))
}

fn check(first: [DVec3; 3], second: [DVec3; 3]) -> bool {
    let expected = oracle(first, second);
    let show = || format!("check({first:?}, {second:?}) should be {expected}");
    for (i, j) in [(0, 0), (1, 0), (2, 1), (0, 2)] {
        let (mut t, mut u) = (first, second);
        t.rotate_left(i);
        u.rotate_left(j);
        assert_eq!(triangles_intersect(t, u), expected, "{}", show());
        t.swap(0, 1);
        assert_eq!(triangles_intersect(u, t), expected, "{}", show());
    }
    expected
}

/// Corners from a small grid: most pairs are degenerate in some way.
fn grid_pair(size: u8) -> impl Strategy<Value = [[DVec3; 3]; 2]> {
    let corner =
        move || [0..size, 0..size, 0..size].prop_map(|p| DVec3::from_array(p.map(f64::from)));
    let triangle = move || [corner(), corner(), corner()];
    // Often make the second share corners with the first.
    (triangle(), triangle(), 0..6).prop_map(|(t, mut u, shared)| {
        match shared {
            0 => {}
            1 | 2 => u[0] = t[1],
            3 | 4 => {
                u[1] = t[0];
                u[0] = t[2];
            }
            _ => u = [t[1], t[0], u[2]],
        }
        [t, u]
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1200))]

    #[test]
    fn small_grids_agree_with_rationals([t, u] in prop_oneof![grid_pair(2), grid_pair(3), grid_pair(5)]) {
        check(t, u);
    }

    #[test]
    fn flat_pairs_agree_with_rationals([t, u] in grid_pair(4), normal in 0..3_usize) {
        // All in one plane, that of the axis or a slanted one.
        for slanted in [false, true] {
            let flat = |p: DVec3| {
                let mut q = p;
                q[normal] = if slanted { 2.0 * p[(normal + 1) % 3] - p[(normal + 2) % 3] } else { 1.0 };
                q
            };
            check(t.map(flat), u.map(flat));
        }
    }

    #[test]
    fn rounded_pairs_agree_with_rationals([t, u] in grid_pair(4), exponent in -300..300) {
        // Tenths are not on the lines that they seem to be on: nearly degenerate.
        let s = 0.1 * 2_f64.powi(exponent);
        check(t.map(|p| p * s), u.map(|p| p * s));
        check(t.map(|p| p * 0.1 + 1e5), u.map(|p| p * 0.1 + 1e5));
    }
}

#[test]
fn every_pair_over_the_corners_of_a_cube_agrees_with_rationals() {
    let cube: Vec<DVec3> = (0..8_u8)
        .map(|i| DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2)))
        .collect();
    let mut triangles = Vec::new();
    for a in 0..8 {
        for b in a..8 {
            for c in b..8 {
                triangles.push([cube[a], cube[b], cube[c]]);
            }
        }
    }
    let mut intersecting = 0;
    for (i, &t) in triangles.iter().enumerate() {
        // The first triangle's order stands for all: the test is symmetric, which `check` verifies.
        for &u in &triangles[i..] {
            intersecting += usize::from(check(t, u));
        }
    }
    assert!(
        intersecting > 500 && intersecting < triangles.len().pow(2) / 4,
        "{intersecting}"
    );
}

/// Two triangles without area that cross in a corner inside both fit: they have it in common.
#[test]
fn segments_that_cross_in_a_common_corner_fit() {
    let m = DVec3::ONE;
    let [x, y] = [DVec3::X, DVec3::Y];
    assert!(!check([m, m + x, m - x], [m, m + y, m - y]));
    assert!(check([m + x, m + x, m - x], [m, m + y, m - y]));
    assert!(check([m + x, m + x, m - x], [m + y, m + y, m - y]));
}

fn brute_force(view: MeshView) -> Vec<(TriangleId, TriangleId)> {
    let n = view.triangles.len() as u32;
    let pairs = (0..n).flat_map(|s| (s + 1..n).map(move |t| (TriangleId(s), TriangleId(t))));
    let corners = |t| {
        view.corners(t)
            .filter(|c: &[DVec3; 3]| c.iter().all(|p| p.is_finite()))
    };
    pairs
        .filter(|&(s, t)| match (corners(s), corners(t)) {
            (Some(a), Some(b)) => oracle(a, b),
            _ => false,
        })
        .collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    #[test]
    fn the_search_finds_all_pairs(
        points in prop::collection::vec([0..4_u8, 0..4_u8, 0..4_u8], 1..12),
        triangles in prop::collection::vec([0..13_u32, 0..13_u32, 0..13_u32], 0..16),
    ) {
        let mut positions: Vec<DVec3> = points.iter().map(|p| DVec3::from_array(p.map(f64::from))).collect();
        positions[0].x = f64::NAN;
        let soup = soup(positions, &triangles);
        let expected = brute_force((&soup).into());
        prop_assert_eq!(self_intersections((&soup).into(), &()).unwrap(), expected.clone());
        prop_assert_eq!(count_self_intersections((&soup).into(), &()).unwrap(), expected.len() as u64);
    }
}

fn count(soup: &TriangleSoup) -> u64 {
    count_self_intersections(soup.into(), &()).unwrap()
}

#[test]
fn embedded_surfaces_have_none() {
    for soup in [
        cube(),
        tetrahedron(),
        sphere(4),
        torus(2.0, 0.5, 40, 20),
        moebius(30),
        sheet(20, 10),
    ] {
        assert_eq!(count(&soup), 0);
    }
    // Vertices copied by cutting have equal coordinates: still none.
    let mut cut = sheet(3, 3);
    let last = cut.positions.len() as u32;
    cut.positions.push(cut.positions[5]);
    for v in cut.triangles[4..].as_flattened_mut() {
        if v.0 == 5 {
            *v = VertexId(last);
        }
    }
    assert_eq!(count(&cut), 0);
}

#[test]
fn two_cubes_through_each_other_have_some() {
    // A duplicate of everything: each triangle meets its copy, and no other badly but in the same plane.
    let twice = together(cube(), cube());
    assert_eq!(
        self_intersections((&twice).into(), &()).unwrap(),
        brute_force((&twice).into())
    );
    let apart = together(cube(), moved(cube(), DVec3::new(1.5, 0.0, 0.0)));
    assert_eq!(count(&apart), 0);
    let through = together(cube(), moved(cube(), DVec3::splat(0.5)));
    let pairs = self_intersections((&through).into(), &()).unwrap();
    assert_eq!(pairs, brute_force((&through).into()));
    assert!(pairs.len() >= 6);
}

#[test]
fn any_number_of_threads_finds_the_same() {
    let tangle = together(
        sphere(3),
        moved(torus(1.0, 0.3, 24, 12), DVec3::new(0.1, 0.2, 0.05)),
    );
    let expected = self_intersections((&tangle).into(), &()).unwrap();
    assert!(expected.len() > 50);
    for threads in [1, 3] {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        let found = pool.install(|| self_intersections((&tangle).into(), &()).unwrap());
        assert_eq!(found, expected);
    }
}

#[test]
fn it_can_be_stopped() {
    struct Stop;
    impl Progress for Stop {
        fn step(&self, _: &'static str, done: u64, _: u64) -> ControlFlow<()> {
            if done > 3 {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        }
    }
    let sphere = sphere(4);
    let stopped = self_intersections((&sphere).into(), &Stop);
    assert_eq!(stopped, Err(MeshError::Cancelled(Cancelled)));
}
