//! Areas, mean curvatures and distances of single vertices, against closed forms and brute force.

mod common;

use common::{moved, sheet, sphere, torus};
use pellicle_geometry::{DVec3, VertexId, triangle};
use pellicle_mesh::{TriangleSoup, area, mean_curvatures, point_distances, vertex_areas};

#[test]
fn areas_add_up_to_the_surface() {
    for soup in [sphere(3), torus(2.0, 0.5, 30, 20), sheet(4, 7)] {
        let areas = vertex_areas((&soup).into());
        let sum: f64 = areas.iter().sum();
        assert!((sum / area((&soup).into()) - 1.0).abs() < 1e-12);
    }
    // Inside a sheet of unit squares six triangles of ½ meet, or four to eight; each gives a third.
    let soup = sheet(4, 7);
    let mut expected = vec![0.0; soup.positions.len()];
    for vertex in soup.triangles.iter().flatten() {
        expected[vertex.index()] += 0.5 / 3.0;
    }
    for (found, expected) in vertex_areas((&soup).into()).into_iter().zip(expected) {
        assert!((found - expected).abs() < 1e-12);
    }
}

#[test]
fn mean_curvatures_of_spheres_and_tori() {
    for (radius, shift) in [
        (1.0, DVec3::ZERO),
        (250.0, DVec3::splat(1e5)),
        (1e-150, DVec3::ZERO),
    ] {
        let mut soup = sphere(4);
        soup.positions.iter_mut().for_each(|p| *p *= radius);
        let soup = moved(soup, shift);
        for found in mean_curvatures((&soup).into()) {
            assert!((found * radius - 1.0).abs() < 0.03, "{found} {radius}");
        }
        // Inside out.
        let mut turned = soup.clone();
        turned.triangles.iter_mut().for_each(|t| t.swap(0, 1));
        for found in mean_curvatures((&turned).into()) {
            assert!((found * radius + 1.0).abs() < 0.03, "{found} {radius}");
        }
    }
    let (big, small) = (2.0, 0.5);
    let soup = torus(big, small, 240, 90);
    let found = mean_curvatures((&soup).into());
    for (p, found) in soup.positions.iter().zip(found) {
        // Whichever way the torus lies: its axis is the one along which it is thinnest.
        let ring = p.truncate().length();
        let cosine = (ring - big) / small;
        let expected = (big + 2.0 * small * cosine) / (2.0 * small * ring);
        assert!((found - expected).abs() < 0.02, "{p}: {found} {expected}");
    }
}

#[test]
fn a_flat_sheet_is_flat_and_its_border_has_no_curvature() {
    let soup = sheet(5, 6);
    let found = mean_curvatures((&soup).into());
    let bounds = (0..2).map(|axis| soup.positions.iter().map(|p| p[axis]).fold(0.0, f64::max));
    let far: Vec<f64> = bounds.collect();
    let mut inner = 0;
    for (p, found) in soup.positions.iter().zip(found) {
        let on_border = (0..2).any(|axis| p[axis] == 0.0 || p[axis] == far[axis]);
        assert_eq!(found.is_nan(), on_border, "{p}");
        if !on_border {
            assert!(found.abs() < 1e-12, "{p}: {found}");
            inner += 1;
        }
    }
    assert!(inner > 0);
}

#[test]
fn where_there_is_no_curvature_there_is_nan() {
    let mut soup = sphere(1);
    // A vertex of no triangle, one of a triangle without area, and one that is not finite.
    soup.positions.extend([DVec3::X, DVec3::Y, DVec3::NAN]);
    let count = soup.positions.len() as u32;
    soup.triangles.push([0, 1, count - 1].map(VertexId));
    soup.triangles.push([0, 1, count - 2].map(VertexId));
    let found = mean_curvatures((&soup).into());
    for vertex in [0, 1, count - 3, count - 2, count - 1] {
        assert!(found[vertex as usize].is_nan(), "{vertex}");
    }
    assert!(found.iter().any(|curvature| curvature.is_finite()));
    assert!(mean_curvatures((&TriangleSoup::default()).into()).is_empty());
    assert_eq!(vertex_areas((&soup).into())[count as usize - 3], 0.0);
}

#[test]
fn distances_are_those_of_brute_force() {
    let soup = torus(2.0, 0.5, 12, 8);
    let points: Vec<DVec3> = (0..200)
        .map(|i| {
            let turn = f64::from(i) * 0.7;
            DVec3::new(
                turn.sin() * 3.0,
                (turn * 1.3).cos() * 3.0,
                f64::from(i % 7) - 3.0,
            )
        })
        .chain([DVec3::NAN])
        .collect();
    let found = point_distances(&points, (&soup).into(), &()).unwrap();
    for (p, found) in points.iter().zip(&found).take(200) {
        let brute = soup.triangles.iter().map(|t| {
            let [a, b, c] = t.map(|v| soup.positions[v.index()]);
            p.distance(triangle::closest_point(*p, a, b, c))
        });
        let expected = brute.fold(f64::INFINITY, f64::min);
        assert!((found - expected).abs() < 1e-12 * (1.0 + expected), "{p}");
    }
    assert!(found[200].is_nan());
    assert!(point_distances(&points, (&TriangleSoup::default()).into(), &()).is_err());
}
