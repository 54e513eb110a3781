//! The bodies of the experiments of Daniel 2015, sections 5 and 6, or what is like them.
//!
//! Lengths are such that the paper's parameters make sense: 100 to 200 units a body, and about 2.5 for the sphere with
//! bumps.

use crate::Shape;
use crate::field::{Blend, Bumps, Ellipsoid, Lobes, Part, Revolution, Star};
use pellicle::prelude::DVec3;
use std::f64::consts::PI;

/// An ellipsoid with semi-axes 70, 50 and 40.
pub fn ellipsoid() -> Shape {
    let semi_axes = DVec3::new(70.0, 50.0, 40.0);
    let volume = 4.0 / 3.0 * PI * semi_axes.element_product();
    Shape::new("ellipsoid", Ellipsoid { semi_axes }, 80, volume)
}

/// A vase, filled: a body of revolution about y, 160 high, with a foot, a belly, a waist and a wide rim.
pub fn vase() -> Shape {
    let vase = Revolution {
        half_height: 80.0,
        profile: [34.0, -46.0, 4.0, 50.0],
    };
    let volume = vase.volume();
    Shape::new("vase", vase, 100, volume)
}

/// A smooth body with four lobes and hollows between them, for figures 6 to 10.
pub fn body() -> Shape {
    let body = Star {
        center: DVec3::ZERO,
        semi_axes: DVec3::new(62.0, 54.0, 48.0),
        radius: Lobes { height: 0.3 },
    };
    let volume = body.volume();
    Shape::new("body", body, 80, volume)
}

/// A sphere of radius 1 with 32 round bumps, towards the corners of an icosahedron and of its dual, for figure 12.
pub fn bumpy_sphere() -> Shape {
    let sphere = Star {
        center: DVec3::ZERO,
        semi_axes: DVec3::ONE,
        radius: Bumps {
            directions: icosahedral_directions(),
            height: 0.14,
            edge: 0.953,
        },
    };
    let volume = sphere.volume();
    Shape::new("bumpy sphere", sphere, 90, volume)
}

/// A bust: head with brow, eyes, nose, mouth and ears, neck, shoulders and a flat base, for figure 11. The face looks
/// along z, y is up.
pub fn bust() -> Shape {
    let mut parts = vec![
        // Cranium, face, chin, cheeks.
        Part::joined([0.0, 62.0, -4.0], [26.0, 31.0, 31.0], 1.0),
        Part::joined([0.0, 43.0, 8.0], [19.5, 27.0, 20.0], 10.0),
        Part::joined([0.0, 22.5, 20.0], [8.5, 7.0, 7.5], 9.0),
        // Neck, chest, back of the shoulders.
        Part::joined([0.0, 16.0, -5.0], [15.0, 36.0, 16.0], 7.0),
        Part::joined([0.0, -30.0, 2.0], [40.0, 31.0, 23.0], 16.0),
        Part::joined([0.0, -16.0, -8.0], [52.0, 15.0, 16.0], 14.0),
        // Brow, nose.
        Part::joined([0.0, 62.5, 22.0], [18.0, 4.0, 6.5], 6.0),
        Part::joined([0.0, 53.0, 27.0], [3.0, 11.0, 5.0], 4.0),
        Part::joined([0.0, 47.0, 30.0], [3.8, 3.8, 5.0], 4.0),
        // Lips.
        Part::joined([0.0, 36.8, 27.4], [8.0, 1.9, 3.0], 1.5),
        Part::joined([0.0, 33.2, 26.8], [6.6, 2.1, 3.0], 1.5),
    ];
    for side in [-1.0, 1.0] {
        parts.extend([
            // Shoulder; nostril, eye socket, eye; ear and its hollow.
            Part::joined([side * 40.0, -24.0, -5.0], [20.0, 17.0, 18.0], 18.0),
            Part::joined([side * 3.8, 45.6, 28.0], [2.4, 2.3, 3.4], 2.5),
            Part::cut([side * 9.5, 55.0, 28.5], [6.5, 4.5, 6.0], 3.0),
            Part::joined([side * 9.5, 54.8, 20.5], [5.0, 4.6, 5.0], 1.0),
            Part::joined([side * 25.5, 52.0, -4.0], [4.0, 10.5, 6.5], 2.5),
            Part::cut([side * 29.5, 53.0, -1.5], [2.2, 6.0, 3.6], 1.5),
        ]);
    }
    let bust = Blend {
        parts,
        floor: -42.0,
        rim: 5.0,
    };
    Shape::measured("bust", bust, 120)
}

/// Two ellipsoids, one a little dented, side by side: like the vesicles of figures 13 to 15. Their clouds are sparse,
/// 400 to 800 points each, and have outliers.
pub fn vesicles() -> [Shape; 2] {
    pair([
        ("left vesicle", [-52.0, 3.0, 0.0], [36.0, 27.0, 22.0], 0.06),
        (
            "right vesicle",
            [44.0, -6.0, 5.0],
            [30.0, 35.0, 24.0],
            -0.09,
        ),
    ])
}

/// Two more, more dented and of different sizes: the other embryo, of figure 15.
pub fn other_vesicles() -> [Shape; 2] {
    pair([
        (
            "other left vesicle",
            [-46.0, -4.0, 2.0],
            [30.0, 38.0, 26.0],
            -0.14,
        ),
        (
            "other right vesicle",
            [47.0, 5.0, -3.0],
            [41.0, 25.0, 24.0],
            0.13,
        ),
    ])
}

/// Two ellipsoids by name, centre and semi-axes, with lobes of a height.
fn pair(of: [(&'static str, [f64; 3], [f64; 3], f64); 2]) -> [Shape; 2] {
    of.map(|(name, center, semi_axes, height)| {
        let vesicle = Star {
            center: center.into(),
            semi_axes: semi_axes.into(),
            radius: Lobes { height },
        };
        let volume = vesicle.volume();
        Shape::new(name, vesicle, 60, volume)
    })
}

/// Every body.
pub fn all() -> Vec<Shape> {
    let mut shapes = vec![ellipsoid(), vase(), body(), bumpy_sphere(), bust()];
    shapes.extend(vesicles());
    shapes.extend(other_vesicles());
    shapes
}

/// The 12 corners of an icosahedron and the 20 of its dual; the nearest two are 37.4° apart.
fn icosahedral_directions() -> Vec<DVec3> {
    let golden = (1.0 + 5.0_f64.sqrt()) / 2.0;
    let signs = [-1.0, 1.0];
    let mut directions = Vec::new();
    for a in signs {
        for b in signs {
            for turn in 0..3 {
                let corner = |x: f64, y: f64, z: f64| {
                    let mut corner = [x, y, z];
                    corner.rotate_right(turn);
                    DVec3::from(corner).normalize()
                };
                directions.push(corner(0.0, a, b * golden));
                directions.push(corner(0.0, a * golden, b / golden));
            }
            directions.extend(signs.map(|c| DVec3::new(a, b, c).normalize()));
        }
    }
    directions
}
