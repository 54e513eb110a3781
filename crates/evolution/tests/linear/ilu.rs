use crate::support::*;
use glam::DVec3;
use nalgebra::{DMatrix, DVector};
use pellicle_evolution::linear::{
    CsrMatrix, Ilu0, IterativeOptions, LinearError, LinearSolver, Preconditioner, Preconditioning,
    Solver, Workspace, conjugate_gradient,
};
use proptest::prelude::*;

/// The operator that a preconditioner approximates, by its action on unit vectors.
fn operator(preconditioner: &mut impl Preconditioner, rows: usize) -> DMatrix<f64> {
    let mut inverse = DMatrix::zeros(rows, rows);
    for column in 0..rows {
        let mut unit = vec![0.0; rows];
        unit[column] = 1.0;
        let mut image = vec![f64::NAN; rows];
        preconditioner.apply(&unit, &mut image);
        inverse.set_column(column, &DVector::from_vec(image));
    }
    inverse.try_inverse().expect("factors are not singular")
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// What defines ILU(0): L U = A wherever A has an entry.
    #[test]
    fn the_product_of_the_factors_is_exact_on_the_pattern(matrix in m_matrix(30)) {
        let matrix = sparse(&matrix);
        let product = operator(&mut Ilu0::new(&matrix), matrix.rows());
        let pattern = matrix.pattern();
        for row in 0..matrix.rows() {
            for entry in pattern.row(row) {
                let (value, column) = (matrix.values()[entry], pattern.columns()[entry] as usize);
                let difference = (product[(row, column)] - value).abs();
                prop_assert!(difference <= 1e-9 * matrix.get(row, row).abs(), "{difference}");
            }
        }
    }

    #[test]
    fn a_full_pattern_makes_it_a_factorisation(matrix in dominant(20), seed in 0..1000_u64) {
        let full = sparse(&matrix.map(|value| if value == 0.0 { 1e-3 } else { value }));
        let right = random_vector(seed, full.rows());
        let mut solution = vec![f64::NAN; full.rows()];
        Ilu0::new(&full).apply(&right, &mut solution);
        let expected = dense_solution(&full, &right);
        prop_assert!(relative_difference(&solution, &expected) <= 1e-13 * condition(&full));
    }

    /// Also with obtuse angles, whose weights are negative.
    #[test]
    fn of_a_stiffness_it_is_symmetric_and_positive_definite(
        surface in distorted_icosphere(),
        seed in 0..1000_u64,
    ) {
        let mut matrix = surface.stiffness();
        matrix.pin(0).unwrap();
        let product = operator(&mut Ilu0::new(&matrix), matrix.rows());
        let asymmetry = (&product - product.transpose()).norm() / product.norm();
        prop_assert!(asymmetry < 1e-9, "{asymmetry}");
        let symmetric = (&product + product.transpose()) * 0.5;
        prop_assert!(symmetric.cholesky().is_some());
        let right = random_vector(seed, matrix.rows());
        let (options, workspace) = (IterativeOptions::default(), &mut Workspace::default());
        let mut solution = vec![0.0; matrix.rows()];
        let ilu = &mut Ilu0::new(&matrix);
        conjugate_gradient(&matrix, &right, &mut solution, ilu, &options, workspace).unwrap();
        prop_assert!(relative_residual(&matrix, &solution, &right) < 1.01e-10);
    }
}

/// A tridiagonal matrix fills nothing: ILU(0) is LU.
#[test]
fn without_fill_it_is_exact() {
    let matrix = sparse(&DMatrix::from_fn(40, 40, |i, j| {
        match i as i32 - j as i32 {
            0 => 3.0,
            1 => -1.5,
            -1 => -0.5 - 0.01 * i as f64,
            _ => 0.0,
        }
    }));
    let right = random_positions(1, 40);
    let mut solution = vec![DVec3::NAN; 40];
    Ilu0::new(&matrix).apply(&right, &mut solution);
    for axis in 0..3 {
        let right: Vec<f64> = right.iter().map(|p| p[axis]).collect();
        let solution: Vec<f64> = solution.iter().map(|p| p[axis]).collect();
        assert!(relative_difference(&solution, &dense_solution(&matrix, &right)) < 1e-14);
    }
}

