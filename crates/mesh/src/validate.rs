//! The total validator: every defect, by id.

use crate::edge_table::{EdgeTable, corner_at, origin};
use crate::{HalfEdgeId, MeshView, TriangleId};
use pellicle_geometry::UnionFind;
use pellicle_geometry::{DVec2, DVec3, VertexId};
use pellicle_predicates::{Sign, orient2d};
use std::fmt;

/// One thing that keeps a soup from being a good oriented manifold.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
pub enum Defect {
    /// More vertices or triangles than `u32` ids can name; nothing else was looked at.
    TooLarge,
    /// A position has a coordinate that is NaN or infinite.
    NotFinite {
        /// The vertex.
        vertex: VertexId,
    },
    /// A corner names a vertex that does not exist.
    IndexOutOfRange {
        /// The triangle.
        triangle: TriangleId,
        /// What its corner names.
        vertex: VertexId,
    },
    /// A triangle names a vertex more than once.
    RepeatedVertex {
        /// The triangle.
        triangle: TriangleId,
        /// The vertex.
        vertex: VertexId,
    },
    /// A triangle has the same three vertices as an earlier one, in either orientation.
    DuplicateTriangle {
        /// The later triangle.
        triangle: TriangleId,
        /// The first one with these vertices.
        first: TriangleId,
    },
    /// More than two triangles share an edge.
    NonManifoldEdge {
        /// Its ends, the lower first.
        edge: [VertexId; 2],
        /// All its triangles.
        triangles: Vec<TriangleId>,
    },
    /// The two triangles of an edge run along it in the same direction.
    InconsistentEdge {
        /// Its ends, the lower first.
        edge: [VertexId; 2],
        /// Its two triangles.
        triangles: [TriangleId; 2],
    },
    /// The triangles at a vertex do not hang together by edges at that vertex.
    NonManifoldVertex {
        /// The vertex.
        vertex: VertexId,
        /// In how many pieces they fall; two or more.
        umbrellas: u32,
    },
    /// No usable triangle has this vertex.
    IsolatedVertex {
        /// The vertex.
        vertex: VertexId,
    },
    /// The corners of a triangle lie exactly on one line. A manifold may hold such triangles.
    ZeroArea {
        /// The triangle.
        triangle: TriangleId,
    },
    /// The stored twin of a half-edge is not the half-edge that runs back along its edge.
    BrokenTwin {
        /// The half-edge.
        half_edge: HalfEdgeId,
    },
    /// The stored outgoing half-edge of a vertex is not the one that it must be.
    BrokenOutgoing {
        /// The vertex.
        vertex: VertexId,
    },
}

impl Defect {
    /// Whether a soup with this defect is refused by [`TriMesh::try_from`](crate::TriMesh): all but
    /// [`Defect::ZeroArea`].
    pub fn prevents_manifold(&self) -> bool {
        !matches!(self, Self::ZeroArea { .. })
    }
}

/// All defects of a mesh or soup, sorted by kind and then by id. Empty for a good oriented manifold.
///
/// Triangles whose vertices are out of range or repeat are reported and otherwise left out: they have no
/// edges. O(n log d), with d the largest vertex degree.
///
/// ```
/// use pellicle_geometry::{DVec3, VertexId};
/// use pellicle_mesh::{Defect, TriangleId, TriangleSoup, validate};
/// let soup = TriangleSoup {
///     positions: vec![DVec3::ZERO, DVec3::X, DVec3::X * 2.0],
///     triangles: vec![[0, 1, 2].map(VertexId)],
/// };
/// assert_eq!(validate((&soup).into()), [Defect::ZeroArea { triangle: TriangleId(0) }]);
/// ```
pub fn validate(mesh: MeshView) -> Vec<Defect> {
    if !mesh.fits_ids() {
        return vec![Defect::TooLarge];
    }
    let mut defects = Vec::new();
    check_positions(mesh, &mut defects);
    check_triangles(mesh, &mut defects);
    let table = EdgeTable::new(mesh);
    check_edges(mesh, &table, &mut defects);
    check_vertices(mesh, &table, &mut defects);
    for (triangle, first) in duplicates(mesh) {
        defects.push(Defect::DuplicateTriangle { triangle, first });
    }
    defects.sort();
    defects.dedup();
    defects
}

