//! Unit normals at the points: pole vectors, turned to one side.
//!
//! A pole vector is a line more than a direction: which of the two poles is farther depends on the shape of the two sides.
//! Signs come from agreement between neighbours, and from where infinity is:
//!
//! 1. *Propagate.* A maximum spanning forest of the edges of candidate triangles, by |n_p · n_q|: along an edge of the
//!    forest both normals point to the same side.
//! 2. *Vote.* The depth of a tetrahedron is the least number of candidate triangles between it and infinity. A
//!    candidate between two depths says which of its sides faces out, and so does each facet of the convex
//!    hull. Each tree of the forest takes the sign that its votes prefer.
//! 3. *Join.* A tree without a preference follows one that has, across the other Delaunay edges, best agreement
//!    first.

use crate::candidates::Wishes;
use crate::canonical::Canonical;
use crate::facet_set::FacetSet;
use crate::options::Acceptance;
use crate::poles::Poles;
use glam::DVec3;
use pellicle_delaunay::{FacetId, TetId, Tetrahedralization};
use pellicle_geometry::{Cancelled, Progress, VertexId, triangle};

/// A unit normal for each point, consistently oriented: the direction of its pole, turned outward.
///
/// Each piece of the surface is oriented on its own, towards the side from which infinity is reached through
/// fewer surfaces: of two nested spheres both have normals that point away from their centre, as
/// [`Method::Cocone`](crate::Method::Cocone) orients them. An open surface turns its normals to the side where
/// more of its convex hull is; where both sides have as much (a flat sheet), they are consistent, but the side is
/// arbitrary.
///
/// By the caller's ids; a duplicate has the normal of its representative. A point whose Voronoi cell gives no
/// direction has the zero vector. The normals depend on the set of points alone, not on their order.
///
/// On a densely sampled smooth surface the error is of the order of the sampling density (Dey 2006); noise
/// beyond the spacing of the points makes pole vectors useless. O(n log n) in the number of tetrahedra.
///
/// ```
/// use pellicle_cocone::normals;
/// use pellicle_delaunay::{Options, tetrahedralize};
/// use pellicle_geometry::DVec3;
///
/// // An icosahedron: every normal points away from the centre.
/// let g = 0.5 + 1.25_f64.sqrt();
/// let signs = [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)];
/// let points: Vec<DVec3> = signs
///     .iter()
///     .map(|&(s, t)| DVec3::new(0.0, s, t * g))
///     .flat_map(|p| [p, DVec3::new(p.y, p.z, p.x), DVec3::new(p.z, p.x, p.y)])
///     .collect();
/// let normals = normals(&tetrahedralize(&points, &Options::default())?);
/// assert!(points.iter().zip(&normals).all(|(p, n)| n.distance(p.normalize()) < 1e-12));
/// # Ok::<(), pellicle_delaunay::Error>(())
/// ```
pub fn normals(tetrahedralization: &Tetrahedralization) -> Vec<DVec3> {
    // The unit observer never stops.
    normals_with(tetrahedralization, &()).unwrap_or_default()
}

/// [`normals`], watched by `progress`.
///
/// # Errors
///
/// [`Cancelled`] when the observer asks to stop.
pub fn normals_with(
    tetrahedralization: &Tetrahedralization,
    progress: &dyn Progress,
) -> Result<Vec<DVec3>, Cancelled> {
    let step = |done| Cancelled::check(progress.step("normals", done, 4));
    step(0)?;
    let canonical = Canonical::of(tetrahedralization);
    let poles = Poles::of(&canonical);
    step(1)?;
    let candidates = candidates(&canonical, &poles);
    let triangles: Vec<FacetId> = candidates.iter(&canonical).collect();
    let mut normals = poles.vectors;
    step(2)?;
    let mut forest = Forest::of(&canonical, &normals, &triangles);
    step(3)?;
    forest.vote(&canonical, &normals, &candidates, &triangles);
    forest.join(&canonical, &normals);
    for (vertex, normal) in normals.iter_mut().enumerate() {
        if forest.is_turned(vertex as u32) {
            *normal = -*normal;
        }
    }
    step(4)?;

    let mut by_point = vec![DVec3::ZERO; canonical.original_points().len()];
    for vertex in canonical.vertex_ids() {
        by_point[canonical.original(vertex).index()] = normals[vertex.index()];
    }
    for (duplicate, representative) in tetrahedralization.duplicates() {
        by_point[duplicate.index()] = by_point[representative.index()];
    }
    Ok(by_point)
}

