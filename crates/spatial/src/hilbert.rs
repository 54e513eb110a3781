//! The three-dimensional Hilbert curve.
//!
//! Source: Hamilton and Rau-Chaplin 2008. At each level the curve visits the eight octants of a cell in
//! Gray-code order; how that order is turned and mirrored is the *state*, an entry corner `e` and a
//! direction `d`:
//!
//! ```text
//!   w    = position along the curve, 0..8
//!   gray = w ^ (w >> 1)                      octants in the order of an untransformed cell
//!   octant = rotate_left(gray, d + 1) ^ e    octants in the order of this cell
//! ```

/// Bits a coordinate in a [`key`]: three of them fill 60 bits.
pub const BITS: u32 = 20;

/// One step down the curve: where the octant comes in this cell's order, and the octant's own state.
#[derive(Clone, Copy)]
struct Step {
    position: u8,
    state: u8,
}

/// 24 states: 3 directions of 8 entry corners, as `3 e + d`.
const STEPS: [[Step; 8]; 24] = steps();

const fn rotate_left(bits: u8, count: u8) -> u8 {
    let count = count % 3;
    ((bits << count) | (bits >> (3 - count))) & 7
}

const fn steps() -> [[Step; 8]; 24] {
    let mut table = [[Step {
        position: 0,
        state: 0,
    }; 8]; 24];
    let mut state = 0;
    while state < 24 {
        let (e, d) = ((state / 3) as u8, (state % 3) as u8);
        let mut w: u8 = 0;
        while w < 8 {
            let octant = rotate_left(w ^ (w >> 1), d + 1) ^ e;
            let (entry, direction) = (entry_corner(w), intra_direction(w));
            let next_e = e ^ rotate_left(entry, d + 1);
            let next_d = (d + direction + 1) % 3;
            table[state][octant as usize] = Step {
                position: w,
                state: 3 * next_e + next_d,
            };
            w += 1;
        }
        state += 1;
    }
    table
}

/// The corner at which the curve enters the `w`-th octant.
const fn entry_corner(w: u8) -> u8 {
    if w == 0 {
        0
    } else {
        let even = 2 * ((w - 1) / 2);
        even ^ (even >> 1)
    }
}

/// The axis along which the curve runs from entry to exit of the `w`-th octant.
const fn intra_direction(w: u8) -> u8 {
    if w == 0 {
        0
    } else if w & 1 == 0 {
        (w - 1).trailing_ones() as u8 % 3
    } else {
        w.trailing_ones() as u8 % 3
    }
}

/// How far along the curve the cell (x, y, z) of a 2²⁰ × 2²⁰ × 2²⁰ grid comes: 60 bits.
///
/// Cells that follow each other on the curve share a face. Higher bits of the arguments are ignored.
///
/// ```
/// use pellicle_spatial::hilbert::key;
/// assert_eq!(key(0, 0, 0), 0);
/// ```
#[inline]
pub fn key(x: u32, y: u32, z: u32) -> u64 {
    let mut state = 0;
    let mut key = 0;
    for bit in (0..BITS).rev() {
        let octant = (x >> bit & 1) | (y >> bit & 1) << 1 | (z >> bit & 1) << 2;
        let step = STEPS[state][octant as usize];
        key = key << 3 | u64::from(step.position);
        state = usize::from(step.state);
    }
    key
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The first 8^levels cells of the curve fill the cube of side 2^levels, each cell beside the last.
    #[test]
    fn the_curve_visits_every_cell_once_and_never_jumps() {
        let side = 8u32;
        let mut cells: Vec<(u64, [i64; 3])> = Vec::new();
        // The state of the uppermost levels is not that of the whole curve, so spread the cells over the
        // high bits.
        let shift = BITS - 3;
        for x in 0..side {
            for y in 0..side {
                for z in 0..side {
                    let key = key(x << shift, y << shift, z << shift) >> (3 * shift);
                    cells.push((key, [x.into(), y.into(), z.into()]));
                }
            }
        }
        cells.sort_unstable();
        for (expected, (key, _)) in cells.iter().enumerate() {
            assert_eq!(*key, expected as u64);
        }
        for pair in cells.windows(2) {
            let distance: i64 = (0..3).map(|i| (pair[0].1[i] - pair[1].1[i]).abs()).sum();
            assert_eq!(distance, 1, "{pair:?}");
        }
    }
}
