//! The bar that tells which colour is which value.

use crate::paint::share;
use crate::shade::{Color, linear};
use crate::{Bar, Coloring, Error, Image, Options, Values, font};

/// The bar of a sheet: where it stands, and what is written beside it.
///
/// ```text
///          title
///   views  ██─ 2       all measures in heights of a digit
///          ██─ 1
///          ██─ 0
/// ```
pub struct ColorBar<'a> {
    values: Values<'a>,
    ends: [f64; 2],
    ticks: Vec<Tick>,
    /// Height of a digit in pixels.
    size: f64,
    /// Columns at the sheet's right.
    pub columns: u32,
}

/// A number at the bar.
#[derive(Clone, Debug, PartialEq)]
struct Tick {
    value: f64,
    label: String,
}

/// Heights of a digit: free space at the left and the right of everything, width of the bar, from there to the numbers,
/// and where the bar begins and ends.
const MARGIN: f64 = 1.2;
const WIDE: f64 = 1.4;
const TICK: f64 = 0.8;
const TOP: f64 = 4.5;
const BOTTOM: f64 = 2.5;

impl<'a> ColorBar<'a> {
    /// The bar that a drawing asks for; an error where it would take half of the sheet or more.
    pub fn new(coloring: &Coloring<'a>, options: &Options) -> Result<Option<Self>, Error> {
        let values = match coloring {
            Coloring::Values(values) if values.bar == Bar::Right => *values,
            _ => return Ok(None),
        };
        let Some(ends) = values.ends() else {
            return Ok(None);
        };
        let (wide, high) = (f64::from(options.width), f64::from(options.height));
        let size = (wide.min(high) / 45.0).clamp(8.0, 40.0);
        let ticks = ticks(ends, (high / (4.5 * size)) as usize);
        let labels = ticks.iter().map(|tick| font::width(&tick.label, size));
        let right = WIDE + TICK + labels.fold(0.0, f64::max) / size;
        let columns = (size * (2.0 * MARGIN + right)).ceil();
        if columns > 0.5 * wide || size * (TOP + BOTTOM + 2.0) > high {
            return Err(Error::NoRoomForBar {
                width: options.width,
                height: options.height,
            });
        }
        Ok(Some(Self {
            values,
            ends,
            ticks,
            size,
            columns: columns as u32,
        }))
    }

    /// Draws it into the columns that are its own.
    pub fn draw(&self, image: &mut Image, options: &Options) {
        let size = self.size;
        let text = linear(options.palette.text);
        let left = f64::from(image.width) - f64::from(self.columns) + MARGIN * size;
        let left = left.floor();
        let right = (left + WIDE * size).floor();
        let top = (TOP * size).floor();
        let bottom = (f64::from(image.height) - BOTTOM * size).floor();
        for row in top as usize..bottom as usize {
            let row = row as f64;
            let share = (bottom - row - 0.5) / (bottom - top);
            let color = linear(self.values.map.color(share));
            font::fill(image, [left, right], [row, row + 1.0], color);
        }
        let half = (0.06 * size).max(0.5);
        for tick in &self.ticks {
            let y = bottom - share(tick.value, self.ends) * (bottom - top);
            let line = [right, right + 0.35 * size];
            font::fill(image, line, [y - half, y + half], text);
            let place = (right + TICK * size, y + 0.5 * size);
            font::write(image, &tick.label, place, size, text);
        }
        self.title(image, top - 1.5 * size, text);
    }

    /// At the right edge above the bar, smaller where it would take more than half of the sheet.
    fn title(&self, image: &mut Image, base: f64, color: Color) {
        let room = 0.5 * f64::from(image.width);
        let natural = font::width(self.values.title, self.size);
        let size = match natural > room {
            true => self.size * room / natural,
            false => self.size,
        };
        let wide = font::width(self.values.title, size);
        let own = f64::from(self.columns) - 2.0 * MARGIN * self.size;
        let x = f64::from(image.width) - MARGIN * self.size - wide.max(own);
        font::write(image, self.values.title, (x, base), size, color);
    }
}

