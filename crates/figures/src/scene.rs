//! Small scenes in space, drawn as vectors: areas, lines and words from far to near.
//!
//! Nearness is that of the middle of each thing, which is right for triangles of about one size that do not cross each
//! other. Larger scenes are for `pellicle::render`.

use crate::sheet::{Color, Panel, Style, Text};
use pellicle::glam::DVec2;
use pellicle::prelude::DVec3;

/// Things in space, and the direction from which they are seen, without perspective.
///
/// ```
/// use pellicle::prelude::DVec3;
/// use pellicle_figures::scene::Scene;
/// use pellicle_figures::sheet::Color;
///
/// let mut scene = Scene::new(DVec3::new(1.0, 2.0, 3.0), DVec3::Z);
/// scene.face(&[DVec3::X, DVec3::Y, DVec3::Z], Color::BLUE);
/// assert_eq!(scene.panel(200.0, 150.0).width(), 200.0);
/// ```
#[derive(Clone, Debug)]
pub struct Scene {
    right: DVec3,
    up: DVec3,
    toward: DVec3,
    things: Vec<(f64, Thing)>,
    /// What the picture must hold.
    fitted: Vec<DVec2>,
}

#[derive(Clone, Debug)]
enum Thing {
    Area(Vec<DVec2>, Style),
    Line(Vec<DVec2>, Style),
    Arrow([DVec2; 2], Style),
    Dot(DVec2, f64, Style),
    Words(DVec2, String, Text),
}

/// How much nearer lines are taken to be than the areas they bound, in units of the scene.
const LIFT: f64 = 1e-3;

/// The share of the panel that stays free on each side.
const BORDER: f64 = 0.06;

impl Scene {
    /// An empty scene: `toward` points to the viewer, `up` is up in the picture.
    ///
    /// # Panics
    ///
    /// If the two are parallel, or one is zero.
    pub fn new(toward: DVec3, up: DVec3) -> Self {
        let toward = toward.normalize();
        let right = up.cross(toward).normalize();
        assert!(right.is_finite(), "up is a direction across the view");
        Self {
            right,
            up: toward.cross(right),
            toward,
            things: Vec::new(),
            fitted: Vec::new(),
        }
    }

    /// Where a point is in the picture plane.
    pub fn place(&self, p: DVec3) -> DVec2 {
        DVec2::new(self.right.dot(p), self.up.dot(p))
    }

    /// Makes the picture hold this point; without such points it holds everything.
    pub fn fit(&mut self, p: DVec3) {
        let place = self.place(p);
        self.fitted.push(place);
    }

    /// A plane polygon in one colour, darker the more it is turned away from the light, with its outline.
    pub fn face(&mut self, corners: &[DVec3], color: Color) {
        self.outlined_face(corners, color, color.mixed(Color::BLACK, 0.45), 0.6);
    }

    /// A shaded polygon with an outline of this colour and width in pixels.
    pub fn outlined_face(&mut self, corners: &[DVec3], color: Color, line: Color, width: f64) {
        let style = Style::fill(self.shaded(corners, color)).outlined(line, width);
        self.area(corners, style);
    }

    /// The colour of a polygon in the light.
    pub fn shaded(&self, corners: &[DVec3], color: Color) -> Color {
        let [a, b, c] = [0, corners.len() / 3, 2 * corners.len() / 3].map(|i| corners[i]);
        let normal = (b - a).cross(c - a).normalize_or_zero();
        // From the upper left, behind the viewer.
        let light = (self.toward + 0.45 * self.up - 0.35 * self.right).normalize();
        let facing = normal * normal.dot(self.toward).signum();
        color.mixed(Color::BLACK, 0.5 * (1.0 - facing.dot(light).max(0.0)))
    }

    /// Whether the side from which the corners run counter-clockwise is seen.
    pub fn is_front(&self, corners: &[DVec3]) -> bool {
        let [a, b, c] = [0, corners.len() / 3, 2 * corners.len() / 3].map(|i| corners[i]);
        (b - a).cross(c - a).dot(self.toward) > 0.0
    }

    /// A polygon.
    pub fn area(&mut self, corners: &[DVec3], style: Style) {
        let nearness = self.nearness(corners);
        let places = self.places(corners);
        self.things.push((nearness, Thing::Area(places, style)));
    }

