//! What Zaharescu et al. 2007 show in section 2: singular vertices and edges, the growing region, changes of topology.

use pellicle_geometry::{DVec3, VertexId};
use pellicle_mesh::{TriMesh, TriangleId, TriangleSoup, count_self_intersections, icosphere};
use pellicle_transformesh::{Observer, Options, Piece, Report, Rule, repair, repair_with};

fn repaired(soup: &TriangleSoup, rule: Rule) -> (TriMesh, Report) {
    let options = Options {
        rule,
        ..Options::default()
    };
    let (mesh, report) = repair(soup, &options).unwrap();
    assert!(mesh.is_closed());
    assert_eq!(count_self_intersections((&mesh).into(), &()).unwrap(), 0);
    assert!(mesh.validate().is_empty(), "{:?}", mesh.validate());
    assert_eq!(report.sources.len(), mesh.triangles().len());
    assert_eq!(report.remaining, 0);
    let (again, second) = repair(&mesh, &options).unwrap();
    assert!(second.unchanged && again == mesh);
    (mesh, report)
}

/// Moved copies of a mesh in one soup.
fn copies(mesh: &TriMesh, shifts: &[DVec3]) -> TriangleSoup {
    let mut soup = TriangleSoup::default();
    for &shift in shifts {
        let first = soup.positions.len() as u32;
        let positions = mesh.positions().iter();
        soup.positions.extend(positions.map(|&p| p + shift));
        let triangles = mesh.triangles().iter();
        soup.triangles
            .extend(triangles.map(|t| t.map(|v| VertexId(v.0 + first))));
    }
    soup
}

/// The unit cube at the origin.
fn cube() -> TriMesh {
    pellicle_mesh::cuboid(DVec3::ZERO, DVec3::ONE).unwrap()
}

#[test]
fn figure_6_an_inverted_triangle_gives_a_singular_vertex() {
    // A vertex pushed past its neighbour, along the surface: the triangles between them turn over.
    let sphere = icosphere(2).unwrap();
    let pushed = VertexId(0);
    for neighbor in sphere.neighbors(pushed) {
        let [from, past] = [pushed, neighbor].map(|v| sphere.position(v));
        let mut soup = sphere.clone().into_soup();
        soup.positions[pushed.index()] = (from + 1.2 * (past - from)).normalize();
        let (mesh, report) = repaired(&soup, Rule::Union);
        assert_eq!(report.pairs, 6);
        assert_eq!(report.singular_vertices, 1);
        assert_eq!((report.components, report.genus[1]), ([1, 1], Some(0)));
        // The vertex and its duplicate.
        let copies = |at: DVec3| mesh.positions().iter().filter(|p| **p == at).count();
        let [pushed, past] = [copies(soup.positions[pushed.index()]), copies(past)];
        assert_eq!(pushed.max(past), 2);
    }
}

#[test]
fn figure_5_singular_edges() {
    // Two full layers of four cubes, and between them two that touch along an edge: around each end of that edge the
    // surface is one umbrella that meets the edge twice.
    let layers = [
        [[0, 0], [1, 0], [0, 1], [1, 1]].as_slice(),
        &[[0, 0], [1, 1]],
        &[[0, 0], [1, 0], [0, 1], [1, 1]],
    ];
    let shifts: Vec<DVec3> = (layers.iter().zip(0..))
        .flat_map(|(cells, z)| cells.iter().map(move |&[x, y]| [x, y, z]))
        .map(|[x, y, z]| DVec3::new(f64::from(x), f64::from(y), f64::from(z)))
        .collect();
    let (_, report) = repaired(&copies(&cube(), &shifts), Rule::Union);
    assert_eq!(report.singular_edges, 1);
    assert!((report.volume[1] - 10.0).abs() < 1e-12);
    assert_eq!(report.components, [10, 1]);
    // The two columns in the middle, parted, make a handle.
    assert_eq!(report.genus[1], Some(1));
}

