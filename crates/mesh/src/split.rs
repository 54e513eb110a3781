//! Any soup made a manifold, by cutting where it is none.
//!
//! The cutting half of Guéziec et al. 2001, "Cutting and stitching: converting sets of polygons to
//! manifold surfaces": corners of triangles are the pieces; two triangles that share a manifold edge glue
//! their corners at both its ends; each set of glued corners becomes a vertex.

use crate::edge_table::{EdgeTable, origin, twins_of};
use crate::validate::{duplicates, umbrellas};
use crate::{MeshError, MeshView, TriMesh, TriangleId, TriangleSoup};
use pellicle_geometry::VertexId;

/// What to do about triangles that face the wrong way.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum OrientationPolicy {
    /// Reverse triangles so that neighbours agree; of each piece the fewer triangles are reversed. A
    /// one-sided piece is cut where that fails.
    #[default]
    Reorient,
    /// Leave every triangle as it is, and cut along edges where neighbours disagree.
    Keep,
}

/// How a soup is made a manifold.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SplitOptions {
    /// What to do about triangles that face the wrong way. Default: reverse the fewer.
    pub orientation: OrientationPolicy,
}

/// Why a triangle is not in the mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum DropReason {
    /// A corner names a vertex that does not exist.
    IndexOutOfRange,
    /// It names a vertex more than once.
    RepeatedVertex,
    /// A corner is not finite.
    NotFinite,
    /// An earlier triangle has the same three vertices.
    Duplicate {
        /// That triangle.
        first: TriangleId,
    },
}

/// What was done to a soup; all ids but the indices of the `_origin` lists are those of the soup.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SplitReport {
    /// Triangles that are not in the mesh, and why; by id.
    pub dropped: Vec<(TriangleId, DropReason)>,
    /// Triangles whose orientation was reversed; by id.
    pub reversed: Vec<TriangleId>,
    /// Edges with more than two triangles: cut.
    pub non_manifold_edges: Vec<[VertexId; 2]>,
    /// Edges whose two triangles run along it in the same direction, even after reversing: cut.
    pub inconsistent_edges: Vec<[VertexId; 2]>,
    /// Vertices of which there is more than one in the mesh, and how many; by id.
    pub split_vertices: Vec<(VertexId, u32)>,
    /// Vertices that no triangle of the mesh has: dropped; by id.
    pub isolated: Vec<VertexId>,
    /// For each vertex of the mesh the vertex of the soup that it is, or is a copy of.
    pub vertex_origin: Vec<VertexId>,
    /// For each triangle of the mesh the triangle of the soup that it is.
    pub triangle_origin: Vec<TriangleId>,
}

impl SplitReport {
    /// Whether the mesh is the soup: same vertices, same triangles, same ids.
    pub fn is_unchanged(&self) -> bool {
        self.dropped.is_empty()
            && self.reversed.is_empty()
            && self.split_vertices.is_empty()
            && self.isolated.is_empty()
    }
}

impl TriMesh {
    /// Makes a mesh of any soup: drops triangles that cannot be kept, orients the others alike if asked,
    /// and duplicates vertices where edges or vertices are not manifold.
    ///
    /// No triangle moves or changes shape, and a soup that is a manifold comes back with the same ids. The
    /// first copy of a vertex keeps its place among the others; further copies follow at the end. The one
    /// error is [`MeshError::TooLarge`]. O(n log d), with d the largest vertex degree.
    ///
    /// ```
    /// use pellicle_geometry::{DVec3, VertexId};
    /// use pellicle_mesh::{SplitOptions, TriMesh, TriangleSoup};
    /// // Two triangles that touch in vertex 0 only.
    /// let soup = TriangleSoup {
    ///     positions: vec![DVec3::ZERO, DVec3::X, DVec3::Y, -DVec3::X, -DVec3::Y],
    ///     triangles: vec![[0, 1, 2].map(VertexId), [0, 3, 4].map(VertexId)],
    /// };
    /// let (mesh, report) = TriMesh::from_soup_splitting(soup, &SplitOptions::default())?;
    /// assert_eq!(mesh.triangles()[1], [5, 3, 4].map(VertexId));
    /// assert_eq!(report.split_vertices, [(VertexId(0), 2)]);
    /// # Ok::<(), pellicle_mesh::MeshError>(())
    /// ```
    ///
    /// ```text
    ///   three triangles at the edge a-b          three copies of a and of b
    ///
    ///        c     d                               c     d
    ///         \   /                                 \   /
    ///          a=b              becomes            a=b a=b
    ///           |                                    a=b
    ///           e                                     |
    ///                                                 e
    /// ```
    pub fn from_soup_splitting(
        soup: TriangleSoup,
        options: &SplitOptions,
    ) -> Result<(Self, SplitReport), MeshError> {
        MeshView::from(&soup).check_size()?;
        let mut report = SplitReport::default();
        let mut kept = keep_usable(soup, &mut report);
        if options.orientation == OrientationPolicy::Reorient {
            reorient(&mut kept, &mut report);
        }
        let mesh = Self::try_from(cut(kept, &mut report))?;
        Ok((mesh, report))
    }
}

