//! The facets around an edge, in the order in which a half-plane that turns about it meets them.
//!
//! ```text
//!        front of i                 d, the edge's direction, points out of the page; angles grow counter-clockwise.
//!     ┄┄┄┄┄┄┄┄┄┄┄┄                  The facet at the left of d, seen from where its normal points, lies along n × d; its
//!      ↑ n                          normal points to where the angle grows if the facet is at the left of d, so that
//!     ─┴──────────× d    facet i    is its *later* side; otherwise the later side is its back.
//!      back of i
//! ```

use crate::arrangement::Arrangement;
use crate::points::{PlaneId, Points};
use crate::weld::Weld;
use pellicle_geometry::VertexId;
use pellicle_mesh::{EdgeEntry, HalfEdgeId};
use pellicle_predicates::Sign;
use std::cmp::Ordering;

/// A facet at an edge.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Leaf {
    pub half_edge: HalfEdgeId,
    pub facet: u32,
    /// Whether the half-edge runs from the edge's lower vertex to its upper one.
    pub forward: bool,
    plane: PlaneId,
}

impl Leaf {
    pub(crate) fn new(arrangement: &Arrangement, lower: VertexId, entry: &EdgeEntry) -> Self {
        let half_edge = entry.half_edge;
        let piece = half_edge.triangle().index();
        Self {
            half_edge,
            facet: arrangement.facet_of[piece],
            forward: arrangement.pieces[piece][half_edge.corner()] == lower,
            plane: PlaneId::NONE,
        }
    }

    fn sign(&self) -> Sign {
        match self.forward {
            true => Sign::Positive,
            false => Sign::Negative,
        }
    }
}

/// The facets at an edge, counter-clockwise about the direction from its lower vertex to its upper one, from the first
/// entry on.
pub(crate) fn fan(
    arrangement: &Arrangement,
    weld: &Weld,
    points: &mut Points,
    [lower, upper]: [VertexId; 2],
    entries: &[EdgeEntry],
) -> Vec<Leaf> {
    let mut leaves: Vec<Leaf> = entries
        .iter()
        .map(|entry| Leaf::new(arrangement, lower, entry))
        .collect();
    if leaves.len() <= 2 {
        return leaves;
    }
    for leaf in &mut leaves {
        let triangle = arrangement.facets[leaf.facet as usize].triangle;
        leaf.plane = points.plane_of_triangle(triangle as usize, weld);
    }
    let along = (0..3).find_map(|k| match points.compare(lower, upper, k) {
        Ordering::Less => Some((k, Sign::Positive)),
        Ordering::Greater => Some((k, Sign::Negative)),
        Ordering::Equal => None,
    });
    let Some((axis, direction)) = along else {
        return leaves;
    };
    let points = &*points;
    // The sign of the sine of the angle from one to the other: normals turn as their facets do.
    let turn = |a: &Leaf, b: &Leaf| {
        let cross = points
            .plane(a.plane)
            .cross_sign(points.plane(b.plane), axis);
        a.sign() * b.sign() * cross * direction
    };
    let first = leaves[0];
    let quarter = |leaf: &Leaf| match turn(&first, leaf) {
        Sign::Positive => 1,
        Sign::Negative => 3,
        Sign::Zero => {
            let cosine = points.plane(first.plane).dot_sign(points.plane(leaf.plane));
            match first.sign() * leaf.sign() * cosine {
                Sign::Negative => 2,
                _ => 0,
            }
        }
    };
    leaves.sort_by(|a, b| {
        quarter(a).cmp(&quarter(b)).then_with(|| match turn(a, b) {
            Sign::Positive => Ordering::Less,
            Sign::Negative => Ordering::Greater,
            Sign::Zero => Ordering::Equal,
        })
    });
    leaves
}
