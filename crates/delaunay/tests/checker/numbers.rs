//! Exact signs by definition: in big integers always, in plain integers where they fit, and by `robust` within its range.

use dashu::integer::IBig;
use std::cmp::Ordering;
use std::ops::{Add, Mul, Sub};

pub type Big = IBig;

/// A ring of integers.
pub trait Number:
    Clone + Ord + Sync + Send + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self>
{
    const NONE: Self;
}

impl Number for Big {
    const NONE: Self = IBig::ZERO;
}

impl Number for i128 {
    const NONE: Self = 0;
}

/// Points as multiples of one power of two.
pub struct Integers<T> {
    pub points: Vec<[T; 3]>,
}

impl Integers<Big> {
    pub fn of(points: &[[f64; 3]]) -> Self {
        let coordinates = points.iter().flatten().map(|&c| decoded(c));
        let lowest = coordinates.filter(|c| c.0 != 0).map(|c| c.1).min();
        let lowest = lowest.unwrap_or(0);
        let integer = |c: f64| {
            let (mantissa, exponent) = decoded(c);
            match mantissa {
                0 => Big::ZERO,
                _ => Big::from(mantissa) << (exponent - lowest) as usize,
            }
        };
        Self {
            points: points.iter().map(|p| p.map(integer)).collect(),
        }
    }
}

impl Integers<i128> {
    /// `None` where a determinant might not fit: a coordinate is no integer, or has more than 20 bits.
    ///
    /// Differences then have 22 bits with their sign, so volumes have 66 and squares of distances 45: the sum of four products
    /// has fewer than 115.
    fn of(points: &[[f64; 3]]) -> Option<Self> {
        let fits = |&c: &f64| c.fract() == 0.0 && c.abs() <= f64::from(1 << 20);
        let all = points.iter().flatten().all(fits);
        all.then(|| Self {
            points: points.iter().map(|p| p.map(|c| c as i128)).collect(),
        })
    }
}

impl<T: Number> Integers<T> {
    /// The sign of the volume of a tetrahedron: positive if its last three corners turn counter-clockwise around the axis from
    /// the first to them, a right-handed frame.
    pub fn orientation(&self, corners: [u32; 4]) -> Ordering {
        let [a, b, c, d] = corners.map(|v| &self.points[v as usize]);
        det3(&difference(b, a), &difference(c, a), &difference(d, a)).cmp(&T::NONE)
    }

    /// `Greater` when the point is inside the sphere of a positive tetrahedron: when its lift, its squared distance from
    /// anywhere, is less than what the corners' lifts amount to there. From the point itself, whose lift then is zero:
    /// Σ λᵢ |cornerᵢ − point|² > 0. A barycentric coordinate λᵢ is the volume with the point in the place of corner i, over the
    /// whole volume, which is positive.
    pub fn sphere(&self, corners: [u32; 4], point: u32) -> Ordering {
        let point = &self.points[point as usize];
        let [a, b, c, d] = corners.map(|v| difference(&self.points[v as usize], point));
        let raised = |p: &[T; 3]| p.iter().fold(T::NONE, |sum, x| sum + x.clone() * x.clone());
        // (point, b, c, d), (a, point, c, d), (a, b, point, d), (a, b, c, point), the point brought to the front.
        let sum = det3(&b, &c, &d) * raised(&a) - det3(&a, &c, &d) * raised(&b)
            + det3(&a, &b, &d) * raised(&c)
            - det3(&a, &b, &c) * raised(&d);
        sum.cmp(&T::NONE)
    }
}

/// a − b.
pub fn difference<T: Number>(a: &[T; 3], b: &[T; 3]) -> [T; 3] {
    std::array::from_fn(|axis| a[axis].clone() - b[axis].clone())
}

/// a · (b × c).
pub fn det3<T: Number>(a: &[T; 3], b: &[T; 3], c: &[T; 3]) -> T {
    let minor = |i: usize, j: usize| b[i].clone() * c[j].clone() - b[j].clone() * c[i].clone();
    a[0].clone() * minor(1, 2) + a[1].clone() * minor(2, 0) + a[2].clone() * minor(0, 1)
}

/// The fastest of the ways that are right for these points.
pub enum Signs<'a> {
    Integers(Integers<i128>),
    /// Shewchuk's adaptive predicates, right as long as nothing over- or underflows.
    Doubles(&'a [[f64; 3]]),
    Big(Integers<Big>),
}

impl<'a> Signs<'a> {
    pub fn of(points: &'a [[f64; 3]]) -> Self {
        if let Some(integers) = Integers::<i128>::of(points) {
            return Self::Integers(integers);
        }
        // The least term of an in-sphere expansion is a product of five last bits, 2⁻⁵² of a coordinate each, the largest a
        // product of five coordinates and some more bits.
        let within =
            |&c: &f64| c == 0.0 || (2.0_f64.powi(-100)..=2.0_f64.powi(150)).contains(&c.abs());
        match points.iter().flatten().all(within) {
            true => Self::Doubles(points),
            false => Self::Big(Integers::<Big>::of(points)),
        }
    }

    pub fn orientation(&self, corners: [u32; 4]) -> Ordering {
        match self {
            Self::Integers(integers) => integers.orientation(corners),
            Self::Big(integers) => integers.orientation(corners),
            Self::Doubles(points) => {
                let [a, b, c, d] = corners.map(|v| coordinates(points[v as usize]));
                // Shewchuk's orientation has the other sign.
                sign(-robust::orient3d(a, b, c, d))
            }
        }
    }

    pub fn sphere(&self, corners: [u32; 4], point: u32) -> Ordering {
        match self {
            Self::Integers(integers) => integers.sphere(corners, point),
            Self::Big(integers) => integers.sphere(corners, point),
            Self::Doubles(points) => {
                let [a, b, c, d] = corners.map(|v| coordinates(points[v as usize]));
                // The same for a tetrahedron whose orientation has the other sign.
                sign(-robust::insphere(
                    a,
                    b,
                    c,
                    d,
                    coordinates(points[point as usize]),
                ))
            }
        }
    }
}

fn coordinates([x, y, z]: [f64; 3]) -> robust::Coord3D<f64> {
    robust::Coord3D { x, y, z }
}

fn sign(value: f64) -> Ordering {
    value.partial_cmp(&0.0).expect("a determinant is a number")
}

/// (m, e) with m · 2ᵉ the value, which is finite.
fn decoded(value: f64) -> (i64, i32) {
    let bits = value.to_bits();
    let fraction = (bits & ((1 << 52) - 1)) as i64;
    let (mantissa, exponent) = match (bits >> 52 & 0x7ff) as i32 {
        0 => (fraction, -1074),
        biased => (fraction | 1 << 52, biased - 1075),
    };
    (
        if value.is_sign_negative() {
            -mantissa
        } else {
            mantissa
        },
        exponent,
    )
}
