use crate::support::*;
use glam::DVec3;
use pellicle_evolution::linear::{
    Columns, CsrMatrix, IterativeOptions, LinearError, LinearSolver, Preconditioning, Solver,
};

const SYMMETRIC: [Solver; 8] = [
    Solver::BiCgStab(Preconditioning::None),
    Solver::BiCgStab(Preconditioning::Jacobi),
    Solver::BiCgStab(Preconditioning::Ilu0),
    Solver::ConjugateGradient(Preconditioning::None),
    Solver::ConjugateGradient(Preconditioning::Jacobi),
    Solver::ConjugateGradient(Preconditioning::Ilu0),
    Solver::Cholesky,
    Solver::LaggedCholesky,
];

/// ψ with this vertex pinned.
fn psi(method: Solver, stiffness: &CsrMatrix, source: &[f64], pin: usize) -> Vec<f64> {
    let options = IterativeOptions {
        tolerance: 1e-13,
        ..Default::default()
    };
    let (mut matrix, mut source) = (stiffness.clone(), source.to_vec());
    matrix.pin(pin).unwrap();
    source[pin] = 0.0;
    let mut solution = vec![0.0; source.len()];
    let mut solver = LinearSolver::new(method, options);
    solver.solve(&matrix, &source, &mut solution).unwrap();
    assert_eq!(solution[pin], 0.0);
    solution
}

/// The pinned vertex fixes a constant and nothing else; obtuse triangles included.
#[test]
fn another_pin_adds_a_constant() {
    let surface = Surface::icosphere(2).distorted(0.03, DVec3::new(1.5, 1.0, 0.8), 1);
    let stiffness = surface.stiffness();
    let obtuse = (0..162).any(|row| {
        let entries = stiffness.pattern().row(row);
        entries.into_iter().any(|entry| {
            stiffness.pattern().columns()[entry] as usize != row && stiffness.values()[entry] > 0.0
        })
    });
    assert!(obtuse);
    let source = balanced(3, 162);
    for method in SYMMETRIC {
        let first = psi(method, &stiffness, &source, 0);
        let size = first.iter().fold(0.0_f64, |m, v| v.abs().max(m));
        for pin in [1, 77, 161] {
            let other = psi(method, &stiffness, &source, pin);
            for (a, b) in first.iter().zip(&other) {
                assert!(
                    (a - b - first[pin]).abs() < 1e-10 * size,
                    "{method:?}, pin {pin}"
                );
            }
        }
        // The row that was dropped holds too.
        assert!(relative_residual(&stiffness, &first, &source) < 1e-10);
    }
}

#[test]
fn a_missing_pin_is_an_error_or_a_solution_never_nonsense() {
    let surface = Surface::icosphere(2).distorted(0.03, DVec3::new(1.5, 1.0, 0.8), 1);
    let stiffness = surface.stiffness();
    // Not balanced: nothing solves it.
    let source = vec![1.0; 162];
    for method in SYMMETRIC {
        let mut solver = LinearSolver::new(method, IterativeOptions::default());
        let result = solver.solve(&stiffness, &source, &mut vec![0.0; 162]);
        let is_named = matches!(
            result,
            Err(LinearError::NotConverged(_) | LinearError::NotPositiveDefinite { .. })
        );
        assert!(is_named, "{method:?}: {result:?}");
    }
}

/// A surface in motion: each step's solution against a dense one, whatever the steps before.
#[test]
fn steps_that_share_a_pattern_and_steps_that_do_not() {
    for method in SYMMETRIC {
        let mut solver = LinearSolver::new(method, IterativeOptions::default());
        let mut solution = Vec::new();
        // Small moves; then a leap; then another connectivity; then back.
        let stretches = [1.0, 1.01, 1.03, 1.05, 1.08, 4.0, 4.1];
        for (level, stretch) in [1, 2, 1]
            .into_iter()
            .flat_map(|l| stretches.map(|s| (l, s)))
        {
            let shape = DVec3::new(stretch, 1.0, 1.0);
            let surface = Surface::icosphere(level).distorted(0.04, shape, 5);
            let mut matrix = surface.stiffness();
            matrix.pin(3).unwrap();
            let mut source = balanced(2, matrix.rows());
            source[3] = 0.0;
            solution.resize(matrix.rows(), 0.0);
            let convergence = solver.solve(&matrix, &source, &mut solution).unwrap();
            assert!(convergence.residual <= 1e-10);
            let expected = dense_solution(&matrix, &source);
            let difference = relative_difference(&solution, &expected);
            assert!(
                difference <= 1.01e-10 * condition(&matrix),
                "{method:?} {difference}"
            );
        }
    }
}

