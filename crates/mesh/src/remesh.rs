//! New triangles for the same surface: of even size, well shaped.

mod change;
mod creases;
mod geometry;
mod options;
mod polish;
mod reference;
mod relax;
mod sizing;

pub use options::{
    CurvatureLength, ImproveOptions, Projection, RemeshOptions, RemeshReport, TargetLength,
};

use crate::edit::MeshEditor;
use crate::frame::Frame;
use crate::{AngleBounds, HalfEdgeId, MeshError, TriMesh, quality};
use pellicle_geometry::{Cancelled, DVec3, Progress, VertexId, triangle};
use reference::{Curves, Surface};

/// How often vertices are relaxed in each round.
const RELAXATIONS: u32 = 2;
/// A side of an equilateral triangle of area one, squared.
const SIDE_SQUARED: f64 = 2.309_401_076_758_503;

/// Triangles of even size and good shape for the same surface (Botsch and Kobbelt 2004).
///
/// Each round
/// 1. splits edges longer than 4/3 of the wanted length L, the longest first,
/// 2. collapses edges shorter than 4/5 L, the shortest first,
/// 3. flips edges towards six neighbours a vertex, four on a border,
/// 4. moves vertices within the tangent plane towards the middle of their triangles,
/// 5. and projects them back onto the surface.
///
/// Last, triangles with angles below 30° or above 120° are mended one by one, as far as the geometry allows.
///
/// Topology stays: components, genus, borders. Borders, and creases sharper than an angle, stay as curves: their
/// vertices move along them only, and corners stay. No move and no collapse turns a triangle by more than 60°, and
/// nothing folds the surface across an edge unless it was folded. The same mesh and options give the same result on any
/// number of threads.
///
/// About O(n log n) a round in the larger of input and result.
///
/// ```
/// use pellicle_mesh::{RemeshOptions, TargetLength, icosphere, remesh};
/// // An ellipsoid with triangles stretched five to one.
/// let mut mesh = icosphere(3)?;
/// let stretched = mesh.positions().iter().map(|p| p.with_z(5.0 * p.z)).collect();
/// mesh.set_positions(stretched)?;
/// let options = RemeshOptions { target: TargetLength::Absolute(0.3), ..RemeshOptions::default() };
/// let (result, report) = remesh(&mesh, &options, &())?;
/// let quality = report.after.unwrap();
/// assert!(quality.min_angle.to_degrees() > 30.0 && quality.max_angle.to_degrees() < 120.0);
/// assert!(result.is_closed());
/// # Ok::<(), pellicle_mesh::MeshError>(())
/// ```
///
/// # Errors
/// [`MeshError::InvalidOption`]; [`MeshError::TooLarge`] if the wanted length asks for more triangles than ids can
/// name; [`MeshError::Cancelled`].
pub fn remesh(
    mesh: &TriMesh,
    options: &RemeshOptions,
    progress: &dyn Progress,
) -> Result<(TriMesh, RemeshReport), MeshError> {
    const STAGE: &str = "remesh";
    options.check()?;
    let before = quality(mesh.into(), &AngleBounds::default());
    let Some(mut state) = State::new(mesh, options)? else {
        let report = RemeshReport::unchanged(before);
        return Ok((mesh.clone(), report));
    };
    let total = 4 * u64::from(options.iterations) + 2;
    let step = |done: u64| Cancelled::check(progress.step(STAGE, done, total));
    step(0)?;
    state.drop_needles();
    state.mark_creases(options);
    state.keep_reference(options);
    state.check_size()?;
    for round in 0..u64::from(options.iterations) {
        step(4 * round + 1)?;
        if round > 0 && state.surface.is_none() {
            state.measure_lengths(options);
        }
        state.split_long()?;
        step(4 * round + 2)?;
        state.collapse_short();
        state.compact();
        step(4 * round + 3)?;
        state.equalize_valences();
        step(4 * round + 4)?;
        for _ in 0..RELAXATIONS {
            state.relax();
        }
    }
    step(total - 1)?;
    state.polish(polish::Freedom::All);
    step(total)?;
    let (mesh, mut report) = state.finish()?;
    report.before = before;
    report.after = quality((&mesh).into(), &AngleBounds::default());
    Ok((mesh, report))
}

