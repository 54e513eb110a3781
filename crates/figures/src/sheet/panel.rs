//! A rectangle of the sheet to draw in.

use super::{Anchor, ColorScale, Scale, Style, Text, coordinate};
use crate::{Error, raster};
use pellicle::glam::DVec2;
use pellicle::render::Image;
use std::fmt::Write as _;

/// One axis of a panel's coordinates: the values in `range` go to the pixels in `pixels`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Map {
    pub scale: Scale,
    pub range: [f64; 2],
    pub pixels: [f64; 2],
}

impl Map {
    fn at(&self, value: f64) -> f64 {
        let share = self.scale.share(value, self.range);
        self.pixels[0] + share * (self.pixels[1] - self.pixels[0])
    }
}

/// A rectangle of the sheet. Points are in the panel's own coordinates; widths, radii and sizes are in pixels.
#[derive(Clone, Debug)]
pub struct Panel {
    size: [f64; 2],
    maps: [Map; 2],
    /// What lies inside the maps' pixels, and is cut off there.
    inside: String,
    /// What lies over it, anywhere in the panel.
    over: String,
    caption: String,
}

/// How the pixels of a picture become those of the sheet.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Sampling {
    /// Blended.
    #[default]
    Smooth,
    /// Each a square of its own.
    Squares,
}

impl Panel {
    /// A panel in pixels, y down, the origin in its upper left corner.
    pub fn pixels(width: f64, height: f64) -> Self {
        let map = |length: f64| Map {
            scale: Scale::Linear,
            range: [0.0, length],
            pixels: [0.0, length],
        };
        Self::mapped([width, height], [map(width), map(height)])
    }

    /// A panel that shows the box from `min` to `max`, y up, with one scale for both axes, in its middle.
    pub fn plane(width: f64, height: f64, min: DVec2, max: DVec2) -> Self {
        let size = DVec2::new(width, height);
        let span = (max - min).max(DVec2::splat(f64::MIN_POSITIVE));
        let scale = (size / span).min_element();
        let half = size / scale / 2.0;
        let middle = (min + max) / 2.0;
        let map = |i: usize, pixels: [f64; 2]| Map {
            scale: Scale::Linear,
            range: [middle[i] - half[i], middle[i] + half[i]],
            pixels,
        };
        Self::mapped(
            [width, height],
            [map(0, [0.0, width]), map(1, [height, 0.0])],
        )
    }

    pub(super) fn mapped(size: [f64; 2], maps: [Map; 2]) -> Self {
        Self {
            size,
            maps,
            inside: String::new(),
            over: String::new(),
            caption: String::new(),
        }
    }

    /// With words below it; they are broken into lines.
    #[must_use]
    pub fn caption(mut self, words: impl Into<String>) -> Self {
        self.caption = words.into();
        self
    }

    /// Its width in pixels.
    pub fn width(&self) -> f64 {
        self.size[0]
    }

    /// Its height in pixels, without the caption.
    pub fn height(&self) -> f64 {
        self.size[1]
    }

    pub(super) fn words(&self) -> &str {
        &self.caption
    }

    /// Where a point is, in pixels from the panel's upper left corner.
    pub fn place(&self, point: DVec2) -> DVec2 {
        DVec2::new(self.maps[0].at(point.x), self.maps[1].at(point.y))
    }

    /// A straight line.
    pub fn line(&mut self, from: DVec2, to: DVec2, style: Style) {
        self.polyline(&[from, to], style);
    }

    /// A line through the points; it breaks at points without a place (not finite, or not positive on a logarithmic
    /// axis).
    pub fn polyline(&mut self, points: &[DVec2], style: Style) {
        let places: Vec<DVec2> = points.iter().map(|&point| self.place(point)).collect();
        for part in places.split(|place| !place.is_finite()) {
            if part.len() > 1 {
                let points = joined(part);
                let style = style.attributes();
                let _ = writeln!(self.inside, "<polyline points=\"{points}\"{style}/>");
            }
        }
    }

    /// A closed area.
    pub fn polygon(&mut self, corners: &[DVec2], style: Style) {
        let places: Vec<DVec2> = corners.iter().map(|&corner| self.place(corner)).collect();
        if places.iter().all(|place| place.is_finite()) {
            let points = joined(&places);
            let style = style.attributes();
            let _ = writeln!(self.inside, "<polygon points=\"{points}\"{style}/>");
        }
    }

