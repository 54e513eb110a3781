//! Signed distances against closed forms, brute force and exact integers.

mod common;

use common::*;
use pellicle_geometry::{DVec3, VertexId};
use pellicle_mesh::{
    MeshError, MeshView, SignedDistance, TriangleId, TriangleSoup, winding_numbers,
};
use proptest::prelude::*;

fn distance_to(soup: &TriangleSoup) -> SignedDistance {
    SignedDistance::new(soup).unwrap()
}

/// The lattice of quarters around the unit cube.
fn quarters() -> Vec<DVec3> {
    let steps = || -4..=8;
    let quarter = |i: i32| f64::from(i) / 4.0;
    steps()
        .flat_map(|x| steps().flat_map(move |y| steps().map(move |z| (x, y, z))))
        .map(|(x, y, z)| DVec3::new(quarter(x), quarter(y), quarter(z)))
        .collect()
}

fn to_unit_cube(p: DVec3) -> f64 {
    let beyond = (p - 0.5).abs() - 0.5;
    beyond.max(DVec3::ZERO).length() + beyond.max_element().min(0.0)
}

#[test]
fn a_cube_exactly() {
    let cube = distance_to(&cube());
    for p in quarters() {
        let s = cube.sample(p);
        assert_eq!(s.distance, to_unit_cube(p), "{p}");
        assert_eq!(s.nearest.distance(p), s.distance.abs(), "{p}");
        assert_eq!(to_unit_cube(s.nearest), 0.0, "{p}");
        // Zero is positive zero.
        assert!(s.distance != 0.0 || s.distance.is_sign_positive());
    }
    assert_eq!(cube.sample(DVec3::ZERO).triangle, TriangleId(0));
}

#[test]
fn a_sphere_up_to_its_facets() {
    let fine = sphere(5);
    let distance = distance_to(&fine);
    // The depth of the facets below the sphere.
    let inradius = fine
        .triangles
        .iter()
        .map(|t| t.map(|v| fine.positions[v.index()]))
        .map(|[a, b, c]| ((a + b + c) / 3.0).length())
        .fold(1.0, f64::min);
    for k in 0..500 {
        let angle = 0.7 * f64::from(k);
        let z = f64::from(k % 41) / 20.5 - 0.99;
        let r = (1.0 - z * z).sqrt();
        let direction = DVec3::new(r * angle.cos(), r * angle.sin(), z);
        for radius in [0.3, 0.9, 1.1, 7.0] {
            let s = distance.sample(radius * direction);
            let expected = radius - 1.0;
            assert!(
                s.distance >= expected - 1e-12 && s.distance <= expected + (1.0 - inradius) + 1e-12,
                "{radius}: {}",
                s.distance
            );
        }
    }
}

#[test]
fn scales_and_places_do_not_matter() {
    let plain = distance_to(&torus(2.0, 0.75, 24, 16));
    let points: Vec<DVec3> = quarters().iter().map(|p| 2.0 * *p - 1.0).collect();
    let expected = plain.samples(&points);
    // 2^990 times 4 does not overflow, though its square does.
    for exponent in [-900, -300, 300, 990] {
        let factor = 2_f64.powi(exponent);
        let mut soup = torus(2.0, 0.75, 24, 16);
        soup.positions.iter_mut().for_each(|p| *p *= factor);
        let scaled: Vec<DVec3> = points.iter().map(|p| *p * factor).collect();
        for (a, b) in distance_to(&soup).samples(&scaled).iter().zip(&expected) {
            assert_eq!(a.distance, b.distance * factor);
            assert_eq!(a.nearest, b.nearest * factor);
            assert_eq!(a.triangle, b.triangle);
        }
    }
    // The cube and the quarters move exactly.
    let shift = DVec3::new(1048576.0, -2097152.0, 4194304.0);
    let far = distance_to(&moved(cube(), shift));
    for p in quarters() {
        assert_eq!(far.sample(p + shift).distance, to_unit_cube(p));
    }
}

