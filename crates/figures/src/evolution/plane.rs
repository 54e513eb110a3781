//! Functions of a plane, and where surfaces meet it: lines and pictures for the sheet.

use crate::sheet::ColorScale;
use pellicle::glam::DVec2;
use pellicle::prelude::*;
use pellicle::render::Image;
use std::collections::HashMap;

/// A function of the plane at the nodes of a square grid, x fastest.
pub(crate) struct Raster {
    /// The first node.
    pub(crate) origin: DVec2,
    /// Between nodes.
    pub(crate) spacing: f64,
    /// Nodes along x.
    pub(crate) columns: usize,
    /// Nodes along y.
    pub(crate) rows: usize,
    /// One a node.
    pub(crate) values: Vec<f64>,
}

impl Raster {
    /// The values of a function on the box from `min` to `max`, with so many nodes along x.
    pub(crate) fn of(min: DVec2, max: DVec2, columns: usize, at: impl Fn(DVec2) -> f64) -> Self {
        let spacing = (max.x - min.x) / (columns - 1) as f64;
        let rows = ((max.y - min.y) / spacing).round() as usize + 1;
        let mut raster = Self {
            origin: min,
            spacing,
            columns,
            rows,
            values: Vec::new(),
        };
        raster.values = (0..columns * rows).map(|i| at(raster.node(i))).collect();
        raster
    }

    /// Where a node is.
    pub(crate) fn node(&self, index: usize) -> DVec2 {
        let (x, y) = (index % self.columns, index / self.columns);
        self.origin + self.spacing * DVec2::new(x as f64, y as f64)
    }

    /// The last node.
    pub(crate) fn end(&self) -> DVec2 {
        self.node(self.columns * self.rows - 1)
    }

    /// A pixel a node, the largest y at the top.
    pub(crate) fn image(&self, scale: &ColorScale) -> Image {
        let row = |y: usize| &self.values[y * self.columns..(y + 1) * self.columns];
        let pixel = |&value: &f64| {
            let [red, green, blue] = scale.at(value).0;
            [red, green, blue, 255]
        };
        Image {
            width: self.columns as u32,
            height: self.rows as u32,
            pixels: (0..self.rows).rev().flat_map(row).map(pixel).collect(),
        }
    }

    /// Where the function has a value, as segments: each square is halved, and the function taken to be linear on the halves.
    pub(crate) fn contour(&self, level: f64) -> Vec<[DVec2; 2]> {
        let mut segments = Vec::new();
        for y in 0..self.rows - 1 {
            for x in 0..self.columns - 1 {
                let node = y * self.columns + x;
                let [a, b, c, d] = [0, 1, self.columns, self.columns + 1].map(|step| node + step);
                for half in [[a, b, d], [a, d, c]] {
                    let corners = half.map(|i| (self.node(i), self.values[i] - level));
                    segments.extend(crossed(corners, |p, q, t| p.lerp(q, t)));
                }
            }
        }
        segments
    }

    /// The graph as a surface: a vertex a node, at the height of its value times `height`.
    pub(crate) fn graph(&self, height: f64) -> TriangleSoup {
        let vertex = |i: usize| self.node(i).extend(height * self.values[i]);
        let mut triangles = Vec::new();
        for y in 0..self.rows - 1 {
            for x in 0..self.columns - 1 {
                let node = y * self.columns + x;
                let [a, b, c, d] =
                    [0, 1, self.columns, self.columns + 1].map(|step| VertexId::new(node + step));
                triangles.extend([[a, b, d], [a, d, c]]);
            }
        }
        TriangleSoup {
            positions: (0..self.values.len()).map(vertex).collect(),
            triangles,
        }
    }
}

/// Where a mesh meets the plane z = `height`, as segments in x and y.
pub(crate) fn slice(mesh: MeshView<'_>, height: f64) -> Vec<[DVec2; 2]> {
    let triangle = |corners: &[VertexId; 3]| {
        let corners = corners.map(|v| mesh.positions[v.index()]);
        let above = corners.map(|p| (p.truncate(), p.z - height));
        crossed(above, |p, q, t| p.lerp(q, t))
    };
    mesh.triangles.iter().filter_map(triangle).collect()
}

