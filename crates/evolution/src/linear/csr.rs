//! Square sparse matrices by compressed rows, the pattern apart from the values.
//!
//! ```text
//! rows     0     2        5     7          entries row 1: offsets[1]..offsets[2] = 2..5
//! columns  0  1  0  1  2  1  2             sorted within a row, the diagonal always among them
//! values   2 -1 -1  2 -1 -1  2
//! ```

use super::{Columns, LinearError, columns};
use pellicle_geometry::VertexId;
use pellicle_mesh::TriMesh;
use std::sync::Arc;

/// Which entries of a square matrix may differ from zero: for each row the sorted columns, the diagonal among them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CsrPattern {
    offsets: Vec<u32>,
    columns: Vec<u32>,
    diagonal: Vec<u32>,
}

impl CsrPattern {
    /// The pattern whose row `i` holds the diagonal and the columns `neighbors(i)`, in any order, repeated or not.
    ///
    /// Time O(entries · log(entries of a row)).
    ///
    /// # Errors
    ///
    /// [`LinearError::NoEntry`] names a neighbour that is no row; [`LinearError::TooLarge`].
    pub fn from_neighbors<I: IntoIterator<Item = usize>>(
        rows: usize,
        mut neighbors: impl FnMut(usize) -> I,
    ) -> Result<Self, LinearError> {
        if rows > u32::MAX as usize {
            return Err(LinearError::TooLarge(rows));
        }
        let mut offsets = Vec::with_capacity(rows + 1);
        offsets.push(0);
        let (mut columns, mut diagonal) = (Vec::new(), Vec::with_capacity(rows));
        let mut in_row = Vec::new();
        for row in 0..rows {
            in_row.clear();
            in_row.push(row as u32);
            for column in neighbors(row) {
                if column >= rows {
                    return Err(LinearError::NoEntry { row, column });
                }
                in_row.push(column as u32);
            }
            in_row.sort_unstable();
            in_row.dedup();
            let before = in_row.partition_point(|&column| (column as usize) < row);
            let end = columns.len() + in_row.len();
            if end > u32::MAX as usize {
                return Err(LinearError::TooLarge(end));
            }
            diagonal.push((columns.len() + before) as u32);
            columns.extend_from_slice(&in_row);
            offsets.push(end as u32);
        }
        Ok(Self {
            offsets,
            columns,
            diagonal,
        })
    }

    /// A row for each vertex of a mesh, with the vertex itself and its neighbours.
    ///
    /// # Errors
    ///
    /// [`LinearError::TooLarge`].
    pub fn of_mesh(mesh: &TriMesh) -> Result<Self, LinearError> {
        Self::from_neighbors(mesh.positions().len(), |row| {
            mesh.neighbors(VertexId::new(row)).map(VertexId::index)
        })
    }

    /// The number of rows, which is the number of columns.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.diagonal.len()
    }

    /// The number of entries.
    #[must_use]
    pub fn entries(&self) -> usize {
        self.columns.len()
    }

    /// The entries of a row, as positions among all entries. Panics where there is no such row.
    #[must_use]
    pub fn row(&self, row: usize) -> std::ops::Range<usize> {
        self.offsets[row] as usize..self.offsets[row + 1] as usize
    }

    /// The column of each entry, row after row, ascending within a row.
    #[must_use]
    pub fn columns(&self) -> &[u32] {
        &self.columns
    }

    /// The position of the diagonal entry of each row.
    #[must_use]
    pub fn diagonal(&self) -> &[u32] {
        &self.diagonal
    }

    /// The position of an entry among all entries, or `None` where the pattern has no such entry.
    ///
    /// Time O(log(entries of the row)). An assembly that repeats keeps these positions, one for each half-edge.
    #[must_use]
    pub fn entry(&self, row: usize, column: usize) -> Option<usize> {
        if row >= self.rows() || column >= self.rows() {
            return None;
        }
        let entries = self.row(row);
        let found = self.columns[entries.clone()].binary_search(&(column as u32));
        found.ok().map(|place| entries.start + place)
    }
}

/// A square matrix: a shared pattern, and a value for each of its entries.
#[derive(Clone, Debug, PartialEq)]
pub struct CsrMatrix {
    pattern: Arc<CsrPattern>,
    values: Vec<f64>,
}

impl CsrMatrix {
    /// A matrix of zeros.
    #[must_use]
    pub fn zeros(pattern: Arc<CsrPattern>) -> Self {
        let values = vec![0.0; pattern.entries()];
        Self { pattern, values }
    }

    /// A matrix with these values, in the order of the pattern's entries.
    ///
    /// # Errors
    ///
    /// [`LinearError::WrongLength`] unless there is one value for each entry.
    pub fn new(pattern: Arc<CsrPattern>, values: Vec<f64>) -> Result<Self, LinearError> {
        check_length(pattern.entries(), values.len())?;
        Ok(Self { pattern, values })
    }

