//! What each sample of a view shows, and how near it is.

use crate::camera::Projected;
use rayon::prelude::*;
use std::ops::Range;

/// The id of a sample that shows nothing.
pub const NOTHING: u32 = u32::MAX;

/// Fractions of a sample that a triangle's corner can lie on: corners are integers from here on, so that two
/// triangles with a common edge agree exactly on which side of it a sample lies.
const FRACTIONS: f64 = 256.0;

/// The samples of one view, rows from the top.
pub struct Plane {
    /// Samples in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// How near what the sample shows is; larger is nearer.
    pub nearness: Vec<f32>,
    /// The triangle, point or mark that it shows.
    pub what: Vec<u32>,
}

impl Plane {
    /// Nothing everywhere.
    pub fn new(width: usize, height: usize) -> Self {
        Self {
            width,
            height,
            nearness: vec![f32::NEG_INFINITY; width * height],
            what: vec![NOTHING; width * height],
        }
    }

    /// Draws bands of so many rows, each apart: what a sample shows does not depend on the bands.
    pub fn draw(&mut self, rows: usize, draw: impl Fn(usize, &mut Samples<'_>) + Sync) {
        let (width, length) = (self.width, self.width * rows);
        let bands = self.nearness.par_chunks_mut(length);
        let bands = bands.zip(self.what.par_chunks_mut(length)).enumerate();
        bands.for_each(|(band, (nearness, what))| {
            let first = band * rows;
            let mut samples = Samples {
                width,
                rows: first..first + what.len() / width,
                nearness,
                what,
            };
            draw(band, &mut samples);
        });
    }
}

/// A band of rows, being drawn.
pub struct Samples<'a> {
    width: usize,
    rows: Range<usize>,
    nearness: &'a mut [f32],
    what: &'a mut [u32],
}

/// Which things lie in which band, in their order.
#[derive(Debug, Default)]
pub struct Bins {
    /// Where the things of each band start, and where the last end.
    starts: Vec<usize>,
    things: Vec<u32>,
}

impl Bins {
    /// Sorts `count` things, the rows of each given, by bands of `band` rows of `height`. Linear time.
    pub fn new(
        count: usize,
        height: usize,
        band: usize,
        rows: impl Fn(usize) -> Range<usize>,
    ) -> Self {
        let bands = |thing: usize| {
            let Range { start, end } = rows(thing);
            let end = end.min(height);
            start / band..if start < end {
                end.div_ceil(band)
            } else {
                start / band
            }
        };
        let mut starts = vec![0; height.div_ceil(band) + 1];
        for thing in 0..count {
            for band in bands(thing) {
                starts[band + 1] += 1;
            }
        }
        for band in 1..starts.len() {
            starts[band] += starts[band - 1];
        }
        let mut things = vec![0; starts[starts.len() - 1]];
        let mut next = starts.clone();
        for thing in 0..count {
            for band in bands(thing) {
                things[next[band]] = thing as u32;
                next[band] += 1;
            }
        }
        Self { starts, things }
    }

    /// The things of a band, ascending.
    pub fn of(&self, band: usize) -> impl Iterator<Item = usize> {
        let things = &self.things[self.starts[band]..self.starts[band + 1]];
        things.iter().map(|&thing| thing as usize)
    }
}

/// A corner in the samples' frame: x to the right, y *down*, the first sample's centre at (½, ½).
#[derive(Clone, Copy, Debug, Default)]
pub struct Corner {
    /// In [`FRACTIONS`] of a sample.
    x: i64,
    /// In [`FRACTIONS`] of a sample.
    y: i64,
    /// As of its point.
    pub nearness: f64,
}

impl Corner {
    /// Where it lies from a place among the samples.
    pub fn offset(&self, at: (f64, f64)) -> (f64, f64) {
        (
            self.x as f64 / FRACTIONS - at.0,
            self.y as f64 / FRACTIONS - at.1,
        )
    }
}

