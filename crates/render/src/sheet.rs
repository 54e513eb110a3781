//! Several views on one sheet, and samples to pixels.

use crate::camera::{Camera, Projected};
use crate::samples::{NOTHING, Placement, Samples};
use crate::shade::{Color, linear, pixel};
use crate::{Error, Image, Options};
use rayon::prelude::*;

/// The share of a view that its scene may fill.
const FILL: f64 = 0.88;

/// The most samples along a side of a view: their coordinates, in fractions, multiply within `i64`.
const MOST_SAMPLES: u64 = 1 << 16;

/// What can be drawn into a view.
pub trait Scene: Sync {
    /// Visits everything that the view must fit.
    fn project(&self, camera: &Camera, visit: &mut dyn FnMut(Projected));
    /// Puts everything into the samples.
    fn draw(&self, view: &View, samples: &mut Samples);
    /// The colour of `what` at a place among the samples.
    fn shade(&self, view: &View, what: u32, at: (f64, f64)) -> Color;
    /// Whether `what` is a mark on the scene, which takes no shadow.
    fn is_mark(&self, what: u32) -> bool;
    /// Whether one thing has one colour everywhere in a view.
    fn is_uniform(&self) -> bool;
}

/// One view: its camera, and where its picture plane lies among its samples.
pub struct View {
    /// Where the viewer stands.
    pub camera: Camera,
    /// From the picture plane to samples.
    pub placement: Placement,
    /// Samples along a pixel's side.
    pub samples_per_pixel: f64,
}

/// The sheet divided: `columns` × `rows` cells of one size.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Layout {
    columns: usize,
    width: usize,
    height: usize,
}

/// Draws all views of a scene.
pub fn draw(scene: &impl Scene, options: &Options) -> Result<Image, Error> {
    let layout = Layout::new(options)?;
    let samples = options.samples as usize;
    let cameras = options
        .views
        .iter()
        .map(|&view| Camera::new(view, options.up, options.projection))
        .collect::<Result<Vec<_>, _>>()?;
    let views = fit(scene, &cameras, layout, samples);

    let background = linear(options.palette.background);
    // Views do not know each other: any number of threads gives the same bytes.
    let cells: Vec<Vec<[u8; 4]>> = views
        .par_iter()
        .map(|view| {
            let mut drawn = Samples::new(layout.width * samples, layout.height * samples);
            scene.draw(view, &mut drawn);
            let shadow = Shadow::new(view, &drawn, options.occlusion);
            resolve(scene, view, &drawn, &shadow, samples, background)
        })
        .collect();
    Ok(layout.assemble(options, &cells, pixel(background)))
}

impl Layout {
    fn new(options: &Options) -> Result<Self, Error> {
        let count = options.views.len();
        if count == 0 {
            return Err(Error::NoView);
        }
        // The number of columns that leaves a cell's shorter side longest; the fewest of those.
        let shorter_side = |columns: usize| {
            let (width, height) = (options.width as usize, options.height as usize);
            (width / columns).min(height / count.div_ceil(columns))
        };
        let columns = (2..=count).fold(1, |best, columns| {
            if shorter_side(columns) > shorter_side(best) {
                columns
            } else {
                best
            }
        });
        let rows = count.div_ceil(columns);
        let layout = Self {
            columns,
            width: options.width as usize / columns,
            height: options.height as usize / rows,
        };
        let fits = |pixels: usize| {
            let samples = pixels as u64 * u64::from(options.samples);
            (1..=MOST_SAMPLES).contains(&samples)
        };
        if fits(layout.width) && fits(layout.height) {
            Ok(layout)
        } else {
            Err(Error::Size {
                width: options.width,
                height: options.height,
                views: count,
                samples: options.samples,
            })
        }
    }

    /// The cells side by side; what the division leaves over is filled with the background.
    fn assemble(&self, options: &Options, cells: &[Vec<[u8; 4]>], fill: [u8; 4]) -> Image {
        let width = options.width as usize;
        let mut pixels = vec![fill; width * options.height as usize];
        for (index, cell) in cells.iter().enumerate() {
            let (row, column) = (index / self.columns, index % self.columns);
            for (line, source) in cell.chunks_exact(self.width).enumerate() {
                let start = (row * self.height + line) * width + column * self.width;
                pixels[start..start + self.width].copy_from_slice(source);
            }
        }
        Image {
            width: options.width,
            height: options.height,
            pixels,
        }
    }
}

/// The views, each centred in its cell, all at the largest scale that fits every one.
fn fit(scene: &impl Scene, cameras: &[Camera], layout: Layout, samples: usize) -> Vec<View> {
    // Least and greatest x and y of each view.
    let boxes: Vec<[f64; 4]> = cameras
        .par_iter()
        .map(|camera| {
            let mut bounds = [
                f64::INFINITY,
                f64::NEG_INFINITY,
                f64::INFINITY,
                f64::NEG_INFINITY,
            ];
            scene.project(camera, &mut |p| {
                bounds[0] = bounds[0].min(p.x);
                bounds[1] = bounds[1].max(p.x);
                bounds[2] = bounds[2].min(p.y);
                bounds[3] = bounds[3].max(p.y);
            });
            if bounds[0] <= bounds[1] {
                bounds
            } else {
                [0.0; 4]
            }
        })
        .collect();
    let (width, height) = (
        (layout.width * samples) as f64,
        (layout.height * samples) as f64,
    );
    let scale = boxes
        .iter()
        .flat_map(|[left, right, bottom, top]| {
            // A point alone, or a line seen along itself, wants no scale of its own.
            [
                width / (right - left).max(0.1),
                height / (top - bottom).max(0.1),
            ]
        })
        .fold(f64::INFINITY, f64::min)
        * FILL;
    cameras
        .iter()
        .zip(&boxes)
        .map(|(&camera, [left, right, bottom, top])| View {
            camera,
            placement: Placement {
                scale,
                origin_x: 0.5 * width - 0.5 * (left + right) * scale,
                origin_y: 0.5 * height + 0.5 * (bottom + top) * scale,
            },
            samples_per_pixel: samples as f64,
        })
        .collect()
}

