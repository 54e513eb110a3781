//! From the values of an axis to a share of its length, and where its ticks stand.

/// How values are spread over an axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Scale {
    /// Evenly.
    #[default]
    Linear,
    /// Evenly by their logarithm; values must be positive.
    Logarithmic,
}

impl Scale {
    /// Where a value stands: 0 at `least`, 1 at `greatest`. NaN where it has no place.
    pub fn share(self, value: f64, [least, greatest]: [f64; 2]) -> f64 {
        match self {
            Self::Linear => (value - least) / (greatest - least),
            Self::Logarithmic => (value / least).ln() / (greatest / least).ln(),
        }
    }

    /// A range that holds the values with a little room, ends included; [0, 1] (or [1, 10]) without any value.
    pub fn range(self, values: impl Iterator<Item = f64>) -> [f64; 2] {
        let has_a_place = |value: &f64| match self {
            Self::Linear => value.is_finite(),
            Self::Logarithmic => value.is_finite() && *value > 0.0,
        };
        let mut range = [f64::INFINITY, f64::NEG_INFINITY];
        for value in values.filter(has_a_place) {
            range = [range[0].min(value), range[1].max(value)];
        }
        let [least, greatest] = range;
        match self {
            Self::Linear if least > greatest => [0.0, 1.0],
            Self::Logarithmic if least > greatest => [1.0, 10.0],
            Self::Linear if least == greatest => [least - 0.5, greatest + 0.5],
            Self::Logarithmic if least == greatest => [least / 2.0, greatest * 2.0],
            Self::Linear => {
                let room = 0.05 * (greatest - least);
                // A range that begins at zero stays there.
                let least = if least == 0.0 { 0.0 } else { least - room };
                [least, greatest + room]
            }
            Self::Logarithmic => {
                let room = (greatest / least).powf(0.05);
                [least / room, greatest * room]
            }
        }
    }

    /// Values for ticks within the range, and what to write at each.
    pub fn ticks(self, range: [f64; 2]) -> Vec<(f64, String)> {
        match self {
            Self::Linear => linear(range),
            Self::Logarithmic => logarithmic(range),
        }
    }
}

/// Multiples of 1, 2 or 5 times a power of ten: at most seven.
fn linear([least, greatest]: [f64; 2]) -> Vec<(f64, String)> {
    let span = greatest - least;
    if !(span > 0.0 && span.is_finite()) {
        return Vec::new();
    }
    let power = (span / 6.0).log10().floor();
    let unit = 10_f64.powf(power);
    let factor = [1.0, 2.0, 5.0]
        .into_iter()
        .find(|factor| span / (factor * unit) <= 6.0)
        .unwrap_or(10.0);
    let step = factor * unit;
    let decimals = if factor == 10.0 { -power - 1.0 } else { -power };
    let decimals = decimals.clamp(0.0, 12.0) as usize;
    let slack = 1e-9 * span;
    let first = ((least - slack) / step).ceil() as i64;
    let last = ((greatest + slack) / step).floor() as i64;
    (first..=last.min(first + 20))
        .map(|i| {
            let value = i as f64 * step;
            let text = if value.abs() >= 1e6 {
                format!("{value:e}")
            } else {
                format!("{value:.decimals$}")
            };
            (value, text.replace('-', "−"))
        })
        .collect()
}

/// Powers of ten, thinned out to at most eight; 2 and 5 times them too where there are fewer than three.
fn logarithmic([least, greatest]: [f64; 2]) -> Vec<(f64, String)> {
    if !(least > 0.0 && greatest > least && greatest.is_finite()) {
        return Vec::new();
    }
    let first = least.log10().floor() as i32;
    let last = greatest.log10().ceil() as i32;
    let inside = |value: f64| value >= least * (1.0 - 1e-9) && value <= greatest * (1.0 + 1e-9);
    let powers = (first..=last).filter(|&p| inside(10_f64.powi(p))).count();
    let every = powers.div_ceil(8).max(1) as i32;
    let factors: &[i32] = if powers < 3 { &[1, 2, 5] } else { &[1] };
    let mut ticks = Vec::new();
    for power in (first..=last).filter(|power| power.rem_euclid(every) == 0) {
        for &factor in factors {
            let value = f64::from(factor) * 10_f64.powi(power);
            if inside(value) {
                ticks.push((value, power_text(factor, power)));
            }
        }
    }
    ticks
}

/// 0.05, 20, 10⁻⁴, 5·10⁷.
fn power_text(factor: i32, power: i32) -> String {
    match power {
        0..=3 => format!("{}", f64::from(factor) * 10_f64.powi(power)),
        -2..=-1 => format!(
            "{:.*}",
            -power as usize,
            f64::from(factor) * 10_f64.powi(power)
        ),
        _ => {
            let exponent: String = power.to_string().chars().map(raised).collect();
            match factor {
                1 => format!("10{exponent}"),
                _ => format!("{factor}·10{exponent}"),
            }
        }
    }
}

fn raised(character: char) -> char {
    match character {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        '0' => '⁰',
        // ⁴ to ⁹ stand in a row.
        digit => char::from_u32('⁴' as u32 + digit as u32 - '4' as u32).unwrap_or(digit),
    }
}
