//! What every reader fills in.

use crate::Note;
use pellicle_geometry::{DVec3, VertexId};

/// What a reader is asked to keep.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Keep {
    Points,
    Everything,
}

#[derive(Debug)]
pub(crate) struct Contents {
    pub positions: Vec<DVec3>,
    /// Empty, or one a position.
    pub normals: Vec<DVec3>,
    pub triangles: Vec<[VertexId; 3]>,
    pub notes: Vec<Note>,
    keep: Keep,
    polygons_cut: u64,
    small_polygons: u64,
}

impl Contents {
    pub fn new(keep: Keep) -> Self {
        Self {
            positions: Vec::new(),
            normals: Vec::new(),
            triangles: Vec::new(),
            notes: Vec::new(),
            keep,
            polygons_cut: 0,
            small_polygons: 0,
        }
    }

    pub fn keeps_triangles(&self) -> bool {
        self.keep == Keep::Everything
    }

    pub fn triangle(&mut self, corners: [u32; 3]) {
        if self.keeps_triangles() {
            push(&mut self.triangles, corners.map(VertexId));
        }
    }

    /// Cuts a polygon into the fan from its first corner; counts those with fewer than three corners.
    pub fn polygon(&mut self, corners: &[u32]) {
        if corners.len() < 3 {
            self.small_polygons += 1;
            return;
        }
        self.polygons_cut += u64::from(corners.len() > 3);
        for pair in corners[1..].windows(2) {
            self.triangle([corners[0], pair[0], pair[1]]);
        }
    }

    pub fn ignored(&mut self, what: impl Into<String>, count: u64) {
        if count > 0 {
            self.notes.push(Note::Ignored {
                what: what.into(),
                count,
            });
        }
    }

    /// Gives back what was reserved in vain, and turns the counts into notes.
    pub fn finish(mut self) -> Self {
        shrink(&mut self.positions);
        shrink(&mut self.normals);
        shrink(&mut self.triangles);
        if self.polygons_cut > 0 {
            self.notes.push(Note::Triangulated {
                polygons: self.polygons_cut,
            });
        }
        let small = self.small_polygons;
        self.ignored("polygons with fewer than three corners", small);
        self
    }
}

/// Pushes, growing by an eighth where `Vec` would double: readers promise a peak near the data held.
pub(crate) fn push<T>(items: &mut Vec<T>, item: T) {
    if items.len() == items.capacity() {
        items.reserve_exact((items.len() / 8).max(256));
    }
    items.push(item);
}

fn shrink<T>(items: &mut Vec<T>) {
    if items.capacity() - items.len() > items.len() / 32 {
        items.shrink_to_fit();
    }
}
