//! Regular triangulations against brute force in exact integers, and their promises.

use dashu::{integer::IBig, rational::RBig};
use pellicle_delaunay::{
    Error, InsertionOrder, Options, RegularTetrahedralization, tetrahedralize,
    tetrahedralize_weighted, tetrahedralize_weighted_with,
};
use pellicle_geometry::{Cancelled, DVec3, Progress, VertexId};
use proptest::prelude::*;
use std::{cmp::Ordering, collections::BTreeMap};

/// Points and their weights.
type Sites = Vec<(DVec3, f64)>;

fn split(sites: &Sites) -> (Vec<DVec3>, Vec<f64>) {
    sites.iter().copied().unzip()
}

/// Small sets of lattices, spheres, planes, random points and extremes, with some points there twice; weights of
/// few values, flat lifts, lifts that are flat but for a few units, random ones and extremes.
fn sites() -> impl Strategy<Value = Sites> {
    let grid = [0..3_i32, 0..3_i32, 0..3_i32].prop_map(|c| DVec3::from(c.map(f64::from)));
    let plane = (0..4_i32, 0..4_i32, prop::bool::weighted(0.2))
        .prop_map(|(x, y, off)| DVec3::new(x.into(), y.into(), u8::from(off).into()));
    let sphere = (
        prop::sample::select(vec![[1.0, 4.0, 8.0], [4.0, 4.0, 7.0], [0.0, 0.0, 9.0]]),
        Just([0_usize, 1, 2]).prop_shuffle(),
        prop::array::uniform3(any::<bool>()),
    )
        .prop_map(|(v, axes, signs)| {
            DVec3::from([0, 1, 2].map(|i| v[axes[i]] * if signs[i] { -1.0 } else { 1.0 }))
        });
    let random = prop::array::uniform3(-1.0..1.0).prop_map(DVec3::from);
    let wild = prop::array::uniform3(prop_oneof![
        Just(0.0),
        Just(5e-324),
        Just(1e300),
        Just(-f64::MAX),
        -1.0..1.0
    ])
    .prop_map(DVec3::from);
    let points = prop_oneof![
        3 => prop::collection::vec(grid, 4..13),
        2 => prop::collection::vec(plane, 4..13),
        2 => prop::collection::vec(sphere, 4..12),
        3 => prop::collection::vec(random, 4..12),
        1 => prop::collection::vec(wild, 4..8),
    ];
    points
        .prop_flat_map(|points| {
            let count = points.len();
            let few = prop::collection::vec((-2..=2_i32).prop_map(f64::from), count);
            let share = prop::collection::vec(-1.0..1.0, count);
            let extreme = prop::collection::vec(
                prop::sample::select(vec![
                    0.0,
                    5e-324,
                    -5e-324,
                    1e-300,
                    1.0,
                    1e300,
                    f64::MAX,
                    f64::MIN,
                ]),
                count,
            );
            let flat = (
                prop::array::uniform3(-2..=2_i32),
                prop::collection::vec(-1..=1_i32, count),
                any::<bool>(),
            );
            let positions = points.clone();
            let flat = flat.prop_map(move |(normal, bends, bent)| {
                let normal = DVec3::from(normal.map(f64::from));
                let weight = |(p, bend): (&DVec3, i32)| {
                    let lift = p.length_squared()
                        + normal.dot(*p)
                        + if bent { f64::from(bend) } else { 0.0 };
                    if lift.is_nan() {
                        0.0
                    } else {
                        lift.clamp(f64::MIN, f64::MAX)
                    }
                };
                positions.iter().zip(bends).map(weight).collect::<Vec<_>>()
            });
            let weights = prop_oneof![few, share, extreme, flat];
            (
                Just(points),
                weights,
                prop::collection::vec(any::<prop::sample::Index>(), 0..3),
            )
        })
        .prop_map(|(points, weights, again)| {
            let mut sites: Sites = points.into_iter().zip(weights).collect();
            // Positions once more, with the weight of another point.
            let count = sites.len();
            for index in again {
                let weight = sites[(index.index(count) + 1) % count].1;
                sites.push((sites[index.index(count)].0, weight));
            }
            sites
        })
}

