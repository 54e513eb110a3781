//! The hierarchy and the k-d tree against brute force, on points and boxes that coincide and touch.

use pellicle_geometry::{Aabb, DVec3};
use pellicle_spatial::{Bvh, KdTree, Neighbor, median_spacing};
use proptest::prelude::*;
use std::ops::ControlFlow;

fn point() -> impl Strategy<Value = DVec3> {
    prop_oneof![
        3 => [-4_i8..5, -4_i8..5, -2_i8..3].prop_map(|p| DVec3::from_array(p.map(f64::from))),
        1 => [-4.0..4.0, -4.0..4.0, -2.0..2.0].prop_map(DVec3::from_array),
    ]
}

fn boxes() -> impl Strategy<Value = Vec<Aabb>> {
    let one = (point(), point(), 0..4).prop_map(|(a, b, kind)| match kind {
        0 => Aabb::EMPTY,
        1 => Aabb::EMPTY.with(a),
        _ => Aabb::EMPTY.with(a).with(a + 0.25 * (b - a)),
    });
    prop::collection::vec(one, 0..120)
}

fn brute_pairs(boxes: &[Aabb]) -> Vec<(u32, u32)> {
    let mut pairs = Vec::new();
    for (j, b) in boxes.iter().enumerate().filter(|(_, b)| !b.is_empty()) {
        for (i, a) in boxes[..j].iter().enumerate().filter(|(_, a)| !a.is_empty()) {
            if a.overlaps(*b) {
                pairs.push((i as u32, j as u32));
            }
        }
    }
    pairs.sort();
    pairs
}

/// All points by distance, then by index.
fn brute_neighbors(points: &[DVec3], query: DVec3) -> Vec<Neighbor> {
    let mut all: Vec<Neighbor> = (0..points.len())
        .map(|i| Neighbor {
            index: i as u32,
            distance_squared: (query - points[i]).length_squared(),
        })
        .collect();
    all.sort_by(|a, b| {
        let by_distance = a.distance_squared.total_cmp(&b.distance_squared);
        by_distance.then(a.index.cmp(&b.index))
    });
    all
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(600))]

    #[test]
    fn overlaps_are_those_of_brute_force(
        boxes in boxes(), query in (point(), point()), count in 0_usize..40
    ) {
        let bvh = Bvh::new(boxes.iter().copied());
        let expected = brute_pairs(&boxes);
        let mut found = Vec::new();
        let _ = bvh.self_overlaps(|i, j| { found.push((i, j)); ControlFlow::Continue(()) });
        found.sort();
        prop_assert_eq!(&found, &expected);
        let mut found = Vec::new();
        for task in bvh.overlap_tasks(count) {
            let _ = bvh.overlaps_of(task, |i, j| { found.push((i, j)); ControlFlow::Continue(()) });
        }
        found.sort();
        prop_assert_eq!(&found, &expected);
        let query = Aabb::EMPTY.with(query.0).with(query.1);
        let mut found = Vec::new();
        let _ = bvh.overlapping(query, |i| { found.push(i); ControlFlow::Continue(()) });
        found.sort();
        let expected: Vec<u32> = (0..boxes.len() as u32)
            .filter(|&i| !boxes[i as usize].is_empty() && boxes[i as usize].overlaps(query))
            .collect();
        prop_assert_eq!(found, expected);
    }

    #[test]
    fn nearest_box_is_that_of_brute_force(boxes in boxes(), query in point()) {
        let bvh = Bvh::new(boxes.iter().copied());
        let distance = |i: u32| boxes[i as usize].distance_squared(query);
        let expected = (0..boxes.len() as u32)
            .filter(|&i| !boxes[i as usize].is_empty())
            .map(|i| (i, distance(i)))
            .min_by(|a, b| a.1.total_cmp(&b.1).then(a.0.cmp(&b.0)));
        prop_assert_eq!(bvh.nearest(query, distance), expected);
    }

    #[test]
    fn neighbors_are_those_of_brute_force(
        points in prop::collection::vec(point(), 0..200),
        query in point(),
        k in 0_usize..30,
        radius in prop_oneof![Just(0.0), Just(1.0), Just(5.0), -1.0..6.0],
    ) {
        let tree = KdTree::new(&points);
        let all = brute_neighbors(&points, query);
        prop_assert_eq!(tree.nearest(query), all.first().copied());
        prop_assert_eq!(tree.nearest_k(query, k), all[..k.min(all.len())].to_vec());
        let mut inside = all;
        inside.retain(|n| radius >= 0.0 && n.distance_squared <= radius * radius);
        inside.sort_by_key(|n| n.index);
        prop_assert_eq!(tree.within(query, radius), inside);
    }

    #[test]
    fn spacing_is_that_of_brute_force(
        points in prop::collection::vec(point(), 0..60), exponent in -900..900
    ) {
        let scale = 2_f64.powi(exponent);
        let scaled: Vec<DVec3> = points.iter().map(|&p| p * scale).collect();
        let mut distinct: Vec<DVec3> = Vec::new();
        for &p in &points {
            if !distinct.contains(&p) {
                distinct.push(p);
            }
        }
        let mut spacings: Vec<f64> = distinct
            .iter()
            .filter_map(|p| {
                let others = distinct.iter().filter(|q| *q != p);
                others.map(|q| p.distance(*q)).min_by(f64::total_cmp)
            })
            .collect();
        spacings.sort_by(f64::total_cmp);
        let expected = spacings.get(spacings.len() / 2).map(|s| s * scale);
        match (median_spacing(&scaled), expected) {
            (Some(found), Some(expected)) => {
                prop_assert!((found / expected - 1.0).abs() < 1e-12, "{found} {expected}");
            }
            (found, expected) => prop_assert_eq!(found, expected),
        }
    }
}

