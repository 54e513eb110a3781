//! Light: colours are linear here, from 0 to 1, and become sRGB only as pixels.

use pellicle_geometry::DVec3;

/// Red, green and blue in linear light.
pub type Color = DVec3;

/// The square stands for sRGB's curve: within a few hundredths of it, and the square root is exactly rounded.
pub fn linear([red, green, blue]: [u8; 3]) -> Color {
    let one = |byte: u8| {
        let share = f64::from(byte) / 255.0;
        share * share
    };
    DVec3::new(one(red), one(green), one(blue))
}

/// The pixel of a colour.
pub fn pixel(color: Color) -> [u8; 4] {
    let one = |share: f64| (share.clamp(0.0, 1.0).sqrt() * 255.0 + 0.5) as u8;
    [one(color.x), one(color.y), one(color.z), 255]
}

/// A matt surface with a faint gloss, lit from the upper left of the viewer, from the right, and by the sky.
///
/// `normal` is of length one in the viewer's frame (x right, y up, z towards the viewer) and faces the viewer.
pub fn lit(surface: Color, normal: DVec3) -> Color {
    // Unit vectors towards the lights.
    const KEY: DVec3 = DVec3::new(-0.48, 0.64, 0.6);
    const FILL: DVec3 = DVec3::new(0.8, 0.0, 0.6);
    const SKY_COLOR: Color = DVec3::new(0.33, 0.35, 0.39);
    const GROUND_COLOR: Color = DVec3::new(0.15, 0.14, 0.13);
    const KEY_COLOR: Color = DVec3::new(0.98, 0.95, 0.90);
    const FILL_COLOR: Color = DVec3::new(0.20, 0.21, 0.23);

    let sky = 0.5 + 0.5 * normal.y;
    let ambient = GROUND_COLOR + (SKY_COLOR - GROUND_COLOR) * sky;
    // Wrapped a little around the edge, so that the shadow side keeps its shape.
    let key = ((normal.dot(KEY) + 0.2) / 1.2).max(0.0);
    let fill = normal.dot(FILL).max(0.0);
    let light = ambient + KEY_COLOR * (key * key.sqrt()) + FILL_COLOR * fill;

    // Blinn's half vector between the key light and the viewer; the 32nd power by squaring.
    let half = (KEY + DVec3::Z) / (KEY + DVec3::Z).length();
    let mut gloss = normal.dot(half).max(0.0);
    for _ in 0..5 {
        gloss *= gloss;
    }
    surface * light + DVec3::splat(0.06 * gloss)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_survive() {
        for byte in 0..=255 {
            assert_eq!(pixel(linear([byte; 3])), [byte, byte, byte, 255]);
        }
    }

    #[test]
    fn the_key_light_is_at_the_upper_left() {
        let white = DVec3::ONE;
        let toward = |x: f64, y: f64| lit(white, DVec3::new(x, y, 0.6)).x;
        assert!(toward(-0.48, 0.64) > toward(0.48, 0.64));
        assert!(toward(-0.48, 0.64) > toward(-0.48, -0.64));
        assert!(lit(white, DVec3::new(0.0, -1.0, 0.0)).min_element() > 0.05);
    }
}
