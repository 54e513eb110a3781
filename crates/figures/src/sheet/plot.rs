//! Plots: axes with ticks, and series of points.

use super::{Anchor, Color, Panel, Scale, Style, Text, panel::Map};
use pellicle::glam::DVec2;

/// Room for labels and ticks, in pixels.
const LEFT: f64 = 62.0;
const RIGHT: f64 = 14.0;
const TOP: f64 = 12.0;
const BOTTOM: f64 = 44.0;

/// Series of points over two axes.
///
/// ```
/// use pellicle::glam::DVec2;
/// use pellicle_figures::sheet::{Axis, Plot, Series};
///
/// let error = |h: f64| DVec2::new(h, 0.3 * h * h);
/// let panel = Plot::new(Axis::new("h").logarithmic(), Axis::new("error").logarithmic())
///     .with(Series::line("order 2", [0.1, 0.05, 0.025].map(error)).marked())
///     .panel(400.0, 300.0);
/// assert_eq!(panel.width(), 400.0);
/// ```
#[derive(Clone, Debug)]
pub struct Plot {
    axes: [Axis; 2],
    series: Vec<Series>,
    legend: bool,
}

/// An axis of a plot.
#[derive(Clone, Debug)]
pub struct Axis {
    label: String,
    scale: Scale,
    range: Option<[f64; 2]>,
}

/// Points that belong together.
#[derive(Clone, Debug)]
pub struct Series {
    label: String,
    points: Vec<DVec2>,
    look: Look,
    color: Option<Color>,
}

/// How a series is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Look {
    /// A line through its points.
    Line,
    /// A line, and a dot at each point.
    MarkedLine,
    /// Dots alone.
    Dots,
    /// A dashed line: for what is expected.
    Dashed,
    /// An upright bar from the lower end of the axis to each point.
    Bars,
}

impl Axis {
    /// A linear axis that holds all points. The label tells the unit.
    pub fn new(label: impl Into<String>) -> Self {
        Self {
            label: label.into(),
            scale: Scale::Linear,
            range: None,
        }
    }

    /// With a logarithmic scale.
    #[must_use]
    pub fn logarithmic(mut self) -> Self {
        self.scale = Scale::Logarithmic;
        self
    }

    /// From `least` to `greatest`, whatever the points.
    #[must_use]
    pub fn range(mut self, least: f64, greatest: f64) -> Self {
        self.range = Some([least, greatest]);
        self
    }
}

impl Series {
    /// A line through the points.
    pub fn line(label: impl Into<String>, points: impl Into<Vec<DVec2>>) -> Self {
        Self {
            label: label.into(),
            points: points.into(),
            look: Look::Line,
            color: None,
        }
    }

    /// Dots at the points.
    pub fn dots(label: impl Into<String>, points: impl Into<Vec<DVec2>>) -> Self {
        Self::line(label, points).look(Look::Dots)
    }

    /// With a dot at each point.
    #[must_use]
    pub fn marked(self) -> Self {
        self.look(Look::MarkedLine)
    }

    /// With another look.
    #[must_use]
    pub fn look(mut self, look: Look) -> Self {
        self.look = look;
        self
    }

    /// In this colour instead of the next one of [`Color::series`].
    #[must_use]
    pub fn color(mut self, color: Color) -> Self {
        self.color = Some(color);
        self
    }
}

impl Plot {
    /// A plot without series: across, then up.
    pub fn new(across: Axis, up: Axis) -> Self {
        Self {
            axes: [across, up],
            series: Vec::new(),
            legend: true,
        }
    }

    /// With one more series.
    #[must_use]
    pub fn with(mut self, series: Series) -> Self {
        self.series.push(series);
        self
    }

    /// Without the legend, which names the series that have a label.
    #[must_use]
    pub fn without_legend(mut self) -> Self {
        self.legend = false;
        self
    }

    /// The plot as a panel; what is drawn into it later is in the plot's coordinates.
    pub fn panel(&self, width: f64, height: f64) -> Panel {
        // The legend has its own rows above, so that it never hides a point.
        let labelled: Vec<(Color, &Series)> = self.colored().collect();
        let labelled: Vec<_> = labelled
            .into_iter()
            .filter(|(_, series)| self.legend && !series.label.is_empty())
            .collect();
        let top = TOP + 16.0 * labelled.len() as f64;
        let maps = [
            self.map(0, [LEFT, width - RIGHT]),
            self.map(1, [height - BOTTOM, top]),
        ];
        let mut panel = Panel::mapped([width, height], maps);
        draw_axis_across(&mut panel, &self.axes[0], maps);
        draw_axis_up(&mut panel, &self.axes[1], maps);
        for (color, series) in self.colored() {
            draw(&mut panel, series, color, maps[1].range[0]);
        }
        for (row, (color, series)) in labelled.into_iter().enumerate() {
            draw_entry(&mut panel, series, color, 8.0 + 16.0 * row as f64);
        }
        panel
    }

