//! Sets of tetrahedra compared, all of them, in bounded memory.

use std::fs::File;
use std::io::{BufReader, ErrorKind, Read};
use std::path::Path;

/// Tetrahedra of each set in memory at once.
const AT_ONCE: u64 = 4_000_000;

/// How two sets differ.
#[derive(Debug, Default, PartialEq)]
pub struct Difference {
    /// Tetrahedra of the first set that the second lacks; one that is there twice too often counts twice.
    pub only_first: u64,
    /// The reverse.
    pub only_second: u64,
}

impl Difference {
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }
}

/// Compares two files of tetrahedra, four little-endian ids each in any order, over the points of a file of doubles.
///
/// Equal points are one vertex. The sets are taken apart by the lowest vertex, and part by part sorted and merged.
pub fn compare(points: &Path, first: &Path, second: &Path) -> Result<Difference, String> {
    let bytes = std::fs::read(points).map_err(|error| format!("{}: {error}", points.display()))?;
    let representatives = representatives(&bytes);
    drop(bytes);
    let length = |path: &Path| {
        std::fs::metadata(path)
            .map(|data| data.len())
            .map_err(|error| format!("{}: {error}", path.display()))
    };
    let parts = (length(first)?.max(length(second)?) / 16).div_ceil(AT_ONCE);
    let mut difference = Difference::default();
    for part in 0..parts as u32 {
        let part = |path: &Path| {
            let file = File::open(path).map_err(|error| format!("{}: {error}", path.display()))?;
            sorted_part(file, &representatives, part, parts as u32)
                .map_err(|error| format!("{}: {error}", path.display()))
        };
        difference.take_in(&part(first)?, &part(second)?);
    }
    Ok(difference)
}

/// For each point, given as three little-endian doubles, the lowest id of an equal point: the programs name equal points
/// by different ids.
fn representatives(points: &[u8]) -> Vec<u32> {
    let coordinate = |bytes: &[u8]| {
        let mut eight = [0; 8];
        eight.copy_from_slice(bytes);
        // Adding zero makes −0 and 0 one.
        (f64::from_le_bytes(eight) + 0.0).to_bits()
    };
    let point = |i: u32| {
        let at = i as usize * 24;
        [0, 8, 16].map(|offset| coordinate(&points[at + offset..at + offset + 8]))
    };
    let mut order: Vec<u32> = (0..(points.len() / 24) as u32).collect();
    order.sort_unstable_by_key(|&i| (point(i), i));
    let mut representatives = vec![0; order.len()];
    for equal in order.chunk_by(|&a, &b| point(a) == point(b)) {
        for &i in equal {
            representatives[i as usize] = equal[0];
        }
    }
    representatives
}

/// The tetrahedra whose lowest vertex belongs to this part of so many, by representatives; ids out of range stay.
fn sorted_part(
    source: impl Read,
    representatives: &[u32],
    part: u32,
    parts: u32,
) -> std::io::Result<Vec<[u32; 4]>> {
    let mut source = BufReader::with_capacity(1 << 20, source);
    let mut tetrahedra = Vec::new();
    let mut bytes = [0; 16];
    loop {
        match source.read_exact(&mut bytes) {
            Ok(()) => {}
            Err(error) if error.kind() == ErrorKind::UnexpectedEof => break,
            Err(error) => return Err(error),
        }
        let mut corners = [0, 4, 8, 12].map(|at| {
            let id = u32::from_le_bytes([bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]]);
            representatives.get(id as usize).copied().unwrap_or(id)
        });
        corners.sort_unstable();
        if corners[0] % parts == part {
            tetrahedra.push(corners);
        }
    }
    tetrahedra.sort_unstable();
    Ok(tetrahedra)
}

impl Difference {
    /// Merges two sorted lists and counts what only one of them has.
    fn take_in(&mut self, first: &[[u32; 4]], second: &[[u32; 4]]) {
        let (mut i, mut j) = (0, 0);
        while i < first.len() && j < second.len() {
            match first[i].cmp(&second[j]) {
                std::cmp::Ordering::Less => (self.only_first, i) = (self.only_first + 1, i + 1),
                std::cmp::Ordering::Greater => {
                    (self.only_second, j) = (self.only_second + 1, j + 1)
                }
                std::cmp::Ordering::Equal => (i, j) = (i + 1, j + 1),
            }
        }
        self.only_first += (first.len() - i) as u64;
        self.only_second += (second.len() - j) as u64;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Points 1 and 3 are equal, zeros of either sign included.
    fn points() -> Vec<u8> {
        let coordinates = [
            [1.0, 0.0, 0.0],
            [0.0, 2.0, 0.0],
            [0.0, 0.0, 3.0],
            [-0.0, 2.0, 0.0],
        ];
        let bytes = |c: &f64| c.to_le_bytes();
        coordinates.iter().flatten().flat_map(bytes).collect()
    }

    fn file(tets: &[[u32; 4]]) -> Vec<u8> {
        let bytes = |id: &u32| id.to_le_bytes();
        tets.iter().flatten().flat_map(bytes).collect()
    }

    fn difference(first: &[[u32; 4]], second: &[[u32; 4]], parts: u32) -> [u64; 2] {
        let representatives = representatives(&points());
        let mut difference = Difference::default();
        for part in 0..parts {
            let sorted =
                |tets| sorted_part(&file(tets)[..], &representatives, part, parts).unwrap();
            difference.take_in(&sorted(first), &sorted(second));
        }
        [difference.only_first, difference.only_second]
    }

    #[test]
    fn equal_points_have_one_representative() {
        assert_eq!(representatives(&points()), [0, 1, 2, 1]);
    }

    #[test]
    fn sets_are_compared_by_place_not_by_id() {
        for parts in 1..5 {
            let one = [[0, 1, 2, 7], [0, 3, 2, 9], [2, 6, 7, 8]];
            let other = [[9, 2, 0, 1], [8, 7, 6, 2], [7, 3, 2, 0]];
            assert_eq!(difference(&one, &other, parts), [0, 0]);
            assert_eq!(difference(&one, &other[1..], parts), [1, 0]);
            assert_eq!(difference(&one[..1], &other, parts), [0, 2]);
            assert_eq!(difference(&[[0, 1, 2, 7]], &[[0, 2, 2, 7]], parts), [1, 1]);
            // One tetrahedron twice is not two.
            assert_eq!(difference(&[one[0], one[0]], &one[..2], parts), [1, 1]);
        }
    }

    #[test]
    fn files_are_compared() {
        let folder = std::env::temp_dir().join(format!("pellicle-sets-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let put = |name: &str, bytes: &[u8]| {
            let path = folder.join(name);
            std::fs::write(&path, bytes).unwrap();
            path
        };
        let points = put("points", &points());
        let one = put("one", &file(&[[0, 1, 2, 7], [0, 1, 2, 8]]));
        let same = put("same", &file(&[[8, 3, 2, 0], [0, 1, 2, 7]]));
        let other = put("other", &file(&[[0, 1, 2, 7]]));
        assert!(compare(&points, &one, &same).unwrap().is_empty());
        let difference = compare(&points, &one, &other).unwrap();
        assert_eq!((difference.only_first, difference.only_second), (1, 0));
        assert!(compare(&points, &one, &folder.join("none")).is_err());
        std::fs::remove_dir_all(&folder).unwrap();
    }
}
