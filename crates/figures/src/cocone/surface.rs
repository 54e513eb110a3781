//! Surfaces whose local feature size is known in closed form, and how densely points sample them.

use crate::Random;
use pellicle::prelude::DVec3;
use pellicle::spatial::KdTree;
use std::collections::HashMap;
use std::f64::consts::{PI, TAU};

/// The radius of the ring of the torus.
const RING: f64 = 1.0;

/// A closed surface around the origin, with the distance f of its points to the medial axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Surface {
    /// The unit sphere: the medial axis is the centre, f = 1.
    Sphere,
    /// A torus about z whose ring has radius 1: the medial axis is that ring and the z-axis, so f is the lesser of the
    /// tube's radius and the distance to the z-axis.
    Torus {
        /// The radius of the tube, below 1.
        tube: f64,
    },
}

impl Surface {
    /// The point at parameters in 0..1: longitude, and latitude or the angle around the tube.
    pub fn point(self, u: f64, v: f64) -> DVec3 {
        let (sin_u, cos_u) = libm::sincos(TAU * u);
        match self {
            Self::Sphere => {
                let (sin, cos) = libm::sincos(PI * (v - 0.5));
                DVec3::new(cos * cos_u, cos * sin_u, sin)
            }
            Self::Torus { tube } => {
                let (sin, cos) = libm::sincos(TAU * v);
                let radius = RING + tube * cos;
                DVec3::new(radius * cos_u, radius * sin_u, tube * sin)
            }
        }
    }

    /// A point, uniform over the area.
    pub fn random_point(self, random: &mut Random) -> DVec3 {
        match self {
            Self::Sphere => {
                let z = 2.0 * random.unit() - 1.0;
                let (sin, cos) = libm::sincos(TAU * random.unit());
                let r = (1.0 - z * z).max(0.0).sqrt();
                DVec3::new(r * cos, r * sin, z)
            }
            Self::Torus { tube } => loop {
                let v = random.unit();
                let width = (RING + tube * libm::cos(TAU * v)) / (RING + tube);
                if random.unit() < width {
                    return self.point(random.unit(), v);
                }
            },
        }
    }

    /// Negative inside, positive outside; the signed distance.
    pub fn distance(self, p: DVec3) -> f64 {
        match self {
            Self::Sphere => p.length() - 1.0,
            Self::Torus { tube } => libm::hypot(axial(p) - RING, p.z) - tube,
        }
    }

    /// The outward unit normal at the nearest point of the surface.
    pub fn normal(self, p: DVec3) -> DVec3 {
        match self {
            Self::Sphere => p.normalize(),
            Self::Torus { .. } => (p - ring_point(p)).normalize(),
        }
    }

    /// f: the distance of a point of the surface to the medial axis.
    pub fn feature_size(self, p: DVec3) -> f64 {
        match self {
            Self::Sphere => 1.0,
            Self::Torus { tube } => tube.min(axial(p)),
        }
    }

    /// The Euler characteristic.
    pub fn euler_characteristic(self) -> i64 {
        match self {
            Self::Sphere => 2,
            Self::Torus { .. } => 0,
        }
    }

    /// No point of the surface whose parameters are within half of `du` and `dv` of these is farther than this.
    fn reach(self, v: f64, du: f64, dv: f64) -> f64 {
        match self {
            Self::Sphere => {
                // The circle of latitude nearest to the equator.
                let from_equator = ((v - 0.5).abs() - 0.5 * dv).max(0.0);
                PI * du * libm::cos(PI * from_equator) + 0.5 * PI * dv
            }
            Self::Torus { tube } => PI * (du * (RING + tube) + dv * tube),
        }
    }

    /// Random points of which no two are nearer than `spacing` times the larger f of the two, and few others could be
    /// added.
    pub fn scatter(self, spacing: f64, random: &mut Random) -> Vec<DVec3> {
        let most = match self {
            Self::Sphere => 1.0,
            Self::Torus { tube } => tube,
        };
        let cell_of = |p: DVec3| (p / (spacing * most)).floor().to_array().map(|x| x as i64);
        let mut cells: HashMap<[i64; 3], Vec<DVec3>> = HashMap::new();
        let mut points: Vec<DVec3> = Vec::new();
        // The free area shrinks slowly: fifty tries a point leave less than a hundredth.
        let mut tries = 0;
        while tries < 50 * points.len() + 2000 {
            tries += 1;
            let p = self.random_point(random);
            let [x, y, z] = cell_of(p);
            let least = |q: DVec3| spacing * self.feature_size(p).max(self.feature_size(q));
            let is_free = (0..27)
                .filter_map(|i| cells.get(&[x + i % 3 - 1, y + i / 3 % 3 - 1, z + i / 9 - 1]))
                .flatten()
                .all(|&q| q.distance(p) >= least(q));
            if is_free {
                cells.entry([x, y, z]).or_default().push(p);
                points.push(p);
            }
        }
        points
    }

