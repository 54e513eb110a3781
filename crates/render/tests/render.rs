//! What a picture must show, checked on shapes whose pictures are known in closed form.

mod common;

use common::hash;
use pellicle_geometry::{DVec3, VertexId};
use pellicle_mesh::TriangleSoup;
use pellicle_render::{
    Error, Image, Options, Palette, Projection, Shading, Up, View, render_mesh, render_points,
};
use std::collections::HashMap;

/// One view from above, parallel, without shadows: x to the right and y up.
fn plain(width: u32, height: u32) -> Options {
    Options {
        width,
        height,
        views: vec![View::Top],
        up: Up::Z,
        projection: Projection::Orthographic,
        occlusion: 0.0,
        ..Options::default()
    }
}

fn soup(positions: &[[f64; 3]], triangles: &[[u32; 3]]) -> TriangleSoup {
    TriangleSoup {
        positions: positions.iter().map(|&p| DVec3::from_array(p)).collect(),
        triangles: triangles.iter().map(|t| t.map(VertexId)).collect(),
    }
}

fn draw(soup: &TriangleSoup, options: &Options) -> Image {
    render_mesh(soup.into(), options).unwrap()
}

/// A subdivided octahedron on the unit sphere: 8 · 4^`level` triangles, counter-clockwise from outside, closed.
fn sphere(level: u32) -> TriangleSoup {
    let n = 1 << level;
    let mut ids = HashMap::new();
    let mut result = TriangleSoup::default();
    for octant in 0..8_u32 {
        let axis = |bit: u32| if octant >> bit & 1 == 0 { 1 } else { -1 };
        let signs = [axis(0), axis(1), axis(2)];
        let mut vertex = |i: i32, j: i32| {
            let corner = [(n - i) * signs[0], (i - j) * signs[1], j * signs[2]];
            *ids.entry(corner).or_insert_with(|| {
                let position = DVec3::from_array(corner.map(f64::from)).normalize();
                result.positions.push(position);
                VertexId::new(result.positions.len() - 1)
            })
        };
        for i in 0..n {
            for j in 0..=i {
                let mut faces = vec![[vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1)]];
                if j < i {
                    faces.push([vertex(i, j), vertex(i + 1, j + 1), vertex(i, j + 1)]);
                }
                for mut face in faces {
                    if signs.iter().product::<i32>() < 0 {
                        face.swap(1, 2);
                    }
                    result.triangles.push(face);
                }
            }
        }
    }
    result
}

fn pixel(image: &Image, x: u32, y: u32) -> [u8; 4] {
    image.pixels[(y * image.width + x) as usize]
}

fn covered(image: &Image) -> usize {
    let background = Palette::default().background;
    image
        .pixels
        .iter()
        .filter(|pixel| pixel[..3] != background)
        .count()
}

/// Whether a pixel is exactly of a mark's colour.
fn shows(image: &Image, color: [u8; 3]) -> usize {
    image
        .pixels
        .iter()
        .filter(|pixel| pixel[..3] == color)
        .count()
}

