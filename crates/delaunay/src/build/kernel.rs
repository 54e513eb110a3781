//! The growing tetrahedralisation.
//!
//! Inside the kernel vertex 0 is the vertex at infinity and vertex k + 1 is the k-th point of the order of
//! insertion, so points that are inserted together lie together in memory. Corner 3 is the only one that
//! may be infinite, and in a tetrahedron that an insertion made corner 0 is the vertex inserted.

use super::{
    blocks::Blocks,
    cells::{AT_REST, Cells},
    lattice,
};
use crate::{Error, FacetId, TetId, id::FACET_CORNERS};
use glam::DVec3;
use pellicle_geometry::{Aabb, VertexId};
use pellicle_predicates::StaticFilter;
use rayon::prelude::*;
use std::{
    ops::Range,
    sync::atomic::{AtomicUsize, Ordering::Relaxed},
};

/// The vertex at infinity, inside the kernel.
pub(crate) const INFINITE: VertexId = VertexId(0);

/// Facet ids leave 30 bits for tetrahedra.
pub(super) const MOST_TETS: usize = 1 << 30;

pub(super) struct Kernel {
    /// By vertex; the first stands for infinity and decides nothing.
    pub(super) points: Vec<DVec3>,
    /// By vertex, or none: of a regular triangulation.
    pub(super) weights: Vec<f64>,
    pub(super) cells: Cells,
    /// Who may touch which of them, while several workers insert.
    pub(super) blocks: Blocks,
    /// Where new tetrahedra find vacant slots.
    regions: Vec<Region>,
    pub(super) filter: StaticFilter,
    /// Four points that span a tetrahedron, so that no plane has them all; `None` where vertices go.
    pub(super) spanning: Option<[VertexId; 4]>,
}

impl Kernel {
    /// One tetrahedron of the first four points of `order`, which are positively oriented, and four
    /// infinite ones around it.
    pub(super) fn of_first_tetrahedron(points: &[DVec3], order: &[u32]) -> Self {
        let mut sorted = Vec::with_capacity(order.len() + 1);
        sorted.push(points[order[0] as usize]);
        sorted.par_extend(order.par_iter().map(|&i| points[i as usize]));
        let bounds = Aabb::of_points(&sorted);

        // Samples of volumes have 6.8 tetrahedra a point; memory that is not touched costs nothing.
        let expected = (7 * order.len()).min(MOST_TETS);
        let mut kernel = Self {
            cells: Cells::with_capacity(expected),
            blocks: Blocks::default(),
            regions: Vec::new(),
            filter: StaticFilter::from_bounds(bounds.min, bounds.max)
                .with_unit(lattice::unit(&sorted, bounds)),
            spanning: Some([1, 2, 3, 4].map(VertexId)),
            points: sorted,
            weights: Vec::new(),
        };
        kernel.make_first_tetrahedron();
        kernel
    }

    /// A kernel without points and tetrahedra.
    pub(super) fn empty() -> Self {
        Self {
            points: vec![DVec3::ZERO],
            weights: Vec::new(),
            cells: Cells::default(),
            blocks: Blocks::default(),
            regions: Vec::new(),
            filter: StaticFilter::from_bounds(DVec3::ZERO, DVec3::ZERO),
            spanning: None,
        }
    }

    pub(super) fn make_first_tetrahedron(&mut self) {
        let mut tets = [[1, 2, 3, 4].map(VertexId); 5];
        for (i, corners) in FACET_CORNERS.into_iter().enumerate() {
            // The facet seen from outside, so that the point at infinity sees it counter-clockwise.
            let [a, b, c] = corners.map(|corner| tets[0][corner]);
            tets[i + 1] = [a, c, b, INFINITE];
        }
        // Each pair of the five shares one facet: the one opposite the corner that the other lacks.
        let places = || (0..5).flat_map(|t| (0..4).map(move |corner| (t, corner)));
        let mut twins = [[FacetId::NONE; 4]; 5];
        for (t, corner) in places() {
            let facet = without(tets[t], corner);
            let twin = places()
                .find(|&(other, across)| other != t && without(tets[other], across) == facet);
            let (other, across) = twin.expect("the five tetrahedra close up");
            twins[t][corner] = FacetId::of(TetId::new(other), across);
        }
        if self.cells.len() < 5 {
            self.cells.grow(5);
        }
        for t in 0..5 {
            self.cells.set(TetId::new(t), tets[t], twins[t], AT_REST);
        }
    }

