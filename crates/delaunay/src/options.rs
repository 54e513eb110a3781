//! How to tetrahedralise.

/// Options of [`tetrahedralize`](crate::tetrahedralize); none of them changes which tetrahedra result.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Options {
    /// The order in which the points are inserted. Default: [`InsertionOrder::Brio`], by far the fastest.
    pub order: InsertionOrder,
}

/// The order of insertion.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum InsertionOrder {
    /// Biased randomised rounds along the Hilbert curve, which depend on the coordinates alone: the arrays
    /// too come out the same for every order of the points.
    #[default]
    Brio,
    /// As the points are given, for points that come in a good order already, and for tests. Up to
    /// quadratic where consecutive points are far apart.
    AsGiven,
}