/// The segment of a triangle on which a linear function vanishes, given its corners and the values there. An edge that two
/// triangles share is met at the same bits, and so is a corner.
fn crossed<P: Copy + PartialEq>(
    corners: [(P, f64); 3],
    between: impl Fn(P, P, f64) -> P,
) -> Option<[P; 2]> {
    // From below to above, which includes zero.
    let root = |(p, u): (P, f64), (q, v): (P, f64)| match v == 0.0 {
        true => q,
        false => between(p, q, u / (u - v)),
    };
    let mut ends = Vec::with_capacity(2);
    for i in 0..3 {
        let (one, other) = (corners[i], corners[(i + 1) % 3]);
        match (one.1 < 0.0, other.1 < 0.0) {
            (true, false) => ends.push(root(one, other)),
            (false, true) => ends.push(root(other, one)),
            _ => {}
        }
    }
    let ends: [P; 2] = ends.try_into().ok()?;
    // A corner alone is no segment.
    (ends[0] != ends[1]).then_some(ends)
}

/// Segments that share ends as lines, in the order of their first segments. Closed lines end where they begin.
pub(crate) fn lines(segments: &[[DVec2; 2]]) -> Vec<Vec<DVec2>> {
    let key = |p: DVec2| p.to_array().map(f64::to_bits);
    let mut at: HashMap<[u64; 2], Vec<usize>> = HashMap::new();
    for (i, ends) in segments.iter().enumerate() {
        for &end in ends {
            at.entry(key(end)).or_default().push(i);
        }
    }
    let mut used = vec![false; segments.len()];
    let mut lines = Vec::new();
    for (i, &[from, to]) in segments.iter().enumerate() {
        if std::mem::replace(&mut used[i], true) {
            continue;
        }
        // Onwards from one end, then from the other.
        let mut line = vec![from, to];
        for _ in 0..2 {
            while let Some(&last) = line.last() {
                let next = at[&key(last)].iter().copied().find(|&j| !used[j]);
                let Some(j) = next else { break };
                used[j] = true;
                let [a, b] = segments[j];
                line.push(if key(a) == key(last) { b } else { a });
            }
            line.reverse();
        }
        lines.push(line);
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_contour_of_a_cone_is_a_circle() {
        let corner = DVec2::splat(1.0);
        let raster = Raster::of(-corner, corner, 101, DVec2::length);
        assert_eq!((raster.rows, raster.end()), (101, corner));
        let segments = raster.contour(0.5);
        let length: f64 = segments.iter().map(|[a, b]| a.distance(*b)).sum();
        assert!(
            (length / std::f64::consts::PI - 1.0).abs() < 1e-3,
            "{length}"
        );
        for end in segments.as_flattened() {
            assert!((end.length() - 0.5).abs() < 1e-3);
        }
        let joined = lines(&segments);
        assert_eq!((joined.len(), joined[0].len()), (1, segments.len() + 1));
        assert_eq!(joined[0].first(), joined[0].last());
    }

    #[test]
    fn a_sphere_is_cut_in_a_circle() {
        let sphere = mesh::icosphere(4).unwrap();
        let segments = slice((&sphere).into(), 0.6);
        let length: f64 = segments.iter().map(|[a, b]| a.distance(*b)).sum();
        let circle = 1.6 * std::f64::consts::PI;
        assert!((length / circle - 1.0).abs() < 1e-2, "{length}");
        assert!(slice((&sphere).into(), 1.1).is_empty());
        assert_eq!(lines(&segments).len(), 1);
        // An open line is one from whichever segment it begins.
        let [a, b, c, d] = [0.0, 1.0, 2.0, 3.0].map(DVec2::splat);
        assert_eq!(lines(&[[b, c], [d, c], [a, b]])[0].len(), 4);
    }

    #[test]
    fn pictures_have_y_up() {
        let raster = Raster::of(DVec2::ZERO, DVec2::new(1.0, 2.0), 2, |p| p.y);
        let scale = ColorScale::sequential(0.0, 2.0);
        let image = raster.image(&scale);
        assert_eq!((image.width, image.height), (2, 3));
        assert_eq!(image.pixels[0][..3], scale.at(2.0).0);
    }
}
