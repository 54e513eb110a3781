//! Times by kind of input: `cargo bench -p pellicle-delaunay`.
//!
//! `order` is the order of insertion alone, `tetrahedralize` all of it, so the difference is location, cavities and
//! retriangulation. One thread; what more threads bring is measured by `cargo xtask bench --delaunay`.

#[path = "../examples/common/mod.rs"]
mod common;

use common::inputs::{KINDS, input};
use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use pellicle_delaunay::{Options, tetrahedralize};
use pellicle_geometry::DVec3;
use pellicle_spatial::brio;
use std::hint::black_box;

/// Points of each kind.
const COUNT: usize = 20_000;

fn by_kind(criterion: &mut Criterion) {
    let alone = rayon::ThreadPoolBuilder::new().num_threads(1).build();
    let alone = alone.expect("a pool of one thread can be built");
    let inputs: Vec<(&str, Vec<DVec3>)> = KINDS
        .iter()
        .filter_map(|&kind| Some((kind, input(kind, COUNT)?)))
        .collect();

    let mut group = criterion.benchmark_group("order");
    for (kind, points) in &inputs {
        group.throughput(Throughput::Elements(points.len() as u64));
        group.bench_with_input(
            BenchmarkId::from_parameter(kind),
            points,
            |bencher, points| {
                alone.install(|| bencher.iter(|| brio::order(black_box(points))));
            },
        );
    }
    group.finish();

    let mut group = criterion.benchmark_group("tetrahedralize");
    group.sample_size(10);
    for (kind, points) in &inputs {
        group.throughput(Throughput::Elements(points.len() as u64));
        group.bench_with_input(
            BenchmarkId::from_parameter(kind),
            points,
            |bencher, points| {
                let options = Options::default();
                alone.install(|| bencher.iter(|| tetrahedralize(black_box(points), &options)));
            },
        );
    }
    group.finish();
}

criterion_group!(benches, by_kind);
criterion_main!(benches);
