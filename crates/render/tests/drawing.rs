//! What is shown on a mesh or on points: values, edges, marks, and nothing at all.

mod common;

use common::hash;
use pellicle_geometry::{Aabb, DVec3, VertexId};
use pellicle_mesh::{MeshView, TriangleId, TriangleSoup};
use pellicle_render::{
    Background, Bar, Borders, ColorMap, Coloring, Dot, Drawing, Error, Image, Options, Palette,
    Projection, Shading, Stroke, Style, Up, Values, View, Visibility, render,
};
use proptest::prelude::*;

/// From above, parallel, one sample a pixel, no light and no shadow: x to the right and y up, 88 of 100 pixels being the
/// side of the square from −1 to 1.
fn plain() -> Options {
    let corner = DVec3::new(1.0, 1.0, 1.0);
    Options {
        width: 100,
        height: 100,
        views: vec![View::Top],
        up: Up::Z,
        projection: Projection::Orthographic,
        shading: Shading::Unlit,
        occlusion: 0.0,
        samples: 1,
        borders: Borders::Plain,
        bounds: Some(Aabb {
            min: -corner,
            max: corner,
        }),
        ..Options::default()
    }
}

/// The x and y that the centre of a pixel shows with [`plain`].
fn place(column: usize, row: usize) -> (f64, f64) {
    let unit = |pixels: usize| (pixels as f64 + 0.5 - 50.0) / 44.0;
    (unit(column), -unit(row))
}

fn soup(corners: &[[f64; 3]]) -> TriangleSoup {
    TriangleSoup {
        positions: corners.iter().map(|&p| DVec3::from_array(p)).collect(),
        triangles: (0..corners.len() as u32 / 3)
            .map(|t| [3 * t, 3 * t + 1, 3 * t + 2].map(VertexId))
            .collect(),
    }
}

/// The square from −1 to 1 at a height, two triangles counter-clockwise from above.
fn square(z: f64) -> TriangleSoup {
    let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    TriangleSoup {
        positions: corners.iter().map(|&[x, y]| DVec3::new(x, y, z)).collect(),
        triangles: vec![[0, 1, 2].map(VertexId), [0, 2, 3].map(VertexId)],
    }
}

fn shows(image: &Image, color: [u8; 3]) -> usize {
    let pixels = image.pixels.iter();
    pixels.filter(|pixel| pixel[..3] == color).count()
}

/// A colour for each triangle, none of them the background's.
fn paint(triangle: usize) -> [u8; 3] {
    [10 + triangle as u8 * 7, 200 - triangle as u8 * 5, 30]
}