#[test]
fn a_factor_of_the_step_before_takes_few_iterations_and_is_renewed() {
    let mut solver = LinearSolver::new(Solver::LaggedCholesky, IterativeOptions::default());
    let mut solution = vec![0.0; 642];
    let mut iterations = Vec::new();
    for step in 0..12 {
        let shape = DVec3::new(1.0 + 0.02 * f64::from(step), 1.0, 1.0);
        let mut matrix = Surface::icosphere(3).distorted(0.01, shape, 5).stiffness();
        matrix.pin(3).unwrap();
        let mut source = balanced(2, 642);
        source[3] = 0.0;
        iterations.push(
            solver
                .solve(&matrix, &source, &mut solution)
                .unwrap()
                .iterations,
        );
    }
    // A factor of the matrix itself takes one or, by rounding, two.
    assert!(
        iterations[0] <= 2 && iterations[1] > iterations[0],
        "{iterations:?}"
    );
    assert!(iterations.iter().all(|&i| i <= 14), "{iterations:?}");
    assert!(
        iterations[3..].iter().any(|&i| i <= 2),
        "never renewed: {iterations:?}"
    );
}

#[test]
fn a_factor_is_dropped_after_an_error() {
    for method in [Solver::Cholesky, Solver::LaggedCholesky] {
        let mut solver = LinearSolver::new(method, IterativeOptions::default());
        let mut matrix = Surface::icosphere(1).stiffness();
        matrix.pin(0).unwrap();
        let mut broken = matrix.clone();
        broken.values_mut()[60] = f64::NAN;
        let mut source = balanced(2, 42);
        source[0] = 0.0;
        for _ in 0..2 {
            let mut solution = vec![0.0; 42];
            solver.solve(&matrix, &source, &mut solution).unwrap();
            assert!(relative_residual(&matrix, &solution, &source) < 1.01e-10);
            let failed = solver.solve(&broken, &source, &mut vec![0.0; 42]);
            assert!(failed.is_err(), "{method:?}");
        }
    }
}

/// The bits of a solution, converged or not.
fn bits<V: Columns>(method: Solver, matrix: &CsrMatrix, right: &[V]) -> Vec<u64> {
    let options = IterativeOptions {
        max_iterations: 12,
        ..Default::default()
    };
    let mut solution = vec![V::ZERO; right.len()];
    let result = LinearSolver::new(method, options).solve(matrix, right, &mut solution);
    let iterations = match result {
        Ok(convergence) => convergence.iterations,
        Err(LinearError::NotConverged(error)) => error.iterations,
        Err(other) => panic!("{other}"),
    };
    let values = solution
        .iter()
        .flat_map(|v| (0..V::COUNT).map(|c| v.column(c).to_bits()));
    values.chain([iterations as u64]).collect()
}

/// Large enough to be shared among threads, with chunks that do not come out even.
#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let surface = Surface::icosphere(6).distorted(2e-3, DVec3::new(1.5, 1.0, 0.8), 1);
    let mut stiffness = surface.stiffness();
    stiffness.pin(0).unwrap();
    let mut source = balanced(1, stiffness.rows());
    source[0] = 0.0;
    let step = surface.implicit_step(3.0, 1);
    let run = |threads| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| {
            let mut all: Vec<_> = SYMMETRIC
                .iter()
                .map(|&method| bits(method, &stiffness, &source))
                .collect();
            for kind in [Preconditioning::Jacobi, Preconditioning::Ilu0] {
                all.push(bits(Solver::BiCgStab(kind), &step, &surface.positions));
            }
            all
        })
    };
    let one = run(1);
    for threads in [2, 3, 7] {
        assert!(run(threads) == one, "{threads} threads");
    }
}