#[test]
fn figure_7_merges_and_splits() {
    let sphere = icosphere(3).unwrap();
    // Two that overlap become one.
    let two = copies(&sphere, &[DVec3::ZERO, 1.5 * DVec3::X]);
    let (_, merged) = repaired(&two, Rule::Union);
    assert_eq!(merged.components, [2, 1]);
    // One whose waist is turned inside out becomes two.
    let mut dumbbell = sphere.clone().into_soup();
    for p in &mut dumbbell.positions {
        // The upper half goes down, the lower half up, near the plane between them.
        let waist = 1.5 * (-(4.0 * p.x).powi(2)).exp();
        *p = DVec3::new(3.0 * p.x, p.y, p.z * (1.0 - waist));
    }
    let (_, split) = repaired(&dumbbell, Rule::Union);
    assert_eq!((split.components, split.genus[1]), ([1, 2], Some(0)));
    // Of twelve in a ring a torus is made.
    let ring: Vec<DVec3> = (0..12)
        .map(|i| {
            let (sin, cos) = (std::f64::consts::TAU * f64::from(i) / 12.0).sin_cos();
            3.0 * DVec3::new(cos, sin, 0.0)
        })
        .collect();
    let (_, torus) = repaired(&copies(&sphere, &ring), Rule::Union);
    assert_eq!((torus.components, torus.genus[1]), ([12, 1], Some(1)));
}

#[test]
fn rules_differ_in_voids_and_what_is_inside_out() {
    let sphere = icosphere(2).unwrap();
    let mut inner = sphere.clone();
    inner.reverse_orientation();
    let scaled = |mesh: &TriMesh, factor: f64| {
        let mut mesh = mesh.clone();
        let positions = mesh.positions().iter().map(|&p| factor * p).collect();
        mesh.set_positions(positions).unwrap();
        copies(&mesh, &[DVec3::ZERO])
    };
    let joined = |parts: &[TriangleSoup]| {
        let mut all = TriangleSoup::default();
        for part in parts {
            let first = all.positions.len() as u32;
            all.positions.extend(&part.positions);
            let triangles = part.triangles.iter();
            all.triangles
                .extend(triangles.map(|t| t.map(|v| VertexId(v.0 + first))));
        }
        all
    };
    // A shell, an island in its void, and beside them a ball inside out.
    let island = scaled(&sphere, 0.2);
    let shell = [scaled(&sphere, 1.0), scaled(&inner, 0.5)];
    let aside = copies(&inner, &[3.0 * DVec3::X]);
    let soup = joined(&[shell[0].clone(), shell[1].clone(), island, aside]);
    let components = |rule| repaired(&soup, rule).1.components[1];
    assert_eq!(components(Rule::Union), 3);
    assert_eq!(components(Rule::Outside), 1);
    assert_eq!(components(Rule::Nonzero), 4);
}

/// Keeps all that it sees.
#[derive(Default)]
struct Seen {
    pairs: Vec<(TriangleId, TriangleId)>,
    cut: Vec<(TriangleId, Vec<Piece>)>,
    seeds: Vec<Piece>,
    grown: Vec<Piece>,
}

impl Observer for Seen {
    fn pairs(&mut self, pairs: &[(TriangleId, TriangleId)]) {
        self.pairs.extend(pairs);
    }
    fn cut(&mut self, triangle: TriangleId, pieces: &[Piece]) {
        self.cut.push((triangle, pieces.to_vec()));
    }
    fn is_watching(&self) -> bool {
        true
    }
    fn seed(&mut self, piece: &Piece) {
        self.seeds.push(*piece);
    }
    fn grown(&mut self, piece: &Piece) {
        self.grown.push(*piece);
    }
}

fn area([a, b, c]: [DVec3; 3]) -> f64 {
    0.5 * (b - a).cross(c - a).length()
}

