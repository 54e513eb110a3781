//! Figure 4: on which side the growing region goes on at a crossing.

use super::toy::RED;
use super::watch::{Seen, append, copies, cube, double_cone, is_clean, repaired};
use crate::sheet::{Anchor, Color, Panel, Style, Text};
use crate::{Error, Made, Number, Run, Sheet, Verdict};
use pellicle::geometry::triangle;
use pellicle::glam::{DMat3, DVec2};
use pellicle::mesh::TriangleId;
use pellicle::prelude::*;
use pellicle::transformesh::{Rule, Segment};

/// Two bodies that meet, and one that is drawn together till it parts: the two ways in which sheets cross.
pub fn make(run: &Run) -> Result<Made, Error> {
    let mut sheet = Sheet::new(2);
    let mut numbers = Vec::new();
    let mut holds = true;
    for (name, soup, is_merge, words) in [
        (
            "join",
            two_bodies(),
            true,
            "Two bodies have moved into each other: the outside goes on where the kept sheets make a \
                                      hollow edge, of more than 180° inside. Dashed parts are dropped.",
        ),
        (
            "split",
            waist(),
            false,
            "A body whose waist was turned inside out: the outside goes on where the kept sheets make a \
                                   ridge, of less than 180° inside.",
        ),
    ] {
        run.step("repair", u64::from(!is_merge), 2)?;
        let (mesh, report, seen) = repaired(&soup, Rule::Union)?;
        let view = SideView::of(&soup, &seen)?;
        let inside = view.inside_angle();
        holds &= is_clean(&mesh)?
            && (inside > 180.0) == is_merge
            && view.halves.iter().filter(|h| h.is_kept).count() == 2;
        holds &= view.normals_oppose();
        numbers.push(
            Number::within(
                format!("{name}: angle inside between the kept parts"),
                inside,
                1e-9,
            )
            .unit("°"),
        );
        numbers.push(Number::exactly(
            format!("{name}: parts kept of four"),
            view.halves.iter().filter(|h| h.is_kept).count() as f64,
        ));
        numbers.push(
            Number::exactly(
                format!("{name}: normals opposed when folded"),
                f64::from(u8::from(view.normals_oppose())),
            )
            .paper("1"),
        );
        numbers.push(Number::exactly(
            format!("{name}: components before"),
            report.components[0] as f64,
        ));
        numbers.push(Number::exactly(
            format!("{name}: components after"),
            report.components[1] as f64,
        ));
        sheet.push(view.panel().caption(words));
    }
    Ok(Made {
        sheet,
        numbers,
        verdict: if holds { Verdict::Agrees } else { Verdict::Different },
        because: "Both are cuts through real results, across a segment in which two triangles meet. The paper's rule, that the \
                  normals of the two kept parts oppose each other when these are folded onto each other, holds in both cases; \
                  the library reaches it by winding numbers on both sides of each part, which also decide where more than two \
                  sheets meet."
            .into(),
    })
}

/// Two cubes that overlap, the second turned.
fn two_bodies() -> TriangleSoup {
    let mut soup = copies(&cube(), &[DVec3::ZERO]);
    let turn = DMat3::from_cols(
        DVec3::new(2.0, 2.0, -1.0),
        DVec3::new(-1.0, 2.0, 2.0),
        DVec3::new(2.0, -1.0, 2.0),
    ) / 3.0;
    let mut other = cube();
    for p in &mut other.positions {
        *p = turn * *p + DVec3::new(0.45, -0.1, 0.25);
    }
    append(&mut soup, &other);
    soup
}

/// A double cone over a bow tie with a crossed middle: the loop between the crossings winds the other way round.
fn waist() -> TriangleSoup {
    let half = [
        [1.3, 0.7],
        [0.7, 0.55],
        [0.25, -0.12],
        [-0.25, -0.12],
        [-0.7, 0.55],
        [-1.3, 0.7],
    ]
    .map(DVec2::from);
    let other = half.iter().map(|p| -*p);
    double_cone(&half.into_iter().chain(other).collect::<Vec<_>>())
}

/// Half a triangle as seen along the segment: a ray from the middle.
struct Half {
    /// Which of the two triangles.
    which: usize,
    direction: DVec2,
    normal: DVec2,
    is_kept: bool,
}

/// The plane across a segment.
struct SideView {
    halves: Vec<Half>,
}

impl SideView {
    /// Across the longest segment both of whose triangles are kept on one side and dropped on the other.
    fn of(soup: &TriangleSoup, seen: &Seen) -> Result<Self, Error> {
        let views = seen.segments.iter().filter_map(|segment| {
            let halves = halves(soup, seen, segment)?;
            let is_clear = [0, 1].iter().all(|&which| {
                halves
                    .iter()
                    .filter(|half| half.which == which && half.is_kept)
                    .count()
                    == 1
            });
            is_clear.then(|| (segment.ends[0].distance(segment.ends[1]), Self { halves }))
        });
        let longest = views.max_by(|a, b| a.0.total_cmp(&b.0));
        longest
            .map(|(_, view)| view)
            .ok_or_else(|| Error::NotShown("a crossing".into()))
    }

