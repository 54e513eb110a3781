//! The kernel, checked after every insertion, and the promise that order does not matter.

use super::*;
use crate::{Defect, TetId, tetrahedralization::last_incident};
use proptest::prelude::*;

/// Small sets that are as degenerate as they come.
pub(crate) fn degenerate_points() -> impl Strategy<Value = Vec<DVec3>> {
    let grid = (0..4_i32, 0..4_i32, 0..4_i32)
        .prop_map(|(x, y, z)| DVec3::new(f64::from(x), f64::from(y), f64::from(z)));
    // Integer points on the sphere x² + y² + z² = 81, in all octants.
    let on_sphere = (
        prop::sample::select(vec![
            [1.0, 4.0, 8.0],
            [4.0, 4.0, 7.0],
            [0.0, 0.0, 9.0],
            [3.0, 6.0, 6.0],
        ]),
        Just([0usize, 1, 2]).prop_shuffle(),
        prop::array::uniform3(any::<bool>()),
    )
        .prop_map(|(values, axes, signs)| {
            DVec3::from([0, 1, 2].map(|i| values[axes[i]] * if signs[i] { -1.0 } else { 1.0 }))
        });
    let flat = (0..5_i32, 0..5_i32, prop::bool::weighted(0.1))
        .prop_map(|(x, y, off)| DVec3::new(f64::from(x), f64::from(y), f64::from(u8::from(off))));
    let random = prop::array::uniform3(-1.0..1.0).prop_map(DVec3::from);
    let wild = prop::array::uniform3(prop_oneof![
        Just(0.0),
        Just(-0.0),
        Just(5e-324),
        Just(1e300),
        Just(-f64::MAX),
        -1.0..1.0
    ])
    .prop_map(DVec3::from);
    let on_line = (-5..5_i32, prop::bool::weighted(0.1)).prop_map(|(t, off)| {
        DVec3::new(0.1, 0.7, -0.3) * f64::from(t).exp2() + DVec3::X * f64::from(u8::from(off))
    });
    prop_oneof![
        prop::collection::vec(on_line, 0..20),
        prop::collection::vec(grid, 0..40),
        prop::collection::vec(on_sphere, 0..40),
        prop::collection::vec(flat, 0..40),
        prop::collection::vec(random, 0..40),
        prop::collection::vec(wild, 0..25),
    ]
}

/// The finite tetrahedra as sets of coordinates, sorted.
pub(crate) fn as_sets(tetrahedralization: &Tetrahedralization) -> Vec<[[u64; 3]; 4]> {
    let bits = |v: VertexId| {
        (tetrahedralization.points()[v.index()] + DVec3::ZERO)
            .to_array()
            .map(f64::to_bits)
    };
    let mut sets: Vec<_> = tetrahedralization
        .finite_tets()
        .iter()
        .map(|tet| {
            let mut corners = tet.map(bits);
            corners.sort_unstable();
            corners
        })
        .collect();
    sets.sort_unstable();
    sets
}

