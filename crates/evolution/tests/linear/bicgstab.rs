use crate::support::*;
use glam::DVec3;
use nalgebra::DMatrix;
use pellicle_evolution::linear::{
    Convergence, CsrMatrix, IterativeOptions, Jacobi, LinearError, NoPreconditioner, NotConverged,
    Workspace, bicgstab,
};
use proptest::prelude::*;

fn options(tolerance: f64) -> IterativeOptions {
    IterativeOptions {
        tolerance,
        ..Default::default()
    }
}

fn solve(matrix: &CsrMatrix, right: &[f64], tolerance: f64) -> Result<Vec<f64>, LinearError> {
    let mut solution = vec![0.0; right.len()];
    let jacobi = &mut Jacobi::new(matrix);
    let workspace = &mut Workspace::default();
    let convergence = bicgstab(
        matrix,
        right,
        &mut solution,
        jacobi,
        &options(tolerance),
        workspace,
    )?;
    let residual = relative_residual(matrix, &solution, right);
    assert!(
        residual <= 1.01 * tolerance + 1e-15,
        "true residual {residual}"
    );
    assert!((convergence.residual - residual).abs() <= 1e-15 + 1e-2 * residual);
    Ok(solution)
}

fn not_converged(result: Result<impl std::fmt::Debug, LinearError>) -> NotConverged {
    match result {
        Err(LinearError::NotConverged(error)) => error,
        other => panic!("{other:?}"),
    }
}

fn check_against_dense(matrix: &CsrMatrix, seed: u64) {
    let right = random_vector(seed, matrix.rows());
    let solution = solve(matrix, &right, 1e-10).unwrap();
    let expected = dense_solution(matrix, &right);
    let inverse = dense(matrix).try_inverse().unwrap();
    let condition = inverse.norm() * dense(matrix).norm();
    let difference = relative_difference(&solution, &expected);
    // The error is at most the condition times the residual.
    assert!(
        difference <= 1.01e-10 * condition,
        "{difference} at condition {condition}"
    );
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(128))]

    #[test]
    fn dominant_matrices(matrix in dominant(40), seed in 0..1000_u64) {
        check_against_dense(&sparse(&matrix), seed);
    }

    #[test]
    fn m_matrices(matrix in m_matrix(40), seed in 0..1000_u64) {
        check_against_dense(&sparse(&matrix), seed);
    }

    #[test]
    fn implicit_steps(surface in distorted_icosphere(), step in 0.0..10.0, seed in 0..1000_u64) {
        check_against_dense(&surface.implicit_step(step, seed), seed);
    }
}

#[test]
fn pinned_stiffness() {
    for (level, seed) in [(0, 1), (1, 2), (2, 3)] {
        let stretch = DVec3::new(4.0, 1.0, 1.0);
        let mut matrix = Surface::icosphere(level)
            .distorted(0.05, stretch, seed)
            .stiffness();
        assert!(matrix.values().iter().any(|&v| v > 0.0) && matrix.pin(3).is_ok());
        check_against_dense(&matrix, seed);
    }
}

#[test]
fn the_identity_takes_one_iteration() {
    let matrix = sparse(&DMatrix::identity(10, 10));
    let right = random_vector(1, 10);
    let mut solution = vec![0.0; 10];
    let workspace = &mut Workspace::default();
    let options = IterativeOptions::default();
    let convergence = bicgstab(
        &matrix,
        &right,
        &mut solution,
        &mut NoPreconditioner,
        &options,
        workspace,
    );
    assert_eq!(solution, right);
    assert_eq!(
        convergence,
        Ok(Convergence {
            iterations: 1,
            residual: 0.0
        })
    );
}

#[test]
fn one_unknown() {
    for (value, right) in [(2.0, 3.0), (-4.0, 1.0), (1e-160, 1.0), (1e150, -1e-120)] {
        let matrix = sparse(&DMatrix::from_element(1, 1, value));
        let solution = solve(&matrix, &[right], 1e-14).unwrap();
        assert!((solution[0] / (right / value) - 1.0).abs() < 1e-14);
    }
}