/// Better angles by flips and moves alone: vertices keep their ids, and their number.
///
/// Flips edges towards larger least angles where that does not fold or bend the surface, relaxes vertices within their
/// tangent planes, and mends the triangles with angles below 30° or above 120° one by one. What [`remesh`] promises
/// of topology, borders, creases, folds and determinism holds here too. About O(n) a round.
///
/// ```
/// use pellicle_mesh::{ImproveOptions, icosphere, improve};
/// let mut mesh = icosphere(2)?;
/// let flattened = mesh.positions().iter().map(|p| p.with_z(p.z / 2.0)).collect();
/// mesh.set_positions(flattened)?;
/// let (better, report) = improve(&mesh, &ImproveOptions::default(), &())?;
/// assert_eq!(better.positions().len(), 162);
/// assert!(report.after.unwrap().min_angle > report.before.unwrap().min_angle);
/// # Ok::<(), pellicle_mesh::MeshError>(())
/// ```
///
/// # Errors
/// [`MeshError::InvalidOption`], [`MeshError::Cancelled`].
pub fn improve(
    mesh: &TriMesh,
    options: &ImproveOptions,
    progress: &dyn Progress,
) -> Result<(TriMesh, RemeshReport), MeshError> {
    const STAGE: &str = "improve";
    let options = options.as_remesh();
    options.check()?;
    let before = quality(mesh.into(), &AngleBounds::default());
    let Some(mut state) = State::new(mesh, &options)? else {
        return Ok((mesh.clone(), RemeshReport::unchanged(before)));
    };
    let total = u64::from(options.iterations) + 1;
    let step = |done: u64| Cancelled::check(progress.step(STAGE, done, total));
    state.mark_creases(&options);
    state.keep_reference(&options);
    for round in 0..options.iterations {
        step(u64::from(round))?;
        state.enlarge_angles();
        state.relax();
    }
    state.enlarge_angles();
    step(total - 1)?;
    state.polish(polish::Freedom::KeepVertices);
    step(total)?;
    let (mesh, mut report) = state.finish()?;
    report.before = before;
    report.after = quality((&mesh).into(), &AngleBounds::default());
    Ok((mesh, report))
}

/// What a vertex may do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    /// Anything within the surface.
    Free,
    /// Move along a crease.
    Crease,
    /// Move along a border.
    Border,
    /// Nothing.
    Corner,
}

/// The mesh under work, in units in which it is about of size one.
struct State {
    editor: MeshEditor,
    /// For each vertex what it may do, and how long its edges should be.
    kinds: Vec<Kind>,
    lengths: Vec<f64>,
    /// What free vertices are projected onto; none if they are not.
    surface: Option<Surface>,
    curves: Curves,
    /// The length of a unit, a power of two.
    scale: f64,
    report: RemeshReport,
}

impl State {
    /// `None` if there is nothing to remesh: no triangle, or no extent.
    fn new(mesh: &TriMesh, options: &RemeshOptions) -> Result<Option<Self>, MeshError> {
        let scale = Frame::of(mesh.positions()).scale;
        let scaled: Vec<DVec3> = mesh.positions().iter().map(|&p| p / scale).collect();
        let mut mesh = mesh.clone();
        // Far from the origin and minute, it overflows; remeshing would be meaningless there.
        if mesh.set_positions(scaled).is_err() {
            return Ok(None);
        }
        let mean = mean_edge(&mesh);
        let length = match &options.target {
            TargetLength::Absolute(length) => length / scale,
            TargetLength::Relative(factor) => factor * mean,
            TargetLength::Curvature(wanted) => wanted.max / scale,
        };
        if !(length > 0.0 && length.is_finite() && mean > 0.0 && mean.is_finite()) {
            return Ok(None);
        }
        let vertices = mesh.positions().len();
        let editor = MeshEditor::new(mesh);
        let kinds = (0..vertices)
            .map(|v| match editor.is_border_vertex(VertexId::new(v)) {
                true => Kind::Corner,
                false => Kind::Free,
            })
            .collect();
        Ok(Some(Self {
            editor,
            kinds,
            lengths: vec![length; vertices],
            surface: None,
            curves: Curves::default(),
            scale,
            report: RemeshReport::default(),
        }))
    }