/// About so many round numbers, at least two wanted, between the ends: multiples of 1, 2 or 5 times a power of ten.
fn ticks([low, high]: [f64; 2], wanted: usize) -> Vec<Tick> {
    let alone = || {
        vec![Tick {
            value: low,
            label: shortest(low),
        }]
    };
    let step = (0.5 * high - 0.5 * low) / wanted.clamp(2, 12) as f64 * 2.0;
    // What the digits of doubles cannot tell apart has one number.
    let magnitude = low.abs().max(high.abs());
    if !(step > 0.0 && step.is_finite() && step > 1e-12 * magnitude) {
        return alone();
    }
    // By its digits, so that every machine rounds alike: step = mantissa · 10^exponent.
    let written = format!("{step:e}");
    let (mantissa, exponent) = written.split_once('e').unwrap_or(("1", "0"));
    let mantissa: f64 = mantissa.parse().unwrap_or(1.0);
    let exponent: i32 = exponent.parse().unwrap_or(0);
    let (factor, exponent) = match mantissa {
        m if m <= 1.0 => (1, exponent),
        m if m <= 2.0 => (2, exponent),
        m if m <= 5.0 => (5, exponent),
        _ => (1, exponent + 1),
    };
    let value = |multiple: i64| -> f64 {
        let text = format!("{}e{exponent}", multiple * factor);
        text.parse().unwrap_or(f64::NAN)
    };
    let unit = value(1);
    if !(unit > 0.0 && unit.is_finite()) {
        return alone();
    }
    let (first, last) = ((low / unit).floor() as i64, (high / unit).ceil() as i64);
    (first..=last)
        .map(|multiple| (multiple * factor, value(multiple)))
        .filter(|&(_, value)| low <= value && value <= high)
        .map(|(digits, value)| Tick {
            value,
            label: label(digits, exponent),
        })
        .collect()
}

/// digits · 10^exponent: plain where that is short, and else with an exponent.
fn label(digits: i64, exponent: i32) -> String {
    let sign = if digits < 0 { "-" } else { "" };
    let text = digits.unsigned_abs().to_string();
    let leading = text.len() as i32 - 1 + exponent;
    match exponent {
        _ if digits == 0 => "0".to_owned(),
        0.. if leading < 6 => format!("{sign}{text}{}", "0".repeat(exponent as usize)),
        -6..0 if leading < 6 => {
            let places = exponent.unsigned_abs() as usize;
            let padded = format!("{text:0>width$}", width = places + 1);
            let (whole, fraction) = padded.split_at(padded.len() - places);
            format!("{sign}{whole}.{fraction}")
        }
        _ => {
            let (first, rest) = text.split_at(1);
            match rest.trim_end_matches('0') {
                "" => format!("{sign}{first}e{leading}"),
                rest => format!("{sign}{first}.{rest}e{leading}"),
            }
        }
    }
}

/// The fewest digits that read back to the number, or six of them.
fn shortest(value: f64) -> String {
    let written = format!("{value}");
    match written.len() {
        0..=9 => written,
        _ => format!("{value:.5e}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(low: f64, high: f64) -> Vec<String> {
        let ticks = ticks([low, high], 5).into_iter();
        ticks.map(|tick| tick.label).collect()
    }

    #[test]
    fn ticks_are_round() {
        assert_eq!(labels(0.0, 1.0), ["0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
        assert_eq!(labels(-1.0, 1.0), ["-1.0", "-0.5", "0", "0.5", "1.0"]);
        assert_eq!(labels(0.0013, 0.0049), ["0.002", "0.003", "0.004"]);
        assert_eq!(labels(0.0, 4.2e7), ["0", "1e7", "2e7", "3e7", "4e7"]);
        assert_eq!(labels(0.0, 25.0), ["0", "5", "10", "15", "20", "25"]);
        assert_eq!(labels(1e-9, 4.1e-9), ["1e-9", "2e-9", "3e-9", "4e-9"]);
        assert_eq!(labels(3.5, 3.5), ["3.5"]);
        assert_eq!(labels(1e9, 1e9 + 1e-7), ["1.00000e9"]);
    }

    #[test]
    fn labels_read_back_to_their_values() {
        let mut state = 7_u64;
        let mut random = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        for _ in 0..20_000 {
            let exponent = (random() * 600.0) as i32 - 300;
            let scale: f64 = format!("1e{exponent}").parse().unwrap();
            let low = (random() - 0.5) * scale;
            let ends = [low, low + random() * scale];
            let found = ticks(ends, 6);
            assert!((1..=14).contains(&found.len()), "{ends:?}: {found:?}");
            for tick in &found {
                let read: f64 = tick.label.parse().unwrap();
                assert!(ends[0] <= tick.value && tick.value <= ends[1], "{tick:?}");
                assert!(read == tick.value || found.len() == 1, "{tick:?}");
            }
            assert!(found.is_sorted_by(|a, b| a.value < b.value));
        }
    }

    #[test]
    fn any_finite_range_has_ticks() {
        for ends in [
            [-f64::MAX, f64::MAX],
            [0.0, f64::MIN_POSITIVE],
            [0.0, 5e-324],
            [-0.0, 0.0],
        ] {
            assert!(!ticks(ends, 6).is_empty(), "{ends:?}");
        }
    }
}