#[test]
fn a_square_covers_what_it_must() {
    let square = soup(
        &[
            [0.0, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [1.0, 1.0, 0.0],
            [0.0, 1.0, 0.0],
        ],
        &[[0, 1, 2], [0, 2, 3]],
    );
    let options = Options {
        samples: 1,
        ..plain(200, 100)
    };
    let image = draw(&square, &options);
    // The side is 88 % of the lower dimension, and the border's half width of one pixel stands out on each side.
    assert_eq!(covered(&image), 90 * 90);
    // Inside, both triangles are one plane: one colour, and no gap along the diagonal.
    let middle = pixel(&image, 100, 50);
    for y in 10..90 {
        for x in 60..140 {
            assert_eq!(pixel(&image, x, y), middle, "{x} {y}");
        }
    }
}

#[test]
fn the_silhouette_of_a_sphere_is_a_circle() {
    let options = Options {
        samples: 1,
        ..plain(400, 400)
    };
    let image = draw(&sphere(6), &options);
    let radius: f64 = 0.88 * 200.0;
    let area = std::f64::consts::PI * radius * radius;
    // The polygon is smaller by some hundred-thousandths; counting centres errs by a fraction of the outline.
    let outline = 2.0 * std::f64::consts::PI * radius;
    assert!((covered(&image) as f64 - area).abs() < 0.25 * outline);
}

#[test]
fn the_back_is_tinted() {
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    for projection in [Projection::Orthographic, Projection::Perspective] {
        for shading in [Shading::Flat, Shading::Smooth] {
            let options = Options {
                projection,
                shading,
                ..plain(90, 90)
            };
            let seen = |face: [u32; 3]| pixel(&draw(&soup(&corners, &[face]), &options), 30, 60);
            let (front, back) = (seen([0, 1, 2]), seen([0, 2, 1]));
            // The front is close to grey, the back's green is far below its red.
            assert!(front[0].abs_diff(front[1]) < 20, "{front:?}");
            assert!(back[0] > back[1] + 50, "{back:?}");
        }
    }
}

#[test]
fn borders_and_edges_of_three_are_marked() {
    let palette = Palette::default();
    let open = soup(
        &[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
        &[[0, 1, 2]],
    );
    let image = draw(&open, &plain(120, 120));
    assert!(shows(&image, palette.border) > 200);
    assert_eq!(shows(&image, palette.non_manifold), 0);

    let book = soup(
        &[
            [0.0, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [0.0, -1.0, 0.0],
            [0.5, 1.0, -1.0],
        ],
        &[[0, 1, 2], [1, 0, 3], [0, 1, 4]],
    );
    assert!(shows(&draw(&book, &plain(120, 120)), palette.non_manifold) > 40);

    let closed = draw(&sphere(2), &plain(120, 120));
    assert_eq!(
        shows(&closed, palette.border) + shows(&closed, palette.non_manifold),
        0
    );
}

#[test]
fn what_is_nearer_hides_what_is_behind() {
    // A small triangle below a large one, in either order of the list.
    let corners = [
        [-1.0, -1.0, 0.0],
        [3.0, -1.0, 0.0],
        [-1.0, 3.0, 0.0],
        [0.0, 0.0, -1.0],
        [0.5, 0.0, -1.0],
        [0.0, 0.5, -1.0],
    ];
    for faces in [[[0, 1, 2], [3, 5, 4]], [[3, 5, 4], [0, 1, 2]]] {
        for projection in [Projection::Orthographic, Projection::Perspective] {
            let above = Options {
                projection,
                ..plain(200, 200)
            };
            let below = Options {
                views: vec![View::Bottom],
                ..above.clone()
            };
            let border = Palette::default().border;
            let from_above = shows(&draw(&soup(&corners, &faces), &above), border);
            let alone = shows(&draw(&soup(&corners, &faces[..1]), &above), border);
            let large_first = faces[0] == [0, 1, 2];
            if large_first {
                assert_eq!(from_above, alone);
            }
            let from_below = shows(&draw(&soup(&corners, &faces), &below), border);
            assert!(from_below > from_above + 50, "{from_above} {from_below}");
        }
    }
}

#[test]
fn scale_and_place_do_not_matter() {
    let base = sphere(3);
    let expected = draw(
        &base,
        &Options {
            width: 160,
            height: 120,
            ..Options::default()
        },
    );
    for (scale, shift) in [
        (2.0_f64.powi(900), 0.0),
        (2.0_f64.powi(-900), 0.0),
        (0.5, 0.0),
    ] {
        let mut moved = base.clone();
        for p in &mut moved.positions {
            *p = *p * scale + DVec3::splat(shift);
        }
        let options = Options {
            width: 160,
            height: 120,
            ..Options::default()
        };
        assert_eq!(draw(&moved, &options), expected, "{scale}");
    }
}

#[test]
fn threads_do_not_matter_and_the_bytes_are_known() {
    let mesh = sphere(4);
    let points = &mesh.positions;
    let options = Options {
        width: 320,
        height: 240,
        shading: Shading::Smooth,
        ..Options::default()
    };
    let draw_all = || {
        let mesh = draw(&mesh, &options);
        let balls = render_points(points, None, &options).unwrap();
        let discs = render_points(points, Some(points), &options).unwrap();
        [mesh, balls, discs]
    };
    let with = |threads| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(draw_all)
    };
    let (one, four) = (with(1), with(4));
    assert!(one == four);
    assert_eq!(
        one.each_ref().map(hash),
        [
            18_116_948_775_827_914_944,
            6_309_772_033_225_979_790,
            9_106_188_400_122_428_267
        ]
    );
}

#[test]
fn perspective_enlarges_what_is_near() {
    let points = [DVec3::new(-1.0, 0.0, 1.0), DVec3::new(1.0, 0.0, -1.0)];
    let options = |projection| Options {
        projection,
        point_radius: Some(0.3),
        ..plain(300, 150)
    };
    let halves = |projection| {
        let image = render_points(&points, None, &options(projection)).unwrap();
        let background = Palette::default().background;
        let count = |from: u32, to: u32| {
            (0..image.height)
                .flat_map(|y| (from..to).map(move |x| (x, y)))
                .filter(|&(x, y)| pixel(&image, x, y)[..3] != background)
                .count()
        };
        (count(0, 150), count(150, 300))
    };
    let (left, right) = halves(Projection::Orthographic);
    assert!(left.abs_diff(right) * 50 < left, "{left} {right}");
    let (near, far) = halves(Projection::Perspective);
    assert!(near > far + far / 4, "{near} {far}");
}

#[test]
fn discs_have_a_front_and_a_back() {
    let options = Options {
        point_radius: Some(1.0),
        ..plain(60, 60)
    };
    let seen = |normal: DVec3| {
        let image = render_points(&[DVec3::ZERO], Some(&[normal]), &options).unwrap();
        pixel(&image, 30, 30)
    };
    let (front, back, none) = (seen(DVec3::Z), seen(DVec3::NEG_Z), seen(DVec3::ZERO));
    assert!(front[0].abs_diff(front[1]) < 20, "{front:?}");
    assert!(back[0] > back[1] + 50, "{back:?}");
    assert!(none[2] > none[0] + 20, "{none:?}");
    assert_eq!(seen(DVec3::NAN), none);
}

#[test]
fn nothing_to_see_is_a_picture_and_nonsense_an_error() {
    let options = plain(30, 20);
    let empty = draw(&TriangleSoup::default(), &options);
    assert_eq!(covered(&empty), 0);
    assert_eq!(covered(&render_points(&[], None, &options).unwrap()), 0);
    let lone = render_points(&[DVec3::splat(1e300)], None, &options).unwrap();
    assert!(covered(&lone) > 0);
    let flat = soup(&[[1.0, 1.0, 1.0]], &[[0, 0, 0]]);
    let _ = draw(&flat, &options);

    let missing = soup(&[[0.0; 3]], &[[0, 0, 1]]);
    assert!(matches!(
        render_mesh((&missing).into(), &options),
        Err(Error::NoSuchVertex {
            triangle: 0,
            vertex: VertexId(1),
            vertices: 1
        })
    ));
    let not_finite = soup(&[[0.0; 3], [f64::NAN, 0.0, 0.0]], &[[0, 0, 1]]);
    assert!(matches!(
        render_mesh((&not_finite).into(), &options),
        Err(Error::NotFinite {
            vertex: VertexId(1),
            ..
        })
    ));
    let unused = soup(
        &[
            [0.0; 3],
            [f64::NAN, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
        ],
        &[[0, 2, 3]],
    );
    assert!(
        covered(&draw(&unused, &options)) > 0,
        "a vertex of no triangle does not count"
    );
}