fn integers(values: impl Iterator<Item = f64> + Clone, least: usize) -> (Vec<IBig>, usize) {
    use dashu::base::BitTest;
    let rational = |v: f64| RBig::try_from(v).expect("a finite double");
    let bits = values
        .clone()
        .map(|v| rational(v).denominator().bit_len() - 1)
        .fold(least, usize::max);
    let scaled = values.map(|v| {
        let rational = rational(v);
        let shift = bits + 1 - rational.denominator().bit_len();
        rational.numerator().clone() << shift
    });
    (scaled.collect(), bits)
}

/// Everything that the definition needs, in exact integers.
struct Exact<'a> {
    points: &'a [DVec3],
    /// The lifts' heights.
    heights: Vec<IBig>,
    /// By four points in ascending order.
    orientations: BTreeMap<[usize; 4], IBig>,
}

impl<'a> Exact<'a> {
    fn new(points: &'a [DVec3], weights: &[f64]) -> Self {
        // Weights count in squares of the coordinates' unit: that of which both are multiples.
        let (_, of_weights) = integers(weights.iter().copied(), 0);
        let coordinates = points.iter().flat_map(|p| p.to_array());
        let (flat, bits) = integers(coordinates, of_weights.div_ceil(2));
        let (weights, weight_bits) = integers(weights.iter().copied(), 2 * bits);
        assert_eq!(weight_bits, 2 * bits);
        let position = |i: usize| [0, 1, 2].map(|k| flat[3 * i + k].clone());
        let heights = (0..points.len())
            .map(|i| position(i).iter().map(|c| c * c).sum::<IBig>() - &weights[i])
            .collect();
        let mut orientations = BTreeMap::new();
        for four in subsets(points.len()) {
            let [a, b, c, d] = four.map(position);
            let row = |p: &[IBig; 3]| [0, 1, 2].map(|k| &p[k] - &a[k]);
            let [u, v, w] = [row(&b), row(&c), row(&d)];
            let cross = |i: usize, j: usize| &v[i] * &w[j] - &v[j] * &w[i];
            let value = &u[0] * cross(1, 2) + &u[1] * cross(2, 0) + &u[2] * cross(0, 1);
            orientations.insert(four, value);
        }
        Self {
            points,
            heights,
            orientations,
        }
    }

    /// det[b − a, c − a, d − a] of different points in any order.
    fn orientation(&self, four: [usize; 4]) -> IBig {
        let mut sorted = four;
        sorted.sort_unstable();
        let inversions = (0..4).flat_map(|i| (0..i).map(move |j| (j, i)));
        let odd = inversions.filter(|&(j, i)| four[j] > four[i]).count() % 2 == 1;
        let value = &self.orientations[&sorted];
        if odd { -value } else { value.clone() }
    }

    /// The coefficients of the heights in the power test.
    fn factors(&self, [a, b, c, d]: [usize; 4], e: usize) -> [IBig; 5] {
        [
            self.orientation([e, b, c, d]),
            self.orientation([a, e, c, d]),
            self.orientation([a, b, e, d]),
            self.orientation([a, b, c, e]),
            -self.orientation([a, b, c, d]),
        ]
    }

    fn power_test(&self, corners: [usize; 4], e: usize) -> IBig {
        let [a, b, c, d] = corners;
        let factors = self.factors(corners, e);
        [a, b, c, d, e]
            .iter()
            .zip(factors)
            .map(|(&i, factor)| &self.heights[i] * factor)
            .sum()
    }

