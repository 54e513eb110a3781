//! From the kernel's arrays to the caller's vertices.

use super::kernel::{INFINITE, Kernel, Mark};
use crate::{FacetId, TetId, Tetrahedralization};
use glam::DVec3;
use pellicle_geometry::VertexId;

impl Kernel {
    /// Closes the gaps, puts the finite tetrahedra first, and names the caller's vertices.
    pub(super) fn finish<'a>(
        mut self,
        points: &'a [DVec3],
        order: &[u32],
        duplicates: Vec<(VertexId, VertexId)>,
    ) -> Tetrahedralization<'a> {
        self.points = Vec::new();
        self.cavity = Default::default();
        self.close_gaps();
        self.marks = Vec::new();
        let finite = self.finite_first();
        for tet in &mut self.tets {
            for vertex in tet {
                *vertex = match *vertex {
                    INFINITE => Tetrahedralization::INFINITE,
                    vertex => VertexId(order[vertex.index() - 1]),
                };
            }
        }
        self.tets.shrink_to_fit();
        self.twins.shrink_to_fit();
        Tetrahedralization::from_arrays(points, self.tets, self.twins, finite, duplicates)
    }

    /// Moves the last tetrahedra into the vacant slots.
    fn close_gaps(&mut self) {
        for &slot in &self.vacant {
            self.marks[slot.index()] = Mark::Vacant;
        }
        self.vacant.sort_unstable();
        for slot in std::mem::take(&mut self.vacant) {
            while self.marks.last() == Some(&Mark::Vacant) {
                self.pop();
            }
            let last = self.tets.len().saturating_sub(1);
            if slot.index() >= last {
                continue;
            }
            self.tets[slot.index()] = self.tets[last];
            self.twins[slot.index()] = self.twins[last];
            self.marks[slot.index()] = self.marks[last];
            self.tell_neighbors(slot);
            self.pop();
        }
    }

    fn pop(&mut self) {
        self.tets.pop();
        self.twins.pop();
        self.marks.pop();
    }

    /// Swaps infinite tetrahedra to the end and returns how many are finite.
    fn finite_first(&mut self) -> usize {
        let is_finite = |tet: &[VertexId; 4]| tet[3] != INFINITE;
        let (mut front, mut back) = (0, self.tets.len());
        loop {
            while front < back && is_finite(&self.tets[front]) {
                front += 1;
            }
            while front < back && !is_finite(&self.tets[back - 1]) {
                back -= 1;
            }
            if front == back {
                return front;
            }
            self.swap(TetId::new(front), TetId::new(back - 1));
        }
    }

    fn swap(&mut self, one: TetId, other: TetId) {
        // Where the two are neighbours, each must first name the other's new place.
        let renamed = |facet: FacetId| match facet.tet() {
            tet if tet == one => FacetId::of(other, facet.corner()),
            tet if tet == other => FacetId::of(one, facet.corner()),
            _ => facet,
        };
        let twins_of_one = self.twins[one.index()].map(renamed);
        let twins_of_other = self.twins[other.index()].map(renamed);
        self.twins[one.index()] = twins_of_other;
        self.twins[other.index()] = twins_of_one;
        self.tets.swap(one.index(), other.index());
        self.tell_neighbors(one);
        self.tell_neighbors(other);
    }

    /// Makes the twins of `tet`'s facets name it.
    fn tell_neighbors(&mut self, tet: TetId) {
        for (corner, twin) in self.twins[tet.index()].into_iter().enumerate() {
            self.twins[twin.tet().index()][twin.corner()] = FacetId::of(tet, corner);
        }
    }
}