    /// Measures the lengths wanted, and keeps what is projected onto.
    fn keep_reference(&mut self, options: &RemeshOptions) {
        self.measure_lengths(options);
        self.curves = Curves::of(&self.editor);
        if options.projection == Projection::Surface {
            // Needles are gone by now, and with them normals that mean nothing.
            let (current, _) = self.editor.clone().finish();
            self.surface = Some(Surface::new(&current, self.lengths.clone()));
        }
    }

    fn measure_lengths(&mut self, options: &RemeshOptions) {
        if let TargetLength::Curvature(wanted) = &options.target {
            let wanted = wanted.divided_by(self.scale);
            self.lengths = sizing::curvature_lengths(&self.editor, &self.kinds, &wanted);
        }
    }

    /// An error if the lengths ask for more triangles than ids can name.
    fn check_size(&self) -> Result<(), MeshError> {
        let mut count = 0.0;
        for vertices in &self.editor.triangles {
            let length = vertices.map(|v| self.lengths[v.index()]);
            let least = length[0].min(length[1]).min(length[2]);
            let [a, b, c] = vertices.map(|v| self.editor.at(v));
            let area = triangle::area(a, b, c);
            // The sides count too: a needle has no area, and is split all the same.
            let around = a.distance(b) + b.distance(c) + c.distance(a);
            count += area / (least * least) * SIDE_SQUARED + around / least;
        }
        match count < f64::from(u32::MAX / 3) {
            true => Ok(()),
            false => Err(MeshError::TooLarge {
                vertices: (count / 2.0) as usize,
                triangles: count as usize,
            }),
        }
    }

    fn kind(&self, v: VertexId) -> Kind {
        self.kinds[v.index()]
    }

    fn is_crease(&self, h: HalfEdgeId) -> bool {
        self.editor.creases[h.index()]
    }

    /// Drops removed elements from all arrays.
    fn compact(&mut self) {
        let remap = self.editor.compact();
        self.kinds = remap.apply(&self.kinds);
        self.lengths = remap.apply(&self.lengths);
    }

    fn finish(self) -> Result<(TriMesh, RemeshReport), MeshError> {
        let (mut mesh, _) = self.editor.finish();
        let restored = mesh.positions().iter().map(|&p| p * self.scale).collect();
        mesh.set_positions(restored)?;
        Ok((mesh, self.report))
    }
}

/// The two neighbours of a vertex along creases or borders; `None` unless there are two.
fn curve_neighbors(editor: &MeshEditor, v: VertexId) -> Option<[VertexId; 2]> {
    let mut found = [None; 2];
    let mut count = 0;
    let mut add = |n: VertexId| {
        if let Some(slot) = found.get_mut(count) {
            *slot = Some(n);
        }
        count += 1;
    };
    for h in editor.around(v) {
        if editor.creases[h.index()] {
            add(editor.destination(h));
        }
        let last = h.previous();
        if editor.twin_of(last).is_none() && editor.creases[last.index()] {
            add(editor.origin(last));
        }
    }
    match (count, found) {
        (2, [Some(a), Some(b)]) => Some([a, b]),
        _ => None,
    }
}

fn mean_edge(mesh: &TriMesh) -> f64 {
    let lengths = mesh.edges().map(|h| {
        mesh.position(mesh.origin(h))
            .distance(mesh.position(mesh.destination(h)))
    });
    let (sum, count) = lengths.fold((0.0, 0_usize), |(sum, count), l| (sum + l, count + 1));
    sum / count as f64
}

#[cfg(test)]
mod tests;
