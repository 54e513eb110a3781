//! A mesh as a scene.

use crate::camera::{Camera, Projected, unit};
use crate::frame::{Fitted, Frame};
use crate::marks::{self, Line, Marks};
use crate::paint::Painted;
use crate::samples::{Bins, Corner, Samples, triangle_rows, twice_area};
use crate::shade::{Color, linear, lit};
use crate::sheet::{Kind, Scene, View};
use crate::{Borders, Drawing, Error, Options, Shading, Style, Visibility};
use pellicle_geometry::{DVec3, VertexId, triangle::double_area_normal};
use pellicle_mesh::{MeshView, TriangleId};
use rayon::prelude::*;

/// Edges, above the ids of triangles and of marks.
const BORDER: u32 = u32::MAX - 1;
const NON_MANIFOLD: u32 = u32::MAX - 2;
const EDGE: u32 = u32::MAX - 3;

/// Half the width of a border in pixels.
const HALF_LINE: f64 = 1.0;

/// Normals that differ by more than 60 degrees stay apart when shading is smooth.
const CREASE_COSINE: f64 = 0.5;

/// A mesh inside the unit ball, its edges, and marks on it.
pub struct MeshScene<'a> {
    positions: Vec<DVec3>,
    triangles: &'a [[VertexId; 3]],
    /// One normal a vertex where shading is smooth, else none.
    normals: Vec<DVec3>,
    shading: Shading,
    style: Style,
    colors: Colors<'a>,
    /// Whether each triangle is marked; empty if none is.
    marked: Vec<bool>,
    /// The ends, and [`EDGE`], [`BORDER`] or [`NON_MANIFOLD`]; those without an error first.
    edges: Vec<([VertexId; 2], u32)>,
    /// Half the width of an [`EDGE`] in pixels.
    half_edge: f64,
    marks: Marks,
    fitted: Fitted,
}

struct Colors<'a> {
    front: Color,
    back: Color,
    border: Color,
    non_manifold: Color,
    edge: Color,
    marked: Color,
    painted: Painted<'a>,
}

/// A mesh among the samples of a view.
pub struct Placed {
    corners: Vec<Corner>,
    triangles: Bins,
    lines: Vec<Line>,
    edges: Bins,
    marks: marks::Placed,
}

/// Refuses what cannot be drawn.
pub fn check(mesh: MeshView<'_>, marked: &[TriangleId]) -> Result<(), Error> {
    let beyond = |t: &&TriangleId| t.index() >= mesh.triangles.len();
    if let Some(&triangle) = marked.iter().find(beyond) {
        let triangles = mesh.triangles.len();
        return Err(Error::NoSuchTriangle {
            triangle,
            triangles,
        });
    }
    let vertices = mesh.positions.len();
    for (triangle, corners) in mesh.triangles.iter().enumerate() {
        for &vertex in corners {
            match mesh.positions.get(vertex.index()) {
                None => {
                    return Err(Error::NoSuchVertex {
                        triangle,
                        vertex,
                        vertices,
                    });
                }
                Some(&position) if !position.is_finite() => {
                    return Err(Error::NotFinite { vertex, position });
                }
                Some(_) => {}
            }
        }
    }
    Ok(())
}

impl<'a> MeshScene<'a> {
    /// The scene of a drawing that [`check`] passed.
    pub fn new(mesh: MeshView<'a>, drawing: &Drawing<'a>, options: &Options) -> Self {
        // Vertices of no triangle have no say in what fits the sheet.
        let corners = mesh.triangles.iter().flatten();
        let corners = corners.map(|vertex| mesh.positions[vertex.index()]);
        let shown = corners.chain(marks::points(drawing.strokes, drawing.dots));
        let (frame, fitted) = Frame::with_bounds(shown, options.bounds);
        let positions: Vec<DVec3> = mesh.positions.iter().map(|&p| frame.place(p)).collect();
        let normals = match options.shading {
            Shading::Flat | Shading::Unlit => Vec::new(),
            Shading::Smooth => vertex_normals(&positions, mesh.triangles),
        };
        let palette = &options.palette;
        Self {
            positions,
            triangles: mesh.triangles,
            normals,
            shading: options.shading,
            style: options.style,
            colors: Colors {
                front: linear(palette.front),
                back: linear(palette.back),
                border: linear(palette.border),
                non_manifold: linear(palette.non_manifold),
                edge: linear(palette.edge),
                marked: linear(palette.marked),
                painted: Painted::new(&drawing.coloring, palette),
            },
            marked: flags(drawing.marked, mesh.triangles.len()),
            edges: edges(mesh.triangles, options),
            half_edge: 0.5 * options.edge_width,
            marks: Marks::new(&frame, drawing.strokes, drawing.dots),
            fitted,
        }
    }

