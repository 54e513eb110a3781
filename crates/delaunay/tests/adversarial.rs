//! Inputs that are as degenerate, as unbalanced or as extreme as they come.
//!
//! Each is tetrahedralised with one to four threads and in several orders of the points; the arrays must be the same, bit for
//! bit. The result is looked at by the library's validator and by a checker that shares no code with it.

mod checker;
mod sets;

use checker::{Claim, Defect};
use pellicle_delaunay::{Error, Options, Tetrahedralization, tetrahedralize};
use pellicle_geometry::DVec3;
use sets::{Random, collinear, icosahedron, integer_ring, permutations_with_signs};

/// Points enough that several threads share them.
const LARGE: usize = 12_000;

/// Everything of a result that a caller sees, with the points' coordinates in the place of their ids.
#[derive(PartialEq)]
struct Seen {
    corners: Vec<[Option<[u64; 3]>; 4]>,
    twins: Vec<[u32; 4]>,
    finite: usize,
}

impl Seen {
    fn of(tetrahedralization: &Tetrahedralization) -> Self {
        let points = tetrahedralization.points();
        let bits = |p: DVec3| (p + DVec3::ZERO).to_array().map(f64::to_bits);
        let corners = |tet: &[pellicle_geometry::VertexId; 4]| {
            tet.map(|v| v.some().map(|v| bits(points[v.index()])))
        };
        Self {
            corners: tetrahedralization.tets().iter().map(corners).collect(),
            twins: twins(tetrahedralization),
            finite: tetrahedralization.finite_count(),
        }
    }
}

fn twins(tetrahedralization: &Tetrahedralization) -> Vec<[u32; 4]> {
    let twins = tetrahedralization.twins().iter();
    twins.map(|facets| facets.map(|facet| facet.0)).collect()
}

fn with_threads(points: &[DVec3], threads: usize) -> Result<Tetrahedralization<'_>, Error> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
    let pool = pool.build().expect("threads can be had");
    pool.install(|| tetrahedralize(points, &Options::default()))
}

/// Finite tetrahedra of a set, after everything was checked; or why it has none, for all orders and threads alike.
fn check(name: &str, points: &[DVec3]) -> Result<usize, Error> {
    let one = with_threads(points, 1);
    let seen = one.as_ref().map(Seen::of);
    for threads in 2..=4 {
        let several = with_threads(points, threads);
        match (&one, &several) {
            (Ok(one), Ok(several)) => {
                assert!(one.tets() == several.tets(), "{name}: {threads} threads");
                assert!(one.twins() == several.twins(), "{name}: {threads} threads");
                assert_eq!(one.finite_count(), several.finite_count(), "{name}");
                assert_eq!(one.duplicates(), several.duplicates(), "{name}");
            }
            _ => assert_eq!(one.as_ref().err(), several.as_ref().err(), "{name}"),
        }
    }
    let mut shuffled = points.to_vec();
    for seed in 1..=3 {
        match seed {
            1 => shuffled.reverse(),
            _ => Random(seed).shuffle(&mut shuffled),
        }
        let other = with_threads(&shuffled, seed as usize);
        match (&seen, other.as_ref().map(Seen::of)) {
            (Ok(one), Ok(other)) => assert!(*one == other, "{name}: order {seed}"),
            (one, other) => assert_eq!(one.as_ref().err(), other.err().as_ref(), "{name}"),
        }
    }
    let one = one?;
    assert_eq!(one.validate(), [], "{name}");
    if let Err(defects) = independently(&one, |_, _| ()) {
        panic!("{name}: {defects:?}");
    }
    Ok(one.finite_count())
}

/// What the independent checker says of a result after some damage to its tetrahedra and twins.
fn independently(
    tetrahedralization: &Tetrahedralization,
    damage: impl FnOnce(&mut Vec<[u32; 4]>, &mut Vec<[u32; 4]>),
) -> Result<checker::Looked, Vec<Defect>> {
    let points: Vec<[f64; 3]> = tetrahedralization
        .points()
        .iter()
        .map(|p| p.to_array())
        .collect();
    let tets = tetrahedralization.tets().iter();
    let mut tets: Vec<[u32; 4]> = tets.map(|tet| tet.map(|v| v.0)).collect();
    let mut twins = twins(tetrahedralization);
    damage(&mut tets, &mut twins);
    Claim {
        points: &points,
        tets: &tets,
        twins: &twins,
        finite: tetrahedralization.finite_count(),
    }
    .check()
}

