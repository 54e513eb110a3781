//! How lines, areas and words look.

use super::{Color, coordinate};
use std::fmt::Write as _;

/// How a line or an area is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Style {
    stroke: Option<(Color, f64)>,
    fill: Option<Color>,
    opacity: f64,
    dashes: Option<f64>,
}

impl Style {
    /// A line of this width in pixels.
    pub fn stroke(color: Color, width: f64) -> Self {
        Self {
            stroke: Some((color, width)),
            fill: None,
            opacity: 1.0,
            dashes: None,
        }
    }

    /// An area without outline.
    pub fn fill(color: Color) -> Self {
        Self {
            stroke: None,
            fill: Some(color),
            opacity: 1.0,
            dashes: None,
        }
    }

    /// With an outline.
    #[must_use]
    pub fn outlined(mut self, color: Color, width: f64) -> Self {
        self.stroke = Some((color, width));
        self
    }

    /// With dashes of this length in pixels.
    #[must_use]
    pub fn dashed(mut self, length: f64) -> Self {
        self.dashes = Some(length);
        self
    }

    /// From 0, invisible, to 1.
    #[must_use]
    pub fn opacity(mut self, opacity: f64) -> Self {
        self.opacity = opacity;
        self
    }

    /// The colour that a legend shows.
    pub(super) fn color(&self) -> Color {
        let stroke = self.stroke.map(|(color, _)| color);
        self.fill.or(stroke).unwrap_or(Color::BLACK)
    }

    /// As attributes of an element, each with a space in front.
    pub(super) fn attributes(&self) -> String {
        let mut text = match self.fill {
            Some(color) => format!(" fill=\"{color}\""),
            None => " fill=\"none\"".to_owned(),
        };
        if let Some((color, width)) = self.stroke {
            let width = coordinate(width);
            let _ = write!(
                text,
                " stroke=\"{color}\" stroke-width=\"{width}\" stroke-linejoin=\"round\""
            );
        }
        if let Some(length) = self.dashes {
            let length = coordinate(length);
            let _ = write!(text, " stroke-dasharray=\"{length} {length}\"");
        }
        if self.opacity < 1.0 {
            let _ = write!(text, " opacity=\"{}\"", coordinate(self.opacity));
        }
        text
    }
}

/// Which part of a text stands at its point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Anchor {
    /// Its beginning: the text is to the right.
    Start,
    /// Its middle.
    Middle,
    /// Its end: the text is to the left.
    End,
}

/// How words are set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Text {
    size: f64,
    color: Color,
    anchor: Anchor,
    bold: bool,
    halo: bool,
    shift: [f64; 2],
    turn: f64,
}

impl Default for Text {
    /// 12 pixels, black, the middle of the baseline at the point.
    fn default() -> Self {
        Self {
            size: 12.0,
            color: Color::BLACK,
            anchor: Anchor::Middle,
            bold: false,
            halo: false,
            shift: [0.0; 2],
            turn: 0.0,
        }
    }
}

impl Text {
    /// Of this size in pixels.
    #[must_use]
    pub fn size(mut self, size: f64) -> Self {
        self.size = size;
        self
    }

    /// In this colour.
    #[must_use]
    pub fn color(mut self, color: Color) -> Self {
        self.color = color;
        self
    }

    /// With this part at the point.
    #[must_use]
    pub fn anchor(mut self, anchor: Anchor) -> Self {
        self.anchor = anchor;
        self
    }

    /// In bold.
    #[must_use]
    pub fn bold(mut self) -> Self {
        self.bold = true;
        self
    }

    /// With a white rim, to be read on top of lines.
    #[must_use]
    pub fn halo(mut self) -> Self {
        self.halo = true;
        self
    }

    /// Moved by pixels, right and down.
    #[must_use]
    pub fn shift(mut self, right: f64, down: f64) -> Self {
        self.shift = [right, down];
        self
    }

    /// Turned counter-clockwise by degrees.
    #[must_use]
    pub fn turned(mut self, degrees: f64) -> Self {
        self.turn = degrees;
        self
    }

    /// Writes the element; the point is in pixels.
    pub(super) fn write(&self, out: &mut String, x: f64, y: f64, words: &str) {
        let [x, y] = [x + self.shift[0], y + self.shift[1]].map(coordinate);
        let anchor = match self.anchor {
            Anchor::Start => "start",
            Anchor::Middle => "middle",
            Anchor::End => "end",
        };
        let mut attributes = String::new();
        if self.bold {
            attributes.push_str(" font-weight=\"bold\"");
        }
        if self.turn != 0.0 {
            let _ = write!(
                attributes,
                " transform=\"rotate({} {x} {y})\"",
                coordinate(-self.turn)
            );
        }
        let size = coordinate(self.size);
        let words = escaped(words);
        if self.halo {
            // Twice, since not every reader of SVG knows `paint-order`.
            let _ = writeln!(
                out,
                "<text x=\"{x}\" y=\"{y}\" font-size=\"{size}\" text-anchor=\"{anchor}\" fill=\"#ffffff\" \
                 stroke=\"#ffffff\" stroke-width=\"3\" stroke-linejoin=\"round\"{attributes}>{words}</text>"
            );
        }
        let _ = writeln!(
            out,
            "<text x=\"{x}\" y=\"{y}\" font-size=\"{size}\" text-anchor=\"{anchor}\" fill=\"{}\"{attributes}>{words}</text>",
            self.color
        );
    }
}

/// The words in lines no wider than `width`, by the usual width of a letter; line breaks stay.
pub(super) fn wrapped(words: &str, width: f64, size: f64) -> Vec<String> {
    let letters = (width / (0.56 * size)).max(1.0) as usize;
    let mut lines = Vec::new();
    for paragraph in words.lines() {
        let mut line = String::new();
        for word in paragraph.split_whitespace() {
            if !line.is_empty() && line.chars().count() + 1 + word.chars().count() > letters {
                lines.push(std::mem::take(&mut line));
            }
            if !line.is_empty() {
                line.push(' ');
            }
            line.push_str(word);
        }
        lines.push(line);
    }
    lines
}

/// With the characters that XML takes for its own.
fn escaped(words: &str) -> String {
    words
        .replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
}
