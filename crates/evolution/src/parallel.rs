//! Elementwise work on one thread or several, with the same bits either way.

use rayon::prelude::*;

/// Below this many elements a second thread costs more than it saves.
const WORTH_SHARING: usize = 8192;

/// `[f(0), f(1), …]` into `values`, whose storage is reused.
pub(crate) fn fill<T: Send>(
    values: &mut Vec<T>,
    count: usize,
    f: impl Fn(usize) -> T + Sync + Send,
) {
    if count < WORTH_SHARING {
        values.clear();
        values.extend((0..count).map(f));
    } else {
        (0..count).into_par_iter().map(f).collect_into_vec(values);
    }
}

/// [`fill`] of a slice.
pub(crate) fn fill_slice<T: Send>(values: &mut [T], f: impl Fn(usize) -> T + Sync + Send) {
    if values.len() < WORTH_SHARING {
        values
            .iter_mut()
            .enumerate()
            .for_each(|(i, value)| *value = f(i));
    } else {
        values
            .par_iter_mut()
            .enumerate()
            .for_each(|(i, value)| *value = f(i));
    }
}
