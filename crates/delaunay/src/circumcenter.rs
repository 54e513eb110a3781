//! Circumcentres, well conditioned or not.

use glam::DVec3;

/// The circumcentre of four points that are not coplanar; `None` where it exceeds the range of doubles.
///
/// With u, v, w the edges from `a` it is
/// a + (|u|² v × w + |v|² w × u + |w|² u × v) / (2 u · v × w).
///
/// Where the determinant suffers cancellation, as in slivers, all is computed again with twice as many
/// digits, from the coordinates on: the relative error stays near 2⁻⁵³ times the condition number that is
/// left after the first 53 bits.
pub fn circumcenter(a: DVec3, b: DVec3, c: DVec3, d: DVec3) -> Option<DVec3> {
    let [u, v, w] = [b - a, c - a, d - a];
    let size = u.abs().max(v.abs()).max(w.abs()).max_element();
    if !(SMALLEST..LARGEST).contains(&size) {
        return circumcenter_scaled(a, b, c, d);
    }
    let (vw, wu, uv) = (v.cross(w), w.cross(u), u.cross(v));
    let determinant = u.dot(vw);
    let magnitude = u.length() * v.length() * w.length();
    let center = if determinant > ILL_CONDITIONED * magnitude {
        let sum = u.length_squared() * vw + v.length_squared() * wu + w.length_squared() * uv;
        a + sum / (2.0 * determinant)
    } else {
        a + precise_offset(a, b, c, d)
    };
    center.is_finite().then_some(center)
}

/// Below this share of the product of the edge lengths, a determinant of doubles has lost half its digits.
const ILL_CONDITIONED: f64 = 1e-7;

/// Edges within this range neither overflow nor underflow in the fifth power, at twice the digits.
const SMALLEST: f64 = 1e-40;
const LARGEST: f64 = 1e60;

/// The same after a scaling by a power of two.
#[cold]
fn circumcenter_scaled(a: DVec3, b: DVec3, c: DVec3, d: DVec3) -> Option<DVec3> {
    // Halves first: the difference of two finite doubles may overflow.
    let half = [a, b, c, d].map(|p| p * 0.5);
    let size = half[1..]
        .iter()
        .map(|p| (*p - half[0]).abs().max_element())
        .fold(0.0, f64::max);
    if size == 0.0 {
        return None;
    }
    let exponent = size.log2().floor();
    // In two steps: 2^-exponent itself may be out of range.
    let scale = [
        (-exponent / 2.0).floor(),
        -exponent - (-exponent / 2.0).floor(),
    ]
    .map(f64::exp2);
    let [a, b, c, d] = half.map(|p| p * scale[0] * scale[1]);
    // Only the differences have to be small; far from the origin they are exact.
    let offset = precise_offset(a, b, c, d);
    let center = half[0] + offset / scale[0] / scale[1];
    let center = center * 2.0;
    center.is_finite().then_some(center)
}

/// From `a` to the circumcentre, with twice the digits.
#[cold]
fn precise_offset(a: DVec3, b: DVec3, c: DVec3, d: DVec3) -> DVec3 {
    let edge = |p: DVec3| [0, 1, 2].map(|axis| DoubleDouble::difference(p[axis], a[axis]));
    let [u, v, w] = [edge(b), edge(c), edge(d)];
    let (vw, wu, uv) = (cross(v, w), cross(w, u), cross(u, v));
    let determinant = dot(u, vw);
    let squares = [dot(u, u), dot(v, v), dot(w, w)];
    let component = |axis: usize| {
        let sum = squares[0] * vw[axis] + squares[1] * wu[axis] + squares[2] * uv[axis];
        sum.high / (2.0 * determinant.high)
    };
    DVec3::new(component(0), component(1), component(2))
}

fn dot(u: [DoubleDouble; 3], v: [DoubleDouble; 3]) -> DoubleDouble {
    u[0] * v[0] + u[1] * v[1] + u[2] * v[2]
}

fn cross(u: [DoubleDouble; 3], v: [DoubleDouble; 3]) -> [DoubleDouble; 3] {
    [
        u[1] * v[2] - u[2] * v[1],
        u[2] * v[0] - u[0] * v[2],
        u[0] * v[1] - u[1] * v[0],
    ]
}

/// The unevaluated sum of two doubles: about 106 bits (Dekker 1971).
#[derive(Clone, Copy)]
struct DoubleDouble {
    high: f64,
    low: f64,
}