/// The triangle that a pixel's centre shows, by brute force over all triangles; none if the centre lies so near to an
/// edge, or two triangles are so near to each other, that rounding may decide.
fn oracle(soup: &TriangleSoup, (x, y): (f64, f64)) -> Option<Option<usize>> {
    let mut found: Option<(f64, f64, usize)> = None;
    let mut heights = Vec::new();
    for (t, corners) in soup.triangles.iter().enumerate() {
        let [a, b, c] = corners.map(|v| soup.positions[v.index()]);
        let turn = |p: DVec3, q: DVec3| (q.x - p.x) * (y - p.y) - (q.y - p.y) * (x - p.x);
        let away = |p: DVec3, q: DVec3| turn(p, q) / (q - p).truncate().length();
        let sides = [away(a, b), away(b, c), away(c, a)];
        // Corners are rounded to 1/256 of a pixel, 1/11264 of a unit: edges move by no more than its diagonal.
        let near = |side: f64| side.abs() < 2e-4;
        let within = sides.iter().all(|s| *s >= -2e-4) || sides.iter().all(|s| *s <= 2e-4);
        if within && sides.into_iter().any(near) {
            return None;
        }
        if !within {
            continue;
        }
        let normal = (b - a).cross(c - a);
        let z = a.z - (normal.x * (x - a.x) + normal.y * (y - a.y)) / normal.z;
        let slack = 2e-4 * normal.truncate().length() / normal.z.abs() + 1e-5;
        heights.push((z, slack));
        if found.is_none_or(|(highest, ..)| z > highest) {
            found = Some((z, slack, t));
        }
    }
    let (highest, own) = found.map_or((0.0, 0.0), |(z, slack, _)| (z, slack));
    let rivals = heights
        .iter()
        .filter(|(z, slack)| highest - z < slack + own);
    (rivals.count() < 2).then_some(found.map(|(.., t)| t))
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 120,
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    #[test]
    fn the_nearest_triangle_shows(
        corners in prop::collection::vec(prop::array::uniform3(-1.0..1.0_f64), 3..60),
    ) {
        let soup = soup(&corners[..corners.len() / 3 * 3]);
        let colors: Vec<[u8; 3]> = (0..soup.triangles.len()).map(paint).collect();
        let drawing = Drawing { coloring: Coloring::Each(&colors), ..Drawing::mesh(&soup) };
        let image = render(&drawing, &plain()).unwrap();
        let mut decided = 0;
        for row in 0..100 {
            for column in 0..100 {
                let pixel = &image.pixels[row * 100 + column][..3];
                let shown = colors.iter().position(|color| pixel == color);
                prop_assert!(shown.is_some() || pixel == Palette::default().background);
                if let Some(expected) = oracle(&soup, place(column, row)) {
                    prop_assert_eq!(shown, expected, "{} {}", column, row);
                    decided += 1;
                }
            }
        }
        prop_assert!(decided > 5000);
    }

    #[test]
    fn values_are_blended_over_triangles(
        gradient in prop::array::uniform2(-5.0..5.0_f64),
        perspective in any::<bool>(),
        map in prop::sample::select(vec![ColorMap::Viridis, ColorMap::Diverging]),
    ) {
        let soup = square(0.0);
        let at = |x: f64, y: f64| gradient[0] * x + gradient[1] * y;
        let values: Vec<f64> = soup.positions.iter().map(|p| at(p.x, p.y)).collect();
        let shown = Values { range: Some([-4.0, 6.0]), map, bar: Bar::Absent, ..Values::new(&values) };
        let drawing = Drawing { coloring: Coloring::Values(shown), ..Drawing::mesh(&soup) };
        // Without depth both projections are a scale.
        let options = Options {
            projection: if perspective { Projection::Perspective } else { Projection::Orthographic },
            bounds: None,
            ..plain()
        };
        let image = render(&drawing, &options).unwrap();
        for row in 8..92 {
            for column in 8..92 {
                let (x, y) = place(column, row);
                let found = image.pixels[row * 100 + column];
                let near = |step: f64| {
                    let expected = map.color((at(x, y) + step + 4.0) / 10.0);
                    (0..3).all(|i| found[i].abs_diff(expected[i]) <= 1)
                };
                // Rounding of corners is 1/256 of a pixel; a step of the table is 10/255 of a value.
                prop_assert!(near(0.0) || near(-2e-3) || near(2e-3), "{} {} {:?}", column, row, found);
            }
        }
    }
}

