//! Measures of any mesh or soup: what it is made of, how large it is, what its topology is.

use crate::edge_table::{EdgeEntry, EdgeTable, corner_at, origin};
use crate::frame::{Frame, Sum};
use crate::validate::{duplicates, umbrellas};
use crate::{MeshError, MeshView, TriangleId};
use pellicle_geometry::UnionFind;
use pellicle_geometry::{Aabb, DVec3, VertexId, triangle};
use std::f64::consts::PI;

/// What [`summarize`] finds. Triangles whose vertices do not exist or repeat are counted as unusable and
/// otherwise left out. Lengths are in the units of the positions.
#[derive(Clone, Debug, PartialEq)]
pub struct Summary {
    /// All vertices.
    pub vertices: usize,
    /// All triangles.
    pub triangles: usize,
    /// Triangles with a vertex that does not exist, or twice the same.
    pub unusable_triangles: usize,
    /// Triangles with the same three vertices as an earlier one.
    pub duplicate_triangles: usize,
    /// Undirected edges.
    pub edges: usize,
    /// Edges with one triangle.
    pub border_edges: usize,
    /// Edges with more than two triangles.
    pub non_manifold_edges: usize,
    /// Edges whose two triangles run along it in the same direction.
    pub inconsistent_edges: usize,
    /// Vertices whose triangles do not hang together by edges at the vertex.
    pub non_manifold_vertices: usize,
    /// Vertices without a usable triangle.
    pub isolated_vertices: usize,
    /// Vertices with a coordinate that is NaN or infinite; their triangles have no area, volume or angle.
    pub not_finite_vertices: usize,
    /// The box around all vertices.
    pub bounds: Aabb,
    /// The sum of the areas.
    pub area: f64,
    /// The enclosed volume, positive if triangles are counter-clockwise seen from outside; `None` unless
    /// every edge is run along as often one way as the other: closed and oriented.
    pub volume: Option<f64>,
    /// The pieces that hang together by edges, by their first triangle.
    pub components: Vec<Component>,
    /// Edge lengths and angles; `None` without a usable triangle.
    pub shape: Option<Shape>,
}

/// A piece that hangs together by edges.
#[derive(Clone, Debug, PartialEq)]
pub struct Component {
    /// Its first triangle.
    pub first: TriangleId,
    /// Its triangles.
    pub triangles: usize,
    /// Its vertices.
    pub vertices: usize,
    /// Its edges.
    pub edges: usize,
    /// Its edges with one triangle.
    pub border_edges: usize,
    /// The closed chains of border edges.
    pub border_loops: usize,
    /// Its edges with more than two triangles.
    pub non_manifold_edges: usize,
    /// Its edges whose two triangles run along it in the same direction.
    pub inconsistent_edges: usize,
    /// Its vertices at which its own triangles do not hang together.
    pub non_manifold_vertices: usize,
    /// Whether reversing triangles can make it oriented: a Möbius strip is not orientable. Judged along
    /// edges with two triangles.
    pub orientable: bool,
    /// The sum of the areas.
    pub area: f64,
    /// The enclosed volume, as for the whole.
    pub volume: Option<f64>,
}

/// Edge lengths, and angles of triangles in radians.
#[derive(Clone, Debug, PartialEq)]
pub struct Shape {
    /// The shortest edge.
    pub min_edge: f64,
    /// The mean over edges, each counted once.
    pub mean_edge: f64,
    /// The longest edge.
    pub max_edge: f64,
    /// The least angle.
    pub min_angle: f64,
    /// The greatest angle.
    pub max_angle: f64,
    /// How many angles lie in each ten degrees: 0° to 10°, …, 170° to 180°; an angle on a limit counts in the
    /// upper class, 180° in the last.
    pub angle_histogram: [u64; 18],
}

impl Summary {
    /// Whether there are triangles, and each edge has at least two.
    pub fn is_closed(&self) -> bool {
        self.edges > 0 && self.border_edges == 0
    }

    /// Whether no edge has more than two triangles.
    pub fn is_edge_manifold(&self) -> bool {
        self.non_manifold_edges == 0
    }

    /// Whether the triangles at each vertex hang together.
    pub fn is_vertex_manifold(&self) -> bool {
        self.non_manifold_vertices == 0
    }

    /// Whether the two triangles of each edge that has two run along it in opposite directions.
    pub fn is_oriented(&self) -> bool {
        self.inconsistent_edges == 0
    }

    /// The closed chains of border edges.
    pub fn border_loops(&self) -> usize {
        self.components.iter().map(|c| c.border_loops).sum()
    }

    /// The sum over the components of vertices − edges + triangles.
    pub fn euler_characteristic(&self) -> i64 {
        self.components
            .iter()
            .map(Component::euler_characteristic)
            .sum()
    }

