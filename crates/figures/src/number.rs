//! The numbers beside a picture.

use crate::Error;
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;

/// One number of a figure, and what the paper prints for it.
///
/// ```
/// use pellicle_figures::{Compare, Number};
///
/// let number = Number::within("radius", 0.97, 1e-9).unit("voxels").paper("about 1");
/// assert_eq!(number.compare, Compare::Within(1e-9));
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Number {
    /// What it counts or measures; unique within the figure.
    pub name: String,
    /// The value; finite.
    pub value: f64,
    /// Its unit; empty for a count or a ratio.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub unit: String,
    /// What the paper prints for it, if it does.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub paper: Option<String>,
    /// How it is compared with a later run.
    pub compare: Compare,
}

/// When two values of a number are the same.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Compare {
    /// When they are equal.
    Exactly,
    /// When they differ by at most this share of the larger magnitude.
    Within(f64),
    /// Always: times, and what else depends on the machine.
    Not,
}

impl Number {
    /// A count, a sign, or what is computed by `+ − × ÷ √` in one order.
    pub fn exactly(name: impl Into<String>, value: f64) -> Self {
        Self::new(name, value, Compare::Exactly)
    }

    /// A number that may differ by a share of itself between machines.
    pub fn within(name: impl Into<String>, value: f64, share: f64) -> Self {
        Self::new(name, value, Compare::Within(share))
    }

    /// A time.
    pub fn uncompared(name: impl Into<String>, value: f64) -> Self {
        Self::new(name, value, Compare::Not)
    }

    fn new(name: impl Into<String>, value: f64, compare: Compare) -> Self {
        Self {
            name: name.into(),
            // −0 is written as "-0.0", which nobody wants to read.
            value: value + 0.0,
            unit: String::new(),
            paper: None,
            compare,
        }
    }

    /// The same number with a unit.
    #[must_use]
    pub fn unit(mut self, unit: impl Into<String>) -> Self {
        self.unit = unit.into();
        self
    }

    /// The same number with what the paper prints.
    #[must_use]
    pub fn paper(mut self, printed: impl Into<String>) -> Self {
        self.paper = Some(printed.into());
        self
    }

    /// Value and unit, rounded for reading.
    pub fn text(&self) -> String {
        let value = readable(self.value);
        match self.unit.as_str() {
            "" => value,
            "°" | "%" => format!("{value}{}", self.unit),
            unit => format!("{value} {unit}"),
        }
    }
}

/// Counts in full, with a thin mark every three digits; other values to four digits.
fn readable(value: f64) -> String {
    let magnitude = value.abs();
    if value == value.trunc() && magnitude < 1e15 {
        let digits = format!("{magnitude:.0}");
        let mut text = String::from(if value < 0.0 { "−" } else { "" });
        for (at, digit) in digits.chars().enumerate() {
            if at > 0 && (digits.len() - at).is_multiple_of(3) {
                text.push(',');
            }
            text.push(digit);
        }
        return text;
    }
    let text = if (1e-3..1e6).contains(&magnitude) {
        let before_the_point = magnitude.log10().floor() as i32 + 1;
        format!("{value:.*}", (4 - before_the_point).max(0) as usize)
    } else {
        format!("{value:.2e}")
    };
    text.replace('-', "−")
}

/// All values are finite, and no name is there twice.
pub fn check(numbers: &[Number]) -> Result<(), Error> {
    let mut names = BTreeSet::new();
    for number in numbers {
        if !number.value.is_finite() {
            return Err(Error::NotFinite {
                name: number.name.clone(),
                value: number.value,
            });
        }
        if !names.insert(&number.name) {
            return Err(Error::SameName {
                name: number.name.clone(),
            });
        }
    }
    Ok(())
}

/// Every way in which `made` is not what was `stored`, a line each; how to compare is what `made` says.
pub fn differences(stored: &[Number], made: &[Number]) -> Vec<String> {
    let find = |name: &str, among: &[Number]| among.iter().position(|n| n.name == name);
    let mut lines = Vec::new();
    for number in made {
        let name = &number.name;
        let Some(at) = find(name, stored) else {
            lines.push(format!("{name}: {} is new", number.text()));
            continue;
        };
        let old = &stored[at];
        if old.unit != number.unit || old.compare != number.compare {
            lines.push(format!("{name}: has another unit or is compared otherwise"));
        }
        if !same(old.value, number.value, number.compare) {
            lines.push(format!("{name}: {} was {}", number.value, old.value));
        }
    }
    for old in stored {
        if find(&old.name, made).is_none() {
            lines.push(format!("{}: {} is gone", old.name, old.text()));
        }
    }
    lines
}

fn same(one: f64, other: f64, compare: Compare) -> bool {
    match compare {
        Compare::Exactly => one == other,
        Compare::Within(share) => (one - other).abs() <= share * one.abs().max(other.abs()),
        Compare::Not => true,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_differs_is_named() {
        let stored = [
            Number::exactly("a", 1.0),
            Number::within("b", 100.0, 0.01),
            Number::uncompared("c", 1.0),
            Number::exactly("d", 1.0),
        ];
        assert!(differences(&stored, &stored).is_empty());
        let made = [
            Number::exactly("a", 1.0_f64.next_up()),
            Number::within("b", 102.0, 0.01),
            Number::uncompared("c", 9.0),
            Number::exactly("e", 1.0),
        ];
        let lines = differences(&stored, &made);
        assert_eq!(lines.len(), 4, "{lines:?}");
        for (line, start) in lines
            .iter()
            .zip(["a: ", "b: ", "e: 1 is new", "d: 1 is gone"])
        {
            assert!(line.starts_with(start), "{line}");
        }
        let close = [Number::within("b", 100.9, 0.01)];
        assert!(differences(&stored[1..2], &close).is_empty());
        let other_unit = [Number::exactly("a", 1.0).unit("m")];
        assert_eq!(differences(&stored[..1], &other_unit).len(), 1);
    }

    #[test]
    fn numbers_that_cannot_be_stored_are_refused() {
        let nan = [Number::exactly("a", f64::NAN)];
        assert!(matches!(check(&nan), Err(Error::NotFinite { .. })));
        let twice = [Number::exactly("a", 0.0), Number::uncompared("a", 1.0)];
        assert!(matches!(check(&twice), Err(Error::SameName { .. })));
    }

    #[test]
    fn readable_numbers() {
        for (value, text) in [
            (0.0, "0"),
            (-0.0, "0"),
            (65536.0, "65,536"),
            (-1000.0, "−1,000"),
            (0.123456, "0.1235"),
            (99.8876, "99.89"),
            (12345.678, "12346"),
            (4.4e-5, "4.40e−5"),
        ] {
            assert_eq!(Number::exactly("x", value).text(), text);
        }
        assert_eq!(Number::exactly("x", 2.5).unit("%").text(), "2.500%");
    }
}
