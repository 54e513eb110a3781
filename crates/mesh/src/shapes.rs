//! Spheres from the icosahedron, boxes, and subdivision of any mesh.

use crate::{HalfEdgeId, MeshError, TriMesh, TriangleId, TriangleSoup};
use pellicle_geometry::{DVec3, VertexId};

/// The icosahedron.
const ICOSAHEDRON: [[u32; 3]; 20] = [
    [0, 11, 5],
    [0, 5, 1],
    [0, 1, 7],
    [0, 7, 10],
    [0, 10, 11],
    [1, 5, 9],
    [5, 11, 4],
    [11, 10, 2],
    [10, 7, 6],
    [7, 1, 8],
    [3, 9, 4],
    [3, 4, 2],
    [3, 2, 6],
    [3, 6, 8],
    [3, 8, 9],
    [4, 9, 5],
    [2, 4, 11],
    [6, 2, 10],
    [8, 6, 7],
    [9, 8, 1],
];

/// The sides of a box, counter-clockwise seen from outside; bits of a corner stand for the upper end along x, y and z.
const SIDES: [[u32; 4]; 6] = [
    [0, 2, 3, 1],
    [4, 5, 7, 6],
    [0, 1, 5, 4],
    [2, 6, 7, 3],
    [0, 4, 6, 2],
    [1, 3, 7, 5],
];

/// The box from `min` to `max`: 8 vertices and 12 triangles. Vertex k has the coordinates of `max` along x, y, z where bits 0, 1,
/// 2 of k are set, otherwise those of `min`.
///
/// Triangles are counter-clockwise seen from outside; clockwise where `max` is below `min` along one axis or along all three. The
/// one error is [`MeshError::NotManifold`], of corners that are not finite.
///
/// ```
/// use pellicle_geometry::DVec3;
/// use pellicle_mesh::{cuboid, signed_volume};
/// let slab = cuboid(DVec3::ZERO, DVec3::new(3.0, 2.0, 0.5))?;
/// assert!(slab.is_closed());
/// assert_eq!(signed_volume((&slab).into()), 3.0);
/// # Ok::<(), pellicle_mesh::MeshError>(())
/// ```
pub fn cuboid(min: DVec3, max: DVec3) -> Result<TriMesh, MeshError> {
    let corner = |k: u32| {
        let end = |axis: usize| if k >> axis & 1 == 1 { max } else { min }[axis];
        DVec3::new(end(0), end(1), end(2))
    };
    let halves = |[a, b, c, d]: [u32; 4]| [[a, b, c], [a, c, d]].map(|t| t.map(VertexId));
    TriMesh::try_from(TriangleSoup {
        positions: (0..8).map(corner).collect(),
        triangles: SIDES.into_iter().flat_map(halves).collect(),
    })
}

/// The unit sphere around the origin: the icosahedron, subdivided `levels` times, the points pushed onto the
/// sphere after each. 10 · 4ᴸ + 2 vertices and 20 · 4ᴸ triangles for L levels: 12, 42, 162, 642, 2562, …
///
/// Triangles are counter-clockwise seen from outside. Linear in the result. The one error is
/// [`MeshError::TooLarge`], from 14 levels on.
///
/// ```
/// use pellicle_mesh::icosphere;
/// let sphere = icosphere(2)?;
/// assert_eq!((sphere.positions().len(), sphere.triangles().len()), (162, 320));
/// assert!(sphere.is_closed());
/// # Ok::<(), pellicle_mesh::MeshError>(())
/// ```
pub fn icosphere(levels: u32) -> Result<TriMesh, MeshError> {
    let growth = 4_usize.saturating_pow(levels);
    check_size(
        growth.saturating_mul(10).saturating_add(2),
        growth.saturating_mul(20),
    )?;
    let mut mesh = icosahedron();
    for _ in 0..levels {
        mesh = subdivide(&mesh)?;
        let on_sphere = mesh.positions().iter().map(|p| p.normalize()).collect();
        mesh.set_positions(on_sphere)?;
    }
    Ok(mesh)
}