#[test]
fn perspective_blends_values_as_seen() {
    // A plane that runs away from the viewer: the value is the place along it.
    let tilted = TriangleSoup {
        positions: [
            [-1.0, -1.0, 1.0],
            [1.0, -1.0, 1.0],
            [1.0, 1.0, -1.0],
            [-1.0, 1.0, -1.0],
        ]
        .map(DVec3::from_array)
        .to_vec(),
        ..square(0.0)
    };
    let values: Vec<f64> = tilted.positions.iter().map(|p| p.y).collect();
    let shown = Values {
        bar: Bar::Absent,
        ..Values::new(&values)
    };
    let drawing = Drawing {
        coloring: Coloring::Values(shown),
        ..Drawing::mesh(&tilted)
    };
    let options = Options {
        projection: Projection::Perspective,
        bounds: None,
        ..plain()
    };
    let image = render(&drawing, &options).unwrap();
    let column = |row: usize| image.pixels[row * 100 + 50];
    let is_background = |row: &usize| column(*row)[..3] == options.palette.background;
    let rows: Vec<usize> = (0..100).filter(|row| !is_background(row)).collect();
    let (top, bottom) = (rows[0] as f64, rows[rows.len() - 1] as f64 + 1.0);
    // The unit ball's radius is √3; the viewer is six of those away. A point at (y, z = −y) is seen at y / (6√3 − z).
    let away = 6.0 * 3.0_f64.sqrt();
    let seen = |y: f64| y / (away + y);
    let mut compared = 0;
    for &row in &rows[1..rows.len() - 1] {
        let share = (bottom - row as f64 - 0.5) / (bottom - top);
        let s = seen(-1.0) + share * (seen(1.0) - seen(-1.0));
        let y = s * away / (1.0 - s);
        let color = column(row);
        let near = |step: f64| ColorMap::Viridis.color((y + step + 1.0) / 2.0) == color[..3];
        // Half a pixel is about 0.012 of y; without the correction the middle would be off by 0.1.
        assert!((-8..=8).any(|step| near(f64::from(step) * 0.002)), "{row}");
        compared += 1;
    }
    assert!(compared > 60);
}

#[test]
fn what_is_no_number_is_grey() {
    let soup = square(0.0);
    for odd in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let values = [odd, 0.0, 1.0, 2.0];
        let shown = Values {
            bar: Bar::Absent,
            ..Values::new(&values)
        };
        let drawing = Drawing {
            coloring: Coloring::Values(shown),
            ..Drawing::mesh(&soup)
        };
        let image = render(&drawing, &plain()).unwrap();
        // Both triangles have that corner.
        assert_eq!(shows(&image, Palette::default().no_value), 88 * 88);
        let points = Drawing {
            coloring: Coloring::Values(shown),
            ..Drawing::points(&soup.positions, None)
        };
        let image = render(&points, &plain()).unwrap();
        let grey = shows(&image, Palette::default().no_value);
        assert!(grey > 0 && shows(&image, ColorMap::Viridis.color(1.0)) == grey);
        assert_eq!(shows(&image, ColorMap::Viridis.color(0.0)), grey);
    }
    // No bar either where there is no value at all.
    let values = [f64::NAN; 4];
    let drawing = Drawing {
        coloring: Coloring::Values(Values::new(&values)),
        ..Drawing::mesh(&soup)
    };
    let image = render(&drawing, &plain()).unwrap();
    assert_eq!(shows(&image, Palette::default().no_value), 88 * 88);
}

/// A sheet with a bar from ½ to 10, over nothing that matters.
fn barred(background: Background, map: ColorMap) -> Image {
    let soup = square(0.0);
    let values = [0.5, 1.0, 2.0, 10.0];
    let shown = Values {
        map,
        title: "height",
        ..Values::new(&values)
    };
    let drawing = Drawing {
        coloring: Coloring::Values(shown),
        ..Drawing::mesh(&soup)
    };
    let options = Options {
        width: 640,
        height: 480,
        background,
        ..plain()
    };
    render(&drawing, &options).unwrap()
}

