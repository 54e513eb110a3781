//! Several views on one sheet, and samples to pixels.

use crate::camera::{Camera, Projected};
use crate::samples::{Bins, NOTHING, Placement, Plane, Samples};
use crate::shade::{Color, linear, pixel};
use crate::{Background, Error, Image, Options};
use rayon::prelude::*;
use std::ops::Range;

/// The share of a view that its scene may fill.
const FILL: f64 = 0.88;

/// The most samples along a side of a view: their coordinates, in fractions, multiply within `i64`.
const MOST_SAMPLES: u64 = 1 << 16;

/// Rows of pixels that are drawn by one thread at a time.
const BAND: usize = 24;

/// What can be drawn into a view.
pub trait Scene: Sync {
    /// The scene among the samples of a view.
    type Placed: Sync;
    /// Visits everything that the view must fit.
    fn project(&self, camera: &Camera, visit: &mut dyn FnMut(Projected));
    /// Finds where everything lies.
    fn place(&self, view: &View) -> Self::Placed;
    /// Puts what lies in a band into its samples.
    fn draw(&self, placed: &Self::Placed, band: usize, camera: &Camera, samples: &mut Samples<'_>);
    /// The colour of `what` at a place among the samples.
    fn shade(&self, view: &View, placed: &Self::Placed, what: u32, at: (f64, f64)) -> Color;
    /// How `what` shows.
    fn kind(&self, what: u32) -> Kind;
    /// Whether one thing has one colour everywhere in a view.
    fn is_uniform(&self) -> bool;
}

/// How a thing shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Takes light and shadow.
    Surface,
    /// Takes no shadow.
    Mark,
    /// Only hides what is behind it.
    Nothing,
}

/// One view: its camera, and where its picture plane lies among its samples.
pub struct View {
    /// Where the viewer stands.
    pub camera: Camera,
    /// From the picture plane to samples.
    pub placement: Placement,
    /// Samples along a pixel's side.
    pub samples_per_pixel: f64,
    /// Rows of samples.
    pub height: usize,
    /// Rows of samples in a band.
    pub band: usize,
}

impl View {
    /// Sorts things by the bands that their rows lie in.
    pub fn bins(&self, count: usize, rows: impl Fn(usize) -> Range<usize>) -> Bins {
        Bins::new(count, self.height, self.band, rows)
    }
}

/// The sheet divided: `columns` × `rows` cells of one size.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Layout {
    columns: usize,
    width: usize,
    height: usize,
}

/// Draws all views of a scene; `right` columns at the right stay free.
pub fn draw(scene: &impl Scene, options: &Options, right: u32) -> Result<Image, Error> {
    let layout = Layout::new(options, right)?;
    let samples = options.samples as usize;
    let cameras = options
        .views
        .iter()
        .map(|&view| Camera::new(view, options.up, options.projection))
        .collect::<Result<Vec<_>, _>>()?;
    let views = fit(scene, &cameras, layout, samples);

    let background = match options.background {
        Background::Opaque => Some(linear(options.palette.background)),
        Background::Transparent => None,
    };
    // Views do not know each other, nor do bands: any number of threads gives the same bytes.
    let cells: Vec<Vec<[u8; 4]>> = views
        .par_iter()
        .map(|view| {
            let mut plane = Plane::new(layout.width * samples, layout.height * samples);
            let placed = scene.place(view);
            plane.draw(view.band, |band, samples| {
                scene.draw(&placed, band, &view.camera, samples);
            });
            let shadow = Shadow::new(view, &mut plane, options.occlusion);
            let resolving = Resolving {
                scene,
                view,
                placed: &placed,
                plane: &plane,
                shadow: &shadow,
                samples,
                background,
            };
            resolving.pixels()
        })
        .collect();
    let fill = background.map_or([0; 4], pixel);
    Ok(layout.assemble(options, &cells, fill))
}

impl Layout {
    fn new(options: &Options, right: u32) -> Result<Self, Error> {
        let count = options.views.len();
        if count == 0 {
            return Err(Error::NoView);
        }
        let sheet = options.width.saturating_sub(right) as usize;
        // The number of columns that leaves a cell's shorter side longest; the fewest of those.
        let shorter_side = |columns: usize| {
            let (width, height) = (sheet, options.height as usize);
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
            width: sheet / columns,
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
            height: layout.height * samples,
            band: BAND * samples,
        })
        .collect()
}

/// How far around a sample to look for what darkens it.
struct Shadow {
    /// In samples; empty where nothing is darkened.
    reaches: Vec<usize>,
    strength: f64,
    /// Length of a sample in the ball's units.
    step: f64,
}