impl DoubleDouble {
    /// a − b without error (Knuth's two-sum).
    fn difference(a: f64, b: f64) -> Self {
        let high = a - b;
        let b_virtual = a - high;
        let a_virtual = high + b_virtual;
        Self {
            high,
            low: (a - a_virtual) + (b_virtual - b),
        }
    }

    fn renormalized(high: f64, low: f64) -> Self {
        let sum = high + low;
        Self {
            high: sum,
            low: low - (sum - high),
        }
    }
}

impl std::ops::Neg for DoubleDouble {
    type Output = Self;
    fn neg(self) -> Self {
        Self {
            high: -self.high,
            low: -self.low,
        }
    }
}

impl std::ops::Add for DoubleDouble {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        let high = Self::difference(self.high, -other.high);
        let low = Self::difference(self.low, -other.low);
        let sum = Self::renormalized(high.high, high.low + low.high);
        Self::renormalized(sum.high, sum.low + low.low)
    }
}

impl std::ops::Sub for DoubleDouble {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl std::ops::Mul for DoubleDouble {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let high = self.high * other.high;
        // Exact: a fused multiply-add rounds once.
        let error = self.high.mul_add(other.high, -high);
        Self::renormalized(
            high,
            error + (self.high * other.low + self.low * other.high),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use dashu::rational::RBig;
    use proptest::prelude::*;

    fn exact(a: DVec3, b: DVec3, c: DVec3, d: DVec3) -> Option<DVec3> {
        let rational = |x: f64| RBig::try_from(x).unwrap();
        let edge = |p: DVec3| [0, 1, 2].map(|i| rational(p[i]) - rational(a[i]));
        let cross = |u: &[RBig; 3], v: &[RBig; 3]| {
            [(1, 2), (2, 0), (0, 1)].map(|(i, j)| &u[i] * &v[j] - &u[j] * &v[i])
        };
        let dot = |u: &[RBig; 3], v: &[RBig; 3]| &u[0] * &v[0] + &u[1] * &v[1] + &u[2] * &v[2];
        let [u, v, w] = [edge(b), edge(c), edge(d)];
        let (vw, wu, uv) = (cross(&v, &w), cross(&w, &u), cross(&u, &v));
        let determinant = dot(&u, &vw);
        if determinant == RBig::ZERO {
            return None;
        }
        let center = [0, 1, 2].map(|i| {
            let sum = dot(&u, &u) * &vw[i] + dot(&v, &v) * &wu[i] + dot(&w, &w) * &uv[i];
            let offset: RBig = sum / (RBig::from(2) * &determinant);
            (offset + rational(a[i])).to_f64().value()
        });
        Some(DVec3::from(center))
    }

    fn coordinate(flatness: f64) -> impl Strategy<Value = DVec3> {
        (-1.0..1.0, -1.0..1.0, -1.0..1.0)
            .prop_map(move |(x, y, z)| DVec3::new(x, y, 0.3 * x + 0.1 * y + flatness * z))
    }

    fn four() -> impl Strategy<Value = [DVec3; 4]> {
        prop_oneof![Just(1.0), Just(1e-6), Just(1e-12), Just(1e-15)].prop_flat_map(|flatness| {
            [
                coordinate(flatness),
                coordinate(flatness),
                coordinate(flatness),
                coordinate(flatness),
            ]
        })
    }

    proptest! {
        #[test]
        fn agrees_with_rationals_slivers_included(
            [a, b, c, d] in four(),
            scale in prop_oneof![Just(1.0), Just(1e-100), Just(1e150)],
        ) {
            let [a, b, c, d] = [a, b, c, d].map(|p| p * scale);
            if let Some(expected) = exact(a, b, c, d) {
                let radius = expected.distance(a);
                // A flat tetrahedron of negative orientation has the same circumcentre.
                let found = circumcenter(a, b, c, d).unwrap();
                prop_assert!(
                    found.distance(expected) <= 1e-8 * radius,
                    "{found} for {expected}"
                );
            }
        }
    }

    #[test]
    fn the_widest_tetrahedra_have_one_within_range() {
        let corner = f64::MAX / 4.0;
        let center = circumcenter(
            DVec3::ZERO,
            DVec3::X * corner,
            DVec3::Y * corner,
            DVec3::Z * corner,
        );
        assert_eq!(center, Some(DVec3::splat(corner / 2.0)));
    }
}