#[test]
fn from_very_far_and_of_no_point() {
    let mut tiny = cube();
    tiny.positions.iter_mut().for_each(|p| *p *= 1e-200);
    for (soup, p, expected) in [
        (&cube(), 1e300 * DVec3::Y, 1e300),
        (&cube(), -1e80 * DVec3::Z, 1e80),
        (&tiny, 1e200 * DVec3::X, 1e200),
        (&tiny, 3.0 * DVec3::X, 3.0),
        (&tiny, DVec3::splat(-1e307), 1e307 * 3_f64.sqrt()),
    ] {
        let s = distance_to(soup).sample(p);
        assert!((s.distance / expected - 1.0).abs() < 1e-15, "{p}: {s:?}");
    }
    assert_eq!(distance_to(&cube()).sample(1e80 * DVec3::X).nearest.x, 1.0);
    for p in [DVec3::NAN, DVec3::INFINITY, DVec3::ZERO.with_y(f64::NAN)] {
        let s = distance_to(&cube()).sample(p);
        assert!(s.distance.is_nan() && s.nearest.is_nan() && s.triangle == TriangleId::NONE);
    }
}

#[test]
fn next_to_the_surface_the_sign_is_right() {
    // One unit in the last place beside a facet of a sphere, far too near for distances to tell.
    let soup = sphere(2);
    let distance = distance_to(&soup);
    let mut on = 0;
    for t in &soup.triangles {
        let [a, b, c] = t.map(|v| soup.positions[v.index()]);
        let middle = (a + b + c) / 3.0;
        for p in [middle, middle * (1.0 + 3e-16), middle * (1.0 - 3e-16)] {
            let s = distance.sample(p);
            let inside = winding_numbers((&soup).into(), &[p]) == [1];
            on += usize::from(s.distance == 0.0 && s.distance.is_sign_positive());
            if s.distance == 0.0 && s.distance.is_sign_positive() {
                continue;
            }
            assert_eq!(s.distance.is_sign_negative(), inside, "{p}: {s:?}");
            assert!(s.distance.abs() < 1e-15);
        }
        assert_eq!(distance.sample(a).distance.to_bits(), 0);
        assert_eq!(distance.sample(a).nearest, a);
    }
    assert!(
        on < soup.triangles.len(),
        "hardly a rounded point is on its facet: {on}"
    );
}

#[test]
fn triangles_without_area() {
    // The top edge of a face cut at a vertex of one side only: the gap is closed by a triangle without area; and one that
    // is nothing but a point, and a pair of needles to and fro.
    let mut soup = cube();
    let middle = VertexId(8);
    soup.positions.push(DVec3::new(0.5, 0.0, 0.0));
    let at = soup
        .triangles
        .iter()
        .position(|t| (0..3).any(|i| [t[i].0, t[(i + 1) % 3].0] == [0, 1]))
        .unwrap();
    let t = soup.triangles[at];
    let i = (0..3)
        .find(|&i| [t[i].0, t[(i + 1) % 3].0] == [0, 1])
        .unwrap();
    let apex = t[(i + 2) % 3];
    soup.triangles[at] = [VertexId(0), middle, apex];
    soup.triangles.push([middle, VertexId(1), apex]);
    soup.triangles.push([VertexId(0), VertexId(1), middle]);
    soup.positions.extend([DVec3::ZERO; 3]);
    soup.triangles.push([9, 10, 11].map(VertexId));
    soup.triangles.push([9, 11, 10].map(VertexId));
    soup.triangles.push([0, 7, 7].map(VertexId));
    let distance = distance_to(&soup);
    for p in quarters() {
        assert_eq!(distance.sample(p).distance, to_unit_cube(p), "{p}");
    }
    // A needle that sticks out is surface too, though nothing is inside.
    let start = soup.positions.len() as u32;
    soup.positions
        .extend([DVec3::ONE, 2.0 * DVec3::ONE, 3.0 * DVec3::ONE]);
    let needle = [start, start + 1, start + 2];
    soup.triangles.push(needle.map(VertexId));
    soup.triangles
        .push([needle[0], needle[2], needle[1]].map(VertexId));
    let distance = distance_to(&soup);
    assert_eq!(distance.sample(DVec3::splat(1.25)).distance.to_bits(), 0);
    assert_eq!(distance.sample(DVec3::splat(4.0)).distance, 3_f64.sqrt());
    assert_eq!(
        distance.sample(DVec3::new(2.0, 2.0, 2.5)).distance,
        (1.0_f64 / 6.0).sqrt()
    );
}

