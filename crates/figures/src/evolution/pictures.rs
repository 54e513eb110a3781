//! Scenes as panels: surfaces, clouds, and what lies around them.

use crate::Error;
use crate::sheet::Panel;
use pellicle::geometry::Aabb;
use pellicle::prelude::*;
use pellicle::render::{
    Bar, ColorMap, Coloring, Dot, Drawing, Image, Options, Palette, Stroke, Style, Values, View,
    Visibility, render,
};

/// A point of a cloud.
pub(crate) const POINT: [u8; 3] = [36, 92, 160];
/// A point that lies off the surface.
pub(crate) const OUTLIER: [u8; 3] = [206, 44, 24];
/// The wires of a surface that has not arrived.
pub(crate) const WIRE: [u8; 3] = [126; 3];

/// Where a picture is taken from, and of what size.
#[derive(Clone, Debug)]
pub(crate) struct Camera {
    /// The direction towards the viewer.
    pub(crate) view: View,
    /// What is to be seen in full.
    pub(crate) bounds: Option<Aabb>,
    /// Pixels of the sheet.
    pub(crate) size: [f64; 2],
    /// The share of width and height, in the middle, that is kept: balls do not reach the corners of their boxes.
    pub(crate) kept: f64,
}

impl Camera {
    /// From before, a little to the right and above.
    pub(crate) fn new(bounds: Aabb, size: [f64; 2]) -> Self {
        Self {
            view: View::From(DVec3::new(0.45, 0.35, 1.0)),
            bounds: Some(bounds),
            size,
            kept: 0.8,
        }
    }

    pub(crate) fn options(&self, style: Style) -> Options {
        let [width, height] = self.size.map(|side| (side / self.kept).round() as u32);
        Options {
            width,
            height,
            views: vec![self.view],
            bounds: self.bounds,
            style,
            edge_width: 0.6,
            palette: Palette {
                background: [255; 3],
                point: POINT,
                front: [212; 3],
                edge: [92; 3],
                ..Palette::default()
            },
            ..Options::default()
        }
    }

    /// The picture as a panel.
    pub(crate) fn panel(&self, image: &Image) -> Result<Panel, Error> {
        let margin = 0.5 * (1.0 - self.kept);
        let image = cropped(image, [margin; 2], [1.0 - margin; 2]);
        Panel::of_image(&posterized(image), self.size[0])
    }

    /// A surface with its edges, and points as dots where it does not hide them, some of them marked.
    pub(crate) fn surface(
        &self,
        mesh: &TriMesh,
        points: &[DVec3],
        marked: &[DVec3],
    ) -> Result<Panel, Error> {
        let mut marks = dots(points, POINT, 1.1);
        marks.extend(dots(marked, OUTLIER, 2.6));
        let drawing = Drawing {
            dots: &marks,
            ..Drawing::mesh(mesh)
        };
        self.panel(&render(&drawing, &self.options(Style::SurfaceAndEdges))?)
    }

    /// A surface whose colours tell a value of each vertex.
    pub(crate) fn valued(
        &self,
        mesh: &TriMesh,
        values: &[f64],
        range: [f64; 2],
        map: ColorMap,
        title: &str,
    ) -> Result<Panel, Error> {
        let drawing = Drawing {
            coloring: Coloring::Values(Values {
                range: Some(range),
                map,
                title,
                bar: Bar::Right,
                ..Values::new(values)
            }),
            ..Drawing::mesh(mesh)
        };
        // The bar stands at the edge.
        let whole = Self {
            kept: 1.0,
            ..self.clone()
        };
        whole.panel(&render(&drawing, &whole.options(Style::SurfaceAndEdges))?)
    }

    /// Points, some of them marked, and perhaps the wires of a surface around them.
    pub(crate) fn cloud(
        &self,
        points: &[DVec3],
        marked: &[DVec3],
        around: Option<&TriMesh>,
        radius: f64,
    ) -> Result<Panel, Error> {
        let strokes = around.map_or_else(Vec::new, |mesh| wires(mesh, WIRE, 0.5));
        let marked = dots(marked, OUTLIER, 2.6);
        let drawing = Drawing {
            strokes: &strokes,
            dots: &marked,
            ..Drawing::points(points, None)
        };
        let options = Options {
            point_radius: Some(radius),
            occlusion: 0.0,
            ..self.options(Style::Surface)
        };
        self.panel(&render(&drawing, &options)?)
    }
}

/// Dots that what is nearer hides.
pub(crate) fn dots(points: &[DVec3], color: [u8; 3], radius: f64) -> Vec<Dot> {
    let dot = |&position: &DVec3| Dot {
        position,
        color,
        radius,
        visibility: Visibility::Hidden,
    };
    points.iter().map(dot).collect()
}

/// The edges of a mesh.
pub(crate) fn wires(mesh: &TriMesh, color: [u8; 3], width: f64) -> Vec<Stroke> {
    let stroke = |half_edge| Stroke {
        ends: [mesh.origin(half_edge), mesh.destination(half_edge)].map(|v| mesh.position(v)),
        color,
        width,
        visibility: Visibility::Hidden,
    };
    mesh.edges().map(stroke).collect()
}

/// A part of a picture, by shares of its width and height from the upper left corner.
pub(crate) fn cropped(image: &Image, from: [f64; 2], to: [f64; 2]) -> Image {
    let pixel = |share: f64, length: u32| ((share * f64::from(length)).round() as u32).min(length);
    let [left, right] = [from[0], to[0]].map(|share| pixel(share, image.width));
    let [top, bottom] = [from[1], to[1]].map(|share| pixel(share, image.height));
    let row = |y: u32| {
        let start = (y * image.width) as usize;
        image.pixels[start + left as usize..start + right as usize].to_vec()
    };
    Image {
        width: right.saturating_sub(left),
        height: bottom.saturating_sub(top),
        pixels: (top..bottom).flat_map(row).collect(),
    }
}

/// With 32 shades of each colour, which nobody misses and which take half the bytes. Greys stay grey, and white white.
pub(crate) fn posterized(mut image: Image) -> Image {
    for pixel in &mut image.pixels {
        for shade in &mut pixel[..3] {
            *shade |= 7;
        }
    }
    image
}

/// The box of all points of clouds.
pub(crate) fn box_of<'a>(clouds: impl IntoIterator<Item = &'a [DVec3]>) -> Aabb {
    let boxes = clouds.into_iter().map(Aabb::of_points);
    boxes.fold(Aabb::EMPTY, Aabb::union)
}
