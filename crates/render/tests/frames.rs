//! Frames of an animation: one camera, and one strip.

use pellicle_geometry::{Aabb, DVec3, VertexId};
use pellicle_mesh::MeshView;
use pellicle_render::{
    Error, Image, Options, Projection, Up, View, render_mesh, render_points, strip,
};

const TRIANGLES: [[VertexId; 3]; 1] = [[VertexId(0), VertexId(1), VertexId(2)]];

fn options(bounds: Option<Aabb>) -> Options {
    Options {
        width: 100,
        height: 100,
        views: vec![View::Top],
        up: Up::Z,
        projection: Projection::Orthographic,
        occlusion: 0.0,
        bounds,
        ..Options::default()
    }
}

fn square(half: f64) -> Aabb {
    let corner = DVec3::new(half, half, 0.5);
    Aabb {
        min: -corner,
        max: corner,
    }
}

fn draw(positions: &[DVec3; 3], options: &Options) -> Image {
    let mesh = MeshView {
        positions,
        triangles: &TRIANGLES,
    };
    render_mesh(mesh, options).unwrap()
}

/// Leftmost, rightmost, uppermost and lowest pixel that is not background.
fn extent(image: &Image) -> [u32; 4] {
    let mut found = [u32::MAX, 0, u32::MAX, 0];
    for (at, pixel) in (0..).zip(&image.pixels) {
        if *pixel != image.pixels[0] {
            let (x, y) = (at % image.width, at / image.width);
            found = [
                found[0].min(x),
                found[1].max(x),
                found[2].min(y),
                found[3].max(y),
            ];
        }
    }
    found
}

fn triangle(size: f64) -> [DVec3; 3] {
    [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]].map(|[x, y]| size * DVec3::new(x, y, 0.0))
}

#[test]
fn a_thing_has_its_place_in_the_box() {
    // 88 of 100 pixels are 2 · 1 units; the middle of the box is the middle of the sheet.
    let near = |found: [u32; 4], expected: [f64; 4]| {
        for (found, expected) in found.into_iter().zip(expected) {
            assert!(
                (f64::from(found) - expected).abs() < 2.0,
                "{found} {expected}"
            );
        }
    };
    let options = options(Some(square(1.0)));
    near(
        extent(&draw(&triangle(1.0), &options)),
        [50.0, 94.0, 6.0, 50.0],
    );
    near(
        extent(&draw(&triangle(0.5), &options)),
        [50.0, 72.0, 28.0, 50.0],
    );
    let moved = triangle(0.5).map(|p| p - 0.5 * DVec3::X);
    near(extent(&draw(&moved, &options)), [28.0, 50.0, 28.0, 50.0]);
}

#[test]
fn without_a_box_each_frame_fills_its_picture() {
    let small = draw(&triangle(0.5), &options(None));
    assert_eq!(small, draw(&triangle(1.0), &options(None)));
    assert_eq!(small, draw(&triangle(1.0), &options(Some(Aabb::EMPTY))));
}

#[test]
fn what_does_not_change_has_the_same_pixels_in_every_frame() {
    // A ball of points and one that wanders to each corner of the box: nothing else may change.
    for projection in [Projection::Orthographic, Projection::Perspective] {
        for view in [View::Top, View::ThreeQuarter] {
            let options = Options {
                projection,
                views: vec![view],
                point_radius: Some(0.02),
                ..options(Some(square(1.0)))
            };
            let frames: Vec<Image> = [-1.0, 1.0]
                .iter()
                .map(|&x| {
                    let wanders = DVec3::new(x, x, 0.5 * x);
                    render_points(&[DVec3::ZERO, wanders], None, &options).unwrap()
                })
                .collect();
            // Half the picture around the middle shows the one that stays.
            let middle = |image: &Image| -> Vec<[u8; 4]> {
                let rows = image.pixels.chunks(100).skip(40).take(20);
                rows.flat_map(|row| row[40..60].to_vec()).collect()
            };
            assert_eq!(middle(&frames[0]), middle(&frames[1]));
            assert_ne!(frames[0], frames[1]);
            assert!(middle(&frames[0]).iter().any(|p| *p != frames[0].pixels[0]));
        }
    }
}

