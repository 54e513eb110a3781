//! Whether points lie on a lattice: scans with a fixed step, grids, rounded coordinates.

use glam::DVec3;
use pellicle_geometry::Aabb;

/// A lattice finer than this part of the box is none: no determinant of few neighbours would be recognised as
/// zero.
const FINEST: f64 = 1.0 / (1_u64 << 40) as f64;

/// The largest power of two of which all coordinates are multiples; 0 where it is a tiny part of the box. Linear
/// time; most often the first point tells.
pub(super) fn unit(points: &[DVec3], bounds: Aabb) -> f64 {
    let least = (bounds.max - bounds.min).max_element() * FINEST;
    let mut unit = f64::INFINITY;
    for coordinate in points.iter().flat_map(|p| p.to_array()) {
        if coordinate != 0.0 {
            unit = unit.min(last_bit(coordinate));
            if unit <= least {
                return 0.0;
            }
        }
    }
    unit
}

/// The value of the last bit that is set in a number.
fn last_bit(x: f64) -> f64 {
    let bits = x.abs().to_bits();
    // All bits behind the last one set, and it, cleared: what is taken away is its value.
    let without = f64::from_bits(bits & (bits - 1));
    match bits << 12 {
        0 => x.abs(),
        _ => x.abs() - without,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_bit_of_a_number() {
        for (number, bit) in [
            (1.0, 1.0),
            (-3.0, 1.0),
            (12.0, 4.0),
            (0.375, 0.125),
            (5e-324, 5e-324),
            (f64::MIN_POSITIVE, f64::MIN_POSITIVE),
            (3.0 * 5e-324, 5e-324),
            (f64::MAX, 2_f64.powi(971)),
        ] {
            assert_eq!(last_bit(number), bit, "{number}");
        }
    }

    #[test]
    fn only_coarse_lattices_count() {
        let unit_of = |points: &[DVec3]| unit(points, Aabb::of_points(points));
        let quarters = [DVec3::ZERO, DVec3::new(0.75, 6.5, -100.0)];
        assert_eq!(unit_of(&quarters), 0.25);
        assert_eq!(unit_of(&[DVec3::ZERO, DVec3::splat(0.1)]), 0.0);
    }
}
