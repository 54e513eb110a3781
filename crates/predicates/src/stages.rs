//! One stage alone: what it decides, for measurements of success and cost.
//!
//! ```
//! use glam::DVec3;
//! use pellicle_predicates::{Sign, insphere, stages, statistics::Stage};
//!
//! let [a, b, c, d] = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
//! let tie = |stage| stages::insphere(stage, a, b, c, d, DVec3::ONE);
//! // On the sphere: no filter can tell, integers of any width do.
//! assert_eq!(tie(Stage::SemiStatic), None);
//! assert_eq!(tie(Stage::AnyWidth), Some(Sign::Zero));
//! assert_eq!(insphere(a, b, c, d, DVec3::ONE), Sign::Zero);
//! ```

use crate::statistics::Stage;
use crate::{Sign, exact, filter, fixed, lattice, unfiltered};
use glam::DVec3;

/// [`orient3d`](crate::orient3d) by one stage: `None` where it is not sure.
///
/// Always `None` for [`Stage::Static`], which needs a box
/// ([`StaticFilter::orient3d_filtered`](crate::StaticFilter::orient3d_filtered)), and for [`Stage::Perturbation`], which is no
/// stage of the plain predicate. Never `None` for [`Stage::AnyWidth`].
pub fn orient3d(stage: Stage, a: DVec3, b: DVec3, c: DVec3, d: DVec3) -> Option<Sign> {
    match stage {
        Stage::Static | Stage::Perturbation => None,
        Stage::SemiStatic => filter::orient3d(a, b, c, d),
        Stage::Lattice => lattice::orient3d(a, b, c, d),
        Stage::FixedWidth => fixed::orient3d(a, b, c, d),
        Stage::Interval => unfiltered::interval_orient3d(a, b, c, d).sign(),
        Stage::AnyWidth => Some(exact::orient3d(a, b, c, d)),
    }
}

/// [`insphere`](crate::insphere) by one stage: `None` where it is not sure.
///
/// Always `None` for [`Stage::Static`], which needs a box
/// ([`StaticFilter::insphere_filtered`](crate::StaticFilter::insphere_filtered)), and for [`Stage::Perturbation`], which is no
/// stage of the plain predicate. Never `None` for [`Stage::AnyWidth`].
pub fn insphere(stage: Stage, a: DVec3, b: DVec3, c: DVec3, d: DVec3, e: DVec3) -> Option<Sign> {
    match stage {
        Stage::Static | Stage::Perturbation => None,
        Stage::SemiStatic => filter::insphere(a, b, c, d, e),
        Stage::Lattice => lattice::insphere(a, b, c, d, e),
        Stage::FixedWidth => fixed::insphere(a, b, c, d, e),
        Stage::Interval => unfiltered::interval_insphere(a, b, c, d, e).sign(),
        Stage::AnyWidth => Some(exact::insphere(a, b, c, d, e)),
    }
}