#[test]
fn insides() {
    // Twice inside is inside; turned inside out is nowhere inside.
    let two = together(cube(), moved(cube(), DVec3::splat(0.5)));
    let distance = distance_to(&two);
    for (p, inside) in [(0.25, true), (0.75, true), (1.25, true), (1.75, false)] {
        assert_eq!(distance.is_inside(DVec3::splat(p)), inside);
    }
    assert_eq!(distance.sample(DVec3::splat(0.75)).distance, -0.25);
    let mut inverted = cube();
    inverted.triangles.iter_mut().for_each(|t| t.swap(0, 1));
    assert_eq!(
        distance_to(&inverted).sample(DVec3::splat(0.5)).distance,
        0.5
    );
    // A cavity is outside.
    inverted
        .positions
        .iter_mut()
        .for_each(|p| *p = 3.0 * *p - 1.0);
    inverted.triangles.iter_mut().for_each(|t| t.swap(0, 1));
    let mut hole = cube();
    hole.triangles.iter_mut().for_each(|t| t.swap(0, 1));
    let shell = distance_to(&together(inverted, hole));
    assert_eq!(shell.sample(DVec3::splat(0.5)).distance, 0.5);
    assert_eq!(shell.sample(DVec3::new(0.5, 0.5, -0.25)).distance, -0.25);
}

#[test]
fn what_is_refused() {
    let mut open = cube();
    open.triangles.remove(0);
    let error = SignedDistance::new(&open).unwrap_err();
    let (edge, forward, backward) = ([0, 1].map(VertexId), 1, 0);
    // The face [0, 2, 3] is gone: its edge from 3 to 0 is the diagonal, 0 to 2 lies on another face.
    assert_eq!(
        error,
        MeshError::NotClosed {
            edge: [0, 2].map(VertexId),
            forward: 0,
            backward: 1
        }
    );
    assert_eq!(
        error.to_string(),
        "not closed: 0 triangles run from vertex 0 to 2 and 1 back"
    );
    let sheet = SignedDistance::new(&sheet(1, 1)).unwrap_err();
    assert_eq!(
        sheet,
        MeshError::NotClosed {
            edge,
            forward,
            backward
        }
    );
    // Closed as a set, but not oriented.
    let mut turned = cube();
    turned.triangles[0].swap(0, 1);
    assert!(matches!(
        SignedDistance::new(&turned),
        Err(MeshError::NotClosed { forward: 0 | 2, .. })
    ));
    assert!(matches!(
        SignedDistance::new(&moebius(12)),
        Err(MeshError::NotClosed { .. })
    ));
    let nothing = MeshView {
        positions: &[DVec3::ZERO],
        triangles: &[],
    };
    assert!(matches!(
        SignedDistance::new(nothing),
        Err(MeshError::NothingToMeasure { .. })
    ));
    let mut broken = cube();
    broken.positions[5].y = f64::NAN;
    assert!(matches!(
        SignedDistance::new(&broken),
        Err(MeshError::NotFinite {
            vertex: VertexId(5),
            ..
        })
    ));
    // What no triangle names does no harm, wherever it is.
    let mut isolated = cube();
    isolated.positions.extend([DVec3::NAN, DVec3::splat(1e300)]);
    assert_eq!(
        distance_to(&isolated).sample(DVec3::splat(0.375)).distance,
        -0.375
    );
}

#[test]
fn threads_do_not_show() {
    let distance = distance_to(&torus(2.0, 0.75, 40, 20));
    let points: Vec<DVec3> = (0..20_000)
        .map(|k| {
            let t = f64::from(k) * 1e-3;
            DVec3::new(
                3.0 * (7.0 * t).sin(),
                3.0 * (11.0 * t).cos(),
                (13.0 * t).sin(),
            )
        })
        .collect();
    let with = |threads| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| distance.samples(&points))
    };
    let one = with(1);
    assert_eq!(one, with(3));
    assert!(
        one.iter()
            .zip(&points)
            .all(|(s, &p)| *s == distance.sample(p))
    );
}

/// The distance from a triangle by the region in which the foot lies (Ericson 2005, section 5.1.5).
fn to_triangle(p: DVec3, [a, b, c]: [DVec3; 3]) -> f64 {
    let segment = |s: DVec3, t: DVec3| {
        let along = t - s;
        let u = ((p - s).dot(along) / along.length_squared()).clamp(0.0, 1.0);
        p.distance(s + u * along)
    };
    let normal = (b - a).cross(c - a).normalize();
    let beside = |s: DVec3, t: DVec3| (t - s).cross(p - s).dot(normal) >= 0.0;
    if beside(a, b) && beside(b, c) && beside(c, a) {
        (p - a).dot(normal).abs()
    } else {
        segment(a, b).min(segment(b, c)).min(segment(c, a))
    }
}