#[test]
fn a_line_plus_one_and_plus_two() {
    for n in [4, 40, LARGE] {
        let mut points = collinear(n, DVec3::new(3.0, -5.0, 7.0), DVec3::new(1.0, 2.0, -4.0));
        assert_eq!(
            check("line", &points),
            Err(Error::Collinear { distinct: n })
        );
        points.push(DVec3::new(0.25, 0.5, 100.0));
        let coplanar = Error::Coplanar { distinct: n + 1 };
        assert_eq!(check("line plus one", &points), Err(coplanar));
        // The two others make a tetrahedron with each edge of the line.
        points.push(DVec3::new(1e-3, -7.0, -300.0));
        assert_eq!(check("line plus two", &points), Ok(n - 1));
    }
}

#[test]
fn a_line_of_uneven_steps_plus_two() {
    // From the least double to the greatest, in powers of two.
    let mut points: Vec<DVec3> = (-1074..=1023)
        .map(|e| DVec3::new(2.0_f64.powi(e / 2) * 2.0_f64.powi(e - e / 2), 0.0, 0.0))
        .collect();
    points.extend([DVec3::Y, DVec3::Z]);
    assert_eq!(check("powers of two", &points), Ok(1074 + 1023));
}

#[test]
fn a_plane_plus_one() {
    // In the plane x + y + z = 0, where a point of a square grid has coordinates (i, j, −i − j).
    for side in [2, 9, 120] {
        let mut points = Vec::new();
        for i in 0..side {
            points.extend(
                (0..side).map(|j| DVec3::new(f64::from(i), f64::from(j), -f64::from(i + j))),
            );
        }
        let distinct = points.len();
        assert_eq!(check("plane", &points), Err(Error::Coplanar { distinct }));
        points.push(DVec3::new(0.5, 0.25, 9.0));
        let triangles = 2 * (side as usize - 1).pow(2);
        assert_eq!(check("plane plus one", &points), Ok(triangles));
        // One more on the other side, and the plane's triangles lie between.
        points.push(DVec3::new(1.5, 0.75, -900.0));
        let count = check("plane between two", &points).unwrap();
        assert!(count > triangles, "{side}: {count}");
    }
}

#[test]
fn a_circle_in_a_plane_plus_one() {
    // 108 points, exactly on a circle: one polygon, which the perturbation alone divides.
    let ring = integer_ring(1105);
    assert_eq!(ring.len(), 108);
    let mut points: Vec<DVec3> = ring.iter().map(|&[x, y]| DVec3::new(x, y, 0.0)).collect();
    points.push(DVec3::new(3.0, 4.0, 5.0));
    assert_eq!(check("circle plus one", &points), Ok(106));
}

#[test]
fn two_skew_lines() {
    // Each edge of the one makes a tetrahedron with each edge of the other.
    for (n, m) in [(2, 2), (3, 50), (300, 250)] {
        let mut points = collinear(n, DVec3::ZERO, DVec3::X);
        points.extend(collinear(m, DVec3::new(0.0, 0.0, 1.0), DVec3::Y));
        assert_eq!(check("skew lines", &points), Ok((n - 1) * (m - 1)));
    }
    let mut points = collinear(90, DVec3::new(-1e5, 3.0, 0.0), DVec3::new(1.0, 2.0, 3.0));
    points.extend(collinear(
        110,
        DVec3::new(5.0, -4e4, 1e3),
        DVec3::new(-2.0, 1.0, 1.0),
    ));
    assert_eq!(check("tilted skew lines", &points), Ok(89 * 109));
}

#[test]
fn the_moment_curve() {
    for n in [4, 60, 300] {
        let points: Vec<DVec3> = (1..=n)
            .map(|t| DVec3::new(f64::from(t), f64::from(t * t), f64::from(t * t * t)))
            .collect();
        // All of them are vertices, and each but four adds a tetrahedron at least.
        let count = check("moment curve", &points).unwrap();
        assert!(count >= n as usize - 3, "{n}: {count}");
    }
    // Near the origin the curve is a line, then a plane's, to the last bit.
    let points: Vec<DVec3> = (-60..60)
        .map(|e| 2.0_f64.powi(e))
        .map(|t| DVec3::new(t, t * t, t * t * t))
        .collect();
    check("moment curve of powers", &points).unwrap();
}