#[test]
fn the_bar_reads_back_its_values() {
    let text = Palette::default().text;
    for background in [Background::Opaque, Background::Transparent] {
        for map in [ColorMap::Viridis, ColorMap::Diverging] {
            let image = barred(background, map);
            let at = |x: usize, y: usize| image.pixels[y * 640 + x];
            // The bar is the column with the most colours right of the view.
            let has_colors = |x: &usize| {
                let column: Vec<[u8; 4]> = (0..480).map(|y| at(*x, y)).collect();
                let pairs = column.windows(2);
                pairs.filter(|pair| pair[0] != pair[1]).count() > 100
            };
            let left = (500..640).find(has_colors).unwrap();
            let bar: Vec<usize> = (left..640).take_while(has_colors).collect();
            assert!(bar.len() >= 10, "{bar:?}");
            let middle = bar[bar.len() / 2];
            let right = bar[bar.len() - 1] + 1;
            let blank = at(639, 479);
            let rows: Vec<usize> = (0..480).filter(|&y| at(middle, y) != blank).collect();
            let (top, bottom) = (rows[0] as f64, rows[rows.len() - 1] as f64 + 1.0);
            // Rows where a tick starts, joined where they touch.
            let inked: Vec<usize> = (0..480)
                .filter(|&y| at(right + 1, y) != blank && y as f64 >= top - 2.0)
                .collect();
            let ticks: Vec<f64> = inked
                .chunk_by(|a, b| a + 1 == *b)
                .map(|rows| (rows[0] + rows[rows.len() - 1] + 1) as f64 / 2.0)
                .collect();
            // From above: 10, 9, … 1, or 10, 8, … 2.
            let step = match ticks.len() {
                10 => 1.0,
                5 => 2.0,
                _ => panic!("{ticks:?}"),
            };
            for (i, tick) in ticks.iter().enumerate() {
                let share = (10.0 - i as f64 * step - 0.5) / 9.5;
                let expected = bottom - share * (bottom - top);
                assert!((tick - expected).abs() <= 1.0, "{tick} {expected}");
            }
            // Any row: the colour is that of the value which the ticks give it.
            for &y in &rows {
                let share = (bottom - y as f64 - 0.5) / (bottom - top);
                assert_eq!(at(middle, y)[..3], map.color(share), "{y}");
                assert_eq!(at(middle, y)[3], 255);
            }
            assert!(shows(&image, text) > 60);
        }
    }
}

#[test]
fn a_sheet_without_room_for_a_bar_is_refused() {
    let soup = square(0.0);
    let values = [0.0, 1.0, 2.0, 3.0];
    let drawing = Drawing {
        coloring: Coloring::Values(Values::new(&values)),
        ..Drawing::mesh(&soup)
    };
    for (width, height) in [(60, 400), (400, 50)] {
        let options = Options {
            width,
            height,
            ..plain()
        };
        let refused = Err(Error::NoRoomForBar { width, height });
        assert_eq!(render(&drawing, &options), refused);
    }
}

#[test]
fn opacity_is_the_share_that_is_covered() {
    // A square of 45.1 × 45.1 pixels that cuts pixels on two sides.
    let soup = soup(&[
        [0.0, 0.0, 0.0],
        [1.025, 0.0, 0.0],
        [1.025, 1.025, 0.0],
        [0.0, 0.0, 0.0],
        [1.025, 1.025, 0.0],
        [0.0, 1.025, 0.0],
    ]);
    let corner = DVec3::splat(2.0);
    let through = Options {
        background: Background::Transparent,
        samples: 10,
        bounds: Some(Aabb {
            min: -corner,
            max: corner,
        }),
        ..plain()
    };
    let clear = render(&Drawing::mesh(&soup), &through).unwrap();
    let side = 1.025 * 22.0;
    let opacity: f64 = clear.pixels.iter().map(|p| f64::from(p[3]) / 255.0).sum();
    // Corners of samples err by a tenth of a pixel along each side at most.
    assert!(
        (opacity - side * side).abs() < 0.1 * 2.0 * side,
        "{opacity}"
    );
    let front = Palette::default().front;
    for pixel in &clear.pixels {
        let expected = if pixel[3] == 0 { [0; 3] } else { front };
        assert_eq!(pixel[..3], expected);
    }
    assert!(clear.pixels.iter().any(|p| (1..255).contains(&p[3])));
    assert_eq!(clear.pixels[0], [0; 4]);

    // Laid over the background it is the opaque picture.
    let opaque = Options {
        background: Background::Opaque,
        ..through
    };
    let whole = render(&Drawing::mesh(&soup), &opaque).unwrap();
    let below = Palette::default().background;
    for (clear, whole) in clear.pixels.iter().zip(&whole.pixels) {
        let share = f64::from(clear[3]) / 255.0;
        for i in 0..3 {
            let linear = |byte: u8| (f64::from(byte) / 255.0).powi(2);
            let mixed = linear(clear[i]) * share + linear(below[i]) * (1.0 - share);
            let expected = (mixed.sqrt() * 255.0).round();
            assert!((expected - f64::from(whole[i])).abs() <= 1.0);
        }
    }
}