/// The sum of the solid angles over 4π.
fn by_solid_angles(soup: &TriangleSoup, p: DVec3) -> f64 {
    let angles = soup.triangles.iter().map(|t| {
        let [a, b, c] = t.map(|v| soup.positions[v.index()] - p);
        let (la, lb, lc) = (a.length(), b.length(), c.length());
        let below = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
        2.0 * a.dot(b.cross(c)).atan2(below)
    });
    angles.sum::<f64>() / (4.0 * std::f64::consts::PI)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn as_brute_force_says(
        bumps in prop::collection::vec(0.5..1.5, 66),
        points in prop::collection::vec(prop::array::uniform3(-2.0..2.0), 1..40),
    ) {
        // A star: its own sign is the radius compared, but for its facets.
        let mut soup = sphere(2);
        soup.positions.iter_mut().zip(&bumps).for_each(|(p, bump)| *p *= *bump);
        let distance = distance_to(&soup);
        for p in points.into_iter().map(DVec3::from) {
            let corners = soup.triangles.iter().map(|t| t.map(|v| soup.positions[v.index()]));
            let least = corners.map(|c| to_triangle(p, c)).fold(f64::MAX, f64::min);
            let s = distance.sample(p);
            prop_assert!((s.distance.abs() - least).abs() < 1e-12, "{} {}", s.distance, least);
            prop_assert!((s.nearest.distance(p) - least).abs() < 1e-12);
            let own = soup.triangles[s.triangle.index()].map(|v| soup.positions[v.index()]);
            prop_assert!(to_triangle(s.nearest, own) < 1e-12);
            let winding = by_solid_angles(&soup, p);
            if least > 1e-3 {
                prop_assert_eq!(s.distance < 0.0, winding > 0.5, "{}", winding);
            }
        }
    }

    /// Tetrahedra and points of a small lattice: zero exactly where integers say that a point is on a face.
    #[test]
    fn on_the_surface_as_integers_say(
        corners in prop::array::uniform4(prop::array::uniform3(-3_i64..=3)),
        points in prop::collection::vec(prop::array::uniform3(-3_i64..=3), 1..60),
    ) {
        let real = |p: [i64; 3]| DVec3::new(p[0] as f64, p[1] as f64, p[2] as f64);
        let faces = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
        let soup = soup(corners.map(real).to_vec(), &faces);
        let distance = distance_to(&soup);
        for p in points {
            let on = faces.iter().any(|f| on_triangle(p, f.map(|v| corners[v as usize])));
            let s = distance.sample(real(p));
            prop_assert_eq!(s.distance.to_bits() == 0, on, "{:?} {:?}", p, s);
            prop_assert!(!on || s.nearest == real(p));
        }
    }
}

/// Whether p = a + s (b − a) + t (c − a) with s, t ≥ 0 and s + t ≤ 1, in integers. Flat triangles are their sides.
fn on_triangle(p: [i64; 3], [a, b, c]: [[i64; 3]; 3]) -> bool {
    let minus = |u: [i64; 3], v: [i64; 3]| [u[0] - v[0], u[1] - v[1], u[2] - v[2]];
    let cross = |u: [i64; 3], v: [i64; 3]| {
        [
            u[1] * v[2] - u[2] * v[1],
            u[2] * v[0] - u[0] * v[2],
            u[0] * v[1] - u[1] * v[0],
        ]
    };
    let dot = |u: [i64; 3], v: [i64; 3]| u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
    let normal = cross(minus(b, a), minus(c, a));
    if normal == [0; 3] {
        let on_side =
            |s, t| cross(minus(t, s), minus(p, s)) == [0; 3] && dot(minus(s, p), minus(t, p)) <= 0;
        return on_side(a, b) || on_side(b, c) || on_side(c, a);
    }
    let beside = |s, t| dot(cross(minus(t, s), minus(p, s)), normal) >= 0;
    dot(minus(p, a), normal) == 0 && beside(a, b) && beside(b, c) && beside(c, a)
}
