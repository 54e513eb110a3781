//! Inputs, and what must hold of every repaired mesh.
#![allow(dead_code)]

use pellicle_geometry::{Aabb, DVec3, VertexId};
use pellicle_mesh::{
    Defect, MeshView, TriMesh, TriangleId, TriangleSoup, count_self_intersections,
    self_intersections, summarize, validate, winding_numbers,
};
use pellicle_transformesh::{Options, Report, Rule, repair};
use std::collections::HashSet;

/// A mesh of the folder of fixtures.
pub fn workload(name: &str) -> TriangleSoup {
    let path = format!(
        "{}/../../fixtures/repair/{name}.off",
        env!("CARGO_MANIFEST_DIR")
    );
    let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{path}: {error}"));
    let mut words = text.split_whitespace();
    assert_eq!(words.next(), Some("OFF"), "{name}");
    let mut number = || -> f64 {
        let word = words.next().expect("as many numbers as announced");
        word.parse().expect("a number")
    };
    let [vertices, triangles, _] = [(); 3].map(|()| number() as usize);
    let mut soup = TriangleSoup::default();
    for _ in 0..vertices {
        soup.positions.push(DVec3::from([(); 3].map(|()| number())));
    }
    for _ in 0..triangles {
        assert_eq!(number(), 3.0, "{name}: triangles alone");
        let corners = [(); 3].map(|()| VertexId(number() as u32));
        soup.triangles.push(corners);
    }
    soup
}

pub fn options(rule: Rule) -> Options {
    Options {
        rule,
        ..Options::default()
    }
}

/// Whether a point of this winding number is inside of what the rule keeps, sealed voids aside.
pub fn is_inside(rule: Rule, winding: i32) -> bool {
    match rule {
        Rule::Nonzero => winding != 0,
        _ => winding >= 1,
    }
}

/// Repairs, and checks what must hold whatever the input is, but for sealed voids under [`Rule::Outside`].
pub fn repaired(input: &TriangleSoup, rule: Rule) -> (TriMesh, Report) {
    let (mesh, report) = repair(input, &options(rule)).unwrap_or_else(|error| {
        panic!("{error}\n{}", pasted(input));
    });
    if let Err(reason) = soundness(input, rule, &mesh, &report) {
        panic!("{reason}\n{}", pasted(input));
    }
    (mesh, report)
}

fn soundness(
    input: &TriangleSoup,
    rule: Rule,
    mesh: &TriMesh,
    report: &Report,
) -> Result<(), String> {
    let check = |holds: bool, what: &str| match holds {
        true => Ok(()),
        false => Err(what.to_owned()),
    };
    let defects = mesh.validate();
    check(defects.is_empty(), &format!("defects: {defects:?}"))?;
    check(mesh.is_closed(), "a border")?;
    let met = count_self_intersections(mesh.into(), &()).map_err(|error| error.to_string())?;
    check(met == 0, &format!("{met} pairs intersect"))?;
    sources(input, mesh, report)?;
    let (again, _) = repair(mesh, &options(rule)).map_err(|error| error.to_string())?;
    check(
        same_bits(mesh, &again),
        "repaired twice is not repaired once",
    )?;
    if rule != Rule::Outside {
        windings(input, rule, mesh)?;
    }
    Ok(())
}

/// No vertex of the result stands beside a vertex of the input, so near that only rounding explains it: a vertex that
/// survives does not move. Not for meshes whose sheets come that near to each other's vertices.
pub fn survivors(input: &TriangleSoup, mesh: &TriMesh) -> Result<(), String> {
    let near = 1e-12 * Aabb::of_points(&input.positions).diagonal();
    let exact: HashSet<[u64; 3]> = input.positions.iter().map(|&p| bits(p)).collect();
    let mut along: Vec<DVec3> = input.positions.clone();
    along.sort_by(|a, b| a.x.total_cmp(&b.x));
    for &p in mesh.positions() {
        if exact.contains(&bits(p)) {
            continue;
        }
        let first = along.partition_point(|q| q.x < p.x - near);
        let beside = along[first..].iter().take_while(|q| q.x <= p.x + near);
        if let Some(q) = beside.into_iter().find(|q| q.distance(p) <= near) {
            return Err(format!("vertex {q} of the input has moved to {p}"));
        }
    }
    Ok(())
}