    /// Prepares for a round that multiplies the tetrahedra by `growth`: those that are there are spread as wide, over as many
    /// `slots` as there may be, and `workers` have a region each to fill.
    ///
    /// The tetrahedra lie in memory about as the Hilbert curve runs. Where they are spread, each round's
    /// tetrahedra come to lie among those of the rounds before: neighbours in space stay neighbours in
    /// memory, and an insertion touches few pages.
    pub(super) fn spread(&mut self, growth: f64, slots: usize, workers: usize) {
        self.cells.spread(slots.min(MOST_TETS), growth, workers);
        self.regions = Region::divide(0..self.cells.len(), workers);
        self.blocks.prepare(self.cells.len(), workers);
    }

    /// The first tetrahedron of a worker's region, or any where that holds none.
    pub(super) fn first_of_region(&self, worker: usize) -> TetId {
        let start = self.regions[worker].next.load(Relaxed);
        let after = start..self.cells.len();
        let mut slots = after.chain(0..start).map(TetId::new);
        slots
            .find(|&slot| self.cells.mark(slot) == AT_REST)
            .expect("there are tetrahedra from the first one on")
    }

    /// Gives all slots out again, those in use included.
    pub(super) fn reset_regions(&mut self) {
        self.regions = Region::divide(0..self.cells.len(), 1);
    }

    /// How many tetrahedra there are.
    pub(super) fn count(&self) -> usize {
        self.cells.count()
    }

    /// How many slots there are.
    pub(super) fn slots(&self) -> usize {
        self.cells.len()
    }

    /// Makes room for `wanted` more tetrahedra, which `workers` fill: not too much, since new slots are touched.
    pub(super) fn grow(&mut self, wanted: usize, workers: usize) -> Result<(), Error> {
        let len = self.cells.len();
        if len >= MOST_TETS {
            return Err(Error::TooMany {
                of: "tetrahedra",
                limit: MOST_TETS,
            });
        }
        let wanted = wanted.max(len / 256).max(256);
        self.cells.grow((len + wanted).min(MOST_TETS));
        self.regions = Region::divide(len..self.cells.len(), workers);
        self.blocks.prepare(self.cells.len(), workers);
        Ok(())
    }

    /// Slots among which a worker may look for vacant ones; none when all are taken.
    #[inline(always)]
    pub(super) fn take_slots(&self, worker: usize) -> Range<usize> {
        match self.regions.get(worker).map(Region::take) {
            Some(slots) if !slots.is_empty() => slots,
            _ => self.take_slots_elsewhere(),
        }
    }

    #[cold]
    fn take_slots_elsewhere(&self) -> Range<usize> {
        let taken = self.regions.iter().map(Region::take);
        taken
            .into_iter()
            .find(|slots| !slots.is_empty())
            .unwrap_or(0..0)
    }

    #[inline(always)]
    pub(super) fn point(&self, vertex: VertexId) -> DVec3 {
        self.points[vertex.index()]
    }
}

/// Slots that are handed out in blocks; away from what other threads write to.
#[repr(align(128))]
struct Region {
    next: AtomicUsize,
    end: usize,
}

impl Region {
    /// Slots in a block.
    const BLOCK: usize = 128;

    fn divide(slots: Range<usize>, parts: usize) -> Vec<Self> {
        let cut = |k: usize| match slots.start + slots.len() * k / parts {
            // Not within a block, which only one worker can hold.
            cut if 0 < k && k < parts => cut.next_multiple_of(Self::BLOCK).min(slots.end),
            cut => cut,
        };
        (0..parts)
            .map(|k| Self {
                next: AtomicUsize::new(cut(k)),
                end: cut(k + 1),
            })
            .collect()
    }

    fn take(&self) -> Range<usize> {
        let step = |next: usize| Some((next + 1).next_multiple_of(Self::BLOCK));
        let start = self.next.fetch_update(Relaxed, Relaxed, step);
        let start = start.unwrap_or(self.end).min(self.end);
        start..(start + 1).next_multiple_of(Self::BLOCK).min(self.end)
    }
}

/// The corners but one, sorted.
fn without(tet: [VertexId; 4], corner: usize) -> [VertexId; 3] {
    let mut facet = FACET_CORNERS[corner].map(|i| tet[i]);
    facet.sort_unstable();
    facet
}