/// Inserts the points as given and validates after each.
fn insert_watched(points: &[DVec3]) -> Result<(), Error> {
    let (mut order, _) = representatives(points, duplicates_aside(points));
    first::four_that_span(points, &mut order)?;
    for count in 4..=order.len() {
        let some: Vec<DVec3> = order[..count].iter().map(|&i| points[i as usize]).collect();
        let options = Options {
            order: InsertionOrder::AsGiven,
        };
        let tetrahedralization = crate::tetrahedralize(&some, &options)?;
        assert_eq!(
            tetrahedralization.validate(),
            [],
            "after {count} of {some:?}"
        );
        assert_eq!(
            tetrahedralization.validate_globally(),
            [],
            "after {count} of {some:?}"
        );
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(192))]

    #[test]
    fn no_defect_after_any_insertion(points in degenerate_points()) {
        // Sets that span nothing are refused, which other tests look at.
        let _ = insert_watched(&points);
    }

    #[test]
    fn the_tetrahedra_depend_on_the_set_of_points_alone(
        (points, shuffled) in degenerate_points()
            .prop_flat_map(|points| (Just(points.clone()), Just(points).prop_shuffle())),
        as_given: bool,
    ) {
        let order = if as_given { InsertionOrder::AsGiven } else { InsertionOrder::Brio };
        let one = crate::tetrahedralize(&points, &Options::default());
        let other = crate::tetrahedralize(&shuffled, &Options { order });
        match (one, other) {
            (Ok(one), Ok(other)) => {
                prop_assert_eq!(as_sets(&one), as_sets(&other));
            }
            (one, other) => prop_assert_eq!(one.err(), other.err()),
        }
    }

    #[test]
    fn in_brio_order_even_the_arrays_do(
        (points, shuffled) in degenerate_points()
            .prop_flat_map(|points| (Just(points.clone()), Just(points).prop_shuffle())),
    ) {
        let arrays = |points: &[DVec3]| {
            crate::tetrahedralize(points, &Options::default()).map(|tetrahedralization| {
                let corners: Vec<_> = tetrahedralization
                    .tets()
                    .iter()
                    .map(|tet| tet.map(|v| v.some().map(|v| points[v.index()])))
                    .collect();
                (corners, tetrahedralization.twins().to_vec())
            })
        };
        prop_assert_eq!(arrays(&points), arrays(&shuffled));
    }
}

#[test]
fn many_duplicates_of_few_points() {
    let points: Vec<DVec3> = (0..10_000)
        .map(|i| DVec3::new(f64::from(i % 5), f64::from(i % 3), f64::from(i % 2)))
        .collect();
    let tetrahedralization = crate::tetrahedralize(&points, &Options::default()).unwrap();
    assert_eq!(tetrahedralization.vertex_count(), 30);
    assert_eq!(tetrahedralization.validate(), []);
    for (duplicate, representative) in tetrahedralization.duplicates() {
        assert_eq!(points[duplicate.index()], points[representative.index()]);
        assert!(representative < duplicate);
    }
}

#[test]
fn two_skew_lines_make_quadratically_many_tetrahedra() {
    let n = 40;
    let mut points: Vec<DVec3> = (0..n).map(|i| DVec3::new(f64::from(i), 0.0, 0.0)).collect();
    points.extend((0..n).map(|i| DVec3::new(0.0, f64::from(i), 1.0)));
    let tetrahedralization = crate::tetrahedralize(&points, &Options::default()).unwrap();
    assert_eq!(tetrahedralization.finite_count(), (n as usize - 1).pow(2));
    assert_eq!(tetrahedralization.validate(), []);
}

#[test]
fn a_cavity_with_more_vertices_than_the_table_takes() {
    // A wheel of points sees the hub's cavity from all around: its rim has 600 vertices.
    let n = 600;
    let mut points: Vec<DVec3> = (0..n)
        .map(|i| {
            let angle = f64::from(i) / f64::from(n) * std::f64::consts::TAU;
            DVec3::new(angle.cos(), angle.sin(), 0.01 * (7.0 * angle).sin())
        })
        .collect();
    points.extend([DVec3::Z, -DVec3::Z, DVec3::new(1e-3, 2e-3, 3e-3)]);
    let as_given = Options {
        order: InsertionOrder::AsGiven,
    };
    let tetrahedralization = crate::tetrahedralize(&points, &as_given).unwrap();
    assert_eq!(tetrahedralization.validate(), []);
    let hub = VertexId::new(points.len() - 1);
    assert!(tetrahedralization.voronoi_cell(hub).unwrap().facets.len() > 256);
}

