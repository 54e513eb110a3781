//! Bytes as points: many equal, many in degenerate position, or anything at all.

use pellicle_delaunay::{
    DynamicTetrahedralization, Error, Options, RegularTetrahedralization, Tetrahedralization,
    tetrahedralize, tetrahedralize_weighted,
};
use pellicle_geometry::{DVec3, VertexId};

/// More points than this find nothing that fewer do not, only later.
const MOST: usize = 48;

/// Up to so many points every vertex is tested against every tetrahedron.
const FEW: usize = 16;

/// Integer points of the sphere x² + y² + z² = 81, up to permutations and signs.
const ON_SPHERE: [[i8; 3]; 4] = [[1, 4, 8], [4, 4, 7], [0, 0, 9], [3, 6, 6]];

/// The first byte says how the others are to be read.
pub fn points(bytes: &[u8]) -> Vec<DVec3> {
    let Some((&scheme, bytes)) = bytes.split_first() else {
        return Vec::new();
    };
    let signed = |byte: u8| f64::from(byte as i8);
    let points: Vec<DVec3> = match scheme % 7 {
        // Small integers: lattices, planes, lines, duplicates.
        0 => chunks::<3>(bytes)
            .map(|c| DVec3::from_array(c.map(|b| f64::from(b % 5))))
            .collect(),
        1 => chunks::<3>(bytes)
            .map(|c| DVec3::from_array(c.map(signed)))
            .collect(),
        // Snapped to tenths, which doubles are not: lattices up to the last bit.
        2 => chunks::<3>(bytes)
            .map(|c| DVec3::from_array(c.map(|b| signed(b) * 0.1)))
            .collect(),
        // A sphere's integer points.
        3 => chunks::<1>(bytes).map(|[byte]| on_sphere(byte)).collect(),
        // Few bits at any exponent.
        4 => chunks::<6>(bytes)
            .map(|c| DVec3::new(scaled(c[0], c[1]), scaled(c[2], c[3]), scaled(c[4], c[5])))
            .collect(),
        // Small integers, some of them moved by the least that there is.
        5 => chunks::<4>(bytes)
            .map(|[x, y, z, moved]| {
                let p = [x, y, z].map(|b| f64::from(b % 5));
                DVec3::from_array([0, 1, 2].map(|axis| match moved >> (2 * axis) & 3 {
                    1 => p[axis].next_up(),
                    2 => p[axis].next_down(),
                    _ => p[axis],
                }))
            })
            .collect(),
        // Doubles as they come, those that are no numbers too.
        _ => chunks::<24>(bytes)
            .map(|c| {
                DVec3::from_array([0, 8, 16].map(|at| {
                    let mut eight = [0; 8];
                    eight.copy_from_slice(&c[at..at + 8]);
                    f64::from_le_bytes(eight)
                }))
            })
            .collect(),
    };
    points.into_iter().take(MOST).collect()
}

fn chunks<const N: usize>(bytes: &[u8]) -> impl Iterator<Item = [u8; N]> {
    bytes.chunks_exact(N).map(|chunk| {
        let mut array = [0; N];
        array.copy_from_slice(chunk);
        array
    })
}

fn scaled(mantissa: u8, exponent: u8) -> f64 {
    let exponent = i32::from(exponent as i8) * 8;
    // In two steps, since the power alone may be out of range.
    f64::from(mantissa as i8) * 2.0_f64.powi(exponent / 2) * 2.0_f64.powi(exponent - exponent / 2)
}

/// Two bits choose the kind, three the signs, three the order.
fn on_sphere(byte: u8) -> DVec3 {
    const ORDERS: [[usize; 3]; 8] = [
        [0, 1, 2],
        [0, 2, 1],
        [1, 0, 2],
        [1, 2, 0],
        [2, 0, 1],
        [2, 1, 0],
        [0, 1, 2],
        [2, 1, 0],
    ];
    let kind = ON_SPHERE[usize::from(byte & 3)];
    let order = ORDERS[usize::from(byte >> 5)];
    DVec3::from_array([0, 1, 2].map(|axis| {
        let value = f64::from(kind[order[axis]]);
        if byte >> (2 + axis) & 1 == 1 {
            -value
        } else {
            value
        }
    }))
}

/// The result has no defect, and is the same for the points in reverse.
pub fn check_tetrahedralize(bytes: &[u8]) {
    let points = points(bytes);
    let reversed: Vec<DVec3> = points.iter().rev().copied().collect();
    let result = tetrahedralize(&points, &Options::default());
    let other = tetrahedralize(&reversed, &Options::default());
    match (result, other) {
        (Ok(one), Ok(other)) => {
            assert_sound(&one);
            let by_place = |made: &Tetrahedralization| by_place(made.tets(), made.points());
            assert_eq!(by_place(&one), by_place(&other));
            assert_eq!(one.twins(), other.twins());
        }
        (Err(Error::NotFinite { vertex }), Err(Error::NotFinite { .. })) => {
            assert!(!points[vertex.index()].is_finite());
        }
        (one, other) => assert_eq!(one.err(), other.err()),
    }
}

fn assert_sound(tetrahedralization: &Tetrahedralization) {
    assert_eq!(tetrahedralization.validate(), []);
    if tetrahedralization.points().len() <= FEW {
        assert_eq!(tetrahedralization.validate_globally(), []);
    }
}

fn bits(point: DVec3) -> [u64; 3] {
    (point + DVec3::ZERO).to_array().map(f64::to_bits)
}

