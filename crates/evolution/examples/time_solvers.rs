//! Times every solver on the systems of a surface in motion: `cargo run --release -p pellicle-evolution --example
//! time_solvers -- 6` for 40 962 vertices (4: 2562, 5: 10 242). One thread: set `RAYON_NUM_THREADS=1`. A second argument
//! picks the solvers whose name contains it, to count instructions.

use glam::DVec3;
use pellicle_evolution::linear::{
    Convergence, CsrMatrix, CsrPattern, IterativeOptions, LinearError, LinearSolver,
    Preconditioning, Solver,
};
use pellicle_geometry::VertexId;
use pellicle_mesh::{TriMesh, icosphere};
use std::sync::Arc;
use std::time::Instant;

/// Time steps of which the fastest and the mean are told.
const STEPS: usize = 12;

/// Radius of the sphere in voxels, and the paper's w_d·τ in voxels.
const RADIUS: f64 = 100.0;
const DIFFUSION: f64 = 0.1;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let levels = std::env::args()
        .nth(1)
        .map_or(Ok(4), |level| level.parse())?;
    let wanted = std::env::args().nth(2).unwrap_or_default();
    let is_wanted = |name: &str| name.contains(&wanted);
    let mesh = icosphere(levels)?;
    let pattern = Arc::new(CsrPattern::of_mesh(&mesh)?);
    let steps: Vec<_> = (0..STEPS)
        .map(|step| System::new(&mesh, &pattern, step))
        .collect();
    println!("{} vertices, {} entries", pattern.rows(), pattern.entries());
    println!("ψ, symmetric: relative residual 1e-10");
    let kinds = [Preconditioning::Jacobi, Preconditioning::Ilu0];
    let iterative = kinds.map(|kind| [Solver::BiCgStab(kind), Solver::ConjugateGradient(kind)]);
    let direct = [Solver::Cholesky, Solver::LaggedCholesky];
    for method in iterative.into_iter().flatten().chain(direct) {
        if !is_wanted(&format!("psi {method:?}")) {
            continue;
        }
        time(method, &steps, |system| (&system.stiffness, &system.source))?;
    }
    println!("positions, three right-hand sides");
    for kind in [
        Preconditioning::None,
        Preconditioning::Jacobi,
        Preconditioning::Ilu0,
    ] {
        let method = Solver::BiCgStab(kind);
        if !is_wanted(&format!("positions {method:?}")) {
            continue;
        }
        time(method, &steps, |system| {
            (&system.implicit, &system.positions)
        })?;
    }
    Ok(())
}

/// Runs the steps one after the other, each from the solution of the one before.
fn time<'a, V>(
    method: Solver,
    steps: &'a [System],
    system: impl Fn(&'a System) -> (&'a CsrMatrix, &'a Vec<V>),
) -> Result<(), LinearError>
where
    V: pellicle_evolution::linear::Columns,
{
    let mut solver = LinearSolver::new(method, IterativeOptions::default());
    let mut solution = vec![V::ZERO; system(&steps[0]).1.len()];
    let (mut seconds, mut iterations) = (Vec::new(), Vec::new());
    for step in steps {
        let (matrix, right) = system(step);
        let start = Instant::now();
        let Convergence {
            iterations: done, ..
        } = solver.solve(matrix, right, &mut solution)?;
        seconds.push(start.elapsed().as_secs_f64());
        iterations.push(done);
    }
    let first = seconds.remove(0);
    let least = seconds.iter().copied().fold(f64::INFINITY, f64::min);
    let mean = seconds.iter().sum::<f64>() / seconds.len() as f64;
    println!(
        "  {:<28} first {:8.2} ms, later {:8.2} ms, at least {:8.2} ms; iterations {iterations:?}",
        format!("{method:?}"),
        1e3 * first,
        1e3 * mean,
        1e3 * least,
    );
    Ok(())
}

/// What a time step solves.
struct System {
    stiffness: CsrMatrix,
    source: Vec<f64>,
    implicit: CsrMatrix,
    positions: Vec<DVec3>,
}

impl System {
    /// An uneven ellipsoid that turns into another, by a twentieth to a third of an edge a step.
    fn new(mesh: &TriMesh, pattern: &Arc<CsrPattern>, step: usize) -> Self {
        let edge = (16.0 / mesh.positions().len() as f64).sqrt();
        let time = 0.1 * edge * step as f64;
        let positions: Vec<DVec3> = mesh
            .positions()
            .iter()
            .enumerate()
            .map(|(i, &p)| {
                let noise =
                    DVec3::from_array([0, 1, 2].map(|axis| 0.2 * edge * random(3 * i + axis)));
                let wave = DVec3::new((5.0 * p.y).sin(), (4.0 * p.z).sin(), (6.0 * p.x).cos());
                (p + noise + wave * time) * DVec3::new(1.4, 1.0, 0.7) * RADIUS
            })
            .collect();
        let mut stiffness = CsrMatrix::zeros(Arc::clone(pattern));
        let mut areas = vec![0.0; positions.len()];
        for triangle in mesh.triangles() {
            let corners = triangle.map(VertexId::index);
            assemble(corners, &positions, &mut stiffness, &mut areas);
        }
        let mut implicit = stiffness.clone();
        for (row, &area) in areas.iter().enumerate() {
            let distance = 10.0 * (1.0 + (3.0 * mesh.positions()[row].z).sin());
            for value in &mut implicit.values_mut()[pattern.row(row)] {
                *value *= DIFFUSION * distance;
            }
            implicit.values_mut()[pattern.diagonal()[row] as usize] += area;
        }
        stiffness.pin(0).expect("symmetric");
        let mut source: Vec<f64> = mesh
            .positions()
            .iter()
            .map(|p| p.x * p.y + 0.3 * p.z)
            .collect();
        let mean =
            source.iter().zip(&areas).map(|(s, a)| s * a).sum::<f64>() / areas.iter().sum::<f64>();
        for (source, area) in source.iter_mut().zip(&areas) {
            *source = (*source - mean) * area;
        }
        source[0] = 0.0;
        let positions = positions
            .iter()
            .zip(areas)
            .map(|(&p, area)| p * area)
            .collect();
        Self {
            stiffness,
            source,
            implicit,
            positions,
        }
    }
}

/// Half the cotangents of a triangle, and a third of its area.
fn assemble(
    corners: [usize; 3],
    positions: &[DVec3],
    stiffness: &mut CsrMatrix,
    areas: &mut [f64],
) {
    for i in 0..3 {
        let [a, b, c] = [0, 1, 2].map(|k| corners[(i + k) % 3]);
        let (u, v) = (positions[a] - positions[c], positions[b] - positions[c]);
        let double_area = u.cross(v).length();
        areas[c] += double_area / 6.0;
        for (p, q) in [(a, b), (b, a)] {
            let weight = 0.5 * u.dot(v) / double_area;
            stiffness.add(p, q, -weight).expect("an edge");
            stiffness.add(p, p, weight).expect("a vertex");
        }
    }
}

/// A number in [−1, 1).
fn random(counter: usize) -> f64 {
    let mut z = (counter as u64 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    (z >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
}