    /// The sign of the power test with every height raised by a small number's power, less for lesser points.
    fn perturbed(&self, corners: [usize; 4], e: usize) -> Ordering {
        let plain = self.power_test(corners, e).cmp(&IBig::ZERO);
        if plain != Ordering::Equal {
            return plain;
        }
        let [a, b, c, d] = corners;
        let mut by_rank: Vec<(usize, IBig)> = [a, b, c, d, e]
            .into_iter()
            .zip(self.factors(corners, e))
            .collect();
        let coordinates = |i: usize| (self.points[i] + DVec3::ZERO).to_array();
        by_rank.sort_by(|x, y| {
            coordinates(y.0)
                .partial_cmp(&coordinates(x.0))
                .expect("finite")
        });
        let signs = by_rank.iter().map(|(_, factor)| factor.cmp(&IBig::ZERO));
        signs
            .into_iter()
            .find(|sign| *sign != Ordering::Equal)
            .unwrap_or(Ordering::Equal)
    }

    /// The four points in positive order, unless they are coplanar.
    fn positive(&self, [a, b, c, d]: [usize; 4]) -> Option<[usize; 4]> {
        match self.orientations[&[a, b, c, d]].cmp(&IBig::ZERO) {
            Ordering::Greater => Some([a, b, c, d]),
            Ordering::Less => Some([b, a, c, d]),
            Ordering::Equal => None,
        }
    }

    /// Whether e lies in the closed positive tetrahedron.
    fn contains(&self, [a, b, c, d]: [usize; 4], e: usize) -> bool {
        [[e, b, c, d], [a, e, c, d], [a, b, e, d], [a, b, c, e]]
            .iter()
            .all(|&four| self.orientation(four) >= IBig::ZERO)
    }

    /// All tetrahedra that no point is in conflict with, corners ascending.
    fn tetrahedra(&self, among: &[usize]) -> Vec<[usize; 4]> {
        let is_empty = |&four: &[usize; 4]| {
            self.positive(four).is_some_and(|corners| {
                let mut others = among.iter().filter(|e| !four.contains(e));
                others.all(|&e| self.perturbed(corners, e) != Ordering::Greater)
            })
        };
        subsets(among.len())
            .into_iter()
            .map(|four| four.map(|i| among[i]))
            .filter(is_empty)
            .collect()
    }

    /// The points strictly above the lower hull of the others' lifts: above some tetrahedron that contains them.
    fn hidden(&self, among: &[usize]) -> Vec<usize> {
        let is_above = |e: usize, four: [usize; 4]| {
            self.positive(four).is_some_and(|corners| {
                self.contains(corners, e) && self.power_test(corners, e) < IBig::ZERO
            })
        };
        let fours: Vec<[usize; 4]> = subsets(among.len())
            .into_iter()
            .map(|four| four.map(|i| among[i]))
            .collect();
        let hides = |e: usize| {
            fours
                .iter()
                .any(|&four| !four.contains(&e) && is_above(e, four))
        };
        among.iter().copied().filter(|&e| hides(e)).collect()
    }
}

/// All four of 0 to count − 1, ascending.
fn subsets(count: usize) -> Vec<[usize; 4]> {
    let mut found = Vec::new();
    for d in 0..count {
        for c in 0..d {
            for b in 0..c {
                found.extend((0..b).map(|a| [a, b, c, d]));
            }
        }
    }
    found
}

/// The first of the heaviest at each position.
fn heaviest(sites: &Sites) -> Vec<usize> {
    let beaten_by = |i: usize, j: usize| {
        let ((p, w), (q, v)) = (sites[i], sites[j]);
        p == q && (v > w || (v == w && j < i))
    };
    (0..sites.len())
        .filter(|&i| !(0..sites.len()).any(|j| beaten_by(i, j)))
        .collect()
}

fn sorted_tetrahedra(regular: &RegularTetrahedralization) -> Vec<[usize; 4]> {
    let mut tetrahedra: Vec<[usize; 4]> = regular
        .finite_tets()
        .iter()
        .map(|tet| {
            let mut corners = tet.map(VertexId::index);
            corners.sort_unstable();
            corners
        })
        .collect();
    tetrahedra.sort_unstable();
    tetrahedra
}

