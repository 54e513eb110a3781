//! A square of signs in three colours, and how many of them are wrong.

use crate::sheet::{Color, Panel, Sampling, Style};
use crate::{Error, Number};
use pellicle::glam::DVec2;
use pellicle::predicates::Sign;
use pellicle::render::Image;

/// The signs of a square of positions: x to the right, y up.
pub(super) struct SignMap {
    pub image: Image,
    pub wrong: u32,
    pub zero: u32,
    /// Wrong, and not zero: one side for the other.
    pub opposite: u32,
}

impl SignMap {
    /// What `found` says at `side` × `side` positions, and how often that is not the truth.
    pub fn new(
        side: u32,
        found: impl Fn(u32, u32) -> Sign,
        truth: impl Fn(u32, u32) -> Sign,
    ) -> Self {
        let mut map = Self {
            image: Image {
                width: side,
                height: side,
                pixels: Vec::new(),
            },
            wrong: 0,
            zero: 0,
            opposite: 0,
        };
        // Rows from the top.
        for y in (0..side).rev() {
            for x in 0..side {
                let [found, truth] = [found(x, y), truth(x, y)];
                map.wrong += u32::from(found != truth);
                map.zero += u32::from(found == Sign::Zero);
                map.opposite += u32::from(found == -truth && found != truth);
                let [red, green, blue] = color(found).0;
                map.image.pixels.push([red, green, blue, 255]);
            }
        }
        map
    }

    /// The map, `size` pixels wide.
    pub fn panel(&self, size: f64) -> Result<Panel, Error> {
        let corner = DVec2::splat(size);
        let mut panel = Panel::pixels(size, size);
        panel.picture(DVec2::ZERO, corner, &self.image, Sampling::Squares)?;
        let entry = |sign, words| (Style::fill(color(sign)).outlined(Color::WHITE, 1.0), words);
        let entries = [
            entry(Sign::Positive, "> 0"),
            entry(Sign::Zero, "= 0"),
            entry(Sign::Negative, "< 0"),
        ];
        panel.legend(DVec2::new(10.0, 10.0), &entries);
        Ok(panel)
    }

    /// How many signs are wrong, how many are on the other side, and how many are zero.
    pub fn numbers(&self, name: &str) -> [Number; 3] {
        [
            ("wrong signs", self.wrong),
            ("left for right", self.opposite),
            ("zeros", self.zero),
        ]
        .map(|(what, count)| Number::exactly(format!("{what}, {name}"), f64::from(count)))
    }
}

pub(super) fn color(sign: Sign) -> Color {
    match sign {
        Sign::Positive => Color::BLUE,
        Sign::Zero => Color::YELLOW,
        Sign::Negative => Color::VERMILION,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn signs_are_counted_and_drawn_where_they_are() {
        // The truth is positive but on the lower row; found is positive but at the left.
        let truth = |_, y| if y == 0 { Sign::Zero } else { Sign::Positive };
        let found = |x, _| {
            if x == 0 {
                Sign::Negative
            } else {
                Sign::Positive
            }
        };
        let map = SignMap::new(3, found, truth);
        assert_eq!((map.wrong, map.opposite, map.zero), (3 + 2, 2, 0));
        assert_eq!(map.image.pixels[3][..3], color(Sign::Negative).0);
        assert_eq!(map.image.pixels[4][..3], color(Sign::Positive).0);
    }
}
