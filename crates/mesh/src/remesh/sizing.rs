//! How long edges should be at each vertex.

use super::{CurvatureLength, Kind};
use crate::MeshView;
use crate::edit::MeshEditor;
use pellicle_geometry::triangle::double_area_normal;
use pellicle_geometry::{DVec3, VertexId};

/// Sweeps of [`grade`]: far more than any surface needs.
const SWEEPS: usize = 1000;

/// For each vertex the length L = √(6ε/κ − 3ε²) of the sides of an equilateral triangle whose middle lies ε from a
/// surface of curvature κ (Dunyach et al. 2013, section 3), κ the greatest in magnitude; between the bounds, and
/// graded. Linear time but for the grading.
pub(super) fn curvature_lengths(
    editor: &MeshEditor,
    kinds: &[Kind],
    wanted: &CurvatureLength,
) -> Vec<f64> {
    let mut curvatures = surface_curvatures(editor.view(), kinds);
    for (v, curvature) in curvatures.iter_mut().enumerate() {
        if matches!(kinds[v], Kind::Border | Kind::Crease) {
            *curvature = curvature.max(curve_curvature(editor, VertexId::new(v)));
        }
    }
    let tolerance = wanted.tolerance;
    let mut lengths: Vec<f64> = curvatures
        .iter()
        .map(|&curvature| {
            let square = 6.0 * tolerance / curvature - 3.0 * tolerance * tolerance;
            // Infinite where the surface is flat, negative where it bends more than the tolerance can follow.
            square.max(0.0).sqrt().clamp(wanted.min, wanted.max)
        })
        .collect();
    grade(editor.view(), wanted.gradation, &mut lengths);
    lengths
}

/// For each vertex the greatest principal curvature in magnitude, of the second fundamental form that fits best how
/// the normals turn along the edges; zero on creases and borders, whose vertices have no one normal.
///
/// With an edge d from v and the turn of the normals δ along it, both in the tangent plane of v, the form is the
/// symmetric S that minimises Σ |S d − δ|² / |d|² (after Rusinkiewicz 2004, who fits it in triangles).
fn surface_curvatures(mesh: MeshView, kinds: &[Kind]) -> Vec<f64> {
    let mut normals = vec![DVec3::ZERO; mesh.positions.len()];
    for t in mesh.triangles {
        let [a, b, c] = t.map(|v| mesh.positions[v.index()]);
        let normal = double_area_normal(a, b, c);
        t.iter().for_each(|v| normals[v.index()] += normal);
    }
    for normal in &mut normals {
        *normal = normal.normalize_or_zero();
    }
    let mut fits = vec![Fit::default(); mesh.positions.len()];
    for t in mesh.triangles {
        for (v, w) in [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])] {
            let (v, w) = (v.index(), w.index());
            if kinds[v] != Kind::Free || kinds[w] != Kind::Free {
                continue;
            }
            let (edge, turn) = (
                mesh.positions[w] - mesh.positions[v],
                normals[w] - normals[v],
            );
            fits[v].add(normals[v], edge, turn);
            fits[w].add(normals[w], -edge, -turn);
        }
    }
    fits.iter().map(Fit::curvature).collect()
}

/// The sums of a least-squares fit of S = (e f; f g).
#[derive(Clone, Copy, Default)]
struct Fit {
    /// Σ x², Σ xy, Σ y² of unit directions.
    moments: [f64; 3],
    /// Σ of what e, f and g are multiplied by, times the turn.
    right: [f64; 3],
}

impl Fit {
    fn add(&mut self, normal: DVec3, edge: DVec3, turn: DVec3) {
        if normal == DVec3::ZERO {
            return;
        }
        let (u, w) = normal.any_orthonormal_pair();
        let length = edge.length();
        if length <= 0.0 {
            return;
        }
        let (x, y) = (edge.dot(u) / length, edge.dot(w) / length);
        let (p, q) = (turn.dot(u) / length, turn.dot(w) / length);
        for (sum, term) in self.moments.iter_mut().zip([x * x, x * y, y * y]) {
            *sum += term;
        }
        for (sum, term) in self.right.iter_mut().zip([x * p, y * p + x * q, y * q]) {
            *sum += term;
        }
    }

    /// The greatest eigenvalue in magnitude.
    ///
    /// The normal equations of Σ (e x + f y − p)² + (f x + g y − q)² are
    /// ```text
    /// │ xx   xy      0  │ │ e │   │ xp      │
    /// │ xy  xx + yy  xy │ │ f │ = │ yp + xq │
    /// │ 0    xy      yy │ │ g │   │ yq      │
    /// ```
    fn curvature(&self) -> f64 {
        let [xx, xy, yy] = self.moments;
        let [r, s, t] = self.right;
        let determinant = (xx + yy) * (xx * yy - xy * xy);
        // Directions along one line only, or none.
        if determinant <= 1e-9 * (xx + yy).powi(3) {
            return 0.0;
        }
        let f = (xx * yy * s - xy * (yy * r + xx * t)) / determinant;
        let (e, g) = ((r - xy * f) / xx, (t - xy * f) / yy);
        let (mean, half) = ((e + g) / 2.0, ((e - g) / 2.0).hypot(f));
        let greatest = mean.abs() + half;
        if greatest.is_finite() { greatest } else { 0.0 }
    }
}

/// The curvature of a border or crease at one of its vertices: the change of direction over the mean length of its
/// two edges.
fn curve_curvature(editor: &MeshEditor, v: VertexId) -> f64 {
    match super::curve_neighbors(editor, v) {
        Some([a, b]) => {
            let (before, after) = (editor.at(v) - editor.at(a), editor.at(b) - editor.at(v));
            let mean = 0.5 * (before.length() + after.length());
            let turn = before
                .normalize_or_zero()
                .distance(after.normalize_or_zero());
            if mean > 0.0 { turn / mean } else { 0.0 }
        }
        None => 0.0,
    }
}

/// Lowers lengths until none exceeds a neighbour's by more than `gradation` times their distance.
pub(super) fn grade(mesh: MeshView, gradation: f64, lengths: &mut [f64]) {
    let relax = |t: &[VertexId; 3], lengths: &mut [f64]| {
        let mut changed = false;
        for (v, w) in [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])] {
            let (v, w) = (v.index(), w.index());
            let slack = gradation * mesh.positions[v].distance(mesh.positions[w]);
            let (at_v, at_w) = (lengths[v], lengths[w]);
            lengths[v] = at_v.min(at_w + slack);
            lengths[w] = at_w.min(at_v + slack);
            changed |= lengths[v] < at_v || lengths[w] < at_w;
        }
        changed
    };
    // Forward and backward in turn: what one order carries one triangle on, the other carries far.
    for _ in 0..SWEEPS {
        let mut changed = false;
        for t in mesh.triangles {
            changed |= relax(t, lengths);
        }
        for t in mesh.triangles.iter().rev() {
            changed |= relax(t, lengths);
        }
        if !changed {
            break;
        }
    }
}