/// Step 1: the triangles that can be kept, and why the others cannot.
fn keep_usable(mut soup: TriangleSoup, report: &mut SplitReport) -> TriangleSoup {
    let view = MeshView::from(&soup);
    let mut reasons: Vec<Option<DropReason>> = view
        .triangles
        .iter()
        .map(|&triangle| drop_reason(view, triangle))
        .collect();
    for (triangle, first) in duplicates(view) {
        reasons[triangle.index()].get_or_insert(DropReason::Duplicate { first });
    }
    let mut kept = Vec::with_capacity(soup.triangles.len());
    for (t, reason) in reasons.into_iter().enumerate() {
        let triangle = TriangleId::new(t);
        match reason {
            Some(reason) => report.dropped.push((triangle, reason)),
            None => {
                kept.push(soup.triangles[t]);
                report.triangle_origin.push(triangle);
            }
        }
    }
    soup.triangles = kept;
    soup
}

fn drop_reason(mesh: MeshView, triangle: [VertexId; 3]) -> Option<DropReason> {
    let [a, b, c] = triangle;
    if triangle.iter().any(|v| v.index() >= mesh.positions.len()) {
        Some(DropReason::IndexOutOfRange)
    } else if a == b || b == c || c == a {
        Some(DropReason::RepeatedVertex)
    } else if triangle
        .iter()
        .any(|v| !mesh.positions[v.index()].is_finite())
    {
        Some(DropReason::NotFinite)
    } else {
        None
    }
}

/// Step 2: in each piece that hangs together by edges with two triangles, spread the orientation of its
/// first triangle; then reverse the fewer.
fn reorient(soup: &mut TriangleSoup, report: &mut SplitReport) {
    let across = triangles_across(soup);
    let mut seen = vec![false; soup.triangles.len()];
    let mut reversed = vec![false; soup.triangles.len()];
    let mut piece = Vec::new();
    for seed in 0..soup.triangles.len() {
        if std::mem::replace(&mut seen[seed], true) {
            continue;
        }
        piece.clear();
        piece.push(seed);
        let mut next = 0;
        while let Some(&t) = piece.get(next) {
            next += 1;
            for (neighbor, agrees) in across[t].into_iter().flatten() {
                let n = neighbor.index();
                if !std::mem::replace(&mut seen[n], true) {
                    // Neighbours that agree share the flag; those that do not differ.
                    reversed[n] = reversed[t] == agrees;
                    piece.push(n);
                }
            }
        }
        if 2 * piece.iter().filter(|&&t| reversed[t]).count() > piece.len() {
            piece.iter().for_each(|&t| reversed[t] = !reversed[t]);
        }
    }
    for (t, triangle) in soup.triangles.iter_mut().enumerate() {
        if reversed[t] {
            triangle.swap(1, 2);
            report.reversed.push(report.triangle_origin[t]);
        }
    }
}

/// For each half-edge of each triangle, the triangle across an edge that has two, and whether the two
/// agree: run along the edge in opposite directions.
fn triangles_across(soup: &TriangleSoup) -> Vec<[Option<(TriangleId, bool)>; 3]> {
    let mut across = vec![[None; 3]; soup.triangles.len()];
    for (_, group) in EdgeTable::new(soup.into()).edges() {
        if let [a, b] = group {
            let (a, b) = (a.half_edge, b.half_edge);
            let agrees = origin(&soup.triangles, a) != origin(&soup.triangles, b);
            across[a.triangle().index()][a.corner()] = Some((b.triangle(), agrees));
            across[b.triangle().index()][b.corner()] = Some((a.triangle(), agrees));
        }
    }
    across
}

/// Step 3: glue corners across manifold edges only, and make a vertex of each set of corners.
fn cut(mut soup: TriangleSoup, report: &mut SplitReport) -> TriangleSoup {
    let view = MeshView::from(&soup);
    let table = EdgeTable::new(view);
    for (edge, group) in table.edges() {
        match group.len() {
            1 => {}
            2 if twins_of(view.triangles, group).is_some() => {}
            2 => report.inconsistent_edges.push(edge),
            _ => report.non_manifold_edges.push(edge),
        }
    }
    let mut corners = umbrellas(view, &table, |group| {
        twins_of(view.triangles, group).is_some()
    });
    let mut copies = vec![0_u32; soup.positions.len()];
    let heads: Vec<bool> = (0..3 * soup.triangles.len())
        .map(|corner| corners.find(corner as u32) == corner as u32)
        .collect();
    for (vertex, _) in soup
        .triangles
        .as_flattened()
        .iter()
        .zip(&heads)
        .filter(|(_, head)| **head)
    {
        copies[vertex.index()] += 1;
    }
    let mut first_copy = vec![VertexId::NONE; copies.len()];
    for (v, &count) in copies.iter().enumerate() {
        let vertex = VertexId::new(v);
        match count {
            0 => report.isolated.push(vertex),
            _ => {
                first_copy[v] = VertexId::new(report.vertex_origin.len());
                report.vertex_origin.push(vertex);
            }
        }
        if count > 1 {
            report.split_vertices.push((vertex, count));
        }
    }
    // The head of a set is its least corner, so its vertex is settled before any other corner asks.
    let flat = soup.triangles.as_flattened_mut();
    for corner in 0..flat.len() {
        let old = flat[corner];
        flat[corner] = if !heads[corner] {
            flat[corners.find(corner as u32) as usize]
        } else if let Some(first) =
            std::mem::replace(&mut first_copy[old.index()], VertexId::NONE).some()
        {
            first
        } else {
            report.vertex_origin.push(old);
            VertexId::new(report.vertex_origin.len() - 1)
        };
    }
    soup.positions = report
        .vertex_origin
        .iter()
        .map(|v| soup.positions[v.index()])
        .collect();
    soup
}
