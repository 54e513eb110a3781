//! An SVG document built by code: panels in a grid, each with a caption.
//!
//! A [`Panel`] is a rectangle to draw in: in pixels, in a plane with y up, or in the coordinates of a [`Plot`].
//! [`Style`] says how lines and areas look, [`Text`] how words do. Lengths without data are in pixels of the sheet.
//!
//! ```
//! use pellicle::glam::DVec2;
//! use pellicle_figures::sheet::{Color, Panel, Sheet, Style, Text};
//!
//! let mut panel = Panel::plane(300.0, 200.0, DVec2::ZERO, DVec2::new(3.0, 2.0)).caption("a triangle");
//! let corners = [DVec2::ZERO, DVec2::new(3.0, 0.0), DVec2::new(1.0, 2.0)];
//! panel.polygon(&corners, Style::fill(Color::SKY).outlined(Color::BLACK, 1.5));
//! panel.text(corners[2], "c", Text::default().bold());
//! let sheet = Sheet::new(1).with(panel);
//! assert!(sheet.svg().starts_with("<svg"));
//! ```

mod color;
mod panel;
mod plot;
mod scale;
mod style;

pub use color::{Color, ColorScale};
pub use panel::{Panel, Sampling};
pub use plot::{Axis, Look, Plot, Series};
pub use scale::Scale;
pub use style::{Anchor, Style, Text};

use std::fmt::Write as _;

/// Around the sheet, and between its panels.
const MARGIN: f64 = 14.0;
const CAPTION_SIZE: f64 = 13.0;
const LINE_HEIGHT: f64 = 1.35;

/// Panels in rows.
#[derive(Clone, Debug)]
pub struct Sheet {
    columns: usize,
    panels: Vec<Panel>,
}

impl Sheet {
    /// An empty sheet with so many panels a row.
    pub fn new(columns: usize) -> Self {
        Self {
            columns: columns.max(1),
            panels: Vec::new(),
        }
    }

    /// Puts a panel behind the last one.
    pub fn push(&mut self, panel: Panel) {
        self.panels.push(panel);
    }

    /// The sheet with one more panel.
    #[must_use]
    pub fn with(mut self, panel: Panel) -> Self {
        self.push(panel);
        self
    }

    /// The document: a white sheet, each column as wide as its widest panel, each row as high as its highest, captions
    /// below.
    pub fn svg(&self) -> String {
        let columns = self.columns.min(self.panels.len()).max(1);
        let mut widths = vec![0.0_f64; columns];
        for (at, panel) in self.panels.iter().enumerate() {
            widths[at % columns] = widths[at % columns].max(panel.width());
        }
        let mut body = String::new();
        let mut top = MARGIN;
        for row in self.panels.chunks(columns) {
            let height = row.iter().map(Panel::height).fold(0.0, f64::max);
            let mut left = MARGIN;
            let mut lines = 0;
            for (panel, width) in row.iter().zip(&widths) {
                let inset = (width - panel.width()) / 2.0;
                panel.write(&mut body, left + inset, top);
                let caption = style::wrapped(panel.words(), *width, CAPTION_SIZE);
                for (line, words) in caption.iter().enumerate() {
                    let y = top + height + CAPTION_SIZE * (1.2 + LINE_HEIGHT * line as f64);
                    let text = Text::default().size(CAPTION_SIZE);
                    text.write(&mut body, left + width / 2.0, y, words);
                }
                lines = lines.max(caption.len());
                left += width + MARGIN;
            }
            top += height + CAPTION_SIZE * LINE_HEIGHT * lines as f64 + 1.5 * MARGIN;
        }
        let width = widths.iter().sum::<f64>() + MARGIN * (columns + 1) as f64;
        let [width, height] = [width, top].map(|length| length.ceil().max(1.0));
        let mut svg = String::new();
        let _ = writeln!(
            svg,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} \
             {height}\" font-family=\"DejaVu Sans, sans-serif\">\n<rect width=\"{width}\" height=\"{height}\" \
             fill=\"#ffffff\"/>"
        );
        svg.push_str(&body);
        svg.push_str("</svg>\n");
        svg
    }
}

/// A coordinate in the document, to a hundredth of a pixel, without trailing zeros.
fn coordinate(value: f64) -> String {
    // Far outside it is out of sight, and no reader of SVG takes it.
    let text = format!("{:.2}", value.clamp(-1e5, 1e5));
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" {
        "0".to_owned()
    } else {
        text.to_owned()
    }
}

#[cfg(test)]
mod tests;
