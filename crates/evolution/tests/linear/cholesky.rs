use crate::support::*;
use glam::DVec3;
use nalgebra::DMatrix;
use pellicle_evolution::linear::{Cholesky, CsrMatrix, CsrPattern, LinearError};
use proptest::prelude::*;
use std::sync::Arc;

fn check(matrix: &CsrMatrix, seed: u64) {
    let rows = matrix.rows();
    let right = random_vector(seed, rows);
    let mut solution = vec![f64::NAN; rows];
    let cholesky = Cholesky::new(matrix).unwrap();
    cholesky.solve(&right, &mut solution).unwrap();
    let expected = dense_solution(matrix, &right);
    let difference = relative_difference(&solution, &expected);
    // Higham 2002, theorem 10.4: a backward error of (3n + 1) u; twice that, u being half of EPSILON, leaves the other
    // half to the two inverses of a pivot's root and to the dense solution.
    let bound = condition(matrix) * (3 * rows + 4) as f64 * f64::EPSILON;
    assert!(difference <= bound, "{difference} > {bound}");
    let positions = random_positions(seed, rows);
    let mut solutions = vec![DVec3::NAN; rows];
    cholesky.solve(&positions, &mut solutions).unwrap();
    for axis in 0..3 {
        let right: Vec<f64> = positions.iter().map(|p| p[axis]).collect();
        cholesky.solve(&right, &mut solution).unwrap();
        assert!(solutions.iter().zip(&solution).all(|(p, &x)| p[axis] == x));
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(128))]

    #[test]
    fn dominant_matrices(matrix in positive_definite(120), seed in 0..1000_u64) {
        check(&sparse(&matrix), seed);
    }

    #[test]
    fn pinned_stiffness(surface in distorted_icosphere(), seed in 0..1000_u64) {
        let mut matrix = surface.stiffness();
        matrix.pin(seed as usize % matrix.rows()).unwrap();
        check(&matrix, seed);
    }

    /// Trees and forests: a matrix without fill, in any order of its rows.
    #[test]
    fn forests(rows in 1..300_usize, seed in 0..1000_u64) {
        let mut matrix = DMatrix::identity(rows, rows);
        for row in 1..rows {
            let up = (random(seed, row as u64).abs() * row as f64) as usize;
            let weight = random(seed + 1, row as u64);
            if weight.abs() > 0.1 {
                matrix[(row, up)] = -weight;
                matrix[(up, row)] = -weight;
                matrix[(row, row)] += weight.abs();
                matrix[(up, up)] += weight.abs();
            }
        }
        check(&sparse(&matrix), seed);
    }
}

/// One panel would be wider than the widest.
#[test]
fn a_full_matrix() {
    for rows in [31, 32, 33, 64, 65, 150] {
        let root = DMatrix::from_fn(rows, rows, |i, j| random(7, (i * rows + j) as u64));
        check(
            &sparse(&(&root * root.transpose() + DMatrix::identity(rows, rows))),
            1,
        );
    }
}

#[test]
fn a_band() {
    for width in [1, 2, 9] {
        let matrix = DMatrix::from_fn(200, 200, |i, j| match i.abs_diff(j) {
            0 => 2.0 * width as f64 + 0.01,
            distance if distance <= width => -1.0,
            _ => 0.0,
        });
        check(&sparse(&matrix), 1);
    }
}

#[test]
fn no_unknowns_and_one() {
    check(&sparse(&DMatrix::from_element(1, 1, 4.0)), 1);
    let empty = Cholesky::new(&sparse(&DMatrix::zeros(0, 0))).unwrap();
    assert_eq!(empty.solve::<f64>(&[], &mut []), Ok(()));
}

#[test]
fn dissection_keeps_the_factor_sparse() {
    for level in [3, 4, 5] {
        let mut matrix = Surface::icosphere(level).stiffness();
        matrix.pin(0).unwrap();
        let rows = matrix.rows() as f64;
        let cholesky = Cholesky::new(&matrix).unwrap();
        assert!((cholesky.entries() as f64) < 5.0 * rows * rows.log2());
    }
}

