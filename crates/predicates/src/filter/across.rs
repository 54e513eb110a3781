//! The static filters of a tetrahedron and what is around it, four tests at once.

use super::{HUGE, HUGE_WEIGHT, INSPHERE, POWER_TEST, StaticFilter, TINY};
use crate::lanes::{self, AcrossBounds, AtInfinity, FourSides, FourVerdicts, Registers};
use glam::DVec3;

impl StaticFilter {
    /// Which of the four neighbours of the positive tetrahedron `corners` have `p` inside their spheres, as
    /// far as the filters can say: four tests at once. Ties on a lattice (see [`with_unit`](Self::with_unit)) go as
    /// [`lifted::insphere`](crate::lifted::insphere) has them; `p` must be none of the vertices, and the neighbours positive. Neighbour i shares all corners but corner i, in whose
    /// place it has `opposite[i]`. The sphere of a neighbour with the vertex at infinity is the half-space beyond its other vertices.
    #[inline(always)]
    pub fn insphere_across<R: Registers>(
        &self,
        registers: R,
        corners: [DVec3; 4],
        opposite: [DVec3; 4],
        p: DVec3,
        at_infinity: AtInfinity,
    ) -> FourVerdicts {
        self.check(&corners);
        self.check(&opposite);
        let bounds = self.across_bounds(self.insphere, INSPHERE, self.half_unit_of_insphere);
        lanes::insphere_across(registers, corners, opposite, p, at_infinity, bounds)
    }

    /// [`insphere_across`](Self::insphere_across) for points with weights, which lie in the interval of
    /// [`with_weights`](Self::with_weights): of which neighbours the hyperplanes through the lifts have that of `p` below. Ties are not
    /// decided. The weight of the vertex at infinity has no say, but lies in the interval too.
    ///
    /// ```
    /// use glam::DVec3;
    /// use pellicle_predicates::StaticFilter;
    /// use pellicle_predicates::lanes::{AtInfinity, FourVerdicts, Registers, Vectorized, vectorized};
    ///
    /// struct Across(f64);
    /// impl Vectorized for Across {
    ///     type Output = FourVerdicts;
    ///     #[inline(always)]
    ///     fn run<R: Registers>(self, registers: R) -> FourVerdicts {
    ///         let filter = StaticFilter::from_bounds(DVec3::splat(-2.0), DVec3::splat(2.0)).with_weights(0.0, 9.0);
    ///         let corners = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z].map(|p| (p, 0.0));
    ///         let opposite = [(DVec3::ONE, 0.0), (-DVec3::X, 0.0), (-DVec3::Y, 0.0), (-DVec3::Z, 0.0)];
    ///         let p = (DVec3::splat(1.5), self.0);
    ///         filter.power_test_across(registers, corners, opposite, p, AtInfinity::default())
    ///     }
    /// }
    /// assert_eq!(vectorized(Across(0.0)), FourVerdicts { inside: 0b0000, outside: 0b1111 });
    /// assert_eq!(vectorized(Across(4.0)), FourVerdicts { inside: 0b0001, outside: 0b1110 });
    /// ```
    #[inline(always)]
    pub fn power_test_across<R: Registers>(
        &self,
        registers: R,
        corners: [(DVec3, f64); 4],
        opposite: [(DVec3, f64); 4],
        p: (DVec3, f64),
        at_infinity: AtInfinity,
    ) -> FourVerdicts {
        for points in [corners, opposite, [p; 4]] {
            self.check(&points.map(|(point, _)| point));
            self.check_weights(&points.map(|(_, weight)| weight));
        }
        let bounds = self.across_bounds(self.power_test, POWER_TEST, 0.0);
        lanes::power_test_across(registers, corners, opposite, p, at_infinity, bounds)
    }

    #[inline(always)]
    fn across_bounds(&self, of_box: f64, factor: f64, half_unit: f64) -> AcrossBounds {
        AcrossBounds {
            of_box,
            of_orientations: self.orient3d,
            half_unit,
            factor,
            least: TINY,
            most: HUGE,
            most_weight: HUGE_WEIGHT,
        }
    }

    /// On which side of the four facets of the positive tetrahedron `corners` the point `p` lies, as far as the filter can
    /// say: four tests at once. On a lattice (see [`with_unit`](Self::with_unit)) it can say it of all.
    #[inline(always)]
    pub fn sides_of_facets<R: Registers>(
        &self,
        registers: R,
        corners: [DVec3; 4],
        p: DVec3,
    ) -> FourSides {
        self.check(&corners);
        self.check(&[p]);
        let (bound, half_unit) = (self.orient3d, self.half_unit_of_orient3d);
        lanes::sides_of_facets(registers, corners, p, bound, half_unit)
    }
}
