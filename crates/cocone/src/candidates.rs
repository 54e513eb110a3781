//! Candidate triangles: the facets whose dual Voronoi edge meets a cocone, and which vertices may say so.

use crate::canonical::Canonical;
use crate::facet_set::FacetSet;
use crate::options::Acceptance;
use crate::poles::Poles;
use pellicle_delaunay::{FacetId, TetId};
use pellicle_geometry::VertexId;
use rayon::prelude::*;

/// A facet that some vertex wishes for.
struct Wish {
    facet: FacetId,
    vertices: [VertexId; 3],
    /// Whether each of the vertices wishes for it.
    by: [bool; 3],
}

/// The facets that vertices wish for.
pub(crate) struct Wishes(Vec<Wish>);

/// A vertex is flat only where its cocone is this much narrower than its cell is high: width ≤ height / 1.2
/// (Dey and Giesen 2001, ratio condition).
const RATIO: f64 = 1.2;

/// Tetrahedra whose facets are looked at by one thread at a time.
const TETS_A_PART: usize = 1 << 16;

/// Pole vectors of neighbours must agree within π/3 (normal condition).
const NEIGHBOR_COSINE: f64 = 0.5;

impl Wishes {
    pub(crate) fn of(canonical: &Canonical, poles: &Poles) -> Self {
        let wish = |facet| {
            let by = poles.wishes(canonical, facet);
            by.contains(&true).then(|| Wish {
                facet,
                vertices: canonical.facet(facet),
                by,
            })
        };
        let finite = canonical.finite_count();
        let parts: Vec<Vec<Wish>> = (0..finite.div_ceil(TETS_A_PART))
            .into_par_iter()
            .map(|part| {
                let mut wishes = Vec::new();
                for t in part * TETS_A_PART..finite.min((part + 1) * TETS_A_PART) {
                    canonical.for_facets_of(TetId::new(t), |facet| wishes.extend(wish(facet)));
                }
                wishes
            })
            .collect();
        let mut all = Vec::with_capacity(parts.iter().map(Vec::len).sum());
        for part in parts {
            all.extend(part);
        }
        Self(all)
    }

    /// Which vertices have flat, well-shaped cells whose neighbours agree on the normal; the others are
    /// undersampled, or on a border (Dey and Giesen 2001).
    ///
    /// 1. Flat is who passes the ratio condition, and the normal condition with all cocone neighbours.
    /// 2. Whoever passes the ratio condition, and the normal condition with one flat neighbour in whose
    ///    cocone it is, is flat too; and so on.
    pub(crate) fn flat(&self, canonical: &Canonical, poles: &Poles) -> Vec<bool> {
        let narrow = self.narrow(canonical, poles);
        let agree = |p: VertexId, q: VertexId| {
            let cosine = poles.vectors[p.index()].dot(poles.vectors[q.index()]);
            cosine.abs() >= NEIGHBOR_COSINE
        };

        let mut flat = narrow.clone();
        for wish in &self.0 {
            for (p, q) in wish.cocone_neighbors() {
                flat[p.index()] &= agree(p, q);
            }
        }

        // Pairs that may still pass on flatness: few, and fewer each round.
        let mut pairs: Vec<(VertexId, VertexId)> = self
            .0
            .iter()
            .flat_map(Wish::cocone_neighbors)
            .filter(|&(p, q)| !flat[q.index()] && narrow[q.index()] && agree(p, q))
            .collect();
        loop {
            let before = pairs.len();
            pairs.retain(|&(p, q)| {
                flat[q.index()] |= flat[p.index()];
                !flat[q.index()]
            });
            if pairs.len() == before {
                return flat;
            }
        }
    }

    /// The ratio condition.
    fn narrow(&self, canonical: &Canonical, poles: &Poles) -> Vec<bool> {
        let mut widths = poles.widths.clone();
        for wish in &self.0 {
            for (vertex, wishes) in wish.vertices.into_iter().zip(wish.by) {
                if wishes && let Some(distance) = poles.crossing(canonical, wish.facet, vertex) {
                    widths[vertex.index()] = widths[vertex.index()].max(distance);
                }
            }
        }
        let narrow = |(width, height): (f64, f64)| width * RATIO <= height;
        widths
            .into_iter()
            .zip(poles.heights.iter().copied())
            .map(narrow)
            .collect()
    }

    /// T: the facets accepted by their flat vertices.
    pub(crate) fn candidates(
        &self,
        canonical: &Canonical,
        flat: &[bool],
        acceptance: Acceptance,
    ) -> FacetSet {
        let mut candidates = FacetSet::empty(canonical);
        for wish in &self.0 {
            let votes = || {
                let voters = wish.vertices.into_iter().zip(wish.by);
                voters.filter(|(vertex, _)| flat[vertex.index()])
            };
            let accepted = match acceptance {
                Acceptance::AnyVertex => votes().any(|(_, wishes)| wishes),
                Acceptance::AllVertices => votes().count() > 0 && votes().all(|(_, wishes)| wishes),
            };
            if accepted {
                candidates.insert(canonical, wish.facet);
            }
        }
        candidates
    }
}

impl Wish {
    /// (p, q) for each p that wishes for the triangle and each other corner q.
    fn cocone_neighbors(&self) -> impl Iterator<Item = (VertexId, VertexId)> {
        let (vertices, by) = (self.vertices, self.by);
        (0..3)
            .filter(move |&i| by[i])
            .flat_map(move |i| [1, 2].map(|k| (vertices[i], vertices[(i + k) % 3])))
    }
}
