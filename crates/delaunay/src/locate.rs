//! Where a point lies, and which vertex is nearest to it: exact, by walking.

#[cfg(test)]
mod tests;

use crate::{
    FacetId, TetId, Tetrahedralization, circulate::AroundVertex, connectivity::Connectivity,
};
use pellicle_geometry::{DVec3, VertexId};
use pellicle_predicates::{Sign, compare_distance, lifted::lexicographic, orient3d};
use std::cmp::Ordering;

/// Where a point lies in a tetrahedralisation: in the cell of lowest dimension that contains it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Location {
    /// At a vertex; at the representative of equal points.
    Vertex(VertexId),
    /// Inside the edge between two vertices.
    Edge {
        /// One of the finite tetrahedra that share the edge.
        tet: TetId,
        /// Its ends, the lower id first.
        ends: [VertexId; 2],
    },
    /// Inside a facet; on the convex hull, as seen from its finite tetrahedron, elsewhere from the one with
    /// the lower id.
    Facet(FacetId),
    /// Inside a finite tetrahedron.
    Tetrahedron(TetId),
    /// Outside of the convex hull: strictly beyond the hull facet of this infinite tetrahedron, one of those
    /// that see the point.
    Outside(TetId),
}

impl Tetrahedralization<'_> {
    /// Where a point lies, exactly, however close to a facet or far away. `None` for a point that is not
    /// finite.
    ///
    /// Walks through the tetrahedra that lie between (Devillers et al. 2002), from `hint`, a vertex thought
    /// to be near: expected O(1) where it is. Without one (or with an id that names no vertex) from the
    /// nearest of 8 n^(1/4) vertices drawn at random: expected O(n^(1/4)) for points in a volume (Mücke et al.
    /// 1999).
    ///
    /// ```
    /// # use pellicle_delaunay::{Location, Options, TetId, tetrahedralize};
    /// # use pellicle_geometry::{DVec3, VertexId};
    /// let points = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    /// let tetrahedralization = tetrahedralize(&points, &Options::default())?;
    /// let at = |p| tetrahedralization.locate(p, None).unwrap();
    /// assert_eq!(at(DVec3::splat(0.1)), Location::Tetrahedron(TetId(0)));
    /// assert!(matches!(at(DVec3::new(0.1, 0.1, 0.0)), Location::Facet(_)));
    /// assert!(matches!(at(DVec3::X * 0.1), Location::Edge { .. }));
    /// assert_eq!(at(DVec3::X), Location::Vertex(VertexId(1)));
    /// assert!(matches!(at(DVec3::ONE), Location::Outside(_)));
    /// # Ok::<(), pellicle_delaunay::Error>(())
    /// ```
    pub fn locate(&self, point: DVec3, hint: Option<VertexId>) -> Option<Location> {
        locate(self, point, hint)
    }

    /// The vertex nearest to a point; of several at the same distance the one with the lexicographically
    /// lowest point. Exact. `None` for a point that is not finite.
    ///
    /// [`locate`](Self::locate), then from vertex to vertex along edges that lead nearer: a vertex without a
    /// nearer neighbour is the nearest of all. `hint` is as there.
    ///
    /// ```
    /// # use pellicle_delaunay::{Options, tetrahedralize};
    /// # use pellicle_geometry::{DVec3, VertexId};
    /// let points = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
    /// let tetrahedralization = tetrahedralize(&points, &Options::default())?;
    /// let nearest = |p| tetrahedralization.nearest_vertex(p, None).unwrap();
    /// assert_eq!(nearest(DVec3::new(0.6, 0.1, 0.2)), VertexId(1));
    /// assert_eq!(nearest(DVec3::ONE), VertexId(3)); // (0, 0, 1), before (0, 1, 0) and (1, 0, 0)
    /// # Ok::<(), pellicle_delaunay::Error>(())
    /// ```
    pub fn nearest_vertex(&self, point: DVec3, hint: Option<VertexId>) -> Option<VertexId> {
        nearest_vertex(self, point, hint)
    }
}

/// See [`Tetrahedralization::locate`].
pub(crate) fn locate<T: Connectivity>(
    among: &T,
    p: DVec3,
    hint: Option<VertexId>,
) -> Option<Location> {
    if !p.is_finite() {
        return None;
    }
    let near = hint.and_then(|vertex| among.tet_at(vertex));
    Some(walk(among, near.or_else(|| jump(among, p))?, p))
}

/// Times n^(1/4): how many vertices [`jump`] looks at. To look at one costs less than to walk through a
/// tetrahedron.
const SAMPLES: f64 = 8.0;

