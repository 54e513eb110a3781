//! Times by kind of input: `cargo bench -p pellicle-delaunay`.
//!
//! `order` is the order of insertion alone and `tetrahedralize` all of it, by point; the difference is location, cavities and
//! their retriangulation. `locate`, `insert` and `remove` are by step, in a tetrahedralisation that is there. One thread; what
//! more of them bring is measured by `cargo xtask bench --delaunay`.

#[path = "../examples/common/mod.rs"]
mod common;

use common::inputs::{KINDS, input, weights};
use criterion::{
    BatchSize, BenchmarkGroup, Criterion, Throughput, criterion_group, criterion_main,
    measurement::WallTime,
};
use pellicle_delaunay::{
    DynamicTetrahedralization, Options, tetrahedralize, tetrahedralize_weighted,
};
use pellicle_geometry::DVec3;
use pellicle_spatial::brio;
use std::hint::black_box;

/// Points of each kind; the last tenth is located, inserted and removed.
const COUNT: usize = 20_000;

fn by_kind(criterion: &mut Criterion) {
    let alone = rayon::ThreadPoolBuilder::new().num_threads(1);
    alone.build_global().expect("nobody asked for threads yet");
    for kind in KINDS {
        let points = input(kind, COUNT).expect("every kind has points");
        let weights = weights(kind, COUNT);
        let mut group = criterion.benchmark_group(kind);
        group.sample_size(10);
        group.throughput(Throughput::Elements(points.len() as u64));
        group.bench_function("order", |bencher| {
            bencher.iter(|| brio::order(black_box(&points)));
        });
        group.bench_function("tetrahedralize", |bencher| {
            let options = Options::default();
            let points = black_box(&points);
            match &weights {
                None => bencher.iter(|| tetrahedralize(points, &options).map(drop)),
                Some(weights) => {
                    bencher.iter(|| tetrahedralize_weighted(points, weights, &options).map(drop))
                }
            }
        });
        if weights.is_none() {
            stepwise(&mut group, &points);
        }
        group.finish();
    }
}

fn stepwise(group: &mut BenchmarkGroup<WallTime>, points: &[DVec3]) {
    let (most, last) = points.split_at(points.len() / 10 * 9);
    let there = || DynamicTetrahedralization::of_points(most).expect("the kinds have sound points");
    let with_last = || {
        let mut there = there();
        let inserted = last.iter().map(|&p| there.insert(p));
        let mut vertices: Vec<_> = inserted
            .map(|vertex| vertex.expect("there is room"))
            .collect();
        vertices.sort_unstable();
        vertices.dedup();
        (there, vertices)
    };
    group.throughput(Throughput::Elements(last.len() as u64));
    let fixed = there();
    group.bench_function("locate", |bencher| {
        bencher.iter(|| {
            last.iter()
                .filter_map(|&p| fixed.locate(black_box(p), None))
                .count()
        });
    });
    group.bench_function("insert", |bencher| {
        let insert = |mut there: DynamicTetrahedralization| {
            last.iter().filter(|&&p| there.insert(p).is_ok()).count()
        };
        bencher.iter_batched(there, insert, BatchSize::PerIteration);
    });
    group.bench_function("remove", |bencher| {
        let remove = |(mut there, vertices): (DynamicTetrahedralization, Vec<_>)| {
            vertices
                .into_iter()
                .filter(|&v| there.remove(v).is_ok())
                .count()
        };
        bencher.iter_batched(with_last, remove, BatchSize::PerIteration);
    });
}

criterion_group!(benches, by_kind);
criterion_main!(benches);