#[test]
fn figures_1_to_4_every_state_can_be_seen() {
    let sphere = icosphere(2).unwrap();
    let shifts = [DVec3::ZERO, DVec3::new(0.9, 0.3, 0.1), 5.0 * DVec3::Y];
    let soup = copies(&sphere, &shifts);
    let mut seen = Seen::default();
    let view = (&soup).into();
    let (mesh, report) = repair_with(view, &Options::default(), &(), &mut seen).unwrap();
    // As without an observer.
    let unseen = repair(&soup, &Options::default()).unwrap();
    assert_eq!((&mesh, &report), (&unseen.0, &unseen.1));
    assert_eq!(seen.pairs.len(), report.pairs);
    assert_eq!(seen.cut.len(), report.cut);
    for (triangle, pieces) in &seen.cut {
        let corners = soup.triangles[triangle.index()].map(|v| soup.positions[v.index()]);
        let sum: f64 = pieces.iter().map(|piece| area(piece.corners)).sum();
        assert!((sum / area(corners) - 1.0).abs() < 1e-12);
        assert!(pieces.iter().any(|piece| piece.is_cut.contains(&true)));
        assert!(pieces.iter().all(|piece| piece.triangle == *triangle));
    }
    assert_eq!(seen.seeds.len(), report.components[1]);
    assert_eq!(seen.grown.len(), report.sources.len());
    assert!(seen.seeds.iter().all(|seed| seen.grown.contains(seed)));
    // Whole triangles first, as long as there are any.
    let is_partial = |piece: &Piece| seen.cut.iter().any(|(t, _)| *t == piece.triangle);
    let first_partial = seen.grown.iter().position(is_partial).unwrap();
    assert!(first_partial > 100, "{first_partial}");
}

#[test]
fn a_cut_triangle_is_partial_however_few_pieces_are_left() {
    let sphere = icosphere(2).unwrap();
    for shift in DVec3::AXES
        .into_iter()
        .flat_map(|axis| [0.9 * axis, -0.9 * axis])
    {
        let soup = copies(
            &sphere,
            &[DVec3::ZERO, shift + DVec3::new(0.03, 0.11, 0.07)],
        );
        let mut seen = Seen::default();
        repair_with((&soup).into(), &Options::default(), &(), &mut seen).unwrap();
        let is_partial = |piece: &Piece| seen.cut.iter().any(|(t, _)| *t == piece.triangle);
        assert!(!seen.seeds.iter().any(is_partial));
        // None is taken while a whole one waits beside what was taken before.
        for (place, piece) in seen
            .grown
            .iter()
            .enumerate()
            .filter(|(_, p)| !is_partial(p))
        {
            let before = &seen.grown[..place];
            let borders = |other: &Piece| {
                let shared = piece.corners.iter().filter(|c| other.corners.contains(c));
                shared.count() == 2
            };
            if let Some(found) = before.iter().position(borders) {
                assert!(!before[found + 1..].iter().any(is_partial), "{place}");
            }
        }
    }
}

#[test]
fn open_meshes_are_refused_or_kept_as_seen_from_outside() {
    // A ball without a cap, through the rim of which another ball sticks out.
    let sphere = icosphere(3).unwrap();
    let mut open = sphere.clone().into_soup();
    open.triangles
        .retain(|t| t.iter().any(|v| open.positions[v.index()].z < 0.8));
    let cap = sphere.triangles().len() - open.triangles.len();
    let first = open.positions.len() as u32;
    let beside = copies(&sphere, &[1.2 * DVec3::X]);
    open.positions.extend(&beside.positions);
    open.triangles.extend(
        beside
            .triangles
            .iter()
            .map(|t| t.map(|v| VertexId(v.0 + first))),
    );
    let error = repair(&open, &Options::default()).unwrap_err();
    assert!(error.to_string().contains("Outside"), "{error}");

    let outside = Options {
        rule: Rule::Outside,
        ..Options::default()
    };
    let (mesh, report) = repair(&open, &outside).unwrap();
    assert_eq!(count_self_intersections((&mesh).into(), &()).unwrap(), 0);
    let borders = mesh.border_loops();
    assert!(cap > 0 && !mesh.is_closed());
    // The border where the cap was, all of it on the vertices of the input.
    assert_eq!(borders.len(), 1);
    for h in &borders[0] {
        let at = mesh.position(mesh.origin(*h));
        assert!(open.positions.contains(&at));
    }
    assert_eq!(report.components, [2, 1]);
    // Once more, nothing changes.
    let (again, second) = repair(&mesh, &outside).unwrap();
    assert!(second.unchanged && again == mesh);
}

#[test]
fn orientations_that_disagree_are_mended_first() {
    let sphere = icosphere(2).unwrap();
    let mut soup = copies(&sphere, &[DVec3::ZERO, 1.1 * DVec3::X]);
    for t in [3, 40, 41] {
        soup.triangles[t].swap(0, 1);
    }
    let (_, report) = repaired(&soup, Rule::Union);
    assert_eq!(report.reoriented, 3);
    assert_eq!(report.components, [2, 1]);
}