#[test]
fn edges_alone_show_what_is_behind_or_not() {
    let edge = Palette::default().edge;
    let back = Palette::default().background;
    // A square, and below it a smaller one.
    let mut both = square(0.5);
    let below = square(-0.5);
    let shift = both.positions.len() as u32;
    both.positions.extend(
        below
            .positions
            .iter()
            .map(|&p| p * DVec3::new(0.5, 0.5, 1.0)),
    );
    let moved = below
        .triangles
        .iter()
        .map(|t| t.map(|v| VertexId(v.0 + shift)));
    both.triangles.extend(moved);
    let alone = square(0.5);
    let draw = |soup: &TriangleSoup, style| {
        let options = Options { style, ..plain() };
        render(&Drawing::mesh(soup), &options).unwrap()
    };
    let visible = draw(&both, Style::VisibleEdges);
    assert_eq!(visible, draw(&alone, Style::VisibleEdges));
    let all = draw(&both, Style::AllEdges);
    assert!(shows(&all, edge) > shows(&visible, edge) + 150);
    for image in [&visible, &all] {
        assert_eq!(shows(image, edge) + shows(image, back), 100 * 100);
    }
    // The diagonal and the four sides, a pixel wide.
    let surface = draw(&alone, Style::SurfaceAndEdges);
    let front = Palette::default().front;
    assert_eq!(shows(&surface, edge), shows(&visible, edge));
    assert_eq!(
        shows(&surface, edge) + shows(&surface, front) + shows(&surface, back),
        10_000
    );
    assert!(
        (4 * 88 - 8..=6 * 88 + 100).contains(&shows(&visible, edge)),
        "{}",
        shows(&visible, edge)
    );
    assert_eq!(shows(&draw(&alone, Style::Surface), edge), 0);
    // As wide as asked for.
    let wide = Options {
        style: Style::VisibleEdges,
        edge_width: 5.0,
        ..plain()
    };
    let image = render(&Drawing::mesh(&alone), &wide).unwrap();
    let column: Vec<usize> = (0..100)
        .filter(|row| image.pixels[row * 100 + 30][..3] == edge)
        .collect();
    // Two sides of five, and the diagonal, longer along the column by √2.
    assert!((16..=18).contains(&column.len()), "{column:?}");
}

#[test]
fn strokes_and_dots_are_hidden_or_not() {
    let soup = square(0.0);
    let color = [1, 2, 3];
    let draw = |z: f64, visibility| {
        let stroke = Stroke {
            // Along the centres of a row of pixels.
            ends: [-0.5, 0.5].map(|x| DVec3::new(x, 0.5 / 44.0, z)),
            color,
            width: 3.0,
            visibility,
        };
        let dot = Dot {
            position: DVec3::new(0.0, 0.5, z),
            color: [4, 5, 6],
            radius: 4.0,
            visibility,
        };
        let drawing = Drawing {
            strokes: &[stroke],
            dots: &[dot],
            ..Drawing::mesh(&soup)
        };
        let image = render(&drawing, &plain()).unwrap();
        (shows(&image, color), shows(&image, [4, 5, 6]))
    };
    let free = draw(0.9, Visibility::Hidden);
    // 44 pixels long, round ends; and a disc.
    assert!((44 * 3..=47 * 3 + 6).contains(&free.0), "{free:?}");
    assert!(
        (f64::from(free.1 as u32) - std::f64::consts::PI * 16.0).abs() < 8.0,
        "{free:?}"
    );
    assert_eq!(draw(-0.9, Visibility::Hidden), (0, 0));
    assert_eq!(draw(-0.9, Visibility::Through), free);
    assert_eq!(draw(0.0, Visibility::Hidden), free);
}