    /// The sum of the genera; `None` if one of them has none.
    pub fn genus(&self) -> Option<usize> {
        self.components.iter().map(Component::genus).sum()
    }
}

impl Component {
    /// Vertices − edges + triangles.
    pub fn euler_characteristic(&self) -> i64 {
        self.vertices as i64 - self.edges as i64 + self.triangles as i64
    }

    /// Whether each edge has at least two triangles.
    pub fn is_closed(&self) -> bool {
        self.border_edges == 0
    }

    /// The number of handles, from χ = 2 − 2g − b with b border loops; `None` unless it is an orientable
    /// manifold.
    pub fn genus(&self) -> Option<usize> {
        let surface =
            self.orientable && self.non_manifold_edges == 0 && self.non_manifold_vertices == 0;
        let twice = 2 - self.euler_characteristic() - self.border_loops as i64;
        surface.then(|| usize::try_from(twice / 2).ok()).flatten()
    }
}

/// Measures a mesh or soup. O(n log d), with d the largest vertex degree; about 90 bytes a triangle meanwhile.
/// The one error is [`MeshError::TooLarge`].
///
/// ```
/// use pellicle_geometry::{DVec3, VertexId};
/// use pellicle_mesh::{TriangleSoup, summarize};
/// let tetrahedron = TriangleSoup {
///     positions: vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z],
///     triangles: [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]].map(|t| t.map(VertexId)).to_vec(),
/// };
/// let summary = summarize((&tetrahedron).into())?;
/// assert!(summary.is_closed() && summary.is_oriented());
/// assert_eq!(summary.genus(), Some(0));
/// assert!((summary.volume.unwrap() - 1.0 / 6.0).abs() < 1e-15);
/// # Ok::<(), pellicle_mesh::MeshError>(())
/// ```
pub fn summarize(mesh: MeshView) -> Result<Summary, MeshError> {
    mesh.check_size()?;
    let table = EdgeTable::new(mesh);
    let mut pieces = Pieces::new(mesh, &table);
    pieces.count_triangles(mesh);
    pieces.count_edges(mesh, &table);
    pieces.judge_orientability(mesh, &table);
    let (isolated_vertices, non_manifold_vertices) = pieces.count_vertices(mesh, &table);
    let count = |of: fn(&Component) -> usize| pieces.components.iter().map(of).sum();
    Ok(Summary {
        vertices: mesh.positions.len(),
        triangles: mesh.triangles.len(),
        unusable_triangles: pieces.of_triangle.iter().filter(|&&c| c == NOWHERE).count(),
        duplicate_triangles: duplicates(mesh).len(),
        edges: count(|c| c.edges),
        border_edges: count(|c| c.border_edges),
        non_manifold_edges: count(|c| c.non_manifold_edges),
        inconsistent_edges: count(|c| c.inconsistent_edges),
        non_manifold_vertices,
        isolated_vertices,
        not_finite_vertices: mesh.positions.iter().filter(|p| !p.is_finite()).count(),
        bounds: mesh.bounds(),
        area: area(mesh),
        volume: match pieces.components.iter().all(|c| c.volume.is_some()) {
            true if !pieces.components.is_empty() => Some(signed_volume(mesh)),
            _ => None,
        },
        shape: shape(mesh, &table),
        components: pieces.components,
    })
}

/// For each triangle the least vertex of its component: of those that it hangs together with by common vertices.
/// [`VertexId::NONE`] for triangles that name a vertex that does not exist. Near-linear time.
///
/// ```
/// use pellicle_geometry::{DVec3, VertexId};
/// use pellicle_mesh::{TriangleSoup, components};
/// let soup = TriangleSoup {
///     positions: vec![DVec3::ZERO; 8],
///     triangles: [[0, 1, 2], [5, 6, 7], [2, 3, 4]].map(|t| t.map(VertexId)).to_vec(),
/// };
/// assert_eq!(components((&soup).into()), [0, 5, 0].map(VertexId));
/// ```
pub fn components(mesh: MeshView) -> Vec<VertexId> {
    let exists = |t: &&[VertexId; 3]| t.iter().all(|v| v.index() < mesh.positions.len());
    let mut sets = UnionFind::new(mesh.positions.len());
    for [a, b, c] in mesh.triangles.iter().filter(exists) {
        sets.union(a.0, b.0);
        sets.union(a.0, c.0);
    }
    let triangles = mesh.triangles.iter();
    triangles
        .map(|t| match exists(&t) {
            true => VertexId(sets.find(t[0].0)),
            false => VertexId::NONE,
        })
        .collect()
}

/// The sum of the areas of the usable triangles with finite corners. Linear time.
pub fn area(mesh: MeshView) -> f64 {
    let mut sum = Sum::default();
    let frame = Frame::of(mesh.positions);
    for (_, [a, b, c]) in measurable(mesh) {
        sum.add(triangle::area(
            frame.apply(a),
            frame.apply(b),
            frame.apply(c),
        ));
    }
    sum.value() * frame.scale * frame.scale
}