/// What is promised for any input; the whole truth by brute force.
fn check(sites: &Sites) -> Result<(), TestCaseError> {
    let (points, weights) = split(sites);
    let Ok(regular) = tetrahedralize_weighted(&points, &weights, &Options::default()) else {
        prop_assert!(tetrahedralize(&points, &Options::default()).is_err());
        return Ok(());
    };
    prop_assert_eq!(regular.validate(), []);
    prop_assert_eq!(regular.validate_globally(), []);

    let exact = Exact::new(&points, &weights);
    let heaviest = heaviest(sites);
    let mut tetrahedra = exact.tetrahedra(&heaviest);
    tetrahedra.sort_unstable();
    prop_assert_eq!(sorted_tetrahedra(&regular), tetrahedra);

    let mut hidden = exact.hidden(&heaviest);
    for i in 0..sites.len() {
        let id = VertexId::new(i);
        match heaviest.iter().find(|&&j| points[i] == points[j]) {
            Some(&j) if weights[i] < weights[j] => hidden.push(i),
            Some(&j) => prop_assert_eq!(regular.representative(id), VertexId::new(j)),
            None => prop_assert!(false, "no heaviest at {}", points[i]),
        }
        prop_assert_eq!(regular.incident(id).is_none(), regular.is_hidden(id));
    }
    hidden.sort_unstable();
    let found: Vec<usize> = regular.hidden().iter().map(|v| v.index()).collect();
    prop_assert_eq!(found, hidden);
    let others = regular.hidden().len() + regular.duplicates().len();
    prop_assert_eq!(regular.vertex_count(), sites.len() - others);
    Ok(())
}

/// The finite tetrahedra and hidden points as positions and weights, sorted.
type Parts = (Vec<Vec<[u64; 4]>>, Vec<[u64; 4]>);

fn as_sets(regular: &RegularTetrahedralization) -> Parts {
    let bits = |v: VertexId| {
        let p = regular.points()[v.index()] + DVec3::ZERO;
        let w = regular.weights()[v.index()] + 0.0;
        [p.x, p.y, p.z, w].map(f64::to_bits)
    };
    let sorted = |mut v: Vec<[u64; 4]>| {
        v.sort_unstable();
        v
    };
    let mut tetrahedra: Vec<_> = regular
        .finite_tets()
        .iter()
        .map(|tet| sorted(tet.map(bits).to_vec()))
        .collect();
    tetrahedra.sort_unstable();
    (
        tetrahedra,
        sorted(regular.hidden().iter().map(|&v| bits(v)).collect()),
    )
}

proptest! {
    #![proptest_config(ProptestConfig {
        rng_seed: proptest::test_runner::RngSeed::Fixed(5),
        failure_persistence: None,
        ..ProptestConfig::with_cases(256)
    })]

    #[test]
    fn it_is_its_definition(sites in sites()) {
        check(&sites)?;
    }

    #[test]
    fn equal_weights_make_it_delaunay(sites in sites(), bits in any::<u64>()) {
        let weight = f64::from_bits(bits);
        prop_assume!(weight.is_finite());
        let (points, _) = split(&sites);
        let weights = vec![weight; points.len()];
        let plain = tetrahedralize(&points, &Options::default());
        match (plain, tetrahedralize_weighted(&points, &weights, &Options::default())) {
            (Ok(plain), Ok(regular)) => {
                prop_assert_eq!(regular.tets(), plain.tets());
                prop_assert_eq!(regular.twins(), plain.twins());
                prop_assert_eq!(regular.duplicates(), plain.duplicates());
                prop_assert_eq!(regular.hidden(), []);
            }
            (plain, regular) => prop_assert_eq!(plain.err(), regular.err()),
        }
    }

    #[test]
    fn the_order_of_the_points_does_not_matter(
        (sites, shuffled) in sites().prop_flat_map(|sites| (Just(sites.clone()), Just(sites).prop_shuffle())),
        as_given: bool,
    ) {
        let mut options = Options::default();
        let (points, weights) = split(&sites);
        let one = tetrahedralize_weighted(&points, &weights, &options);
        if as_given {
            options.order = InsertionOrder::AsGiven;
        }
        let (points, weights) = split(&shuffled);
        let other = tetrahedralize_weighted(&points, &weights, &options);
        match (one, other) {
            (Ok(one), Ok(other)) => {
                prop_assert_eq!(as_sets(&one), as_sets(&other));
                if !as_given {
                    let positions = |regular: &RegularTetrahedralization| {
                        let corner = |v: VertexId| v.some().map(|v| regular.points()[v.index()]);
                        regular.tets().iter().map(|tet| tet.map(corner)).collect::<Vec<_>>()
                    };
                    prop_assert_eq!(positions(&one), positions(&other));
                    prop_assert_eq!(one.twins(), other.twins());
                }
            }
            (one, other) => prop_assert_eq!(one.err(), other.err()),
        }
    }
}