    /// A rectangle by two opposite corners.
    pub fn rectangle(&mut self, one: DVec2, other: DVec2, style: Style) {
        let corners = [
            one,
            DVec2::new(other.x, one.y),
            other,
            DVec2::new(one.x, other.y),
        ];
        self.polygon(&corners, style);
    }

    /// A mark: a circle whose radius is in pixels.
    pub fn dot(&mut self, center: DVec2, radius: f64, style: Style) {
        self.ellipse(self.place(center), [radius; 2], style);
    }

    /// A circle whose radius is in the panel's coordinates; an ellipse where the axes' scales differ.
    pub fn circle(&mut self, center: DVec2, radius: f64, style: Style) {
        let place = self.place(center);
        let radii = (self.place(center + DVec2::splat(radius)) - place).abs();
        self.ellipse(place, radii.to_array(), style);
    }

    fn ellipse(&mut self, place: DVec2, radii: [f64; 2], style: Style) {
        if place.is_finite() && radii.iter().all(|radius| radius.is_finite()) {
            let [x, y] = place.to_array().map(coordinate);
            let [rx, ry] = radii.map(coordinate);
            let style = style.attributes();
            let _ = writeln!(
                self.inside,
                "<ellipse cx=\"{x}\" cy=\"{y}\" rx=\"{rx}\" ry=\"{ry}\"{style}/>"
            );
        }
    }

    /// A line with a head at its end, in the line's colour; it stops `short` pixels before `to`.
    pub fn arrow(&mut self, from: DVec2, to: DVec2, short: f64, style: Style) {
        let [start, end] = [self.place(from), self.place(to)];
        let along = (end - start).normalize_or_zero();
        if !(along.is_finite() && along != DVec2::ZERO) {
            return;
        }
        let tip = end - along * short;
        let neck = tip - along * 8.0;
        let side = along.perp() * 3.5;
        let color = style.color();
        let line = joined(&[start, neck]);
        let head = joined(&[tip, neck + side, neck - side]);
        let style = style.attributes();
        let _ = writeln!(
            self.inside,
            "<polyline points=\"{line}\"{style}/>\n<polygon points=\"{head}\" fill=\"{color}\"/>"
        );
    }

    /// Words at a point.
    pub fn text(&mut self, at: DVec2, words: &str, text: Text) {
        let place = self.place(at);
        if place.is_finite() {
            text.write(&mut self.over, place.x, place.y, words);
        }
    }

    /// Words at a place in pixels from the panel's upper left corner.
    pub fn text_at_pixel(&mut self, place: DVec2, words: &str, text: Text) {
        text.write(&mut self.over, place.x, place.y, words);
    }

    /// A line in pixels, over everything: for axes and brackets.
    pub(super) fn over_line(&mut self, from: DVec2, to: DVec2, style: Style) {
        let points = joined(&[from, to]);
        let style = style.attributes();
        let _ = writeln!(self.over, "<polyline points=\"{points}\"{style}/>");
    }

    /// A mark in pixels, over everything.
    pub(super) fn over_dot(&mut self, place: DVec2, style: Style) {
        let [x, y] = place.to_array().map(coordinate);
        let style = style.attributes();
        let _ = writeln!(self.over, "<circle cx=\"{x}\" cy=\"{y}\" r=\"3\"{style}/>");
    }

    /// A picture between two opposite corners. Its first row is at the top of the sheet.
    pub fn picture(
        &mut self,
        one: DVec2,
        other: DVec2,
        image: &Image,
        sampling: Sampling,
    ) -> Result<(), Error> {
        let [a, b] = [self.place(one), self.place(other)];
        let [x, y] = a.min(b).to_array().map(coordinate);
        let [width, height] = (a - b).abs().to_array().map(coordinate);
        let rendering = match sampling {
            Sampling::Smooth => "",
            // The first for browsers, the second for the older readers of SVG.
            Sampling::Squares => {
                " style=\"image-rendering:pixelated\" image-rendering=\"optimizeSpeed\""
            }
        };
        let data = base64(&raster::png_of_image(image)?);
        let _ = writeln!(
            self.inside,
            "<image x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\" preserveAspectRatio=\"none\"{rendering} \
             href=\"data:image/png;base64,{data}\"/>"
        );
        Ok(())
    }