/// Graphs that cannot be halved: a hub with leaves, and rows without a neighbour. Quadratic time would show.
#[test]
fn stars_and_isolated_rows() {
    let rows = 60_000;
    let hub = rows / 2;
    let pattern = CsrPattern::from_neighbors(rows, |row| match row {
        _ if row == hub => 0..hub,
        _ if row < hub => hub..hub + 1,
        _ => 0..0,
    });
    let mut matrix = CsrMatrix::zeros(Arc::new(pattern.unwrap()));
    for row in 0..rows {
        matrix
            .add(row, row, if row == hub { rows as f64 } else { 2.0 })
            .unwrap();
        if row < hub {
            matrix.add(row, hub, -1.0).unwrap();
            matrix.add(hub, row, -1.0).unwrap();
        }
    }
    let right = random_vector(1, rows);
    let mut solution = vec![f64::NAN; rows];
    let cholesky = Cholesky::new(&matrix).unwrap();
    assert!(cholesky.entries() < 20 * rows);
    cholesky.solve(&right, &mut solution).unwrap();
    assert!(relative_residual(&matrix, &solution, &right) < 1e-12);
}

#[test]
fn a_refreshed_factor_is_a_new_one() {
    let surface = Surface::icosphere(3);
    let pinned = |surface: Surface| {
        let mut matrix = surface.stiffness();
        matrix.pin(100).unwrap();
        matrix
    };
    let first = pinned(surface.clone());
    let second = pinned(surface.distorted(0.02, DVec3::new(2.0, 1.0, 1.0), 3));
    let right = random_vector(1, 642);
    let mut cholesky = Cholesky::new(&first).unwrap();
    for matrix in [&second, &first] {
        cholesky.refresh(matrix).unwrap();
        let (mut refreshed, mut new) = (vec![0.0; 642], vec![0.0; 642]);
        cholesky.solve(&right, &mut refreshed).unwrap();
        Cholesky::new(matrix)
            .unwrap()
            .solve(&right, &mut new)
            .unwrap();
        assert_eq!(refreshed, new);
    }
}

#[test]
fn a_matrix_that_is_not_positive_definite_names_a_row() {
    let mut diagonal = DMatrix::identity(50, 50);
    for bad in [-1.0, 0.0, f64::NAN, f64::INFINITY] {
        diagonal[(20, 20)] = bad;
        let factor = Cholesky::new(&sparse(&diagonal)).map(|_| ());
        assert_eq!(factor, Err(LinearError::NotPositiveDefinite { row: 20 }));
    }
    // The stiffness of an edge without a pin.
    let singular = DMatrix::from_row_slice(2, 2, &[1.0, -1.0, -1.0, 1.0]);
    let factor = Cholesky::new(&sparse(&singular)).map(|_| ());
    assert!(matches!(
        factor,
        Err(LinearError::NotPositiveDefinite { .. })
    ));
    // And after a sound one.
    let mut cholesky = Cholesky::new(&sparse(&DMatrix::identity(50, 50))).unwrap();
    diagonal[(20, 20)] = -1.0;
    let refreshed = cholesky.refresh(&sparse(&diagonal));
    assert_eq!(refreshed, Err(LinearError::NotPositiveDefinite { row: 20 }));
}

#[test]
fn a_pattern_must_be_symmetric_and_the_one_analysed() {
    let lopsided = CsrPattern::from_neighbors(2, |row| (row == 0).then_some(1)).unwrap();
    let factor = Cholesky::new(&CsrMatrix::zeros(Arc::new(lopsided))).map(|_| ());
    assert_eq!(factor, Err(LinearError::NoEntry { row: 1, column: 0 }));
    let mut cholesky = Cholesky::new(&sparse(&DMatrix::identity(3, 3))).unwrap();
    let refreshed = cholesky.refresh(&sparse(&DMatrix::identity(4, 4)));
    assert_eq!(refreshed, Err(LinearError::WrongPattern));
    let wrong = cholesky.solve(&[1.0; 4], &mut [0.0; 3]);
    assert_eq!(
        wrong,
        Err(LinearError::WrongLength {
            expected: 3,
            found: 4
        })
    );
}
