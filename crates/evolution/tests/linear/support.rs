//! Matrices to solve with, and a dense solution to compare with.

use glam::DVec3;
use nalgebra::{DMatrix, DVector};
use pellicle_evolution::linear::{CsrMatrix, CsrPattern};
use proptest::prelude::*;
use std::sync::Arc;

/// A closed triangulated surface.
#[derive(Clone, Debug)]
pub struct Surface {
    pub positions: Vec<DVec3>,
    pub triangles: Vec<[usize; 3]>,
}

impl Surface {
    /// A subdivided icosahedron: 12, 42, 162, 642, 2562, 10 242, 40 962 vertices.
    pub fn icosphere(subdivisions: u32) -> Self {
        let sphere = pellicle_mesh::icosphere(subdivisions).unwrap();
        let triangles = sphere.triangles().iter();
        Self {
            positions: sphere.positions().to_vec(),
            triangles: triangles.map(|t| t.map(|v| v.index())).collect(),
        }
    }

    /// Each vertex moved by up to `amount` in each coordinate, then the whole stretched: obtuse triangles, negative
    /// cotangent weights.
    pub fn distorted(mut self, amount: f64, stretch: DVec3, seed: u64) -> Self {
        for (i, position) in self.positions.iter_mut().enumerate() {
            let noise = DVec3::from_array([0, 1, 2].map(|c| random(seed, 3 * i as u64 + c)));
            *position = (*position + noise * amount) * stretch;
        }
        self
    }

    pub fn pattern(&self) -> Arc<CsrPattern> {
        let mut neighbors = vec![Vec::new(); self.positions.len()];
        for triangle in &self.triangles {
            for i in 0..3 {
                neighbors[triangle[i]].push(triangle[(i + 1) % 3]);
                neighbors[triangle[i]].push(triangle[(i + 2) % 3]);
            }
        }
        let pattern = CsrPattern::from_neighbors(neighbors.len(), |row| neighbors[row].clone());
        Arc::new(pattern.unwrap())
    }

    /// Half the cotangents of the angles opposite each edge: positive semi-definite, its kernel the constants.
    pub fn stiffness(&self) -> CsrMatrix {
        let mut matrix = CsrMatrix::zeros(self.pattern());
        for triangle in &self.triangles {
            for i in 0..3 {
                let [a, b, c] = [0, 1, 2].map(|k| triangle[(i + k) % 3]);
                let (u, v) = (
                    self.positions[a] - self.positions[c],
                    self.positions[b] - self.positions[c],
                );
                let weight = 0.5 * u.dot(v) / u.cross(v).length();
                for (p, q) in [(a, b), (b, a)] {
                    matrix.add(p, q, -weight).unwrap();
                    matrix.add(p, p, weight).unwrap();
                }
            }
        }
        matrix
    }

    /// diag(mass) + D K with D at random between 0 and `step`: not symmetric.
    pub fn implicit_step(&self, step: f64, seed: u64) -> CsrMatrix {
        let mut matrix = self.stiffness();
        let mut mass = vec![0.0; self.positions.len()];
        for triangle in &self.triangles {
            let [a, b, c] = triangle.map(|v| self.positions[v]);
            for v in triangle {
                mass[*v] += (b - a).cross(c - a).length() / 6.0;
            }
        }
        let pattern = Arc::clone(matrix.pattern());
        for (row, mass) in mass.iter().enumerate() {
            let factor = step * (0.5 + 0.5 * random(seed, row as u64));
            for entry in pattern.row(row) {
                matrix.values_mut()[entry] *= factor;
            }
            matrix.values_mut()[pattern.diagonal()[row] as usize] += mass;
        }
        matrix
    }
}