/// The volume between the usable triangles with finite corners and the middle of the bounds, counted
/// negative where a triangle faces the middle: the enclosed volume if the mesh is closed and oriented.
/// Linear time.
pub fn signed_volume(mesh: MeshView) -> f64 {
    let mut sum = Sum::default();
    let frame = Frame::of(mesh.positions);
    for (_, corners) in measurable(mesh) {
        sum.add(signed_volume_below(frame, corners));
    }
    volume_in_units(sum, frame)
}

/// Six times the volume between a triangle and the origin of the frame, in its units.
fn signed_volume_below(frame: Frame, corners: [DVec3; 3]) -> f64 {
    let [a, b, c] = corners.map(|p| frame.apply(p));
    a.dot(b.cross(c))
}

fn volume_in_units(six_times: Sum, frame: Frame) -> f64 {
    six_times.value() / 6.0 * frame.scale * frame.scale * frame.scale
}

/// The usable triangles with finite corners.
pub(crate) fn measurable(mesh: MeshView) -> impl Iterator<Item = (usize, [DVec3; 3])> {
    let corners = move |t: usize| {
        let corners = mesh.corners(TriangleId::new(t))?;
        let good = mesh.is_usable(mesh.triangles[t]) && corners.iter().all(|p| p.is_finite());
        good.then_some((t, corners))
    };
    (0..mesh.triangles.len()).filter_map(corners)
}

/// The component of an unusable triangle.
const NOWHERE: u32 = u32::MAX;

struct Pieces {
    components: Vec<Component>,
    /// For each triangle the index of its component.
    of_triangle: Vec<u32>,
}

impl Pieces {
    fn new(mesh: MeshView, table: &EdgeTable) -> Self {
        let mut sets = UnionFind::new(mesh.triangles.len());
        for (_, group) in table.edges() {
            for pair in group.windows(2) {
                sets.union(
                    pair[0].half_edge.triangle().0,
                    pair[1].half_edge.triangle().0,
                );
            }
        }
        let mut components = Vec::new();
        let mut of_triangle = vec![NOWHERE; mesh.triangles.len()];
        for t in 0..mesh.triangles.len() {
            if !mesh.is_usable(mesh.triangles[t]) {
                continue;
            }
            let root = sets.find(t as u32) as usize;
            if root == t {
                of_triangle[t] = components.len() as u32;
                components.push(Component::starting_at(TriangleId::new(t)));
            } else {
                // The root is the least of its set, so it has its number already.
                of_triangle[t] = of_triangle[root];
            }
        }
        Self {
            components,
            of_triangle,
        }
    }

    fn of(&mut self, triangle: TriangleId) -> &mut Component {
        &mut self.components[self.of_triangle[triangle.index()] as usize]
    }

    fn count_triangles(&mut self, mesh: MeshView) {
        for &c in self.of_triangle.iter().filter(|&&c| c != NOWHERE) {
            self.components[c as usize].triangles += 1;
        }
        let frame = Frame::of(mesh.positions);
        let mut sums = vec![(Sum::default(), Sum::default()); self.components.len()];
        for (t, corners) in measurable(mesh) {
            let (area, volume) = &mut sums[self.of_triangle[t] as usize];
            let [a, b, c] = corners.map(|p| frame.apply(p));
            area.add(triangle::area(a, b, c));
            volume.add(signed_volume_below(frame, corners));
        }
        for (component, (area, volume)) in self.components.iter_mut().zip(sums) {
            component.area = area.value() * frame.scale * frame.scale;
            component.volume = Some(volume_in_units(volume, frame));
        }
    }

    fn count_edges(&mut self, mesh: MeshView, table: &EdgeTable) {
        for (edge, group) in table.edges() {
            let component = self.of(group[0].half_edge.triangle());
            let forward = group
                .iter()
                .filter(|e| origin(mesh.triangles, e.half_edge) == edge[0])
                .count();
            component.edges += 1;
            match group.len() {
                1 => component.border_edges += 1,
                2 => component.inconsistent_edges += usize::from(forward != 1),
                _ => component.non_manifold_edges += 1,
            }
            if 2 * forward != group.len() {
                component.volume = None;
            }
        }
    }

