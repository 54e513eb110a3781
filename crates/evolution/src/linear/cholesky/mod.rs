//! Sparse Cholesky factors: P A Pᵀ = L Lᵀ, the structure apart from the values.
//!
//! Left-looking, by panels of columns with the same rows (Ng and Peyton 1993), so that most of the arithmetic is dense.

mod ordering;
mod symbolic;

use super::{Columns, CsrMatrix, LinearError, Preconditioner};
use symbolic::{PADDING, Panel, Symbolic};

/// The factor of a symmetric positive definite matrix: solves at once, or preconditions a matrix that is near.
///
/// The order is nested dissection of the pattern's graph; it and the structure of L are found once for a pattern,
/// [`refresh`](Self::refresh) then computes the values for another matrix of that pattern. On a closed mesh of n vertices
/// L has about n·log₂(n)·4 entries; time O(n^1.5), solution O(n log n). Sequential: same bits everywhere.
#[derive(Debug)]
pub struct Cholesky {
    symbolic: Symbolic,
    values: Vec<f64>,
    /// The product of a panel with its own transpose, before it is subtracted.
    product: Vec<f64>,
    /// For each panel the next of those that wait for the same column.
    next: Vec<u32>,
    /// For each panel the last that waits for one of its columns.
    waiting: Vec<u32>,
    /// For each panel how many of its rows are used up.
    used: Vec<u32>,
    /// Where a row lies in the present panel.
    local: Vec<u32>,
}

const NONE: u32 = u32::MAX;

impl Cholesky {
    /// Analyses the pattern of a matrix and factorises it. Values above the diagonal of P A Pᵀ are taken to mirror those
    /// below.
    ///
    /// # Errors
    ///
    /// [`LinearError::NoEntry`] where the pattern is not symmetric; [`LinearError::NotPositiveDefinite`] names the row
    /// whose pivot is not positive; [`LinearError::TooLarge`].
    pub fn new(matrix: &CsrMatrix) -> Result<Self, LinearError> {
        let symbolic = Symbolic::new(matrix.pattern())?;
        let panels = symbolic.panels.len();
        let product = symbolic.panels.iter().map(|panel| {
            panel.stride()
                * (panel.height - panel.width)
                    .min(symbolic::WIDTH)
                    .next_multiple_of(4)
        });
        let product = vec![0.0; product.max().unwrap_or(0)];
        let mut cholesky = Self {
            values: vec![0.0; symbolic.values],
            product,
            next: vec![NONE; panels],
            waiting: vec![NONE; panels],
            used: vec![0; panels],
            local: vec![0; symbolic.order.len()],
            symbolic,
        };
        cholesky.refresh(matrix)?;
        Ok(cholesky)
    }

    /// The number of entries stored for L.
    #[must_use]
    pub fn entries(&self) -> usize {
        self.values.len()
    }

    /// Whether a matrix has the pattern that was analysed.
    #[must_use]
    pub fn fits(&self, matrix: &CsrMatrix) -> bool {
        matrix.has_pattern(&self.symbolic.pattern)
    }

    /// Factorises another matrix of the same pattern, without allocating.
    ///
    /// # Errors
    ///
    /// [`LinearError::WrongPattern`]; [`LinearError::NotPositiveDefinite`] names the row of the matrix whose pivot is not
    /// positive. The factor must not be used after an error.
    pub fn refresh(&mut self, matrix: &CsrMatrix) -> Result<(), LinearError> {
        if !self.fits(matrix) {
            return Err(LinearError::WrongPattern);
        }
        self.values.fill(0.0);
        for &[entry, value] in &self.symbolic.gather {
            self.values[value as usize] = matrix.values()[entry as usize];
        }
        self.waiting.fill(NONE);
        for p in 0..self.symbolic.panels.len() {
            let panel = self.symbolic.panels[p];
            for (local, &row) in self.symbolic.rows_of(&panel).iter().enumerate() {
                self.local[row as usize] = local as u32;
            }
            let mut descendant = std::mem::replace(&mut self.waiting[p], NONE);
            while descendant != NONE {
                let following = self.next[descendant as usize];
                self.subtract(&panel, descendant as usize);
                descendant = following;
            }
            let end = panel.values + panel.width * panel.stride();
            let factored = factorise(&mut self.values[panel.values..end], &panel);
            factored.map_err(|column| LinearError::NotPositiveDefinite {
                row: self.symbolic.order[panel.first + column] as usize,
            })?;
            self.wait(p, panel.width);
        }
        Ok(())
    }

