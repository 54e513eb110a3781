//! The document: what is drawn is where it should be, and the drawer takes it.

use super::*;
use crate::raster;
use pellicle::glam::DVec2;
use pellicle::render::Image;

/// The colour of a pixel of the drawn sheet, `share` of its width and height from the upper left corner.
fn pixel(sheet: &Sheet, across: f64, down: f64) -> [u8; 3] {
    let png = raster::png(&sheet.svg()).expect("the sheet is an SVG");
    let picture = image::load_from_memory(&png).expect("a PNG").to_rgb8();
    let at = |share: f64, length: u32| ((share * f64::from(length)) as u32).min(length - 1);
    picture
        .get_pixel(at(across, picture.width()), at(down, picture.height()))
        .0
}

fn one(panel: Panel) -> Sheet {
    Sheet::new(1).with(panel)
}

#[test]
fn y_is_up_in_a_plane_and_down_in_pixels() {
    let lower = [DVec2::ZERO, DVec2::new(2.0, 1.0)];
    let mut plane = Panel::plane(200.0, 200.0, DVec2::ZERO, DVec2::splat(2.0));
    plane.rectangle(lower[0], lower[1], Style::fill(Color::BLUE));
    let sheet = one(plane);
    assert_eq!(pixel(&sheet, 0.5, 0.6), Color::BLUE.0);
    assert_eq!(pixel(&sheet, 0.5, 0.3), Color::WHITE.0);
    let mut pixels = Panel::pixels(200.0, 200.0);
    pixels.rectangle(
        DVec2::ZERO,
        DVec2::new(200.0, 100.0),
        Style::fill(Color::BLUE),
    );
    let sheet = one(pixels);
    assert_eq!(pixel(&sheet, 0.5, 0.3), Color::BLUE.0);
    assert_eq!(pixel(&sheet, 0.5, 0.6), Color::WHITE.0);
}

#[test]
fn both_axes_of_a_plane_have_one_scale() {
    let panel = Panel::plane(400.0, 100.0, DVec2::ZERO, DVec2::ONE);
    let [a, b, c] = [DVec2::ZERO, DVec2::X, DVec2::Y].map(|point| panel.place(point));
    assert_eq!((b - a).length(), (c - a).length());
    assert_eq!(panel.place(DVec2::splat(0.5)), DVec2::new(200.0, 50.0));
}

#[test]
fn what_leaves_a_panel_is_cut_off() {
    let mut panel = Panel::plane(100.0, 100.0, DVec2::ZERO, DVec2::ONE);
    panel.rectangle(
        DVec2::splat(-9.0),
        DVec2::splat(9.0),
        Style::fill(Color::BLUE),
    );
    let sheet = one(panel);
    assert_eq!(pixel(&sheet, 0.5, 0.5), Color::BLUE.0);
    assert_eq!(pixel(&sheet, 0.03, 0.03), Color::WHITE.0);
}

#[test]
fn a_picture_keeps_its_squares() {
    let [red, green] = [[255, 0, 0, 255], [0, 255, 0, 255]];
    let image = Image {
        width: 2,
        height: 1,
        pixels: vec![red, green],
    };
    let mut panel = Panel::pixels(100.0, 100.0);
    panel
        .picture(DVec2::ZERO, DVec2::splat(100.0), &image, Sampling::Squares)
        .expect("a picture");
    let sheet = one(panel);
    assert_eq!(pixel(&sheet, 0.45, 0.4), [255, 0, 0]);
    assert_eq!(pixel(&sheet, 0.55, 0.4), [0, 255, 0]);
}

#[test]
fn words_are_drawn_and_escaped() {
    let mut panel = Panel::pixels(100.0, 60.0);
    panel.text(
        DVec2::new(50.0, 40.0),
        "█ < & >",
        Text::default().size(30.0),
    );
    let svg = one(panel).svg();
    assert!(svg.contains("█ &lt; &amp; &gt;"));
    let png = raster::png(&svg).expect("an SVG");
    let picture = image::load_from_memory(&png).expect("a PNG").to_rgb8();
    assert!(picture.pixels().any(|pixel| pixel.0 == Color::BLACK.0));
}

#[test]
fn captions_are_broken_into_lines() {
    let words = "as many words as do not fit into one line of a narrow panel";
    let lines = style::wrapped(words, 150.0, 13.0);
    assert!(lines.len() > 1);
    assert_eq!(lines.join(" "), words);
    assert!(lines.iter().all(|line| line.chars().count() <= 20));
}

#[test]
fn ticks_are_round_and_inside() {
    let texts = |scale: Scale, range| -> Vec<String> {
        scale
            .ticks(range)
            .into_iter()
            .map(|(_, text)| text)
            .collect()
    };
    assert_eq!(
        texts(Scale::Linear, [0.0, 1.0]),
        ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]
    );
    assert_eq!(
        texts(Scale::Linear, [-30.0, 30.0]),
        ["−30", "−20", "−10", "0", "10", "20", "30"]
    );
    assert_eq!(
        texts(Scale::Logarithmic, [1e-5, 1e-2]),
        ["10⁻⁵", "10⁻⁴", "10⁻³", "0.01"]
    );
    assert_eq!(
        texts(Scale::Logarithmic, [1.0, 30.0]),
        ["1", "2", "5", "10", "20"]
    );
    assert_eq!(
        texts(Scale::Logarithmic, [1e16, 1e18]),
        ["10¹⁶", "10¹⁷", "10¹⁸"]
    );
    for scale in [Scale::Linear, Scale::Logarithmic] {
        for range in [
            [0.3, 0.9],
            [1.0, 7e5],
            [2e-9, 5e11],
            [1.0, 1.0],
            [f64::NAN, 1.0],
        ] {
            let ticks = scale.ticks(range);
            assert!(ticks.len() <= 9, "{scale:?} {range:?} {ticks:?}");
            for (value, _) in ticks {
                let share = scale.share(value, range);
                assert!(
                    (-1e-6..=1.0 + 1e-6).contains(&share),
                    "{scale:?} {range:?} {value}"
                );
            }
        }
    }
}

#[test]
fn points_without_a_place_break_a_line() {
    let points = [1.0, 10.0, 0.0, 100.0, 1000.0].map(DVec2::splat);
    let axes = ["x", "y"].map(|label| Axis::new(label).logarithmic());
    let [across, up] = axes;
    let panel = Plot::new(across, up)
        .with(Series::line("", points))
        .panel(300.0, 300.0);
    let svg = one(panel).svg();
    assert!(!svg.contains("NaN") && !svg.contains("inf"));
    assert_eq!(svg.matches("stroke-width=\"1.8\"").count(), 2);
    raster::png(&svg).expect("an SVG");
}

#[test]
fn base64_is_that_of_the_rfc() {
    for (bytes, text) in [
        ("", ""),
        ("f", "Zg=="),
        ("fo", "Zm8="),
        ("foo", "Zm9v"),
        ("foobar", "Zm9vYmFy"),
    ] {
        assert_eq!(panel::base64(bytes.as_bytes()), text);
    }
}

#[test]
fn colours_of_a_scale() {
    let scale = ColorScale::diverging(-2.0, 2.0);
    assert_eq!(scale.at(-9.0), scale.stops[0]);
    assert_eq!(scale.at(0.0), scale.stops[2]);
    assert_eq!(scale.at(2.0), scale.stops[4]);
    assert_eq!(scale.at(f64::NAN), scale.stops[2]);
    assert_eq!(
        ColorScale::sequential(1.0, 1.0).at(1.0),
        ColorScale::sequential(0.0, 1.0).stops[2]
    );
}