    /// Two sides for each triangle, joined across edges with two triangles: a component is one-sided where
    /// both sides of a triangle are joined.
    fn judge_orientability(&mut self, mesh: MeshView, table: &EdgeTable) {
        let mut sides = UnionFind::new(2 * mesh.triangles.len());
        for (_, group) in table.edges() {
            if let [a, b] = group {
                let (s, t) = (a.half_edge.triangle().0, b.half_edge.triangle().0);
                let disagree = u32::from(
                    origin(mesh.triangles, a.half_edge) == origin(mesh.triangles, b.half_edge),
                );
                sides.union(2 * s, 2 * t + disagree);
                sides.union(2 * s + 1, 2 * t + 1 - disagree);
            }
        }
        for t in 0..self.of_triangle.len() as u32 {
            if self.of_triangle[t as usize] != NOWHERE && sides.find(2 * t) == sides.find(2 * t + 1)
            {
                self.of(TriangleId(t)).orientable = false;
            }
        }
    }

    /// Counts the vertices of each component and its border loops; returns how many vertices are isolated,
    /// and how many are not manifold.
    fn count_vertices(&mut self, mesh: MeshView, table: &EdgeTable) -> (usize, usize) {
        let mut corners = umbrellas(mesh, table, |_| true);
        self.count_border_loops(mesh, table, &mut corners);
        // One entry for each umbrella: its vertex and component.
        let mut fans: Vec<(VertexId, u32)> = Vec::with_capacity(mesh.positions.len());
        for (corner, &vertex) in mesh.triangles.as_flattened().iter().enumerate() {
            let component = self.of_triangle[corner / 3];
            if component != NOWHERE && corners.find(corner as u32) == corner as u32 {
                fans.push((vertex, component));
            }
        }
        fans.sort_unstable();
        for group in fans.chunk_by(|a, b| a == b) {
            let component = &mut self.components[group[0].1 as usize];
            component.vertices += 1;
            component.non_manifold_vertices += usize::from(group.len() > 1);
        }
        let (mut used, mut non_manifold) = (0, 0);
        for group in fans.chunk_by(|a, b| a.0 == b.0) {
            used += 1;
            non_manifold += usize::from(group.len() > 1);
        }
        (mesh.positions.len() - used, non_manifold)
    }

    /// Border edges that end in the same umbrella belong to the same loop.
    fn count_border_loops(&mut self, mesh: MeshView, table: &EdgeTable, corners: &mut UnionFind) {
        let border: Vec<([VertexId; 2], EdgeEntry)> = table
            .edges()
            .filter_map(|(edge, group)| match group {
                [only] => Some((edge, *only)),
                _ => None,
            })
            .collect();
        let mut ends: Vec<(u32, u32)> = Vec::with_capacity(2 * border.len());
        for (i, (edge, entry)) in border.iter().enumerate() {
            for &v in edge {
                let corner = corner_at(mesh.triangles, entry.half_edge, v);
                ends.push((corners.find(corner.0), i as u32));
            }
        }
        ends.sort_unstable();
        let mut loops = UnionFind::new(border.len());
        for group in ends.chunk_by(|a, b| a.0 == b.0) {
            for pair in group.windows(2) {
                loops.union(pair[0].1, pair[1].1);
            }
        }
        for (i, (_, entry)) in border.iter().enumerate() {
            if loops.find(i as u32) == i as u32 {
                self.of(entry.half_edge.triangle()).border_loops += 1;
            }
        }
    }
}

impl Component {
    fn starting_at(first: TriangleId) -> Self {
        Self {
            first,
            triangles: 0,
            vertices: 0,
            edges: 0,
            border_edges: 0,
            border_loops: 0,
            non_manifold_edges: 0,
            inconsistent_edges: 0,
            non_manifold_vertices: 0,
            orientable: true,
            area: 0.0,
            volume: None,
        }
    }
}

/// Edge lengths and angles of the usable triangles with finite corners.
fn shape(mesh: MeshView, table: &EdgeTable) -> Option<Shape> {
    let frame = Frame::of(mesh.positions);
    let at = |v: VertexId| frame.apply(mesh.positions[v.index()]);
    let (mut min_edge, mut max_edge, mut sum, mut count) =
        (f64::INFINITY, 0.0_f64, Sum::default(), 0);
    for ([a, b], _) in table.edges() {
        let length = at(a).distance(at(b));
        if length.is_finite() {
            min_edge = min_edge.min(length);
            max_edge = max_edge.max(length);
            sum.add(length);
            count += 1;
        }
    }
    let (mut min_angle, mut max_angle, mut angle_histogram) = (PI, 0.0_f64, [0; 18]);
    for (_, [a, b, c]) in measurable(mesh) {
        for angle in triangle::angles(a, b, c) {
            min_angle = min_angle.min(angle);
            max_angle = max_angle.max(angle);
            angle_histogram[((angle * (18.0 / PI)) as usize).min(17)] += 1;
        }
    }
    (angle_histogram != [0; 18]).then(|| Shape {
        min_edge: min_edge * frame.scale,
        mean_edge: sum.value() / f64::from(count) * frame.scale,
        max_edge: max_edge * frame.scale,
        min_angle,
        max_angle,
        angle_histogram,
    })
}
