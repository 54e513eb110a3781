//! A mesh as a scene.

use crate::camera::{Camera, Projected, unit};
use crate::frame::{Fitted, Frame};
use crate::samples::{Samples, twice_area};
use crate::shade::{Color, linear, lit};
use crate::sheet::{Scene, View};
use crate::{Error, Options, Shading};
use pellicle_geometry::{DVec3, VertexId, triangle::double_area_normal};
use pellicle_mesh::MeshView;

/// Marks, above the ids of triangles.
const BORDER: u32 = u32::MAX - 1;
const NON_MANIFOLD: u32 = u32::MAX - 2;
const MOST_TRIANGLES: usize = (u32::MAX - 8) as usize;

/// Half the width of a border in pixels.
const HALF_LINE: f64 = 1.0;

/// Normals that differ by more than 60 degrees stay apart when shading is smooth.
const CREASE_COSINE: f64 = 0.5;

/// A mesh inside the unit ball, and its edges that do not have two triangles.
pub struct MeshScene<'a> {
    positions: Vec<DVec3>,
    triangles: &'a [[VertexId; 3]],
    /// One normal a vertex where shading is smooth, else none.
    normals: Vec<DVec3>,
    /// The ends, and [`BORDER`] or [`NON_MANIFOLD`].
    marked: Vec<([VertexId; 2], u32)>,
    fitted: Fitted,
    colors: Colors,
}

struct Colors {
    front: Color,
    back: Color,
    border: Color,
    non_manifold: Color,
}

/// Refuses what cannot be drawn.
pub fn check(mesh: MeshView<'_>) -> Result<(), Error> {
    if mesh.triangles.len() > MOST_TRIANGLES {
        return Err(Error::TooMany {
            count: mesh.triangles.len(),
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
    /// The scene of a mesh that [`check`] passed.
    pub fn new(mesh: MeshView<'a>, options: &Options) -> Self {
        // Vertices of no triangle have no say in what fits the sheet.
        let corners = mesh.triangles.iter().flatten();
        let corners = corners.map(|vertex| mesh.positions[vertex.index()]);
        let (frame, fitted) = Frame::with_bounds(corners, options.bounds);
        let positions: Vec<DVec3> = mesh.positions.iter().map(|&p| frame.place(p)).collect();
        let normals = match options.shading {
            Shading::Flat => Vec::new(),
            Shading::Smooth => vertex_normals(&positions, mesh.triangles),
        };
        let palette = &options.palette;
        Self {
            positions,
            triangles: mesh.triangles,
            normals,
            marked: marked_edges(mesh.triangles),
            fitted,
            colors: Colors {
                front: linear(palette.front),
                back: linear(palette.back),
                border: linear(palette.border),
                non_manifold: linear(palette.non_manifold),
            },
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

    /// The blended normal at a sample, in the viewer's frame, on the flat normal's side.
    fn smooth_normal(&self, view: &View, triangle: usize, flat: DVec3, at: (f64, f64)) -> DVec3 {
        let placed = self.corners(triangle).map(|corner| {
            let projected = view.camera.project(corner);
            let (x, y) = view.placement.place(projected);
            (x - at.0, y - at.1, projected.nearness)
        });
        let mut sum = DVec3::ZERO;
        for i in 0..3 {
            let (b, c) = (placed[(i + 1) % 3], placed[(i + 2) % 3]);
            let own = view
                .camera
                .turn(self.normals[self.triangles[triangle][i].index()]);
            let normal = if own.dot(flat) >= CREASE_COSINE {
                own
            } else {
                flat
            };
            // The area spanned with the opposite edge, undone by how much perspective enlarges the corner.
            sum += normal * ((b.0 * c.1 - b.1 * c.0) * view.camera.enlargement(placed[i].2));
        }
        let normal = unit(sum).unwrap_or(flat);
        if normal.dot(flat) < 0.0 {
            -normal
        } else {
            normal
        }
    }
}

impl Scene for MeshScene<'_> {
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
    }

    fn draw(&self, view: &View, samples: &mut Samples) {
        let corners: Vec<_> = self
            .positions
            .iter()
            .map(|&position| view.placement.corner(view.camera.project(position)))
            .collect();
        for (index, triangle) in self.triangles.iter().enumerate() {
            samples.triangle(triangle.map(|vertex| corners[vertex.index()]), index as u32);
        }
        let half_width = HALF_LINE * view.samples_per_pixel;
        // Enough that a surface which falls off steeply beside its border does not swallow half the line.
        let lift = 2.0 * half_width / view.placement.scale + 0.004;
        for &(ends, mark) in &self.marked {
            let ends = ends.map(|vertex| {
                let projected = view.camera.project(self.positions[vertex.index()]);
                (view.placement.place(projected), projected.nearness)
            });
            samples.line(ends, half_width, lift, mark);
        }
    }

    fn shade(&self, view: &View, what: u32, at: (f64, f64)) -> Color {
        match what {
            BORDER => return self.colors.border,
            NON_MANIFOLD => return self.colors.non_manifold,
            _ => {}
        }
        let triangle = what as usize;
        let mut normal = self.flat_normal(&view.camera, triangle);
        if !self.normals.is_empty() {
            normal = self.smooth_normal(view, triangle, normal, at);
        }
        // In perspective the sign of the normal's z does not tell the side; the picture's own turning does.
        let faces_viewer = {
            let [a, b, c] = self
                .corners(triangle)
                .map(|corner| view.placement.corner(view.camera.project(corner)));
            twice_area(a, b, c) < 0
        };
        if faces_viewer {
            lit(self.colors.front, normal)
        } else {
            lit(self.colors.back, -normal)
        }
    }

    fn is_mark(&self, what: u32) -> bool {
        what >= NON_MANIFOLD
    }

    fn is_uniform(&self) -> bool {
        self.normals.is_empty()
    }
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

/// The edges with one triangle, and those with three or more, by a sort: O(n log n).
fn marked_edges(triangles: &[[VertexId; 3]]) -> Vec<([VertexId; 2], u32)> {
    let mut edges: Vec<[VertexId; 2]> = triangles
        .iter()
        .flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]])
        .filter(|[from, to]| from != to)
        .map(|[from, to]| [from.min(to), from.max(to)])
        .collect();
    edges.sort_unstable();
    edges
        .chunk_by(|a, b| a == b)
        .filter_map(|same| match same.len() {
            1 => Some((same[0], BORDER)),
            2 => None,
            _ => Some((same[0], NON_MANIFOLD)),
        })
        .collect()
}