    /// The ε of which the points are an ε-sample, the least one: the greatest distance of a point x of the surface to the
    /// nearest sample, over f(x). Between the two numbers returned, which differ by a part in 500 at most.
    ///
    /// Both the distance and f change by no more than x moves, so a patch of the parameters whose centre is too near to the
    /// samples, its reach counted, holds no maximum; the others are cut into four.
    pub fn epsilon(self, points: &[DVec3]) -> [f64; 2] {
        const PRECISION: f64 = 1.002;
        let tree = KdTree::new(points);
        let at = |p: DVec3| {
            tree.nearest(p)
                .map_or(f64::INFINITY, |n| n.distance_squared.sqrt())
        };
        let mut least = 0.0_f64;
        let mut most = 0.0_f64;
        let mut patches = Vec::new();
        const START: u32 = 32;
        let share = 1.0 / f64::from(START);
        for i in 0..START * START {
            let (u, v) = (f64::from(i % START) + 0.5, f64::from(i / START) + 0.5);
            patches.push((u * share, v * share, share));
        }
        // Level by level: a good lower bound early.
        while !patches.is_empty() {
            let mut next = Vec::new();
            for &(u, v, _) in &patches {
                let p = self.point(u, v);
                least = least.max(at(p) / self.feature_size(p));
            }
            for (u, v, size) in patches {
                let p = self.point(u, v);
                let reach = self.reach(v, size, size);
                let f = self.feature_size(p) - reach;
                let bound = if f > 0.0 {
                    (at(p) + reach) / f
                } else {
                    f64::INFINITY
                };
                if bound <= PRECISION * least {
                    most = most.max(bound);
                } else {
                    let quarter = 0.25 * size;
                    next.extend(
                        [-quarter, quarter].into_iter().flat_map(|du| {
                            [-quarter, quarter].map(|dv| (u + du, v + dv, 0.5 * size))
                        }),
                    );
                }
            }
            patches = next;
        }
        [least, most.max(least)]
    }
}

/// The distance to the z-axis.
fn axial(p: DVec3) -> f64 {
    libm::hypot(p.x, p.y)
}

/// The nearest point of the ring.
fn ring_point(p: DVec3) -> DVec3 {
    DVec3::new(p.x, p.y, 0.0) * (RING / axial(p))
}

#[cfg(test)]
mod tests {
    use super::*;
    use pellicle::delaunay::VoronoiVertex;
    use pellicle::prelude::*;

    const SURFACES: [Surface; 3] = [
        Surface::Sphere,
        Surface::Torus { tube: 0.4 },
        Surface::Torus { tube: 0.6 },
    ];

    #[test]
    fn points_lie_on_the_surface_and_balls_of_radius_f_along_the_normals_touch_the_medial_axis() {
        let mut random = Random::new(1, 0);
        for surface in SURFACES {
            for _ in 0..2000 {
                let p = surface.random_point(&mut random);
                assert!(surface.distance(p).abs() < 1e-14);
                let (n, f) = (surface.normal(p), surface.feature_size(p));
                // Inside: the centre is equally far from everything or from a circle of the tube.
                let h = 1e-4;
                let away = surface.distance(p + h * n) - h;
                assert!(away.abs() < 1e-13, "{away}");
                if let Surface::Torus { tube } = surface {
                    let to_axis = libm::hypot(p.x, p.y);
                    assert!(f <= tube && f <= to_axis && (f == tube || f == to_axis));
                }
            }
        }
    }

    #[test]
    fn epsilon_is_what_the_hull_of_points_on_a_sphere_says() {
        // On the sphere the farthest places are the directions of the facets of the convex hull.
        let mut random = Random::new(2, 0);
        for count in [40, 400, 4000] {
            let points: Vec<DVec3> = (0..count)
                .map(|_| Surface::Sphere.random_point(&mut random))
                .collect();
            let tetrahedra = tetrahedralize(&points, &Default::default()).unwrap();
            let farthest = tetrahedra
                .unbounded_voronoi_edges()
                .map(|edge| match edge.ends[1] {
                    VoronoiVertex::Infinite(n) => {
                        let corner = tetrahedra.facet(edge.facet)[0];
                        n.distance(points[corner.index()])
                    }
                    VoronoiVertex::Finite(_) => unreachable!("the second end is infinite"),
                })
                .fold(0.0, f64::max);
            let [least, most] = Surface::Sphere.epsilon(&points);
            assert!(least <= farthest && farthest <= most * (1.0 + 1e-12));
            assert!(most <= 1.0021 * least);
        }
    }

    #[test]
    fn scattered_points_are_epsilon_samples_with_the_spacing_or_little_more() {
        for surface in SURFACES {
            let points = surface.scatter(0.3, &mut Random::new(3, 0));
            let [_, epsilon] = surface.epsilon(&points);
            assert!((0.2..0.42).contains(&epsilon), "{epsilon}");
            let tree = KdTree::new(&points);
            for &p in &points {
                let next = tree.nearest_k(p, 2)[1].distance_squared.sqrt();
                assert!(next >= 0.3 * surface.feature_size(p));
            }
        }
    }
}