fn lattice(side: i32) -> Vec<DVec3> {
    let coordinates = |i: i32| [i % side, i / side % side, i / side / side].map(f64::from);
    (0..side.pow(3))
        .map(|i| DVec3::from(coordinates(i)))
        .collect()
}

/// A fixed sequence of numbers in [0, 1).
fn sequence(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed;
    move || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// All lifts on one hyperplane: the perturbation alone decides, and it hides no point.
#[test]
fn flat_lifts_hide_nothing() {
    let points = lattice(5);
    for normal in [DVec3::ZERO, DVec3::new(3.0, -1.0, 2.0)] {
        let weights: Vec<f64> = points
            .iter()
            .map(|p| p.length_squared() + normal.dot(*p) - 7.0)
            .collect();
        let regular = tetrahedralize_weighted(&points, &weights, &Options::default()).unwrap();
        assert_eq!(regular.validate(), []);
        assert_eq!(regular.validate_globally(), []);
        assert_eq!(regular.hidden(), []);
        let volume: f64 = regular
            .finite_tets()
            .iter()
            .map(|tet| {
                let [a, b, c, d] = tet.map(|v| points[v.index()]);
                (b - a).dot((c - a).cross(d - a))
            })
            .sum();
        assert_eq!(volume, 6.0 * 64.0);
    }
}

/// Lifts on a concave surface: the corners of the box alone are vertices.
#[test]
fn concave_lifts_hide_all_but_the_corners() {
    let points = lattice(5);
    let weights: Vec<f64> = points.iter().map(|p| 2.0 * p.length_squared()).collect();
    let regular = tetrahedralize_weighted(&points, &weights, &Options::default()).unwrap();
    assert_eq!(regular.validate(), []);
    assert_eq!(regular.vertex_count(), 8);
    assert_eq!(regular.hidden().len(), 125 - 8);
}

#[test]
fn one_heavy_point_hides_all_that_are_not_on_the_hull() {
    let points = lattice(4);
    for weight in [100.0, 1e300, f64::MAX] {
        let mut weights = vec![0.0; points.len()];
        let heavy = points
            .iter()
            .position(|p| *p == DVec3::new(1.0, 2.0, 1.0))
            .unwrap();
        weights[heavy] = weight;
        let regular = tetrahedralize_weighted(&points, &weights, &Options::default()).unwrap();
        assert_eq!(regular.validate(), []);
        let inside = |p: &DVec3| p.to_array().iter().all(|c| (1.0..=2.0).contains(c));
        let expected: Vec<VertexId> = (0..points.len())
            .filter(|&i| i != heavy && inside(&points[i]))
            .map(VertexId::new)
            .collect();
        assert_eq!(regular.hidden(), expected);
        assert_eq!(expected.len(), 7);
        for tet in regular.finite_tets() {
            assert!(tet.contains(&VertexId::new(heavy)));
        }
    }
}

/// The least of weights decides a tie; and weights may be as small as the squares of the smallest coordinates.
#[test]
fn the_smallest_weights_count() {
    let cube = lattice(2);
    let tiny = 5e-324;
    let mut weights = vec![0.0; 8];
    weights[7] = tiny;
    let regular = tetrahedralize_weighted(&cube, &weights, &Options::default()).unwrap();
    let at_heavy = regular
        .finite_tets()
        .iter()
        .filter(|tet| tet.contains(&VertexId(7)))
        .count();
    assert_eq!((regular.finite_count(), at_heavy), (6, 6));
    weights[7] = -tiny;
    let regular = tetrahedralize_weighted(&cube, &weights, &Options::default()).unwrap();
    let at_light = regular
        .finite_tets()
        .iter()
        .filter(|tet| tet.contains(&VertexId(7)))
        .count();
    assert_eq!(at_light, 1);

    let unit = f64::powi(2.0, -537);
    let mut points: Vec<DVec3> = lattice(3).iter().map(|&p| p * unit).collect();
    let centre = points
        .iter()
        .position(|p| *p == DVec3::splat(unit))
        .unwrap();
    points.swap(0, centre);
    let mut weights = vec![0.0; points.len()];
    // Below the lattice's hyperplane by one squared unit at −1: the same height as its neighbours.
    for (weight, hidden) in [(0.0, false), (-tiny, false), (-2.0 * tiny, true)] {
        weights[0] = weight;
        let regular = tetrahedralize_weighted(&points, &weights, &Options::default()).unwrap();
        assert_eq!(regular.validate(), []);
        assert_eq!(regular.is_hidden(VertexId(0)), hidden, "{weight:e}");
    }
}

#[test]
fn of_equal_points_the_heaviest_stands_for_all() {
    let mut points = lattice(2);
    points.extend([DVec3::ZERO, -DVec3::ZERO, DVec3::ZERO, DVec3::X]);
    let mut weights = vec![0.0; points.len()];
    // Point 8 is heavier than 0, 9 as heavy as 8, 10 lighter than all; 11 is another X.
    weights[8..11].copy_from_slice(&[0.5, 0.5, -0.5]);
    let regular = tetrahedralize_weighted(&points, &weights, &Options::default()).unwrap();
    assert_eq!(regular.validate(), []);
    assert_eq!(regular.hidden(), [VertexId(0), VertexId(10)]);
    assert_eq!(
        regular.duplicates(),
        [(VertexId(9), VertexId(8)), (VertexId(11), VertexId(1))]
    );
    assert_eq!(regular.vertex_count(), 8);
    assert_eq!(regular.incident(VertexId(9)), regular.incident(VertexId(8)));
    assert_eq!(regular.incident(VertexId(0)), None);
    assert_eq!(regular.around_vertex(VertexId(0)).count(), 0);
    assert!(regular.around_vertex(VertexId(8)).count() >= 3);
    assert!(regular.is_hidden(VertexId(0)) && !regular.is_hidden(VertexId(9)));
}

/// A hidden point may have a duplicate, which is hidden with it.
#[test]
fn duplicates_of_hidden_points_are_hidden() {
    let mut points = lattice(2);
    points.extend([DVec3::splat(0.5); 3]);
    let mut weights = vec![0.0; 8];
    weights.extend([-1.0, -2.0, -1.0]);
    let regular = tetrahedralize_weighted(&points, &weights, &Options::default()).unwrap();
    assert_eq!(regular.validate(), []);
    assert_eq!(regular.hidden(), [VertexId(8), VertexId(9)]);
    assert_eq!(regular.duplicates(), [(VertexId(10), VertexId(8))]);
    assert!(regular.is_hidden(VertexId(10)));
    assert_eq!(regular.incident(VertexId(10)), None);
    assert_eq!(regular.vertex_count(), 8);
}

#[test]
fn many_points_of_random_weights() {
    let mut next = sequence(11);
    let mut hidden = Vec::new();
    for spread in [1e-6, 1e-3, 1e-2, 1.0] {
        let points: Vec<DVec3> = (0..4000)
            .map(|_| DVec3::new(next(), next(), next()))
            .collect();
        let weights: Vec<f64> = points.iter().map(|_| spread * next()).collect();
        let regular = tetrahedralize_weighted(&points, &weights, &Options::default()).unwrap();
        assert_eq!(regular.validate(), []);
        hidden.push(regular.hidden().len());
    }
    assert!(hidden.is_sorted());
    assert!(
        hidden[0] == 0 && hidden[2] > 500 && hidden[3] > 3500,
        "{hidden:?}"
    );
}

/// Enough points that threads share rounds, and meet hidden points while they do.
#[test]
fn threads_do_not_matter() {
    let mut next = sequence(7);
    for spread in [3e-4, 3e-2] {
        let points: Vec<DVec3> = (0..40_000)
            .map(|_| DVec3::new(next(), next(), next()))
            .collect();
        let weights: Vec<f64> = points.iter().map(|_| spread * next()).collect();
        let with = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
            let build = || tetrahedralize_weighted(&points, &weights, &Options::default()).unwrap();
            pool.build().unwrap().install(build)
        };
        let one = with(1);
        assert_eq!(one.validate(), []);
        assert!(!one.hidden().is_empty());
        for threads in [2, 4] {
            let several = with(threads);
            assert!(several.tets() == one.tets() && several.twins() == one.twins());
            assert_eq!(several.hidden(), one.hidden());
        }
    }
}

