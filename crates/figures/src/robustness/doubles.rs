//! The slides' formulas, in doubles: what rounding makes of them is what the figures show.

use pellicle::glam::DVec2;

/// (qx − px)(ry − py) − (qy − py)(rx − px): positive when p, q, r turn counter-clockwise.
pub(super) fn orient(p: DVec2, q: DVec2, r: DVec2) -> f64 {
    (q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x)
}

/// The same as the determinant of three rows 1, x, y.
pub(super) fn orient_of_rows(p: DVec2, q: DVec2, r: DVec2) -> f64 {
    area(q, r) - area(p, r) + area(p, q)
}

/// The determinant of four rows 1, x, y, x² + y²: positive when d is inside the circle through a, b and c, which turn
/// counter-clockwise.
pub(super) fn in_disk_of_rows([a, b, c]: [DVec2; 3], d: DVec2) -> f64 {
    // Along the last column; each cofactor is the orientation of the other three.
    let turn = |p: DVec2, q: DVec2, r: DVec2| area(p, q) - area(p, r) + area(q, r);
    square(a) * turn(b, c, d) - square(b) * turn(a, c, d) + square(c) * turn(a, b, d)
        - square(d) * turn(a, b, c)
}

/// The same, d moved into the origin first.
pub(super) fn in_disk(corners: [DVec2; 3], d: DVec2) -> f64 {
    let [a, b, c] = corners.map(|p| p - d);
    square(a) * area(b, c) - square(b) * area(a, c) + square(c) * area(a, b)
}

/// By constructing the center and the radius of the circle through a, b and c.
pub(super) fn in_disk_by_center([a, b, c]: [DVec2; 3], d: DVec2) -> f64 {
    let (p, q) = (b - a, c - a);
    let center = a + (q.perp() * -square(p) + p.perp() * square(q)) / (2.0 * area(p, q));
    let radius = square(a - center).sqrt();
    radius - square(d - center).sqrt()
}

fn area(p: DVec2, q: DVec2) -> f64 {
    p.x * q.y - p.y * q.x
}

fn square(p: DVec2) -> f64 {
    p.x * p.x + p.y * p.y
}

#[cfg(test)]
mod tests {
    use super::*;
    use pellicle::predicates::{Sign, incircle, orient2d};

    #[test]
    fn orientations_have_the_exact_sign_where_it_is_clear() {
        for (p, q, r) in [
            ([0.0, 0.0], [1.0, 0.0], [0.3, 1.0]),
            ([1.0, 2.0], [-1.0, 0.5], [3.0, -1.0]),
            ([0.0, 0.0], [1.0, 1.0], [2.0, 2.0]),
        ] {
            let [p, q, r] = [p, q, r].map(DVec2::from);
            let exact = orient2d(p, q, r);
            let found = [orient(p, q, r), orient_of_rows(p, q, r)].map(Sign::of);
            assert_eq!(found, [exact; 2]);
        }
    }

    #[test]
    fn in_disk_tests_have_the_exact_sign_where_it_is_clear() {
        let [a, b, c] = [[0.25, 0.0], [1.0, 0.0], [0.0, 1.5]].map(DVec2::from);
        for d in [[0.5, 0.5], [0.9, 0.8], [2.0, 2.0], [-1.0, 0.0]].map(DVec2::from) {
            let exact = incircle(a, b, c, d);
            let corners = [a, b, c];
            let found = [in_disk(corners, d), in_disk_of_rows(corners, d)];
            assert_eq!(found.map(Sign::of), [exact; 2], "{d}");
            assert_eq!(Sign::of(in_disk_by_center(corners, d)), exact, "{d}");
            // Only the determinants turn with the orientation.
            let turned = [b, a, c];
            let found = [in_disk(turned, d), in_disk_of_rows(turned, d)];
            assert_eq!(found.map(Sign::of), [-exact; 2], "{d}");
        }
    }
}
