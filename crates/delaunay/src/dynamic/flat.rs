//! Points that span no tetrahedron yet.

use crate::build::collinear;
use pellicle_geometry::{DVec3, VertexId};
use pellicle_predicates::{Sign, orient3d};
use std::collections::HashMap;

/// What stands for the tetrahedra of points in a plane, on a line, or fewer.
#[derive(Default)]
pub(super) struct Flat {
    /// As many affinely independent vertices as there are, three at most, with their points.
    basis: Vec<(VertexId, DVec3)>,
    /// The vertex at each point.
    by_point: HashMap<[u64; 3], VertexId>,
}

impl Flat {
    pub(super) fn dimension(&self) -> Option<usize> {
        self.basis.len().checked_sub(1)
    }

    /// The vertex at a point.
    pub(super) fn at(&self, point: DVec3) -> Option<VertexId> {
        self.by_point.get(&key(point)).copied()
    }

    /// Whether the point and the others span a tetrahedron.
    pub(super) fn spans_with(&self, point: DVec3) -> bool {
        match self.basis[..] {
            [(_, a), (_, b), (_, c)] => orient3d(a, b, c, point) != Sign::Zero,
            _ => false,
        }
    }

    /// Adds a point that is not there and lies flat with the others.
    pub(super) fn add(&mut self, vertex: VertexId, point: DVec3) {
        self.by_point.insert(key(point), vertex);
        let is_independent = match self.basis[..] {
            [] | [_] => true,
            [(_, a), (_, b)] => !collinear(a, b, point),
            _ => false,
        };
        if is_independent {
            self.basis.push((vertex, point));
        }
    }

    /// Removes a point; `others` are those that remain, wanted only if the point was part of the basis.
    pub(super) fn remove(
        &mut self,
        vertex: VertexId,
        point: DVec3,
        others: impl Iterator<Item = (VertexId, DVec3)>,
    ) {
        self.by_point.remove(&key(point));
        if self.basis.iter().all(|&(other, _)| other != vertex) {
            return;
        }
        let wanted = self.basis.len();
        self.basis.clear();
        for (vertex, point) in others {
            if self.basis.len() == wanted {
                return;
            }
            self.add(vertex, point);
        }
    }
}

/// −0 and 0 are equal.
fn key(point: DVec3) -> [u64; 3] {
    (point + DVec3::ZERO).to_array().map(f64::to_bits)
}
