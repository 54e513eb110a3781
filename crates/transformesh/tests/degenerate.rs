//! Inputs that are open, empty, broken or flat: refused by name or repaired, never a panic.

mod common;

use common::*;
use pellicle_geometry::{DVec3, VertexId};
use pellicle_mesh::{TriangleSoup, signed_volume};
use pellicle_transformesh::{Rule, repair};

const RULES: [Rule; 3] = [Rule::Outside, Rule::Union, Rule::Nonzero];

fn cube() -> TriangleSoup {
    cuboid(DVec3::ZERO, DVec3::ONE)
}

#[test]
fn open_meshes_are_refused() {
    let mut lidless = cube();
    lidless.triangles.pop();
    let one = TriangleSoup {
        positions: vec![DVec3::ZERO, DVec3::X, DVec3::Y],
        triangles: vec![[0, 1, 2].map(VertexId)],
    };
    for open in [workload("open_sphere_overlap"), lidless, one] {
        for rule in [Rule::Union, Rule::Nonzero] {
            let error = repair(&open, &options(rule)).expect_err("no inside is defined");
            assert!(!error.to_string().is_empty());
        }
        // Refused or repaired, but survived.
        let _ = repair(&open, &options(Rule::Outside));
    }
}

#[test]
fn nothing_stays_nothing() {
    for rule in RULES {
        let (mesh, report) = repair(&TriangleSoup::default(), &options(rule)).unwrap();
        assert!(mesh.triangles().is_empty() && report.sources.is_empty());
        let alone = TriangleSoup {
            positions: vec![DVec3::ONE],
            triangles: Vec::new(),
        };
        if let Ok((mesh, _)) = repair(&alone, &options(rule)) {
            assert!(mesh.triangles().is_empty());
        }
    }
}

#[test]
fn what_is_not_finite_or_not_there_is_refused() {
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let mut soup = cube();
        soup.positions[3].y = bad;
        for rule in RULES {
            assert!(repair(&soup, &options(rule)).is_err());
        }
    }
    for bad in [8, u32::MAX] {
        let mut soup = cube();
        soup.triangles[5][1] = VertexId(bad);
        for rule in RULES {
            assert!(repair(&soup, &options(rule)).is_err());
        }
    }
}

/// Triangles that bound nothing: twice the same vertex, two sheets back to back, corners on one line.
#[test]
fn triangles_without_an_inside_vanish() {
    let with = |extra: &[[u32; 3]]| {
        let mut soup = cube();
        soup.positions.push(DVec3::splat(0.5));
        soup.positions.push(DVec3::splat(0.25));
        soup.triangles.extend(extra.iter().map(|t| t.map(VertexId)));
        soup
    };
    for soup in [
        with(&[[0, 0, 1]]),
        with(&[[3, 3, 3]]),
        with(&[[0, 1, 8], [0, 8, 1]]),
        with(&[[0, 7, 8], [0, 8, 7]]),
        // Back to back on one line, within the diagonal.
        with(&[[0, 9, 8], [8, 9, 0]]),
        // Back to back, outside of the cube.
        with(&[[0, 1, 2], [2, 1, 0]]),
    ] {
        let (mesh, _) = repaired(&soup, Rule::Union);
        assert_eq!(topology(&mesh), (1, 0));
        assert!((signed_volume((&mesh).into()) - 1.0).abs() < 1e-12);
    }
}

#[test]
fn every_triangle_twice_and_thrice() {
    for times in [2, 3] {
        let mut soup = cube();
        soup.triangles = soup.triangles.repeat(times);
        let (mesh, _) = repaired(&soup, Rule::Union);
        assert_eq!(topology(&mesh), (1, 0));
        assert!((signed_volume((&mesh).into()) - 1.0).abs() < 1e-12);
    }
}

/// A vertex on an edge of two other triangles: closed in space, not by vertices.
#[test]
fn flat_triangles_close_what_is_closed_in_space() {
    let mut soup = cube();
    let middle = VertexId(8);
    soup.positions.push(DVec3::new(0.5, 0.0, 0.0));
    // Each of the two triangles at the edge 0–1 in two, but one of them by way of a flat triangle 0, 8, 1.
    let at = |soup: &TriangleSoup, from: u32, to: u32| {
        soup.triangles
            .iter()
            .position(|t| (0..3).any(|i| t[i] == VertexId(from) && t[(i + 1) % 3] == VertexId(to)))
    };
    let cut = at(&soup, 0, 1).unwrap();
    let t = soup.triangles.swap_remove(cut);
    let apex = t.into_iter().find(|v| v.0 > 1).unwrap();
    soup.triangles.push([VertexId(0), middle, apex]);
    soup.triangles.push([middle, VertexId(1), apex]);
    soup.triangles.push([VertexId(0), VertexId(1), middle]);
    let (mesh, _) = repaired(&soup, Rule::Union);
    assert_eq!(topology(&mesh), (1, 0));
    assert!((signed_volume((&mesh).into()) - 1.0).abs() < 1e-12);
}

/// A body squeezed flat has no inside.
#[test]
fn flat_bodies_vanish() {
    for squeeze in [
        DVec3::new(1.0, 1.0, 0.0),
        DVec3::new(0.0, 1.0, 0.0),
        DVec3::ZERO,
    ] {
        let soup = mapped(&workload("cubes_generic"), |p| p * squeeze + 0.3);
        for rule in [Rule::Union, Rule::Nonzero] {
            let (mesh, _) = repaired(&soup, rule);
            assert!(mesh.triangles().is_empty());
        }
    }
}

/// Figure 6 of Zaharescu et al. 2007: one corner pulled through the opposite face turns the triangles at it inside out.
#[test]
fn a_corner_pulled_through_the_opposite_face() {
    let mut soup = tetrahedron([DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z]);
    soup.positions[3] = DVec3::new(0.2, 0.2, -1.0);
    let (mesh, _) = repaired(&soup, Rule::Union);
    assert!(mesh.triangles().is_empty());
    // On a larger body only the part beyond the far face is inside out.
    let mut cube = cube();
    let apex = VertexId(8);
    cube.positions.push(DVec3::new(0.5, 0.4, -0.75));
    let top: Vec<[VertexId; 3]> = cube
        .triangles
        .extract_if(.., |t| t.iter().all(|v| v.0 >= 4))
        .collect();
    assert_eq!(top.len(), 2);
    for edge in [[4, 5], [5, 7], [7, 6], [6, 4]] {
        cube.triangles
            .push([VertexId(edge[0]), VertexId(edge[1]), apex]);
    }
    let (mesh, _) = repaired(&cube, Rule::Union);
    assert!(!mesh.triangles().is_empty());
}

/// A fan of many thin pieces through one point.
#[test]
fn many_bodies_in_one_point() {
    let mut parts = Vec::new();
    for i in 0..12_i32 {
        let (x, y) = (f64::from(i % 4) - 1.5, f64::from(i / 4) - 1.0);
        let z = if i % 2 == 0 { 4.0 } else { -4.0 };
        parts.push(tetrahedron([
            DVec3::ZERO,
            DVec3::new(x, y, z),
            DVec3::new(x + z / 8.0, y, z),
            DVec3::new(x, y + 0.5, z),
        ]));
    }
    for rule in [Rule::Union, Rule::Nonzero] {
        repaired(&joined(parts.clone()), rule);
    }
}