#[test]
fn too_few_collinear_and_coplanar_points_are_refused_by_name() {
    let fails = |points: &[DVec3]| crate::tetrahedralize(points, &Options::default()).unwrap_err();
    let line: Vec<DVec3> = (0..9)
        .map(|i| DVec3::new(0.1, 0.7, 0.3) * f64::from(1 << i))
        .collect();
    let plane: Vec<DVec3> = (0..9)
        .map(|i| DVec3::new(f64::from(i), f64::from(i * i), 0.5))
        .collect();
    assert_eq!(fails(&[]), Error::TooFewPoints { distinct: 0 });
    assert_eq!(fails(&[DVec3::ONE; 7]), Error::TooFewPoints { distinct: 1 });
    assert_eq!(fails(&line), Error::Collinear { distinct: 9 });
    assert_eq!(fails(&plane), Error::Coplanar { distinct: 9 });
    assert_eq!(
        fails(&[DVec3::ZERO, DVec3::NAN]),
        Error::NotFinite {
            vertex: VertexId(1)
        }
    );
}

#[test]
fn an_observer_stops_the_work() {
    struct Never;
    impl Progress for Never {
        fn step(&self, _: &'static str, _: u64, _: u64) -> std::ops::ControlFlow<()> {
            std::ops::ControlFlow::Break(())
        }
    }
    let points = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    let stopped = crate::tetrahedralize_with(&points, &Options::default(), &Never);
    assert_eq!(stopped.unwrap_err(), Error::Cancelled(Cancelled));
}

/// The validator itself: each kind of damage is found.
#[test]
fn the_validator_finds_a_swapped_twin_and_a_turned_tetrahedron() {
    let points: Vec<DVec3> = (0..27)
        .map(|i| DVec3::new(f64::from(i % 3), f64::from(i / 3 % 3), f64::from(i / 9)))
        .collect();
    let whole = crate::tetrahedralize(&points, &Options::default()).unwrap();
    let damaged = |damage: fn(&mut Vec<[VertexId; 4]>, &mut Vec<[crate::FacetId; 4]>)| {
        let (mut tets, mut twins) = (whole.tets().to_vec(), whole.twins().to_vec());
        damage(&mut tets, &mut twins);
        let finite = whole.finite_count();
        let incident = last_incident(points.len(), &tets[..finite]);
        Tetrahedralization::from_arrays(&points, tets, twins, finite, incident, Vec::new())
            .validate()
    };
    assert_eq!(damaged(|_, _| ()), []);
    assert!(damaged(|_, twins| twins[0].swap(0, 1)).contains(&Defect::Twin(crate::FacetId(0))));
    assert!(damaged(|tets, _| tets[0].swap(0, 1)).contains(&Defect::Orientation(TetId(0))));
    assert!(damaged(|tets, _| tets[0][0] = tets[0][1]).contains(&Defect::Corners(TetId(0))));
}

/// Cavities of all sizes around those where the way to pair edges changes.
#[test]
fn a_cavity_may_have_any_number_of_vertices() {
    for vertices in [4_u32, 5, 63, 64, 65, 66, 253, 254, 255, 256, 257, 300] {
        // Along a spiral on a sphere around the last point, which is so in conflict with all tetrahedra.
        let turn = std::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
        let on_sphere = (0..vertices).map(|i| {
            let z = 1.0 - (2.0 * f64::from(i) + 1.0) / f64::from(vertices);
            let (sin, cos) = (turn * f64::from(i)).sin_cos();
            DVec3::new(cos, sin, 0.0) * (1.0 - z * z).sqrt() + DVec3::Z * z
        });
        let points: Vec<DVec3> = on_sphere.chain([DVec3::ZERO]).collect();
        let options = Options {
            order: InsertionOrder::AsGiven,
        };
        let tetrahedralization =
            crate::tetrahedralize(&points, &options).expect("in general position");
        assert_eq!(tetrahedralization.finite_count(), 2 * vertices as usize - 4);
        assert_eq!(tetrahedralization.validate(), [], "{vertices}");
    }
}
