//! Bars in groups, as SVG.

use std::fmt::Write as _;

/// A picture: a group of bars for each label, one bar for each series.
pub struct Bars<'a> {
    pub title: &'a str,
    /// Under the title: what the height is.
    pub unit: &'a str,
    /// Name and colour.
    pub series: Vec<(String, &'static str)>,
    /// A label, and a height for each series; none where it was not measured.
    pub groups: Vec<(String, Vec<Option<f64>>)>,
    /// A line across, and what it says.
    pub line: Option<(f64, &'a str)>,
}

/// Blue, light blue, orange, green, red, violet: told apart by most eyes, also in grey.
pub const COLORS: [&str; 6] = [
    "#2b6cb0", "#90cdf4", "#dd8a1f", "#38a169", "#c53030", "#805ad5",
];

const BAR: f64 = 16.0;
const GAP: f64 = 28.0;
/// Room for the label of a group.
const LABEL: f64 = 96.0;
/// Room for a title.
const TITLE: f64 = 440.0;
const LEFT: f64 = 48.0;
const TOP: f64 = 78.0;
const HEIGHT: f64 = 240.0;
const BOTTOM: f64 = 40.0;
/// Room for a word of the legend.
const LEGEND: f64 = 132.0;

impl Bars<'_> {
    /// The picture.
    pub fn to_svg(&self) -> String {
        let group = (BAR * self.series.len() as f64 + GAP).max(LABEL);
        let bars = group * self.groups.len() as f64 + GAP;
        let legend = LEGEND * self.series.len() as f64;
        let width = LEFT + bars.max(legend).max(TITLE) + GAP;
        let height = TOP + HEIGHT + BOTTOM;
        let step = round_step(self.highest());
        let top = (self.highest() / step).ceil().max(1.0) * step;
        let y = |value: f64| TOP + HEIGHT * (1.0 - value / top);

        let mut svg = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width:.0} {height:.0}\" \
             font-family=\"sans-serif\" font-size=\"11\">\n\
             <rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n\
             <text x=\"{LEFT}\" y=\"20\" font-size=\"15\">{}</text>\n\
             <text x=\"{LEFT}\" y=\"36\" fill=\"#555\">{}</text>\n",
            escaped(self.title),
            escaped(self.unit),
        );
        for (i, (name, color)) in self.series.iter().enumerate() {
            let x = LEFT + LEGEND * i as f64;
            let _ = writeln!(
                svg,
                "<rect x=\"{x}\" y=\"46\" width=\"11\" height=\"11\" fill=\"{}\"/>\
                 <text x=\"{}\" y=\"56\">{}</text>",
                color,
                x + 15.0,
                escaped(name),
            );
        }
        let mut tick = 0.0;
        while tick <= top * 1.0001 {
            let _ = writeln!(
                svg,
                "<line x1=\"{LEFT}\" x2=\"{:.0}\" y1=\"{1:.1}\" y2=\"{1:.1}\" stroke=\"#ddd\"/>\
                 <text x=\"{2}\" y=\"{3:.1}\" text-anchor=\"end\">{4}</text>",
                width - GAP,
                y(tick),
                LEFT - 6.0,
                y(tick) + 4.0,
                short(tick),
            );
            tick += step;
        }
        for (g, (label, heights)) in self.groups.iter().enumerate() {
            let middle = LEFT + GAP / 2.0 + group * (g as f64 + 0.5);
            let left = middle - BAR * self.series.len() as f64 / 2.0;
            for (i, height) in heights.iter().enumerate() {
                let Some(value) = *height else { continue };
                let _ = writeln!(
                    svg,
                    "<rect x=\"{:.1}\" y=\"{:.1}\" width=\"{:.0}\" height=\"{:.1}\" fill=\"{}\">\
                     <title>{}, {}: {value:.3}</title></rect>",
                    left + BAR * i as f64,
                    y(value),
                    BAR - 1.0,
                    TOP + HEIGHT - y(value),
                    self.series[i].1,
                    escaped(label),
                    escaped(&self.series[i].0),
                );
            }
            let _ = writeln!(
                svg,
                "<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{}</text>",
                middle,
                TOP + HEIGHT + 18.0,
                escaped(label),
            );
        }
        if let Some((value, words)) = self.line {
            let _ = writeln!(
                svg,
                "<line x1=\"{LEFT}\" x2=\"{0:.0}\" y1=\"{1:.1}\" y2=\"{1:.1}\" stroke=\"#111\" \
                 stroke-dasharray=\"5 3\"/><text x=\"{0:.0}\" y=\"{2:.1}\" text-anchor=\"end\">{3}</text>",
                width - GAP,
                y(value),
                y(value) - 4.0,
                escaped(words),
            );
        }
        svg + "</svg>\n"
    }

    fn highest(&self) -> f64 {
        let heights = self.groups.iter().flat_map(|(_, heights)| heights);
        let line = self.line.map_or(0.0, |(value, _)| value);
        heights.copied().flatten().fold(line, f64::max)
    }
}

/// The step of 1, 2 or 5 times a power of ten that makes four to ten steps up to `top`.
fn round_step(top: f64) -> f64 {
    if !(top > 0.0 && top.is_finite()) {
        return 1.0;
    }
    let power = 10.0_f64.powf((top / 4.0).log10().floor());
    let most = top / 4.0 / power;
    power * [5.0, 2.0].into_iter().find(|&s| s <= most).unwrap_or(1.0)
}

/// At most two digits behind the point, and none that are zero.
fn short(value: f64) -> String {
    let text = format!("{value:.2}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_measured_value_has_a_bar() {
        let svg = Bars {
            title: "a < b",
            unit: "seconds",
            series: vec![("one".into(), COLORS[0]), ("two".into(), COLORS[2])],
            groups: vec![
                ("x".into(), vec![Some(1.0), None]),
                ("y".into(), vec![Some(0.5), Some(2.0)]),
            ],
            line: Some((1.0, "as fast")),
        }
        .to_svg();
        assert_eq!(svg.matches("<title>").count(), 3);
        assert!(svg.contains("a &lt; b") && svg.contains("y, two: 2.000"));
        // The highest bar reaches up to the top, the others as far as their values say.
        assert!(svg.contains("y=\"78.0\" width=\"15\" height=\"240.0\""));
        assert!(svg.contains("height=\"120.0\"") && svg.contains("height=\"60.0\""));
        assert_eq!(svg.matches("<svg").count(), svg.matches("</svg>").count());
    }

    #[test]
    fn steps_are_round() {
        for (top, step) in [
            (1.0, 0.2),
            (2.0, 0.5),
            (4.0, 1.0),
            (99.0, 20.0),
            (0.07, 0.01),
        ] {
            assert!(
                (round_step(top) - step).abs() < 1e-12,
                "{top}: {}",
                round_step(top)
            );
        }
        assert_eq!(round_step(0.0), 1.0);
        assert_eq!(
            (short(0.5), short(20.0), short(0.0)),
            ("0.5".into(), "20".into(), "0".into())
        );
    }
}