/// Every triangle names the triangle it is a part of: in its plane, and the very same triangle if nothing meets that. (A
/// flat neighbour does not count as meeting it, but may have a corner on its edge, at which it is cut; and when rounding
/// has made new intersections, what met nothing before may be cut too.)
fn sources(input: &TriangleSoup, mesh: &TriMesh, report: &Report) -> Result<(), String> {
    if report.sources.len() != mesh.triangles().len() {
        return Err(format!("{} sources", report.sources.len()));
    }
    let view = MeshView::from(input);
    let span = Aabb::of_points(&input.positions).diagonal();
    let pairs = self_intersections(view, &()).map_err(|error| error.to_string())?;
    let met: HashSet<TriangleId> = pairs.iter().flat_map(|&(a, b)| [a, b]).collect();
    let defects = validate(view);
    let is_flat = |defect: &Defect| matches!(defect, Defect::ZeroArea { .. });
    let none_is_flat = !defects.iter().any(is_flat);
    for (triangle, &source) in mesh.triangle_ids().zip(&report.sources) {
        let corners = mesh.corners(triangle);
        let [a, b, c] = view
            .corners(source)
            .ok_or_else(|| format!("no triangle {source:?} in the input"))?;
        let normal = (b - a).cross(c - a);
        // Rounded coordinates tell nothing of the plane of a sliver.
        if normal.length() < 1e-6 * span * span {
            continue;
        }
        let normal = normal.normalize();
        let off = corners.iter().map(|p| normal.dot(p - a).abs());
        let off = off.fold(0.0, f64::max);
        if off > 1e-9 * span {
            return Err(format!("{triangle:?} is {off:e} off its source {source:?}"));
        }
        if none_is_flat && report.repeats == 0 && !met.contains(&source) {
            let turned = [[a, b, c], [a, c, b]].map(|t| canonical(t.map(bits)));
            if !turned.contains(&canonical(corners.map(bits))) {
                return Err(format!("{source:?} meets nothing, and is not what it was"));
            }
        }
    }
    Ok(())
}

/// The winding number of the result is 1 where the input's is that of the inside, and 0 elsewhere.
fn windings(input: &TriangleSoup, rule: Rule, mesh: &TriMesh) -> Result<(), String> {
    let points = samples(input);
    let before = winding_numbers(input.into(), &points);
    let after = winding_numbers(mesh.into(), &points);
    for ((p, before), after) in points.iter().zip(before).zip(after) {
        if after != i32::from(is_inside(rule, before)) {
            return Err(format!(
                "at {p} the input winds {before} times, the result {after}"
            ));
        }
    }
    Ok(())
}

/// Points all over the box, and on both sides of some triangles, far enough for rounding not to matter.
pub fn samples(input: &TriangleSoup) -> Vec<DVec3> {
    let bounds = Aabb::of_points(&input.positions);
    let mut random = Random(input.triangles.len() as u64);
    let mut points: Vec<DVec3> = (0..600)
        .map(|_| bounds.min + (1.2 * random.vector() - 0.1) * bounds.extent())
        .collect();
    let view = MeshView::from(input);
    let stride = input.triangles.len().div_ceil(400).max(1);
    let usable = (0..input.triangles.len()).step_by(stride);
    for [a, b, c] in usable.filter_map(|t| view.corners(TriangleId::new(t))) {
        let weights = random.vector() + 0.01;
        let weights = weights / weights.element_sum();
        let p = weights.x * a + weights.y * b + weights.z * c;
        let far = 1e-6 * bounds.diagonal() * (b - a).cross(c - a).normalize_or_zero();
        // A point on a flat triangle may lie on another one.
        if far != DVec3::ZERO {
            points.extend([p + far, p - far]);
        }
    }
    points
}

/// Numbers in [0, 1), the same on every machine.
pub struct Random(pub u64);

impl Random {
    pub fn bits(&mut self) -> u64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        self.0 >> 11
    }

    pub fn unit(&mut self) -> f64 {
        self.bits() as f64 / (1_u64 << 53) as f64
    }

    pub fn vector(&mut self) -> DVec3 {
        DVec3::new(self.unit(), self.unit(), self.unit())
    }

    /// One of 0 to `end` − 1.
    pub fn below(&mut self, end: usize) -> usize {
        (self.unit() * end as f64) as usize
    }

    /// A rotation by a random angle about a random axis.
    pub fn rotation(&mut self) -> glam::DQuat {
        loop {
            let [x, y, z, w] = [(); 4].map(|()| 2.0 * self.unit() - 1.0);
            let q = glam::DQuat::from_xyzw(x, y, z, w);
            if (0.01..1.0).contains(&q.length_squared()) {
                return q.normalize();
            }
        }
    }
}