#[test]
fn no_unknowns() {
    assert_eq!(
        solve(&sparse(&DMatrix::zeros(0, 0)), &[], 1e-10),
        Ok(vec![])
    );
}

#[test]
fn a_zero_right_side_gives_zero_from_any_guess() {
    let matrix = Surface::icosphere(1).implicit_step(1.0, 1);
    let mut solution = random_vector(1, 42);
    let workspace = &mut Workspace::default();
    let jacobi = &mut Jacobi::new(&matrix);
    let options = IterativeOptions::default();
    let convergence = bicgstab(
        &matrix,
        &[0.0; 42],
        &mut solution,
        jacobi,
        &options,
        workspace,
    );
    assert_eq!(convergence, Ok(Convergence::default()));
    assert_eq!(solution, [0.0; 42]);
}

#[test]
fn an_exact_guess_takes_no_iteration_and_a_near_one_fewer() {
    let matrix = Surface::icosphere(3).implicit_step(1.0, 1);
    let right = random_vector(1, 642);
    let (jacobi, workspace) = (&mut Jacobi::new(&matrix), &mut Workspace::default());
    let mut solution = vec![0.0; 642];
    let options = options(1e-9);
    let mut run = |solution: &mut [f64]| {
        bicgstab(&matrix, &right, solution, jacobi, &options, workspace).unwrap()
    };
    let cold = run(&mut solution).iterations;
    let exact = solution.clone();
    assert_eq!(run(&mut solution).iterations, 0);
    assert_eq!(solution, exact);
    for (row, value) in solution.iter_mut().enumerate() {
        *value += 1e-5 * random(4, row as u64);
    }
    let warm = run(&mut solution).iterations;
    assert!(0 < warm && warm < cold, "{warm} of {cold}");
    assert!(relative_difference(&solution, &exact) < 1e-6);
}

#[test]
fn three_columns_are_three_single_columns_to_the_bit() {
    let matrix = Surface::icosphere(3)
        .distorted(0.02, DVec3::new(3.0, 1.0, 1.0), 5)
        .implicit_step(0.5, 1);
    let rows = matrix.rows();
    let mut right = random_positions(1, rows);
    // Columns that converge at different times, and one that is zero.
    for (row, value) in right.iter_mut().enumerate() {
        value.x = matrix.get(row, 17) * 1e-200;
        value.z = 0.0;
    }
    let (jacobi, options) = (&mut Jacobi::new(&matrix), IterativeOptions::default());
    let mut solution = random_positions(2, rows);
    solution.iter_mut().for_each(|value| value.x *= 1e-200);
    let guess = solution.clone();
    let together = bicgstab(
        &matrix,
        &right,
        &mut solution,
        jacobi,
        &options,
        &mut Workspace::default(),
    );
    let mut most = 0;
    for axis in 0..3 {
        let right: Vec<f64> = right.iter().map(|p| p[axis]).collect();
        let mut single: Vec<f64> = guess.iter().map(|p| p[axis]).collect();
        let alone = bicgstab(
            &matrix,
            &right,
            &mut single,
            jacobi,
            &options,
            &mut Workspace::default(),
        );
        most = most.max(alone.unwrap().iterations);
        assert!(
            solution.iter().zip(&single).all(|(p, &x)| p[axis] == x),
            "axis {axis}"
        );
    }
    assert_eq!(together.unwrap().iterations, most);
}

#[test]
fn a_workspace_serves_systems_of_any_size() {
    let mut workspace = Workspace::default();
    for level in [2, 0, 1, 2] {
        let matrix = Surface::icosphere(level).implicit_step(1.0, 1);
        let right = random_vector(1, matrix.rows());
        let mut solution = vec![0.0; right.len()];
        let (jacobi, options) = (&mut Jacobi::new(&matrix), IterativeOptions::default());
        bicgstab(
            &matrix,
            &right,
            &mut solution,
            jacobi,
            &options,
            &mut workspace,
        )
        .unwrap();
        assert!(relative_residual(&matrix, &solution, &right) < 1.01e-10);
    }
}

