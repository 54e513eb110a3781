//! Points for the tests.

use pellicle_geometry::DVec3;

#[path = "../../examples/common/random.rs"]
mod random;

pub use random::SplitMix as Random;

/// So many points in equal steps; exactly on a line if start and step are small integers.
pub fn collinear(count: usize, start: DVec3, step: DVec3) -> Vec<DVec3> {
    (0..count).map(|i| start + step * i as f64).collect()
}

/// All integer points on the circle of this radius around the origin.
pub fn integer_ring(radius: i64) -> Vec<[f64; 2]> {
    let mut ring = Vec::new();
    for x in -radius..=radius {
        let square = radius * radius - x * x;
        let y = square.isqrt();
        if y * y == square {
            ring.push([x as f64, y as f64]);
            if y > 0 {
                ring.push([x as f64, -y as f64]);
            }
        }
    }
    ring
}

/// All integer points on the sphere with this squared radius around the origin.
pub fn integer_sphere(square: i64) -> Vec<DVec3> {
    let most = square.isqrt();
    let mut points = Vec::new();
    for x in -most..=most {
        for y in -most..=most {
            let rest = square - x * x - y * y;
            if rest < 0 {
                continue;
            }
            let z = rest.isqrt();
            if z * z == rest {
                points.push(DVec3::new(x as f64, y as f64, z as f64));
                if z > 0 {
                    points.push(DVec3::new(x as f64, y as f64, -z as f64));
                }
            }
        }
    }
    points
}

/// All points that come of one by permuting its coordinates and changing their signs, each once.
pub fn permutations_with_signs([a, b, c]: [f64; 3]) -> Vec<DVec3> {
    let orders = [
        [a, b, c],
        [a, c, b],
        [b, a, c],
        [b, c, a],
        [c, a, b],
        [c, b, a],
    ];
    let mut points: Vec<DVec3> = Vec::new();
    for order in orders {
        for signs in 0..8 {
            let signed = [0, 1, 2].map(|i| {
                if signs >> i & 1 == 1 {
                    -order[i]
                } else {
                    order[i]
                }
            });
            let point = DVec3::from_array(signed);
            if !points.contains(&point) {
                points.push(point);
            }
        }
    }
    points
}

/// With the golden ratio as near as a double comes.
pub fn icosahedron() -> Vec<DVec3> {
    let golden = (1.0 + 5.0_f64.sqrt()) / 2.0;
    let mut points = Vec::new();
    for signs in 0..4 {
        let one = if signs & 1 == 0 { 1.0 } else { -1.0 };
        let other = if signs & 2 == 0 { golden } else { -golden };
        points.push(DVec3::new(0.0, one, other));
        points.push(DVec3::new(one, other, 0.0));
        points.push(DVec3::new(other, 0.0, one));
    }
    points
}
