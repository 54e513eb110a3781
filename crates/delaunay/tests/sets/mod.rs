//! Points for the tests.

use pellicle_geometry::DVec3;

/// The SplitMix64 generator.
pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Uniform in [0, 1).
    pub fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1u64 << 53) as f64
    }

    pub fn below(&mut self, n: usize) -> usize {
        (self.next() % n as u64) as usize
    }

    pub fn in_cube(&mut self) -> DVec3 {
        DVec3::new(self.unit(), self.unit(), self.unit())
    }

    /// Of length one, uniform.
    pub fn direction(&mut self) -> DVec3 {
        loop {
            let p = self.in_cube() * 2.0 - 1.0;
            if (1e-6..=1.0).contains(&p.length_squared()) {
                return p.normalize();
            }
        }
    }

    pub fn shuffle<T>(&mut self, items: &mut [T]) {
        for i in (1..items.len()).rev() {
            items.swap(i, self.below(i + 1));
        }
    }
}

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