#[test]
fn marks_are_fitted_and_marked_triangles_show() {
    let soup = square(0.0);
    let options = Options {
        bounds: None,
        ..plain()
    };
    let far = Stroke {
        ends: [DVec3::ZERO, DVec3::new(4.0, 0.0, 0.0)],
        color: [9, 9, 9],
        width: 2.0,
        visibility: Visibility::Hidden,
    };
    let drawing = Drawing {
        strokes: &[far],
        marked: &[TriangleId(1)],
        ..Drawing::mesh(&soup)
    };
    let image = render(&drawing, &options).unwrap();
    // The square is two of the five units that now are 88 pixels wide; half of it is marked.
    let marked = shows(&image, Palette::default().marked);
    let half = (88.0_f64 * 0.4).powi(2) / 2.0;
    assert!((marked as f64 - half).abs() < 45.0, "{marked} {half}");
    assert!(image.pixels[50 * 100 + 92][..3] == [9, 9, 9]);
}

#[test]
fn points_take_colours_and_values() {
    let points = [DVec3::new(-0.5, 0.0, 0.0), DVec3::new(0.5, 0.0, 0.0)];
    let options = Options {
        point_radius: Some(0.2),
        ..plain()
    };
    let colors = [[200, 10, 10], [10, 10, 200]];
    let drawing = Drawing {
        coloring: Coloring::Each(&colors),
        ..Drawing::points(&points, None)
    };
    let image = render(&drawing, &options).unwrap();
    assert_eq!(image.pixels[50 * 100 + 28][..3], colors[0]);
    assert_eq!(image.pixels[50 * 100 + 72][..3], colors[1]);
    let values = Values {
        bar: Bar::Absent,
        ..Values::new(&[3.0, 7.0])
    };
    let drawing = Drawing {
        coloring: Coloring::Values(values),
        ..Drawing::points(&points, Some(&[DVec3::Z, DVec3::NEG_Z]))
    };
    let image = render(&drawing, &options).unwrap();
    assert_eq!(
        image.pixels[50 * 100 + 28][..3],
        ColorMap::Viridis.color(0.0)
    );
    assert_eq!(
        image.pixels[50 * 100 + 72][..3],
        ColorMap::Viridis.color(1.0)
    );
}

/// A wavy sheet with everything on it, in four views.
fn everything(style: Style, background: Background) -> Image {
    const SIDE: usize = 20;
    let height = |i: usize, j: usize| ((i * i + 3 * j) % 11) as f64 / 40.0;
    let vertices = (0..SIDE * SIDE).map(|v| (v / SIDE, v % SIDE));
    let positions: Vec<DVec3> = vertices
        .map(|(i, j)| DVec3::new(i as f64 / 10.0 - 1.0, j as f64 / 10.0 - 1.0, height(i, j)))
        .collect();
    let id = |i: usize, j: usize| VertexId::new(i * SIDE + j);
    let cells = (0..(SIDE - 1) * (SIDE - 1)).map(|c| (c / (SIDE - 1), c % (SIDE - 1)));
    let triangles: Vec<[VertexId; 3]> = cells
        .flat_map(|(i, j)| {
            let [a, b, c, d] = [id(i, j), id(i + 1, j), id(i + 1, j + 1), id(i, j + 1)];
            [[a, b, c], [a, c, d]]
        })
        .collect();
    let values: Vec<f64> = positions.iter().map(|p| p.z).collect();
    let strokes: Vec<Stroke> = (0..9)
        .map(|k| Stroke {
            ends: [positions[k], positions[399 - 17 * k]],
            color: [200, 20 * k as u8, 0],
            width: 0.5 + k as f64 * 0.3,
            visibility: if k % 2 == 0 {
                Visibility::Hidden
            } else {
                Visibility::Through
            },
        })
        .collect();
    let dots = [Dot {
        position: positions[210],
        color: [0, 0, 255],
        radius: 5.0,
        visibility: Visibility::Hidden,
    }];
    let drawing = Drawing {
        coloring: Coloring::Values(Values {
            title: "height",
            ..Values::new(&values)
        }),
        marked: &[TriangleId(7), TriangleId(300)],
        strokes: &strokes,
        dots: &dots,
        ..Drawing::mesh(MeshView {
            positions: &positions,
            triangles: &triangles,
        })
    };
    let options = Options {
        width: 400,
        height: 300,
        up: Up::Z,
        shading: Shading::Smooth,
        style,
        background,
        ..Options::default()
    };
    render(&drawing, &options).unwrap()
}