/// Whether three points lie exactly on one line, by the signs of their three projections.
pub(crate) fn are_collinear(a: DVec3, b: DVec3, c: DVec3) -> bool {
    let project: [fn(DVec3) -> DVec2; 3] = [
        |p| DVec2::new(p.x, p.y),
        |p| DVec2::new(p.y, p.z),
        |p| DVec2::new(p.z, p.x),
    ];
    project
        .iter()
        .all(|to_plane| orient2d(to_plane(a), to_plane(b), to_plane(c)) == Sign::Zero)
}

/// The triangles with the same three vertices as an earlier one, with that one; by id.
///
/// A counting sort by the lowest vertex, then a small sort in each bucket.
pub(crate) fn duplicates(mesh: MeshView) -> Vec<(TriangleId, TriangleId)> {
    let mut first = vec![0_u32; mesh.positions.len() + 1];
    let usable = |t: &[VertexId; 3]| mesh.is_usable(*t);
    for triangle in mesh.triangles.iter().filter(|t| usable(t)) {
        first[sorted(*triangle)[0].index() + 1] += 1;
    }
    for v in 1..first.len() {
        first[v] += first[v - 1];
    }
    let mut entries = vec![(0_u32, 0_u32, 0_u32); first[mesh.positions.len()] as usize];
    let mut cursor = first.clone();
    for (t, triangle) in mesh.triangles.iter().enumerate().filter(|(_, t)| usable(t)) {
        let [low, middle, high] = sorted(*triangle);
        entries[cursor[low.index()] as usize] = (middle.0, high.0, t as u32);
        cursor[low.index()] += 1;
    }
    let mut found = Vec::new();
    for v in 0..mesh.positions.len() {
        let bucket = &mut entries[first[v] as usize..first[v + 1] as usize];
        bucket.sort_unstable();
        for group in bucket.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
            found.extend(
                group[1..]
                    .iter()
                    .map(|e| (TriangleId(e.2), TriangleId(group[0].2))),
            );
        }
    }
    found.sort_unstable();
    found
}

/// The corners (`3t + i`) joined by sharing an edge at the same vertex: one set for each umbrella.
/// `glues` says which edges join.
pub(crate) fn umbrellas(
    mesh: MeshView,
    table: &EdgeTable,
    mut glues: impl FnMut(&[crate::edge_table::EdgeEntry]) -> bool,
) -> UnionFind {
    let mut corners = UnionFind::new(3 * mesh.triangles.len());
    for (edge, group) in table.edges() {
        if !glues(group) {
            continue;
        }
        for pair in group.windows(2) {
            for v in edge {
                corners.union(
                    corner_at(mesh.triangles, pair[0].half_edge, v).0,
                    corner_at(mesh.triangles, pair[1].half_edge, v).0,
                );
            }
        }
    }
    corners
}

fn sorted(mut triangle: [VertexId; 3]) -> [VertexId; 3] {
    triangle.sort_unstable();
    triangle
}

fn check_positions(mesh: MeshView, defects: &mut Vec<Defect>) {
    for (v, position) in mesh.positions.iter().enumerate() {
        if !position.is_finite() {
            defects.push(Defect::NotFinite {
                vertex: VertexId::new(v),
            });
        }
    }
}

fn check_triangles(mesh: MeshView, defects: &mut Vec<Defect>) {
    for (t, &vertices) in mesh.triangles.iter().enumerate() {
        let triangle = TriangleId::new(t);
        for vertex in vertices {
            if vertex.index() >= mesh.positions.len() {
                defects.push(Defect::IndexOutOfRange { triangle, vertex });
            }
        }
        let [a, b, c] = vertices;
        if a == b || a == c {
            defects.push(Defect::RepeatedVertex {
                triangle,
                vertex: a,
            });
        } else if b == c {
            defects.push(Defect::RepeatedVertex {
                triangle,
                vertex: b,
            });
        } else if let Some([a, b, c]) = mesh.corners(triangle)
            && [a, b, c].iter().all(|p| p.is_finite())
            && are_collinear(a, b, c)
        {
            defects.push(Defect::ZeroArea { triangle });
        }
    }
}

