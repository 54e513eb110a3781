//! Several images side by side.

use crate::{Error, Image};

/// Images of one size in rows of `columns`, from the top left. Linear time.
///
/// There is at least one column, and none without an image; what the last row leaves free has the colour of the first
/// image's top left pixel, which is its background.
///
/// ```
/// use pellicle_render::{Image, strip};
///
/// let plain = |grey| Image { width: 2, height: 1, pixels: vec![[grey, grey, grey, 255]; 2] };
/// let frames = [plain(0), plain(100), plain(200)];
/// let row = strip(&frames, 3)?;
/// assert_eq!((row.width, row.height), (6, 1));
/// let grid = strip(&frames, 2)?;
/// assert_eq!((grid.width, grid.height, grid.pixels[4][0]), (4, 2, 200));
/// # Ok::<(), pellicle_render::Error>(())
/// ```
pub fn strip(images: &[Image], columns: usize) -> Result<Image, Error> {
    let first = images.first().ok_or(Error::NoImage)?;
    let background = *first.pixels.first().ok_or(Error::NoImage)?;
    for (index, image) in images.iter().enumerate() {
        let expected = u64::from(image.width) * u64::from(image.height);
        let same = (image.width, image.height) == (first.width, first.height);
        if !same || image.pixels.len() as u64 != expected {
            return Err(Error::UnequalImages {
                image: index,
                width: image.width,
                height: image.height,
                pixels: image.pixels.len(),
                first: (first.width, first.height),
            });
        }
    }
    let columns = columns.clamp(1, images.len());
    let rows = images.len().div_ceil(columns);
    let side = |count: usize, pixels: u32| u32::try_from(count).ok()?.checked_mul(pixels);
    let size = side(columns, first.width).zip(side(rows, first.height));
    let (width, height) = size.ok_or(Error::StripSize {
        columns,
        rows,
        size: (first.width, first.height),
    })?;

    let mut pixels = Vec::with_capacity(width as usize * height as usize);
    let line = first.width as usize;
    for row in images.chunks(columns) {
        for y in 0..first.height as usize {
            for image in row {
                pixels.extend_from_slice(&image.pixels[y * line..(y + 1) * line]);
            }
            let free = (columns - row.len()) * line;
            pixels.extend(std::iter::repeat_n(background, free));
        }
    }
    Ok(Image {
        width,
        height,
        pixels,
    })
}
