//! Room between tetrahedra for those of the next round.

/// Where tetrahedra go when they are spread: by old slot the new one, which is never less.
///
/// The slots are those of some workers, each with an equal part. A worker fills its part from the start, and goes on in slots
/// that are added behind all others if there are fewer slots than tetrahedra. When it comes to a place along the Hilbert
/// curve it is to find there, at the same slots, the tetrahedra that already are there. So they are spread as
/// wide as if there were slots for all, and the last ones of a part are not spread at all:
///
/// ```text
/// old      abcdefgh                               one part, twice as many expected, slots for 3/4 of these
/// new      a.b.c.d.efgh|
/// filled   aAbBcCdDefghEFGH
/// ```
pub(super) struct Spreading {
    /// By part, and after the last: its first old slot, and its first new one.
    starts: Vec<(usize, usize)>,
    /// The distance between two that were neighbours: a multiple of a small power of two, so that products with it are exact
    /// and no two go to the same slot.
    step: f64,
}

impl Spreading {
    /// From `old` to `new` slots, which are no fewer, in so many parts, where the tetrahedra become `growth` times as many.
    pub(super) fn new(old: usize, new: usize, growth: f64, parts: usize) -> Self {
        let start = |slots: usize, part: usize| slots * part / parts;
        Self {
            starts: (0..=parts)
                .map(|part| (start(old, part), start(new, part)))
                .collect(),
            step: ((growth * 256.0).floor() / 256.0).max(1.0),
        }
    }

    pub(super) fn of(&self, slot: usize) -> usize {
        let next = self.starts[1..].partition_point(|&(old, _)| old <= slot) + 1;
        let (old, new) = self.starts[next - 1];
        let (old_end, new_end) = self.starts[next];
        let spread = new + ((slot - old) as f64 * self.step) as usize;
        spread.min(new_end - (old_end - slot))
    }

    /// The first slot that goes to `slot` or beyond.
    pub(super) fn first_beyond(&self, slot: usize) -> usize {
        let (mut low, mut high) = (0, slot);
        while low < high {
            let middle = low.midpoint(high);
            if self.of(middle) < slot {
                low = middle + 1;
            } else {
                high = middle;
            }
        }
        low
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn as_drawn() {
        let spreading = Spreading::new(8, 12, 2.0, 1);
        let new: Vec<usize> = (0..8).map(|slot| spreading.of(slot)).collect();
        assert_eq!(new, [0, 2, 4, 6, 8, 9, 10, 11]);
    }

    proptest! {
        #[test]
        fn nobody_meets_anybody(
            old in 1..300_usize,
            more in 0..2000_usize,
            growth in 0.5..12.0,
            parts in 1..5_usize,
        ) {
            let new = old + more;
            let spreading = Spreading::new(old, new, growth, parts);
            let places: Vec<usize> = (0..old).map(|slot| spreading.of(slot)).collect();
            prop_assert!(places.is_sorted_by(|one, next| one < next));
            prop_assert!((0..old).all(|slot| (slot..new).contains(&places[slot])));
            for slot in 0..=old {
                let first = spreading.first_beyond(slot);
                prop_assert_eq!(first, places.partition_point(|&place| place < slot));
            }
        }
    }
}