/// From the picture plane to samples: one scale, and where the plane's origin lies.
#[derive(Clone, Copy, Debug)]
pub struct Placement {
    /// Samples per unit.
    pub scale: f64,
    /// The origin's place, to the right.
    pub origin_x: f64,
    /// The origin's place, down.
    pub origin_y: f64,
}

impl Placement {
    /// Where a point of the picture plane lies among the samples; y points down.
    pub fn place(&self, p: Projected) -> (f64, f64) {
        (
            self.origin_x + p.x * self.scale,
            self.origin_y - p.y * self.scale,
        )
    }

    /// The same as integers.
    pub fn corner(&self, p: Projected) -> Corner {
        let (x, y) = self.place(p);
        // Saturates for what lies far outside, which is never drawn.
        let fixed = |v: f64| (v * FRACTIONS + 0.5).floor().clamp(-1e9, 1e9) as i64;
        Corner {
            x: fixed(x),
            y: fixed(y),
            nearness: p.nearness,
        }
    }
}

impl Samples<'_> {
    /// Shows `what` at a sample unless something as near is there already.
    #[inline]
    pub fn put(&mut self, at: usize, nearness: f32, what: u32) {
        if nearness > self.nearness[at] {
            self.nearness[at] = nearness;
            self.what[at] = what;
        }
    }

    /// Fills a triangle, from whichever side it is seen. One seen edge-on covers no sample.
    pub fn triangle(&mut self, [a, mut b, mut c]: [Corner; 3], what: u32) {
        let mut area = twice_area(a, b, c);
        if area == 0 {
            return;
        }
        if area < 0 {
            std::mem::swap(&mut b, &mut c);
            area = -area;
        }
        let corners = [a, b, c];
        let (columns, rows) = self.covered(&corners);
        if columns.is_empty() {
            return;
        }
        let inverse = 1.0 / area as f64;
        // How the three edge functions, and with them the nearness, change from column to column.
        let mut steps = [0; 3];
        for i in 0..3 {
            let (from, to) = (corners[(i + 1) % 3], corners[(i + 2) % 3]);
            steps[i] = -(to.y - from.y) * FRACTIONS as i64;
        }
        let blend = |weights: [i64; 3]| {
            (weights[0] as f64 * a.nearness
                + weights[1] as f64 * b.nearness
                + weights[2] as f64 * c.nearness)
                * inverse
        };
        let slope = blend(steps);
        for row in rows {
            // The edge functions at the row's first sample: each is twice the area spanned with the opposite corner's
            // edge, hence that corner's weight.
            let (x, y) = (center(columns.start), center(row));
            let mut weights = [0; 3];
            for i in 0..3 {
                let (from, to) = (corners[(i + 1) % 3], corners[(i + 2) % 3]);
                weights[i] = (to.x - from.x) * (y - from.y) - (to.y - from.y) * (x - from.x);
            }
            let first = blend(weights);
            let start = (row - self.rows.start) * self.width;
            let line = start + columns.start..start + columns.end;
            let samples = self.nearness[line.clone()].iter_mut();
            let mut was_inside = false;
            for (at, (stored, shown)) in samples.zip(&mut self.what[line]).enumerate() {
                // No sign bit: all three are zero or above.
                if weights[0] | weights[1] | weights[2] >= 0 {
                    was_inside = true;
                    let nearness = (first + at as f64 * slope) as f32;
                    if nearness > *stored {
                        *stored = nearness;
                        *shown = what;
                    }
                } else if was_inside {
                    break;
                }
                for i in 0..3 {
                    weights[i] += steps[i];
                }
            }
        }
    }

    /// The columns and rows whose sample centres lie in the corners' box.
    fn covered(&self, corners: &[Corner; 3]) -> (Range<usize>, Range<usize>) {
        (
            centers_between(corners.map(|corner| corner.x), &(0..self.width)),
            centers_between(corners.map(|corner| corner.y), &self.rows),
        )
    }

    /// Calls `visit(samples, index, dx, dy)` for each sample whose centre is within `radius` of (`x`, `y`) along each
    /// axis, with its offset from there.
    pub fn around(
        &mut self,
        (x, y): (f64, f64),
        radius: f64,
        mut visit: impl FnMut(&mut Self, usize, f64, f64),
    ) {
        let columns = centers_around(x, radius, &(0..self.width));
        for row in centers_around(y, radius, &self.rows) {
            let start = (row - self.rows.start) * self.width;
            for column in columns.clone() {
                let (dx, dy) = (column as f64 + 0.5 - x, row as f64 + 0.5 - y);
                visit(self, start + column, dx, dy);
            }
        }
    }

    /// Draws a line of the given half width over whatever is not more than `lift` nearer than it.
    pub fn line(
        &mut self,
        [from, to]: [((f64, f64), f64); 2],
        half_width: f64,
        lift: f64,
        what: u32,
    ) {
        let ((x0, y0), near0) = from;
        let ((x1, y1), near1) = to;
        let (ex, ey) = (x1 - x0, y1 - y0);
        let length_squared = ex * ex + ey * ey;
        let length = length_squared.sqrt();
        for row in rows_of([y0, y1], half_width, &self.rows) {
            let y = row as f64 + 0.5;
            // Where the row lies in the strip around the line, and between the ends.
            let middle = x0 + (y - y0) * ex / ey;
            let reach = half_width * length / ey.abs();
            // Of a level line these are no numbers, and bound nothing.
            let left = (x0.min(x1) - half_width).max(middle - reach);
            let right = (x0.max(x1) + half_width).min(middle + reach);
            let columns = (left - 0.501).ceil().max(0.0) as usize
                ..((right - 0.499).floor() + 1.0).clamp(0.0, self.width as f64) as usize;
            let start = (row - self.rows.start) * self.width;
            for column in columns {
                let (px, py) = (column as f64 + 0.5 - x0, y - y0);
                let along = if length_squared > 0.0 {
                    ((px * ex + py * ey) / length_squared).clamp(0.0, 1.0)
                } else {
                    0.0
                };
                let (ox, oy) = (px - ex * along, py - ey * along);
                let nearness = near0 + (near1 - near0) * along;
                let at = start + column;
                let stored = f64::from(self.nearness[at]);
                if ox * ox + oy * oy <= half_width * half_width && nearness + lift >= stored {
                    self.what[at] = what;
                    self.nearness[at] = self.nearness[at].max(nearness as f32);
                }
            }
        }
    }
}