#[test]
fn many_equal_points_and_grids_are_ordinary() {
    let n = 100_000;
    let mut points = vec![DVec3::ONE; n];
    points.push(2.0 * DVec3::ONE);
    let tree = KdTree::new(&points);
    assert_eq!(tree.nearest(DVec3::ZERO).map(|f| f.index), Some(0));
    assert_eq!(
        tree.nearest(3.0 * DVec3::ONE).map(|f| f.index),
        Some(n as u32)
    );
    let nearest: Vec<u32> = tree
        .nearest_k(DVec3::ZERO, 3)
        .iter()
        .map(|f| f.index)
        .collect();
    assert_eq!(nearest, [0, 1, 2]);
    assert_eq!(tree.within(DVec3::ONE, 0.5).len(), n);
    assert_eq!(median_spacing(&points), Some(3_f64.sqrt()));
    assert_eq!(median_spacing(&points[..n]), None);
    let bvh = Bvh::new(points.iter().map(|&p| Aabb::EMPTY.with(p)));
    let at = |q: DVec3| bvh.nearest(q, |i| points[i as usize].distance_squared(q));
    assert_eq!(at(3.0 * DVec3::ONE), Some((n as u32, 3.0)));

    // A flat grid: all z equal, each x and y three hundred times.
    let grid: Vec<DVec3> = (0..90_000)
        .map(|i| DVec3::new(f64::from(i % 300), f64::from(i / 300), 7.0))
        .collect();
    let tree = KdTree::new(&grid);
    for i in (0..grid.len()).step_by(997) {
        let beside = tree.nearest(grid[i] + DVec3::splat(0.25));
        assert_eq!(beside.map(|f| f.index), Some(i as u32));
        let near = brute_neighbors(&grid, grid[i]);
        let count = near
            .iter()
            .take_while(|f| f.distance_squared <= 1.0)
            .count();
        assert_eq!(tree.within(grid[i], 1.0).len(), count);
    }
    assert_eq!(median_spacing(&grid), Some(1.0));
}

#[test]
fn odd_input_is_no_panic() {
    for points in [
        vec![],
        vec![DVec3::NAN; 20],
        vec![DVec3::INFINITY, DVec3::ZERO],
    ] {
        let tree = KdTree::new(&points);
        assert_eq!(tree.len(), points.iter().filter(|p| p.is_finite()).count());
        assert_eq!(tree.nearest(DVec3::ONE).is_some(), !tree.is_empty());
        assert!(tree.nearest(DVec3::NAN).is_none());
        assert_eq!(median_spacing(&points), None);
        let bvh = Bvh::new(points.iter().map(|&p| Aabb { min: p, max: p }));
        let _ = bvh.self_overlaps(|_, _| ControlFlow::Continue(()));
        assert!(bvh.nearest(DVec3::ONE, |_| f64::NAN).is_none());
    }
    let huge: Vec<DVec3> = (0..34)
        .map(|i| DVec3::splat(1e307 * f64::from(i - 17)))
        .collect();
    assert!(KdTree::new(&huge).nearest(DVec3::ZERO).is_some());
    let spacing = median_spacing(&huge).unwrap();
    assert!(
        (spacing / (1e307 * 3_f64.sqrt()) - 1.0).abs() < 1e-12,
        "{spacing}"
    );
}