    fn corners(&self, triangle: usize) -> [DVec3; 3] {
        self.triangles[triangle].map(|vertex| self.positions[vertex.index()])
    }

    /// The normal of a triangle in the viewer's frame, seen from wherever it is seen.
    fn flat_normal(&self, camera: &Camera, triangle: usize) -> DVec3 {
        let [a, b, c] = self.corners(triangle);
        camera.turn(unit(double_area_normal(a, b, c)).unwrap_or(DVec3::Z))
    }

    /// How much each corner counts at a place among the samples, up to a common factor.
    fn weights(camera: &Camera, corners: [Corner; 3], at: (f64, f64)) -> [f64; 3] {
        let offsets = corners.map(|corner| corner.offset(at));
        std::array::from_fn(|i| {
            let (b, c) = (offsets[(i + 1) % 3], offsets[(i + 2) % 3]);
            // The area spanned with the opposite edge, undone by how much perspective enlarges the corner.
            (b.0 * c.1 - b.1 * c.0) * camera.enlargement(corners[i].nearness)
        })
    }

    /// The blended normal at a sample, in the viewer's frame, on the flat normal's side.
    fn smooth_normal(
        &self,
        camera: &Camera,
        triangle: usize,
        flat: DVec3,
        weights: [f64; 3],
    ) -> DVec3 {
        let mut sum = DVec3::ZERO;
        for (&vertex, weight) in self.triangles[triangle].iter().zip(weights) {
            let own = camera.turn(self.normals[vertex.index()]);
            let normal = if own.dot(flat) >= CREASE_COSINE {
                own
            } else {
                flat
            };
            sum += normal * weight;
        }
        let normal = unit(sum).unwrap_or(flat);
        if normal.dot(flat) < 0.0 {
            -normal
        } else {
            normal
        }
    }

    /// The colour of a triangle's surface before light.
    fn surface(
        &self,
        triangle: usize,
        faces_viewer: bool,
        weights: impl Fn() -> [f64; 3],
    ) -> Color {
        if self.marked.get(triangle) == Some(&true) {
            return self.colors.marked;
        }
        match &self.colors.painted {
            Painted::Sides if faces_viewer => self.colors.front,
            Painted::Sides => self.colors.back,
            Painted::Each(colors) => linear(colors[triangle]),
            Painted::Values(scale) => {
                let values = self.triangles[triangle].map(|vertex| vertex.index());
                scale.blend(values, weights())
            }
        }
    }
}

