//! The table of `filter.rs`, counted by machine: the determinants over numbers that know how often they were
//! rounded and how large their monomials are.

use crate::{
    determinant::{self, Ring},
    filter,
};

/// A computed number, as the error analysis sees it.
#[derive(Clone, Debug)]
struct Rounded {
    /// The most roundings on the way of any monomial.
    roundings: u32,
    /// Σ |monomials|.
    monomials: f64,
}

impl Rounded {
    /// A difference of two doubles.
    fn difference(magnitude: f64) -> Self {
        Self {
            roundings: 1,
            monomials: magnitude,
        }
    }
}

impl Ring for Rounded {
    fn add(&self, other: &Self) -> Self {
        Self {
            roundings: self.roundings.max(other.roundings) + 1,
            monomials: self.monomials + other.monomials,
        }
    }
    fn sub(&self, other: &Self) -> Self {
        self.add(other)
    }
    fn mul(&self, other: &Self) -> Self {
        Self {
            roundings: self.roundings + other.roundings + 1,
            monomials: self.monomials * other.monomials,
        }
    }
}

/// The bound is k u Σ |monomials|, and at most a two-hundredth more.
fn check(value: Rounded, bound: f64) {
    let unit_roundoff = f64::EPSILON / 2.0;
    let least = f64::from(value.roundings) * unit_roundoff * value.monomials;
    let ratio = bound / least;
    assert!((1.0015..1.005).contains(&ratio), "{value:?}: {ratio}");
}

/// Extents of every order, the larger ones in each place.
fn extents() -> impl Iterator<Item = [f64; 3]> {
    let sizes = [1.0, 0.37, 1e-9, 3e20];
    (0..64).map(move |i| [sizes[i & 3], sizes[i >> 2 & 3], sizes[i >> 4]])
}

#[test]
fn the_bounds_are_those_of_the_formulas() {
    for extents in extents() {
        let space = extents.map(Rounded::difference);
        let plane = [extents[0], extents[1]].map(Rounded::difference);
        let (p, q) = (&space, &plane);
        let [x, y, _] = extents;
        check(determinant::orient2d(q, q), filter::orient2d_bound([x, y]));
        check(
            determinant::orient3d(p, p, p),
            filter::orient3d_bound(extents),
        );
        check(
            determinant::incircle(q, q, q),
            filter::incircle_bound([x, y]),
        );
        check(
            determinant::insphere(p, p, p, p),
            filter::insphere_bound(extents),
        );
        let value = determinant::insphere(p, p, p, p);
        let bound = filter::magnitudes::insphere_bound(value.monomials);
        check(value, bound);
        for weight in [0.0, 1e-30, 0.2, 1e12, 1e80] {
            let weights = [0; 4].map(|_| Rounded::difference(weight));
            check(
                determinant::power_test([p; 4], &weights),
                filter::power_test_bound(extents, weight),
            );
        }
    }
}

/// The counts of the table.
#[test]
fn roundings_by_determinant() {
    let p = &[1.0; 3].map(Rounded::difference);
    let q = &[1.0; 2].map(Rounded::difference);
    let weights = [0; 4].map(|_| Rounded::difference(1.0));
    let counted = [
        determinant::orient2d(q, q),
        determinant::orient3d(p, p, p),
        determinant::incircle(q, q, q),
        determinant::insphere(p, p, p, p),
        determinant::power_test([p; 4], &weights),
    ];
    let counted = counted.map(|value| (value.roundings, value.monomials));
    assert_eq!(
        counted,
        [(4, 2.0), (8, 6.0), (11, 12.0), (16, 72.0), (17, 96.0)]
    );
}