#[test]
fn two_cospherical_rings() {
    let ring = integer_ring(1105);
    // Parallel: a prism of 108 sides, inscribed.
    let mut points: Vec<DVec3> = ring
        .iter()
        .map(|&[x, y]| DVec3::new(x, y, -400.0))
        .collect();
    points.extend(ring.iter().map(|&[x, y]| DVec3::new(x, y, 400.0)));
    check("parallel rings", &points).unwrap();
    points.push(DVec3::ZERO);
    check("parallel rings and their centre", &points).unwrap();
    // Crossed: in two planes at a right angle, with two points in common.
    let mut points: Vec<DVec3> = ring.iter().map(|&[x, y]| DVec3::new(x, y, 0.0)).collect();
    points.extend(ring.iter().map(|&[x, y]| DVec3::new(x, 0.0, y)));
    check("crossed rings", &points).unwrap();
    // Linked, and not on one sphere: every point of the one is near every point of the other.
    let mut points: Vec<DVec3> = ring.iter().map(|&[x, y]| DVec3::new(x, y, 0.0)).collect();
    points.extend(ring.iter().map(|&[x, y]| DVec3::new(x + 1105.0, 0.0, y)));
    check("linked rings", &points).unwrap();
    // As rounding leaves them.
    let circle = |n: u32, z: f64| {
        (0..n).map(move |i| {
            let angle = f64::from(i) / f64::from(n) * std::f64::consts::TAU;
            DVec3::new(angle.cos(), angle.sin(), z)
        })
    };
    let points: Vec<DVec3> = circle(6000, -0.5).chain(circle(6000, 0.5)).collect();
    check("rounded rings", &points).unwrap();
}

#[test]
fn a_hundred_thousand_duplicates_of_ten_points() {
    let mut random = Random(7);
    let ten: Vec<DVec3> = (0..10).map(|_| random.in_cube()).collect();
    let points: Vec<DVec3> = (0..100_000).map(|_| ten[random.below(10)]).collect();
    let count = check("duplicates", &points).unwrap();
    assert_eq!(Ok(count), check("the ten", &ten));
    // Of zero either sign is the same.
    let signed: Vec<DVec3> = (0..100_000)
        .map(|i| {
            let corner = DVec3::new(
                f64::from(i & 1),
                f64::from(i >> 1 & 1),
                f64::from(i >> 2 & 1),
            );
            let sign = if random.below(2) == 0 { 1.0 } else { -1.0 };
            corner * sign * corner.signum()
        })
        .collect();
    assert!(matches!(check("cube of signed zeros", &signed), Ok(1..)));
}

#[test]
fn denormal_clusters_beside_huge_coordinates() {
    let least = 5e-324;
    let mut cluster = Vec::new();
    for i in 0..64 {
        let corner = DVec3::new(f64::from(i % 4), f64::from(i / 4 % 4), f64::from(i / 16));
        cluster.push(corner * least);
    }
    check("denormal grid", &cluster).unwrap();
    for far in [1e300, f64::MAX / 4.0, 1.0] {
        let mut points = cluster.clone();
        for i in 0..8 {
            let sign =
                DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2)) * 2.0 - 1.0;
            points.push(sign * far);
        }
        check("denormal grid in a huge cube", &points).unwrap();
    }
    let mut random = Random(11);
    let mut points: Vec<DVec3> = (0..40)
        .map(|_| (random.in_cube() * 6.0).round() * least)
        .collect();
    points.extend((0..40).map(|_| (random.in_cube() - 0.5) * 1e300));
    points.extend((0..40).map(|_| DVec3::splat(1e300) + (random.in_cube() * 9.0).round() * 1e285));
    check("three clusters", &points).unwrap();
    // Exponents as wide as they go, in each coordinate of its own.
    let wild = |random: &mut Random| {
        (random.unit() - 0.5) * 2.0_f64.powi(random.below(2000) as i32 - 1000)
    };
    let points: Vec<DVec3> = (0..150)
        .map(|_| DVec3::new(wild(&mut random), wild(&mut random), wild(&mut random)))
        .collect();
    check("wild exponents", &points).unwrap();
}