/// Balls of very different sizes, touching and overlapping, as atoms are.
#[test]
fn balls_on_a_lattice() {
    let points = lattice(9);
    let mut next = sequence(3);
    let radii: Vec<f64> = points
        .iter()
        .map(|_| (8.0 * next()).floor() * 0.25)
        .collect();
    let weights: Vec<f64> = radii.iter().map(|r| r * r).collect();
    let regular = tetrahedralize_weighted(&points, &weights, &Options::default()).unwrap();
    assert_eq!(regular.validate(), []);
    assert!(!regular.hidden().is_empty());
}

/// The same number added to all weights, exactly, changes nothing.
#[test]
fn only_differences_of_weights_count() {
    let points = lattice(4);
    let mut next = sequence(9);
    let weights: Vec<f64> = points.iter().map(|_| (4.0 * next()).floor()).collect();
    let shifted: Vec<f64> = weights.iter().map(|w| w - 4096.0).collect();
    let one = tetrahedralize_weighted(&points, &weights, &Options::default()).unwrap();
    let other = tetrahedralize_weighted(&points, &shifted, &Options::default()).unwrap();
    assert_eq!(one.tets(), other.tets());
    assert_eq!(one.twins(), other.twins());
    assert_eq!(one.hidden(), other.hidden());
    assert!(!one.hidden().is_empty());
}

