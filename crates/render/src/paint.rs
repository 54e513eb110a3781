//! Colours of things, where the palette does not give them.

use crate::shade::{Color, linear};
use crate::{ColorMap, Coloring, Error, Palette};

/// Where a scene's colours come from.
pub enum Painted<'a> {
    /// The palette.
    Sides,
    /// One a thing.
    Each(&'a [[u8; 3]]),
    /// Values.
    Values(Scale<'a>),
}

/// Values, and which colour each has.
pub struct Scale<'a> {
    values: &'a [f64],
    ends: [f64; 2],
    map: ColorMap,
    none: Color,
}

/// Refuses colours that are not one a thing, and ranges that are none.
pub fn check(coloring: &Coloring<'_>, things: usize, vertices: usize) -> Result<(), Error> {
    match coloring {
        Coloring::Each(colors) if colors.len() != things => Err(Error::ColorCount {
            colors: colors.len(),
            expected: things,
        }),
        Coloring::Values(values) if values.values.len() != vertices => Err(Error::ValueCount {
            values: values.values.len(),
            expected: vertices,
        }),
        Coloring::Values(values) => match values.range {
            Some([low, high]) if !(low.is_finite() && high.is_finite() && low <= high) => {
                Err(Error::NoRange { low, high })
            }
            _ => Ok(()),
        },
        _ => Ok(()),
    }
}

impl<'a> Painted<'a> {
    /// The colours that [`check`] passed.
    pub fn new(coloring: &Coloring<'a>, palette: &Palette) -> Self {
        match coloring {
            Coloring::Sides => Self::Sides,
            Coloring::Each(colors) => Self::Each(colors),
            Coloring::Values(values) => Self::Values(Scale {
                values: values.values,
                ends: values.ends().unwrap_or_default(),
                map: values.map,
                none: linear(palette.no_value),
            }),
        }
    }
}

impl Scale<'_> {
    /// The colour of one value.
    pub fn of(&self, index: usize) -> Color {
        self.color(self.values[index])
    }

    /// The colour of three values blended by weights that may all have a common factor, also a negative one.
    pub fn blend(&self, indices: [usize; 3], weights: [f64; 3]) -> Color {
        let values = indices.map(|index| self.values[index]);
        let total: f64 = weights.iter().sum();
        // The middle of a pixel's samples may lie a little outside; halves, so that nothing overflows.
        let share = |i: usize| match weights[i] / total {
            share if share.is_finite() => share.clamp(0.0, 1.0),
            _ => 1.0 / 3.0,
        };
        let shares = [share(0), share(1), share(2)];
        let whole: f64 = shares.iter().sum();
        if values.iter().any(|value| !value.is_finite()) {
            return self.none;
        }
        let blended = (0..3).map(|i| values[i] * (shares[i] / whole)).sum();
        self.color(blended)
    }

    fn color(&self, value: f64) -> Color {
        if !value.is_finite() {
            return self.none;
        }
        linear(self.map.color(share(value, self.ends)))
    }
}

/// Where a value lies between the ends: 0 to 1 from the first to the second; in the middle if they are equal.
pub fn share(value: f64, [low, high]: [f64; 2]) -> f64 {
    // Halves, so that no finite range overflows.
    let extent = 0.5 * high - 0.5 * low;
    if extent > 0.0 {
        (0.5 * value - 0.5 * low) / extent
    } else if value == low {
        0.5
    } else if value < low {
        0.0
    } else {
        1.0
    }
}

#[cfg(test)]
mod tests {
    use super::share;

    #[test]
    fn shares_of_any_range() {
        assert_eq!(share(1.0, [0.0, 4.0]), 0.25);
        assert_eq!(share(f64::MAX, [-f64::MAX, f64::MAX]), 1.0);
        assert_eq!(share(0.0, [-f64::MAX, f64::MAX]), 0.5);
        assert_eq!(
            [0.0, 1.0, 2.0].map(|value| share(value, [1.0, 1.0])),
            [0.0, 0.5, 1.0]
        );
        let tiny = f64::MIN_POSITIVE;
        assert_eq!(share(tiny, [0.0, 2.0 * tiny]), 0.5);
    }
}