fn candidates(canonical: &Canonical, poles: &Poles) -> FacetSet {
    let wishes = Wishes::of(canonical, poles);
    let flat = wishes.flat(canonical, poles);
    wishes.candidates(canonical, &flat, Acceptance::AnyVertex)
}

/// Trees of vertices whose normals have one side in common.
struct Forest {
    /// By vertex: the vertex above it in its tree, itself for a root.
    above: Vec<u32>,
    /// By vertex: whether its normal is turned against that of the vertex above.
    turned: Vec<bool>,
    /// By root: how strongly the tree prefers its root's normal as it is (positive) or turned (negative).
    votes: Vec<f64>,
}

/// The root of a vertex's tree, and whether the tree has a preference.
type Tree = (u32, bool);

/// An edge, and how well the normals of its ends agree.
#[derive(Clone, Copy)]
struct Edge {
    agreement: f64,
    ends: [u32; 2],
}

impl Forest {
    fn of(canonical: &Canonical, normals: &[DVec3], triangles: &[FacetId]) -> Self {
        let mut forest = Self {
            above: (0..normals.len() as u32).collect(),
            turned: vec![false; normals.len()],
            votes: vec![0.0; normals.len()],
        };
        let triangles = triangles.iter().map(|&facet| canonical.facet(facet));
        forest.span(normals, triangles.collect());
        forest
    }

    /// The root of the vertex's tree, and whether the vertex's normal is turned against the root's.
    fn find(&mut self, vertex: u32) -> (u32, bool) {
        let (mut v, mut turned) = (vertex as usize, false);
        while self.above[v] as usize != v {
            // Halve the path.
            let above = self.above[v] as usize;
            self.turned[v] ^= self.turned[above];
            self.above[v] = self.above[above];
            turned ^= self.turned[v];
            v = self.above[v] as usize;
        }
        (v as u32, turned)
    }

    /// Joins the trees of two vertices unless both have a preference.
    fn unite(&mut self, normals: &[DVec3], [p, q]: [u32; 2]) {
        let ((a, a_turned), (b, b_turned)) = (self.find(p), self.find(q));
        if a == b || self.has_preference(a) && self.has_preference(b) {
            return;
        }
        let opposed = normals[p as usize].dot(normals[q as usize]) < 0.0;
        let (root, below) = (a.min(b), a.max(b));
        let turned = a_turned ^ b_turned ^ opposed;
        self.above[below as usize] = root;
        self.turned[below as usize] = turned;
        let votes = self.votes[below as usize];
        self.votes[root as usize] += if turned { -votes } else { votes };
    }

    fn vote(
        &mut self,
        canonical: &Canonical,
        normals: &[DVec3],
        candidates: &FacetSet,
        triangles: &[FacetId],
    ) {
        let depths = depths(canonical, candidates);
        for &facet in triangles {
            let twin = canonical.twin(facet);
            let [depth, beyond] = [facet, twin].map(|side| depths[side.tet().index()]);
            if depth != beyond {
                let side = if depth < beyond { facet } else { twin };
                self.vote_outward(canonical, normals, side);
            }
        }
        for infinite in canonical.finite_count()..canonical.tets().len() {
            self.vote_outward(canonical, normals, FacetId::of(TetId::new(infinite), 3));
        }
    }

    /// The vertices of a facet that is seen from outside vote.
    fn vote_outward(&mut self, canonical: &Canonical, normals: &[DVec3], side: FacetId) {
        let facet = canonical.facet(side);
        let [a, b, c] = facet.map(|v| canonical.point(v));
        let outward = triangle::double_area_normal(a, b, c).normalize_or_zero();
        for vertex in facet {
            let cosine = normals[vertex.index()].dot(outward);
            let (root, turned) = self.find(vertex.0);
            self.votes[root as usize] += if turned { -cosine } else { cosine };
        }
    }