/// Heights of the samples, and how far around one to look for what darkens it.
struct Shadow {
    heights: Vec<f32>,
    /// In samples; empty where nothing is darkened.
    reaches: Vec<usize>,
    strength: f64,
    /// Length of a sample in the ball's units.
    step: f64,
}

impl Shadow {
    fn new(view: &View, samples: &Samples, occlusion: f64) -> Self {
        if occlusion.is_nan() || occlusion <= 0.0 {
            return Self {
                heights: Vec::new(),
                reaches: Vec::new(),
                strength: 0.0,
                step: 1.0,
            };
        }
        let side = samples.width.min(samples.height) as f64;
        let pixel = view.samples_per_pixel;
        let reaches = [
            2.0 * pixel,
            (side * 0.012).max(4.0 * pixel),
            (side * 0.04).max(8.0 * pixel),
        ];
        let height = |&nearness: &f32| match nearness {
            f32::NEG_INFINITY => f32::NEG_INFINITY,
            _ => view.camera.height(f64::from(nearness)) as f32,
        };
        Self {
            heights: samples.nearness.iter().map(height).collect(),
            reaches: reaches.map(|reach| reach as usize).to_vec(),
            strength: occlusion,
            step: 1.0 / view.placement.scale,
        }
    }

    /// The share of light that a sample keeps.
    ///
    /// ```text
    ///    a           b      On both sides of the sample, at some distance: where the mean of a and b
    ///     \    s    /       lies above s, s lies in a crease. A slope has a mean of its own height.
    ///      `-..|..-'        A gap far deeper than wide is not a crease but an outline, and fades out.
    /// ```
    fn kept(&self, width: usize, height: usize, column: usize, row: usize) -> f64 {
        let own = f64::from(self.heights[row * width + column]);
        let mut sum = 0.0;
        for &reach in &self.reaches {
            let span = reach as f64 * self.step;
            for (dx, dy) in [(1, 0), (0, 1), (1, 1), (1, -1)] {
                let at = |sign: isize| {
                    let x = column as isize + sign * dx * reach as isize;
                    let y = row as isize + sign * dy * reach as isize;
                    let inside =
                        (0..width as isize).contains(&x) && (0..height as isize).contains(&y);
                    inside.then(|| f64::from(self.heights[y as usize * width + x as usize]))
                };
                let (Some(a), Some(b)) = (at(1), at(-1)) else {
                    continue;
                };
                let depth = ((a + b) * 0.5 - own) / span;
                if depth > 0.0 {
                    sum += depth / (1.0 + depth * depth);
                }
            }
        }
        1.0 / (1.0 + 0.5 * self.strength * sum)
    }
}

/// Samples to pixels: the mean in linear light.
fn resolve(
    scene: &impl Scene,
    view: &View,
    drawn: &Samples,
    shadow: &Shadow,
    samples: usize,
    background: Color,
) -> Vec<[u8; 4]> {
    let (width, height) = (drawn.width / samples, drawn.height / samples);
    let mut last = (NOTHING, Color::ZERO);
    let mut pixels = Vec::with_capacity(width * height);
    for y in 0..height {
        for x in 0..width {
            let mut sum = Color::ZERO;
            for sub in 0..samples * samples {
                let (column, row) = (x * samples + sub % samples, y * samples + sub / samples);
                let what = drawn.what[row * drawn.width + column];
                if what == NOTHING {
                    sum += background;
                    continue;
                }
                if what != last.0 || !scene.is_uniform() {
                    let at = (column as f64 + 0.5, row as f64 + 0.5);
                    last = (what, scene.shade(view, what, at));
                }
                let lit = if shadow.reaches.is_empty() || scene.is_mark(what) {
                    last.1
                } else {
                    last.1 * shadow.kept(drawn.width, drawn.height, column, row)
                };
                sum += lit;
            }
            pixels.push(pixel(sum / (samples * samples) as f64));
        }
    }
    pixels
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::View as Side;

    fn layout(views: usize, width: u32, height: u32) -> Result<Layout, Error> {
        Layout::new(&Options {
            width,
            height,
            views: vec![Side::Front; views],
            ..Options::default()
        })
    }

    #[test]
    fn cells_are_as_large_as_the_sheet_allows() {
        for (views, sheet, columns, width, height) in [
            (1, (90, 60), 1, 90, 60),
            (2, (90, 60), 2, 45, 60),
            (4, (90, 60), 2, 45, 30),
            (5, (90, 60), 3, 30, 30),
            (3, (90, 30), 3, 30, 30),
            (3, (30, 90), 1, 30, 30),
        ] {
            let found = layout(views, sheet.0, sheet.1).unwrap();
            assert_eq!(
                (found.columns, found.width, found.height),
                (columns, width, height)
            );
        }
    }

    #[test]
    fn impossible_sheets_are_refused() {
        assert!(matches!(layout(0, 90, 60), Err(Error::NoView)));
        for (views, width, height) in [(4, 1, 3), (1, 0, 0), (1, u32::MAX, 60)] {
            assert!(matches!(
                layout(views, width, height),
                Err(Error::Size { .. })
            ));
        }
    }
}
