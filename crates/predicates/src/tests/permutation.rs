//! All permutations of a few items with their parities.

use crate::Sign;

/// Every arrangement of the items, positive for the even ones.
pub(super) fn permutations<T: Copy, const N: usize>(items: [T; N]) -> Vec<([T; N], Sign)> {
    fn arrange<T: Copy, const N: usize>(
        items: [T; N],
        from: usize,
        parity: Sign,
        found: &mut Vec<([T; N], Sign)>,
    ) {
        if from == N {
            found.push((items, parity));
        }
        for i in from..N {
            let mut swapped = items;
            swapped.swap(from, i);
            arrange(
                swapped,
                from + 1,
                if i == from { parity } else { -parity },
                found,
            );
        }
    }
    let mut found = Vec::new();
    arrange(items, 0, Sign::Positive, &mut found);
    found
}

#[test]
fn half_of_them_are_even() {
    let all = permutations([1, 2, 3, 4]);
    assert_eq!(all.len(), 24);
    let even = all.iter().filter(|(_, parity)| *parity == Sign::Positive);
    assert_eq!(even.count(), 12);
    assert!(all.contains(&([2, 3, 1, 4], Sign::Positive)));
    assert!(all.contains(&([2, 1, 3, 4], Sign::Negative)));
}