impl Scene for MeshScene<'_> {
    type Placed = Placed;

    fn project(&self, camera: &Camera, visit: &mut dyn FnMut(Projected)) {
        if !self.fitted.project(camera, visit) {
            return;
        }
        let mut used = vec![false; self.positions.len()];
        for vertex in self.triangles.iter().flatten() {
            if !std::mem::replace(&mut used[vertex.index()], true) {
                visit(camera.project(self.positions[vertex.index()]));
            }
        }
        self.marks.project(camera, visit);
    }

    fn place(&self, view: &View) -> Placed {
        let place = |&position: &DVec3| view.placement.corner(view.camera.project(position));
        let corners: Vec<Corner> = self.positions.iter().map(place).collect();
        let drawn = match self.style {
            Style::AllEdges => 0,
            _ => self.triangles.len(),
        };
        let triangles = view.bins(drawn, |t| {
            let corners = self.triangles[t].map(|vertex| corners[vertex.index()]);
            triangle_rows(corners, view.height)
        });
        let line = |&(ends, kind): &([VertexId; 2], u32)| {
            let ends = ends.map(|vertex| self.positions[vertex.index()]);
            let half_width = if kind == EDGE {
                self.half_edge
            } else {
                HALF_LINE
            };
            Line::new(view, ends, half_width, Visibility::Hidden)
        };
        let lines: Vec<Line> = self.edges.iter().map(line).collect();
        let edges = view.bins(lines.len(), |i| lines[i].rows(view));
        Placed {
            corners,
            triangles,
            lines,
            edges,
            marks: self.marks.place(view),
        }
    }

    fn draw(&self, placed: &Placed, band: usize, _camera: &Camera, samples: &mut Samples<'_>) {
        for index in placed.triangles.of(band) {
            let corners = self.triangles[index].map(|vertex| placed.corners[vertex.index()]);
            samples.triangle(corners, index as u32);
        }
        for edge in placed.edges.of(band) {
            placed.lines[edge].draw(samples, self.edges[edge].1);
        }
        placed.marks.draw(band, samples, self.triangles.len());
    }

    fn shade(&self, view: &View, placed: &Placed, what: u32, at: (f64, f64)) -> Color {
        match what {
            BORDER => return self.colors.border,
            NON_MANIFOLD => return self.colors.non_manifold,
            EDGE => return self.colors.edge,
            _ => {}
        }
        let triangle = what as usize;
        if let Some(mark) = triangle.checked_sub(self.triangles.len()) {
            return self.marks.color(mark);
        }
        let corners = self.triangles[triangle].map(|vertex| placed.corners[vertex.index()]);
        // In perspective the sign of the normal's z does not tell the side; the picture's own turning does.
        let faces_viewer = {
            let [a, b, c] = corners;
            twice_area(a, b, c) < 0
        };
        let weights = || Self::weights(&view.camera, corners, at);
        let surface = self.surface(triangle, faces_viewer, weights);
        if self.shading == Shading::Unlit {
            return surface;
        }
        let mut normal = self.flat_normal(&view.camera, triangle);
        if !self.normals.is_empty() {
            normal = self.smooth_normal(&view.camera, triangle, normal, weights());
        }
        lit(surface, if faces_viewer { normal } else { -normal })
    }

    fn kind(&self, what: u32) -> Kind {
        match self.style {
            _ if what as usize >= self.triangles.len() => Kind::Mark,
            Style::VisibleEdges => Kind::Nothing,
            _ => Kind::Surface,
        }
    }

    fn is_uniform(&self) -> bool {
        self.normals.is_empty() && !matches!(self.colors.painted, Painted::Values(_))
    }
}

/// Whether each of `count` triangles is among those listed; nothing if none is.
fn flags(listed: &[TriangleId], count: usize) -> Vec<bool> {
    if listed.is_empty() {
        return Vec::new();
    }
    let mut flags = vec![false; count];
    for triangle in listed {
        flags[triangle.index()] = true;
    }
    flags
}

/// Area-weighted normals of length one; z for a vertex whose triangles cancel out.
fn vertex_normals(positions: &[DVec3], triangles: &[[VertexId; 3]]) -> Vec<DVec3> {
    let mut sums = vec![DVec3::ZERO; positions.len()];
    for corners in triangles {
        let [a, b, c] = corners.map(|vertex| positions[vertex.index()]);
        for vertex in corners {
            sums[vertex.index()] += double_area_normal(a, b, c);
        }
    }
    sums.into_iter()
        .map(|sum| unit(sum).unwrap_or(DVec3::Z))
        .collect()
}

/// The edges to be drawn, ordinary ones first, by a sort: O(n log n).
fn edges(triangles: &[[VertexId; 3]], options: &Options) -> Vec<([VertexId; 2], u32)> {
    let all = options.style != Style::Surface;
    if !all && options.borders == Borders::Plain {
        return Vec::new();
    }
    let mut edges: Vec<[VertexId; 2]> = triangles
        .iter()
        .flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]])
        .filter(|[from, to]| from != to)
        .map(|[from, to]| [from.min(to), from.max(to)])
        .collect();
    edges.par_sort_unstable();
    let mut kinds: Vec<([VertexId; 2], u32)> = edges
        .chunk_by(|a, b| a == b)
        .filter_map(|same| match (same.len(), options.borders) {
            (1, Borders::Marked) => Some((same[0], BORDER)),
            (3.., Borders::Marked) => Some((same[0], NON_MANIFOLD)),
            _ => all.then_some((same[0], EDGE)),
        })
        .collect();
    kinds.sort_by_key(|&(_, kind)| kind);
    kinds
}
