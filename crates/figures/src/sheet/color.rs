//! Colours that people with any colour vision tell apart, and scales of them.

use std::fmt;

/// A colour in sRGB: red, green, blue.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Color(pub [u8; 3]);

/// The qualitative ones are those of M. Okabe and K. Ito, which differ for every kind of colour vision.
impl Color {
    /// Ink.
    pub const BLACK: Self = Self([26, 26, 26]);
    /// Paper.
    pub const WHITE: Self = Self([255, 255, 255]);
    /// What stays in the background.
    pub const GRAY: Self = Self([140, 140, 140]);
    /// What stays further in the background.
    pub const PALE: Self = Self([222, 222, 222]);
    /// The first of a series.
    pub const BLUE: Self = Self([0, 114, 178]);
    /// The second: what is wrong or in question.
    pub const VERMILION: Self = Self([213, 94, 0]);
    /// The third: what is right.
    pub const GREEN: Self = Self([0, 158, 115]);
    /// The fourth.
    pub const PURPLE: Self = Self([204, 121, 167]);
    /// The fifth.
    pub const ORANGE: Self = Self([230, 159, 0]);
    /// The sixth.
    pub const SKY: Self = Self([86, 180, 233]);
    /// The seventh.
    pub const YELLOW: Self = Self([240, 228, 66]);

    /// The qualitative colours in their order, for series by index; they repeat after the seventh.
    pub fn series(index: usize) -> Self {
        const SERIES: [Color; 7] = [
            Color::BLUE,
            Color::VERMILION,
            Color::GREEN,
            Color::PURPLE,
            Color::ORANGE,
            Color::SKY,
            Color::YELLOW,
        ];
        SERIES[index % SERIES.len()]
    }

    /// The colour at `share` of the way to another one.
    #[must_use]
    pub fn mixed(self, other: Self, share: f64) -> Self {
        let share = share.clamp(0.0, 1.0);
        let blend = |a: u8, b: u8| (f64::from(a) * (1.0 - share) + f64::from(b) * share).round();
        Self(std::array::from_fn(|i| blend(self.0[i], other.0[i]) as u8))
    }
}

impl fmt::Display for Color {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [red, green, blue] = self.0;
        write!(f, "#{red:02x}{green:02x}{blue:02x}")
    }
}

/// Colours for the values of an interval.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ColorScale {
    /// The value of the first colour.
    pub least: f64,
    /// The value of the last one.
    pub greatest: f64,
    /// From the first colour to the last, evenly spaced.
    pub stops: [Color; 5],
}

impl ColorScale {
    /// From dark to light.
    pub fn sequential(least: f64, greatest: f64) -> Self {
        let stops = [
            [68, 1, 84],
            [59, 82, 139],
            [33, 145, 140],
            [94, 201, 98],
            [253, 231, 37],
        ]
        .map(Color);
        Self {
            least,
            greatest,
            stops,
        }
    }

    /// From blue over white to red, white in the middle.
    pub fn diverging(least: f64, greatest: f64) -> Self {
        let stops = [
            [33, 102, 172],
            [146, 197, 222],
            [247, 247, 247],
            [244, 165, 130],
            [178, 24, 43],
        ]
        .map(Color);
        Self {
            least,
            greatest,
            stops,
        }
    }

    /// The colour of a value; those outside the interval have the colour of its nearer end.
    pub fn at(&self, value: f64) -> Color {
        let share = (value - self.least) / (self.greatest - self.least);
        let position = if share.is_finite() {
            share.clamp(0.0, 1.0) * 4.0
        } else {
            2.0
        };
        let before = (position as usize).min(3);
        self.stops[before].mixed(self.stops[before + 1], position - before as f64)
    }
}