    /// Puts a panel in the list of the one that holds its next row.
    fn wait(&mut self, p: usize, used: usize) {
        let panel = &self.symbolic.panels[p];
        if let Some(&row) = self.symbolic.rows_of(panel).get(used) {
            let target = self.symbolic.panel_of[row as usize] as usize;
            self.used[p] = used as u32;
            self.next[p] = self.waiting[target];
            self.waiting[target] = p as u32;
        }
    }

    /// Subtracts what an earlier panel contributes to this one: its rows from the first in this panel's columns on, times
    /// the transpose of those in the columns.
    fn subtract(&mut self, panel: &Panel, earlier: usize) {
        let source = self.symbolic.panels[earlier];
        let rows = &self.symbolic.rows_of(&source)[self.used[earlier] as usize..];
        let end = panel.first + panel.width;
        let columns = rows.partition_point(|&row| (row as usize) < end);
        let stride = rows.len() + PADDING;
        let (before, own) = self.values.split_at_mut(panel.values);
        let from = source.values;
        multiply(
            &before[from..from + source.width * source.stride()],
            source.stride(),
            self.used[earlier] as usize,
            columns,
            &mut self.product,
        );
        for (j, product) in self.product.chunks_exact(stride).take(columns).enumerate() {
            let column = (rows[j] as usize - panel.first) * panel.stride();
            let target = &mut own[column..column + panel.height];
            for (&row, &value) in rows[j..].iter().zip(&product[j..]) {
                target[self.local[row as usize] as usize] -= value;
            }
        }
        let used = self.used[earlier] as usize + columns;
        self.wait(earlier, used);
    }

    /// `solution` = A⁻¹ `right`, for each column of the right side.
    ///
    /// # Errors
    ///
    /// [`LinearError::WrongLength`].
    pub fn solve<V: Columns>(&self, right: &[V], solution: &mut [V]) -> Result<(), LinearError> {
        super::csr::check_length(self.symbolic.order.len(), right.len())?;
        super::csr::check_length(self.symbolic.order.len(), solution.len())?;
        let order = &self.symbolic.order;
        let mut unknowns: Vec<V> = order.iter().map(|&row| right[row as usize]).collect();
        let tallest = self.symbolic.panels.iter().map(|panel| panel.height).max();
        let mut below = vec![V::ZERO; tallest.unwrap_or(0)];
        for panel in &self.symbolic.panels {
            self.forward(panel, &mut unknowns, &mut below);
        }
        for panel in self.symbolic.panels.iter().rev() {
            self.backward(panel, &mut unknowns, &mut below);
        }
        for (&row, &unknown) in order.iter().zip(&unknowns) {
            solution[row as usize] = unknown;
        }
        Ok(())
    }

    fn columns(
        &self,
        panel: &Panel,
    ) -> impl DoubleEndedIterator<Item = &[f64]> + ExactSizeIterator {
        let end = panel.values + panel.width * panel.stride();
        let columns = self.values[panel.values..end].chunks_exact(panel.stride());
        let height = panel.height;
        columns.map(move |column| &column[..height])
    }