#[test]
fn tiny_and_huge_right_sides_are_solved_alike() {
    let matrix = Surface::icosphere(1).implicit_step(1.0, 1);
    let right = random_vector(1, 42);
    let solution = solve(&matrix, &right, 1e-12).unwrap();
    for exponent in [-1000, -600, 600, 1000] {
        let factor = 2.0_f64.powi(exponent);
        let scaled: Vec<f64> = right.iter().map(|b| b * factor).collect();
        let mut other = vec![0.0; 42];
        let (jacobi, workspace) = (&mut Jacobi::new(&matrix), &mut Workspace::default());
        bicgstab(
            &matrix,
            &scaled,
            &mut other,
            jacobi,
            &options(1e-12),
            workspace,
        )
        .unwrap();
        let equal = solution.iter().zip(&other).all(|(a, b)| a * factor == *b);
        assert!(equal, "2^{exponent}");
    }
}

// Breakdown. Without its treatment each of these divides by zero or stands still.

/// r̂·v = 0 and t·s = 0 in the first iteration.
#[test]
fn skew_matrices_break_the_process_down() {
    let skew = DMatrix::from_row_slice(2, 2, &[0.0, 1.0, -1.0, 0.0]);
    let solution = solve(&sparse(&skew), &[3.0, 5.0], 1e-12).unwrap();
    assert!(relative_difference(&solution, &[-5.0, 3.0]) < 1e-11);
    for rows in [4, 8, 20] {
        let random = DMatrix::from_fn(rows, rows, |i, j| {
            random(rows as u64, (i * rows + j) as u64)
        });
        let skew = &random - random.transpose();
        let right = random_vector(3, rows);
        let solution = solve(&sparse(&skew), &right, 1e-11).unwrap();
        let expected = dense_solution(&sparse(&skew), &right);
        assert!(relative_difference(&solution, &expected) < 1e-8);
    }
}

/// A permutation in one cycle: every step of a short recurrence is orthogonal to the one before.
#[test]
fn cyclic_shifts_break_the_process_down() {
    for rows in [2, 3, 5, 8] {
        let shift = DMatrix::from_fn(rows, rows, |i, j| f64::from((i + 1) % rows == j));
        let mut right = vec![0.0; rows];
        right[0] = 1.0;
        let solution = solve(&sparse(&shift), &right, 1e-12).unwrap();
        let mut expected = vec![0.0; rows];
        expected[1 % rows] = 1.0;
        assert!(relative_difference(&solution, &expected) < 1e-11);
    }
}

#[test]
fn a_breakdown_in_one_column_leaves_the_others_alone() {
    // Blocks: a rotation, which breaks down, and the identity, which does not.
    let mut matrix = DMatrix::identity(4, 4) * 2.0;
    matrix
        .view_mut((0, 0), (2, 2))
        .copy_from_slice(&[0.0, -1.0, 1.0, 0.0]);
    let matrix = sparse(&matrix);
    let right = [
        DVec3::new(1.0, 0.0, 0.0),
        DVec3::new(2.0, 0.0, 0.0),
        DVec3::Y,
        DVec3::Z,
    ];
    let mut solution = [DVec3::ZERO; 4];
    let (options, workspace) = (options(1e-12), &mut Workspace::default());
    bicgstab(
        &matrix,
        &right,
        &mut solution,
        &mut NoPreconditioner,
        &options,
        workspace,
    )
    .unwrap();
    let expected = [
        DVec3::new(-2.0, 0.0, 0.0),
        DVec3::X,
        DVec3::Y / 2.0,
        DVec3::Z / 2.0,
    ];
    for (a, b) in solution.iter().zip(expected) {
        assert!((*a - b).length() < 1e-11, "{a} {b}");
    }
}

// What has no solution is reported.