fn check_edges(mesh: MeshView, table: &EdgeTable, defects: &mut Vec<Defect>) {
    for (edge, group) in table.edges() {
        match group {
            [_] => {}
            [a, b] => {
                let (a, b) = (a.half_edge, b.half_edge);
                if origin(mesh.triangles, a) == origin(mesh.triangles, b) {
                    defects.push(Defect::InconsistentEdge {
                        edge,
                        triangles: [a.triangle(), b.triangle()],
                    });
                }
            }
            many => defects.push(Defect::NonManifoldEdge {
                edge,
                triangles: many.iter().map(|e| e.half_edge.triangle()).collect(),
            }),
        }
    }
}

fn check_vertices(mesh: MeshView, table: &EdgeTable, defects: &mut Vec<Defect>) {
    for (v, &umbrellas) in umbrella_counts(mesh, table).iter().enumerate() {
        let vertex = VertexId::new(v);
        match umbrellas {
            0 => defects.push(Defect::IsolatedVertex { vertex }),
            1 => {}
            _ => defects.push(Defect::NonManifoldVertex { vertex, umbrellas }),
        }
    }
}

/// For each vertex, into how many pieces its triangles fall: 0 for an isolated vertex, 1 for a manifold
/// one whose edges are manifold.
pub(crate) fn umbrella_counts(mesh: MeshView, table: &EdgeTable) -> Vec<u32> {
    let mut corners = umbrellas(mesh, table, |_| true);
    let mut counts = vec![0_u32; mesh.positions.len()];
    for (t, &triangle) in mesh.triangles.iter().enumerate() {
        if mesh.is_usable(triangle) {
            for (i, vertex) in triangle.iter().enumerate() {
                let corner = (3 * t + i) as u32;
                counts[vertex.index()] += u32::from(corners.find(corner) == corner);
            }
        }
    }
    counts
}

impl fmt::Display for Defect {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TooLarge => write!(f, "more vertices or triangles than 32-bit ids can name"),
            Self::NotFinite { vertex } => write!(f, "vertex {} is not finite", vertex.0),
            Self::IndexOutOfRange { triangle, vertex } => {
                write!(
                    f,
                    "triangle {} names vertex {}, which does not exist",
                    triangle.0, vertex.0
                )
            }
            Self::RepeatedVertex { triangle, vertex } => {
                write!(
                    f,
                    "triangle {} names vertex {} more than once",
                    triangle.0, vertex.0
                )
            }
            Self::DuplicateTriangle { triangle, first } => {
                write!(
                    f,
                    "triangle {} has the vertices of triangle {}",
                    triangle.0, first.0
                )
            }
            Self::NonManifoldEdge {
                edge: [a, b],
                triangles,
            } => {
                write!(f, "edge {}-{} has {} triangles", a.0, b.0, triangles.len())
            }
            Self::InconsistentEdge {
                edge: [a, b],
                triangles: [s, t],
            } => write!(
                f,
                "triangles {} and {} run along edge {}-{} in the same direction",
                s.0, t.0, a.0, b.0
            ),
            Self::NonManifoldVertex { vertex, umbrellas } => {
                write!(
                    f,
                    "the triangles at vertex {} fall into {umbrellas} pieces",
                    vertex.0
                )
            }
            Self::IsolatedVertex { vertex } => write!(f, "vertex {} has no triangle", vertex.0),
            Self::ZeroArea { triangle } => write!(f, "triangle {} has no area", triangle.0),
            Self::BrokenTwin { half_edge } => {
                write!(f, "half-edge {} has a wrong twin", half_edge.0)
            }
            Self::BrokenOutgoing { vertex } => {
                write!(f, "vertex {} has a wrong outgoing half-edge", vertex.0)
            }
        }
    }
}