/// Every triangle in four, by the middles of its edges. The surface stays the same set of points.
///
/// ```text
///              c
///             / \            triangle t becomes  4t     at a
///            /4t+2\                              4t + 1 at b
///          ca ---- bc                            4t + 2 at c
///          / \4t+3/ \                            4t + 3 in the middle
///         /4t \  /4t+1\
///        a --- ab ---- b
/// ```
///
/// Vertices keep their ids; the middle of the n-th edge of [`TriMesh::edges`] becomes vertex `V + n`, with `V`
/// the number of vertices before. Corner `i` of triangle `4t + i` is corner `i` of `t`; so a border stays one,
/// and topology stays as it was. Linear time. The one error is [`MeshError::TooLarge`].
///
/// ```
/// use pellicle_mesh::{icosphere, subdivide};
/// let finer = subdivide(&icosphere(0)?)?;
/// assert_eq!((finer.positions().len(), finer.triangles().len()), (42, 80));
/// # Ok::<(), pellicle_mesh::MeshError>(())
/// ```
pub fn subdivide(mesh: &TriMesh) -> Result<TriMesh, MeshError> {
    let (old, count) = (mesh.positions().len(), mesh.triangles().len());
    let edges = mesh.edges().count();
    check_size(old + edges, count.saturating_mul(4))?;
    let mut positions = mesh.positions().to_vec();
    positions.reserve(edges);
    let mut middles = vec![VertexId::NONE; 3 * count];
    for h in mesh.edges() {
        let middle = VertexId::new(positions.len());
        let [a, b] = [mesh.origin(h), mesh.destination(h)].map(|v| mesh.position(v));
        // Halved first: the sum might overflow. The order of the sum does not matter to its rounding.
        positions.push(a * 0.5 + b * 0.5);
        middles[h.index()] = middle;
        if let Some(twin) = mesh.twin(h) {
            middles[twin.index()] = middle;
        }
    }
    let mut triangles = Vec::with_capacity(4 * count);
    let mut twins = Vec::with_capacity(12 * count);
    for t in mesh.triangle_ids() {
        let [a, b, c] = mesh.triangles()[t.index()];
        let [ab, bc, ca] = [0, 1, 2].map(|i| middles[HalfEdgeId::of(t, i).index()]);
        triangles.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
        twins.extend((0..12).map(|h| twin_after_subdivision(mesh, t, h / 3, h % 3)));
    }
    Ok(TriMesh::from_connected(positions, triangles, twins))
}

/// The twin of half-edge `corner` of child `child` of triangle `t`.
///
/// Half-edge `i` of `t` becomes, in order, half-edge `i` of child `i` and half-edge `i` of child `i + 1`;
/// half-edge `i + 2` of child `i + 1` meets half-edge `i` of the middle.
fn twin_after_subdivision(
    mesh: &TriMesh,
    t: TriangleId,
    child: usize,
    corner: usize,
) -> HalfEdgeId {
    let of = |t: TriangleId, child: usize, corner| {
        HalfEdgeId::of(TriangleId::new(4 * t.index() + child), corner)
    };
    if child == 3 {
        return of(t, (corner + 1) % 3, (corner + 2) % 3);
    }
    if corner == (child + 1) % 3 {
        return of(t, 3, (child + 2) % 3);
    }
    match mesh.twin(HalfEdgeId::of(t, corner)) {
        None => HalfEdgeId::NONE,
        // The first half runs beside the twin's second half, and the other way round.
        Some(twin) if corner == child => {
            of(twin.triangle(), (twin.corner() + 1) % 3, twin.corner())
        }
        Some(twin) => of(twin.triangle(), twin.corner(), twin.corner()),
    }
}

fn icosahedron() -> TriMesh {
    let golden = (1.0 + 5.0_f64.sqrt()) / 2.0;
    let positions = [
        DVec3::new(-1.0, golden, 0.0),
        DVec3::new(1.0, golden, 0.0),
        DVec3::new(-1.0, -golden, 0.0),
        DVec3::new(1.0, -golden, 0.0),
        DVec3::new(0.0, -1.0, golden),
        DVec3::new(0.0, 1.0, golden),
        DVec3::new(0.0, -1.0, -golden),
        DVec3::new(0.0, 1.0, -golden),
        DVec3::new(golden, 0.0, -1.0),
        DVec3::new(golden, 0.0, 1.0),
        DVec3::new(-golden, 0.0, -1.0),
        DVec3::new(-golden, 0.0, 1.0),
    ];
    let triangles: Vec<[VertexId; 3]> = ICOSAHEDRON.map(|t| t.map(VertexId)).to_vec();
    let directed = |h: usize| {
        let triangle = triangles[h / 3];
        (triangle[h % 3], triangle[(h + 1) % 3])
    };
    let twins = (0..60)
        .map(|h| {
            let (a, b) = directed(h);
            let twin = (0..60).find(|&g| directed(g) == (b, a));
            twin.map_or(HalfEdgeId::NONE, HalfEdgeId::new)
        })
        .collect();
    let on_sphere = positions.map(DVec3::normalize).to_vec();
    TriMesh::from_connected(on_sphere, triangles, twins)
}

fn check_size(vertices: usize, triangles: usize) -> Result<(), MeshError> {
    match vertices < u32::MAX as usize && triangles < u32::MAX as usize / 3 {
        true => Ok(()),
        false => Err(MeshError::TooLarge {
            vertices,
            triangles,
        }),
    }
}