#[test]
fn grids() {
    let grid = |side: u32| {
        (0..side.pow(3)).map(move |i| {
            DVec3::new(
                f64::from(i % side),
                f64::from(i / side % side),
                f64::from(i / side / side),
            )
        })
    };
    for side in [2, 5, 40] {
        // Six tetrahedra a cell, or five: what the perturbation makes of a lattice, all cells alike.
        let cells = (side as usize - 1).pow(3);
        let count = check("grid", &grid(side).collect::<Vec<_>>()).unwrap();
        assert!((5 * cells..=6 * cells).contains(&count), "{side}: {count}");
    }
    for scale in [
        DVec3::splat(0.1),
        DVec3::new(1.0 / 3.0, 1.0 / 7.0, 0.3),
        DVec3::new(1e-200, 1.0, 1e200),
        DVec3::splat(1e-310),
        DVec3::new(-1.0, 2.0, 4.0),
    ] {
        let points: Vec<DVec3> = grid(9).map(|p| p * scale).collect();
        check("scaled grid", &points).unwrap();
        // Far from the origin the last bits are lost, and so is the lattice.
        let points: Vec<DVec3> = grid(7).map(|p| p * scale + 1.0).collect();
        match check("moved grid", &points) {
            Ok(_) => {}
            Err(error) => assert!(matches!(
                error,
                Error::Coplanar { .. } | Error::TooFewPoints { .. } | Error::Collinear { .. }
            )),
        }
    }
    // Face-centred and body-centred.
    let centred = |offsets: [DVec3; 3]| {
        let points: Vec<DVec3> = grid(6)
            .flat_map(|p| [p, p + offsets[0], p + offsets[1], p + offsets[2]])
            .collect();
        points
    };
    let half = |x: f64, y: f64, z: f64| DVec3::new(x, y, z) / 2.0;
    let faces = [
        half(1.0, 1.0, 0.0),
        half(0.0, 1.0, 1.0),
        half(1.0, 0.0, 1.0),
    ];
    check("face-centred", &centred(faces)).unwrap();
    check("body-centred", &centred([DVec3::splat(0.5); 3])).unwrap();
}

#[test]
fn rounded_spheres() {
    let mut random = Random(3);
    for (count, radius) in [(300, 5.0), (3000, 30.0), (3000, 1000.0), (60_000, 1000.0)] {
        let points: Vec<DVec3> = (0..count)
            .map(|_| (random.direction() * radius).round())
            .collect();
        check("rounded sphere", &points).unwrap();
    }
    // All of them exactly on a sphere.
    let points: Vec<DVec3> = sets::integer_sphere(2501);
    assert!(points.len() > 500, "{}", points.len());
    check("integer points of a sphere", &points).unwrap();
}

#[test]
fn regular_polytopes() {
    let octahedron = permutations_with_signs([0.0, 0.0, 1.0]);
    let cube = permutations_with_signs([1.0, 1.0, 1.0]);
    let cuboctahedron = permutations_with_signs([0.0, 1.0, 1.0]);
    let truncated_octahedron = permutations_with_signs([0.0, 1.0, 2.0]);
    let rhombicuboctahedron = permutations_with_signs([1.0, 1.0, 1.0 + 2.0_f64.sqrt()]);
    let great = permutations_with_signs([1.0, 2.0, 3.0]);
    let tetrahedron: Vec<DVec3> = cube
        .iter()
        .copied()
        .filter(|p| p.x * p.y * p.z > 0.0)
        .collect();
    assert_eq!(check("tetrahedron", &tetrahedron), Ok(1));
    assert_eq!(check("octahedron", &octahedron), Ok(4));
    assert!(matches!(check("cube", &cube), Ok(5 | 6)));
    for (name, vertices, points) in [
        ("cuboctahedron", 12, cuboctahedron),
        ("truncated octahedron", 24, truncated_octahedron),
        ("rhombicuboctahedron", 24, rhombicuboctahedron),
        ("great rhombicuboctahedron", 48, great),
        ("icosahedron", 12, icosahedron()),
    ] {
        assert_eq!(points.len(), vertices, "{name}");
        check(name, &points).unwrap();
        let with_centre: Vec<DVec3> = points.iter().copied().chain([DVec3::ZERO]).collect();
        check(name, &with_centre).unwrap();
        // Copies side by side, which share facets and are cospherical each.
        let row = points
            .iter()
            .flat_map(|&p| (0..4).map(move |i| p + DVec3::X * f64::from(4 * i)));
        check(name, &row.collect::<Vec<_>>()).unwrap();
    }
}