#[test]
fn threads_do_not_matter_and_the_bytes_are_known() {
    let all = || {
        [
            everything(Style::Surface, Background::Opaque),
            everything(Style::SurfaceAndEdges, Background::Transparent),
            everything(Style::VisibleEdges, Background::Opaque),
            everything(Style::AllEdges, Background::Transparent),
        ]
    };
    let with = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
        pool.build().unwrap().install(all)
    };
    let one = with(1);
    for threads in [2, 3, 8] {
        assert!(one == with(threads), "{threads}");
    }
    assert_eq!(
        one.each_ref().map(hash),
        [
            4_241_557_468_155_104_962,
            2_984_974_221_474_680_305,
            11_815_719_057_115_372_301,
            1_067_270_226_371_576_344
        ]
    );
}

#[test]
fn wrong_drawings_are_refused() {
    let soup = square(0.0);
    let mesh = Drawing::mesh(&soup);
    let refused = |drawing: Drawing<'_>| render(&drawing, &plain()).unwrap_err();
    let colors = |coloring| Drawing { coloring, ..mesh };
    assert_eq!(
        refused(colors(Coloring::Each(&[[0; 3]; 4]))),
        Error::ColorCount {
            colors: 4,
            expected: 2
        }
    );
    let values = Values::new(&[1.0, 2.0]);
    assert_eq!(
        refused(colors(Coloring::Values(values))),
        Error::ValueCount {
            values: 2,
            expected: 4
        }
    );
    for range in [[1.0, 0.0], [f64::NAN, 1.0], [0.0, f64::INFINITY]] {
        let values = Values {
            range: Some(range),
            ..Values::new(&[0.0; 4])
        };
        let error = refused(colors(Coloring::Values(values)));
        assert!(matches!(error, Error::NoRange { .. }), "{error}");
    }
    assert_eq!(
        refused(Drawing {
            marked: &[TriangleId(2)],
            ..mesh
        }),
        Error::NoSuchTriangle {
            triangle: TriangleId(2),
            triangles: 2
        }
    );
    let stroke = Stroke {
        ends: [DVec3::ZERO, DVec3::NAN],
        color: [0; 3],
        width: 1.0,
        visibility: Visibility::Hidden,
    };
    assert_eq!(
        refused(Drawing {
            strokes: &[stroke],
            ..mesh
        }),
        Error::StrokeNotFinite { stroke: 0 }
    );
    let dot = Dot {
        position: DVec3::INFINITY,
        color: [0; 3],
        radius: 1.0,
        visibility: Visibility::Hidden,
    };
    assert_eq!(
        refused(Drawing {
            dots: &[dot],
            ..mesh
        }),
        Error::DotNotFinite { dot: 0 }
    );
}

#[test]
fn odd_widths_are_drawn_somehow() {
    let soup = square(0.0);
    for width in [f64::NAN, -1.0, 0.0, f64::INFINITY, 1e300] {
        let options = Options {
            edge_width: width,
            style: Style::AllEdges,
            ..plain()
        };
        let stroke = Stroke {
            ends: [DVec3::ZERO, DVec3::X],
            color: [0; 3],
            width,
            visibility: Visibility::Hidden,
        };
        let drawing = Drawing {
            strokes: &[stroke],
            ..Drawing::mesh(&soup)
        };
        for projection in [Projection::Orthographic, Projection::Perspective] {
            let options = Options {
                projection,
                ..options.clone()
            };
            assert!(render(&drawing, &options).is_ok(), "{width}");
        }
    }
}
