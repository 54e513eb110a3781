//! The two linear systems of a step, assembled on one pattern.
//!
//! K is the cotangent stiffness: K_ij = −½ (cot + cot) along an edge, rows summing to zero; positive semi-definite but
//! for rounding, with the constants of each component as its kernel.

use crate::Error;
use crate::finite_volumes::FiniteVolumes;
use crate::linear::{
    Columns, Convergence, CsrMatrix, CsrPattern, IterativeOptions, LinearError, LinearSolver,
    Preconditioning, Solver,
};
use crate::parallel::fill_slice;
use crate::rings::Rings;
use glam::DVec3;
use std::sync::Arc;

/// The matrices, and what their solvers keep while connectivity stands.
#[derive(Debug)]
pub(crate) struct Systems {
    entries: Vec<Entry>,
    stiffness: CsrMatrix,
    motion: CsrMatrix,
    potential: Option<(SystemSolver, LinearSolver<f64>)>,
    motion_solver: Option<(SystemSolver, LinearSolver<DVec3>)>,
}

/// How a system is solved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SystemSolver {
    /// By what.
    pub method: Solver,
    /// When it stops.
    pub limits: IterativeOptions,
}

impl SystemSolver {
    /// For ψ, symmetric positive definite: by factors that serve for several steps, which measures fastest.
    pub const POTENTIAL: Self = Self {
        method: Solver::LaggedCholesky,
        limits: IterativeOptions {
            tolerance: 1e-8,
            max_iterations: 5000,
        },
    };
    /// For the positions, not symmetric: BiCGStab, as in the paper.
    pub const MOTION: Self = Self {
        method: Solver::BiCgStab(Preconditioning::Jacobi),
        limits: IterativeOptions {
            tolerance: 1e-10,
            max_iterations: 2000,
        },
    };
}

/// Where an entry of the pattern comes from.
#[derive(Clone, Copy, Debug)]
struct Entry {
    row: u32,
    /// Its edge among all of the rings'; none on the diagonal.
    edge: u32,
}

const DIAGONAL: u32 = u32::MAX;

impl Systems {
    pub(crate) fn new(rings: &Rings) -> Result<Self, Error> {
        let pattern = CsrPattern::from_neighbors(rings.vertices(), |i| {
            rings.around(i).iter().map(|edge| edge.neighbor as usize)
        })?;
        let mut entries = vec![
            Entry {
                row: 0,
                edge: DIAGONAL
            };
            pattern.entries()
        ];
        for i in 0..rings.vertices() {
            for entry in pattern.row(i) {
                entries[entry].row = i as u32;
            }
            for (p, edge) in rings.around(i).iter().enumerate() {
                if let Some(entry) = pattern.entry(i, edge.neighbor as usize) {
                    entries[entry].edge = (rings.offset(i) + p) as u32;
                }
            }
        }
        let pattern = Arc::new(pattern);
        Ok(Self {
            entries,
            stiffness: CsrMatrix::zeros(Arc::clone(&pattern)),
            motion: CsrMatrix::zeros(pattern),
            potential: None,
            motion_solver: None,
        })
    }

    /// Solves −Kψ = `right_side`, with ψ = 0 at the first vertex of each component; (4.13). ψ holds a guess at first.
    pub(crate) fn solve_potential(
        &mut self,
        rings: &Rings,
        volumes: &FiniteVolumes,
        right_side: &[f64],
        psi: &mut [f64],
        solver: &SystemSolver,
    ) -> Result<Convergence, Error> {
        assemble(
            self.stiffness.values_mut(),
            &self.entries,
            rings,
            volumes,
            |_| 1.0,
            |_| 0.0,
        );
        let mut negated: Vec<f64> = right_side.iter().map(|value| -value).collect();
        for &pin in &rings.first_vertices {
            let shift = psi[pin as usize];
            self.stiffness.pin(pin as usize)?;
            negated[pin as usize] = 0.0;
            if shift != 0.0 {
                let label = rings.component(pin as usize);
                for (i, value) in psi.iter_mut().enumerate() {
                    if rings.component(i) == label {
                        *value -= shift;
                    }
                }
            }
        }
        let chosen = chosen(&mut self.potential, solver);
        match chosen.solve(&self.stiffness, &negated, psi) {
            // Triangles that have all but collapsed can cost a factor its positive pivots.
            Err(LinearError::NotPositiveDefinite { .. }) => {
                let method = Solver::BiCgStab(Preconditioning::Jacobi);
                let mut other = LinearSolver::new(method, solver.limits);
                Ok(other.solve(&self.stiffness, &negated, psi)?)
            }
            result => Ok(result?),
        }
    }

    /// Solves (diag μ + diag c K) F = `right_side` for the positions F, which hold a guess at first; c_i = τ w_d d_i.
    pub(crate) fn solve_motion(
        &mut self,
        rings: &Rings,
        volumes: &FiniteVolumes,
        diffusion: impl Fn(usize) -> f64 + Sync + Send,
        right_side: &[DVec3],
        positions: &mut [DVec3],
        solver: &SystemSolver,
    ) -> Result<Convergence, Error> {
        let areas = &volumes.areas;
        assemble(
            self.motion.values_mut(),
            &self.entries,
            rings,
            volumes,
            diffusion,
            |i| areas[i],
        );
        let chosen = chosen(&mut self.motion_solver, solver);
        Ok(chosen.solve(&self.motion, right_side, positions)?)
    }
}

/// The solver kept, or a new one if another is asked for.
fn chosen<'a, V: Columns>(
    kept: &'a mut Option<(SystemSolver, LinearSolver<V>)>,
    wanted: &SystemSolver,
) -> &'a mut LinearSolver<V> {
    if kept.as_ref().is_none_or(|(solver, _)| solver != wanted) {
        *kept = None;
    }
    let make = || (*wanted, LinearSolver::new(wanted.method, wanted.limits));
    &mut kept.get_or_insert_with(make).1
}

/// diag(`mass`) + diag(`scale`) K.
fn assemble(
    values: &mut [f64],
    entries: &[Entry],
    rings: &Rings,
    volumes: &FiniteVolumes,
    scale: impl Fn(usize) -> f64 + Sync + Send,
    mass: impl Fn(usize) -> f64 + Sync + Send,
) {
    let weights = &volumes.weights;
    fill_slice(values, |e| {
        let Entry { row, edge } = entries[e];
        let row = row as usize;
        if edge == DIAGONAL {
            let first = rings.offset(row);
            let around = &weights[first..first + rings.around(row).len()];
            mass(row) + scale(row) * around.iter().sum::<f64>()
        } else {
            -scale(row) * weights[edge as usize]
        }
    });
}
