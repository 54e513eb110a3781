//! Colours for values.

use crate::shade::pixel;
use pellicle_geometry::DVec3;

/// From a share of a range to a colour. Both maps change evenly to the eye, and read the same to those who do not tell
/// red from green.
///
/// ```
/// use pellicle_render::ColorMap;
/// assert_eq!(ColorMap::Viridis.color(0.0), [0x44, 0x01, 0x54]);
/// assert_eq!(ColorMap::Viridis.color(2.0), ColorMap::Viridis.color(1.0));
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ColorMap {
    /// From dark violet over green to yellow: for what grows. The table of Smith and van der Walt 2015, under
    /// CC0.
    #[default]
    Viridis,
    /// From blue over white to orange, as dark at both ends: for what has two sides, with zero in the middle. Straight
    /// lines in the space of Ottosson 2020.
    Diverging,
}

/// 256 colours of six digits each.
const VIRIDIS: &[u8] = b"\
    44015444025645045745055946075a46085c460a5d460b5e470d60470e61471063471164471365481467481668481769\
    48186a481a6c481b6d481c6e481d6f481f70482071482173482374482475482576482677482878482979472a7a472c7a\
    472d7b472e7c472f7d46307e46327e46337f463480453581453781453882443983443a83443b84433d84433e85423f85\
    4240864241864142874144874045884046883f47883f48893e49893e4a893e4c8a3d4d8a3d4e8a3c4f8a3c508b3b518b\
    3b528b3a538b3a548c39558c39568c38588c38598c375a8c375b8d365c8d365d8d355e8d355f8d34608d34618d33628d\
    33638d32648e32658e31668e31678e31688e30698e306a8e2f6b8e2f6c8e2e6d8e2e6e8e2e6f8e2d708e2d718e2c718e\
    2c728e2c738e2b748e2b758e2a768e2a778e2a788e29798e297a8e297b8e287c8e287d8e277e8e277f8e27808e26818e\
    26828e26828e25838e25848e25858e24868e24878e23888e23898e238a8d228b8d228c8d228d8d218e8d218f8d21908d\
    21918c20928c20928c20938c1f948c1f958b1f968b1f978b1f988b1f998a1f9a8a1e9b8a1e9c891e9d891f9e891f9f88\
    1fa0881fa1881fa1871fa28720a38620a48621a58521a68522a78522a88423a98324aa8325ab8225ac8226ad8127ad81\
    28ae8029af7f2ab07f2cb17e2db27d2eb37c2fb47c31b57b32b67a34b67935b77937b87838b9773aba763bbb753dbc74\
    3fbc7340bd7242be7144bf7046c06f48c16e4ac16d4cc26c4ec36b50c46a52c56954c56856c66758c7655ac8645cc863\
    5ec96260ca6063cb5f65cb5e67cc5c69cd5b6ccd5a6ece5870cf5773d05675d05477d1537ad1517cd2507fd34e81d34d\
    84d44b86d54989d5488bd6468ed64590d74393d74195d84098d83e9bd93c9dd93ba0da39a2da37a5db36a8db34aadc32\
    addc30b0dd2fb2dd2db5de2bb8de29bade28bddf26c0df25c2df23c5e021c8e020cae11fcde11dd0e11cd2e21bd5e21a\
    d8e219dae319dde318dfe318e2e418e5e419e7e419eae51aece51befe51cf1e51df4e61ef6e620f8e621fbe723fde725";

impl ColorMap {
    /// The colour in sRGB at a share from 0 to 1; what lies outside has the colour of the nearer end, NaN that of 0.
    pub fn color(self, share: f64) -> [u8; 3] {
        let share = if share.is_nan() { 0.0 } else { share };
        let share = share.clamp(0.0, 1.0);
        match self {
            Self::Viridis => {
                let entry = (share * 255.0 + 0.5) as usize;
                std::array::from_fn(|i| {
                    let digit = |at: usize| match VIRIDIS[6 * entry + 2 * i + at] {
                        letter @ b'a'..=b'f' => letter - b'a' + 10,
                        digit => digit - b'0',
                    };
                    16 * digit(0) + digit(1)
                })
            }
            Self::Diverging => {
                let [red, green, blue, _] = pixel(diverging(share));
                [red, green, blue]
            }
        }
    }
}

/// Linear red, green and blue.
fn diverging(share: f64) -> DVec3 {
    // Lightness, green to red, blue to yellow.
    const BLUE: DVec3 = DVec3::new(0.5, -0.035, -0.135);
    const WHITE: DVec3 = DVec3::new(0.95, 0.0, 0.0);
    const ORANGE: DVec3 = DVec3::new(0.5, 0.09, 0.095);
    let side = 2.0 * share - 1.0;
    let end = if side < 0.0 { BLUE } else { ORANGE };
    let Lab { x: l, y: a, z: b } = WHITE + (end - WHITE) * side.abs();
    let cube = |v: f64| v * v * v;
    let long = cube(l + 0.396_337_777_4 * a + 0.215_803_757_3 * b);
    let middle = cube(l - 0.105_561_345_8 * a - 0.063_854_172_8 * b);
    let short = cube(l - 0.089_484_177_5 * a - 1.291_485_548 * b);
    DVec3::new(
        4.076_741_662_1 * long - 3.307_711_591_3 * middle + 0.230_969_929_2 * short,
        -1.268_438_004_6 * long + 2.609_757_401_1 * middle - 0.341_319_396_5 * short,
        -0.004_196_086_3 * long - 0.703_418_614_7 * middle + 1.707_614_701 * short,
    )
}

type Lab = DVec3;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_is_whole() {
        assert_eq!(VIRIDIS.len(), 256 * 6);
        assert!(VIRIDIS.iter().all(u8::is_ascii_hexdigit));
        assert_eq!(ColorMap::Viridis.color(0.5), [0x21, 0x91, 0x8c]);
        assert_eq!(ColorMap::Viridis.color(1.0), [0xfd, 0xe7, 0x25]);
    }

    #[test]
    fn lightness_tells_the_value() {
        let light = |color: [u8; 3]| {
            let [r, g, b] = color.map(f64::from);
            0.2126 * r * r + 0.7152 * g * g + 0.0722 * b * b
        };
        for step in 0..100 {
            let (a, b) = (f64::from(step) / 100.0, f64::from(step + 1) / 100.0);
            let [low, high] = [a, b].map(|share| light(ColorMap::Viridis.color(share)));
            assert!(low < high, "{a}");
            let [low, high] = [a, b].map(|share| light(ColorMap::Diverging.color(share)));
            assert_eq!(low < high, step < 50, "{a}");
        }
    }

    #[test]
    fn nothing_is_cut_off() {
        for step in 0..=200 {
            let color = diverging(f64::from(step) / 200.0);
            assert!(
                color.min_element() >= 0.0 && color.max_element() <= 1.0,
                "{step}: {color}"
            );
        }
    }

    #[test]
    fn any_number_has_a_colour() {
        for map in [ColorMap::Viridis, ColorMap::Diverging] {
            assert_eq!(map.color(f64::NAN), map.color(0.0));
            assert_eq!(map.color(f64::INFINITY), map.color(1.0));
            assert_eq!(map.color(-1.0), map.color(0.0));
        }
    }
}
