//! Meshes with known measures, made by formula.
#![allow(dead_code)]

use pellicle_geometry::{DVec3, VertexId};
use pellicle_mesh::{TriMesh, TriangleSoup, cuboid};
use std::f64::consts::TAU;

pub fn soup(positions: Vec<DVec3>, triangles: &[[u32; 3]]) -> TriangleSoup {
    TriangleSoup {
        positions,
        triangles: triangles.iter().map(|t| t.map(VertexId)).collect(),
    }
}

pub fn mesh(soup: TriangleSoup) -> TriMesh {
    let mesh = TriMesh::try_from(soup).expect("a manifold");
    assert_eq!(mesh.validate(), []);
    mesh
}

/// The unit cube, 12 triangles, counter-clockwise seen from outside.
pub fn cube() -> TriangleSoup {
    cuboid(DVec3::ZERO, DVec3::ONE).unwrap().into_soup()
}

/// The tetrahedron (0, x, y, z).
pub fn tetrahedron() -> TriangleSoup {
    soup(
        vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z],
        &[[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]],
    )
}

/// The octahedron with every triangle split in four `levels` times and pushed onto the unit sphere.
pub fn sphere(levels: usize) -> TriangleSoup {
    let mut positions = vec![
        DVec3::X,
        DVec3::Y,
        -DVec3::X,
        -DVec3::Y,
        DVec3::Z,
        -DVec3::Z,
    ];
    let mut triangles: Vec<[u32; 3]> = (0..4)
        .flat_map(|i| [[i, (i + 1) % 4, 4], [(i + 1) % 4, i, 5]])
        .collect();
    for _ in 0..levels {
        let mut middles = std::collections::BTreeMap::new();
        let mut finer = Vec::new();
        for [a, b, c] in triangles {
            let mut middle = |a: u32, b: u32| {
                *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                    let p = positions[a as usize] + positions[b as usize];
                    positions.push(p.normalize());
                    positions.len() as u32 - 1
                })
            };
            let [ab, bc, ca] = [middle(a, b), middle(b, c), middle(c, a)];
            finer.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
        }
        triangles = finer;
    }
    soup(positions, &triangles)
}

/// A torus about the z axis, `rings` by `sides` quads.
pub fn torus(major: f64, minor: f64, rings: u32, sides: u32) -> TriangleSoup {
    let mut positions = Vec::new();
    let mut triangles = Vec::new();
    for i in 0..rings {
        for j in 0..sides {
            let (u, v) = (
                TAU * f64::from(i) / f64::from(rings),
                TAU * f64::from(j) / f64::from(sides),
            );
            let r = major + minor * v.cos();
            positions.push(DVec3::new(r * u.cos(), r * u.sin(), minor * v.sin()));
            let at = |i: u32, j: u32| (i % rings) * sides + j % sides;
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    soup(positions, &triangles)
}

/// A strip of `segments` quads closed to a ring with half a turn; one-sided, with one border. Triangles
/// run the same way round along the strip, and meet wrongly at one seam.
pub fn moebius(segments: u32) -> TriangleSoup {
    let mut positions = Vec::new();
    let mut triangles = Vec::new();
    for i in 0..segments {
        let u = TAU * f64::from(i) / f64::from(segments);
        for side in [-0.3, 0.3] {
            let r = 1.0 + side * (u / 2.0).cos();
            positions.push(DVec3::new(r * u.cos(), r * u.sin(), side * (u / 2.0).sin()));
        }
        let (a, b) = (2 * i, 2 * i + 1);
        let (c, d) = if i + 1 < segments {
            (a + 2, b + 2)
        } else {
            (1, 0)
        };
        triangles.extend([[a, c, b], [b, c, d]]);
    }
    soup(positions, &triangles)
}

/// A flat grid of `nx` by `ny` unit quads in the plane z = 0, facing up.
pub fn sheet(nx: u32, ny: u32) -> TriangleSoup {
    let mut positions = Vec::new();
    let mut triangles = Vec::new();
    for y in 0..=ny {
        for x in 0..=nx {
            positions.push(DVec3::new(f64::from(x), f64::from(y), 0.0));
            if x < nx && y < ny {
                let a = y * (nx + 1) + x;
                let [b, c, d] = [a + 1, a + nx + 2, a + nx + 1];
                triangles.extend([[a, b, c], [a, c, d]]);
            }
        }
    }
    soup(positions, &triangles)
}

/// Both soups as one.
pub fn together(mut a: TriangleSoup, b: TriangleSoup) -> TriangleSoup {
    let shift = a.positions.len() as u32;
    a.positions.extend(b.positions);
    a.triangles
        .extend(b.triangles.iter().map(|t| t.map(|v| VertexId(v.0 + shift))));
    a
}

pub fn moved(mut soup: TriangleSoup, by: DVec3) -> TriangleSoup {
    soup.positions.iter_mut().for_each(|p| *p += by);
    soup
}

/// A fixture in OFF.
pub fn off(name: &str) -> TriangleSoup {
    let path = format!("{}/../../fixtures/{name}.off", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(path).expect("a fixture");
    let lines = text.lines().map(|l| l.split('#').next().unwrap_or(""));
    let mut words = lines.flat_map(str::split_whitespace).skip(1);
    let mut number = || {
        words
            .next()
            .expect("a number")
            .parse::<f64>()
            .expect("a number")
    };
    let (vertices, faces, _) = (number() as usize, number() as usize, number());
    let positions = (0..vertices)
        .map(|_| DVec3::new(number(), number(), number()))
        .collect();
    let triangles: Vec<[u32; 3]> = (0..faces)
        .map(|_| {
            assert_eq!(number(), 3.0);
            [number() as u32, number() as u32, number() as u32]
        })
        .collect();
    soup(positions, &triangles)
}

/// What no edit and no remeshing may change: components, genus, border loops, χ.
pub fn topology(mesh: &TriMesh) -> (usize, Option<usize>, usize, i64) {
    let s = pellicle_mesh::summarize(mesh.into()).unwrap();
    let sum = |of: fn(&pellicle_mesh::Component) -> i64| s.components.iter().map(of).sum::<i64>();
    let loops = sum(|c| c.border_loops as i64) as usize;
    let characteristic = sum(|c| c.euler_characteristic());
    (s.components.len(), s.genus(), loops, characteristic)
}