fn by_place(tets: &[[VertexId; 4]], points: &[DVec3]) -> Vec<[Option<[u64; 3]>; 4]> {
    let place = |v: VertexId| v.some().map(|v| bits(points[v.index()]));
    tets.iter().map(|tet| tet.map(place)).collect()
}

/// The same of points with weights.
///
/// The first byte says how many of the others are weights, the second how those are to be read.
pub fn check_regular(bytes: &[u8]) {
    let Some((&split, bytes)) = bytes.split_first() else {
        return;
    };
    let (weights, bytes) = bytes.split_at(usize::from(split).min(bytes.len()));
    let points = points(bytes);
    let weights: Vec<f64> = weights_of(weights).take(points.len()).collect();
    let reversed: Vec<DVec3> = points.iter().rev().copied().collect();
    let reversed_weights: Vec<f64> = weights.iter().rev().copied().collect();
    let options = Options::default();
    let result = tetrahedralize_weighted(&points, &weights, &options);
    let other = tetrahedralize_weighted(&reversed, &reversed_weights, &options);
    match (result, other) {
        (Ok(one), Ok(other)) => {
            assert_eq!(one.validate(), []);
            if points.len() <= FEW {
                assert_eq!(one.validate_globally(), []);
            }
            let by_place = |made: &RegularTetrahedralization| by_place(made.tets(), made.points());
            assert_eq!(by_place(&one), by_place(&other));
            assert_eq!(one.twins(), other.twins());
            assert_eq!(hidden(&one), hidden(&other));
        }
        (Err(Error::NotFinite { vertex }), Err(Error::NotFinite { .. })) => {
            assert!(!points[vertex.index()].is_finite());
        }
        (Err(Error::WeightNotFinite { vertex }), Err(Error::WeightNotFinite { .. })) => {
            assert!(!weights[vertex.index()].is_finite());
        }
        (one, other) => assert_eq!(one.err(), other.err()),
    }
}

/// Weights without end: those that the bytes say, then zeros.
fn weights_of(bytes: &[u8]) -> impl Iterator<Item = f64> {
    let (scheme, bytes) = bytes.split_first().unwrap_or((&0, &[]));
    let weights: Vec<f64> = match scheme % 4 {
        // As coordinates are: many points exactly on others' spheres.
        0 => chunks::<1>(bytes).map(|[b]| f64::from(b % 5)).collect(),
        1 => chunks::<1>(bytes).map(|[b]| f64::from(b as i8)).collect(),
        2 => chunks::<2>(bytes).map(|[m, e]| scaled(m, e)).collect(),
        _ => chunks::<8>(bytes).map(f64::from_le_bytes).collect(),
    };
    weights.into_iter().chain(std::iter::repeat(0.0))
}

fn hidden(regular: &RegularTetrahedralization) -> Vec<([u64; 3], u64)> {
    let place = |v: &VertexId| {
        let weight = regular.weights()[v.index()] + 0.0;
        (bits(regular.points()[v.index()]), weight.to_bits())
    };
    let mut hidden: Vec<_> = regular.hidden().iter().map(place).collect();
    hidden.sort_unstable();
    hidden
}

/// Insertions and removals end at what the points that are left make at once.
///
/// The first byte says how many of the others name the points that are removed, one after each third insertion and the rest
/// at the end.
pub fn check_dynamic(bytes: &[u8]) {
    let Some((&split, bytes)) = bytes.split_first() else {
        return;
    };
    let (choices, bytes) = bytes.split_at(usize::from(split).min(bytes.len()));
    let mut choices = choices.iter();
    let mut dynamic = DynamicTetrahedralization::new();
    let remove = |dynamic: &mut DynamicTetrahedralization, choice: u8| {
        let count = dynamic.vertex_count();
        if count > 0 {
            let vertex = dynamic.vertices().nth(usize::from(choice) % count);
            let vertex = vertex.expect("there are as many vertices as are counted");
            dynamic.remove(vertex).expect("the vertex is there");
        }
    };
    for (i, point) in points(bytes).into_iter().enumerate() {
        match dynamic.insert(point) {
            Ok(vertex) => assert_eq!(dynamic.point(vertex), Some(point)),
            Err(error) => assert!(!point.is_finite(), "{error}"),
        }
        if i % 3 == 2
            && let Some(&choice) = choices.next()
        {
            remove(&mut dynamic, choice);
        }
    }
    assert_eq!(dynamic.validate(), []);
    for &choice in choices {
        remove(&mut dynamic, choice);
    }
    assert_eq!(dynamic.validate(), []);
    let left: Vec<DVec3> = dynamic
        .vertices()
        .filter_map(|v| dynamic.point(v))
        .collect();
    let mut again = Vec::new();
    match (
        dynamic.to_tetrahedralization(&mut again),
        tetrahedralize(&left, &Options::default()),
    ) {
        (Ok(one), Ok(other)) => {
            assert_sound(&one);
            assert_eq!(sorted(&one), sorted(&other));
        }
        (one, other) => assert_eq!(one.err(), other.err()),
    }
}

fn sorted(tetrahedralization: &Tetrahedralization) -> Vec<[Option<[u64; 3]>; 4]> {
    let mut tets = by_place(tetrahedralization.tets(), tetrahedralization.points());
    for tet in &mut tets {
        tet.sort_unstable();
    }
    tets.sort_unstable();
    tets
}