    /// A panel that is a picture, `width` pixels wide.
    pub fn of_image(image: &Image, width: f64) -> Result<Self, Error> {
        let height = width * f64::from(image.height) / f64::from(image.width.max(1));
        let mut panel = Self::pixels(width, height);
        panel.picture(
            DVec2::ZERO,
            DVec2::new(width, height),
            image,
            Sampling::Smooth,
        )?;
        Ok(panel)
    }

    /// What colours mean: a swatch and a word each, in rows from a place in pixels.
    pub fn legend(&mut self, place: DVec2, entries: &[(Style, &str)]) {
        for (row, (style, words)) in entries.iter().enumerate() {
            let y = place.y + 17.0 * row as f64;
            let style = style.attributes();
            let [left, top] = [place.x, y].map(coordinate);
            let _ = writeln!(
                self.over,
                "<rect x=\"{left}\" y=\"{top}\" width=\"14\" height=\"11\"{style}/>"
            );
            let text = Text::default().size(11.0).anchor(Anchor::Start).halo();
            text.write(&mut self.over, place.x + 20.0, y + 9.5, words);
        }
    }

    /// A bar of colours with its values, upright, its upper left corner at a place in pixels.
    pub fn color_bar(&mut self, place: DVec2, height: f64, scale: &ColorScale, unit: &str) {
        const STEPS: usize = 64;
        let step = height / STEPS as f64;
        for at in 0..STEPS {
            let share = 1.0 - (at as f64 + 0.5) / STEPS as f64;
            let color = scale.at(scale.least + share * (scale.greatest - scale.least));
            let [x, y] = [place.x, place.y + at as f64 * step].map(coordinate);
            // A little more than a step, so that no seam shows.
            let tall = coordinate(step + if at + 1 < STEPS { 0.5 } else { 0.0 });
            let _ = writeln!(
                self.over,
                "<rect x=\"{x}\" y=\"{y}\" width=\"14\" height=\"{tall}\" fill=\"{color}\"/>"
            );
        }
        let range = [scale.least, scale.greatest];
        let text = Text::default().size(10.5).anchor(Anchor::Start);
        for (value, words) in Scale::Linear.ticks(range) {
            let y = place.y + height * (1.0 - Scale::Linear.share(value, range));
            text.write(&mut self.over, place.x + 18.0, y + 3.5, &words);
        }
        text.write(&mut self.over, place.x, place.y - 6.0, unit);
    }

    /// Writes it as an element whose upper left corner is at (`left`, `top`).
    pub(super) fn write(&self, out: &mut String, left: f64, top: f64) {
        let [left, top] = [left, top].map(coordinate);
        let [width, height] = self.size.map(coordinate);
        let corner = DVec2::new(self.maps[0].pixels[0], self.maps[1].pixels[0]);
        let opposite = DVec2::new(self.maps[0].pixels[1], self.maps[1].pixels[1]);
        let [x, y] = corner.min(opposite).to_array().map(coordinate);
        let [inner_width, inner_height] = (corner - opposite).abs().to_array().map(coordinate);
        let _ = writeln!(
            out,
            "<svg x=\"{left}\" y=\"{top}\" width=\"{width}\" height=\"{height}\" overflow=\"visible\">\n<svg \
             x=\"{x}\" y=\"{y}\" width=\"{inner_width}\" height=\"{inner_height}\" viewBox=\"{x} {y} {inner_width} \
             {inner_height}\">\n{}</svg>\n{}</svg>",
            self.inside, self.over
        );
    }
}

fn joined(places: &[DVec2]) -> String {
    let points: Vec<String> = places
        .iter()
        .map(|place| format!("{},{}", coordinate(place.x), coordinate(place.y)))
        .collect();
    points.join(" ")
}

/// Bytes as text, as RFC 4648 says.
pub(super) fn base64(bytes: &[u8]) -> String {
    const LETTERS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for chunk in bytes.chunks(3) {
        let three = std::array::from_fn(|i| chunk.get(i).copied().unwrap_or(0));
        let [a, b, c] = three.map(u32::from);
        let bits = a << 16 | b << 8 | c;
        for place in 0..4 {
            text.push(match place <= chunk.len() {
                true => char::from(LETTERS[(bits >> (18 - 6 * place) & 63) as usize]),
                false => '=',
            });
        }
    }
    text
}
