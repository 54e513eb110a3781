//! Pictures as PNG: of a sheet, by `resvg` with the DejaVu fonts, and of an image in memory.

use crate::Error;
use image::{
    ExtendedColorType, ImageEncoder,
    codecs::png::{CompressionType, FilterType, PngEncoder},
};
use pellicle::render::Image;
use resvg::{tiny_skia, usvg};
use std::sync::{Arc, LazyLock};

/// Pixels in a row of a picture, at most.
const WIDEST: f32 = 1280.0;

/// Pixels to a unit of the sheet, at most.
const FINEST: f32 = 1.6;

/// The same fonts on every machine.
static FONTS: LazyLock<Arc<usvg::fontdb::Database>> = LazyLock::new(|| {
    let mut fonts = usvg::fontdb::Database::new();
    for font in [
        dejavu::sans::regular(),
        dejavu::sans::bold(),
        dejavu::sans::oblique(),
        dejavu::sans_mono::regular(),
    ] {
        fonts.load_font_data(font.to_vec());
    }
    fonts.set_sans_serif_family("DejaVu Sans");
    fonts.set_monospace_family("DejaVu Sans Mono");
    Arc::new(fonts)
});

/// Draws an SVG document: 1.6 pixels a unit, or fewer if the picture were wider than 1280 pixels.
pub fn png(svg: &str) -> Result<Vec<u8>, Error> {
    let options = usvg::Options {
        fontdb: Arc::clone(&FONTS),
        ..usvg::Options::default()
    };
    let tree =
        usvg::Tree::from_str(svg, &options).map_err(|error| Error::Svg(error.to_string()))?;
    let size = tree.size();
    let scale = (WIDEST / size.width()).min(FINEST);
    let [width, height] =
        [size.width(), size.height()].map(|length| (length * scale).round().max(1.0) as u32);
    let mut pixels = tiny_skia::Pixmap::new(width, height)
        .ok_or_else(|| Error::Svg(format!("{width} × {height} pixels")))?;
    // The last row and column may be covered in part only.
    pixels.fill(tiny_skia::Color::WHITE);
    let transform = tiny_skia::Transform::from_scale(scale, scale);
    resvg::render(&tree, transform, &mut pixels.as_mut());
    // Sheets are opaque.
    let rgb: Vec<u8> = pixels
        .pixels()
        .iter()
        .flat_map(|pixel| [pixel.red(), pixel.green(), pixel.blue()])
        .collect();
    encode(&rgb, width, height, ExtendedColorType::Rgb8)
}

/// Encodes an image; without its opacity when all of it is opaque.
pub fn png_of_image(image: &Image) -> Result<Vec<u8>, Error> {
    if image.pixels.iter().all(|pixel| pixel[3] == 255) {
        let rgb: Vec<u8> = image
            .pixels
            .iter()
            .flat_map(|&[red, green, blue, _]| [red, green, blue])
            .collect();
        return encode(&rgb, image.width, image.height, ExtendedColorType::Rgb8);
    }
    let rgba = image.pixels.as_flattened();
    encode(rgba, image.width, image.height, ExtendedColorType::Rgba8)
}

fn encode(
    bytes: &[u8],
    width: u32,
    height: u32,
    color: ExtendedColorType,
) -> Result<Vec<u8>, Error> {
    let channels = usize::from(color.bits_per_pixel() / 8);
    if bytes.len() != width as usize * height as usize * channels {
        let reason = format!("{} bytes", bytes.len());
        return Err(Error::Png {
            width,
            height,
            reason,
        });
    }
    let mut encoded = Vec::new();
    PngEncoder::new_with_quality(&mut encoded, CompressionType::Best, FilterType::Adaptive)
        .write_image(bytes, width, height, color)
        .map_err(|error| Error::Png {
            width,
            height,
            reason: error.to_string(),
        })?;
    Ok(encoded)
}