    /// The pattern.
    #[must_use]
    pub fn pattern(&self) -> &Arc<CsrPattern> {
        &self.pattern
    }

    /// The number of rows, which is the number of columns.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.pattern.rows()
    }

    /// The value of each entry, in the order of the pattern's.
    #[must_use]
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// The value of each entry, to assemble anew.
    pub fn values_mut(&mut self) -> &mut [f64] {
        &mut self.values
    }

    /// The value in a row and column; zero outside the pattern.
    #[must_use]
    pub fn get(&self, row: usize, column: usize) -> f64 {
        let entry = self.pattern.entry(row, column);
        entry.map_or(0.0, |entry| self.values[entry])
    }

    /// Adds to the value in a row and column.
    ///
    /// # Errors
    ///
    /// [`LinearError::NoEntry`] outside the pattern.
    pub fn add(&mut self, row: usize, column: usize, value: f64) -> Result<(), LinearError> {
        let entry = self.pattern.entry(row, column);
        let entry = entry.ok_or(LinearError::NoEntry { row, column })?;
        self.values[entry] += value;
        Ok(())
    }

    /// Fixes one unknown to zero: drops its row and its column, the diagonal entry apart.
    ///
    /// A positive semi-definite stiffness of one connected component, whose kernel is the constants, becomes positive
    /// definite. With [`pin`](Self::pin)ned row `i` the right-hand side must have zero there too; the solution then has
    /// zero there. A diagonal entry that is not positive becomes one.
    ///
    /// # Errors
    ///
    /// [`LinearError::NoEntry`] if there is no such row, or if the pattern is not symmetric about it.
    pub fn pin(&mut self, row: usize) -> Result<(), LinearError> {
        if row >= self.rows() {
            return Err(LinearError::NoEntry { row, column: row });
        }
        let pattern = Arc::clone(&self.pattern);
        for entry in pattern.row(row) {
            let column = pattern.columns[entry] as usize;
            if column != row {
                let mirrored = pattern.entry(column, row);
                let mirrored = mirrored.ok_or(LinearError::NoEntry {
                    row: column,
                    column: row,
                })?;
                self.values[entry] = 0.0;
                self.values[mirrored] = 0.0;
            }
        }
        let diagonal = &mut self.values[pattern.diagonal[row] as usize];
        if diagonal.partial_cmp(&&mut 0.0) != Some(std::cmp::Ordering::Greater) {
            *diagonal = 1.0;
        }
        Ok(())
    }

    pub(super) fn has_pattern(&self, pattern: &Arc<CsrPattern>) -> bool {
        Arc::ptr_eq(&self.pattern, pattern) || self.pattern == *pattern
    }

    /// `product` = A `vector`, for each column of the vector. Same bits for any number of threads.
    ///
    /// # Errors
    ///
    /// [`LinearError::WrongLength`] unless both have one value for each row.
    pub fn multiply<V: Columns>(&self, vector: &[V], product: &mut [V]) -> Result<(), LinearError> {
        check_length(self.rows(), vector.len())?;
        check_length(self.rows(), product.len())?;
        self.multiply_and_sum(vector, product, |_, _| []);
        Ok(())
    }

    /// [`multiply`](Self::multiply), with sums over rows: `share(row, (A vector)[row])` is the share of a row.
    pub(super) fn multiply_and_sum<V: Columns, const SUMS: usize>(
        &self,
        vector: &[V],
        product: &mut [V],
        share: impl Fn(usize, V) -> [V; SUMS] + Sync,
    ) -> [V; SUMS] {
        let pattern = &*self.pattern;
        columns::update(product, |first, rows| {
            let mut sums = [V::ZERO; SUMS];
            let mut start = pattern.offsets[first] as usize;
            let ends = &pattern.offsets[first + 1..=first + rows.len()];
            for ((out, &end), row) in rows.iter_mut().zip(ends).zip(first..) {
                let end = end as usize;
                let entries = pattern.columns[start..end].iter();
                let mut sum = V::ZERO;
                for (&column, &value) in entries.zip(&self.values[start..end]) {
                    sum += vector[column as usize] * value;
                }
                start = end;
                *out = sum;
                for (total, share) in sums.iter_mut().zip(share(row, sum)) {
                    *total += share;
                }
            }
            sums
        })
    }
}

/// An error unless two lengths agree.
pub(super) fn check_length(expected: usize, found: usize) -> Result<(), LinearError> {
    if expected == found {
        Ok(())
    } else {
        Err(LinearError::WrongLength { expected, found })
    }
}