/// Triangles in another order, corners too, and vertices by other numbers.
pub fn shuffled(input: &TriangleSoup, seed: u64) -> TriangleSoup {
    let mut random = Random(seed);
    let mut order: Vec<usize> = (0..input.positions.len()).collect();
    for i in (1..order.len()).rev() {
        order.swap(i, random.below(i + 1));
    }
    let mut new_of_old = vec![VertexId(0); order.len()];
    for (new, &old) in order.iter().enumerate() {
        new_of_old[old] = VertexId::new(new);
    }
    let mut triangles: Vec<[VertexId; 3]> = input
        .triangles
        .iter()
        .map(|t| t.map(|v| new_of_old[v.index()]))
        .collect();
    for i in (1..triangles.len()).rev() {
        triangles.swap(i, random.below(i + 1));
    }
    for triangle in &mut triangles {
        triangle.rotate_left(random.below(3));
    }
    TriangleSoup {
        positions: order.iter().map(|&old| input.positions[old]).collect(),
        triangles,
    }
}

pub fn mapped(input: &TriangleSoup, map: impl Fn(DVec3) -> DVec3) -> TriangleSoup {
    TriangleSoup {
        positions: input.positions.iter().map(|&p| map(p)).collect(),
        triangles: input.triangles.clone(),
    }
}

pub fn joined(parts: impl IntoIterator<Item = TriangleSoup>) -> TriangleSoup {
    let mut all = TriangleSoup::default();
    for part in parts {
        let offset = all.positions.len() as u32;
        all.positions.extend(part.positions);
        let moved = part
            .triangles
            .iter()
            .map(|t| t.map(|v| VertexId(v.0 + offset)));
        all.triangles.extend(moved);
    }
    all
}

pub fn inverted(mut soup: TriangleSoup) -> TriangleSoup {
    soup.triangles.iter_mut().for_each(|t| t.swap(1, 2));
    soup
}

/// A box, outward, 12 triangles.
pub fn cuboid(min: DVec3, max: DVec3) -> TriangleSoup {
    pellicle_mesh::cuboid(min, max).unwrap().into_soup()
}

/// A tetrahedron of these corners; inside out if they are negatively oriented.
pub fn tetrahedron(corners: [DVec3; 4]) -> TriangleSoup {
    TriangleSoup {
        positions: corners.to_vec(),
        triangles: [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]
            .map(|t| t.map(VertexId))
            .to_vec(),
    }
}

/// Components, and their genera summed.
pub fn topology(mesh: &TriMesh) -> (usize, usize) {
    let summary = summarize(mesh.into()).expect("finite");
    let genus = summary.genus().expect("a surface");
    (summary.components.len(), genus)
}

/// Both zeros are one.
pub fn bits(p: DVec3) -> [u64; 3] {
    p.to_array().map(|c| (c + 0.0).to_bits())
}

fn canonical<T: Ord + Copy>(mut triangle: [T; 3]) -> [T; 3] {
    let least = (0..3).min_by_key(|&i| triangle[i]).unwrap_or(0);
    triangle.rotate_left(least);
    triangle
}

/// The triangles by their coordinates, in an order of their own.
pub fn as_set(mesh: &TriMesh) -> Vec<[[u64; 3]; 3]> {
    let corners = mesh.triangle_ids().map(|t| mesh.corners(t).map(bits));
    let mut set: Vec<_> = corners.map(canonical).collect();
    set.sort_unstable();
    set
}

pub fn same_bits<'a>(a: impl Into<MeshView<'a>>, b: impl Into<MeshView<'a>>) -> bool {
    let (a, b) = (a.into(), b.into());
    let exact = |view: MeshView| -> Vec<[u64; 3]> {
        let positions = view.positions.iter();
        positions.map(|p| p.to_array().map(f64::to_bits)).collect()
    };
    a.triangles == b.triangles && exact(a) == exact(b)
}

/// A small input as it can be pasted into a test; of a large one its size.
fn pasted(input: &TriangleSoup) -> String {
    if input.triangles.len() > 60 {
        return format!("{} triangles", input.triangles.len());
    }
    let positions: Vec<[f64; 3]> = input.positions.iter().map(|p| p.to_array()).collect();
    let triangles: Vec<[u32; 3]> = input.triangles.iter().map(|t| t.map(|v| v.0)).collect();
    format!("let positions = {positions:?};\nlet triangles = {triangles:?};")
}