/// The indices within `limits` of the sample centres from the least to the greatest of three corners' coordinates.
fn centers_between([a, b, c]: [i64; 3], limits: &Range<usize>) -> Range<usize> {
    let half = FRACTIONS as i64 / 2;
    // The first centre at or after the least, and the first after the greatest.
    let first = (a.min(b).min(c) - half + FRACTIONS as i64 - 1).div_euclid(FRACTIONS as i64);
    let end = (a.max(b).max(c) - half).div_euclid(FRACTIONS as i64) + 1;
    let clamp = |v: i64| v.clamp(limits.start as i64, limits.end as i64) as usize;
    clamp(first)..clamp(end)
}

/// The indices within `limits` of the sample centres at most `radius` from `middle`.
fn centers_around(middle: f64, radius: f64, limits: &Range<usize>) -> Range<usize> {
    let first = (middle - radius - 0.5).ceil().max(limits.start as f64) as usize;
    let end = (middle + radius - 0.5).floor() + 1.0;
    first..(end.max(0.0) as usize).min(limits.end)
}

/// The rows that a triangle covers, of all there are.
pub fn triangle_rows(corners: [Corner; 3], height: usize) -> Range<usize> {
    centers_between(corners.map(|corner| corner.y), &(0..height))
}

/// The rows that a disc, or a line from the first to the last y, covers at most, of all there are.
pub fn rows_between(y: [f64; 2], radius: f64, height: usize) -> Range<usize> {
    rows_of(y, radius, &(0..height))
}