    /// A line through points, part by part.
    pub fn line(&mut self, points: &[DVec3], style: Style) {
        for ends in points.windows(2) {
            let nearness = self.nearness(ends) + LIFT;
            let places = self.places(ends);
            self.things.push((nearness, Thing::Line(places, style)));
        }
    }

    /// A line over everything.
    pub fn line_over(&mut self, points: &[DVec3], style: Style) {
        let places = self.places(points);
        self.things
            .push((f64::INFINITY, Thing::Line(places, style)));
    }

    /// A closed area over everything.
    pub fn area_over(&mut self, points: &[DVec3], style: Style) {
        let places = self.places(points);
        self.things
            .push((f64::INFINITY, Thing::Area(places, style)));
    }

    /// An arrow over everything.
    pub fn arrow_over(&mut self, from: DVec3, to: DVec3, style: Style) {
        let ends = [self.place(from), self.place(to)];
        self.things.push((f64::INFINITY, Thing::Arrow(ends, style)));
    }

    /// A dot of a radius in pixels.
    pub fn dot(&mut self, p: DVec3, radius: f64, style: Style) {
        let nearness = self.nearness(&[p]) + 2.0 * LIFT;
        let place = self.place(p);
        self.things
            .push((nearness, Thing::Dot(place, radius, style)));
    }

    /// A dot over everything.
    pub fn dot_over(&mut self, p: DVec3, radius: f64, style: Style) {
        let place = self.place(p);
        self.things
            .push((f64::INFINITY, Thing::Dot(place, radius, style)));
    }

    /// A sphere, drawn as a disc of its radius, which an orthogonal view of it is.
    pub fn disc(&mut self, center: DVec3, radius: f64, style: Style) {
        let circle: Vec<DVec3> = (0..72)
            .map(|i| {
                let (sin, cos) = libm::sincos(std::f64::consts::TAU * f64::from(i) / 72.0);
                center + radius * (cos * self.right + sin * self.up)
            })
            .collect();
        self.area(&circle, style);
    }

    /// Words over everything.
    pub fn words(&mut self, at: DVec3, words: impl Into<String>, text: Text) {
        let place = self.place(at);
        self.things
            .push((f64::INFINITY, Thing::Words(place, words.into(), text)));
    }

    fn nearness(&self, points: &[DVec3]) -> f64 {
        points.iter().map(|p| self.toward.dot(*p)).sum::<f64>() / points.len().max(1) as f64
    }

    fn places(&self, points: &[DVec3]) -> Vec<DVec2> {
        points.iter().map(|&p| self.place(p)).collect()
    }

    /// The scene in a panel of this size in pixels.
    pub fn panel(&self, width: f64, height: f64) -> Panel {
        let everything = || {
            self.things.iter().flat_map(|(_, thing)| match thing {
                Thing::Area(places, _) | Thing::Line(places, _) => places.clone(),
                Thing::Arrow(ends, _) => ends.to_vec(),
                Thing::Dot(place, ..) | Thing::Words(place, ..) => vec![*place],
            })
        };
        let places: Vec<DVec2> = match self.fitted.is_empty() {
            true => everything().collect(),
            false => self.fitted.clone(),
        };
        let min = places.iter().copied().fold(DVec2::INFINITY, DVec2::min);
        let max = places.iter().copied().fold(DVec2::NEG_INFINITY, DVec2::max);
        let border = BORDER * (max - min).max_element();
        let mut panel = Panel::plane(width, height, min - border, max + border);
        let mut things: Vec<&(f64, Thing)> = self.things.iter().collect();
        things.sort_by(|a, b| a.0.total_cmp(&b.0));
        for (_, thing) in things {
            match thing {
                Thing::Area(places, style) => panel.polygon(places, *style),
                Thing::Line(places, style) => panel.polyline(places, *style),
                Thing::Arrow([from, to], style) => panel.arrow(*from, *to, 0.0, *style),
                Thing::Dot(place, radius, style) => panel.dot(*place, *radius, *style),
                Thing::Words(place, words, text) => panel.text(*place, words, *text),
            }
        }
        panel
    }
}