#[test]
fn uneven_samples_of_surfaces() {
    let mut random = Random(5);
    // A cylinder of rings: each ring cocircular as far as rounding goes, neighbours cospherical.
    let points: Vec<DVec3> = (0..LARGE)
        .map(|i| {
            let angle = (i % 40) as f64 / 40.0 * std::f64::consts::TAU;
            DVec3::new(angle.cos(), angle.sin(), (i / 40) as f64 * 0.1)
        })
        .collect();
    check("cylinder", &points).unwrap();
    // Density that grows towards a point, through all exponents.
    let points: Vec<DVec3> = (0..LARGE)
        .map(|i| random.direction() * 2.0_f64.powi(-((i % 1000) as i32)))
        .collect();
    check("nested spheres", &points).unwrap();
    // One point far away from a dense ball.
    let mut points: Vec<DVec3> = (0..LARGE).map(|_| random.in_cube() * 1e-9).collect();
    points.push(DVec3::splat(1e9));
    check("one far away", &points).unwrap();
}

/// Races show seldom: the same again and again, with more threads than cores, where all of them meet at few vertices.
#[test]
fn threads_many_times() {
    let mut random = Random(13);
    let fan = collinear(LARGE, DVec3::ZERO, DVec3::new(1.0, -2.0, 3.0));
    let fan: Vec<DVec3> = fan.into_iter().chain([DVec3::Y, DVec3::Z]).collect();
    let clustered: Vec<DVec3> = (0..LARGE)
        .map(|_| random.direction() * random.unit().powi(40))
        .collect();
    let rounded: Vec<DVec3> = (0..2 * LARGE)
        .map(|_| (random.direction() * 200.0).round())
        .collect();
    for (name, points) in [("fan", fan), ("clustered", clustered), ("rounded", rounded)] {
        let one = with_threads(&points, 1).unwrap();
        for round in 0..12 {
            let several = with_threads(&points, 2 + round % 7).unwrap();
            assert!(one.tets() == several.tets(), "{name}: round {round}");
            assert!(one.twins() == several.twins(), "{name}: round {round}");
        }
    }
}

/// A change of tetrahedra and twins.
type Damage<'a> = &'a dyn Fn(&mut Vec<[u32; 4]>, &mut Vec<[u32; 4]>);

/// The checker itself: each kind of damage is found, and by its name.
#[test]
fn the_checker_finds_damage() {
    let points: Vec<DVec3> = (0..64)
        .map(|i| DVec3::new(f64::from(i % 4), f64::from(i / 4 % 4), f64::from(i / 16)))
        .collect();
    let whole = tetrahedralize(&points, &Options::default()).unwrap();
    let finite = whole.finite_count();
    assert!(independently(&whole, |_, _| ()).is_ok());
    let first = |damage: Damage| {
        independently(&whole, |tets, twins| damage(tets, twins)).unwrap_err()[0].clone()
    };
    assert_eq!(
        first(&|tets, _| tets[3][1] = 9999),
        Defect::Corners { tet: 3 }
    );
    assert_eq!(
        first(&|tets, _| tets[3][1] = tets[3][0]),
        Defect::Corners { tet: 3 }
    );
    assert_eq!(
        first(&|_, twins| twins[0].swap(0, 1)),
        Defect::Twin { tet: 0, corner: 0 }
    );
    assert!(matches!(
        first(&|tets, _| tets.swap(0, finite)),
        Defect::Corners { tet: 0 }
    ));
    // Mirrored as a whole, all twins stay twins.
    let mirrored = |tets: &mut Vec<[u32; 4]>, twins: &mut Vec<[u32; 4]>| {
        for (tet, twins) in tets.iter_mut().zip(twins) {
            tet.swap(0, 1);
            twins.swap(0, 1);
            *twins = twins.map(|twin| match twin % 4 {
                0 => twin + 1,
                1 => twin - 1,
                _ => twin,
            });
        }
    };
    assert_eq!(first(&mirrored), Defect::Orientation { tet: 0 });
}