    fn kept(&self) -> [&Half; 2] {
        let mut kept = self.halves.iter().filter(|half| half.is_kept);
        [kept.next(), kept.next()].map(|half| half.unwrap_or(&self.halves[0]))
    }

    /// The angle from one kept part to the other through the side that their normals face away from, in degrees.
    fn inside_angle(&self) -> f64 {
        let [a, b] = self.kept();
        let least = a.direction.angle_to(b.direction).abs().to_degrees();
        // The short way from a to b leads to a's inside, or away from it.
        let toward = b.direction - a.direction.dot(b.direction) * a.direction;
        if toward.dot(a.normal) < 0.0 {
            least
        } else {
            360.0 - least
        }
    }

    /// Whether, with the second part folded onto the first, the normals point to opposite sides.
    fn normals_oppose(&self) -> bool {
        let [a, b] = self.kept();
        // Turned with its part, a normal keeps its side of the ray.
        a.direction.perp_dot(a.normal) * b.direction.perp_dot(b.normal) < 0.0
    }

    fn panel(&self) -> Panel {
        let mut panel = Panel::plane(480.0, 400.0, DVec2::new(-1.2, -1.0), DVec2::new(1.2, 1.0));
        let [a, b] = self.kept();
        // The inside, as a wedge.
        let turn = self.inside_angle().to_radians();
        let start = a.direction;
        let sense = -start.perp_dot(a.normal).signum();
        let mut wedge = vec![DVec2::ZERO];
        wedge
            .extend((0..=60).map(|i| {
                2.0 * DVec2::from_angle(sense * turn * f64::from(i) / 60.0).rotate(start)
            }));
        panel.polygon(&wedge, Style::fill(Color::PALE.mixed(Color::WHITE, 0.35)));
        let inside = 0.62 * DVec2::from_angle(sense * 0.5 * turn).rotate(start);
        panel.text(
            inside,
            "inside",
            Text::default().size(13.0).color(Color::GRAY),
        );
        for half in &self.halves {
            let color = [Color::BLUE, Color::VERMILION][half.which];
            let style = match half.is_kept {
                true => Style::stroke(color, 4.5),
                false => Style::stroke(color, 1.8).dashed(7.0),
            };
            panel.line(DVec2::ZERO, 0.95 * half.direction, style);
            let at = 0.6 * half.direction;
            let arrow = match half.is_kept {
                true => Style::fill(color).outlined(color, 2.0),
                false => Style::fill(color).outlined(color, 1.0).opacity(0.5),
            };
            panel.arrow(at, at + 0.24 * half.normal, 0.0, arrow);
        }
        let text = Text::default().size(14.0).halo().anchor(Anchor::Middle);
        for (half, name) in [(a, "t"), (b, "N(t)")] {
            let color = [Color::BLUE, Color::VERMILION][half.which];
            panel.text(
                1.02 * half.direction,
                name,
                text.bold().color(color).shift(0.0, 5.0),
            );
        }
        panel.dot(DVec2::ZERO, 5.0, Style::fill(RED));
        panel
    }
}

fn halves(soup: &TriangleSoup, seen: &Seen, segment: &Segment) -> Option<Vec<Half>> {
    let [from, to] = segment.ends;
    let axis = (to - from).normalize_or_zero();
    if axis == DVec3::ZERO {
        return None;
    }
    let middle = 0.5 * (from + to);
    let normals = segment.triangles.map(|t| normal(soup, t));
    let [Some(n), Some(_)] = normals else {
        return None;
    };
    // The first triangle lies level.
    let (x, y) = (n.cross(axis), n);
    let flat = |v: DVec3| DVec2::new(v.dot(x), v.dot(y)).normalize();
    let mut halves = Vec::new();
    for (which, (&t, normal)) in segment.triangles.iter().zip(normals).enumerate() {
        let normal = normal?;
        for sign in [1.0, -1.0] {
            let direction = sign * normal.cross(axis);
            let probe = middle + 1e-4 * direction;
            let is_there = |corners: &[DVec3; 3]| {
                (0..3).all(|i| {
                    let [a, b] = [corners[i], corners[(i + 1) % 3]];
                    (b - a).cross(probe - a).dot(normal) >= 0.0
                })
            };
            // The triangle has to go on to this side.
            if !is_there(&soup.triangles[t.index()].map(|v| soup.positions[v.index()])) {
                return None;
            }
            let is_kept = seen
                .grown
                .iter()
                .any(|piece| piece.triangle == t && is_there(&piece.corners));
            halves.push(Half {
                which,
                direction: flat(direction),
                normal: flat(normal),
                is_kept,
            });
        }
    }
    Some(halves)
}

fn normal(soup: &TriangleSoup, t: TriangleId) -> Option<DVec3> {
    let [a, b, c] = soup.triangles[t.index()].map(|v| soup.positions[v.index()]);
    triangle::unit_normal(a, b, c)
}
