use crate::support::*;
use glam::DVec3;
use nalgebra::DMatrix;
use pellicle_evolution::linear::{
    Convergence, CsrMatrix, IterativeOptions, Jacobi, LinearError, NoPreconditioner, NotConverged,
    Workspace, conjugate_gradient,
};
use proptest::prelude::*;

fn solve(matrix: &CsrMatrix, right: &[f64]) -> Result<(Vec<f64>, Convergence), LinearError> {
    let mut solution = vec![0.0; right.len()];
    let (options, workspace) = (IterativeOptions::default(), &mut Workspace::default());
    let jacobi = &mut Jacobi::new(matrix);
    let convergence =
        conjugate_gradient(matrix, right, &mut solution, jacobi, &options, workspace)?;
    let residual = relative_residual(matrix, &solution, right);
    assert!(residual <= 1.01e-10 && (convergence.residual - residual).abs() < 1e-12);
    Ok((solution, convergence))
}

fn not_converged(result: Result<impl std::fmt::Debug, LinearError>) -> NotConverged {
    match result {
        Err(LinearError::NotConverged(error)) => error,
        other => panic!("{other:?}"),
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(128))]

    #[test]
    fn positive_definite_matrices(matrix in positive_definite(40), seed in 0..1000_u64) {
        let matrix = sparse(&matrix);
        let right = random_vector(seed, matrix.rows());
        let (solution, _) = solve(&matrix, &right).unwrap();
        let difference = relative_difference(&solution, &dense_solution(&matrix, &right));
        prop_assert!(difference <= 1.01e-10 * condition(&matrix));
    }
}

/// In exact arithmetic there are as many iterations as distinct eigenvalues.
#[test]
fn two_eigenvalues_take_two_iterations() {
    let matrix = DMatrix::from_fn(30, 30, |i, j| if i == j { 5.0 } else { 1.0 });
    let (options, workspace) = (IterativeOptions::default(), &mut Workspace::default());
    let (right, mut solution) = (random_vector(1, 30), vec![0.0; 30]);
    let (matrix, none) = (sparse(&matrix), &mut NoPreconditioner);
    let convergence = conjugate_gradient(&matrix, &right, &mut solution, none, &options, workspace);
    assert_eq!(convergence.unwrap().iterations, 2);
}

#[test]
fn a_stiffness_without_a_pin_serves_if_the_right_side_is_balanced() {
    let surface = Surface::icosphere(3).distorted(0.02, DVec3::new(2.0, 1.0, 1.0), 1);
    let stiffness = surface.stiffness();
    let right = balanced(1, 642);
    let (solution, free) = solve(&stiffness, &right).unwrap();
    let mut pinned = stiffness.clone();
    pinned.pin(0).unwrap();
    let mut grounded = right.clone();
    grounded[0] = 0.0;
    let (other, fixed) = solve(&pinned, &grounded).unwrap();
    let size = solution.iter().fold(0.0_f64, |m, v| v.abs().max(m));
    for (a, b) in solution.iter().zip(&other) {
        assert!((a - solution[0] - b).abs() < 1e-7 * size);
    }
    assert!(free.iterations < fixed.iterations);
}

#[test]
fn what_is_not_positive_definite_does_not_converge() {
    let indefinite = sparse(&DMatrix::from_row_slice(2, 2, &[1.0, 2.0, 2.0, 1.0]));
    let error = not_converged(solve(&indefinite, &[1.0, -1.0]));
    assert!(
        error.residual.is_finite() && error.iterations <= 2,
        "{error}"
    );
    let skew = sparse(&DMatrix::from_row_slice(2, 2, &[0.0, 1.0, -1.0, 0.0]));
    assert_eq!(not_converged(solve(&skew, &[1.0, 1.0])).iterations, 1);
    let stiffness = Surface::icosphere(2).stiffness();
    let error = not_converged(solve(&stiffness, &[1.0; 162]));
    assert!(error.residual > 0.5, "{error}");
}

#[test]
fn what_is_not_finite_ends_at_once() {
    let mut matrix = Surface::icosphere(1).stiffness();
    matrix.pin(0).unwrap();
    let right = random_vector(1, 42);
    for bad in [f64::NAN, f64::INFINITY] {
        let mut bad_matrix = matrix.clone();
        bad_matrix.values_mut()[50] = bad;
        let error = not_converged(solve(&bad_matrix, &right));
        assert!(
            !error.residual.is_finite() && error.iterations <= 1,
            "{error}"
        );
        let mut bad_right = right.clone();
        bad_right[3] = bad;
        let error = not_converged(solve(&matrix, &bad_right));
        assert!(
            !error.residual.is_finite() && error.iterations == 0,
            "{error}"
        );
    }
}

#[test]
fn the_limit_of_iterations_holds() {
    let mut matrix = Surface::icosphere(2).stiffness();
    matrix.pin(0).unwrap();
    let right = random_vector(1, 162);
    for max_iterations in [0, 1, 5] {
        let options = IterativeOptions {
            max_iterations,
            ..Default::default()
        };
        let mut solution = vec![0.0; 162];
        let (jacobi, workspace) = (&mut Jacobi::new(&matrix), &mut Workspace::default());
        let result =
            conjugate_gradient(&matrix, &right, &mut solution, jacobi, &options, workspace);
        let error = not_converged(result);
        assert_eq!(error.iterations, max_iterations);
        let residual = relative_residual(&matrix, &solution, &right);
        assert!((error.residual / residual - 1.0).abs() < 1e-9);
    }
}

#[test]
fn three_columns_are_three_single_columns_to_the_bit() {
    let mut matrix = Surface::icosphere(2).stiffness();
    matrix.pin(0).unwrap();
    let mut right = random_positions(1, 162);
    right.iter_mut().enumerate().for_each(|(row, b)| {
        b.x = matrix.get(row, 17) * 1e-200;
        b.z = 0.0;
    });
    let options = IterativeOptions::default();
    let jacobi = &mut Jacobi::new(&matrix);
    let mut solution = vec![DVec3::ZERO; 162];
    let workspace = &mut Workspace::default();
    conjugate_gradient(&matrix, &right, &mut solution, jacobi, &options, workspace).unwrap();
    for axis in 0..3 {
        let right: Vec<f64> = right.iter().map(|p| p[axis]).collect();
        let (mut alone, workspace) = (vec![0.0; 162], &mut Workspace::default());
        conjugate_gradient(&matrix, &right, &mut alone, jacobi, &options, workspace).unwrap();
        assert!(
            solution.iter().zip(&alone).all(|(p, &x)| p[axis] == x),
            "axis {axis}"
        );
    }
}