/// Tetrahedralisations that are sound but not Delaunay, or not of these points.
#[test]
fn the_checker_finds_what_is_not_delaunay() {
    // A bipyramid over a triangle: two tetrahedra, or three around its axis.
    let corners = [
        DVec3::X,
        DVec3::new(-0.5, 1.0, 0.0),
        DVec3::new(-0.5, -1.0, 0.0),
    ];
    let flat: Vec<DVec3> = corners
        .into_iter()
        .chain([DVec3::Z * 0.1, DVec3::Z * -0.1])
        .collect();
    let tall: Vec<DVec3> = corners
        .into_iter()
        .chain([DVec3::Z * 3.0, DVec3::Z * -3.0])
        .collect();
    let of = |points| tetrahedralize(points, &Options::default()).unwrap();
    let (flat, tall) = (of(&flat), of(&tall));
    assert_eq!((flat.finite_count(), tall.finite_count()), (3, 2));
    for (tets, points) in [(&flat, &tall), (&tall, &flat)] {
        let found = claimed(tets, points.points()).unwrap_err();
        assert!(matches!(found[0], Defect::NotDelaunay { .. }), "{found:?}");
    }
    // A point that is no vertex.
    let mut more = tall.points().to_vec();
    more.push(DVec3::splat(0.01));
    assert_eq!(claimed(&tall, &more), Err(vec![Defect::Use { point: 5 }]));
    // An equal of a vertex is none; but the lowest id stands for both.
    more[5] = more[4];
    assert!(claimed(&tall, &more).is_ok());
    let higher: Vec<DVec3> = (0..6)
        .map(|i| more[if i == 0 { 5 } else { i - 1 }])
        .collect();
    assert_eq!(higher[0], higher[5]);
    let shifted = |tets: &mut Vec<[u32; 4]>| {
        for v in tets
            .iter_mut()
            .flatten()
            .filter(|v| **v != checker::INFINITE)
        {
            *v += 1;
        }
    };
    let found = claimed_after(&tall, &higher, shifted).unwrap_err();
    assert_eq!(found, [Defect::Use { point: 0 }, Defect::Use { point: 5 }]);
    // Points moved so that the hull has a dent.
    let mut dented = flat.points().to_vec();
    dented[0] = DVec3::new(0.2, 0.0, 0.0);
    dented[3] = DVec3::new(1.0, 0.0, 0.8);
    dented[4] = DVec3::new(1.0, 0.0, -0.8);
    let found = claimed(&tall, &dented).unwrap_err();
    assert!(
        found
            .iter()
            .any(|defect| matches!(defect, Defect::NotConvex { .. })),
        "{found:?}"
    );
}

/// Of two ways to divide a square pyramid with a square base, the perturbation wants one.
#[test]
fn the_checker_finds_a_tie_told_wrong() {
    let points: Vec<DVec3> = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [1.0, 1.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.5, 0.5, 1.0],
    ]
    .map(DVec3::from_array)
    .into();
    let right = tetrahedralize(&points, &Options::default()).unwrap();
    assert_eq!(right.finite_count(), 2);
    // Turned by a quarter, the square has its other diagonal.
    let turned: Vec<DVec3> = [1, 2, 3, 0, 4].map(|i: usize| points[i]).into();
    let found = claimed(&right, &turned).unwrap_err();
    assert!(
        found
            .iter()
            .all(|defect| matches!(defect, Defect::NotDelaunay { .. })),
        "{found:?}"
    );
    assert!(claimed(&right, &points).is_ok());
}

/// The tetrahedra of one set claimed for other points.
fn claimed(
    tetrahedralization: &Tetrahedralization,
    points: &[DVec3],
) -> Result<checker::Looked, Vec<Defect>> {
    claimed_after(tetrahedralization, points, |_| ())
}

/// The same, the vertices renamed.
fn claimed_after(
    tetrahedralization: &Tetrahedralization,
    points: &[DVec3],
    rename: impl FnOnce(&mut Vec<[u32; 4]>),
) -> Result<checker::Looked, Vec<Defect>> {
    let points: Vec<[f64; 3]> = points.iter().map(|p| p.to_array()).collect();
    let tets = tetrahedralization.tets().iter();
    let mut tets: Vec<[u32; 4]> = tets.map(|tet| tet.map(|v| v.0)).collect();
    rename(&mut tets);
    Claim {
        points: &points,
        tets: &tets,
        twins: &twins(tetrahedralization),
        finite: tetrahedralization.finite_count(),
    }
    .check()
}