/// A number in [−1, 1) from a seed and a counter.
pub fn random(seed: u64, counter: u64) -> f64 {
    let mut z = (seed << 40)
        .wrapping_add(counter + 1)
        .wrapping_mul(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
}

pub fn random_vector(seed: u64, rows: usize) -> Vec<f64> {
    (0..rows as u64).map(|row| random(seed, row)).collect()
}

pub fn random_positions(seed: u64, rows: usize) -> Vec<DVec3> {
    let coordinates = random_vector(seed, 3 * rows);
    coordinates.chunks(3).map(DVec3::from_slice).collect()
}

/// A matrix whose pattern is that of the nonzero values, and the diagonal.
pub fn sparse(dense: &DMatrix<f64>) -> CsrMatrix {
    let rows = dense.nrows();
    let pattern = CsrPattern::from_neighbors(rows, |row| {
        (0..rows).filter(move |&column| dense[(row, column)] != 0.0)
    });
    let mut matrix = CsrMatrix::zeros(Arc::new(pattern.unwrap()));
    for row in 0..rows {
        for column in 0..rows {
            if dense[(row, column)] != 0.0 {
                matrix.add(row, column, dense[(row, column)]).unwrap();
            }
        }
    }
    matrix
}

pub fn dense(matrix: &CsrMatrix) -> DMatrix<f64> {
    DMatrix::from_fn(matrix.rows(), matrix.rows(), |row, column| {
        matrix.get(row, column)
    })
}

/// The solution by dense LU factorisation with pivoting.
pub fn dense_solution(matrix: &CsrMatrix, right: &[f64]) -> Vec<f64> {
    let lu = dense(matrix).lu();
    let solution = lu.solve(&DVector::from_column_slice(right));
    solution.expect("not singular").as_slice().to_vec()
}

/// ‖a − b‖ / ‖b‖.
pub fn relative_difference(a: &[f64], b: &[f64]) -> f64 {
    let difference: f64 = a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum();
    let size: f64 = b.iter().map(|b| b * b).sum();
    if difference == 0.0 {
        0.0
    } else {
        (difference / size).sqrt()
    }
}

/// ‖b − Ax‖ / ‖b‖, by dense rows.
pub fn relative_residual(matrix: &CsrMatrix, solution: &[f64], right: &[f64]) -> f64 {
    let pattern = matrix.pattern();
    let image: Vec<f64> = (0..matrix.rows())
        .map(|row| {
            let entries = pattern.row(row);
            let products =
                entries.map(|e| matrix.values()[e] * solution[pattern.columns()[e] as usize]);
            products.sum()
        })
        .collect();
    relative_difference(&image, right)
}

/// Diagonally dominant rows with entries of either sign and a random pattern; not symmetric.
pub fn dominant(largest: usize) -> impl Strategy<Value = DMatrix<f64>> {
    (1..=largest, any::<u32>(), 0.05..0.9).prop_map(|(rows, seed, density)| {
        let seed = u64::from(seed);
        let at = |k: u64| random(seed & 0xff_ffff, k);
        let mut matrix = DMatrix::from_fn(rows, rows, |row, column| {
            let k = 2 * (row * rows + column) as u64;
            if at(k).abs() < density {
                at(k + 1)
            } else {
                0.0
            }
        });
        for row in 0..rows {
            matrix[(row, row)] = 0.0;
            let sum: f64 = matrix.row(row).iter().map(|value| value.abs()).sum();
            let sign = if at(row as u64) < 0.0 { -1.0 } else { 1.0 };
            matrix[(row, row)] = sign * (sum + 0.1);
        }
        matrix
    })
}

/// M-matrices: off the diagonal nothing positive, rows that sum to zero but for one; not symmetric.
pub fn m_matrix(largest: usize) -> impl Strategy<Value = DMatrix<f64>> {
    dominant(largest).prop_map(|mut matrix| {
        let rows = matrix.nrows();
        for row in 0..rows {
            // The ring makes it irreducible.
            matrix[(row, (row + 1) % rows)] -= 0.5;
            for column in 0..rows {
                matrix[(row, column)] = -matrix[(row, column)].abs();
            }
            matrix[(row, row)] = 0.0;
            matrix[(row, row)] = -matrix.row(row).sum();
        }
        matrix[(0, 0)] += 1.0;
        matrix
    })
}

pub fn distorted_icosphere() -> impl Strategy<Value = Surface> {
    (0..3_u32, 0.0..0.25, 0.2..5.0, 0..1000_u64).prop_map(|(level, amount, stretch, seed)| {
        let amount = amount / f64::from(1 << level);
        Surface::icosphere(level).distorted(amount, DVec3::new(stretch, 1.0, 1.0), seed)
    })
}

/// Symmetric, diagonally dominant with a positive diagonal, entries of either sign; often not connected.
pub fn positive_definite(largest: usize) -> impl Strategy<Value = DMatrix<f64>> {
    dominant(largest).prop_map(|matrix| {
        let mut matrix = &matrix + matrix.transpose();
        for row in 0..matrix.nrows() {
            matrix[(row, row)] = 0.0;
            let sum: f64 = matrix.row(row).iter().map(|value| value.abs()).sum();
            matrix[(row, row)] = sum + 0.1;
        }
        matrix
    })
}

/// The source of a redistribution: sums to zero.
pub fn balanced(seed: u64, rows: usize) -> Vec<f64> {
    let mut source = random_vector(seed, rows);
    let mean = source.iter().sum::<f64>() / rows as f64;
    source.iter_mut().for_each(|value| *value -= mean);
    source
}

/// ‖A‖ ‖A⁻¹‖ in the norm of Frobenius.
pub fn condition(matrix: &CsrMatrix) -> f64 {
    let matrix = dense(matrix);
    let inverse = matrix.clone().try_inverse().expect("not singular");
    matrix.norm() * inverse.norm()
}
