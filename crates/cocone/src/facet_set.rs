//! Sets of facets, one bit a facet side.

use crate::canonical::Canonical;
use pellicle_delaunay::{FacetId, TetId};

/// A set of facets; both sides of a facet are in it or neither is.
#[derive(Clone)]
pub(crate) struct FacetSet {
    /// By tetrahedron: bit i for the facet opposite corner i.
    sides: Vec<u8>,
    count: usize,
}

impl FacetSet {
    pub(crate) fn empty(canonical: &Canonical) -> Self {
        Self {
            sides: vec![0; canonical.tets().len()],
            count: 0,
        }
    }

    #[inline]
    pub(crate) fn contains(&self, facet: FacetId) -> bool {
        self.sides[facet.tet().index()] >> facet.corner() & 1 != 0
    }

    /// Whether the facet was not in the set.
    pub(crate) fn insert(&mut self, canonical: &Canonical, facet: FacetId) -> bool {
        let is_new = !self.contains(facet);
        if is_new {
            self.count += 1;
            for side in [facet, canonical.twin(facet)] {
                self.sides[side.tet().index()] |= 1 << side.corner();
            }
        }
        is_new
    }

    /// Whether the facet was in the set.
    pub(crate) fn remove(&mut self, canonical: &Canonical, facet: FacetId) -> bool {
        let was_in = self.contains(facet);
        if was_in {
            self.count -= 1;
            for side in [facet, canonical.twin(facet)] {
                self.sides[side.tet().index()] &= !(1 << side.corner());
            }
        }
        was_in
    }

    /// How many facets.
    pub(crate) fn len(&self) -> usize {
        self.count
    }

    /// Each facet once, seen from the tetrahedron with the lower id, in order.
    pub(crate) fn iter<'s>(
        &'s self,
        canonical: &'s Canonical,
    ) -> impl Iterator<Item = FacetId> + 's {
        let tets = self
            .sides
            .iter()
            .enumerate()
            .filter(|(_, sides)| **sides != 0);
        tets.flat_map(|(t, sides)| {
            let in_set = (0..4).filter(move |corner| sides >> corner & 1 != 0);
            in_set.map(move |corner| FacetId::of(TetId::new(t), corner))
        })
        .filter(|&facet| facet.tet() < canonical.twin(facet).tet())
    }
}