#[test]
fn it_takes_fewer_iterations_than_the_diagonal() {
    let surface = Surface::icosphere(3).distorted(0.02, DVec3::new(2.0, 1.0, 1.0), 1);
    let mut stiffness = surface.stiffness();
    stiffness.pin(0).unwrap();
    let step = surface.implicit_step(0.2, 1);
    let right = random_vector(2, 642);
    let iterations = |method: Solver, matrix: &CsrMatrix| {
        let mut solver = LinearSolver::new(method, IterativeOptions::default());
        let convergence = solver.solve(matrix, &right, &mut vec![0.0; 642]);
        convergence.unwrap().iterations
    };
    for (method, matrix) in [
        (Solver::ConjugateGradient as fn(_) -> _, &stiffness),
        (Solver::BiCgStab, &stiffness),
        (Solver::BiCgStab, &step),
    ] {
        let jacobi = iterations(method(Preconditioning::Jacobi), matrix);
        let ilu = iterations(method(Preconditioning::Ilu0), matrix);
        assert!(
            3 * ilu <= 2 * jacobi,
            "{ilu} with ILU(0), {jacobi} with Jacobi"
        );
    }
}

#[test]
fn a_refreshed_one_is_a_new_one() {
    let surface = Surface::icosphere(2);
    let (first, second) = (surface.implicit_step(1.0, 1), surface.implicit_step(2.0, 2));
    let mut ilu = Ilu0::new(&first);
    ilu.refresh(&second).unwrap();
    let vector = random_vector(1, 162);
    let (mut refreshed, mut new) = (vec![0.0; 162], vec![0.0; 162]);
    ilu.apply(&vector, &mut refreshed);
    Ilu0::new(&second).apply(&vector, &mut new);
    assert_eq!(refreshed, new);
    let other = sparse(&DMatrix::identity(162, 162));
    assert_eq!(ilu.refresh(&other), Err(LinearError::WrongPattern));
}

#[test]
fn pivots_that_vanish_are_replaced() {
    for rows in [
        vec![0.0, 1.0, 1.0, 0.0],
        vec![1.0, 1.0, 1.0, 1.0],
        vec![1.0, 2.0, 2.0, 1.0],
        vec![0.0, 0.0, 0.0, 0.0],
        vec![1e-320, 1.0, 1.0, 1.0],
    ] {
        let matrix = sparse(&DMatrix::from_row_slice(2, 2, &rows));
        let mut image = [f64::NAN; 2];
        Ilu0::new(&matrix).apply(&[1.0, 2.0], &mut image);
        assert!(image.iter().all(|value| value.is_finite()), "{rows:?}");
    }
}

/// The example of Kershaw 1978: positive definite, but the last pivot of its incomplete factors is −5.
#[test]
fn a_pivot_that_turns_negative_is_replaced() {
    let values = [3, -2, 0, 2, -2, 3, -2, 0, 0, -2, 3, -2, 2, 0, -2, 3].map(f64::from);
    let matrix = DMatrix::from_row_slice(4, 4, &values);
    assert!(matrix.clone().cholesky().is_some());
    let matrix = sparse(&matrix);
    let product = operator(&mut Ilu0::new(&matrix), 4);
    assert!((&product - product.transpose()).norm() < 1e-12);
    assert!(product.cholesky().is_some());
    let (options, workspace) = (IterativeOptions::default(), &mut Workspace::default());
    let (right, mut solution) = ([1.0, 2.0, -3.0, 0.5], [0.0; 4]);
    let ilu = &mut Ilu0::new(&matrix);
    conjugate_gradient(&matrix, &right, &mut solution, ilu, &options, workspace).unwrap();
    assert!(relative_residual(&matrix, &solution, &right) < 1.01e-10);
}