    fn colored(&self) -> impl Iterator<Item = (Color, &Series)> {
        self.series
            .iter()
            .enumerate()
            .map(|(at, series)| (series.color.unwrap_or(Color::series(at)), series))
    }

    fn map(&self, axis: usize, pixels: [f64; 2]) -> Map {
        let Axis { scale, range, .. } = self.axes[axis];
        let values = self.series.iter().flat_map(|series| &series.points);
        let range = range.unwrap_or_else(|| scale.range(values.map(|point| point[axis])));
        Map {
            scale,
            range,
            pixels,
        }
    }
}

fn draw_axis_across(panel: &mut Panel, axis: &Axis, [across, up]: [Map; 2]) {
    let base = up.pixels[0];
    let line = Style::stroke(Color::BLACK, 1.0);
    let ends = across.pixels.map(|x| DVec2::new(x, base));
    panel.over_line(ends[0], ends[1], line);
    for (value, words) in axis.scale.ticks(across.range) {
        let share = axis.scale.share(value, across.range);
        let x = across.pixels[0] + share * (across.pixels[1] - across.pixels[0]);
        let foot = DVec2::new(x, base);
        panel.over_line(foot, foot + DVec2::Y * 5.0, line);
        panel.line(
            DVec2::new(value, up.range[0]),
            DVec2::new(value, up.range[1]),
            Style::stroke(Color::PALE, 0.7),
        );
        panel.text_at_pixel(foot + DVec2::Y * 17.0, &words, Text::default().size(11.0));
    }
    let middle = DVec2::new((ends[0].x + ends[1].x) / 2.0, base + 36.0);
    panel.text_at_pixel(middle, &axis.label, Text::default());
}

fn draw_axis_up(panel: &mut Panel, axis: &Axis, [across, up]: [Map; 2]) {
    let side = across.pixels[0];
    let line = Style::stroke(Color::BLACK, 1.0);
    let ends = up.pixels.map(|y| DVec2::new(side, y));
    panel.over_line(ends[0], ends[1], line);
    for (value, words) in axis.scale.ticks(up.range) {
        let share = axis.scale.share(value, up.range);
        let y = up.pixels[0] + share * (up.pixels[1] - up.pixels[0]);
        let foot = DVec2::new(side, y);
        panel.over_line(foot - DVec2::X * 5.0, foot, line);
        panel.line(
            DVec2::new(across.range[0], value),
            DVec2::new(across.range[1], value),
            Style::stroke(Color::PALE, 0.7),
        );
        let text = Text::default().size(11.0).anchor(Anchor::End);
        panel.text_at_pixel(foot + DVec2::new(-8.0, 4.0), &words, text);
    }
    let middle = DVec2::new(14.0, (ends[0].y + ends[1].y) / 2.0);
    panel.text_at_pixel(middle, &axis.label, Text::default().turned(90.0));
}

fn draw(panel: &mut Panel, series: &Series, color: Color, base: f64) {
    let line = Style::stroke(color, 1.8);
    match series.look {
        Look::Line | Look::MarkedLine => panel.polyline(&series.points, line),
        Look::Dashed => panel.polyline(&series.points, line.dashed(5.0)),
        Look::Dots => {}
        Look::Bars => {
            for &point in &series.points {
                let foot = DVec2::new(point.x, base);
                panel.line(foot, point, Style::stroke(color, 7.0));
            }
        }
    }
    if matches!(series.look, Look::MarkedLine | Look::Dots) {
        for &point in &series.points {
            panel.dot(point, 3.0, Style::fill(color));
        }
    }
}

/// A sample of the series' look, and its label.
fn draw_entry(panel: &mut Panel, series: &Series, color: Color, y: f64) {
    let [from, to] = [LEFT + 4.0, LEFT + 30.0].map(|x| DVec2::new(x, y));
    let line = Style::stroke(color, 1.8);
    match series.look {
        Look::Line => panel.over_line(from, to, line),
        Look::Dashed => panel.over_line(from, to, line.dashed(5.0)),
        Look::Bars => panel.over_line(from, to, Style::stroke(color, 8.0)),
        Look::Dots => panel.over_dot((from + to) / 2.0, Style::fill(color)),
        Look::MarkedLine => {
            panel.over_line(from, to, line);
            panel.over_dot((from + to) / 2.0, Style::fill(color));
        }
    }
    let text = Text::default().size(11.0).anchor(Anchor::Start);
    panel.text_at_pixel(to + DVec2::new(7.0, 4.0), &series.label, text);
}