    fn has_preference(&self, root: u32) -> bool {
        self.votes[root as usize] != 0.0
    }

    /// Trees without a preference are joined to others.
    fn join(&mut self, canonical: &Canonical, normals: &[DVec3]) {
        let tets = &canonical.tets()[..canonical.finite_count()];
        self.span(normals, tets.to_vec());
    }

    /// Each tree without a preference is joined to another along its best edge of the simplices, again
    /// and again (Borůvka 1926). At least half of those trees go in each round: O(n log n).
    fn span<const N: usize>(&mut self, normals: &[DVec3], mut simplices: Vec<[VertexId; N]>) {
        loop {
            let trees: Vec<Tree> = (0..normals.len() as u32)
                .map(|v| {
                    let (root, _) = self.find(v);
                    (root, self.has_preference(root))
                })
                .collect();
            let tree = |v: &VertexId| trees[v.index()];
            simplices.retain(|simplex| {
                let first = tree(&simplex[0]);
                let mixed = simplex.iter().any(|v| tree(v).0 != first.0);
                mixed && !simplex.iter().all(|v| tree(v).1)
            });
            if simplices.is_empty() {
                return;
            }
            let best = best_edges(normals, &trees, &simplices);
            for edge in best.into_iter().flatten() {
                self.unite(normals, edge.ends);
            }
        }
    }

    /// Whether the vertex's pole vector points inward.
    fn is_turned(&mut self, vertex: u32) -> bool {
        let (root, turned) = self.find(vertex);
        turned ^ (self.votes[root as usize] < 0.0)
    }
}

/// By root of a tree without a preference, its best edge to another tree.
fn best_edges<const N: usize>(
    normals: &[DVec3],
    trees: &[Tree],
    simplices: &[[VertexId; N]],
) -> Vec<Option<Edge>> {
    let mut best: Vec<Option<Edge>> = vec![None; normals.len()];
    let pairs = (0..N).flat_map(|i| (0..i).map(move |j| [i, j]));
    let edges = simplices
        .iter()
        .flat_map(|simplex| pairs.clone().map(|pair| pair.map(|k| simplex[k])));
    for edge in edges {
        let ends = edge.map(|v| trees[v.index()]);
        if ends[0].0 == ends[1].0 {
            continue;
        }
        for (root, _) in ends.into_iter().filter(|(_, prefers)| !prefers) {
            let edge = Edge::between(normals, edge);
            let best = &mut best[root as usize];
            if best.as_ref().is_none_or(|best| edge.is_better_than(best)) {
                *best = Some(edge);
            }
        }
    }
    best
}

impl Edge {
    fn between(normals: &[DVec3], [p, q]: [VertexId; 2]) -> Self {
        Self {
            agreement: normals[p.index()].dot(normals[q.index()]).abs(),
            ends: [p.0.min(q.0), p.0.max(q.0)],
        }
    }

    /// Of equals the one with the lower canonical ids, so that nothing depends on the order of the input.
    fn is_better_than(&self, other: &Self) -> bool {
        let by_agreement = self.agreement.total_cmp(&other.agreement);
        by_agreement.then(other.ends.cmp(&self.ends)).is_gt()
    }
}

/// By tetrahedron, the least number of candidates between it and infinity.
fn depths(canonical: &Canonical, candidates: &FacetSet) -> Vec<u32> {
    let unknown = u32::MAX;
    let mut depths = vec![unknown; canonical.tets().len()];
    let infinite = canonical.finite_count()..canonical.tets().len();
    let mut here: Vec<TetId> = infinite.map(TetId::new).collect();
    let mut deeper = Vec::new();
    let mut depth = 0;
    while !here.is_empty() {
        while let Some(tet) = here.pop() {
            if depths[tet.index()] != unknown {
                continue;
            }
            depths[tet.index()] = depth;
            for (corner, twin) in canonical.twins(tet).into_iter().enumerate() {
                if depths[twin.tet().index()] == unknown {
                    match candidates.contains(FacetId::of(tet, corner)) {
                        true => deeper.push(twin.tet()),
                        false => here.push(twin.tet()),
                    }
                }
            }
        }
        std::mem::swap(&mut here, &mut deeper);
        depth += 1;
    }
    depths
}
