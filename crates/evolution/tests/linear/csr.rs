use crate::support::{Surface, dense, random_positions, random_vector};
use glam::DVec3;
use nalgebra::DVector;
use pellicle_evolution::linear::{CsrMatrix, CsrPattern, LinearError};
use pellicle_geometry::VertexId;
use pellicle_mesh::{TriMesh, TriangleSoup};
use std::sync::Arc;

fn ring(rows: usize) -> CsrPattern {
    CsrPattern::from_neighbors(rows, |row| [(row + 1) % rows, (row + rows - 1) % rows]).unwrap()
}

#[test]
fn rows_are_sorted_and_hold_the_diagonal() {
    let pattern = ring(5);
    assert_eq!((pattern.rows(), pattern.entries()), (5, 15));
    for row in 0..5 {
        let columns = &pattern.columns()[pattern.row(row)];
        assert!(columns.is_sorted_by(|a, b| a < b));
        assert_eq!(
            pattern.entry(row, row),
            Some(pattern.diagonal()[row] as usize)
        );
        for column in 0..5 {
            let expected = [0, 1, 4].contains(&((5 + row - column) % 5));
            let entry = pattern.entry(row, column);
            assert_eq!(entry.is_some(), expected);
            assert!(entry.is_none_or(|e| pattern.columns()[e] as usize == column));
        }
    }
    assert_eq!(pattern.entry(5, 0), None);
    assert_eq!(pattern.entry(0, 5), None);
    assert_eq!(pattern.entry(0, (1 << 32) + 1), None, "no wrapping");
}

#[test]
fn repeated_neighbors_and_the_row_itself_count_once() {
    let pattern = CsrPattern::from_neighbors(2, |_| [1, 0, 1, 0]).unwrap();
    assert_eq!(pattern.columns(), [0, 1, 0, 1]);
}

#[test]
fn a_neighbor_outside_is_named() {
    let pattern = CsrPattern::from_neighbors(2, |row| [row + 1]);
    assert_eq!(pattern, Err(LinearError::NoEntry { row: 1, column: 2 }));
}

#[test]
fn an_empty_matrix_multiplies_nothing() {
    let pattern = CsrPattern::from_neighbors(0, |_| []).unwrap();
    let matrix = CsrMatrix::zeros(Arc::new(pattern));
    matrix.multiply::<f64>(&[], &mut []).unwrap();
}

#[test]
fn the_pattern_of_a_mesh_is_its_adjacency() {
    let surface = Surface::icosphere(1);
    let triangles = surface.triangles.iter();
    let soup = TriangleSoup {
        positions: surface.positions.clone(),
        triangles: triangles.map(|t| t.map(VertexId::new)).collect(),
    };
    let mesh = TriMesh::try_from(soup).unwrap();
    assert_eq!(CsrPattern::of_mesh(&mesh).unwrap(), *surface.pattern());
}

#[test]
fn products_are_those_of_the_dense_matrix() {
    let matrix = Surface::icosphere(2)
        .distorted(0.05, DVec3::new(3.0, 1.0, 1.0), 7)
        .implicit_step(0.3, 1);
    let rows = matrix.rows();
    let vector = random_vector(2, rows);
    let expected = dense(&matrix) * DVector::from_column_slice(&vector);
    let mut product = vec![f64::NAN; rows];
    matrix.multiply(&vector, &mut product).unwrap();
    for (a, b) in product.iter().zip(expected.iter()) {
        assert!((a - b).abs() <= 1e-13 * matrix.values().iter().fold(1.0, |m, v| v.abs().max(m)));
    }
    // Three columns at once are three single columns.
    let positions = random_positions(3, rows);
    let mut products = vec![DVec3::NAN; rows];
    matrix.multiply(&positions, &mut products).unwrap();
    for axis in 0..3 {
        let single: Vec<f64> = positions.iter().map(|p| p[axis]).collect();
        matrix.multiply(&single, &mut product).unwrap();
        assert!(products.iter().zip(&product).all(|(p, &x)| p[axis] == x));
    }
}

#[test]
fn lengths_are_checked() {
    let matrix = CsrMatrix::zeros(Arc::new(ring(5)));
    let wrong = |found| Err(LinearError::WrongLength { expected: 5, found });
    assert_eq!(matrix.multiply(&[0.0; 4], &mut [0.0; 5]), wrong(4));
    assert_eq!(matrix.multiply(&[0.0; 5], &mut [0.0; 6]), wrong(6));
    let values = CsrMatrix::new(Arc::new(ring(5)), vec![0.0; 14]);
    assert!(matches!(
        values,
        Err(LinearError::WrongLength {
            expected: 15,
            found: 14
        })
    ));
}

#[test]
fn a_value_outside_the_pattern_is_refused() {
    let mut matrix = CsrMatrix::zeros(Arc::new(ring(5)));
    let refused = matrix.add(0, 2, 1.0);
    assert_eq!(refused, Err(LinearError::NoEntry { row: 0, column: 2 }));
    assert_eq!(matrix.get(0, 2), 0.0);
}

#[test]
fn a_pinned_stiffness_loses_a_row_and_a_column() {
    let stiffness = Surface::icosphere(1)
        .distorted(0.1, DVec3::new(2.0, 1.0, 1.0), 3)
        .stiffness();
    let mut pinned = stiffness.clone();
    pinned.pin(7).unwrap();
    for row in 0..stiffness.rows() {
        for column in 0..stiffness.rows() {
            let drops = row != column && (row == 7 || column == 7);
            let expected = if drops {
                0.0
            } else {
                stiffness.get(row, column)
            };
            assert_eq!(pinned.get(row, column), expected);
        }
    }
    let largest = stiffness
        .values()
        .iter()
        .fold(0.0_f64, |m, v| v.abs().max(m));
    let mut image = vec![f64::NAN; 42];
    stiffness.multiply(&[1.0; 42], &mut image).unwrap();
    assert!(
        image.iter().all(|v| v.abs() < 1e-14 * largest),
        "constants are the kernel"
    );
    assert!(dense(&pinned).cholesky().is_some(), "positive definite");
    assert_eq!(
        pinned.pin(42),
        Err(LinearError::NoEntry {
            row: 42,
            column: 42
        })
    );
}

#[test]
fn a_pin_needs_a_symmetric_pattern_and_makes_the_diagonal_positive() {
    let pattern = CsrPattern::from_neighbors(2, |row| (row == 0).then_some(1)).unwrap();
    let mut matrix = CsrMatrix::zeros(Arc::new(pattern));
    assert_eq!(
        matrix.pin(0),
        Err(LinearError::NoEntry { row: 1, column: 0 })
    );
    matrix.pin(1).unwrap();
    assert_eq!(matrix.get(1, 1), 1.0);
}