#[test]
fn what_has_no_regular_triangulation_is_refused_by_name() {
    let cube = lattice(2);
    let fails = |points: &[DVec3], weights: &[f64]| {
        tetrahedralize_weighted(points, weights, &Options::default()).unwrap_err()
    };
    assert_eq!(
        fails(&cube, &[0.0; 7]),
        Error::WeightCount {
            points: 8,
            weights: 7
        }
    );
    let mut weights = [1.0; 8];
    weights[5] = f64::INFINITY;
    weights[6] = f64::NAN;
    assert_eq!(
        fails(&cube, &weights),
        Error::WeightNotFinite {
            vertex: VertexId(5)
        }
    );
    assert_eq!(
        fails(&cube[..4], &[0.0, 1.0, 2.0, 3.0]),
        Error::Coplanar { distinct: 4 }
    );
    assert_eq!(
        fails(&[DVec3::ONE; 3], &[0.0, 1.0, 2.0]),
        Error::TooFewPoints { distinct: 1 }
    );
    assert_eq!(
        fails(&[DVec3::NAN], &[0.0]),
        Error::NotFinite {
            vertex: VertexId(0)
        }
    );
}

#[test]
fn an_observer_stops_the_work() {
    struct Never;
    impl Progress for Never {
        fn step(&self, _: &'static str, _: u64, _: u64) -> std::ops::ControlFlow<()> {
            std::ops::ControlFlow::Break(())
        }
    }
    let cube = lattice(2);
    let stopped = tetrahedralize_weighted_with(&cube, &[0.0; 8], &Options::default(), &Never);
    assert_eq!(stopped.unwrap_err(), Error::Cancelled(Cancelled));
}