#[test]
fn a_singular_matrix_does_not_converge() {
    let stiffness = Surface::icosphere(2).stiffness();
    let error = not_converged(solve(&stiffness, &vec![1.0; 162], 1e-10));
    assert!(error.residual > 0.5, "{error}");
    for matrix in [DMatrix::zeros(3, 3), DMatrix::from_element(3, 3, 1.0)] {
        let error = not_converged(solve(&sparse(&matrix), &[1.0, 2.0, 3.0], 1e-10));
        assert!(error.residual > 0.1 && error.iterations <= 2000, "{error}");
    }
}

#[test]
fn a_singular_matrix_with_a_consistent_right_side_may_be_solved() {
    let stiffness = Surface::icosphere(2).stiffness();
    let mut right = vec![0.0; 162];
    stiffness
        .multiply(&random_vector(1, 162), &mut right)
        .unwrap();
    solve(&stiffness, &right, 1e-9).unwrap();
}

#[test]
fn the_limit_of_iterations_holds() {
    let mut matrix = Surface::icosphere(3).stiffness();
    matrix.pin(0).unwrap();
    let mut right = random_vector(1, 642);
    right[0] = 0.0;
    for limit in [0, 1, 5] {
        let options = IterativeOptions {
            tolerance: 1e-10,
            max_iterations: limit,
        };
        let mut solution = vec![0.0; 642];
        let (jacobi, workspace) = (&mut Jacobi::new(&matrix), &mut Workspace::default());
        let result = bicgstab(&matrix, &right, &mut solution, jacobi, &options, workspace);
        let error = not_converged(result);
        assert_eq!(error.iterations, limit);
        let residual = relative_residual(&matrix, &solution, &right);
        assert!(
            (error.residual / residual - 1.0).abs() < 1e-9,
            "{error} {residual}"
        );
    }
}

#[test]
fn a_tolerance_below_rounding_is_reported_not_pursued() {
    let mut matrix = Surface::icosphere(2).stiffness();
    matrix.pin(0).unwrap();
    let mut right = random_vector(1, 162);
    right[0] = 0.0;
    for tolerance in [1e-25, 0.0, -1.0, f64::NAN] {
        let error = not_converged(solve(&matrix, &right, tolerance));
        assert!(error.residual < 1e-12, "{error}");
        assert!(error.iterations < 2000, "{error}");
    }
}

#[test]
fn what_is_not_finite_ends_at_once() {
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let matrix = Surface::icosphere(1).implicit_step(1.0, 1);
        let right = random_vector(1, 42);
        let mut bad_matrix = matrix.clone();
        bad_matrix.values_mut()[5] = bad;
        let mut bad_right = right.clone();
        bad_right[41] = bad;
        let mut bad_guess = vec![0.0; 42];
        bad_guess[7] = bad;
        let zero = vec![0.0; 42];
        for (matrix, right, mut guess) in [
            (&bad_matrix, &right, zero.clone()),
            (&matrix, &bad_right, zero),
            (&matrix, &right, bad_guess),
        ] {
            let (jacobi, options) = (&mut Jacobi::new(matrix), IterativeOptions::default());
            let workspace = &mut Workspace::default();
            let error = not_converged(bicgstab(
                matrix, right, &mut guess, jacobi, &options, workspace,
            ));
            assert!(
                !error.residual.is_finite() && error.iterations <= 1,
                "{error}"
            );
        }
    }
}

#[test]
fn lengths_are_checked() {
    let matrix = sparse(&DMatrix::identity(3, 3));
    let (options, workspace) = (IterativeOptions::default(), &mut Workspace::default());
    let mut run = |right: &[f64], solution: &mut [f64]| {
        bicgstab(
            &matrix,
            right,
            solution,
            &mut NoPreconditioner,
            &options,
            workspace,
        )
    };
    let wrong = |found| Err(LinearError::WrongLength { expected: 3, found });
    assert_eq!(run(&[1.0; 2], &mut [0.0; 3]), wrong(2));
    assert_eq!(run(&[1.0; 3], &mut [0.0; 4]), wrong(4));
}
