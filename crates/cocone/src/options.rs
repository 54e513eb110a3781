//! How to reconstruct.

/// Options of [`reconstruct`](crate::reconstruct).
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Options {
    /// Which member of the family. Default: [`Method::Cocone`].
    pub method: Method,
    /// Which triangles are candidates. Default: [`Acceptance::AnyVertex`].
    pub acceptance: Acceptance,
}

/// A member of the Cocone family.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Method {
    /// Cocone (Dey 2006, chapter 4): the surface as far as the sample supports it. Places that are
    /// undersampled, and the borders of open surfaces, stay open.
    #[default]
    Cocone,
    /// Tight Cocone (Dey and Goswami 2003): always closed, never empty, a manifold, free of
    /// self-intersections.
    TightCocone,
}

/// Which facets become candidates, given which of their vertices have them in their cocones. Only flat,
/// well-sampled vertices are asked.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Acceptance {
    /// One of the vertices suffices: T = ∪ T_p (Dey 2006).
    #[default]
    AnyVertex,
    /// All of the vertices must agree (Amenta et al. 2002).
    AllVertices,
}
