//! What a vector holds for each row, and sums over rows that do not depend on the number of threads.

use glam::DVec3;
use rayon::prelude::*;
use std::fmt::Debug;
use std::ops::{Add, AddAssign, Mul, Sub, SubAssign};

/// One number for each right-hand side: `f64` for one system, [`DVec3`] for three that share a matrix.
///
/// Products of two are taken component by component: the columns never mix.
pub trait Columns:
    Copy
    + Debug
    + Default
    + PartialEq
    + Send
    + Sync
    + Add<Output = Self>
    + AddAssign
    + Sub<Output = Self>
    + SubAssign
    + Mul<Output = Self>
    + Mul<f64, Output = Self>
    + private::Sealed
    + 'static
{
    /// The number of columns.
    const COUNT: usize;
    /// Zero in each column.
    const ZERO: Self;
    /// The number in one column.
    fn column(self, column: usize) -> f64;
    /// Replaces the number in one column.
    fn set_column(&mut self, column: usize, value: f64);

    /// The number `f(column)` in each column.
    #[inline]
    fn from_columns(mut f: impl FnMut(usize) -> f64) -> Self {
        let mut columns = Self::ZERO;
        for column in 0..Self::COUNT {
            columns.set_column(column, f(column));
        }
        columns
    }
}

mod private {
    pub trait Sealed {}
    impl Sealed for f64 {}
    impl Sealed for glam::DVec3 {}
}

impl Columns for f64 {
    const COUNT: usize = 1;
    const ZERO: Self = 0.0;

    #[inline]
    fn column(self, _column: usize) -> f64 {
        self
    }

    #[inline]
    fn set_column(&mut self, _column: usize, value: f64) {
        *self = value;
    }
}

impl Columns for DVec3 {
    const COUNT: usize = 3;
    const ZERO: Self = DVec3::ZERO;

    #[inline]
    fn column(self, column: usize) -> f64 {
        self[column]
    }

    #[inline]
    fn set_column(&mut self, column: usize, value: f64) {
        self[column] = value;
    }
}

/// Rows in a chunk. The sums of chunks are added in order, so this number is part of the result's bits.
const CHUNK: usize = 2048;

/// Below this many rows a second thread costs more than it gives.
const PARALLEL_ROWS: usize = 16_384;

/// Fills `out` chunk by chunk; `f(first row, rows)` returns the chunk's share of `SUMS` sums over all rows.
pub(super) fn update<V: Columns, const SUMS: usize>(
    out: &mut [V],
    f: impl Fn(usize, &mut [V]) -> [V; SUMS] + Sync,
) -> [V; SUMS] {
    if out.len() < PARALLEL_ROWS {
        let chunks = out.chunks_mut(CHUNK).enumerate();
        total(chunks.map(|(i, rows)| f(i * CHUNK, rows)))
    } else {
        let chunks = out.par_chunks_mut(CHUNK).enumerate();
        let shares: Vec<_> = chunks.map(|(i, rows)| f(i * CHUNK, rows)).collect();
        total(shares.into_iter())
    }
}

/// [`update`] of two vectors of the same length at once.
pub(super) fn update_two<V: Columns, const SUMS: usize>(
    a: &mut [V],
    b: &mut [V],
    f: impl Fn(usize, &mut [V], &mut [V]) -> [V; SUMS] + Sync,
) -> [V; SUMS] {
    if a.len() < PARALLEL_ROWS {
        let chunks = a.chunks_mut(CHUNK).zip(b.chunks_mut(CHUNK)).enumerate();
        total(chunks.map(|(i, (a, b))| f(i * CHUNK, a, b)))
    } else {
        let chunks = a.par_chunks_mut(CHUNK).zip(b.par_chunks_mut(CHUNK));
        let shares: Vec<_> = chunks
            .enumerate()
            .map(|(i, (a, b))| f(i * CHUNK, a, b))
            .collect();
        total(shares.into_iter())
    }
}

/// `SUMS` sums over rows; `f(rows)` returns the share of a chunk of rows.
pub(super) fn sums<V: Columns, const SUMS: usize>(
    count: usize,
    f: impl Fn(std::ops::Range<usize>) -> [V; SUMS] + Sync + Send,
) -> [V; SUMS] {
    let rows = |chunk: usize| chunk * CHUNK..count.min((chunk + 1) * CHUNK);
    let chunks = 0..count.div_ceil(CHUNK);
    if count < PARALLEL_ROWS {
        total(chunks.map(|chunk| f(rows(chunk))))
    } else {
        let shares: Vec<_> = chunks.into_par_iter().map(|chunk| f(rows(chunk))).collect();
        total(shares.into_iter())
    }
}

fn total<V: Columns, const SUMS: usize>(shares: impl Iterator<Item = [V; SUMS]>) -> [V; SUMS] {
    let mut sums = [V::ZERO; SUMS];
    for share in shares {
        for (sum, share) in sums.iter_mut().zip(share) {
            *sum += share;
        }
    }
    sums
}
