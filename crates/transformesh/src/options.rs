//! What is asked for, and what was done.

use pellicle_mesh::TriangleId;

/// Which surface is kept. The winding number says how often the mesh winds around a place: 1 inside of an ordinary
/// closed mesh, 2 where two solids overlap, −1 inside of one that is inside out.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Rule {
    /// What is reached from outside: as [`Rule::Union`], but sealed voids, and whatever lies in them, are filled. The reading
    /// of Zaharescu et al. 2007. Also the one rule for open meshes, which keep their borders.
    Outside,
    /// The border of where the winding number is at least 1: overlaps merge, voids stay, what is inside out vanishes.
    #[default]
    Union,
    /// The border of where the winding number is not 0: what is inside out is turned.
    Nonzero,
}

/// How to repair.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Options {
    /// Which surface is kept. Default: [`Rule::Union`], the outside surface of any mesh deformed from a valid one.
    pub rule: Rule,
    /// How often to repeat where rounding new vertices to doubles made new intersections. Default: 8; the first nearly always
    /// does. Each takes out slivers sixteen times as thick as the one before, from a few units in the last place on.
    pub rounds: u32,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            rule: Rule::Union,
            rounds: 8,
        }
    }
}

/// What was found and done.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Report {
    /// Whether the mesh is the input, bit for bit.
    pub unchanged: bool,
    /// Pairs of triangles of the input that intersected.
    pub pairs: usize,
    /// Triangles that were cut.
    pub cut: usize,
    /// Triangles of the input without area, which were left out.
    pub degenerate: usize,
    /// Triangles of the input whose orientation was reversed so that neighbours agree, before anything else.
    pub reoriented: usize,
    /// Connected parts of the cut surface, and so rays by which winding numbers were found.
    pub seeds: usize,
    /// Points at which the result has several vertices.
    pub singular_vertices: usize,
    /// Edges that were halved, since two sheets of one umbrella touch along them.
    pub singular_edges: usize,
    /// Vertices of the result that the input does not have.
    pub new_vertices: usize,
    /// Those of them whose exact place is not a triple of doubles, and was rounded.
    pub rounded: usize,
    /// How often the work was repeated because rounding made new intersections.
    pub repeats: u32,
    /// Pairs of triangles that still intersect, and triangles without area, after all repeats: zero but where thousands of
    /// sheets pass within rounding of each other and all are to be kept.
    pub remaining: usize,
    /// Connected components before and after.
    pub components: [usize; 2],
    /// The sum of the components' genus after; before, if the input is a closed manifold.
    pub genus: [Option<usize>; 2],
    /// The signed volume before (of an input with overlaps: each counted) and after.
    pub volume: [f64; 2],
    /// For each triangle of the result the one of the input that it is a piece of.
    pub sources: Vec<TriangleId>,
}