/// Of these rows those that a line from the first to the last y covers at most.
fn rows_of(y: [f64; 2], radius: f64, rows: &Range<usize>) -> Range<usize> {
    let (low, high) = (y[0].min(y[1]), y[0].max(y[1]));
    centers_around(low, radius, rows).start..centers_around(high, radius, rows).end
}

/// Twice the signed area in the samples' frame: positive when `a, b, c` turn *clockwise* to the viewer, since y
/// points down; the edge functions then are positive inside.
pub fn twice_area(a: Corner, b: Corner, c: Corner) -> i64 {
    (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)
}

/// A sample's centre as an integer.
fn center(index: usize) -> i64 {
    index as i64 * FRACTIONS as i64 + FRACTIONS as i64 / 2
}

#[cfg(test)]
mod tests {
    use super::*;

    const PLACEMENT: Placement = Placement {
        scale: 1.0,
        origin_x: 0.0,
        origin_y: 16.0,
    };

    fn corner(x: f64, y: f64) -> Corner {
        PLACEMENT.corner(Projected {
            x,
            y,
            nearness: x + 2.0 * y,
        })
    }

    #[test]
    fn neighbours_leave_no_gap() {
        // A fan of slivers around a point that lies on no sample.
        let hub = corner(8.3, 7.7);
        let rim: Vec<Corner> = (0..=64)
            .map(|i| {
                let along = f64::from(i % 16) / 16.0 * 18.0 - 1.0;
                match i / 16 {
                    0 => corner(along, -1.0),
                    1 => corner(17.0, along),
                    2 => corner(16.0 - along, 17.0),
                    3 => corner(-1.0, 16.0 - along),
                    _ => corner(-1.0, -1.0),
                }
            })
            .collect();
        let mut samples = Plane::new(16, 16);
        samples.draw(5, |_, band| {
            for pair in rim.windows(2) {
                band.triangle([hub, pair[0], pair[1]], 1);
            }
        });
        assert!(samples.what.iter().all(|&what| what == 1));
    }

    #[test]
    fn nearness_is_linear_and_decides() {
        let mut samples = Plane::new(16, 16);
        let far = [corner(0.0, 0.0), corner(16.0, 0.0), corner(0.0, 16.0)];
        samples.draw(16, |_, band| band.triangle(far, 1));
        // The sample at column 2, row 3 has its centre at (2.5, 12.5) with y up.
        assert_eq!(samples.nearness[3 * 16 + 2], 2.5 + 2.0 * 12.5);
        let nearer = far.map(|corner| Corner {
            nearness: corner.nearness + 1.0,
            ..corner
        });
        samples.draw(3, |_, band| {
            band.triangle([nearer[0], nearer[2], nearer[1]], 2);
            band.triangle(far, 3);
        });
        assert!(
            samples
                .what
                .iter()
                .all(|&what| what == 2 || what == NOTHING)
        );
        assert_eq!(samples.what[3 * 16 + 2], 2);
        assert_eq!(samples.what[3 * 16 + 12], NOTHING);
    }

    #[test]
    fn area_has_the_sign_it_says() {
        let (a, b, c) = (corner(0.0, 0.0), corner(1.0, 0.0), corner(0.0, 1.0));
        assert!(twice_area(a, b, c) < 0, "counter-clockwise to the viewer");
        assert!(twice_area(a, c, b) > 0);
    }

    #[test]
    fn a_line_is_as_wide_as_asked_and_hides_behind_what_is_nearer() {
        let mut samples = Plane::new(16, 16);
        samples.draw(16, |_, band| {
            band.put(8 * 16 + 8, 5.0, 1);
            band.put(8 * 16 + 9, 1.05, 1);
            band.line([((2.0, 8.5), 1.0), ((14.0, 8.5), 1.0)], 1.1, 0.1, 7);
        });
        let rows: Vec<usize> = (0..16)
            .filter(|row| samples.what[row * 16 + 5] == 7)
            .collect();
        assert_eq!(rows, [7, 8, 9]);
        assert_eq!(samples.what[8 * 16 + 8], 1);
        assert_eq!(samples.what[8 * 16 + 9], 7);
    }
}
