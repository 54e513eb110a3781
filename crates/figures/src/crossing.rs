//! Closed surfaces that cross themselves, of any size: what `repair` is measured on.
//!
//! All are images of the sphere, or two of them; how fine is a frequency f, the number of parts into which each edge of
//! an icosahedron is cut: 10f² + 2 vertices and 20f² triangles a sphere.

use crate::Random;
use pellicle::geometry::Aabb;
use pellicle::mesh::{TriMesh, TriangleSoup, icosphere};
use pellicle::prelude::{DVec3, VertexId};
use std::collections::HashMap;
use std::f64::consts::{PI, TAU};

/// The stream of the bumps: the same seed for them and for a cloud's defects does not correlate them.
const BUMPS: u64 = 11;

/// Bumps of [`bumpy_offset`], and how wide one is on the unit sphere.
const BUMP_COUNT: usize = 60;
const BUMP_WIDTH: f64 = 0.16;

/// The unit sphere around the origin: each triangle of the icosahedron in `frequency`² parts, evenly, and the points
/// pushed onto the sphere.
///
/// ```
/// use pellicle_figures::crossing::geodesic_sphere;
/// let sphere = geodesic_sphere(3);
/// assert_eq!((sphere.positions.len(), sphere.triangles.len()), (92, 180));
/// ```
///
/// # Panics
/// If `frequency` is zero.
pub fn geodesic_sphere(frequency: u32) -> TriangleSoup {
    assert!(frequency > 0, "an edge has a part at least");
    let base = icosahedron();
    let mut soup = TriangleSoup::default();
    let mut of_key: HashMap<[(u32, u32); 3], VertexId> = HashMap::new();
    for &corners in base.triangles() {
        // Weights i, j, k of the corners a, b, c, of sum f; a point is known by its corners of positive weight.
        let mut at = |i: u32, j: u32| {
            let weights = [frequency - i - j, i, j];
            let mut key = [0, 1, 2].map(|n| match weights[n] {
                0 => (u32::MAX, 0),
                weight => (corners[n].0, weight),
            });
            key.sort_unstable();
            *of_key.entry(key).or_insert_with(|| {
                let weighted = key.iter().filter(|(_, weight)| *weight > 0);
                let sum: DVec3 = weighted
                    .map(|&(corner, weight)| f64::from(weight) * base.position(VertexId(corner)))
                    .sum();
                soup.positions.push(sum.normalize());
                VertexId::new(soup.positions.len() - 1)
            })
        };
        for i in 0..frequency {
            for j in 0..frequency - i {
                let [a, b, c] = [at(i, j), at(i + 1, j), at(i, j + 1)];
                soup.triangles.push([a, b, c]);
                if i + j + 2 <= frequency {
                    soup.triangles.push([b, at(i + 1, j + 1), c]);
                }
            }
        }
    }
    soup
}

fn icosahedron() -> TriMesh {
    icosphere(0).expect("twelve vertices")
}

/// Two unit spheres of this frequency whose centres are about 1.2 apart, the second turned: one body, in which two caps
/// vanish. The intersecting pairs grow with the frequency.
pub fn two_spheres(frequency: u32) -> TriangleSoup {
    let mut soup = geodesic_sphere(frequency);
    let turned = soup.positions.iter().map(|&p| {
        let (sin, cos) = libm::sincos(0.4);
        let p = DVec3::new(cos * p.x - sin * p.y, sin * p.x + cos * p.y, p.z);
        let (sin, cos) = libm::sincos(0.7);
        DVec3::new(p.x, cos * p.y - sin * p.z, sin * p.y + cos * p.z) + DVec3::new(1.2, 0.05, 0.03)
    });
    let turned: Vec<DVec3> = turned.collect();
    let offset = soup.positions.len();
    soup.positions.extend(turned);
    let second = soup.triangles.clone();
    let moved = second
        .into_iter()
        .map(|t| t.map(|v| VertexId::new(v.index() + offset)));
    soup.triangles.extend(moved);
    soup
}

/// A sphere with a crooked valley whose lips have moved through each other at three places: three bridges over the valley,
/// so a body of genus 3. The intersecting pairs grow with the frequency: a few hundred of them among 50,000 triangles.
///
/// ```text
///   ____  ____        across the valley at a bridge: the lips lean over it, and have crossed
///       \/
///       /\
///      |  |
///       \_/
/// ```
pub fn valley(frequency: u32) -> TriangleSoup {
    let mut soup = geodesic_sphere(frequency);
    for p in &mut soup.positions {
        *p = in_valley(*p);
    }
    soup
}

/// Where a point of the unit sphere goes: the valley runs along the equator from longitude −1 to 1.
fn in_valley(p: DVec3) -> DVec3 {
    const HALF_WIDTH: f64 = 0.16;
    const DEPTH: f64 = 0.25;
    let longitude = libm::atan2(p.y, p.x);
    // It fades out at its ends.
    let fading = ((1.0 - longitude * longitude) / 0.3).clamp(0.0, 1.0);
    if fading == 0.0 {
        return p;
    }
    // From −1 to 1 between the lips.
    let latitude = libm::asin(p.z.clamp(-1.0, 1.0)) - 0.05 * libm::sin(2.0 * longitude);
    let across = latitude / HALF_WIDTH;
    let floor = libm::exp(-across * across * across * across);
    let beyond = (across.abs() - 1.15) / 0.3;
    let lip = 1.9 * across * libm::exp(-0.5 * beyond * beyond);
    let lean = 0.065 + 0.055 * libm::cos(4.0 * PI * longitude);
    let (sin, cos) = libm::sincos(longitude);
    let north = DVec3::new(-p.z * cos, -p.z * sin, libm::cos(latitude)).normalize_or_zero();
    p * (1.0 - DEPTH * fading * floor) - north * (lean * lip * fading)
}

/// A sphere with many bumps, placed by the seed, and moved outwards along its normals by this share of its diagonal: where a hollow is
/// narrower than that, the surface turns inside out and crosses itself, in many places.
pub fn bumpy_offset(frequency: u32, share: f64, seed: u64) -> TriangleSoup {
    let mut random = Random::new(seed, BUMPS);
    let bumps: Vec<DVec3> = (0..BUMP_COUNT).map(|_| direction(&mut random)).collect();
    let mut soup = geodesic_sphere(frequency);
    for p in &mut soup.positions {
        let heights = bumps
            .iter()
            .map(|bump| libm::exp(-p.distance_squared(*bump) / (BUMP_WIDTH * BUMP_WIDTH)));
        *p *= 1.0 + 0.22 * heights.sum::<f64>();
    }
    let diagonal = Aabb::of_points(&soup.positions).diagonal();
    let normals = vertex_normals(&soup);
    for (p, normal) in soup.positions.iter_mut().zip(normals) {
        *p += share * diagonal * normal;
    }
    soup
}

fn direction(random: &mut Random) -> DVec3 {
    let z = 2.0 * random.unit() - 1.0;
    let (sin, cos) = libm::sincos(TAU * random.unit());
    let r = (1.0 - z * z).sqrt();
    DVec3::new(r * cos, r * sin, z)
}

/// Area-weighted normals of the vertices.
fn vertex_normals(soup: &TriangleSoup) -> Vec<DVec3> {
    let mut normals = vec![DVec3::ZERO; soup.positions.len()];
    for t in &soup.triangles {
        let [a, b, c] = t.map(|v| soup.positions[v.index()]);
        for v in t {
            normals[v.index()] += (b - a).cross(c - a);
        }
    }
    normals.into_iter().map(DVec3::normalize_or_zero).collect()
}