    /// L y = b.
    fn forward<V: Columns>(&self, panel: &Panel, unknowns: &mut [V], below: &mut [V]) {
        let own = &mut unknowns[panel.first..panel.first + panel.width];
        let below = &mut below[..panel.height - panel.width];
        below.fill(V::ZERO);
        for (k, column) in self.columns(panel).enumerate() {
            let value = own[k] * column[k].recip();
            own[k] = value;
            for (unknown, &l) in own[k + 1..].iter_mut().zip(&column[k + 1..]) {
                *unknown -= value * l;
            }
            for (sum, &l) in below.iter_mut().zip(&column[panel.width..]) {
                *sum += value * l;
            }
        }
        let rows = &self.symbolic.rows_of(panel)[panel.width..];
        for (&row, &sum) in rows.iter().zip(&*below) {
            unknowns[row as usize] -= sum;
        }
    }

    /// Lᵀ x = y.
    fn backward<V: Columns>(&self, panel: &Panel, unknowns: &mut [V], below: &mut [V]) {
        let rows = &self.symbolic.rows_of(panel)[panel.width..];
        let below = &mut below[..rows.len()];
        for (below, &row) in below.iter_mut().zip(rows) {
            *below = unknowns[row as usize];
        }
        let own = &mut unknowns[panel.first..panel.first + panel.width];
        for (k, column) in self.columns(panel).enumerate().rev() {
            let sum = dot(&column[k + 1..panel.width], &own[k + 1..])
                + dot(&column[panel.width..], below);
            own[k] = (own[k] - sum) * column[k].recip();
        }
    }
}

impl Preconditioner for Cholesky {
    fn apply<V: Columns>(&mut self, vector: &[V], solution: &mut [V]) {
        self.solve(vector, solution)
            .expect("as many values as rows");
    }
}

/// Σ l·x in four interleaved sums.
fn dot<V: Columns>(l: &[f64], x: &[V]) -> V {
    let mut sums = [V::ZERO; 4];
    let (l, l_rest) = l.as_chunks::<4>();
    let (x, x_rest) = x.as_chunks::<4>();
    for (l, x) in l.iter().zip(x) {
        for i in 0..4 {
            sums[i] += x[i] * l[i];
        }
    }
    for ((sum, &l), &x) in sums.iter_mut().zip(l_rest).zip(x_rest) {
        *sum += x * l;
    }
    (sums[0] + sums[1]) + (sums[2] + sums[3])
}

/// Dense Cholesky of a panel, in place: the triangle, and the rows below times its inverse transposed. An error is the
/// column whose pivot is not positive.
fn factorise(values: &mut [f64], panel: &Panel) -> Result<(), usize> {
    let stride = panel.stride();
    for k in 0..panel.width {
        let (done, rest) = values.split_at_mut(k * stride);
        let column = &mut rest[k..panel.height];
        for earlier in done.chunks_exact(stride) {
            let earlier = &earlier[k..panel.height];
            let factor = earlier[0];
            for (value, &l) in column.iter_mut().zip(earlier) {
                *value -= factor * l;
            }
        }
        let pivot = column[0];
        if !(pivot > 0.0 && pivot.is_finite()) {
            return Err(k);
        }
        let root = pivot.sqrt();
        column[0] = root;
        let inverse = root.recip();
        for value in &mut column[1..] {
            *value *= inverse;
        }
    }
    Ok(())
}

/// `product` = B Cᵀ, where B are the rows of a panel from `first` on and C its next `columns` rows; on and below the
/// diagonal. Tiles of 4 × 4 reach over the ends, into rows of zeros or of no use.
fn multiply(panel: &[f64], stride: usize, first: usize, columns: usize, product: &mut [f64]) {
    let rows = stride - PADDING - first;
    let out = rows + PADDING;
    for j in (0..columns).step_by(4) {
        for i in (j..rows).step_by(4) {
            let mut tile = [[0.0; 4]; 4];
            for column in panel.chunks_exact(stride) {
                let b = &column[first + i..first + i + 4];
                let c = &column[first + j..first + j + 4];
                for (tile, &c) in tile.iter_mut().zip(c) {
                    for (sum, &b) in tile.iter_mut().zip(b) {
                        *sum += b * c;
                    }
                }
            }
            for (k, tile) in tile.iter().enumerate() {
                product[(j + k) * out + i..][..4].copy_from_slice(tile);
            }
        }
    }
}