impl Shadow {
    /// Also makes the nearness of each sample its height.
    fn new(view: &View, plane: &mut Plane, occlusion: f64) -> Self {
        if occlusion.is_nan() || occlusion <= 0.0 {
            return Self {
                reaches: Vec::new(),
                strength: 0.0,
                step: 1.0,
            };
        }
        let side = plane.width.min(plane.height) as f64;
        let pixel = view.samples_per_pixel;
        let reaches = [
            2.0 * pixel,
            (side * 0.012).max(4.0 * pixel),
            (side * 0.04).max(8.0 * pixel),
        ];
        plane.nearness.par_chunks_mut(1 << 14).for_each(|chunk| {
            for nearness in chunk {
                if *nearness != f32::NEG_INFINITY {
                    *nearness = view.camera.height(f64::from(*nearness)) as f32;
                }
            }
        });
        Self {
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
    fn kept(&self, plane: &Plane, column: usize, row: usize) -> f64 {
        let (width, height) = (plane.width, plane.height);
        let place = row * width + column;
        let own = f64::from(plane.nearness[place]);
        let mut sum = 0.0;
        for &reach in &self.reaches {
            let span = reach as f64 * self.step;
            // Whether there are samples so far to the left and the right, and above and below.
            let wide = column >= reach && column + reach < width;
            let high = row >= reach && row + reach < height;
            let (right, down) = (reach, reach * width);
            let pairs = [
                (wide, right),
                (high, down),
                (wide && high, down + right),
                (wide && high, down.wrapping_sub(right)),
            ];
            for (_, offset) in pairs.into_iter().filter(|(inside, _)| *inside) {
                let a = f64::from(plane.nearness[place + offset]);
                let b = f64::from(plane.nearness[place - offset]);
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
struct Resolving<'a, S: Scene> {
    scene: &'a S,
    view: &'a View,
    placed: &'a S::Placed,
    plane: &'a Plane,
    shadow: &'a Shadow,
    /// Along a pixel's side.
    samples: usize,
    /// None where it is transparent.
    background: Option<Color>,
}

/// The samples of a pixel that show one thing.
struct Share {
    what: u32,
    count: usize,
    /// The sums of their columns and rows.
    column: usize,
    row: usize,
    /// The first of them.
    first: (usize, usize),
}

impl<S: Scene> Resolving<'_, S> {
    fn pixels(&self) -> Vec<[u8; 4]> {
        let width = self.plane.width / self.samples;
        let mut pixels = vec![[0; 4]; width * (self.plane.height / self.samples)];
        let empty = self.background.map_or([0; 4], pixel);
        let rows = pixels.par_chunks_mut(width).enumerate();
        rows.for_each_init(Vec::new, |shares, (y, row)| {
            let mut last = (NOTHING, Color::ZERO);
            for (x, pixel) in row.iter_mut().enumerate() {
                if self.is_empty(x, y) {
                    *pixel = empty;
                    continue;
                }
                self.gather(x, y, shares);
                *pixel = self.resolve(shares, &mut last);
            }
        });
        pixels
    }

    /// Whether no sample of a pixel shows anything.
    fn is_empty(&self, x: usize, y: usize) -> bool {
        let mut rows = y * self.samples..(y + 1) * self.samples;
        rows.all(|row| {
            let start = row * self.plane.width + x * self.samples;
            let line = &self.plane.what[start..start + self.samples];
            line.iter().all(|&what| what == NOTHING)
        })
    }

    /// What the samples of a pixel show.
    fn gather(&self, x: usize, y: usize, shares: &mut Vec<Share>) {
        shares.clear();
        for row in y * self.samples..(y + 1) * self.samples {
            let start = row * self.plane.width + x * self.samples;
            let line = &self.plane.what[start..start + self.samples];
            for (column, &what) in (x * self.samples..).zip(line) {
                match shares.iter_mut().find(|share| share.what == what) {
                    Some(share) => {
                        share.count += 1;
                        share.column += column;
                        share.row += row;
                    }
                    None => shares.push(Share {
                        what,
                        count: 1,
                        column,
                        row,
                        first: (column, row),
                    }),
                }
            }
        }
    }

    /// The mean of a pixel's colours, each taken in the middle of its samples.
    fn resolve(&self, shares: &[Share], last: &mut (u32, Color)) -> [u8; 4] {
        let (mut sum, mut covered) = (Color::ZERO, 0);
        for share in shares {
            let kind = match share.what {
                NOTHING => Kind::Nothing,
                what => self.scene.kind(what),
            };
            if kind == Kind::Nothing {
                continue;
            }
            if share.what != last.0 || !self.scene.is_uniform() {
                let count = share.count as f64;
                let middle = |sum: usize| sum as f64 / count + 0.5;
                let at = (middle(share.column), middle(share.row));
                let color = self.scene.shade(self.view, self.placed, share.what, at);
                *last = (share.what, color);
            }
            let mut lit = last.1;
            if kind == Kind::Surface && !self.shadow.reaches.is_empty() {
                lit *= self.shadow.kept(self.plane, share.first.0, share.first.1);
            }
            sum += lit * share.count as f64;
            covered += share.count;
        }
        let all = self.samples * self.samples;
        match self.background {
            Some(background) => pixel((sum + background * (all - covered) as f64) / all as f64),
            None if covered == 0 => [0; 4],
            None => {
                let [red, green, blue, _] = pixel(sum / covered as f64);
                let opacity = (covered * 255 + all / 2) / all;
                [red, green, blue, opacity as u8]
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::View as Side;

    fn layout(views: usize, width: u32, height: u32) -> Result<Layout, Error> {
        Layout::new(
            &Options {
                width,
                height,
                views: vec![Side::Front; views],
                ..Options::default()
            },
            0,
        )
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
