//! Watching the states of the algorithm: for pictures, and for finding out why.

use pellicle_geometry::DVec3;
use pellicle_mesh::TriangleId;

/// A segment in which two triangles meet; a point where its ends are equal. Rounded from exact points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment {
    /// The triangles, the lesser id first.
    pub triangles: [TriangleId; 2],
    /// From, to.
    pub ends: [DVec3; 2],
}

/// A triangle of a cut triangle, or a whole one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Piece {
    /// The triangle of the input.
    pub triangle: TriangleId,
    /// Rounded from exact points; counter-clockwise as the triangle.
    pub corners: [DVec3; 3],
    /// Which edges lie on an intersection: edge `i` from corner `i` to the next.
    pub is_cut: [bool; 3],
}

/// Sees each stage; `()` sees nothing, and costs nothing. The stages come in the order of the methods, once: repeats
/// after rounding are not shown.
pub trait Observer {
    /// Pairs of triangles that intersect.
    fn pairs(&mut self, _pairs: &[(TriangleId, TriangleId)]) {}
    /// The segments in which these pairs meet, as [`crate::intersection_segments`] gives them.
    fn segments(&mut self, _segments: &[Segment]) {}
    /// The constrained triangulation of one cut triangle.
    fn cut(&mut self, _triangle: TriangleId, _pieces: &[Piece]) {}
    /// Whether the other methods are called.
    fn is_watching(&self) -> bool {
        false
    }
    /// A piece on the outside, by which a component is entered.
    fn seed(&mut self, _piece: &Piece) {}
    /// A piece that the growing front takes in, neighbour by neighbour from the seed; whole triangles are *valid*, pieces of
    /// cut ones *partially valid* in the words of Zaharescu et al. 2007.
    fn grown(&mut self, _piece: &Piece) {}
}

impl Observer for () {}
