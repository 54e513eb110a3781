//! Winding numbers against solid angles, and on rays through edges and vertices.

mod common;

use common::cube;
use pellicle_geometry::{DVec3, VertexId};
use pellicle_mesh::{TriMesh, TriangleSoup, icosphere, winding_numbers};
use proptest::prelude::*;

/// The sum of the solid angles of the triangles over 4π (Van Oosterom and Strackee's formula).
fn by_solid_angles(soup: &TriangleSoup, p: DVec3) -> f64 {
    let angles = soup.triangles.iter().map(|t| {
        let [a, b, c] = t.map(|v| soup.positions[v.index()] - p);
        let (la, lb, lc) = (a.length(), b.length(), c.length());
        let below = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
        2.0 * a.dot(b.cross(c)).atan2(below)
    });
    angles.sum::<f64>() / (4.0 * std::f64::consts::PI)
}

fn soup_of(mesh: TriMesh, map: impl Fn(DVec3) -> DVec3) -> TriangleSoup {
    let mut soup = mesh.into_soup();
    soup.positions.iter_mut().for_each(|p| *p = map(*p));
    soup
}

fn joined(mut first: TriangleSoup, second: TriangleSoup) -> TriangleSoup {
    let offset = first.positions.len() as u32;
    first.positions.extend(second.positions);
    let moved = second
        .triangles
        .iter()
        .map(|t| t.map(|v| VertexId(v.0 + offset)));
    first.triangles.extend(moved);
    first
}

proptest! {
    #[test]
    fn as_solid_angles_say(
        shift in prop::array::uniform3(-1.0..1.0),
        inverted: bool,
        points in prop::collection::vec(prop::array::uniform3(-2.0..2.0), 1..40),
    ) {
        let mut second = soup_of(icosphere(1).unwrap(), |p| 0.8 * p + DVec3::from(shift));
        if inverted {
            second.triangles.iter_mut().for_each(|t| t.swap(0, 1));
        }
        let soup = joined(soup_of(icosphere(2).unwrap(), |p| p), second);
        let points: Vec<DVec3> = points.into_iter().map(DVec3::from).collect();
        for (p, winding) in points.iter().zip(winding_numbers((&soup).into(), &points)) {
            prop_assert!((by_solid_angles(&soup, *p) - f64::from(winding)).abs() < 1e-6);
        }
    }

    /// Cubes of the integer lattice, and points of it half a step apart: rays through edges, vertices and along faces.
    #[test]
    fn lattice_points(corners in prop::collection::vec(prop::array::uniform3(-2..3), 1..4)) {
        let mut soup = TriangleSoup { positions: Vec::new(), triangles: Vec::new() };
        for &[x, y, z] in &corners {
            let at = glam::IVec3::new(x, y, z).as_dvec3();
            let cube = cube();
            soup = joined(soup, TriangleSoup {
                positions: cube.positions.iter().map(|p| 2.0 * *p + at).collect(),
                ..cube
            });
        }
        let steps = || -6..=10;
        let points: Vec<DVec3> = steps()
            .flat_map(|x| steps().flat_map(move |y| steps().map(move |z| glam::IVec3::new(x, y, z))))
            .map(|p| p.as_dvec3() * 0.5)
            .collect();
        for (p, winding) in points.iter().zip(winding_numbers((&soup).into(), &points)) {
            // The moved point is inside of [low, high) along y and z; on a face across x it is moved along the face, and
            // neither ahead nor behind: it counts as not ahead.
            let inside = corners.iter().filter(|&&[x, y, z]| {
                let local = *p - glam::IVec3::new(x, y, z).as_dvec3();
                let within = |c: f64| (0.0..2.0).contains(&c);
                within(local.x) && within(local.y) && within(local.z)
            });
            prop_assert_eq!(winding, inside.count() as i32, "{}", p);
        }
    }
}

#[test]
fn nothing_winds_around_what_is_not_finite() {
    let points = [
        DVec3::NAN,
        DVec3::INFINITY,
        DVec3::splat(1e300),
        DVec3::splat(0.25),
    ];
    assert_eq!(winding_numbers((&cube()).into(), &points), [0, 0, 0, 1]);
    let mut broken = cube();
    broken.positions[0] = DVec3::NAN;
    broken
        .triangles
        .push([VertexId(0), VertexId(90), VertexId(0)]);
    assert_eq!(winding_numbers((&broken).into(), &points).len(), 4);
}