/// A tetrahedron at the nearest of a few vertices. Which ones hangs on the point alone.
fn jump<T: Connectivity>(among: &T, p: DVec3) -> Option<TetId> {
    let any = among.any_tet()?;
    let limit = among.vertex_limit() as u64;
    let mut state = p.to_array().map(f64::to_bits).into_iter().fold(0, mixed);
    let mut best = among.corners(any)[0];
    let mut least = among.position(best).distance_squared(p);
    for _ in 0..(SAMPLES * (limit as f64).powf(0.25)) as u64 {
        state = mixed(state, 1);
        let vertex = VertexId::new(((u128::from(state) * u128::from(limit)) >> 64) as usize);
        // A guess: rounding does not matter, and what is not a number is no vertex.
        let distance = among.position(vertex).distance_squared(p);
        if distance < least {
            (best, least) = (vertex, distance);
        }
    }
    among.tet_at(best).or(Some(any))
}

/// One step of SplitMix64.
fn mixed(state: u64, add: u64) -> u64 {
    let mut z = state.wrapping_add(add).wrapping_add(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// The remembering walk from `start`: through any facet that has `p` strictly beyond it, but not back through
/// the one just crossed (Devillers et al. 2002). It ends because the tetrahedralisation is a regular one and
/// the signs are exact.
fn walk<T: Connectivity>(among: &T, start: TetId, p: DVec3) -> Location {
    let mut tet = start;
    if !among.has_four_points(tet) {
        tet = among.other_side(FacetId::of(tet, 3)).tet();
    }
    let mut entered_through = usize::MAX;
    'walk: loop {
        let mut holds = [false; 4];
        for corner in (0..4).filter(|&corner| corner != entered_through) {
            let [a, b, c] = among.facet_points(tet, corner);
            match orient3d(a, b, c, p) {
                Sign::Positive => {}
                Sign::Zero => holds[corner] = true,
                Sign::Negative => {
                    let beyond = among.other_side(FacetId::of(tet, corner));
                    (tet, entered_through) = (beyond.tet(), beyond.corner());
                    if !among.has_four_points(tet) {
                        return Location::Outside(tet);
                    }
                    continue 'walk;
                }
            }
        }
        return classified(among, tet, holds);
    }
}

/// The location of a point in the closed tetrahedron `tet`, of which the facets in `holds` contain it.
fn classified<T: Connectivity>(among: &T, tet: TetId, holds: [bool; 4]) -> Location {
    let corners = among.corners(tet);
    // Two facets meet in an edge, three in a corner; four never do: no tetrahedron is flat.
    let on = |number: usize| (0..4).filter(|&corner| holds[corner]).nth(number);
    let off = |number: usize| (0..4).filter(|&corner| !holds[corner]).nth(number);
    match (on(0), off(0), off(1), off(2)) {
        (Some(corner), _, _, Some(_)) => {
            let facet = FacetId::of(tet, corner);
            let twin = among.other_side(facet);
            Location::Facet(match among.has_four_points(twin.tet()) {
                true => facet.min(twin),
                false => facet,
            })
        }
        (_, Some(i), Some(j), None) => Location::Edge {
            tet,
            ends: [corners[i].min(corners[j]), corners[i].max(corners[j])],
        },
        (_, Some(corner), None, None) => Location::Vertex(corners[corner]),
        _ => Location::Tetrahedron(tet),
    }
}

/// See [`Tetrahedralization::nearest_vertex`].
///
/// Why it ends at the nearest: if some vertex is nearer to `p` than `v`, then `p` is beyond one of the
/// Voronoi facets of `v`, and an edge of every Delaunay triangulation, perturbed or not, crosses that facet.
/// Among equally near vertices the same holds of the lexicographic order: they lie on an empty sphere around
/// `p`, their convex hull is a face of the Delaunay complex, each of its edges is there, and on a polytope a
/// linear order has no local minimum but the global one.
pub(crate) fn nearest_vertex<T: Connectivity>(
    among: &T,
    p: DVec3,
    hint: Option<VertexId>,
) -> Option<VertexId> {
    let tet = match locate(among, p, hint)? {
        Location::Vertex(vertex) => among.tet_at(vertex)?,
        Location::Edge { tet, .. } | Location::Tetrahedron(tet) | Location::Outside(tet) => tet,
        Location::Facet(facet) => facet.tet(),
    };
    let is_nearer = |one: VertexId, other: VertexId| {
        let (one, other) = (among.position(one), among.position(other));
        let order = compare_distance(p, one, other).then_with(|| lexicographic(one, other));
        order == Ordering::Less
    };
    let corners = among.corners(tet).into_iter();
    let mut best = corners
        .filter(|&corner| corner != VertexId::NONE)
        .reduce(|best, corner| {
            if is_nearer(corner, best) {
                corner
            } else {
                best
            }
        })?;
    'descent: loop {
        for tet in AroundVertex::new(among, best) {
            for corner in among.corners(tet) {
                if corner != best && corner != VertexId::NONE && is_nearer(corner, best) {
                    best = corner;
                    continue 'descent;
                }
            }
        }
        return Some(best);
    }
}