#[test]
fn what_lies_outside_of_the_box_is_not_cut_off() {
    for projection in [Projection::Orthographic, Projection::Perspective] {
        let options = Options {
            projection,
            ..options(Some(square(1.0)))
        };
        // Far behind where the viewer of the box alone would stand, too.
        for size in [3.0, 1e3, 1e300] {
            let high = triangle(size).map(|p| p + size * DVec3::Z);
            let image = draw(&high, &options);
            let [left, right, top, bottom] = extent(&image);
            // Upright: one leg along the lower edge, a tip above.
            let filled = |row: u32| {
                let row = image.pixels.chunks(100).nth(row as usize).unwrap();
                row.iter().filter(|&&p| p != image.pixels[0]).count()
            };
            assert!(filled(bottom) > filled(top) + 10, "{projection:?} {size}");
            assert!(left > 0 && right < 99 && top > 0 && bottom < 99);
            assert!(
                right > left + 20 && bottom > top + 20,
                "{projection:?} {size}"
            );
        }
    }
}

#[test]
fn a_box_that_is_not_finite_is_refused() {
    for half in [f64::NAN, f64::INFINITY] {
        let bounds = Some(square(half));
        let mesh = MeshView {
            positions: &triangle(1.0),
            triangles: &TRIANGLES,
        };
        let error = render_mesh(mesh, &options(bounds)).unwrap_err();
        assert!(matches!(error, Error::BoundsNotFinite { .. }), "{error}");
        let error = render_points(&triangle(1.0), None, &options(bounds)).unwrap_err();
        assert!(matches!(error, Error::BoundsNotFinite { .. }), "{error}");
    }
    // The largest box that there is.
    let bounds = Some(square(f64::MAX));
    assert_eq!(draw(&triangle(1.0), &options(bounds)).pixels.len(), 10_000);
}

/// An image whose pixels say which image, column and row they are.
fn numbered(image: u8, width: u32, height: u32) -> Image {
    let pixels = (0..height)
        .flat_map(|y| (0..width).map(move |x| [image, x as u8, y as u8, 255]))
        .collect();
    Image {
        width,
        height,
        pixels,
    }
}

#[test]
fn every_pixel_of_a_strip_is_where_it_belongs() {
    let images: Vec<Image> = (0..5).map(|i| numbered(i, 3, 2)).collect();
    for (columns, effective, rows) in [
        (0, 1, 5),
        (1, 1, 5),
        (2, 2, 3),
        (4, 4, 2),
        (5, 5, 1),
        (9, 5, 1),
    ] {
        let strip = strip(&images, columns).unwrap();
        assert_eq!((strip.width, strip.height), (3 * effective, 2 * rows));
        for (at, pixel) in (0..).zip(&strip.pixels) {
            let (x, y) = (at % strip.width, at / strip.width);
            let image = y / 2 * effective + x / 3;
            let expected = match image < 5 {
                true => [image as u8, (x % 3) as u8, (y % 2) as u8, 255],
                false => [0, 0, 0, 255],
            };
            assert_eq!(*pixel, expected, "{columns} columns, {x} {y}");
        }
    }
}

#[test]
fn strips_that_cannot_be() {
    assert_eq!(strip(&[], 1), Err(Error::NoImage));
    assert_eq!(strip(&[numbered(0, 0, 0)], 1), Err(Error::NoImage));
    let mut short = numbered(1, 2, 2);
    short.pixels.pop();
    for other in [numbered(1, 2, 3), numbered(1, 4, 1), short] {
        let error = strip(&[numbered(0, 2, 2), other], 2).unwrap_err();
        assert!(
            matches!(error, Error::UnequalImages { image: 1, .. }),
            "{error}"
        );
    }
    let wide = Image {
        width: u32::MAX,
        height: 0,
        pixels: vec![],
    };
    assert_eq!(strip(&[wide.clone(), wide], 2), Err(Error::NoImage));
}
